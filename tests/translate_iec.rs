//! Instruction list of IEC 61131-3 to drawings and back. What a list does is told by a small machine of its own, which
//! owes nothing to the translator.

use crate::corpus::say_skipped;
use proptest::prelude::*;
use rungwise::document::{Document, Notation};
use rungwise::ide::{self, Style};
use rungwise::target::{Model, Target};
use rungwise::text::Language;
use rungwise::translate::{Certificate, Options, Proof, To, Translated, Translation, prove, translate};
use std::collections::HashMap;
use std::path::Path;
use std::process::Command;

pub(crate) fn list(text: &str) -> Document {
    Document::new(text, Notation::IecIl, Target::of(Model::Iec))
}

pub(crate) fn drawing(text: &str) -> Document {
    Document::new(text, Notation::Ladder, Target::of(Model::Iec))
}

pub(crate) fn to(document: &Document, to: To) -> Translation {
    translate(document, None, to, &Options::default())
}

/// The text of a translation of which nothing is kept and everything is proved.
pub(crate) fn certain(document: &Document, form: To) -> String {
    let translation = to(document, form);
    for rung in &translation.rungs {
        let said = (rung.certificate, rung.note.as_ref().map(|note| note.key()));
        let is_certain = rung.certificate.is_some_and(Certificate::is_certain) && rung.note.is_none();
        assert!(is_certain, "{said:?}\n{}\n--\n{}", document.slice(rung.span), translation.text);
    }
    translation.text
}

/// A program with these variables and this body.
fn program(variables: &str, body: &str) -> String {
    format!("PROGRAM Test\nVAR\n{variables}\nEND_VAR\n{body}\nEND_PROGRAM\n")
}

const BITS: &str = "a, b, c, d, e : BOOL; x, y, z, w : BOOL; n, k : INT;";

/// The instructions of the body of a list, one a line with single blanks.
pub(crate) fn body(text: &str) -> Vec<String> {
    let from = text.rfind("END_VAR").map_or(0, |at| at + "END_VAR".len());
    let end = text.find("END_PROGRAM").unwrap_or(text.len());
    let lines = text[from..end].lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
    lines.filter(|line| !line.is_empty()).collect()
}

/// There, back, and there once more: the drawing and the list stay as they became.
fn round(text: &str) -> (String, String) {
    let drawn = certain(&list(text), To::Ladder);
    let back = certain(&drawing(&drawn), To::Iec);
    assert_eq!(certain(&list(&back), To::Ladder).replace(" : ", ":"), drawn_again(&drawn), "{back}");
    (drawn, back)
}

/// A drawing with the layout of declarations that a list gives them.
fn drawn_again(drawn: &str) -> String {
    let back = certain(&drawing(drawn), To::Iec);
    certain(&list(&back), To::Ladder).replace(" : ", ":")
}

/// The state of a program: bits as 0 and 1, and words.
pub(crate) type State = HashMap<String, i64>;

/// Runs the body of a list once.
pub(crate) fn scan(text: &str, state: &mut State) {
    let lines = body(text);
    let value = |state: &State, word: &str| match word {
        "TRUE" => 1,
        "FALSE" => 0,
        _ => word.parse().unwrap_or_else(|_| state.get(&word.to_lowercase()).copied().unwrap_or(0)),
    };
    let mut stack: Vec<(String, i64)> = Vec::new();
    let (mut current, mut at) = (0, 0);
    while let Some(line) = lines.get(at) {
        at += 1;
        let (word, operand) = line.split_once(' ').unwrap_or((line, ""));
        if let Some(operator) = word.strip_suffix('(') {
            stack.push((operator.to_string(), current));
            current = value(state, operand);
            continue;
        }
        let jump =
            |at: &mut usize| *at = lines.iter().position(|line| *line == format!("{operand}:")).unwrap();
        match word {
            "CAL" => {
                let instance = operand.trim_end_matches('(').to_lowercase();
                let clk = value(state, lines[at].trim_start_matches("CLK := "));
                at += 2;
                let before = state.insert(format!("{instance}.m"), clk).unwrap_or(0);
                let rising = instance.starts_with("rise");
                let edge = if rising { clk > before } else { clk < before };
                state.insert(format!("{instance}.q"), i64::from(edge));
            }
            ")" => {
                let (operator, before) = stack.pop().unwrap();
                current = combine(&operator, before, current);
            }
            "LD" => current = value(state, operand),
            "LDN" => current = 1 - value(state, operand),
            "NOT" => current = 1 - current,
            "ST" => _ = state.insert(operand.to_lowercase(), current),
            "STN" => _ = state.insert(operand.to_lowercase(), 1 - current),
            "S" if current == 1 => _ = state.insert(operand.to_lowercase(), 1),
            "R" if current == 1 => _ = state.insert(operand.to_lowercase(), 0),
            "S" | "R" => {}
            "JMP" => jump(&mut at),
            "JMPC" if current == 1 => jump(&mut at),
            "JMPCN" if current == 0 => jump(&mut at),
            "RET" => return,
            "RETC" if current == 1 => return,
            "RETCN" if current == 0 => return,
            "JMPC" | "JMPCN" | "RETC" | "RETCN" => {}
            label if label.ends_with(':') => {}
            operator => current = combine(operator, current, value(state, operand)),
        }
    }
}

/// What an operator makes of the current result and its operand.
pub(crate) fn combine(operator: &str, left: i64, right: i64) -> i64 {
    match operator {
        "AND" | "&" => left & right,
        "ANDN" => left & (1 - right),
        "OR" => left | right,
        "ORN" => left | (1 - right),
        "XOR" => left ^ right,
        "XORN" => left ^ (1 - right),
        "ADD" => left + right,
        "SUB" => left - right,
        "MUL" => left * right,
        "DIV" => left / right,
        "MOD" => left % right,
        "GT" => i64::from(left > right),
        "GE" => i64::from(left >= right),
        "EQ" => i64::from(left == right),
        "NE" => i64::from(left != right),
        "LE" => i64::from(left <= right),
        "LT" => i64::from(left < right),
        other => panic!("{other}"),
    }
}

/// Two lists do the same with the given variables, from all states of `inputs` and through some scans of changing ones.
fn same(one: &str, other: &str, inputs: &[&str], outputs: &[&str]) {
    let mut states = [State::new(), State::new()];
    for pattern in (0..1u32 << inputs.len()).chain((0..1 << inputs.len()).rev()) {
        for (text, state) in [one, other].into_iter().zip(&mut states) {
            for (number, input) in inputs.iter().enumerate() {
                state.insert(input.to_string(), i64::from(pattern >> number & 1));
            }
            scan(text, state);
        }
        for output in outputs {
            let [left, right] =
                [&states[0], &states[1]].map(|state| state.get(*output).copied().unwrap_or(0));
            assert_eq!(left, right, "{output} for {pattern:b}\n{one}\n--\n{other}");
        }
    }
}

