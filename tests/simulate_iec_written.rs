//! The reason for a value of an IEC 61131-3 program is the instruction that wrote it last, whatever stands before that.

use crate::binary::{folder, run};
use crate::simulate_iec::document;
use rungwise::document::{Document, Notation};
use rungwise::simulate::{Drivers, Inquiry, Place, Session, Value, compile};
use rungwise::text::Language;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

const MS: i64 = 1_000_000;

/// The answer to a question behind the last of five scans.
fn why(program: &str, settings: &[&str], name: &str) -> String {
    let folder = folder(&[("main.il", program)]);
    let mut arguments = vec!["run", "main.il", "--watch", name, "--scans", "5", "--why", name];
    settings.iter().for_each(|setting| arguments.extend(["--set", *setting]));
    let (code, out, err) = run(&folder, &arguments);
    assert_eq!((code, err.as_str()), (0, ""));
    out.split_once("\n\n").map(|(_, told)| told.to_string()).unwrap_or(out)
}

fn motor(declared: &str, body: &str) -> String {
    format!("PROGRAM Main\nVAR\ngo, Motor : BOOL; {declared}\nEND_VAR\nLD go\nS Motor\n{body}END_PROGRAM\n")
}

#[test]
fn a_reset_behind_a_calculation_is_the_reason_with_what_it_has_read() {
    let told = |declared, body| why(&motor(declared, body), &["go=1"], "Motor");
    assert_eq!(
        told("w : WORD := 16#3;", "LD w\nAND 16#1\nWORD_TO_BOOL\nR Motor\n"),
        "\
Motor is off: R Motor has power  [main.il:10]
  this is calculated: LD w, AND 16#1, WORD_TO_BOOL  [main.il:7]
    w is 3: nothing drives it  [main.il:7]
"
    );
    assert_eq!(
        told("n : INT := 101;", "GT(n, 100)\nR Motor\n"),
        "\
Motor is off: R Motor has power  [main.il:8]
  this is calculated: GT(n, 100)  [main.il:7]
    n is 101: nothing drives it  [main.il:7]
"
    );
    // One without power is not the reason, and one behind it is.
    assert_eq!(
        told("n : INT := 7;", "GT(n, 100)\nR Motor\n"),
        "Motor is on: S Motor has power  [main.il:6]\n  go is on since scan 0 (0 ms): it was set by hand  [main.il:5]\n"
    );
    assert_eq!(
        told("n : INT := 7; i : INT;", "LD n\nADD 1\nGT 7\nSTN Motor\n"),
        "\
Motor is off: STN Motor is executed  [main.il:10]
  this is calculated: LD n, ADD 1, GT 7  [main.il:7]
    n is 7: nothing drives it  [main.il:7]
"
    );
}

#[test]
fn what_has_not_written_yet_is_named_also_behind_a_calculation() {
    let program = "PROGRAM Main\nVAR\nMotor : BOOL; n : INT;\nEND_VAR\nGT(n, 100)\nS Motor\nEND_PROGRAM\n";
    assert_eq!(
        why(program, &[], "Motor"),
        "\
Motor is off: nothing that drives it has done so yet
  S Motor has no power  [main.il:6]
    this is calculated: GT(n, 100)  [main.il:5]
      n is 0: nothing drives it  [main.il:5]
"
    );
}

#[test]
fn elements_whose_number_is_known_at_run_time_have_reasons() {
    let program = "PROGRAM Main\nVAR\ni : INT := 2; n : INT; a : ARRAY[0..3] OF INT;\nEND_VAR\n\
        LD n\nADD 1\nST n\nLD n\nST a[i]\nLD 5\nST a[1]\nEND_PROGRAM\n";
    assert_eq!(
        why(program, &[], "a[2]"),
        "\
a[2] is 5: LD n, ST a[i] is executed  [main.il:8]
  n is 5: LD n, ADD 1, ST n is executed  [main.il:5]
"
    );
    assert_eq!(
        why(program, &[], "a[3]"),
        "a[3] is 0: nothing that drives it has done so yet\n  LD n, ST a[i] is executed  [main.il:8]\n"
    );
}

