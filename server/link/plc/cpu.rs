//! The CPU of the virtual PLC: its program, its mode, and the scans that it runs.

use crate::document::{Comments, Document, Notation};
use crate::link::{Mode, Switch};
use crate::machine_code::{END, Image, ParameterBlock, decode, sum, words_of};
use crate::simulate::{Code, Machine, Value, Variable, compile};
use crate::target::{Device, DeviceKind, Latches, Target};
use std::sync::Arc;

/// A PLC without hardware.
#[derive(Clone, Debug)]
pub struct Plc {
    pub(super) target: &'static Target,
    /// Parameters and program as they lie from 8000 on.
    pub(super) program: Vec<u8>,
    /// Whether something has been written into the program since it was last taken over.
    pub(super) is_open: bool,
    pub(super) machine: Machine<u8>,
    /// The words of a program that ran with these latches, and what runs them.
    coded: Option<(Vec<u16>, Latches, Arc<Code>)>,
    /// What a host wants to watch, as it wrote it.
    pub(super) watch_list: Vec<u8>,
    pub(super) mode: Mode,
    switch: Switch,
    /// From one scan to the next.
    scan_ns: i64,
    /// When the next scan is due; scans are counted from when the CPU came to RUN.
    next_ns: i64,
    started_ns: i64,
    /// Whether something has changed that is to be kept without power.
    pub(super) is_changed: bool,
    /// Whether a program was taken over meanwhile.
    pub(super) is_taken_over: bool,
}

/// The special relays with which a host gives orders, and what they are for.
pub(super) const WRITE_ENABLE: u32 = 8118;
const FORCED_MODE: u32 = 8035;
const FORCED_RUN: u32 = 8036;
const FORCED_STOP: u32 = 8037;
/// On where a program cannot be run, with the number of the error in the register of the same number.
const CIRCUIT_ERROR: u32 = 8066;
/// The memory of what went wrong first.
const ERROR: u32 = 8004;
/// Bytes of the parameters before the program.
pub(super) const PARAMETER_BYTES: usize = 2 * ParameterBlock::WORDS;
/// Where the sum of the program stands in the parameters.
pub(super) const SUM: usize = 2;
/// Behind a gap of so many scans those that were missed are left out.
const MOST_LATE_SCANS: i64 = 100;
/// The most steps that addresses of 16 bits reach.
pub(super) const MOST_STEPS: usize = 16_000;

const fn relay(number: u32) -> Device {
    Device::new(DeviceKind::M, number)
}

impl Plc {
    /// A new PLC with nothing in its memory, its switch at RUN.
    pub fn new(target: &'static Target, scan_ns: i64) -> Plc {
        let steps = (target.limits.steps as usize).min(MOST_STEPS);
        let mut plc = Plc {
            target,
            program: blank(target, (steps / 1000) as u16),
            is_open: false,
            machine: Machine::new(Arc::new(nothing(target))),
            coded: None,
            watch_list: Vec::new(),
            mode: Mode::Stop,
            switch: Switch::Run,
            scan_ns: scan_ns.max(1),
            next_ns: 0,
            started_ns: 0,
            is_changed: false,
            is_taken_over: false,
        };
        plc.machine.identify();
        plc.machine.set_word(Device::new(DeviceKind::D, 8003), 0x10);
        plc.add_up();
        plc
    }

    /// With another memory, of so many thousands of steps, which is blank.
    pub fn with_memory(mut self, thousands: u16) -> Plc {
        self.program = blank(self.target, thousands);
        self.add_up();
        self
    }

