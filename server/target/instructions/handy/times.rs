//! TTMR, STMR, RAMP: timers of another kind, and values that change with the scans.

use crate::target::semantics::COMPLETE;
use crate::target::{DeviceKind, Execution, Fault};

/// Nanoseconds in a tenth of a second.
const TENTH: i64 = 100_000_000;

pub(super) fn teach(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        return if execution.is_left() { execution.set_word(0, 1, 0) } else { Ok(()) };
    }
    let unit = match execution.count(1, 0, 2)? {
        0 => 10 * TENTH,
        1 => TENTH,
        _ => TENTH / 10,
    };
    let held = if execution.noted(0) == 0 { 0 } else { execution.noted(1) + execution.scan_ns() };
    let most = i64::from(i16::MAX);
    execution.set_word(0, 1, (held / TENTH).min(most))?;
    execution.set_word(0, 0, (held / unit).min(most))?;
    execution.note(0, 1);
    execution.note(1, held);
    Ok(())
}

/// What STMR notes in its first cell.
mod phase {
    pub(super) const IDLE: i64 = 0;
    pub(super) const DRIVEN: i64 = 1;
    pub(super) const RELEASED: i64 = 2;
}

pub(super) fn special_timer(execution: &mut dyn Execution) -> Result<(), Fault> {
    let before = execution.noted(0);
    if !execution.power() && before == phase::IDLE {
        return Ok(());
    }
    let preset = execution.count(1, 1, 32_767)?;
    if !execution.device(0)?.is_some_and(|timer| timer.kind == DeviceKind::T && timer.number < 200) {
        return Err(Fault::NoDevice(0));
    }
    let phase = if execution.power() { phase::DRIVEN } else { phase::RELEASED };
    let passed = if phase == before { execution.noted(1) + execution.scan_ns() } else { 0 };
    let is_over = passed >= preset * TENTH;
    let was_delayed = execution.bit(2, 3)?;
    let outputs = match (phase, is_over) {
        (phase::DRIVEN, _) => [true, false, !is_over, is_over],
        (_, false) => [true, true, false, was_delayed],
        (_, true) => [false; 4],
    };
    let is_idle = phase == phase::RELEASED && is_over;
    let pattern = (0..).zip(outputs).map(|(bit, on)| i64::from(on) << bit).sum();
    execution.set_bits(2, 0, 4, pattern)?;
    execution.set_word(0, 0, if is_idle { 0 } else { (passed / TENTH).min(preset) })?;
    execution.set_bit(0, 0, is_over && !is_idle)?;
    execution.note(0, if is_idle { phase::IDLE } else { phase });
    execution.note(1, passed);
    Ok(())
}

pub(super) fn ramp(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        if execution.is_left() {
            execution.set_relay(COMPLETE, false);
        }
        return Ok(());
    }
    let scans = execution.count(3, 1, 32_767)?;
    let (from, to) = (execution.word(0, 0)?, execution.word(1, 0)?);
    // The first cell has the scans done, and one more.
    let done = match execution.noted(0) {
        over if over > scans && !execution.relay(8026) => 0,
        next => next.min(scans),
    };
    execution.set_word(2, 1, done)?;
    execution.set_word(2, 0, from + (to - from) * done / scans)?;
    execution.note(0, done + 1);
    execution.set_relay(COMPLETE, done == scans);
    Ok(())
}
