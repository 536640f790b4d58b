//! Whether two programs do the same, and if not, for which inputs.
//!
//! Rungs are compared in step as far as they drive the same things in the same order. Where one program does so in
//! another way, stretches between jumps, labels and the like are compared by what comes of them.

mod ground;
mod labels;
mod parted;
mod straight;
mod telling;

use self::ground::Ground;
use super::counterexample::{self, Counterexample};
use super::paired::Paired;
use super::source::{self, Source};
use super::{Purpose, To, declared, dialect, helpers, reached, types, units};
use crate::document::{DeclaredType, Document, Scopes};
use crate::ladder::CoilKind;
use crate::logic::{
    Action, Comparison, Deed, Drive, Effort, Path, Place, Refusal, State, Storage, Term, compare,
    compare_outcome, may_drive, shown, touches_bits,
};
use crate::target::iec::ElementaryType;
use crate::target::{DeviceKind, Flow, Model, Target};
use crate::text::{Message, Span, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;
use std::borrow::Cow;

/// What is known of two programs.
#[derive(Clone, PartialEq, Debug)]
pub enum Proof {
    /// For all inputs and all states both do the same in each scan.
    Equal {
        /// Whether some bits are driven in another order, or other relays on the way, with the same outcome.
        is_reordered: bool,
    },
    /// They differ in a scan.
    Different(Box<Counterexample>),
    /// Nothing is proved.
    Undecided {
        /// Why.
        reason: Message,
        /// The rung of the first program from which on, and that of the second, if there is one.
        at: [Option<Span>; 2],
        /// A difference, if one is suspected: it counts if running both programs shows it.
        suspect: Option<Box<Counterexample>>,
    },
}

impl Proof {
    fn undecided(reason: Message, at: [Option<Span>; 2]) -> Proof {
        Proof::Undecided { reason, at, suspect: None }
    }
}

/// Compares two programs. If one is for the FX family and the other of IEC 61131-3, the devices of the one are the
/// variables that a translation gives them.
///
/// A program that stands in no project is compared with one of a project as if it stood in its place.
pub fn prove(left: &Document, right: &Document) -> Proof {
    let placed = [left.outer().is_none().then_some(right), right.outer().is_none().then_some(left)];
    let placed = [left, right].into_iter().zip(placed).map(|(own, other)| {
        let (outer, number) = other?.outer().filter(|_| !own.target().is_fx())?;
        Some(own.linked(outer.clone(), number))
    });
    let placed: Vec<Option<Document>> = placed.collect();
    let [left, right] =
        [(left, 0), (right, 1)].map(|(own, side)| placed.get(side).and_then(Option::as_ref).unwrap_or(own));
    let is_mixed = !left.target().is_kin_of(right.target());
    let mut sources = [left, right].map(|document| {
        let mut program = source::program(document, None);
        if is_mixed && document.target().is_fx() {
            dialect::convert(document, (To::Iec, Target::of(Model::Iec)), &mut program, Purpose::Proof);
            dialect::part_calculations(&mut program);
        }
        program.rungs
    });
    if ![left, right].iter().all(|document| document.target().is_fx()) {
        labels::named_alike(&mut sources);
    }
    let paired = Paired::of([left, right]);
    let unlike = declared::difference([left, right], [&sources[0], &sources[1]], &paired)
        .or_else(|| declared::other_type([left, right], [&sources[0], &sources[1]]));
    if let Some((reason, at)) = unlike {
        return Proof::undecided(reason, at);
    }
    let family = if left.target().is_fx() { left.target() } else { right.target() };
    for (document, sources) in [left, right].into_iter().zip(&mut sources).filter(|_| is_mixed) {
        dialect::refuse_others(document, family, sources);
    }
    let mut sources = sources.map(parted::parted);
    // Comments before a unit are no part of another one.
    let says_something = |source: &Source| source.rung.path != Ok(None) || !source.rung.labels.is_empty();
    sources.iter_mut().for_each(|sources| sources.retain(says_something));
    let stretches = [0, 1].map(|side| stretches(&sources[side]));
    if let Some((reason, at)) = units::unlike([left, right], [&sources[0], &sources[1]]) {
        return Proof::undecided(reason, at);
    }
    let may_be_off = sources.iter().flatten().any(leaves_out);
    let mut effort = Effort::of_program();
    effort.know(types::compared([left, right], [&sources[0], &sources[1]]));
    if sources.iter().flatten().all(straight::is_straight) {
        effort.know_straight();
    }
    let mut prover = Prover {
        all: [&sources[0], &sources[1]],
        before: [Vec::new(), Vec::new()],
        next: [0, 0],
        may_be_off,
        helpers: helpers::of([left, right], [&sources[0], &sources[1]]),
        is_reordered: false,
        is_mixed,
        scopes: [left.scopes(), right.scopes()],
        effort,
        paired,
    };
    let starts = [0, 1].map(|side| sources[side].first());
    if let [Some(left), Some(right)] = starts
        && !prover.paired.are(left.pou, right.pou)
    {
        let at = [left, right].map(|source| Some(source.span()));
        return Proof::undecided(Message::new("prove.structure"), at);
    }
    let [left, right] = &stretches;
    let outcome = left.iter().zip(right).try_for_each(|(left, right)| prover.stretches(left, right));
    match outcome {
        Err(proof) => proof,
        Ok(()) if left.len() != right.len() => {
            let least = left.len().min(right.len());
            let at = [left, right].map(|side| side.get(least).and_then(Stretch::span));
            Proof::undecided(Message::new("prove.structure"), at)
        }
        Ok(()) => Proof::Equal { is_reordered: prover.is_reordered },
    }
}

/// Whether a rung begins a part of the program in which there may be no power at the left rail. One that cannot be read
/// does if it has such a word.
fn leaves_out(source: &Source) -> bool {
    if source.rung.path.is_err() {
        let words = source.words();
        let mut words = words.split(|c: char| !c.is_alphanumeric());
        return words.any(|word| ["MC", "STL"].iter().any(|own| own.eq_ignore_ascii_case(word)));
    }
    reached::has_flow(source, |flow| matches!(flow, Flow::SectionBegin | Flow::Step))
}

/// Rungs that are executed one after the other, and what ends them: a label, a jump, another program unit, or an
/// instruction of which nobody knows which bits it looks at.
#[derive(Default)]
struct Stretch<'s> {
    rungs: Vec<(&'s Source, &'s Path)>,
    end: Option<End<'s>>,
}

