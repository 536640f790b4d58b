//! Constants as numbers, and the numbers that what they are compared with can be.

use super::formula::Kind;
use super::{Formulas, Moment, Term};
use crate::target::iec::{ElementaryType, Literal, LiteralValue};
use crate::target::{Constant, Model, Operand};

/// The number that `term` is where it is compared with `other`, in 16 or 32 bits on the FX family.
///
/// A literal of IEC 61131-3 is a number only next to a variable whose type is known, and if that type and its own
/// convert to each other without a change of any value: of `5` next to a REAL, or of `UINT#5` next to an INT, nobody
/// knows which numbers lie beside it. Times count in nanoseconds. Real numbers have the places that they have among all
/// numbers of their type, so that the next number is the next larger one.
pub(super) fn number(term: &Term, other: &Term, wide: bool, formulas: &Formulas) -> Option<i128> {
    match term.operand {
        Operand::Constant { value: Constant::Decimal(value), index: None } => Some(i128::from(value)),
        Operand::Constant { value: Constant::Hexadecimal(bits), index: None } => match wide {
            true => u32::try_from(bits).ok().map(|bits| i128::from(bits as i32)),
            false => u16::try_from(bits).ok().map(|bits| i128::from(bits as i16)),
        },
        Operand::Literal(literal) => match other.operand {
            Operand::Literal(other) if other.named_type != literal.named_type => None,
            Operand::Literal(_) => alone(literal),
            _ => formulas.type_of(&other.key()).and_then(|kind| next_to(literal, kind)),
        },
        _ => None,
    }
}

/// The number that a literal is next to another literal of its type.
fn alone(literal: Literal) -> Option<i128> {
    match literal.value {
        LiteralValue::Integer(value) => Some(value),
        LiteralValue::Time(value) | LiteralValue::TimeOfDay(value) => Some(i128::from(value)),
        LiteralValue::Date(value) => Some(i128::from(value)),
        LiteralValue::DateAndTime(value) => Some(value),
        // In which size they are compared, nobody knows.
        _ => None,
    }
}

/// The number that a literal is next to a variable of type `kind`.
fn next_to(literal: Literal, kind: ElementaryType) -> Option<i128> {
    use ElementaryType::*;
    match (literal.value, kind) {
        (LiteralValue::Integer(value), _) => is_number_of(literal, value, kind).then_some(value),
        (LiteralValue::Time(value), Time | Ltime)
        | (LiteralValue::TimeOfDay(value), TimeOfDay | LtimeOfDay) => Some(i128::from(value)),
        (LiteralValue::Date(value), Date) => Some(i128::from(value)),
        (LiteralValue::DateAndTime(value), DateAndTime | LdateAndTime) => Some(value),
        (LiteralValue::Real(value), Real) if matches!(literal.named_type, None | Some(Real)) => {
            Some(i128::from(place_of_single(value as f32)))
        }
        (LiteralValue::Real(value), Lreal) if matches!(literal.named_type, None | Some(Lreal)) => {
            Some(i128::from(place_of_double(value)))
        }
        _ => None,
    }
}

/// The place of a number among all of its type: larger numbers have larger places, that of 0 is 0.
fn place_of_single(value: f32) -> i64 {
    let magnitude = i64::from(value.abs().to_bits());
    if value < 0.0 { -magnitude } else { magnitude }
}

fn place_of_double(value: f64) -> i64 {
    let magnitude = i64::try_from(value.abs().to_bits()).unwrap_or(i64::MAX);
    if value < 0.0 { -magnitude } else { magnitude }
}

/// The real number at a place among those of type `kind`; nothing for types of other numbers.
pub fn real_at(place: i64, kind: ElementaryType) -> Option<f64> {
    let value = match kind {
        ElementaryType::Real => f64::from(f32::from_bits(u32::try_from(place.unsigned_abs()).ok()?)),
        ElementaryType::Lreal => f64::from_bits(place.unsigned_abs()),
        _ => return None,
    };
    Some(if place < 0 { -value } else { value })
}

/// Whether variables of this type may be no number at all (IEC 60559).
pub(super) fn is_real(kind: ElementaryType) -> bool {
    matches!(kind, ElementaryType::Real | ElementaryType::Lreal)
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

/// The numbers that a word can be, as far as anything is known of them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Numbers {
    /// The least.
    pub least: Option<i128>,
    /// The greatest.
    pub greatest: Option<i128>,
    /// How far one is from the next.
    pub step: i128,
}

