//! Times and settings as people write them: `500ms`, `X0=1@100ms`.

use super::Value;
use crate::target::iec::LiteralValue;
use crate::target::{Model, Operand};

/// A value that a variable gets, from a time on.
#[derive(Clone, PartialEq, Debug)]
pub struct Setting {
    /// As people call the variable.
    pub name: String,
    /// What it is to be.
    pub value: Value,
    /// When, in nanoseconds: before the first scan that begins then or later.
    pub from_ns: i64,
}

impl Setting {
    /// Reads `NAME=VALUE` or `NAME=VALUE@TIME`.
    ///
    /// # Errors
    /// The piece that cannot be read, or the form that is wanted.
    pub fn read(word: &str) -> Result<Setting, String> {
        let (setting, from) =
            word.rsplit_once('@').map_or((word, None), |(setting, from)| (setting, Some(from)));
        let (name, value) = setting.split_once('=').ok_or("NAME=VALUE")?;
        let value = Value::read(value).ok_or_else(|| value.to_string())?;
        Ok(Setting { name: name.trim().to_string(), value, from_ns: from.map_or(Ok(0), duration)? })
    }
}

/// A time in nanoseconds: `10ms`, `1.5s`, `T#2m`; a number alone is milliseconds.
///
/// # Errors
/// The word, if it is no time.
pub fn duration(word: &str) -> Result<i64, String> {
    let bare = word.trim();
    let time = match bare.parse::<f64>() {
        Ok(_) => format!("T#{bare}ms"),
        Err(_) if bare.contains('#') => bare.to_string(),
        Err(_) => format!("T#{bare}"),
    };
    match Operand::read(&time, Model::Iec) {
        Operand::Literal(literal) => match literal.value {
            LiteralValue::Time(time_ns) if time_ns >= 0 => Ok(time_ns),
            _ => Err(word.to_string()),
        },
        _ => Err(word.to_string()),
    }
}
