//! Programs that are wrong, through the binary: each is told at its place, and no command stops at them.

use crate::binary::{folder, run};
use serde_json::Value;

/// A subroutine that calls itself.
const SELF: &str = "LD X0\nCALL P0\nFEND\nP0\nLD X1\nOUT Y0\nLD X2\nCALL P0\nSRET\nEND\n";
/// Two that call each other.
const MUTUAL: &str = "LD X0\nCALL P0\nFEND\nP0\nLD X1\nCALL P1\nSRET\nP1\nLD X2\nCALL P0\nSRET\nEND\n";
const OPEN: &str = "PROGRAM p\nVAR a, b, c : BOOL; END_VAR\nLD a\nAND( b\nST c\nEND_PROGRAM\n";
const NOWHERE: &str = "PROGRAM p\nVAR a, b : BOOL; END_VAR\nLD a\nJMPC nowhere\nST b\nEND_PROGRAM\n";
const CONTAINS_ITSELF: &str = "FUNCTION_BLOCK A\nVAR own : A; END_VAR\nCAL own()\nEND_FUNCTION_BLOCK\n\
    PROGRAM p\nVAR x : A; END_VAR\nCAL x()\nEND_PROGRAM\n";

/// What a command says of a program: its code, and both streams.
fn said(words: &[&str], text: &str) -> (i32, String, String) {
    let folder = folder(&[("a.il", text)]);
    let ended = run(&folder, words);
    assert!(!ended.2.contains("panicked") && !ended.2.contains("overflowed"), "{words:?}: {}", ended.2);
    ended
}

/// The only error that `check` finds, as place, code and the rest of its line.
fn check(text: &str, place: &str, code: &str, message: &str) {
    let (ended, out, _) = said(&["check", "a.il"], text);
    let errors: Vec<&str> = out.lines().filter(|line| line.contains(": error[")).collect();
    assert_eq!((ended, errors), (1, vec![&*format!("a.il:{place}: error[{code}]: {message}")]), "{text}");
}

#[test]
fn blocks_and_branches_that_do_not_pair_are_told_at_their_place() {
    let never = "the block that `LD X1` begins is never joined with the one before: ANB, ORB or an output is \
        missing before `OUT Y0`";
    check("LD X0\nLD X1\nOUT Y0\nEND\n", "2:1", "block-stack", never);
    let lonely = "ANB joins two blocks, but 1 begun by LD wait here";
    check("LD X0\nANB\nOUT Y0\nEND\n", "2:1", "block-stack", lonely);
    let unpaired = "MPP goes back to a branching point, but no MPS is open here";
    check("LD X0\nMPP\nOUT Y0\nEND\n", "2:1", "branch-stack", unpaired);
    check(OPEN, "4:4", "unclosed-parenthesis", "this parenthesis is not closed");
}

#[test]
fn recursion_is_told_as_the_way_back_to_where_it_began() {
    check(SELF, "8:6", "nesting-too-deep", "a subroutine calls itself: P0 → P0");
    check(MUTUAL, "6:6", "nesting-too-deep", "a subroutine calls itself: P0 → P1 → P0");
    check(CONTAINS_ITSELF, "2:11", "recursive-pou", "A contains itself: A → A");
    // A loop of subroutines that is entered from outside is named without the way to it.
    let entered = SELF.replace("CALL P0\nFEND\nP0", "CALL P7\nFEND\nP7\nLD X3\nCALL P0\nSRET\nP0");
    check(&entered, "12:6", "nesting-too-deep", "a subroutine calls itself: P0 → P0");
}

#[test]
fn labels_that_stand_nowhere_are_told_at_the_jump() {
    let missing = "the label `P5` stands nowhere";
    check("LD X0\nCJ P5\nLD X1\nOUT Y0\nEND\n", "2:4", "undefined-label", missing);
    check(NOWHERE, "4:6", "undefined-label", "the label `nowhere` stands nowhere");
}