impl Numbers {
    /// Those of a word by its name: those of the type where that is known, of 16 or 32 bits with a sign on the FX
    /// family, and a whole number itself. With `is_narrow` only those that every PLC can make of it: a subrange, whole
    /// milliseconds, no infinite number.
    pub(super) fn of(word: &Moment, formulas: &Formulas, is_narrow: bool) -> Numbers {
        let wide = word.name.strip_prefix(super::WIDE);
        let key = wide.unwrap_or(&word.name);
        match formulas.kind_of(key) {
            Some(kind) => Numbers::of_kind(kind, is_narrow),
            // Names of IEC 61131-3 have small letters.
            None if key.starts_with(|c: char| c.is_ascii_uppercase()) => {
                Numbers::of_group(key, wide.is_some()).unwrap_or_else(|| Numbers::of_device(wide.is_some()))
            }
            // Of a literal that no type fits, not every PLC makes its number.
            None => match Operand::read(key, Model::Iec) {
                Operand::Literal(Literal { value: LiteralValue::Integer(value), .. }) if is_narrow => {
                    Numbers { least: Some(value), greatest: Some(value), step: 1 }
                }
                _ => Numbers { step: 1, ..Numbers::default() },
            },
        }
    }

    /// Those of a group of relays with fewer bits than the word that is made of it.
    fn of_group(key: &str, wide: bool) -> Option<Numbers> {
        let Operand::Nibbles { digits, index: None, .. } = Operand::read(key, Model::Fx3u) else {
            return None;
        };
        let whole = if wide { 8 } else { 4 };
        let greatest = (1 << (4 * u32::from(digits))) - 1;
        (digits < whole).then_some(Numbers { least: Some(0), greatest: Some(greatest), step: 1 })
    }

    fn of_device(wide: bool) -> Numbers {
        let kind = if wide { ElementaryType::Dint } else { ElementaryType::Int };
        Numbers::of_kind(Kind { elementary: kind, limits: None }, false)
    }

    fn of_kind(kind: Kind, is_narrow: bool) -> Numbers {
        let Kind { elementary, limits } = kind;
        let (least, greatest) = match elementary {
            ElementaryType::Real => real_ends(place_of_single(f32::INFINITY), is_narrow),
            ElementaryType::Lreal => real_ends(place_of_double(f64::INFINITY), is_narrow),
            _ => integers(elementary).map(|all| (*all.start(), *all.end())).unzip(),
        };
        let is_time = matches!(elementary, ElementaryType::Time | ElementaryType::Ltime);
        let step = if is_time && is_narrow { NANOSECONDS } else { 1 };
        match limits.filter(|_| is_narrow) {
            Some((low, high)) => Numbers {
                least: Some(least.map_or(low, |least| least.max(low))),
                greatest: Some(greatest.map_or(high, |greatest| greatest.min(high))),
                step,
            },
            None => Numbers { least, greatest, step },
        }
    }
}

/// The ends of the real numbers, where `infinite` is the place of the infinite one.
fn real_ends(infinite: i64, is_narrow: bool) -> (Option<i128>, Option<i128>) {
    let end = i128::from(infinite) - i128::from(is_narrow);
    (Some(-end), Some(end))
}

/// Those of a millisecond.
const NANOSECONDS: i128 = 1_000_000;

/// The numbers that `term` can be, if these have ends.
pub(super) fn range(term: &Term, wide: bool, formulas: &Formulas) -> Numbers {
    match term.operand {
        Operand::Variable | Operand::Direct(_) => match formulas.kind_of(&term.key()) {
            Some(kind) => Numbers::of_kind(kind, false),
            None => Numbers::of_device(wide),
        },
        _ => Numbers::of_device(wide),
    }
}

/// The numbers of an integer type, or of a bit string, which is compared like a number without a sign: IEC 61131-3
/// has its bits compared from the leftmost one on.
fn integers(kind: ElementaryType) -> Option<std::ops::RangeInclusive<i128>> {
    kind.integers().filter(|_| kind != ElementaryType::Bool)
}
