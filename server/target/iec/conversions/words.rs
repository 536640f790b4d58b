//! What the pages of conversions say and show.

use super::Conversion::{self, *};
use crate::target::iec::{ElementaryType, GenericType};

/// The paragraph of the page.
pub fn about(conversion: Conversion) -> String {
    let what = "The current result is the input, and the result takes its place.";
    match conversion {
        Value(from, to) => format!("Converts {} to {}. {what} {}", noun(from), noun(to), trap(from, to)),
        ToValue(to) => format!(
            "Converts a value of any elementary type to {}, as the function that names both types would, such as \
             `{}_TO_{to}`. {what} A form of the third edition; a reader sees the type of the input only at its \
             declaration.",
            noun(to),
            if to == ElementaryType::Int { ElementaryType::Real } else { ElementaryType::Int },
        ),
        Truncate(_, to) | ToTruncated(to) => format!("{} {what} {}", truncates(&noun(to)), range(to)),
        AnyTruncate => format!(
            "{} {what} The result takes the integer type of the variable that it is stored to. The third edition \
             prefers the forms that name the type, such as `TRUNC_INT`.",
            truncates("an integer"),
        ),
        FromBcd(from, to) if digits_fit(from, to) => format!("{} {what}", from_bcd(&noun(from), to)),
        FromBcd(from, to) => format!("{} {what} {}", from_bcd(&noun(from), to), range(to)),
        FromAnyBcd(to) => format!("{} {what} {}", from_bcd("a bit string", to), range(to)),
        ToBcd(from, to) => format!("{} {what}", to_bcd(&noun(from), to)),
        AnyToBcd(to) => format!("{} {what}", to_bcd("an integer", to)),
        ToAnyBcd(from) => format!(
            "Writes {} as decimal digits, four bits each, into the bit string that the result is stored to: 12 \
             gives 16#12. {what} A negative number, or one with more digits than there is room for, is an error.",
            noun(from),
        ),
    }
}

/// A type with its article, as code: `an INT`.
fn noun(kind: ElementaryType) -> String {
    // A leading L is spelled as a letter, `an LREAL`; of the others only INT starts with a vowel's sound.
    let vowel = matches!(kind, ElementaryType::Int) || matches!(kind.name().as_bytes().first(), Some(b'L'));
    format!("{} {kind}", if vowel { "an" } else { "a" })
}

fn truncates(to: &str) -> String {
    format!(
        "Converts a real number to {to} by cutting off what follows the point, towards zero: 1.9 gives 1 and -1.9 \
         gives -1. A conversion with `_TO_` would round instead."
    )
}

fn from_bcd(from: &str, to: ElementaryType) -> String {
    format!(
        "Reads {from} as decimal digits, four bits each, and gives the number as {}: 16#12 gives 12. Thumbwheel \
         switches deliver such digits. A group of four bits above 9 is an error.",
        noun(to)
    )
}

fn to_bcd(from: &str, to: ElementaryType) -> String {
    let digits = to.bits().unwrap_or(0) / 4;
    format!(
        "Writes {from} as decimal digits, four bits each, into {}: 12 gives 16#12. Seven-segment displays take such \
         digits. A negative number, or one of more than {digits} digits, is an error.",
        noun(to)
    )
}

/// Whether `number` holds as many nines as there is room for in `digits`.
fn digits_fit(digits: ElementaryType, number: ElementaryType) -> bool {
    let largest = 10i128.pow(digits.bits().unwrap_or(0) / 4) - 1;
    number.integers().is_some_and(|range| range.contains(&largest))
}