enum End<'s> {
    Label(Span, &'s str),
    /// The program unit that begins, by its number.
    Unit(Span, Option<usize>),
    Rung(&'s Source, &'s Path),
    /// A rung that cannot be read, by its words.
    Unread(&'s Source, SmolStr),
}

impl Stretch<'_> {
    /// Where it starts.
    fn span(&self) -> Option<Span> {
        let first = self.rungs.first().map(|(source, _)| source.span());
        first.or_else(|| self.end.as_ref().map(End::span))
    }
}

impl End<'_> {
    fn span(&self) -> Span {
        match self {
            End::Label(span, _) | End::Unit(span, _) => *span,
            End::Rung(source, _) | End::Unread(source, _) => source.span(),
        }
    }

    /// Why it is not compared, if it cannot be read or has no counterpart.
    fn obstacle(&self) -> Option<Message> {
        let End::Unread(source, _) = self else { return None };
        let refusal = source.rung.path.as_ref().err().map(Refusal::message);
        source
            .note
            .clone()
            .or_else(|| Some(Message::new("prove.unread").with_messages("why", vec![refusal?])))
    }

    /// Whether it is nothing but END.
    fn ends_program(&self) -> bool {
        let End::Rung(_, path) = self else { return false };
        path.actions().iter().all(|action| action.deed.ends_program())
    }
}

