//! FNC 110–132: arithmetic with binary floating point numbers, IEEE 754 single precision in two registers.
//!
//! All but INT exist only with `D`; their `count` is that form's, 2 for a pair of registers.

use super::specs::{FX2N_UP, applied, bits_out, operand};
use crate::target::{Accepts, Access, Execution, Fault, Instruction, OperandSpec};

const REGISTER: Accepts = Accepts::D.or(Accepts::R);

/// A floating point number in a pair, or a constant. An integer constant is converted by the CPU.
const fn value(name: &'static str, meaning: &'static str) -> OperandSpec {
    operand(name, meaning, Access::Read, REGISTER.or(Accepts::K).or(Accepts::E)).covering(2)
}

/// A floating point number in a pair of registers.
const fn stored(name: &'static str, meaning: &'static str) -> OperandSpec {
    operand(name, meaning, Access::Read, REGISTER).covering(2)
}

/// A pair that is written.
const fn result(meaning: &'static str) -> OperandSpec {
    operand("D", meaning, Access::Write, REGISTER).covering(2)
}

/// ECMP EZCP EBCD EBIN EADD ESUB EMUL EDIV ESQR INT SIN COS TAN.
pub const ROWS: &[Instruction] = &[
    applied(
        110,
        "ECMP",
        "float compare",
        &[
            value("S1", "first number"),
            value("S2", "second number"),
            bits_out("D", "greater, equal, less").covering(3),
        ],
        "Compares two floating point numbers and switches one of three bits on: `D` if `S1` is greater \
         than `S2`, the next if they are equal, the third if it is less. It is written `DECMP` and \
         works in every scan in which it is driven; with the drive off the bits keep the last result, \
         so reset them with `ZRST` if that matters. Computed numbers are rarely exactly equal: leave \
         some room with `DEZCP` instead of waiting for the second bit.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         DECMP D10 K100 M0\n\
         LD M0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(compare),
    applied(
        111,
        "EZCP",
        "float zone compare",
        &[
            value("S1", "lower limit"),
            value("S2", "upper limit"),
            value("S", "number to compare"),
            bits_out("D", "below, within, above").covering(3),
        ],
        "Compares a floating point number with two limits and switches one of three bits on: `D` below \
         `S1`, the next from `S1` to `S2`, the third above `S2`. It is written `DEZCP` and works in \
         every scan in which it is driven; the bits keep the last result when the drive goes off. `S1` \
         must not be greater than `S2`, otherwise `S2` is taken to be equal to `S1`.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         DEZCP K20 K80 D10 M0\n\
         LD M1\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(compare_zone),
    applied(
        118,
        "EBCD",
        "float to decimal exponent form",
        &[stored("S", "number"), result("mantissa and exponent")],
        "Turns a floating point number into a decimal mantissa in `D` (1000 to 9999, or negative) and \
         a power of ten in the next register, for people and for displays: 3.142 becomes 3142 and −3. \
         It is written `DEBCD`. Only four digits survive, the last one rounded, so do not compute on \
         with the result. Zero gives 0 and 0.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         LD X0\n\
         DEBCDP D10 D12\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(to_decimal_exponent),
    applied(
        119,
        "EBIN",
        "decimal exponent form to float",
        &[stored("S", "mantissa and exponent"), result("number")],
        "Makes a floating point number from a decimal mantissa in `S` and a power of ten in the next \
         register: 3142 and −3 become 3.142. It is written `DEBIN`. It is the way to write a fraction \
         into a program for an FX2N, which has no real constants. Use four digits for the mantissa; \
         the first scan is early enough. A number too large to be stored is an operation error.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K3142 D0\n\
         MOV K-3 D1\n\
         DEBIN D0 D10\n\
         LD X0\n\
         DEMUL D10 K2 D12\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(from_decimal_exponent),
    applied(
        120,
        "EADD",
        "float add",
        &[value("S1", "first number"), value("S2", "number to add"), result("sum")],
        "Adds two floating point numbers, each in a pair of registers. It is written `DEADD`. An \
         integer constant is converted, an integer in a register is not: convert it by `FLT` first, or \
         the bits are read as nonsense. `M8020` shows zero, `M8021` a result too small and `M8022` one \
         too large to be stored; the smallest or the largest number of its sign is stored then. A pair \
         whose bits are no number is an operation error. With the same pair as source and destination \
         use `DEADDP`, or it adds again in every scan.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         DEADD D10 K5 D12\n\
         INT D12 D1\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(add),
    applied(
        121,
        "ESUB",
        "float subtract",
        &[value("S1", "number"), value("S2", "number to subtract"), result("difference")],
        "Subtracts the floating point number `S2` from `S1`. It is written `DESUB`; flags and the need \
         to convert integers by `FLT` are as for `DEADD`. The difference of two nearly equal numbers \
         has few good digits left: single precision carries about seven in all. With the same pair as \
         source and destination use `DESUBP`.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         DESUB D10 K273 D12\n\
         INT D12 D1\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(subtract),
    applied(
        122,
        "EMUL",
        "float multiply",
        &[value("S1", "first number"), value("S2", "second number"), result("product")],
        "Multiplies two floating point numbers. It is written `DEMUL`. Unlike the integer `MUL` the \
         product takes no more room than the factors, a pair of registers. `M8022` comes on when it is \
         too large to be stored. To scale a measured value convert it by `FLT` first, and the result \
         back by `INT`, which drops the fraction.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         DEMUL D10 K3 D12\n\
         INT D12 D1\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(multiply),
    applied(
        123,
        "EDIV",
        "float divide",
        &[value("S1", "dividend"), value("S2", "divisor"), result("quotient")],
        "Divides the floating point number `S1` by `S2`. It is written `DEDIV`. There is no remainder; \
         the quotient takes one pair of registers. Division by zero is an operation error (`M8067`), \
         and the result keeps its former value: test a computed divisor before. Dividing by 10 or 100 \
         is also how a fraction is made where real constants are missing.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         DEDIV D10 K10 D12\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(divide),
    applied(
        127,
        "ESQR",
        "float square root",
        &[value("S", "number"), result("square root")],
        "Takes the square root of a floating point number, as for flow from a differential pressure. It \
         is written `DESQR`. A negative number is an operation error (`M8067`): a sensor that swings a \
         little below zero is enough, so limit the value first. `M8020` comes on when the result is \
         zero.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         LD>= D0 K0\n\
         DESQR D10 D12\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(square_root),
    applied(
        129,
        "INT",
        "float to integer",
        &[stored("S", "number"), operand("D", "integer", Access::Write, REGISTER)],
        "Turns a floating point number into an integer of 16 bits (`DINT`: 32 bits) by dropping the \
         fraction, towards zero: 2.9 gives 2 and −2.9 gives −2. Add 0.5 before to round. `M8020` comes \
         on when the result is 0, `M8021` when a fraction was dropped, and `M8022` when the number \
         does not fit, which leaves `D` as it is: then use `DINT`. The source is a pair of registers \
         in both forms.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         DEDIV D10 K10 D12\n\
         INT D12 D1\n\
         LD= D1 K25\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(to_integer),
    applied(
        130,
        "SIN",
        "sine",
        &[stored("S", "angle in radians").also(Accepts::E), result("sine")],
        "Takes the sine of an angle in radians, a floating point number. It is written `DSIN`. Degrees \
         must be multiplied by π ÷ 180 ≈ 0.0174533 before. Keep the angle between 0 and 2π; the older \
         CPUs accept no other, simulation takes any. It costs much more time than an addition: compute \
         it when the angle changes, not in every scan.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K1745 D0\n\
         MOV K-5 D1\n\
         DEBIN D0 D10\n\
         LD M8000\n\
         FLT D2 D12\n\
         DEMUL D12 D10 D14\n\
         DSIN D14 D16\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(sine),
    applied(
        131,
        "COS",
        "cosine",
        &[stored("S", "angle in radians").also(Accepts::E), result("cosine")],
        "Takes the cosine of an angle in radians, a floating point number. It is written `DCOS`. \
         Degrees must be multiplied by π ÷ 180 before, and the angle kept between 0 and 2π, as for \
         `DSIN`. Near 90° the result is a very small number, seldom exactly 0, so do not compare it for \
         equality.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         DEDIV D10 K100 D12\n\
         DCOS D12 D14\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(cosine),
    applied(
        132,
        "TAN",
        "tangent",
        &[stored("S", "angle in radians").also(Accepts::E), result("tangent")],
        "Takes the tangent of an angle in radians, a floating point number. It is written `DTAN`. \
         Degrees must be multiplied by π ÷ 180 before, and the angle kept between 0 and 2π, as for \
         `DSIN`. Close to 90° and 270° the result grows without limit and its sign changes: limit the \
         angle before the result steers anything.\n\n\
         ```il\n\
         LD M8000\n\
         FLT D0 D10\n\
         DEDIV D10 K100 D12\n\
         DTAN D12 D14\n\
         END\n\
         ```\n",
    )
    .wide_only()
    .pulse()
    .on(FX2N_UP)
    .doing(tangent),
];

/// The number at an operand, which is neither infinite nor no number.
fn number(execution: &mut dyn Execution, place: usize) -> Result<f64, Fault> {
    let number = execution.real(place, 0)?;
    if number.is_finite() { Ok(number) } else { Err(Fault::Value(place as u8)) }
}

/// Writes a result of arithmetic and its flags. Double precision is enough that rounding twice is rounding once.
fn put(execution: &mut dyn Execution, value: f64) -> Result<(), Fault> {
    let place = execution.operands() - 1;
    let single = value as f32;
    let (is_small, is_large) = (value != 0.0 && single.abs() < f32::MIN_POSITIVE, single.is_infinite());
    let stored = match (is_small, is_large) {
        (true, _) => f32::MIN_POSITIVE.copysign(single),
        (_, true) => f32::MAX.copysign(single),
        // 0 has no sign.
        _ => single + 0.0,
    };
    execution.set_real(place, 0, f64::from(stored))?;
    execution.set_flags(value == 0.0, is_small, is_large);
    Ok(())
}

fn compare(execution: &mut dyn Execution) -> Result<(), Fault> {
    let ordering = number(execution, 0)?.partial_cmp(&number(execution, 1)?);
    execution.answer(2, ordering.ok_or(Fault::Value(0))?)
}

fn compare_zone(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (lower, upper, value) = (number(execution, 0)?, number(execution, 1)?, number(execution, 2)?);
    let upper = upper.max(lower);
    execution.set_relays(3, &[value < lower, (lower..=upper).contains(&value), value > upper])
}

fn to_decimal_exponent(execution: &mut dyn Execution) -> Result<(), Fault> {
    // Written with four digits, `-3.142e0`, which is rounded as one expects.
    let written = format!("{:.3e}", number(execution, 0)?);
    let (digits, power) = written.split_once('e').ok_or(Fault::Value(0))?;
    let mantissa: i64 = digits.replace('.', "").parse().map_err(|_| Fault::Value(0))?;
    let power: i64 = power.parse().map_err(|_| Fault::Value(0))?;
    let power = if mantissa == 0 { 0 } else { power - 3 };
    execution.set_double(1, 0, power << 16 | mantissa & 0xFFFF)
}

fn from_decimal_exponent(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (mantissa, power) = (execution.word(0, 0)?, execution.word(0, 1)?);
    let number: f32 = format!("{mantissa}e{power}").parse().map_err(|_| Fault::Value(0))?;
    if number.is_infinite() {
        return Err(Fault::Overflow);
    }
    execution.set_real(1, 0, f64::from(number))
}

fn add(execution: &mut dyn Execution) -> Result<(), Fault> {
    let sum = number(execution, 0)? + number(execution, 1)?;
    put(execution, sum)
}

fn subtract(execution: &mut dyn Execution) -> Result<(), Fault> {
    let difference = number(execution, 0)? - number(execution, 1)?;
    put(execution, difference)
}

fn multiply(execution: &mut dyn Execution) -> Result<(), Fault> {
    let product = number(execution, 0)? * number(execution, 1)?;
    put(execution, product)
}

fn divide(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (dividend, divisor) = (number(execution, 0)?, number(execution, 1)?);
    if divisor == 0.0 {
        return Err(Fault::DivisionByZero);
    }
    put(execution, dividend / divisor)
}

fn square_root(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = number(execution, 0)?;
    if value < 0.0 {
        return Err(Fault::Value(0));
    }
    put(execution, value.sqrt())
}

fn to_integer(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = number(execution, 0)?;
    let (least, greatest) = execution.limits();
    let integer = value.trunc() as i64;
    let does_fit = (least..=greatest).contains(&integer);
    if does_fit {
        execution.put(1, integer)?;
    }
    execution.set_flags(integer == 0, value != value.trunc(), !does_fit);
    Ok(())
}

fn sine(execution: &mut dyn Execution) -> Result<(), Fault> {
    let angle = number(execution, 0)?;
    execution.set_real(1, 0, angle.sin())
}

fn cosine(execution: &mut dyn Execution) -> Result<(), Fault> {
    let angle = number(execution, 0)?;
    execution.set_real(1, 0, angle.cos())
}

fn tangent(execution: &mut dyn Execution) -> Result<(), Fault> {
    let angle = number(execution, 0)?;
    execution.set_real(1, 0, angle.tan())
}