/// What to mind when `from` becomes `to`.
fn trap(from: ElementaryType, to: ElementaryType) -> String {
    let is = |kind: ElementaryType, group| kind.belongs_to(group);
    let text = |kind| is(kind, GenericType::AnyString);
    match () {
        () if text(from) && text(to) => {
            "A character that the other kind of text does not have becomes what the maker chose, or an error."
                .to_string()
        }
        () if text(to) && is(from, GenericType::AnyChar) => "The text has this one character.".to_string(),
        () if text(from) && is(to, GenericType::AnyChar) => {
            "The first character of the text is taken; an empty text is an error.".to_string()
        }
        () if text(to) => format!(
            "The text is written in the way of a literal; the standard leaves the number of digits and the prefix \
             to the maker, so test what your controller writes for `{}`.",
            sample(from)
        ),
        () if text(from) => format!(
            "The text must read as a literal of the type, such as `{}`; any other text is an error, on some \
             controllers 0.",
            sample(to)
        ),
        () if is(from, GenericType::AnyChar) || is(to, GenericType::AnyChar) => match from.bits() > to.bits()
        {
            true => {
                "The code of the character is kept; one too large for the result is an error.".to_string()
            }
            false => "The code of the character is kept.".to_string(),
        },
        () if is_time(from) && is_time(to) => between_times(from, to),
        () if is_time(from) || is_time(to) => time_and_number(from, to),
        () if is(from, GenericType::AnyReal) && is(to, GenericType::AnyInt) => format!(
            "The number is rounded to the nearest integer; halves go to the even one by the standard (2.5 gives 2, \
             3.5 gives 4), away from zero on some controllers (2.5 gives 3). `{from}_TRUNC_{to}` cuts off instead. {}",
            range(to)
        ),
        () if is(to, GenericType::AnyReal) && is(from, GenericType::AnyNum) => to_real(from, to),
        () if is(from, GenericType::AnyInt) && is(to, GenericType::AnyInt) => integers(from, to),
        () => bits(from, to),
    }
}

fn is_time(kind: ElementaryType) -> bool {
    kind.belongs_to(GenericType::AnyDuration) || kind.belongs_to(GenericType::AnyDate)
}

fn between_times(from: ElementaryType, to: ElementaryType) -> String {
    use ElementaryType::*;
    match (from, to) {
        (DateAndTime | LdateAndTime, Date | Ldate) => {
            "The day is kept and the time of day dropped.".to_string()
        }
        (DateAndTime | LdateAndTime, TimeOfDay | LtimeOfDay) => {
            "The time of day is kept and the day dropped.".to_string()
        }
        (Date, _) => "The day stays the same; the third edition does this by itself.".to_string(),
        (Time | TimeOfDay | DateAndTime, _) => {
            "The value stays the same, counted in nanoseconds; the third edition does this by itself."
                .to_string()
        }
        _ => format!(
            "Digits finer than the {to} of the controller are lost, and a value past its range is an error."
        ),
    }
}

fn time_and_number(from: ElementaryType, to: ElementaryType) -> String {
    let (time, number) = if is_time(from) { (from, to) } else { (to, from) };
    if number == ElementaryType::Bool {
        let zero =
            if time.belongs_to(GenericType::AnyDuration) { "a duration of zero" } else { "the first moment" };
        return format!("FALSE stands for {zero}; what TRUE stands for is up to the maker.");
    }
    if time.belongs_to(GenericType::AnyDuration) {
        return "The standard does not give the unit of the number: most controllers count milliseconds, some whole \
                seconds. Multiplying or dividing a time by a number is the same everywhere."
            .to_string();
    }
    if matches!(time, ElementaryType::TimeOfDay | ElementaryType::LtimeOfDay) {
        return "The number counts from midnight; the standard does not give its unit, which most makers take as \
                milliseconds."
            .to_string();
    }
    format!(
        "The standard gives neither the unit of the number nor the day from which a {time} counts; both are the \
             maker's."
    )
}

fn to_real(from: ElementaryType, to: ElementaryType) -> String {
    let digits = if to == ElementaryType::Real { 7 } else { 15 };
    match (from, from.widens_to(to)) {
        (ElementaryType::Lreal, _) => {
            format!("About {digits} digits remain, and a number past 3.4E+38 is an error.")
        }
        (_, true) => "Every value is kept exactly; the third edition does this by itself.".to_string(),
        (_, false) => format!(
            "Numbers of more than {digits} digits lose the last ones: check a counter that grows large."
        ),
    }
}

fn integers(from: ElementaryType, to: ElementaryType) -> String {
    match from.widens_to(to) {
        true => "Every value fits; the third edition does this by itself.".to_string(),
        false => range(to),
    }
}

/// What becomes of numbers that `to` does not hold.
fn range(to: ElementaryType) -> String {
    match to.integers() {
        Some(range) => format!(
            "A number outside {} to {} is an error; controllers without a check keep the low {} bits.",
            range.start(),
            range.end(),
            to.bits().unwrap_or(0)
        ),
        None => String::new(),
    }
}

