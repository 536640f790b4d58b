//! Calculations with words, which IEC 61131-3 writes as functions, and calls of functions that the program declares.

use super::{Callee, Formal, Term};
use crate::document::Scopes;
use crate::target::iec::Function;

/// A function whose result is stored: one of the standard with one or two words, or one of the program. The terms of
/// its action are its inputs, then the result.
#[derive(Clone, PartialEq, Debug)]
pub struct Computation {
    /// The function.
    pub function: Callee,
}

impl Computation {
    /// The output for the result, which the standard gives no name.
    pub const RESULT: &'static str = "OUT";

    /// That of the standard function called `name`, letter case aside; nothing for functions of other shapes.
    pub fn named(name: &str) -> Option<Computation> {
        let function = Function::named(name)?;
        OPERATORS.contains(&function.name).then_some(Computation { function: Callee::Function(function) })
    }

    /// That of the function called `name` which the program declares.
    pub fn declared(name: &str, scopes: &Scopes) -> Option<Computation> {
        Callee::declared_function(name, scopes).map(|function| Computation { function })
    }

    /// The name of the function.
    pub fn name(&self) -> &str {
        self.function.name()
    }

    /// Its inputs.
    pub fn inputs(&self) -> Vec<Formal<'_>> {
        self.function.inputs()
    }

    /// Whether the program declares the function.
    pub fn is_declared(&self) -> bool {
        self.function.is_declared()
    }

    /// Whether it only copies a word.
    pub fn copies(&self) -> bool {
        !self.is_declared() && self.name() == "MOVE"
    }

    /// Whether it joins the bits of words, and single bits as well.
    pub fn is_bitwise(&self) -> bool {
        !self.is_declared() && matches!(self.name(), "AND" | "OR" | "XOR")
    }

    /// What is read, and what is written; nothing if these are not as many terms as it has.
    pub fn operands<'t>(&self, terms: &'t [Term]) -> Option<(&'t [Term], &'t Term)> {
        let (result, inputs) = terms.split_last()?;
        (inputs.len() == self.inputs().len()).then_some((inputs, result))
    }

    /// What it may change: its result, and what is handed over to be changed. What a function of the program does
    /// beyond that is not among it.
    pub fn changes<'t>(&self, terms: &'t [Term]) -> Vec<&'t Term> {
        let Some((result, operands)) = terms.split_last() else { return Vec::new() };
        let inputs = self.inputs();
        let handed_over = operands.iter().zip(&inputs).filter(|(_, formal)| formal.is_in_out);
        handed_over.map(|(term, _)| term).chain([result]).collect()
    }
}

/// The functions that instruction list has as operators, and the copy, which it writes as a load and a store.
const OPERATORS: [&str; 9] = ["MOVE", "ADD", "SUB", "MUL", "DIV", "MOD", "AND", "OR", "XOR"];
