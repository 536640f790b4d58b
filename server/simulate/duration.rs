//! Times as people write them.

use crate::target::iec::LiteralValue;
use crate::target::{Model, Operand};

/// A time such as `10ms`, `1.5s` or `T#2m` in nanoseconds; a number alone is milliseconds. Nothing if it is no time, or
/// one before 0.
pub fn duration(word: &str) -> Option<i64> {
    let bare = word.trim();
    let time = match bare.parse::<f64>() {
        Ok(_) => format!("T#{bare}ms"),
        Err(_) if bare.contains('#') => bare.to_string(),
        Err(_) => format!("T#{bare}"),
    };
    match Operand::read(&time, Model::Iec) {
        Operand::Literal(literal) => match literal.value {
            LiteralValue::Time(time_ns) if time_ns >= 0 => Some(time_ns),
            _ => None,
        },
        _ => None,
    }
}
