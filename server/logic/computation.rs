//! Calculations with words, which IEC 61131-3 writes as functions.

use super::Term;
use crate::target::Operand;
use crate::target::iec::Function;
use std::fmt;

/// A function of one or two words whose result is stored. The terms of its action are its inputs, then the result.
///
/// Two are equal if they make the same of the same inputs: bits are joined alike in patterns and in numbers.
#[derive(Clone, Copy)]
pub struct Computation {
    /// The function.
    pub function: &'static Function,
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
        self.function.name == other.function.name && self.widens() == other.widens()
    }
}

impl fmt::Debug for Computation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}", self.function.name, self.conversion)
    }
}

impl Computation {
    /// The output for the result, which the standard gives no name.
    pub const RESULT: &'static str = "OUT";

    /// That of the function called `name`, letter case aside; nothing for functions of other shapes.
    pub fn named(name: &str) -> Option<Computation> {
        let function = Function::named(name)?;
        OPERATORS.contains(&function.name).then_some(Computation { function, conversion: Conversion::None })
    }

    /// The same with its operands converted; nothing if that makes no sense of the function.
    pub fn converted(self, conversion: Conversion) -> Option<Computation> {
        let makes_sense = match conversion {
            Conversion::None => true,
            Conversion::Patterns { .. } => self.is_bitwise(),
            Conversion::Widened => self.function.name == "MUL",
        };
        makes_sense.then_some(Computation { conversion, ..self })
    }

    /// That which only copies a word.
    pub fn copies(self) -> bool {
        self.function.name == "MOVE"
    }

    /// Whether it joins or inverts the bits of words, and single bits as well.
    pub fn is_bitwise(self) -> bool {
        matches!(self.function.name, "AND" | "OR" | "XOR" | "NOT")
    }

    /// Whether its result has twice the bits of its inputs.
    pub fn widens(self) -> bool {
        self.conversion == Conversion::Widened
    }

    /// What is read, and what is written; nothing if these are not as many terms as it has.
    pub fn operands(self, terms: &[Term]) -> Option<(&[Term], &Term)> {
        let (result, inputs) = terms.split_last()?;
        (inputs.len() == self.function.inputs.len()).then_some((inputs, result))
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
