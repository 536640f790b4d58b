//! Rules about the sense of programs, where a page is too small, and comments that allow what rules report.

use crate::lsp_client::{Client, codes};
use proptest::prelude::*;
use rungwise::check::{self, RULES, Severities};
use rungwise::document::{Document, Edit, Member, Notation, ProjectView};
use rungwise::ide;
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Severity, Span, TextEdit};
use serde_json::json;

/// The settings of a project that looks at fragments: what is read in them is written elsewhere.
pub fn without_sense() -> Severities {
    let first = RULES.iter().position(|rule| rule.code == "double-coil").expect("the first of its group");
    let grades = RULES[first..].iter().map(|rule| (rule.code.to_string(), None)).collect();
    Severities { grades, never: Vec::new() }
}

fn document(notation: Notation, text: &str) -> Document {
    let model = if notation == Notation::IecIl { Model::Iec } else { Model::Fx2n };
    Document::new(text, notation, Target::of(model))
}

fn judged(notation: Notation, text: &str) -> Vec<Diagnostic> {
    check::all(&document(notation, text), &Severities::default())
}

/// `code line words` of everything that is found, or of what is found under `code` alone.
fn told(notation: Notation, text: &str, code: Option<&str>) -> Vec<String> {
    let line = |one: &Diagnostic| text[..one.span.start as usize].matches('\n').count() + 1;
    let all = judged(notation, text);
    let wanted = all.iter().filter(|one| code.is_none_or(|code| one.code == code));
    wanted.map(|one| format!("{} {} {}", one.code, line(one), one.span.of(text))).collect()
}

/// FX programs, with the lines in which one of the codes is told.
fn check_lines(code: &str, programs: &[(&str, &[usize])]) {
    for (program, lines) in programs {
        let text = format!("{}\nEND\n", program.replace("; ", "\n"));
        let found = told(Notation::FxIl, &text, Some(code));
        let found: Vec<usize> =
            found.iter().map(|one| one.split(' ').nth(1).unwrap().parse().unwrap()).collect();
        assert_eq!(found, *lines, "{code}: {program}\n{:?}", told(Notation::FxIl, &text, None));
    }
}

#[test]
fn coils_of_parts_that_do_not_run_together_are_no_double_coils() {
    check_lines(
        "double-coil",
        &[
            ("STL S20; OUT Y0; LD X0; SET S21; STL S21; OUT Y0; RET", &[]),
            ("STL S20; OUT Y0; LD X1; OUT Y0; LD X0; SET S21; STL S21; OUT Y0; RET", &[2]),
            ("LD X0; OUT Y0; STL S20; OUT Y0; RET", &[2]),
            ("LD X0; CALL P1; CALL P2; FEND; P1; LD X1; OUT Y0; SRET; P2; LD X2; OUT Y0; SRET", &[]),
            ("LD X0; OUT Y0; CALL P1; FEND; P1; LD X1; OUT Y0; SRET", &[2]),
            ("LD X0; CJ P1; LD X1; OUT Y0; P1; LDI X0; CJ P2; LD X2; OUT Y0; P2; LD X3; OUT Y1", &[]),
            ("LD X0; CJ P1; LD X1; OUT Y0; P1; LD X2; OUT Y0", &[4]),
            ("LD X0; OUT Y0; LD X1; CJ P1; LD X2; OUT Y0; P1; LD X3; OUT Y1", &[2]),
            ("LD X0; CJ P1; LD X1; OUT Y0; FEND; P1; LD X2; OUT Y0; FEND", &[]),
            ("LD X0; OUT Y0; LD X1; OUT Y0; LD X2; OUT Y0", &[2, 4]),
            ("LD X0; CJ P1; LD X1; OUT Y0; P1; LDI X0; CJ P63; LD X2; OUT Y0", &[]),
            ("LD X0; PLS M0; LD X1; OUT M0; LD M0; OUT Y0", &[2]),
            ("LD X0; MC N0 M5; LD X1; MCR N0; LD X1; MC N0 M5; MCR N0", &[2]),
            ("LD X0; OUT T0 K5; LD X1; OUT T0 K5; LD T0; OUT Y0", &[]),
        ],
    );
}

