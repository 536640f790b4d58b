//! Durations, dates, times of day: exact, in whole nanoseconds and days.

use super::{LiteralProblem, number};

const NANOSECONDS_PER_SECOND: i64 = 1_000_000_000;
const NANOSECONDS_PER_DAY: i64 = 24 * 60 * 60 * NANOSECONDS_PER_SECOND;

/// The units of durations, longest first: spelling, nanoseconds, and the limit of a unit that is not the first.
const UNITS: [(&str, i64, i128); 7] = [
    ("d", NANOSECONDS_PER_DAY, i128::MAX),
    ("h", 60 * 60 * NANOSECONDS_PER_SECOND, 24),
    ("m", 60 * NANOSECONDS_PER_SECOND, 60),
    ("s", NANOSECONDS_PER_SECOND, 60),
    ("ms", 1_000_000, 1000),
    ("us", 1000, 1000),
    ("ns", 1, 1000),
];

/// Nanoseconds of what stands after `T#`: `-1d_2h30m`, `1.5s`.
///
/// The first unit may be of any size as long as the sum fits 64 bits, some 292 years.
pub fn duration(text: &str) -> Result<i64, LiteralProblem> {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    let mut rest = unsigned;
    let mut total: i128 = 0;
    let mut next_unit = 0;
    let mut fraction_seen = false;
    while !rest.is_empty() || next_unit == 0 {
        if fraction_seen {
            return Err(LiteralProblem::DurationForm);
        }
        let (whole, fraction, after) = leading_number(rest)?;
        let letters = after.len() - after.trim_start_matches(|c: char| c.is_ascii_alphabetic()).len();
        let (name, after) = after.split_at(letters);
        let unit = UNITS.iter().position(|(unit, ..)| unit.eq_ignore_ascii_case(name));
        let Some(unit) = unit.filter(|unit| *unit >= next_unit) else {
            return Err(LiteralProblem::DurationForm);
        };
        let (_, nanoseconds, limit) = UNITS[unit];
        if next_unit > 0 && whole >= limit {
            return Err(LiteralProblem::DurationOverflow);
        }
        let part = whole.checked_mul(i128::from(nanoseconds)).ok_or(LiteralProblem::Range)?;
        let part = part.checked_add(i128::from(scaled_fraction(fraction.unwrap_or(""), nanoseconds)));
        total = part.and_then(|part| total.checked_add(part)).ok_or(LiteralProblem::Range)?;
        fraction_seen = fraction.is_some();
        next_unit = unit + 1;
        rest = match after.strip_prefix('_') {
            Some("") => return Err(LiteralProblem::Underscore),
            Some(after) => after,
            None => after,
        };
    }
    let signed = if text.starts_with('-') { -total } else { total };
    i64::try_from(signed).map_err(|_| LiteralProblem::Range)
}

/// Days since 1970-01-01 of `2024-01-31`.
pub fn date(text: &str) -> Result<i32, LiteralProblem> {
    let mut parts = text.split('-');
    let (Some(year), Some(month), Some(day), None) = (parts.next(), parts.next(), parts.next(), parts.next())
    else {
        return Err(LiteralProblem::DateForm);
    };
    let (year, month, day) = (digits(year, 4, 4)?, digits(month, 1, 2)?, digits(day, 1, 2)?);
    let length = match month {
        2 if year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => return Err(LiteralProblem::NoSuchDate),
    };
    if year == 0 || !(1..=length).contains(&day) {
        return Err(LiteralProblem::NoSuchDate);
    }
    // Years that start in March have the leap day at their end; 400 of them have 146,097 days.
    let shifted_year = if month < 3 { year - 1 } else { year };
    let shifted_month = (month + 9) % 12;
    let days_before_month = (153 * shifted_month + 2) / 5;
    let days = 365 * shifted_year + shifted_year / 4 - shifted_year / 100 + shifted_year / 400;
    // 719,468 days lie between 0000-03-01 and 1970-01-01.
    Ok((days + days_before_month + day - 1 - 719_468) as i32)
}

/// Nanoseconds since midnight of `23:59:59.999`.
pub fn time_of_day(text: &str) -> Result<i64, LiteralProblem> {
    let mut parts = text.split(':');
    let (Some(hour), Some(minute), Some(second), None) =
        (parts.next(), parts.next(), parts.next(), parts.next())
    else {
        return Err(LiteralProblem::DateForm);
    };
    let (second, fraction) = match second.split_once('.') {
        Some((_, "")) => return Err(LiteralProblem::DateForm),
        Some((second, fraction)) => (second, fraction),
        None => (second, ""),
    };
    if !fraction.bytes().all(|digit| digit.is_ascii_digit()) {
        return Err(LiteralProblem::DateForm);
    }
    let (hour, minute, second) = (digits(hour, 1, 2)?, digits(minute, 1, 2)?, digits(second, 1, 2)?);
    if hour > 23 || minute > 59 || second > 59 {
        return Err(LiteralProblem::NoSuchDate);
    }
    let whole = (hour * 60 + minute) * 60 + second;
    Ok(whole * NANOSECONDS_PER_SECOND + scaled_fraction(fraction, NANOSECONDS_PER_SECOND))
}

/// Nanoseconds since 1970-01-01 of `2024-01-31-12:00:00`.
pub fn date_and_time(text: &str) -> Result<i128, LiteralProblem> {
    let (day, time) = text.rsplit_once('-').ok_or(LiteralProblem::DateForm)?;
    let days = i128::from(date(day)?);
    Ok(days * i128::from(NANOSECONDS_PER_DAY) + i128::from(time_of_day(time)?))
}

/// The number at the start of `text`: its whole part, the digits after the point, and what follows.
fn leading_number(text: &str) -> Result<(i128, Option<&str>, &str), LiteralProblem> {
    let number_end = text.find(|c: char| !c.is_ascii_digit() && c != '_' && c != '.').unwrap_or(text.len());
    let (number, after) = text.split_at(number_end);
    if number.is_empty() {
        return Err(LiteralProblem::DurationForm);
    }
    let (whole, fraction) = match number.split_once('.') {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (number, None),
    };
    if whole.is_empty() || fraction.is_some_and(|fraction| fraction.is_empty() || fraction.contains('.')) {
        return Err(LiteralProblem::DurationForm);
    }
    if fraction.is_some_and(|fraction| {
        fraction.starts_with('_') || fraction.ends_with('_') || fraction.contains("__")
    }) {
        return Err(LiteralProblem::Underscore);
    }
    Ok((number::integer(whole, 10)?, fraction, after))
}

/// `0.fraction` of `nanoseconds`, rounded down. Eighteen digits are more than a day's nanoseconds can show.
fn scaled_fraction(fraction: &str, nanoseconds: i64) -> i64 {
    let mut value: i128 = 0;
    let mut scale: i128 = 1;
    for digit in fraction.bytes().filter(u8::is_ascii_digit).take(18) {
        value = value * 10 + i128::from(digit - b'0');
        scale *= 10;
    }
    // Below `nanoseconds`, so it fits.
    (value * i128::from(nanoseconds) / scale) as i64
}

/// A number of at least `shortest` and at most `longest` decimal digits.
fn digits(text: &str, shortest: usize, longest: usize) -> Result<i64, LiteralProblem> {
    let plain =
        (shortest..=longest).contains(&text.len()) && text.bytes().all(|digit| digit.is_ascii_digit());
    if !plain {
        return Err(LiteralProblem::DateForm);
    }
    text.parse().map_err(|_| LiteralProblem::DateForm)
}
