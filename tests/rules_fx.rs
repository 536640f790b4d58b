//! Rules on FX programs, where a page is too small: every example of the instruction table, the limits of each model,
//! one diagnostic for one mistake, and fixes that mend.

use crate::rules_sense::without_sense;
use proptest::prelude::*;
use rungwise::check::{self, RULES, Severities};
use rungwise::document::{Document, Notation};
use rungwise::target::{Form, Model, Target, instructions};
use rungwise::text::{Diagnostic, Language, Severity, TextEdit};

fn judged(text: &str, target: &'static Target) -> Vec<Diagnostic> {
    check::all(&Document::new(text, Notation::FxIl, target), &without_sense())
}

/// Code and marked words of everything found, as `code: words`.
fn told(text: &str, target: &'static Target) -> Vec<String> {
    judged(text, target).iter().map(|found| format!("{}: {}", found.code, found.span.of(text))).collect()
}

fn fx(name: &str) -> &'static Target {
    // A name that is none becomes a target on which no FX program is clean.
    Target::named(name).unwrap_or(Target::of(Model::Iec))
}

/// A program of these lines with END behind.
fn program(lines: &[&str]) -> String {
    let mut text = lines.join("\n");
    text.push_str("\nEND\n");
    text
}

#[test]
fn every_example_of_the_instruction_table_is_clean_on_its_models() {
    let mut wrong = Vec::new();
    let mut checked = 0;
    for row in instructions::all().chain([&instructions::LABEL]) {
        let example = row.page.split("```il\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        for &model in row.models {
            checked += 1;
            for found in judged(example, Target::of(model)) {
                if found.severity != Severity::Hint {
                    let message = found.message.render(Language::English);
                    wrong.push(format!("{} on {model:?}: {}: {message}", row.mnemonic, found.code));
                }
            }
        }
    }
    assert!(checked > 300, "only {checked} examples");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn ranges_end_where_the_model_does() {
    for (target, last, beyond) in [
        ("fx1s", "LD M511", "LD M512"),
        ("fx1n", "LD M1535", "LD M1536"),
        ("fx2n", "LD M3071", "LD M3072"),
        ("fx3u", "LD M7679", "LD M7680"),
        ("fx2n", "LD M8255", "LD M8256"),
        ("fx1s", "LD T63", "LD T64"),
        ("fx2n", "LD T255", "LD T256"),
        ("fx3u", "LD T511", "LD T512"),
        ("fx1s", "LD C31", "LD C32"),
        ("fx1s", "LD C235", "LD C234"),
        ("fx2n", "LD X377", "LD X400"),
        ("fx3u", "LD X367", "LD X370"),
        ("fx2n", "MOV K1 D7999", "MOV K1 D8256"),
        ("fx2n", "DMOV K1 D7998", "DMOV K1 D7999"),
        ("fx2n", "MOV K4M3056 D0", "MOV K4M3057 D0"),
        ("fx2n", "MOV D0Z7 D1", "MOV D0Z8 D1"),
        ("fx2n", "CMP K1 K2 M3069", "CMP K1 K2 M3070"),
        ("fx1s", "MOV K4Y0 D0", "MOV K4Y20 D0"),
    ] {
        let text = |line: &str| match line.starts_with("LD") {
            true => program(&[line, "OUT Y0"]),
            false => program(&["LD X0", line]),
        };
        assert_eq!(told(&text(last), fx(target)), Vec::<String>::new(), "{target} {last}");
        let word =
            beyond.split(' ').find(|word| beyond.starts_with("LD") && *word != "LD").map(str::to_string);
        let found = told(&text(beyond), fx(target));
        assert_eq!(found.len(), 1, "{target} {beyond}: {found:?}");
        assert!(found[0].starts_with("device-out-of-range: "), "{target} {beyond}: {found:?}");
        assert!(word.is_none_or(|word| found[0].ends_with(&word)), "{target} {beyond}: {found:?}");
    }
}

#[test]
fn labels_are_devices_too() {
    let text = program(&["LD X0", "CJ P100", "LD X1", "OUT Y0", "P100", "LD X2", "OUT Y1"]);
    assert_eq!(told(&text, fx("fx2n")), Vec::<String>::new());
    assert_eq!(told(&text, fx("fx1s")), ["device-out-of-range: P100", "device-out-of-range: P100"]);
}

/// Each program has one mistake; what follows is the one diagnostic, `code: marked words`.
const ONE_MISTAKE: &[(&[&str], &str)] = &[
    (&["LD X0", "FOO BAR X1"], "unknown-instruction: FOO"),
    (&["LD X0", "MOV K1,"], "syntax-error: ,"),
    (&["LD", "OUT Y0"], "operand-count: LD"),
    (&["LD X0", "OUT"], "operand-count: OUT"),
    (&["LD X0", "OUT Y0 X1"], "operand-count: X1"),
    (&["LD X0", "OUT T0 X1"], "operand-kind: X1"),
    (&["LD X0", "OUT T0"], "missing-preset: T0"),
    (&["LD X0", "OUT C200 K-5"], ""),
    (&["LD X0", "OUT C200 K3000000000"], "constant-out-of-range: K3000000000"),
    (&["LD X0", "OUT C0 K32768"], "constant-out-of-range: K32768"),
    (&["LD X0", "MOV R0 D0"], "unknown-device: R0"),
    (&["LD X0", "MOV R0Z0 D0"], "unknown-device: R0Z0"),
    (&["LD X0", "MOV D0 X0"], "write-to-input: X0"),
    (&["LD X0", "MOV D0 K5"], "operand-kind: K5"),
    (&["LD X0", "MOV D0 K2X0"], "write-to-input: X0"),
    (&["LD X0", "SET X1"], "write-to-input: X1"),
    (&["LD X0", "MOV \"AB\" D0"], "operand-kind: \"AB\""),
    (&["LD X0", "PLS M8013"], "operand-kind: M8013"),
    (&["LD X0", "MC N8 M0", "LD X1", "OUT Y0", "MCR N8"], "device-out-of-range: N8|device-out-of-range: N8"),
    (&["LD D0.3", "OUT Y0"], "operand-kind: D0.3"),
    (&["LD M0Z0", "OUT Y0"], "operand-kind: M0Z0"),
    (&["LD X0", "DEADD E1.5 D0 D2"], "operand-kind: E1.5"),
    (&["AND X0", "OUT Y0", "OUT Y1"], "no-current-result: AND"),
    (&["OUT Y0", "OUT Y1", "SET M0"], "no-current-result: OUT"),
    (&["STL S20", "MPS", "AND X0", "OUT Y0", "MPP", "OUT Y1", "RET"], "no-current-result: MPS"),
    (&["STL S20", "OUT Y0", "OUT Y1", "LD X0", "SET S21", "RET"], ""),
    (&["LD X0", "LD X1", "OUT Y0", "OUT Y1"], "block-stack: LD"),
    (&["LD X0", "ORB", "OUT Y0"], "block-stack: ORB"),
    (&["LD X0", "OUT Y0", "LD X1", "OR X2", "ANB", "OUT Y1"], ""),
    (&["LD X0", "MPS", "LD X1", "OR X2", "ANB", "OUT Y0", "MPP", "LD X3", "OR X4", "ANB", "OUT Y1"], ""),
    (&["LD X0", "MPS", "AND X1", "OUT Y0", "LD X2", "OUT Y1"], "branch-stack: MPS"),
    (&["LD X0", "MPS", "AND X1", "MPP", "OUT Y0"], "rung-without-output: AND X1"),
    (&["LD X0", "MPS", "AND X1", "OUT Y0", "MPP"], "rung-without-output: MPP"),
    (&["LD X0", "MPS", "MPS", "AND X1", "OUT Y0", "MPP", "OUT Y1"], "branch-stack: MPS"),
    (&["LD X0", "MRD", "OUT Y0", "MPP", "OUT Y1"], "branch-stack: MRD"),
    (&["LD X0", "NOP", "OUT Y0"], ""),
    (&["LD X0", "AND X1"], "rung-without-output: AND X1"),
    (&["LD X0", "OUT Y0", "AND X1"], "rung-without-output: AND X1"),
    (&["LD X0", "CJ P63", "LD X1", "OUT Y0"], ""),
    (&["LD X0", "CALL P63"], "subroutine-structure: P63"),
    (&["LD X0", "CJ P5"], "undefined-label: P5"),
    (&["LD X0", "CJ P5Z0", "P6", "LD X1", "OUT Y0"], ""),
    (&["P6", "LD X1", "OUT Y0"], "unused-label: P6"),
    (&["LD X1", "OUT Y0", "SRET"], "subroutine-structure: SRET"),
    (
        &["LD X1", "CALL P1", "CALL P2", "P1", "LD X2", "OUT Y1", "SRET", "P2", "LD X3", "OUT Y2", "SRET"],
        "subroutine-structure: P1",
    ),
    (
        &["LD X1", "CALL P1", "CALL P2", "FEND", "P1", "LD X2", "OUT Y1", "P2", "LD X3", "OUT Y2", "SRET"],
        "subroutine-structure: P1",
    ),
    (&["LD X1", "CALL P1", "CALL P2", "FEND", "P1", "P2", "LD X3", "OUT Y2", "SRET"], ""),
    (&["FEND", "I001", "LD M8000", "INC D0", "IRET"], "unused-label: I001"),
    (&["EI", "FEND", "I001", "LD M8000", "INC D0", "IRET"], ""),
    (&["LD X0", "MC N0 M0", "LD X1", "MC N1 M1", "LD X2", "OUT Y0", "MCR N0"], ""),
    (&["LD X0", "MC N0 M0", "LD X1", "OUT Y0", "MCR N1", "MCR N0"], "master-control-order: N1"),
    (&["FOR K2", "LD M8000", "INC D0"], "for-next-balance: FOR"),
    (&["LD X0", "CJ P1", "FOR K2", "LD X1", "CJ P1", "LD X2", "INC D0", "NEXT", "P1", "LD X3", "OUT Y0"], ""),
    (&["LD X0", "CALL P1", "FEND", "P1", "STL S20", "OUT Y0", "RET", "SRET"], "step-ladder-structure: STL"),
    (&["STL S20", "OUT Y0", "RET", "STL S21", "OUT Y1"], "step-ladder-structure: STL"),
    (&["LD X0", "OUT Y0", "(* the rest"], "unclosed-comment: (*"),
    (&["LD X0", "MOV K5M0 D0"], "operand-kind: K5M0"),
    (&["LD X0", "ZRST C200 C234"], ""),
    (&["LD X0", "RST C200"], ""),
    (&["LD X0", "INC C200"], "operand-kind: C200"),
];

#[test]
fn one_mistake_is_told_once() {
    let mut wrong = Vec::new();
    for (lines, expected) in ONE_MISTAKE {
        let found = told(&program(lines), fx("fx2n")).join("|");
        if found != *expected {
            wrong.push(format!("{lines:?}\n  expected {expected}\n  found    {found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A rung of `blocks` loads that are joined, and one of `branches` branches.
fn nested(blocks: usize, branches: usize) -> String {
    let mut lines = vec!["LD X0"; blocks];
    lines.extend(vec!["ORB"; blocks - 1]);
    lines.extend(["OUT Y0", "LD X1"]);
    lines.extend(["MPS", "AND X2"].repeat(branches));
    lines.push("OUT Y1");
    lines.extend(["MPP", "OUT Y2"].repeat(branches));
    program(&lines)
}

#[test]
fn nesting_ends_at_the_limits_of_the_cpu() {
    assert_eq!(told(&nested(8, 11), fx("fx2n")), Vec::<String>::new());
    assert_eq!(told(&nested(9, 11), fx("fx2n")), ["nesting-too-deep: LD"]);
    assert_eq!(told(&nested(8, 12), fx("fx2n")), ["nesting-too-deep: MPS"]);
    let loops = |depth: usize| {
        let lines = [vec!["FOR K2"; depth], vec!["LD M8000", "INC D0"], vec!["NEXT"; depth]].concat();
        told(&program(&lines), fx("fx2n"))
    };
    assert_eq!(loops(5), Vec::<String>::new());
    assert_eq!(loops(6), ["nesting-too-deep: FOR"]);
    let calls = |depth: usize| {
        let mut lines = vec!["LD X0".to_string(), "CALL P1".into(), "FEND".into()];
        for level in 1..=depth {
            lines.extend([format!("P{level}"), "LD X1".into()]);
            lines.push(if level < depth { format!("CALL P{}", level + 1) } else { "OUT Y0".into() });
            lines.push("SRET".into());
        }
        let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
        told(&program(&lines), fx("fx2n"))
    };
    assert_eq!(calls(5), Vec::<String>::new());
    assert_eq!(calls(6), ["nesting-too-deep: P6"]);
}

#[test]
fn instructions_that_only_a_larger_model_has_are_told() {
    for row in instructions::all() {
        let example = row.page.split("```il\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        for model in
            [Model::Fx1s, Model::Fx1n, Model::Fx2n].into_iter().filter(|model| !row.models.contains(model))
        {
            let found = told(example, Target::of(model));
            let is_told = found.iter().any(|found| {
                let word = found.strip_prefix("instruction-not-on-target: ").and_then(Form::named);
                word.is_some_and(|form| form.instruction.mnemonic == row.mnemonic)
            });
            assert!(is_told, "{} on {model:?}: {found:?}", row.mnemonic);
        }
    }
}

/// Programs with a mistake, and what the first fix of the first diagnostic makes of them.
#[test]
fn first_fixes_make_clean_programs() {
    for (text, mended) in [
        ("LD X0\nMVO K1 D0\nEND\n", "LD X0\nMOV K1 D0\nEND\n"),
        ("ld x0\nandn x1\nout y0\nend\n", "ld x0\nani x1\nout y0\nend\n"),
        ("LD X0\nOUT Y0", "LD X0\nOUT Y0\nEND\n"),
        ("LD X0\r\nOUT Y0\r\n", "LD X0\r\nOUT Y0\r\nEND\r\n"),
        ("LD X0\nOUT T0\nEND\n", "LD X0\nOUT T0 K10\nEND\n"),
        ("LD X0\nMOV K40000 D0\nEND\n", "LD X0\nDMOV K40000 D0\nEND\n"),
        ("LD X0\nMOV X0 D0\nEND\n", "LD X0\nMOV K4X0 D0\nEND\n"),
        ("LD X0\nMOV K8M0 D0\nEND\n", "LD X0\nDMOV K8M0 D0\nEND\n"),
        ("LD X0\nOUT X1\nEND\n", "LD X0\nOUT Y1\nEND\n"),
        ("LD XO\nOUT Y0\nEND\n", "LD X0\nOUT Y0\nEND\n"),
        ("LD X0 X1\nOUT Y0\nEND\n", "LD X0\nOUT Y0\nEND\n"),
        ("ANI X0\nOUT Y0\nEND\n", "LDI X0\nOUT Y0\nEND\n"),
        ("OUT Y0\nEND\n", "LD M8000\nOUT Y0\nEND\n"),
        ("LD X0\nLDI X1\nOUT Y0\nEND\n", "LD X0\nANI X1\nOUT Y0\nEND\n"),
        ("LD X0\nLD X1\nOR X2\nOUT Y0\nEND\n", "LD X0\nLD X1\nOR X2\nANB\nOUT Y0\nEND\n"),
        ("LD X0\nANB\nOUT Y0\nEND\n", "LD X0\nOUT Y0\nEND\n"),
        ("LD X0\nMPS\nOUT Y0\nMRD\nAND X1\nOUT Y1\nEND\n", "LD X0\nMPS\nOUT Y0\nMPP\nAND X1\nOUT Y1\nEND\n"),
        ("FOR K2\r\nLD X0\r\nINC D0\r\nEND\r\n", "FOR K2\r\nLD X0\r\nINC D0\r\nNEXT\r\nEND\r\n"),
        ("STL S20\nOUT Y0\nEND\n", "STL S20\nOUT Y0\nRET\nEND\n"),
        ("LD X0\nOUT Y0\nRET\nEND\n", "LD X0\nOUT Y0\nEND\n"),
        ("LD X0\nMC N0 M0\nLD X1\nOUT Y0\nEND\n", "LD X0\nMC N0 M0\nLD X1\nOUT Y0\nMCR N0\nEND\n"),
        (
            "LD X0\nCALL P1\nP1\nLD X1\nOUT Y0\nSRET\nEND\n",
            "LD X0\nCALL P1\nFEND\nP1\nLD X1\nOUT Y0\nSRET\nEND\n",
        ),
        (
            "LD X0\nCALL P1\nFEND\nP1\nLD X1\nOUT Y0\nEND\n",
            "LD X0\nCALL P1\nFEND\nP1\nLD X1\nOUT Y0\nSRET\nEND\n",
        ),
        ("LD X0\nOUT Y0\nEND\nLD X1\nOUT Y1\nEND\n", "LD X0\nOUT Y0\nLD X1\nOUT Y1\nEND\n"),
        ("P1\nLD X0\nOUT Y0\nEND\n", "LD X0\nOUT Y0\nEND\n"),
        ("P1 LD X0\nOUT Y0\nEND\n", " LD X0\nOUT Y0\nEND\n"),
        ("LD X0\nOUT Y0\nRET ; the end\nEND\n", "LD X0\nOUT Y0\n ; the end\nEND\n"),
        ("LD X0\nOUT Y0 (* the motor\nEND\n", "LD X0\nOUT Y0 (* the motor *)\nEND\n"),
    ] {
        let found = judged(text, fx("fx2n"));
        let fix = found
            .first()
            .and_then(|first| first.fixes.first())
            .unwrap_or_else(|| panic!("{text}: {found:?}"));
        let result = TextEdit::apply_all(&fix.edits, text);
        assert_eq!(result, mended, "{}", found[0].code);
        assert_eq!(told(&result, fx("fx2n")), Vec::<String>::new(), "{mended}");
    }
}

#[test]
fn list_and_drawing_are_judged_alike() {
    let drawing = "|  X0           |\n+--| |---[FEND]-+\n\n|  X1        Y1 |\n+--| |-------( )+\n";
    let document = Document::new(drawing, Notation::Ladder, fx("fx2n"));
    let found = check::program(&document, &Severities::default());
    let codes: Vec<&str> = found.iter().map(|found| found.code).collect();
    assert!(codes.contains(&"missing-end"), "{codes:?}");
}

/// A line of a program, mostly sensible.
fn line() -> impl Strategy<Value = String> {
    let mnemonic = prop::sample::select(vec![
        "LD", "LDI", "AND", "OR", "ANB", "ORB", "MPS", "MRD", "MPP", "INV", "OUT", "SET", "RST", "PLS", "MC",
        "MCR", "STL", "RET", "END", "FEND", "NOP", "CJ", "CALL", "SRET", "IRET", "EI", "FOR", "NEXT", "MOV",
        "DMOV", "LD=", "P1", "P2", "I001", "P63", "FOO", "(*", "*)", "\"",
    ]);
    let operand = prop::sample::select(vec![
        "",
        " X0",
        " Y1",
        " M8013",
        " T0 K50",
        " C200 K5",
        " N0 M0",
        " N1 M1",
        " S20",
        " P1",
        " P2",
        " P63",
        " D0",
        " K1 D0",
        " K99999 D0",
        " X8",
        " Q",
        " E1.5",
        " K4M0Z9",
        ",",
        " é",
        " P1Z0",
    ]);
    (mnemonic, operand).prop_map(|(mnemonic, operand)| format!("{mnemonic}{operand}\n"))
}

proptest! {
    /// Whatever stands in a program: no panic, places within the text, messages with all their words, and fixes that
    /// can be applied.
    #[test]
    fn findings_are_sound(lines in prop::collection::vec(line(), 0..40)) {
        let text = lines.concat();
        let document = Document::new(&text, Notation::FxIl, fx("fx2n"));
        for found in check::all(&document, &Severities::default()) {
            let mut spans = vec![found.span];
            spans.extend(found.related.iter().map(|related| related.span));
            spans.extend(found.fixes.iter().flat_map(|fix| &fix.edits).map(|edit| edit.span));
            for span in spans {
                prop_assert!(text.get(span.range()).is_some(), "{} {span:?}", found.code);
            }
            let mut messages = vec![&found.message];
            messages.extend(found.related.iter().map(|related| &related.message));
            messages.extend(found.fixes.iter().map(|fix| &fix.title));
            for message in messages {
                let words = message.render(Language::English);
                prop_assert!(!words.contains('{') && !words.starts_with(message.key()), "{words}");
            }
            prop_assert!(RULES.iter().any(|rule| rule.code == found.code), "{} is no rule", found.code);
        }
    }
}
