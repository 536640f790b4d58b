//! Conditions in the making, as lists write them.

use super::{Contact, Expression, Refusal};
use crate::target::Role;

/// A block that waits to be joined.
pub(super) struct Block {
    pub(super) condition: Expression,
    /// At least as deep as `condition` nests.
    depth: usize,
}

impl Block {
    pub(super) fn of(contact: Contact) -> Block {
        Block { condition: Expression::Contact(contact), depth: 1 }
    }

    pub(super) fn invert(&mut self) -> Result<(), Refusal> {
        self.depth += 1;
        if self.depth > Expression::DEPTH_MAX {
            return Err(Refusal::TooDeep);
        }
        let condition = std::mem::replace(&mut self.condition, Expression::Constant(true));
        self.condition = Expression::Not(Box::new(condition));
        Ok(())
    }

    pub(super) fn join(&mut self, other: Block, role: Role) -> Result<(), Refusal> {
        let is_nested = match role {
            Role::Series | Role::BlockSeries => !matches!(self.condition, Expression::And(_)),
            _ => !matches!(self.condition, Expression::Or(_)),
        };
        self.depth = (self.depth + usize::from(is_nested)).max(other.depth + 1);
        if self.depth > Expression::DEPTH_MAX {
            return Err(Refusal::TooDeep);
        }
        match role {
            Role::Series | Role::BlockSeries => self.condition.and_with(other.condition),
            _ => self.condition.or_with(other.condition),
        }
        Ok(())
    }

    /// One of the two and not the other, in series and parallel. Both conditions are there twice.
    pub(super) fn exclude(&mut self, other: Block) -> Result<(), Refusal> {
        let sides = [&self.condition, &other.condition];
        if sides.iter().any(|side| side.contacts().len() > Block::EXCLUDED_MAX) {
            return Err(Refusal::NotBoolean);
        }
        self.depth = self.depth.max(other.depth) + 3;
        if self.depth > Expression::DEPTH_MAX {
            return Err(Refusal::TooDeep);
        }
        let [left, right] = sides.map(Expression::clone);
        let [not_left, not_right] = sides.map(Expression::negated);
        self.condition =
            Expression::or([Expression::and([left, not_right]), Expression::and([not_left, right])]);
        Ok(())
    }

    /// So many contacts may be on each side of XOR: a chain of four doubles to sixteen.
    const EXCLUDED_MAX: usize = 16;
}
