//! What scenarios have shown of a program: the states of its contacts, and which of them decided.
//!
//! A contact is covered when it was seen on and off while it was evaluated. It *decides* in a scan if power at some
//! output of its rung would be otherwise had it alone been otherwise: masking MC/DC, with each contact as a condition
//! of its own, also where two of them read the same device. A contact that decided while it was on and while it was off
//! has the pair of scans that MC/DC wants, for such a rung's power rises and falls with each of its contacts.
//!
//! A list of IEC 61131-3 has conditions besides: BOOL operands, comparisons, and what jumps, calls and returns go by.
//! Where what they do with each other is calculated, and no rung that is read as logic, it is told of them whether they
//! held and did not, and not whether they decided.

use crate::document::{Document, Notation};
use crate::ladder::ContactKind;
use crate::logic::{Contact, Deed, Drive, Expression, Gate, Path, Test};
use crate::simulate::{Code, Place, Problem, Sight, compile, instruction_words};
use crate::target::{Device, DeviceKind, Operand};
use crate::text::Span;
use crate::translate::Source;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;
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
    /// What it reads, as written; of a condition that no contact is what stands there.
    pub name: String,
    /// What it asks of what it reads.
    pub kind: ConditionKind,
    /// How often it was evaluated while it conducted.
    pub on: u64,
    /// How often it was evaluated while it did not.
    pub off: u64,
    /// Whether it decided while it conducted.
    pub decided_on: bool,
    /// Whether it decided while it did not.
    pub decided_off: bool,
    /// Whether its rung is read as logic, so that it is known whether it decides.
    pub is_decidable: bool,
}

/// What a contact asks of what it reads.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ConditionKind {
    /// That it is on.
    On,
    /// That it is off.
    Off,
    /// More: an edge, a comparison, what has been calculated.
    Other,
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
    /// Contacts of which that can be known.
    pub decidable: usize,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, more: Counts) {
        self.rungs += more.rungs;
        self.evaluated += more.evaluated;
        self.contacts += more.contacts;
        self.covered += more.covered;
        self.decided += more.decided;
        self.decidable += more.decidable;
    }
}

