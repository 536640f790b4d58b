//! Names of what can be watched and set, and their values.

use super::code::Code;
use super::machine::Machine;
use super::row::Cell;
use super::session::Touch;
use super::{Lanes, Lies, Scope, Slot, Spot, iec};
use crate::target::iec::{Datum, ElementaryType, Literal, LiteralValue, characters_of, spelled};
use crate::target::{Device, DeviceKind, Model, Operand};
use crate::text::Message;
use serde_json::Value as Json;
use smol_str::SmolStr;
use std::fmt;
use std::ops::RangeInclusive;

/// Something with a value that a person can watch and set.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Variable {
    /// A relay, or the contact or the coil of a timer or counter.
    Relay(Cell),
    /// A register, or the current value of a timer or counter.
    Word(Slot),
    /// A register and the one behind it.
    Pair(Slot, Slot),
    /// A variable of IEC 61131-3 that is no BOOL.
    Typed(Spot),
    /// A variable of an enumerated type, with the number of the type.
    Enumerated(Spot, u32),
}

/// What a variable has.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// On or off.
    Bit(bool),
    /// A number, signed as its type says.
    Number(i64),
    /// A number beyond those of 64 bits with a sign.
    Unsigned(u64),
    /// A real number.
    Real(f64),
    /// A duration, in nanoseconds.
    Time(i64),
    /// A text, and a value of an enumerated type by its name.
    Text(SmolStr),
    /// A date or a character as a literal.
    Name(SmolStr),
}

impl Code {
    /// The variable that a person calls `name`, letter case aside.
    ///
    /// `T0` is the current value of the timer, `TS0` its contact, `TC0` its coil, and so with counters (`CN0`, `CS0`,
    /// `CC0`), as in the maker's tools. `D0:32` is a pair of registers.
    ///
    /// In IEC 61131-3 it is `Motor.Timer.ET`, `Resource.Main.Levels[3]` or `%IX0.0`; what stands around a name may be
    /// left out where only one variable is called so.
    pub fn variable(&self, name: &str) -> Option<Variable> {
        let name = name.trim();
        if !self.target.is_fx() {
            return self.iec.find(name).map(|leaf| match (leaf.spot.lies, leaf.enumeration) {
                (_, Some(enumeration)) => Variable::Enumerated(leaf.spot, enumeration),
                (Lies::Cell(cell), None) => Variable::Relay(cell),
                _ => Variable::Typed(leaf.spot),
            });
        }
        if let Some(register) = name.strip_suffix(":32") {
            let device = self.device(register).filter(|device| has_pairs(device.kind))?;
            let behind = Device::new(device.kind, device.number + 1);
            let is_pair = device.is_special() == behind.is_special();
            let pair = Variable::Pair(self.layout.slot(device)?, self.layout.slot(behind)?);
            return is_pair.then_some(pair);
        }
        if let Some(device) = self.device(name) {
            let word = self.layout.slot(device).map(Variable::Word);
            return word.or_else(|| self.layout.cell(device).map(Variable::Relay));
        }
        let mut letters = name.chars();
        let kind = DeviceKind::of_letter(letters.next()?).filter(|kind| kind.has_preset())?;
        let part = letters.next()?.to_ascii_uppercase();
        let device = self.device(&format!("{}{}", kind.letter(), letters.as_str()))?;
        match part {
            'S' => self.layout.cell(device).map(Variable::Relay),
            'C' => self.layout.coil(device).map(Variable::Relay),
            'N' => self.layout.slot(device).map(Variable::Word),
            _ => None,
        }
    }

    /// What the program uses, as names for [`Code::variable`]: relays, contacts of timers and counters, registers; the
    /// variables of an IEC 61131-3 program that are worth watching.
    pub fn named(&self) -> Vec<String> {
        let name = |device: &Device| match device.kind.has_preset() {
            true => format!("{}S{}", device.kind.letter(), device.number),
            false => device.to_string(),
        };
        if !self.target.is_fx() {
            return self.iec.watched();
        }
        self.devices.iter().map(name).collect()
    }

    /// The variables of an IEC 61131-3 program by the units that declare them; for an FX nothing.
    pub fn scopes(&self) -> Vec<Scope> {
        self.iec.scopes()
    }

