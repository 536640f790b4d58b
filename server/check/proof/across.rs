//! Outputs that are never or always on because of what other rungs make of the relays before them.
//!
//! A relay is followed if one plain coil is all that writes it, so that its value is known from there. Two things are
//! looked for: relays that are never on and whatever needs them, rung after rung; and rungs that ask for the opposite
//! of what the rung of a relay above them asks for, which the names of both tell before any tree is read.

use super::constant::{Reason, Way, is_output, place_of, value_of, ways};
use super::rung::{devices_of, has_constant};
use super::{always_energised, never_energised};
use crate::check::ProgramContext;
use crate::check::sense::{Key, Name, Use, Uses, is_general};
use crate::document::{Act, DeclaredType, Notation, Part};
use crate::il::iec::SectionKind;
use crate::logic::{self, Atom, Contact, Declared, Deed, Formulas, Path, Run};
use crate::target::DeviceKind;
use crate::target::iec::ElementaryType;
use crate::text::{Diagnostic, Message, Span, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, ToSmolStr};
use std::rc::Rc;

/// So many rungs are read for one another at most, and so many relays lie between the first and the last of them.
const RUNGS_MAX: usize = 12;
const DEPTH_MAX: usize = 3;
/// Rungs with more words are left out, so that the look at all rungs stays cheap.
const WORDS_MAX: usize = 64;
/// So many rungs are proved in one check, the first in the order of execution, so that an edit has its answer while
/// people type.
const PROOFS_MAX: usize = 150;

/// What is found in the whole program.
pub(super) fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut across = Across::new(context);
    let mut waiting = across.candidates();
    // The order of execution: what a relay is, is known before it is asked for below.
    waiting.sort_by_key(|one| std::cmp::Reverse(one.span.start));
    let mut proofs = 0;
    let mut done: FxHashSet<(Span, usize)> = FxHashSet::default();
    while let Some(rung) = waiting.pop() {
        // The same rung is looked at again only when more relays are known to be off.
        if proofs < PROOFS_MAX && done.insert((rung.span, across.off.len())) {
            proofs += 1;
            across.judge(&rung, &mut waiting);
        }
    }
    across.told(found);
}

/// The rungs of a chunk, at their places in the program.
type Rungs = Rc<Vec<(Span, Option<Path>)>>;

struct Across<'c, 'a> {
    context: &'c ProgramContext<'a>,
    uses: &'c Uses<'a>,
    /// The coil of each followed relay, by the number of its name.
    coils: Vec<Option<Use>>,
    /// The rungs that were read, by the start of their chunk.
    read: FxHashMap<usize, Rungs>,
    /// The keys of relays that are never on, with their coils.
    off: FxHashMap<SmolStr, Span>,
    /// By the place of the output, so that each is told once.
    found: FxHashMap<Span, Diagnostic>,
}

impl<'c, 'a> Across<'c, 'a> {
    fn new(context: &'c ProgramContext<'a>) -> Self {
        let uses = context.uses();
        let coils = uses.names().map(|(number, name)| coil_of(context, number, name)).collect();
        Across {
            context,
            uses,
            coils,
            read: FxHashMap::default(),
            off: FxHashMap::default(),
            found: FxHashMap::default(),
        }
    }

    fn told(self, found: &mut Vec<Diagnostic>) {
        let mut own: Vec<Diagnostic> = self.found.into_values().collect();
        own.sort_by_key(|one| one.span);
        found.extend(own);
    }

