//! What functions and function blocks do while a PLC runs: the code of a row, and what it sees.

use super::{ElementaryType, GenericType};
use crate::target::Fault;
use smol_str::SmolStr;
use std::cmp::Ordering;
use std::ops::RangeInclusive;

/// A value that is computed with.
#[derive(Clone, PartialEq, Debug)]
pub enum Datum {
    /// BOOL and bit strings without a sign, integers, TIME and times of day in nanoseconds, dates in days, dates with
    /// times in nanoseconds since 1970-01-01, characters as their codes.
    Whole(i128),
    /// REAL and LREAL.
    Real(f64),
    /// STRING and WSTRING.
    Text(SmolStr),
}

/// What a function is asked to make a result of.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// In the order of the declaration.
    pub values: &'a [Datum],
    /// The types of the values.
    pub kinds: &'a [ElementaryType],
    /// The type of the result.
    pub result: ElementaryType,
}

/// The code of a function. A whole number that the type of the result does not hold is cut to it by whoever asks, and
/// told as [`Fault::Overflow`].
#[derive(Clone, Copy, Debug)]
pub struct Formula {
    general: fn(&Inputs<'_>) -> Result<Datum, Fault>,
    /// The same for one or two whole numbers of 64 bits, if there is a shorter way for them.
    pub kernel: Option<Kernel>,
}

/// What a function makes of two whole numbers, or of the first one if it has one input: BOOL and bit strings, integers
/// and durations; nothing where 64 bits do not hold the result or something is wrong, which the formula then tells.
pub type Kernel = fn(i64, i64) -> Option<i64>;

impl Formula {
    /// A value as it is.
    pub const COPY: Formula = Formula::new(|inputs| inputs.values.first().cloned().ok_or(Fault::Value(0)))
        .with_kernel(|value, _| Some(value));

    /// By this code for inputs of all types.
    pub const fn new(general: fn(&Inputs<'_>) -> Result<Datum, Fault>) -> Formula {
        Formula { general, kernel: None }
    }

    /// With a shorter way for whole numbers, that leads to the same result or to none.
    pub const fn with_kernel(self, kernel: Kernel) -> Formula {
        Formula { kernel: Some(kernel), ..self }
    }

    /// The result, or what is wrong.
    pub fn apply(&self, inputs: &Inputs<'_>) -> Result<Datum, Fault> {
        (self.general)(inputs)
    }
}

/// The code of a function block: what a call does to the instance.
pub type Working = fn(&mut dyn Instance);

/// An instance of a standard function block that is called: its inputs and outputs by their places, both from 0.
pub trait Instance {
    /// An input of any type but a text; a BOOL as 0 or 1.
    fn input(&self, place: usize) -> i128;

    /// An output as it is.
    fn output(&self, place: usize) -> i128;

    /// Writes an output; what its type does not hold is cut.
    fn set_output(&mut self, place: usize, value: i128);

    /// What the instance noted at the same place, 0 at first. It has [`NOTES`] places.
    fn noted(&self, place: usize) -> i64;

    /// Notes a number for the next calls.
    fn note(&mut self, place: usize, value: i64);

    /// The numbers that an output can hold.
    fn range(&self, place: usize) -> RangeInclusive<i128>;

    /// The time at which the scan began, in nanoseconds.
    fn now_ns(&self) -> i64;
}

/// How many numbers the instance of a block can note, see [`Instance::noted`].
pub const NOTES: usize = 4;

/// Short forms for bits.
impl dyn Instance + '_ {
    /// Whether an input is on.
    pub fn is_on(&self, place: usize) -> bool {
        self.input(place) != 0
    }

    /// Switches an output.
    pub fn switch(&mut self, place: usize, on: bool) {
        self.set_output(place, i128::from(on));
    }

    /// Whether the input has come on since this was asked the last time; `note` is where that is noted.
    pub fn has_risen(&mut self, input: usize, note: usize) -> bool {
        let (is_on, was_on) = (self.is_on(input), self.noted(note) != 0);
        self.note(note, i64::from(is_on));
        is_on && !was_on
    }
}

impl From<bool> for Datum {
    fn from(on: bool) -> Datum {
        Datum::Whole(i128::from(on))
    }
}

impl Datum {
    /// The value that a variable of type `kind` has without an initial value.
    pub fn default_of(kind: ElementaryType) -> Datum {
        use ElementaryType::*;
        match kind {
            Real | Lreal => Datum::Real(0.0),
            String | Wstring => Datum::Text(SmolStr::default()),
            // The standard's second edition begins with the year 1.
            Date => Datum::Whole(DAYS_FROM_YEAR_1),
            DateAndTime => Datum::Whole(DAYS_FROM_YEAR_1 * NS_OF_DAY),
            _ => Datum::Whole(0),
        }
    }

