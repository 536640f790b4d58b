//! Calls of function blocks on the power line, and under a condition.

use super::Term;
use crate::target::Operand;
use crate::target::iec::{EN, FunctionBlock};
use smol_str::format_smolstr;
use std::fmt;

/// A call of a standard function block: power drives an input, and goes on from its first output. Or power enables the
/// call, `EN` of a box and `CALC` of instruction list: without it nothing of the instance changes.
///
/// The terms of its action are the instance, then the operands of the other inputs and outputs in the order of their
/// declaration, as far as they have any.
#[derive(Clone, Copy)]
pub struct Call {
    /// The block.
    pub block: &'static FunctionBlock,
    /// The place of the input that power drives, mostly the first; another one where an input operator such as `R C1`
    /// calls the block, and [`Call::ENABLE`] where it enables the call.
    power: u8,
    /// Which pins have operands: a bit for each input in order, then one for each output.
    given: u32,
}

/// An input or an output of a call with its operand.
#[derive(Clone, Debug)]
pub struct Argument {
    /// The formal name, upper case.
    pub name: &'static str,
    /// Whether it is an output.
    pub is_output: bool,
    /// What is written to the input, or where the output is written to.
    pub term: Term,
}

impl PartialEq for Call {
    fn eq(&self, other: &Call) -> bool {
        (self.block.name, self.power, self.given) == (other.block.name, other.power, other.given)
    }
}

impl fmt::Debug for Call {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}/{:b}", self.block.name, self.power_in(), self.given)
    }
}

impl Call {
    /// The place of EN, which is before all inputs of its own that a block can have.
    const ENABLE: u8 = u8::MAX;

    /// A call of `instance` with its terms in order, where power drives the input called `power`, or `EN`. `arguments`
    /// gives for each other pin its formal name in any letter case, whether it is an output, and its operand. Nothing
    /// if the block has no such pin, or one is there twice, or power drives it.
    pub fn new(
        block: &'static FunctionBlock,
        power: &str,
        instance: Term,
        arguments: impl IntoIterator<Item = (impl AsRef<str>, bool, Term)>,
    ) -> Option<(Call, Vec<Term>)> {
        let is_enabled = power.eq_ignore_ascii_case(EN.name);
        let own = block.inputs.iter().position(|pin| pin.name.eq_ignore_ascii_case(power));
        let power = if is_enabled { Call::ENABLE } else { u8::try_from(own?).ok()? };
        let mut call = Call { block, power, given: 0 };
        let mut placed: Vec<(usize, Term)> = Vec::new();
        for (name, is_output, term) in arguments {
            let pins = if is_output { block.outputs } else { block.inputs };
            let number = pins.iter().position(|pin| pin.name.eq_ignore_ascii_case(name.as_ref()))?;
            if number == usize::from(power) && !is_output {
                return None;
            }
            let place = number + if is_output { block.inputs.len() } else { 0 };
            if call.given & 1 << place != 0 {
                return None;
            }
            call.given |= 1 << place;
            placed.push((place, term));
        }
        placed.sort_by_key(|(place, _)| *place);
        let terms = std::iter::once(instance).chain(placed.into_iter().map(|(_, term)| term)).collect();
        Some((call, terms))
    }

    /// The input that power drives.
    pub fn power_in(self) -> &'static str {
        match self.is_enabled() {
            true => EN.name,
            false => self.block.inputs.get(self.power as usize).map_or("", |pin| pin.name),
        }
    }

    /// Whether power enables the call and drives none of the block's own inputs.
    pub fn is_enabled(self) -> bool {
        self.power == Call::ENABLE
    }

    /// Whether an input operator of instruction list is the whole of it: `R C1`.
    pub fn is_input_operator(self) -> bool {
        self.power != 0 && self.given == 0 && self.block.has_input_operator(self.power_in())
    }

    /// The output from which power goes on.
    pub fn power_out(self) -> &'static str {
        self.block.outputs.first().map_or("", |pin| pin.name)
    }

    /// The variable from which power goes on: `T1.Q` for the instance `T1`; nothing behind a call that power enables.
    pub fn output(self, terms: &[Term]) -> Option<Term> {
        if self.is_enabled() {
            return None;
        }
        Some(member(terms.first()?, self.power_out()))
    }

    /// What a call may change: the members of the instance, and the variables that outputs are written to.
    pub fn changes(self, terms: &[Term]) -> Vec<Term> {
        let Some(instance) = terms.first() else { return Vec::new() };
        let pins = self.block.inputs.iter().chain(self.block.outputs);
        let members = pins.map(|pin| member(instance, pin.name));
        let outputs = self.arguments(terms).into_iter().filter(|argument| argument.is_output);
        members.chain(outputs.map(|argument| argument.term)).collect()
    }

    /// The inputs and outputs with operands, where `terms` are those of the action.
    pub fn arguments(self, terms: &[Term]) -> Vec<Argument> {
        let inputs = self.block.inputs.iter().map(|pin| (pin.name, false));
        let pins = inputs.chain(self.block.outputs.iter().map(|pin| (pin.name, true)));
        let given = pins.enumerate().filter(|(place, _)| self.given & 1 << place != 0);
        let operands = terms.iter().skip(1);
        given
            .zip(operands)
            .map(|((_, (name, is_output)), term)| Argument { name, is_output, term: term.clone() })
            .collect()
    }
}

/// `instance.name`
pub(super) fn member(instance: &Term, name: &str) -> Term {
    let name = format_smolstr!("{}.{name}", instance.text);
    Term { storage: instance.storage, ..Term::new(Operand::Variable, &name, instance.span) }
}
