//! Runs paths with formulas in place of bits: what is done, under which conditions, in which order.

use super::formula::{Atom, Moment, Step};
use super::number::{is_real, number, range};
use super::{
    Action, Contact, Deed, Drive, Expression, Formula, Formulas, Gate, Path, Storage, Term, Test, WIDE,
    wholes,
};
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::target::iec::LiteralValue;
use crate::target::{Access, Constant, Device, DeviceKind, Flow, Form, Location, Operand};
use crate::text::folded;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};

/// Something that is done, and the condition.
#[derive(Clone, Debug)]
pub struct Effect<'p> {
    /// What is done. That of a negated coil is done under the inverse of its power, and then is that of a plain one.
    pub action: &'p Action,
    /// When, over the atoms at the start of the run.
    pub guard: Formula,
    /// Its number among the events, from 1; nothing if it drives a bit whose value is known.
    pub event: Option<u32>,
    /// What a call or a calculation is handed over: the value of each of its operands but the instance, and of the
    /// inputs that the instance keeps.
    pub reads: Vec<Formula>,
}

impl Effect<'_> {
    /// What is done, with negation moved into the guard.
    pub fn deed(&self) -> Deed {
        match &self.action.deed {
            Deed::Coil(CoilKind::Negated) => Deed::Coil(CoilKind::Plain),
            deed => deed.clone(),
        }
    }

    /// Whether two effects do the same to the same operands, whatever the conditions.
    pub fn is_like(&self, other: &Effect<'_>) -> bool {
        let counts_alike = || self.counted().is_some_and(|own| other.counted() == Some(own));
        self.deed() == other.deed() && (self.action.terms == other.action.terms || counts_alike())
    }

    /// The timer or counter of 16 bits that a coil drives, and the constant up to which it counts: 0 works as 1 does.
    fn counted(&self) -> Option<(Device, i64)> {
        let (Deed::Coil(_), [own, preset]) = (&self.action.deed, &self.action.terms[..]) else { return None };
        let device =
            own.operand.device().filter(|device| device.kind == DeviceKind::T || device.number < 200)?;
        match preset.operand {
            Operand::Constant { value: Constant::Decimal(number @ 0..), index: None } => {
                Some((device, number.max(1)))
            }
            _ => None,
        }
    }
}

/// A run through rungs.
///
/// Most outputs are bits whose value is known when they are driven, and what reads them later reads that value. What
/// else an action does is an event: afterwards nothing is known of the devices that it may have changed.
#[derive(Debug)]
pub struct Run<'p> {
    /// What was done, in order.
    pub effects: Vec<Effect<'p>>,
    /// How many of the effects are events.
    events: u32,
    /// Bits that were driven.
    driven: FxHashMap<SmolStr, Driven<'p>>,
    /// What has parts that were driven.
    parted: FxHashSet<SmolStr>,
    /// The last event, counted from 1, that may have changed this device.
    changed: FxHashMap<SmolStr, u32>,
    /// The last event that may have changed any device of a kind; the last place is for variables.
    kinds: [u32; KINDS],
    /// The last step that changed anything of a kind: what words made of such bits depend on.
    touched: [u32; KINDS],
    /// Whether what is compared is the outcome, not each effect in turn: steps then have their values.
    by_outcome: bool,
    /// The power at the left rail.
    rail: Formula,
    /// The last event that may have set special relays: flags of arithmetic and of completion.
    flags: u32,
    /// The last event that may have changed whatever is no plain variable of the own program unit.
    known: u32,
    /// The last contact for an edge of each relay that has one memory for all of them.
    asked: FxHashMap<SmolStr, u32>,
    /// Whether states are relays like others, as in a program without steps.
    has_plain_states: bool,
}

/// A bit that was driven.
#[derive(Clone, Copy, Debug)]
struct Driven<'p> {
    term: &'p Term,
    value: Formula,
    /// How many events there had been.
    since: u32,
}

/// One for each kind of device, one for variables, one for each area of addresses, and one for variables that may lie
/// anywhere.
const KINDS: usize = DeviceKind::ALL.len() + 5;
const VARIABLES: usize = DeviceKind::ALL.len();
const ANYWHERE: usize = KINDS - 1;

