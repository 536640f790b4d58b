//! Rungs as they are run with plain values, and what is told of a difference that shows then.

use super::{Rungs, rung_of};
use crate::logic::State;
use crate::target::iec::ElementaryType;
use crate::translate::counterexample::{self, Counterexample, Inputs, Shown, Value};
use crate::translate::reached;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// What it takes to run rungs with plain values.
pub(super) struct Ground<'s> {
    /// The types that variables have, by their keys.
    pub(super) types: FxHashMap<SmolStr, ElementaryType>,
    /// What is executed in one scan, on either side.
    pub(super) units: [reached::Unit<'s>; 2],
}

impl Ground<'_> {
    pub(super) fn type_of(&self, key: &str) -> Option<ElementaryType> {
        self.types.get(key).copied()
    }

    /// The difference in `what`, which `sides` drive, as people are told it.
    pub(super) fn found(
        &self,
        (what, key, values): (String, SmolStr, [bool; 2]),
        state: &State,
        sides: [Rungs<'_, '_>; 2],
    ) -> Counterexample {
        let own = self.units.each_ref().map(|unit| unit.paths());
        let type_of = |key: &str| self.type_of(key);
        let Inputs { inputs, before, mut keys } = counterexample::inputs(state, [&own[0], &own[1]], &type_of);
        keys.insert(what.clone(), key);
        let at = sides.map(|side| rung_of(side, &what));
        let sides = values.map(Value::Bit);
        let shown = Shown::Untried;
        Counterexample { inputs, before, what, sides, at, keys, shown }
    }
}
