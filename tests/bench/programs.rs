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

/// The relays that get a coil, on an FX3U. The rungs behind them count instead, as no program has that many.
const COILS: usize = 7_680;

/// Instruction list of so many rungs.
pub fn rungs(count: usize) -> String {
    (0..count).map(|number| il_rung(number, false)).collect::<String>() + "END\n"
}

/// Instruction list of IEC 61131-3 of about so many lines, in units of a hundred rungs.
pub fn iec(lines: usize) -> String {
    const RUNGS: usize = 100;
    let mut text = String::new();
    let mut count = 0;
    for unit in 0.. {
        if count >= lines {
            break;
        }
        text += &format!("PROGRAM Unit{unit}\nVAR\n");
        (0..=RUNGS).for_each(|rung| text += &format!("    Relay{rung} : BOOL;\n"));
        text += "END_VAR\n";
        for rung in 0..RUNGS {
            let (next, other) = (rung + 1, rung * 7 % RUNGS);
            text += &format!(
                "    LD Relay{next}\n    OR Relay{rung}\n    ANDN Relay{other}\n    ST Relay{rung}\n"
            );
        }
        text += "END_PROGRAM\n";
        count += 4 + RUNGS * 5;
    }
    text
}

/// Instruction list of IEC 61131-3 of so many rungs in one unit: seal-ins with a branch behind a contact, and rungs with
/// an output behind another one's power.
pub fn iec_unit(rungs: usize) -> String {
    let mut text = "PROGRAM Main\nVAR\n    Held1 : BOOL;\n".to_string();
    (0..=rungs).for_each(|rung| text += &format!("    Relay{rung} : BOOL;\n"));
    text += "END_VAR\n";
    for rung in 0..rungs {
        let (next, other) = (rung + 1, rung * 7 % rungs);
        text += &format!("    LDN Relay{next}\n    AND( Relay{rung}\n    OR Relay{other}\n    )\n");
        if rung % 10 == 0 {
            text += &format!("    ST Held1\n    AND Relay{next}\n    S Relay{other}\n    LD Held1\n");
        }
        text += &format!("    ST Relay{rung}\n");
    }
    text + "END_PROGRAM\n"
}

/// A rung of a program in which no rule finds anything: each coil, timer and latch is there once, and read.
fn il_rung(number: usize, marked: bool) -> String {
    let input = if marked { "X10".to_string() } else { format!("X{:o}", number % 128) };
    let (block, register) = (number / 4, number % 500);
    let counted = format!("INC D{}", block % 125 * 4 + 3);
    match number % 4 {
        0 if block < COILS => {
            format!("// Rung {number}: seal-in\nLD {input}\nOR M{block}\nANI X1\nOUT M{block}\n")
        }
        0 => format!("// Rung {number}: count\nLD {input}\nOR M3\nANI X1\n{counted}\n"),
        1 => {
            let output = if block < 128 { format!("OUT Y{block:o}") } else { counted };
            let latch = if block % 2 == 0 { "SET" } else { "RST" };
            let state = block / 2 % 450;
            format!("LD {input}\nLD M3\nOR M4\nANB\nMPS\nAND M5\n{output}\nMPP\nANI M6\n{latch} S{state}\n")
        }
        2 if block < 200 => format!("LD {input}\nOUT T{block} K{}\n", number % 1000 + 1),
        2 => format!("LD {input}\n{counted}\n"),
        _ => format!("LD> D{register} K{}\nAND T{}\nMOV K5 D{register}\n", number % 1000, block % 200),
    }
}

fn ladder_rung(number: usize, marked: bool) -> String {
    let input = if marked { "X10".to_string() } else { format!("X{:o}", number % 128) };
    let relay = if number < COILS { format!("M{number}") } else { format!("S{}", number - COILS) };
    let mut rung = format!("(* Rung {number} *)\n");
    rung += &format!("|   {input:<8}  X1                         {relay:<5}|\n");
    rung += "+---| |---+---|/|------------------------( )-+\n";
    rung += &format!("|   {relay:<6}|                                  |\n");
    rung += "+---| |---+                                  |\n\n";
    rung
}
