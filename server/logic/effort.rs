//! How much work many proofs may be.
//!
//! Effort is counted in nodes of decision diagrams, not in time, so that the answers are the same on every machine.

use super::{Formulas, Types};
use std::sync::Arc;

/// A question alone may be so much work: some tenths of a second.
pub(super) const QUESTION: usize = 1_000_000;

/// The proofs of all rungs of a program may be so much work: a second or two.
const PROGRAM: usize = 8_000_000;

/// Effort that many questions share.
#[derive(Debug)]
pub struct Effort {
    left: usize,
    most: usize,
    types: Arc<Types>,
    is_straight: bool,
}

impl Effort {
    /// So much in all, and `most` for each question.
    pub fn of(all: usize, most: usize) -> Effort {
        Effort { left: all, most, types: Arc::default(), is_straight: false }
    }

    /// For all the proofs of a program.
    pub fn of_program() -> Effort {
        Effort::of(PROGRAM, QUESTION)
    }

    /// The questions to come are about variables of these types.
    pub fn know(&mut self, types: Types) {
        self.types = Arc::new(types);
    }

    /// The questions to come are about programs without jumps, loops and the like: each contact is executed once in
    /// each scan, from the first on.
    pub fn know_straight(&mut self) {
        self.is_straight = true;
    }

    /// What is left.
    pub fn left(&self) -> usize {
        self.left
    }

    /// The answer of `question`, whose work is taken off.
    pub fn ask<T>(&mut self, question: impl FnOnce(&mut Formulas) -> T) -> T {
        let given = self.left.min(self.most);
        let formulas = Formulas::limited(given).with_types(self.types.clone());
        let mut formulas = if self.is_straight { formulas.straight() } else { formulas };
        let answer = question(&mut formulas);
        self.left -= given - formulas.effort();
        answer
    }
}