#[test]
fn a_coil_that_is_read_before_the_second_one_is_not_joined_with_it() {
    let twice = |between: &str| {
        let text = format!("LD X0\nOUT M0\n{between}LD X1\nOUT M0\nLD M0\nOUT Y2\nEND\n");
        let mut found = judged(Notation::FxIl, &text);
        found.retain(|one| one.code == "double-coil");
        let [one] = &found[..] else { panic!("{text}{found:?}") };
        (one.message.key(), one.fixes.len())
    };
    assert_eq!(twice(""), ("double-coil.found", 1));
    assert_eq!(twice("LD M0\nOUT Y1\n"), ("double-coil.read-between", 0));
}

#[test]
fn a_coil_and_a_latch_of_one_step_disturb_each_other() {
    check_lines(
        "coil-and-set-reset",
        &[
            ("LD X0; OUT Y0; LD X1; SET Y0; LD X2; RST Y0", &[4, 6]),
            ("STL S20; OUT Y0; LD X0; SET S21; STL S21; SET Y0; RET; LD X1; RST Y0", &[9]),
            ("LD X0; OUT Y0; LD X1; ZRST Y0 Y7", &[]),
            ("LD X0; OUT C0 K5; LD X1; RST C0; LD C0; OUT Y0", &[]),
        ],
    );
}

#[test]
fn rows_of_devices_are_read_and_written_too() {
    check_lines(
        "read-never-written",
        &[
            ("LD X0; MOV K5 K1M0; LD M3; OUT Y0", &[]),
            ("LD X0; MOV K5 K1M0; LD M4; OUT Y0", &[3]),
            ("LD X0; FMOV K0 D0 K10; LD= D9 K0; OUT Y0", &[]),
            ("LD X0; FMOV K0 D0 K10; LD= D10 K0; OUT Y0", &[3]),
            ("LD X0; BMOV D200 D0 D201; LD= D99 K0; OUT Y0", &[]),
            ("LD X0; MOV K1 Z0; MOV K1 D0Z0; LD= D50 K0; OUT Y0", &[]),
            ("LD X0; ZRST M0 M9; LD M9; OUT Y0", &[]),
            ("LD X0; DMOV K1 D0; LD= D1 K0; OUT Y0", &[]),
            ("LD X0; MUL K1 K2 D0; LD= D1 K0; OUT Y0", &[]),
            ("LD X0; DMUL K1 K2 D0; LD= D3 K0; OUT Y0", &[]),
            ("LD X0; CMP K1 D250 M0; LD M2; OUT Y0", &[]),
            ("LD X0; SFTL X1 M0 K8 K1; LD M7; OUT Y0", &[]),
            ("LD M500; OUT Y0; LD M8013; OUT Y1; LD= D300 K1; OUT Y2", &[]),
            ("LD T5; OUT Y0; LD C120; OUT Y1; LD Y7; OUT Y2", &[1, 3, 5]),
            // Most of the relays come from a panel.
            ("LD M0; OUT Y0; LD M1; OUT Y1; LD M2; OUT Y2", &[]),
        ],
    );
    check_lines(
        "written-never-read",
        &[
            ("LD X0; OUT M0; MOV K1M0 D300", &[]),
            ("LD X0; OUT M4; MOV K1M0 D300", &[2]),
            ("LD X0; MOV K1 D5; BMOV D0 D300 K6", &[]),
            ("LD X0; DMOV K1 D4; LD= D5 K0; OUT Y0", &[]),
            ("LD X0; DMOV K1 D4; LD= D6 K0; OUT Y0", &[2]),
            ("LD X0; OUT M500; MOV K1 D300; OUT M8034", &[]),
            ("LD X0; MC N0 M5; LD X1; OUT Y0; MCR N0", &[]),
            ("LD X0; MOV K1 D5; MOV K1 Z0; MOV D0Z0 D300", &[]),
            ("LD X0; INC D5", &[]),
            ("LD X0; OUT T3 K5; LD X1; OUT C3 K5; RST C3", &[2, 4]),
        ],
    );
}

