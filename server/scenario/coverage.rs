//! What scenarios have shown of a program: the states of its contacts, and which of them decided.
//!
//! A contact is covered when it was seen on and off while it was evaluated. It *decides* in a scan if power at some
//! output of its rung would be otherwise had it alone been otherwise: masking MC/DC, with each contact as a condition
//! of its own, also where two of them read the same device. A contact that decided while it was on and while it was off
//! has the pair of scans that MC/DC wants, for such a rung's power rises and falls with each of its contacts.

use crate::document::Document;
use crate::logic::{Contact, Drive, Expression, Gate, Path};
use crate::simulate::{Code, Machine, Place, Problem, Sight, compile};
use crate::target::{Device, DeviceKind, Operand};
use crate::text::Span;
use crate::translate::Source;
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::AddAssign;
use std::sync::Arc;

/// What was seen of a program.
#[derive(Debug)]
pub struct Coverage {
    watched: Arc<Code>,
    /// In the order of the documents.
    rungs: Vec<RungCoverage>,
    decisions: Vec<Decision>,
    /// What each instruction of the code is.
    seats: Vec<Seat>,
    /// The rungs of which something was seen in this scan.
    touched: Vec<usize>,
}

/// What was seen of a rung.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct RungCoverage {
    /// The number of its document.
    pub document: u32,
    /// Where it stands there.
    pub span: Span,
    /// How often it was evaluated.
    pub evaluated: u64,
    /// Its contacts from left to right and top to bottom.
    pub contacts: Vec<ContactCoverage>,
}

/// What was seen of a contact.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ContactCoverage {
    /// Where it stands.
    pub span: Span,
    /// What it reads, as written.
    pub name: String,
    /// How often it was evaluated while it conducted.
    pub on: u64,
    /// How often it was evaluated while it did not.
    pub off: u64,
    /// Whether it decided while it conducted.
    pub decided_on: bool,
    /// Whether it decided while it did not.
    pub decided_off: bool,
}

/// Numbers of contacts.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counts {
    /// Rungs.
    pub rungs: usize,
    /// Rungs that were evaluated.
    pub evaluated: usize,
    /// Contacts.
    pub contacts: usize,
    /// Contacts that were on and off.
    pub covered: usize,
    /// Contacts that decided while they were on and while they were off.
    pub decided: usize,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, more: Counts) {
        self.rungs += more.rungs;
        self.evaluated += more.evaluated;
        self.contacts += more.contacts;
        self.covered += more.covered;
        self.decided += more.decided;
    }
}

/// What an instruction is.
#[derive(Clone, Copy, Debug)]
enum Seat {
    /// Nothing that is covered.
    Nothing,
    /// This contact of this rung.
    Contact(usize, usize),
    /// Something else in this rung.
    Other(usize),
}

/// How a rung comes to its results.
#[derive(Debug, Default)]
struct Decision {
    path: Path,
    /// The number of the contact at each place of the path; nothing for those that no scan can tell of.
    numbers: FxHashMap<Span, usize>,
    /// What the contacts are in this evaluation.
    values: Vec<Option<bool>>,
    is_open: bool,
    /// Values that were looked at.
    known: FxHashSet<Box<[Option<bool>]>>,
}

/// So many values of a rung's contacts are known again.
const MOST_KNOWN: usize = 4096;

impl ContactCoverage {
    /// Whether it was on and off.
    pub fn is_covered(&self) -> bool {
        self.on > 0 && self.off > 0
    }

    /// Whether it decided while it was on and while it was off.
    pub fn has_decided(&self) -> bool {
        self.decided_on && self.decided_off
    }
}

