//! The part of a program on which some bits depend: the rungs that drive them, those that drive what these look at, and
//! so on.

use crate::check::ProgramContext;
use crate::check::sense::{Key, Use, Uses};
use crate::document::{Access, Act, Document, Notation, Part, Tree};
use crate::il::iec::{ItemKind, SectionKind};
use crate::logic::{self, Declared, Formula, Formulas, Path, Refusal, Run, Source, Term};
use crate::target::{Device, DeviceKind, Flow, Location, Operand, Width};
use crate::text::{Span, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, ToSmolStr};
use std::collections::BTreeMap;

/// Why a part of a program cannot be followed from scan to scan.
#[derive(Clone, Debug)]
pub(super) enum Obstacle {
    /// It is written here, where a jump, a master control, a step or a routine may leave it out.
    Part(Span),
    /// It is written here, which a scan may come to several times.
    Loop(Span),
    /// It is written here in a rung that has no conditions to be read.
    Unread(Span, Refusal),
    /// It is written here as well, in another unit.
    Elsewhere(Span),
    /// It is known by two names, of which this is one.
    Alias(Span),
    /// It is a variable of the caller, or lives for one call.
    Passing(Span),
    /// Too many rungs have to do with it.
    Large,
}

/// The rungs that count, in the order of execution.
pub(super) struct Slice {
    pieces: Vec<Piece>,
    /// The bits that are read or driven, by their keys.
    pub terms: FxHashMap<SmolStr, Term>,
    /// What is known of each.
    sources: FxHashMap<SmolStr, Source>,
    /// The keys of the names with these numbers.
    keys: FxHashMap<u32, SmolStr>,
    /// Whether states are relays like others.
    has_plain_states: bool,
}

struct Piece {
    /// Nothing where the rung cannot be read.
    path: Option<Path>,
    /// Whether a scan may pass over it.
    is_skipped: bool,
    /// Whether it looks at special relays, which the CPU changes when it likes.
    looks_at_specials: bool,
}

/// More rungs are not followed, so that the question has its answer while people type.
const RUNGS_MAX: usize = 2_000;

impl Slice {
    /// That of the names with these numbers, each written somewhere.
    pub fn of(context: &ProgramContext<'_>, wanted: &[u32]) -> Result<Slice, Obstacle> {
        let mut collector = Collector::new(context, wanted);
        let mut waiting: Vec<u32> = wanted.to_vec();
        while let Some(name) = waiting.pop() {
            if collector.seen.insert(name) {
                collector.name(name, &mut waiting)?;
            }
        }
        Ok(collector.finish())
    }

    /// Runs the rungs once; with the run, what holds in each scan whatever its state is.
    pub fn run(&self, formulas: &mut Formulas) -> (Run<'_>, Formula) {
        let mut run = if self.has_plain_states { Run::without_steps() } else { Run::new() };
        let mut facts = Vec::new();
        for piece in &self.pieces {
            if piece.looks_at_specials {
                run.pause();
            }
            match &piece.path {
                None => run.unread(formulas),
                Some(path) if piece.is_skipped => run.maybe(path, formulas),
                Some(path) => {
                    let before = run.effects.len();
                    run.path(path, formulas);
                    for number in before..run.effects.len() {
                        facts.extend(timer_fact(&run, number, formulas));
                    }
                }
            }
        }
        let facts = formulas.and(facts);
        (run, facts)
    }

    /// The words that name the device or variable with this number.
    pub fn term(&self, number: u32) -> Option<&Term> {
        self.terms.get(self.keys.get(&number)?)
    }

    /// A key as the program writes it.
    pub fn name<'s>(&'s self, key: &'s str) -> &'s str {
        let plain = key.strip_prefix("D ").unwrap_or(key);
        self.terms.get(plain).map_or(plain, |term| term.text.as_str())
    }

    /// The same as a piece of program in a message.
    pub fn shown(&self, key: &str) -> String {
        format!("`{}`", self.name(key))
    }

    /// What is known of the bit of a key.
    pub fn source(&self, key: &SmolStr) -> Source {
        self.sources.get(key).copied().unwrap_or(Source::Unknown)
    }
}

