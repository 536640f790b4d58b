//! Outputs that are never or always on because of other rungs: what is told, and what is left alone.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Language};

fn found(text: &str) -> Vec<Diagnostic> {
    let notation = if text.contains('|') { Notation::Ladder } else { Notation::FxIl };
    let document = Document::new(text, notation, Target::of(Model::Fx2n));
    let mut found = check::all(&document, &Severities::default());
    found.retain(|one| matches!(one.code, "never-energised" | "always-energised"));
    found
}

/// `code output` of each finding in a list, whose lines are parted by `; `.
fn told(program: &str) -> Vec<String> {
    let text = format!("{}\nEND\n", program.replace("; ", "\n"));
    found(&text).iter().map(|one| format!("{} {}", &one.code[..5], one.span.of(&text))).collect()
}

#[test]
fn what_other_rungs_exclude_is_told() {
    let programs: &[(&str, &[&str])] = &[
        // A relay that is never on, and whatever needs it: below, above, and in a chain.
        ("LD X0; ANI X0; OUT M0; LD M0; OUT Y0", &["never M0", "never Y0"]),
        ("LD M0; OUT Y0; LD X0; ANI X0; OUT M0", &["never Y0", "never M0"]),
        (
            "LD X0; ANI X0; OUT M0; LD M0; AND X1; OUT M1; LD M1; OUT Y1; LD M1; OR X2; OUT Y2; LD M1; MOV K1 D0",
            &["never M0", "never M1", "never Y1", "never K1"],
        ),
        ("LD M2; OUT M1; LD M1; OUT Y0; LD X0; ANI X0; OUT M2", &["never M1", "never Y0", "never M2"]),
        ("LD X0; ANI X0; OUT M0; LDP M0; SET Y0; LD X1; RST Y0", &["never M0", "never Y0"]),
        // Conditions of two rungs that exclude each other.
        ("LD X0; ANI X1; OUT M0; LD M0; AND X1; OUT Y0", &["never Y0"]),
        ("LD X0; OR X1; OUT M0; LDI M0; AND X0; OUT Y0", &["never Y0"]),
        ("LD X0; ANI X1; OUT M0; LD X1; AND X2; OUT M1; LD M0; AND M1; OUT Y0", &["never Y0"]),
        (
            "LD X0; ANI X1; OUT M0; LD M0; AND X2; OUT M1; LD M1; LD X1; OR M0; ANB; ANI M0; OUT Y0",
            &["never Y0"],
        ),
        ("LD X0; ANI X1; OUT M0; LD M0; AND X1; SET Y0; LD X5; RST Y0", &["never Y0"]),
        // Always.
        ("LD X0; OUT M0; LD M0; ORI X0; OUT Y0", &["alway Y0"]),
    ];
    for (program, expected) in programs {
        assert_eq!(told(program), *expected, "{program}");
    }
}

#[test]
fn what_may_come_on_is_left_alone() {
    for program in [
        // An interlock; the other polarity; the value of the scan before.
        "LD X0; ANI M1; OUT M0; LD X1; ANI M0; OUT M1; LD M0; OUT Y0; LD M1; OUT Y1",
        "LD X0; ANI X1; OUT M0; LDI M0; AND X1; OUT Y0",
        "LD M0; AND X1; OUT Y0; LD X0; ANI X1; OUT M0",
        // Something else writes the relay: a latch, a row, another coil, the CPU.
        "LD X0; ANI X1; OUT M0; LD X2; SET M0; LD M0; AND X1; OUT Y0",
        "LD X0; ANI X1; OUT M0; LD X2; MOV D0 K1M0; LD M0; AND X1; OUT Y0",
        "LD X0; ANI X1; OUT M0; LD X1; OUT M0; LD M0; AND X1; OUT Y0",
        // What both ask for changes between them.
        "LD X0; OUT M5; LD M5; OUT M0; LD X1; SET M5; LD M0; ANI M5; OUT Y0; LD X3; RST M5",
        "LD M5; OUT M0; LD X1; OUT M5; LD M0; ANI M5; OUT Y0",
        "LDI T0; OUT M0; LD X1; OUT T0 K5; LD M0; AND T0; OUT Y0",
        "LD M8013; OUT M0; LD M0; ANI M8013; OUT Y0",
        // A relay that keeps its value, one that a jump or a master control may leave out, one of a routine.
        "LD X0; ANI X1; OUT M600; LD M600; AND X1; AND X2; OUT Y0; LD M600; OUT Y1; LD X0; OUT M600",
        "LD X7; CJ P1; LD X0; ANI X1; OUT M0; P1; LD M0; AND X1; OUT Y0",
        "LD X7; MC N0 M100; LD X0; ORI X1; OUT M0; MCR N0; LDI M0; AND X0; OUT Y0",
        // Written in an interrupt routine between any two rungs.
        "LD M5; OUT M0; LD M0; ANI M5; OUT Y0; EI; FEND; I001; LD X1; OUT M5; IRET",
        // On purpose.
        "LD M8001; OUT M0; LD M0; OUT Y0",
        "LD X0; ANI M8000; OUT M0; LD M0; OUT Y0",
    ] {
        let told: Vec<String> = told(program).into_iter().filter(|one| one.contains('Y')).collect();
        assert!(told.is_empty(), "{program}\n{told:?}");
    }
}

#[test]
fn the_reason_names_the_relay_and_its_coil() {
    let text = "LD X0\nANI X1\nOUT M0\nLD M0\nAND X1\nOUT Y0\nLD Y0\nOUT Y1\nEND\n";
    let found = found(text);
    let said: Vec<String> = found.iter().map(|one| one.message.render(Language::English)).collect();
    assert_eq!(
        said,
        [
            "`Y0` is never on: what drives `M0` and what is asked for here (`M0`, `X1`) never hold together",
            "`Y1` is never on: `Y0` is driven by no rung that can be on",
        ]
    );
    let place = |number: usize| found[number].related[0].span;
    assert_eq!((place(0).of(text), place(0).start, place(1).start), ("M0", 17, 37));
}

#[test]
fn drawings_and_files_are_followed_alike() {
    let text = "|  X0    X1    M0  |\n+--| |---|/|---( )-+\n|  M0    X1    Y0  |\n+--| |---| |---( )-+\n";
    let found = found(text);
    assert_eq!(found.iter().map(|one| one.span.of(text)).collect::<Vec<_>>(), ["Y0"]);
    assert_eq!(found[0].related[0].span.of(text), "M0");
}