const INPUTS: &[&str] = &["a", "b", "c", "d", "e"];
const OUTPUTS: &[&str] = &["x", "y", "z", "w"];

#[test]
fn conditions_go_there_and_back() {
    let text = program(BITS, "LD a\nOR( b\nANDN c\n)\nANDN d\nORN e\nST y\nAND b\nSTN z\nS w\nR x");
    let (drawn, back) = round(&text);
    same(&text, &back, INPUTS, OUTPUTS);
    assert_eq!(
        body(&back),
        ["LD a", "OR( b", "ANDN c", ")", "ANDN d", "ORN e", "ST y", "AND b", "STN z", "S w", "R x"],
        "{drawn}"
    );
}

#[test]
fn what_is_loaded_from_words_is_compared() {
    let text = program(BITS, "LD n\nGE 10\nAND a\nOR( k\nLT n\n)\nST y");
    let (drawn, back) = round(&text);
    assert!(drawn.contains("[>= n 10]") && drawn.contains("[< k n]"), "{drawn}");
    assert_eq!(body(&back), body(&text));
}

#[test]
fn exclusive_or_is_drawn_and_complements_are_moved_in() {
    let text = program(BITS, "LD a\nXOR( b\nAND c\n)\nXORN d\nST y\nLD a\nAND b\nNOT\nST z");
    let (_, back) = round(&text);
    same(&text, &back, INPUTS, OUTPUTS);
    assert!(body(&back).contains(&"NOT".to_string()) || body(&back).contains(&"STN z".to_string()), "{back}");
}

#[test]
fn jumps_returns_and_labels_keep_their_places() {
    let text = program(
        BITS,
        "LD a\nJMPC over\nLD b\nST y\nover:\nLD c\nRETCN\nLD d\nAND e\nJMPCN last\nLD b\nST z\nJMP last\nlast:\nLD b\nST w\nRET",
    );
    let (drawn, back) = round(&text);
    assert!(drawn.contains("over:\n|") && drawn.contains(">>last") && drawn.contains("<RETURN>"), "{drawn}");
    same(&text, &back, INPUTS, OUTPUTS);
}

#[test]
fn a_jump_between_outputs_is_kept_as_it_is() {
    for body in ["LD a\nJMPC over\nST y\nover:\nLD b\nST z", "LD a\nST y\nover:\nAND b\nST z"] {
        let translation = to(&list(&program(BITS, body)), To::Ladder);
        let kept = translation.rungs.first().unwrap();
        assert_eq!(
            kept.note.as_ref().map(|note| note.key()),
            Some("logic.not-boolean"),
            "{}",
            translation.text
        );
        assert!(translation.text.contains("{il\n"), "{}", translation.text);
        // And it comes back as it was.
        let back = to(&drawing(&translation.text), To::Iec).text;
        same(&program(BITS, body), &back, INPUTS, OUTPUTS);
    }
}

#[test]
fn what_is_kept_as_it_is_has_the_margin_of_the_page() {
    let text = "PROGRAM Main\nVAR w : INT; END_VAR\n    LD w\n    ADD(\n        LD 5\n    )\n    GT 3\n    JMPC out\nout:\nEND_PROGRAM\n";
    let drawn = to(&list(text), To::Ladder).text;
    let boxed = "{il\nLD w\nADD(\n    LD 5\n)\nGT 3\nJMPC out\n}\n";
    assert!(drawn.contains(boxed) && drawn.ends_with("END_PROGRAM\n"), "{drawn}");
    assert!(!drawn.ends_with("\n\n"), "{drawn:?}");
}

#[test]
fn detectors_of_edges_are_contacts() {
    let variables = format!("{BITS} up : R_TRIG; down : F_TRIG; Was1, Fall1 : BOOL;");
    let falls = "LD Was1\nANDN b\nST Fall1\nLD b\nST Was1\n";
    let text = format!("{falls}CAL up(\nCLK := a\n)\nLD up.Q\nAND c\nOR Fall1\nS y");
    let (drawn, back) = round(&program(&variables, &text));
    assert!(drawn.contains("|P|") && drawn.contains("|N|") && !drawn.contains("--(Was"), "{drawn}");
    assert_eq!(body(&back).join("\n"), text);
    // F_TRIG is on in its first call if its input is off, which no edge contact is.
    let (drawn, _) = round(&program(&variables, "CAL down(\nCLK := b\n)\nLD down.Q\nS y"));
    assert!(drawn.contains("F_TRIG") && !drawn.contains("|N|"), "{drawn}");
    // What the variables of a falling edge are, others may see, or a jump or the rung itself comes between.
    for other in [
        format!("{falls}LD Fall1\nST y\nLD Fall1\nST z"),
        format!("{falls}LD Fall1\nST y\nLD Was1\nST z"),
        format!("{falls}(* here *)\nLD Fall1\nST y"),
        format!("{falls}over:\nLD Fall1\nST y"),
        format!("{falls}LD c\nST b\nAND Fall1\nST y"),
        "LD Was1\nANDN b\nST Fall1\nLD c\nST Was1\nLD Fall1\nST y".to_string(),
        "LD Was1\nANDN b\nS Fall1\nLD b\nST Was1\nLD Fall1\nST y".to_string(),
    ] {
        let (drawn, back) = round(&program(&variables, &other));
        assert!(!drawn.contains("|N|"), "{other}\n{drawn}");
        let [other, back] = [other, back].map(|text| text.replace("(* here *)\n", ""));
        same(&program(&variables, &other), &back, INPUTS, &["y", "z", "b"]);
    }
    for kept in ["Was1 : BOOL := TRUE; Fall1 : BOOL;", "Was1 AT %MX0.0 : BOOL; Fall1 : BOOL;"] {
        let (drawn, _) = round(&program(&format!("{BITS} {kept}"), &format!("{falls}LD Fall1\nST y")));
        assert!(!drawn.contains("|N|"), "{kept}\n{drawn}");
    }
    // Who else asks for the output gets it from the block.
    let (drawn, back) = round(&program(&variables, "CAL up(\nCLK := a\n)\nLD up.Q\nST y\nLD up.Q\nST z"));
    assert!(drawn.contains("R_TRIG") && !drawn.contains("|P|"), "{drawn}");
    assert_eq!(body(&back), ["CAL up(", "CLK := a", ")", "LD up.Q", "ST y", "LD up.Q", "ST z"]);
}

