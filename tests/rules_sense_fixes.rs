//! Fixes of the rules about program sense: what they make of a program, and where there is none.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::text::TextEdit;

/// The program as the first fix of the first finding under `code` makes it; nothing if there is no fix.
fn mended(code: &str, text: &str) -> Option<String> {
    let notation = if text.contains('|') { Notation::Ladder } else { Notation::FxIl };
    let document = Document::new(text, notation, Target::of(Model::Fx2n));
    let found = check::all(&document, &Severities::default());
    let one = found.iter().find(|one| one.code == code).unwrap_or_else(|| panic!("{code} in\n{text}"));
    one.fixes.first().map(|fix| TextEdit::apply_all(&fix.edits, text))
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
