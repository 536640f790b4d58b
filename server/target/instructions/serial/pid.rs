//! PID: a controller that adds a change to its output in each sampling time.
//!
//! The change is gain × ((error − error before) + sampling time / integral time × error + derivative part). The
//! derivative part follows the measured value, not the error, through a first-order filter whose time is the derivative
//! gain times the derivative time. Source: the equations of the FX programming manuals, which this follows.

mod tuning;

use crate::target::{Execution, Fault, Model};

/// The parameters, from the first word on.
struct Parameters {
    /// In seconds.
    sampling: f64,
    /// Bits: the output rises with the set value less the measured one; alarms; limits.
    switches: i64,
    /// How much of the filtered value before remains, 0 to 1.
    filter: f64,
    gain: f64,
    /// In seconds; 0 for none.
    integral: f64,
    /// The time of the derivative part's filter, in seconds.
    damping: f64,
    /// In seconds; 0 for none.
    derivative: f64,
}

/// Bits of the second parameter.
const REVERSE: i64 = 1;
const INPUT_ALARM: i64 = 2;
const OUTPUT_ALARM: i64 = 4;
const AUTOMATIC_TUNING: i64 = 16;
const LIMITS: i64 = 32;
/// Of an FX3U: the other method of tuning.
const LIMIT_CYCLE: i64 = 64;

/// Places of parameters behind the first: how fast the measured value and the output may rise and fall, of the output
/// its limits instead, and the alarms.
const INPUT_RISE: i64 = 20;
const INPUT_FALL: i64 = 21;
const OUTPUT_RISE: i64 = 22;
const OUTPUT_FALL: i64 = 23;
const ALARMS: i64 = 24;

/// Cells in which it notes things: real numbers by their bits.
mod note {
    pub(super) const RUNS: usize = 0;
    pub(super) const NS: usize = 1;
    pub(super) const FILTERED: usize = 2;
    pub(super) const FILTERED_BEFORE: usize = 3;
    pub(super) const ERROR: usize = 4;
    pub(super) const DERIVATIVE: usize = 5;
    pub(super) const OUTPUT: usize = 6;
    pub(super) const MEASURED: usize = 7;
}

/// What it does: noted as what runs.
const CONTROLS: i64 = 1;
const TUNES: i64 = 2;

/// The error codes of D8067.
const SAMPLING_TOO_SHORT: i64 = 6740;
const OUTPUT_OVERFLOW: i64 = 6747;

fn real(execution: &dyn Execution, cell: usize) -> f64 {
    f64::from_bits(execution.noted(cell) as u64)
}

fn note(execution: &mut dyn Execution, cell: usize, value: f64) {
    execution.note(cell, value.to_bits() as i64);
}

/// Warns by the error registers while it goes on.
fn warn(execution: &mut dyn Execution, code: i64) {
    execution.set_relay(8067, true);
    execution.set_register(8067, code);
}

fn parameters(execution: &mut dyn Execution) -> Result<Parameters, Fault> {
    const LIMITS_OF_PARAMETERS: [(i64, i64, i64, u16); 6] = [
        (0, 1, 32_767, 6730),
        (2, 0, 99, 6732),
        (3, 0, 32_767, 6733),
        (4, 0, 32_767, 6734),
        (5, 0, 200, 6735),
        (6, 0, 32_767, 6736),
    ];
    for (place, least, most, code) in LIMITS_OF_PARAMETERS {
        if !(least..=most).contains(&execution.word(2, place)?) {
            return Err(Fault::Pid(code));
        }
    }
    let switches = execution.word(2, 1)?;
    let is_limit_cycle = switches & LIMIT_CYCLE != 0 && execution.model() == Model::Fx3u;
    if switches & AUTOMATIC_TUNING != 0 && is_limit_cycle {
        return Err(Fault::LimitCycle);
    }
    if switches & OUTPUT_ALARM != 0 && switches & LIMITS != 0 {
        return Err(Fault::Value(2));
    }
    let mut word = |place: i64| execution.word(2, place).map(|word| word as f64);
    let derivative = word(6)? / 100.0;
    Ok(Parameters {
        sampling: word(0)? / 1_000.0,
        switches,
        filter: word(2)? / 100.0,
        gain: word(3)? / 100.0,
        integral: word(4)? / 10.0,
        damping: word(5)? / 100.0 * derivative,
        derivative,
    })
}

