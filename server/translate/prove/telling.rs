//! What is told of a difference: that it is one, or that it may be one.

use super::super::counterexample::Counterexample;
use super::super::reached;
use super::{Proof, Prover};
use crate::il::iec::PouKind;
use crate::target::{DeviceKind, Model, Operand};
use crate::text::{Message, Span};

impl Prover<'_> {
    /// A proof that there is this difference, unless only running both programs can tell: a master control or a step
    /// may leave out what differs, who calls a unit may never do it so, a constant has one value.
    pub(super) fn told(&self, found: Counterexample) -> Proof {
        let doubt = match () {
            () if self.may_be_off => Some("prove.left-out"),
            () if (0..2).any(|side| self.is_called(side, found.at[side])) => Some("prove.called"),
            () if found.inputs.keys().any(|name| self.is_constant(name)) => Some("prove.unconfirmed"),
            // It counts how often its power comes, not how long it stays.
            () if is_counter(&found.what) => Some("prove.unconfirmed"),
            () => None,
        };
        let (at, found) = (found.at, Box::new(found));
        match doubt {
            Some(key) => Proof::Undecided { reason: Message::new(key), at, suspect: Some(found) },
            None => Proof::Different(found),
        }
    }

    /// Whether the rung at a place belongs to a routine or a unit that others call.
    fn is_called(&self, side: usize, at: Option<Span>) -> bool {
        let all = self.all[side];
        let number = at.and_then(|at| all.iter().position(|source| source.span() == at));
        let Some(number) = number else { return false };
        let unit = all[number].pou.and_then(|pou| self.scopes[side].pous.get(pou));
        unit.is_some_and(|unit| unit.kind != PouKind::Program) || all[..number].iter().any(reached::ends_main)
    }

    /// Whether a variable of either program is one that never changes.
    fn is_constant(&self, name: &str) -> bool {
        self.scopes.iter().any(|scopes| scopes.is_constant(name))
    }
}

/// That two sides do not the same, where they part.
pub(super) fn unlike(sides: [Option<String>; 2]) -> Message {
    match sides {
        [Some(left), Some(right)] if left != right => {
            Message::new("prove.unlike").with("left", left).with("right", right)
        }
        [Some(what), None] | [None, Some(what)] => Message::new("prove.one-side").with("what", what),
        _ => Message::new("prove.otherwise"),
    }
}

/// Whether a name is that of a counter of the FX family.
fn is_counter(name: &str) -> bool {
    matches!(Operand::read(name, Model::Fx3u), Operand::Device(device) if device.kind == DeviceKind::C)
}
