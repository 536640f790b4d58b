//! Integers with a base, and reals.

use super::{LiteralProblem, LiteralValue};

/// Reads an integer or a real without a type name: `12`, `-1_000`, `16#FF`, `1.5E-3`.
pub fn read(word: &str) -> Result<LiteralValue, LiteralProblem> {
    let unsigned = word.strip_prefix(['+', '-']).unwrap_or(word);
    if unsigned.is_empty() {
        return Err(LiteralProblem::Form);
    }
    if let Some((base, digits)) = unsigned.split_once('#') {
        let value = based(base, digits)?;
        return if unsigned == word { Ok(LiteralValue::Integer(value)) } else { Err(LiteralProblem::Sign) };
    }
    // Only a real has a point or an exponent: integers in other bases are gone by here.
    if unsigned.contains(['.', 'e', 'E']) {
        return real(word, unsigned).map(LiteralValue::Real);
    }
    let value = integer(unsigned, 10)?;
    Ok(LiteralValue::Integer(if word.starts_with('-') { -value } else { value }))
}

/// Digits of `base` with single underscores between them.
pub fn integer(digits: &str, base: u32) -> Result<i128, LiteralProblem> {
    check_underscores(digits)?;
    let mut value: i128 = 0;
    for digit in digits.chars().filter(|digit| *digit != '_') {
        let digit = digit.to_digit(base).ok_or(LiteralProblem::Digit)?;
        value = value
            .checked_mul(i128::from(base))
            .and_then(|value| value.checked_add(i128::from(digit)))
            .ok_or(LiteralProblem::Range)?;
    }
    Ok(value)
}

fn based(base: &str, digits: &str) -> Result<i128, LiteralProblem> {
    let base = match base {
        "2" => 2,
        "8" => 8,
        "16" => 16,
        _ => return Err(LiteralProblem::Base),
    };
    if digits.starts_with(['+', '-']) {
        return Err(LiteralProblem::Sign);
    }
    integer(digits, base)
}

/// At least one digit, no underscore at an end, no two in a row.
fn check_underscores(digits: &str) -> Result<(), LiteralProblem> {
    match digits {
        "" => Err(LiteralProblem::Digit),
        _ if digits.starts_with('_') || digits.ends_with('_') || digits.contains("__") => {
            Err(LiteralProblem::Underscore)
        }
        _ => Ok(()),
    }
}

/// A point with a digit on both sides, then perhaps an exponent.
fn real(word: &str, unsigned: &str) -> Result<f64, LiteralProblem> {
    let (mantissa, exponent) = match unsigned.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent.strip_prefix(['+', '-']).unwrap_or(exponent))),
        None => (unsigned, None),
    };
    let (whole, fraction) = mantissa.split_once('.').ok_or(LiteralProblem::RealForm)?;
    for digits in [Some(whole), Some(fraction), exponent].into_iter().flatten() {
        if digits.is_empty() || digits.contains('.') {
            return Err(LiteralProblem::RealForm);
        }
        check_underscores(digits)?;
        if !digits.chars().all(|digit| digit == '_' || digit.is_ascii_digit()) {
            return Err(LiteralProblem::Digit);
        }
    }
    let value: f64 = word.replace('_', "").parse().map_err(|_| LiteralProblem::RealForm)?;
    if value.is_finite() { Ok(value) } else { Err(LiteralProblem::Range) }
}
