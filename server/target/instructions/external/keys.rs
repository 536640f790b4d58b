//! TKY, HKY, DSW, ARWS: numbers from keys and switches.

use super::displays::signals;
use crate::target::semantics::COMPLETE;
use crate::target::{Execution, Fault};

/// Four digits, or eight in the 32-bit form.
fn places(execution: &dyn Execution) -> i64 {
    if execution.is_wide() { 100_000_000 } else { 10_000 }
}

/// Shifts a digit into a number from the right.
fn shift_in(execution: &mut dyn Execution, place: usize, digit: i64) -> Result<(), Fault> {
    let places = places(execution);
    let number = execution.value(place)?;
    execution.put(place, (number * 10 + digit).rem_euclid(places))
}

pub(super) fn ten_keys(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        return if execution.is_left() { execution.set_bits(2, 0, 11, 0) } else { Ok(()) };
    }
    let keys = execution.bits(0, 0, 10)?;
    // The key that is held, from 1, and all those of the scan before.
    let (held, before) = (execution.noted(1), execution.noted(2));
    let is_held = held > 0 && keys >> (held - 1) & 1 == 1;
    let pressed = keys & !before;
    let fresh = if is_held || pressed == 0 { None } else { Some(i64::from(pressed.trailing_zeros())) };
    let held = match fresh {
        Some(digit) => digit + 1,
        None if is_held => held,
        None => 0,
    };
    let flags = if held > 0 { 1 << (held - 1) | 1 << 10 } else { 0 };
    execution.set_bits(2, 0, 11, flags)?;
    if let Some(digit) = fresh {
        shift_in(execution, 1, digit)?;
    }
    execution.note(0, 1);
    execution.note(1, held);
    execution.note(2, keys);
    Ok(())
}

/// Switches the row outputs, and complete off, when power has left.
fn leave(execution: &mut dyn Execution, rows: usize) -> Result<bool, Fault> {
    let is_left = execution.is_left();
    if is_left {
        execution.set_bits(rows, 0, 4, 0)?;
        execution.set_relay(COMPLETE, false);
    }
    Ok(is_left)
}

/// The step of a round of four rows, two scans each: a row is switched on, and in the next scan it is read. Notes 1
/// and up in the first cell.
fn round(execution: &mut dyn Execution, rows: usize) -> Result<Option<i64>, Fault> {
    let step = execution.noted(0).max(1) - 1;
    let row = step / 2;
    if step % 2 == 0 {
        execution.set_bits(rows, 0, 4, 1 << row)?;
    }
    execution.note(0, (step + 1) % 8 + 1);
    execution.set_relay(COMPLETE, step == 7);
    Ok((step % 2 == 1).then_some(row))
}

pub(super) fn sixteen_keys(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        return if leave(execution, 1)? { execution.set_bits(3, 0, 8, 0) } else { Ok(()) };
    }
    // The keys of the round so far, and of the round before.
    let Some(row) = round(execution, 1)? else { return Ok(()) };
    let keys = execution.noted(1) | execution.bits(0, 0, 4)? << (4 * row);
    execution.note(1, if row == 3 { 0 } else { keys });
    if row < 3 {
        return Ok(());
    }
    let pressed = keys & !execution.noted(2);
    execution.note(2, keys);
    let is_hexadecimal = execution.relay(8167);
    let digits = if is_hexadecimal { 0xFFFF } else { 0x03FF };
    let mut flags = execution.bits(3, 0, 6)?;
    if pressed != 0 {
        let key = i64::from(pressed.trailing_zeros());
        match key {
            _ if is_hexadecimal => {
                let number = execution.value(2)?;
                execution.put(2, number << 4 | key)?;
            }
            0..=9 => shift_in(execution, 2, key)?,
            _ => flags = 1 << (key - 10),
        }
    }
    let (is_digit, is_function) = (keys & digits != 0, keys & !digits != 0);
    let flags = flags | i64::from(is_function) << 6 | i64::from(is_digit) << 7;
    execution.set_bits(3, 0, 8, flags)
}

pub(super) fn digital_switches(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        return leave(execution, 1).map(|_| ());
    }
    let sets = execution.count(3, 1, 2)?;
    let Some(row) = round(execution, 1)? else { return Ok(()) };
    for set in 0..sets {
        let cell = 1 + set as usize;
        let digits = if row == 0 { 0 } else { execution.noted(cell) };
        let digits = digits | execution.bits(0, 4 * set, 4)? << (4 * row);
        execution.note(cell, digits);
    }
    if row < 3 {
        return Ok(());
    }
    let mut numbers = [0; 2];
    for (set, number) in numbers.iter_mut().enumerate().take(sets as usize) {
        let digit = |place: i64| execution.noted(1 + set) >> (4 * place) & 15;
        if (0..4).any(|place| digit(place) > 9) {
            return Err(Fault::Value(0));
        }
        *number = (0..4).rev().fold(0, |number, place| number * 10 + digit(place));
    }
    for set in (0..sets as usize).rev() {
        execution.set_word(2, set as i64, numbers[set])?;
    }
    Ok(())
}

/// Places of the keys of ARWS.
const DOWN: i64 = 1;
const UP: i64 = 2;
const RIGHT: i64 = 4;
const LEFT: i64 = 8;

pub(super) fn arrow_switch(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        return if execution.is_left() { execution.set_bits(2, 0, 8, 0) } else { Ok(()) };
    }
    let number = execution.word(1, 0)?;
    if !(0..=9_999).contains(&number) {
        return Err(Fault::Value(1));
    }
    let logic = execution.count(3, 0, 3)?;
    let is_first = execution.noted(0) == 0;
    let keys = execution.bits(0, 0, 4)?;
    let pressed = if is_first { 0 } else { keys & !execution.noted(2) };
    let mut digit = if is_first { 3 } else { execution.noted(1) };
    match pressed {
        RIGHT => digit = (digit + 3) % 4,
        LEFT => digit = (digit + 1) % 4,
        _ => {}
    }
    let weight = 10_i64.pow(digit as u32);
    let old = number / weight % 10;
    let new = match pressed {
        UP => (old + 1) % 10,
        DOWN => (old + 9) % 10,
        _ => old,
    };
    execution.set_bits(2, 0, 8, signals(logic, new, 1 << digit))?;
    execution.set_word(1, 0, number + (new - old) * weight)?;
    execution.note(0, 1);
    execution.note(1, digit);
    execution.note(2, keys);
    Ok(())
}
