//! IST: the switches of a step program.

use crate::target::{Device, DeviceKind, Execution, Fault};

/// Cells in which it notes things.
mod note {
    /// The mode of the scan before, from 1; 0 before the first.
    pub(super) const MODE: usize = 0;
    /// Whether the start switch of the mode was on.
    pub(super) const START: usize = 1;
    /// Whether a continuous run has been started and not stopped.
    pub(super) const RUNS: usize = 2;
    /// Whether transfers wait for the start switch.
    pub(super) const STOPPED: usize = 3;
}

/// The three modes of a step program, each with its initial state.
const MANUAL: i64 = 0;
const RETURN: i64 = 1;
const AUTOMATIC: i64 = 2;

/// Places of the switches behind the first one.
const ONE_STEP: i64 = 2;
const CONTINUOUS: i64 = 4;
const START_RETURN: i64 = 5;
const START_AUTOMATIC: i64 = 6;
const STOP: i64 = 7;

pub(super) fn initial_state(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (Some(lowest), Some(highest)) = (execution.device(1)?, execution.device(2)?) else {
        return Err(Fault::NoDevice(1));
    };
    if lowest.number < 20 || lowest.number >= highest.number {
        return Err(Fault::Value(1));
    }
    let switches = execution.bits(0, 0, 8)?;
    let is_on = |place: i64| switches >> place & 1 == 1;
    execution.set_relay(8047, true);
    let Some(chosen) = (0..5).find(|place| is_on(*place)) else { return Ok(()) };
    let mode = chosen.min(AUTOMATIC);
    if execution.noted(note::MODE) != mode + 1 {
        change_mode(execution, mode, lowest.number..=highest.number)?;
    }
    let start = is_on(if mode == RETURN { START_RETURN } else { START_AUTOMATIC });
    let is_start = start && execution.noted(note::START) == 0 && mode != MANUAL;
    execution.note(note::START, i64::from(start));
    if is_on(STOP) {
        execution.note(note::RUNS, 0);
        execution.note(note::STOPPED, 1);
    } else if is_start {
        execution.note(note::RUNS, 1);
        execution.note(note::STOPPED, 0);
    }
    let transfers_start = match chosen {
        CONTINUOUS => execution.noted(note::RUNS) != 0,
        _ => mode == AUTOMATIC && start,
    };
    let transfers_wait = match chosen {
        MANUAL => true,
        ONE_STEP => !is_start,
        // The cycle is finished: continuous operation ends where M8041 is asked for.
        CONTINUOUS => false,
        _ => execution.noted(note::STOPPED) != 0,
    };
    execution.set_relay(8040, transfers_wait);
    execution.set_relay(8041, transfers_start);
    execution.set_relay(8042, is_start);
    Ok(())
}

/// Leaves the states of the mode before, and enters the initial one of this mode.
fn change_mode(
    execution: &mut dyn Execution,
    mode: i64,
    automatic: std::ops::RangeInclusive<u32>,
) -> Result<(), Fault> {
    let is_first = execution.noted(note::MODE) == 0;
    for state in (0..3).chain(10..20).chain(automatic) {
        execution.clear(Device::new(DeviceKind::S, state))?;
    }
    // Neither at home nor told to leave them on.
    if !is_first && !execution.relay(8044) && !execution.relay(8045) {
        for output in 0.. {
            if execution.clear(Device::new(DeviceKind::Y, output)).is_err() {
                break;
            }
        }
    }
    if mode == RETURN {
        execution.set_relay(8043, false);
    }
    execution.note(note::MODE, mode + 1);
    execution.note(note::START, 0);
    execution.note(note::RUNS, 0);
    execution.note(note::STOPPED, 0);
    execution.set_state(mode as u32);
    Ok(())
}
