//! Paths of the FX family in the words of IEC 61131-3.

use super::{COMPUTED, Lack, PULSE, STEPPED, address, without};
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{
    Action, Call, Callee, Computation, Contact, Deed, Drive, Expression, Gate, Path, Storage, Term, Test,
};
use crate::target::iec::FunctionBlock;
use crate::target::{Constant, Device, DeviceKind, Form, Model, Operand, Target};
use crate::text::Span;
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use std::cell::Cell;
use std::sync::Arc;

/// Whether a rung is but END, which IEC 61131-3 does not write.
pub(super) fn is_end(path: &Path) -> bool {
    let [Drive::Action(action)] = &path.drives[..] else { return false };
    path.gates.is_empty() && action.deed.ends_program()
}

/// `path`, written for `target`, with variables for devices. `pulses` counts the detectors of pulse forms.
pub(super) fn path(path: &Path, target: &Target, pulses: &Cell<u32>) -> Result<Path, Lack> {
    let mut path = Converter { target, pulses }.path(path)?;
    let computes = |drive: &Drive| matches!(drive, Drive::Action(Action { deed: Deed::Compute(_), .. }));
    // Calculations need no load that is always on.
    if path.gates == [Gate::Pass(Expression::Constant(true))] && path.drives.iter().all(computes) {
        path.gates.clear();
    }
    Ok(path)
}

