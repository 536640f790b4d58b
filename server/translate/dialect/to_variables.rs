//! Paths of the FX family in the words of IEC 61131-3.

use super::{FIRST_SPECIAL, address, without};
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Call, Contact, Deed, Drive, Expression, Gate, Path, Refusal, Storage, Term, Test};
use crate::target::iec::FunctionBlock;
use crate::target::{Constant, Device, DeviceKind, Flow, Form, Model, Operand, Target};
use crate::text::Span;
use smol_str::{SmolStr, ToSmolStr, format_smolstr};

/// Whether a rung is but END, which IEC 61131-3 does not write.
pub(super) fn is_end(path: &Path) -> bool {
    let [Drive::Action(action)] = &path.drives[..] else { return false };
    path.gates.is_empty()
        && matches!(action.deed, Deed::Instruction(form) if form.instruction.flow() == Flow::ProgramEnd)
}

/// `path`, written for `target`, with variables for devices.
pub(super) fn path(path: &Path, target: &Target) -> Result<Path, Refusal> {
    Converter { target }.path(path)
}

struct Converter<'t> {
    target: &'t Target,
}

impl Converter<'_> {
    fn path(&self, path: &Path) -> Result<Path, Refusal> {
        let mut converted = Path::default();
        for gate in &path.gates {
            converted.gates.push(match gate {
                Gate::Pass(expression) => Gate::Pass(self.expression(expression)?),
                Gate::Invert => Gate::Invert,
                Gate::Through(_) => return Err(Refusal::NoCounterpart),
            });
        }
        for drive in &path.drives {
            converted.drives.push(match drive {
                Drive::Path(path) => Drive::Path(self.path(path)?),
                Drive::Action(action) => self.action(action)?,
            });
        }
        Ok(converted)
    }

    fn expression(&self, expression: &Expression) -> Result<Expression, Refusal> {
        let all = |parts: &[Expression]| -> Result<Vec<Expression>, Refusal> {
            parts.iter().map(|part| self.expression(part)).collect()
        };
        Ok(match expression {
            Expression::Constant(value) => Expression::Constant(*value),
            Expression::Contact(contact) => self.contact(contact)?,
            Expression::Not(part) => Expression::Not(Box::new(self.expression(part)?)),
            Expression::And(parts) => Expression::and(all(parts)?),
            Expression::Or(parts) => Expression::or(all(parts)?),
        })
    }

    fn contact(&self, contact: &Contact) -> Result<Expression, Refusal> {
        let terms = match (contact.test, &contact.terms[..]) {
            (Test::Bit(kind), [term]) => {
                let always = match term.key().as_str() {
                    "M8000" => Some(true),
                    "M8001" => Some(false),
                    _ => None,
                };
                match (always, kind) {
                    (Some(value), ContactKind::NormallyOpen) => return Ok(Expression::Constant(value)),
                    (Some(value), ContactKind::NormallyClosed) => return Ok(Expression::Constant(!value)),
                    _ => vec![self.bit(term)?],
                }
            }
            (Test::Compare(operator), [left, right]) if !operator.is_wide() => {
                vec![self.word(left)?, self.word(right)?]
            }
            _ => return Err(Refusal::NoCounterpart),
        };
        Ok(Expression::Contact(Contact { terms, ..contact.clone() }))
    }

    fn bit(&self, term: &Term) -> Result<Term, Refusal> {
        let Operand::Device(device) = term.operand else { return Err(Refusal::NoCounterpart) };
        match device.kind {
            DeviceKind::X | DeviceKind::Y | DeviceKind::M | DeviceKind::S => self.located(device, term.span),
            DeviceKind::T => {
                self.timer_unit(device)?;
                Ok(variable(&format_smolstr!("{device}.Q"), term.span))
            }
            DeviceKind::C => {
                self.counter(device)?;
                Ok(variable(&format_smolstr!("{device}.Q"), term.span))
            }
            _ => Err(Refusal::NoCounterpart),
        }
    }

    fn word(&self, term: &Term) -> Result<Term, Refusal> {
        match term.operand {
            Operand::Device(device) if device.kind == DeviceKind::D => self.located(device, term.span),
            Operand::Device(device) if device.kind == DeviceKind::C => {
                self.counter(device)?;
                Ok(variable(&format_smolstr!("{device}.CV"), term.span))
            }
            Operand::Constant { value, index: None } => number(value, term.span),
            _ => Err(Refusal::NoCounterpart),
        }
    }

    fn located(&self, device: Device, span: Span) -> Result<Term, Refusal> {
        let address = without(address(device).filter(|_| device.number < FIRST_SPECIAL))?;
        Ok(Term { storage: Storage::At(address), ..variable(&device.to_smolstr(), span) })
    }

    /// Milliseconds for each step of a timer that forgets its time when power goes off.
    fn timer_unit(&self, device: Device) -> Result<i64, Refusal> {
        let range = without(device.range_on(self.target).filter(|range| !range.latched))?;
        Ok(i64::from(range.timer_unit_ms))
    }

    fn counter(&self, device: Device) -> Result<(), Refusal> {
        without((device.number < 200).then_some(()))
    }

    fn action(&self, action: &Action) -> Result<Drive, Refusal> {
        let span = action.span;
        match (action.deed, &action.terms[..]) {
            (Deed::Coil(CoilKind::Plain), [timed, preset]) => {
                self.preset(timed, preset, span).map(Drive::Action)
            }
            (Deed::Coil(kind), [term]) => {
                let Operand::Device(device) = term.operand else { return Err(Refusal::NoCounterpart) };
                match (kind, device.kind) {
                    (CoilKind::Reset, DeviceKind::C) => {
                        self.counter(device)?;
                        call("CTU", "R", &device.to_smolstr(), None, span).map(Drive::Action)
                    }
                    (_, DeviceKind::T | DeviceKind::C | DeviceKind::D) => Err(Refusal::NoCounterpart),
                    (CoilKind::Rising, _) => self.pulse("R_TRIG", "PLS", term, span),
                    (CoilKind::Falling, _) => self.pulse("F_TRIG", "PLF", term, span),
                    _ => Ok(Drive::Action(Action { terms: vec![self.bit(term)?], ..action.clone() })),
                }
            }
            (Deed::Instruction(form), [label]) if Form::named("CJ") == Some(form) => {
                let label = variable(&label.key(), label.span);
                Ok(Drive::Action(Action { deed: Deed::Jump, terms: vec![label], span }))
            }
            _ => Err(Refusal::NoCounterpart),
        }
    }

    /// `OUT T0 K50`, `OUT C0 K10`
    fn preset(&self, device: &Term, preset: &Term, span: Span) -> Result<Action, Refusal> {
        let Operand::Device(device) = device.operand else { return Err(Refusal::NoCounterpart) };
        match (device.kind, preset.operand) {
            (DeviceKind::T, Operand::Constant { value: Constant::Decimal(steps), index: None })
                if steps >= 0 =>
            {
                let time = duration(without(steps.checked_mul(self.timer_unit(device)?))?);
                let preset = Term::new(Operand::read(&time, Model::Iec), &time, preset.span);
                call("TON", "IN", &device.to_smolstr(), Some(("PT", preset)), span)
            }
            (DeviceKind::C, _) => {
                self.counter(device)?;
                call("CTU", "CU", &device.to_smolstr(), Some(("PV", self.word(preset)?)), span)
            }
            _ => Err(Refusal::NoCounterpart),
        }
    }

    /// `PLS M0`: a detector, and its output in the relay.
    fn pulse(&self, block: &str, prefix: &str, relay: &Term, span: Span) -> Result<Drive, Refusal> {
        let relay = self.bit(relay)?;
        let detector = call(block, "CLK", &format_smolstr!("{prefix}_{relay}"), None, span)?;
        let coil = Action { deed: Deed::Coil(CoilKind::Plain), terms: vec![relay], span };
        Ok(Drive::Path(Path { gates: vec![Gate::Through(detector)], drives: vec![Drive::Action(coil)] }))
    }
}

