//! Automatic tuning by the response to a step.
//!
//! The output stays as the program has set it. From one sampling time to the next the measured value rises most
//! steeply somewhere; the tangent there meets the value of the start after the dead time. When the value has gone a
//! third of the way that was wanted, gain, integral time, derivative time and direction are written and the bit that
//! asked for it goes off. Source of the procedure: the analog control manual of the FX3U, "step response method". It
//! does not say how the CPU computes; here these are the values of Ziegler and Nichols for a controller of three
//! parts, 1.2 / (slope × dead time), twice and half the dead time ("Optimum settings for automatic controllers", 1942).

use super::{AUTOMATIC_TUNING, Parameters, REVERSE, note, real};
use crate::target::{Execution, Fault};

/// Where the measured value began, and how far it was from the wanted one.
const START: usize = note::FILTERED;
const DISTANCE: usize = note::FILTERED_BEFORE;
/// The steepest change, for each second, and the dead time that its tangent shows.
const SLOPE: usize = note::ERROR;
const DEAD_TIME: usize = note::DERIVATIVE;
/// Since the start, in seconds.
const TIME: usize = note::OUTPUT;

/// A smaller distance at the start is an error.
const LEAST_DISTANCE: f64 = 150.0;
/// Its code.
const NOT_TUNED: u16 = 6750;

/// What is done in a sampling time, with the wanted value and the measured one.
pub(super) fn sample(
    execution: &mut dyn Execution,
    parameters: &Parameters,
    is_first: bool,
    (wanted, measured): (f64, f64),
) -> Result<(), Fault> {
    if is_first {
        for (cell, value) in [(START, measured), (DISTANCE, wanted - measured), (note::MEASURED, measured)] {
            note(execution, cell, value);
        }
        for cell in [SLOPE, DEAD_TIME, TIME] {
            note(execution, cell, 0.0);
        }
    }
    let (start, distance) = (real(execution, START), real(execution, DISTANCE));
    if distance.abs() < LEAST_DISTANCE {
        return Err(Fault::Pid(NOT_TUNED));
    }
    if is_first {
        return Ok(());
    }
    let time = real(execution, TIME) + parameters.sampling;
    note(execution, TIME, time);
    let slope = (measured - real(execution, note::MEASURED)) / parameters.sampling;
    note(execution, note::MEASURED, measured);
    if slope.abs() > real(execution, SLOPE).abs() {
        note(execution, SLOPE, slope);
        let dead = time - (measured - start) / slope;
        note(execution, DEAD_TIME, dead.max(parameters.sampling));
    }
    if (measured - start).abs() < distance.abs() / 3.0 {
        return Ok(());
    }
    finish(execution, parameters.switches)
}

/// Writes what was found.
fn finish(execution: &mut dyn Execution, switches: i64) -> Result<(), Fault> {
    let (slope, dead) = (real(execution, SLOPE), real(execution, DEAD_TIME));
    let output = execution.word(3, 0)? as f64;
    // In percent, 100 ms and 10 ms.
    let found = [120.0 * (output / (slope * dead)).abs(), 20.0 * dead, 50.0 * dead];
    for (place, value) in [3, 4, 6].into_iter().zip(found) {
        execution.set_word(2, place, value.round().clamp(1.0, 32_767.0) as i64)?;
    }
    // What the output has driven up is controlled in reverse.
    let is_reverse = (slope > 0.0) == (output > 0.0);
    let direction = if is_reverse { switches | REVERSE } else { switches & !REVERSE };
    execution.set_word(2, 1, direction & !AUTOMATIC_TUNING)
}
