//! Runs paths with formulas in place of bits: what is done, under which conditions, in which order.

use super::changes::Changes;
use super::formula::{Atom, Moment, Step};
use super::number::{is_real, number, range};
use super::{Action, Contact, Deed, Drive, Expression, Formula, Formulas, Gate, Path, Term, Test, WIDE};
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::target::iec::LiteralValue;
use crate::target::{Constant, Device, DeviceKind, Operand};
use crate::text::folded;
use rustc_hash::FxHashMap;
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
    /// Which of them may have changed what.
    changes: Changes,
    /// Bits that were driven.
    driven: FxHashMap<SmolStr, Driven<'p>>,
    /// Whether what is compared is the outcome, not each effect in turn: steps then have their values.
    by_outcome: bool,
    /// The power at the left rail.
    rail: Formula,
    /// The last contact for an edge of each relay that has one memory for all of them.
    asked: FxHashMap<SmolStr, u32>,
}

/// A bit that was driven.
#[derive(Clone, Copy, Debug)]
struct Driven<'p> {
    term: &'p Term,
    value: Formula,
    /// How many events there had been.
    since: u32,
}

impl<'p> Run<'p> {
    /// A run in which nothing was done.
    pub fn new() -> Run<'p> {
        Run {
            effects: Vec::new(),
            changes: Changes::default(),
            driven: FxHashMap::default(),
            by_outcome: false,
            rail: Formulas::TRUE,
            asked: FxHashMap::default(),
        }
    }

    /// The same for a program without steps, in which states are relays like others.
    pub fn without_steps() -> Run<'p> {
        Run { changes: Changes::without_steps(), ..Run::new() }
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
            let guard = formulas.atom(Atom::Behind(self.events() + 1));
            self.event(action, guard, formulas);
        }
    }

    /// Passes something that nobody can read, and that may change anything.
    pub fn unread(&mut self, formulas: &mut Formulas) {
        self.changes.unread(formulas);
    }

    /// Lets time pass, in which the CPU may change the special relays that it owns.
    pub fn pause(&mut self) {
        self.changes.pause();
    }

    /// How many events there were.
    pub fn events(&self) -> u32 {
        self.changes.events()
    }

    /// A relay whose edges contacts of the two runs took in different ways, so that those of later scans differ.
    pub fn asks_otherwise<'r>(&'r self, other: &'r Run<'_>) -> Option<&'r SmolStr> {
        let mut relays = self.asked.keys().chain(other.asked.keys());
        relays.find(|relay| self.asked.get(*relay) != other.asked.get(*relay))
    }

    /// Whether only bits were driven.
    pub fn is_boolean(&self) -> bool {
        self.events() == 0
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
                        None => formulas.atom(Atom::Behind(self.events())),
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
        let driven = self.driven.get(name).filter(|driven| driven.since >= self.changes.last(term, name));
        driven.map(|driven| driven.value).or_else(|| term.always().map(Formulas::constant))
    }

    /// The moment at which `term`, whose key is `name`, is read as a bit.
    fn moment(&self, term: &Term, name: SmolStr, formulas: &mut Formulas) -> Moment {
        let since = self.changes.since(term, &name, formulas);
        Moment { name, since }
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
            Operand::Variable if self.driven.contains_key(&key) => self.changes.since_any(),
            _ if wide => self.changes.since_pair(term, &key, formulas),
            _ => self.changes.since(term, &key, formulas),
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
            self.changes.drive(term, known, formulas);
            self.driven.insert(key, Driven { term, value, since: self.events() });
            return;
        }
        let own = action.terms.first().filter(|_| matches!(action.deed, Deed::Coil(_)));
        let before = own.map(|own| self.bit(own, formulas));
        self.event(action, guard, formulas);
        let (Some(term), Some(before)) = (own, before) else { return };
        let after = self.bit(term, formulas);
        if let Some(value) = known_after(action, guard, [before, after], formulas) {
            self.driven.insert(term.key(), Driven { term, value, since: self.events() });
        }
    }

    /// Does something of which nothing is known afterwards.
    fn event(&mut self, action: &'p Action, guard: Formula, formulas: &mut Formulas) {
        let reads = match &action.deed {
            Deed::Call(call) => {
                let kept = call.kept_inputs(&action.terms);
                action.terms.iter().skip(1).chain(&kept).map(|term| self.bit(term, formulas)).collect()
            }
            Deed::Compute(_) => action.terms.iter().map(|term| self.bit(term, formulas)).collect(),
            _ => Vec::new(),
        };
        self.changes.event(action, formulas);
        self.effects.push(Effect { action, guard, event: Some(self.events()), reads });
    }

    /// The bit that a coil drives and its value then; nothing if more happens than that.
    fn bit_driven(
        &self,
        action: &'p Action,
        guard: Formula,
        formulas: &mut Formulas,
    ) -> Option<(&'p Term, Formula)> {
        let [term] = &action.terms[..] else { return None };
        if !self.changes.is_lone(term) {
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