#[test]
fn function_blocks_stand_on_the_power_line() {
    let variables = format!("{BITS} T1 : TON; C1 : CTU;");
    let text = program(
        &variables,
        "LD a\nAND b\nST T1.IN\nCAL T1(\nPT := T#5s\n)\nLD T1.Q\nANDN c\nST y\nCAL C1(\nCU := d,\nR := e,\nPV := 10,\nCV => n\n)\nLD C1.Q\nOR a\nST z",
    );
    let (drawn, back) = round(&text);
    assert!(drawn.contains("| TON  |") && drawn.contains("|IN   Q|") && drawn.contains("CV|--n"), "{drawn}");
    assert_eq!(body(&back), body(&text));
    // A box that is not the standard's, or is called otherwise, is kept.
    for call in ["CAL n(\nIN := a\n)", "CAL T1(\nIN := a,\nXX := b\n)"] {
        let translation = to(&list(&program(&variables, &format!("LD a\n{call}"))), To::Ladder);
        assert!(
            translation.text.contains(&format!("{{il\nLD a\n{call}\n}}")) || translation.text.contains(call),
            "{}",
            translation.text
        );
        assert!(translation.rungs.iter().any(|rung| rung.note.is_some()), "{call}");
    }
}

#[test]
fn power_that_is_wanted_again_is_loaded_again() {
    // A single contact that nothing changes is loaded once more.
    let text = "
|   a        b                 y |
+--| |---+--| |---------------( )+
|        |  c                  z |
|        +--| |---------------( )+
";
    let single = certain(&drawing(text), To::Iec);
    assert_eq!(body(&single), ["LD a", "AND b", "ST y", "LD a", "AND c", "ST z"]);
    assert!(!single.contains("Held"), "{single}");
    // One that is driven meanwhile, or more than one, is kept in a helper.
    let driven = text.replace("y |", "a |");
    let compared = text.replace("|   a     ", "|         ").replace("--| |---+--", "[> n 5]-+--");
    for (text, list) in [
        (driven, "LD a\nST Held1\nAND b\nST a\nLD Held1\nAND c\nST z"),
        (compared, "LD n\nGT 5\nST Held1\nAND b\nST y\nLD Held1\nAND c\nST z"),
    ] {
        let held = certain(&drawing(&text), To::Iec);
        assert_eq!(body(&held).join("\n"), list, "{text}");
        assert!(held.contains("Held1 : BOOL;"), "{held}");
    }
}

#[test]
fn a_drawing_without_declarations_gets_a_program() {
    let drawn = "
(* Seal-in *)
|   Start     Stop                                Motor |
+---| |---+---|/|---[> Level 300]----------------( )----+
|   Motor |                                             |
+---| |---+                                             |
";
    let written = certain(&drawing(drawn), To::Iec);
    for line in
        ["PROGRAM Main", "Start : BOOL;", "Stop  : BOOL;", "Motor : BOOL;", "Level : INT;", "(* Seal-in *)"]
    {
        assert!(written.contains(line), "{line}\n{written}");
    }
    assert!(written.trim_end().ends_with("END_PROGRAM"), "{written}");
    let found = problems(&written);
    assert!(found.is_empty(), "{found:?}\n{written}");
    assert_eq!(formatted(&list(&written)), written);
}

/// What the check has against a list.
fn problems(text: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("program.il");
    std::fs::write(&path, text).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_rungwise")).arg("check").arg(&path).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    said.lines()
        .filter(|line| line.contains("error") || line.contains("warning"))
        .map(str::to_string)
        .collect()
}

/// The document as `rungwise fmt` has it.
fn formatted(document: &Document) -> String {
    let style = Style { kind: Default::default(), width: 48 };
    let mut text = document.text();
    for edit in ide::format(document, style).into_iter().rev() {
        text.replace_range(edit.span.range(), &edit.text);
    }
    text
}

#[test]
fn a_hundred_thousand_parentheses_are_refused() {
    let deep = format!("LD a\n{}{}ST y", "AND( b\n".repeat(100_000), ")\n".repeat(100_000));
    let wide = format!("LD a\n{}ST y", "OR( b\nAND c\n)\n".repeat(20_000));
    let unclosed = format!("LD a\n{}ST y", "AND( b\n".repeat(100_000));
    for (body, note) in [(deep, Some("logic.too-deep")), (wide, None), (unclosed, Some("logic.unreadable"))] {
        let text = program(BITS, &body);
        let options = Options { proves: false, ..Options::default() };
        let translation = translate(&list(&text), None, To::Boolean, &options);
        let rung = translation.rungs.first().unwrap();
        assert_eq!(rung.note.as_ref().map(|note| note.key()), note);
    }
}

/// A list of random instructions, which may make sense or not.
fn instructions() -> impl Strategy<Value = Vec<String>> {
    let operand = prop::sample::select(vec!["a", "b", "c", "d", "e"]);
    let output = prop::sample::select(vec!["x", "y", "z", "w", "a"]);
    let word = prop::sample::select(vec![
        "LD", "LDN", "AND", "ANDN", "OR", "ORN", "XOR", "AND(", "OR(", "ANDN(", "ORN(",
    ]);
    let store = prop::sample::select(vec!["ST", "STN", "S", "R", "ST"]);
    let line = prop_oneof![
        5 => (word, operand).prop_map(|(word, operand)| format!("{word} {operand}")),
        3 => (store, output).prop_map(|(word, operand)| format!("{word} {operand}")),
        2 => Just(")".to_string()),
        1 => Just("NOT".to_string()),
    ];
    prop::collection::vec(line, 1..24)
}

/// The same with parentheses that pair, loads first and outputs last.
fn mended(lines: Vec<String>) -> String {
    let mut open = 0;
    let mut mended = vec!["LD a".to_string()];
    for line in lines {
        let stores = ["ST", "STN", "S ", "R "].iter().any(|word| line.starts_with(word));
        match line.as_str() {
            ")" if open == 0 => continue,
            ")" => open -= 1,
            _ if open > 0 && (stores || line.starts_with("LD")) => continue,
            line if line.contains('(') => open += 1,
            line if line.starts_with("LD") => mended.push("ST w".into()),
            _ => {}
        }
        mended.push(line);
    }
    mended.extend(std::iter::repeat_n(")".to_string(), open));
    mended.push("ST x".to_string());
    mended.join("\n")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(250))]

    #[test]
    fn lists_do_the_same_when_they_come_back(lines in instructions()) {
        let text = program(BITS, &mended(lines));
        let drawn = to(&list(&text), To::Ladder);
        for rung in &drawn.rungs {
            prop_assert!(rung.certificate.is_some_and(Certificate::is_certain), "{:?}\n{}\n{}", rung, text, drawn.text);
        }
        let back = to(&drawing(&drawn.text), To::Iec);
        for rung in &back.rungs {
            prop_assert!(rung.certificate.is_some_and(Certificate::is_certain), "{:?}\n{}\n{}", rung, drawn.text, back.text);
        }
        same(&text, &back.text, INPUTS, OUTPUTS);
        let again = to(&drawing(&to(&list(&back.text), To::Ladder).text), To::Iec);
        prop_assert_eq!(&again.text, &back.text);
        prop_assert_eq!(formatted(&list(&back.text)), back.text);
    }

    #[test]
    fn lists_of_any_words_come_to_an_end(lines in instructions()) {
        let text = lines.join("\n");
        for form in To::ALL {
            let translation = to(&list(&text), form);
            // Each line belongs to a rung; what closes nothing is but a mistake.
            let mut start = 0;
            for line in text.split_inclusive('\n') {
                let covers = |rung: &Translated| rung.span.touches(start) && !rung.span.is_empty();
                let is_told = line.trim() == ")" || translation.rungs.iter().any(covers);
                prop_assert!(is_told, "{:?} {}\n{}", form, line, text);
                start += line.len();
            }
        }
    }
}

