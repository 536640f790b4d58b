//! Whether two stretches of program do the same.

use super::decide::{Verdict, equal};
use super::{Formulas, Path, Run};
use std::collections::BTreeMap;

/// What comes of a comparison.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Comparison {
    /// The same is done to the same devices in the same order, under equal conditions.
    Same {
        /// Whether only bits are driven; else there are actions of which nothing is known but that both sides have
        /// them, with the same operands.
        is_boolean: bool,
    },
    /// Both do the same to the same devices in the same order, but not under the same conditions.
    Different {
        /// The number of the effect whose conditions differ.
        effect: usize,
        /// Values of atoms for which they do, by the number of the atom.
        values: BTreeMap<u32, bool>,
    },
    /// They do not the same things in the same order.
    Unlike {
        /// The number of the first effect that differs.
        effect: usize,
    },
    /// Too large a question.
    Undecided,
}

/// Compares what is done by paths run one after the other from the same state, step by step.
pub fn compare(left: &[&Path], right: &[&Path], formulas: &mut Formulas) -> Comparison {
    let [left, right] = [left, right].map(|paths| {
        let mut run = Run::new();
        paths.iter().for_each(|path| run.path(path, formulas));
        run
    });
    let pairs = left.effects.iter().zip(&right.effects);
    let unlike = pairs.clone().position(|(left, right)| !left.is_like(right));
    let lengths = [left.effects.len(), right.effects.len()];
    if let Some(effect) = unlike.or((lengths[0] != lengths[1]).then(|| lengths[0].min(lengths[1]))) {
        return Comparison::Unlike { effect };
    }
    for (effect, (left, right)) in pairs.enumerate() {
        match equal(formulas, left.guard, right.guard) {
            Verdict::Equal => {}
            Verdict::Different(values) => return Comparison::Different { effect, values },
            Verdict::Undecided => return Comparison::Undecided,
        }
    }
    Comparison::Same { is_boolean: left.is_boolean() }
}
