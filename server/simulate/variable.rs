//! Names of what can be watched and set, and their values.

use super::code::Code;
use super::iec::{self, HandedOver, Leaf, UnitVariables, joined};
use super::machine::Machine;
use super::row::Cell;
use super::session::Touch;
use super::{Lanes, Layout, Lies, Slot, Spot, Value, around};
use crate::target::iec::{Datum, ElementaryType};
use crate::target::{Device, DeviceKind, Operand, Port, PortKind, Target};
use crate::text::Message;
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
    /// What is around the CPU.
    Around(Port),
}

impl Code {
    /// The variable that a person calls `name`, letter case aside.
    ///
    /// `T0` is the current value of the timer, `TS0` its contact, `TC0` its coil, and so with counters (`CN0`, `CS0`,
    /// `CC0`), as in the maker's tools. `D0:32` is a pair of registers. What is around the CPU has the names that
    /// [`Port`] says.
    ///
    /// In IEC 61131-3 it is `Motor.Timer.ET`, `Resource.Main.Levels[3]` or `%IX0.0`; what stands around a name may be
    /// left out where only one variable is called so.
    pub fn variable(&self, name: &str) -> Option<Variable> {
        let name = name.trim();
        if !self.target.is_fx() {
            return self.iec.find(name).map(Variable::of_leaf);
        }
        self.layout.variable(name, self.target)
    }

    /// The variable that a name means inside of an IEC 61131-3 program unit, which has no name for what stands outside
    /// of all. In a program with several instances it is that of the first; of any other unit nothing is given where
    /// its instances differ.
    pub fn variable_at(&self, unit: &str, name: &str) -> Option<Variable> {
        self.iec.names().find_at(unit, name.trim()).map(Variable::of_leaf)
    }

    /// The variables that a name means inside of an IEC 61131-3 program unit: one for each of its instances.
    pub fn variables_at(&self, unit: &str, name: &str) -> Vec<Variable> {
        let scopes = self.iec.names().scopes_of(unit);
        scopes.filter_map(|scope| self.variable_in(scope, name)).collect()
    }

    /// The variable that a name means at an instruction, by the number of that: one of the instance or function of
    /// IEC 61131-3 that the instruction belongs to, else what it means anywhere.
    pub fn variable_from(&self, instruction: u32, name: &str) -> Option<Variable> {
        let scope = self.iec.names().scope_at(instruction);
        scope.and_then(|scope| self.variable_in(scope, name)).or_else(|| self.variable(name))
    }

    /// A name for [`Code::variable`] of what is called `name` in the instance or function that an instruction belongs
    /// to; nothing if that has no such variable.
    pub fn whole_name(&self, instruction: u32, name: &str) -> Option<String> {
        let names = self.iec.names();
        let scope = names.scope_at(instruction)?;
        let leaf = names.find_in(scope, name.trim())?;
        let own = joined(&names.owner_of(scope)?, name.trim());
        // What is handed over as VAR_IN_OUT has the name that it has elsewhere.
        if names.find(&own) == Some(leaf) { Some(own) } else { names.name_at(leaf.spot) }
    }

    /// The body of a unit of IEC 61131-3 to which an instruction belongs, by its number.
    pub fn scope_at(&self, instruction: u32) -> Option<usize> {
        self.iec.names().scope_at(instruction)
    }

    /// What is handed over to the bodies of an IEC 61131-3 program as VAR_IN_OUT.
    pub fn handed_over(&self) -> Vec<HandedOver> {
        self.iec.names().handed_over()
    }

    /// The program, the instance of a function block or the function of IEC 61131-3 to which an instruction belongs, as
    /// a name for [`Code::variable`] begins.
    pub fn owner(&self, instruction: u32) -> Option<String> {
        let names = self.iec.names();
        names.owner_of(names.scope_at(instruction)?)
    }