#[test]
fn latches_need_both_halves() {
    check_lines(
        "set-without-reset",
        &[
            ("LD X0; SET M0; LD M0; OUT Y0", &[2]),
            ("LD X0; SET M0; LD X1; ZRST M0 M9; LD M0; OUT Y0", &[]),
            ("LD X0; SET M0; LD X1; MOV K0 K4M0; LD M0; OUT Y0", &[]),
            ("LD X0; SET S0; STL S0; OUT Y0; RET", &[]),
            ("LD X0; SET M8034", &[]),
            ("LD M0; CJ P1; SET M0; P1; LD M0; OUT Y0", &[]),
        ],
    );
    check_lines(
        "reset-without-set",
        &[
            ("LD X0; RST M0; LD M0; OUT Y0", &[2]),
            ("LD X0; RST M0; LD X1; ALT M0; LD M0; OUT Y0", &[]),
            ("LD X0; RST C0; LD C0; OUT Y0", &[2]),
            ("LD X0; RST D0", &[]),
        ],
    );
}

#[test]
fn a_late_reader_is_told_only_where_another_order_would_help() {
    check_lines(
        "read-before-write",
        &[
            ("LD M0; OUT Y0; LD X0; OUT M0", &[1]),
            ("LD M0; OUT Y0; LD X0; OR M0; ANI X1; OUT M0", &[1]),
            // Each of two relays locks the other out.
            ("LD X0; ANI M1; OUT M0; LD X1; ANI M0; OUT M1", &[]),
            // An edge: the value of the scan before is wanted.
            ("LD X0; ANI M0; OUT Y0; LD X0; OUT M0", &[]),
            ("LD M0; OUT Y0; LD X0; OUT M0; LD M0; OUT Y1", &[]),
            ("LD M0; OUT M1; LD M1; OUT M0", &[]),
            ("LD M500; OUT Y0; LD X0; OUT M500", &[]),
        ],
    );
}

#[test]
fn words_and_numbers_of_two_words_keep_apart() {
    check_lines(
        "overlapping-words",
        &[
            ("LD X0; DMOV K1 D0; MOV K1 D1; LDD= D0 K1; OUT Y0", &[3]),
            ("LD X0; DMOV K1 D0; MOV K1 D2; LDD= D0 K1; OUT Y0", &[]),
            // A number that is put together of two words.
            ("LD X0; MOV K1 D0; MOV K0 D1; DMOV D0 D10; LDD= D10 K1; OUT Y0", &[]),
            ("LD X0; DMOV K1 D0; DMOV K1 D1; LDD= D0 K1; OUT Y0", &[3]),
            // Quotient and remainder are two words.
            ("LD X0; DIV D300 K7 D0; MOV K1 D1", &[]),
        ],
    );
}

#[test]
fn what_nothing_leads_to_is_told() {
    check_lines(
        "unreachable-code",
        &[
            ("LD X0; OUT Y0; FEND; LD X1; OUT Y1", &[4]),
            ("LD M8000; CJ P1; LD X1; OUT Y1; P1; LD X2; OUT Y2", &[3]),
            ("LDI M8000; CJ P1; LD X1; OUT Y1; P1; LD X2; OUT Y2", &[]),
            ("LD M8000; AND X0; CJ P1; LD X1; OUT Y1; P1; LD X2; OUT Y2", &[]),
            ("LD M8000; CJP P1; LD X1; OUT Y1; P1; LD X2; OUT Y2", &[]),
            ("LD X0; CALL P1; FEND; P1; LD X1; OUT Y1; SRET; LD X2; OUT Y2", &[8]),
            ("LD X0; OUT Y0; FEND; NOP", &[]),
        ],
    );
    let text = "LD X0\nOUT Y0\nFEND\nLD X1\nOUT Y1\nP1\nLD X2\nOUT Y2\nSRET\nEND\n";
    let found = judged(Notation::FxIl, text);
    let found = found.iter().find(|one| one.code == "unreachable-code").expect("told");
    assert_eq!(TextEdit::apply_all(&found.fixes[0].edits, text), text.replace("LD X1\nOUT Y1\n", ""));
    let drawing = "|  M8000         |\n+--| |---[CJ P1]-+\n\n|  X1        Y1  |\n+--| |-------( )-+\n\nP1:\n\
                   |  X2        Y2  |\n+--| |-------( )-+\n";
    assert_eq!(told(Notation::Ladder, drawing, Some("unreachable-code")).len(), 1);
    let open = drawing.replace("M8000", "X0   ");
    assert_eq!(told(Notation::Ladder, &open, Some("unreachable-code")), [""; 0]);
}

