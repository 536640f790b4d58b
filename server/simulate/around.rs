//! What is around the CPU, as values.

use super::Value;
use crate::target::{Outside, Port, PortKind};
use crate::text::Message;
use smol_str::SmolStr;

/// What is at a port.
pub(super) fn value(port: Port, outside: &Outside) -> Value {
    match port.kind() {
        PortKind::Bit => Value::Bit(outside.number(port) != 0),
        PortKind::Number(_) => Value::Number(outside.number(port)),
        PortKind::Frame => Value::Text(text_of(outside.frame(port))),
    }
}

/// What a value that people write is there; nothing if it is none of its values.
pub(super) fn meant(port: Port, value: &Value) -> Option<Value> {
    match (port.kind(), value) {
        // A frame is what is written, whatever else that could be.
        (PortKind::Frame, Value::Text(text) | Value::Name(text) | Value::Word(text, _)) => {
            bytes_of(text).map(|_| Value::Text(text.clone()))
        }
        (PortKind::Frame, _) => None,
        (PortKind::Bit, _) => value.as_bit().map(Value::Bit),
        (PortKind::Number(_), Value::Number(_)) => Some(value.clone()),
        (PortKind::Number(_), Value::Word(_, meant)) => Some((**meant).clone()),
        (PortKind::Number(_), _) => None,
    }
}

/// What a person may write there; nothing for what is none of its values, and where the program alone writes.
pub(super) fn taken(port: Port, value: &Value) -> Option<Value> {
    let value = meant(port, value).filter(|_| !port.is_of_program())?;
    match (port.kind(), &value) {
        (PortKind::Number(range), Value::Number(number)) => range.contains(number).then_some(value),
        (PortKind::Number(_), _) => None,
        _ => Some(value),
    }
}

/// Why nothing can be written there, or not `value`; nothing where its numbers say it.
pub(super) fn refusal(port: Port, value: &Value) -> Option<Message> {
    match port.kind() {
        _ if port.is_of_program() => Some(Message::new("simulate.of-program")),
        // It could be written, so it was to be held.
        _ if taken(port, value).is_some() => Some(Message::new("simulate.not-held")),
        PortKind::Frame => Some(Message::new("simulate.frame")),
        PortKind::Bit | PortKind::Number(_) => None,
    }
}

/// Writes a value that [`taken`] gave.
pub(super) fn put(port: Port, outside: &mut Outside, value: &Value) {
    match value {
        Value::Text(text) => outside.serial.waiting.extend(bytes_of(text)),
        Value::Bit(on) => outside.put(port, i64::from(*on)),
        Value::Number(number) => outside.put(port, *number),
        _ => {}
    }
}

/// Bytes as text: each is the character with its number.
fn text_of(bytes: &[u8]) -> SmolStr {
    bytes.iter().copied().map(char::from).collect()
}

/// The same backwards; nothing where a character is none of the first 256.
fn bytes_of(text: &str) -> Option<Vec<u8>> {
    text.chars().map(|character| u8::try_from(character).ok()).collect()
}
