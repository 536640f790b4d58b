//! What a program tells the CPU by special relays and registers, and what the CPU does at the end of a scan.
//!
//! Sources: the tables of special devices in the FX programming manuals; what a CPU says of itself is from recordings
//! of the programming port. Where these are silent: M8037 stops the CPU at the end of the scan that switches it on, and
//! it goes on where it stopped when M8037 is switched off from outside; registers of M8047 without a state are 0.

use super::code::Code;
use super::layout::{NS_BEYOND, WRITTEN};
use super::run::Run;
use super::timing::{self, Moment};
use super::{ErrorKind, Lanes, Machine, Slot};
use crate::target::{Device, DeviceKind, Model};

/// Clears devices that are not latched.
const CLEAR: u32 = 8031;
/// Clears devices that are.
const CLEAR_LATCHED: u32 = 8032;
/// Keeps outputs and registers at a stop.
const HOLD: u32 = 8033;
/// Switches output terminals off.
const OUTPUTS_OFF: u32 = 8034;
/// Stops the CPU.
const STOP: u32 = 8037;
/// Keeps the scan time constant; its register has the same number.
const CONSTANT: u32 = 8039;
/// On while a state is on.
const STATE_ON: u32 = 8046;
/// Switches on watching states.
const WATCH_STATES: u32 = 8047;
/// The registers of the lowest states that are on.
const LOWEST_STATES: std::ops::RangeInclusive<u32> = 8040..=8047;
/// The time of the watchdog.
const WATCHDOG: u32 = 8000;
/// The type of the CPU and its version, and a second time.
const TYPES: [u32; 2] = [8001, 8101];
/// Memory for the program in thousands of steps as older tools know it, and all of it.
const MEMORY: [u32; 2] = [8002, 8102];
/// The watchdog if the program says nothing else, and at most, in milliseconds.
const WATCHDOG_MS: (i64, i64) = (200, 2_000);
/// Annunciators are no steps.
const ANNUNCIATORS: std::ops::RangeInclusive<u32> = 900..=999;

/// On while there is an error of one of these kinds; its register says which relay is on.
const ANY_ERROR: u32 = 8004;

/// A kind of errors, each with a relay, and a register of the same number for the code.
#[derive(Clone, Copy)]
pub(super) struct CpuError {
    relay: u32,
    /// Remembers that there was one.
    memory: Option<u32>,
}

impl CpuError {
    /// The CPU stops, as if it were broken.
    pub(super) const HARDWARE: CpuError = CpuError { relay: 8061, memory: None };
    /// An instruction is not executed, and the CPU goes on.
    pub(super) const OPERATION: CpuError = CpuError { relay: 8067, memory: Some(8068) };
}

/// Whether a register is among those in which the CPU says what it is, which nobody can change.
pub fn is_identity(device: Device) -> bool {
    device.kind == DeviceKind::D && TYPES.iter().chain(&MEMORY).any(|number| *number == device.number)
}

impl<L: Lanes> Machine<L> {
    /// Tells the program of an error in special relays and registers.
    pub(super) fn tell(&mut self, code: &Code, lanes: L, error: CpuError, number: i64) {
        for relay in [Some(error.relay), error.memory, Some(ANY_ERROR)].into_iter().flatten() {
            if let Some(cell) = code.layout.cell(Device::new(DeviceKind::M, relay)) {
                self.memory.set_cell(cell, self.memory.cell(cell) | lanes);
            }
        }
        for (register, value) in [(error.relay, number), (ANY_ERROR, i64::from(error.relay))] {
            let Some(slot) = code.layout.slot(Device::new(DeviceKind::D, register)) else { continue };
            for lane in (0..L::COUNT).filter(|lane| lanes.lane(*lane)) {
                self.memory.set_word(slot, lane, value);
            }
        }
    }

    /// What the CPU says of itself when it gets power, in special registers.
    pub fn identify(&mut self) {
        let target = self.code.target;
        let steps = i64::from(target.limits.steps / 1000);
        // An FX3U says first that it is an FX2N, for tools that know no other.
        let (first, other) = match target.model {
            Model::Fx1s => (22_210, 22_210),
            Model::Fx1n => (26_210, 26_210),
            Model::Fx3u => (24_232, 16_232),
            _ => (24_310, 24_310),
        };
        let known = [
            (WATCHDOG, WATCHDOG_MS.0),
            (TYPES[0], first),
            (TYPES[1], other),
            (MEMORY[0], steps.min(8)),
            (MEMORY[1], steps),
        ];
        for (number, value) in known {
            let register = Device::new(DeviceKind::D, number);
            // What was set before the start stays.
            if self.word(register, 0) == 0 {
                self.set_word(register, value);
            }
        }
    }

    /// The present scan, for timers.
    pub(super) fn moment(&self) -> Moment {
        Moment { scan: self.scans as i64, elapsed_ns: self.scan_ns }
    }

    /// Ops that a scan may run before the watchdog stops it, of an FX by D8000.
    pub(super) fn most_ops(&self) -> u64 {
        if !self.code.target.is_fx() {
            return Self::MOST_OPS;
        }
        let ms = self.word(Device::new(DeviceKind::D, WATCHDOG), 0).clamp(1, WATCHDOG_MS.1);
        Self::MOST_OPS / WATCHDOG_MS.0 as u64 * ms as u64
    }

