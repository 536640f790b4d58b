//! What the pages of conversions say and show.

use super::Conversion::{self, *};
use crate::target::iec::{ElementaryType, GenericType};
use crate::text::{Language, Message};

/// A few words: `INT to REAL`.
pub fn title(conversion: Conversion) -> Message {
    let message = match conversion {
        Value(..) => Message::new("conversion-title.value"),
        ToValue(_) => Message::new("conversion-title.to-value"),
        Truncate(..) => Message::new("conversion-title.truncate"),
        ToTruncated(_) => Message::new("conversion-title.to-truncated"),
        AnyTruncate => Message::new("conversion-title.any-truncate"),
        FromBcd(..) => Message::new("conversion-title.from-bcd"),
        FromAnyBcd(_) => Message::new("conversion-title.from-any-bcd"),
        ToBcd(..) => Message::new("conversion-title.to-bcd"),
        AnyToBcd(_) => Message::new("conversion-title.any-to-bcd"),
        ToAnyBcd(_) => Message::new("conversion-title.to-any-bcd"),
    };
    match conversion {
        Value(from, to) | Truncate(from, to) | FromBcd(from, to) | ToBcd(from, to) => {
            message.with("from", from).with("to", to)
        }
        ToValue(to) | ToTruncated(to) | FromAnyBcd(to) | AnyToBcd(to) => message.with("to", to),
        ToAnyBcd(from) => message.with("from", from),
        AnyTruncate => message,
    }
}

/// The paragraph of the page.
pub fn about(conversion: Conversion, language: Language) -> String {
    let sentences: Vec<String> =
        sentences(conversion).iter().map(|sentence| sentence.render(language)).collect();
    sentences.join(match language {
        Language::English => " ",
        Language::SimplifiedChinese => "",
    })
}

fn sentences(conversion: Conversion) -> Vec<Message> {
    let what = Message::new("conversion.what");
    match conversion {
        Value(from, to) => {
            let converts = with_noun(with_noun(Message::new("conversion.value"), "from", from), "to", to);
            [vec![converts, what], trap(from, to)].concat()
        }
        ToValue(to) => {
            let example = if to == ElementaryType::Int { ElementaryType::Real } else { ElementaryType::Int };
            let converts = with_noun(Message::new("conversion.to-value"), "to", to);
            let converts = converts.with("example", format!("{example}_TO_{to}"));
            vec![converts, what, Message::new("conversion.third-edition")]
        }
        Truncate(_, to) | ToTruncated(to) => {
            let truncates = with_noun(Message::new("conversion.truncates"), "to", to);
            [vec![truncates, what], range(to)].concat()
        }
        AnyTruncate => vec![
            Message::new("conversion.truncates-any"),
            what,
            Message::new("conversion.takes-type-of-variable"),
        ],
        FromBcd(from, to) => {
            let reads = with_noun(with_noun(Message::new("conversion.from-bcd"), "from", from), "to", to);
            let limits = if digits_fit(from, to) { Vec::new() } else { range(to) };
            [vec![reads, what], limits].concat()
        }
        FromAnyBcd(to) => {
            let reads = with_noun(Message::new("conversion.from-any-bcd"), "to", to);
            [vec![reads, what], range(to)].concat()
        }
        ToBcd(from, to) => vec![to_bcd(with_noun(Message::new("conversion.to-bcd"), "from", from), to), what],
        AnyToBcd(to) => vec![to_bcd(Message::new("conversion.any-to-bcd"), to), what],
        ToAnyBcd(from) => vec![
            with_noun(Message::new("conversion.to-any-bcd"), "from", from),
            what,
            Message::new("conversion.no-room-for-digits"),
        ],
    }
}

/// With `{name}` standing for a type, with its article where the language has one: `an INT`.
fn with_noun(message: Message, name: &'static str, kind: ElementaryType) -> Message {
    // A leading L is spelled as a letter, `an LREAL`; of the others only INT starts with a vowel's sound.
    let vowel = matches!(kind, ElementaryType::Int) || matches!(kind.name().as_bytes().first(), Some(b'L'));
    let noun = match vowel {
        true => Message::new("conversion.noun-vowel"),
        false => Message::new("conversion.noun"),
    };
    message.with_messages(name, vec![noun.with("type", kind)])
}

fn to_bcd(message: Message, to: ElementaryType) -> Message {
    let digits = to.bits().unwrap_or(0) / 4;
    with_noun(message, "to", to).with("digits", digits)
}

/// Whether `number` holds as many nines as there is room for in `digits`.
fn digits_fit(digits: ElementaryType, number: ElementaryType) -> bool {
    let largest = 10i128.pow(digits.bits().unwrap_or(0) / 4) - 1;
    number.integers().is_some_and(|range| range.contains(&largest))
}

