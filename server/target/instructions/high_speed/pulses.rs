//! PLSY, PWM, PLSR: pulses from an output.

use crate::target::instructions::motion::{MOST_HERTZ, Motion, PulseOutput, Ramp, state};
use crate::target::{Execution, Fault};

pub(super) fn pulses(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() && execution.noted(0) == state::IDLE {
        return Ok(());
    }
    let output = PulseOutput::at(execution, 2)?;
    if !execution.power() {
        return output.leave(execution);
    }
    let (hertz, pulses) = (execution.value(0)?, execution.value(1)?);
    if hertz < 0 {
        return Err(Fault::Value(0));
    }
    if pulses < 0 {
        return Err(Fault::Value(1));
    }
    let mut motion = Motion::noted(execution);
    if motion.state == state::IDLE {
        motion = Motion::begin((pulses > 0).then_some(pulses), hertz, 1, hertz);
        output.show(execution, &motion)?;
    } else {
        // The time since the scan before belongs to the speed of that scan.
        output.pass(execution, &mut motion, None)?;
        motion.jump_to_speed(hertz);
        output.show(execution, &motion)?;
    }
    motion.note(execution);
    Ok(())
}

pub(super) fn ramped_pulses(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() && execution.noted(0) == state::IDLE {
        return Ok(());
    }
    let output = PulseOutput::at(execution, 3)?;
    if !execution.power() {
        return output.leave(execution);
    }
    let mut motion = Motion::noted(execution);
    if motion.state == state::IDLE {
        let (hertz, pulses, ramp_ms) = (execution.value(0)?, execution.value(1)?, execution.value(2)?);
        if !(1..=MOST_HERTZ).contains(&hertz) {
            return Err(Fault::Value(0));
        }
        if pulses < 0 {
            return Err(Fault::Value(1));
        }
        if !(0..=5_000).contains(&ramp_ms) {
            return Err(Fault::Value(2));
        }
        motion = Motion::begin(Some(pulses), hertz, 1, 0);
        motion.kept = (hertz * 1_000 / ramp_ms.max(1)).max(1);
        output.show(execution, &motion)?;
    } else {
        let ramp = Ramp { up: motion.kept, down: motion.kept };
        output.pass(execution, &mut motion, Some(ramp))?;
    }
    motion.note(execution);
    Ok(())
}

pub(super) fn pulse_width(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        return if execution.is_left() { execution.set_bit(2, 0, false) } else { Ok(()) };
    }
    PulseOutput::at(execution, 2)?;
    let (width, period) = (execution.word(0, 0)?, execution.word(1, 0)?);
    if period < 1 {
        return Err(Fault::Value(1));
    }
    if !(0..=period).contains(&width) {
        return Err(Fault::Value(0));
    }
    let passed = if execution.noted(0) == 0 { 0 } else { execution.noted(1) + execution.scan_ns() };
    let passed = passed % (period * 1_000_000);
    execution.note(0, 1);
    execution.note(1, passed);
    execution.set_bit(2, 0, passed < width * 1_000_000)
}