/// The output of a TON is off when power does not reach its input.
fn timer_fact(run: &Run<'_>, number: usize, formulas: &mut Formulas) -> Option<Formula> {
    let effect = run.effects.get(number)?;
    let guard = effect.guard;
    let contact = match effect.deed() {
        logic::Deed::Call(call) if call.block.is_standard("TON") && call.power_in() == "IN" => {
            call.output(&effect.action.terms)?
        }
        _ => return None,
    };
    let contact = run.bit(&contact, formulas);
    let idle = formulas.not(contact);
    Some(formulas.or([idle, guard]))
}

/// A stretch of the program with one or more rungs that run one after the other.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Stretch {
    start: u32,
    end: u32,
    file: usize,
}

struct Collector<'c, 'a> {
    context: &'c ProgramContext<'a>,
    uses: &'c Uses<'a>,
    wanted: &'c [u32],
    seen: FxHashSet<u32>,
    /// Each with whether a scan may pass over it.
    stretches: BTreeMap<Stretch, bool>,
    /// Lists of IEC 61131-3 are read as a whole, for a rung may reach over several chunks.
    lists: FxHashMap<usize, List>,
    /// The file and the unit that drives what is wanted.
    home: Option<(usize, usize)>,
    /// Where rows of several devices are written, with the devices.
    rows: Option<Vec<(Device, Use)>>,
    /// Whether the places that read inputs anew are among the stretches.
    knows_refreshes: bool,
}

/// The rungs of a file, from its start.
struct List(Vec<(Span, Result<Option<Path>, Refusal>)>);

impl<'c, 'a> Collector<'c, 'a> {
    fn new(context: &'c ProgramContext<'a>, wanted: &'c [u32]) -> Self {
        Collector {
            context,
            uses: context.uses(),
            wanted,
            seen: FxHashSet::default(),
            stretches: BTreeMap::new(),
            lists: FxHashMap::default(),
            home: None,
            rows: None,
            knows_refreshes: false,
        }
    }

    /// Takes in all rungs that write a name.
    fn name(&mut self, number: u32, waiting: &mut Vec<u32>) -> Result<(), Obstacle> {
        let is_wanted = self.wanted.contains(&number);
        let writes: Vec<Use> = self.uses.of_name(number).filter(|one| one.access.act.writes()).collect();
        let Some(name) = self.uses.name(number) else { return Ok(()) };
        if let Some(first) = writes.first() {
            if let Some(variable) = name.variable
                && matches!(variable.section, SectionKind::InOut | SectionKind::Temporary)
            {
                return Err(Obstacle::Passing(first.span));
            }
            self.known_by_one_name(number)?;
        }
        for one in &writes {
            self.write(one, is_wanted, waiting)?;
        }
        if let Key::Device(device) = name.key {
            for one in self.rows_over(device) {
                self.write(&one, is_wanted, waiting)?;
            }
            if device.kind == DeviceKind::X {
                self.refreshes(waiting)?;
            }
        }
        Ok(())
    }

    /// Takes in the rungs that read inputs anew in the middle of a scan.
    fn refreshes(&mut self, waiting: &mut Vec<u32>) -> Result<(), Obstacle> {
        if std::mem::replace(&mut self.knows_refreshes, true) {
            return Ok(());
        }
        for statement in self.context.statements().filter(|one| one.flow() == Some(Flow::Refresh)) {
            let Some((start, chunk, _)) = self.uses.chunk_at(statement.span.start) else { continue };
            let behind = self.context.files().partition_point(|file| file.start <= start);
            let file = behind.saturating_sub(1);
            let stretch = Stretch { start: start as u32, end: (start + chunk.len()) as u32, file };
            self.take(stretch, statement.span, false, waiting)?;
        }
        Ok(())
    }

