//! Settings as people write them: `X0=1@100ms`.

use super::{Value, duration};
use crate::text::Message;

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
    /// The sentence that says what cannot be read.
    pub fn read(word: &str) -> Result<Setting, Message> {
        let (setting, from) =
            word.rsplit_once('@').map_or((word, None), |(setting, from)| (setting, Some(from)));
        let unread = || Message::new("cli.run-setting").with("setting", word);
        let (name, value) = setting.split_once('=').ok_or_else(unread)?;
        let unread = || Message::new("cli.run-value").with("value", value).with("name", name);
        let value = Value::read(value).ok_or_else(unread)?;
        let unread = || Message::new("cli.run-moment").with("time", from.unwrap_or_default());
        let from_ns = from.map_or(Some(0), duration).ok_or_else(unread)?;
        Ok(Setting { name: name.trim().to_string(), value, from_ns })
    }
}
