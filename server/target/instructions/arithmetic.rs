//! Arithmetic and logic on whole words: FNC 20 to 29.

use super::specs::{FX2N_UP, applied, changed, destination, source};
use crate::target::{Accepts, DeviceKind, Execution, Fault, Instruction, OperandSpec};

const LEFT: OperandSpec = source("S1", "first value");
const RIGHT: OperandSpec = source("S2", "second value");
const RESULT: OperandSpec = destination("D", "result");

/// Two words for the product, or for quotient and remainder; four in the 32-bit form.
const TWO_WORDS: OperandSpec =
    destination("D", "first of two words for the result").except(Accepts::V).covering(2);

/// ADD SUB MUL DIV INC DEC WAND WOR WXOR NEG.
pub const ROWS: &[Instruction] = &[
    applied(
        20,
        "ADD",
        "add",
        &[LEFT, RIGHT, RESULT],
        "Adds two signed numbers, in each scan in which the result is on; with the same register as \
         source and destination it therefore adds again in every scan, unless written ADDP. M8020 goes \
         on if the sum is 0, M8022 if it passes 32767 (DADD 2147483647) and M8021 if it falls below \
         the smallest number; the sum then wraps round, so that 32767 + 1 is -32768. Manuals describe \
         a sum that keeps the sign of the limit there; here all bits of the sum are kept.\n\n\
         ```il\n\
         LD X0\n\
         ADDP D0 K5 D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(add),
    applied(
        21,
        "SUB",
        "subtract",
        &[LEFT, RIGHT, RESULT],
        "Subtracts S2 from S1, both signed, in each scan in which the result is on; use SUBP where it \
         shall happen once. The flags are those of ADD: M8020 for 0, M8021 for a result below the \
         smallest number, M8022 for one above the largest.\n\n\
         ```il\n\
         LD X0\n\
         SUBP D0 K5 D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(subtract),
    applied(
        22,
        "MUL",
        "multiply",
        &[LEFT, RIGHT, TWO_WORDS],
        "Multiplies two signed numbers. The product has twice as many bits: MUL D0 D2 D4 writes D4 and \
         D5, and DMUL four registers, so keep the following ones free. A product in a group of bits is \
         cut to the bits that are there. DMUL writes only the lower 32 bits to a group, and it does \
         not take Z as destination. The flags M8020 to M8022 stay as they are.\n\n\
         ```il\n\
         LD X0\n\
         MUL D0 K10 D2\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(multiply),
    applied(
        23,
        "DIV",
        "divide",
        &[LEFT, RIGHT, TWO_WORDS],
        "Divides S1 by S2, both signed, and writes the quotient to D and the remainder to the next \
         word; DDIV writes two words of each. The quotient is rounded towards 0 and the remainder has \
         the sign of S1. Division by 0 is an execution error and leaves the destination as it is. A \
         group of bits gets the quotient alone, and DDIV does not take Z as destination. -32768 \
         divided by -1 does not fit, which is an execution error as well; the flags M8020 to M8022 \
         stay as they are.\n\n\
         ```il\n\
         LD X0\n\
         DIV D0 K10 D2\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(divide),
    applied(
        24,
        "INC",
        "add 1",
        &[changed("D", "word")],
        "Adds 1 to a word. It is executed in every scan in which the result is on, so nearly always \
         INCP is meant. After 32767 comes -32768 (DINC: after 2147483647 comes -2147483648), and no \
         flag is set.\n\n\
         ```il\n\
         LD X0\n\
         INCP D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(increment),
    applied(
        25,
        "DEC",
        "subtract 1",
        &[changed("D", "word")],
        "Subtracts 1 from a word. It is executed in every scan in which the result is on, so nearly \
         always DECP is meant. After -32768 comes 32767, and no flag is set.\n\n\
         ```il\n\
         LD X0\n\
         DECP D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(decrement),
    applied(
        26,
        "WAND",
        "and of words",
        &[LEFT, RIGHT, RESULT],
        "Combines two words bit by bit: a bit of the destination is on if it is on in both. With a \
         constant it masks bits out: H0F keeps the lowest four. The 32-bit form drops the W: DAND.\n\n\
         ```il\n\
         LD X0\n\
         WAND D0 H0F D1\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(and),
    applied(
        27,
        "WOR",
        "or of words",
        &[LEFT, RIGHT, RESULT],
        "Combines two words bit by bit: a bit of the destination is on if it is on in one of them or \
         in both. With a constant it switches bits on and leaves the others. The 32-bit form drops \
         the W: DOR.\n\n\
         ```il\n\
         LD X0\n\
         WOR D0 H0F D1\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(or),
    applied(
        28,
        "WXOR",
        "exclusive or of words",
        &[LEFT, RIGHT, RESULT],
        "Combines two words bit by bit: a bit of the destination is on if it differs between them. It \
         shows which bits of a word have changed, and with a constant it turns bits round; then use \
         the pulse form, or they turn back in the next scan. The 32-bit form drops the W: DXOR.\n\n\
         ```il\n\
         LD X0\n\
         WXOR D0 D1 D2\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(exclusive_or),
    applied(
        29,
        "NEG",
        "change the sign",
        &[changed("D", "word")],
        "Changes the sign of a word (two's complement). Use NEGP: the plain form changes it again in \
         each scan. The smallest number, -32768, has no counterpart and stays as it is.\n\n\
         ```il\n\
         LD X0\n\
         NEGP D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(negate),
];

fn add(execution: &mut dyn Execution) -> Result<(), Fault> {
    let sum = execution.value(0)? + execution.value(1)?;
    put_flagged(execution, sum)
}

fn subtract(execution: &mut dyn Execution) -> Result<(), Fault> {
    let difference = execution.value(0)? - execution.value(1)?;
    put_flagged(execution, difference)
}

/// Writes a sum, and the flags: 0 is what is stored, the others are of the sum itself.
fn put_flagged(execution: &mut dyn Execution, sum: i64) -> Result<(), Fault> {
    let (least, greatest) = execution.limits();
    let stored = execution.wrapped(sum);
    execution.put(2, stored)?;
    execution.set_flags(stored == 0, sum < least, sum > greatest);
    Ok(())
}

fn multiply(execution: &mut dyn Execution) -> Result<(), Fault> {
    let product = execution.value(0)? * execution.value(1)?;
    match execution.is_wide() {
        true => put_pair(execution, product, product >> 32),
        false => execution.set_double(2, 0, product),
    }
}

fn divide(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (dividend, divisor) = (execution.value(0)?, execution.value(1)?);
    let quotient = dividend.checked_div(divisor).ok_or(Fault::DivisionByZero)?;
    if quotient > execution.limits().1 {
        return Err(Fault::Overflow);
    }
    let remainder = dividend - quotient * divisor;
    if execution.is_wide() {
        return put_pair(execution, quotient, remainder);
    }
    match execution.group_bits(2) {
        Some(_) => execution.set_word(2, 0, quotient),
        // Two words that are a pair also where the second one is V.
        None => execution.set_double(2, 0, remainder << 16 | quotient & 0xFFFF),
    }
}

/// Writes two numbers of 32 bits, of which a group of bits takes the first only. Index registers have no room for two.
fn put_pair(execution: &mut dyn Execution, first: i64, second: i64) -> Result<(), Fault> {
    if execution.group_bits(2).is_some() {
        return execution.set_double(2, 0, first);
    }
    if execution.device(2)?.is_some_and(|device| device.kind == DeviceKind::Z) {
        return Err(Fault::NoDevice(2));
    }
    execution.put_values(2, &[first, second])
}

fn increment(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)?;
    execution.put(0, value + 1)
}

fn decrement(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)?;
    execution.put(0, value - 1)
}

fn and(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)? & execution.value(1)?;
    execution.put(2, value)
}

fn or(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)? | execution.value(1)?;
    execution.put(2, value)
}

fn exclusive_or(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)? ^ execution.value(1)?;
    execution.put(2, value)
}

fn negate(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = execution.value(0)?;
    execution.put(0, -value)
}
