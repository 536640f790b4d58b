//! Conditions: what must hold for power to pass.

use super::Term;
use crate::document::{compare_form, contact_form};
use crate::ladder::{CompareOperator, ContactKind};
use crate::target::{Form, Role};
use crate::text::Span;
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// A condition. Its connections have any number of parts, so that 500 parallel branches are one level and not 500.
///
/// Canonical where the constructors made it: no series directly in a series, no parallel directly in a parallel, both
/// with at least two parts.
#[derive(Clone, PartialEq, Debug)]
pub enum Expression {
    /// A wire, or no connection at all.
    Constant(bool),
    /// A contact or a comparison.
    Contact(Contact),
    /// The part inverted.
    Not(Box<Expression>),
    /// Parts in series, from left to right.
    And(Vec<Expression>),
    /// Branches from top to bottom.
    Or(Vec<Expression>),
}

/// A contact: it tests devices, and conducts while the test holds.
#[derive(Clone, PartialEq, Debug)]
pub struct Contact {
    /// What it asks.
    pub test: Test,
    /// Of which devices: one, or both sides of a comparison.
    pub terms: Vec<Term>,
    /// Its cells, or its line, in the chunk that it was read from.
    pub span: Span,
}

/// What a contact asks.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Test {
    /// A bit.
    Bit(ContactKind),
    /// Two words.
    Compare(CompareOperator),
}

impl Test {
    /// The test of an FX contact in any of its places: of LD as of AND and OR.
    pub fn of_form(form: Form) -> Option<Test> {
        let load = form.placed(Role::Load)?;
        TESTS.get(&(load.instruction.mnemonic, load.wide)).copied()
    }

    /// The load that makes this test on the FX family.
    pub fn form(self) -> Option<Form> {
        match self {
            Test::Bit(kind) => contact_form(kind),
            Test::Compare(operator) => compare_form(operator),
        }
    }

    /// The test that holds where this one does not; an edge has none.
    pub fn opposite(self) -> Option<Test> {
        Some(match self {
            Test::Bit(ContactKind::NormallyOpen) => Test::Bit(ContactKind::NormallyClosed),
            Test::Bit(ContactKind::NormallyClosed) => Test::Bit(ContactKind::NormallyOpen),
            Test::Bit(ContactKind::Rising | ContactKind::Falling) => return None,
            Test::Compare(operator) => Test::Compare(operator.opposite()),
        })
    }
}

static TESTS: LazyLock<FxHashMap<(&'static str, bool), Test>> = LazyLock::new(|| {
    let bits = ContactKind::ALL.into_iter().map(Test::Bit);
    let tests = bits.chain(CompareOperator::ALL.into_iter().map(Test::Compare));
    tests.filter_map(|test| test.form().map(|form| ((form.instruction.mnemonic, form.wide), test))).collect()
});

impl Expression {
    /// How deep connections may nest, see [`Shape::DEPTH_MAX`](crate::ladder::reduce::Shape::DEPTH_MAX). Who builds an
    /// expression step by step asks [`Expression::depth`], so that recursion over it is safe.
    pub const DEPTH_MAX: usize = crate::ladder::reduce::Shape::DEPTH_MAX;

    /// Parts in series.
    pub fn and(parts: impl IntoIterator<Item = Expression>) -> Expression {
        let mut series = Vec::new();
        for part in parts {
            match part {
                Expression::And(parts) => series.extend(parts),
                Expression::Constant(true) => {}
                part => series.push(part),
            }
        }
        match series.len() {
            0 => Expression::Constant(true),
            1 => series.remove(0),
            _ => Expression::And(series),
        }
    }

    /// Branches in parallel.
    pub fn or(parts: impl IntoIterator<Item = Expression>) -> Expression {
        let mut branches = Vec::new();
        for part in parts {
            match part {
                Expression::Or(parts) => branches.extend(parts),
                Expression::Constant(false) => {}
                part => branches.push(part),
            }
        }
        match branches.len() {
            0 => Expression::Constant(false),
            1 => branches.remove(0),
            _ => Expression::Or(branches),
        }
    }

