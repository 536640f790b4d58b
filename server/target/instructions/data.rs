//! Working on data: FNC 40 to 49.

use super::specs::{FX2N_UP, applied, bits_out, count, destination, operand, source};
use crate::target::semantics::{BORROW, ZERO};
use crate::target::{Accepts, Access, Device, DeviceKind, Drive, Execution, Extent, Fault, Instruction};
use std::ops::RangeInclusive;

/// What can be reset as a range.
const RESETTABLE: Accepts =
    Accepts::Y.or(Accepts::M).or(Accepts::S).or(Accepts::T).or(Accepts::C).or(Accepts::D).or(Accepts::R);

/// The word devices T C D R V Z, without groups of bits.
const REGISTERS: Accepts =
    Accepts::T.or(Accepts::C).or(Accepts::D).or(Accepts::R).or(Accepts::V).or(Accepts::Z);

/// Single relays.
const RELAYS: Accepts = Accepts::X.or(Accepts::Y).or(Accepts::M).or(Accepts::S);

/// ZRST DECO ENCO SUM BON MEAN ANS ANR SQR FLT.
pub const ROWS: &[Instruction] = &[
    applied(
        40,
        "ZRST",
        "reset a range",
        &[
            operand("D1", "first device", Access::Write, RESETTABLE)
                .reaching(Extent::Through(1))
                .driven(Drive::Reset),
            operand("D2", "last device", Access::Write, RESETTABLE).driven(Drive::Reset),
        ],
        "Resets all devices from D1 to D2: relays and states go off, registers become 0, timers and \
         counters lose value and contact. If D1 is above D2, only D1 is reset. Both must be of the \
         same kind, and 32-bit counters cannot be mixed with the others: else it is an execution \
         error.\n\n\
         ```il\n\
         LD M8002\n\
         ZRST M0 M99\n\
         ZRST D0 D9\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(reset_range),
    applied(
        41,
        "DECO",
        "decode",
        &[
            source("S", "number").accepting(RELAYS.or(REGISTERS).or(Accepts::K)),
            operand("D", "first device of the row", Access::Write, RESETTABLE).reaching(Extent::Onwards),
            count("n", "number of bits that are read", (1, 8)),
        ],
        "Switches on one of 2 to the power of n bits: the one whose place, counted from 0, is the \
         number in the lowest n bits of S, or in n relays from S on; all others go off. With a relay \
         as destination, n of 8 takes 256 relays, so keep the row free; with a word as destination n \
         is at most 4. When the result goes off, the last state stays.\n\n\
         ```il\n\
         LD X0\n\
         DECO D0 M0 K3\n\
         LD M5\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(decode),
    applied(
        42,
        "ENCO",
        "encode",
        &[
            source("S", "first device of the row").accepting(RELAYS.or(REGISTERS)).reaching(Extent::Onwards),
            destination("D", "place of the highest bit that is on").accepting(REGISTERS),
            count("n", "number of bits that are written", (1, 8)),
        ],
        "Writes to D the place, counted from 0, of the highest bit that is on among 2 to the power of \
         n bits from S on. If none is on, it is an execution error and D keeps its value. With a word \
         as source, n is at most 4.\n\n\
         ```il\n\
         LD X0\n\
         ENCO M0 D0 K3\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(encode),
    applied(
        43,
        "SUM",
        "count bits that are on",
        &[source("S", "word"), destination("D", "number of bits that are on")],
        "Counts how many bits of a word are on, for instance how many of sixteen sensors see \
         something. If none is on, the zero flag M8020 goes on.\n\n\
         ```il\n\
         LD X0\n\
         SUM K4X0 D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(count_bits),
    applied(
        44,
        "BON",
        "test a bit",
        &[
            source("S", "word"),
            bits_out("D", "relay for the answer"),
            count("n", "bit, 0 is the lowest", (0, 15)).within_wide(0, 31).or_register(),
        ],
        "Copies one bit of a word to a relay. Bit 15 is the sign, so BON tells whether a number is \
         negative. When the result goes off, the relay keeps its state. A bit that the word does not \
         have is an execution error.\n\n\
         ```il\n\
         LD M8000\n\
         BON D0 M0 K15\n\
         LD M0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(test_bit),
    applied(
        45,
        "MEAN",
        "mean value",
        &[
            source("S", "first value")
                .accepting(Accepts::WORD_SOURCE.without(Accepts::K.or(Accepts::V).or(Accepts::Z)))
                .counted_by(2),
            destination("D", "mean value"),
            count("n", "number of values", (1, 64)).or_register(),
        ],
        "Writes the mean of n words from S on to D; the fraction is dropped, also of a negative mean. \
         A number of values below 1 or above 64 is an execution error. Together with a shift of words \
         it smooths the values of an analog input.\n\n\
         ```il\n\
         LD M8013\n\
         MEAN D10 D0 K8\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(mean),
    applied(
        46,
        "ANS",
        "set an annunciator",
        &[
            operand("S", "timer", Access::Write, Accepts::T),
            source("m", "time in 100 ms")
                .accepting(Accepts::K.or(Accepts::D).or(Accepts::R))
                .within(1, 32767),
            operand("D", "annunciator", Access::Write, Accepts::S),
        ],
        "Switches an annunciator, one of the states S900 to S999, on when the result has been on for m \
         times 100 ms, and leaves it on. The timer is one of T0 to T199 and goes back when the result \
         goes off. While M8049 is on, M8048 shows that an annunciator is on and D8049 has the lowest \
         one. ANR switches them off again.\n\n\
         ```il\n\
         LD M8000\n\
         OUT M8049\n\
         LD Y0\n\
         ANI X0\n\
         ANS T0 K10 S900\n\
         LD X1\n\
         OUT Y0\n\
         LD X2\n\
         ANRP\n\
         LD M8048\n\
         OUT Y1\n\
         END\n\
         ```\n",
    )
    .on(FX2N_UP)
    .always(set_annunciator),
    applied(
        47,
        "ANR",
        "reset an annunciator",
        &[],
        "Switches off the annunciator that is on and has the lowest number; each execution takes the \
         next one, so use ANRP with a button. It takes no operands.\n\n\
         ```il\n\
         LD Y0\n\
         ANI X0\n\
         ANS T0 K10 S900\n\
         LD X1\n\
         OUT Y0\n\
         LD X2\n\
         ANRP\n\
         LD S900\n\
         OUT Y1\n\
         END\n\
         ```\n",
    )
    .pulse()
    .on(FX2N_UP)
    .doing(reset_annunciator),
    applied(
        48,
        "SQR",
        "square root",
        &[
            source("S", "value")
                .accepting(Accepts::K.or(Accepts::D).or(Accepts::R))
                .within(0, 32767)
                .within_wide(0, 2147483647),
            destination("D", "root").accepting(Accepts::D.or(Accepts::R)),
        ],
        "Writes the square root of a whole number, with the fraction dropped; M8021 goes on if \
         something was dropped, M8020 if the root is 0. A negative number is an execution error.\n\n\
         ```il\n\
         LD X0\n\
         SQR D0 D1\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(square_root),
    applied(
        49,
        "FLT",
        "convert to a real number",
        &[
            source("S", "whole number").accepting(Accepts::D.or(Accepts::R)),
            destination("D", "first of two words for the real number")
                .accepting(Accepts::D.or(Accepts::R))
                .covering(2),
        ],
        "Converts a whole number to a real number of 32 bits, which takes two registers also in the \
         16-bit form. Constants need no conversion: real arithmetic such as DEADD converts them \
         itself. The way back is INT. A real number carries 24 bits: larger numbers are rounded to the \
         nearest one.\n\n\
         ```il\n\
         LD X0\n\
         FLT D0 D2\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(to_real),
];

/// The states that ANR switches off.
const ANNUNCIATORS: RangeInclusive<u32> = 900..=999;

/// The unit of the timers that ANS takes.
const UNIT_NS: i64 = 100_000_000;

/// Whether an operand is a row of relays; else it is one word.
fn is_row_of_relays(execution: &mut dyn Execution, place: usize) -> Result<bool, Fault> {
    Ok(execution.device(place)?.is_some_and(|device| device.kind.is_bit() && !device.kind.has_preset()))
}

fn reset_range(execution: &mut dyn Execution) -> Result<(), Fault> {
    let first = execution.device(0)?.ok_or(Fault::NoDevice(0))?;
    let last = execution.device(1)?.ok_or(Fault::NoDevice(1))?;
    let is_wide_counter = |device: Device| device.kind == DeviceKind::C && device.number >= 200;
    if first.kind != last.kind || is_wide_counter(first) != is_wide_counter(last) {
        return Err(Fault::Value(1));
    }
    // Devices of one kind have no gap but the one before the special ones, over which no offset reaches.
    let reach = i64::from(last.number.max(first.number) - first.number);
    for offset in [0, reach] {
        match first.kind.is_bit() {
            true => execution.bit(0, offset).map(|_| ())?,
            false => execution.word(0, offset).map(|_| ())?,
        }
    }
    (first.number..=last.number.max(first.number))
        .try_for_each(|number| execution.clear(Device::new(first.kind, number)))
}

fn decode(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (is_row, from_row) = (is_row_of_relays(execution, 1)?, is_row_of_relays(execution, 0)?);
    let digits = execution.count(2, 1, if is_row { 8 } else { 4 })?;
    let number = match from_row {
        true => (0..).zip(execution.relays(0, digits)?).map(|(place, bit)| i64::from(bit) << place).sum(),
        false => execution.word(0, 0)? & ((1 << digits) - 1),
    };
    match is_row {
        true => {
            let row: Vec<bool> = (0..1 << digits).map(|place| place == number).collect();
            execution.set_relays(1, &row)
        }
        false => execution.set_word(1, 0, 1 << number),
    }
}

fn encode(execution: &mut dyn Execution) -> Result<(), Fault> {
    let is_row = is_row_of_relays(execution, 0)?;
    let digits = execution.count(2, 1, if is_row { 8 } else { 4 })?;
    let length = 1 << digits;
    let highest = match is_row {
        true => execution.relays(0, length)?.iter().rposition(|bit| *bit).map(|place| place as i64),
        false => {
            let word = execution.word(0, 0)?;
            (0..length).rev().find(|place| word >> place & 1 == 1)
        }
    };
    execution.set_word(1, 0, highest.ok_or(Fault::Value(0))?)
}

fn count_bits(execution: &mut dyn Execution) -> Result<(), Fault> {
    let mask = (1 << execution.width()) - 1;
    let count = (execution.value(0)? & mask).count_ones();
    execution.put(1, i64::from(count))?;
    execution.set_relay(ZERO, count == 0);
    Ok(())
}

fn test_bit(execution: &mut dyn Execution) -> Result<(), Fault> {
    let place = execution.count(2, 0, i64::from(execution.width()) - 1)?;
    let is_on = execution.value(0)? >> place & 1 == 1;
    execution.set_bit(1, 0, is_on)
}

fn mean(execution: &mut dyn Execution) -> Result<(), Fault> {
    let count = execution.count(2, 1, 64)?;
    let sum: i64 = execution.values(0, count)?.iter().sum();
    execution.put(1, sum / count)
}

/// Notes the time with power in nanoseconds.
fn set_annunciator(execution: &mut dyn Execution) -> Result<(), Fault> {
    let limit = execution.word(1, 0)?;
    execution.bit(2, 0)?;
    if !execution.power() {
        if execution.noted(1) == 1 {
            execution.note(1, 0);
            execution.set_word(0, 0, 0)?;
            execution.set_bit(0, 0, false)?;
        }
        return Ok(());
    }
    let passed = execution.noted(0).saturating_add(execution.scan_ns());
    let passed = if execution.is_rising() { 0 } else { passed };
    execution.note(0, passed);
    execution.note(1, 1);
    let units = (passed / UNIT_NS).min(limit.max(1));
    execution.set_word(0, 0, units)?;
    if units >= limit.max(1) {
        execution.set_bit(0, 0, true)?;
        execution.set_bit(2, 0, true)?;
    }
    Ok(())
}

fn reset_annunciator(execution: &mut dyn Execution) -> Result<(), Fault> {
    let mut annunciators = ANNUNCIATORS.map(|number| Device::new(DeviceKind::S, number));
    match annunciators.find(|annunciator| execution.is_on(*annunciator)) {
        Some(lowest) => execution.clear(lowest),
        None => Ok(()),
    }
}

fn square_root(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = u64::try_from(execution.value(0)?).map_err(|_| Fault::Value(0))?;
    let root = value.isqrt();
    execution.put(1, root as i64)?;
    execution.set_relay(ZERO, root == 0);
    execution.set_relay(BORROW, root * root != value);
    Ok(())
}

fn to_real(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)?;
    execution.set_real(1, 0, value as f64)
}