    /// One place in each rung that may be worth a proof.
    fn candidates(&self) -> Vec<Use> {
        let mut candidates = Vec::new();
        let mut words: Vec<Asked> = Vec::new();
        self.uses.each_rung(|rung| {
            let Some((_, first)) = rung.clone().next() else { return };
            // Two contacts and an output are the least that can exclude each other.
            let count = rung.size_hint().0;
            if !(3..=WORDS_MAX).contains(&count) || self.is_list_of_units(&first) {
                return;
            }
            words.clear();
            let mut drives_relay = false;
            for (number, one) in rung {
                drives_relay |= one.access.act == Act::Coil && self.coil(number).is_some();
                words.extend(Asked::of(number, &one, false, 0));
                let is_inverse = one.access.act == Act::ReadOff;
                let Some(coil) = self.coil_above(number, &one) else { continue };
                let source = words.len() + 1;
                let asked = self.uses.in_rung(&coil).take(WORDS_MAX);
                words.extend(asked.filter_map(|(number, one)| Asked::of(number, &one, is_inverse, source)));
            }
            words.sort_unstable();
            let differ = |pair: &[Asked]| pair[0].excludes(&pair[1], drives_relay);
            if words.chunk_by(|one, other| one.name == other.name).any(|same| {
                same.windows(2).any(differ) || matches!(same, [first, .., last] if differ(&[*first, *last]))
            }) {
                candidates.push(first);
            }
        });
        candidates
    }

    fn coil(&self, number: u32) -> Option<Use> {
        *self.coils.get(number as usize)?
    }

    /// The coil of a followed relay that is read at `one`, if it comes before in the same file.
    fn coil_above(&self, number: u32, one: &Use) -> Option<Use> {
        if !matches!(one.access.act, Act::Read | Act::ReadOff) || !one.is_whole() {
            return None;
        }
        self.coil(number)
            .filter(|coil| coil.span.start < one.span.start && coil.file == one.file && !coil.in_rung_of(one))
    }

    /// Lists of IEC 61131-3 have no rungs by themselves.
    fn is_list_of_units(&self, one: &Use) -> bool {
        self.context.files().get(one.file).is_none_or(|file| file.document.notation() == Notation::IecIl)
    }

    fn judge(&mut self, one: &Use, waiting: &mut Vec<Use>) {
        let Some((span, path)) = self.rung(one) else { return };
        if has_constant(&path) {
            return;
        }
        let before = self.rungs_before(one).unwrap_or_default();
        let mut formulas = Formulas::default();
        let mut run = Run::new();
        before.iter().for_each(|(_, path)| run.path(path, &mut formulas));
        let start = run.effects.len();
        run.path(&path, &mut formulas);
        let guards: Vec<_> = run.effects[start..].iter().map(|effect| effect.guard).collect();
        let guards = formulas.replaced(&guards, |formulas, atom| match formulas.atom_at(atom).clone() {
            Atom::Bit(of) | Atom::Edge { of, .. } if self.off.contains_key(&of.name) => Formulas::FALSE,
            same => formulas.atom(same),
        });
        for (guard, way) in guards.into_iter().zip(ways(&path)) {
            if way.conditions.is_empty() || !is_output(way.action) {
                continue;
            }
            let Some(is_on) = value_of(guard, &mut formulas) else { continue };
            let is_coil = matches!(way.action.deed, Deed::Coil(_));
            let place = place_of(way.action).shifted(span.start as usize);
            self.note(one, &way, is_on, waiting);
            if (is_on && !is_coil) || self.is_known_alone(&path, place_of(way.action)) {
                continue;
            }
            let reason = self.reason(&way, &before);
            let diagnostic = match is_on {
                true => always_energised::diagnostic(&way, reason),
                false => never_energised::diagnostic(&way, reason),
            };
            // Places of the rung are those of its chunk; the others are those of the program.
            self.found.entry(place).or_insert(Diagnostic { span: place, ..diagnostic });
        }
    }

    /// Whether the rung alone says it, so that it is told there.
    fn is_known_alone(&self, path: &Path, place: Span) -> bool {
        let mut formulas = Formulas::default();
        let mut run = Run::new();
        run.path(path, &mut formulas);
        let guards: Vec<_> = run.effects.iter().map(|effect| effect.guard).collect();
        let mut own = guards.into_iter().zip(ways(path));
        own.any(|(guard, way)| place_of(way.action) == place && value_of(guard, &mut formulas).is_some())
    }