impl Coverage {
    /// Nothing seen yet of the documents that are one program.
    ///
    /// # Errors
    /// With what keeps the program from running.
    pub fn new(documents: &[&Document]) -> Result<Coverage, Vec<Problem>> {
        let watched = Arc::new(compile(documents, true)?);
        let mut coverage = Coverage {
            watched,
            rungs: Vec::new(),
            decisions: Vec::new(),
            seats: Vec::new(),
            touched: Vec::new(),
        };
        let places = coverage.places(documents.len());
        let mut seats: FxHashMap<Place, Seat> = FxHashMap::default();
        for (number, document) in (0..).zip(documents) {
            for source in Source::within(document, Span::new(0, document.len())) {
                // END and its kin are no rungs that anything could be seen of.
                let is_rung = |path: &&Path| !path.actions().iter().all(|action| action.deed.stands_alone());
                if let Some(path) = source.path().filter(is_rung) {
                    coverage.rung(number, &source, path, &places, &mut seats);
                }
            }
        }
        let mut all = vec![Seat::Nothing; places.values().copied().max().map_or(0, |last| last + 1)];
        for (place, instruction) in &places {
            all[*instruction] = seats.get(place).copied().unwrap_or(Seat::Nothing);
        }
        coverage.seats = all;
        Ok(coverage)
    }

    /// Where the instructions of the code stand, with their numbers.
    fn places(&self, documents: usize) -> FxHashMap<Place, usize> {
        let machine = Machine::<u8>::new(Arc::clone(&self.watched));
        let ranges = (0..documents as u32).map(|number| self.watched.instructions_in(number, 0..usize::MAX));
        let instructions = ranges.flatten();
        instructions.filter_map(|number| Some((machine.place(number)?, number as usize))).collect()
    }

    fn rung(
        &mut self,
        document: u32,
        source: &Source,
        path: &Path,
        places: &FxHashMap<Place, usize>,
        seats: &mut FxHashMap<Place, Seat>,
    ) {
        let number = self.rungs.len();
        let mut contacts = Vec::new();
        let mut decision = Decision { path: path.clone(), ..Decision::default() };
        let place = |span: Span| Place { document, span: span.shifted(source.start) };
        let mut found = Vec::new();
        path.visit(&mut |_| {}, &mut |condition| found.extend(condition.contacts()));
        for contact in found {
            let at = place(contact.span);
            if !places.contains_key(&at) || decision.numbers.contains_key(&contact.span) {
                continue;
            }
            decision.numbers.insert(contact.span, contacts.len());
            seats.insert(at, Seat::Contact(number, contacts.len()));
            contacts.push(ContactCoverage {
                span: at.span,
                name: name_of(contact),
                on: 0,
                off: 0,
                decided_on: false,
                decided_off: false,
            });
        }
        for action in path.actions() {
            seats.entry(place(action.span)).or_insert(Seat::Other(number));
        }
        seats.entry(place(source.rung.span)).or_insert(Seat::Other(number));
        decision.values = vec![None; contacts.len()];
        self.decisions.push(decision);
        self.rungs.push(RungCoverage { document, span: source.span(), evaluated: 0, contacts });
    }

    /// Code that says what it sees.
    pub fn watched(&self) -> Arc<Code> {
        Arc::clone(&self.watched)
    }

    /// What was seen, rung by rung, without contacts of relays that are always on or always off.
    pub fn rungs(&self) -> impl Iterator<Item = RungCoverage> {
        self.rungs.iter().map(|rung| {
            let mut rung = rung.clone();
            rung.contacts.retain(|contact| !is_constant(&contact.name));
            rung
        })
    }

    /// Numbers of the rungs of a document, or of all.
    pub fn counts(&self, document: Option<u32>) -> Counts {
        let mut counts = Counts::default();
        for rung in self.rungs().filter(|rung| document.is_none_or(|number| rung.document == number)) {
            counts.rungs += 1;
            counts.evaluated += usize::from(rung.evaluated > 0);
            counts.contacts += rung.contacts.len();
            counts.covered += rung.contacts.iter().filter(|contact| contact.is_covered()).count();
            counts.decided += rung.contacts.iter().filter(|contact| contact.has_decided()).count();
        }
        counts
    }