#[test]
fn a_relay_of_the_latched_range_gets_a_general_one() {
    let text = "LD M0\nAND M2\nOUT M600\nLD M600\nANI M600\nOUT Y0\nEND\n";
    let found = judged(Notation::FxIl, text);
    let found = found.iter().find(|one| one.code == "latched-range").expect("told");
    assert_eq!(TextEdit::apply_all(&found.fixes[0].edits, text), text.replace("M600", "M1"));
    check_lines(
        "latched-range",
        &[
            ("LD X0; OR M600; OUT M600; LD M600; OUT Y0", &[]),
            ("LD X0; SET M600; LD X1; RST M600", &[]),
            ("STL S0; OUT M600; RET; LD M600; OUT Y0", &[]),
            ("LD X0; OUT M2800; LDP M2800; OUT Y0", &[]),
        ],
    );
}

#[test]
fn the_first_instruction_without_room_is_marked() {
    let target = |model: Model, rungs: usize| {
        // Four more steps, to meet the limit exactly.
        let text = format!("{}{}END\n", "LD X0\nAND X1\nINC D300\n".repeat(rungs), "NOP\n".repeat(4));
        let document = Document::new(&text, Notation::FxIl, Target::of(model));
        let found = check::program(&document, &Severities::default());
        let found = found.iter().find(|one| one.code == "program-too-large");
        found.map(|one| (one.severity, text[..one.span.start as usize].matches('\n').count()))
    };
    // Five steps a rung of three lines.
    assert_eq!(target(Model::Fx1s, 399), None);
    assert_eq!(target(Model::Fx1s, 400), Some((Severity::Error, 1200)));
    assert_eq!(target(Model::Fx1s, 500), Some((Severity::Error, 1200)));
    assert_eq!(target(Model::Fx2n, 2000), Some((Severity::Warning, 4800)));
    assert_eq!(target(Model::Fx2n, 4000), Some((Severity::Error, 9600)));
    assert_eq!(target(Model::Fx3u, 4000), None);
}

#[test]
fn a_variable_that_holds_one_result_after_another_is_usual_in_lists() {
    let program = |body: &str| {
        let head = "PROGRAM p\nVAR\n  a AT %IX0.0 : BOOL;\n  q AT %QX0.0 : BOOL;\n  t : BOOL;\nEND_VAR\n";
        format!("{head}{}\nEND_PROGRAM\n", body.replace("; ", "\n"))
    };
    for (body, lines) in [
        ("LD a; ST t; LD t; ST q; LD a; ST t; LD t; S q", &["coil-and-set-reset 14 q"][..0]),
        ("LD a; ST t; LDN a; ST t; LD t; ST q", &["double-coil 8 t"]),
        ("LD a; ST q; LDN a; ST q", &["double-coil 8 q"]),
        // A default that a later statement may change.
        ("LD FALSE; ST q; LD a; JMPC done; LD TRUE; ST q; done:; LD a; R q", &[]),
        ("LD a; S q; LD a; ST q", &["coil-and-set-reset 8 q"]),
    ] {
        let text = program(body);
        let found = told(Notation::IecIl, &text, None);
        let found: Vec<_> =
            found.iter().filter(|one| one.contains("double") || one.contains("coil")).collect();
        assert_eq!(found, lines, "{body}");
    }
}

