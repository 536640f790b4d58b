//! Programs of any length that look like real ones.

/// A program and the place of a digit in its middle: a `0` whose change to `8` makes an octal mistake.
pub struct Program {
    pub text: String,
    /// Line and column of the digit.
    pub digit: (u32, u32),
}

/// A program of about `lines` lines, `il` for FX instruction list or `lad` for ladder.
pub fn program(notation: &str, lines: usize) -> Program {
    let rung = if notation == "lad" { ladder_rung } else { il_rung };
    let mut text = String::new();
    let mut count = 0;
    let mut number = 0;
    let mut digit = None;
    while count < lines {
        if digit.is_none() && count >= lines / 2 {
            digit = Some(count);
        }
        let piece = rung(number, digit == Some(count));
        count += piece.matches('\n').count();
        text += &piece;
        number += 1;
    }
    if notation == "il" {
        text += "END\n";
    }
    let middle = digit.unwrap_or(0);
    let line = text.lines().enumerate().skip(middle).find(|(_, line)| line.contains("X10"));
    let (line, content) = line.unwrap_or((0, ""));
    let column = content.find("X10").map_or(0, |at| at + 2);
    Program { text, digit: (line as u32, column as u32) }
}

/// Instruction list of about `bytes` bytes.
pub fn program_of_bytes(bytes: usize) -> String {
    let mut text = String::with_capacity(bytes + 100);
    let mut number = 0;
    while text.len() < bytes {
        text += &il_rung(number, false);
        number += 1;
    }
    text + "END\n"
}

/// Instruction list of so many rungs.
pub fn rungs(count: usize) -> String {
    (0..count).map(|number| il_rung(number, false)).collect::<String>() + "END\n"
}

fn il_rung(number: usize, marked: bool) -> String {
    let relay = number % 1500;
    let input = if marked { "X10".to_string() } else { format!("X{:o}", number % 128) };
    match number % 4 {
        0 => format!("// Rung {number}: seal-in\nLD {input}\nOR M{relay}\nANI X1\nOUT M{relay}\n"),
        1 => format!(
            "LD {input}\nLD M3\nOR M4\nANB\nMPS\nAND M5\nOUT M{relay}\nMPP\nANI M6\nSET S{}\n",
            number % 900
        ),
        2 => format!("LD {input}\nOUT T{} K{}\n", number % 200, number % 1000 + 1),
        _ => format!("LD> D{} K{}\nAND {input}\nMOV K{relay} D{relay}\n", number % 500, number % 1000),
    }
}

fn ladder_rung(number: usize, marked: bool) -> String {
    let input = if marked { "X10".to_string() } else { format!("X{:o}", number % 128) };
    let relay = format!("M{}", number % 1500);
    let mut rung = format!("(* Rung {number} *)\n");
    rung += &format!("|   {input:<8}  X1                         {relay:<5}|\n");
    rung += "+---| |---+---|/|------------------------( )-+\n";
    rung += &format!("|   {relay:<6}|                                  |\n");
    rung += "+---| |---+                                  |\n\n";
    rung
}
