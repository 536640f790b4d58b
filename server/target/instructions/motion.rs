//! Pulses that an output gives over many scans: how many there are after some time, with ramps and without.
//!
//! Time passes in whole milliseconds, of which each has as many pulses as its mean speed gives. The relay of the output
//! is on while pulses are given; it does not follow each of them.

use crate::target::semantics::COMPLETE;
use crate::target::{DeviceKind, Execution, Fault, Model};

/// A movement that an instruction notes from scan to scan.
#[derive(Clone, Copy)]
pub(super) struct Motion {
    pub(super) state: i64,
    /// What was given of `total`, in millionths of a pulse.
    done: i64,
    /// In thousandths of a pulse in a second.
    speed: i64,
    /// What is no whole millisecond yet.
    rest_ns: i64,
    /// In millionths of a pulse.
    total: i64,
    /// 1 forward, -1 backward.
    pub(super) direction: i64,
    /// The speed that it is to have, like `speed`.
    top: i64,
    /// A number that the instruction keeps with it.
    pub(super) kept: i64,
}

/// States of a movement.
pub(super) mod state {
    /// There is none.
    pub const IDLE: i64 = 0;
    /// It goes on.
    pub const MOVES: i64 = 1;
    /// It has come to its end.
    pub const DONE: i64 = 2;
    /// It slows down, as its power has gone.
    pub const BRAKES: i64 = 3;
    /// It was stopped by a relay.
    pub const STOPPED: i64 = 4;
}

/// How the speed changes, in thousandths of a pulse in a second, in each millisecond.
#[derive(Clone, Copy)]
pub(super) struct Ramp {
    pub(super) up: i64,
    pub(super) down: i64,
}

/// The highest speed with a ramp that any model has, in Hz.
pub(super) const MOST_HERTZ: i64 = 200_000;

/// Units of [`Motion::done`] in a pulse.
const PULSE: i64 = 1_000_000;
const MS: i64 = 1_000_000;
/// Milliseconds of one scan with a ramp; if time makes a greater leap, the rest of it is lost.
const MOST_STEPS: i64 = 1_000_000;

impl Motion {
    /// The movement that the instruction has noted.
    pub(super) fn noted(execution: &dyn Execution) -> Motion {
        let [state, done, speed, rest_ns, total, direction, top, kept] =
            std::array::from_fn(|cell| execution.noted(cell));
        Motion { state, done, speed, rest_ns, total, direction, top, kept }
    }

    /// Notes it.
    pub(super) fn note(self, execution: &mut dyn Execution) {
        let cells = [
            self.state,
            self.done,
            self.speed,
            self.rest_ns,
            self.total,
            self.direction,
            self.top,
            self.kept,
        ];
        cells.into_iter().enumerate().for_each(|(cell, value)| execution.note(cell, value));
    }

    /// A movement of `pulses` at `hertz`, without end if there are none of the former.
    pub(super) fn begin(pulses: Option<i64>, hertz: i64, direction: i64, lowest_hertz: i64) -> Motion {
        let total = pulses.map_or(i64::MAX, |pulses| pulses.saturating_mul(PULSE));
        let top = hertz * 1_000;
        let speed = (lowest_hertz * 1_000).clamp(0, top);
        Motion { state: state::MOVES, done: 0, speed, rest_ns: 0, total, direction, top, kept: 0 }
    }

    /// Changes the speed that it is to have.
    pub(super) fn set_speed(&mut self, hertz: i64) {
        self.top = hertz * 1_000;
    }

    /// Changes the speed at once.
    pub(super) fn jump_to_speed(&mut self, hertz: i64) {
        self.set_speed(hertz);
        self.speed = self.top;
    }

    /// Lets time pass; gives the pulses that were given in it.
    fn pass(&mut self, ns: i64, ramp: Option<Ramp>) -> i64 {
        let before = self.done / PULSE;
        let time_ns = self.rest_ns + ns.max(0);
        self.rest_ns = time_ns % MS;
        let steps = time_ns / MS;
        match ramp {
            None => {
                self.speed = self.top;
                self.done = self.done.saturating_add(self.top.saturating_mul(steps)).min(self.total);
            }
            Some(ramp) => {
                for _ in 0..steps.min(MOST_STEPS) {
                    if self.done >= self.total || self.state == state::BRAKES && self.speed == 0 {
                        break;
                    }
                    self.step(ramp);
                }
            }
        }
        self.done / PULSE - before
    }

    /// Lets a millisecond pass.
    fn step(&mut self, Ramp { up, down }: Ramp) {
        let (old, left) = (self.speed, self.total - self.done);
        let nearer = if old < self.top { (old + up).min(self.top) } else { (old - down).max(self.top) };
        // Whether it can still stop at the end after a step that ends at this speed.
        let can_stop = |speed: i64| left - (old + speed) / 2 >= speed * speed / (2 * down);
        self.speed = if self.state == state::BRAKES {
            (old - down).max(0)
        } else if can_stop(nearer) {
            nearer
        } else if can_stop(old) {
            old
        } else {
            (old - down).max(down.min(self.top))
        };
        self.done = self.done.saturating_add((old + self.speed) / 2).min(self.total);
    }

    fn is_at_end(&self) -> bool {
        self.done >= self.total
    }
}

/// An output that gives pulses, with what belongs to it on this model.
#[derive(Clone, Copy)]
pub(super) struct PulseOutput {
    number: u32,
    place: usize,
    model: Model,
    counts_positions: bool,
}

