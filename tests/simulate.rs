//! The simulated PLC: what instructions do, scan by scan.

use rungwise::document::{Document, Notation};
use rungwise::simulate::{Machine, Outcome, Session, Touch, Value, compile};
use rungwise::target::{Access, Device, DeviceKind, Extent, Form, Model, Operand, Target};
use std::collections::BTreeSet;
use std::sync::Arc;

const MS: i64 = 1_000_000;
/// So many data registers are watched, from D0 on.
const REGISTERS: u32 = 1_000;

/// A PLC with this program, and time that goes on by 10 ms from scan to scan.
///
/// No scan may write to a register that the instruction table does not say to be written: proofs rely on that.
pub(crate) struct Plc {
    pub(crate) machine: Machine<u8>,
    pub(crate) scan_ms: i64,
    now_ms: i64,
    /// The numbers of the data registers that the instructions may write; nothing if these may be any.
    written: Option<BTreeSet<u32>>,
}

/// The data registers that an FX list writes by what the table says of its operands.
fn written(text: &str) -> Option<BTreeSet<u32>> {
    let mut written = BTreeSet::new();
    for line in text.lines() {
        let mut words = line.split(';').next().unwrap_or_default().split_whitespace();
        let Some(form) = words.next().and_then(Form::named) else { continue };
        let operands: Vec<Operand> = words.map(|word| Operand::read(word, Model::Fx3u)).collect();
        for (place, spec) in form.instruction.operands.iter().enumerate().take(operands.len()) {
            let is_written = spec.access != Access::Read || spec.extent != Extent::Fixed;
            match operands[place] {
                _ if !is_written => {}
                Operand::Device(Device { kind: DeviceKind::D, number })
                | Operand::WordBit { word: Device { kind: DeviceKind::D, number }, .. } => {
                    written.extend(number..number + u32::from(form.covered(place, &operands)?));
                }
                Operand::Indexed { device, .. } if device.kind == DeviceKind::D => return None,
                _ => {}
            }
        }
    }
    Some(written)
}

pub(crate) fn device(name: &str) -> Device {
    match Operand::read(name, Model::Fx3u) {
        Operand::Device(device) => device,
        other => panic!("{name} is {other:?}"),
    }
}

/// What switching an input or writing a relay of a simulation does.
pub(crate) fn switched(session: &Session, name: &str, on: bool) -> Touch {
    let code = session.machine().code();
    let touch = code.variable(name).and_then(|variable| variable.set(code, &Value::Bit(on)));
    touch.unwrap_or_else(|| panic!("{name} is no relay"))
}

/// Does that before the next scan.
pub(crate) fn switch(session: &mut Session, name: &str, on: bool) {
    let touch = switched(session, name, on);
    session.touch(touch);
}

impl Plc {
    pub(crate) fn of(text: &str, notation: Notation, model: Model) -> Plc {
        let document = Document::new(text, notation, Target::of(model));
        let code = compile(&[&document], false).unwrap_or_else(|problems| panic!("{problems:?}\n{text}"));
        let written = if notation == Notation::FxIl { written(text) } else { None };
        Plc { machine: Machine::new(Arc::new(code)), scan_ms: 10, now_ms: 0, written }
    }

    /// A list for the FX3U.
    pub(crate) fn list(text: &str) -> Plc {
        Plc::of(text, Notation::FxIl, Model::Fx3u)
    }

    /// Switches inputs, or writes relays and registers: `X0`, `X1=0`, `D0=5`.
    pub(crate) fn set(&mut self, settings: &str) -> &mut Plc {
        for setting in settings.split_whitespace() {
            let (name, value) = setting.split_once('=').unwrap_or((setting, "1"));
            let (device, value) = (device(name), value.parse::<i64>().expect("a number"));
            match device.kind.is_bit() && !device.kind.has_preset() {
                true => self.machine.set(device, if value == 0 { 0 } else { 0xFF }),
                false => self.machine.set_word(device, value),
            }
        }
        self
    }

    pub(crate) fn scan(&mut self) -> Outcome {
        let registers = |machine: &Machine<u8>| -> Vec<i64> {
            (0..REGISTERS).map(|number| machine.word(Device::new(DeviceKind::D, number), 0)).collect()
        };
        let before = registers(&self.machine);
        let outcome = self.machine.scan(self.now_ms * MS);
        self.now_ms += self.scan_ms;
        if let Some(written) = &self.written {
            let after = registers(&self.machine);
            for number in (0..REGISTERS).filter(|number| !written.contains(number)) {
                assert_eq!(after[number as usize], before[number as usize], "D{number} was written");
            }
        }
        outcome
    }

