//! Calculations with words, which IEC 61131-3 writes as functions, and calls of functions that the program declares.

use super::{Callee, Formal, Term};
use crate::document::Scopes;
use crate::target::Operand;
use crate::target::iec::Function;

use std::fmt;

/// A function whose result is stored: one of the standard with one or two words, or one of the program. The terms of
/// its action are its inputs, then the result.
///
/// Two are equal if they make the same of the same inputs: bits are joined alike in patterns and in numbers.
#[derive(Clone)]
pub struct Computation {
    /// The function.
    pub function: Callee,
    /// What is done with its inputs before, and with its result.
    pub conversion: Conversion,
}

/// How a calculation converts variables; literals are what they have to be.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Conversion {
    /// Not at all.
    #[default]
    None,
    /// Numbers are made patterns of bits, and the result a number again: `INT_TO_WORD`, `WORD_TO_INT`.
    Patterns {
        /// Whether they have 32 bits: `DINT_TO_DWORD`, `DWORD_TO_DINT`.
        wide: bool,
    },
    /// Numbers of 16 bits get 32, which those of the product are then: `INT_TO_DINT`.
    Widened,
}

impl PartialEq for Computation {
    fn eq(&self, other: &Computation) -> bool {
        self.function == other.function && self.widens() == other.widens()
    }
}

impl fmt::Debug for Computation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}", self.name(), self.conversion)
    }
}

impl Computation {
    /// The output for the result, which the standard gives no name.
    pub const RESULT: &'static str = "OUT";

    /// That of the standard function called `name`, letter case aside; nothing for functions of other shapes.
    pub fn named(name: &str) -> Option<Computation> {
        let function = Function::named(name).filter(|function| OPERATORS.contains(&function.name))?;
        Some(Computation { function: Callee::Function(function), conversion: Conversion::None })
    }

    /// That of the function called `name` which the program declares.
    pub fn declared(name: &str, scopes: &Scopes) -> Option<Computation> {
        let function = Callee::declared_function(name, scopes)?;
        Some(Computation { function, conversion: Conversion::None })
    }

    /// The same with its operands converted; nothing if that makes no sense of the function.
    pub fn converted(self, conversion: Conversion) -> Option<Computation> {
        let makes_sense = match conversion {
            Conversion::None => true,
            Conversion::Patterns { .. } => self.is_bitwise(),
            Conversion::Widened => self.standard() == Some("MUL"),
        };
        makes_sense.then_some(Computation { conversion, ..self })
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

    /// The name of a function of the standard; nothing if the program declares it.
    pub fn standard(&self) -> Option<&'static str> {
        match self.function {
            Callee::Function(function) => Some(function.name),
            _ => None,
        }
    }

    /// Whether it only copies a word.
    pub fn copies(&self) -> bool {
        self.standard() == Some("MOVE")
    }

    /// Whether it joins or inverts the bits of words, and single bits as well.
    pub fn is_bitwise(&self) -> bool {
        matches!(self.standard(), Some("AND" | "OR" | "XOR" | "NOT"))
    }

    /// Whether its result has twice the bits of its inputs.
    pub fn widens(&self) -> bool {
        self.conversion == Conversion::Widened
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

impl Conversion {
    /// The function that an input goes through, if it does through any.
    pub fn of_input(self, input: &Term) -> Option<&'static str> {
        let is_literal = matches!(input.operand, Operand::Literal(_));
        match self {
            _ if is_literal => None,
            Conversion::None => None,
            Conversion::Patterns { wide: false } => Some("INT_TO_WORD"),
            Conversion::Patterns { wide: true } => Some("DINT_TO_DWORD"),
            Conversion::Widened => Some("INT_TO_DINT"),
        }
    }

    /// The function that the result goes through.
    pub fn of_result(self) -> Option<&'static str> {
        match self {
            Conversion::None | Conversion::Widened => None,
            Conversion::Patterns { wide: false } => Some("WORD_TO_INT"),
            Conversion::Patterns { wide: true } => Some("DWORD_TO_DINT"),
        }
    }

    /// The types of the inputs and of the result, where it tells them.
    pub fn types(self) -> Option<[&'static str; 2]> {
        match self {
            Conversion::None => None,
            Conversion::Patterns { wide: false } => Some(["INT", "INT"]),
            Conversion::Patterns { wide: true } => Some(["DINT", "DINT"]),
            Conversion::Widened => Some(["INT", "DINT"]),
        }
    }

    /// The conversion that begins with a function, letter case aside: what inputs go through.
    pub fn named(function: &str) -> Option<Conversion> {
        let input = Term::new(Operand::Variable, "", Default::default());
        let is_own =
            |own: &Conversion| own.of_input(&input).is_some_and(|name| name.eq_ignore_ascii_case(function));
        Conversion::ALL.into_iter().find(is_own)
    }

    /// The conversion that ends with a function, letter case aside: what the result goes through.
    pub fn of_result_named(function: &str) -> Option<Conversion> {
        let is_own =
            |own: &Conversion| own.of_result().is_some_and(|name| name.eq_ignore_ascii_case(function));
        Conversion::ALL.into_iter().find(is_own)
    }

    const ALL: [Conversion; 3] =
        [Conversion::Patterns { wide: false }, Conversion::Patterns { wide: true }, Conversion::Widened];
}

/// The functions that instruction list has as operators, and the copy, which it writes as a load and a store.
const OPERATORS: [&str; 10] = ["MOVE", "ADD", "SUB", "MUL", "DIV", "MOD", "AND", "OR", "XOR", "NOT"];