impl<'p> Run<'p> {
    /// A run in which nothing was done.
    pub fn new() -> Run<'p> {
        Run {
            effects: Vec::new(),
            events: 0,
            driven: FxHashMap::default(),
            parted: FxHashSet::default(),
            changed: FxHashMap::default(),
            kinds: [0; KINDS],
            touched: [0; KINDS],
            by_outcome: false,
            rail: Formulas::TRUE,
            flags: 0,
            known: 0,
            asked: FxHashMap::default(),
            has_plain_states: false,
        }
    }

    /// The same for a program without steps, in which states are relays like others.
    pub fn without_steps() -> Run<'p> {
        Run { has_plain_states: true, ..Run::new() }
    }

    /// The same for a comparison of outcomes, where effects need not pair. `rail` is the power at the left rail, which
    /// is off in what a master control or a step leaves out.
    pub fn by_outcome(rail: Formula) -> Run<'p> {
        Run { by_outcome: true, rail, ..Run::new() }
    }

    /// Runs a rung.
    pub fn path(&mut self, path: &'p Path, formulas: &mut Formulas) {
        self.powered(path, self.rail, formulas);
    }

    /// Passes a rung that may be executed or not: nothing is known afterwards of what it drives.
    pub fn maybe(&mut self, path: &'p Path, formulas: &mut Formulas) {
        for action in path.actions() {
            let guard = formulas.atom(Atom::Behind(self.events + 1));
            self.event(action, guard, formulas);
        }
    }

    /// Passes something that nobody can read, and that may change anything.
    pub fn unread(&mut self, formulas: &mut Formulas) {
        self.events += 1;
        self.change_all(formulas);
    }

    /// Lets time pass, in which the CPU may change the special relays that it owns.
    pub fn pause(&mut self) {
        self.events += 1;
        self.flags = self.events;
    }

    /// How many events there were.
    pub fn events(&self) -> u32 {
        self.events
    }

    /// A relay whose edges contacts of the two runs took in different ways, so that those of later scans differ.
    pub fn asks_otherwise<'r>(&'r self, other: &'r Run<'_>) -> Option<&'r SmolStr> {
        let mut relays = self.asked.keys().chain(other.asked.keys());
        relays.find(|relay| self.asked.get(*relay) != other.asked.get(*relay))
    }

    /// Whether only bits were driven.
    pub fn is_boolean(&self) -> bool {
        self.events == 0
    }

    /// The bits that were driven.
    pub fn bits(&self) -> impl Iterator<Item = &'p Term> {
        self.driven.values().map(|driven| driven.term)
    }

    /// The value of a bit where the run stands.
    pub fn bit(&self, term: &Term, formulas: &mut Formulas) -> Formula {
        if let Operand::Literal(literal) = &term.operand
            && let LiteralValue::Bool(value) = literal.value
        {
            return Formulas::constant(value);
        }
        let name = term.key();
        if let Some(value) = self.value(term, &name) {
            return value;
        }
        if matches!(term.operand, Operand::Device(Device::OFF_AT_FIRST)) {
            let first = self.bit(&Term::of_device(Device::FIRST_SCAN, term.span), formulas);
            return formulas.not(first);
        }
        let of = self.moment(term, name, formulas);
        formulas.atom(Atom::Bit(of))
    }

    fn powered(&mut self, path: &'p Path, power: Formula, formulas: &mut Formulas) {
        let mut power = power;
        for gate in &path.gates {
            power = match gate {
                Gate::Pass(expression) => {
                    let condition = self.condition(expression, formulas);
                    formulas.and([power, condition])
                }
                Gate::Invert => formulas.not(power),
                Gate::Through(action) => {
                    self.act(action, power, formulas);
                    match action.power_out() {
                        Some(output) => self.bit(&output, formulas),
                        None => formulas.atom(Atom::Behind(self.events)),
                    }
                }
            };
        }
        for drive in &path.drives {
            match drive {
                Drive::Action(action) => self.act(action, power, formulas),
                Drive::Path(path) => self.powered(path, power, formulas),
            }
        }
    }

    /// Whether `expression` lets power pass where the run stands.
    pub fn condition(&mut self, expression: &Expression, formulas: &mut Formulas) -> Formula {
        match expression {
            Expression::Constant(value) => Formulas::constant(*value),
            Expression::Contact(contact) => self.contact(contact, formulas),
            Expression::Not(part) => {
                let part = self.condition(part, formulas);
                formulas.not(part)
            }
            Expression::And(parts) => {
                let parts: Vec<Formula> = parts.iter().map(|part| self.condition(part, formulas)).collect();
                formulas.and(parts)
            }
            Expression::Or(parts) => {
                let parts: Vec<Formula> = parts.iter().map(|part| self.condition(part, formulas)).collect();
                formulas.or(parts)
            }
        }
    }

    /// Whether a contact conducts where the run stands, which may take an edge from those behind it.
    pub fn contact(&mut self, contact: &Contact, formulas: &mut Formulas) -> Formula {
        match (contact.test, &contact.terms[..]) {
            (Test::Bit(kind), [term]) => match kind {
                ContactKind::NormallyOpen => self.bit(term, formulas),
                ContactKind::NormallyClosed => {
                    let bit = self.bit(term, formulas);
                    formulas.not(bit)
                }
                ContactKind::Rising | ContactKind::Falling => {
                    let name = term.key();
                    let value = self.value(term, &name);
                    let rising = kind == ContactKind::Rising;
                    if let Some(edge) = self.edge_of_scans(term, rising, formulas) {
                        return edge;
                    }
                    let is_single =
                        matches!(term.operand, Operand::Device(device) if device.has_single_edge());
                    let of = self.moment(term, name.clone(), formulas);
                    if !is_single {
                        return formulas.atom(Atom::Edge { of, value, rising });
                    }
                    let before = self.asked.get(&name).copied().unwrap_or(0);
                    let step = formulas.step(Step::Asked { before, of, value, rising });
                    self.asked.insert(name, step);
                    formulas.atom(Atom::SingleEdge(step))
                }
            },
            (Test::Compare(operator), [left, right]) => self.compare(operator, left, right, formulas),
            _ => Formulas::FALSE,
        }
    }

    /// The edge of a special relay that tells of the scan, if the program leaves it to the CPU: before the first scan
    /// all of them count as off, and no edge falls in it.
    fn edge_of_scans(&self, term: &Term, rising: bool, formulas: &mut Formulas) -> Option<Formula> {
        let Operand::Device(device) = term.operand else { return None };
        match (device, rising) {
            (Device::ALWAYS_OFF, _) => Some(Formulas::FALSE),
            _ if !formulas.is_straight() => None,
            (Device::ALWAYS_ON | Device::FIRST_SCAN, true) => {
                Some(self.bit(&Term::of_device(Device::FIRST_SCAN, term.span), formulas))
            }
            (Device::ALWAYS_ON | Device::OFF_AT_FIRST, false) => Some(Formulas::FALSE),
            // It comes on when the other one goes off.
            (Device::OFF_AT_FIRST, true) => {
                let first = Term::of_device(Device::FIRST_SCAN, term.span);
                let of = self.moment(&first, first.key(), formulas);
                Some(formulas.atom(Atom::Edge { of, value: None, rising: false }))
            }
            _ => None,
        }
    }

    /// The value that the run gave to `term`, whose key is `name`, or that it always has.
    fn value(&self, term: &Term, name: &SmolStr) -> Option<Formula> {
        let driven = self.driven.get(name).filter(|driven| driven.since >= self.last_event(term, name));
        driven.map(|driven| driven.value).or_else(|| term.always().map(Formulas::constant))
    }

    /// The moment at which `term`, whose key is `name`, is read as a bit.
    fn moment(&self, term: &Term, name: SmolStr, formulas: &mut Formulas) -> Moment {
        // Words are made of bits, bits of words: whatever wrote to the kind counts.
        let is_apart = self.is_apart(term) || term.is_own_part();
        let since = match is_apart && !self.parted.contains(&name) {
            true => self.after(self.last_event(term, &name), formulas),
            false if leads_anywhere(term) => self.touched[ANYWHERE],
            false => self.touched[slot(term)],
        };
        Moment { name, since }
    }

    /// The step that an event is; 0 for none.
    fn after(&self, event: u32, formulas: &mut Formulas) -> u32 {
        if event == 0 { 0 } else { formulas.step(Step::Event { number: event, before: 0 }) }
    }

    /// The last event that may have changed `term`.
    fn last_event(&self, term: &Term, name: &SmolStr) -> u32 {
        let own = self.changed.get(name).copied().unwrap_or(0);
        let around = wholes(name).filter_map(|whole| self.changed.get(whole).copied()).max().unwrap_or(0);
        own.max(around).max(self.bulk(term))
    }

    /// The last event that may have changed `term` together with others.
    fn bulk(&self, term: &Term) -> u32 {
        let is_flag = matches!(term.operand, Operand::Device(device) if device.is_special());
        let known = if term.storage == Storage::Local { 0 } else { self.known };
        self.kinds[slot(term)].max(known).max(if is_flag { self.flags } else { 0 })
    }

    /// All comparisons in terms of "at least".
    fn compare(
        &self,
        operator: CompareOperator,
        left: &Term,
        right: &Term,
        formulas: &mut Formulas,
    ) -> Formula {
        use CompareOperator::*;
        let wide = operator.is_wide();
        let holds = match operator {
            GreaterOrEqual { .. } => self.at_least(left, right, wide, formulas),
            LessOrEqual { .. } => self.at_least(right, left, wide, formulas),
            Less { .. } => {
                let at_least = self.at_least(left, right, wide, formulas);
                formulas.not(at_least)
            }
            Greater { .. } => {
                let at_least = self.at_least(right, left, wide, formulas);
                formulas.not(at_least)
            }
            Equal { .. } | NotEqual { .. } => {
                let sides =
                    [self.at_least(left, right, wide, formulas), self.at_least(right, left, wide, formulas)];
                formulas.and(sides)
            }
        };
        let holds = self.of_numbers(holds, [left, right], formulas);
        if matches!(operator, NotEqual { .. }) { formulas.not(holds) } else { holds }
    }

    /// A comparison that fails where one of its sides is no number.
    fn of_numbers(&self, holds: Formula, sides: [&Term; 2], formulas: &mut Formulas) -> Formula {
        let reals = sides.into_iter().filter(|side| formulas.type_of(&side.key()).is_some_and(is_real));
        let reals: Vec<&Term> = reals.collect();
        let mut all = vec![holds];
        for side in reals {
            let word = self.word(side, false, formulas);
            let is_none = formulas.atom(Atom::NoNumber(word));
            all.push(formulas.not(is_none));
        }
        formulas.and(all)
    }

    fn at_least(&self, left: &Term, right: &Term, wide: bool, formulas: &mut Formulas) -> Formula {
        let sides = [(left, right), (right, left)].map(|(own, other)| number(own, other, wide, formulas));
        let known = match sides {
            [Some(left), Some(right)] => return Formulas::constant(left >= right),
            [None, Some(number)] => self.reaches(left, number, wide, formulas),
            // 10 ≥ D0 unless D0 ≥ 11.
            [Some(number), None] => {
                let beyond = self.reaches(right, number + 1, wide, formulas);
                beyond.map(|beyond| formulas.not(beyond))
            }
            [None, None] => None,
        };
        known.unwrap_or_else(|| {
            let [word, other] = [left, right].map(|term| self.word(term, wide, formulas));
            match word == other {
                true => Formulas::TRUE,
                false => formulas.atom(Atom::AtLeast { word, other }),
            }
        })
    }

    /// Whether `term` is at least `number`; nothing if that is too large a number to work with.
    fn reaches(&self, term: &Term, number: i128, wide: bool, formulas: &mut Formulas) -> Option<Formula> {
        let range = range(term, wide, formulas);
        if range.least.is_some_and(|least| number <= least) {
            return Some(Formulas::TRUE);
        }
        if range.greatest.is_some_and(|greatest| number > greatest) {
            return Some(Formulas::FALSE);
        }
        let number = i64::try_from(number).ok()?;
        let word = self.word(term, wide, formulas);
        Some(formulas.atom(Atom::Reaches { word, number }))
    }

    /// The moment at which `term` is read as a word.
    fn word(&self, term: &Term, wide: bool, formulas: &mut Formulas) -> Moment {
        let key = term.key();
        let name = match wide {
            true => format_smolstr!("{WIDE}{key}"),
            // An INT and a UINT at one address are two numbers, which no scan with plain values has.
            false if term.address().is_some() && formulas.is_of_many_types(&key) => {
                format_smolstr!("{key} {}", folded(&term.text))
            }
            false => key.clone(),
        };
        let since = match term.operand {
            Operand::Literal(_) | Operand::Constant { index: None, .. } => 0,
            // A variable whose type nobody knows was driven as a bit.
            Operand::Variable if self.driven.contains_key(&key) => self.touched[ANYWHERE],
            _ => self.moment(term, key, formulas).since,
        };
        Moment { name, since }
    }

    fn act(&mut self, action: &'p Action, power: Formula, formulas: &mut Formulas) {
        let guard = match action.deed {
            Deed::Coil(CoilKind::Negated) => formulas.not(power),
            _ => power,
        };
        // Whatever is inverted on the way, nothing is done without power at the left rail.
        let guard = formulas.and([guard, self.rail]);
        if let Some((term, value)) = self.bit_driven(action, guard, formulas) {
            self.effects.push(Effect { action, guard, event: None, reads: Vec::new() });
            let key = term.key();
            let known = self.by_outcome.then_some(value);
            let place = slot(term);
            self.parted.extend(wholes(&key).map(SmolStr::from));
            // A variable in a place of its own is part of no word. An element may be read by a subscript that varies.
            let is_element = term.is_element();
            for slot in [place, ANYWHERE].into_iter().filter(|slot| *slot != VARIABLES || is_element) {
                let before = self.touched[slot];
                self.touched[slot] = formulas.step(Step::Driven { before, key: key.clone(), value: known });
            }
            self.driven.insert(key, Driven { term, value, since: self.events });
            return;
        }
        let own = action.terms.first().filter(|_| matches!(action.deed, Deed::Coil(_)));
        let before = own.map(|own| self.bit(own, formulas));
        self.event(action, guard, formulas);
        let (Some(term), Some(before)) = (own, before) else { return };
        let after = self.bit(term, formulas);
        if let Some(value) = known_after(action, guard, [before, after], formulas) {
            self.driven.insert(term.key(), Driven { term, value, since: self.events });
        }
    }

    /// Does something of which nothing is known afterwards.
    fn event(&mut self, action: &'p Action, guard: Formula, formulas: &mut Formulas) {
        self.events += 1;
        let reads = match &action.deed {
            Deed::Call(call) => {
                let kept = call.kept_inputs(&action.terms);
                action.terms.iter().skip(1).chain(&kept).map(|term| self.bit(term, formulas)).collect()
            }
            Deed::Compute(_) => action.terms.iter().map(|term| self.bit(term, formulas)).collect(),
            _ => Vec::new(),
        };
        self.effects.push(Effect { action, guard, event: Some(self.events), reads });
        self.change(action, formulas);
    }

    /// Notes what the event that just happened may have changed.
    fn change(&mut self, action: &Action, formulas: &mut Formulas) {
        match &action.deed {
            Deed::Instruction(form) if writes_operands(*form) => {
                action.changes().iter().for_each(|term| self.change_kind(slot(term), formulas));
                self.flags = self.events;
                self.touch(ANYWHERE, formulas);
            }
            // What is done meanwhile elsewhere, nobody knows here.
            Deed::Instruction(_) => self.change_all(formulas),
            Deed::Call(call) if call.keeps_in_out() => self.change_all(formulas),
            deed => {
                if action.runs_unit() {
                    self.change_known(formulas);
                }
                if matches!(deed, Deed::Call(_)) {
                    self.touch(VARIABLES, formulas);
                }
                action.changes().iter().for_each(|term| self.change_term(term, formulas));
            }
        }
    }

    fn change_all(&mut self, formulas: &mut Formulas) {
        self.kinds = [self.events; KINDS];
        self.touched = [self.after(self.events, formulas); KINDS];
        self.flags = self.events;
    }

    /// Anything may have changed but the plain variables that only their program unit knows.
    fn change_known(&mut self, formulas: &mut Formulas) {
        let variables = self.kinds[VARIABLES];
        self.change_all(formulas);
        self.kinds[VARIABLES] = variables;
        self.known = self.events;
    }

    fn change_term(&mut self, term: &Term, formulas: &mut Formulas) {
        self.changed.insert(term.key(), self.events);
        match self.is_apart(term) {
            true => self.touch(slot(term), formulas),
            // Setting one state resets others; a word has its bits and those beside it.
            false => self.change_kind(slot(term), formulas),
        }
    }

    /// Anything of a kind may have changed. What may lie anywhere may be any variable.
    fn change_kind(&mut self, slot: usize, formulas: &mut Formulas) {
        let slots = if slot == ANYWHERE { VARIABLES..KINDS } else { slot..slot + 1 };
        for slot in slots {
            self.kinds[slot] = self.events;
            self.touch(slot, formulas);
        }
    }

    /// The last event changed something of a kind.
    fn touch(&mut self, slot: usize, formulas: &mut Formulas) {
        for slot in [slot, ANYWHERE] {
            let step = Step::Event { number: self.events, before: self.touched[slot] };
            self.touched[slot] = formulas.step(step);
        }
    }

    /// Whether it is a bit by itself, so that a coil that writes to it does nothing else.
    fn is_lone(&self, term: &Term) -> bool {
        let is_state = matches!(term.operand, Operand::Device(device) if device.kind == DeviceKind::S);
        term.is_lone() || (self.has_plain_states && is_state)
    }

    /// Whether nothing but writing to it changes it: a bit by itself, a timer or a counter.
    fn is_apart(&self, term: &Term) -> bool {
        self.is_lone(term) || matches!(term.operand, Operand::Device(device) if device.kind.has_preset())
    }

    /// The bit that a coil drives and its value then; nothing if more happens than that.
    fn bit_driven(
        &self,
        action: &'p Action,
        guard: Formula,
        formulas: &mut Formulas,
    ) -> Option<(&'p Term, Formula)> {
        let [term] = &action.terms[..] else { return None };
        if !self.is_lone(term) {
            return None;
        }
        let value = match &action.deed {
            Deed::Coil(CoilKind::Plain | CoilKind::Negated) => guard,
            Deed::Coil(CoilKind::Set) => {
                let before = self.bit(term, formulas);
                formulas.or([before, guard])
            }
            Deed::Coil(CoilKind::Reset) => {
                let before = self.bit(term, formulas);
                let idle = formulas.not(guard);
                formulas.and([before, idle])
            }
            _ => return None,
        };
        Some((term, value))
    }
}