fn call(
    block: &str,
    power: &str,
    instance: &SmolStr,
    argument: Option<(&str, Term)>,
    span: Span,
) -> Result<Action, Refusal> {
    let block = without(FunctionBlock::named(block))?;
    let arguments = argument.into_iter().map(|(name, term)| (name, false, term));
    let (call, terms) = without(Call::new(block, power, variable(instance, span), arguments))?;
    Ok(Action { deed: Deed::Call(call), terms, span })
}

fn variable(name: &str, span: Span) -> Term {
    Term::new(Operand::Variable, name, span)
}

fn number(value: Constant, span: Span) -> Result<Term, Refusal> {
    let value = match value {
        Constant::Decimal(value) => value,
        Constant::Hexadecimal(bits) => i64::from(without(u16::try_from(bits).ok())? as i16),
        Constant::Real(_) => return Err(Refusal::NoCounterpart),
    };
    let text = value.to_smolstr();
    Ok(Term::new(Operand::read(&text, Model::Iec), &text, span))
}

/// Milliseconds as a literal.
fn duration(milliseconds: i64) -> SmolStr {
    match milliseconds % 1000 {
        0 => format_smolstr!("T#{}s", milliseconds / 1000),
        _ => format_smolstr!("T#{milliseconds}ms"),
    }
}
