//! The simulated PLC at work: samples inputs, runs the program, refreshes outputs, scan by scan.

use super::code::{Call, CallCode, Code, Op, Place};
use super::execution::Executing;
use super::forces::Force;
use super::interrupts::{self, Interrupts};
use super::layout::{NS_BEYOND, RESET};
use super::row::{self, Cell, Row};
use super::terminals::Terminals;
use super::timing;
use super::{Glimpse, Lanes, Memory, annunciators, clock};
use crate::target::{Device, DeviceKind, Execution, Fault, Outside};
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
    /// The scan did not end; it was stopped at this instruction.
    Watchdog,
    /// CALL or FOR nest deeper than the PLC can.
    TooDeep,
    /// SRET without CALL, or NEXT without FOR.
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
        let layout = &code.layout;
        let terminals = Terminals::new(layout);
        let mut memory = Memory::new(code.slots);
        memory.set_cell(Row::RAIL, L::ALL);
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
        self.scan_inside(now_ns, &mut |glimpse| watch(glimpse.sight))
    }

    /// The same, and `watch` may look at the PLC as it is there.
    pub fn scan_inside(&mut self, now_ns: i64, watch: &mut impl FnMut(Glimpse<'_, L>) -> bool) -> Outcome {
        self.scan_ns = if self.scans == 0 { 0 } else { now_ns - self.now_ns };
        self.now_ns = now_ns;
        self.scans += 1;
        self.terminals.sample(&mut self.memory, &self.outside);
        self.special();
        self.hold();
        let code = Arc::clone(&self.code);
        self.fast(&code);
        let rows = self.forced_rows.clone();
        let mut run = Run::default();
        if self.is_stopped() {
            self.stand_still();
        } else {
            self.run(&code, rows.as_deref().unwrap_or(&code.rows), &mut run, watch);
            self.end_scan(&code, &mut run);
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
            self.count_pulses();
            self.hold();
        }
    }

    /// Special relays and registers that the CPU writes at the start of a scan.
    fn special(&mut self) {
        let layout = Arc::clone(&self.code.layout);
        let is_first = self.scans == 1;
        let half = |ms: i64| clock::is_second_half(ms, self.now_ns, self.scan_ns, self.scans);
        let relays = [
            (8000, true),
            (8001, false),
            (8002, is_first),
            (8003, !is_first),
            (8011, half(10)),
            (8012, half(100)),
            (8013, half(1000)),
            (8014, half(60_000)),
        ];
        for (number, on) in relays {
            if let Some(cell) = layout.cell(Device::new(DeviceKind::M, number)) {
                self.memory.set_cell(cell, L::all(on));
            }
        }
        self.identify();
        clock::advance(&mut self.memory, &layout, self.scans, self.scan_ns);
        annunciators::monitor(&mut self.memory, &layout);
        // In tenths of a millisecond: the present scan time, the least and the greatest so far.
        let Some(slot) = layout.slot(Device::new(DeviceKind::D, 8010)) else { return };
        let tenths = i64::from((self.scan_ns / 100_000).min(i64::from(i16::MAX)) as i16);
        for lane in 0..L::COUNT {
            let (least, greatest) = (self.memory.word(slot + 1, lane), self.memory.word(slot + 2, lane));
            self.memory.set_word(slot, lane, tenths);
            if self.scans > 1 {
                let least = if self.scans == 2 { tenths } else { least.min(tenths) };
                self.memory.set_word(slot + 1, lane, least);
                self.memory.set_word(slot + 2, lane, greatest.max(tenths));
            }
        }
    }

    fn run(
        &mut self,
        code: &Code,
        rows: &[Row],
        run: &mut Run,
        watch: &mut impl FnMut(Glimpse<'_, L>) -> bool,
    ) {
        let (mut at, most_ops) = (0, self.most_ops());
        while let Some(op) = code.ops.get(at) {
            let mut next = at + 1;
            run.ops += 1;
            if run.ops > most_ops && !run.renew(&mut self.interrupts) {
                run.error(code, at, ErrorKind::Watchdog, 0);
                return;
            }
            match *op {
                Op::Rows(from, to) => {
                    row::run(&rows[from as usize..to as usize], &mut self.memory.cells);
                    // The watchdog counts instructions, whatever they became.
                    run.ops += u64::from(to - from);
                    at = next;
                    continue;
                }
                Op::Seen { place, power } => {
                    let sight = Sight { instruction: place, conducts: None, power: self.memory.cell(power) };
                    if !watch(run.glimpse(self, sight)) {
                        run.outcome.is_broken_off = true;
                        return;
                    }
                    at = next;
                    continue;
                }
                Op::SeenContact { place, src, invert, power } => {
                    let conducts = self.memory.cell(src) ^ L::all(invert);
                    let power = self.memory.cell(power);
                    let sight = Sight { instruction: place, conducts: Some(conducts), power };
                    if !watch(run.glimpse(self, sight)) {
                        run.outcome.is_broken_off = true;
                        return;
                    }
                    at = next;
                    continue;
                }
                Op::Timer { power, timer } => {
                    let power = self.memory.cell(power);
                    let moment = self.moment();
                    timing::timer(&mut self.memory, timer, power, moment);
                }
                Op::Counter { power, counter } => {
                    let power = self.memory.cell(power);
                    timing::counter(&mut self.memory, counter, power);
                }
                Op::HighSpeed { power, counter } => {
                    let power = self.memory.cell(power);
                    timing::high_speed(&mut self.memory, counter, power);
                }
                Op::Clear { power, device } => self.clear(code, self.memory.cell(power), device),
                Op::Execute { power, call } => self.execute(code, at, power, call, run),
                Op::Test { to, call } => self.test(code, at, to, call, run),
                Op::Transfer { power, state, list } => {
                    self.transfer(code, self.memory.cell(power), state, list);
                }
                Op::Step { rail, was, state, above, end } => {
                    let active = self.memory.cell(state) & self.memory.cell(above);
                    let is_left = active == L::NONE && self.memory.cell(was) == L::NONE;
                    self.memory.set_cell(rail, active);
                    self.memory.set_cell(was, active);
                    if is_left {
                        next = end as usize;
                    }
                }
                Op::Jump { power, to } => {
                    if self.memory.bit(power, 0) {
                        next = to as usize;
                    }
                }
                Op::Call { power, to } => {
                    if self.memory.bit(power, 0) {
                        if run.calls.len() >= code.target.limits.calls as usize + run.routines.len() {
                            run.error(code, at, ErrorKind::TooDeep, 0);
                            return;
                        }
                        run.calls.push(next);
                        next = to as usize;
                    }
                }
                Op::Interrupt => next = self.interrupt(code, run, next),
                Op::Return => match run.calls.pop() {
                    Some(back) => {
                        next = back;
                        if run.routines.pop_if(|depth| *depth > run.calls.len()).is_some() {
                            self.interrupts.are_allowed = true;
                            next = self.interrupt(code, run, back);
                        }
                    }
                    None => {
                        run.error(code, at, ErrorKind::NothingToReturnTo, 0);
                        return;
                    }
                },
                Op::For { call, next: behind } => {
                    let rounds = self.rounds(code, at, call, run);
                    run.leave_loop(next);
                    if rounds < 1 {
                        next = behind as usize;
                    } else if run.loops.len() >= code.target.limits.loops as usize {
                        run.error(code, at, ErrorKind::TooDeep, 0);
                        return;
                    } else {
                        run.loops.push((next, rounds));
                    }
                }
                Op::Next { first } => match run.inner_loop(first as usize) {
                    Some((begin, rounds)) => {
                        *rounds -= 1;
                        if *rounds > 0 {
                            next = *begin;
                        } else {
                            run.loops.pop();
                        }
                    }
                    None => {
                        run.error(code, at, ErrorKind::NothingToReturnTo, 0);
                        return;
                    }
                },
                Op::End => return,
            }
            if !self.forces.is_empty() {
                self.hold();
            }
            at = next;
        }
    }

    /// Where the program goes on if an interrupt may run here: at its routine, and behind that at `back`.
    fn interrupt(&mut self, code: &Code, run: &mut Run, back: usize) -> usize {
        if run.routines.len() >= interrupts::MOST_NESTED {
            return back;
        }
        let (layout, memory) = (&code.layout, &self.memory);
        let is_on = |device| layout.cell(device).is_some_and(|cell| memory.bit(cell, 0));
        let Some(routine) = self.interrupts.take(code, is_on) else { return back };
        run.calls.push(back);
        run.routines.push(run.calls.len());
        routine
    }

    /// RST of what is no relay.
    fn clear(&mut self, code: &Code, power: L, device: Device) {
        let (cell, slot) = (code.layout.cell(device), code.layout.slot(device));
        if let Some(cell) = cell {
            let contact = self.memory.cell(cell);
            self.memory.set_cell(cell, contact & !power);
            self.memory.set_cell(cell + RESET, power);
        }
        for lane in (0..L::COUNT).filter(|lane| power.lane(*lane)) {
            if let Some(slot) = slot {
                self.memory.set_word(slot, lane, 0);
                if device.kind == DeviceKind::T {
                    self.memory.set_word(slot + NS_BEYOND, lane, 0);
                }
            }
        }
    }

    /// SET or OUT of a state in a step: the step is left for it, unless M8040 forbids transfers.
    fn transfer(&mut self, code: &Code, power: L, state: Cell, list: u32) {
        let forbidden =
            code.layout.cell(Device::new(DeviceKind::M, 8040)).map_or(L::NONE, |cell| self.memory.cell(cell));
        let done = power & !forbidden;
        for source in code.states.get(list as usize).into_iter().flatten() {
            let source_state = self.memory.cell(*source);
            self.memory.set_cell(*source, source_state & !done);
        }
        let entered = self.memory.cell(state) | done;
        self.memory.set_cell(state, entered);
    }

    fn execute(&mut self, code: &Code, at: usize, power: Cell, call: u32, run: &mut Run) {
        let Some(called) = code.calls.get(call as usize) else { return };
        let CallCode::Deed(deed) = called.code else { return };
        let power = self.memory.cell(power);
        let before = self.memory.cell(called.was);
        self.memory.set_cell(called.was, power);
        let executed = match (called.is_always, called.form.pulse) {
            (true, _) => L::ALL,
            (false, true) => power & !before,
            (false, false) => power,
        };
        if executed == L::NONE {
            return;
        }
        for lane in (0..L::COUNT).filter(|lane| executed.lane(*lane)) {
            let is_rising = power.lane(lane) && !before.lane(lane);
            let done = deed(&mut self.executing(code, called, lane, power.lane(lane), is_rising));
            if let Err(fault) = done {
                self.fault(code, at, fault, lane, run);
            }
        }
    }

    fn test(&mut self, code: &Code, at: usize, to: Cell, call: u32, run: &mut Run) {
        let Some(called) = code.calls.get(call as usize) else { return };
        let CallCode::Test(holds) = called.code else { return };
        let mut conducts = L::NONE;
        for lane in 0..L::COUNT {
            match holds(&mut self.executing(code, called, lane, true, false)) {
                Ok(on) => conducts = conducts.with(lane, on),
                Err(fault) => self.fault(code, at, fault, lane, run),
            }
        }
        self.memory.set_cell(to, conducts);
    }

    /// How many rounds FOR makes: one at least, unless nobody can say.
    fn rounds(&mut self, code: &Code, at: usize, call: u32, run: &mut Run) -> i64 {
        let Some(called) = code.calls.get(call as usize) else { return 0 };
        match self.executing(code, called, 0, true, false).word(0, 0) {
            Ok(rounds) => rounds.max(1),
            Err(fault) => {
                self.fault(code, at, fault, 0, run);
                0
            }
        }
    }

    fn executing<'m>(
        &'m mut self,
        code: &'m Code,
        call: &'m Call,
        lane: usize,
        power: bool,
        is_rising: bool,
    ) -> Executing<'m, L> {
        Executing {
            memory: &mut self.memory,
            terminals: &mut self.terminals,
            outside: &mut self.outside[lane],
            interrupts: &mut self.interrupts,
            model: code.target.model,
            layout: &code.layout,
            call,
            lane,
            power,
            is_rising,
            now_ns: self.now_ns,
            scan_ns: self.scan_ns,
            is_first_scan: self.scans == 1,
        }
    }

    /// Tells the program and the caller that an instruction was not executed.
    fn fault(&mut self, code: &Code, at: usize, fault: Fault, lane: usize, run: &mut Run) {
        for number in [8067, 8068, 8004] {
            if let Some(cell) = code.layout.cell(Device::new(DeviceKind::M, number)) {
                self.memory.set_bit(cell, lane, true);
            }
        }
        for (number, value) in [(8067, fault.code()), (8004, 8067)] {
            if let Some(slot) = code.layout.slot(Device::new(DeviceKind::D, number)) {
                self.memory.set_word(slot, lane, value);
            }
        }
        run.error(code, at, ErrorKind::Fault(fault), lane);
    }
}