impl PulseOutput {
    /// The output at an operand: Y0 or Y1, on the FX3U up to Y3.
    pub(super) fn at(execution: &mut dyn Execution, place: usize) -> Result<PulseOutput, Fault> {
        let model = execution.model();
        let count = if model == Model::Fx3u { 4 } else { 2 };
        match execution.device(place)? {
            Some(device) if device.kind == DeviceKind::Y && device.number < count => {
                Ok(PulseOutput { number: device.number, place, model, counts_positions: false })
            }
            _ => Err(Fault::Value(place as u8)),
        }
    }

    /// The same, where the instruction counts positions.
    pub(super) fn of_drive(execution: &mut dyn Execution, place: usize) -> Result<PulseOutput, Fault> {
        let output = PulseOutput::at(execution, place)?;
        Ok(PulseOutput { counts_positions: true, ..output })
    }

    /// Its number: of Y1 it is 1.
    pub(super) fn number(self) -> usize {
        self.number as usize
    }

    /// The first special register of its position, or of its pulses where the model knows no positions.
    fn position_register(self) -> u32 {
        match self.model {
            Model::Fx3u => 8340 + 10 * self.number,
            _ => 8140 + 2 * self.number,
        }
    }

    /// Where it stands, as the CPU counts.
    pub(super) fn position(self, execution: &dyn Execution) -> i64 {
        pair(execution, self.position_register())
    }

    /// Makes this the place from which positions count.
    pub(super) fn clear_position(self, execution: &mut dyn Execution) {
        set_pair(execution, self.position_register(), 0);
    }

    /// The speed at which movements begin, in Hz.
    pub(super) fn lowest(self, execution: &dyn Execution) -> i64 {
        let register = if self.model == Model::Fx3u { 8342 + 10 * self.number } else { 8145 };
        execution.register(register).max(0)
    }

    /// How fast speed changes by the special registers. Those that hold 0 count as the maker sets them: 100,000 Hz
    /// within 100 ms.
    pub(super) fn ramp(self, execution: &dyn Execution) -> Ramp {
        let (top, rise, fall) = match self.model {
            Model::Fx3u => {
                let first = 8343 + 10 * self.number;
                (pair(execution, first), execution.register(first + 5), execution.register(first + 6))
            }
            _ => (pair(execution, 8146), execution.register(8148), execution.register(8148)),
        };
        let or = |value: i64, usual: i64| if value > 0 { value } else { usual };
        let top = or(top, 100_000) * 1_000;
        Ramp { up: (top / or(rise, 100)).max(1), down: (top / or(fall, 100)).max(1) }
    }

    fn is_stopped(self, execution: &dyn Execution) -> bool {
        match self.model {
            Model::Fx3u => execution.relay(8349 + 10 * self.number),
            Model::Fx2n => false,
            _ => execution.relay(8145 + self.number),
        }
    }

    /// Lets the time of a scan pass for a movement, and shows what came of it.
    pub(super) fn pass(
        self,
        execution: &mut dyn Execution,
        motion: &mut Motion,
        ramp: Option<Ramp>,
    ) -> Result<(), Fault> {
        if motion.state == state::MOVES && self.is_stopped(execution) {
            motion.state = state::STOPPED;
        }
        if matches!(motion.state, state::MOVES | state::BRAKES) {
            let pulses = motion.pass(execution.scan_ns(), ramp);
            self.count(execution, pulses, motion.direction);
            if motion.state == state::BRAKES && (motion.speed == 0 || motion.is_at_end()) {
                motion.state = state::IDLE;
            } else if motion.state == state::MOVES && motion.is_at_end() {
                motion.state = state::DONE;
            }
        }
        self.show(execution, motion)
    }

    /// Ends a movement at once when power has left it.
    pub(super) fn leave(self, execution: &mut dyn Execution) -> Result<(), Fault> {
        let mut motion = Motion::noted(execution);
        if execution.is_left() {
            execution.set_relay(COMPLETE, false);
            motion.state = state::IDLE;
            self.show(execution, &motion)?;
        }
        Ok(())
    }

    /// Shows whether pulses are given.
    pub(super) fn show(self, execution: &mut dyn Execution, motion: &Motion) -> Result<(), Fault> {
        let is_moving = matches!(motion.state, state::MOVES | state::BRAKES);
        let speed = if is_moving { motion.speed } else { 0 };
        execution.outside().axes[self.number as usize].frequency = motion.direction * speed / 1_000;
        match self.model {
            Model::Fx3u => execution.set_relay(8340 + 10 * self.number, is_moving),
            Model::Fx2n => {}
            _ => execution.set_relay(8147 + self.number, is_moving),
        }
        if execution.power() {
            execution.set_relay(COMPLETE, motion.state == state::DONE);
        }
        execution.set_bit(self.place, 0, is_moving && motion.top > 0)
    }

    /// Counts pulses where the CPU and the drive do.
    fn count(self, execution: &mut dyn Execution, pulses: i64, direction: i64) {
        let axis = &mut execution.outside().axes[self.number as usize];
        axis.position += direction * pulses;
        axis.pulses += pulses;
        let mut add = |register: u32, count: i64| {
            let sum = pair(execution, register) + count;
            set_pair(execution, register, sum);
        };
        if self.number < 2 {
            add(8136, pulses);
        }
        if self.counts_positions || self.model != Model::Fx3u {
            add(self.position_register(), direction * pulses);
        } else if self.number < 2 {
            add(8140 + 2 * self.number, pulses);
        }
    }
}

fn pair(execution: &dyn Execution, register: u32) -> i64 {
    let (lower, upper) = (execution.register(register), execution.register(register + 1));
    i64::from((upper as i32) << 16 | i32::from(lower as u16))
}

fn set_pair(execution: &mut dyn Execution, register: u32, value: i64) {
    execution.set_register(register, value);
    execution.set_register(register + 1, value >> 16);
}
