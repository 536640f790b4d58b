//! Runs paths with plain values, one scan from a given state: a second opinion on what the diagrams say, that shares
//! nothing with them but the reading of rungs.

use super::{Action, Call, Computation, Contact, Deed, Drive, Expression, Gate, Path, Rung, Term, Test};
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::target::iec::LiteralValue;
use crate::target::{Constant, Device, DeviceKind, Flow, Form, Model, Operand};
use crate::text::folded;
use smol_str::{SmolStr, format_smolstr};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// A real number as a variable holds it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Real {
    /// The number.
    pub value: f64,
    /// Whether the variable is a REAL, so that literals have 32 bits beside it.
    pub single: bool,
}

/// Devices and variables by their keys, see [`Term::key`]; what is left out is off, or 0.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct State {
    /// Bits.
    pub bits: BTreeMap<SmolStr, bool>,
    /// Words; 32-bit values with a `D` and a blank before the key.
    pub words: BTreeMap<SmolStr, i64>,
    /// Real numbers of IEC 61131-3.
    pub reals: BTreeMap<SmolStr, Real>,
    /// Bits one scan before, as contacts of edges saw them; those that are left out did not change.
    pub before: BTreeMap<SmolStr, bool>,
    /// What an event leaves behind whose working nobody knows, by its number from 1: timers, instructions, calls.
    pub left_behind: BTreeMap<u32, LeftBehind>,
}

/// What an event leaves behind.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct LeftBehind {
    /// Bits that it changes.
    pub bits: BTreeMap<SmolStr, bool>,
    /// Words that it changes.
    pub words: BTreeMap<SmolStr, i64>,
    /// Whether power goes on behind it.
    pub passes: bool,
}

/// What came of a scan.
#[derive(Debug)]
pub struct Scan<'s> {
    state: &'s State,
    bits: BTreeMap<SmolStr, bool>,
    words: BTreeMap<SmolStr, i64>,
    /// Whether each event had power, in order.
    pub events: Vec<bool>,
    /// The events of which it was only guessed what bits they leave behind: units of the program, instructions and
    /// calculations may never leave these.
    pub guesses: Vec<u32>,
    /// Whether words were guessed that units of the program and calculations may never come to.
    pub guesses_words: bool,
    /// Whether something was executed of which nobody knows what it does.
    is_vague: bool,
    next: Next,
}

/// Where a scan goes on behind an action.
#[derive(Clone, PartialEq, Eq, Debug)]
enum Next {
    /// At the next one.
    Here,
    /// At a label.
    At(SmolStr),
    /// Nowhere.
    End,
    /// Where nobody follows: in a subroutine, in a loop, in what a step leaves out.
    Lost,
}

/// One scan of `paths` from `state`.
pub fn evaluate<'s>(paths: &[&Path], state: &'s State) -> Scan<'s> {
    let (bits, words) = (state.bits.clone(), state.words.clone());
    let mut scan = Scan {
        state,
        bits,
        words,
        events: Vec::new(),
        guesses: Vec::new(),
        guesses_words: false,
        is_vague: false,
        next: Next::Here,
    };
    paths.iter().for_each(|path| scan.path(path, true));
    scan
}

/// One scan from `state` of rungs with their labels, where jumps lead. Nothing where it comes to a rung that cannot be
/// read, to an instruction of which nobody knows what it does, or where nobody can follow it.
pub fn evaluate_jumping<'s>(rungs: &[&Rung], state: &'s State) -> Option<Scan<'s>> {
    let mut scan = evaluate(&[], state);
    let mut at = 0;
    // Whoever jumps back may do so for ever.
    for round in 0.. {
        if round > rungs.len() * ROUNDS_MAX {
            return None;
        }
        let Some(rung) = rungs.get(at) else { break };
        scan.next = Next::Here;
        if let Some(path) = rung.path.as_ref().ok()? {
            scan.path(path, true);
        }
        at = match &scan.next {
            Next::Here => at + 1,
            Next::End => break,
            Next::Lost => return None,
            Next::At(label) => {
                let is_it = |own: &SmolStr| own.eq_ignore_ascii_case(label);
                rungs.iter().position(|rung| rung.labels.iter().any(is_it))?
            }
        };
    }
    (!scan.is_vague).then_some(scan)
}

/// So often each rung is executed on average before a scan counts as one that never ends.
const ROUNDS_MAX: usize = 8;

