//! Mutants: programs with one fault each. Scenarios that pass with a mutant as they do without it have not shown that
//! what it changes matters.

use super::{Bench, Golden, Scenario};
use crate::document::{Document, Edit, Notation};
use crate::il::iec::ItemKind;
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Term, Test};
use crate::target::iec::{Datum, ElementaryType, LiteralValue, spelled};
use crate::target::{Constant, Device, DeviceKind, Model, Operand};
use crate::text::{Message, Span};
use crate::translate::{Proof, Rewritten, Source, prove, rewritten};

/// A program with one fault.
#[derive(Clone, PartialEq, Debug)]
pub struct Mutant {
    /// The number of the document with the fault.
    pub document: usize,
    /// Where the fault is.
    pub span: Span,
    /// What it is.
    pub change: Change,
    /// The rung, by its number among those of the document, and the fault by its number in the rung.
    rung: usize,
    number: usize,
}

/// What is otherwise in a mutant.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Change {
    /// A contact conducts where it did not, and the other way round.
    Opposite(String),
    /// A contact is left out: power always passes there.
    Bridged(String),
    /// A branch that begins with this contact is left out.
    Cut(String),
    /// A coil sets where it reset, or the other way round; whether it sets now.
    Latch(String, bool),
    /// A timer or counter has another preset.
    Preset(String, String),
    /// Something is done with another constant: what that is about, the new constant and the old one.
    Constant(String, String, String),
}

/// What became of a mutant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fate {
    /// A scenario failed with it.
    Killed,
    /// All scenarios passed, and nothing shows that it does the same as the program.
    Survived,
    /// It is proved to do the same as the program, so no scenario can tell.
    Equivalent,
    /// The program with the fault is none that runs.
    Invalid,
    /// It cannot be written, so nothing is known of it.
    Unwritten,
}

impl Change {
    /// The sentence that says it.
    pub fn message(&self) -> Message {
        match self {
            Change::Opposite(name) => Message::new("mutant.opposite").with("name", name),
            Change::Bridged(name) => Message::new("mutant.bridged").with("name", name),
            Change::Cut(name) => Message::new("mutant.cut").with("name", name),
            Change::Latch(name, true) => Message::new("mutant.set").with("name", name),
            Change::Latch(name, false) => Message::new("mutant.reset").with("name", name),
            Change::Preset(name, preset) => {
                Message::new("mutant.preset").with("name", name).with("preset", preset)
            }
            Change::Constant(name, new, old) => {
                Message::new("mutant.constant").with("name", name).with("new", new).with("old", old)
            }
        }
    }
}

/// The mutants of a program.
pub struct Mutants<'d> {
    documents: &'d [&'d Document],
    sources: Vec<Vec<Source>>,
    all: Vec<Mutant>,
}