    pub(crate) fn scans(&mut self, count: usize) -> &mut Plc {
        for _ in 0..count {
            let outcome = self.scan();
            assert!(outcome.errors.is_empty(), "{:?}", outcome.errors);
        }
        self
    }

    pub(crate) fn on(&self, name: &str) -> bool {
        self.machine.bit(device(name)) != 0
    }

    pub(crate) fn word(&self, name: &str) -> i64 {
        self.machine.word(device(name), 0)
    }

    /// What these devices are: relays by themselves when they are on, with `~` when they are off, words with `=`.
    #[track_caller]
    pub(crate) fn check(&mut self, expected: &str) -> &mut Plc {
        for expected in expected.split_whitespace() {
            let found = match (expected.split_once('='), expected.strip_prefix('~')) {
                (Some((name, _)), _) => format!("{name}={}", self.word(name)),
                (_, Some(name)) => {
                    if self.on(name) {
                        name.to_string()
                    } else {
                        format!("~{name}")
                    }
                }
                (None, None) => {
                    if self.on(expected) {
                        expected.to_string()
                    } else {
                        format!("~{expected}")
                    }
                }
            };
            assert_eq!(found, expected);
        }
        self
    }
}

#[test]
fn a_seal_in_holds_until_it_is_broken() {
    let mut plc = Plc::list("LD X0\nOR Y0\nANI X1\nOUT Y0\nEND\n");
    plc.scans(1).check("~Y0").set("X0").scans(1).check("Y0").set("X0=0").scans(3).check("Y0");
    plc.set("X1").scans(1).check("~Y0").set("X1=0").scans(1).check("~Y0");
}

#[test]
fn blocks_and_branches_are_joined_as_the_stack_says() {
    let text = "LD X0\nOR X1\nLD X2\nAND X3\nLDI X4\nANI X5\nORB\nOR X6\nANB\nOR X7\nOUT Y6\n\
                LD X0\nMPS\nAND X1\nOUT Y0\nMRD\nANI X1\nOUT Y1\nMPP\nLD X2\nOR X3\nANB\nOUT Y2\nINV\nOUT Y3\nEND\n";
    let mut plc = Plc::list(text);
    for inputs in 0..256 {
        let x = |bit: i32| inputs >> bit & 1 == 1;
        for bit in 0..8 {
            plc.machine.set(device(&format!("X{bit}")), if x(bit) { 0xFF } else { 0 });
        }
        plc.scans(1);
        let y6 = (x(0) || x(1)) && (x(2) && x(3) || !x(4) && !x(5) || x(6)) || x(7);
        let y2 = x(0) && (x(2) || x(3));
        let expected = [(6, y6), (0, x(0) && x(1)), (1, x(0) && !x(1)), (2, y2), (3, !y2)];
        for (number, on) in expected {
            assert_eq!(plc.on(&format!("Y{number}")), on, "Y{number} for {inputs:08b}");
        }
    }
}

#[test]
fn a_block_behind_an_output_is_joined_with_what_drove_it() {
    let mut plc = Plc::list("LD X0\nOUT Y0\nLD X1\nOR X2\nANB\nOUT Y1\nEND\n");
    plc.set("X1")
        .scans(1)
        .check("~Y0 ~Y1")
        .set("X0")
        .scans(1)
        .check("Y0 Y1")
        .set("X1=0")
        .scans(1)
        .check("Y0 ~Y1");
}

#[test]
fn edges_last_a_scan_each_at_its_place() {
    let text = "LDP X0\nOUT Y0\nLDF X0\nOUT Y1\nLD X1\nANDP X0\nOUT Y2\nLD X1\nORF X0\nOUT Y3\n\
                LD X0\nPLS M0\nLD X0\nPLF M1\nLD X0\nMEP\nOUT Y4\nLD X0\nMEF\nOUT Y5\nEND\n";
    let mut plc = Plc::list(text);
    plc.scans(1).check("~Y0 ~Y1 ~Y2 ~Y3 ~M0 ~M1 ~Y4 ~Y5");
    plc.set("X0").scans(1).check("Y0 ~Y1 ~Y2 ~Y3 M0 ~M1 Y4 ~Y5");
    plc.scans(1).check("~Y0 ~Y1 ~Y2 ~Y3 ~M0 ~M1 ~Y4 ~Y5");
    plc.set("X0=0 X1").scans(1).check("~Y0 Y1 ~Y2 Y3 ~M0 M1 ~Y4 Y5");
    plc.scans(1).check("~Y0 ~Y1 ~Y2 Y3 ~M0 ~M1 ~Y4 ~Y5").set("X0").scans(1).check("Y0 ~Y1 Y2 Y3 M0 ~M1 Y4");
}