impl Default for Run<'_> {
    fn default() -> Self {
        Run::new()
    }
}

/// Whether an instruction changes what it names and flags, and nothing else. One that names nothing to change refreshes
/// inputs, resets annunciators, or steers the program.
fn writes_operands(form: Form) -> bool {
    let is_written = form.instruction.operands.iter().any(|spec| spec.access != Access::Read);
    is_written && form.instruction.flow() == Flow::Straight
}

/// Whether it depends on more than devices of its kind: on an index register, or on flags that instructions set.
fn leads_anywhere(term: &Term) -> bool {
    match term.operand {
        Operand::Indexed { .. }
        | Operand::Nibbles { index: Some(_), .. }
        | Operand::Constant { index: Some(_), .. } => true,
        Operand::Nibbles { first, .. } => first.is_special(),
        _ => false,
    }
}

/// What the bit of a coil is afterwards whose event leaves it as `after` says, as far as its working is known: a timer
/// does not run without power, SET leaves nothing off, a pulse comes with power alone.
fn known_after(
    action: &Action,
    guard: Formula,
    [before, after]: [Formula; 2],
    formulas: &mut Formulas,
) -> Option<Formula> {
    let device = action.terms.first().and_then(|term| match term.operand {
        Operand::Device(device) => Some(device),
        _ => None,
    })?;
    let idle = formulas.not(guard);
    Some(match action.deed {
        Deed::Coil(CoilKind::Plain) if device.is_forgetful_timer() => {
            let on = formulas.or([before, after]);
            formulas.and([guard, on])
        }
        Deed::Coil(CoilKind::Rising) => formulas.and([guard, after]),
        Deed::Coil(CoilKind::Falling) => formulas.and([idle, after]),
        Deed::Coil(CoilKind::Set) => formulas.or([guard, before]),
        Deed::Coil(CoilKind::Reset) => formulas.and([idle, before]),
        _ => return None,
    })
}

/// The place of a term's kind.
fn slot(term: &Term) -> usize {
    let area = |location: Location| VARIABLES + 1 + location as usize;
    match (term.operand, term.storage) {
        (Operand::Direct(address), _) => area(address.location),
        (Operand::Variable, Storage::At(address)) => area(address.location),
        (Operand::Variable, Storage::Anywhere) => ANYWHERE,
        _ => term.operand.device().map_or(VARIABLES, |device| device.kind as usize),
    }
}
