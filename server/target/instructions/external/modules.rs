//! FROM and TO: the buffer memories of special modules.

use crate::target::{Execution, Fault};

/// The module, the first number in its memory, and how many numbers are moved.
fn block(execution: &mut dyn Execution) -> Result<(u8, i64, i64), Fault> {
    let module = execution.value(0)?;
    let first = execution.value(1)?;
    let count = execution.value(3)?;
    if !(0..8).contains(&module) {
        return Err(Fault::Value(0));
    }
    let words = if execution.is_wide() { 2 } else { 1 };
    if !(0..=32_767).contains(&first) {
        return Err(Fault::Value(1));
    }
    if !(1..=32_767).contains(&count) || first + count * words > 32_768 {
        return Err(Fault::Value(3));
    }
    Ok((module as u8, first, count))
}

pub(super) fn read(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (module, first, count) = block(execution)?;
    let is_wide = execution.is_wide();
    // The last number first: if there is a place for it, there is one for all of them.
    for number in (0..count).rev() {
        let outside = execution.outside();
        let word = |at: i64| outside.buffer(module, at as u16).ok_or(Fault::NoModule);
        let value = match is_wide {
            true => {
                let (lower, upper) = (word(first + 2 * number)?, word(first + 2 * number + 1)?);
                i64::from(i32::from(upper) << 16 | i32::from(lower as u16))
            }
            false => i64::from(word(first + number)?),
        };
        execution.put_at(2, number, value)?;
    }
    Ok(())
}

pub(super) fn write(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (module, first, count) = block(execution)?;
    let is_wide = execution.is_wide();
    execution.value_at(2, count - 1)?;
    for number in 0..count {
        let value = execution.value_at(2, number)?;
        let outside = execution.outside();
        let is_taken = match is_wide {
            true => {
                outside.set_buffer(module, (first + 2 * number) as u16, value as i16)
                    && outside.set_buffer(module, (first + 2 * number + 1) as u16, (value >> 16) as i16)
            }
            false => outside.set_buffer(module, (first + number) as u16, value as i16),
        };
        if !is_taken {
            return Err(Fault::NoModule);
        }
    }
    Ok(())
}