#[test]
fn set_and_reset_hold_and_leave_the_result_as_it_was() {
    let text = "LD X0\nSET Y0\nRST Y1\nOUT Y2\nLD X1\nRST Y0\nSET Y1\nOUT Y3\nEND\n";
    let mut plc = Plc::list(text);
    plc.set("X0").scans(1).check("Y0 ~Y1 Y2 ~Y3").set("X0=0").scans(1).check("Y0 ~Y1 ~Y2 ~Y3");
    plc.set("X1").scans(1).check("~Y0 Y1 ~Y2 Y3").set("X0").scans(1).check("~Y0 Y1 Y2 Y3");
}

#[test]
fn timers_run_in_their_units_while_their_coil_has_power() {
    let mut plc = Plc::list("LD X0\nOUT T0 K3\nOUT T200 K5\nOUT T250 K2\nLD X1\nRST T250\nEND\n");
    plc.set("X0").scans(1).check("T0=0 ~T0").scans(5).check("T200 T200=5 ~T0 T0=0");
    plc.scans(5).check("T0=1").scans(20).check("T0 T0=3 T250 T250=2");
    plc.set("X0=0").scans(1).check("~T0 T0=0 ~T200 T250 T250=2").set("X1").scans(1).check("~T250 T250=0");
}

#[test]
fn a_retentive_timer_adds_what_it_ran() {
    let mut plc = Plc::list("LD X0\nOUT T246 K50\nEND\n");
    plc.set("X0").scans(3).check("T246=20").set("X0=0").scans(9).check("T246=20 ~T246");
    plc.set("X0").scans(1).check("T246=20").scans(3).check("T246=50 T246");
}

#[test]
fn a_timer_stands_still_while_it_is_jumped_over() {
    let mut plc = Plc::list("LD X1\nCJ P0\nLD X0\nOUT T200 K10\nP0\nLD T200\nOUT Y0\nEND\n");
    plc.set("X0").scans(4).check("T200=3").set("X1").scans(7).check("T200=3");
    plc.set("X1=0").scans(1).check("T200=3").scans(7).check("T200=10 Y0");
}

#[test]
fn counters_count_edges_and_wait_for_their_reset() {
    let mut plc = Plc::list("LD X1\nRST C0\nLD X0\nOUT C0 K2\nLD C0\nOUT Y0\nEND\n");
    for expected in ["C0=1 ~C0", "C0=2 C0 Y0", "C0=2 C0"] {
        plc.set("X0").scans(2).check(expected).set("X0=0").scans(1);
    }
    plc.set("X1").scans(1).check("C0=0 ~C0 ~Y0").set("X0").scans(1).check("C0=0").set("X1=0 X0=0").scans(1);
    plc.set("X0").scans(1).check("C0=1");
}

#[test]
fn counters_of_32_bits_go_both_ways_and_round() {
    let mut plc = Plc::list("LD X2\nOUT M8200\nLD X0\nOUT C200 K3\nEND\n");
    for expected in ["C200=1 ~C200", "C200=2 ~C200", "C200=3 C200", "C200=4 C200"] {
        plc.set("X0").scans(1).check(expected).set("X0=0").scans(1);
    }
    plc.set("X2");
    for expected in ["C200=3 C200", "C200=2 ~C200"] {
        plc.set("X0").scans(1).check(expected).set("X0=0").scans(1);
    }
    plc.set("C200=-2147483648 X0").scans(1).check("C200=2147483647");
}

#[test]
fn a_master_control_is_a_rail_behind_a_contact() {
    let text = "LD X0\nMC N0 M100\nLD X1\nOUT Y0\nLD X2\nSET Y1\nLD X1\nOR X2\nOUT T200 K1\nLD X3\nMC N1 M101\n\
                LD X1\nOUT Y2\nMCR N1\nLD X1\nOUT Y3\nMCR N0\nLD X1\nOUT Y4\nEND\n";
    let mut plc = Plc::list(text);
    plc.set("X1 X2 X3").scans(1).check("~Y0 ~Y1 ~Y2 ~Y3 Y4 ~M100");
    plc.set("X0").scans(1).check("Y0 Y1 Y2 Y3 Y4 M100 M101").scans(2).check("T200");
    plc.set("X3=0")
        .scans(1)
        .check("Y0 ~Y2 Y3 ~M101")
        .set("X0=0 X3")
        .scans(1)
        .check("~Y0 Y1 ~Y2 ~Y3 Y4 ~T200 ~M101");
}

