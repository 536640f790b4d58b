//! Rotating and shifting: FNC 30 to 39.

use super::moves::same_digits;
use super::specs::{FX2N_UP, applied, bits, bits_out, changed, count, destination, source};
use crate::target::semantics::{CARRY, ZERO};
use crate::target::{Accepts, Execution, Fault, Instruction, OperandSpec};

const ROTATED: OperandSpec = changed("D", "word that is rotated");
const BY: OperandSpec = count("n", "number of bits", (1, 16)).within_wide(1, 32).or_register();

/// Words that stand in rows.
const ROW: Accepts = Accepts::WORD_DESTINATION.without(Accepts::V.or(Accepts::Z));

const BITS_IN: OperandSpec = bits("S", "first bit that is shifted in").counted_by(3);
const BITS_MOVED: OperandSpec =
    bits_out("D", "first bit of the row").except(Accepts::WORD_BIT).read_and_written().counted_by(2);
const WORDS_IN: OperandSpec =
    source("S", "first word that is shifted in").accepting(ROW.or(Accepts::KNX)).counted_by(3);
const WORDS_MOVED: OperandSpec =
    destination("D", "first word of the row").accepting(ROW).read_and_written().counted_by(2);

/// ROR ROL RCR RCL SFTR SFTL WSFR WSFL SFWR SFRD.
pub const ROWS: &[Instruction] = &[
    applied(
        30,
        "ROR",
        "rotate right",
        &[ROTATED, BY],
        "Rotates the bits of a word by n places to the right; what leaves at the lower end comes in at \
         the upper end, and the last bit to leave is also in the carry flag M8022. Use RORP, since the \
         plain form rotates in every scan. A group of bits must be a whole word, K4 or in the 32-bit \
         form K8. With n in a register, a value below 1 or above 16, with DROR 32, is an execution \
         error.\n\n\
         ```il\n\
         LD X0\n\
         RORP D0 K4\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(rotate_right),
    applied(
        31,
        "ROL",
        "rotate left",
        &[ROTATED, BY],
        "Rotates the bits of a word by n places to the left; what leaves at the upper end comes in at \
         the lower end, and the last bit to leave is also in the carry flag M8022. Use ROLP, since the \
         plain form rotates in every scan. A group of bits must be a whole word, K4 or in the 32-bit \
         form K8. With n in a register, a value below 1 or above 16, with DROL 32, is an execution \
         error.\n\n\
         ```il\n\
         LD X0\n\
         ROLP D0 K4\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(rotate_left),
    applied(
        32,
        "RCR",
        "rotate right with carry",
        &[ROTATED, BY],
        "Rotates the bits of a word together with the carry flag M8022 by n places to the right, as a \
         ring of 17 bits (33 in the 32-bit form): the carry flag comes in at the upper end and the \
         lowest bit goes to the carry flag. Set or reset M8022 before it to choose what comes in. A \
         group of bits must be a whole word, and n lies in the same limits as for ROR.\n\n\
         ```il\n\
         LD X0\n\
         RCRP D0 K1\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(rotate_right_with_carry),
    applied(
        33,
        "RCL",
        "rotate left with carry",
        &[ROTATED, BY],
        "Rotates the bits of a word together with the carry flag M8022 by n places to the left, as a \
         ring of 17 bits (33 in the 32-bit form): the carry flag comes in at the lower end and the \
         highest bit goes to the carry flag. Set or reset M8022 before it to choose what comes in. A \
         group of bits must be a whole word, and n lies in the same limits as for ROR.\n\n\
         ```il\n\
         LD X0\n\
         RCLP D0 K1\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(rotate_left_with_carry),
    applied(
        34,
        "SFTR",
        "shift bits right",
        &[
            BITS_IN,
            BITS_MOVED,
            count("n1", "length of the row", (1, 1024)),
            count("n2", "number of places", (1, 1024)).or_register(),
        ],
        "Shifts a row of n1 relays from D on by n2 places towards the lower numbers; n2 devices from S \
         on come in at the upper end, and what leaves at the lower end is lost. n2 must not be greater \
         than n1. What comes in is read before anything moves. Use SFTRP, since the plain form shifts \
         in every scan.\n\n\
         ```il\n\
         LD X0\n\
         SFTRP X1 M0 K16 K1\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(shift_bits_right),
    applied(
        35,
        "SFTL",
        "shift bits left",
        &[
            BITS_IN,
            BITS_MOVED,
            count("n1", "length of the row", (1, 1024)),
            count("n2", "number of places", (1, 1024)).or_register(),
        ],
        "Shifts a row of n1 relays from D on by n2 places towards the higher numbers; n2 devices from \
         S on come in at the lower end, and what leaves at the upper end is lost. n2 must not be \
         greater than n1. What comes in is read before anything moves. With a sensor at S and one \
         pulse for each piece it follows pieces along a conveyor; use SFTLP, since the plain form \
         shifts in every scan.\n\n\
         ```il\n\
         LD X0\n\
         SFTLP X1 M0 K8 K1\n\
         LD M7\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(shift_bits_left),
    applied(
        36,
        "WSFR",
        "shift words right",
        &[
            WORDS_IN,
            WORDS_MOVED,
            count("n1", "length of the row", (1, 512)),
            count("n2", "number of places", (1, 512)).or_register(),
        ],
        "Shifts a row of n1 words from D on by n2 places towards the lower numbers; n2 words from S on \
         come in at the upper end. n2 must not be greater than n1, and groups of bits must have the \
         same number of digits on both sides. What comes in is read before anything moves. Use WSFRP, \
         since the plain form shifts in every scan.\n\n\
         ```il\n\
         LD X0\n\
         WSFRP D0 D10 K8 K1\n\
         END\n\
         ```\n",
    )
    .pulse()
    .on(FX2N_UP)
    .doing(shift_words_right),
    applied(
        37,
        "WSFL",
        "shift words left",
        &[
            WORDS_IN,
            WORDS_MOVED,
            count("n1", "length of the row", (1, 512)),
            count("n2", "number of places", (1, 512)).or_register(),
        ],
        "Shifts a row of n1 words from D on by n2 places towards the higher numbers; n2 words from S \
         on come in at the lower end, so D always holds the newest value. n2 must not be greater than \
         n1, and groups of bits must have the same number of digits on both sides. What comes in is \
         read before anything moves. Use WSFLP, since the plain form shifts in every scan.\n\n\
         ```il\n\
         LD X0\n\
         WSFLP D0 D10 K8 K1\n\
         END\n\
         ```\n",
    )
    .pulse()
    .on(FX2N_UP)
    .doing(shift_words_left),
    applied(
        38,
        "SFWR",
        "write to a queue",
        &[
            source("S", "value that is put in"),
            destination("D", "counter of the queue, its values follow")
                .accepting(ROW)
                .read_and_written()
                .counted_by(2),
            count("n", "length with the counter", (2, 512)),
        ],
        "Puts a value into a queue: D counts the values, the n-1 words after it hold them in the order \
         in which they came. While the queue is full, the carry flag M8022 is on and nothing is \
         written. Clear D before the first use, use SFWRP to write once, and take values out with \
         SFRD. A count below 0 is an execution error.\n\n\
         ```il\n\
         LD M8002\n\
         RST D10\n\
         LD X0\n\
         SFWRP D0 D10 K8\n\
         LD X1\n\
         SFRDP D10 D1 K8\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(write_to_queue),
    applied(
        39,
        "SFRD",
        "read from a queue",
        &[
            source("S", "counter of the queue, its values follow")
                .accepting(ROW)
                .read_and_written()
                .counted_by(2),
            destination("D", "value that is taken out"),
            count("n", "length with the counter", (2, 512)),
        ],
        "Takes the oldest value out of a queue that SFWR fills: it goes to D, the others move up, and \
         the counter S falls by 1. While the queue is empty, the zero flag M8020 is on and D keeps its \
         value. Use SFRDP to read once. The last word of the queue keeps its value when the others \
         move up. A count below 0 or above n-1 is an execution error.\n\n\
         ```il\n\
         LD M8002\n\
         RST D10\n\
         LD X0\n\
         SFWRP D0 D10 K8\n\
         LD X1\n\
         SFRDP D10 D1 K8\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(read_from_queue),
];

/// The places of a rotation, and the word as a pattern of its bits. A group of bits is a whole word.
fn rotated(execution: &mut dyn Execution) -> Result<(u64, u32), Fault> {
    let width = execution.width();
    let by = execution.count(1, 1, i64::from(width))?;
    if execution.group_bits(0).is_some_and(|bits| bits != width) {
        return Err(Fault::Value(0));
    }
    Ok((execution.value(0)? as u64 & ((1 << width) - 1), by as u32))
}

fn rotate_right(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (value, by) = rotated(execution)?;
    let width = execution.width();
    execution.put(0, (value >> by | value << (width - by)) as i64)?;
    execution.set_relay(CARRY, value >> (by - 1) & 1 == 1);
    Ok(())
}

fn rotate_left(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (value, by) = rotated(execution)?;
    let width = execution.width();
    execution.put(0, (value << by | value >> (width - by)) as i64)?;
    execution.set_relay(CARRY, value >> (width - by) & 1 == 1);
    Ok(())
}

fn rotate_right_with_carry(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (value, by) = rotated(execution)?;
    turn_ring(execution, value, by)
}

/// To the left by so many places is to the right by the others.
fn rotate_left_with_carry(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (value, by) = rotated(execution)?;
    let ring = execution.width() + 1;
    turn_ring(execution, value, ring - by)
}

/// Rotates a word with the carry flag above it to the right.
fn turn_ring(execution: &mut dyn Execution, value: u64, by: u32) -> Result<(), Fault> {
    let width = execution.width();
    let ring = value | u64::from(execution.relay(CARRY)) << width;
    let turned = ring >> by | ring << (width + 1 - by);
    execution.put(0, turned as i64)?;
    execution.set_relay(CARRY, turned >> width & 1 == 1);
    Ok(())
}

/// The length of a row and the number of places, which is not greater.
fn lengths(execution: &mut dyn Execution, most: i64) -> Result<(usize, usize), Fault> {
    let length = execution.count(2, 1, most)?;
    Ok((length as usize, execution.count(3, 1, length)? as usize))
}

fn shift_bits_right(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (length, by) = lengths(execution, 1024)?;
    let (new, old) = (execution.relays(0, by as i64)?, execution.relays(1, length as i64)?);
    execution.set_relays(1, &[&old[by..], &new].concat())
}

fn shift_bits_left(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (length, by) = lengths(execution, 1024)?;
    let (new, old) = (execution.relays(0, by as i64)?, execution.relays(1, length as i64)?);
    execution.set_relays(1, &[&new, &old[..length - by]].concat())
}

fn shift_words_right(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (length, by) = lengths(execution, 512)?;
    same_digits(execution, 0, 1)?;
    let (new, old) = (execution.values(0, by as i64)?, execution.values(1, length as i64)?);
    execution.put_values(1, &[&old[by..], &new].concat())
}

fn shift_words_left(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (length, by) = lengths(execution, 512)?;
    same_digits(execution, 0, 1)?;
    let (new, old) = (execution.values(0, by as i64)?, execution.values(1, length as i64)?);
    execution.put_values(1, &[&new, &old[..length - by]].concat())
}

fn write_to_queue(execution: &mut dyn Execution) -> Result<(), Fault> {
    let length = execution.count(2, 2, 512)?;
    let (value, queue) = (execution.value(0)?, execution.values(1, length)?);
    let waiting = queue.first().copied().filter(|waiting| *waiting >= 0).ok_or(Fault::Value(1))?;
    let is_full = waiting >= length - 1;
    if !is_full {
        execution.set_word(1, waiting + 1, value)?;
        execution.set_word(1, 0, waiting + 1)?;
    }
    execution.set_relay(CARRY, is_full);
    Ok(())
}

fn read_from_queue(execution: &mut dyn Execution) -> Result<(), Fault> {
    let length = execution.count(2, 2, 512)?;
    let queue = execution.values(0, length)?;
    let waiting =
        queue.first().copied().filter(|waiting| (0..length).contains(waiting)).ok_or(Fault::Value(0))?;
    if waiting > 0 {
        execution.word(1, 0)?;
        execution.put_values(0, &[&[waiting - 1], &queue[2..]].concat())?;
        execution.set_word(1, 0, queue[1])?;
    }
    execution.set_relay(ZERO, waiting == 0);
    Ok(())
}