    /// The model.
    pub fn target(&self) -> &'static Target {
        self.target
    }

    /// What it does.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// What runs the program.
    pub fn machine(&self) -> &Machine<u8> {
        &self.machine
    }

    /// The words of the program, unused ones too.
    pub fn words(&self) -> Vec<u16> {
        let (words, _) = self.program[PARAMETER_BYTES..].as_chunks::<2>();
        words.iter().map(|word| u16::from_le_bytes(*word)).collect()
    }

    /// Which devices it keeps without power, as its parameters say.
    pub(super) fn latches(&self) -> Latches {
        words_of(&self.program[..PARAMETER_BYTES])
            .map(|words| ParameterBlock::from_words(&words).latches())
            .unwrap_or_default()
    }

    /// Puts a program into the memory as a download does; the CPU has to stand still.
    pub fn load(&mut self, words: &[u16]) {
        let memory = &mut self.program[PARAMETER_BYTES..];
        memory.fill(0xFF);
        for (place, word) in memory.chunks_exact_mut(2).zip(words) {
            place.copy_from_slice(&word.to_le_bytes());
        }
        self.take_over();
    }

    /// Somebody turns the switch.
    pub fn turn(&mut self, switch: Switch, now_ns: i64) {
        self.switch = switch;
        match switch {
            Switch::Stop => self.stop(),
            Switch::Run => {
                self.machine.set(relay(FORCED_STOP), 0);
                self.start(now_ns);
            }
        }
    }

    /// Somebody switches what is wired to an input, or writes a device as if with a panel.
    pub fn put(&mut self, variable: Variable, value: &Value) {
        self.machine.write(variable, value);
        self.is_changed = true;
    }

    /// Runs the scans that are due; gives when the next one is, if the CPU runs.
    pub fn advance(&mut self, now_ns: i64) -> Option<i64> {
        if self.mode == Mode::Run && now_ns - self.next_ns > MOST_LATE_SCANS * self.scan_ns {
            self.next_ns = now_ns;
        }
        while self.mode == Mode::Run && self.next_ns <= now_ns {
            let outcome = self.machine.scan(self.next_ns - self.started_ns);
            let is_stopped = self.machine.bit(relay(FORCED_STOP)) != 0;
            self.next_ns += self.scan_ns.max(self.machine.least_scan_ns());
            if is_stopped || outcome.is_broken_off {
                self.stop();
            }
        }
        (self.mode == Mode::Run).then_some(self.next_ns)
    }

    /// What follows when a host has switched a special relay that is an order.
    pub(super) fn obey(&mut self, number: u32, on: bool, now_ns: i64) {
        let is_on = |number| self.machine.bit(relay(number)) != 0;
        match (number, on) {
            (FORCED_STOP, true) => self.stop(),
            (FORCED_STOP, false) if self.switch == Switch::Run => self.start(now_ns),
            (FORCED_MODE | FORCED_RUN, true)
                if is_on(FORCED_MODE) && is_on(FORCED_RUN) && !is_on(FORCED_STOP) =>
            {
                self.start(now_ns);
            }
            _ => {}
        }
    }

    /// The CPU comes to RUN if its program is whole and can be run; else it lights its error lamp.
    fn start(&mut self, now_ns: i64) {
        if self.mode == Mode::Run {
            return;
        }
        let code = if self.is_open { None } else { self.code() };
        let Some(code) = code else {
            self.complain();
            return;
        };
        let orders = [FORCED_MODE, FORCED_RUN].map(|number| (number, self.machine.bit(relay(number))));
        self.machine = self.machine.restarted(code);
        for (number, on) in orders {
            self.machine.set(relay(number), on);
        }
        self.mode = Mode::Run;
        (self.started_ns, self.next_ns) = (now_ns, now_ns);
    }

    fn complain(&mut self) {
        self.machine.set(relay(ERROR), 0xFF);
        self.machine.set_word(Device::new(DeviceKind::D, ERROR), i64::from(CIRCUIT_ERROR));
        self.machine.set(relay(CIRCUIT_ERROR), 0xFF);
        self.machine.set_word(Device::new(DeviceKind::D, CIRCUIT_ERROR), 6601);
    }

    /// The CPU stands still; outputs are off, and what is not latched is forgotten.
    fn stop(&mut self) {
        if self.mode == Mode::Stop {
            return;
        }
        self.mode = Mode::Stop;
        self.is_changed = true;
        let is_held = self.machine.bit(relay(8033)) != 0;
        let stop = self.machine.bit(relay(FORCED_STOP));
        if !is_held {
            self.machine = self.machine.restarted(Arc::clone(self.machine.code()));
        }
        self.machine.set(relay(FORCED_STOP), stop);
    }

    /// The end of a download: the program is added up, and may be run.
    pub(super) fn take_over(&mut self) {
        self.is_open = false;
        self.is_changed = true;
        self.is_taken_over = true;
        self.add_up();
    }

    /// The sum of all words of the program, unused ones too, stands in the parameters.
    fn add_up(&mut self) {
        let sum = sum(&self.words());
        self.program[SUM..SUM + 2].copy_from_slice(&sum.to_le_bytes());
    }

    /// All of the program is forgotten.
    pub(super) fn clear_program(&mut self) {
        let thousands = self.words().len() / 1000;
        self.program = blank(self.target, thousands as u16);
        self.take_over();
    }

    /// The code of the program up to END, if it has one and can be run.
    fn code(&mut self) -> Option<Arc<Code>> {
        let (memory, _) = self.program[PARAMETER_BYTES..].as_chunks::<2>();
        let end = memory.iter().position(|word| u16::from_le_bytes(*word) == END)?;
        let words: Vec<u16> = memory[..=end].iter().map(|word| u16::from_le_bytes(*word)).collect();
        let latches = self.latches();
        let is_known = |(known, kept, _): &&(Vec<u16>, Latches, _)| *known == words && *kept == latches;
        if let Some((_, _, code)) = self.coded.as_ref().filter(is_known) {
            return Some(Arc::clone(code));
        }
        let list = decode(&words, self.target.model).text;
        let comments = Arc::new(Comments::default().with_latches(latches));
        let document = Document::with_comments(&list, Notation::FxIl, self.target, comments);
        let code = Arc::new(compile(&[&document], false).ok()?);
        self.coded = Some((words, latches, Arc::clone(&code)));
        Some(code)
    }
}

/// The bytes of a memory of so many thousands of steps with nothing but END.
fn blank(target: &Target, thousands: u16) -> Vec<u8> {
    let parameters = ParameterBlock::new(target.model).with_capacity(thousands);
    Image::new(parameters, &[END]).map(|image| image.to_bytes()).unwrap_or_default()
}

/// A program that does nothing.
fn nothing(target: &'static Target) -> Code {
    let document = Document::new("END\n", Notation::FxIl, target);
    compile(&[&document], false).unwrap_or_else(|_| unreachable!("an empty program can be run"))
}
