//! Names of what can be watched and set, and their values.

use super::code::Code;
use super::machine::Machine;
use super::row::Cell;
use super::session::Touch;
use super::{Lanes, Slot};
use crate::target::{Device, DeviceKind, Operand};
use crate::text::Message;
use serde_json::Value as Json;
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
}

/// What a variable has.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// On or off.
    Bit(bool),
    /// A signed number.
    Number(i64),
}

impl Code {
    /// The variable that a person calls `name`, letter case aside.
    ///
    /// `T0` is the current value of the timer, `TS0` its contact, `TC0` its coil, and so with counters (`CN0`, `CS0`,
    /// `CC0`), as in the maker's tools. `D0:32` is a pair of registers.
    pub fn variable(&self, name: &str) -> Option<Variable> {
        let name = name.trim();
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

    /// What the program uses, as names for [`Code::variable`]: relays, contacts of timers and counters, registers.
    pub fn named(&self) -> Vec<String> {
        let name = |device: &Device| match device.kind.has_preset() {
            true => format!("{}S{}", device.kind.letter(), device.number),
            false => device.to_string(),
        };
        self.devices.iter().map(name).collect()
    }

    fn device(&self, name: &str) -> Option<Device> {
        match Operand::read(name, self.target.model) {
            Operand::Device(device) if self.layout.has(device) => Some(device),
            _ => None,
        }
    }
}

impl Variable {
    /// What setting it to `value` does; nothing if that is no value of it.
    pub fn set(self, code: &Code, value: &Value) -> Option<Touch> {
        match (self, value) {
            (Variable::Relay(cell), _) => {
                let device = code.layout.device_of_cell(cell).filter(|_| !self.is_coil(code));
                device.zip(value.as_bit()).map(|(_, on)| Touch::Write(self, Value::Bit(on)))
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
            Variable::Relay(_) => None,
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
    pub fn release(self, code: &Code) -> Option<Touch> {
        let device = match self {
            Variable::Relay(cell) => code.layout.device_of_cell(cell),
            Variable::Word(slot) | Variable::Pair(slot, _) => code.layout.device_of_slot(slot),
        };
        device.map(|_| Touch::LetGo(self))
    }
}

/// Whether two of these, one behind the other, are a number of 32 bits.
fn has_pairs(kind: DeviceKind) -> bool {
    matches!(kind, DeviceKind::D | DeviceKind::R)
}

impl Value {
    /// A value as people write it: `1`, `on`, `TRUE`, `-5`, `H1F`, `16#1F`.
    pub fn read(word: &str) -> Option<Value> {
        let word = word.trim();
        match word.to_ascii_lowercase().as_str() {
            "on" | "true" => return Some(Value::Bit(true)),
            "off" | "false" => return Some(Value::Bit(false)),
            _ => {}
        }
        let upper = word.to_ascii_uppercase();
        let hexadecimal = upper.strip_prefix('H').or_else(|| upper.strip_prefix("16#"));
        if let Some(digits) = hexadecimal {
            // A pattern of 16 bits is a signed number, as everywhere on these PLCs.
            let bits = u32::from_str_radix(digits, 16).ok()?;
            let number = u16::try_from(bits).map_or(i64::from(bits as i32), |word| i64::from(word as i16));
            return Some(Value::Number(number));
        }
        upper.strip_prefix('K').unwrap_or(&upper).parse().ok().map(Value::Number)
    }

    /// As programs that read results want it.
    pub fn json(&self) -> Json {
        match self {
            Value::Bit(on) => Json::Bool(*on),
            Value::Number(number) => Json::from(*number),
        }
    }

    /// As a bit: 0 is off, 1 is on.
    pub fn as_bit(&self) -> Option<bool> {
        match self {
            Value::Bit(on) => Some(*on),
            Value::Number(0) => Some(false),
            Value::Number(1) => Some(true),
            Value::Number(_) => None,
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Bit(on) => f.write_str(if *on { "1" } else { "0" }),
            Value::Number(number) => number.fmt(f),
        }
    }
}

impl<L: Lanes> Machine<L> {
    /// The value of a variable in a scenario: of an output what is at its terminal.
    pub fn value(&self, variable: Variable, lane: usize) -> Value {
        match variable {
            Variable::Relay(cell) => Value::Bit(self.relay(cell).lane(lane)),
            Variable::Word(slot) => Value::Number(self.memory().word(slot, lane)),
            Variable::Pair(lower, upper) => {
                let (lower, upper) = (self.memory().word(lower, lane), self.memory().word(upper, lane));
                Value::Number(i64::from((upper as i32) << 16 | i32::from(lower as u16)))
            }
        }
    }
}