impl<'d> Mutants<'d> {
    /// All mutants of the documents that are one program, in the order of the text.
    pub fn of(documents: &'d [&'d Document]) -> Mutants<'d> {
        let mut sources = Vec::new();
        let mut all = Vec::new();
        for (number, document) in documents.iter().enumerate() {
            let own = Source::within(document, Span::new(0, document.len()));
            for (rung, source) in own.iter().enumerate() {
                // A list that a drawing carries along in a box would be drawn in its place.
                let is_boxed = source.rung.is_list && document.notation() == Notation::Ladder;
                let Some(path) = source.path().filter(|_| !is_boxed) else { continue };
                let mut faults = Faults { wanted: None, found: Vec::new() };
                faults.path(path);
                let mutants = faults.found.into_iter().enumerate().map(|(fault, (span, change))| Mutant {
                    document: number,
                    span: span.shifted(source.start),
                    change,
                    rung,
                    number: fault,
                });
                all.extend(mutants);
            }
            sources.push(own);
        }
        all.sort_by_key(|mutant| (mutant.document, mutant.span.start));
        Mutants { documents, sources, all }
    }

    /// At most so many of them, in the order of the text; which ones follows from `seed` alone.
    pub fn sample(&self, most: usize, seed: u64) -> Vec<&Mutant> {
        let mut lots: Vec<(u64, usize)> = (0..self.all.len()).map(|at| (lot(seed, at as u64), at)).collect();
        lots.sort_unstable();
        lots.truncate(most);
        lots.sort_unstable_by_key(|(_, at)| *at);
        lots.into_iter().filter_map(|(_, at)| self.all.get(at)).collect()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The documents of the program with the fault of `mutant`; nothing if it cannot be written.
    pub fn documents(&self, mutant: &Mutant) -> Option<Vec<Document>> {
        let document = self.documents.get(mutant.document)?;
        let source = self.sources.get(mutant.document)?.get(mutant.rung)?;
        let mut faults = Faults { wanted: Some(mutant.number), found: Vec::new() };
        let path = faults.path(source.path()?);
        let Rewritten { mut text, declarations } = rewritten(document, source, path).ok()?;
        let span = match document.notation() {
            Notation::Ladder => lines(document, source.span()),
            _ => source.span(),
        };
        while text.ends_with('\n') {
            text.pop();
        }
        // Below rails that are indented the drawing goes on.
        let (_, _, first) = document.line_at(span.start as usize);
        if document.notation() == Notation::Ladder && is_drawn(&first) {
            let indent = &first[..first.len() - first.trim_start().len()];
            text = text.lines().map(|line| format!("{indent}{line}")).collect::<Vec<_>>().join("\n");
        }
        let mut changed = (*document).clone();
        changed.apply(&[Edit { range: Some(span.start as usize..span.end as usize), text }]);
        if !declarations.is_empty() {
            // The head of the unit stands before the rung, so it is where it was.
            let at = behind_head(document, source)?;
            changed.apply(&[Edit { range: Some(at..at), text: format!("\n{declarations}") }]);
        }
        let own = |(number, document): (usize, &&Document)| match number == mutant.document {
            true => changed.clone(),
            false => (*document).clone(),
        };
        Some(self.documents.iter().enumerate().map(own).collect())
    }

    /// What becomes of a mutant that runs these scenarios, which pass without the fault.
    pub fn fate(&self, mutant: &Mutant, scenarios: &[(&Scenario, Option<&Golden>)]) -> Fate {
        let Some(documents) = self.documents(mutant) else { return Fate::Unwritten };
        let seen: Vec<&Document> = documents.iter().collect();
        let Ok(bench) = Bench::new(&seen) else { return Fate::Invalid };
        let is_killed = scenarios.iter().any(|(scenario, golden)| {
            bench.run(scenario, *golden, None).map_or(true, |report| !report.is_passed())
        });
        if is_killed {
            return Fate::Killed;
        }
        match (self.documents.get(mutant.document), documents.get(mutant.document)) {
            (Some(left), Some(right)) if matches!(prove(left, right), Proof::Equal { .. }) => {
                Fate::Equivalent
            }
            _ => Fate::Survived,
        }
    }
}

/// Where the head of the program unit ends in which a rung stands, as `PROGRAM Main`.
fn behind_head(document: &Document, source: &Source) -> Option<usize> {
    let unit = document.unit_at(source.span().start as usize);
    unit.number?;
    let mut start = unit.span.start as usize;
    while start < unit.span.end as usize
        && let Some(at) = document.chunk_at(start).filter(|at| at.start == start)
    {
        let mut items = at.chunk.iec().into_iter().flat_map(|tree| &tree.items);
        if let Some(head) = items.find(|item| matches!(item.kind, ItemKind::Pou { .. })) {
            return Some(start + head.span.end as usize);
        }
        start += at.chunk.len();
    }
    None
}

/// The lines in which a drawing stands, with rails that begin above it or end below it: beside the rails of another
/// drawing they would be part of it, and have no end.
fn lines(document: &Document, span: Span) -> Span {
    let (_, start, _) = document.line_at(span.start as usize);
    let end = end_of_line(document, span.end as usize).max(span.end as usize);
    let (mut above, mut below) = (start, end);
    while above > 0 && is_bare_rail(&document.line_at(above - 1).2) {
        above = document.line_at(above - 1).1;
    }
    while below + 1 < document.len() && is_bare_rail(&document.line_at(below + 1).2) {
        below = end_of_line(document, below + 1);
    }
    // Rails that lead to another rung belong to both.
    let leads_on = |offset: Option<usize>| offset.is_some_and(|at| is_drawn(&document.line_at(at).2));
    let start = if leads_on(above.checked_sub(1)) { start } else { above };
    let end = if leads_on((below + 1 < document.len()).then_some(below + 1)) { end } else { below };
    Span::new(start, end)
}

