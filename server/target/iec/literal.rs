//! Literals: numbers, times, dates, texts.

use super::ElementaryType;

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
