//! Values as people and programs write them.

use crate::target::iec::{
    Datum, ElementaryType, Literal, LiteralValue, characters_of, is_identifier, real_spelled, shortest,
    spelled,
};
use crate::target::{Model, Operand};
use serde_json::Value as Json;
use smol_str::SmolStr;
use std::fmt;

/// What a variable has.
#[derive(Clone, Debug)]
pub enum Value {
    /// On or off.
    Bit(bool),
    /// A number, signed as its type says.
    Number(i64),
    /// A number beyond those of 64 bits with a sign.
    Unsigned(u64),
    /// A real number; of a REAL the one with the fewest digits that it stands for.
    Real(f64),
    /// A duration, in nanoseconds.
    Time(i64),
    /// A text.
    Text(SmolStr),
    /// A value of an enumerated type by its name, a date or a character as a literal.
    Name(SmolStr),
    /// A word that is this number or bit, unless a variable has a value with such a name: `H1F`, `K5`, `on`. No
    /// variable has it.
    Word(SmolStr, Box<Value>),
}

impl PartialEq for Value {
    /// What is no number is the same as itself, so that it is no news in each scan.
    fn eq(&self, other: &Value) -> bool {
        match (self, other) {
            (Value::Bit(own), Value::Bit(other)) => own == other,
            (Value::Number(own), Value::Number(other)) | (Value::Time(own), Value::Time(other)) => {
                own == other
            }
            (Value::Unsigned(own), Value::Unsigned(other)) => own == other,
            (Value::Real(own), Value::Real(other)) => own == other || own.is_nan() && other.is_nan(),
            (Value::Text(own), Value::Text(other)) | (Value::Name(own), Value::Name(other)) => own == other,
            (Value::Word(own, meant), Value::Word(other, other_meant)) => {
                own == other && meant == other_meant
            }
            _ => false,
        }
    }
}

impl Value {
    /// What a variable of an elementary type has.
    pub(super) fn of_datum(datum: Datum, kind: ElementaryType) -> Value {
        use ElementaryType::*;
        match (datum, kind) {
            (Datum::Real(number), _) => Value::Real(shortest(number, kind)),
            (Datum::Whole(number), Bool) => Value::Bit(number != 0),
            (Datum::Whole(number), Time | Ltime) => Value::Time(number as i64),
            (Datum::Whole(number), _) if kind.integers().is_some() => match i64::try_from(number) {
                Ok(number) => Value::Number(number),
                Err(_) => Value::Unsigned(number as u64),
            },
            (Datum::Text(text), _) => Value::Text(text),
            (datum, _) => Value::Name(spelled(&datum, kind)),
        }
    }

    /// A value as people write it: `1`, `on`, `TRUE`, `-5`, `H1F`, `16#1F`, `1.5`, `Infinity`, `T#2s`, `'text'`,
    /// `D#2024-01-31`, `Colour#Red`, `Red`.
    pub fn read(word: &str) -> Option<Value> {
        let word = word.trim();
        match Value::number(word) {
            Some(meant) if is_identifier(word) => Some(Value::Word(word.into(), Box::new(meant))),
            Some(meant) => Some(meant),
            None => match Operand::read(word, Model::Iec) {
                Operand::Literal(literal) => match literal.value {
                    LiteralValue::Bool(on) => Some(Value::Bit(on)),
                    LiteralValue::Integer(number) => match i64::try_from(number) {
                        Ok(number) => Some(Value::Number(number)),
                        Err(_) => u64::try_from(number).ok().map(Value::Unsigned),
                    },
                    LiteralValue::Real(number) => Some(Value::Real(number)),
                    LiteralValue::Time(time) => Some(Value::Time(time)),
                    LiteralValue::Text | LiteralValue::WideText => characters_of(word).map(Value::Text),
                    _ => Some(Value::Name(word.into())),
                },
                _ => is_identifier(word).then(|| Value::Name(word.into())),
            },
        }
    }

    /// A value that a program hands over: a text is read as people write it.
    pub fn of_json(value: &Json) -> Option<Value> {
        match value {
            Json::Bool(on) => Some(Value::Bit(*on)),
            Json::Number(number) => {
                let whole = number.as_i64().map(Value::Number);
                let unsigned = || number.as_u64().map(Value::Unsigned);
                whole.or_else(unsigned).or_else(|| number.as_f64().map(Value::Real))
            }
            Json::String(word) => Value::read(word),
            _ => None,
        }
    }

    /// A number or a bit in one of the forms that are no literals of IEC 61131-3.
    fn number(word: &str) -> Option<Value> {
        match word.to_ascii_lowercase().as_str() {
            "on" => return Some(Value::Bit(true)),
            "off" => return Some(Value::Bit(false)),
            "infinity" => return Some(Value::Real(f64::INFINITY)),
            "-infinity" => return Some(Value::Real(f64::NEG_INFINITY)),
            "nan" => return Some(Value::Real(f64::NAN)),
            _ => {}
        }
        let upper = word.to_ascii_uppercase();
        if let Some(digits) = upper.strip_prefix('H')
            && let Ok(bits) = u32::from_str_radix(digits, 16)
        {
            // A pattern of 16 bits is a signed number, as everywhere on these PLCs.
            let number = u16::try_from(bits).map_or(i64::from(bits as i32), |word| i64::from(word as i16));
            return Some(Value::Number(number));
        }
        upper.strip_prefix('K').unwrap_or(&upper).parse().ok().map(Value::Number)
    }

