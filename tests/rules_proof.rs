//! Rules that need a proof: what they tell, what they stay silent about, and what their fixes make.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::logic::{Comparison, Formulas, Path, compare, rungs};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Language, TextEdit};

const CODES: [&str; 5] =
    ["contradiction-on-path", "redundant-contact", "redundant-branch", "never-energised", "always-energised"];

fn document(text: &str) -> Document {
    let notation =
        if text.starts_with('|') || text.starts_with('+') { Notation::Ladder } else { Notation::FxIl };
    Document::new(text, notation, Target::of(Model::Fx2n))
}

fn proved(text: &str) -> Vec<Diagnostic> {
    let mut found = check::all(&document(text), &Severities::default());
    found.retain(|one| CODES.contains(&one.code));
    found
}

/// `code words` of each finding in a list, whose lines are parted by `; `.
fn told(program: &str) -> Vec<String> {
    let text = format!("{}\nEND\n", program.replace("; ", "\n"));
    proved(&text).iter().map(|one| format!("{} {}", one.code, one.span.of(&text))).collect()
}

#[test]
fn in_a_master_control_an_output_is_on_when_that_is() {
    let message = |program: &str| {
        let text = format!("{}\nEND\n", program.replace("; ", "\n"));
        let found = proved(&text).into_iter().find(|one| one.code == "always-energised");
        found.map(|one| one.message.render(Language::English)).unwrap_or_default()
    };
    let rung = "LD X0; ORI X0; OUT Y0";
    let control = message(&format!("LD X1; MC N0 M10; {rung}; MCR N0; LD X2; OUT Y1"));
    assert!(control.starts_with("`Y0` is on whenever the master control"), "{control}");
    let step = message(&format!("LD X1; SET S20; STL S20; LD X2; OUT Y2; {rung}; RET"));
    assert!(step.starts_with("`Y0` is on whenever"), "{step}");
    let behind = message(&format!("LD X1; MC N0 M10; LD X2; OUT Y1; MCR N0; {rung}"));
    assert!(behind.starts_with("`Y0` is always on"), "{behind}");
}

fn path_of(text: &str) -> Path {
    let document = document(text);
    let chunk = document.chunks().next().expect("a rung").chunk;
    rungs(&chunk.reading(), document.target()).remove(0).path.expect("a path").expect("power")
}