    /// Has the readers of a relay looked at that is now known.
    fn note(&mut self, rung: &Use, way: &Way<'_>, is_on: bool, waiting: &mut Vec<Use>) {
        let Deed::Coil(_) = way.action.deed else { return };
        let uses = self.uses;
        let Some((number, coil)) = uses.in_rung(rung).find_map(|(number, one)| {
            let coil = self.coil(number).filter(|coil| coil.span == one.span)?;
            let term = way.action.terms.first()?;
            (key_of(uses.name(number)?, &uses.words(&coil)) == term.key()).then_some((number, coil))
        }) else {
            return;
        };
        if !is_on {
            let Some(name) = uses.name(number) else { return };
            if self.off.insert(key_of(name, &uses.words(&coil)), coil.span).is_some() {
                return;
            }
        }
        let reads = |one: &Use| one.access.act.reads() && one.file == coil.file && !one.in_rung_of(&coil);
        waiting.extend(uses.of_name(number).filter(reads).filter(|one| !self.is_list_of_units(one)));
    }

    /// Why an output has one value, in terms of the relays before it.
    fn reason(&self, way: &Way<'_>, before: &[(Use, Path)]) -> Reason {
        let mut contacts: Vec<&Contact> = Vec::new();
        way.conditions.iter().for_each(|condition| condition.visit(&mut |contact| contacts.push(contact)));
        for contact in &contacts {
            let Some(term) = contact.terms.first() else { continue };
            if let Some(coil) = self.off.get(&term.key()) {
                let message = Message::new("never-energised.across").with("name", &term.text);
                let place = Message::new("energised.coil").with("name", &term.text);
                return Reason { message, places: vec![(*coil, place)] };
            }
        }
        let driven: Vec<(Span, String)> = before
            .iter()
            .map(|(coil, _)| (coil.span, self.uses.words(coil)))
            .filter(|(_, words)| {
                let is_named = |contact: &&Contact| contact.terms.iter().any(|term| term.text == *words);
                contacts.iter().any(is_named)
            })
            .collect();
        let names = driven.iter().map(|(_, words)| format!("`{words}`"));
        let message = Message::new("energised.together")
            .with_words("names", names, ", ")
            .with("devices", devices_of(way.conditions.iter().copied()));
        let place =
            |(span, words): &(Span, String)| (*span, Message::new("energised.coil").with("name", words));
        Reason { message, places: driven.iter().map(place).collect() }
    }

    /// The start of the chunk and the path of the rung in which a place stands.
    fn rung(&mut self, one: &Use) -> Option<(Span, Path)> {
        let (start, chunk) = self.uses.chunk(one)?;
        let file = self.context.files().get(one.file)?;
        let rungs = self.read.entry(start).or_insert_with(|| {
            let reading = chunk.reading();
            let declared = Declared {
                scopes: file.document.scopes(),
                pous: one.unit.saturating_sub(chunk.pou_starts()),
            };
            let rungs = logic::rungs_with(&reading, file.document.reader(), declared);
            // Places in a list that a drawing carries along are not those of the drawing.
            let is_own = |rung: &logic::Rung| !rung.is_list || file.document.notation() != Notation::Ladder;
            let own = rungs.into_iter().filter(is_own);
            Rc::new(own.map(|rung| (rung.span, rung.path.ok().flatten())).collect())
        });
        let at = one.span.start - start as u32;
        let (_, path) = rungs.iter().find(|(span, _)| span.start <= at && at < span.end)?;
        Some((Span::at(start), path.clone()?))
    }

    /// The rungs of the relays above on which that of `one` depends, in the order of execution, each with its coil;
    /// nothing if they cannot be taken together.
    fn rungs_before(&mut self, one: &Use) -> Option<Vec<(Use, Path)>> {
        let regions = self.context.regions();
        let is_plain = |at: u32| {
            regions.at(at).is_plain() && !regions.may_be_skipped(at) && !regions.may_be_repeated(at)
        };
        if !is_plain(one.span.start) {
            return None;
        }
        let mut coils: Vec<Use> = Vec::new();
        let mut level = vec![*one];
        for _ in 0..DEPTH_MAX {
            let mut next = Vec::new();
            for rung in &level {
                for (number, read) in self.uses.in_rung(rung) {
                    let Some(coil) = self.coil_above(number, &read) else { continue };
                    if !coils.iter().any(|other| other.in_rung_of(&coil)) {
                        coils.push(coil);
                        next.push(coil);
                    }
                }
            }
            level = next;
        }
        coils.sort_by_key(|coil| coil.span.start);
        if coils.len() > RUNGS_MAX || !coils.iter().all(|coil| is_plain(coil.span.start)) {
            return None;
        }
        self.is_one_moment(one, &coils)?;
        let mut rungs = Vec::with_capacity(coils.len());
        for coil in coils {
            let (_, path) = self.rung(&coil)?;
            if has_constant(&path) {
                return None;
            }
            rungs.push((coil, path));
        }
        Some(rungs)
    }