struct Converter<'t> {
    target: &'t Target,
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
            converted.drives.push(match drive {
                Drive::Path(path) => Drive::Path(self.path(path)?),
                Drive::Action(action) => self.action(action).map_err(|lack| lack.of_action(action))?,
            });
        }
        Ok(converted)
    }

    fn expression(&self, expression: &Expression) -> Result<Expression, Lack> {
        expression.mapped(&mut |contact| self.contact(contact).map_err(|lack| lack.of_contact(contact)))
    }

    fn contact(&self, contact: &Contact) -> Result<Expression, Lack> {
        let terms = match (contact.test, &contact.terms[..]) {
            (Test::Bit(kind), [term]) => match (term.always(), kind) {
                (Some(value), ContactKind::NormallyOpen) => return Ok(Expression::Constant(value)),
                (Some(value), ContactKind::NormallyClosed) => return Ok(Expression::Constant(!value)),
                _ => vec![self.bit(term)?],
            },
            (Test::Compare(operator), [left, right]) if !operator.is_wide() => {
                vec![self.word(left)?, self.word(right)?]
            }
            _ => return Err(Lack::Unnamed),
        };
        Ok(Expression::Contact(Contact { terms, ..contact.clone() }))
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
                Ok(variable(&format_smolstr!("{device}.Q"), term.span))
            }
            DeviceKind::C => {
                self.counter(device)?;
                Ok(variable(&format_smolstr!("{device}.Q"), term.span))
            }
            _ => Err(Lack::Unnamed),
        }
    }

    fn word(&self, term: &Term) -> Result<Term, Lack> {
        self.own_word(term).map_err(|lack| lack.named(&term.text))
    }

    fn own_word(&self, term: &Term) -> Result<Term, Lack> {
        match term.operand {
            Operand::Device(device) if device.kind == DeviceKind::D => self.located(device, term.span),
            Operand::Device(device) if device.kind == DeviceKind::C => {
                self.counter(device)?;
                Ok(variable(&format_smolstr!("{device}.CV"), term.span))
            }
            Operand::Constant { value, index: None } => number(value, term.span),
            _ => Err(Lack::Unnamed),
        }
    }

    fn located(&self, device: Device, span: Span) -> Result<Term, Lack> {
        let address = without(address(device))?;
        Ok(Term { storage: Storage::At(address), ..variable(&device.to_smolstr(), span) })
    }

    /// Milliseconds for each step of a timer that forgets its time when power goes off.
    fn timer_unit(&self, device: Device) -> Result<i64, Lack> {
        let range = without(device.range_on(self.target).filter(|range| !range.latched))?;
        Ok(i64::from(range.timer_unit_ms))
    }

    fn counter(&self, device: Device) -> Result<(), Lack> {
        without((device.number < 200).then_some(()))
    }

    fn action(&self, action: &Action) -> Result<Drive, Lack> {
        let span = action.span;
        match (&action.deed, &action.terms[..]) {
            (Deed::Coil(CoilKind::Plain), [timed, preset]) => {
                self.preset(timed, preset, span).map(Drive::Action)
            }
            (Deed::Coil(kind), [term]) => {
                let Operand::Device(device) = term.operand else { return Err(Lack::Unnamed) };
                match (kind, device.kind) {
                    (CoilKind::Reset, DeviceKind::C) => {
                        self.counter(device)?;
                        call("CTU", "R", &device.to_smolstr(), None, span).map(Drive::Action)
                    }
                    (CoilKind::Reset, DeviceKind::D) => {
                        let zero = literal("0", term.span);
                        self.computed("MOVE", vec![zero, self.word(term)?], span).map(Drive::Action)
                    }
                    (_, DeviceKind::T | DeviceKind::C | DeviceKind::D) => Err(Lack::Unnamed),
                    _ => Ok(Drive::Action(Action { terms: vec![self.bit(term)?], ..action.clone() })),
                }
            }
            (Deed::Instruction(form), _) if self.calculation(*form, action).is_some() => {
                let action = without(self.calculation(*form, action))??;
                if form.pulse { self.on_arrival(action) } else { Ok(Drive::Action(action)) }
            }
            (Deed::Instruction(form), [label]) if Form::named("CJ") == Some(*form) => {
                let label = variable(&label.key(), label.span);
                Ok(Drive::Action(Action { deed: Deed::Jump, terms: vec![label], span }))
            }
            _ => Err(Lack::Unnamed),
        }
    }

    /// What MOV, ADD, INC and their kin calculate; nothing for other instructions.
    fn calculation(&self, form: Form, action: &Action) -> Option<Result<Action, Lack>> {
        let row = |rows: &[(&str, &'static str)]| {
            let mut rows = rows.iter().filter(|_| !form.wide);
            rows.find(|(own, _)| *own == form.instruction.mnemonic).map(|(_, function)| *function)
        };
        let words = || action.terms.iter().map(|term| self.word(term)).collect::<Result<Vec<_>, _>>();
        if let Some(function) = row(&STEPPED) {
            let one = literal("1", action.span);
            let terms = words().and_then(|mut terms| {
                let register = without(terms.pop())?;
                Ok(vec![register.clone(), one, register])
            });
            return Some(terms.and_then(|terms| self.computed(function, terms, action.span)));
        }
        let function = row(&COMPUTED)?;
        Some(words().and_then(|mut terms| {
            let is_step = matches!(&terms[..], [left, _, result] if left == result);
            // Plain ones stand for RST, INC and DEC.
            for term in &mut terms {
                if term.text == "0" && function == "MOVE" || term.text == "1" && is_step {
                    *term = literal(&format_smolstr!("INT#{}", term.text), term.span);
                }
            }
            self.computed(function, terms, action.span)
        }))
    }

    fn computed(&self, function: &str, terms: Vec<Term>, span: Span) -> Result<Action, Lack> {
        let computation = without(Computation::named(function))?;
        let (_, result) = without(computation.operands(&terms))?;
        // The value of a counter belongs to its block.
        without((result.address().is_some()).then_some(()))?;
        Ok(Action { deed: Deed::Compute(computation), terms, span })
    }

    /// A calculation that is done when power arrives.
    fn on_arrival(&self, action: Action) -> Result<Drive, Lack> {
        self.pulses.set(self.pulses.get() + 1);
        let instance = format_smolstr!("{PULSE}{}", self.pulses.get());
        let detector = call("R_TRIG", "CLK", &instance, None, action.span)?;
        Ok(Drive::Path(Path { gates: vec![Gate::Through(detector)], drives: vec![Drive::Action(action)] }))
    }

    /// `OUT T0 K50`, `OUT C0 K10`
    fn preset(&self, device: &Term, preset: &Term, span: Span) -> Result<Action, Lack> {
        let Operand::Device(device) = device.operand else { return Err(Lack::Unnamed) };
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
            _ => Err(Lack::Unnamed),
        }
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

fn number(value: Constant, span: Span) -> Result<Term, Lack> {
    let value = match value {
        Constant::Decimal(value) => value,
        Constant::Hexadecimal(bits) => i64::from(without(u16::try_from(bits).ok())? as i16),
        Constant::Real(_) => return Err(Lack::Unnamed),
    };
    Ok(literal(&value.to_smolstr(), span))
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