#[test]
fn a_step_hands_over_and_its_coils_go_off() {
    let text = "LD M8002\nSET S0\nSTL S0\nOUT Y0\nLD X0\nSET S20\nSTL S20\nOUT Y1\nOUT T200 K2\nLD T200\nSET S21\n\
                STL S21\nOUT Y0\nOUT Y2\nLD X1\nOUT S0\nRET\nLD X5\nOUT Y5\nEND\n";
    let mut plc = Plc::list(text);
    plc.scans(1)
        .check("S0 Y0 ~Y1")
        .set("X0")
        .scans(1)
        .check("~S0 S20 Y0 Y1")
        .set("X0=0")
        .scans(1)
        .check("~Y0 Y1");
    plc.scans(1)
        .check("S21 ~S20 Y0 Y1 Y2")
        .scans(1)
        .check("Y0 ~Y1 Y2")
        .set("X1")
        .scans(1)
        .check("S0 ~S21 Y0 Y2");
    // The step that is left switches its coils off in its turn, also one that the step before it in the program drives.
    plc.scans(1).check("~Y0 ~Y2").set("X5").scans(1).check("Y0 Y5");
}

#[test]
fn subroutines_and_loops_are_executed_in_place() {
    let mut plc = Plc::list("LD X0\nCALL P1\nFEND\nP1\nLD X1\nOUT Y0\nSRET\nEND\n");
    plc.set("X1").scans(1).check("~Y0").set("X0").scans(1).check("Y0").set("X0=0 X1=0").scans(1).check("Y0");
    let mut plc = Plc::list("FOR K3\nLD M8000\nOUT M0\nLDI M1\nOUT M1\nNEXT\nEND\n");
    plc.scans(1).check("M1").scans(1).check("~M1");
}

#[test]
fn a_scan_that_does_not_end_is_stopped_at_its_jump() {
    let text = "P0\nLD M8000\nOUT Y0\nLD M8000\nCJ P0\nEND\n";
    let mut plc = Plc::list(text);
    let outcome = plc.scan();
    let place = outcome.errors[0].place.expect("a place");
    assert_eq!(format!("{:?}", outcome.errors[0].kind), "Watchdog");
    assert!(
        text[place.span.start as usize..].starts_with("CJ")
            || text[place.span.start as usize..].starts_with("LD")
    );
}

#[test]
fn forced_devices_keep_their_values() {
    let mut plc = Plc::list("LD X0\nOUT Y0\nLD Y0\nOUT Y1\nLD X0\nOUT T200 K1\nLD T200\nOUT Y2\nEND\n");
    plc.machine.force(device("Y0"), true);
    plc.scans(1).check("Y0 Y1");
    plc.machine.force(device("X0"), true);
    plc.machine.force(device("T200"), false);
    plc.scans(4).check("X0 Y0 ~T200 ~Y2").set("X0=0").scans(1).check("X0");
    plc.machine.release(device("T200"));
    plc.machine.release(device("Y0"));
    plc.scans(1).check("T200 Y2 Y0");
    plc.machine.release(device("X0"));
    plc.scans(1).check("~X0 ~Y0 ~Y1 ~Y2");
}

#[test]
fn a_call_in_the_middle_of_a_rung_leaves_the_current_result_alone() {
    let routine = "FEND\nP0\nLD X1\nAND X2\nORI X3\nOUT Y7\nSRET\nEND\n";
    for rung in [
        "LD X0\nCALL P0\nOUT Y0\n",
        "LD X0\nMPS\nCALL P0\nMPP\nOUT Y0\n",
        "LD X0\nOR X5\nMPS\nAND X4\nCALL P0\nMRD\nOUT Y0\nMPP\nOUT Y1\n",
    ] {
        for (inputs, expected) in [("X0 X3 X4", true), ("X0=0 X3=0 X4=0 X1 X2", false)] {
            let mut plc = Plc::list(&format!("{rung}{routine}"));
            plc.set(inputs).scan();
            assert_eq!(plc.machine.bit(device("Y0")) != 0, expected, "{rung} {inputs}");
        }
    }
}
