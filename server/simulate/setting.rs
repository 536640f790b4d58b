//! Settings as people write them: `X0=1@100ms`.

use super::{Value, duration};

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
        let from_ns = match from {
            Some(from) => duration(from).ok_or_else(|| from.to_string())?,
            None => 0,
        };
        Ok(Setting { name: name.trim().to_string(), value, from_ns })
    }
}
