//! Why the parts of an instance of a function block are what they are.

use super::drivers::Driver;
use super::subject::Subject;
use super::{Inquiry, Moment, Reason};
use crate::logic::{Call, Callee, Term};
use crate::simulate::{Value, Variable};
use crate::target::Operand;
use crate::text::Message;

impl Inquiry<'_> {
    /// Why a call gave a value: to an input of its instance, to an output, or to where an output is written to.
    pub(super) fn called(
        &self,
        subject: &Subject,
        call: &Call,
        driver: &Driver,
        at: Moment,
        told: &dyn Fn(Message) -> Message,
        asked: &mut Vec<Subject>,
    ) -> Reason {
        let place = Some(driver.place);
        let terms = &driver.action.terms;
        let arguments = call.arguments(terms);
        let behind = Moment { before: at.before + 1, ..at };
        let pin = |name: &str| {
            let member = format!("{}.{name}", terms.first()?.text);
            self.subject_of(&Term::new(Operand::Variable, &member, driver.action.span), driver)
        };
        let is_it = |name: &str| pin(name).is_some_and(|pin| pin == *subject);
        let made = Message::new("why.executed").with("instruction", self.words(driver.place));
        // Where an output is written to: the output itself says why.
        let output = arguments.iter().find(|argument| {
            argument.is_output && self.subject_of(&argument.term, driver).is_some_and(|own| own == *subject)
        });
        if let Some(pin) = output.and_then(|output| pin(output.name)) {
            let at = Moment { before: self.end_of(driver, at), ..at };
            let because = self.values_of(&[pin], at, asked);
            return self.reason(told(made), place, at.scan, because);
        }
        let inputs = call.block.inputs();
        let mut because = Vec::new();
        let mut of_input = |name: &str, asked: &mut Vec<Subject>| {
            if name.eq_ignore_ascii_case(call.power_in()) && driver.wire.is_some() {
                because.extend(self.power(driver, at, true, asked));
            } else if let Some(argument) = arguments.iter().find(|argument| argument.name == name) {
                let handed = self.subjects(std::slice::from_ref(&argument.term), driver);
                because.extend(self.values_of(&handed, at, asked));
            } else if let Some(pin) = pin(name)
                .filter(|pin| matches!(pin.variable, Variable::Relay(_)) && self.drivers_of(pin).len() > 1)
            {
                because.extend(self.values_of(&[pin], at, asked));
            }
        };
        if let Some(input) = inputs.iter().find(|input| is_it(input.name)) {
            of_input(input.name, asked);
            return self.reason(told(made), place, at.scan, because);
        }
        inputs.iter().for_each(|input| of_input(input.name, asked));
        let how = self.counted_by(call, &pin, behind).unwrap_or_else(|| made.clone());
        self.reason(told(how), place, at.scan, because)
    }

    /// How far a timer or a counter of the standard is.
    fn counted_by(&self, call: &Call, pin: &dyn Fn(&str) -> Option<Subject>, at: Moment) -> Option<Message> {
        let Callee::Block(_) = call.block else { return None };
        let value = |name: &str| self.value_at(pin(name)?.variable, at);
        match (value("ET"), value("PT"), value("CV"), value("PV")) {
            (Some(Value::Time(now)), Some(Value::Time(preset)), ..) => {
                let seconds = |time: i64| time as f64 / 1e9;
                let key = if now >= preset { "why.timed" } else { "why.timing" };
                Some(Message::new(key).with("now", seconds(now)).with("preset", seconds(preset)))
            }
            (_, _, Some(now), Some(preset)) => {
                let key =
                    if now.as_number()? >= preset.as_number()? { "why.counted" } else { "why.counting" };
                Some(Message::new(key).with("now", now).with("preset", preset))
            }
            _ => None,
        }
    }

    /// The number of the first sight behind a call that is none of the unit that it calls.
    fn end_of(&self, driver: &Driver, at: Moment) -> usize {
        let Some((seen, frame)) = self.seen(at.scan).zip(self.frame(driver)) else { return at.before + 1 };
        let mut later = at.before + 1..seen.len();
        let is_own =
            |number: &usize| seen.at(*number).is_some_and(|sight| frame.contains(&sight.instruction));
        later.find(is_own).unwrap_or(seen.len())
    }

    /// The moment at which a calculation of several lines began.
    pub(super) fn begun(&self, driver: &Driver, at: Moment) -> Moment {
        let lines = self.drivers.several_lines(driver.place).map_or(1, |own| {
            let document = self.documents.get(own.document as usize);
            document.map_or(1, |document| document.slice(own.span).lines().count())
        });
        Moment { before: at.before.saturating_sub(lines - 1), ..at }
    }
}
