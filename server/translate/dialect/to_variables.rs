//! Paths of the FX family in the words of IEC 61131-3.

mod applied;

use super::counted::{Coils, Reached, stopping, turned};
use super::first_scan;
use super::registers::is_wide_counter;
use super::{
    END_POINTER, KEPT, Lack, PULSE, Purpose, Registers, address, pair_address, single_edge, without,
};
use crate::ladder::{CoilKind, CompareOperator, ContactKind};
use crate::logic::{
    Action, Call, Callee, Computation, Contact, Deed, Drive, Expression, Gate, Path, Storage, Term, Test,
};
use crate::target::iec::FunctionBlock;
use crate::target::{Constant, Device, DeviceKind, DirectAddress, Form, Model, Operand, Target, Width};
use crate::text::Span;
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use std::cell::Cell;
use std::sync::Arc;

/// Whether a rung is but END, which IEC 61131-3 does not write.
pub(super) fn is_end(path: &Path) -> bool {
    let [Drive::Action(action)] = &path.drives[..] else { return false };
    path.gates.is_empty() && action.deed.ends_program()
}

/// `path`, written for `target`, with variables for devices. `registers` and `coils` are those of the program, and
/// `pulses` counts the detectors of pulse forms.
pub(super) fn path(
    path: &Path,
    (target, purpose): (&Target, Purpose),
    (registers, coils): (&Registers, &Coils),
    pulses: &Cell<u32>,
) -> Result<Path, Lack> {
    let mut path = Converter { target, purpose, registers, coils, pulses }.path(path)?;
    // Calculations and paths with conditions of their own need no load that is always on.
    let loads = |drive: &Drive| match drive {
        Drive::Action(action) => matches!(action.deed, Deed::Compute(_)),
        Drive::Path(path) => matches!(path.gates.first(), Some(Gate::Pass(_))),
    };
    if path.gates == [Gate::Pass(Expression::Constant(true))] && path.drives.iter().all(loads) {
        path.gates.clear();
    }
    Ok(path)
}

struct Converter<'t> {
    target: &'t Target,
    purpose: Purpose,
    registers: &'t Registers,
    coils: &'t Coils,
    pulses: &'t Cell<u32>,
}

