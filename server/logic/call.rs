//! Calls of function blocks on the power line, and under a condition.

use super::{Callee, Term};
use crate::target::Operand;
use crate::target::iec::{EN, ENO};
use smol_str::format_smolstr;
use std::fmt;

/// A call of a function block: power drives an input, and goes on from the first output that is a bit. Or power enables
/// the call, `EN` of a box and `CALC` of instruction list: without it nothing of the instance changes.
///
/// The terms of its action are the instance, then the operands of the other inputs and outputs in the order of their
/// declaration, as far as they have any; ENO is the last of the outputs.
#[derive(Clone, PartialEq)]
pub struct Call {
    /// The block.
    pub block: Callee,
    /// The place of the input that power drives, mostly the first; another one where an input operator such as `R C1`
    /// calls the block, and nothing where power enables the call.
    power: Option<u16>,
    /// The places of the parameters that have operands, in order: inputs, then outputs, then ENO.
    given: Vec<u16>,
}

/// An input or an output of a call with its operand.
#[derive(Clone, Debug)]
pub struct Argument<'c> {
    /// The formal name, as declared; upper case in the standard.
    pub name: &'c str,
    /// Whether it is an output.
    pub is_output: bool,
    /// Whether the block may change the operand: an output, or a VAR_IN_OUT.
    pub is_changed: bool,
    /// What is written to the input, or where the output is written to.
    pub term: Term,
}

impl fmt::Debug for Call {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}.{}/{:?}", self.block, self.power_in(), self.given)
    }
}

impl Call {
    /// A call of `instance` with its terms in order, where power drives the input called `power`, or `EN`. `arguments`
    /// gives for each other parameter its formal name in any letter case, whether it is an output, and its operand.
    /// Nothing if the block has no such parameter, or one is there twice, or power drives it.
    pub fn new(
        block: Callee,
        power: &str,
        instance: Term,
        arguments: impl IntoIterator<Item = (impl AsRef<str>, bool, Term)>,
    ) -> Option<(Call, Vec<Term>)> {
        let is_enabled = power.eq_ignore_ascii_case(EN.name);
        let (inputs, outputs) = (block.inputs(), block.outputs());
        let own = inputs.iter().position(|formal| formal.is_called(power));
        let power = if is_enabled { None } else { Some(u16::try_from(own?).ok()?) };
        let mut placed: Vec<(u16, Term)> = Vec::new();
        for (name, is_output, term) in arguments {
            let name = name.as_ref();
            let place = match is_output {
                true if name.eq_ignore_ascii_case(ENO.name) => inputs.len() + outputs.len(),
                true => inputs.len() + outputs.iter().position(|formal| formal.is_called(name))?,
                false => inputs.iter().position(|formal| formal.is_called(name))?,
            };
            let place = u16::try_from(place).ok()?;
            if power == Some(place) || placed.iter().any(|(other, _)| *other == place) {
                return None;
            }
            placed.push((place, term));
        }
        placed.sort_by_key(|(place, _)| *place);
        let (given, operands): (Vec<u16>, Vec<Term>) = placed.into_iter().unzip();
        let terms = std::iter::once(instance).chain(operands).collect();
        Some((Call { block, power, given }, terms))
    }

    /// The input that power drives.
    pub fn power_in(&self) -> &str {
        match self.power {
            None => EN.name,
            Some(place) => self.block.inputs().get(usize::from(place)).map_or("", |formal| formal.name),
        }
    }

    /// Whether power enables the call and drives none of the block's own inputs.
    pub fn is_enabled(&self) -> bool {
        self.power.is_none()
    }

    /// Whether power enables the call and ENO is written to an operand, which happens without power, too: then `CALC`,
    /// which does nothing without power, is not the same.
    pub fn tells_enable(&self) -> bool {
        let places = self.block.inputs().len() + self.block.outputs().len();
        self.is_enabled() && self.given.last().is_some_and(|last| usize::from(*last) == places)
    }

    /// Whether an input operator of instruction list is the whole of it: `R C1`.
    pub fn is_input_operator(&self) -> bool {
        let Callee::Block(block) = self.block else { return false };
        self.power != Some(0) && self.given.is_empty() && block.has_input_operator(self.power_in())
    }

    /// The output from which power goes on; empty if there is none.
    pub fn power_out(&self) -> &str {
        self.block.power_out().unwrap_or_default()
    }

    /// The variable from which power goes on: `T1.Q` for the instance `T1`; nothing behind a call that power enables.
    pub fn output(&self, terms: &[Term]) -> Option<Term> {
        if self.is_enabled() {
            return None;
        }
        Some(member(terms.first()?, self.block.power_out()?))
    }

    /// What a call may change: the members of the instance, and the variables that outputs are written to or that are
    /// handed over to be changed. What a block of the program does beyond that is not among it.
    pub fn changes(&self, terms: &[Term]) -> Vec<Term> {
        let Some(instance) = terms.first() else { return Vec::new() };
        let (inputs, outputs) = (self.block.inputs(), self.block.outputs());
        let members = inputs.iter().chain(&outputs).map(|formal| member(instance, formal.name));
        let changed = self.arguments(terms).into_iter().filter(|argument| argument.is_changed);
        members.chain(changed.map(|argument| argument.term)).collect()
    }

    /// The inputs of the instance that keep the values they have from elsewhere: neither power nor an operand tells
    /// them.
    pub fn kept_inputs(&self, terms: &[Term]) -> Vec<Term> {
        let Some(instance) = terms.first() else { return Vec::new() };
        let is_told = |place: u16| self.power == Some(place) || self.given.contains(&place);
        let inputs = (0..).zip(self.block.inputs()).filter(|(place, _)| !is_told(*place));
        inputs.map(|(_, formal)| member(instance, formal.name)).collect()
    }

    /// Whether something is left to the block that an earlier call handed over, so that nobody knows what it changes.
    pub fn keeps_in_out(&self) -> bool {
        let mut inputs = (0..).zip(self.block.inputs());
        inputs.any(|(place, formal)| formal.is_in_out && !self.given.contains(&place))
    }

    /// The inputs and outputs with operands, where `terms` are those of the action.
    pub fn arguments(&self, terms: &[Term]) -> Vec<Argument<'_>> {
        let (inputs, outputs) = (self.block.inputs(), self.block.outputs());
        let argument = |(place, term): (&u16, &Term)| {
            let place = usize::from(*place);
            let is_output = place >= inputs.len();
            let formal = inputs.get(place).or_else(|| outputs.get(place - inputs.len()));
            let is_changed = is_output || formal.is_some_and(|formal| formal.is_in_out);
            let name = formal.map_or(ENO.name, |formal| formal.name);
            Argument { name, is_output, is_changed, term: term.clone() }
        };
        self.given.iter().zip(terms.iter().skip(1)).map(argument).collect()
    }
}

/// `instance.name`
pub(super) fn member(instance: &Term, name: &str) -> Term {
    let name = format_smolstr!("{}.{name}", instance.text);
    Term { storage: instance.storage, ..Term::new(Operand::Variable, &name, instance.span) }
}