#[test]
fn files_of_a_program_know_each_others_coils() {
    let main = document(Notation::FxIl, "LD X0\nOUT Y0\nLD M0\nOUT Y1\n");
    let subs = document(
        Notation::Ladder,
        "|  X1        Y0  |\n+--| |-------( )-+\n\n|  X2        M0  |\n+--| |-------( )-+\n",
    );
    let members =
        vec![Member { name: "main.il", document: &main }, Member { name: "subs.lad", document: &subs }];
    let view = ProjectView::new(members, 0, true).expect("a view");
    let codes = |found: &[Diagnostic]| found.iter().map(|one| one.code).collect::<Vec<_>>();
    let found = check::within_project(&view, &Severities::default());
    assert_eq!(codes(&found), ["double-coil", "read-before-write"][..1]);
    assert_eq!(found[0].related[0].file, Some(1));
    assert_eq!(codes(&check::within_project(&view.from(1), &Severities::default())), [""; 0]);
    let all = check::project(&view, &Severities::default());
    assert_eq!(codes(&all[0]), ["double-coil"]);
    // What drives devices is a part of what other files see; where it stands is none.
    let other = document(Notation::FxIl, "LD X0\nOUT Y2\nLD M0\nOUT Y1\n");
    let moved = document(Notation::FxIl, "; a line\nLD X0\nOUT Y0\nLD M0\nOUT Y1\n");
    assert_ne!(check::surface(&main), check::surface(&other));
    assert_eq!(check::surface(&main), check::surface(&moved));
    // Proofs go through the rungs of other files: how contacts are joined is a part of it, comments are none.
    for (notation, one, two, is_same) in [
        (Notation::FxIl, "LD X0\nAND X1\nOUT Y0\n", "LD X0\nOR X1\nOUT Y0\n", false),
        (Notation::FxIl, "LD> D0 K5\nOUT Y0\n", "LD> D0 K6\nOUT Y0\n", false),
        (Notation::FxIl, "LD X0\nOUT Y0\n", "\n; on\n\nLD X0 ; in\n  OUT Y0\n", true),
        (
            Notation::Ladder,
            "|  X0    X1    Y0  |\n+--| |---| |---( )-+\n",
            "|  X0          Y0  |\n+--| |-+-----( )-+\n|  X1  |           |\n+--| |-+           |\n",
            false,
        ),
        (
            Notation::Ladder,
            "|  X0    X1    Y0  |\n+--| |---| |---( )-+\n",
            "// both\n|  X0    X1    Y0  |\n+--| |---| |---( )-+\n",
            true,
        ),
        (Notation::IecIl, "LD %IX0.0\nAND %IX0.1\nST %QX0.0\n", "LD %IX0.0\nOR %IX0.1\nST %QX0.0\n", false),
        (Notation::IecIl, "LD %IX0.0\nST %QX0.0\n", "(* on *)\nLD %IX0.0\nST %QX0.0\n", true),
    ] {
        let [first, second] = [one, two].map(|text| check::surface(&document(notation, text)));
        assert_eq!(first == second, is_same, "{one}\n{two}");
    }
}

// Comments that allow

const TWICE: &str = "LD X0\nOUT Y0\nLD X1\nOUT Y0\nLD X2\nOUT Y1\nLD X3\nOUT Y1\nEND\n";

#[test]
fn a_comment_allows_for_its_rung_or_for_the_file() {
    let allow = "// rungwise: allow(double-coil)\n";
    for (text, expected) in [
        (TWICE.to_string(), &["double-coil 2 Y0", "double-coil 6 Y1"][..]),
        (format!("{allow}{TWICE}"), &["double-coil 7 Y1"]),
        (format!("{allow}\n{TWICE}"), &[]),
        (format!("\u{feff}// Press\n{allow}\n{TWICE}"), &[]),
        (TWICE.replacen("Y0", "Y0 ; rungwise: allow(double-coil)", 1), &["double-coil 6 Y1"]),
        (TWICE.replacen("LD X2", &format!("{allow}LD X2"), 1), &["double-coil 2 Y0"]),
        (TWICE.replacen("LD X2", &format!("\n{allow}\nLD X2"), 1), &["double-coil 2 Y0"]),
        (
            TWICE.replacen("LD X2", "(* as wanted,\n rungwise: allow( double-coil ) *)\nLD X2", 1),
            &["double-coil 2 Y0"],
        ),
        (
            TWICE.replacen("LD X1", &format!("{allow}LD X1"), 1),
            &["double-coil 2 Y0", "unused-suppression 3 double-coil", "double-coil 7 Y1"],
        ),
        (
            format!("// rungwise: allow(double-coil, missing-end)\n\n{TWICE}"),
            &["unused-suppression 1 missing-end"],
        ),
        ("// rungwise: allow(missing-end)\n\nLD X0\nOUT Y0\n".to_string(), &[]),
        ("LD X0\nOUT Y0 // rungwise: allow(missing-end)\n".to_string(), &[]),
        // The tier that looks at each rung by itself.
        ("// rungwise: allow(device-out-of-range)\nLD M4000\nOUT Y0\nEND\n".to_string(), &[]),
        (
            "// rungwise: allow(device-out-of-range)\nLD X0\nOUT Y0\nEND\n".to_string(),
            &["unused-suppression 1 device-out-of-range"],
        ),
        // What cannot be read cannot be allowed.
        (
            "// rungwise: allow(syntax-error)\nLD X0,\nOUT Y0\nEND\n".to_string(),
            &["unused-suppression 1 syntax-error", "syntax-error 2 ,"],
        ),
        (
            "// rungwise: allow(unused-suppression)\nLD X0\nOUT Y0\nEND\n".to_string(),
            &["unused-suppression 1 unused-suppression"],
        ),
    ] {
        assert_eq!(told(Notation::FxIl, &text, None), expected, "{text}");
    }
}