impl Converter<'_> {
    fn path(&self, path: &Path) -> Result<Path, Lack> {
        let mut converted = Path::default();
        for gate in &path.gates {
            converted.gates.push(match gate {
                Gate::Pass(expression) => Gate::Pass(self.expression(expression)?),
                Gate::Invert => Gate::Invert,
                Gate::Through(action) => return Err(Lack::Unnamed.of_action(action)),
            });
        }
        for drive in &path.drives {
            match drive {
                Drive::Path(path) => converted.drives.push(Drive::Path(self.path(path)?)),
                Drive::Action(action) => {
                    let drives = self.drives(action).map_err(|lack| lack.of_action(action))?;
                    converted.drives.extend(drives);
                }
            }
        }
        Ok(converted)
    }

    fn expression(&self, expression: &Expression) -> Result<Expression, Lack> {
        expression.mapped(&mut |contact| self.contact(contact).map_err(|lack| lack.of_contact(contact)))
    }

    fn contact(&self, contact: &Contact) -> Result<Expression, Lack> {
        let (test, terms) = match (contact.test, &contact.terms[..]) {
            (Test::Bit(kind), [term]) => match (term.always(), kind) {
                (Some(value), ContactKind::NormallyOpen) => return Ok(Expression::Constant(value)),
                (Some(value), ContactKind::NormallyClosed) => return Ok(Expression::Constant(!value)),
                // What the first scan is, IEC 61131-3 does not say.
                (_, ContactKind::NormallyOpen | ContactKind::NormallyClosed)
                    if self.purpose == Purpose::Proof && first_scan::value_in(term).is_some() =>
                {
                    (contact.test, vec![term.clone()])
                }
                _ if self.purpose == (Purpose::Text { is_whole: true })
                    && let Some((kind, relay)) = first_scan::contact(kind, term) =>
                {
                    (Test::Bit(kind), vec![relay])
                }
                _ => {
                    single_edge(kind, term)?;
                    (contact.test, vec![self.bit(term)?])
                }
            },
            (Test::Compare(operator), [left, right]) if let Some(device) = counter_of(left) => {
                return self.counted(operator, (device, left), right, contact.span);
            }
            (Test::Compare(operator), [left, right]) if let Some(device) = counter_of(right) => {
                return self.counted(turned(operator), (device, right), left, contact.span);
            }
            // What is compared tells how wide it is.
            (Test::Compare(operator), [left, right]) => {
                let width = if operator.is_wide() { Width::Double } else { Width::Word };
                let terms = vec![self.number(left, width)?, self.number(right, width)?];
                (Test::Compare(operator.in_width(false)), terms)
            }
            _ => return Err(Lack::Unnamed),
        };
        Ok(Expression::Contact(Contact { test, terms, span: contact.span }))
    }

    fn bit(&self, term: &Term) -> Result<Term, Lack> {
        self.own_bit(term).map_err(|lack| lack.named(&term.text))
    }

    fn own_bit(&self, term: &Term) -> Result<Term, Lack> {
        let Operand::Device(device) = term.operand else { return Err(Lack::Unnamed) };
        match device.kind {
            DeviceKind::X | DeviceKind::Y | DeviceKind::M | DeviceKind::S => self.located(device, term.span),
            DeviceKind::T => {
                self.timer_unit(device)?;
                self.coils.one(device)?;
                Ok(variable(&format_smolstr!("{device}.Q"), term.span))
            }
            DeviceKind::C => {
                self.counter(device)?;
                Ok(variable(&format_smolstr!("{device}.Q"), term.span))
            }
            _ => Err(Lack::Unnamed),
        }
    }

    /// A number of 16 or 32 bits.
    fn number(&self, term: &Term, width: Width) -> Result<Term, Lack> {
        self.own_number(term, width).map_err(|lack| lack.named(&term.text))
    }

    fn own_number(&self, term: &Term, width: Width) -> Result<Term, Lack> {
        let reason = |key| Lack::Reason(key, term.text.clone());
        match (term.operand, width) {
            (Operand::Device(device), Width::Double) if device.kind == DeviceKind::D => {
                self.pair(device, term.span)
            }
            (Operand::Device(device), _) if device.kind == DeviceKind::D => self.located(device, term.span),
            (Operand::Device(device), _) if is_wide_counter(device) => Err(reason("translate.wide-counter")),
            (Operand::Device(device), _) if device.kind == DeviceKind::C => {
                Err(reason("translate.counter-number"))
            }
            (Operand::Device(device), _) if device.kind == DeviceKind::T => {
                Err(reason("translate.timer-value"))
            }
            (Operand::Nibbles { .. }, _) => Err(reason("translate.nibbles")),
            (Operand::Constant { value, index: None }, _) => {
                Ok(literal(&constant(value, width)?.to_smolstr(), term.span))
            }
            _ => Err(Lack::Unnamed),
        }
    }

    /// The variable for 32 bits from a register on.
    fn pair(&self, first: Device, span: Span) -> Result<Term, Lack> {
        let address = without(pair_address(first))?;
        match self.registers.is_pair(first.number) {
            true => Ok(at(address, first, span)),
            false => Err(Lack::Reason("translate.torn", first.to_smolstr())),
        }
    }

    fn located(&self, device: Device, span: Span) -> Result<Term, Lack> {
        Ok(at(without(address(device))?, device, span))
    }

    /// Milliseconds for each step of a timer that forgets its time when power goes off.
    fn timer_unit(&self, device: Device) -> Result<i64, Lack> {
        let range = without(device.range_on(self.target).filter(|range| !range.latched))?;
        Ok(i64::from(range.timer_unit_ms))
    }

    fn counter(&self, device: Device) -> Result<(), Lack> {
        match is_wide_counter(device) {
            true => Err(Lack::Reason("translate.wide-counter", device.to_smolstr())),
            false => self.coils.one(device),
        }
    }

    /// A comparison of the count of a counter, which stops at its preset, with a constant.
    fn counted(
        &self,
        operator: CompareOperator,
        (device, counter): (Device, &Term),
        other: &Term,
        span: Span,
    ) -> Result<Expression, Lack> {
        let named = |lack: Lack| lack.named(&counter.text);
        self.counter(device).map_err(named)?;
        let (Operand::Constant { value, index: None }, false) = (other.operand, operator.is_wide()) else {
            return Err(Lack::Reason("translate.counter-number", counter.text.clone()));
        };
        let number = constant(value, Width::Word)?;
        Ok(match stopping(operator, number, self.coils.preset(device).map_err(named)?) {
            Reached::Constant(value) => Expression::Constant(value),
            Reached::Count(operator, number) => {
                let count = variable(&format_smolstr!("{device}.CV"), counter.span);
                let terms = vec![count, literal(&number.to_smolstr(), other.span)];
                Expression::Contact(Contact { test: Test::Compare(operator), terms, span })
            }
        })
    }

    fn drives(&self, action: &Action) -> Result<Vec<Drive>, Lack> {
        let Deed::Instruction(form) = action.deed else {
            return self.action(action).map(|action| vec![Drive::Action(action)]);
        };
        if let (Some(true), [label]) = (Form::named("CJ").map(|jump| jump == form), &action.terms[..]) {
            if label.text.eq_ignore_ascii_case(END_POINTER) {
                let leave = Action { deed: Deed::Return, terms: Vec::new(), span: action.span };
                return Ok(vec![Drive::Action(leave)]);
            }
            let label = variable(&label.key(), label.span);
            let jump = Action { deed: Deed::Jump, terms: vec![label], span: action.span };
            return Ok(vec![Drive::Action(jump)]);
        }
        if KEPT.contains(&form.instruction.mnemonic) {
            return Err(Lack::Unnamed);
        }
        let drives = self.applied(form, &action.terms, action.span)?;
        if form.pulse { self.on_arrival(drives, action.span).map(|drive| vec![drive]) } else { Ok(drives) }
    }

    fn action(&self, action: &Action) -> Result<Action, Lack> {
        let span = action.span;
        match (&action.deed, &action.terms[..]) {
            (Deed::Coil(CoilKind::Plain), [timed, preset]) => self.preset(timed, preset, span),
            (Deed::Coil(kind), [term]) => {
                let Operand::Device(device) = term.operand else { return Err(Lack::Unnamed) };
                match (kind, device.kind) {
                    (CoilKind::Reset, DeviceKind::C) => {
                        self.counter(device)?;
                        self.coils.preset(device)?;
                        call("CTU", "R", &device.to_smolstr(), None, span)
                    }
                    (CoilKind::Reset, DeviceKind::D) => {
                        let zero = literal("0", term.span);
                        self.computed("MOVE", vec![zero, self.number(term, Width::Word)?], span)
                    }
                    (CoilKind::Reset, DeviceKind::T) => {
                        Err(Lack::Reason("translate.timer-reset", term.text.clone()))
                    }
                    (_, DeviceKind::T | DeviceKind::C | DeviceKind::D) => Err(Lack::Unnamed),
                    _ => Ok(Action { terms: vec![self.bit(term)?], ..action.clone() }),
                }
            }
            (Deed::Return, _) => Ok(action.clone()),
            _ => Err(Lack::Unnamed),
        }
    }

    fn computed(&self, function: &str, terms: Vec<Term>, span: Span) -> Result<Action, Lack> {
        self.compute(without(Computation::named(function))?, terms, span)
    }

    fn compute(&self, computation: Computation, terms: Vec<Term>, span: Span) -> Result<Action, Lack> {
        let (_, result) = without(computation.operands(&terms))?;
        if result.address().is_none() {
            return Err(match result.text.split_once('.') {
                Some((counter, _)) => Lack::Reason("translate.counter-value", counter.into()),
                None => Lack::Unnamed.named(&result.text),
            });
        }
        Ok(Action { deed: Deed::Compute(computation), terms, span })
    }

    /// What is done when power arrives.
    fn on_arrival(&self, drives: Vec<Drive>, span: Span) -> Result<Drive, Lack> {
        self.pulses.set(self.pulses.get() + 1);
        let instance = format_smolstr!("{PULSE}{}", self.pulses.get());
        let detector = call("R_TRIG", "CLK", &instance, None, span)?;
        Ok(Drive::Path(Path { gates: vec![Gate::Through(detector)], drives }))
    }

    /// `OUT T0 K50`, `OUT C0 K10`
    fn preset(&self, device: &Term, preset: &Term, span: Span) -> Result<Action, Lack> {
        let Operand::Device(device) = device.operand else { return Err(Lack::Unnamed) };
        match (device.kind, preset.operand) {
            (DeviceKind::T, Operand::Constant { value: Constant::Decimal(steps), index: None })
                if steps >= 0 =>
            {
                self.coils.one(device)?;
                // K0 works as K1 does (FX programming manuals, on timers).
                let time = duration(without(steps.max(1).checked_mul(self.timer_unit(device)?))?);
                let preset = Term::new(Operand::read(&time, Model::Iec), &time, preset.span);
                call("TON", "IN", &device.to_smolstr(), Some(("PT", preset)), span)
            }
            (DeviceKind::C, _) => {
                self.counter(device)?;
                let number = self.coils.preset(device)?;
                let preset = literal(&number.to_smolstr(), preset.span);
                call("CTU", "CU", &device.to_smolstr(), Some(("PV", preset)), span)
            }
            _ => Err(Lack::Unnamed),
        }
    }
}

