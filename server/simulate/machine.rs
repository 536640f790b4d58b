//! The simulated PLC at work: samples inputs, runs the program, refreshes outputs, scan by scan.

use super::code::{Code, Place};
use super::forces::Force;
use super::interrupts::Interrupts;
use super::row::{Cell, Row};
use super::run::Run;
use super::terminals::Terminals;
use super::writes::Watch;
use super::{Glimpse, Lanes, Memory, iec, timing};
use crate::target::{Device, DeviceKind, Fault, Outside};
use crate::text::Message;
use std::sync::Arc;

/// A PLC with a program, in one scenario (`u8`) or 64 side by side (`u64`).
#[derive(Clone, Debug)]
pub struct Machine<L> {
    pub(super) code: Arc<Code>,
    pub(super) memory: Memory<L>,
    pub(super) terminals: Terminals<L>,
    /// What is around each of the PLCs.
    pub(super) outside: Vec<Outside>,
    pub(super) interrupts: Interrupts,
    /// What inputs X0 to X7 were when they were sampled last.
    inputs: [L; 8],
    pub(super) forces: Vec<Force>,
    /// Rows of the program whose outputs are forced, instead of its own.
    pub(super) forced_rows: Option<Arc<[Row]>>,
    /// Scans so far.
    pub(super) scans: u64,
    pub(super) now_ns: i64,
    pub(super) scan_ns: i64,
}

/// What came of a scan.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Outcome {
    /// What went wrong, in order, at most [`Outcome::MOST_ERRORS`].
    pub errors: Vec<Error>,
    /// Whether the watcher ended it before its end.
    pub is_broken_off: bool,
}

impl Outcome {
    /// More errors of one scan are not kept.
    pub const MOST_ERRORS: usize = 16;
}

/// Something that went wrong while the program ran.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Error {
    /// The instruction.
    pub place: Option<Place>,
    /// What happened.
    pub kind: ErrorKind,
    /// The scenario.
    pub lane: usize,
}

/// What can go wrong while a program runs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ErrorKind {
    /// An instruction was not executed; the scan went on.
    Fault(Fault),
    /// A calculation of an IEC 61131-3 program has no proper result; the scan went on.
    Calculation(Fault),
    /// The scan did not end; it was stopped at this instruction, and the CPU of an FX with it.
    Watchdog,
    /// CALL or FOR nest deeper than the PLC can; it was not executed, nor the loop, and the scan went on.
    TooDeep,
    /// SRET without CALL, or NEXT without FOR; it was not executed.
    NothingToReturnTo,
    /// The program has stopped the CPU by M8037.
    Stopped,
}

/// What an instruction saw when it was executed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sight<L> {
    /// Its number among the instructions of the code, see [`Machine::place`].
    pub instruction: u32,
    /// Whether a contact conducts; nothing for other instructions.
    pub conducts: Option<L>,
    /// Power behind a contact, or at an output.
    pub power: L,
}

impl ErrorKind {
    /// The sentence that says it; operands are counted from 1.
    pub fn message(self) -> Message {
        match self {
            ErrorKind::Fault(Fault::DivisionByZero) => Message::new("simulate.division"),
            ErrorKind::Fault(Fault::NoDevice(place)) => {
                Message::new("simulate.index").with("number", place.saturating_add(1))
            }
            ErrorKind::Fault(Fault::Value(place)) => {
                Message::new("simulate.value").with("number", place.saturating_add(1))
            }
            ErrorKind::Fault(Fault::Overflow) => Message::new("simulate.overflow"),
            ErrorKind::Fault(Fault::NoModule) => Message::new("simulate.no-module"),
            ErrorKind::Fault(Fault::Pid(code)) => Message::new("simulate.pid").with("code", code),
            ErrorKind::Fault(Fault::NotSimulated(place)) => {
                Message::new("simulate.not-simulated").with("number", place.saturating_add(1))
            }
            ErrorKind::Fault(Fault::TableMode) => Message::new("simulate.table-mode"),
            ErrorKind::Fault(Fault::LimitCycle) => Message::new("simulate.limit-cycle"),
            ErrorKind::Fault(Fault::Index) | ErrorKind::Calculation(Fault::Index) => {
                Message::new("simulate.subscript")
            }
            ErrorKind::Fault(Fault::Subrange) | ErrorKind::Calculation(Fault::Subrange) => {
                Message::new("simulate.subrange")
            }
            ErrorKind::Calculation(Fault::DivisionByZero) => Message::new("simulate.division-iec"),
            ErrorKind::Calculation(Fault::Overflow) => Message::new("simulate.overflow-iec"),
            ErrorKind::Calculation(Fault::Value(place)) => {
                Message::new("simulate.value-iec").with("number", place.saturating_add(1))
            }
            ErrorKind::Calculation(other) => ErrorKind::Fault(other).message(),
            ErrorKind::Watchdog => Message::new("simulate.watchdog"),
            ErrorKind::TooDeep => Message::new("simulate.too-deep"),
            ErrorKind::Stopped => Message::new("simulate.stopped"),
            ErrorKind::NothingToReturnTo => Message::new("simulate.nothing-to-return-to"),
        }
    }
}

impl<L: Lanes> Machine<L> {
    /// Ops that a scan may run before the watchdog stops it: at 80 ns, which an FX2N needs for the shortest
    /// instruction, the 200 ms of D8000.
    pub const MOST_OPS: u64 = 2_500_000;

    /// A PLC that has not run yet: all is off and 0.
    pub fn new(code: Arc<Code>) -> Machine<L> {
        let terminals = Terminals::new(&code);
        let mut memory = Memory::new(code.slots, code.iec.texts);
        memory.set_cell(Row::RAIL, L::ALL);
        iec::initialise(&mut memory, &code.iec, 0);
        Machine {
            code,
            memory,
            terminals,
            outside: vec![Outside::default(); L::COUNT],
            interrupts: Interrupts::default(),
            inputs: [L::NONE; 8],
            forces: Vec::new(),
            forced_rows: None,
            scans: 0,
            now_ns: 0,
            scan_ns: 0,
        }
    }

