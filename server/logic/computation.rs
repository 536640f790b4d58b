//! Calculations with words, which IEC 61131-3 writes as functions.

use super::Term;
use crate::target::iec::Function;
use std::fmt;

/// A function of one or two words whose result is stored. The terms of its action are its inputs, then the result.
#[derive(Clone, Copy)]
pub struct Computation {
    /// The function.
    pub function: &'static Function,
}

impl PartialEq for Computation {
    fn eq(&self, other: &Computation) -> bool {
        self.function.name == other.function.name
    }
}

impl fmt::Debug for Computation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.function.name)
    }
}

impl Computation {
    /// The output for the result, which the standard gives no name.
    pub const RESULT: &'static str = "OUT";

    /// That of the function called `name`, letter case aside; nothing for functions of other shapes.
    pub fn named(name: &str) -> Option<Computation> {
        let function = Function::named(name)?;
        OPERATORS.contains(&function.name).then_some(Computation { function })
    }

    /// That which only copies a word.
    pub fn copies(self) -> bool {
        self.function.inputs.len() == 1
    }

    /// Whether it joins the bits of words, and single bits as well.
    pub fn is_bitwise(self) -> bool {
        matches!(self.function.name, "AND" | "OR" | "XOR")
    }

    /// What is read, and what is written; nothing if these are not as many terms as it has.
    pub fn operands(self, terms: &[Term]) -> Option<(&[Term], &Term)> {
        let (result, inputs) = terms.split_last()?;
        (inputs.len() == self.function.inputs.len()).then_some((inputs, result))
    }
}

/// The functions that instruction list has as operators, and the copy, which it writes as a load and a store.
const OPERATORS: [&str; 9] = ["MOVE", "ADD", "SUB", "MUL", "DIV", "MOD", "AND", "OR", "XOR"];