impl<'s> Scan<'s> {
    /// The bit with this key.
    pub fn bit(&self, key: &str) -> bool {
        self.bits.get(key).copied().unwrap_or(false)
    }

    fn path(&mut self, path: &Path, power: bool) {
        let mut power = power;
        for gate in &path.gates {
            power = match gate {
                Gate::Pass(expression) => power && self.holds(expression),
                Gate::Invert => !power,
                Gate::Through(action) => {
                    self.act(action, power);
                    match action.power_out() {
                        Some(output) => self.value(&output),
                        None => self.left_behind().is_some_and(|left| left.passes),
                    }
                }
            };
        }
        for drive in &path.drives {
            match drive {
                Drive::Action(action) => {
                    self.act(action, power);
                    self.next = next(action, power, std::mem::replace(&mut self.next, Next::Here));
                }
                Drive::Path(path) => self.path(path, power),
            }
        }
    }

    fn holds(&self, expression: &Expression) -> bool {
        match expression {
            Expression::Constant(value) => *value,
            Expression::Contact(contact) => self.conducts(contact),
            Expression::Not(part) => !self.holds(part),
            Expression::And(parts) => parts.iter().all(|part| self.holds(part)),
            Expression::Or(parts) => parts.iter().any(|part| self.holds(part)),
        }
    }

    fn conducts(&self, contact: &Contact) -> bool {
        match (contact.test, &contact.terms[..]) {
            (Test::Bit(kind), [term]) => {
                let value = self.value(term);
                let before = self.before(term).unwrap_or(value);
                match kind {
                    ContactKind::NormallyOpen => value,
                    ContactKind::NormallyClosed => !value,
                    ContactKind::Rising => value && !before,
                    ContactKind::Falling => !value && before,
                }
            }
            (Test::Compare(operator), [left, right]) => {
                let order = self.order([left, right], operator.is_wide());
                match operator {
                    CompareOperator::Equal { .. } => order == Some(Ordering::Equal),
                    CompareOperator::NotEqual { .. } => order != Some(Ordering::Equal),
                    CompareOperator::Greater { .. } => order == Some(Ordering::Greater),
                    CompareOperator::Less { .. } => order == Some(Ordering::Less),
                    CompareOperator::GreaterOrEqual { .. } => order.is_some_and(Ordering::is_ge),
                    CompareOperator::LessOrEqual { .. } => order.is_some_and(Ordering::is_le),
                }
            }
            _ => false,
        }
    }

    /// What a contact for the edge of `term` saw before; nothing if that did not change.
    fn before(&self, term: &Term) -> Option<bool> {
        let known = |key: &str| self.state.before.get(key).copied();
        known(&term.key()).or_else(|| {
            let first = Device::FIRST_SCAN.to_string();
            match term.operand {
                Operand::Device(Device::ALWAYS_ON) => Some(!self.bit(&first)),
                Operand::Device(Device::FIRST_SCAN) => Some(false),
                Operand::Device(Device::OFF_AT_FIRST) => {
                    Some(!self.bit(&first) && known(&first) != Some(true))
                }
                _ => None,
            }
        })
    }

    fn value(&self, term: &Term) -> bool {
        match term.operand {
            Operand::Literal(literal) if literal.value == LiteralValue::Bool(true) => true,
            Operand::Device(Device::OFF_AT_FIRST) => !self.bit(&Device::FIRST_SCAN.to_string()),
            Operand::Device(device) if let Some(value) = device.always() => value,
            Operand::WordBit { word, bit } if self.words.contains_key(&*word.to_string()) => {
                self.words[&*word.to_string()] >> bit & 1 == 1
            }
            _ => self.bit(&term.key()),
        }
    }

    /// How two words compare; nothing if one of them is no number.
    fn order(&self, sides: [&Term; 2], wide: bool) -> Option<Ordering> {
        let reals = sides.map(|side| self.state.reals.get(&side.key()));
        let written = |side: &Term| match side.operand {
            Operand::Literal(literal) => match literal.value {
                LiteralValue::Real(value) => Some(value),
                LiteralValue::Integer(value) => Some(value as f64),
                _ => None,
            },
            _ => None,
        };
        let is_whole = |side: &Term| match side.operand {
            Operand::Literal(literal) => !matches!(literal.value, LiteralValue::Real(_)),
            _ => true,
        };
        if reals.iter().any(Option::is_some) || !sides.into_iter().all(is_whole) {
            let is_single = reals.iter().flatten().any(|real| real.single);
            let value = |side: usize| {
                let written = written(sides[side]).unwrap_or_default();
                let written = if is_single { f64::from(written as f32) } else { written };
                reals[side].map_or(written, |real| real.value)
            };
            return value(0).partial_cmp(&value(1));
        }
        let [left, right] = sides.map(|side| self.compared(side, wide));
        Some(left.cmp(&right))
    }

