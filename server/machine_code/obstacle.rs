//! Why an instruction has no machine code, and the sentences that say so.

use super::operands::Uncoded;
use crate::target::{Form, Target};
use crate::text::Message;

/// Why an instruction has no machine code.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Obstacle {
    /// The model does not have it.
    NotOnModel,
    /// No source tells its code.
    Unknown,
    /// It has more or fewer operands than it takes.
    OperandCount,
    /// The operand at this place, from 0.
    Operand(usize, Uncoded),
}

impl Obstacle {
    /// The sentence, with the words of the source.
    pub fn message(self, form: Form, operand: &str, target: &Target) -> Message {
        let key = match self {
            Obstacle::NotOnModel => "machine-code.not-on-model",
            Obstacle::Unknown => "machine-code.unknown-code",
            Obstacle::OperandCount => "machine-code.operand-count",
            Obstacle::Operand(_, Uncoded::Unreadable) => "machine-code.unreadable-operand",
            Obstacle::Operand(_, Uncoded::NotTaken) => "machine-code.operand-not-taken",
            Obstacle::Operand(_, Uncoded::NoDevice) => "machine-code.no-device",
            Obstacle::Operand(_, Uncoded::Unknown) => "machine-code.unknown-operand",
            Obstacle::Operand(_, Uncoded::IndexV) => "machine-code.index-v",
            Obstacle::Operand(_, Uncoded::TooLarge(_)) => "machine-code.too-large",
            Obstacle::Operand(_, Uncoded::Text) => "machine-code.text",
        };
        let message = Message::new(key)
            .with("instruction", form.mnemonic())
            .with("word", operand)
            .with("target", target.title);
        match self {
            Obstacle::Operand(_, Uncoded::TooLarge(bits)) => message.with("bits", bits),
            _ => message,
        }
    }
}