/// Where the line ends in which an offset lies, before what ends it.
fn end_of_line(document: &Document, offset: usize) -> usize {
    let (_, start, text) = document.line_at(offset);
    start + text.trim_end_matches(['\r', '\n']).len()
}

fn is_bare_rail(line: &str) -> bool {
    let line = line.trim();
    !line.is_empty() && line.chars().all(|sign| matches!(sign, '|' | '│' | ' ' | '\t'))
}

fn is_drawn(line: &str) -> bool {
    line.trim_start().starts_with(['|', '│', '+', '├', '└'])
}

/// Splitmix64 of Sebastiano Vigna, which is in the public domain.
pub(super) fn lot(seed: u64, number: u64) -> u64 {
    let mut lot = seed.wrapping_add(number.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    lot = (lot ^ (lot >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    lot = (lot ^ (lot >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    lot ^ (lot >> 31)
}

/// Goes over a rung, notes the faults that it may have, and makes the one that is wanted.
struct Faults {
    wanted: Option<usize>,
    found: Vec<(Span, Change)>,
}

impl Faults {
    /// Notes a fault; whether it is the wanted one.
    fn fault(&mut self, span: Span, change: Change) -> bool {
        self.found.push((span, change));
        self.wanted == Some(self.found.len() - 1)
    }

    fn path(&mut self, path: &Path) -> Path {
        let mut gates = Vec::new();
        for gate in &path.gates {
            match gate {
                Gate::Pass(condition) => match self.condition(condition, Beside::Series) {
                    Expression::Constant(true) if path.gates.len() > 1 => {}
                    condition => gates.push(Gate::Pass(condition)),
                },
                Gate::Through(action) => gates.push(Gate::Through(self.action(action))),
                Gate::Invert => gates.push(Gate::Invert),
            }
        }
        let drives = path.drives.iter().map(|drive| match drive {
            Drive::Action(action) => Drive::Action(self.action(action)),
            Drive::Path(path) => Drive::Path(self.path(path)),
        });
        Path { gates, drives: drives.collect() }
    }

    fn condition(&mut self, condition: &Expression, beside: Beside) -> Expression {
        match condition {
            Expression::Constant(value) => Expression::Constant(*value),
            Expression::Contact(contact) => self.contact(contact, beside),
            Expression::Not(part) => Expression::Not(Box::new(self.condition(part, Beside::Series))),
            Expression::And(parts) => {
                let parts: Vec<Expression> =
                    parts.iter().map(|part| self.condition(part, Beside::Series)).collect();
                Expression::and(parts)
            }
            Expression::Or(parts) => {
                let mut left = Vec::new();
                for part in parts {
                    let first =
                        part.contacts().first().map(|contact| (contact.span, name_of(&contact.terms)));
                    let is_cut = first.is_some_and(|(span, name)| self.fault(span, Change::Cut(name)));
                    let part = self.condition(part, Beside::Parallel);
                    if !is_cut {
                        left.push(part);
                    }
                }
                Expression::or(left)
            }
        }
    }

    fn contact(&mut self, contact: &Contact, beside: Beside) -> Expression {
        let name = name_of(&contact.terms);
        let opposite = match contact.test {
            Test::Bit(ContactKind::Rising) => Some(Test::Bit(ContactKind::Falling)),
            Test::Bit(ContactKind::Falling) => Some(Test::Bit(ContactKind::Rising)),
            test => test.opposite(),
        };
        let mut made = contact.clone();
        if let Some(test) = opposite
            && self.fault(contact.span, Change::Opposite(name.clone()))
        {
            made.test = test;
        }
        self.constants(contact.span, &mut made.terms);
        // One that is a branch alone is left out with its branch.
        let is_bridged = beside == Beside::Series && self.fault(contact.span, Change::Bridged(name));
        if is_bridged { Expression::Constant(true) } else { Expression::Contact(made) }
    }

    fn action(&mut self, action: &Action) -> Action {
        let mut made = action.clone();
        let name = action.terms.first().map(|term| term.text.to_string()).unwrap_or_default();
        match &action.deed {
            Deed::Coil(kind @ (CoilKind::Set | CoilKind::Reset)) if is_relay(&action.terms) => {
                let sets = *kind == CoilKind::Reset;
                if self.fault(action.span, Change::Latch(name, sets)) {
                    made.deed = Deed::Coil(if sets { CoilKind::Set } else { CoilKind::Reset });
                }
            }
            Deed::Coil(CoilKind::Plain) => {
                let [counted, preset] = &action.terms[..] else { return made };
                let Some(other) = other_preset(counted, preset) else { return made };
                if self.fault(action.span, Change::Preset(name, other.text.to_string())) {
                    made.terms[1] = other;
                }
            }
            Deed::Instruction(_) | Deed::Call(_) | Deed::Compute(_) => {
                self.constants(action.span, &mut made.terms);
            }
            _ => {}
        }
        made
    }

    /// Each constant among the operands of something may be another one.
    fn constants(&mut self, span: Span, terms: &mut [Term]) {
        let is_named = |term: &&Term| other_constant(term).is_none();
        let about = terms.iter().find(is_named).map(|term| term.text.to_string()).unwrap_or_default();
        for term in terms {
            let Some(other) = other_constant(term) else { continue };
            let (new, old) = (other.text.to_string(), term.text.to_string());
            if self.fault(span, Change::Constant(about.clone(), new, old)) {
                *term = other;
            }
        }
    }
}

/// How a condition is connected.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Beside {
    Series,
    Parallel,
}

/// Whether the operand may be set as well as reset.
fn is_relay(terms: &[Term]) -> bool {
    match terms.first().map(|term| term.operand) {
        Some(Operand::Device(device)) => device.kind.is_bit() && !device.kind.has_preset(),
        Some(_) => true,
        None => false,
    }
}

/// A counter counts one more. A timer takes twice as long: a unit more or less is seldom anybody's business.
fn other_preset(counted: &Term, preset: &Term) -> Option<Term> {
    let Operand::Constant { value: Constant::Decimal(number), index: None } = preset.operand else {
        return None;
    };
    let is_timer = matches!(counted.operand, Operand::Device(Device { kind: DeviceKind::T, .. }));
    let other = match is_timer {
        true => number.checked_mul(2).filter(|twice| *twice <= i64::from(i16::MAX)).unwrap_or(number / 2),
        false => number.checked_add(1).filter(|more| *more <= i64::from(i32::MAX))?,
    };
    let operand = Operand::Constant { value: Constant::Decimal(other), index: None };
    (other != number).then(|| Term::new(operand, &format!("K{other}"), preset.span))
}

/// A number is one more, a time twice as long.
fn other_constant(term: &Term) -> Option<Term> {
    let text = match term.operand {
        Operand::Constant { value: Constant::Decimal(number), index: None } => {
            format!("K{}", number.checked_add(1).filter(|more| *more <= i64::from(i32::MAX))?)
        }
        Operand::Literal(literal) => match literal.value {
            LiteralValue::Integer(number) => {
                let named = literal.named_type.map(|kind| format!("{kind}#")).unwrap_or_default();
                format!("{named}{}", number.checked_add(1)?)
            }
            LiteralValue::Time(time) => {
                spelled(&Datum::Whole(time.checked_mul(2)?.into()), ElementaryType::Time).to_string()
            }
            _ => return None,
        },
        _ => return None,
    };
    let model = if matches!(term.operand, Operand::Literal(_)) { Model::Iec } else { Model::Fx3u };
    let other = Term::new(Operand::read(&text, model), &text, term.span);
    (other.text != term.text).then_some(other)
}

fn name_of(terms: &[Term]) -> String {
    terms.iter().map(|term| term.text.as_str()).collect::<Vec<_>>().join(" ")
}