    /// The value in a variable of type `kind`; nothing if that does not hold it. A number alone is milliseconds where a
    /// time is wanted.
    pub(super) fn datum(&self, kind: ElementaryType) -> Option<Datum> {
        use ElementaryType::*;
        let is_real = matches!(kind, Real | Lreal);
        let datum = match self {
            Value::Bit(on) => Datum::from(*on),
            Value::Number(number) if is_real => Datum::Real(*number as f64),
            Value::Number(number) if matches!(kind, Time | Ltime) => {
                Datum::Whole(i128::from(*number) * 1_000_000)
            }
            Value::Number(number) => Datum::Whole(i128::from(*number)),
            Value::Unsigned(number) => Datum::Whole(i128::from(*number)),
            Value::Real(number) if is_real => Datum::Real(*number),
            Value::Real(ms) if matches!(kind, Time | Ltime) => Datum::Whole((ms * 1e6).round() as i128),
            Value::Time(time) if matches!(kind, Time | Ltime) => Datum::Whole(i128::from(*time)),
            Value::Text(text) if matches!(kind, String | Wstring) => Datum::Text(text.clone()),
            Value::Word(_, meant) => return meant.datum(kind),
            Value::Text(text) | Value::Name(text) => match Literal::read(text) {
                Ok(literal) => return Datum::of_literal(literal.value, kind),
                Err(_) => return None,
            },
            Value::Real(_) | Value::Time(_) => return None,
        };
        let is_number = kind.integers().is_some() || is_real || matches!(kind, Time | Ltime);
        match &datum {
            Datum::Whole(_) | Datum::Real(_) if !is_number => None,
            Datum::Whole(_) if is_real => None,
            _ => {
                let (held, is_same) = datum.held(kind);
                is_same.then_some(held)
            }
        }
    }

    /// What it means beside a device of the FX family; nothing for a name, for they have no values with names.
    pub fn of_device(&self) -> Option<Value> {
        match self {
            Value::Word(_, meant) => Some((**meant).clone()),
            Value::Name(_) => None,
            value => Some(value.clone()),
        }
    }

    /// As programs that read results want it. JSON has no number for what is infinite or no number at all: that is a
    /// text, `"Infinity"`, `"-Infinity"` or `"NaN"`.
    pub fn json(&self) -> Json {
        match self {
            Value::Bit(on) => Json::Bool(*on),
            Value::Number(number) => Json::from(*number),
            Value::Unsigned(number) => Json::from(*number),
            Value::Real(number) if !number.is_finite() => Json::from(real_spelled(*number).as_str()),
            Value::Real(number) => Json::from(*number),
            // Milliseconds, as a whole number where they are one.
            Value::Time(time) if time % 1_000_000 == 0 => Json::from(time / 1_000_000),
            Value::Time(time) => Json::from(*time as f64 / 1e6),
            Value::Text(text) | Value::Name(text) => Json::from(text.as_str()),
            Value::Word(_, meant) => meant.json(),
        }
    }

    /// As a number; a bit is 0 or 1, a time is milliseconds.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Value::Bit(on) => Some(f64::from(u8::from(*on))),
            Value::Number(number) => Some(*number as f64),
            Value::Unsigned(number) => Some(*number as f64),
            Value::Real(number) => Some(*number),
            Value::Time(time) => Some(*time as f64 / 1e6),
            Value::Text(_) | Value::Name(_) => None,
            Value::Word(_, meant) => meant.as_number(),
        }
    }

    /// As a bit: 0 is off, 1 is on.
    pub fn as_bit(&self) -> Option<bool> {
        match self {
            Value::Bit(on) => Some(*on),
            Value::Number(0) => Some(false),
            Value::Number(1) => Some(true),
            Value::Word(_, meant) => meant.as_bit(),
            _ => None,
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Bit(on) => f.write_str(if *on { "1" } else { "0" }),
            Value::Number(number) => number.fmt(f),
            Value::Unsigned(number) => number.fmt(f),
            Value::Real(number) => f.write_str(&real_spelled(*number)),
            Value::Time(time) => {
                f.write_str(&spelled(&Datum::Whole(i128::from(*time)), ElementaryType::Time))
            }
            Value::Text(text) => {
                f.write_str("'")?;
                text.chars().try_for_each(|character| match character {
                    '$' | '\'' => write!(f, "${character}"),
                    // As a literal has what cannot be seen.
                    _ if character.is_control() => write!(f, "${:02X}", character as u32),
                    _ => write!(f, "{character}"),
                })?;
                f.write_str("'")
            }
            Value::Name(name) | Value::Word(name, _) => f.write_str(name),
        }
    }
}
