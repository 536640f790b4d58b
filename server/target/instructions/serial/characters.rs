//! RS, PRUN, ASCI, HEX, CCD, VRRD, VRSC: bytes, characters and trimmers.

use crate::target::{DeviceKind, Execution, Fault};

/// On while each word carries one byte.
const ONE_BYTE: u32 = 8161;
/// Asks RS to send, and tells that it has received.
const SEND: u32 = 8122;
/// See [`SEND`].
const RECEIVED: u32 = 8123;

/// The bytes in words behind an operand: two in each, the lower half first, or one.
fn bytes(execution: &mut dyn Execution, place: usize, count: i64) -> Result<Vec<u8>, Fault> {
    let in_word = if execution.relay(ONE_BYTE) { 1 } else { 2 };
    let byte = |number: i64| {
        execution.word(place, number / in_word).map(|word| (word >> (8 * (number % in_word))) as u8)
    };
    (0..count).map(byte).collect()
}

/// Writes bytes to words behind an operand. Half a word that gets no byte stays as it is.
fn set_bytes(execution: &mut dyn Execution, place: usize, bytes: &[u8]) -> Result<(), Fault> {
    if execution.relay(ONE_BYTE) {
        for (number, byte) in bytes.iter().enumerate().rev() {
            execution.set_word(place, number as i64, i64::from(*byte))?;
        }
        return Ok(());
    }
    for (number, pair) in bytes.chunks(2).enumerate().rev() {
        let number = number as i64;
        let upper = match pair.get(1) {
            Some(upper) => i64::from(*upper) << 8,
            None => execution.word(place, number)? & !0xFF,
        };
        execution.set_word(place, number, i64::from(pair[0]) | upper)?;
    }
    Ok(())
}

pub(super) fn communicate(execution: &mut dyn Execution) -> Result<(), Fault> {
    let to_send = execution.count(1, 0, 4_096)?;
    let most = execution.count(3, 0, 4_096)? as usize;
    if execution.relay(SEND) {
        let frame = bytes(execution, 0, to_send)?;
        execution.outside().serial.send(frame);
        execution.set_relay(SEND, false);
        execution.set_register(SEND, 0);
    }
    if execution.relay(RECEIVED) || most == 0 {
        return Ok(());
    }
    let Some(mut frame) = execution.outside().serial.waiting.front().cloned() else { return Ok(()) };
    frame.truncate(most);
    set_bytes(execution, 2, &frame)?;
    execution.outside().serial.waiting.pop_front();
    execution.set_register(RECEIVED, frame.len() as i64);
    execution.set_relay(RECEIVED, true);
    Ok(())
}

/// Where bit number `bit` of an operand lies behind its first one: inputs and outputs are counted in eights, others in
/// tens of which eight are used.
fn octal_place(execution: &mut dyn Execution, place: usize, bit: i64) -> Result<i64, Fault> {
    let is_octal =
        execution.device(place)?.is_some_and(|first| matches!(first.kind, DeviceKind::X | DeviceKind::Y));
    Ok(if is_octal { bit } else { bit / 8 * 10 + bit % 8 })
}

pub(super) fn copy_octal(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (Some(from), Some(to)) = (execution.group_bits(0), execution.group_bits(1)) else {
        return Err(Fault::NoDevice(0));
    };
    let count = i64::from(from.min(to).min(execution.width()));
    let mut bits = Vec::with_capacity(count as usize);
    for bit in 0..count {
        let at = octal_place(execution, 0, bit)?;
        bits.push(execution.bit(0, at)?);
    }
    for (bit, on) in bits.into_iter().enumerate().rev() {
        let at = octal_place(execution, 1, bit as i64)?;
        execution.set_bit(1, at, on)?;
    }
    Ok(())
}

pub(super) fn to_characters(execution: &mut dyn Execution) -> Result<(), Fault> {
    let count = execution.count(2, 1, 256)?;
    let mut codes = Vec::with_capacity(count as usize);
    for digit in (0..count).rev() {
        let digit = (execution.word(0, digit / 4)? >> (4 * (digit % 4)) & 15) as u8;
        codes.push(if digit < 10 { b'0' + digit } else { b'A' + digit - 10 });
    }
    set_bytes(execution, 1, &codes)
}

pub(super) fn from_characters(execution: &mut dyn Execution) -> Result<(), Fault> {
    let count = execution.count(2, 1, 256)?;
    let mut words = vec![0; (count as usize).div_ceil(4)];
    for (digit, code) in bytes(execution, 0, count)?.into_iter().rev().enumerate() {
        let value = match code {
            b'0'..=b'9' => code - b'0',
            b'A'..=b'F' => code - b'A' + 10,
            _ => return Err(Fault::Value(0)),
        };
        words[digit / 4] |= i64::from(value) << (4 * (digit % 4));
    }
    for (place, word) in words.into_iter().enumerate().rev() {
        execution.set_word(1, place as i64, word)?;
    }
    Ok(())
}

pub(super) fn check_code(execution: &mut dyn Execution) -> Result<(), Fault> {
    let count = execution.count(2, 1, 256)?;
    let bytes = bytes(execution, 0, count)?;
    let sum = bytes.iter().map(|byte| i64::from(*byte)).sum();
    let parity = bytes.iter().fold(0, |parity, byte| parity ^ i64::from(*byte));
    execution.set_word(1, 1, parity)?;
    execution.set_word(1, 0, sum)
}

fn trimmer(execution: &mut dyn Execution) -> Result<i64, Fault> {
    let number = execution.count(0, 0, 7)?;
    Ok(i64::from(execution.outside().trimmers[number as usize]))
}

pub(super) fn read_trimmer(execution: &mut dyn Execution) -> Result<(), Fault> {
    let position = trimmer(execution)?;
    execution.set_word(1, 0, position)
}

pub(super) fn read_switch(execution: &mut dyn Execution) -> Result<(), Fault> {
    let position = trimmer(execution)?;
    execution.set_word(1, 0, (position * 10 + 127) / 255)
}