    /// What is compared: a literal may be larger than any word that a state has. Times are in nanoseconds.
    fn compared(&self, term: &Term, wide: bool) -> i128 {
        match term.operand {
            Operand::Literal(literal) => match literal.value {
                LiteralValue::Integer(value) | LiteralValue::DateAndTime(value) => value,
                LiteralValue::Time(value) | LiteralValue::TimeOfDay(value) => i128::from(value),
                LiteralValue::Date(value) => i128::from(value),
                _ => i128::from(self.word(term, wide)),
            },
            _ => i128::from(self.word(term, wide)),
        }
    }

    fn word(&self, term: &Term, wide: bool) -> i64 {
        match term.operand {
            Operand::Constant { value: Constant::Decimal(value), index: None } => value,
            Operand::Constant { value: Constant::Hexadecimal(bits), index: None } => {
                signed(bits, if wide { 32 } else { 16 })
            }
            Operand::Literal(literal) if let LiteralValue::Integer(value) = literal.value => {
                i64::try_from(value).unwrap_or(0)
            }
            Operand::Nibbles { digits, first, index: None } => {
                let bits = 0..u32::from(digits) * 4;
                let on = |bit: &u32| self.bit(&Device::new(first.kind, first.number + bit).to_string());
                let pattern = bits.filter(on).fold(0, |pattern, bit| pattern | 1 << bit);
                signed(pattern, if wide { 32 } else { 16 })
            }
            _ => {
                let key = term.key();
                let key = if wide { format_smolstr!("D {key}") } else { key };
                self.words.get(&key).copied().unwrap_or(0)
            }
        }
    }

    fn act(&mut self, action: &Action, power: bool) {
        let power = power != (action.deed == Deed::Coil(CoilKind::Negated));
        if let (Deed::Coil(kind), [term]) = (&action.deed, &action.terms[..])
            && term.is_lone()
        {
            let value = match kind {
                CoilKind::Plain | CoilKind::Negated => Some(power),
                CoilKind::Set => Some(power || self.value(term)),
                CoilKind::Reset => Some(!power && self.value(term)),
                _ => None,
            };
            if let Some(value) = value {
                self.bits.insert(term.key(), value);
                return;
            }
        }
        let moved = self.moved(action, power);
        let copied = self.copied_bits(action, power);
        let works = matches!(action.deed, Deed::Instruction(_) | Deed::Compute(_));
        let is_guessed = action.runs_unit() || power && works && copied.is_none();
        self.events.push(power);
        let is_straight = |form: &Form| form.instruction.flow() == Flow::Straight;
        let is_known = matches!(&action.deed, Deed::Instruction(form) if !is_straight(form));
        let remembers =
            matches!(action.deed, Deed::Call(_) | Deed::Coil(CoilKind::Rising | CoilKind::Falling));
        self.is_vague |= is_guessed && moved.is_none() && !is_known || remembers;
        let nothing = LeftBehind::default();
        let left = self.left_behind().filter(|_| copied.is_none()).unwrap_or(&nothing);
        let words: Vec<_> = left.words.iter().filter(|(key, _)| may_write_word(action, key)).collect();
        self.guesses_words |= is_guessed && moved.is_none() && !words.is_empty();
        if is_guessed && !left.bits.is_empty() {
            self.guesses.push(self.events.len() as u32);
        }
        let own = action.terms.first().map(|term| (term.key(), self.value(term)));
        let bits = own.into_iter().chain(left.bits.iter().map(|(key, value)| (key.clone(), *value)));
        let bits: Vec<_> =
            bits.map(|(key, value)| (self.bit_after(action, power, &key, value), key)).collect();
        self.bits.extend(bits.into_iter().map(|(value, key)| (key, value)));
        if power || !is_idle_without_power(action) {
            self.words.extend(words.into_iter().map(|(key, value)| (key.clone(), *value)));
        }
        self.words.extend(moved);
        self.bits.extend(copied.into_iter().flatten());
    }

