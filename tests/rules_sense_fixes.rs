//! Fixes of the rules about program sense: what they make of a program, and where there is none.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::text::TextEdit;

/// The program as each fix of the first finding under `code` makes it.
fn all_mended(code: &str, text: &str) -> Vec<String> {
    let (notation, model) = match text {
        text if text.contains('|') => (Notation::Ladder, Model::Fx2n),
        text if text.contains("END_PROGRAM") => (Notation::IecIl, Model::Iec),
        _ => (Notation::FxIl, Model::Fx2n),
    };
    let document = Document::new(text, notation, Target::of(model));
    let found = check::all(&document, &Severities::default());
    let one = found.iter().find(|one| one.code == code).unwrap_or_else(|| panic!("{code} in\n{text}"));
    one.fixes.iter().map(|fix| TextEdit::apply_all(&fix.edits, text)).collect()
}

/// The same of the first fix; nothing if there is none.
fn mended(code: &str, text: &str) -> Option<String> {
    all_mended(code, text).into_iter().next()
}

/// Of lists whose lines are parted by `; `: what the fixes of the first make of it.
fn assert_all_mend(code: &str, program: &str, expected: &[&str]) {
    let text = |lines: &str| lines.split("; ").map(|line| format!("{line}\n")).collect::<String>();
    let expected: Vec<String> = expected.iter().map(|one| text(one)).collect();
    assert_eq!(all_mended(code, &text(program)), expected, "{program}");
}

/// Lists whose lines are parted by `; `: the fix of the first makes the second.
fn assert_mends(code: &str, program: &str, expected: &str) {
    let text = |lines: &str| lines.split("; ").map(|line| format!("{line}\n")).collect::<String>() + "END\n";
    assert_eq!(mended(code, &text(program)), Some(text(expected)), "{program}");
}

#[test]
fn the_next_free_timer_or_counter_is_driven() {
    assert_mends(
        "reused-timer",
        "LD X0; OUT T0 K5; LD X1; OUT T0 K9; LD T0; OUT T1 K3; LD T1; OUT Y0",
        "LD X0; OUT T0 K5; LD X1; OUT T2 K9; LD T0; OUT T1 K3; LD T1; OUT Y0",
    );
    // Timers of one clock end at T199, and T199 is the only one left.
    assert_mends(
        "reused-timer",
        "LD X0; OUT T198 K5; LD X1; OUT T198 K9; LD T198; OUT Y0",
        "LD X0; OUT T198 K5; LD X1; OUT T199 K9; LD T198; OUT Y0",
    );
    assert_eq!(
        mended("reused-timer", "LD X0\nOUT T199 K5\nLD X1\nOUT T199 K9\nLD T199\nOUT Y0\nEND\n"),
        None
    );
    assert_mends(
        "reused-counter",
        "LD X0; OUT C3 K5; LD X1; OUT C3 K9; LD C3; OUT Y0; LD X5; RST C3",
        "LD X0; OUT C3 K5; LD X1; OUT C4 K9; LD C3; OUT Y0; LD X5; RST C3",
    );
}

#[test]
fn a_number_of_32_bits_gets_a_pair_of_its_own() {
    assert_mends(
        "overlapping-words",
        "LD X0; DMOV K100000 D0; MOV K1 D1; DMOV D0 D20; MOV D1 D30; MOV D5 D2",
        "LD X0; DMOV K100000 D6; MOV K1 D1; DMOV D6 D20; MOV D1 D30; MOV D5 D2",
    );
    // Where one half of it is used as a word, nobody knows what was meant.
    let halved = "LD X0\nDMOV K100000 D0\nMOV K1 D1\nMOV D0 D30\nMOV D1 D31\nEND\n";
    assert_eq!(mended("overlapping-words", halved), None);
}

#[test]
fn what_is_never_on_needs_no_reset() {
    assert_mends(
        "reset-without-set",
        "LD X1; OUT Y1; LD X0; ANI X2; RST M0; LD M0; OUT Y0",
        "LD X1; OUT Y1; LD M0; OUT Y0",
    );
    // It may be on from the day before, or the rung does something else as well.
    assert_eq!(mended("reset-without-set", "LD X0\nRST M600\nLD M600\nOUT Y0\nEND\n"), None);
    assert_eq!(mended("reset-without-set", "LD X0\nOUT Y1\nRST M0\nLD M0\nOUT Y0\nEND\n"), None);
}

