//! Values written as literals, and texts without their quotes.

use crate::target::iec::semantics::NS_OF_DAY;
use crate::target::iec::{Datum, ElementaryType, GenericType, LiteralValue};
use smol_str::{SmolStr, SmolStrBuilder, ToSmolStr, format_smolstr};
use std::fmt::Write;

/// A value of type `kind` as a literal: `TRUE`, `-5`, `16#FF`, `1.5`, `T#1s500ms`, `D#2024-01-31`. A text stays what it
/// is, without quotes.
pub fn spelled(value: &Datum, kind: ElementaryType) -> SmolStr {
    use ElementaryType::*;
    let number = value.whole();
    match (value, kind) {
        (Datum::Text(text), _) => text.clone(),
        (Datum::Real(number), _) => real_spelled(shortest(*number, kind)),
        (_, Bool) => if number == 0 { "FALSE" } else { "TRUE" }.into(),
        (_, Time) => format_smolstr!("T#{}", duration(number)),
        (_, Ltime) => format_smolstr!("LT#{}", duration(number)),
        (_, Date) => format_smolstr!("D#{}", date(number)),
        (_, Ldate) => format_smolstr!("LD#{}", date(number)),
        (_, TimeOfDay | LtimeOfDay) => format_smolstr!("{kind}#{}", time_of_day(number)),
        (_, DateAndTime | LdateAndTime) => {
            let (day, time) = (date(number.div_euclid(NS_OF_DAY)), time_of_day(number.rem_euclid(NS_OF_DAY)));
            format_smolstr!("{kind}#{day}-{time}")
        }
        (_, Char | Wchar) => char::from_u32(number as u32).into_iter().collect(),
        _ if kind.belongs_to(GenericType::AnyBit) => format_smolstr!("16#{number:X}"),
        _ => number.to_smolstr(),
    }
}

/// The number with the fewest digits that a variable of type `kind` takes for this one: of the REAL nearest to 0.1 it is
/// 0.1, and not what is left behind its seventh digit.
pub fn shortest(number: f64, kind: ElementaryType) -> f64 {
    match kind {
        ElementaryType::Real => format!("{:?}", number as f32).parse().unwrap_or(number),
        _ => number,
    }
}

/// A real number as a literal, with a digit on both sides of the point: `0.1`, `1.0e20`. What is no number of the
/// standard's is `Infinity`, `-Infinity` or `NaN`.
pub fn real_spelled(number: f64) -> SmolStr {
    if number.is_nan() {
        return "NaN".into();
    }
    if number.is_infinite() {
        return if number > 0.0 { "Infinity" } else { "-Infinity" }.into();
    }
    let digits = format!("{number:?}");
    match digits.split_once('e') {
        Some((mantissa, exponent)) if !mantissa.contains('.') => format_smolstr!("{mantissa}.0e{exponent}"),
        _ => digits.into(),
    }
}

fn duration(nanoseconds: i128) -> SmolStr {
    const UNITS: [(&str, i128); 7] = [
        ("d", NS_OF_DAY),
        ("h", 3_600_000_000_000),
        ("m", 60_000_000_000),
        ("s", 1_000_000_000),
        ("ms", 1_000_000),
        ("us", 1000),
        ("ns", 1),
    ];
    if nanoseconds == 0 {
        return "0s".into();
    }
    let mut text = SmolStrBuilder::new();
    let mut rest = nanoseconds.abs();
    if nanoseconds < 0 {
        text.push('-');
    }
    for (unit, size) in UNITS {
        if rest >= size {
            let _ = write!(text, "{}{unit}", rest / size);
            rest %= size;
        }
    }
    text.finish()
}

/// The date so many days after 1970-01-01, in the calendar that is in use today.
fn date(days: i128) -> SmolStr {
    // Counted from 0000-03-01, so that a leap day is the last one of its year; 400 years have 146,097 days.
    let days = days + 719_468;
    let (era, day) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let (date, month) = (day - (153 * month + 2) / 5 + 1, if month < 10 { month + 3 } else { month - 9 });
    let year = era * 400 + year + i128::from(month <= 2);
    format_smolstr!("{year:04}-{month:02}-{date:02}")
}

fn time_of_day(nanoseconds: i128) -> SmolStr {
    let (seconds, fraction) = (nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    let clock = format_smolstr!("{hour:02}:{minute:02}:{second:02}");
    match fraction {
        0 => clock,
        _ => format_smolstr!("{clock}.{}", format!("{fraction:09}").trim_end_matches('0')),
    }
}

/// The characters of a text literal, with or without the name of its type; nothing if there are no quotes around it.
pub fn characters_of(word: &str) -> Option<SmolStr> {
    let start = word.find(['\'', '"'])?;
    let (quote, code_digits) = if word[start..].starts_with('\'') { ('\'', 2) } else { ('"', 4) };
    let mut rest = word[start + 1..].strip_suffix(quote)?.chars();
    let mut text = SmolStrBuilder::new();
    while let Some(character) = rest.next() {
        if character != '$' {
            text.push(character);
            continue;
        }
        let escaped = rest.next()?;
        match escaped.to_ascii_uppercase() {
            'L' | 'N' => text.push('\n'),
            'P' => text.push('\u{c}'),
            'R' => text.push('\r'),
            'T' => text.push('\t'),
            digit if digit.is_ascii_hexdigit() => {
                let digits: String =
                    std::iter::once(digit).chain(rest.by_ref().take(code_digits - 1)).collect();
                text.push(char::from_u32(u32::from_str_radix(&digits, 16).ok()?)?);
            }
            _ => text.push(escaped),
        }
    }
    Some(text.finish())
}

impl Datum {
    /// What a literal is where a value of type `kind` is expected; nothing if it is none, or a text, which stays in the
    /// source.
    pub fn of_literal(value: LiteralValue, kind: ElementaryType) -> Option<Datum> {
        let is_real = kind.belongs_to(GenericType::AnyReal);
        let datum = match value {
            LiteralValue::Bool(on) => Datum::from(on),
            LiteralValue::Integer(_) if is_real => return None,
            LiteralValue::Integer(number) => Datum::Whole(number),
            LiteralValue::Real(number) if is_real => Datum::Real(number),
            LiteralValue::Time(time) | LiteralValue::TimeOfDay(time) => Datum::Whole(i128::from(time)),
            LiteralValue::Date(days) => Datum::Whole(i128::from(days)),
            LiteralValue::DateAndTime(time) => Datum::Whole(time),
            _ => return None,
        };
        let is_own = match value {
            LiteralValue::Bool(_) => kind == ElementaryType::Bool,
            LiteralValue::Integer(_) => kind.integers().is_some(),
            LiteralValue::Time(_) => matches!(kind, ElementaryType::Time | ElementaryType::Ltime),
            LiteralValue::TimeOfDay(_) => {
                matches!(kind, ElementaryType::TimeOfDay | ElementaryType::LtimeOfDay)
            }
            LiteralValue::Date(_) => matches!(kind, ElementaryType::Date | ElementaryType::Ldate),
            LiteralValue::DateAndTime(_) => {
                matches!(kind, ElementaryType::DateAndTime | ElementaryType::LdateAndTime)
            }
            _ => true,
        };
        let (held, is_same) = datum.held(kind);
        (is_own && is_same).then_some(held)
    }
}