/// A scan that runs.
#[derive(Default)]
pub(super) struct Run {
    outcome: Outcome,
    /// Where calls go back to.
    calls: Vec<usize>,
    /// Behind which calls the routines of interrupts run.
    routines: Vec<usize>,
    /// Where loops begin, and how many rounds are left.
    loops: Vec<(usize, i64)>,
    ops: u64,
    /// How often WDT has given the scan more time.
    renewals: u32,
}

/// More often WDT does not help: a loop without end is stopped all the same.
const MOST_RENEWALS: u32 = 8;

impl Run {
    /// Whether the watchdog begins again, as WDT has been executed.
    fn renew(&mut self, interrupts: &mut Interrupts) -> bool {
        let is_renewed = interrupts.is_watchdog_restarted && self.renewals < MOST_RENEWALS;
        if is_renewed {
            interrupts.is_watchdog_restarted = false;
            self.renewals += 1;
            self.ops = 0;
        }
        is_renewed
    }

    fn glimpse<'m, L>(&'m self, machine: &'m Machine<L>, sight: Sight<L>) -> Glimpse<'m, L> {
        Glimpse { machine, sight, calls: &self.calls, routines: &self.routines }
    }

    /// The loop that begins at an op, if it runs. A jump may have left loops within it, which are done with.
    fn inner_loop(&mut self, begin: usize) -> Option<&mut (usize, i64)> {
        let own = self.loops.iter().rposition(|(op, _)| *op == begin)?;
        self.loops.truncate(own + 1);
        self.loops.last_mut()
    }

    /// A loop that begins again was left by a jump, if it runs.
    fn leave_loop(&mut self, begin: usize) {
        if self.inner_loop(begin).is_some() {
            self.loops.pop();
        }
    }

    pub(super) fn error(&mut self, code: &Code, at: usize, kind: ErrorKind, lane: usize) {
        if self.outcome.errors.len() < Outcome::MOST_ERRORS {
            self.outcome.errors.push(Error { place: code.place(at), kind, lane });
        }
    }
}
