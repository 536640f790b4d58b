//! Runs paths with formulas in place of bits: what is done, under which conditions, in which order.

use super::formula::{Atom, Moment};
use super::{Action, Contact, Deed, Drive, Expression, Formula, Formulas, Gate, Path, Term, Test};
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::target::iec::LiteralValue;
use crate::target::{Access, Constant, DeviceKind, Flow, Operand, Width};
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
}

impl Effect<'_> {
    /// What is done, with negation moved into the guard.
    pub fn deed(&self) -> Deed {
        match self.action.deed {
            Deed::Coil(CoilKind::Negated) => Deed::Coil(CoilKind::Plain),
            deed => deed,
        }
    }

    /// Whether two effects do the same to the same operands, whatever the conditions.
    pub fn is_like(&self, other: &Effect<'_>) -> bool {
        self.deed() == other.deed() && self.action.terms == other.action.terms
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
    /// The last event, counted from 1, that may have changed this device.
    changed: FxHashMap<SmolStr, u32>,
    /// The last event that may have changed any device of a kind; the last place is for variables.
    kinds: [u32; KINDS],
    /// The last effect, counted from 1, that changed anything of a kind: what words made of such bits depend on.
    touched: [u32; KINDS],
    /// The last event that may have set special relays: flags of arithmetic and of completion.
    flags: u32,
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

/// One for each kind of device, and one for variables.
const KINDS: usize = DeviceKind::ALL.len() + 1;
const VARIABLES: usize = KINDS - 1;

impl<'p> Run<'p> {
    /// A run in which nothing was done.
    pub fn new() -> Run<'p> {
        Run {
            effects: Vec::new(),
            events: 0,
            driven: FxHashMap::default(),
            changed: FxHashMap::default(),
            kinds: [0; KINDS],
            touched: [0; KINDS],
            flags: 0,
            has_plain_states: false,
        }
    }

    /// The same for a program without steps, in which states are relays like others.
    pub fn without_steps() -> Run<'p> {
        Run { has_plain_states: true, ..Run::new() }
    }

    /// Runs a rung.
    pub fn path(&mut self, path: &'p Path, formulas: &mut Formulas) {
        self.powered(path, Formulas::TRUE, formulas);
    }

    /// Passes a rung that may be executed or not: nothing is known afterwards of what it drives.
    pub fn maybe(&mut self, path: &'p Path, formulas: &mut Formulas) {
        for action in path.actions() {
            let guard = formulas.atom(Atom::Behind(self.events + 1));
            self.event(action, guard);
        }
    }

    /// Passes something that nobody can read, and that may change anything.
    pub fn unread(&mut self) {
        self.events += 1;
        self.kinds = [self.events; KINDS];
        self.touched = [self.effects.len() as u32 + 1; KINDS];
        self.flags = self.events;
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
        self.value(term, &name).unwrap_or_else(|| {
            let of = self.moment(term, name);
            formulas.atom(Atom::Bit(of))
        })
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
    pub fn condition(&self, expression: &Expression, formulas: &mut Formulas) -> Formula {
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

    /// Whether a contact conducts where the run stands.
    pub fn contact(&self, contact: &Contact, formulas: &mut Formulas) -> Formula {
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
                    let of = self.moment(term, name);
                    formulas.atom(Atom::Edge { of, value, rising: kind == ContactKind::Rising })
                }
            },
            (Test::Compare(operator), [left, right]) => self.compare(operator, left, right, formulas),
            _ => Formulas::FALSE,
        }
    }

    /// The value that the run gave to `term`, whose key is `name`.
    fn value(&self, term: &Term, name: &SmolStr) -> Option<Formula> {
        let driven = self.driven.get(name)?;
        (driven.since >= self.last_event(term, name)).then_some(driven.value)
    }

    /// The moment at which `term`, whose key is `name`, is read.
    fn moment(&self, term: &Term, name: SmolStr) -> Moment {
        // Words are made of bits, bits of words, and an index may lead anywhere: whatever wrote to the kind counts.
        let since = if self.is_apart(term) { self.last_event(term, &name) } else { self.touched[slot(term)] };
        Moment { name, since }
    }

    /// The last event that may have changed `term`.
    fn last_event(&self, term: &Term, name: &SmolStr) -> u32 {
        let own = self.changed.get(name).copied().unwrap_or(0);
        own.max(self.bulk(term))
    }

    /// The last event that may have changed `term` together with others.
    fn bulk(&self, term: &Term) -> u32 {
        let is_flag = matches!(term.operand, Operand::Device(device)
            if device.kind == DeviceKind::M && device.number >= FIRST_SPECIAL);
        self.kinds[slot(term)].max(if is_flag { self.flags } else { 0 })
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
        match operator {
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
                let equal = formulas.and(sides);
                if matches!(operator, Equal { .. }) { equal } else { formulas.not(equal) }
            }
        }
    }

    fn at_least(&self, left: &Term, right: &Term, wide: bool, formulas: &mut Formulas) -> Formula {
        match (number(left, wide), number(right, wide)) {
            (Some(left), Some(right)) => Formulas::constant(left >= right),
            (None, Some(number)) => self.reaches(left, number, wide, formulas),
            // 10 ≥ D0 unless D0 ≥ 11.
            (Some(number), None) => {
                let beyond = self.reaches(right, number + 1, wide, formulas);
                formulas.not(beyond)
            }
            (None, None) => {
                let [word, other] = [left, right].map(|term| self.word(term, wide));
                match word == other {
                    true => Formulas::TRUE,
                    false => formulas.atom(Atom::AtLeast { word, other }),
                }
            }
        }
    }

    fn reaches(&self, term: &Term, number: i64, wide: bool, formulas: &mut Formulas) -> Formula {
        let (least, greatest) = match wide {
            true => (i64::from(i32::MIN), i64::from(i32::MAX)),
            false => (i64::from(i16::MIN), i64::from(i16::MAX)),
        };
        match number {
            _ if number <= least => Formulas::TRUE,
            _ if number > greatest => Formulas::FALSE,
            _ => formulas.atom(Atom::Reaches { word: self.word(term, wide), number }),
        }
    }

    fn word(&self, term: &Term, wide: bool) -> Moment {
        let key = term.key();
        let name = if wide { format_smolstr!("D {key}") } else { key.clone() };
        Moment { name, ..self.moment(term, key) }
    }

    fn act(&mut self, action: &'p Action, power: Formula, formulas: &mut Formulas) {
        let guard = match action.deed {
            Deed::Coil(CoilKind::Negated) => formulas.not(power),
            _ => power,
        };
        let number = self.effects.len() as u32 + 1;
        if let Some((term, value)) = self.bit_driven(action, guard, formulas) {
            self.effects.push(Effect { action, guard, event: None });
            self.driven.insert(term.key(), Driven { term, value, since: self.events });
            self.touched[slot(term)] = number;
            return;
        }
        self.event(action, guard);
    }

    /// Does something of which nothing is known afterwards.
    fn event(&mut self, action: &'p Action, guard: Formula) {
        let number = self.effects.len() as u32 + 1;
        self.events += 1;
        self.effects.push(Effect { action, guard, event: Some(self.events) });
        match action.deed {
            Deed::Coil(_) => {
                if let Some(term) = action.terms.first() {
                    self.changed.insert(term.key(), self.events);
                    self.touched[slot(term)] = number;
                    // Setting one state resets others; a word has its bits and those beside it.
                    if !self.is_apart(term) {
                        self.kinds[slot(term)] = self.events;
                    }
                }
            }
            Deed::Instruction(form) if form.instruction.flow() == Flow::Straight => {
                for (term, spec) in action.terms.iter().zip(form.instruction.operands) {
                    if spec.access != Access::Read {
                        self.kinds[slot(term)] = self.events;
                        self.touched[slot(term)] = number;
                    }
                }
                self.flags = self.events;
            }
            Deed::Call(call) => {
                self.touched[VARIABLES] = number;
                for changed in call.changes(&action.terms) {
                    self.changed.insert(changed.key(), self.events);
                }
            }
            // What is done meanwhile elsewhere, nobody knows here.
            Deed::Instruction(_) => {
                self.kinds = [self.events; KINDS];
                self.touched = [number; KINDS];
                self.flags = self.events;
            }
            Deed::Jump | Deed::Return => {}
        }
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
        let value = match action.deed {
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

    /// Whether it is a bit by itself, so that writing to it changes nothing else. Setting a state resets others, and
    /// the contact of a timer is no bit that a coil writes.
    fn is_lone(&self, term: &Term) -> bool {
        match &term.operand {
            Operand::Device(device) => match device.kind {
                DeviceKind::X | DeviceKind::Y | DeviceKind::M => true,
                DeviceKind::S => self.has_plain_states,
                _ => false,
            },
            Operand::Direct(address) => address.width == Width::Bit,
            // `T1.Q` is a bit by itself, `Word.3` is not.
            Operand::Variable => {
                let is_part =
                    |(_, last): (&str, &str)| last.starts_with(|c: char| c.is_ascii_digit() || c == '%');
                !term.text.contains(['[', '^']) && !term.text.rsplit_once('.').is_some_and(is_part)
            }
            _ => false,
        }
    }

    /// Whether nothing but writing to it changes it: a bit by itself, a timer or a counter.
    fn is_apart(&self, term: &Term) -> bool {
        self.is_lone(term) || matches!(term.operand, Operand::Device(device) if device.kind.has_preset())
    }
}

impl Default for Run<'_> {
    fn default() -> Self {
        Run::new()
    }
}

/// The first special relay.
const FIRST_SPECIAL: u32 = 8000;

/// The place of a term's kind.
fn slot(term: &Term) -> usize {
    term.operand.device().map_or(VARIABLES, |device| device.kind as usize)
}

/// The whole number that a term is, in 16 or 32 bits.
fn number(term: &Term, wide: bool) -> Option<i64> {
    match term.operand {
        Operand::Constant { value: Constant::Decimal(value), index: None } => Some(value),
        Operand::Constant { value: Constant::Hexadecimal(bits), index: None } => match wide {
            true => u32::try_from(bits).ok().map(|bits| i64::from(bits as i32)),
            false => u16::try_from(bits).ok().map(|bits| i64::from(bits as i16)),
        },
        _ => None,
    }
}