#[test]
fn the_command_line_writes_iec() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("motor.lad");
    std::fs::write(&path, "|  Start        Motor |\n+--| |---------( )---+\n").unwrap();
    let output = translated(&path, "iec");
    assert!(output.contains("LD      Start\n    ST      Motor\n"), "{output}");
}

/// What `rungwise translate --prove` writes.
fn translated(path: &Path, form: &str) -> String {
    let program = env!("CARGO_BIN_EXE_rungwise");
    let output =
        Command::new(program).args(["translate", "--prove", "--to", form]).arg(path).output().unwrap();
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{complaint}");
    String::from_utf8(output.stdout).unwrap()
}

/// The program of an FX2N.
pub(crate) fn fx(text: &str) -> Document {
    Document::new(text, Notation::FxIl, Target::of(Model::Fx2n))
}

#[test]
fn devices_become_located_variables_and_back() {
    let text = "\
; motor
LD X12
OR Y12
ANI M20
OUT Y12
LD S20
AND>= D20 K-5
AND<> C0 H9
SET S21
LD Y12
OUT T0 K55
LD T0
OUT T200 K55
LDP X0
ORF T200
OUT C0 K10
LD X3
RST C0
LDI C0
PLS M7
LD X3
AND X4
PLF M8
LD X5
CJ P3
LDI X5
RST M9
P3
LD X6
OUT C1 K5
END
";
    let written = certain(&fx(text), To::Iec);
    for declaration in [
        "X12 AT %IX1.2",
        "Y12 AT %QX1.2",
        "M20 AT %MX2.4",
        "S20 AT %MX1102.4",
        "D20 AT %MW1020",
        "T0 ",
        "C0 ",
        "PLS_M7",
        "PLF_M8",
    ] {
        assert!(written.contains(declaration), "{declaration}\n{written}");
    }
    let lines = body(&written);
    for line in
        ["PT := T#5500ms", "PT := T#550ms", "PV := 10", "R C0", "EQ 10", "JMPC P3", "GE -5", "ST PLF_M8"]
    {
        let line = line.replace("EQ 10", "NE 9");
        assert!(lines.iter().any(|own| own.trim_end_matches(',') == line), "{line}\n{written}");
    }
    assert!(problems(&written).is_empty(), "{:?}\n{written}", problems(&written));
    let back = certain(&list(&written), To::Fx);
    assert_eq!(back, text.replace("; motor", "(* motor *)").replace("H9", "K9"));
    // And by way of a drawing of either language.
    let drawn = certain(&list(&written), To::Ladder);
    assert_eq!(certain(&drawing(&drawn), To::Fx), back);
    let own = certain(&fx(text), To::Ladder);
    let own = Document::new(&own, Notation::Ladder, Target::of(Model::Fx2n));
    assert_eq!(certain(&own, To::Iec), written);
}

#[test]
fn variables_are_devices_by_their_addresses() {
    let text = program(
        "Start AT %IX0.0 : BOOL; Lamp AT %QX1.0 : BOOL; Level AT %MW1007 : INT;",
        "LD Start\nANDN %MX0.3\nST Lamp\nLD Level\nGT 3\nS %QX0.1\nJMPC over\nLD TRUE\nST %MX1100.1\nover:\nLD FALSE\nST Lamp",
    );
    let written = certain(&list(&text), To::Fx);
    let expected =
        "LD X0\nANI M3\nOUT Y10\nLD> D7 K3\nSET Y1\nCJ P0\nLD M8000\nOUT S1\nP0\nLDI M8000\nOUT Y10\nEND\n";
    assert_eq!(written, expected);
}

/// The note of the first rung, in English.
fn note(translation: &Translation) -> String {
    translation.rungs[0].note.as_ref().map(|note| note.render(Language::English)).unwrap_or_default()
}

#[test]
fn what_has_no_counterpart_keeps_its_words() {
    for (rung, words, lack) in [
        ("LD X0\nOUT T246 K5", "OUT T246 K5", "T246"),
        ("LD X0\nMOVP K5 D0Z0", "MOVP K5 D0Z0", "D0Z0"),
        ("LD M8013\nOUT Y0", "LD M8013", "M8013"),
        ("LD X0\nBCD D0 D1", "BCD D0 D1", "BCD"),
        ("LDD>= D7999 K5\nOUT Y0", "LDD>= D7999 K5", "D7999"),
        ("STL S0\nOUT Y0", "STL S0", "STL"),
    ] {
        let translation = to(&fx(&format!("{rung}\nEND\n")), To::Iec);
        assert_eq!(
            note(&translation),
            format!("`{lack}` has no counterpart in the other language"),
            "{rung}"
        );
        assert_eq!(translation.rungs[0].certificate, Some(Certificate::Undecided));
        assert!(translation.text.contains(&format!("(* {words} *)")), "{}", translation.text);
        assert!(problems(&translation.text).is_empty(), "{}", translation.text);
    }
    for (rung, said, in_chinese) in [
        (
            "DMOV C0 D10",
            "`C0` as a number stops at its preset, where the value of a block counts on: beside a constant alone that is \
             the same",
            "`C0` 作为数值停在设定值，而功能块的值继续计数：只有与常数比较时两者相同",
        ),
        (
            "MUL K4 K5 D10",
            "`MUL` of two constants makes 32 bits, and in IEC 61131-3 a product has the type of its operands",
            "`MUL` 的两个常数之积为 32 位，而 IEC 61131-3 中积的类型与操作数相同",
        ),
    ] {
        let translation = to(&fx(&format!("LD X0\n{rung}\nEND\n")), To::Iec);
        assert_eq!(note(&translation), said);
        let note = translation.rungs[0].note.as_ref().expect("a note");
        assert_eq!(note.render(Language::SimplifiedChinese), in_chinese);
    }
    let wide = "D0 AT %MW1000 : INT; D4 AT %MD502 : DINT;";
    let translation = to(&list(&program(wide, "LD D0\nINT_TO_DINT\nMUL 70000\nST D4")), To::Fx);
    assert_eq!(note(&translation), "`70000` does not fit in 16 bits, with which the instruction calculates");
    for (body, lack) in [
        ("LD a\nST y", "a"),
        ("LD X0\nST T0.IN\nCAL T0(\nPT := T#50ms\n)", "T0 : TON"),
        ("LD X0\nRETC", "RET"),
        ("LD X0\nJMPC nowhere", "nowhere"),
        ("LD X0\nCALC T0(\nPT := T#5s\n)", "T0 : TON"),
    ] {
        let translation = to(&list(&program("a, y : BOOL; X0 AT %IX0.0 : BOOL; T0 : TON;", body)), To::Fx);
        assert_eq!(
            note(&translation),
            format!("`{lack}` has no counterpart in the other language"),
            "{body}"
        );
        let note = translation.rungs[0].note.as_ref().unwrap();
        let said = note.render(Language::SimplifiedChinese);
        assert_eq!(said, format!("`{lack}` 在另一种语言中没有对应物"), "{body}");
    }
}

