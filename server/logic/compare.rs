//! Whether two stretches of program do the same.

use super::decide::{Verdict, equal};
use super::{Action, Atom, Deed, Effect, Formula, Formulas, Path, Run, Term, is_within};
use crate::ladder::CoilKind;
use crate::target::{Device, DeviceKind, Flow};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;
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
    /// What one does differs from what the other does.
    Different {
        /// What differs: the bit, or the first operand of the action.
        what: String,
        /// Where to look for it in a run.
        place: Place,
        /// What it is on the left and on the right: the bit, or whether the action is done.
        sides: [bool; 2],
        /// Values of atoms for which they do, by the number of the atom.
        values: BTreeMap<u32, bool>,
    },
    /// They do not the same things in the same order: what comes on either side where they part, as people read it;
    /// nothing where a side is at its end, or where both have the same words and mean something else.
    Unlike([Option<String>; 2]),
    /// Too large a question.
    Undecided,
    /// They differ for values only that words need not have.
    Doubtful,
    /// This action finds other values on either side, and nobody knows what it makes of them.
    Open(String),
    /// Contacts for edges of this relay, which gives each edge to one of them, are not executed alike.
    AsksOtherwise(SmolStr),
}

/// What differs between two runs.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Place {
    /// The bit with this key, at the end or where it is driven.
    Bit(SmolStr),
    /// The power of the event of this number, from 1.
    Event(u32),
}

/// Compares what is done by paths run one after the other from the same state, step by step: the same things in the
/// same order under equal conditions.
pub fn compare(left: &[&Path], right: &[&Path], formulas: &mut Formulas) -> Comparison {
    compare_but(left, right, &FxHashSet::default(), formulas)
}

/// The same, where the right side may have coils of further bits of its own, `helpers` by their keys.
pub fn compare_but(
    left: &[&Path],
    right: &[&Path],
    helpers: &FxHashSet<SmolStr>,
    formulas: &mut Formulas,
) -> Comparison {
    let [left, mut right] = [left, right].map(|paths| run(Run::new(), paths, formulas));
    if !helpers.is_empty() {
        right.effects.retain(|effect| {
            let [term] = &effect.action.terms[..] else { return true };
            let is_driven = effect.event.is_none() && effect.deed() == Deed::Coil(CoilKind::Plain);
            !is_driven || !helpers.contains(&term.key())
        });
    }
    if let Some(relay) = left.asks_otherwise(&right) {
        return Comparison::AsksOtherwise(relay.clone());
    }
    if let Some(unlike) = unlike(left.effects.iter(), right.effects.iter()) {
        return unlike;
    }
    for (left, right) in left.effects.iter().zip(&right.effects) {
        let sides = [left.guard, right.guard];
        if let Some(difference) = difference(formulas, sides, || place_of(left)) {
            return difference;
        }
    }
    Comparison::Same { is_boolean: left.is_boolean() }
}