#[test]
fn fixes_mend_comments_that_allow_nothing() {
    for (comment, mended) in [
        ("// rungwise: allow(double-coil)\n", ""),
        ("  (* rungwise: allow(double-coil) *)\n", ""),
        ("// Press: rungwise: allow(double-coil)\n", "// Press: \n"),
        ("// rungwise: allow(latched-range, double-coil)\n", "// rungwise: allow(double-coil)\n"),
        ("// rungwise: allow(double-coli)\n", "// rungwise: allow(double-coil)\n"),
    ] {
        let text = format!("{comment}LD X0\nOUT Y0\nEND\n");
        let found = judged(Notation::FxIl, &text);
        let fixed = TextEdit::apply_all(&found[0].fixes[0].edits, &text);
        assert_eq!(fixed, format!("{mended}LD X0\nOUT Y0\nEND\n"));
    }
}

#[test]
fn quick_fixes_allow_what_is_found() {
    let iec = "PROGRAM p\nVAR\n    a AT %IX0.0 : BOOL;\n    q AT %QX0.0 : BOOL;\nEND_VAR\n    LD a\n    ST q\n    LDN a\n    ST q\nEND_PROGRAM\n";
    let drawing = "(* Press *)\n|  X0        Y0  |\n+--| |-------( )-+\n|                |\n|  X1        Y0  |\n+--| |-------( )-+\n";
    for (notation, text) in [
        (Notation::FxIl, TWICE.to_string()),
        (Notation::FxIl, TWICE.replace('\n', "\r\n")),
        (Notation::FxIl, format!("\u{feff}{TWICE}")),
        (Notation::FxIl, TWICE.replacen("LD X0", "P1\nLD X0", 1)),
        (Notation::IecIl, iec.to_string()),
        (Notation::Ladder, drawing.to_string()),
    ] {
        let document = document(notation, &text);
        let found = judged(notation, &text);
        let coil = found.iter().find(|one| one.code == "double-coil").expect("told");
        let twice = found.iter().filter(|one| one.code == "double-coil").count();
        let fixes = ide::allowing(&document, &found, coil.span);
        assert_eq!(fixes.len(), 2, "{text}");
        for ((_, fix), left) in fixes.iter().zip([twice - 1, 0]) {
            let allowed = TextEdit::apply_all(&fix.edits, &text);
            let found = judged(notation, &allowed);
            let codes: Vec<&str> = found
                .iter()
                .map(|one| one.code)
                .filter(|code| code.contains("coil") || code.contains("supp"))
                .collect();
            assert_eq!(codes.len(), left, "{codes:?}\n{allowed}");
            assert_eq!(allowed.contains("\r\n"), text.contains("\r\n"));
        }
    }
    // Errors are mended, not allowed.
    let text = "LD M4000\nOUT Y0\nEND\n";
    let found = judged(Notation::FxIl, text);
    assert!(ide::allowing(&document(Notation::FxIl, text), &found, found[0].span).is_empty(), "{found:?}");
}

#[test]
fn a_second_code_joins_the_list_of_the_first() {
    let text = "// rungwise: allow(latched-range)\nLD X0\nOUT M600\nLD X1\nOUT M600\nEND\n";
    let found = judged(Notation::FxIl, text);
    let coil = found.iter().find(|one| one.code == "double-coil").expect("told");
    let document = document(Notation::FxIl, text);
    let fixes = ide::allowing(&document, &found, coil.span);
    let allowed = TextEdit::apply_all(&fixes[0].1.edits, text);
    assert!(allowed.starts_with("// rungwise: allow(latched-range, double-coil)\nLD X0"), "{allowed}");
}

