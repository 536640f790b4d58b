//! Lists that a drawing carries along in boxes `{il … }` run as the lists that they are.

use crate::binary::{folder, run};
use serde_json::Value;
use tempfile::TempDir;

/// A contact in parallel with what already drives an output has no drawing.
const CALCULATED_BITS: &str = "LDI Y0\nOUT Y0\nOR X1\nOUT Y1\nLD X2\nANB\nOUT Y2\nLD X3\nOUT T0 K2\nOR X1\nSET M2\n\
    LD X0\nCALL P0\nFEND\nP0\nLD X1\nOUT Y3\nOR X2\nOUT Y4\nSRET\nEND\n";
/// Nor has what calculates with the current result.
const CALCULATED_WORDS: &str = "PROGRAM p\nVAR a, b : INT; c, d, x : BOOL; t : TON; END_VAR\nLD a\nADD b\nMUL 3\n\
    GT 10\nST c\nLD c\nJMPCN over\nLD a\nADD( b\nMUL 2\n)\nST b\nover:\nLD c\nAND d\nST d\nLD b\nSUB( a\nDIV 3\n)\nST a\n\
    CAL t(IN := x, PT := T#20ms)\nLD t.Q\nST d\nEND_PROGRAM\n";

/// A folder with a list, and with the drawing of it, which must have boxes.
fn drawn(list: &str) -> TempDir {
    let folder = folder(&[("p.il", list)]);
    let (code, _, err) = run(&folder, &["translate", "p.il", "--to", "ladder", "-o", "p.lad"]);
    assert_eq!(code, 0, "{err}");
    let drawing = std::fs::read_to_string(folder.path().join("p.lad")).unwrap();
    assert!(drawing.contains("{il\n") && drawing.contains("---| |---"), "{drawing}");
    folder
}

/// Runs a list and its drawing with these settings; both show the same values in every scan.
fn check(list: &str, settings: &[&str]) {
    let folder = drawn(list);
    let shown = |file: &str| {
        let set = settings.iter().flat_map(|setting| ["--set", setting]);
        let words = ["run", file, "--scans", "12", "--format", "json"];
        let (code, out, err) = run(&folder, &words.into_iter().chain(set).collect::<Vec<_>>());
        assert_eq!(code, 0, "{err}");
        serde_json::from_str::<Value>(&out).unwrap()["scans"].clone()
    };
    let scans = shown("p.il");
    assert!(scans.as_array().unwrap().len() > 5, "{scans}");
    assert_eq!(shown("p.lad"), scans);
}

#[test]
fn a_drawing_runs_as_the_list_of_which_it_carries_parts_along() {
    check(CALCULATED_BITS, &["X1=1@20ms", "X1=0@40ms", "X2=1@30ms", "X3=1@50ms", "X0=1@60ms"]);
    check(CALCULATED_WORDS, &["a=1", "b=2@30ms", "x=1@40ms", "x=0@100ms"]);
}

/// Why devices are as they are, without the places.
fn because(folder: &TempDir, file: &str, setting: &str, names: &[&str]) -> Vec<String> {
    let asked = names.iter().flat_map(|name| ["--why", name]);
    let words = ["run", file, "--scans", "8", "--set", setting];
    let (code, out, err) = run(folder, &words.into_iter().chain(asked).collect::<Vec<_>>());
    assert_eq!(code, 0, "{err}");
    out.lines().filter_map(|line| Some(line.split_once("  [p.")?.0.to_string())).collect()
}

#[test]
fn why_follows_a_device_into_a_list_that_is_carried_along() {
    let bits = drawn(CALCULATED_BITS);
    for setting in ["X2=1@30ms", "X1=1@40ms"] {
        let said = |file| because(&bits, file, setting, &["Y0", "Y1", "Y2", "Y1@10ms"]);
        assert_eq!(said("p.lad"), said("p.il"));
        assert!(said("p.lad").contains(&"Y1 is off: OUT Y1 has no power".to_string()), "{:?}", said("p.lad"));
    }
    let (_, out, _) = run(&bits, &["run", "p.lad", "--scans", "2", "--why", "Y1", "--set", "X1=1"]);
    assert!(out.contains("Y1 is on: OUT Y1 has power  [p.lad:5]"), "{out}");
    let words = drawn(CALCULATED_WORDS);
    let (_, out, _) =
        run(&words, &["run", "p.lad", "--scans", "4", "--set", "a=5", "--why", "c", "--why", "b"]);
    assert!(
        out.contains("c is on: ST c is executed  [p.lad:9]\n  this is calculated: LD a, ADD b, MUL 3, GT 10"),
        "{out}"
    );
}

#[test]
fn a_drawn_calculation_is_named_by_what_it_calculates() {
    let list = CALCULATED_WORDS.replace("ADD( b\nMUL 2\n)\nST b", "ADD 5\nST b");
    let folder = drawn(&list);
    let (_, out, err) = run(&folder, &["run", "p.lad", "--scans", "4", "--set", "a=5", "--why", "b"]);
    assert!(out.contains(": ADD has power  [p.lad:"), "{out}{err}");
}

#[test]
fn what_a_list_in_a_box_lacks_is_told_at_its_line() {
    let text = "{il\nLD X0\nOUT Y0\nOR X1\nCJ P9\n}\n\n|   X0        Y1 |\n+---| |------( )-+\n";
    let files = folder(&[("p.lad", text)]);
    let (code, _, err) = run(&files, &["run", "p.lad"]);
    assert_eq!((code, err.contains("p.lad:5:1: there is no label P9 to jump to")), (1, true), "{err}");
}