    /// Formulas know a variable by its name, so what lies at an address may have but one.
    fn known_by_one_name(&self, number: u32) -> Result<(), Obstacle> {
        let Some(name) = self.uses.name(number) else { return Ok(()) };
        let Key::Direct(address) = name.key else { return Ok(()) };
        let mut all = self.uses.of_name(number).map(|one| (one.span, folded(&self.uses.words(&one))));
        let Some((_, words)) = all.next() else { return Ok(()) };
        if let Some((span, _)) = all.find(|(_, other)| *other != words) {
            return Err(Obstacle::Alias(span));
        }
        for (other, name) in self.uses.names() {
            if let Key::Direct(wide) = name.key
                && wide.location == address.location
                && wide.width != Width::Bit
                && let Some(one) = self.uses.of_name(other).find(|one| one.access.act.writes())
            {
                return Err(Obstacle::Alias(one.span));
            }
        }
        Ok(())
    }

    /// Takes in the rung of a place that writes, with all that it has to do with.
    fn write(&mut self, one: &Use, is_wanted: bool, waiting: &mut Vec<u32>) -> Result<(), Obstacle> {
        let home = *self.home.get_or_insert((one.file, one.unit));
        if !self.uses.is_fx && home != (one.file, one.unit) {
            return Err(Obstacle::Elsewhere(one.span));
        }
        let stretch = self.stretch(one).ok_or(Obstacle::Unread(one.span, Refusal::Unreadable))?;
        self.take(stretch, one.span, is_wanted, waiting)?;
        if is_wanted && let Some(refusal) = self.refusal(stretch, one) {
            return Err(Obstacle::Unread(one.span, refusal));
        }
        Ok(())
    }

    /// Takes in a stretch, for what is done at `place`, with all that it has to do with.
    fn take(
        &mut self,
        stretch: Stretch,
        place: Span,
        is_wanted: bool,
        waiting: &mut Vec<u32>,
    ) -> Result<(), Obstacle> {
        let (regions, at) = (self.context.regions(), place.start);
        if regions.may_be_repeated(at) {
            return Err(Obstacle::Loop(place));
        }
        let region = regions.at(at);
        let is_skipped = !region.is_plain() || regions.may_be_skipped(at);
        if is_skipped && (is_wanted || !region.is_in_order()) {
            return Err(Obstacle::Part(place));
        }
        if let Some(known) = self.stretches.get_mut(&stretch) {
            *known |= is_skipped;
        } else {
            self.stretches.insert(stretch, is_skipped);
            if self.stretches.len() > RUNGS_MAX {
                return Err(Obstacle::Large);
            }
            let uses = self.uses;
            for (number, other) in uses.within(stretch.start, stretch.end) {
                waiting.push(number);
                self.row(number, &other, waiting);
            }
        }
        Ok(())
    }

    /// Where several devices are meant, all of them have to do with it.
    fn row(&self, number: u32, one: &Use, waiting: &mut Vec<u32>) {
        let is_part = one.access.part == Part::Inside;
        if one.access.count == 1 && !is_part {
            return;
        }
        let key = |wanted: u32| self.uses.name(wanted).map(|name| name.key);
        let Some(Key::Device(first)) = key(number) else { return };
        let is_covered =
            |device: Device| device.kind == first.kind && (is_part || covers(one, first, device));
        let covered = self
            .uses
            .names()
            .filter(|(_, name)| matches!(name.key, Key::Device(device) if is_covered(device)));
        waiting.extend(covered.map(|(number, _)| number));
    }

    /// The places that write rows of devices in which this one is.
    fn rows_over(&mut self, device: Device) -> Vec<Use> {
        let uses = self.uses;
        if !uses.is_written_in_row(device) {
            return Vec::new();
        }
        let rows = self.rows.get_or_insert_with(|| {
            let rows = |(number, name): (u32, &crate::check::sense::Name<'_>)| {
                let Key::Device(first) = name.key else { return Vec::new() };
                let is_row = |one: &Use| one.access.act.writes() && one.access.count > 1;
                uses.of_name(number).filter(is_row).map(|one| (first, one)).collect()
            };
            uses.names().flat_map(rows).collect()
        });
        let over = rows.iter().filter(|(first, one)| covers(one, *first, device));
        over.map(|(_, one)| *one).collect()
    }

