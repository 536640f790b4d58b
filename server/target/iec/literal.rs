//! Literals: numbers, times, dates, texts (IEC 61131-3 2nd ed. 2.2, 3rd ed. 6.3).

use super::{ElementaryType, GenericType, is_identifier};
use crate::text::folded;
use smol_str::{SmolStr, format_smolstr};

mod number;
mod spelling;
pub use spelling::{characters_of, real_spelled, shortest, spelled};
mod text;
mod time;

/// A literal as written: the type it names, if any, and its value.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Literal {
    /// `INT` in `INT#5`; times, dates, `TRUE` and texts have theirs by their form.
    pub named_type: Option<ElementaryType>,
    /// The value.
    pub value: LiteralValue,
}

/// The value of a literal. Texts stay in the source.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum LiteralValue {
    /// `TRUE`, `FALSE`, `BOOL#1`.
    Bool(bool),
    /// `12`, `-12`, `16#FF`.
    Integer(i128),
    /// `1.5E-3`.
    Real(f64),
    /// `T#1h30m`, in nanoseconds.
    Time(i64),
    /// `D#2024-01-31`, in days since 1970-01-01.
    Date(i32),
    /// `TOD#23:59:59.999`, in nanoseconds since midnight.
    TimeOfDay(i64),
    /// `DT#2024-01-31-12:00:00`, in nanoseconds since 1970-01-01; 64 bits would not reach the year 1.
    DateAndTime(i128),
    /// `'single byte'`.
    Text,
    /// `"double byte"`.
    WideText,
    /// `Colour#Red`, a value of an enumerated type.
    Enumerated,
}

/// Why a literal cannot be read.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum LiteralProblem {
    /// A digit that the base does not have.
    Digit,
    /// A base other than 2, 8, 16.
    Base,
    /// `__` or `_` at an end.
    Underscore,
    /// A real without a digit on both sides of the point.
    RealForm,
    /// A sign where the form has none: `-16#FF`, `WORD#-1`.
    Sign,
    /// Units of a duration not in descending order, unknown, or a fraction before the last.
    DurationForm,
    /// A lower unit of a duration past its limit, as in `T#1h90m`.
    DurationOverflow,
    /// A date or a time of day not written as `2024-01-31`, `12:00:00`, `2024-01-31-12:00:00`.
    DateForm,
    /// No such day or time of day.
    NoSuchDate,
    /// A type name before `#` that does not exist or does not fit the value.
    Type,
    /// A number that the named type cannot hold.
    Range,
    /// No literal at all: a bare name, a lone sign, nothing.
    Form,
    /// A text that does not end on its line, or an unknown `$` sequence.
    Text,
}

impl Literal {
    /// Reads one word, letter case aside. Names without `#` other than TRUE and FALSE are no literals.
    ///
    /// Durations and dates are exact; digits below a nanosecond are dropped.
    ///
    /// ```
    /// use rungwise::target::iec::{Literal, LiteralProblem, LiteralValue};
    /// assert_eq!(Literal::read("t#1.5s").map(|l| l.value), Ok(LiteralValue::Time(1_500_000_000)));
    /// assert_eq!(Literal::read("T#1h90m"), Err(LiteralProblem::DurationOverflow));
    /// ```
    pub fn read(word: &str) -> Result<Literal, LiteralProblem> {
        let Some(first) = word.chars().next() else { return Err(LiteralProblem::Form) };
        match first {
            '\'' => text::single(word).map(|()| Literal::of(ElementaryType::String, LiteralValue::Text)),
            '"' => text::double(word).map(|()| Literal::of(ElementaryType::Wstring, LiteralValue::WideText)),
            '0'..='9' | '+' | '-' | '.' => Ok(Literal { named_type: None, value: number::read(word)? }),
            _ => match word.split_once('#') {
                Some((prefix, rest)) => Literal::typed(prefix, rest),
                None if word.eq_ignore_ascii_case("TRUE") => {
                    Ok(Literal::of(ElementaryType::Bool, LiteralValue::Bool(true)))
                }
                None if word.eq_ignore_ascii_case("FALSE") => {
                    Ok(Literal::of(ElementaryType::Bool, LiteralValue::Bool(false)))
                }
                None => Err(LiteralProblem::Form),
            },
        }
    }

    /// One spelling of what was read from `word`, the same for all that are the same literal: `T#1s` and `t#1000ms`,
    /// `1.0` and `1.00`, `INT#16#10` and `int#16`.
    pub fn spelled(&self, word: &str) -> SmolStr {
        let named = || self.named_type.map_or_else(String::new, |kind| format!("{}#", folded(kind.name())));
        match self.value {
            LiteralValue::Bool(value) => format_smolstr!("{value}"),
            LiteralValue::Integer(value) => format_smolstr!("{}{value}", named()),
            LiteralValue::Real(value) => format_smolstr!("{}{:?}", named(), value + 0.0),
            LiteralValue::Time(value) | LiteralValue::TimeOfDay(value) => {
                format_smolstr!("{}{value}ns", named())
            }
            LiteralValue::Date(value) => format_smolstr!("{}{value}d", named()),
            LiteralValue::DateAndTime(value) => format_smolstr!("{}{value}ns", named()),
            // Capitals count between quotes.
            LiteralValue::Text | LiteralValue::WideText => word.into(),
            LiteralValue::Enumerated => folded(word),
        }
    }