#[test]
fn a_coil_that_is_only_reset_elsewhere_sets() {
    assert_mends("coil-and-set-reset", "LD X0; OUT Y0; LD X1; RST Y0", "LD X0; SET Y0; LD X1; RST Y0");
    let drawn = "|  X0    Y0  |\n+--| |---( )-+\n|  X1    Y0  |\n+--| |---(R)-+\n";
    assert_eq!(mended("coil-and-set-reset", drawn), Some(drawn.replace("( )", "(S)")));
    // With a set beside it, either may be the mistake.
    assert_eq!(mended("coil-and-set-reset", "LD X0\nOUT Y0\nLD X1\nSET Y0\nLD X2\nRST Y0\nEND\n"), None);
}

#[test]
fn a_jump_finds_its_label_or_gets_one() {
    // The label to which nothing else leads comes before one with a nearer number.
    assert_all_mend(
        "undefined-label",
        "LD X0; CJ P2; LD X1; CJ P3; P3; LD X2; OUT Y0; P9; LD X3; OUT Y1; END",
        &[
            "LD X0; CJ P9; LD X1; CJ P3; P3; LD X2; OUT Y0; P9; LD X3; OUT Y1; END",
            "LD X0; CJ P2; LD X1; CJ P3; P3; LD X2; OUT Y0; P9; LD X3; OUT Y1; P2; END",
        ],
    );
    // What is called stands behind FEND, which is put there with it.
    assert_all_mend("undefined-label", "LD X0; CALL P2; END", &["LD X0; CALL P2; FEND; P2; SRET; END"]);
    assert_all_mend(
        "undefined-label",
        "LD X0; CALL P2; LD X1; CJ P1; P1; FEND; P3; LD X1; OUT Y1; SRET; END",
        &[
            "LD X0; CALL P3; LD X1; CJ P1; P1; FEND; P3; LD X1; OUT Y1; SRET; END",
            "LD X0; CALL P2; LD X1; CJ P1; P1; FEND; P3; LD X1; OUT Y1; SRET; P2; SRET; END",
        ],
    );
    assert_all_mend(
        "undefined-label",
        "PROGRAM A; VAR b : BOOL; END_VAR; LD b; JMPC Redy; ST b; Ready: LD b; ST b; END_PROGRAM",
        &[
            "PROGRAM A; VAR b : BOOL; END_VAR; LD b; JMPC Ready; ST b; Ready: LD b; ST b; END_PROGRAM",
            "PROGRAM A; VAR b : BOOL; END_VAR; LD b; JMPC Redy; ST b; Ready: LD b; ST b; Redy:; END_PROGRAM",
        ],
    );
}

#[test]
fn a_label_leaves_the_loop_into_which_a_jump_went() {
    assert_all_mend(
        "jump-into-loop",
        "LD X0; CJ P1; FOR K2; FOR K3; LD X1; INC D0; P1; LD X2; INC D1; NEXT; NEXT; END",
        &["LD X0; CJ P1; P1; FOR K2; FOR K3; LD X1; INC D0; LD X2; INC D1; NEXT; NEXT; END"],
    );
    // Only the inner loop is entered.
    assert_all_mend(
        "jump-into-loop",
        "FOR K2; LD X0; CJ P1; FOR K3; LD X1; INC D0; P1; LD X2; INC D1; NEXT; NEXT; END",
        &["FOR K2; LD X0; CJ P1; P1; FOR K3; LD X1; INC D0; LD X2; INC D1; NEXT; NEXT; END"],
    );
    // One who jumps to it within the loop would begin that anew.
    let inside = "LD X0; CJ P1; FOR K3; LD X1; CJ P1; INC D0; P1; LD X2; INC D1; NEXT; END";
    assert_all_mend("jump-into-loop", inside, &[]);
}

#[test]
fn what_is_set_and_never_reset_gets_a_coil_or_a_reset() {
    let coil = "LD X0; OUT Y0; LD X1; RST Y1; END";
    let reset = "LD X0; SET Y0; LD X1; RST Y0; END";
    assert_all_mend("set-without-reset", "LD X0; SET Y0; LD X1; RST Y1; END", &[coil, reset]);
    let drawn = "|  X0    Y0  |\n+--| |---(S)-+\n";
    assert_eq!(all_mended("set-without-reset", drawn), [drawn.replace("(S)", "( )")]);
    // A coil behind an edge is on for one scan, and two would be a double coil.
    assert_all_mend("set-without-reset", "LDP X0; SET Y0; END", &[]);
    assert_all_mend("set-without-reset", "LD X0; SET Y0; LD X1; SET Y0; END", &[]);
}