#[test]
fn drawn_coils_and_boxes_whose_element_is_known_at_run_time_are_followed() {
    let program = "PROGRAM Main\nVAR\ngo : BOOL; i : INT := 2; lit : ARRAY[1..3] OF BOOL;\nEND_VAR\n\n\
        |  go             lit[i] |\n+---| |-------------( )--+\n\nEND_PROGRAM\n";
    let folder = folder(&[("main.lad", program)]);
    let asked = ["run", "main.lad", "--watch", "go", "--scans", "3", "--set", "go=1", "--why", "lit[2]"];
    let (code, out, err) = run(&folder, &asked);
    assert_eq!((code, err.as_str()), (0, ""));
    let expected = "lit[2] is on: ( ) lit[i] has power  [main.lad:7]\n  \
        go is on since scan 0 (0 ms): it was set by hand  [main.lad:7]\n";
    assert!(out.ends_with(expected), "{out}");
}

#[test]
fn a_variable_that_is_handed_over_to_be_changed_was_changed_by_who_did() {
    let program = "FUNCTION_BLOCK Bump\nVAR_IN_OUT\nx : INT;\nEND_VAR\nVAR_INPUT\nby : INT;\nEND_VAR\n\
        LD x\nADD by\nST x\nEND_FUNCTION_BLOCK\n\
        FUNCTION_BLOCK Look\nVAR_IN_OUT\nx : INT;\nEND_VAR\nVAR\ny : INT;\nEND_VAR\nLD x\nST y\nEND_FUNCTION_BLOCK\n\
        PROGRAM Main\nVAR\ntotal : INT; a : Bump; b : Look;\nEND_VAR\nCAL a(x := total, by := 3)\nCAL b(x := total)\n\
        END_PROGRAM\n";
    assert_eq!(
        why(program, &[], "total"),
        "\
total is 15: LD x, ADD by, ST x is executed  [main.il:8]
  a.by is 3: CAL a(x := total, by := 3) is executed  [main.il:26]
"
    );
}

#[test]
fn an_instruction_with_lists_among_its_parameters_is_one_instruction() {
    let program = "FUNCTION_BLOCK Keep\nVAR_INPUT\nx : BOOL;\nEND_VAR\nVAR_OUTPUT\ny : BOOL;\nEND_VAR\n\
        LD x\nST y\nEND_FUNCTION_BLOCK\nPROGRAM Main\nVAR\ngo, lit : BOOL; n : INT := 5; k : Keep;\nEND_VAR\n\
        LD go\nST lit\nCAL k(\nx := (\nLD n\nADD 1\nGT 5\n),\ny => lit\n)\nEND_PROGRAM\n";
    let told = why(program, &[], "lit");
    assert!(told.starts_with("lit is on: CAL k( is executed  [main.il:17]\n"), "{told}");
    let told = why(program, &[], "k.x");
    assert!(told.starts_with("k.x is on: CAL k( is executed  [main.il:17]\n"), "{told}");
}

#[test]
fn what_a_configuration_connects_is_followed_through_the_program() {
    let program = "CONFIGURATION Plant\nVAR_GLOBAL\nstart AT %IX0.0 : BOOL; lamp : BOOL;\nEND_VAR\nRESOURCE R ON PLC\n\
        TASK T(INTERVAL := T#10ms, PRIORITY := 1);\nPROGRAM P WITH T : Main(go := start, out => lamp);\nEND_RESOURCE\n\
        END_CONFIGURATION\nPROGRAM Main\nVAR_INPUT\ngo : BOOL;\nEND_VAR\nVAR_OUTPUT\nout : BOOL;\nEND_VAR\n\
        LD go\nST out\nEND_PROGRAM\n";
    assert_eq!(
        why(program, &["start=1"], "lamp"),
        "\
lamp is on: PROGRAM P WITH T : Main(go := start, out => lamp) is executed  [main.il:7]
  out is on: ST out has power  [main.il:18]
    go is on: PROGRAM P WITH T : Main(go := start, out => lamp) is executed  [main.il:17]
      start is on since scan 0 (0 ms): it was set by hand
"
    );
}

/// What is known of the PLC of a test: a relay by its name.
type Bits = BTreeMap<&'static str, bool>;

/// What a condition is.
type Holds = fn(&Bits) -> bool;

