//! Constants as numbers, and the numbers that what they are compared with can be.

use super::{Formulas, Term};
use crate::target::iec::{ElementaryType, Literal, LiteralValue};
use crate::target::{Constant, Operand};
use std::ops::RangeInclusive;

/// Numbers beyond this are not calculated with: sums of some of them must have room in 64 bits.
pub(super) const NUMBER_MAX: u64 = 1 << 61;

/// The whole number that `term` is where it is compared with `other`, in 16 or 32 bits on the FX family.
///
/// A literal of IEC 61131-3 is a number only next to an integer or a bit string whose type is known, and if that type
/// and its own convert to each other without a change of any value: of `5` next to a REAL, or of `UINT#5` next to an
/// INT, nobody knows which numbers lie beside it.
pub(super) fn number(term: &Term, other: &Term, wide: bool, formulas: &Formulas) -> Option<i128> {
    match term.operand {
        Operand::Constant { value: Constant::Decimal(value), index: None } => Some(i128::from(value)),
        Operand::Constant { value: Constant::Hexadecimal(bits), index: None } => match wide {
            true => u32::try_from(bits).ok().map(|bits| i128::from(bits as i32)),
            false => u16::try_from(bits).ok().map(|bits| i128::from(bits as i16)),
        },
        Operand::Literal(literal) => {
            let LiteralValue::Integer(value) = literal.value else { return None };
            let fits = match other.operand {
                Operand::Literal(other) => {
                    matches!(other.value, LiteralValue::Integer(_)) && other.named_type == literal.named_type
                }
                _ => formulas.type_of(&other.key()).is_some_and(|kind| is_number_of(literal, value, kind)),
            };
            fits.then_some(value)
        }
        _ => None,
    }
}

/// Whether a literal of this value is compared with a variable of type `kind` as one number with another.
fn is_number_of(literal: Literal, value: i128, kind: ElementaryType) -> bool {
    let Some(range) = integers(kind) else { return false };
    match literal.named_type {
        None => range.contains(&value),
        Some(own) => {
            let holds = integers(own).is_some_and(|own| own.contains(&value));
            holds && (own == kind || own.widens_to(kind) || kind.widens_to(own))
        }
    }
}

/// The numbers that `term` can be: those of its type where that is known, else of 16 or 32 bits with a sign.
pub(super) fn range(term: &Term, wide: bool, formulas: &Formulas) -> RangeInclusive<i128> {
    let known = match term.operand {
        Operand::Variable | Operand::Direct(_) => formulas.type_of(&term.key()).and_then(integers),
        _ => None,
    };
    known.unwrap_or(match wide {
        true => i128::from(i32::MIN)..=i128::from(i32::MAX),
        false => i128::from(i16::MIN)..=i128::from(i16::MAX),
    })
}

/// The numbers of an integer type, or of a bit string, which is compared like a number without a sign: IEC 61131-3
/// has its bits compared from the leftmost one on.
fn integers(kind: ElementaryType) -> Option<RangeInclusive<i128>> {
    kind.integers().filter(|_| kind != ElementaryType::Bool)
}
