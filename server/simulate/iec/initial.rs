//! The values that variables have at first.

use super::compile::Compiler;
use super::kind::{Declared, Extent, Kind, Record, count};
use super::place::Place as Variable;
use crate::il::iec::{OperandId, SectionKind, TypeSpec, ValueKind};
use crate::simulate::{Obstacle, Problem};
use crate::target::Operand;
use crate::target::iec::{Datum, ElementaryType, GenericType, LiteralValue, characters_of};
use crate::text::{Message, folded};
use std::iter::repeat_n;

/// An initial value: a record of a source.
type Written = Option<(usize, u32)>;

/// A value that stands in the text, where one of type `kind` is wanted.
pub(super) fn constant(operand: Operand, word: &str, kind: ElementaryType) -> Option<Datum> {
    let Operand::Literal(literal) = operand else { return None };
    match literal.value {
        LiteralValue::Text | LiteralValue::WideText => match kind {
            ElementaryType::String | ElementaryType::Wstring => characters_of(word).map(Datum::Text),
            ElementaryType::Char | ElementaryType::Wchar => {
                let first = characters_of(word)?.chars().next()?;
                Some(Datum::Whole(i128::from(u32::from(first))))
            }
            _ => None,
        },
        // A bit is a bit string whose other bits are 0.
        LiteralValue::Bool(on) if kind.belongs_to(GenericType::AnyBit) => Some(Datum::from(on)),
        LiteralValue::Integer(number) if kind.belongs_to(GenericType::AnyReal) => {
            Some(Datum::Real(number as f64))
        }
        value => Datum::of_literal(value, kind),
    }
}