    /// What the bit with this key is after an event that is said to leave `left`, as far as its working is known:
    /// a timer does not run without power, SET does not leave off, an instruction without power changes nothing.
    fn bit_after(&self, action: &Action, power: bool, key: &str, left: bool) -> bool {
        let before = self.bit(key);
        let own = action.terms.first().filter(|term| term.key() == key);
        let device = own.and_then(|term| term.operand.device());
        match (&action.deed, device) {
            (Deed::Coil(CoilKind::Plain), Some(timer)) if timer.is_forgetful_timer() => {
                power && (before || left)
            }
            (Deed::Coil(CoilKind::Plain), Some(device)) if device.kind.has_preset() => {
                before || power && left
            }
            (Deed::Coil(CoilKind::Rising), _) if own.is_some() => power && left,
            (Deed::Coil(CoilKind::Falling), _) if own.is_some() => !power && left,
            (Deed::Coil(CoilKind::Set), Some(_)) => power || before,
            (Deed::Coil(CoilKind::Reset), Some(_)) => !power && before,
            (Deed::Call(call), _) if !call.is_enabled() => {
                self.output_after(call, &action.terms, power, key).unwrap_or(left)
            }
            (Deed::Instruction(form), _) if power && !form.pulse && form.instruction.clears() => false,
            _ if !power && is_idle_without_power(action) => before,
            _ => left,
        }
    }

    /// What standard blocks make of their output `key` where their input alone decides it.
    fn output_after(&self, call: &Call, terms: &[Term], power: bool, key: &str) -> Option<bool> {
        let instance = terms.first()?.key();
        let output = key.strip_prefix(&*instance)?.strip_prefix('.')?;
        let arguments = call.arguments(terms);
        let is = |name: &str| call.block.is_standard(name);
        let pin = |name: &str| {
            let given = arguments.iter().find(|argument| !argument.is_output && argument.name == name);
            match given {
                Some(argument) => self.value(&argument.term),
                None if call.power_in() == name => power,
                None => self.bit(&format!("{instance}.{}", folded(name))),
            }
        };
        let input = || pin(call.power_in());
        let has_preset = arguments.iter().any(|argument| {
            argument.name == "PV"
                && matches!(argument.term.operand, Operand::Literal(_))
                && self.word(&argument.term, false) > 0
        });
        match output {
            "q1" if is("SR") => Some(pin("S1") || self.bit(key) && !pin("R")),
            "q1" if is("RS") => Some(!pin("R1") && (pin("S") || self.bit(key))),
            "q" if is("CTU") && pin("R") && has_preset => Some(false),
            "q" if (is("TON") || is("R_TRIG")) && !input() => Some(false),
            "q" if is("TOF") && input() => Some(true),
            "q" if is("F_TRIG") && input() => Some(false),
            _ => None,
        }
    }