/// What to mind when `from` becomes `to`.
fn trap(from: ElementaryType, to: ElementaryType) -> Vec<Message> {
    let is = |kind: ElementaryType, group| kind.belongs_to(group);
    let text = |kind| is(kind, GenericType::AnyString);
    let sentence = match () {
        () if text(from) && text(to) => Message::new("conversion.other-texts"),
        () if text(to) && is(from, GenericType::AnyChar) => Message::new("conversion.one-character"),
        () if text(from) && is(to, GenericType::AnyChar) => Message::new("conversion.first-character"),
        () if text(to) => Message::new("conversion.as-literal").with("sample", sample(from)),
        () if text(from) => Message::new("conversion.reads-literal").with("sample", sample(to)),
        () if is(from, GenericType::AnyChar) || is(to, GenericType::AnyChar) => match from.bits() > to.bits()
        {
            true => Message::new("conversion.code-may-not-fit"),
            false => Message::new("conversion.code-kept"),
        },
        () if is_time(from) && is_time(to) => between_times(from, to),
        () if is_time(from) || is_time(to) => time_and_number(from, to),
        () if is(from, GenericType::AnyReal) && is(to, GenericType::AnyInt) => {
            let rounds = Message::new("conversion.rounds").with("truncates", format!("{from}_TRUNC_{to}"));
            return [vec![rounds], range(to)].concat();
        }
        () if is(to, GenericType::AnyReal) && is(from, GenericType::AnyNum) => to_real(from, to),
        () if is(from, GenericType::AnyInt) && is(to, GenericType::AnyInt) => match from.widens_to(to) {
            true => Message::new("conversion.every-value-fits"),
            false => return range(to),
        },
        () => bits(from, to),
    };
    vec![sentence]
}

fn is_time(kind: ElementaryType) -> bool {
    kind.belongs_to(GenericType::AnyDuration) || kind.belongs_to(GenericType::AnyDate)
}

fn between_times(from: ElementaryType, to: ElementaryType) -> Message {
    use ElementaryType::*;
    match (from, to) {
        (DateAndTime | LdateAndTime, Date | Ldate) => Message::new("conversion.day-kept"),
        (DateAndTime | LdateAndTime, TimeOfDay | LtimeOfDay) => Message::new("conversion.time-of-day-kept"),
        (Date, _) => Message::new("conversion.same-day"),
        (Time | TimeOfDay | DateAndTime, _) => Message::new("conversion.nanoseconds"),
        _ => Message::new("conversion.finer-digits-lost").with("to", to),
    }
}

fn time_and_number(from: ElementaryType, to: ElementaryType) -> Message {
    let (time, number) = if is_time(from) { (from, to) } else { (to, from) };
    let is_duration = time.belongs_to(GenericType::AnyDuration);
    match () {
        () if number == ElementaryType::Bool && is_duration => Message::new("conversion.false-duration"),
        () if number == ElementaryType::Bool => Message::new("conversion.false-moment"),
        () if is_duration => Message::new("conversion.unit-of-duration"),
        () if matches!(time, ElementaryType::TimeOfDay | ElementaryType::LtimeOfDay) => {
            Message::new("conversion.from-midnight")
        }
        () => Message::new("conversion.unit-of-date").with("time", time),
    }
}

fn to_real(from: ElementaryType, to: ElementaryType) -> Message {
    let digits = if to == ElementaryType::Real { 7 } else { 15 };
    match (from, from.widens_to(to)) {
        (ElementaryType::Lreal, _) => Message::new("conversion.digits-remain").with("digits", digits),
        (_, true) => Message::new("conversion.kept-exactly"),
        (_, false) => Message::new("conversion.last-digits-lost").with("digits", digits),
    }
}

/// What becomes of numbers that `to` does not hold.
fn range(to: ElementaryType) -> Vec<Message> {
    let message = to.integers().map(|range| {
        Message::new("conversion.range")
            .with("least", range.start())
            .with("greatest", range.end())
            .with("bits", to.bits().unwrap_or(0))
    });
    message.into_iter().collect()
}

/// Bit strings on either side, numbers perhaps on the other.
fn bits(from: ElementaryType, to: ElementaryType) -> Message {
    use ElementaryType::*;
    match (from, to) {
        (Bool, _) => Message::new("conversion.from-bool"),
        (Real | Lreal, Bool) => Message::new("conversion.real-to-bool"),
        (_, Bool) => Message::new("conversion.bits-to-bool"),
        (Dword, Real) | (Real, Dword) | (Lword, Lreal) | (Lreal, Lword) => {
            Message::new("conversion.pattern-kept")
        }
        (_, Real | Lreal) => {
            let digits = if to == Real { 7 } else { 15 };
            match from.bits() > Some(if to == Real { 16 } else { 32 }) {
                true => Message::new("conversion.unsigned-digits").with("digits", digits),
                false => Message::new("conversion.unsigned"),
            }
        }
        (Real | Lreal, _) => Message::new("conversion.real-to-bits"),
        _ if from.bits() < to.bits() && from.belongs_to(GenericType::AnySigned) => {
            Message::new("conversion.sign-filled")
        }
        _ if from.bits() < to.bits() => Message::new("conversion.zero-filled"),
        _ if from.bits() > to.bits() => {
            Message::new("conversion.low-bits").with("bits", to.bits().unwrap_or(0))
        }
        _ => Message::new("conversion.all-bits"),
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