/// What an instruction is.
#[derive(Clone, Copy, Debug)]
enum Seat {
    /// Nothing that is covered.
    Nothing,
    /// This contact of this rung.
    Contact(usize, usize),
    /// This condition of this rung, which is not read as logic.
    Condition(usize, usize),
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
    /// Nothing seen yet.
    fn new(span: Span, name: String, kind: ConditionKind, is_decidable: bool) -> ContactCoverage {
        let (on, off, decided_on, decided_off) = (0, 0, false, false);
        ContactCoverage { span, name, kind, on, off, decided_on, decided_off, is_decidable }
    }

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
            seats: vec![Seat::Nothing; watched.places().len()],
            watched,
            rungs: Vec::new(),
            decisions: Vec::new(),
            touched: Vec::new(),
        };
        let places = Places::of(&coverage.watched, documents);
        for (number, document) in (0..).zip(documents) {
            for source in Source::within(document, Span::new(0, document.len())) {
                coverage.rung(&places, number, document, &source);
            }
        }
        Ok(coverage)
    }

    fn rung(&mut self, places: &Places, document: u32, text: &Document, source: &Source) {
        let number = self.rungs.len();
        let place = |span: Span| Place { document, span: span.shifted(source.start) };
        // END and its kin are no rungs that anything could be seen of.
        let is_rung = |path: &&Path| !path.actions().iter().all(|action| action.deed.stands_alone());
        let path = source.path().filter(is_rung);
        let mut decision = Decision { path: path.cloned().unwrap_or_default(), ..Decision::default() };
        let mut contacts = Vec::new();
        let mut found = Vec::new();
        decision
            .path
            .visit(&mut |_| {}, &mut |condition| found.extend(condition.contacts().into_iter().cloned()));
        for contact in found {
            let at = place(contact.span);
            let own = places.conditions_at(at);
            if own.is_empty() || decision.numbers.contains_key(&contact.span) {
                continue;
            }
            decision.numbers.insert(contact.span, contacts.len());
            self.sit(&own, Seat::Contact(number, contacts.len()));
            let name = name_of(&contact, text.notation());
            contacts.push(ContactCoverage::new(at.span, name, kind_of(&contact), true));
        }
        decision.values = vec![None; contacts.len()];
        // What is calculated line by line.
        for (span, own) in places.within(document, source.span()) {
            let is_free = |instruction: &u32| matches!(self.seats[*instruction as usize], Seat::Nothing);
            if !own.iter().all(is_free) || path.is_some_and(|path| !calculates(path, span, source.start)) {
                continue;
            }
            self.sit(own, Seat::Condition(number, contacts.len()));
            let words = instruction_words(text, span);
            contacts.push(ContactCoverage::new(span, words, ConditionKind::Other, false));
        }
        if path.is_none() && contacts.is_empty() {
            return;
        }
        for action in decision.path.actions() {
            self.sit_free(&places.at(place(action.span)), Seat::Other(number));
        }
        self.sit_free(&places.at(place(source.rung.span)), Seat::Other(number));
        self.decisions.push(decision);
        self.rungs.push(RungCoverage { document, span: source.span(), evaluated: 0, contacts });
    }

    fn sit(&mut self, instructions: &[u32], seat: Seat) {
        for instruction in instructions {
            self.seats[*instruction as usize] = seat;
        }
    }

    fn sit_free(&mut self, instructions: &[u32], seat: Seat) {
        let is_free = |instruction: &&u32| matches!(self.seats[**instruction as usize], Seat::Nothing);
        let free: Vec<u32> = instructions.iter().filter(is_free).copied().collect();
        self.sit(&free, seat);
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
            counts.decidable += rung.contacts.iter().filter(|contact| contact.is_decidable).count();
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
            Some(Seat::Condition(rung, condition)) => {
                let Some(holds) = sight.conducts.map(|conducts| conducts != 0) else { return };
                self.open(rung);
                let seen = &mut self.rungs[rung].contacts[condition];
                seen.on += u64::from(holds);
                seen.off += u64::from(!holds);
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
        // Behind the contacts stand conditions that are not read as logic.
        let seen = &mut seen[..decision.values.len()];
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

/// Where conditions stand, with the instructions that are compiled of them: one for each instance of a unit.
struct Places {
    /// By document and start.
    conditions: BTreeMap<(u32, u32), (Span, Vec<u32>)>,
    all: FxHashMap<Place, Vec<u32>>,
    /// The same of lists of IEC 61131-3 by the ends, for contacts there are operands.
    ends: FxHashMap<(u32, u32), Vec<u32>>,
    are_conditions: FxHashSet<u32>,
}

impl Places {
    fn of(code: &Code, documents: &[&Document]) -> Places {
        let are_conditions: FxHashSet<u32> = code.conditions().collect();
        let (mut conditions, mut all, mut ends) =
            (BTreeMap::new(), FxHashMap::<_, Vec<u32>>::default(), FxHashMap::<_, Vec<u32>>::default());
        for (number, place) in (0..).zip(code.places()) {
            all.entry(*place).or_default().push(number);
            let notation = documents.get(place.document as usize).map(|document| document.notation());
            if notation == Some(Notation::IecIl) {
                ends.entry((place.document, place.span.end)).or_default().push(number);
            }
            if are_conditions.contains(&number) {
                let at = (place.document, place.span.start);
                conditions.entry(at).or_insert_with(|| (place.span, Vec::new())).1.push(number);
            }
        }
        Places { conditions, all, ends, are_conditions }
    }

    /// The instructions of what stands at a place.
    fn at(&self, place: Place) -> Vec<u32> {
        let exactly = self.all.get(&place);
        exactly.or_else(|| self.ends.get(&(place.document, place.span.end))).cloned().unwrap_or_default()
    }

    /// The same as far as they tell whether a condition holds.
    fn conditions_at(&self, place: Place) -> Vec<u32> {
        let mut own = self.at(place);
        own.retain(|instruction| self.are_conditions.contains(instruction));
        own
    }

    /// The conditions within a rung.
    fn within(&self, document: u32, rung: Span) -> impl Iterator<Item = (Span, &[u32])> {
        let own = self.conditions.range((document, rung.start)..(document, rung.end));
        own.map(|(_, (span, instructions))| (*span, instructions.as_slice()))
    }
}

/// Whether an action of a rung is a calculation in which something stands.
fn calculates(path: &Path, span: Span, start: usize) -> bool {
    path.actions().iter().any(|action| {
        let own = action.span.shifted(start);
        matches!(action.deed, Deed::Compute(_)) && own.start <= span.start && span.end <= own.end
    })
}

fn kind_of(contact: &Contact) -> ConditionKind {
    match contact.test {
        Test::Bit(ContactKind::NormallyOpen) => ConditionKind::On,
        Test::Bit(ContactKind::NormallyClosed) => ConditionKind::Off,
        _ => ConditionKind::Other,
    }
}

fn name_of(contact: &Contact, notation: Notation) -> String {
    if let (Test::Compare(how), [left, right], Notation::IecIl) = (contact.test, &contact.terms[..], notation)
    {
        return format!("{} {} {}", left.text, how.iec_name(), right.text);
    }
    contact.terms.iter().map(|term| term.text.as_str()).collect::<Vec<_>>().join(" ")
}

/// M8000 is on in every scan, M8001 in none.
fn is_constant(name: &str) -> bool {
    let relays = [8000, 8001].map(|number| Operand::Device(Device::new(DeviceKind::M, number)));
    relays.contains(&Operand::read(name, crate::target::Model::Fx3u))
}