/// The stretches of a program. The END at its end is left out: a drawing may go without.
fn stretches(sources: &[Source]) -> Vec<Stretch<'_>> {
    let mut stretches = Vec::new();
    let mut open = Stretch::default();
    let mut pou = sources.first().and_then(|source| source.pou);
    // Nothing is executed behind an END, a return or a jump without condition.
    let mut is_left = false;
    for source in sources {
        is_left &= source.pou == pou && source.rung.labels.is_empty();
        if source.pou != pou {
            pou = source.pou;
            open.end = Some(End::Unit(source.span(), pou));
            stretches.push(std::mem::take(&mut open));
        }
        for label in &source.rung.labels {
            open.end = Some(End::Label(source.span(), label));
            stretches.push(std::mem::take(&mut open));
        }
        if is_left {
            continue;
        }
        match &source.rung.path {
            Ok(None) => {}
            Ok(Some(path)) if path.actions().iter().any(|action| touches_bits(action)) => {
                open.end = Some(End::Rung(source, path));
                stretches.push(std::mem::take(&mut open));
                let ends = |drive: &Drive| matches!(drive, Drive::Action(action) if leaves(&action.deed));
                is_left = path.gates.is_empty() && path.drives.iter().any(ends);
            }
            Ok(Some(path)) => open.rungs.push((source, path)),
            Err(_) => {
                open.end = Some(End::Unread(source, source.words()));
                stretches.push(std::mem::take(&mut open));
            }
        }
    }
    match stretches.last_mut() {
        Some(last) if open.rungs.is_empty() && last.end.as_ref().is_some_and(End::ends_program) => {
            last.end = None;
        }
        _ => stretches.push(open),
    }
    stretches
}

/// Whether the rungs behind it are not executed if it is without condition.
fn leaves(deed: &Deed) -> bool {
    matches!(deed, Deed::Jump | Deed::Return) || deed.ends_program()
}