    /// As a whole number; 0 for a text.
    pub fn whole(&self) -> i128 {
        match self {
            Datum::Whole(number) => *number,
            Datum::Real(number) => *number as i128,
            Datum::Text(_) => 0,
        }
    }

    /// As a real number; 0 for a text.
    pub fn real(&self) -> f64 {
        match self {
            Datum::Whole(number) => *number as f64,
            Datum::Real(number) => *number,
            Datum::Text(_) => 0.0,
        }
    }

    /// As a text; empty for a number.
    pub fn text(&self) -> &str {
        match self {
            Datum::Text(text) => text,
            _ => "",
        }
    }

    /// Which of two values of one type is greater; nothing if one of them is no number at all.
    pub fn order(&self, other: &Datum) -> Option<Ordering> {
        match (self, other) {
            (Datum::Whole(left), Datum::Whole(right)) => Some(left.cmp(right)),
            (Datum::Text(left), Datum::Text(right)) => Some(left.cmp(right)),
            (Datum::Text(_), _) | (_, Datum::Text(_)) => None,
            _ => self.real().partial_cmp(&other.real()),
        }
    }

    /// The low bits that a bit string of type `kind` holds, or what is left within a type's range.
    pub fn within(self, kind: ElementaryType) -> Datum {
        self.held(kind).0
    }

    /// The value as a variable of type `kind` holds it, and whether it is the same value: whole numbers keep their low
    /// bits, reals the digits there is room for.
    pub fn held(self, kind: ElementaryType) -> (Datum, bool) {
        match (self, kind) {
            (Datum::Real(number), ElementaryType::Real) => {
                let held = f64::from(number as f32);
                (Datum::Real(held), held.is_finite() || !number.is_finite())
            }
            (Datum::Whole(number), ElementaryType::Bool) => (Datum::from(number & 1 == 1), number >> 1 == 0),
            (Datum::Whole(number), _) => {
                let range = range_of(kind);
                match range.contains(&number) {
                    true => (Datum::Whole(number), true),
                    false => (Datum::Whole(cut(number, range)), false),
                }
            }
            (other, _) => (other, true),
        }
    }
}

/// Nanoseconds of a day.
pub const NS_OF_DAY: i128 = 86_400_000_000_000;
/// Days from 1970-01-01 to 0001-01-01.
const DAYS_FROM_YEAR_1: i128 = -719_162;

/// The whole numbers that a type holds, see [`Datum::Whole`]. A time of day begins again at midnight.
pub fn range_of(kind: ElementaryType) -> RangeInclusive<i128> {
    use ElementaryType::*;
    match kind {
        TimeOfDay | LtimeOfDay => 0..=NS_OF_DAY - 1,
        // As many microseconds as 64 bits hold.
        DateAndTime | LdateAndTime => i64::MIN as i128 * 1000..=i64::MAX as i128 * 1000 + 999,
        Char => 0..=0xFF,
        Wchar => 0..=0xFFFF,
        _ => kind.integers().unwrap_or(i128::from(i64::MIN)..=i128::from(i64::MAX)),
    }
}

fn cut(number: i128, range: RangeInclusive<i128>) -> i128 {
    let count = range.end() - range.start() + 1;
    range.start() + (number - range.start()).rem_euclid(count)
}

impl Inputs<'_> {
    /// The input at a place as a whole number.
    pub fn whole(&self, place: usize) -> i128 {
        self.values.get(place).map_or(0, Datum::whole)
    }

    /// The input at a place as a real number.
    pub fn real(&self, place: usize) -> f64 {
        self.values.get(place).map_or(0.0, Datum::real)
    }

    /// The input at a place as a text.
    pub fn text(&self, place: usize) -> &str {
        self.values.get(place).map_or("", Datum::text)
    }

    /// The type of the input at a place.
    pub fn kind(&self, place: usize) -> ElementaryType {
        self.kinds.get(place).copied().unwrap_or(self.result)
    }

    /// Whether one of the inputs is a REAL or LREAL.
    pub fn has_real(&self) -> bool {
        self.kinds.iter().any(|kind| kind.belongs_to(GenericType::AnyReal))
    }
}