/// Compares what has come of the same state when paths were run: the same events in the same order under equal
/// conditions, and the same values of all bits at the end, whatever the way there. Of the paths the first `known` on
/// either side are known to do the same. With `may_be_off` there may be no power at the left rail. Bits that
/// `is_private` finds are those of one side alone: what they are at the end does not count, but what others are must
/// not depend on what they are at first.
pub fn compare_outcome(
    left: &[&Path],
    right: &[&Path],
    known: [usize; 2],
    (may_be_off, is_private): (bool, &dyn Fn(&Term) -> bool),
    formulas: &mut Formulas,
) -> Comparison {
    let known = [(left, known[0]), (right, known[1])]
        .map(|(paths, known)| run(Run::new(), &paths[..known.min(paths.len())], &mut Formulas::default()));
    let skipped = known[0].events() as usize;
    let known = known.map(|run| run.effects.len());
    let rail = if may_be_off { formulas.atom(Atom::Rail) } else { Formulas::TRUE };
    let [left, right] = [left, right].map(|paths| run(Run::by_outcome(rail), paths, formulas));
    let events = || [&left, &right].map(|run| run.effects.iter().filter(|e| e.event.is_some()));
    let [own, other] = events();
    if let Some(unlike) = unlike(own, other) {
        return unlike;
    }
    if let Some(relay) = left.asks_otherwise(&right) {
        return Comparison::AsksOtherwise(relay.clone());
    }
    let in_step = in_step([&left, &right], known, formulas);
    let mut open = None;
    let [own, other] = events();
    for (left, right) in own.zip(other).skip(skipped) {
        let sides = [left.guard, right.guard];
        if let Some(difference) = difference(formulas, sides, || place_of(left)) {
            return difference;
        }
        for sides in left.reads.iter().zip(&right.reads).map(|(left, right)| [*left, *right]) {
            if let Some(difference) = difference(formulas, sides, || place_of(left)) {
                // What the call makes of it, nobody knows.
                return match difference {
                    Comparison::Different { .. } => Comparison::Open(shown(left.action)),
                    other => other,
                };
            }
        }
        // What an event makes of bits that differ when it happens, nobody knows. Behind a unit that finds them
        // different nothing is the same for sure, but what it leaves may still tell both sides apart.
        match left.action.runs_unit() {
            true if left.event > in_step => open = open.or_else(|| Some(shown(left.action))),
            true => {}
            false if touches_bits(left.action) => return Comparison::Open(shown(left.action)),
            false => {}
        }
    }
    let bits = left.bits().chain(right.bits()).filter(|term| !is_private(term));
    let mut bits: Vec<_> = bits.map(|term| (term.key(), term)).collect();
    bits.sort_by(|(left, _), (right, _)| left.cmp(right));
    bits.dedup_by(|(left, _), (right, _)| left == right);
    for (_, bit) in bits {
        let sides = [left.bit(bit, formulas), right.bit(bit, formulas)];
        if let Some(difference) =
            difference(formulas, sides, || (bit.text.to_string(), Place::Bit(bit.key())))
        {
            return difference;
        }
    }
    match open {
        Some(what) => Comparison::Open(what),
        None => Comparison::Same { is_boolean: left.is_boolean() },
    }
}