    fn left_behind(&self) -> Option<&'s LeftBehind> {
        self.state.left_behind.get(&(self.events.len() as u32))
    }

    /// The register that MOV or a calculation writes with what it holds then, as far as that is known.
    fn moved(&self, action: &Action, power: bool) -> Option<(SmolStr, i64)> {
        let register = action.terms.last()?;
        let is_register = matches!(register.operand, Operand::Device(Device { kind: DeviceKind::D, .. }));
        let copies = |form: &Form| form.instruction.copies() && is_register && !form.wide && !form.pulse;
        let result = match &action.deed {
            Deed::Compute(_) if !power => self.word(register, false),
            Deed::Compute(computation) => self.result(computation, &action.terms)?,
            Deed::Instruction(form) if copies(form) => {
                let source = if power { action.terms.first()? } else { register };
                self.word(source, false)
            }
            _ => return None,
        };
        Some((register.key(), result))
    }

    /// The bits that MOV with power copies to a group of relays, by their keys. It changes nothing else.
    fn copied_bits(&self, action: &Action, power: bool) -> Option<Vec<(SmolStr, bool)>> {
        let (Deed::Instruction(form), [source, group]) = (&action.deed, &action.terms[..]) else {
            return None;
        };
        let Operand::Nibbles { digits, first, index: None } = group.operand else { return None };
        let is_plain = |term: &Term| match term.operand {
            Operand::Nibbles { first, index: None, .. } => !first.is_special(),
            Operand::Device(_) | Operand::Constant { index: None, .. } => true,
            _ => false,
        };
        let is_known = form.instruction.copies() && !form.wide && !form.pulse && is_plain(source);
        if !is_known || !power || first.is_special() {
            return None;
        }
        let word = self.word(source, false);
        let bit = |number: u32| (Device::new(first.kind, first.number + number).to_string().into(), number);
        let bits = (0..u32::from(digits) * 4).map(bit);
        Some(bits.map(|(key, number)| (key, word >> number & 1 == 1)).collect())
    }

    /// What a function of the standard makes of whole numbers, if 16 bits hold it: of more, the types decide.
    fn result(&self, computation: &Computation, terms: &[Term]) -> Option<i64> {
        let (inputs, _) = computation.operands(terms)?;
        let is_whole = |term: &Term| match term.operand {
            Operand::Literal(literal) => matches!(literal.value, LiteralValue::Integer(_)),
            _ => true,
        };
        if !inputs.iter().all(is_whole) {
            return None;
        }
        let inputs: Vec<i64> = inputs.iter().map(|term| self.word(term, false)).collect();
        let result = match (computation.standard()?, &inputs[..]) {
            ("MOVE", [word]) => *word,
            ("NOT", [word]) => !word,
            ("ADD", [left, right]) => left.checked_add(*right)?,
            ("SUB", [left, right]) => left.checked_sub(*right)?,
            ("MUL", [left, right]) => left.checked_mul(*right)?,
            ("DIV", [left, right]) => left.checked_div(*right)?,
            ("MOD", [left, right]) => left.checked_rem(*right)?,
            ("AND", [left, right]) => left & right,
            ("OR", [left, right]) => left | right,
            ("XOR", [left, right]) => left ^ right,
            _ => return None,
        };
        i16::try_from(result).is_ok().then_some(result)
    }
}

/// Where the scan goes on behind an action, if it went on as `before` says up to there.
fn next(action: &Action, power: bool, before: Next) -> Next {
    if before != Next::Here {
        return before;
    }
    let label = || action.terms.first().map_or(Next::Lost, |term| Next::At(term.text.clone()));
    match &action.deed {
        Deed::Jump | Deed::Return if !power => Next::Here,
        Deed::Jump => label(),
        Deed::Return => Next::End,
        Deed::Instruction(form) => match form.instruction.flow() {
            Flow::Jump if form.pulse => Next::Lost,
            Flow::Jump if power => label(),
            Flow::ProgramEnd | Flow::MainEnd | Flow::SubroutineEnd | Flow::InterruptEnd => Next::End,
            Flow::Jump | Flow::Straight | Flow::Nothing | Flow::Refresh | Flow::InterruptsAllowed => {
                Next::Here
            }
            _ => Next::Lost,
        },
        _ => Next::Here,
    }
}

/// Whether an action may change the word with this key: an instruction writes from its operand on upwards.
fn may_write_word(action: &Action, key: &str) -> bool {
    let Deed::Instruction(form) = &action.deed else { return true };
    let is_wide = key.starts_with("D ");
    let Operand::Device(word) = Operand::read(key.trim_start_matches("D "), Model::Fx3u) else { return true };
    if form.instruction.flow() != Flow::Straight {
        return true;
    }
    let last = word.number + u32::from(is_wide);
    // A flag turns the way of some copies, so what is read counts, too.
    action.terms.iter().any(|term| match term.operand {
        Operand::Constant { index: None, .. } => false,
        Operand::Device(first) => first.kind == word.kind && first.number <= last,
        _ => term.operand.device().is_none_or(|device| device.kind == word.kind),
    })
}

/// Whether an action changes nothing while it has no power.
fn is_idle_without_power(action: &Action) -> bool {
    match &action.deed {
        Deed::Instruction(form) => matches!(form.instruction.flow(), Flow::Straight | Flow::Refresh),
        Deed::Call(call) => call.is_enabled() && !call.tells_enable(),
        Deed::Compute(_) => true,
        _ => false,
    }
}

/// The number that the lowest `width` bits are.
fn signed(bits: u64, width: u32) -> i64 {
    let bits = bits & ((1 << width) - 1);
    let value = i64::try_from(bits).unwrap_or(0);
    if bits >> (width - 1) == 1 { value - (1 << width) } else { value }
}
