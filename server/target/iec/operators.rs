//! The operators of Instruction List (IEC 61131-3 2nd ed. table 52, 3rd ed. table 68).

use super::GenericType;
use super::page::Page;

/// One operator.
#[derive(Debug)]
pub struct Operator {
    /// Upper case: `LD`, `AND`, `&`.
    pub name: &'static str,
    /// A few words.
    pub title: &'static str,
    /// Which modifiers it takes.
    pub modifiers: Modifiers,
    /// What it does to the current result.
    pub role: OperatorRole,
    /// What its operand and the current result may be; nothing for those without a value (JMP, CAL, RET).
    pub operand: Option<GenericType>,
    pub(super) page: Page,
}

/// An operator as it is written in one word: `ANDN`, `JMPCN`, `&`. The `(` is a token of its own.
#[derive(Clone, Copy, Debug)]
pub struct Written {
    /// The row.
    pub operator: &'static Operator,
    /// With `N` as a negation: `LDN`, `ORN`.
    pub negate: bool,
    /// With `C`: `Some(true)`, with `CN`: `Some(false)`; the value that the current result must have.
    pub condition: Option<bool>,
}

/// The modifiers that an operator takes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Modifiers {
    /// `N`, negation of the operand (`LDN`).
    pub negate: bool,
    /// `(`, evaluation deferred to `)`.
    pub defer: bool,
    /// `C` and `CN`, execution if the current result is 1 or 0.
    pub condition: bool,
}

/// What an operator does to the current result.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum OperatorRole {
    /// LD: makes a current result.
    Load,
    /// ST: stores it.
    Store,
    /// S, R: set and reset, driven by it.
    Latch,
    /// AND, ADD, GT …: combines it with the operand; `comparison` makes it BOOL.
    Combine {
        /// GT GE EQ NE LE LT.
        comparison: bool,
    },
    /// NOT: changes it.
    Complement,
    /// JMP.
    Jump,
    /// CAL.
    Call,
    /// RET.
    Return,
}
