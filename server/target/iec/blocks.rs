//! The standard function blocks (IEC 61131-3 2nd ed. tables 34 to 37).

use super::Parameter;
use super::page::Page;

/// One standard function block.
#[derive(Debug)]
pub struct FunctionBlock {
    /// Upper case: `TON`.
    pub name: &'static str,
    /// A few words.
    pub title: &'static str,
    /// The inputs in the order of the declaration.
    pub inputs: &'static [Parameter],
    /// The outputs in the order of the declaration.
    pub outputs: &'static [Parameter],
    /// The inputs that are also operators of Instruction List (`CU C10`), table 54.
    pub input_operators: &'static [&'static str],
    pub(super) page: Page,
}