    /// Notes what an instruction saw.
    pub fn note(&mut self, sight: Sight<u8>) {
        match self.seats.get(sight.instruction as usize).copied() {
            Some(Seat::Contact(rung, contact)) => {
                let Some(conducts) = sight.conducts.map(|conducts| conducts != 0) else { return };
                if self.decisions[rung].values[contact].is_some() {
                    // A second time in one scan: a loop, or a routine that is called again.
                    self.close(rung);
                }
                self.open(rung);
                self.decisions[rung].values[contact] = Some(conducts);
                let seen = &mut self.rungs[rung].contacts[contact];
                seen.on += u64::from(conducts);
                seen.off += u64::from(!conducts);
            }
            Some(Seat::Other(rung)) => self.open(rung),
            Some(Seat::Nothing) | None => {}
        }
    }

    /// Ends a scan.
    pub fn end_scan(&mut self) {
        for rung in std::mem::take(&mut self.touched) {
            self.close(rung);
        }
    }

    fn open(&mut self, rung: usize) {
        if !std::mem::replace(&mut self.decisions[rung].is_open, true) {
            self.rungs[rung].evaluated += 1;
            self.touched.push(rung);
        }
    }

    /// An evaluation of a rung is over.
    fn close(&mut self, rung: usize) {
        let (decision, seen) = (&mut self.decisions[rung], &mut self.rungs[rung].contacts);
        if !std::mem::take(&mut decision.is_open) {
            return;
        }
        let values: Box<[Option<bool>]> = decision.values.as_slice().into();
        decision.values.fill(None);
        let is_known = seen.iter().all(ContactCoverage::has_decided) || decision.known.contains(&values);
        if is_known || values.contains(&None) {
            return;
        }
        let before = decision.results(&values);
        let mut flipped = values.clone();
        for (number, contact) in seen.iter_mut().enumerate() {
            let is_on = values[number] == Some(true);
            if if is_on { contact.decided_on } else { contact.decided_off } {
                continue;
            }
            flipped[number] = Some(!is_on);
            let decides = decision.results(&flipped) != before;
            flipped[number] = Some(is_on);
            contact.decided_on |= decides && is_on;
            contact.decided_off |= decides && !is_on;
        }
        if decision.known.len() < MOST_KNOWN {
            decision.known.insert(values);
        }
    }
}

impl Decision {
    /// Power at the outputs, and at whatever else power reaches.
    fn results(&self, values: &[Option<bool>]) -> Vec<bool> {
        let mut results = Vec::new();
        self.run(&self.path, true, values, &mut results);
        results
    }

    fn run(&self, path: &Path, power: bool, values: &[Option<bool>], results: &mut Vec<bool>) {
        let mut power = power;
        for gate in &path.gates {
            match gate {
                Gate::Pass(condition) => power &= self.holds(condition, values),
                Gate::Invert => power = !power,
                Gate::Through(_) => results.push(power),
            }
        }
        for drive in &path.drives {
            match drive {
                Drive::Action(_) => results.push(power),
                Drive::Path(path) => self.run(path, power, values, results),
            }
        }
    }

    fn holds(&self, condition: &Expression, values: &[Option<bool>]) -> bool {
        match condition {
            Expression::Constant(value) => *value,
            Expression::Contact(contact) => {
                let number = self.numbers.get(&contact.span);
                number.and_then(|number| values.get(*number).copied().flatten()).unwrap_or(false)
            }
            Expression::Not(part) => !self.holds(part, values),
            Expression::And(parts) => parts.iter().all(|part| self.holds(part, values)),
            Expression::Or(parts) => parts.iter().any(|part| self.holds(part, values)),
        }
    }
}

fn name_of(contact: &Contact) -> String {
    contact.terms.iter().map(|term| term.text.as_str()).collect::<Vec<_>>().join(" ")
}

/// M8000 is on in every scan, M8001 in none.
fn is_constant(name: &str) -> bool {
    let relays = [8000, 8001].map(|number| Operand::Device(Device::new(DeviceKind::M, number)));
    relays.contains(&Operand::read(name, crate::target::Model::Fx3u))
}
