//! Pins of calls, in lists as in drawn boxes: instances in arrays, and what is handed over to be changed.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};

/// A block that changes `Total`, one input of which is a bit, and a function that changes its only operand.
const UNITS: &str = "\
FUNCTION_BLOCK Pump
VAR_INPUT
    Run : BOOL;
END_VAR
VAR_IN_OUT
    Total : INT;
    Full : BOOL;
END_VAR
VAR_OUTPUT
    Alarm : BOOL;
END_VAR
    LD Run
    AND Full
    ST Alarm
    LD Total
    ADD 1
    ST Total
END_FUNCTION_BLOCK
";

const VARIABLES: &str = "\
VAR
    a, f, y : BOOL;
    t : INT;
    ts : ARRAY [1..3] OF INT;
    Timer : TON;
    Counter : CTU;
    P : Pump;
    bs : ARRAY [1..2] OF TON;
    ps : ARRAY [1..2] OF Pump;
END_VAR
VAR CONSTANT
    Most : INT := 5;
END_VAR
";

/// `code words` of each finding of a program that is graded as an error.
fn told(body: &str, notation: Notation) -> Vec<String> {
    let units = match notation {
        Notation::Ladder => {
            UNITS.replace("    LD Run", "{il\n    LD Run").replace("END_FUNCTION", "}\nEND_FUNCTION")
        }
        _ => UNITS.to_string(),
    };
    let text = format!("{units}\nPROGRAM Main\n{VARIABLES}\n{body}\nEND_PROGRAM\n");
    let document = Document::new(&text, notation, Target::of(Model::Iec));
    let found = check::all(&document, &Severities::default());
    let errors = found.iter().filter(|one| one.severity == rungwise::text::Severity::Error);
    errors.map(|one| format!("{} {}", one.code, one.span.of(&text))).collect()
}

fn drawn(body: &str) -> Vec<String> {
    told(body, Notation::Ladder)
}

fn listed(body: &str) -> Vec<String> {
    told(body, Notation::IecIl)
}

/// A rung with a timer called `instance`, with its preset at the pin `pin`.
fn timer(instance: &str, pin: &str) -> String {
    format!(
        "
|              {instance:6}                    |
|            +----------+                |
|    a       |   TON    |           y    |
+---| |------|IN       Q|----------( )---+
|    T#5s----|{pin:4}      |                |
|            +----------+                |
"
    )
}

/// A rung with a pump called `instance` that is handed over `total` and `full`.
fn pump(instance: &str, total: &str, full: &str) -> String {
    format!(
        "
|              {instance:6}                    |
|            +----------+                |
|    a       |   Pump   |           y    |
+---| |------|Run  Alarm|----------( )---+
|{total:>9}---|Total     |                |
|{full:>9}---|Full      |                |
|            +----------+                |
"
    )
}

#[test]
fn an_element_of_an_array_of_instances_is_declared() {
    assert_eq!(drawn(&timer("Timer", "PT")), Vec::<String>::new());
    assert_eq!(drawn(&timer("bs[1]", "PT")), Vec::<String>::new());
    assert_eq!(drawn(&pump("ps[2]", "t", "f")), Vec::<String>::new());
    // Its pins are those of the block.
    assert_eq!(drawn(&timer("bs[1]", "PX")), ["unknown-parameter PX"]);
    // An array that nobody declares is told by its name alone.
    assert_eq!(drawn(&timer("cs[1]", "PT")), ["undeclared-variable cs"]);
}

#[test]
fn the_array_of_drawn_instances_is_in_use() {
    let text = format!("PROGRAM Main\n{VARIABLES}\n{}\nEND_PROGRAM\n", timer("bs[1]", "PT"));
    let document = Document::new(&text, Notation::Ladder, Target::of(Model::Iec));
    let found = check::all(&document, &Severities::default());
    let unused = found.iter().filter(|one| one.code == "unused-variable");
    let unused: Vec<&str> = unused.map(|one| one.span.of(&text)).collect();
    assert!(unused.contains(&"ps") && !unused.contains(&"bs"), "{unused:?}");
}