    /// The program.
    pub fn code(&self) -> &Arc<Code> {
        &self.code
    }

    /// Goes on with code of the same program that says what it sees, or no longer does.
    pub fn set_code(&mut self, code: Arc<Code>) {
        self.code = code;
        self.patch();
    }

    /// Scans so far.
    pub fn scans(&self) -> u64 {
        self.scans
    }

    /// When the last scan began, in nanoseconds since the CPU came to RUN.
    pub fn now_ns(&self) -> i64 {
        self.now_ns
    }

    /// What it remembers.
    pub fn memory(&self) -> &Memory<L> {
        &self.memory
    }

    /// What is around the PLCs, one for each scenario.
    pub fn outside(&self) -> &[Outside] {
        &self.outside
    }

    /// The same, to change it before a scan.
    pub fn outside_mut(&mut self) -> &mut [Outside] {
        &mut self.outside
    }

    /// The memory of the computer that a copy of it takes, but for what is seldom used.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>() + self.memory.bytes()
    }

    /// Where an instruction that was seen stands.
    pub fn place(&self, instruction: u32) -> Option<Place> {
        self.code.places.get(instruction as usize).copied()
    }

    /// Switches an input terminal, or writes a relay; of timers and counters the contact.
    pub fn set(&mut self, device: Device, value: L) {
        if let Some(cell) = self.code.layout.cell(device) {
            self.write_cell(cell, value);
        }
    }

    /// Switches the input terminal in a cell, or writes the cell.
    pub(super) fn write_cell(&mut self, cell: Cell, value: L) {
        match self.terminals.input_mut(cell) {
            Some(input) => *input = value,
            None => self.memory.set_cell(cell, value),
        }
    }

    /// Writes a register, or the current value of a timer or counter, in all scenarios.
    pub fn set_word(&mut self, device: Device, value: i64) {
        let layout = Arc::clone(&self.code.layout);
        let Some(slot) = layout.slot(device) else { return };
        let value = layout.held(device, value);
        for lane in 0..L::COUNT {
            timing::store(&mut self.memory, &layout, (slot, device), lane, value);
        }
    }

    /// The relay, the contact of the timer or counter, or what an output terminal has.
    pub fn bit(&self, device: Device) -> L {
        self.code.layout.cell(device).map_or(L::NONE, |cell| self.relay(cell))
    }

    /// What a cell has; of an output what is at its terminal.
    pub fn relay(&self, cell: Cell) -> L {
        self.terminals.output(cell).unwrap_or_else(|| self.memory.cell(cell))
    }

    /// The register, or the current value of the timer or counter, in a scenario.
    pub fn word(&self, device: Device, lane: usize) -> i64 {
        self.code.layout.slot(device).map_or(0, |slot| self.memory.word(slot, lane))
    }

    /// Runs a scan that begins at `now_ns`.
    pub fn scan(&mut self, now_ns: i64) -> Outcome {
        self.scan_watched(now_ns, &mut |_| true)
    }

    /// The same; `watch` is told what each instruction sees, if the code says it, and ends the scan there with false.
    pub fn scan_watched(&mut self, now_ns: i64, watch: &mut impl FnMut(Sight<L>) -> bool) -> Outcome {
        self.scan_inside(now_ns, &mut |glimpse| glimpse.sight.is_none_or(&mut *watch))
    }

    /// The same, and `watch` may look at the PLC as it is there.
    pub fn scan_inside(&mut self, now_ns: i64, watch: &mut impl FnMut(Glimpse<'_, L>) -> bool) -> Outcome {
        self.scan_with(now_ns, watch)
    }

    /// The same with somebody who may look at each op.
    pub(super) fn scan_with(&mut self, now_ns: i64, watch: &mut impl Watch<L>) -> Outcome {
        self.scan_ns = if self.scans == 0 { 0 } else { now_ns - self.now_ns };
        self.now_ns = now_ns;
        self.scans += 1;
        self.terminals.sample(&mut self.memory, &self.outside);
        self.special();
        self.hold();
        let code = Arc::clone(&self.code);
        if code.target.is_fx() {
            self.fast(&code);
        }
        let rows = self.forced_rows.clone();
        let mut run = Run::default();
        if self.is_running() {
            self.run(&code, rows.as_deref().unwrap_or(&code.rows), &mut run, watch);
            self.end_scan(&code, &mut run);
        } else {
            self.stand_still();
        }
        run.outcome
    }

    /// What happened faster than the scan: edges of inputs, pulses, interrupts.
    fn fast(&mut self, code: &Code) {
        let first = code.layout.terminals(DeviceKind::X).start;
        let mut inputs = [L::NONE; 8];
        inputs.copy_from_slice(&self.memory.cells[first..first + 8]);
        // What is on when the CPU starts has not gone on.
        let before = if self.scans == 1 { inputs } else { self.inputs };
        self.inputs = inputs;
        for (lane, outside) in self.outside.iter_mut().enumerate() {
            outside.begin_scan(std::array::from_fn(|x| inputs[x].lane(lane) && !before[x].lane(lane)));
        }
        self.interrupts.begin_scan();
        self.interrupts.ask_for_edges(code, before.map(|x| x.lane(0)), inputs.map(|x| x.lane(0)));
        self.interrupts.ask_for_time(code, self.now_ns - self.scan_ns, self.now_ns);
        if code.counts_pulses {
            self.count_pulses(before);
            self.hold();
        }
    }
}