    /// The program, the instance of a function block or the function of IEC 61131-3 to which an instruction belongs, as
    /// a name for [`Code::variable`] begins.
    pub fn owner(&self, instruction: u32) -> Option<String> {
        self.iec.owner(instruction)
    }

    fn device(&self, name: &str) -> Option<Device> {
        match Operand::read(name, self.target.model) {
            Operand::Device(device) if self.layout.has(device) => Some(device),
            _ => None,
        }
    }
}

impl Variable {
    /// Its type, if it is declared with one.
    pub fn declared(self) -> Option<ElementaryType> {
        match self {
            Variable::Typed(spot) => Some(spot.kind),
            _ => None,
        }
    }

    /// What setting it to `value` does; nothing if that is no value of it.
    pub fn set(self, code: &Code, value: &Value) -> Option<Touch> {
        match (self, value) {
            (Variable::Relay(_), _) => {
                let is_free = !self.is_coil(code);
                value.as_bit().filter(|_| is_free).map(|on| Touch::Write(self, Value::Bit(on)))
            }
            (Variable::Typed(_) | Variable::Enumerated(..), _) => {
                self.datum(code, value).map(|_| Touch::Write(self, value.clone()))
            }
            (_, Value::Number(number)) if self.range(code)?.contains(number) => {
                Some(Touch::Write(self, value.clone()))
            }
            _ => None,
        }
    }

    /// The numbers that it takes; nothing for a relay.
    pub fn range(self, code: &Code) -> Option<RangeInclusive<i64>> {
        let narrow = i64::from(i16::MIN)..=i64::from(i16::MAX);
        let wide = i64::from(i32::MIN)..=i64::from(i32::MAX);
        match self {
            Variable::Relay(_) | Variable::Enumerated(..) => None,
            Variable::Typed(spot) => {
                let range = spot.kind.integers()?;
                let bound = |bound: i128| i64::try_from(bound).unwrap_or(i64::MAX);
                Some(bound(*range.start())..=bound(*range.end()))
            }
            Variable::Word(slot) => {
                let device = code.layout.device_of_slot(slot)?;
                Some(if code.layout.is_wide(device) { wide } else { narrow })
            }
            Variable::Pair(..) => Some(wide),
        }
    }

    /// Why it, which people call `name`, cannot be set to `value`.
    pub fn refusal(self, code: &Code, name: &str, value: &Value) -> Message {
        match (value, self.range(code)) {
            (Value::Number(number), Some(range)) => Message::new("simulate.range")
                .with("name", name)
                .with("value", number)
                .with("least", range.start())
                .with("greatest", range.end()),
            _ if self.is_coil(code) => Message::new("simulate.coil").with("name", name),
            _ => Message::new("cli.run-no-value").with("name", name),
        }
    }

    /// Whether it is the coil of a timer or counter, which only the program drives.
    fn is_coil(self, code: &Code) -> bool {
        let Variable::Relay(cell) = self else { return false };
        let device = code.layout.device_of_cell(cell);
        device.and_then(|device| code.layout.coil(device)) == Some(cell)
    }

    /// What holding it at `value` does; nothing if that is no value of it.
    pub fn force(self, code: &Code, value: &Value) -> Option<Touch> {
        self.set(code, value).map(|_| Touch::Hold(self, value.clone()))
    }

    /// What letting it go does.
    pub fn release(self) -> Touch {
        Touch::LetGo(self)
    }

    /// The value as a variable of IEC 61131-3 takes it; nothing if it is none of its type.
    pub(super) fn datum(self, code: &Code, value: &Value) -> Option<Datum> {
        let kind = match (self, value) {
            (Variable::Enumerated(_, enumeration), Value::Text(name) | Value::Name(name)) => {
                return code.iec.value_named(enumeration, name).map(Datum::Whole);
            }
            (Variable::Enumerated(_, enumeration), Value::Number(number)) => {
                let number = i128::from(*number);
                return code.iec.name_of_value(enumeration, number).map(|_| Datum::Whole(number));
            }
            (Variable::Typed(spot), _) => spot.kind,
            _ => return None,
        };
        value.datum(kind)
    }
}

/// Whether two of these, one behind the other, are a number of 32 bits.
fn has_pairs(kind: DeviceKind) -> bool {
    matches!(kind, DeviceKind::D | DeviceKind::R)
}

