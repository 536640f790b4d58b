//! ABSD, INCD, ROTC: cams, step switches and round tables.

use crate::target::semantics::COMPLETE;
use crate::target::{Device, DeviceKind, Execution, Fault};

pub(super) fn absolute(execution: &mut dyn Execution) -> Result<(), Fault> {
    let count = execution.count(3, 1, 64)?;
    let position = execution.value(1)?;
    let mut outputs = 0;
    for output in 0..count {
        let (on, off) = (execution.value_at(0, 2 * output)?, execution.value_at(0, 2 * output + 1)?);
        let is_on = match on <= off {
            true => (on..off).contains(&position),
            false => position >= on || position < off,
        };
        outputs |= i64::from(is_on) << output;
    }
    execution.set_bits(2, 0, count, outputs)
}

pub(super) fn incremental(execution: &mut dyn Execution) -> Result<(), Fault> {
    let count = execution.count(3, 1, 64)?;
    let counter = match execution.device(1)? {
        Some(counter) if counter.kind == DeviceKind::C => counter,
        _ => return Err(Fault::NoDevice(1)),
    };
    let steps = Device::new(DeviceKind::C, counter.number + 1);
    if !execution.power() {
        if execution.is_left() {
            execution.clear(steps)?;
            execution.clear(counter)?;
            execution.set_bits(2, 0, count, 0)?;
            execution.set_relay(COMPLETE, false);
        }
        return Ok(());
    }
    let mut step = execution.word(1, 1)?;
    if !(0..count).contains(&step) {
        step = 0;
    }
    let is_reached = execution.word(1, 0)? >= execution.word(0, step)?;
    let is_last = is_reached && step == count - 1;
    if is_reached {
        step = if is_last { 0 } else { step + 1 };
    }
    execution.set_bits(2, 0, count, 1 << step)?;
    if is_reached {
        execution.clear(counter)?;
    }
    execution.set_word(1, 1, step)?;
    execution.note(0, 1);
    execution.set_relay(COMPLETE, is_last);
    Ok(())
}

/// Places of the outputs behind the three signals.
const FAST_FORWARD: i64 = 0;
const SLOW_FORWARD: i64 = 1;
const HALT: i64 = 2;
const SLOW_BACKWARD: i64 = 3;
const FAST_BACKWARD: i64 = 4;

pub(super) fn rotary_table(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        return if execution.is_left() { execution.set_bits(3, 3, 5, 0) } else { Ok(()) };
    }
    let divisions = execution.count(1, 2, 32_767)?;
    let slow = execution.count(2, 0, divisions)?;
    let (a, b, zero) = (execution.bit(3, 0)?, execution.bit(3, 1)?, execution.bit(3, 2)?);
    // Whether A was on is noted as 2, as 1 tells that it has run.
    let is_edge = a && execution.noted(0) == 1;
    let mut position = execution.word(0, 0)?;
    if zero {
        position = 0;
    } else if is_edge {
        position = (position + if b { -1 } else { 1 }).rem_euclid(divisions);
    }
    let (station, item) = (execution.word(0, 1)?, execution.word(0, 2)?);
    if !(0..divisions).contains(&station) || !(0..divisions).contains(&item) {
        return Err(Fault::Value(0));
    }
    let forward = (item - station - position).rem_euclid(divisions);
    let backward = divisions - forward;
    let command = match (forward, forward <= backward) {
        (0, _) => HALT,
        (way, true) => {
            if way > slow {
                FAST_FORWARD
            } else {
                SLOW_FORWARD
            }
        }
        (_, false) => {
            if backward > slow {
                FAST_BACKWARD
            } else {
                SLOW_BACKWARD
            }
        }
    };
    execution.set_bits(3, 3, 5, 1 << command)?;
    execution.set_word(0, 0, position)?;
    execution.note(0, if a { 2 } else { 1 });
    Ok(())
}
