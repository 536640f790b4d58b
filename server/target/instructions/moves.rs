//! Moving and converting values: FNC 12 to 19.

use super::specs::{FX2N_UP, applied, changed, count, destination, source};
use crate::target::{Accepts, Execution, Fault, Instruction};

/// Words that blocks are made of; index registers do not stand in a row of memory with others.
const BLOCK: Accepts = Accepts::WORD_DESTINATION.without(Accepts::V.or(Accepts::Z));

/// Words and groups of bits, no constants.
const WORDS: Accepts = Accepts::WORD_SOURCE.without(Accepts::K);

/// MOV SMOV CML BMOV FMOV XCH BCD BIN.
pub const ROWS: &[Instruction] = &[
    applied(
        12,
        "MOV",
        "move",
        &[source("S", "value"), destination("D", "where it goes")],
        "Copies a constant, a word or a group of bits to a word or a group of bits, in each scan in \
         which the result is on. When the result goes off, the destination keeps its value. K4M0 \
         stands for sixteen relays from M0 on; a destination with fewer bits takes the lower ones, one \
         with more is filled with 0. DMOV moves 32 bits, a register and the next one. Z0 and V0 are \
         one number for DMOV, V0 its upper half; V alone has no 32 bits. An index such as that of D0Z1 \
         counts in the same way: V alone or Z alone with 16 bits, Z and V together with 32. A number \
         that the PLC does not have is an execution error.\n\n\
         ```il\n\
         LD X0\n\
         MOV K100 D0\n\
         LD X1\n\
         MOV D0 K2Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(move_value),
    applied(
        13,
        "SMOV",
        "move digits",
        &[
            source("S", "source").accepting(WORDS),
            count("m1", "first digit that is moved, 4 is the highest", (1, 4)),
            count("m2", "number of digits", (1, 4)),
            destination("D", "destination"),
            count("n", "place of the first digit in the destination", (1, 4)),
        ],
        "Moves decimal digits from one word into another: m2 digits of the source from digit m1 \
         downwards go to the destination from digit n downwards, and its other digits stay. Digit 1 is \
         the units, digit 4 the thousands. Both words are converted to decimal digits and back, so \
         they must lie between 0 and 9999; while M8168 is on, hexadecimal digits are moved as they \
         are. If m2 is greater than m1 or n, it is an execution error.\n\n\
         ```il\n\
         LD X0\n\
         SMOVP D0 K2 K2 D1 K4\n\
         END\n\
         ```\n",
    )
    .pulse()
    .on(FX2N_UP)
    .doing(move_digits),
    applied(
        14,
        "CML",
        "move the complement",
        &[source("S", "value"), destination("D", "where the inverted bits go")],
        "Copies a value with every bit turned round, 0 to 1 and 1 to 0, in each scan in which the \
         result is on. It serves where a device reads inputs or drives lamps with inverted logic.\n\n\
         ```il\n\
         LD X0\n\
         CML K2X10 K2Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(move_complement),
    applied(
        15,
        "BMOV",
        "move a block",
        &[
            source("S", "first source").accepting(BLOCK.or(Accepts::KNX)).counted_by(2),
            destination("D", "first destination").accepting(BLOCK).counted_by(2),
            count("n", "number of words", (1, 512)).or_register(),
        ],
        "Copies a row of n words to another place, in each scan in which the result is on; areas that \
         overlap are copied correctly. Groups of bits must have the same number of digits on both \
         sides. Watch the end of the area: a block that would run past the last device is an execution \
         error and copies nothing. While M8024 is on, the block goes from D to S.\n\n\
         ```il\n\
         LD X0\n\
         BMOVP D0 D10 K5\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(move_block),
    applied(
        16,
        "FMOV",
        "fill",
        &[
            source("S", "value"),
            destination("D", "first destination").accepting(BLOCK).counted_by(2),
            count("n", "number of words", (1, 512)),
        ],
        "Writes one value to a row of n words, for instance 0 to clear a table. It is executed in each \
         scan in which the result is on, so the pulse form is the usual one. A row that would run past \
         the last device is an execution error and writes nothing.\n\n\
         ```il\n\
         LD M8002\n\
         FMOV K0 D0 K10\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(fill),
    applied(
        17,
        "XCH",
        "exchange",
        &[changed("D1", "one word"), changed("D2", "the other word")],
        "Exchanges the contents of two words. Use the pulse form: without it they change places again \
         in every scan. While M8160 is on and both operands are the same, it exchanges the two bytes \
         of the word. Different operands are then an execution error, and DXCH exchanges the bytes of \
         each of the two words.\n\n\
         ```il\n\
         LD X0\n\
         XCHP D0 D1\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(exchange),
    applied(
        18,
        "BCD",
        "convert to BCD",
        &[source("S", "binary value").accepting(WORDS), destination("D", "decimal digits")],
        "Converts a binary number to four decimal digits of four bits each, as seven-segment displays \
         want them. The number must lie between 0 and 9999, with DBCD between 0 and 99999999; \
         anything else is an execution error. Arithmetic is always binary, so convert only for \
         display.\n\n\
         ```il\n\
         LD X0\n\
         BCD D0 K2Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(to_bcd),
    applied(
        19,
        "BIN",
        "convert from BCD",
        &[source("S", "decimal digits").accepting(WORDS), destination("D", "binary value")],
        "Converts decimal digits of four bits each, as thumbwheel switches give them, to a binary \
         number. A digit above 9 is an execution error, which happens for a moment while a switch is \
         turned; a constant cannot be converted, since constants are binary already.\n\n\
         ```il\n\
         LD X0\n\
         BIN K2X10 D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(from_bcd),
];

/// Turns the low and the high byte round, instead of what XCH does else.
const SWAPS_BYTES: u32 = 8160;
/// SMOV moves digits of four bits as they are.
const HEXADECIMAL_DIGITS: u32 = 8168;
/// BMOV copies the other way.
const BACKWARDS: u32 = 8024;

fn move_value(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)?;
    execution.put(1, value)
}

fn move_complement(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)?;
    execution.put(1, !value)
}

fn move_digits(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (first, count, place) =
        (execution.count(1, 1, 4)?, execution.count(2, 1, 4)?, execution.count(4, 1, 4)?);
    if count > first || count > place {
        return Err(Fault::Value(2));
    }
    let is_decimal = !execution.relay(HEXADECIMAL_DIGITS);
    let mut digits = |operand| {
        let value = execution.word(operand, 0)?;
        match is_decimal {
            true => bcd(value, 4).ok_or(Fault::Value(operand as u8)),
            false => Ok(value & 0xFFFF),
        }
    };
    let (source, old) = (digits(0)?, digits(3)?);
    let mask = (1 << (4 * count)) - 1;
    let moved = source >> (4 * (first - count)) & mask;
    let to = 4 * (place - count);
    let new = old & !(mask << to) | moved << to;
    let new = if is_decimal { binary(new).ok_or(Fault::Value(3))? } else { new };
    execution.set_word(3, 0, new)
}

fn move_block(execution: &mut dyn Execution) -> Result<(), Fault> {
    let count = execution.count(2, 1, 512)?;
    same_digits(execution, 0, 1)?;
    let (from, to) = if execution.relay(BACKWARDS) { (1, 0) } else { (0, 1) };
    let values = execution.values(from, count)?;
    execution.put_values(to, &values)
}

/// Groups of bits between which rows are moved have the same number of digits.
pub(super) fn same_digits(execution: &mut dyn Execution, from: usize, to: usize) -> Result<(), Fault> {
    match (execution.group_bits(from), execution.group_bits(to)) {
        (Some(one), Some(other)) if one != other => Err(Fault::Value(to as u8)),
        _ => Ok(()),
    }
}

fn fill(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (value, count) = (execution.value(0)?, execution.count(2, 1, 512)?);
    execution.put_values(1, &vec![value; count as usize])
}

fn exchange(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (one, other) = (execution.value(0)?, execution.value(1)?);
    if !execution.relay(SWAPS_BYTES) {
        execution.put(0, other)?;
        return execution.put(1, one);
    }
    if execution.device(0)? != execution.device(1)? || execution.group_bits(0) != execution.group_bits(1) {
        return Err(Fault::Value(1));
    }
    swap_bytes(execution)
}

/// Exchanges the two bytes of each word of the first operand.
pub(super) fn swap_bytes(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)?;
    execution.put(0, (value & 0x00FF_00FF) << 8 | value >> 8 & 0x00FF_00FF)
}

fn to_bcd(execution: &mut dyn Execution) -> Result<(), Fault> {
    let digits = execution.width() / 4;
    let pattern = bcd(execution.value(0)?, digits).ok_or(Fault::Value(0))?;
    execution.put(1, pattern)
}

fn from_bcd(execution: &mut dyn Execution) -> Result<(), Fault> {
    let mask = (1 << execution.width()) - 1;
    let value = binary(execution.value(0)? & mask).ok_or(Fault::Value(0))?;
    execution.put(1, value)
}

/// So many decimal digits of four bits each, if the number has no more.
fn bcd(number: i64, digits: u32) -> Option<i64> {
    let digit = |place| (number / 10_i64.pow(place) % 10) << (4 * place);
    (0..10_i64.pow(digits)).contains(&number).then(|| (0..digits).map(digit).sum())
}

/// The number that decimal digits of four bits each are.
fn binary(pattern: i64) -> Option<i64> {
    (0..8).rev().try_fold(0, |number, place| {
        let digit = pattern >> (4 * place) & 0xF;
        (digit < 10).then_some(number * 10 + digit)
    })
}