    /// The stretch in which a place stands.
    fn stretch(&mut self, one: &Use) -> Option<Stretch> {
        let file = self.context.files().get(one.file)?;
        if file.document.notation() != Notation::IecIl {
            let (start, chunk) = self.uses.chunk(one)?;
            return Some(Stretch { start: start as u32, end: (start + chunk.len()) as u32, file: one.file });
        }
        let document = file.document;
        let list = self.lists.entry(one.file).or_insert_with(|| List::of(document));
        let at = one.span.start - file.start as u32;
        let rung = list.0.iter().find(|(span, _)| span.start <= at && at < span.end)?.0;
        let rung = rung.shifted(file.start);
        Some(Stretch { start: rung.start, end: rung.end, file: one.file })
    }

    /// Why the rung of a place cannot be read.
    fn refusal(&self, stretch: Stretch, one: &Use) -> Option<Refusal> {
        self.rungs_of(stretch).into_iter().find_map(|(span, path)| {
            let is_here = span.start <= one.span.start && one.span.start <= span.end;
            path.err().filter(|_| is_here)
        })
    }

    /// The rungs of a stretch, at their places in the program.
    fn rungs_of(&self, stretch: Stretch) -> Vec<(Span, Result<Option<Path>, Refusal>)> {
        let Some(file) = self.context.files().get(stretch.file) else { return Vec::new() };
        if let Some(list) = self.lists.get(&stretch.file) {
            let at = |span: &Span| span.shifted(file.start);
            let own = list.0.iter().filter(|(span, _)| at(span).start == stretch.start);
            return own.map(|(span, path)| (at(span), path.clone())).collect();
        }
        let at = self.uses.chunk_at(stretch.start);
        let Some((start, chunk, unit)) = at else { return Vec::new() };
        let reading = chunk.reading();
        let declared =
            Declared { scopes: file.document.scopes(), pous: unit.saturating_sub(chunk.pou_starts()) };
        let rungs = logic::rungs_with(&reading, file.document.reader(), declared);
        rungs.into_iter().map(|rung| (rung.span.shifted(start), rung.path)).collect()
    }

    fn finish(mut self) -> Slice {
        let mut slice = Slice {
            pieces: Vec::new(),
            terms: FxHashMap::default(),
            sources: FxHashMap::default(),
            keys: FxHashMap::default(),
            has_plain_states: !self.context.regions().has_steps,
        };
        let stretches = std::mem::take(&mut self.stretches);
        for (stretch, is_skipped) in stretches {
            let is_special = |number: u32| {
                matches!(self.uses.name(number).map(|name| name.key), Some(Key::Device(device))
                    if device.kind == DeviceKind::M && device.is_special() && !STEADY.contains(&device.number))
            };
            let looks_at_specials =
                self.uses.within(stretch.start, stretch.end).any(|(number, _)| is_special(number));
            for (_, path) in self.rungs_of(stretch) {
                let path = match path {
                    Ok(None) => continue,
                    Ok(Some(path)) => Some(path),
                    Err(_) => None,
                };
                path.iter().for_each(|path| note_terms(path, &mut slice.terms));
                slice.pieces.push(Piece { path, is_skipped, looks_at_specials });
            }
            for (number, one) in self.uses.within(stretch.start, stretch.end) {
                if let Some((key, source)) = self.source(number, &one) {
                    slice.keys.insert(number, key.clone());
                    slice.sources.insert(key, source);
                }
            }
        }
        for number in self.wanted {
            self.name_wanted(*number, &mut slice);
        }
        slice
    }

    /// What is written only as one of several stands in no rung by its name.
    fn name_wanted(&self, number: u32, slice: &mut Slice) {
        let Some(one) = self.uses.of_name(number).next() else { return };
        let Some((key, source)) = self.source(number, &one) else { return };
        // It may stand there as a part of an operand, `K1Y0`. A variable is known by the rung that writes it, or not.
        if let Some(Key::Device(device)) = self.uses.name(number).map(|name| name.key) {
            let term = || Term::of_device(device, Span::default());
            slice.terms.entry(key.clone()).or_insert_with(term);
        }
        slice.keys.entry(number).or_insert_with(|| key.clone());
        slice.sources.entry(key).or_insert(source);
    }

