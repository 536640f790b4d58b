//! Names of what can be read and written in a PLC.

use super::Dialect;
use super::devices::Place;
use crate::link::address::{Extended, Part, Plain};
use crate::simulate::{Names, Value};
use crate::target::{Device, DeviceKind, Operand, Target};
use std::fmt;
use std::ops::RangeInclusive;

/// Something with a value in a PLC.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Point {
    /// A relay, or the contact or the coil of a timer or counter.
    Bit(Device, Part),
    /// A register, or the current value of a timer or counter.
    Word(Device),
    /// A register and the one behind it.
    Pair(Device),
}

impl Point {
    /// The point of this name: `X0`, `D10`, `D0:32`, `T0` (the current value), `TS0` (the contact), `TC0` (the coil),
    /// as in the simulator.
    pub fn named(name: &str, target: &Target) -> Option<Point> {
        let name = name.trim();
        let device = |name: &str| match Operand::read(name, target.model) {
            Operand::Device(device) if device.range_on(target).is_some() => Some(device),
            _ => None,
        };
        if let Some(register) = name.strip_suffix(":32") {
            let is_fit =
                |device: &Device| device.kind == DeviceKind::D && device.next_in_range(target).is_some();
            return device(register).filter(is_fit).map(Point::Pair);
        }
        if let Some(device) = device(name) {
            return match device.kind {
                kind if kind.is_word() => Some(Point::Word(device)),
                kind if kind.is_bit() => Some(Point::Bit(device, Part::Contact)),
                _ => None,
            };
        }
        let mut letters = name.chars();
        let kind = DeviceKind::of_letter(letters.next()?).filter(|kind| kind.has_preset())?;
        let part = letters.next()?.to_ascii_uppercase();
        let device = device(&format!("{}{}", kind.letter(), letters.as_str()))?;
        match part {
            'S' => Some(Point::Bit(device, Part::Contact)),
            'C' => Some(Point::Bit(device, Part::Coil)),
            'N' => Some(Point::Word(device)),
            _ => None,
        }
    }

    /// The numbers that it takes.
    pub fn range(self) -> RangeInclusive<i64> {
        let wide = i64::from(i32::MIN)..=i64::from(i32::MAX);
        match self {
            Point::Bit(..) => 0..=1,
            Point::Pair(_) => wide,
            Point::Word(device) if device.kind == DeviceKind::C && device.number >= 200 => wide,
            Point::Word(_) => i64::from(i16::MIN)..=i64::from(i16::MAX),
        }
    }

    /// The number that is written for a value, 0 or 1 for a bit; nothing if that is none of it.
    pub fn number(self, value: &Value) -> Option<i64> {
        match value {
            value if self.is_bit() => value.as_bit().map(i64::from),
            Value::Number(number) => Some(*number).filter(|number| self.range().contains(number)),
            _ => None,
        }
    }

    /// What a number that was read from it is.
    pub fn value(self, number: i64) -> Value {
        if self.is_bit() { Value::Bit(number != 0) } else { Value::Number(number) }
    }

    /// Whether the port of this model reaches it.
    pub fn is_reached(self, target: &Target) -> bool {
        match Dialect::of(target) {
            Dialect::Plain => Place::of::<Plain>(self).is_ok(),
            Dialect::Extended => Place::of::<Extended>(self).is_ok(),
        }
    }

    /// Whether it is on or off.
    pub fn is_bit(self) -> bool {
        matches!(self, Point::Bit(..))
    }
}

/// The names of what the port of a model reaches, for expressions.
#[derive(Clone, Copy)]
pub struct NamesOfPlc(pub &'static Target);

impl Names for NamesOfPlc {
    type Variable = Point;

    fn variable(&self, name: &str) -> Option<Point> {
        Point::named(name, self.0).filter(|point| point.is_reached(self.0))
    }

    fn meant(&self, _: Point, value: &Value) -> Option<Value> {
        value.of_device()
    }
}

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Point::Bit(device, part) if device.kind.has_preset() => {
                let letter = if *part == Part::Coil { 'C' } else { 'S' };
                write!(f, "{}{letter}{}", device.kind.letter(), device.number)
            }
            Point::Bit(device, _) | Point::Word(device) => write!(f, "{device}"),
            Point::Pair(device) => write!(f, "{device}:32"),
        }
    }
}