#[test]
fn what_is_never_written_is_read_from_what_nobody_reads() {
    assert_all_mend(
        "read-never-written",
        "LD X0; OUT M12; LD X1; OUT M19; LD M19; OUT Y1; LD M20; OUT Y0; LDI M20; OUT Y2; END",
        &["LD X0; OUT M12; LD X1; OUT M19; LD M19; OUT Y1; LD M12; OUT Y0; LDI M12; OUT Y2; END"],
    );
    assert_all_mend(
        "read-never-written",
        "LD X1; OUT M19; LD M19; OUT Y1; LD M20; OUT Y0; END",
        &["LD X1; OUT M19; LD M19; OUT Y1; LD M19; OUT Y0; END"],
    );
    assert_all_mend("read-never-written", "LD X1; OUT M17; LD M17; OUT Y1; LD M20; OUT Y0; END", &[]);
    // A name of another length would move what stands behind it in a drawing: a shorter one is filled up.
    let drawn = "|  X0    T5 K9 |\n+--| |---( )---+\n|  T12     Y0  |\n+--| |-----( )-+\n";
    assert_eq!(all_mended("read-never-written", drawn), [drawn.replace("T12", "T5 ")]);
    let unit = "PROGRAM A; VAR; I AT %IX0.0 : BOOL; O AT %QX0.0 : BOOL; Ready : BOOL; Reday : BOOL; END_VAR; \
                LD I; ST Ready; LD Reday; ST O; END_PROGRAM";
    assert_all_mend("read-never-written", unit, &[&unit.replace("LD Reday", "LD Ready")]);
}

#[test]
fn what_belongs_to_the_cpu_is_left_to_it() {
    assert_all_mend(
        "special-device-written",
        "LD M0; OUT Y0; LD X1; OUT M0; LD X0; OUT M8013; END",
        &["LD M0; OUT Y0; LD X1; OUT M0; LD X0; OUT M1; END", "LD M0; OUT Y0; LD X1; OUT M0; END"],
    );
    let drawn = "|  X0              |\n+--| |-[MOV K0 D8010]-+\n";
    assert!(all_mended("special-device-written", drawn)[0].contains("[MOV K0 D0   ]"));
}

#[test]
fn an_edge_is_taken_where_every_scan_comes() {
    assert_all_mend(
        "edge-in-skipped-code",
        "LD X10; CJ P1; LD X2; ANDF X0; SET Y0; LD X1; RST Y0; P1; LD X2; OUT Y1; END",
        &["LD X0; PLF M0; LD X10; CJ P1; LD X2; AND M0; SET Y0; LD X1; RST Y0; P1; LD X2; OUT Y1; END"],
    );
    // A relay has its edge in the middle of a scan.
    let relay = "LD X0; OUT M5; LD X10; CJ P1; LDP M5; SET Y0; LD X1; RST Y0; P1; LD X2; OUT Y1; END";
    assert_all_mend("edge-in-skipped-code", relay, &[]);
}

#[test]
fn the_later_of_two_outputs_is_locked() {
    assert_all_mend(
        "mutual-exclusion",
        "// rungwise: never Y0 & Y1; LD X0; OUT Y0; LD X1; OR X2; OUT Y1; END",
        &["// rungwise: never Y0 & Y1; LD X0; OUT Y0; LD X1; OR X2; ANI Y0; OUT Y1; END"],
    );
    // The one that is set is so in any order, the coil comes last.
    assert_all_mend(
        "mutual-exclusion",
        "// rungwise: never Y1 & Y0; LD X0; SET Y0; LD X3; RST Y0; LD X1; OUT Y1; END",
        &["// rungwise: never Y1 & Y0; LD X0; SET Y0; LD X3; RST Y0; LD X1; ANI Y0; OUT Y1; END"],
    );
    // Nothing is added where it would be in the way of another output, or would not do.
    for open in [
        "// rungwise: never Y0 & Y1; LD X0; OUT Y0; LD X1; OUT Y1; OUT Y2; END",
        "// rungwise: never Y0 & Y1; LD X0; SET Y0; LD X1; SET Y1; END",
        "// rungwise: never Y0 & Y1; LD X0; OUT Y0; LD X1; OUT Y1; LD X2; OR Y0; OUT Y0; END",
        "// rungwise: never Y0 & Y1; LD X0; OUT Y0; LD X5; CJ P1; LD X1; OUT Y1; P1; END",
    ] {
        assert_all_mend("mutual-exclusion", open, &[]);
    }
}