    /// The key under which formulas know what is named at a place, and what is known of it.
    fn source(&self, number: u32, one: &Use) -> Option<(SmolStr, Source)> {
        let (name, acts) = (self.uses.name(number)?, self.uses.acts(number));
        let is_written = acts.writes_but(&[]);
        if let Key::Device(device) = name.key {
            let is_written = is_written || self.uses.is_written_in_row(device);
            let is_latched = self.context.keeps(device);
            let source = match device.kind {
                DeviceKind::X if !is_written => Source::Input,
                _ if device.is_special() => Source::Unknown,
                DeviceKind::M | DeviceKind::Y | DeviceKind::S if !is_written => Source::Input,
                DeviceKind::M | DeviceKind::Y | DeviceKind::S | DeviceKind::T | DeviceKind::C => {
                    if !is_written {
                        Source::Unknown
                    } else if is_latched {
                        Source::Kept
                    } else {
                        Source::Driven
                    }
                }
                _ => Source::Unknown,
            };
            return Some((device.to_smolstr(), source));
        }
        if one.access.part != Part::Whole {
            return None;
        }
        let words = self.uses.words(one);
        let key = match name.key {
            Key::Direct(address) => address.to_smolstr(),
            _ => folded(&words),
        };
        let has_value = acts.has(&[Act::DeclareValue]);
        let is_input_address =
            matches!(name.key, Key::Direct(address) if address.location == Location::Input);
        let source = match is_written {
            _ if has_value => Source::Unknown,
            true if is_input_address => Source::Unknown,
            true => Source::Driven,
            false => Source::Input,
        };
        Some((key, source))
    }
}

/// M8000 to M8003 have their values for a whole scan.
const STEADY: [u32; 4] = [8000, 8001, 8002, 8003];

fn covers(one: &Use, first: Device, device: Device) -> bool {
    if device.kind != first.kind {
        return false;
    }
    match (one.access.part, one.access.count) {
        (Part::Indexed, _) => true,
        (_, Access::OPEN) => device.number >= first.number,
        (_, count) => (first.number..first.number.saturating_add(u32::from(count))).contains(&device.number),
    }
}

/// The words of a rung by their keys.
fn note_terms(path: &Path, terms: &mut FxHashMap<SmolStr, Term>) {
    let mut found: Vec<Term> = Vec::new();
    let mut conditions = Vec::new();
    path.visit(
        &mut |action| {
            found.extend(action.terms.iter().cloned());
            if let logic::Deed::Call(call) = &action.deed {
                found.extend(call.changes(&action.terms));
            }
        },
        &mut |condition| conditions.push(condition),
    );
    for condition in conditions {
        condition.visit(&mut |contact| found.extend(contact.terms.iter().cloned()));
    }
    for term in found {
        if !matches!(term.operand, Operand::Constant { .. } | Operand::Literal(_) | Operand::Text) {
            terms.entry(term.key()).or_insert(term);
        }
    }
}

impl List {
    fn of(document: &Document) -> List {
        let whole = document.chunk_of(&document.text());
        let declared = Declared { scopes: document.scopes(), pous: 0 };
        let rungs = logic::rungs_with(&whole, document.reader(), declared);
        let units: Vec<u32> = match whole.tree() {
            Tree::Iec(tree) => {
                let starts = tree.items.iter().filter(|item| matches!(item.kind, ItemKind::Pou { .. }));
                starts.map(|item| item.span.start).collect()
            }
            _ => Vec::new(),
        };
        // A rung that cannot be read may reach into the next unit.
        let end = |span: Span| {
            let next = units.iter().find(|start| **start > span.start).copied().unwrap_or(u32::MAX);
            Span { start: span.start, end: span.end.min(next) }
        };
        List(rungs.into_iter().map(|rung| (end(rung.span), rung.path)).collect())
    }
}
