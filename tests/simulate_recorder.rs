//! What a recorder knows of variables is what they were, however the simulation came there.

use crate::simulate::switch;
use proptest::prelude::*;
use rungwise::document::{Document, Notation};
use rungwise::simulate::{Recorder, Session, Value, compile};
use rungwise::target::{Model, Target};
use std::sync::Arc;

const MS: i64 = 1_000_000;
const NAMES: [&str; 4] = ["X0", "Y0", "T200", "D0"];
/// A seal-in with a timer of 10 ms, and a register that changes in each scan of it.
const PROGRAM: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nOUT T200 K7\nLD Y0\nINC D0\nLD T200\nMOV K-3 D0\nEND\n";

struct Bench {
    session: Session,
    recorder: Recorder,
}

impl Bench {
    fn new(text: &str) -> Bench {
        let document = Document::new(text, Notation::FxIl, Target::of(Model::Fx3u));
        let code = compile(&[&document], false).expect("a program");
        Bench { session: Session::new(Arc::new(code)), recorder: Recorder::default() }
    }

    fn scan(&mut self, count: u64) {
        for _ in 0..count {
            let next = self.session.machine().scans() as i64 * 10 * MS;
            self.session.scan(next);
            self.recorder.note(self.session.machine());
        }
    }

    /// The changes between two scans, as the history of the session has them.
    fn truth(&self, name: &str, first: u64, last: u64) -> Vec<(u64, Value)> {
        let variable = self.session.machine().code().variable(name).expect("a variable");
        let mut changes: Vec<(u64, Value)> = Vec::new();
        self.session.walk(first, last, |machine| {
            let value = machine.value(variable, 0);
            if changes.last().is_none_or(|(_, before)| *before != value) {
                changes.push((machine.scans(), value));
            }
            true
        });
        changes
    }
}

fn names() -> Vec<String> {
    NAMES.map(str::to_string).to_vec()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_recorder_knows_what_variables_were(
        steps in proptest::collection::vec((0..4u8, 0..2u8, 1..400u64), 1..24),
        begin in 0..24usize,
        window in (0..2_000u64, 1..2_000u64),
    ) {
        let mut bench = Bench::new(PROGRAM);
        bench.scan(1);
        for (number, (kind, input, count)) in steps.into_iter().enumerate() {
            if number == begin {
                bench.recorder.record(&names(), bench.session.machine());
            }
            match kind {
                0 => switch(&mut bench.session, &format!("X{input}"), true),
                1 => switch(&mut bench.session, &format!("X{input}"), false),
                2 => bench.scan(count),
                _ => {
                    let back = bench.session.machine().scans().saturating_sub(count / 4).max(1);
                    bench.session.back_to(back);
                    bench.recorder.cut(bench.session.machine());
                }
            }
        }
        // Whoever is recorded from here on has a past that is found again.
        bench.recorder.record(&names(), bench.session.machine());
        bench.recorder.look_back(&bench.session, 1, || true);
        let last = bench.session.machine().scans();
        let first = (window.0 % last) + 1;
        let end = (first + window.1).min(last);
        for name in NAMES {
            let signal = bench.recorder.signal(name).expect("it is recorded");
            prop_assert_eq!(signal.since(), 1);
            prop_assert_eq!(signal.changes(1, last, usize::MAX), bench.truth(name, 1, last));
            prop_assert_eq!(signal.changes(first, end, usize::MAX), bench.truth(name, first, end));
        }
    }
}

#[test]
fn what_is_looked_back_into_comes_in_portions() {
    let mut bench = Bench::new(PROGRAM);
    bench.scan(20_000);
    bench.recorder.record(&names(), bench.session.machine());
    let mut portions = 0;
    let mut known = 20_000;
    while known > 1 && portions < 200 {
        let mut left = 1;
        bench.recorder.look_back(&bench.session, 1, || {
            left -= 1;
            left == 0
        });
        let since = bench.recorder.signal("D0").expect("it is recorded").since();
        assert!(since < known, "nothing of {known} was found");
        (known, portions) = (since, portions + 1);
    }
    assert!((2..200).contains(&portions), "{portions} portions");
}

#[test]
fn a_long_record_is_bounded_and_keeps_extremes() {
    let mut bench = Bench::new("LD M8000\nINC D0\nLD= D0 K30000\nMOV K-9 D0\nEND\n");
    bench.scan(1);
    bench.recorder.record(&["D0".to_string()], bench.session.machine());
    bench.scan(400_000);
    let signal = bench.recorder.signal("D0").expect("it is recorded");
    let all = signal.changes(1, 400_001, usize::MAX);
    assert!(all.len() <= 40_000, "{} changes", all.len());
    assert!(signal.exact_from() > 300_000, "{}", signal.exact_from());
    let values: Vec<i64> = all.iter().filter_map(|(_, value)| value.json().as_i64()).collect();
    assert_eq!((values.iter().min(), values.iter().max()), (Some(&-9), Some(&29_999)));
    assert!(all.is_sorted_by_key(|(scan, _)| *scan));
    // Of what was thinned out again and again each peak and each fall is there.
    let old = signal.changes(1, 250_000, usize::MAX);
    let count = |wanted: i64| old.iter().filter(|(_, value)| *value == Value::Number(wanted)).count();
    assert_eq!((count(29_999), count(-9)), (8, 8));
    // The newest are all there, the old ones when they are run again.
    let newest = bench.truth("D0", 395_000, 400_001);
    assert_eq!(signal.changes(395_000, 400_001, usize::MAX), newest);
    let again =
        bench.recorder.again(&["D0".to_string()], &bench.session, 5_000, 5_100).expect("a short stretch");
    let close = again.signal("D0").expect("it is recorded").changes(5_000, 5_100, usize::MAX);
    assert_eq!(close, bench.truth("D0", 5_000, 5_100));
    assert_eq!(close.len(), 101);
}

#[test]
fn other_code_for_the_same_plc_goes_on_with_the_record() {
    let mut bench = Bench::new(PROGRAM);
    bench.scan(10);
    bench.recorder.record(&names(), bench.session.machine());
    switch(&mut bench.session, "X0", true);
    bench.scan(10);
    let document = Document::new("LD X0\nOUT Y1\nRST Y0\nEND\n", Notation::FxIl, Target::of(Model::Fx3u));
    bench.session.adopt(Arc::new(compile(&[&document], false).expect("a program")));
    bench.recorder.adopt(bench.session.machine());
    bench.scan(5);
    let changes = bench.recorder.signal("Y0").expect("it is recorded").changes(1, 25, 100);
    let wanted = [(10, false), (11, true), (21, false)].map(|(scan, on)| (scan, Value::Bit(on)));
    assert_eq!(changes, wanted);
}