#[test]
fn what_is_proved_is_told_once() {
    let programs: &[(&str, &[&str])] = &[
        // What excludes each other, on one path and across the ends of branches.
        ("LD X0; ANI X0; OUT Y0", &["contradiction-on-path ANI X0", "never-energised Y0"]),
        ("LD> D0 K10; AND< D0 K5; OUT Y0", &["contradiction-on-path AND< D0 K5", "never-energised Y0"]),
        ("LD= D0 K1; AND= D0 K2; OUT Y0", &["contradiction-on-path AND= D0 K2", "never-energised Y0"]),
        ("LDP X0; ANI X0; OUT Y0", &["contradiction-on-path ANI X0", "never-energised Y0"]),
        ("LDP M2800; ANI M2800; OUT Y0", &["contradiction-on-path ANI M2800", "never-energised Y0"]),
        ("LD X0; LDI X0; OR X1; ANB; OUT Y0", &["contradiction-on-path LDI X0"]),
        ("LDI X0; OR X1; AND X0; OUT Y0", &["contradiction-on-path LDI X0"]),
        ("LD X0; MPS; OUT Y0; MPP; ANI X0; OUT Y1", &["contradiction-on-path ANI X0", "never-energised Y1"]),
        // Two forms of one and not the other.
        ("LD X0; OR X1; LDI X0; ORI X1; ANB; OUT Y0", &[]),
        ("LD X0; ANI X1; LDI X0; AND X1; ORB; OUT Y0", &[]),
        // What a rung drives is read as it is then.
        ("LD M0; OUT Y0; ANI Y0; OUT Y1", &["never-energised Y1"]),
        ("LD X0; ANI M0; OUT M0; AND M0; OUT Y0", &[]),
        ("LD M0; RST M0; ANI M0; OUT Y1", &[]),
        ("LD M0; MOV K0 K4M0; ANI M0; OUT Y1", &[]),
        // Timers and counters change when they are driven.
        // A timer with power keeps its contact on.
        ("LD T0; OUT T0 K5; ANI T0; OUT Y0", &["never-energised Y0"]),
        ("LD T0; OR X0; OUT T0 K5; ANI T0; OUT Y0", &[]),
        ("LD X0; INV; AND X0; OUT Y0", &["never-energised Y0"]),
        // Makes no difference.
        ("LD X0; AND X1; AND X0; OUT Y0", &["redundant-contact AND X0"]),
        ("LD X0; OR X1; OR X0; OUT Y0", &["redundant-branch OR X0"]),
        ("LD X0; LD X1; AND X0; ORB; OUT Y0", &["redundant-branch LD X1"]),
        ("LD X0; LDI X0; AND X1; ORB; OUT Y0", &["redundant-contact LDI X0"]),
        ("LD X0; MPS; OUT Y0; MPP; AND X0; OUT Y1", &["redundant-contact AND X0"]),
        ("LDP X0; AND X0; OUT Y0", &["redundant-contact AND X0"]),
        ("LD> D0 K10; AND> D0 K5; OUT Y0", &["redundant-contact AND> D0 K5"]),
        // By consensus: the last branch has its work done by the two before.
        ("LD X0; AND X1; LDI X0; AND X2; ORB; LD X1; AND X2; ORB; OUT Y0", &["redundant-branch LD X1"]),
        // Seals, interlocks and contacts that several branches need.
        ("LD X0; OR Y0; ANI X1; OUT Y0", &[]),
        ("LD X0; AND X1; LD X0; AND X2; ORB; OUT Y0", &[]),
        ("LD X0; LD Y0; AND X0; ORB; OUT Y0", &["redundant-branch LD Y0"]),
        ("LDP X0; ANI Y0; SET Y0; LDP X0; AND Y0; RST Y0", &[]),
        // Never and always.
        (
            "LD X0; OR X1; ANI X0; ANI X1; OUT Y0",
            &["contradiction-on-path LD X0", "contradiction-on-path OR X1", "never-energised Y0"],
        ),
        ("LD X0; INV; AND X0; MOV K1 D0", &["never-energised K1"]),
        ("LD> D0 K32767; OUT Y0", &["never-energised Y0"]),
        ("LD X0; ORI X0; OUT Y0", &["always-energised Y0"]),
        ("LD X0; ORI X0; MOV K1 D0", &[]),
        // On purpose.
        ("LD M8000; OUT Y0", &[]),
        ("LD M8001; AND X0; OUT Y0", &[]),
        ("LD X0; ANI M8000; OUT Y0", &[]),
        ("LD= K1 K1; OUT Y0", &[]),
    ];
    let wrong: Vec<String> = programs
        .iter()
        .filter(|(program, expected)| told(program) != *expected)
        .map(|(program, expected)| format!("{program}\n  wanted {expected:?}\n  told {:?}", told(program)))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_reason_is_said_in_a_line() {
    let said = |program: &str| {
        let text = format!("{}\nEND\n", program.replace("; ", "\n"));
        let found = proved(&text);
        found.last().expect("a finding").message.render(Language::English)
    };
    let lines = [
        ("LD X0; AND X1; ANI X0; OUT Y0", "`Y0` is never on: `X0` and `NOT X0` in series"),
        ("LD> D0 K32767; OUT Y0", "`Y0` is never on: `D0 > K32767` never holds"),
        ("LD X0; ORI X0; OUT Y0", "`Y0` is always on: `X0` and `NOT X0` in parallel"),
        ("LD X0; OR X1; ANI X0; ANI X1; OUT Y0", "`Y0` is never on: no values of `X0`, `X1` change it"),
        (
            "LD X0; LD X1; AND X0; ORB; OUT Y0",
            "the branch `X1 · X0` makes no difference: wherever it conducts, `X0` does, too",
        ),
        (
            "LD> D0 K10; AND> D0 K5; OUT Y0",
            "`D0 > K5` makes no difference: `D0 > K10` in series with it conducts only where it does",
        ),
        (
            "LD X0; LDI X0; AND X1; ORB; OUT Y0",
            "`NOT X0` makes no difference: where it does not conduct, the branch beside it does (`X0`)",
        ),
    ];
    for (program, line) in lines {
        assert_eq!(said(program), line, "{program}");
    }
}

#[test]
fn a_fix_takes_away_what_is_redundant_and_nothing_else() {
    let programs = [
        ("LD X0\nAND X1 ; kept\nAND X0\nOUT Y0\n", "LD X0\nAND X1 ; kept\nOUT Y0\n"),
        ("LD X0\r\nOR X1\r\nOR X0\r\nOUT Y0\r\n", "LD X0\r\nOR X1\r\nOUT Y0\r\n"),
        ("  LD X0\n  LD X1\n  AND X0\n  ORB\n  OUT Y0\n", "  LD X0\n  OUT Y0\n"),
        ("LD X0\nLDI X0\nAND X1\nORB\nOUT Y0\n", "LD X0\nOR X1\nOUT Y0\n"),
        (
            "|  X0    X1    X0     Y0  |\n+--| |---| |---| |----( )-+\n",
            "|  X0    X1           Y0  |\n+--| |---| |----------( )-+\n",
        ),
    ];
    for (before, after) in programs {
        let found = proved(before);
        let [one] = &found[..] else { panic!("{before}: {found:?}") };
        let fixed = TextEdit::apply_all(&one.fixes[0].edits, before);
        let same = compare(&[&path_of(before)], &[&path_of(&fixed)], &mut Formulas::default());
        assert!(matches!(same, Comparison::Same { .. }), "{before}\n{fixed}");
        match before.starts_with('|') {
            // Where a drawing has its elements is the printer's choice.
            true => {
                let words = |text: &str| text.split_whitespace().map(str::to_string).collect::<Vec<_>>();
                let names =
                    |text: &str| words(text).into_iter().filter(|word| word.len() == 2).collect::<Vec<_>>();
                assert_eq!(names(&fixed), names(after));
            }
            false => assert_eq!(fixed, after),
        }
        assert!(proved(&fixed).is_empty(), "{fixed}");
    }
    // A comment beside a line that goes away would be lost.
    let found = proved("LD X0\nAND X1\nAND X0 ; why\nOUT Y0\n");
    assert!(found[0].fixes.is_empty());
}

#[test]
fn comments_allow_what_is_proved() {
    let text = "// rungwise: allow(never-energised, contradiction-on-path)\nLD X0\nANI X0\nOUT Y0\nEND\n";
    assert!(proved(text).is_empty());
    assert!(
        check::all(&document(text), &Severities::default())
            .iter()
            .all(|one| one.code != "unused-suppression")
    );
}

#[test]
fn large_rungs_are_looked_at_in_little_time() {
    let branches: String = (0..5_000).map(|number| format!("OR M{}\n", number % 400)).collect();
    let text = format!("LD X0\n{branches}OUT Y0\nEND\n");
    let start = std::time::Instant::now();
    assert!(proved(&text).is_empty());
    let text: String = (0..40)
        .map(|number| format!("LD M{number}\n{}OUT Y{:o}\n", "AND M1\nOR X1\n".repeat(40), number % 100))
        .collect();
    assert!(!proved(&text).is_empty());
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn behind_rungs_that_are_too_hard_simple_ones_are_still_proved() {
    let hard: String = (0..60).map(crate::lsp_streaming::hard_rung).collect();
    let text = format!("{hard}LD X2\nINV\nAND X2\nOUT Y1\nEND\n");
    let document = Document::new(&text, Notation::FxIl, Target::of(Model::Fx3u));
    let found = || {
        let mut found = check::all(&document, &Severities::default());
        found.retain(|one| CODES.contains(&one.code));
        found
    };
    let first = found();
    assert_eq!(first.iter().map(|one| one.code).collect::<Vec<_>>(), ["never-energised"]);
    assert_eq!(found(), first, "what is kept is told again");
}