/// Conditions with what they are while `w` is 16#3 and `n` is 101.
const CONDITIONS: [(&str, Holds); 10] = [
    ("LD a\n", |bits| bits["a"]),
    ("LD a\nANDN b\n", |bits| bits["a"] && !bits["b"]),
    ("LD Motor\nOR b\n", |bits| bits["Motor"] || bits["b"]),
    ("LDN Lamp\n", |bits| !bits["Lamp"]),
    ("LD w\nAND 16#1\nWORD_TO_BOOL\n", |_| true),
    ("LD w\nAND 16#4\nWORD_TO_BOOL\n", |_| false),
    ("GT(n, 100)\n", |_| true),
    ("LD n\nADD 5\nLT 100\n", |_| false),
    ("SEL(a, Lamp, Motor)\n", |bits| if bits["a"] { bits["Motor"] } else { bits["Lamp"] }),
    ("LD a\nXOR b\n", |bits| bits["a"] != bits["b"]),
];

#[test]
fn the_last_write_is_the_reason_in_programs_of_all_kinds() {
    let mut dice = fastrand::Rng::with_seed(7);
    for _ in 0..60 {
        let mut text = String::from(
            "PROGRAM Main\nVAR\na, b, Motor, Lamp : BOOL;\nw : WORD := 16#3; n : INT := 101;\nEND_VAR\n",
        );
        // What each rung does: its number of rungs to leave out, its condition, and its outputs with their lines.
        let mut rungs = Vec::new();
        for number in 0..6_usize {
            let (words, holds) = CONDITIONS[dice.usize(..CONDITIONS.len())];
            text += words;
            if dice.usize(..4) == 0 {
                let _ = writeln!(text, "JMPC L{number}");
                rungs.push((Some(number), holds, Vec::new()));
            } else {
                let outputs: Vec<(&str, &str, usize)> = (0..=dice.usize(..2))
                    .map(|_| {
                        let (word, name) =
                            (["ST", "STN", "S", "R"][dice.usize(..4)], ["Motor", "Lamp"][dice.usize(..2)]);
                        let _ = writeln!(text, "{word} {name}");
                        (word, name, text.lines().count())
                    })
                    .collect();
                rungs.push((None, holds, outputs));
            }
            // A jump leaves the next rung out.
            if let Some((Some(label), ..)) = number.checked_sub(1).and_then(|before| rungs.get(before)) {
                let _ = writeln!(text, "L{label}:");
            }
        }
        let _ = writeln!(text, "LD a\nL5:\nEND_PROGRAM");
        let source = document(&text, Notation::IecIl);
        let documents: [&Document; 1] = [&source];
        let code =
            Arc::new(compile(&documents, false).unwrap_or_else(|problems| panic!("{text}{problems:?}")));
        let (watched, drivers) = (Arc::new(compile(&documents, true).unwrap()), Drivers::of(&documents));
        let mut session = Session::new(Arc::clone(&code));
        let mut bits = Bits::from([("a", false), ("b", false), ("Motor", false), ("Lamp", false)]);
        for scan in 0..4 {
            for name in ["a", "b"] {
                bits.insert(name, dice.bool());
                let variable = code.variable(name).unwrap();
                session.touch(variable.set(&code, &Value::Bit(bits[name])).unwrap());
            }
            session.scan(scan * 10 * MS);
            let mut last: BTreeMap<&str, (&str, usize)> = BTreeMap::new();
            let mut at = 0;
            while let Some((jump, holds, outputs)) = rungs.get(at) {
                let on = holds(&bits);
                for (word, name, line) in outputs {
                    let value = match *word {
                        "ST" => Some(on),
                        "STN" => Some(!on),
                        "S" => on.then_some(true),
                        _ => on.then_some(false),
                    };
                    if let Some(value) = value {
                        bits.insert(name, value);
                        last.insert(name, (word, *line));
                    }
                }
                at += if jump.is_some() && on { 2 } else { 1 };
            }
            let inquiry = Inquiry::new(&session, &watched, &documents, &drivers);
            for (name, (word, line)) in last {
                let reason = inquiry.why(name, None).unwrap();
                let told = reason.told(Language::English, |place: Place| {
                    (source.line_of(place.span.start as usize) + 1).to_string()
                });
                let first = told.lines().next().unwrap();
                let state = if bits[name] { "on" } else { "off" };
                let expected = format!("{name} is {state}: {word} {name} ");
                assert!(
                    first.starts_with(&expected) && first.ends_with(&format!("[{line}]")),
                    "{text}{told}"
                );
            }
        }
    }
}