#[test]
fn types_decide_how_words_compare() {
    let variables = "x AT %QX0.0 : BOOL; n, k : INT; D5 : REAL; i AT %MW1000 : INT; j AT %MW1001 : INT; \
                     u AT %MW1002 : UINT; v AT %MW1003 : UINT; w AT %MW1004 : WORD;";
    for (condition, expected) in [
        ("LD i\nGT j", "LD> D0 D1"),
        ("LD i\nLE -5", "LD<= D0 K-5"),
        ("LD u\nEQ v", "LD= D2 D3"),
        ("LD u\nNE 7", "LD<> D2 K7"),
        ("LD w\nEQ 7", "LD= D4 K7"),
    ] {
        let written = certain(&list(&program(variables, &format!("{condition}\nST x"))), To::Fx);
        assert_eq!(written, format!("{expected}\nOUT Y0\nEND\n"));
    }
    let order = |word: &str, kind: &str| {
        format!("`{word}` is of type {kind}, and the FX family compares words with a sign")
    };
    let other = |word: &str, kind: &str| {
        format!("`{word}` is of type {kind}, with which no instruction of 16 bits calculates")
    };
    for (condition, reason) in [
        ("LD u\nGT 5", order("u", "UINT")),
        ("LD 5\nLT v", order("v", "UINT")),
        ("LD u\nEQ -5", order("u", "UINT")),
        ("LD w\nGE 5", order("w", "WORD")),
        ("LD %MW1007\nGE 5", order("%MW1007", "WORD")),
        ("LD u\nEQ i", order("u", "UINT")),
        ("LD D5\nGT 5", other("D5", "REAL")),
    ] {
        let translation = to(&list(&program(variables, &format!("{condition}\nST x"))), To::Fx);
        assert_eq!(note(&translation), reason, "{condition}\n{}", translation.text);
        assert!(!translation.text.contains("OUT Y0\nEND"), "{}", translation.text);
    }
    // Sums are the same with and without a sign; other types have no instruction.
    let sum = |body: &str| to(&list(&program(variables, body)), To::Fx);
    assert_eq!(sum("LD u\nADD v\nST u").text, "LD M8000\nADD D2 D3 D2\nEND\n");
    assert_eq!(note(&sum("LD D5\nADD D5\nST D5")), other("D5", "REAL"));
}

#[test]
fn calculations_are_jumped_over_and_come_back() {
    let text = "\
LD X0
MOV K0 D0
MOV H0FF D1
OUT Y0
ADD D0 K1 D0
LD X1
OR X2
INC D0
ADDP D0 D1 D2
AND X3
SUB D2 D7 D2
RST D3
LD M8000
DEC D4
LDI X1
MOVP K-5 D0
END
";
    let written = certain(&fx(text), To::Iec);
    let lines = body(&written);
    let expected = "LD X0 | JMPCN Skip1 | LD INT#0 | ST D0 | LD 255 | ST D1 | Skip1: | LD X0 | ST Y0 | JMPCN Skip2 | \
                    LD D0 | ADD INT#1 | ST D0 | Skip2: | LD X1 | OR X2 | ST Held1 | JMPCN Skip3 | LD D0 | ADD 1 | ST D0 | \
                    Skip3: | LD Held1 | ST Pulse1.CLK | CAL Pulse1 | LD Pulse1.Q | JMPCN Skip4 | LD D0 | ADD D1 | ST D2 | \
                    Skip4: | LD Held1 | AND X3 | JMPCN Skip5 | LD D2 | SUB D7 | ST D2 | LD 0 | ST D3 | Skip5: | LD D4 | \
                    SUB 1 | ST D4 | LDN X1 | ST Pulse2.CLK | CAL Pulse2 | LD Pulse2.Q | JMPCN Skip6 | LD -5 | ST D0 | Skip6:";
    assert_eq!(lines.join(" | "), expected, "{written}");
    for declaration in ["D2 AT %MW1002 : INT;", "Pulse1 : R_TRIG;"] {
        let written = written.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(written.contains(declaration), "{declaration}\n{written}");
    }
    assert!(problems(&written).is_empty(), "{:?}\n{written}", problems(&written));
    assert_eq!(formatted(&list(&written)), written);
    let back = certain(&list(&written), To::Fx);
    assert!(matches!(prove(&fx(text), &fx(&back)), Proof::Equal { .. }), "{back}");
    let instructions = |text: &str| {
        let applied =
            text.lines().filter(|line| !line.starts_with(['L', 'O', 'A', 'M']) || line.starts_with("MOV"));
        applied.map(|line| line.replace("H0FF", "K255")).collect::<Vec<_>>()
    };
    assert_eq!(instructions(&back), instructions(text), "{back}");
    // By way of a drawing, in which they are boxes.
    let drawn = certain(&list(&written), To::Ladder);
    assert!(drawn.contains("MOVE") && drawn.contains("|EN   ENO|"), "{drawn}");
    assert_eq!(certain(&drawing(&drawn), To::Fx), back, "{drawn}");
    let again = body(&certain(&drawing(&drawn), To::Iec)).join(" | ");
    assert_eq!(again.replace("Held2", "Held1"), expected, "{drawn}");
}