    fn of(kind: ElementaryType, value: LiteralValue) -> Literal {
        Literal { named_type: Some(kind), value }
    }

    /// `rest` after `prefix#`.
    fn typed(prefix: &str, rest: &str) -> Result<Literal, LiteralProblem> {
        use ElementaryType::*;
        let short = |letters: &str| prefix.eq_ignore_ascii_case(letters);
        let kind = match () {
            () if short("T") => Time,
            () if short("LT") => Ltime,
            () if short("D") => Date,
            () if short("LD") => Ldate,
            () => match ElementaryType::named(prefix) {
                Some(kind) => kind,
                None if is_identifier(prefix) => return enumerated(rest),
                None => return Err(LiteralProblem::Type),
            },
        };
        let value = match kind {
            Time | Ltime => time::duration(rest).map(LiteralValue::Time),
            Date | Ldate => time::date(rest).map(LiteralValue::Date),
            TimeOfDay | LtimeOfDay => time::time_of_day(rest).map(LiteralValue::TimeOfDay),
            DateAndTime | LdateAndTime => time::date_and_time(rest).map(LiteralValue::DateAndTime),
            String | Wstring | Char | Wchar => text::typed(kind, rest),
            _ => typed_number(kind, rest),
        }?;
        Ok(Literal::of(kind, value))
    }

    /// The type that the literal has by itself: the named one, else INT to LINT for integers by their size and
    /// LREAL for reals; nothing for values of enumerated types. Integers and reals without a named type may stand
    /// wherever a type that holds them is expected, see [`Literal::fits`].
    pub fn natural_type(&self) -> Option<ElementaryType> {
        use ElementaryType::*;
        match self.value {
            LiteralValue::Integer(value) => self.named_type.or_else(|| {
                let sizes = [Int, Dint, Lint, Ulint];
                sizes.into_iter().find(|kind| kind.integers().is_some_and(|range| range.contains(&value)))
            }),
            LiteralValue::Real(_) => self.named_type.or(Some(Lreal)),
            _ => self.named_type,
        }
    }

    /// Whether it may stand where a value of type `kind` is expected, in the way of the second edition: a named
    /// type must be that type; 0 and 1 are BOOL too, integers fit every integer and bit string that holds them,
    /// and reals both real types.
    pub fn fits(&self, kind: ElementaryType) -> bool {
        match (self.named_type, self.value) {
            (Some(named), _) => named == kind,
            (None, LiteralValue::Integer(value)) => {
                kind.integers().is_some_and(|range| range.contains(&value))
            }
            (None, LiteralValue::Real(value)) => match kind {
                ElementaryType::Real => (value as f32).is_finite(),
                _ => kind == ElementaryType::Lreal,
            },
            (None, _) => false,
        }
    }
}

/// What stands after the name of an enumerated type.
fn enumerated(rest: &str) -> Result<Literal, LiteralProblem> {
    match is_identifier(rest) {
        true => Ok(Literal { named_type: None, value: LiteralValue::Enumerated }),
        // `FOO#5` is no value of an enumeration: FOO is taken for a type that does not exist.
        false if rest.is_empty() => Err(LiteralProblem::Form),
        false => Err(LiteralProblem::Type),
    }
}

/// `5` of `INT#5`, `TRUE` of `BOOL#TRUE`, `16#FF` of `WORD#16#FF`.
fn typed_number(kind: ElementaryType, rest: &str) -> Result<LiteralValue, LiteralProblem> {
    if rest.eq_ignore_ascii_case("TRUE") || rest.eq_ignore_ascii_case("FALSE") {
        let value = LiteralValue::Bool(rest.eq_ignore_ascii_case("TRUE"));
        return if kind == ElementaryType::Bool { Ok(value) } else { Err(LiteralProblem::Type) };
    }
    let bits = kind.belongs_to(GenericType::AnyBit);
    if bits && rest.starts_with(['+', '-']) {
        return Err(LiteralProblem::Sign);
    }
    if !rest.starts_with(|first: char| first.is_ascii_digit() || "+-._".contains(first)) {
        // A word after the `#` is a value of the wrong type, nothing at all is half a literal.
        return Err(if rest.is_empty() { LiteralProblem::Form } else { LiteralProblem::Type });
    }
    let value = number::read(rest)?;
    match (value, kind.integers()) {
        (LiteralValue::Integer(value), Some(range)) if !range.contains(&value) => Err(LiteralProblem::Range),
        (LiteralValue::Integer(value), Some(_)) if kind == ElementaryType::Bool => {
            Ok(LiteralValue::Bool(value == 1))
        }
        (LiteralValue::Integer(_), Some(_)) => Ok(value),
        (LiteralValue::Integer(_), None) => Err(LiteralProblem::RealForm),
        (LiteralValue::Real(real), None) => {
            match kind == ElementaryType::Real && !(real as f32).is_finite() {
                true => Err(LiteralProblem::Range),
                false => Ok(value),
            }
        }
        _ => Err(LiteralProblem::Type),
    }
}