fn line() -> impl Strategy<Value = String> {
    let lines = [
        "LD X0",
        "LDP X1",
        "LD M0",
        "OUT Y0",
        "OUT M0",
        "OUT M600",
        "SET M0",
        "RST M0",
        "OUT T0 K5",
        "DMOV D0 D10",
        "MOV K1 D11",
        "STL S20",
        "RET",
        "P1",
        "CJ P1",
        "FEND",
        "SRET",
        "LD M4000",
        "",
        "// rungwise: allow(double-coil, written-never-read)",
        "; rungwise: allow(device-out-of-range)",
        "(* rungwise: allow(reused-timer, nonsense) *)",
        "END",
    ];
    prop::sample::select(lines.to_vec()).prop_map(|line| format!("{line}\n"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// After any edits everything is found as in a document that is read at once.
    #[test]
    fn edits_leave_nothing_behind(
        lines in prop::collection::vec(line(), 1..60),
        edits in prop::collection::vec((0usize..60, 0usize..3, prop::collection::vec(line(), 0..3)), 1..6),
    ) {
        let mut lines = lines;
        let mut edited = document(Notation::FxIl, &lines.concat());
        check::all(&edited, &Severities::default());
        for (at, removed, inserted) in edits {
            let at = at.min(lines.len());
            let end = (at + removed).min(lines.len());
            let offset = |line: usize| lines[..line].iter().map(String::len).sum::<usize>();
            let range = offset(at)..offset(end);
            edited.apply(&[Edit { range: Some(range), text: inserted.concat() }]);
            lines.splice(at..end, inserted);
            let scratch = document(Notation::FxIl, &lines.concat());
            let found = check::all(&edited, &Severities::default());
            prop_assert_eq!(&found, &check::once(&scratch, &Severities::default()));
            for one in found {
                for (_, fix) in ide::allowing(&edited, std::slice::from_ref(&one), Span::at(one.span.start as usize)) {
                    let text = TextEdit::apply_all(&fix.edits, &lines.concat());
                    let left = judged(Notation::FxIl, &text);
                    let moved = one.span.start as usize + text.len() - lines.concat().len();
                    let is_left = |other: &Diagnostic| other.code == one.code && other.span.start as usize == moved;
                    prop_assert!(!left.iter().any(is_left), "{}\n{}", one.code, text);
                }
            }
        }
    }
}

#[test]
fn fixes_make_what_they_say() {
    let drawn = |above: &str, below: &str| {
        let rung = |contact: &str, coil: &str| format!("|  {contact}        {coil}  |\n+--| |-------( )-+\n");
        let (above, below) = (above.split_once(' ').unwrap(), below.split_once(' ').unwrap());
        format!("{}\n{}", rung(above.0, above.1), rung(below.0, below.1))
    };
    for (notation, text, code, expected) in [
        (
            Notation::FxIl,
            "LD X0\nOR X3\nOUT Y0\n// why\nLD X1\nAND X2\nOUT Y0\nEND\n".to_string(),
            "double-coil",
            "// why\nLD X1\nAND X2\nLD X0\nOR X3\nORB\nOUT Y0\nEND\n".to_string(),
        ),
        (
            Notation::FxIl,
            "  LD X0\r\n  OUT Y0\r\n  LD X1\r\n  OUT Y0\r\n  END\r\n".to_string(),
            "double-coil",
            "  LD X1\r\n  LD X0\r\n  ORB\r\n  OUT Y0\r\n  END\r\n".to_string(),
        ),
        (
            Notation::FxIl,
            "; a\nLD M0\nOUT Y0\n; b\nLD X0\nOUT M0\nEND\n".to_string(),
            "read-before-write",
            "; b\nLD X0\nOUT M0\n; a\nLD M0\nOUT Y0\nEND\n".to_string(),
        ),
        (Notation::Ladder, drawn("M0 Y0", "X0 M0"), "read-before-write", drawn("X0 M0", "M0 Y0") + "\n"),
        (
            Notation::FxIl,
            "LD X0\nOUT Y0\nLD X1\nANI X2\nOUT M0\nEND\n".to_string(),
            "written-never-read",
            "LD X0\nOUT Y0\nEND\n".to_string(),
        ),
    ] {
        let found = judged(notation, &text);
        let found = found.iter().find(|one| one.code == code).expect("told");
        let mended = TextEdit::apply_all(&found.fixes[0].edits, &text);
        assert_eq!(mended.trim_end(), expected.trim_end(), "{code}");
        assert_eq!(told(notation, &mended, Some(code)), [""; 0], "{mended}");
    }
    // Of rungs with more than one output, with labels or step numbers, there is no such fix.
    for text in [
        "LD X0\nOUT Y1\nOUT Y0\nLD X1\nOUT Y0\nEND\n",
        "LD X0\nMPS\nAND X1\nOUT Y1\nMPP\nOUT Y0\nLD X1\nOUT Y0\nEND\n",
        "0 LD X0\n1 OUT Y0\n2 LD X1\n3 OUT Y0\n4 END\n",
        "LD X0\nCJ P1\nLD M0\nP1\nLD M0\nOUT Y0\nLD X2\nOUT M0\nEND\n",
    ] {
        let found = judged(Notation::FxIl, text);
        let wanted = |one: &&Diagnostic| matches!(one.code, "double-coil" | "read-before-write");
        assert!(found.iter().filter(wanted).all(|one| one.fixes.is_empty()), "{text}");
    }
}

#[test]
fn codes_are_proposed_where_something_is_allowed() {
    let labels = |text: &str| {
        let offset = text.find('$').expect("a cursor");
        let document = document(Notation::FxIl, &text.replace('$', ""));
        let found = ide::completions(&document, offset, rungwise::text::Language::English);
        found.into_iter().map(|one| one.label).collect::<Vec<_>>()
    };
    assert_eq!(labels("// rungwise: allow(double$)\nLD X0\nOUT Y0\nEND\n"), ["double-coil"]);
    assert_eq!(
        labels("(* rungwise: allow(double-coil, latched$) *)\nLD X0\nOUT Y0\nEND\n"),
        ["latched-range"]
    );
    assert!(labels("// rungwise: allow($)\nLD X0\nOUT Y0\nEND\n").len() > 30);
    for text in ["// rungwise: allow(double-coil) d$\n", "// double$\n", "// rungwise: allow(syntax-e$)\n"] {
        assert_eq!(labels(text), [""; 0], "{text}");
    }
}

#[test]
fn the_server_offers_to_allow() {
    const URI: &str = "file:///tmp/allowed.il";
    let mut client = Client::start();
    client.open(URI, "plc-il", TWICE);
    // The rules about whole programs may follow the others in a message of their own.
    let awaits = |version: i64, wanted: &[&str], client: &mut Client| {
        client.wait_for(&format!("{wanted:?}"), |message| {
            message["params"]["version"] == json!(version)
                && message["params"]["diagnostics"].as_array().is_some_and(|found| codes(found) == wanted)
        });
    };
    awaits(1, &["double-coil", "double-coil"], &mut client);
    let line = |line: u32, column: u32| json!({"line": line, "character": column});
    let actions = client.request(
        "textDocument/codeAction",
        json!({"textDocument": {"uri": URI}, "range": {"start": line(1, 4), "end": line(1, 4)},
            "context": {"diagnostics": []}}),
    );
    let actions = actions["result"].as_array().expect("actions").clone();
    let allow = actions.iter().find(|action| action["title"] == json!("Allow double-coil for this rung"));
    let edit = &allow.expect("offered")["edit"];
    assert!(edit.to_string().contains("// rungwise: allow(double-coil)\\n"), "{edit}");
    assert!(actions.iter().any(|action| action["title"] == json!("Allow double-coil in this file")));
    client.change(URI, 2, (0, 0), (0, 0), "// rungwise: allow(double-coil)\n");
    awaits(2, &["double-coil"], &mut client);
    client.change(URI, 3, (0, 19), (0, 30), "latched-range");
    awaits(3, &["unused-suppression", "double-coil", "double-coil"], &mut client);
}
