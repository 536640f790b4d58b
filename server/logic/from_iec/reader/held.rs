//! Power that a helper keeps.

use super::{Reader, Value};
use crate::il::iec::{ItemKind, OperandId};
use crate::logic::Refusal;
use crate::target::iec::OperatorRole;
use crate::text::folded;

impl Reader<'_, '_> {
    /// Keeps the power in a helper that a load in the same rung gives back; tells whether it was that.
    pub(super) fn holds(&mut self, id: OperandId, negated: bool) -> Result<bool, Refusal> {
        let name = folded(self.source.tree.operand(id).span.of(self.source.text));
        if negated || !self.source.is_helper(self.pou, &name) || !self.is_loaded_later(&name) {
            return Ok(false);
        }
        self.invert()?;
        self.builder.keep();
        self.held.insert(name, self.builder.place());
        Ok(true)
    }

    /// Goes back to the power that a helper keeps; tells whether it was that.
    pub(super) fn goes_back(&mut self, id: OperandId) -> Result<bool, Refusal> {
        let name = folded(self.source.tree.operand(id).span.of(self.source.text));
        let ItemKind::Operation { operation, .. } = self.source.item(self.at).kind else { return Ok(false) };
        let Some(place) = self.held.get(&name).copied().filter(|_| !operation.negated) else {
            return Ok(false);
        };
        let for_good = !self.is_loaded_later(&name);
        if for_good {
            self.held.remove(&name);
        }
        if matches!(self.value, Value::Loaded(..) | Value::Block(_)) {
            return Err(Refusal::WithoutOutput);
        }
        self.builder.back_to(place, for_good).ok_or(Refusal::WithoutOutput)?;
        self.is_inverted = false;
        self.value = Value::Power;
        Ok(true)
    }

    /// Whether the next mention of a helper in the rung loads it.
    fn is_loaded_later(&self, name: &str) -> bool {
        let rest = (self.at + 1..self.end).map(|index| self.source.item(index));
        let mut mentions = rest.filter_map(|item| match item.kind {
            ItemKind::Operation { operation, operand: Some(id) } => {
                let operand = self.source.tree.operand(id).span.of(self.source.text);
                operand.eq_ignore_ascii_case(name).then_some((operation, item.depth))
            }
            _ => None,
        });
        mentions.next().is_some_and(|(operation, depth)| {
            operation.operator.role == OperatorRole::Load && !operation.negated && depth == 0
        })
    }
}
