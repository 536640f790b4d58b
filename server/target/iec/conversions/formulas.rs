//! What conversions make of values. Where the standard leaves it open: numbers of times are milliseconds, those of
//! dates seconds since 1970-01-01; patterns of bits and integers of other widths keep their low bits, a negative number
//! fills upper bits with ones; bit strings convert to reals and back as unsigned numbers.

use super::Conversion;
use crate::target::Fault;
use crate::target::iec::literal::spelled;
use crate::target::iec::semantics::{NS_OF_DAY, range_of};
use crate::target::iec::{Datum, ElementaryType, Formula, GenericType, Inputs, Literal, LiteralValue};
use smol_str::SmolStr;

impl Conversion {
    /// The code of its row.
    pub(super) fn formula(self) -> Formula {
        Formula::new(match self {
            Conversion::Value(..) | Conversion::ToValue(_) => value,
            Conversion::Truncate(..) | Conversion::ToTruncated(_) | Conversion::AnyTruncate => {
                |inputs| real_to_whole(inputs.real(0).trunc())
            }
            Conversion::FromBcd(..) | Conversion::FromAnyBcd(_) => from_bcd,
            Conversion::ToBcd(..) | Conversion::AnyToBcd(_) | Conversion::ToAnyBcd(_) => to_bcd,
        })
    }
}

const NS_OF_MILLISECOND: i128 = 1_000_000;
const NS_OF_SECOND: i128 = 1_000_000_000;
const SECONDS_OF_DAY: i128 = 86_400;

fn value(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    use ElementaryType::*;
    let (from, to) = (inputs.kind(0), inputs.result);
    let is = |kind: ElementaryType, group| kind.belongs_to(group);
    let is_real = |kind| is(kind, GenericType::AnyReal);
    let is_text = |kind| is(kind, GenericType::AnyChars);
    match (from, to) {
        _ if from == to => Ok(inputs.values[0].clone()),
        _ if is_text(from) && is_text(to) => text_to_text(inputs),
        (String | Wstring, _) => read(inputs.text(0), to),
        (_, String | Wstring) => Ok(Datum::Text(spelled(&inputs.values[0], from))),
        (Bool, _) if is_real(to) => Ok(Datum::Real(inputs.real(0))),
        (_, Bool) if is_real(from) => Ok(Datum::from(inputs.real(0) != 0.0)),
        (_, Bool) => Ok(Datum::from(inputs.whole(0) != 0)),
        _ if is_real(from) && is_real(to) => Ok(Datum::Real(inputs.real(0))),
        _ if is_time(from) && is_time(to) => Ok(Datum::Whole(between_times(inputs.whole(0), from, to))),
        _ if is_time(from) => match is_real(to) {
            true => Ok(Datum::Real(inputs.real(0) / unit(from) as f64)),
            false => Ok(Datum::Whole(inputs.whole(0).div_euclid(unit(from)) * seconds(from))),
        },
        _ if is_time(to) && is_real(from) => {
            real_to_whole((inputs.real(0) * unit(to) as f64).round_ties_even())
        }
        _ if is_time(to) => Ok(Datum::Whole((inputs.whole(0) * unit(to)).div_euclid(seconds(to)))),
        _ if is_real(from) => real_to_whole(inputs.real(0).round_ties_even()),
        _ if is_real(to) => Ok(Datum::Real(inputs.real(0))),
        // Numbers must fit; patterns are cut.
        _ if is(from, GenericType::AnyInt) && is(to, GenericType::AnyInt) => Ok(inputs.values[0].clone()),
        _ => Ok(inputs.values[0].clone().within(to)),
    }
}

fn is_time(kind: ElementaryType) -> bool {
    kind.belongs_to(GenericType::AnyDuration) || kind.belongs_to(GenericType::AnyDate)
}

/// What the number 1 stands for, in the unit of the type's values: of a date it is a second of a day.
fn unit(kind: ElementaryType) -> i128 {
    use ElementaryType::*;
    match kind {
        Date | Ldate => 1,
        DateAndTime | LdateAndTime => NS_OF_SECOND,
        _ => NS_OF_MILLISECOND,
    }
}

/// How many numbers one unit of the type's values is: a day has many seconds.
fn seconds(kind: ElementaryType) -> i128 {
    match kind {
        ElementaryType::Date | ElementaryType::Ldate => SECONDS_OF_DAY,
        _ => 1,
    }
}

fn between_times(value: i128, from: ElementaryType, to: ElementaryType) -> i128 {
    use ElementaryType::*;
    match (from, to) {
        (DateAndTime | LdateAndTime, Date | Ldate) => value.div_euclid(NS_OF_DAY),
        (DateAndTime | LdateAndTime, TimeOfDay | LtimeOfDay) => value.rem_euclid(NS_OF_DAY),
        _ => value,
    }
}

fn real_to_whole(number: f64) -> Result<Datum, Fault> {
    match number.is_finite() {
        true => Ok(Datum::Whole(number as i128)),
        false => Err(Fault::Overflow),
    }
}

/// Texts and characters: a single-byte text has no character above 16#FF.
fn text_to_text(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    use ElementaryType::*;
    let text: SmolStr = match inputs.kind(0) {
        Char | Wchar => char::from_u32(inputs.whole(0) as u32).into_iter().collect(),
        _ => inputs.text(0).into(),
    };
    let is_narrow = matches!(inputs.result, String | Char);
    if is_narrow && text.chars().any(|character| u32::from(character) > 0xFF) {
        return Err(Fault::Value(0));
    }
    match inputs.result {
        Char | Wchar => {
            let first = text.chars().next().ok_or(Fault::Value(0))?;
            Ok(Datum::Whole(i128::from(u32::from(first))))
        }
        _ => Ok(Datum::Text(text)),
    }
}

/// The value that a text says in the way of a literal of type `to`, with or without its prefix.
fn read(text: &str, to: ElementaryType) -> Result<Datum, Fault> {
    let text = text.trim();
    let is_unprefixed = is_time(to) && !text.contains('#');
    let literal = match is_unprefixed {
        true => Literal::read(&format!("{to}#{text}")),
        false => Literal::read(text),
    };
    let literal = literal.map_err(|_| Fault::Value(0))?;
    match literal.value {
        LiteralValue::Integer(number) if to.belongs_to(GenericType::AnyReal) => {
            Ok(Datum::Real(number as f64))
        }
        value => Datum::of_literal(value, to).ok_or(Fault::Value(0)),
    }
}

fn from_bcd(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    let (mut digits, mut number, mut place) = (inputs.whole(0) as u128, 0, 1);
    while digits != 0 {
        if digits & 0xF > 9 {
            return Err(Fault::Value(0));
        }
        number += (digits & 0xF) as i128 * place;
        (digits, place) = (digits >> 4, place * 10);
    }
    Ok(Datum::Whole(number))
}

fn to_bcd(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    let mut number = inputs.whole(0);
    if number < 0 {
        return Err(Fault::Value(0));
    }
    let (mut digits, mut shift) = (0_i128, 0);
    while number != 0 {
        digits |= (number % 10) << shift;
        (number, shift) = (number / 10, shift + 4);
    }
    match range_of(inputs.result).contains(&digits) {
        true => Ok(Datum::Whole(digits)),
        false => Err(Fault::Value(0)),
    }
}
