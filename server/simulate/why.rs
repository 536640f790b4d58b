//! Why a device is on or off: the fewest contacts that held it so in a scan, followed back through relays, timers,
//! counters, set coils, steps and master controls.
//!
//! Everything is said of a scan as it was executed: a contact has the value that it saw at its place, and what it saw
//! is followed to the instruction that had written it by then, in the same scan or an earlier one.

mod cut;
pub use cut::Condition;

mod drivers;
pub use drivers::Drivers;

mod seen;

mod literals;

mod subject;
use subject::Subject;

mod calls;

mod skipped;

mod writers;
use writers::Writer;

mod calculated;

use super::{ChangeSearch, Code, Machine, Place, Session, Sight, Value, Variable, instruction_words};
use crate::document::Document;
use crate::ladder::CoilKind;
use crate::logic::Deed;
use crate::target::{Device, DeviceKind, Flow, Operand, Semantics};
use crate::text::{Language, Message};
use drivers::{Driver, Wire};
use literals::Literals;
use seen::Seen;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

/// A reason, and the reasons for it.
#[derive(Clone, PartialEq, Debug)]
pub struct Reason {
    /// The sentence.
    pub message: Message,
    /// The instruction or contact that it is about.
    pub place: Option<Place>,
    /// The scan, from 0 on.
    pub scan: u64,
    /// When it began, in nanoseconds.
    pub time_ns: i64,
    /// Why that was so.
    pub because: Vec<Reason>,
}

impl Reason {
    /// It and the reasons behind it, each with how deep it stands.
    pub fn flat(&self) -> Vec<(usize, &Reason)> {
        let mut all = vec![(0, self)];
        for reason in &self.because {
            all.extend(reason.flat().into_iter().map(|(depth, reason)| (depth + 1, reason)));
        }
        all
    }

    /// A line for each of them, set in by how deep it stands; `place` says where its instruction is.
    pub fn told(&self, language: Language, place: impl Fn(Place) -> String) -> String {
        let line = |(depth, reason): (usize, &Reason)| {
            let at = reason.place.map(|at| format!("  [{}]", place(at))).unwrap_or_default();
            format!("{}{}{at}\n", "  ".repeat(depth), reason.message.render(language))
        };
        self.flat().into_iter().map(line).collect()
    }
}

/// A simulation that is asked why.
pub struct Inquiry<'a> {
    session: &'a Session,
    /// Code of the program that says what it sees.
    watched: &'a Arc<Code>,
    documents: &'a [&'a Document],
    /// The scan that is going on: the PLC as it is there, and what was seen of it.
    open: Option<(&'a Machine<u8>, Rc<Seen>)>,
    drivers: &'a Drivers,
    /// Whether the history is looked through further.
    goes_on: &'a dyn Fn() -> bool,
    known: RefCell<Vec<(u64, Rc<Seen>)>>,
    reasons: RefCell<usize>,
}

/// A moment of a simulation: within a scan, before so many sights.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Moment {
    scan: u64,
    before: usize,
}

/// Something of which it is known whether it lets power through.
#[derive(Clone, PartialEq, Debug)]
enum Literal {
    /// The relay of a contact, with the contact.
    Bit(Subject, Place),
    /// A contact that is more: an edge, a comparison of these; of one in a list what it says.
    Contact(Place, Option<String>, Vec<Subject>),
    /// A master control or a step.
    Rail(Place),
    /// What decides by itself.
    Through(Place),
}

/// Reasons nest no deeper.
const MOST_DEPTH: usize = 8;
/// More reasons are not given at once.
const MOST_REASONS: usize = 80;
/// So many instructions are named that might have driven a device and did not.
const MOST_IDLE: usize = 4;