    /// Whether nothing else writes what these rungs read from the first to the last of them.
    fn is_one_moment(&self, one: &Use, coils: &[Use]) -> Option<()> {
        let first = coils.first()?.span.start;
        let rungs: Vec<Use> = coils.iter().copied().chain([*one]).collect();
        let own: Vec<Vec<(u32, Use)>> = rungs.iter().map(|rung| self.uses.in_rung(rung).collect()).collect();
        let ends = own.iter().flatten().map(|(_, one)| one.span.start).max()?;
        let starts = own.iter().flatten().map(|(_, one)| one.span.start).min()?.min(first);
        let is_own = |at: u32| own.iter().flatten().any(|(_, one)| one.span.start == at);
        for (number, access) in own.iter().flatten() {
            let is_row = access.access.count > 1 || access.access.part != Part::Whole;
            let in_row = match self.uses.name(*number)?.key {
                Key::Device(device) => {
                    let changes = device.is_special() && !matches!(device.number, 8000..=8003);
                    changes || self.uses.is_written_in_row(device)
                }
                _ => false,
            };
            let writes = self.uses.written_at(*number);
            let comes_between = |at: &u32| {
                !self.context.regions().at(*at).is_in_order()
                    || (starts <= *at && *at <= ends && !is_own(*at))
            };
            if is_row || in_row || writes.iter().any(comes_between) {
                return None;
            }
        }
        Some(())
    }
}

/// What a rung asks of a name.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Asked {
    name: u32,
    is_off: bool,
    /// The number of the rung among those that were put together, 0 for the last.
    source: usize,
}

impl Asked {
    fn of(name: u32, one: &Use, is_inverse: bool, source: usize) -> Option<Asked> {
        let is_off = match one.access.act {
            Act::Read => is_inverse,
            Act::ReadOff => !is_inverse,
            _ => return None,
        };
        one.is_whole().then_some(Asked { name, is_off, source })
    }

    /// Whether both may not hold together; within one rung that matters only if it drives a relay that others read.
    fn excludes(&self, other: &Asked, drives_relay: bool) -> bool {
        self.is_off != other.is_off && (self.source != other.source || drives_relay)
    }
}

/// The one coil that is all that writes a relay.
fn coil_of(context: &ProgramContext<'_>, number: u32, name: &Name<'_>) -> Option<Use> {
    let uses = context.uses();
    let acts = uses.acts(number);
    let is_followed =
        acts.has(&[Act::Coil]) && !acts.writes_but(&[Act::Coil]) && !acts.has(&[Act::DeclareValue]);
    if !is_followed || uses.written_at(number).len() != 1 {
        return None;
    }
    let is_relay = match name.key {
        Key::Device(device) => {
            let is_kind = match device.kind {
                DeviceKind::M => is_general(device, context),
                DeviceKind::Y => true,
                _ => false,
            };
            is_kind && !uses.is_written_in_row(device)
        }
        Key::Local(..) => name.variable.is_none_or(|variable| {
            variable.section == SectionKind::Local
                && variable.address.is_none()
                && variable.declared == DeclaredType::Elementary(ElementaryType::Bool)
        }),
        Key::Global(_) | Key::Direct(_) => false,
    };
    if !is_relay {
        return None;
    }
    uses.of_name(number).find(|one| one.access.act == Act::Coil && one.is_whole())
}

fn key_of(name: &Name<'_>, words: &str) -> SmolStr {
    match name.key {
        Key::Device(device) => device.to_smolstr(),
        _ => folded(words),
    }
}
