//! Whether a scan comes to a difference that was found behind a label, a jump or a rung that cannot be read.
//!
//! Formulas know nothing of what comes before these. So the difference counts only if both programs show it when they
//! are run from the start of the unit, jumps and all.

use super::source::Source;
use crate::logic::{Action, Deed, Path, Place, Rung, State, Term, evaluate_jumping};
use crate::target::Flow;
use smol_str::SmolStr;
use std::collections::BTreeSet;

/// Rungs that are executed in one scan.
pub(super) struct Unit<'s> {
    rungs: Vec<&'s Rung>,
    /// How many of them there are up to the difference.
    ahead: usize,
}

impl<'s> Unit<'s> {
    /// Those of `all` around the ones from number `first` to `end`: of the same program unit, and of the same routine
    /// where the FX family has several.
    pub(super) fn around(all: &'s [Source], first: usize, end: usize) -> Unit<'s> {
        let unit = all.get(first).or(all.last()).and_then(|source| source.pou);
        let is_other = |source: &Source| source.pou != unit || ends_routine(source);
        let before = &all[..first.min(all.len())];
        let start = before.iter().rposition(is_other).map_or(0, |last| last + 1);
        let rungs = all[start..].iter().take_while(|source| source.pou == unit);
        Unit { rungs: rungs.map(|source| &source.rung).collect(), ahead: end.saturating_sub(start) }
    }

    /// The bits that decide about jumps, by their keys.
    fn switches(&self) -> Vec<SmolStr> {
        let paths = self.rungs.iter().filter_map(|rung| rung.path.as_ref().ok()?.as_ref());
        let jumps = paths.filter(|path| path.actions().into_iter().any(leaves));
        jumps.flat_map(Path::terms).filter(|term| term.is_lone()).map(Term::key).collect()
    }

    /// Whether all rungs up to the difference are executed, one after the other.
    fn is_straight(&self) -> bool {
        let ahead = &self.rungs[..self.ahead.min(self.rungs.len())];
        let is_open = |rung: &&Rung| !rung.labels.is_empty() || rung.path.is_err();
        let jumps = |rung: &&Rung| {
            let actions = rung.path.iter().flatten().flat_map(Path::actions);
            actions.into_iter().any(leaves)
        };
        let before = ahead.split_last().map_or(ahead, |(_, before)| before);
        !ahead.iter().skip(1).any(is_open) && !before.iter().any(jumps)
    }
}

/// Whether something else than the next rung may come behind an action.
fn leaves(action: &Action) -> bool {
    match &action.deed {
        Deed::Jump | Deed::Return => true,
        Deed::Instruction(form) => form.instruction.flow() == Flow::Jump,
        _ => false,
    }
}

/// Whether a routine of the FX family ends with a rung.
fn ends_routine(source: &Source) -> bool {
    let actions = source.rung.path.iter().flatten().flat_map(Path::actions);
    actions.into_iter().any(|action| match &action.deed {
        Deed::Instruction(form) => {
            matches!(form.instruction.flow(), Flow::MainEnd | Flow::SubroutineEnd | Flow::InterruptEnd)
        }
        _ => false,
    })
}

/// Whether a scan from `state` comes to the difference at `place`, which both programs show if they run from it.
pub(super) fn is_reached(units: [Unit<'_>; 2], state: &State, place: &Place) -> bool {
    if units.iter().all(Unit::is_straight) {
        return true;
    }
    // What lay behind a jump may as well have been so from the start.
    let mut start = State { left_behind: Default::default(), ..state.clone() };
    for left in state.left_behind.values() {
        start.bits.extend(left.bits.iter().map(|(key, value)| (key.clone(), *value)));
        start.words.extend(left.words.iter().map(|(key, value)| (key.clone(), *value)));
    }
    let differs = |state: &State| {
        let scans = units.each_ref().map(|unit| evaluate_jumping(&unit.rungs, state));
        let [Some(left), Some(right)] = scans else { return false };
        match place {
            Place::Bit(key) => left.bit(key) != right.bit(key),
            Place::Event(_) => left.events != right.events,
        }
    };
    // Whether jumps are taken, the difference itself may leave open.
    let switches: BTreeSet<SmolStr> = units.iter().flat_map(Unit::switches).collect();
    let turned = switches.into_iter().take(SWITCHES_MAX).map(|key| {
        let mut turned = start.clone();
        let bit = turned.bits.entry(key).or_default();
        *bit = !*bit;
        turned
    });
    differs(&start) || turned.collect::<Vec<_>>().iter().any(differs)
}

/// So many bits that decide about jumps are tried with the other value.
const SWITCHES_MAX: usize = 16;