    /// Puts `part` in series behind this, without copying what is there.
    pub fn and_with(&mut self, part: Expression) {
        if let Expression::And(parts) = self {
            match part {
                Expression::And(more) => parts.extend(more),
                Expression::Constant(true) => {}
                part => parts.push(part),
            }
            return;
        }
        let first = std::mem::replace(self, Expression::Constant(true));
        *self = Expression::and([first, part]);
    }

    /// Puts `part` in parallel below this, without copying what is there.
    pub fn or_with(&mut self, part: Expression) {
        if let Expression::Or(parts) = self {
            match part {
                Expression::Or(more) => parts.extend(more),
                Expression::Constant(false) => {}
                part => parts.push(part),
            }
            return;
        }
        let first = std::mem::replace(self, Expression::Constant(false));
        *self = Expression::or([first, part]);
    }

    /// The parts of a connection; nothing inside a contact or a constant.
    pub fn parts(&self) -> &[Expression] {
        match self {
            Expression::And(parts) | Expression::Or(parts) => parts,
            Expression::Not(part) => std::slice::from_ref(part),
            Expression::Constant(_) | Expression::Contact(_) => &[],
        }
    }

    /// How many contacts, constants and connections it has.
    pub(super) fn size(&self) -> usize {
        1 + self.parts().iter().map(Expression::size).sum::<usize>()
    }

    /// Calls `found` with each contact, left to right and top to bottom.
    pub fn visit<'e>(&'e self, found: &mut impl FnMut(&'e Contact)) {
        match self {
            Expression::Contact(contact) => found(contact),
            _ => self.parts().iter().for_each(|part| part.visit(found)),
        }
    }

    /// Calls `found` with all operands.
    pub fn each_term(&mut self, found: &mut impl FnMut(&mut Term)) {
        match self {
            Expression::Constant(_) => {}
            Expression::Contact(contact) => contact.terms.iter_mut().for_each(found),
            Expression::Not(part) => part.each_term(found),
            Expression::And(parts) | Expression::Or(parts) => {
                parts.iter_mut().for_each(|part| part.each_term(found));
            }
        }
    }

    /// Moves it later in the text by so many bytes.
    pub fn shift(&mut self, start: usize) {
        match self {
            Expression::Constant(_) => {}
            Expression::Contact(contact) => {
                contact.span = contact.span.shifted(start);
                contact.terms.iter_mut().for_each(|term| term.span = term.span.shifted(start));
            }
            Expression::Not(part) => part.shift(start),
            Expression::And(parts) | Expression::Or(parts) => {
                parts.iter_mut().for_each(|part| part.shift(start));
            }
        }
    }

    /// The contacts, left to right and top to bottom.
    pub fn contacts(&self) -> Vec<&Contact> {
        let mut contacts = Vec::new();
        self.visit(&mut |contact| contacts.push(contact));
        contacts
    }

    /// The same connections with other conditions for contacts; the first error of `instead`, if there is one.
    pub fn mapped<E>(
        &self,
        instead: &mut impl FnMut(&Contact) -> Result<Expression, E>,
    ) -> Result<Expression, E> {
        let mut all = |parts: &[Expression]| {
            parts.iter().map(|part| part.mapped(instead)).collect::<Result<Vec<_>, E>>()
        };
        Ok(match self {
            Expression::Constant(value) => Expression::Constant(*value),
            Expression::And(parts) => Expression::and(all(parts)?),
            Expression::Or(parts) => Expression::or(all(parts)?),
            Expression::Contact(contact) => instead(contact)?,
            Expression::Not(part) => Expression::Not(Box::new(part.mapped(instead)?)),
        })
    }

    /// The expression that holds where this one does not, with the negation moved into its contacts: De Morgan's form.
    /// An edge keeps its negation before it.
    pub fn negated(&self) -> Expression {
        match self {
            Expression::Constant(value) => Expression::Constant(!value),
            Expression::Contact(contact) => match contact.test.opposite() {
                Some(test) => Expression::Contact(Contact { test, ..contact.clone() }),
                None => Expression::Not(Box::new(self.clone())),
            },
            Expression::Not(part) => (**part).clone(),
            Expression::And(parts) => Expression::or(parts.iter().map(Expression::negated)),
            Expression::Or(parts) => Expression::and(parts.iter().map(Expression::negated)),
        }
    }
}