/// To run what was made of the rest would show a program that nobody wrote.
#[test]
fn what_cannot_be_read_is_not_run() {
    let head = "PROGRAM p\nVAR a, b : BOOL; END_VAR\n";
    let refused = [
        (OPEN.to_string(), "4:4: this parenthesis is not closed"),
        (format!("{head}LD a )\nST b\nEND_PROGRAM\n"), "3:6: `)` without `(`"),
        (format!("{head}LD a b\nST b\nEND_PROGRAM\n"), "3:6: expected end of line, found `b`"),
        (format!("{head}LD a (* \nST b\nEND_PROGRAM\n"), "3:6: this comment does not end"),
        (head.replace(" END_VAR", "") + "LD a\nST b\nEND_PROGRAM\n", "2:1: VAR lacks its END_VAR"),
    ];
    for (text, reason) in refused {
        let (code, out, err) = said(&["run", "--scans", "2", "a.il"], &text);
        let first = err.lines().next().unwrap_or_default();
        assert_eq!((code, out.as_str()), (1, ""), "{text}{err}");
        assert_eq!(first, format!("error[simulation]: a.il:{reason}"));
    }
    // What a PLC would run runs, with a word of caution.
    let (code, out, err) = said(&["run", "--scans", "2", "a.il"], "LD X0\nLD X1\nOUT Y0\nEND\n");
    assert_eq!((code, out.is_empty()), (0, false), "{err}");
    assert!(err.starts_with("warning[check]: the program runs, but `rungwise check` finds errors"), "{err}");
}

#[test]
fn a_rung_of_a_subroutine_says_that_only_a_call_leads_to_it() {
    let (code, _, err) = said(&["translate", "a.il", "--to", "iec"], SELF);
    let reason = "this rung is kept as it is: it stands behind `FEND`, where only a call, a jump or an interrupt leads";
    assert_eq!((code, err.lines().filter(|line| line.ends_with(reason)).count()), (1, 3), "{err}");
}

/// Each of these is one rung of 100,000 instructions, which no PLC has room for.
#[test]
fn a_hundred_thousand_instructions_in_a_rung_stop_no_command() {
    let half = 50_000;
    for body in [
        "AND X1\n".repeat(2 * half),
        "OR X1\n".repeat(2 * half),
        "LD X1\nORB\n".repeat(half),
        "AND X1\nOR X2\n".repeat(half),
        "OUT Y0\n".repeat(2 * half),
        "INV\n".repeat(2 * half),
        "LD X1\n".repeat(half) + &"ANB\n".repeat(half),
        "MPS\nAND X1\n".repeat(half / 2) + "OUT Y0\n" + &"MPP\nOUT Y1\n".repeat(half / 2),
    ] {
        let text = format!("LD X0\n{body}OUT Y2\nEND\n");
        let (code, out, _) = said(&["check", "--format", "json", "a.il"], &text);
        let told: Value = serde_json::from_str(&out).unwrap();
        let found = told["files"][0]["diagnostics"].as_array().unwrap();
        let codes: Vec<&str> = found.iter().filter_map(|found| found["code"].as_str()).collect();
        assert!(code == 1 && codes.contains(&"program-too-large"), "{codes:?}");
        for to in ["ladder", "boolean"] {
            let (code, out, err) = said(&["translate", "a.il", "--to", to], &text);
            // What has no other form is there as it was, and that is told.
            let is_kept = err.starts_with("a.il:1: this rung is kept as it is: ");
            assert!(code == 0 || (code == 1 && is_kept), "{to}: {err}");
            assert!(out.contains("Y2") && (!is_kept || out.contains("OUT Y2")), "{to}: {err}");
        }
        let (code, out, _) = said(&["prove", "a.il", "a.il"], &text);
        assert!(code == 0 && out.starts_with("equal: "), "{out}");
        assert_eq!(said(&["run", "--scans", "2", "a.il", "--watch", "Y2"], &text).0, 0);
        let (code, _, err) = said(&["encode", "a.il"], &text);
        assert!(code == 1 && err.starts_with("a.il:16001:1: error[no-machine-code]: "), "{err}");
    }
}