#[test]
fn calculations_of_a_list_are_boxes() {
    let text = program(
        "a, b : BOOL; x, y : BOOL; n, k, m : INT; w AT %MW5 : WORD; v : WORD;",
        "LD n\nADD k\nST m\nLD w\nAND v\nST w\nLD a\nOR b\nJMPCN over\nLD n\nMOD 7\nST n\nover:\nLD b\nST y",
    );
    let (drawn, back) = round(&text);
    for word in ["ADD", "AND", "MOD", "IN1", "OUT"] {
        assert!(drawn.contains(word), "{word}\n{drawn}");
    }
    assert!(!drawn.contains("over"), "{drawn}");
    assert_eq!(body(&back).join("\n"), body(&text).join("\n").replace("over", "Skip1"), "{drawn}");
    // A label to which others jump stays one.
    let text = program(BITS, "LD c\nJMPC over\nLD a\nJMPCN over\nLD n\nST k\nover:\nLD b\nST y");
    let (drawn, back) = round(&text);
    assert!(drawn.contains("over:"), "{drawn}");
    same(&text, &back, INPUTS, &["k", "y"]);
    // What goes on behind its store, or is no single calculation, stays as it is.
    for kept in [
        "LD n\nADD k\nST m\nST n",
        "LD n\nADD k\nMUL n\nST m",
        "LD a\nJMPCN over\nLD n\nST k\nover:\nAND b\nST y",
    ] {
        let translation = to(&list(&program(BITS, &kept.replace("m", "w"))), To::Ladder);
        assert!(translation.rungs.iter().any(|rung| rung.note.is_some()), "{kept}\n{}", translation.text);
    }
}

#[test]
fn what_a_jump_skips_is_done_as_before() {
    for condition in ["LD a", "LDN a\nOR b", "LD a\nANDN b\nNOT", "LD a\nANDN b\nST w\nNOT"] {
        let text = program(
            BITS,
            &format!("{condition}\nST y\nJMPCN over\nLD n\nADD 1\nST n\nLD n\nST k\nover:\nLD n\nGT 3\nST z"),
        );
        let (_, back) = round(&text);
        same(&text, &back, INPUTS, &["y", "z", "n", "k"]);
    }
}

/// A random program of an FX2N, well formed.
pub(crate) fn fx_programs() -> impl Strategy<Value = String> {
    let bit = prop::sample::select(vec!["X0", "X1", "X17", "Y0", "M5", "S3", "T1", "C2"]);
    let contact = (prop::sample::select(vec!["LD", "LDI", "LDP", "LDF"]), bit)
        .prop_map(|(word, bit)| format!("{word} {bit}"));
    let compare = prop::sample::select(vec!["LD>= D0 K5", "LD<> C2 K3"]).prop_map(str::to_string);
    let load = prop_oneof![6 => contact, 1 => compare];
    let join = prop::sample::select(vec!["ANB", "ORB"]);
    let output = prop::sample::select(vec![
        "OUT Y0",
        "OUT M5",
        "SET Y1",
        "RST S3",
        "OUT T1 K30",
        "OUT C2 K4",
        "RST C2",
        "PLS M9",
        "PLF M10",
        "MOV K5 D0",
        "MOVP D1 D0",
        "ADD D0 D2 D1",
        "SUBP D0 K1 D0",
        "INC D0",
        "DECP D1",
        "RST D0",
        "INV\nOUT Y2",
    ]);
    let outputs = prop::collection::vec(output, 1..4);
    let rung = (load.clone(), prop::collection::vec((load, join), 0..5), outputs).prop_map(
        |(first, more, outputs)| {
            let more: String = more.iter().map(|(load, join)| format!("{load}\n{join}\n")).collect();
            format!("{first}\n{more}{}\n", outputs.join("\n"))
        },
    );
    prop::collection::vec(rung, 1..5).prop_map(|rungs| with_one_coil(&rungs.concat()) + "END\n")
}

/// The program with one coil of each timer and counter: two of them have no counterpart, and what resets a counter must
/// know its preset.
fn with_one_coil(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines() {
        let is_coil = ["OUT T1 K30", "OUT C2 K4"].contains(&line);
        let is_known = is_coil && lines.iter().any(|own| own == line);
        lines.push(if is_known { "OUT Y3".into() } else { line.into() });
    }
    if !lines.iter().any(|line| line == "OUT C2 K4") {
        lines.extend(["LD X1".into(), "OUT C2 K4".into()]);
    }
    lines.join("\n") + "\n"
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn fx_programs_go_to_iec_and_back(text in fx_programs()) {
        let written = certain(&fx(&text), To::Iec);
        let back = certain(&list(&written), To::Fx);
        let proof = prove(&fx(&text), &fx(&back));
        prop_assert!(matches!(proof, Proof::Equal { .. }), "{:?}\n{}\n{}\n{}", proof, text, written, back);
        prop_assert_eq!(formatted(&list(&written)), written);
    }
}

/// The rungs of programs by other people that stay as they are, with the reason; all others go there and back.
const KEPT: &[(&str, &[&str])] = &[
    // `dbg 1` prints the current result, and `jmpcn down` before it leaves it standing; `dbg x` behind a call as well.
    ("echidna-x-blink", &[THERE_NOT_BOOLEAN, THERE_NOT_BOOLEAN, BACK_NOT_BOOLEAN, BACK_NOT_BOOLEAN]),
    ("echidna-x-ctu", &[THERE_CALLEE, BACK_CALLEE]),
    ("echidna-x-fb", &[THERE_CALLEE, BACK_CALLEE]),
    ("echidna-x-rtc", &[THERE_CALLEE, BACK_CALLEE]),
    // XOR of a byte, and its conversion.
    ("echidna-x-tutorial-example1", &[THERE_NOT_BOOLEAN, BACK_NOT_BOOLEAN]),
    ("echidna-x-tutorial-example2", &[THERE_NOT_BOOLEAN, BACK_NOT_BOOLEAN]),
    ("echidna-x-tutorial-example3", &[THERE_NOT_BOOLEAN, BACK_NOT_BOOLEAN]),
    // RES of an LDmicro counter: a coil in the drawing, a call of the block in the list.
    ("ldmicrowebsim-test-0", &["there undecided translate.block-coil"]),
    // Open wires and prose, which the check reports.
    ("vdorr-negative-test01", &["there undecided logic.open-circuit"]),
    ("vdorr-readme", &["there undecided logic.unreadable", "there undecided logic.unreadable"]),
];
const THERE_NOT_BOOLEAN: &str = "there construction logic.not-boolean";
const BACK_NOT_BOOLEAN: &str = "back construction logic.not-boolean";
const THERE_CALLEE: &str = "there construction logic.callee";
const BACK_CALLEE: &str = "back construction logic.callee";

#[test]
fn programs_of_others_go_there_and_back() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = ["../shared/corpus", "../../shared/corpus"]
        .iter()
        .map(|place| root.join(place))
        .find(|at| at.exists());
    let Some(folder) = folder else { return say_skipped("no folder ../shared/corpus") };
    let mut kept = Vec::new();
    for (part, notation) in [("iec", Notation::IecIl), ("ladder", Notation::Ladder)] {
        let mut files: Vec<_> =
            std::fs::read_dir(folder.join(part)).unwrap().map(|file| file.unwrap().path()).collect();
        files.sort();
        for path in files {
            let text = std::fs::read_to_string(&path).unwrap();
            let text = &text[text.find('\n').unwrap() + 1..];
            let document = Document::new(text, notation, Target::of(Model::Iec));
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            kept.extend(there_and_back(&name, &document));
        }
    }
    let expected: Vec<String> = KEPT
        .iter()
        .flat_map(|(name, notes)| notes.iter().map(move |note| format!("{name}: {note}")))
        .collect();
    assert_eq!(kept, expected, "{kept:#?}");
}