/// The last event that runs a unit of the program and before which both sides did the same step by step, so that the
/// unit finds everything alike. The first `known` effects on either side are known to lead to the same.
fn in_step(sides: [&Run<'_>; 2], known: [usize; 2], formulas: &mut Formulas) -> Option<u32> {
    let runs_unit = |effect: &Effect<'_>| effect.action.runs_unit();
    if !sides[0].effects.iter().any(runs_unit) {
        return None;
    }
    let [left, right] = [0, 1].map(|side| sides[side].effects.iter().skip(known[side]));
    let alike = left.zip(right).take_while(|(left, right)| {
        left.is_like(right) && equal(formulas, left.guard, right.guard) == Verdict::Equal
    });
    alike.filter(|(left, _)| runs_unit(left)).last().and_then(|(left, _)| left.event)
}

/// `run`, after it went through `paths`.
fn run<'p>(mut run: Run<'p>, paths: &[&'p Path], formulas: &mut Formulas) -> Run<'p> {
    paths.iter().for_each(|path| run.path(path, formulas));
    run
}

/// The difference between two sides; nothing if they are equal.
fn difference(
    formulas: &mut Formulas,
    [left, right]: [Formula; 2],
    what: impl FnOnce() -> (String, Place),
) -> Option<Comparison> {
    match equal(formulas, left, right) {
        Verdict::Equal => None,
        Verdict::Undecided => Some(Comparison::Undecided),
        Verdict::Doubtful => Some(Comparison::Doubtful),
        Verdict::Different(values) => {
            let value = |atom: u32| values.get(&atom).copied().unwrap_or(false);
            let sides = formulas.evaluate(&[left, right], value);
            let (what, place) = what();
            Some(Comparison::Different { what, place, sides: [sides[0], sides[1]], values })
        }
    }
}

/// Where two rows of effects part; nothing if they do the same to the same operands.
fn unlike<'a, 'p: 'a>(
    left: impl Iterator<Item = &'a Effect<'p>>,
    right: impl Iterator<Item = &'a Effect<'p>>,
) -> Option<Comparison> {
    let (mut left, mut right) = (left.fuse(), right.fuse());
    loop {
        let sides = [left.next(), right.next()];
        match sides {
            [None, None] => return None,
            [Some(left), Some(right)] if left.is_like(right) => {}
            _ => return Some(Comparison::Unlike(sides.map(|side| side.map(|effect| worded(effect.action))))),
        }
    }
}

/// An action with its operands: `MOV K5 D0`, `(S Y0)`, `(T0 K50)`, `T1(IN, T#1s)`.
fn worded(action: &Action) -> String {
    let words: Vec<&str> = action.terms.iter().map(|term| term.text.as_str()).collect();
    match &action.deed {
        Deed::Instruction(_) => shown(action),
        Deed::Coil(kind) => format!("({})", format!("{} {}", kind.mark(), words.join(" ")).trim()),
        Deed::Compute(computation) => format!("{}({})", computation.name(), words.join(", ")),
        Deed::Call(_) => format!("{}({})", shown(action), words.get(1..).unwrap_or_default().join(", ")),
        Deed::Jump => format!("-> {}", words.join(" ")),
        Deed::Return => "RET".into(),
    }
}

fn place_of(effect: &Effect<'_>) -> (String, Place) {
    let bit = || effect.action.terms.first().map(Term::key).unwrap_or_default();
    (shown(effect.action), effect.event.map_or_else(|| Place::Bit(bit()), Place::Event))
}

/// What an action is called in a counterexample: the instruction with its operands, or what it drives.
pub fn shown(action: &Action) -> String {
    match (&action.deed, action.terms.first()) {
        (Deed::Coil(_), Some(term)) => term.text.to_string(),
        (Deed::Instruction(form), _) => {
            let words = action.terms.iter().map(|term| term.text.as_str());
            std::iter::once(form.mnemonic().as_str()).chain(words).collect::<Vec<_>>().join(" ")
        }
        (Deed::Compute(_), _) => action.terms.last().map(|term| term.text.to_string()).unwrap_or_default(),
        (Deed::Return, _) => "RET".into(),
        (_, term) => term.map(|term| term.text.to_string()).unwrap_or_default(),
    }
}

/// Whether an action looks at bits other than through its condition and the operands of a call, or may change bits
/// whose values are known, as units of the program do that are called, or decides what comes next. What it does when
/// its condition fails depends on what was before.
pub fn touches_bits(action: &Action) -> bool {
    // States, timers and counters change in events only, and these come in the same order.
    let is_bit = |term: &Term| term.operand.device().is_some_and(|device| is_driven(device.kind));
    let covers = || action.changes().iter().any(|term| covers_others(term));
    match action.deed {
        Deed::Instruction(form) => {
            form.instruction.flow() != Flow::Straight || action.terms.iter().any(is_bit)
        }
        // Instructions look at special relays that none of their operands names: carry, direction, modes.
        Deed::Coil(_) => covers() || action.terms.first().is_some_and(is_special),
        Deed::Compute(_) | Deed::Call(_) => action.runs_unit() || covers(),
        Deed::Jump | Deed::Return => true,
    }
}

fn is_special(term: &Term) -> bool {
    term.operand.device().is_some_and(Device::is_special)
}

/// Whether an action may drive the bit with this key.
pub fn may_drive(action: &Action, key: &str) -> bool {
    let is_alike =
        |term: &Term| term.operand.device().is_none_or(|device| key.starts_with(device.kind.letter()));
    let is_own = |own: &str| own == key || is_within(own, key) || is_within(key, own);
    let may_be = |term: &Term| is_own(&term.key()) || covers_others(term) && is_alike(term);
    let steers = matches!(action.deed, Deed::Instruction(form) if form.instruction.flow() != Flow::Straight);
    !steers && action.changes().iter().any(|term| may_be(term))
}

/// Whether who writes to it may write to bits that have names of their own.
fn covers_others(term: &Term) -> bool {
    !term.is_lone() && term.operand.device().is_none_or(|device| is_driven(device.kind))
}

/// Whether coils drive single bits of this kind.
fn is_driven(kind: DeviceKind) -> bool {
    matches!(kind, DeviceKind::X | DeviceKind::Y | DeviceKind::M)
}
