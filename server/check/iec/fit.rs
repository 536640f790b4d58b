//! Whether a value may stand where a type is expected.

use super::{Expected, ValueType};
use crate::target::iec::{ElementaryType, GenericType, Literal, LiteralValue};

/// The answer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fit {
    /// It may, or nobody can say.
    Fits,
    /// A number that the type cannot hold.
    OutOfRange(ElementaryType),
    /// Another type.
    Mismatch,
}

/// Whether `value` may stand where `expected` is. Widening without loss is allowed, as in the third edition;
/// narrowing is not.
pub fn fit(value: &ValueType, expected: Expected) -> Fit {
    match (value, expected) {
        (ValueType::Unknown, _) | (_, Expected::Unknown) => Fit::Fits,
        (ValueType::Elementary(from), Expected::Elementary(to)) => fits_if(from.widens_to(to)),
        (ValueType::Elementary(from), Expected::Group(group)) => fits_if(group.contains(*from)),
        (ValueType::Literal(literal), Expected::Elementary(to)) => literal_fit(literal, to),
        (ValueType::Literal(literal), Expected::Group(group)) => fits_if(may_belong(literal, group)),
        (ValueType::Instance(_), _) => Fit::Mismatch,
    }
}

fn fits_if(fits: bool) -> Fit {
    if fits { Fit::Fits } else { Fit::Mismatch }
}

/// Whether a constant may stand where a value of type `kind` is expected.
fn literal_fit(literal: &Literal, kind: ElementaryType) -> Fit {
    let widens = literal.named_type.is_some_and(|named| {
        named.widens_to(kind) || named == ElementaryType::String && kind == ElementaryType::Char
    });
    if widens || literal.fits(kind) {
        return Fit::Fits;
    }
    if literal.named_type.is_some() {
        return Fit::Mismatch;
    }
    match literal.value {
        // A mantissa holds all integers up to its own size, so that `2` is a REAL where a REAL is expected.
        LiteralValue::Integer(value) if kind.belongs_to(GenericType::AnyReal) => {
            let bits = if kind == ElementaryType::Real { 24 } else { 53 };
            if value.unsigned_abs() <= 1 << bits { Fit::Fits } else { Fit::OutOfRange(kind) }
        }
        LiteralValue::Integer(_) if kind != ElementaryType::Bool && kind.integers().is_some() => {
            Fit::OutOfRange(kind)
        }
        LiteralValue::Real(_) if kind == ElementaryType::Real => Fit::OutOfRange(kind),
        _ => Fit::Mismatch,
    }
}

/// Whether a constant may be of some type of `group`.
fn may_belong(literal: &Literal, group: GenericType) -> bool {
    match (literal.natural_type(), literal.named_type) {
        (None, _) => true,
        (Some(kind), Some(_)) => group.contains(kind),
        (Some(_), None) => group.members().any(|kind| literal_fit(literal, kind) == Fit::Fits),
    }
}