#[test]
fn what_a_drawn_box_is_to_change_is_a_variable() {
    for (total, full, expected) in [
        ("t", "f", vec![]),
        ("t", "y", vec![]),
        ("5", "f", vec!["operand-kind 5"]),
        ("16#1F", "f", vec!["operand-kind 16#1F"]),
        ("t", "TRUE", vec!["operand-kind TRUE"]),
        ("Most", "f", vec!["constant-written Most"]),
        ("t", "Timer.Q", vec!["constant-written Timer.Q"]),
        ("t", "Timer.IN", vec![]),
        ("Most", "FALSE", vec!["constant-written Most", "operand-kind FALSE"]),
    ] {
        for instance in ["P", "ps[1]"] {
            assert_eq!(drawn(&pump(instance, total, full)), expected, "{instance} {total} {full}");
        }
    }
    // An inverted value is no variable, nor is power.
    let inverted = pump("P", "t", "f").replace("--|Full", "-O|Full");
    assert!(inverted.contains("-O|Full"), "{inverted}");
    assert_eq!(drawn(&inverted), ["operand-kind Full"]);
}

#[test]
fn what_an_output_of_a_drawn_box_is_written_to_is_a_variable() {
    let counter = |out: &str| {
        format!(
            "
|             Counter                    |
|            +----------+                |
|    a       |   CTU    |           y    |
+---| |------|CU       Q|----------( )---+
|         f--|R       CV|--{out:14}|
|         3--|PV        |                |
|            +----------+                |
"
        )
    };
    assert_eq!(drawn(&counter("t")), Vec::<String>::new());
    assert_eq!(drawn(&counter("5")), ["operand-kind 5"]);
    assert_eq!(drawn(&counter("Most")), ["constant-written Most"]);
}

#[test]
fn what_a_call_in_a_list_is_to_change_is_a_variable() {
    for (call, expected) in [
        ("CAL P(\nRun := a,\nTotal := t,\nFull := f\n)", vec![]),
        ("CAL ps[1](\nRun := a,\nTotal := ts[1],\nFull := f\n)", vec![]),
        ("CAL P(\nRun := a,\nTotal := 5,\nFull := f\n)", vec!["operand-kind 5"]),
        (
            "CAL P(\nRun := a,\nTotal := Most,\nFull := Timer.Q\n)",
            vec!["constant-written Most", "constant-written Timer.Q"],
        ),
        ("CAL P(a, Most, f)", vec!["constant-written Most"]),
        ("CAL P(a, 5, f)", vec!["operand-kind 5"]),
        ("CAL P(\nRun := a,\nTotal := (\nLD t\nADD 1\n),\nFull := f\n)", vec!["operand-kind Total"]),
        ("CAL P(\nRun := (\nLD a\nANDN f\n),\nTotal := t,\nFull := f\n)", vec![]),
    ] {
        assert_eq!(listed(call), expected, "{call}");
    }
}

#[test]
fn the_current_result_is_no_variable_unless_it_was_just_loaded() {
    let function = |body: &str| {
        let units = "FUNCTION Bump : INT\nVAR_IN_OUT\n Own : INT;\nEND_VAR\nVAR_INPUT\n By : INT;\nEND_VAR\n\
             LD Own\nADD By\nST Own\nST Bump\nEND_FUNCTION\n";
        let text = format!("{units}\nPROGRAM Main\nVAR\n t : INT;\nEND_VAR\n{body}\nST t\nEND_PROGRAM\n");
        let document = Document::new(&text, Notation::IecIl, Target::of(Model::Iec));
        let found = check::all(&document, &Severities::default());
        let errors = found.iter().filter(|one| one.severity == rungwise::text::Severity::Error);
        errors.map(|one| format!("{} {}", one.code, one.span.of(&text))).collect::<Vec<_>>()
    };
    assert_eq!(function("LD t\nBump 5"), Vec::<String>::new());
    assert_eq!(function("LD 7\nBump 5"), ["operand-kind 7"]);
    assert_eq!(function("LD t\nADD 1\nBump 5"), ["operand-kind ADD 1"]);
}

#[test]
fn a_coil_writes_its_variable() {
    let text = |section: &str| {
        format!(
            "PROGRAM p\nVAR {section}\n k : BOOL := TRUE;\nEND_VAR\nVAR\n a : BOOL;\nEND_VAR\n\n\
             |    a        k   |\n+---| |------( )--+\n\n|    k        a   |\n+---| |------(S)--+\n\nEND_PROGRAM\n"
        )
    };
    for (section, expected) in [("CONSTANT", 1), ("", 0)] {
        let folder = crate::binary::folder(&[("main.lad", &text(section))]);
        let (_, out, _) = crate::binary::run(&folder, &["check", "main.lad", "--lang", "en"]);
        assert_eq!(out.matches("error[constant-written]").count(), expected, "{out}");
        assert_eq!(out.contains("main.lad:9:15"), expected == 1, "{out}");
    }
}