struct Prover<'s> {
    /// The rungs of either program.
    all: [&'s [Source]; 2],
    /// The paths that are known to do the same, on either side.
    before: [Vec<&'s Path>; 2],
    /// The first rung behind those, on either side.
    next: [usize; 2],
    /// Whether a part of the program may be left out, so that there is no power at the left rail.
    may_be_off: bool,
    /// Variables that only one of the programs has.
    helpers: FxHashSet<SmolStr>,
    is_reordered: bool,
    /// Whether one of them is for the FX family and the other of IEC 61131-3.
    is_mixed: bool,
    /// What either program declares.
    scopes: [&'s Scopes; 2],
    effort: Effort,
    /// Which units are the same.
    paired: Paired,
}

impl<'s> Prover<'s> {
    fn stretches(&mut self, left: &Stretch<'s>, right: &Stretch<'s>) -> Result<(), Proof> {
        // What ends at different things does not start at the same ones, either.
        let is_alike = match (&left.end, &right.end) {
            (None, None) | (Some(End::Rung(..)), Some(End::Rung(..))) => true,
            (Some(End::Label(_, left)), Some(End::Label(_, right))) => left.eq_ignore_ascii_case(right),
            (Some(End::Unit(_, left)), Some(End::Unit(_, right))) => self.paired.are(*left, *right),
            (Some(End::Unread(_, left)), Some(End::Unread(_, right))) => left == right && !self.is_mixed,
            _ => false,
        };
        if !is_alike {
            let ends = [left, right].map(|side| side.end.as_ref());
            let reason = ends.into_iter().flatten().find_map(End::obstacle);
            // What cannot be read is what has to be looked at.
            let is_meant = |end: &&End<'_>| reason.is_none() || matches!(end, End::Unread(..));
            let at = ends.map(|end| end.filter(is_meant).map(End::span));
            return Err(Proof::undecided(reason.unwrap_or_else(|| Message::new("prove.structure")), at));
        }
        self.rungs([&left.rungs, &right.rungs])?;
        match (&left.end, &right.end) {
            (Some(End::Rung(left, left_path)), Some(End::Rung(right, right_path))) => {
                self.rungs([&[(*left, *left_path)], &[(*right, *right_path)]])
            }
            // What stands here may come after other rungs than those before it, or knows other variables.
            (Some(End::Label(..) | End::Unit(..) | End::Unread(..)), _) => {
                self.before.iter_mut().for_each(Vec::clear);
                for (next, (all, side)) in self.next.iter_mut().zip(self.all.iter().zip([left, right])) {
                    *next = match &side.end {
                        Some(End::Unread(source, _)) => behind(all, source.span()),
                        // What a label or a unit begins with comes next.
                        Some(end) => behind(all, end.span()).saturating_sub(1),
                        None => *next,
                    };
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Compares rungs in step; where that does not do, by what comes of them.
    fn rungs(&mut self, sides: [&[(&'s Source, &'s Path)]; 2]) -> Result<(), Proof> {
        let effort = &mut self.effort;
        let in_step = groups(sides).is_some_and(|groups| {
            groups.into_iter().all(|group| {
                let paths = group.map(|side| side.iter().map(|(_, path)| *path).collect::<Vec<_>>());
                let comparison = effort.ask(|formulas| compare(&paths[0], &paths[1], formulas));
                matches!(comparison, Comparison::Same { .. })
            })
        });
        let paths = sides.map(|side| side.iter().map(|(_, path)| *path).collect::<Vec<&Path>>());
        if !in_step {
            self.outcome(&paths, sides)?;
            self.is_reordered = true;
        }
        let [left, right] = paths;
        self.before[0].extend(left);
        self.before[1].extend(right);
        for (next, (all, side)) in self.next.iter_mut().zip(self.all.iter().zip(sides)) {
            *next = side.last().map_or(*next, |(last, _)| behind(all, last.span()));
        }
        Ok(())
    }

    fn outcome(
        &mut self,
        paths: &[Vec<&'s Path>; 2],
        sides: [&[(&'s Source, &'s Path)]; 2],
    ) -> Result<(), Proof> {
        let may_be_off = self.may_be_off;
        let is_private = |term: &Term| self.helpers.contains(&term.key());
        let alone = self.effort.ask(|formulas| {
            compare_outcome(&paths[0], &paths[1], [0, 0], (may_be_off, &is_private), formulas)
        });
        if matches!(alone, Comparison::Same { .. }) {
            return Ok(());
        }
        // What is different from any state may be the same from those that the rungs before can lead to.
        let [left, right] =
            [0, 1].map(|side| self.before[side].iter().chain(&paths[side]).copied().collect::<Vec<&Path>>());
        let known = [self.before[0].len(), self.before[1].len()];
        let at = sides.map(|side| side.first().map(|(source, _)| source.span()));
        let undecided = |key| Err(Proof::undecided(Message::new(key), at));
        let (comparison, state) = self.compared([&left, &right], known, false);
        match comparison {
            // With no power at the rail they may do otherwise.
            Comparison::Same { .. } if may_be_off => match self.compared([&left, &right], known, true) {
                (Comparison::Same { .. }, _) => Ok(()),
                _ => undecided("prove.left-out"),
            },
            Comparison::Same { .. } => Ok(()),
            Comparison::Undecided => undecided("prove.undecided"),
            Comparison::Doubtful => undecided("prove.unconfirmed"),
            Comparison::Open(what) => {
                Err(Proof::undecided(Message::new("prove.open").with("what", what), at))
            }
            Comparison::AsksOtherwise(relay) => {
                Err(Proof::undecided(Message::new("prove.single-edge").with("relay", relay), at))
            }
            Comparison::Unlike(sides) => Err(Proof::undecided(telling::unlike(sides), at)),
            Comparison::Different { place: Place::Bit(key), .. } if self.is_driven_behind(sides, &key) => {
                let found = self.beyond(sides).or_else(|| self.by_running(state, sides));
                found.map_or_else(|| undecided("prove.driven-again"), |found| Err(self.told(found)))
            }
            Comparison::Different { what, place, .. } => {
                let found = self.different((what, place), state.clone(), [&left, &right], sides);
                let found = found.or_else(|| self.by_running(state, sides));
                found.map_or_else(|| undecided("prove.unconfirmed"), |found| Err(self.told(found)))
            }
        }
    }

    /// Compares what comes of paths, with the state in which they differ.
    fn compared(
        &mut self,
        [left, right]: [&[&Path]; 2],
        known: [usize; 2],
        may_be_off: bool,
    ) -> (Comparison, Option<State>) {
        let is_private = |term: &Term| self.helpers.contains(&term.key());
        self.effort.ask(|formulas| {
            let comparison = compare_outcome(left, right, known, (may_be_off, &is_private), formulas);
            let values = match &comparison {
                Comparison::Different { values, .. } => counterexample::state(formulas, values),
                _ => None,
            };
            (comparison, values)
        })
    }

    /// Looks beyond the calls of units that follow for a difference that lasts: one side drives before a call what the
    /// other drives behind it.
    fn beyond(&mut self, sides: [Rungs<'_, 's>; 2]) -> Option<Counterexample> {
        if self.may_be_off {
            return None;
        }
        let ahead = [0, 1].map(|side| self.ahead(side, sides[side]));
        let [left, right] = [0, 1].map(|side| {
            let ahead = ahead[side].iter().map(|(_, path)| *path);
            self.before[side].iter().copied().chain(ahead).collect::<Vec<&Path>>()
        });
        let known = [self.before[0].len(), self.before[1].len()];
        let (comparison, state) = self.compared([&left, &right], known, false);
        let Comparison::Different { what, place: Place::Bit(key), .. } = comparison else { return None };
        let sides = [&ahead[0][..], &ahead[1][..]];
        if self.is_driven_behind(sides, &key) {
            return None;
        }
        self.different((what, Place::Bit(key)), state, [&left, &right], sides)
    }

    /// The rungs of a side and those behind, as far as they are executed one after the other.
    fn ahead(&self, side: usize, rungs: Rungs<'_, 's>) -> Vec<(&'s Source, &'s Path)> {
        let all = self.all[side];
        let next = rungs.last().map_or(self.next[side], |(last, _)| behind(all, last.span()));
        let mut ahead = rungs.to_vec();
        for source in &all[next.min(all.len())..] {
            let Ok(path) = &source.rung.path else { break };
            let mut actions = path.iter().flat_map(Path::actions);
            let is_straight = actions.all(|action| action.runs_unit() || !touches_bits(action));
            let is_same_unit = ahead.last().is_none_or(|(last, _)| last.pou == source.pou);
            if !source.rung.labels.is_empty() || !is_straight || !is_same_unit {
                break;
            }
            ahead.extend(path.iter().map(|path| (source, path)));
        }
        ahead
    }
}

/// The number of the first rung behind the one at `span`.
fn behind(all: &[Source], span: Span) -> usize {
    all.partition_point(|source| source.span().start <= span.start)
}

impl Prover<'_> {
    /// The difference that running both programs from `state` confirms. Formulas know less than a PLC: what they leave
    /// open may be what it never does.
    fn different(
        &self,
        (what, place): (String, Place),
        state: Option<State>,
        paths: [&[&Path]; 2],
        sides: [Rungs<'_, '_>; 2],
    ) -> Option<Counterexample> {
        let (state, ground) = self.ground(state, sides)?;
        if matches!(place, Place::Event(_)) && !self.lasts(&what) {
            return None;
        }
        // Whether a jump is taken is nothing that lasts.
        let jumps = |(_, path): &(&Source, &Path)| path.actions().into_iter().any(reached::leaves);
        if matches!(place, Place::Event(_)) && sides.iter().any(|side| side.iter().any(jumps)) {
            return None;
        }
        let (state, values) = counterexample::confirmed_near(state, paths, &place)?;
        let state = reached::reached(&ground.units, &state, &place)?;
        let key = match &place {
            Place::Bit(key) => key.clone(),
            Place::Event(_) => folded(&what),
        };
        Some(ground.found((what, key, values), &state, sides))
    }

    /// `state`, if one can be in it, and what is needed to run the rungs around `sides` from there, if running these
    /// with plain values is what a PLC does.
    fn ground(&self, state: Option<State>, sides: [Rungs<'_, '_>; 2]) -> Option<(State, Ground<'_>)> {
        let units = [0, 1].map(|side| self.unit_around(side, sides[side]));
        let ground = Ground { types: self.types(sides), units };
        let state = state.filter(|state| counterexample::is_possible(state, &|key| ground.type_of(key)))?;
        self.is_plain(&ground.units).then_some((state, ground))
    }

    /// The difference that is there at the end of a scan when both programs are run from a state in which something
    /// else differs on the way.
    fn by_running(&self, state: Option<State>, sides: [Rungs<'_, '_>; 2]) -> Option<Counterexample> {
        let (state, ground) = self.ground(state, sides)?;
        let units = &ground.units;
        let (bit, state, values) = reached::found(units, &state)?;
        let key = bit.key();
        let is_again = (0..2).any(|side| {
            let (all, own) = (self.all[side], &units[side].numbers);
            let others = all[..own.start].iter().chain(&all[own.end..]).filter_map(Source::path);
            others.flat_map(Path::actions).any(|action| may_drive(action, &key))
        });
        if is_again {
            return None;
        }
        Some(ground.found((bit.text.to_string(), key, values), &state, sides))
    }

    /// Whether running what is executed in one scan with plain values is what a PLC does.
    fn is_plain(&self, units: &[reached::Unit<'_>; 2]) -> bool {
        (0..2).all(|side| {
            let own = self.all[side].get(units[side].numbers.clone()).unwrap_or_default();
            counterexample::is_plain(&own.iter().filter_map(Source::path).collect::<Vec<_>>())
        })
    }

    /// The rungs around those of a side that are executed in one scan.
    fn unit_around(&self, side: usize, rungs: Rungs<'_, '_>) -> reached::Unit<'_> {
        let all = self.all[side];
        let next = self.next[side].min(all.len());
        let first = rungs.first().map(|(first, _)| behind(all, first.span()) - 1);
        let end = rungs.last().map_or(next, |(last, _)| behind(all, last.span()));
        reached::Unit::around(all, first.unwrap_or(next), end)
    }

    /// The types that variables have in the units of `sides`, by their keys.
    fn types(&self, sides: [Rungs<'_, '_>; 2]) -> FxHashMap<SmolStr, ElementaryType> {
        let mut types = FxHashMap::default();
        for ((all, scopes), side) in self.all.iter().zip(self.scopes).zip(sides) {
            let unit = side.first().map(|(source, _)| source.pou);
            for source in all.iter().filter(|source| unit.is_none_or(|unit| source.pou == unit)) {
                for term in source.path().map(Path::terms).unwrap_or_default() {
                    if let Some(DeclaredType::Elementary(kind)) = scopes.type_of(source.pou, &term.text) {
                        types.insert(term.key(), kind);
                    }
                }
            }
        }
        types
    }

    /// Whether what an action does is still there when the scan ends, as far as one can see: nothing else writes what
    /// it writes, or a block remembers it. A detector of edges does nothing that a program of the other family would
    /// have to do.
    fn lasts(&self, what: &str) -> bool {
        let all =
            || self.all.iter().flat_map(|all| all.iter()).filter_map(Source::path).flat_map(Path::actions);
        let own: Vec<&Action> = all().filter(|action| shown(action) == what).collect();
        let is_detector = |action: &&&Action| match &action.deed {
            Deed::Call(call) => ["R_TRIG", "F_TRIG"].iter().any(|name| call.block.is_standard(name)),
            _ => false,
        };
        if self.is_mixed && own.iter().any(|action| is_detector(&action)) {
            return false;
        }
        // Where it stands twice, the other one may do it.
        let count = |all: &[Source]| {
            let actions = all.iter().filter_map(Source::path).flat_map(Path::actions);
            actions.filter(|action| shown(action) == what).count()
        };
        if self.all.iter().any(|all| count(all) > 1) {
            return false;
        }
        let forgets = |action: &&&Action| {
            let is_pulse = matches!(action.deed, Deed::Coil(CoilKind::Rising | CoilKind::Falling));
            is_pulse || matches!(action.deed, Deed::Instruction(_) | Deed::Compute(_))
        };
        let written = own.iter().filter(forgets).flat_map(|action| action.changes());
        let written: Vec<Term> = written.map(Cow::into_owned).collect();
        let mut others = all().filter(|action| shown(action) != what);
        !others.any(|action| {
            action
                .changes()
                .iter()
                .any(|term| written.iter().any(|own| own.may_cover(term) || may_overlap(own, term)))
        })
    }

    /// Whether the bit with this key may be driven once more behind the rungs on either side, so that what it is at
    /// their end is not what the scan leaves.
    fn is_driven_behind(&self, sides: [&[(&Source, &Path)]; 2], key: &str) -> bool {
        let is_reached = self.reach(sides, key);
        self.all.iter().zip(sides).any(|(all, side)| {
            let last = side.last().map(|(source, _)| source.span());
            let behind = all.iter().filter(|source| last.is_none_or(|last| source.span() > last));
            let mut behind = behind.filter(|source| !side.iter().any(|(own, _)| std::ptr::eq(*own, *source)));
            let drives = |source: &Source, action: &Action| {
                may_drive(action, key) || action.runs_unit() && is_reached(source)
            };
            behind.any(|source| match &source.rung.path {
                Ok(path) => path.iter().flat_map(Path::actions).any(|action| drives(source, action)),
                Err(_) => may_name(source, key),
            })
        })
    }

    /// From which rungs units are called that may drive the variable with this key, which `sides` drive: from none if
    /// only its own unit knows it, else from those of its unit, or from all if all units know it.
    fn reach(&self, sides: [&[(&Source, &Path)]; 2], key: &str) -> impl Fn(&Source) -> bool + use<> {
        let mut found = (Storage::Anywhere, None);
        for (source, path) in sides.into_iter().flatten() {
            let changes = path.actions().into_iter().flat_map(Action::changes);
            let own = changes.into_iter().find(|term| term.key() == key);
            found = own.map_or(found, |own| (own.storage, source.pou));
        }
        let root = key.split(['.', '[', '^']).next().unwrap_or(key);
        let is_global = self.scopes.iter().any(|scopes| scopes.variable(None, root).is_some());
        let (storage, unit) = found;
        move |source| match storage {
            Storage::Local => false,
            Storage::Own if !is_global => source.pou == unit,
            _ => true,
        }
    }
}

/// Whether a rung that cannot be read may drive the variable with this key: it has the name; or a device of the kind,
/// among which may be groups and the first of a row; or it has any name, if the variable lies at an address.
fn may_name(source: &Source, key: &str) -> bool {
    let (text, root) = (folded(source.text()), folded(key.split(['.', '[', '^']).next().unwrap_or(key)));
    let is_device = key.starts_with(|letter: char| letter.is_ascii_uppercase());
    let name = root.trim_end_matches(|digit: char| digit.is_ascii_digit());
    key.starts_with('%') || text.contains(if is_device { name } else { &root })
}

/// Whether two operands of the FX family may have a relay in common: a group has others than its first.
fn may_overlap(one: &Term, other: &Term) -> bool {
    let kind = |term: &Term| term.operand.device().map(|device| device.kind);
    let is_relay = matches!(kind(one), Some(DeviceKind::X | DeviceKind::Y | DeviceKind::M | DeviceKind::S));
    is_relay && kind(one) == kind(other) && !(one.is_lone() && other.is_lone())
}

/// Rungs with their paths.
type Rungs<'r, 's> = &'r [(&'s Source, &'s Path)];

/// Those of either side.
type Group<'r, 's> = [Rungs<'r, 's>; 2];

/// The least groups of rungs with as many actions on either side; nothing if that does not come out even.
fn groups<'r, 's>(sides: Group<'r, 's>) -> Option<Vec<Group<'r, 's>>> {
    let [mut left, mut right] = sides;
    let mut groups = Vec::with_capacity(left.len());
    while !left.is_empty() || !right.is_empty() {
        let (mut ends, mut actions) = ([0, 0], [0, 0]);
        while ends == [0, 0] || actions[0] != actions[1] {
            let side = usize::from(actions[0] > actions[1] || (ends[0] > 0 && ends[1] == 0));
            let (_, path) = [left, right][side].get(ends[side])?;
            actions[side] += path.actions().len();
            ends[side] += 1;
        }
        let ([left_group, right_group], rest) =
            ([&left[..ends[0]], &right[..ends[1]]], [&left[ends[0]..], &right[ends[1]..]]);
        groups.push([left_group, right_group]);
        [left, right] = rest;
    }
    Some(groups)
}

/// The last rung that drives `what`, else the first.
fn rung_of(side: &[(&Source, &Path)], what: &str) -> Option<Span> {
    let drives = |(_, path): &&(&Source, &Path)| {
        path.actions().iter().any(|action| action.terms.first().is_some_and(|term| term.text == what))
    };
    let rung = side.iter().rfind(drives).or(side.first());
    rung.map(|(source, _)| source.span())
}
