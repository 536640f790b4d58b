//! The contacts that decide whether power comes to an instruction, with what they saw.

use super::cut::Condition;
use super::drivers::{Driver, Wire};
use super::seen::Seen;
use super::{Inquiry, Literal, Moment};
use crate::ladder::{CompareOperator, ContactKind};
use crate::logic::{Contact, Expression, Term, Test};
use crate::simulate::{Place, Sight, Value};
use crate::text::Span;

/// The literals of a rung, with their values and the sights in which these were seen.
pub(super) struct Literals<'i, 'a> {
    inquiry: &'i Inquiry<'a>,
    seen: &'i Seen,
    at: Moment,
    /// The instruction whose power they decide.
    driver: &'i Driver,
    pub(super) known: Vec<(Literal, bool, usize)>,
}

impl<'i, 'a> Literals<'i, 'a> {
    pub(super) fn new(
        inquiry: &'i Inquiry<'a>,
        seen: &'i Seen,
        at: Moment,
        driver: &'i Driver,
    ) -> Literals<'i, 'a> {
        Literals { inquiry, seen, at, driver, known: Vec::new() }
    }

    pub(super) fn wire(&mut self, wire: &Wire) -> Option<Condition> {
        match wire {
            Wire::Pass(expression) => self.expression(expression),
            Wire::Not(part) => Some(Condition::Not(Box::new(self.wire(part)?))),
            Wire::Series(parts) => {
                parts.iter().map(|part| self.wire(part)).collect::<Option<_>>().map(Condition::And)
            }
            Wire::Through(action) => {
                let place = self.placed(action.span);
                let (at, sight) = self.last(place)?;
                let is_rail = self.inquiry.drivers.rail(place).is_some();
                let literal = if is_rail { Literal::Rail(place) } else { Literal::Through(place) };
                Some(self.literal(literal, sight.power != 0, at))
            }
        }
    }

    fn expression(&mut self, expression: &Expression) -> Option<Condition> {
        let mut all =
            |parts: &[Expression]| parts.iter().map(|part| self.expression(part)).collect::<Option<Vec<_>>>();
        Some(match expression {
            Expression::Constant(value) => Condition::Constant(*value),
            Expression::Not(part) => Condition::Not(Box::new(self.expression(part)?)),
            Expression::And(parts) => Condition::And(all(parts)?),
            Expression::Or(parts) => Condition::Or(all(parts)?),
            Expression::Contact(contact) => self.contact(contact)?,
        })
    }

    fn last(&self, place: Place) -> Option<(usize, Sight<u8>)> {
        let frame = self.inquiry.frame(self.driver);
        self.seen.last(self.inquiry.watched, place, frame, self.at.before)
    }

    fn contact(&mut self, contact: &Contact) -> Option<Condition> {
        let place = self.placed(contact.span);
        let subject = self.inquiry.subject_of(contact.terms.first()?, self.driver);
        let is_inverse = contact.test == Test::Bit(ContactKind::NormallyClosed);
        let is_plain = is_inverse || contact.test == Test::Bit(ContactKind::NormallyOpen);
        let sight = self.last(place);
        // What JMPCN goes by is read as the opposite of the contact that the list has.
        let is_listed = is_plain && subject.is_some() && self.inquiry.is_in_list(place);
        let (at, conducts) = match (sight, &subject) {
            (Some((at, Sight { conducts: Some(conducts), .. })), _) if !is_listed => (at, conducts != 0),
            // A list tells of the current result, and nothing of what is handed over in a call.
            (sight, Some(subject)) if is_plain => {
                let at = sight.map_or(self.at.before, |(at, _)| at);
                let moment = Moment { before: at, ..self.at };
                let value = self.inquiry.value_at(subject.variable, moment)?.as_bit()?;
                (at, value != is_inverse)
            }
            (sight, _) if self.driver.frame.is_some() => {
                let at = sight.map_or(self.at.before, |(at, _)| at);
                (at, self.compares(contact, Moment { before: at, ..self.at })?)
            }
            _ => return None,
        };
        Some(match subject.filter(|_| is_plain) {
            Some(subject) => {
                let literal = self.literal(Literal::Bit(subject, place), conducts != is_inverse, at);
                if is_inverse { Condition::Not(Box::new(literal)) } else { literal }
            }
            None => {
                let (words, compared) = match (contact.test, &contact.terms[..]) {
                    (Test::Compare(how), [left, right]) => {
                        let words = format!("{} {} {}", left.text, how.iec_name(), right.text);
                        let words = self.inquiry.is_in_list(place).then_some(words);
                        (words, self.inquiry.subjects(&contact.terms, self.driver))
                    }
                    _ => (None, Vec::new()),
                };
                self.literal(Literal::Contact(place, words, compared), conducts, at)
            }
        })
    }

    /// Whether a comparison in a list holds, which tells of the current result only.
    fn compares(&self, contact: &Contact, at: Moment) -> Option<bool> {
        let (Test::Compare(how), [left, right]) = (contact.test, &contact.terms[..]) else { return None };
        let value = |term: &Term| match self.inquiry.subject_of(term, self.driver) {
            Some(subject) => self.inquiry.value_at(subject.variable, at),
            None => Value::read(&term.text),
        };
        let (left, right) = (value(left)?.as_number()?, value(right)?.as_number()?);
        Some(match how {
            CompareOperator::Equal { .. } => left == right,
            CompareOperator::NotEqual { .. } => left != right,
            CompareOperator::Greater { .. } => left > right,
            CompareOperator::Less { .. } => left < right,
            CompareOperator::GreaterOrEqual { .. } => left >= right,
            CompareOperator::LessOrEqual { .. } => left <= right,
        })
    }

    pub(super) fn rail(&mut self, place: Place) -> Option<Condition> {
        let (at, sight) = self.last(place)?;
        Some(self.literal(Literal::Rail(place), sight.power != 0, at))
    }

    /// The same device with the same value is one literal, wherever its contacts stand.
    fn literal(&mut self, literal: Literal, value: bool, at: usize) -> Condition {
        let same = |(known, other, _): &(Literal, bool, usize)| match (known, &literal) {
            (Literal::Bit(known, _), Literal::Bit(subject, _)) => known == subject && *other == value,
            (known, literal) => known == literal,
        };
        let number = self.known.iter().position(same).unwrap_or_else(|| {
            self.known.push((literal, value, at));
            self.known.len() - 1
        });
        Condition::Literal(number)
    }

    /// Spans of a rung count from where its chunk begins.
    fn placed(&self, span: Span) -> Place {
        let document = self.inquiry.documents.get(self.driver.place.document as usize);
        let start = document.and_then(|document| document.chunk_at(self.driver.place.span.start as usize));
        Place { document: self.driver.place.document, span: span.shifted(start.map_or(0, |at| at.start)) }
    }
}