impl Compiler<'_> {
    /// Notes in a list what a variable has at first. With `all` also what is 0, off or empty.
    pub(super) fn initial_of_variable(
        &mut self,
        list: usize,
        variable: &Variable,
        declared: Option<Declared>,
        all: bool,
    ) {
        let written = declared.and_then(|declared| self.initially(declared));
        if let Err(problem) = self.initial(list, variable, written, all) {
            self.problems.push(problem);
        }
    }

    /// The initial value of a declaration, or of the type that it names.
    fn initially(&self, declared: Declared) -> Written {
        let mut declared = declared;
        // Types that name each other in a circle are refused elsewhere.
        for _ in 0..16 {
            let declaration = self.declared.declaration(declared.source, declared.index);
            if let Some(value) = declaration.initial {
                return Some((declared.source, value));
            }
            let spec = self.declared.sources[declared.source].tree.type_spec(declaration.declared?);
            let TypeSpec::Named = spec.value else { return None };
            let name = folded(self.declared.word(declared.source, spec.span));
            let (source, index) = *self.declared.types.get(&name)?;
            declared = Declared { source, index };
        }
        None
    }

    fn initial(
        &mut self,
        list: usize,
        variable: &Variable,
        written: Written,
        all: bool,
    ) -> Result<(), Problem> {
        match &variable.kind {
            Kind::Elementary(kind, _) => {
                let value = match written {
                    Some((source, at)) => self.initial_datum(source, at, *kind)?,
                    None => Datum::default_of(*kind),
                };
                self.noted(list, variable, value, all);
            }
            Kind::Subrange(kind, range) => {
                let value = match written {
                    Some((source, at)) => self.initial_datum(source, at, *kind)?,
                    // The first number of the range, where 0 may be none of it.
                    None => self
                        .parts
                        .ranges
                        .get(*range as usize - 1)
                        .map_or(Datum::Whole(0), |range| Datum::Whole(range.0)),
                };
                self.noted(list, variable, value, all);
            }
            Kind::Enumeration(names) => {
                let value = match written {
                    Some((source, at)) => {
                        let word = self.constant_at(source, at).map(|id| self.declared.operand(source, id));
                        let name = word.map(|word| folded(word.rsplit('#').next().unwrap_or(word)));
                        let place = names.values.iter().position(|own| Some(folded(own)) == name);
                        place.ok_or_else(|| self.unreadable(source, at))?
                    }
                    None => 0,
                };
                self.noted(list, variable, Datum::Whole(value as i128), all);
            }
            Kind::Array(bounds, element) => {
                let values = match written {
                    Some((source, at)) => self.elements(source, at, count(bounds))?,
                    None => Vec::new(),
                };
                let size = variable.size_of(element);
                // Elements without a value that all begin with 0 need no look.
                let is_plain = values.is_empty() && !all && !begins_otherwise(element);
                let count = if is_plain { 0 } else { count(bounds).min(MOST_ELEMENTS) };
                for number in 0..count {
                    let Some(part) = variable.part((**element).clone(), size.times(number)) else { break };
                    self.initial(list, &part, values.get(number as usize).copied().flatten(), all)?;
                }
            }
            Kind::Record(record) => self.initial_of_record(list, variable, &record.clone(), written, all)?,
        }
        Ok(())
    }

    fn initial_of_record(
        &mut self,
        list: usize,
        variable: &Variable,
        record: &Record,
        written: Written,
        all: bool,
    ) -> Result<(), Problem> {
        for field in &record.fields {
            let own = written.and_then(|(source, at)| {
                let tree = self.declared.sources[source].tree;
                let is_own = |value: &u32| {
                    let name = tree.values[*value as usize].field;
                    name.is_some_and(|name| folded(self.declared.word(source, name)) == folded(&field.name))
                };
                // The value itself stands behind the record that names the field.
                tree.values_inside(at).find(is_own).map(|value| (source, value))
            });
            let value = own.or_else(|| field.declared.and_then(|declared| self.initially(declared)));
            let place = match field.address {
                Some(address) if value.is_some() => self.located(address, &field.kind).ok(),
                _ if field.has_place() => variable.part(field.kind.clone(), field.at),
                _ => None,
            };
            if let Some(place) = place
                && field.section != SectionKind::External
            {
                self.initial(list, &place, value, all)?;
            }
        }
        Ok(())
    }

    fn noted(&mut self, list: usize, variable: &Variable, value: Datum, all: bool) {
        let is_nothing = matches!(&value, Datum::Whole(0))
            || matches!(&value, Datum::Real(number) if *number == 0.0)
            || matches!(&value, Datum::Text(text) if text.is_empty());
        let variable = self.bound_to(variable.clone());
        if let (Some(spot), true) = (variable.spot(), all || !is_nothing) {
            self.parts.initials[list].push((spot, value));
        }
    }

    /// The values of the elements of an array, repetitions written out.
    fn elements(&self, source: usize, at: u32, most: u64) -> Result<Vec<Written>, Problem> {
        let tree = self.declared.sources[source].tree;
        let mut values: Vec<Written> = Vec::new();
        let mut inside: Vec<u32> = match self.declared.value(source, at).map(|value| value.kind) {
            Some(ValueKind::Array) => tree.values_inside(at).collect(),
            _ => vec![at],
        };
        inside.reverse();
        while let Some(at) = inside.pop() {
            match tree.values[at as usize].kind {
                ValueKind::Repeat { count } => {
                    let count = self.declared.operand(source, count).replace('_', "").parse::<u64>();
                    let count = count.map_err(|_| self.unreadable(source, at))?;
                    let repeated: Vec<u32> = tree.values_inside(at).collect();
                    let room = most.saturating_sub(values.len() as u64);
                    match &repeated[..] {
                        [] => values.extend(repeat_n(None, count.min(room) as usize)),
                        all => {
                            for _ in 0..count.min(room) {
                                values.extend(all.iter().map(|value| Some((source, *value))));
                            }
                        }
                    }
                }
                _ => values.push(Some((source, at))),
            }
        }
        Ok(values)
    }

    fn constant_at(&self, source: usize, at: u32) -> Option<OperandId> {
        match self.declared.value(source, at)?.kind {
            ValueKind::Constant(id) => Some(id),
            _ => None,
        }
    }

    fn initial_datum(&self, source: usize, at: u32, kind: ElementaryType) -> Result<Datum, Problem> {
        let wrong = || self.unreadable(source, at);
        let id = self.constant_at(source, at).ok_or_else(wrong)?;
        let operand = self.declared.sources[source].tree.operand(id);
        let word = self.declared.word(source, operand.span);
        let value = constant(operand.value, word, kind).or_else(|| {
            let (source, id) = self.constant(word, None)?;
            let operand = self.declared.sources[source].tree.operand(id);
            constant(operand.value, self.declared.word(source, operand.span), kind)
        });
        value.ok_or_else(wrong)
    }

    fn unreadable(&self, source: usize, at: u32) -> Problem {
        let span = self.declared.value(source, at).map_or_else(Default::default, |value| value.span);
        let obstacle = Obstacle::Iec(Message::new("simulate.initial"));
        Problem { place: self.declared.place(source, span), obstacle }
    }
}

/// More elements of an array are not looked at one by one.
const MOST_ELEMENTS: u64 = 1 << 20;

/// Whether a variable of this type may have something else than 0 at first, though nothing is written at it.
fn begins_otherwise(kind: &Kind) -> bool {
    match kind {
        Kind::Elementary(kind, _) => !is_zero(*kind),
        Kind::Subrange(..) => true,
        Kind::Enumeration(_) => false,
        Kind::Array(_, element) => begins_otherwise(element),
        Kind::Record(record) => record.size != Extent::default(),
    }
}

fn is_zero(kind: ElementaryType) -> bool {
    match Datum::default_of(kind) {
        Datum::Whole(number) => number == 0,
        Datum::Real(number) => number == 0.0,
        Datum::Text(text) => text.is_empty(),
    }
}