/// What is not proved of a program on its way to the other form and back.
fn there_and_back(name: &str, document: &Document) -> Vec<String> {
    let other = if document.notation() == Notation::Ladder { To::Iec } else { To::Ladder };
    let first = to(document, other);
    let back = match other {
        To::Ladder => to(&drawing(&first.text), To::Iec),
        _ => to(&list(&first.text), To::Ladder),
    };
    let mut said = Vec::new();
    for (direction, translation) in [("there", &first), ("back", &back)] {
        for rung in &translation.rungs {
            let certificate = rung.certificate.map_or("none", Certificate::word);
            let note = rung.note.as_ref().map_or("", |note| note.key());
            if !note.is_empty() || certificate == "undecided" {
                said.push(format!("{name}: {direction} {certificate} {note}"));
            }
        }
    }
    // What is certified is proved of the programs as well.
    if said.is_empty() {
        let [there, again] = match other {
            To::Ladder => [drawing(&first.text), list(&back.text)],
            _ => [list(&first.text), drawing(&back.text)],
        };
        for (direction, made) in [("there", there), ("back", again)] {
            let proof = prove(document, &made);
            if !matches!(proof, Proof::Equal { .. }) {
                said.push(format!("{name}: {direction} {proof:?}"));
            }
        }
    }
    said
}

#[test]
fn a_coil_of_a_block_is_named() {
    let drawn = "\
| a                             C2 |
+-| |---------------------------(R)-+

|           C2                      |
|          +-----+                  |
| b        | CTU |               y  |
+-| |------|CU  Q|--------------( )-+
|       4--|PV   |                  |
|          +-----+                  |
";
    let translation = to(&drawing(drawn), To::Iec);
    let [reset, count] = &translation.rungs[..] else { panic!("{translation:?}") };
    assert!(translation.text.contains("R       C2\n"), "{}", translation.text);
    assert_eq!(reset.certificate, Some(Certificate::Undecided));
    let note = reset.note.as_ref().expect("a note").render(Language::English);
    assert!(note.contains("`C2` is a function block"), "{note}");
    assert!(count.note.is_none() && count.certificate.is_some_and(Certificate::is_certain));
}

#[test]
fn coils_of_edges_are_stores_of_detectors() {
    let drawn = "
|   a        b                 y |
+--| |--+---| |---------------(P)+
|       |    c                 z |
|       +---| |-----------+---(N)+
|                         |    w |
|                         +---( )+
";
    let written = certain(&drawing(drawn), To::Iec);
    let expected = [
        "LD a",
        "AND b",
        "ST PLS_y.CLK",
        "CAL PLS_y",
        "LD PLS_y.Q",
        "ST y",
        "LD a",
        "AND c",
        "ST PLF_z",
        "LD Was1",
        "ANDN PLF_z",
        "ST z",
        "LD PLF_z",
        "ST Was1",
        "ST w",
    ];
    assert_eq!(body(&written), expected, "{written}");
    assert!(written.contains("PLS_y : R_TRIG;") && written.contains("PLF_z : BOOL;"), "{written}");
    assert!(!written.contains("Fall"), "{written}");
    assert!(problems(&written).is_empty(), "{:?}\n{written}", problems(&written));
    let again = certain(&list(&written), To::Ladder);
    assert!(again.contains("(P)") && again.contains("(N)") && !again.contains("CLK"), "{again}");
    // The detectors that are declared already serve once more.
    assert_eq!(certain(&drawing(&again), To::Iec), written);
    // Two coils of one variable have a detector each, and on the FX family they are PLS and PLF.
    let text = "LD X0\nPLS M0\nLD X0\nAND X1\nPLF M1\nLD X2\nOR X3\nPLS M0\nEND\n";
    let written = certain(&fx(text), To::Iec);
    assert!(written.contains("CAL     PLS_M0_2"), "{written}");
    assert_eq!(certain(&list(&written), To::Fx), text, "{written}");
    let drawn = certain(&list(&written), To::Ladder);
    assert_eq!(drawn.matches("(P)").count(), 2, "{drawn}");
    assert_eq!(certain(&drawing(&drawn), To::Fx), text, "{drawn}");
}

#[test]
fn what_sees_more_of_a_detector_is_no_coil_of_an_edge() {
    let variables = format!("{BITS} PLS_y, Edge : R_TRIG;");
    for calls in [
        "LD a\nST PLS_y.CLK\nCAL PLS_y\nLD PLS_y.Q\nST y\nS z",
        "LD a\nST PLS_y.CLK\nCAL PLS_y\nLD PLS_y.Q\nST z",
        "LD a\nST PLS_y.CLK\nCAL PLS_y\nLDN PLS_y.Q\nST y",
        "LD a\nST PLS_y.CLK\nCAL PLS_y\nLD PLS_y.Q\nST y\nLD PLS_y.Q\nST z",
        "LD a\nST Edge.CLK\nCAL Edge\nLD Edge.Q\nST y",
    ] {
        let drawn = to(&list(&program(&variables, calls)), To::Ladder).text;
        assert!(drawn.contains("CLK") && !drawn.contains("(P)"), "{calls}\n{drawn}");
    }
}

#[test]
fn detectors_keep_their_names() {
    let variables = format!("{BITS} Edge, Other : R_TRIG; Drop : F_TRIG;");
    let text = program(
        &variables,
        "CAL Edge(\nCLK := a\n)\nLD Edge.Q\nST y\nCAL Other(\nCLK := b\n)\nCAL Drop(\nCLK := c\n)\nLD Other.Q\nAND Drop.Q\nS z",
    );
    let (drawn, back) = round(&text);
    assert!(drawn.contains("|P|") && !drawn.contains("Rise"), "{drawn}");
    assert_eq!(body(&back), body(&text), "{drawn}");
    assert!(!back.contains("Rise1") && !back.contains("Fall1"), "{back}");
    // What is used elsewhere is not taken, whether that can be read or not.
    let text =
        program(&variables, "CAL Edge(\nCLK := a\n)\nLD Edge.Q\nST y\nLD Other.M\nADD n\nMUL Drop\nST k");
    let drawn = to(&list(&text), To::Ladder).text;
    let more = drawn.replace("END_PROGRAM", "|  a      z |\n+--|P|---( )+\n\nEND_PROGRAM");
    let back = to(&drawing(&more), To::Iec).text;
    assert!(back.contains("Rise1 : R_TRIG;") && back.contains("CAL     Rise1("), "{back}");
}