/// Bit strings on either side, numbers perhaps on the other.
fn bits(from: ElementaryType, to: ElementaryType) -> String {
    use ElementaryType::*;
    match (from, to) {
        (Bool, _) => "FALSE gives 0 and TRUE gives 1.".to_string(),
        (Real | Lreal, Bool) => "0.0 gives FALSE; what other numbers give is up to the maker, so a comparison with \
                                 `NE` says it better."
            .to_string(),
        (_, Bool) => "0 gives FALSE. By the standard the lowest bit counts, on many controllers every value but 0 \
                      gives TRUE: a comparison with `NE` says what is meant."
            .to_string(),
        (Dword, Real) | (Real, Dword) | (Lword, Lreal) | (Lreal, Lword) => {
            "By the third edition the pattern of bits is kept, as a number is stored in memory; older controllers \
             convert the number instead, so that 1.0 and 16#1 correspond."
                .to_string()
        }
        (_, Real | Lreal) => {
            let digits = if to == Real { 7 } else { 15 };
            match from.bits() > Some(if to == Real { 16 } else { 32 }) {
                true => format!("The bits count as an unsigned number, of which about {digits} digits remain."),
                false => "The bits count as an unsigned number.".to_string(),
            }
        }
        (Real | Lreal, _) => "The number is rounded to the nearest integer, which must fit as an unsigned one; \
                              anything else is an error."
            .to_string(),
        _ if from.bits() < to.bits() && from.belongs_to(GenericType::AnySigned) => {
            "The bits are kept; controllers differ in whether a negative number fills the upper ones with 0 or 1."
                .to_string()
        }
        _ if from.bits() < to.bits() => "The bits are kept, and zeros fill the upper ones.".to_string(),
        _ if from.bits() > to.bits() => {
            format!("The low {} bits are kept and the others dropped.", to.bits().unwrap_or(0))
        }
        _ => "All bits are kept as they are, so an integer with its highest bit set is negative if it has a sign."
            .to_string(),
    }
}

/// The type of the example's input.
pub fn example_input(conversion: Conversion) -> ElementaryType {
    match conversion {
        Value(from, _) | Truncate(from, _) | FromBcd(from, _) | ToBcd(from, _) | ToAnyBcd(from) => from,
        ToValue(ElementaryType::Int) | ToTruncated(_) | AnyTruncate => ElementaryType::Real,
        ToValue(_) => ElementaryType::Int,
        FromAnyBcd(_) => ElementaryType::Byte,
        AnyToBcd(_) => ElementaryType::Uint,
    }
}

/// The type of the example's result.
pub fn example_result(conversion: Conversion) -> ElementaryType {
    match conversion {
        Value(_, to) | ToValue(to) | Truncate(_, to) | ToTruncated(to) => to,
        FromBcd(_, to) | FromAnyBcd(to) | ToBcd(_, to) | AnyToBcd(to) => to,
        AnyTruncate => ElementaryType::Dint,
        ToAnyBcd(_) => ElementaryType::Word,
    }
}

/// The initial value of the example's input: for texts one that reads as the result's type.
pub fn example_value(conversion: Conversion, input: ElementaryType) -> String {
    let result = example_result(conversion);
    match (conversion, input) {
        (FromBcd(..) | FromAnyBcd(_), _) => "16#12".to_string(),
        (ToValue(_), ElementaryType::Int) => "1".to_string(),
        (Value(_, to), ElementaryType::String) if !to.belongs_to(GenericType::AnyChars) => {
            format!("'{}'", sample(result))
        }
        (Value(_, to), ElementaryType::Wstring) if !to.belongs_to(GenericType::AnyChars) => {
            format!("\"{}\"", sample(result))
        }
        _ => sample(input).to_string(),
    }
}

/// A literal of the type.
fn sample(kind: ElementaryType) -> &'static str {
    use ElementaryType::*;
    match kind {
        Bool => "TRUE",
        Byte | Word | Dword | Lword => "16#12",
        Sint | Int | Dint | Lint | Usint | Uint | Udint | Ulint => "12",
        Real | Lreal => "1.5",
        Time => "T#1.5s",
        Date => "D#2024-01-31",
        TimeOfDay => "TOD#12:30:00",
        DateAndTime => "DT#2024-01-31-12:30:00",
        String => "'A'",
        Wstring => "\"A\"",
        Ltime => "LT#1.5s",
        Ldate => "LD#2024-01-31",
        LtimeOfDay => "LTOD#12:30:00",
        LdateAndTime => "LDT#2024-01-31-12:30:00",
        Char => "'A'",
        Wchar => "\"A\"",
    }
}
