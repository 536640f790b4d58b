//! What is asked about, and what drives it.

use super::Inquiry;
use super::drivers::Driver;
use crate::logic::Term;
use crate::simulate::{Spot, Variable};
use crate::target::{Device, Operand};
use smol_str::{SmolStr, ToSmolStr};
use std::ops::Range;

/// What is asked about.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Subject {
    /// A device as terms are compared, a variable as people call it.
    pub(super) name: SmolStr,
    pub(super) device: Option<Device>,
    pub(super) variable: Variable,
}

impl Inquiry<'_> {
    /// What people call so.
    pub(super) fn subject(&self, name: &str) -> Option<Subject> {
        let name = name.trim();
        let code = self.watched;
        if !code.target.is_fx() {
            return code.variable(name).map(|variable| self.variable_subject(variable, name));
        }
        let device = |name: &str| match Operand::read(name, code.target.model) {
            Operand::Device(device) => Some(device),
            _ => None,
        };
        // TS0, TC0 and TN0 are parts of T0.
        let whole = || {
            let (kind, rest) = (name.get(..1)?, name.get(1..)?);
            let rest = rest.strip_prefix(['S', 'C', 'N', 's', 'c', 'n'])?;
            device(&format!("{kind}{rest}")).filter(|device| device.kind.has_preset())
        };
        match device(name).or_else(whole) {
            Some(device) => self.device_subject(device),
            None => {
                let variable = code.variable(name)?;
                Some(Subject { name: name.to_lowercase().into(), device: None, variable })
            }
        }
    }

    pub(super) fn device_subject(&self, device: Device) -> Option<Subject> {
        let layout = &self.watched.layout;
        let relay = layout.cell(device).map(Variable::Relay);
        let variable = relay.or_else(|| layout.slot(device).map(Variable::Word))?;
        Some(Subject { name: device.to_smolstr(), device: Some(device), variable })
    }

    pub(super) fn variable_subject(&self, variable: Variable, name: &str) -> Subject {
        let spot = match variable {
            Variable::Relay(cell) => Some(Spot::of_cell(cell)),
            Variable::Typed(spot) | Variable::Enumerated(spot, _) => Some(spot),
            _ => None,
        };
        let own = spot.and_then(|spot| self.watched.iec.name_of(spot));
        Subject { name: own.map_or_else(|| name.into(), SmolStr::from), device: None, variable }
    }

    /// What an operand of an instruction is, seen from where that stands.
    pub(super) fn subject_of(&self, term: &Term, driver: &Driver) -> Option<Subject> {
        match (term.operand, driver.frame) {
            (Operand::Device(device), _) => self.device_subject(device),
            (_, Some(frame)) => {
                let variable = self.watched.variable_in(frame, &term.text)?;
                Some(self.variable_subject(variable, &term.text))
            }
            (_, None) => self.subject(&term.text),
        }
    }

    /// The operands that are variables, each once.
    pub(super) fn subjects(&self, terms: &[Term], driver: &Driver) -> Vec<Subject> {
        let mut subjects: Vec<Subject> = Vec::new();
        for term in terms {
            if let Some(subject) = self.subject_of(term, driver).filter(|subject| !subjects.contains(subject))
            {
                subjects.push(subject);
            }
        }
        subjects
    }

    /// What drives it, in the order of the text. In IEC 61131-3 each instance of a unit has drivers of its own.
    pub(super) fn drivers_of(&self, subject: &Subject) -> Vec<Driver> {
        match self.watched.target.is_fx() {
            true => self.drivers.named(&subject.name).to_vec(),
            false => self.drivers.of_variable(subject.variable, self.watched),
        }
    }

    /// The numbers of the instructions of the body in which an instruction stands.
    pub(super) fn frame(&self, driver: &Driver) -> Option<Range<u32>> {
        driver.frame.map(|frame| self.watched.iec.names().instructions_of(frame))
    }
}
