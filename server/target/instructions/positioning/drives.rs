//! ABS, ZRN, PLSV, DRVI, DRVA: movements of servo and stepping drives.

use crate::target::instructions::motion::{MOST_HERTZ, Motion, PulseOutput, state};
use crate::target::semantics::COMPLETE;
use crate::target::{Execution, Fault};

/// Scans of a reading: 32 bits and a sum of 6, two in each.
const READINGS: i64 = 19;

pub(super) fn absolute(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        if execution.is_left() {
            execution.set_relay(COMPLETE, false);
            execution.set_bits(1, 0, 3, 0)?;
        }
        return Ok(());
    }
    let reading = (execution.noted(0) + 1).min(READINGS);
    let is_over = reading == READINGS;
    if is_over {
        let position = i64::from(execution.outside().absolute);
        execution.set_double(2, 0, position)?;
    }
    // Servo on; transfer mode until it is over; a request for every other pair of bits.
    let signals = if is_over { 1 } else { 3 | (reading % 2) << 2 };
    execution.set_bits(1, 0, 3, signals)?;
    execution.note(0, reading);
    execution.set_relay(COMPLETE, is_over);
    Ok(())
}

pub(super) fn to_zero(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() && execution.noted(0) == state::IDLE {
        return Ok(());
    }
    let output = PulseOutput::of_drive(execution, 3)?;
    let mut motion = Motion::noted(execution);
    if !execution.power() {
        return brake(execution, output, motion);
    }
    let (fast, slow) = (execution.value(0)?, execution.value(1)?);
    if !(1..=MOST_HERTZ).contains(&fast) {
        return Err(Fault::Value(0));
    }
    if !(1..=fast).contains(&slow) {
        return Err(Fault::Value(1));
    }
    let is_near = execution.bit(2, 0)?;
    let ramp = output.ramp(execution);
    if motion.state == state::IDLE {
        motion = Motion::begin(None, fast, -1, output.lowest(execution));
        output.show(execution, &motion)?;
    } else if motion.state == state::MOVES && motion.kept == 1 && !is_near {
        motion.state = state::DONE;
        output.clear_position(execution);
        execution.outside().axes[output.number()].position = 0;
        output.show(execution, &motion)?;
    } else {
        output.pass(execution, &mut motion, Some(ramp))?;
    }
    // Once the switch was met it creeps.
    if motion.state == state::MOVES && is_near {
        motion.kept = 1;
        motion.set_speed(slow);
    }
    motion.note(execution);
    Ok(())
}

/// Slows a movement down when power has left it.
fn brake(execution: &mut dyn Execution, output: PulseOutput, mut motion: Motion) -> Result<(), Fault> {
    match motion.state {
        state::MOVES => motion.state = state::BRAKES,
        state::BRAKES => {}
        _ => return output.leave(execution),
    }
    let ramp = output.ramp(execution);
    output.pass(execution, &mut motion, Some(ramp))?;
    motion.note(execution);
    Ok(())
}

pub(super) fn variable(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() && execution.noted(0) == state::IDLE {
        return Ok(());
    }
    let output = PulseOutput::of_drive(execution, 1)?;
    if !execution.power() {
        execution.set_bit(2, 0, false)?;
        return output.leave(execution);
    }
    let hertz = execution.value(0)?;
    execution.set_bit(2, 0, hertz > 0)?;
    let mut motion = Motion::noted(execution);
    if motion.state == state::IDLE {
        motion = Motion::begin(None, hertz.abs(), hertz.signum(), hertz.abs());
        output.show(execution, &motion)?;
    } else {
        // The time since the scan before belongs to the speed of that scan.
        output.pass(execution, &mut motion, None)?;
        motion.direction = hertz.signum();
        motion.jump_to_speed(hertz.abs());
        output.show(execution, &motion)?;
    }
    motion.note(execution);
    Ok(())
}

pub(super) fn by_increment(execution: &mut dyn Execution) -> Result<(), Fault> {
    drive(execution, |execution, _| execution.value(0))
}

pub(super) fn to_position(execution: &mut dyn Execution) -> Result<(), Fault> {
    drive(execution, |execution, output| {
        let target = execution.value(0)?;
        Ok(target - output.position(execution))
    })
}

/// Moves by as many pulses as `way` gives when the movement begins.
fn drive(
    execution: &mut dyn Execution,
    way: fn(&mut dyn Execution, PulseOutput) -> Result<i64, Fault>,
) -> Result<(), Fault> {
    if !execution.power() && execution.noted(0) == state::IDLE {
        return Ok(());
    }
    let output = PulseOutput::of_drive(execution, 2)?;
    let mut motion = Motion::noted(execution);
    if !execution.power() {
        return brake(execution, output, motion);
    }
    if motion.state == state::IDLE {
        let hertz = execution.value(1)?;
        if !(1..=MOST_HERTZ).contains(&hertz) {
            return Err(Fault::Value(1));
        }
        let way = way(execution, output)?;
        execution.set_bit(3, 0, way >= 0)?;
        motion = Motion::begin(Some(way.abs()), hertz, way.signum(), output.lowest(execution));
        output.show(execution, &motion)?;
    } else {
        let ramp = output.ramp(execution);
        output.pass(execution, &mut motion, Some(ramp))?;
    }
    motion.note(execution);
    Ok(())
}
