//! REF, REFF, MTR, SPD: inputs in the middle of a scan, in a matrix, and faster than a scan.

use crate::target::semantics::COMPLETE;
use crate::target::{Device, DeviceKind, Execution, Fault};

pub(super) fn refresh(execution: &mut dyn Execution) -> Result<(), Fault> {
    let count = execution.count(1, 8, 256)?;
    if count % 8 != 0 {
        return Err(Fault::Value(1));
    }
    match execution.device(0)? {
        Some(first) if first.number % 8 == 0 => execution.refresh(first, count),
        _ => Err(Fault::Value(0)),
    }
}

pub(super) fn refresh_filtered(execution: &mut dyn Execution) -> Result<(), Fault> {
    execution.count(0, 0, 60)?;
    execution.refresh(Device::new(DeviceKind::X, 0), 16)
}

pub(super) fn matrix(execution: &mut dyn Execution) -> Result<(), Fault> {
    let rows = execution.count(3, 2, 8)?;
    if !execution.power() {
        if execution.is_left() {
            execution.set_bits(1, 0, rows, 0)?;
            execution.set_relay(COMPLETE, false);
        }
        return Ok(());
    }
    // A row is switched on, and in the next scan it is read.
    let step = (execution.noted(0).max(1) - 1) % (2 * rows);
    let row = step / 2;
    if step % 2 == 0 {
        execution.set_bits(1, 0, rows, 1 << row)?;
    } else {
        // Numbers of outputs are octal, so that the next ten of them are eight on.
        let is_octal = execution.device(2)?.is_some_and(|first| first.kind == DeviceKind::Y);
        let contacts = execution.bits(0, 0, 8)?;
        execution.set_bits(2, row * if is_octal { 8 } else { 10 }, 8, contacts)?;
    }
    execution.note(0, (step + 1) % (2 * rows) + 1);
    execution.set_relay(COMPLETE, step == 2 * rows - 1);
    Ok(())
}

pub(super) fn speed(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        execution.is_left();
        return Ok(());
    }
    let input = match execution.device(0)? {
        Some(device) if device.kind == DeviceKind::X && device.number < 8 => device.number as usize,
        _ => return Err(Fault::Value(0)),
    };
    let window_ns = execution.value(1)? * 1_000_000;
    if window_ns < 1 {
        return Err(Fault::Value(1));
    }
    // Pulses before the first execution belong to no window.
    let is_first = execution.noted(0) == 0;
    let arrived = i64::from(execution.outside().arrived[input]);
    let (passed, counted) = match is_first {
        true => (0, 0),
        false => (execution.noted(1) + execution.scan_ns(), execution.noted(2) + arrived),
    };
    let is_over = passed >= window_ns;
    let (passed, running) = if is_over { (passed % window_ns, 0) } else { (passed, counted) };
    execution.put_at(2, 2, (window_ns - passed + 999_999) / 1_000_000)?;
    execution.put_at(2, 1, running)?;
    if is_over {
        execution.put_at(2, 0, counted)?;
    }
    execution.note(0, 1);
    execution.note(1, passed);
    execution.note(2, running);
    Ok(())
}
