//! Words of a program as the logic compares them.

use crate::target::{Constant, Operand};
use crate::text::{Span, folded};
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use std::fmt;

/// An operand: what it says, how it was written, and where. Two terms are equal if they mean the same, however written.
#[derive(Clone, Debug)]
pub struct Term {
    /// As read.
    pub operand: Operand,
    /// As written.
    pub text: SmolStr,
    /// Where it stands in the chunk that it was read from; empty if it was not read.
    pub span: Span,
}

impl Term {
    /// `text`, which reads as `operand`.
    pub fn new(operand: Operand, text: &str, span: Span) -> Term {
        Term { operand, text: text.into(), span }
    }

    /// Its value in every scan, if it is a device that has only one.
    pub fn always(&self) -> Option<bool> {
        match self.operand {
            Operand::Device(device) => device.always(),
            _ => None,
        }
    }

    /// What it means, in one spelling: `X10` for `x010`, `K16` for `H10`, names in lower case.
    pub fn key(&self) -> SmolStr {
        match &self.operand {
            Operand::Device(device) => device.to_smolstr(),
            Operand::Indexed { device, index } => format_smolstr!("{device}{index}"),
            Operand::Nibbles { digits, first, index: None } => {
                format_smolstr!("K{digits}{first}")
            }
            Operand::Nibbles { digits, first, index: Some(index) } => {
                format_smolstr!("K{digits}{first}{index}")
            }
            Operand::WordBit { word, bit } => format_smolstr!("{word}.{bit:x}"),
            Operand::Constant { value: Constant::Decimal(value), index: None } => {
                format_smolstr!("K{value}")
            }
            // A larger pattern is another number in 16 bits than in 32.
            Operand::Constant { value: Constant::Hexadecimal(value), index: None } if *value <= 0x7FFF => {
                format_smolstr!("K{value}")
            }
            Operand::Direct(address) => address.to_smolstr(),
            Operand::Text => self.text.clone(),
            _ => folded(&self.text),
        }
    }
}

impl PartialEq for Term {
    fn eq(&self, other: &Term) -> bool {
        self.key() == other.key()
    }
}

impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