/// The counter that a term is.
fn counter_of(term: &Term) -> Option<Device> {
    match term.operand {
        Operand::Device(device) if device.kind == DeviceKind::C => Some(device),
        _ => None,
    }
}

fn call(
    block: &str,
    power: &str,
    instance: &SmolStr,
    argument: Option<(&str, Term)>,
    span: Span,
) -> Result<Action, Lack> {
    let block = Callee::Block(without(FunctionBlock::named(block))?);
    let arguments = argument.into_iter().map(|(name, term)| (name, false, term));
    let (call, terms) = without(Call::new(block, power, variable(instance, span), arguments))?;
    Ok(Action { deed: Deed::Call(Arc::new(call)), terms, span })
}

fn variable(name: &str, span: Span) -> Term {
    Term::new(Operand::Variable, name, span)
}

/// The variable named like a device that lies at this address.
fn at(address: DirectAddress, device: Device, span: Span) -> Term {
    Term { storage: Storage::At(address), ..variable(&device.to_smolstr(), span) }
}

/// The number that a constant is in 16 or 32 bits.
fn constant(value: Constant, width: Width) -> Result<i64, Lack> {
    Ok(match (value, width) {
        (Constant::Decimal(value), _) => value,
        (Constant::Hexadecimal(bits), Width::Double) => i64::from(without(u32::try_from(bits).ok())? as i32),
        (Constant::Hexadecimal(bits), _) => i64::from(without(u16::try_from(bits).ok())? as i16),
        (Constant::Real(_), _) => return Err(Lack::Unnamed),
    })
}

fn literal(text: &str, span: Span) -> Term {
    Term::new(Operand::read(text, Model::Iec), text, span)
}

/// Milliseconds as a literal.
fn duration(milliseconds: i64) -> SmolStr {
    match milliseconds % 1000 {
        0 => format_smolstr!("T#{}s", milliseconds / 1000),
        _ => format_smolstr!("T#{milliseconds}ms"),
    }
}
