//! Relays and registers by which the CPU tells of itself and is ordered about, and the depth of its calls.

use crate::simulate::Plc;
use rungwise::simulate::{ErrorKind, Outcome};

#[test]
fn a_step_is_not_left_while_transfers_are_forbidden() {
    let text = "LD X5\nOUT M8040\nLD M8002\nSET S0\nSTL S0\nLD X0\nSET S20\nSTL S20\nOUT Y0\nLD X1\nSET S21\n\
                STL S21\nOUT Y1\nRET\nEND\n";
    let mut plc = Plc::list(text);
    plc.scans(2).check("S0 ~S20 ~Y0");
    plc.set("X5 X0").scans(3).check("S0 ~S20 ~Y0");
    // The condition is as good in a later scan.
    plc.set("X5=0").scans(2).check("~S0 S20 Y0");
    plc.set("X5 X0=0 X1").scans(3).check("S20 Y0 ~S21 ~Y1");
    // Coils of the step that stays are driven on.
    plc.set("X1=0").scans(1).set("X5=0").scans(3).check("S20 Y0 ~S21 ~Y1");
    plc.set("X1").scans(2).check("~S20 ~Y0 S21 Y1");
}

#[test]
fn scan_times_are_told_in_tenths_of_a_millisecond_with_the_least_and_the_greatest() {
    let mut plc = Plc::list("LD M8000\nMOV D8010 D0\nEND\n");
    plc.scans(1).check("D8010=0");
    plc.scans(1).check("D8010=100 D8011=100 D8012=100 D0=100");
    // A scan is as long as the way to the next one, which sees it.
    plc.scan_ms = 7;
    plc.scans(1).check("D8010=100").scans(1).check("D8010=70 D8011=70 D8012=100 D0=70");
    plc.scan_ms = 25;
    plc.scans(2).check("D8010=250 D8011=70 D8012=250");
    plc.scan_ms = 10;
    plc.scans(2).check("D8010=100 D8011=70 D8012=250");
    // What does not fit in a register is the greatest number.
    plc.scan_ms = 60_000;
    plc.scans(2).check("D8010=32767 D8012=32767 D8011=70");
}

#[test]
fn the_clock_of_a_minute_is_off_for_thirty_seconds_and_on_for_thirty() {
    let mut plc = Plc::list("LD M8014\nOUT C0 K100\nLDP M8014\nINC D0\nEND\n");
    let mut edges = Vec::new();
    let mut before = false;
    for scan in 0..30_001i64 {
        plc.scans(1);
        let on = plc.on("M8014");
        if on != before {
            edges.push((scan * 10, on));
        }
        before = on;
    }
    let expected: Vec<(i64, bool)> = (1..=10).map(|half| (half * 30_000, half % 2 == 1)).collect();
    assert_eq!(edges, expected);
    plc.check("D0=5");
}

/// So many routines, each of which counts in D0 and calls the next one.
fn routines(count: u32) -> String {
    let mut text = "LD M8000\nINC D1\nCALL P0\nINC D2\nFEND\n".to_string();
    for number in 0..count {
        text += &format!("P{number}\nLD M8000\nINC D0\n");
        if number + 1 < count {
            text += &format!("CALL P{}\n", number + 1);
        }
        text += "SRET\n";
    }
    text + "END\n"
}

#[test]
fn calls_nest_five_deep_and_the_sixth_is_not_executed() {
    let mut plc = Plc::list(&routines(5));
    plc.scans(2).check("D0=10 D1=2 D2=2");
    let text = routines(6);
    let mut plc = Plc::list(&text);
    let of = |outcome: &Outcome| {
        let [error] = &outcome.errors[..] else { panic!("{:?}", outcome.errors) };
        let span = error.place.expect("a place").span;
        (error.kind, text[span.start as usize..span.end as usize].to_string())
    };
    let outcome = plc.scan();
    assert_eq!(of(&outcome), (ErrorKind::TooDeep, "CALL P5".to_string()));
    // What is behind it is.
    plc.check("D0=5 D1=1 D2=1 M8067 M8068 M8004 D8067=6702 D8004=8067");
    // The next scan begins at the top, with nothing left of the calls.
    let outcome = plc.scan();
    assert_eq!(of(&outcome).0, ErrorKind::TooDeep);
    plc.check("D0=10 D1=2 D2=2");
    // A routine that calls itself is stopped in the same way.
    let text = "LD M8000\nCALL P0\nFEND\nP0\nLD M8000\nINC D0\nCALL P0\nSRET\nEND\n";
    let mut plc = Plc::list(text);
    assert_eq!(plc.scan().errors.first().map(|error| error.kind), Some(ErrorKind::TooDeep));
    plc.check("D0=5");
}

#[test]
fn loops_nest_five_deep_and_the_sixth_is_passed_over() {
    let nested = |depth: usize| {
        format!("{}LD M8000\nINC D0\n{}END\n", "FOR K2\n".repeat(depth), "NEXT\n".repeat(depth))
    };
    Plc::list(&nested(5)).scans(1).check("D0=32");
    let mut plc = Plc::list(&nested(6).replace("END", "LD M8000\nINC D1\nEND"));
    let outcome = plc.scan();
    assert_eq!(outcome.errors.first().map(|error| error.kind), Some(ErrorKind::TooDeep));
    plc.check("D0=0 D1=1 M8067 D8067=6704 D8004=8067 ~M8061");
}

#[test]
fn what_has_nothing_to_go_back_to_is_not_executed() {
    let mut plc = Plc::list("LD M8000\nINC D0\nSRET\nLD M8000\nINC D1\nEND\n");
    let outcome = plc.scan();
    assert_eq!(outcome.errors.first().map(|error| error.kind), Some(ErrorKind::NothingToReturnTo));
    plc.check("D0=1 D1=1 M8067 D8067=6709");
}

#[test]
fn the_watchdog_stops_the_cpu_until_it_is_switched_off() {
    let mut plc = Plc::list("LD M8000\nINC D0\nLD X0\nOUT Y0\nP0\nLD X1\nCJ P0\nEND\n");
    plc.set("X0").scans(2).check("D0=2 Y0 ~M8061 ~M8004");
    plc.set("X1");
    let outcome = plc.scan();
    assert_eq!(outcome.errors.first().map(|error| error.kind), Some(ErrorKind::Watchdog));
    // Outputs are off; registers can be looked at.
    plc.check("D0=3 ~Y0 M8061 M8004 D8061=6105 D8004=8061 ~M8067");
    plc.set("X1=0");
    assert_eq!(plc.scan().errors, []);
    plc.check("D0=3 ~Y0 ~M8000");
    plc.set("M8061=0").scans(1).check("D0=4 Y0 M8000");
}
