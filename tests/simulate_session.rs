//! Looking back: any scan of a simulation is known again, and goes on from there in another way.

use crate::simulate::{device, switch};
use proptest::prelude::*;
use rungwise::document::{Document, Notation};
use rungwise::simulate::{HistoryLimit, Machine, Session, compile};
use rungwise::target::{Model, Target};
use std::sync::Arc;

const MS: i64 = 1_000_000;

const PROGRAM: &str =
    "LD X0\nOR Y0\nANI X1\nOUT Y0\nOUT T200 K3\nLD T200\nOUT Y1\nLDP X0\nOUT C0 K100\nEND\n";

fn document(text: &str, notation: Notation) -> Document {
    Document::new(text, notation, Target::of(Model::Fx3u))
}

fn session(text: &str) -> Session {
    let code = compile(&[&document(text, Notation::FxIl)], false).expect("a program");
    Session::new(Arc::new(code))
}

/// All that a person could ask the PLC.
fn state(machine: &Machine<u8>) -> String {
    let relays = ["X0", "X1", "Y0", "Y1", "T200", "C0"].map(|name| machine.bit(device(name)) != 0);
    format!(
        "{} {} {relays:?} {:?}",
        machine.scans(),
        machine.now_ns(),
        ["T200", "C0"].map(|name| machine.word(device(name), 0))
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_scan_is_known_as_it_was(
        touches in proptest::collection::vec((0..3_000u64, 0..2u8, any::<bool>()), 0..60),
        steps in proptest::collection::vec(1..30i64, 1..8),
        back in 0..3_000u64,
    ) {
        let mut session = session(PROGRAM);
        let mut states = vec![state(session.machine())];
        let mut now = 0;
        for scan in 1..=3_000u64 {
            for (_, input, on) in touches.iter().filter(|(at, ..)| *at == scan) {
                switch(&mut session, &format!("X{input}"), *on);
            }
            session.scan(now);
            // Scans are evenly apart for a while, then at another distance.
            now += steps[scan as usize / 400 % steps.len()] * MS;
            states.push(state(session.machine()));
        }
        for scan in (0..=3_000).step_by(97).chain([back]) {
            let machine = session.at(scan);
            prop_assert_eq!(machine.as_ref().map(state), Some(states[scan as usize].clone()));
        }
        let changed = session.last_change(3_000, |machine| machine.bit(device("Y0")));
        let y0 = |scan: usize| states[scan].split_once('[').map(|(_, relays)| relays.split(", ").nth(2).map(str::to_string));
        let expected = (1..=3_000usize).rev().find(|scan| y0(*scan) != y0(scan - 1));
        prop_assert_eq!(changed, expected.map(|scan| scan as u64));
        // Gone back, it goes on as it did before if the same is done.
        prop_assert!(session.back_to(back));
        prop_assert_eq!(state(session.machine()), states[back as usize].clone());
        let time = session.time_of(back).unwrap_or(0);
        session.scan(time + MS);
        prop_assert_eq!(session.machine().scans(), back + 1);
    }
}

#[test]
fn a_million_scans_stay_in_bounded_memory_and_are_all_known() {
    let mut session = session(PROGRAM);
    for scan in 0..1_000_000u64 {
        if scan % 100_000 == 50 {
            switch(&mut session, "X0", scan % 200_000 == 50);
        }
        session.scan(scan as i64 * 10 * MS);
    }
    assert_eq!(session.first_scan(), 0);
    assert!(session.moments() <= 96, "{}", session.moments());
    for scan in [1, 51, 60, 99_999, 500_051, 999_999] {
        let machine = session.at(scan).expect("a scan");
        assert_eq!(machine.now_ns(), (scan as i64 - 1) * 10 * MS);
        assert_eq!(machine.bit(device("Y0")) != 0, scan > 50, "{scan}");
    }
    assert_eq!(session.last_change(1_000_000, |machine| machine.bit(device("Y1"))), Some(54));
}

/// A history of one MiB, of a PLC that is switched before each scan.
fn busy(scans: u64) -> Session {
    let limit = HistoryLimit::read("1 MiB").expect("a size");
    let mut session = session(PROGRAM).with_limit(limit);
    for scan in 0..scans {
        switch(&mut session, "X0", scan % 3 == 0);
        switch(&mut session, "X1", scan % 7 == 0);
        session.scan(scan as i64 * 10 * MS);
    }
    session
}

#[test]
fn what_was_done_is_forgotten_oldest_first_when_a_small_history_is_full() {
    let long = busy(20_000);
    assert!(long.is_cut() && long.first_scan() > 10_000, "{}", long.first_scan());
    // With room for two states it is forgotten in halves: one of them, some 4,600 things that were done, is there.
    assert!(long.first_scan() < 17_800, "{}", long.first_scan());
    let all = session(PROGRAM);
    assert!(!all.is_cut());
    let first = long.first_scan();
    assert!(long.at(first - 1).is_none());
    assert_eq!(long.last_change(first, |machine| machine.bit(device("X1"))), None);
    // What is known is what was.
    for scan in [first, first + 1, first + 777, 19_999] {
        let was = busy(scan);
        assert_eq!(long.at(scan).as_ref().map(state), Some(state(was.machine())), "{scan}");
    }
    let mut back = long;
    assert!(!back.back_to(first - 1) && back.back_to(first + 1));
    assert_eq!(back.machine().scans(), first + 1);
}

#[test]
fn a_history_with_room_for_few_states_is_shorter_and_one_with_more_room_reaches_back_to_the_start() {
    let run = |limit: &str| {
        let mut session = session("LD X0\nOUT Y0\nEND\n");
        session.set_limit(HistoryLimit::read(limit).expect("a size"));
        (0..120_000).for_each(|scan| _ = session.scan(scan * MS));
        (session.is_cut(), session.first_scan(), session.moments())
    };
    let (is_cut, first, moments) = run("1 MiB");
    assert!(is_cut && first >= 60_000 && moments == 2, "{first} {moments}");
    assert_eq!(run("64 MiB"), (false, 0, 8));
}