    /// The variable that a name means in one of the bodies of an IEC 61131-3 program.
    pub(super) fn variable_in(&self, scope: usize, name: &str) -> Option<Variable> {
        self.iec.names().find_in(scope, name.trim()).map(Variable::of_leaf)
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
    pub fn variables_by_unit(&self) -> Vec<UnitVariables> {
        self.iec.names().by_unit()
    }
}

impl Layout {
    /// What is called `name` in a PLC of the FX family, as [`Code::variable`] says.
    pub fn variable(&self, name: &str, target: &Target) -> Option<Variable> {
        let name = name.trim();
        let device = |name: &str| match Operand::read(name, target.model) {
            Operand::Device(device) if self.has(device) => Some(device),
            _ => None,
        };
        if let Some(register) = name.strip_suffix(":32") {
            let device = device(register).filter(|device| has_pairs(device.kind))?;
            let behind = Device::new(device.kind, device.number + 1);
            let is_pair = device.is_special() == behind.is_special();
            let pair = Variable::Pair(self.slot(device)?, self.slot(behind)?);
            return is_pair.then_some(pair);
        }
        if let Some(device) = device(name) {
            let word = self.slot(device).map(Variable::Word);
            return word.or_else(|| self.cell(device).map(Variable::Relay));
        }
        if let Some(port) = Port::read(name, device) {
            return Some(Variable::Around(port));
        }
        let mut letters = name.chars();
        let kind = DeviceKind::of_letter(letters.next()?).filter(|kind| kind.has_preset())?;
        let part = letters.next()?.to_ascii_uppercase();
        let device = device(&format!("{}{}", kind.letter(), letters.as_str()))?;
        match part {
            'S' => self.cell(device).map(Variable::Relay),
            'C' => self.coil(device).map(Variable::Relay),
            'N' => self.slot(device).map(Variable::Word),
            _ => None,
        }
    }
}

impl Variable {
    fn of_leaf(leaf: Leaf) -> Variable {
        match (leaf.spot.lies, leaf.enumeration) {
            (_, Some(enumeration)) => Variable::Enumerated(leaf.spot, enumeration),
            (Lies::Cell(cell), None) if leaf.spot.index == 0 => Variable::Relay(cell),
            _ => Variable::Typed(leaf.spot),
        }
    }

    /// Its type, if it is declared with one.
    pub fn declared(self) -> Option<ElementaryType> {
        match self {
            Variable::Typed(spot) => Some(spot.kind),
            _ => None,
        }
    }

    /// What setting it to `value` does; nothing if that is no value of it.
    pub fn set(self, code: &Code, value: &Value) -> Option<Touch> {
        let value = &self.meant(code, value)?;
        match (self, value) {
            (Variable::Relay(_), _) => {
                let is_free = !self.is_coil(code);
                value.as_bit().filter(|_| is_free).map(|on| Touch::Write(self, Value::Bit(on)))
            }
            (Variable::Typed(_) | Variable::Enumerated(..), _) => {
                self.datum(code, value).map(|_| Touch::Write(self, value.clone()))
            }
            (Variable::Around(port), _) => around::taken(port, value).map(|value| Touch::Write(self, value)),
            (_, Value::Number(number)) if self.range(code)?.contains(number) => {
                Some(Touch::Write(self, value.clone()))
            }
            _ => None,
        }
    }

    /// What a value is that people write for it: `Red` and `Colour#Red` are the same, `K5` is a number unless a value
    /// of its type is called so. Nothing for a name that says no value of it.
    pub fn meant(self, code: &Code, value: &Value) -> Option<Value> {
        match (self, value) {
            (Variable::Enumerated(_, enumeration), _) => {
                let number = self.datum(code, value)?.whole();
                code.iec.name_of_value(enumeration, number).cloned().map(Value::Name)
            }
            (Variable::Around(port), _) => around::meant(port, value),
            (_, Value::Word(_, meant)) => Some((**meant).clone()),
            (Variable::Typed(spot), Value::Name(_)) => {
                value.datum(spot.kind).map(|datum| Value::of_datum(datum, spot.kind))
            }
            (_, Value::Name(_)) => None,
            _ => Some(value.clone()),
        }
    }