#[test]
fn calls_under_a_condition_are_boxes_with_enable() {
    let variables = format!("{BITS} T1 : TON; C1 : CTU;");
    let text = program(
        &variables,
        "LD a\nCALC T1(\nIN := b,\nPT := T#5s\n)\nLD a\nANDN b\nCALCN C1(\nCU := c,\nPV := 10,\nCV => n\n)\nLD T1.Q\nST y\nCAL T1(\nPT := T#1s\n)\nLD T1.Q\nST z",
    );
    let (drawn, back) = round(&text);
    assert!(drawn.contains("|EN ENO|") || drawn.contains("|EN  ENO|"), "{drawn}");
    assert_eq!(body(&back), body(&text), "{drawn}");
    // EN as a parameter is the same condition; that of one contact inverted is its opposite.
    for (one, other) in [
        ("CAL T1(\nEN := a,\nIN := b\n)", "LD a\nCALC T1(\nIN := b\n)"),
        ("LD a\nCALCN T1", "LDN a\nCALC T1"),
    ] {
        let (_, back) = round(&program(&variables, one));
        assert_eq!(body(&back).join("\n"), other);
    }
    // The power of several is kept, for the call leaves no current result behind.
    let (drawn, back) = round(&program(&variables, "LD a\nOR b\nST Held1\nCALC T1\nLD Held1\nST y"));
    assert!(drawn.contains("( )"), "{drawn}");
    assert!(back.contains("CALC"), "{back}");
    for kept in ["LD a\nCALC T1\nST y", "LD a\nCALC T1(\nXX := b\n)", "LD a\nAND( b\nCALC T1\n)\nST y"] {
        let translation = to(&list(&program(&variables, kept)), To::Ladder);
        assert!(translation.rungs.iter().any(|rung| rung.note.is_some()), "{kept}\n{}", translation.text);
    }
}

#[test]
fn a_call_without_its_condition_changes_nothing() {
    let one = |body: &str| list(&program(&format!("{BITS} T1 : TON;"), body));
    let base = "LD a\nCALC T1(\nIN := b\n)\nLD T1.Q\nST y";
    assert!(matches!(prove(&one(base), &one(base)), Proof::Equal { .. }));
    for other in [
        base.replace("CALC", "CALCN"),
        base.replace("LD a", "LD c"),
        base.replace("IN := b", "IN := c"),
        base.replace("LD a\nCALC", "CAL"),
        base.replace("LD a\nCALC T1(\nIN := b\n)", "CAL T1(\nIN := a\n)"),
    ] {
        assert!(!matches!(prove(&one(base), &one(&other)), Proof::Equal { .. }), "{other}");
    }
    // What would be a difference only if a call without power changed its output is none.
    let idle = "LD T1.Q\nST w\nLD a\nANDN a\nCALC T1(\nIN := b\n)\nLD T1.Q\nST y";
    let proof = prove(&one(idle), &one(&idle.replace("LD T1.Q\nST y", "LD w\nST y")));
    assert!(!matches!(proof, Proof::Different(_)), "{proof:?}");
    let proof = prove(&one(idle), &one(&idle.replace("LD T1.Q\nST y", "LDN w\nST y")));
    assert!(!matches!(proof, Proof::Equal { .. }), "{proof:?}");
}

#[test]
fn what_depends_on_a_rung_that_is_kept_is_kept_with_it() {
    for (text, translated) in [
        ("LD X0\nMC N0 M100\nLD X1\nOUT Y0\nMCR N0\nLD X2\nOUT Y1\nEND\n", &["Y1"][..]),
        ("FOR K3\nLD X3\nOUT Y2\nNEXT\nLD X2\nOUT Y1\nEND\n", &["Y1"]),
        ("LD X7\nOUT Y7\nFEND\nP1\nLD X5\nOUT Y3\nSRET\nEND\n", &["Y7"]),
        ("LD T250\nCJ P1\nLD X5\nOUT Y3\nP1\nLD X2\nOUT Y1\nEND\n", &["Y1"]),
        // A jump that is translated, or leads back, leaves the others to themselves.
        ("LD X0\nCJ P1\nLD X5\nOUT Y3\nP1\nLD X2\nOUT Y1\nEND\n", &["Y3", "Y1"]),
        ("P1\nLD X5\nOUT Y3\nLD T250\nCJ P1\nLD X2\nOUT Y1\nEND\n", &["Y3", "Y1"]),
    ] {
        let iec = to(&fx(text), To::Iec).text;
        let stores = iec.lines().filter_map(|line| line.trim().strip_prefix("ST "));
        assert_eq!(stores.map(str::trim).collect::<Vec<_>>(), translated, "{iec}");
    }
    // A detector of its own has no counterpart, so its jump has none.
    let jump = "LD a\nST R.CLK\nCAL R\nLD R.Q\nJMPCN L\nLD b\nST y\nL:\nLD c\nST z\n";
    let variables = "a AT %IX0.0, b AT %IX0.1, c AT %IX0.2, y AT %QX0.0, z AT %QX0.1 : BOOL; R : R_TRIG;";
    let variables = variables.replace(", ", " : BOOL; ");
    let translation =
        to(&list(&format!("PROGRAM P\nVAR\n{variables}\nEND_VAR\n{jump}END_PROGRAM\n")), To::Fx);
    assert!(
        !translation.text.contains("OUT Y0") && translation.text.contains("OUT Y1"),
        "{}",
        translation.text
    );
    let notes: Vec<&str> =
        translation.rungs.iter().filter_map(|rung| rung.note.as_ref()).map(|note| note.key()).collect();
    assert_eq!(notes, ["translate.no-counterpart", "translate.guarded"]);
}

/// Whether the writer or the converter has no words for a jump, what it may leave out is not done in each scan.
#[test]
fn what_a_kept_rung_may_leave_out_is_kept_with_it() {
    for text in [
        "LD X0\nCJ P1\nAND X1\nOUT Y0\nLD X2\nOUT Y1\nP1\nLD X3\nOUT Y2\nEND\n",
        "LD X0\nCJ P63\nAND X1\nOUT Y0\nLD X2\nOUT Y1\nLD X3\nOUT Y2\nEND\n",
    ] {
        let document = Document::new(text, Notation::FxIl, Target::of(Model::Fx3u));
        let written = translate(&document, None, To::Iec, &Options::default());
        let stores: Vec<&str> =
            written.text.lines().map(str::trim).filter(|line| line.starts_with("ST ")).collect();
        let expected: &[&str] = if text.contains("P63") { &[] } else { &["ST      Y2"] };
        assert_eq!(stores, expected, "{}", written.text);
        assert_eq!(written.rungs[1].note.as_ref().map(|note| note.key()), Some("translate.guarded"));
    }
}