pub(super) fn control(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        execution.is_left();
        return Ok(());
    }
    let mut parameters = parameters(execution)?;
    let (wanted, measured) = (execution.word(0, 0)? as f64, execution.word(1, 0)? as f64);
    let present = execution.word(3, 0)?;
    execution.word(2, ALARMS)?;
    let is_tuning = parameters.switches & AUTOMATIC_TUNING != 0;
    let mode = if is_tuning { TUNES } else { CONTROLS };
    let is_first = execution.noted(note::RUNS) != mode;
    let sampling_ns = (parameters.sampling * 1e9).round() as i64;
    let passed_ns = execution.noted(note::NS) + execution.scan_ns();
    if !is_first && passed_ns < sampling_ns {
        execution.note(note::NS, passed_ns);
        return Ok(());
    }
    if sampling_ns < execution.scan_ns() {
        parameters.sampling = execution.scan_ns() as f64 / 1e9;
        warn(execution, SAMPLING_TOO_SHORT);
    }
    execution.note(note::RUNS, mode);
    execution.note(note::NS, if is_first { 0 } else { passed_ns % sampling_ns });
    if is_tuning {
        return tuning::sample(execution, &parameters, is_first, (wanted, measured));
    }
    if is_first {
        // The past of the measured value is taken to be what it is now, and no error is behind.
        for cell in [note::FILTERED, note::FILTERED_BEFORE, note::MEASURED] {
            note(execution, cell, measured);
        }
        for cell in [note::ERROR, note::DERIVATIVE] {
            note(execution, cell, 0.0);
        }
    }
    let change = change(execution, &parameters, wanted, measured);
    // What something else has written to the output is where it goes on from.
    let exact = real(execution, note::OUTPUT);
    let before = if exact.round() as i64 == present { exact } else { present as f64 };
    let output = limit(execution, &parameters, before + change)?;
    alarm(execution, &parameters, measured, output - before)?;
    note(execution, note::OUTPUT, output);
    note(execution, note::MEASURED, measured);
    execution.set_word(3, 0, output.round() as i64)
}

/// What is added to the output.
fn change(execution: &mut dyn Execution, parameters: &Parameters, wanted: f64, measured: f64) -> f64 {
    let (before, earlier) = (real(execution, note::FILTERED), real(execution, note::FILTERED_BEFORE));
    let filtered = measured + parameters.filter * (before - measured);
    let sign = if parameters.switches & REVERSE != 0 { -1.0 } else { 1.0 };
    let error = sign * (filtered - wanted);
    let proportional = error - real(execution, note::ERROR);
    let integral = match parameters.integral {
        0.0 => 0.0,
        time => parameters.sampling / time * error,
    };
    let derivative = match parameters.derivative {
        0.0 => 0.0,
        time => {
            let bend = sign * (filtered - 2.0 * before + earlier);
            let last = real(execution, note::DERIVATIVE);
            (time * bend + parameters.damping * last) / (parameters.sampling + parameters.damping)
        }
    };
    note(execution, note::FILTERED_BEFORE, before);
    note(execution, note::FILTERED, filtered);
    note(execution, note::ERROR, error);
    note(execution, note::DERIVATIVE, derivative);
    parameters.gain * (proportional + integral + derivative)
}

fn limit(execution: &mut dyn Execution, parameters: &Parameters, output: f64) -> Result<f64, Fault> {
    let (least, most) = (f64::from(i16::MIN), f64::from(i16::MAX));
    if parameters.switches & LIMITS != 0 {
        let (upper, lower) = (execution.word(2, OUTPUT_RISE)?, execution.word(2, OUTPUT_FALL)?);
        return Ok(output.min(upper as f64).max(lower as f64));
    }
    if output < least || most < output {
        warn(execution, OUTPUT_OVERFLOW);
    }
    Ok(output.clamp(least, most))
}

fn alarm(
    execution: &mut dyn Execution,
    parameters: &Parameters,
    measured: f64,
    change: f64,
) -> Result<(), Fault> {
    if parameters.switches & (INPUT_ALARM | OUTPUT_ALARM) == 0 {
        return Ok(());
    }
    let rise = measured - real(execution, note::MEASURED);
    let mut over = |place: i64, rise: f64| execution.word(2, place).map(|most| i64::from(rise > most as f64));
    let mut alarms = 0;
    if parameters.switches & INPUT_ALARM != 0 {
        alarms |= over(INPUT_RISE, rise)? | over(INPUT_FALL, -rise)? << 1;
    }
    if parameters.switches & OUTPUT_ALARM != 0 {
        alarms |= over(OUTPUT_RISE, change)? << 2 | over(OUTPUT_FALL, -change)? << 3;
    }
    execution.set_word(2, ALARMS, alarms)
}