impl Value {
    /// What a variable of an elementary type has.
    pub(super) fn of_datum(datum: Datum, kind: ElementaryType) -> Value {
        use ElementaryType::*;
        match (datum, kind) {
            (Datum::Real(number), _) => Value::Real(number),
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

    /// A value as people write it: `1`, `on`, `TRUE`, `-5`, `H1F`, `16#1F`, `1.5`, `T#2s`, `'text'`, `D#2024-01-31`,
    /// `Colour#Red`.
    pub fn read(word: &str) -> Option<Value> {
        let word = word.trim();
        match word.to_ascii_lowercase().as_str() {
            "on" | "true" => return Some(Value::Bit(true)),
            "off" | "false" => return Some(Value::Bit(false)),
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
        if let Ok(number) = upper.strip_prefix('K').unwrap_or(&upper).parse() {
            return Some(Value::Number(number));
        }
        match Operand::read(word, Model::Iec) {
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
            _ => None,
        }
    }

    /// The value in a variable of type `kind`; nothing if that does not hold it. A number alone is milliseconds where a
    /// time is wanted.
    fn datum(&self, kind: ElementaryType) -> Option<Datum> {
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
            Value::Text(text) | Value::Name(text) if matches!(kind, String | Wstring) => {
                Datum::Text(text.clone())
            }
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

    /// As programs that read results want it.
    pub fn json(&self) -> Json {
        match self {
            Value::Bit(on) => Json::Bool(*on),
            Value::Number(number) => Json::from(*number),
            Value::Unsigned(number) => Json::from(*number),
            Value::Real(number) => Json::from(*number),
            // Milliseconds, as a whole number where they are one.
            Value::Time(time) if time % 1_000_000 == 0 => Json::from(time / 1_000_000),
            Value::Time(time) => Json::from(*time as f64 / 1e6),
            Value::Text(text) | Value::Name(text) => Json::from(text.as_str()),
        }
    }

    /// As a bit: 0 is off, 1 is on.
    pub fn as_bit(&self) -> Option<bool> {
        match self {
            Value::Bit(on) => Some(*on),
            Value::Number(0) => Some(false),
            Value::Number(1) => Some(true),
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
            Value::Real(number) => write!(f, "{number:?}"),
            Value::Time(time) => {
                f.write_str(&spelled(&Datum::Whole(i128::from(*time)), ElementaryType::Time))
            }
            Value::Text(text) => write!(f, "'{}'", text.replace('$', "$$").replace('\'', "$'")),
            Value::Name(name) => f.write_str(name),
        }
    }
}

impl<L: Lanes> Machine<L> {
    /// The value of a variable in a scenario: of an output what is at its terminal.
    pub fn value(&self, variable: Variable, lane: usize) -> Value {
        match variable {
            Variable::Relay(cell) => Value::Bit(self.relay(cell).lane(lane)),
            Variable::Word(slot) => Value::Number(self.memory().word(slot, lane)),
            Variable::Typed(spot) => Value::of_datum(self.datum_at(spot, lane), spot.kind),
            Variable::Enumerated(spot, enumeration) => {
                let number = self.datum_at(spot, lane).whole();
                let name = self.code.iec.name_of_value(enumeration, number).cloned();
                name.map_or(Value::Number(number as i64), Value::Text)
            }
            Variable::Pair(lower, upper) => {
                let (lower, upper) = (self.memory().word(lower, lane), self.memory().word(upper, lane));
                Value::Number(i64::from((upper as i32) << 16 | i32::from(lower as u16)))
            }
        }
    }

    /// The value at a place; of an output what is at its terminals.
    fn datum_at(&self, spot: Spot, lane: usize) -> Datum {
        let published = match spot.lies {
            Lies::Bits(first, count) => {
                let bits: Option<Vec<L>> =
                    (first..first + Cell::from(count)).map(|cell| self.terminals.output(cell)).collect();
                bits
            }
            _ => None,
        };
        let pattern = published
            .map(|bits| bits.iter().rev().fold(0, |pattern, bit| pattern << 1 | u64::from(bit.lane(lane))));
        match pattern {
            Some(pattern) => iec::of_pattern(pattern, spot.kind),
            None => iec::read(self.memory(), &self.code.iec, spot, lane).unwrap_or(Datum::Whole(0)),
        }
    }
}
