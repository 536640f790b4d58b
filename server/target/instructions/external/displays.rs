//! SEGD, SEGL, ASC, PR: numbers and texts for people.

use crate::target::semantics::COMPLETE;
use crate::target::{Execution, Fault};

/// Segments a to g, from bit 0 on, of the digits 0 to F. The 7 has segment f as well. Source: the manuals' table.
const SEGMENTS: [i64; 16] =
    [0x3F, 0x06, 0x5B, 0x4F, 0x66, 0x6D, 0x7D, 0x27, 0x7F, 0x6F, 0x77, 0x7C, 0x39, 0x5E, 0x79, 0x71];

pub(super) fn seven_segments(execution: &mut dyn Execution) -> Result<(), Fault> {
    let digit = execution.word(0, 0)? & 15;
    let old = execution.word(1, 0)?;
    execution.set_word(1, 0, old & !0xFF | SEGMENTS[digit as usize])
}

/// Four data outputs and four strobes behind them, of which `logic` turns the former round by 2, the latter by 1.
pub(super) fn signals(logic: i64, data: i64, strobes: i64) -> i64 {
    let data = if logic & 2 == 0 { data } else { !data };
    let strobes = if logic & 1 == 0 { strobes } else { !strobes };
    data & 15 | (strobes & 15) << 4
}

pub(super) fn latched_display(execution: &mut dyn Execution) -> Result<(), Fault> {
    let variant = execution.count(2, 0, 7)?;
    let (sets, logic) = (if variant < 4 { 1 } else { 2 }, variant % 4);
    if !execution.power() {
        if execution.is_left() {
            execution.set_relay(COMPLETE, false);
            execution.set_bits(1, 0, if sets == 1 { 8 } else { 12 }, 0)?;
        }
        return Ok(());
    }
    // Three scans for each digit: its data, its strobe, its data alone again.
    let step = execution.noted(0).max(1) - 1;
    let digit = step / 3;
    let mut data = [0; 2];
    for (set, shown) in data.iter_mut().enumerate().take(sets) {
        let cell = 1 + set;
        if step == 0 {
            let number = execution.word(0, set as i64)?;
            if !(0..=9_999).contains(&number) {
                return Err(Fault::Value(0));
            }
            execution.note(cell, number);
        }
        *shown = execution.noted(cell) / 10_i64.pow(digit as u32) % 10;
    }
    let strobes = if step % 3 == 1 { 1 << digit } else { 0 };
    if sets == 2 {
        let second = if logic & 2 == 0 { data[1] } else { !data[1] };
        execution.set_bits(1, 8, 4, second)?;
    }
    execution.set_bits(1, 0, 8, signals(logic, data[0], strobes))?;
    execution.note(0, (step + 1) % 12 + 1);
    execution.set_relay(COMPLETE, step == 11);
    Ok(())
}

pub(super) fn characters(execution: &mut dyn Execution) -> Result<(), Fault> {
    let mut codes = [b' '; 8];
    for (code, byte) in codes.iter_mut().zip(execution.text(0).bytes()) {
        *code = byte;
    }
    let words: Vec<i64> = match execution.relay(8161) {
        true => codes.iter().map(|code| i64::from(*code)).collect(),
        false => codes.chunks(2).map(|pair| i64::from(pair[0]) | i64::from(pair[1]) << 8).collect(),
    };
    for (place, word) in words.into_iter().enumerate().rev() {
        execution.set_word(1, place as i64, word)?;
    }
    Ok(())
}

/// Places of the outputs of PR behind the eight of data.
const STROBE: i64 = 8;
const BUSY: i64 = 9;

pub(super) fn print(execution: &mut dyn Execution) -> Result<(), Fault> {
    if !execution.power() {
        if execution.is_left() {
            execution.set_relay(COMPLETE, false);
            execution.set_bits(1, 0, 10, 0)?;
        }
        return Ok(());
    }
    // Three scans for each character: its data, its strobe, its data alone again.
    let step = execution.noted(0).max(1) - 1;
    let number = step / 3;
    let most = if execution.relay(8027) { 16 } else { 8 };
    let code = match number < most {
        true => execution.word(0, number / 2)? >> (8 * (number % 2)) & 0xFF,
        false => 0,
    };
    let is_over = number >= most || most == 16 && code == 0;
    let pattern = if is_over { 0 } else { code | i64::from(step % 3 == 1) << STROBE | 1 << BUSY };
    execution.set_bits(1, 0, 10, pattern)?;
    execution.note(0, if is_over { step + 1 } else { step + 2 });
    execution.set_relay(COMPLETE, is_over);
    Ok(())
}