    /// The numbers that it takes; nothing for a relay.
    pub fn range(self, code: &Code) -> Option<RangeInclusive<i64>> {
        let narrow = i64::from(i16::MIN)..=i64::from(i16::MAX);
        let wide = i64::from(i32::MIN)..=i64::from(i32::MAX);
        match self {
            Variable::Relay(_) | Variable::Enumerated(..) => None,
            Variable::Typed(spot) => {
                let whole = spot.kind.integers()?;
                let (least, greatest) = code.iec.range(spot).unwrap_or((*whole.start(), *whole.end()));
                let bound = |bound: i128| i64::try_from(bound).unwrap_or(i64::MAX);
                Some(bound(least)..=bound(greatest))
            }
            Variable::Word(slot) => {
                let device = code.layout.device_of_slot(slot)?;
                Some(if code.layout.is_wide(device) { wide } else { narrow })
            }
            Variable::Pair(..) => Some(wide),
            Variable::Around(port) => match port.kind() {
                PortKind::Number(range) => Some(range),
                PortKind::Bit | PortKind::Frame => None,
            },
        }
    }

    /// Why it, which people call `name`, cannot be set to `value`.
    pub fn refusal(self, code: &Code, name: &str, value: &Value) -> Message {
        let meant = self.meant(code, value);
        if let Variable::Around(port) = self
            && let Some(reason) = around::refusal(port, value)
        {
            return reason.with("name", name);
        }
        match (meant.as_ref().unwrap_or(value), self.range(code)) {
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
        match self.set(code, value)? {
            // What is around the CPU has no image in it that could be held.
            Touch::Write(Variable::Around(_), _) => None,
            Touch::Write(variable, value) => Some(Touch::Hold(variable, value)),
            _ => None,
        }
    }

    /// What letting it go does.
    pub fn release(self) -> Touch {
        Touch::LetGo(self)
    }

    /// The value as a variable of IEC 61131-3 takes it; nothing if it is none of its type.
    pub(super) fn datum(self, code: &Code, value: &Value) -> Option<Datum> {
        match (self, value) {
            (Variable::Enumerated(_, enumeration), Value::Text(name) | Value::Name(name)) => {
                code.iec.value_named(enumeration, name).map(Datum::Whole)
            }
            (Variable::Enumerated(_, enumeration), Value::Word(name, meant)) => {
                let named = code.iec.value_named(enumeration, name).map(Datum::Whole);
                named.or_else(|| self.datum(code, meant))
            }
            (Variable::Enumerated(_, enumeration), Value::Number(number)) => {
                let number = i128::from(*number);
                code.iec.name_of_value(enumeration, number).map(|_| Datum::Whole(number))
            }
            (Variable::Typed(spot), _) => {
                let within = |datum: &Datum| {
                    let range = code.iec.range(spot);
                    range.is_none_or(|(least, greatest)| (least..=greatest).contains(&datum.whole()))
                };
                value.datum(spot.kind).filter(within)
            }
            _ => None,
        }
    }
}

/// Whether two of these, one behind the other, are a number of 32 bits.
fn has_pairs(kind: DeviceKind) -> bool {
    matches!(kind, DeviceKind::D | DeviceKind::R)
}

impl<L: Lanes> Machine<L> {
    /// The value of a variable in a scenario: of an output what is at its terminal.
    pub fn value(&self, variable: Variable, lane: usize) -> Value {
        match variable {
            Variable::Relay(cell) => Value::Bit(self.relay(cell).lane(lane)),
            Variable::Word(slot) => Value::Number(self.memory().word(slot, lane)),
            Variable::Around(port) => around::value(port, &self.outside()[lane]),
            Variable::Typed(spot) => Value::of_datum(self.datum_at(spot, lane), spot.kind),
            Variable::Enumerated(spot, enumeration) => {
                let number = self.datum_at(spot, lane).whole();
                let name = self.code.iec.name_of_value(enumeration, number).cloned();
                name.map_or(Value::Number(number as i64), Value::Name)
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
                    (0..Cell::from(count)).map(|bit| self.terminals.output(first + bit)).collect();
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
