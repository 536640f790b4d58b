//! Whether a scan comes to a difference that was found behind a label, a jump or a rung that cannot be read.
//!
//! Formulas know nothing of what comes before these. So the difference counts only if both programs show it when they
//! are run from the start of the unit, jumps and all.

use super::source::Source;
use crate::logic::{Action, Deed, Path, Place, Rung, Scan, State, Term, evaluate_jumping};
use crate::target::Flow;
use smol_str::SmolStr;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Rungs that are executed in one scan.
pub(super) struct Unit<'s> {
    rungs: Vec<&'s Rung>,
    /// How many of them there are up to the difference.
    ahead: usize,
    /// Their numbers among all.
    pub(super) numbers: Range<usize>,
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
        let rungs: Vec<&Rung> = rungs.map(|source| &source.rung).collect();
        let numbers = start..start + rungs.len();
        Unit { rungs, ahead: end.saturating_sub(start), numbers }
    }

    /// What its rungs do, as far as they can be read.
    pub(super) fn paths(&self) -> Vec<&'s Path> {
        self.rungs.iter().filter_map(|rung| rung.path.as_ref().ok()?.as_ref()).collect()
    }

    /// The bits that decide about jumps, by their keys.
    fn switches(&self) -> Vec<SmolStr> {
        let jumps = self.paths().into_iter().filter(|path| path.actions().into_iter().any(leaves));
        jumps.flat_map(Path::terms).filter(|term| term.is_lone()).map(Term::key).collect()
    }

    /// The bits by themselves that coils drive.
    fn driven(&self) -> Vec<Term> {
        let coils = self
            .paths()
            .into_iter()
            .flat_map(Path::actions)
            .filter(|action| matches!(action.deed, Deed::Coil(_)));
        coils.filter_map(|action| action.terms.first()).filter(|term| term.is_lone()).cloned().collect()
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
pub(super) fn leaves(action: &Action) -> bool {
    match &action.deed {
        Deed::Jump | Deed::Return => true,
        Deed::Instruction(form) => form.instruction.flow() == Flow::Jump,
        _ => false,
    }
}

/// Whether the main program of the FX family ends with a rung, so that what follows is called.
pub(super) fn ends_main(source: &Source) -> bool {
    has_flow(source, |flow| flow == Flow::MainEnd)
}

/// Whether a routine of the FX family ends with a rung.
fn ends_routine(source: &Source) -> bool {
    has_flow(source, |flow| matches!(flow, Flow::MainEnd | Flow::SubroutineEnd | Flow::InterruptEnd))
}

/// Whether a rung has an instruction that leads on in such a way.
pub(super) fn has_flow(source: &Source, is_such: impl Fn(Flow) -> bool) -> bool {
    let actions = source.rung.path.iter().flatten().flat_map(Path::actions);
    actions.into_iter().any(|action| match &action.deed {
        Deed::Instruction(form) => is_such(form.instruction.flow()),
        _ => false,
    })
}

/// `state`, or the one near to it from which a scan comes to the difference at `place` that both programs show if they
/// run from it; nothing if none does.
pub(super) fn reached(units: &[Unit<'_>; 2], state: &State, place: &Place) -> Option<State> {
    let differs = |[left, right]: [Scan<'_>; 2]| match place {
        Place::Bit(key) => left.bit(key) != right.bit(key),
        Place::Event(_) => left.events != right.events,
    };
    if units.iter().all(Unit::is_straight) {
        return Some(state.clone());
    }
    starts(units, state).into_iter().find(|start| scans(units, start).is_some_and(differs))
}

/// A bit that both programs drive, one of them to another value, in a scan that begins in `state` or in one near to it,
/// with that state and the values.
pub(super) fn found(units: &[Unit<'_>; 2], state: &State) -> Option<(Term, State, [bool; 2])> {
    let mut bits: Vec<Term> = units.iter().flat_map(Unit::driven).collect();
    bits.sort_by_cached_key(Term::key);
    bits.dedup();
    starts(units, state).into_iter().find_map(|start| {
        let ends = scans(units, &start)?;
        bits.iter().find_map(|bit| {
            let values = ends.each_ref().map(|scan| scan.bit(&bit.key()));
            (values[0] != values[1]).then(|| (bit.clone(), start.clone(), values))
        })
    })
}

fn scans<'s>(units: &[Unit<'_>; 2], state: &'s State) -> Option<[Scan<'s>; 2]> {
    let [left, right] = units.each_ref().map(|unit| evaluate_jumping(&unit.rungs, state));
    Some([left?, right?])
}

/// States like `state` with which a scan may begin. What lay behind a jump may as well have been so from the start, and
/// whether jumps are taken, a difference may leave open.
fn starts(units: &[Unit<'_>; 2], state: &State) -> Vec<State> {
    let mut start = State { left_behind: BTreeMap::new(), ..state.clone() };
    for left in state.left_behind.values() {
        start.bits.extend(left.bits.iter().map(|(key, value)| (key.clone(), *value)));
        start.words.extend(left.words.iter().map(|(key, value)| (key.clone(), *value)));
    }
    let switches: BTreeSet<SmolStr> = units.iter().flat_map(Unit::switches).collect();
    let turned = switches.into_iter().take(SWITCHES_MAX).map(|key| {
        let mut turned = start.clone();
        let bit = turned.bits.entry(key).or_default();
        *bit = !*bit;
        turned
    });
    let turned: Vec<State> = turned.collect();
    std::iter::once(start).chain(turned).collect()
}

/// So many bits that decide about jumps are tried with the other value.
const SWITCHES_MAX: usize = 16;
