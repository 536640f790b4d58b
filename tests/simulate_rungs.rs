//! What the contact table makes of rungs, beside answers that owe nothing to it: a stack machine for lists, and for
//! drawings the list that they are a translation of.

use crate::simulate::device;
use crate::stack_machine::{self, Bits};
use crate::translate::{WORKED, all_small_rungs, certain, drawing, list, made_up, truth_of_list};
use proptest::prelude::*;
use rungwise::document::Document;
use rungwise::simulate::{Code, Lanes, Machine, compile};
use rungwise::target::{Device, DeviceKind};
use rungwise::translate::To;
use std::sync::Arc;

fn code(document: &Document, is_watched: bool) -> Arc<Code> {
    Arc::new(compile(&[document], is_watched).unwrap_or_else(|problems| panic!("{problems:?}")))
}

/// One scan of a program whose rungs drive M0, M1 …, for all values of X0 to X4 side by side: a bit for each.
fn truths(document: &Document, rungs: usize, is_watched: bool) -> Vec<u32> {
    let mut machine: Machine<u64> = Machine::new(code(document, is_watched));
    for number in 0..5 {
        let on = |lane: &usize| lane >> number & 1 == 1;
        let lanes = (0..64).filter(on).fold(u64::NONE, |lanes, lane| lanes.with(lane, true));
        machine.set(Device::new(DeviceKind::X, number), lanes);
    }
    machine.scan(0);
    (0..rungs as u32).map(|rung| machine.bit(Device::new(DeviceKind::M, rung)) as u32).collect()
}

/// The three programs that the design papers walk through, by what their equations say.
#[test]
fn worked_examples_do_what_their_equations_say() {
    type Bits<'a> = &'a dyn Fn(&str) -> bool;
    /// The output, the inputs, and what the first is by the others.
    type Answer<'a> = (&'a str, &'a [&'a str], &'a dyn Fn(Bits<'_>) -> bool);
    let answers: [Answer<'_>; 3] = [
        ("Y5", &["X4", "X6", "M102"], &|on| on("X4") || on("X6") || !on("M102")),
        ("M103", &["Y5", "X7", "M108", "X10", "M110"], &|on| {
            (!on("Y5") && on("X7") || on("M108")) && !on("X10") || !on("M110")
        }),
        ("Y6", &["X0", "X1", "X2", "X3", "X4", "X5", "X6", "X7"], &|on| {
            (on("X0") || on("X1")) && (on("X2") && on("X3") || !on("X4") && !on("X5") || on("X6")) || on("X7")
        }),
    ];
    for ((text, _), (output, inputs, answer)) in WORKED.into_iter().zip(answers) {
        for document in [list(text), drawing(&certain(&list(text), To::Ladder))] {
            let mut machine: Machine<u8> = Machine::new(code(&document, false));
            for state in 0..1_u32 << inputs.len() {
                let is_on = |number: usize| state >> number & 1 == 1;
                for (number, input) in inputs.iter().enumerate() {
                    machine.set(device(input), u8::all(is_on(number)));
                }
                machine.scan(i64::from(state) * 10_000_000);
                let on = |name: &str| is_on(inputs.iter().position(|own| *own == name).expect("an input"));
                assert_eq!(machine.bit(device(output)) != 0, answer(&on), "{text} {state:b}");
            }
        }
    }
}

#[test]
fn every_small_rung_drives_its_coil_as_the_stack_machine_says() {
    let rungs = all_small_rungs();
    let expected: Vec<u32> = rungs.iter().map(|rung| truth_of_list(rung)).collect();
    // An FX2N has no more relays than these.
    for (rungs, expected) in rungs.chunks(3_000).zip(expected.chunks(3_000)) {
        let numbered =
            rungs.iter().enumerate().map(|(number, rung)| rung.replace("Y0", &format!("M{number}")));
        let text = numbered.collect::<String>() + "END\n";
        let drawn = certain(&list(&text), To::Ladder);
        for document in [list(&text), drawing(&drawn)] {
            for is_watched in [false, true] {
                let found = truths(&document, rungs.len(), is_watched);
                let wrong = (0..rungs.len()).find(|rung| found[*rung] != expected[*rung]);
                assert_eq!(wrong.map(|rung| &rungs[rung]), None);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn large_rungs_do_in_each_scan_what_the_stack_machine_does(
        rung in made_up(120),
        states in proptest::collection::vec(any::<u64>(), 2..6),
    ) {
        let text = rung.list() + "END\n";
        let drawn = drawing(&certain(&list(&text), To::Ladder));
        let mut machines = [(list(&text), false), (list(&text), true), (drawn, false)]
            .map(|(document, is_watched)| Machine::<u8>::new(code(&document, is_watched)));
        let relays = |state: u64| (0..400).map(move |n| (format!("M{n}"), state.rotate_left(n * 7) & 1 == 1));
        let mut bits = Bits::new();
        let mut before: Bits = (0..400).map(|n| (format!("M{n}"), false)).collect();
        for (scan, state) in states.into_iter().enumerate() {
            bits.extend(relays(state));
            stack_machine::scan(&text, &mut bits, &before);
            for machine in &mut machines {
                for (relay, on) in relays(state) {
                    machine.set(device(&relay), u8::all(on));
                }
                machine.scan(scan as i64 * 10_000_000);
                for (output, on) in bits.iter().filter(|(name, _)| name.starts_with('Y')) {
                    prop_assert_eq!(machine.bit(device(output)) != 0, *on, "{} in scan {}\n{}", output, scan, text);
                }
            }
            before = relays(state).collect();
        }
    }

    #[test]
    fn scenarios_side_by_side_are_what_each_is_alone(
        rungs in proptest::collection::vec(made_up(12), 1..5),
        states in proptest::collection::vec(any::<[u64; 8]>(), 1..5),
    ) {
        // Timers and counters as well, driven by what the rungs drive.
        let rungs: String = rungs.iter().map(|rung| rung.list()).collect();
        let text = rungs + "LD Y0\nOUT T200 K1\nLD Y1\nOUT C0 K2\nLD Y2\nRST C0\nLD T200\nOR C0\nOUT Y17\nEND\n";
        let code = code(&list(&text), false);
        let mut all: Machine<u64> = Machine::new(Arc::clone(&code));
        let mut alone: Vec<Machine<u8>> = (0..64).map(|_| Machine::new(Arc::clone(&code))).collect();
        for (scan, state) in states.into_iter().enumerate() {
            for relay in 0..80u32 {
                let name = Device::new(DeviceKind::M, relay);
                let lanes = state[relay as usize % 8].rotate_left(relay * 3);
                all.set(name, lanes);
                for (lane, machine) in alone.iter_mut().enumerate() {
                    machine.set(name, u8::all(lanes.lane(lane)));
                }
            }
            let now = scan as i64 * 10_000_000;
            all.scan(now);
            for (lane, machine) in alone.iter_mut().enumerate() {
                machine.scan(now);
                for name in ["Y0", "Y1", "Y2", "Y3", "Y17", "T200", "C0"].map(device) {
                    prop_assert_eq!(all.bit(name).lane(lane), machine.bit(name) != 0, "{}\n{}", name, text);
                    prop_assert_eq!(all.word(name, lane), machine.word(name, 0));
                }
            }
        }
    }
}