    /// The time from one scan to the next that the program asks for by M8039 and D8039, in nanoseconds; 0 if it does
    /// not.
    pub fn least_scan_ns(&self) -> i64 {
        match self.orders(CONSTANT).lane(0) {
            true => self.word(Device::new(DeviceKind::D, CONSTANT), 0).max(0) * 1_000_000,
            false => 0,
        }
    }

    fn orders(&self, number: u32) -> L {
        let cell = self.code.layout.cell(Device::new(DeviceKind::M, number));
        cell.map_or(L::NONE, |cell| self.memory.cell(cell))
    }

    /// Whether the program has stopped the CPU.
    fn is_stopped(&self) -> bool {
        self.orders(STOP).lane(0)
    }

    /// Whether the watchdog has.
    fn is_broken(&self) -> bool {
        self.orders(CpuError::HARDWARE.relay).lane(0)
    }

    /// Whether a scan executes the program.
    pub(super) fn is_running(&self) -> bool {
        !self.is_stopped() && !self.is_broken()
    }

    /// A scan of a CPU that is stopped: the program is not executed.
    pub(super) fn stand_still(&mut self) {
        self.set(Device::new(DeviceKind::M, 8000), L::NONE);
    }

    /// What follows when the program has run: outputs are published.
    pub(super) fn end_scan(&mut self, code: &Code, run: &mut Run) {
        let moment = self.moment();
        for timer in &code.routine_timers {
            timing::routine_timer(&mut self.memory, *timer, moment);
        }
        self.watch_states();
        let is_stopped = self.is_stopped();
        let is_held = self.orders(HOLD).lane(0);
        let has_forgotten = is_stopped && !is_held;
        if self.orders(CLEAR) != L::NONE || has_forgotten {
            let lanes = if has_forgotten { L::ALL } else { self.orders(CLEAR) };
            let own: Vec<Device> = code.layout.forgetful().collect();
            self.clear_all(own.into_iter(), lanes);
        }
        if self.orders(CLEAR_LATCHED) != L::NONE {
            let lanes = self.orders(CLEAR_LATCHED);
            let own: Vec<Device> = code.layout.latched().collect();
            self.clear_all(own.into_iter(), lanes);
        }
        self.hold();
        self.terminals.switch_off(self.orders(OUTPUTS_OFF) | L::all(self.is_broken()));
        self.terminals.publish(&self.memory);
        if is_stopped {
            run.error(code, code.ops.len().saturating_sub(1), ErrorKind::Stopped, 0);
        }
    }

    fn clear_all(&mut self, devices: impl Iterator<Item = Device>, lanes: L) {
        let is_cleared = |device: &Device| device.kind != DeviceKind::X && !device.is_special();
        for device in devices.filter(is_cleared) {
            if let Some(cell) = self.code.layout.cell(device) {
                let behind = if device.kind.has_preset() { 1 } else { 0 };
                for cell in cell..=cell + behind {
                    self.memory.set_cell(cell, self.memory.cell(cell) & !lanes);
                }
            }
            let Some(slot) = self.code.layout.slot(device) else { continue };
            for lane in (0..L::COUNT).filter(|lane| lanes.lane(*lane)) {
                self.memory.set_word(slot, lane, 0);
                if device.kind == DeviceKind::T {
                    self.memory.set_word(slot + NS_BEYOND, lane, 0);
                }
            }
        }
    }

    /// While M8047 is on, M8046 tells that a state is on, and D8040 to D8047 have the lowest of them.
    fn watch_states(&mut self) {
        let watched = self.orders(WATCH_STATES);
        let code = std::sync::Arc::clone(&self.code);
        let layout = &code.layout;
        let Some(any) = layout.cell(Device::new(DeviceKind::M, STATE_ON)) else { return };
        if watched == L::NONE {
            self.memory.set_cell(any, L::NONE);
            return;
        }
        let states = layout.devices().filter(|device| device.kind == DeviceKind::S);
        let states: Vec<(u32, u16)> = states
            .filter(|state| !ANNUNCIATORS.contains(&state.number))
            .filter_map(|state| Some((state.number, layout.cell(state)?)))
            .collect();
        let registers: Vec<Slot> =
            LOWEST_STATES.filter_map(|number| layout.slot(Device::new(DeviceKind::D, number))).collect();
        for lane in (0..L::COUNT).filter(|lane| watched.lane(*lane)) {
            let mut on =
                states.iter().filter(|(_, cell)| self.memory.bit(*cell, lane)).map(|(state, _)| *state);
            let lowest: Vec<u32> = on.by_ref().take(registers.len()).collect();
            self.memory.set_bit(any, lane, !lowest.is_empty());
            for (place, register) in registers.iter().enumerate() {
                let state = lowest.get(place).copied().unwrap_or(0);
                self.memory.set_word(*register, lane, i64::from(state));
            }
        }
    }

    /// Timers whose current value was held see at their coils that something else has written it.
    pub(super) fn note_written(&mut self, slot: Slot) {
        let device = self.code.layout.device_of_slot(slot).filter(|device| device.kind == DeviceKind::T);
        if let Some(contact) = device.and_then(|timer| self.code.layout.cell(timer)) {
            self.memory.set_cell(contact + WRITTEN, L::ALL);
        }
    }
}