impl<'a> Inquiry<'a> {
    /// Asks about a session; `watched` is code of `documents`, which are its program, that says what it sees, and
    /// `drivers` are theirs.
    pub fn new(
        session: &'a Session,
        watched: &'a Arc<Code>,
        documents: &'a [&'a Document],
        drivers: &'a Drivers,
    ) -> Inquiry<'a> {
        Inquiry {
            session,
            watched,
            documents,
            open: None,
            drivers,
            goes_on: &|| true,
            known: RefCell::default(),
            reasons: RefCell::default(),
        }
    }

    /// Asks within the scan behind those of the session: the PLC as it is there, and what was seen so far.
    pub fn within(mut self, machine: &'a Machine<u8>, sights: Vec<Sight<u8>>) -> Inquiry<'a> {
        self.open = Some((machine, Rc::new(Seen::new(sights))));
        self
    }

    /// Looks through the history no longer than while `goes_on`, asked after each of its scans; what has not changed by
    /// then is told to be so at least since there.
    pub fn patient(mut self, goes_on: &'a dyn Fn() -> bool) -> Inquiry<'a> {
        self.goes_on = goes_on;
        self
    }

    /// Why a device or variable is what it is after scan number `scan`, from 0 on, or now; nothing for a name or a scan
    /// that is not known.
    pub fn why(&self, name: &str, scan: Option<u64>) -> Option<Reason> {
        let subject = self.subject(name)?;
        let last = self.session.machine().scans() + u64::from(self.open.is_some());
        let scan = scan.map_or(last, |scan| scan.saturating_add(1));
        if scan > last || scan == 0 || scan <= self.session.first_scan() {
            return None;
        }
        *self.reasons.borrow_mut() = 0;
        let moment = Moment { scan, before: self.seen(scan)?.len() };
        let value = self.value(&subject, scan)?;
        Some(self.value_reason(&subject, &value, moment, None, &mut Vec::new()))
    }

    fn seen(&self, scan: u64) -> Option<Rc<Seen>> {
        if let Some((_, seen)) = self.open.as_ref().filter(|_| scan > self.session.machine().scans()) {
            return Some(Rc::clone(seen));
        }
        if let Some((_, seen)) = self.known.borrow().iter().find(|(known, _)| *known == scan) {
            return Some(Rc::clone(seen));
        }
        let seen = Rc::new(Seen::new(self.session.sights(scan, self.watched)?));
        self.known.borrow_mut().push((scan, Rc::clone(&seen)));
        Some(seen)
    }

    /// The PLC after a scan, or within the one that is going on.
    fn machine(&self, scan: u64) -> Option<Machine<u8>> {
        match &self.open {
            Some((machine, _)) if scan > self.session.machine().scans() => Some((*machine).clone()),
            _ => self.session.at(scan),
        }
    }

    fn value(&self, subject: &Subject, scan: u64) -> Option<Value> {
        self.machine(scan).map(|machine| machine.value_inside(subject.variable, 0))
    }

    /// What a variable had when the next instruction of a moment was executed.
    fn value_at(&self, variable: Variable, at: Moment) -> Option<Value> {
        if at.before >= self.seen(at.scan)?.len() {
            return Some(self.machine(at.scan)?.value_inside(variable, 0));
        }
        self.session.inside(at.scan, self.time_of(at.scan)?, self.watched, at.before, |machine| {
            machine.value_inside(variable, 0)
        })
    }

    /// When a scan began, also one that is going on.
    fn time_of(&self, scan: u64) -> Option<i64> {
        let open = self.open.as_ref().map(|(machine, _)| machine.now_ns());
        self.session.time_of(scan).or(open)
    }

    /// Why words are what they are, as far as that is not being told already.
    fn values_of(&self, subjects: &[Subject], at: Moment, asked: &mut Vec<Subject>) -> Vec<Reason> {
        let new: Vec<&Subject> = subjects.iter().filter(|subject| !asked.contains(subject)).collect();
        let reason = |subject: &Subject| {
            let value = self.value_at(subject.variable, at)?;
            Some(self.value_reason(subject, &value, at, None, asked))
        };
        new.into_iter().filter_map(reason).collect()
    }

    fn reason(&self, message: Message, place: Option<Place>, scan: u64, because: Vec<Reason>) -> Reason {
        *self.reasons.borrow_mut() += 1;
        let open = self.open.as_ref().map_or(0, |(machine, _)| machine.now_ns());
        let time_ns = self.session.time_of(scan).unwrap_or(open);
        Reason { message, place, scan: scan.saturating_sub(1), time_ns, because }
    }

    /// How people call it: with what the project says of it.
    fn shown(&self, subject: &Subject) -> String {
        let comments = self.documents.iter().filter_map(|document| {
            let row = document.comments().of_device(subject.device?)?;
            let words = if row.comment.is_empty() { &row.symbol } else { &row.comment };
            (!words.is_empty()).then(|| words.clone())
        });
        match comments.into_iter().next() {
            Some(words) => format!("{} ({words})", subject.name),
            None => subject.name.to_string(),
        }
    }

    fn words(&self, place: Place) -> String {
        let Some(document) = self.documents.get(place.document as usize) else { return String::new() };
        let Some(own) = self.drivers.several_lines(place) else {
            return instruction_words(document, place.span);
        };
        // What a list calculates line by line.
        let text = document.slice(own.span);
        text.lines()
            .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "))
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// What a subject is: `Y0 is on`.
    fn state(&self, subject: &Subject, value: &Value) -> Message {
        let name = self.shown(subject);
        let is_counted = subject.device.is_some_and(|device| device.kind.has_preset());
        match value {
            Value::Bit(true) if is_counted => Message::new("why.contact-on").with("name", name),
            Value::Bit(false) if is_counted => Message::new("why.contact-off").with("name", name),
            Value::Bit(true) => Message::new("why.on").with("name", name),
            Value::Bit(false) => Message::new("why.off").with("name", name),
            value => Message::new("why.is").with("name", name).with("value", value),
        }
    }

    /// Why a subject had a value at a moment; `since` is the scan in which it got it, if that is not the one of the
    /// question.
    fn value_reason(
        &self,
        subject: &Subject,
        value: &Value,
        moment: Moment,
        since: Option<u64>,
        asked: &mut Vec<Subject>,
    ) -> Reason {
        let mut state = self.state(subject, value);
        if let Some(scan) = since {
            let time = self.session.time_of(scan).unwrap_or_default();
            state = Message::new("why.since")
                .with_messages("what", vec![state])
                .with("scan", scan.saturating_sub(1))
                .with("time", super::milliseconds(time));
        }
        let told = |how: Message| {
            Message::new("why.told")
                .with_messages("what", vec![state.clone()])
                .with_messages("how", vec![how])
        };
        let is_asked = asked.contains(subject);
        if asked.len() >= MOST_DEPTH || *self.reasons.borrow() >= MOST_REASONS {
            return self.reason(state, None, moment.scan, Vec::new());
        }
        let machine = self.machine(moment.scan);
        if machine.is_some_and(|machine| machine.is_forced(subject.variable)) {
            return self.reason(told(Message::new("why.forced")), None, moment.scan, Vec::new());
        }
        if let Some(device) = subject.device
            && (device.is_special() || device.kind == DeviceKind::X)
            && self.drivers_of(subject).is_empty()
        {
            return self.outside(subject, device, moment, since, &told);
        }
        if !is_asked && let Some((writer, at)) = self.writer(subject, value, moment) {
            asked.push(subject.clone());
            let reason = self.given(subject, value, &writer, Moment { before: at, ..moment }, &told, asked);
            asked.pop();
            return reason;
        }
        self.kept(subject, value, moment, &told, asked)
    }

    /// An input, or what the PLC drives itself.
    fn outside(
        &self,
        subject: &Subject,
        device: Device,
        moment: Moment,
        since: Option<u64>,
        told: &dyn Fn(Message) -> Message,
    ) -> Reason {
        if device.is_special() {
            return self.reason(told(Message::new("why.special")), None, moment.scan, Vec::new());
        }
        let last = moment.scan.min(self.session.machine().scans());
        let changed = self.session.last_switching(last, subject.variable, self.goes_on);
        let how = match changed.filter(|_| since.is_none()) {
            Some(scan) => Message::new("why.input-since")
                .with("scan", scan.saturating_sub(1))
                .with("time", super::milliseconds(self.session.time_of(scan).unwrap_or_default())),
            None => Message::new("why.input"),
        };
        self.reason(told(how), None, moment.scan, Vec::new())
    }

    /// Who gave something its value before or in a scan, where no instruction is known for it: a person, or a part of
    /// the program that is not followed.
    fn hand(&self, subject: &Subject, scan: u64) -> Message {
        let is_touched = self.session.is_touched(scan, subject.variable);
        Message::new(if is_touched { "why.by-hand" } else { "why.by-program" })
    }

    /// Why something has a value that nothing wrote in this scan, or that it kept by itself.
    fn kept(
        &self,
        subject: &Subject,
        value: &Value,
        moment: Moment,
        told: &dyn Fn(Message) -> Message,
        asked: &mut Vec<Subject>,
    ) -> Reason {
        let variable = subject.variable;
        let of = move |machine: &Machine<u8>| machine.value_inside(variable, 0);
        // The scan itself is over for what was executed before this moment only.
        let last = (moment.scan - 1).max(self.session.first_scan());
        let is_new = self.session.at(last).is_none_or(|machine| of(&machine) != *value);
        if is_new {
            return self.reason(told(self.hand(subject, moment.scan)), None, moment.scan, Vec::new());
        }
        let idle = self.writers_of(subject);
        let mut search = ChangeSearch::new(last, of);
        let Some(changed) = search.look(self.session, self.goes_on) else {
            let since = self.since(Message::new("why.at-least"), search.end());
            return self.reason(told(since), None, moment.scan, Vec::new());
        };
        match changed {
            Some(scan) if scan < moment.scan => {
                let at = self.seen(scan).map(|seen| Moment { scan, before: seen.len() });
                let before = at.and_then(|at| Some((self.writer(subject, value, at)?, at)));
                let Some(((writer, number), at)) = before else {
                    let state = self.state(subject, value);
                    let since = self.since(state, scan);
                    let how = self.hand(subject, scan);
                    let message = Message::new("why.told")
                        .with_messages("what", vec![since])
                        .with_messages("how", vec![how]);
                    return self.reason(message, None, scan, Vec::new());
                };
                let since = self.since(self.state(subject, value), scan);
                let told = |how: Message| {
                    Message::new("why.told")
                        .with_messages("what", vec![since.clone()])
                        .with_messages("how", vec![how])
                };
                asked.push(subject.clone());
                let at = Moment { before: number, ..at };
                let mut reason = self.given(subject, value, &writer, at, &told, asked);
                reason.because.extend(self.passed_over(&writer, value, moment, asked));
                asked.pop();
                reason
            }
            _ if idle.is_empty() => {
                self.reason(told(Message::new("why.nothing-drives")), None, moment.scan, Vec::new())
            }
            _ if asked.contains(subject) => {
                self.reason(told(Message::new("why.from-start")), None, moment.scan, Vec::new())
            }
            _ => {
                asked.push(subject.clone());
                let idle = idle.iter().take(MOST_IDLE);
                let because = idle.map(|writer| self.idle(subject, writer, moment, asked)).collect();
                asked.pop();
                self.reason(told(Message::new("why.never")), None, moment.scan, because)
            }
        }
    }

    /// Why what gave something its value in an earlier scan, and would write it in each, has not done so since.
    fn passed_over(
        &self,
        writer: &Writer,
        value: &Value,
        moment: Moment,
        asked: &mut Vec<Subject>,
    ) -> Option<Reason> {
        let (place, frame) = match writer {
            Writer::Read(driver) if always_writes(driver, value) => (driver.place, driver.frame),
            Writer::Read(_) => return None,
            Writer::Other(own) => (self.place_of(*own), self.watched.iec.names().scope_at(*own)),
        };
        [Some(moment), self.scan_before(moment)].into_iter().flatten().find_map(|at| {
            let because = self.skipped(place, frame, at, asked)?;
            let message = Message::new("why.not-executed").with("instruction", self.words(place));
            Some(self.reason(message, Some(place), at.scan, vec![because]))
        })
    }

    fn since(&self, state: Message, scan: u64) -> Message {
        let time = super::milliseconds(self.session.time_of(scan).unwrap_or_default());
        Message::new("why.since")
            .with_messages("what", vec![state])
            .with("scan", scan.saturating_sub(1))
            .with("time", time)
    }

    /// What an instruction saw last before the sight with this number, and the number of that.
    fn saw(&self, seen: &Seen, driver: &Driver, before: usize) -> Option<(usize, Sight<u8>)> {
        seen.last(self.watched, driver.place, self.frame(driver), before)
    }

    /// The end of the scan before a moment within a scan, in which what comes later in the scan had its last turn.
    fn scan_before(&self, moment: Moment) -> Option<Moment> {
        let is_open = self.open.is_some() && moment.scan > self.session.machine().scans();
        let is_within = is_open || moment.before < self.seen(moment.scan)?.len();
        let scan =
            moment.scan.checked_sub(1).filter(|scan| is_within && *scan > self.session.first_scan())?;
        Some(Moment { scan, before: self.seen(scan)?.len() })
    }

    /// An instruction that might have driven something and did not.
    fn idle(&self, subject: &Subject, writer: &Writer, moment: Moment, asked: &mut Vec<Subject>) -> Reason {
        let driver = match writer {
            Writer::Read(driver) => driver,
            Writer::Other(own) => return self.idly_calculated(subject, *own, moment, asked),
        };
        let instruction = self.words(driver.place);
        let seen = self.seen(moment.scan);
        match seen.and_then(|seen| self.saw(&seen, driver, moment.before)) {
            Some((at, sight)) => {
                let because = self.power(driver, Moment { before: at, ..moment }, sight.power != 0, asked);
                let message = Message::new(manner(driver, sight.power != 0)).with("instruction", instruction);
                self.reason(message, Some(driver.place), moment.scan, because)
            }
            None => {
                let skipped = self.skipped(driver.place, driver.frame, moment, asked);
                if let (None, Some(earlier)) = (&skipped, self.scan_before(moment)) {
                    return self.idle(subject, writer, earlier, asked);
                }
                let because = skipped
                    .or_else(|| driver.rail.and_then(|rail| self.rail_reason(rail, moment, false, asked)));
                let message = Message::new("why.not-executed").with("instruction", instruction);
                self.reason(message, Some(driver.place), moment.scan, because.into_iter().collect())
            }
        }
    }

    /// Why what wrote a value last gave it.
    fn given(
        &self,
        subject: &Subject,
        value: &Value,
        writer: &Writer,
        at: Moment,
        told: &dyn Fn(Message) -> Message,
        asked: &mut Vec<Subject>,
    ) -> Reason {
        match writer {
            Writer::Read(driver) => self.driven(subject, value, driver, at, told, asked),
            Writer::Other(own) => self.calculated(subject, *own, at, told, asked),
        }
    }

    /// Why an instruction that was executed gave a value.
    fn driven(
        &self,
        subject: &Subject,
        value: &Value,
        driver: &Driver,
        at: Moment,
        told: &dyn Fn(Message) -> Message,
        asked: &mut Vec<Subject>,
    ) -> Reason {
        let seen = self.seen(at.scan);
        let has_power = seen.and_then(|seen| seen.at(at.before)).is_some_and(|sight| sight.power != 0);
        if let Deed::Call(call) = &driver.action.deed {
            return self.called(subject, call, driver, at, told, asked);
        }
        let mut because = self.power(driver, at, has_power, asked);
        let key = manner(driver, has_power);
        if let Deed::Compute(computation) = &driver.action.deed
            && let Some((inputs, _)) = computation.operands(&driver.action.terms)
        {
            because.extend(self.values_of(&self.subjects(inputs, driver), self.begun(driver, at), asked));
        }
        let power = Message::new(key).with("instruction", self.words(driver.place));
        let counts = subject.device.filter(|device| device.kind.has_preset() && is_coil(driver));
        let how = match counts.and_then(|device| self.counted(device, driver, at.scan, value)) {
            Some(how) => {
                let because = vec![self.reason(power, Some(driver.place), at.scan, because)];
                return self.reason(told(how), Some(driver.place), at.scan, because);
            }
            None if is_pulse(driver) && has_power && *value == Value::Bit(false) => {
                return self.reason(
                    told(Message::new("why.pulse-over")),
                    Some(driver.place),
                    at.scan,
                    because,
                );
            }
            None => power,
        };
        self.reason(told(how), Some(driver.place), at.scan, because)
    }

    /// How far a timer or counter is.
    fn counted(&self, device: Device, driver: &Driver, scan: u64, value: &Value) -> Option<Message> {
        let machine = self.machine(scan)?;
        let layout = &self.watched.layout;
        let now = machine.memory().word(layout.slot(device)?, 0);
        let preset = match driver.action.terms.get(1)?.operand {
            Operand::Device(register) => machine.memory().word(layout.slot(register)?, 0),
            _ => Value::read(&driver.action.terms.get(1)?.text)?.as_number()? as i64,
        };
        let is_on = *value == Value::Bit(true);
        if device.kind == DeviceKind::C {
            let key = if is_on { "why.counted" } else { "why.counting" };
            return Some(Message::new(key).with("now", now).with("preset", preset));
        }
        let unit_ms = device.range_on(self.watched.target)?.timer_unit_ms.max(1);
        let seconds = |units: i64| units as f64 * f64::from(unit_ms) / 1000.0;
        let key = if is_on { "why.timed" } else { "why.timing" };
        Some(Message::new(key).with("now", seconds(now)).with("preset", seconds(preset)))
    }

    /// The fewest contacts by which power came to an instruction, or did not.
    fn power(&self, driver: &Driver, at: Moment, has_power: bool, asked: &mut Vec<Subject>) -> Vec<Reason> {
        let Some(seen) = self.seen(at.scan) else { return Vec::new() };
        let mut literals = Literals::new(self, &seen, at, driver);
        let rail = driver.rail.and_then(|rail| literals.rail(rail));
        let Some(wire) = driver.wire.as_ref().and_then(|wire| literals.wire(wire)) else { return Vec::new() };
        let condition = Condition::And(rail.into_iter().chain([wire]).collect());
        let known = literals.known;
        let values: Vec<bool> = known.iter().map(|(_, value, _)| *value).collect();
        // What was computed otherwise than is understood here is not explained. A call in a list tells that it is made,
        // and not what it hands over.
        if condition.holds(&values) != has_power && !(driver.frame.is_some() && is_call(driver)) {
            return Vec::new();
        }
        let is_asked =
            |literal: &Literal| matches!(literal, Literal::Bit(subject, _) if asked.contains(subject));
        let costs: Vec<u32> = known.iter().map(|(literal, ..)| u32::from(is_asked(literal))).collect();
        let deciding = condition.decisive(&values, &costs);
        let reasons = deciding.into_iter().map(|number| {
            let (literal, value, number) = &known[number];
            self.literal_reason(literal, *value, Moment { before: *number, ..at }, asked)
        });
        reasons.collect()
    }

    fn literal_reason(&self, literal: &Literal, value: bool, at: Moment, asked: &mut Vec<Subject>) -> Reason {
        match literal {
            Literal::Bit(subject, place) => {
                let reason = self.value_reason(subject, &Value::Bit(value), at, None, asked);
                Reason { place: Some(*place), ..reason }
            }
            Literal::Contact(place, words, compared) => {
                let key = match (words, value) {
                    (None, true) => "why.conducts",
                    (None, false) => "why.blocks",
                    (Some(_), true) => "why.holds",
                    (Some(_), false) => "why.fails",
                };
                let words = words.clone().unwrap_or_else(|| self.words(*place));
                let message = Message::new(key).with("instruction", words);
                let because = self.values_of(compared, at, asked);
                self.reason(message, Some(*place), at.scan, because)
            }
            Literal::Rail(place) => {
                // What it saw itself counts.
                let at = Moment { before: at.before + 1, ..at };
                let reason = self.rail_reason(*place, at, value, asked);
                reason.unwrap_or_else(|| self.through(*place, value, at.scan))
            }
            Literal::Through(place) => self.through(*place, value, at.scan),
        }
    }

    fn through(&self, place: Place, value: bool, scan: u64) -> Reason {
        let key = if value { "why.passes" } else { "why.stops" };
        let message = Message::new(key).with("instruction", self.words(place));
        self.reason(message, Some(place), scan, Vec::new())
    }

    /// Why a step is active or not, or a master control has power.
    fn rail_reason(&self, place: Place, at: Moment, is_on: bool, asked: &mut Vec<Subject>) -> Option<Reason> {
        let driver = self.drivers.rail(place)?;
        let device = driver.action.terms.first()?.operand.device()?;
        if matches!(&driver.action.deed, Deed::Instruction(form) if form.instruction.flow() == Flow::Step) {
            let subject = self.device_subject(device)?;
            let reason = self.value_reason(&subject, &Value::Bit(is_on), at, None, asked);
            return Some(Reason { place: Some(place), ..reason });
        }
        let seen = self.seen(at.scan)?;
        let (number, sight) = seen.last(self.watched, place, None, at.before)?;
        let key = if sight.power != 0 { "why.powered" } else { "why.unpowered" };
        let because = self.power(driver, Moment { before: number, ..at }, sight.power != 0, asked);
        let message = Message::new(key).with("instruction", self.words(place));
        Some(self.reason(message, Some(place), at.scan, because))
    }
}

/// Whether an instruction that is executed with this power gives a device this value, or may give it one.
fn writes(driver: &Driver, has_power: bool, value: &Value) -> bool {
    let is_on = *value == Value::Bit(true);
    match &driver.action.deed {
        // Entering another step leaves this one.
        _ if driver.leaves => has_power && !is_on,
        Deed::Coil(CoilKind::Set) => has_power && is_on,
        Deed::Coil(CoilKind::Reset) => has_power && !is_on,
        // The coil of a state in a step enters it, and takes nothing away.
        Deed::Coil(CoilKind::Plain) if is_state(driver) && driver.rail.is_some() => has_power && is_on,
        Deed::Coil(_) => true,
        Deed::Call(call) => !call.is_enabled() || has_power,
        Deed::Instruction(form) => match form.instruction.semantics {
            Semantics::Always(_) | Semantics::Basic => true,
            _ => has_power,
        },
        _ => has_power,
    }
}

/// Whether an instruction gives a device this value, or may give it one, whenever it is executed.
fn always_writes(driver: &Driver, value: &Value) -> bool {
    let is_bare = manner(driver, true) == "why.executed";
    is_bare || [false, true].into_iter().all(|power| writes(driver, power, value))
}

/// How it is told that an instruction is executed with power or without.
fn manner(driver: &Driver, has_power: bool) -> &'static str {
    match (&driver.action.deed, &driver.wire) {
        // Nothing is connected with what a list calculates.
        (Deed::Compute(_), Some(Wire::Series(parts))) if parts.is_empty() => "why.executed",
        _ if has_power => "why.powered",
        _ => "why.unpowered",
    }
}

fn is_state(driver: &Driver) -> bool {
    let first = driver.action.terms.first().and_then(|term| term.operand.device());
    first.is_some_and(|device| device.kind == DeviceKind::S)
}

/// Whether it is the coil of a timer or counter.
fn is_coil(driver: &Driver) -> bool {
    matches!(driver.action.deed, Deed::Coil(CoilKind::Plain)) && driver.action.terms.len() > 1
}

fn is_call(driver: &Driver) -> bool {
    matches!(driver.action.deed, Deed::Call(_))
}

fn is_pulse(driver: &Driver) -> bool {
    matches!(driver.action.deed, Deed::Coil(CoilKind::Rising | CoilKind::Falling))
}
