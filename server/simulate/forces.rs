//! Values that are held whatever inputs and program say, and values that a person writes.

use super::iec::{self, Lies, Spot};
use super::row::{Cell, Row};
use super::{Code, Lanes, Machine, Slot, Value, Variable, around};
use crate::target::iec::Datum;
use crate::target::{Device, Location};

/// Something that keeps a value whatever the program does.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Force {
    Relay(Cell, bool),
    Word(Slot, i64),
    /// A variable of IEC 61131-3 that is no BOOL.
    Typed(Spot, Datum),
}

impl Force {
    /// Whether it holds this, or a half of it.
    fn holds(&self, variable: Variable) -> bool {
        match (self, variable) {
            (Force::Relay(forced, _), Variable::Relay(cell)) => *forced == cell,
            (Force::Word(forced, _), Variable::Word(slot)) => *forced == slot,
            (Force::Word(forced, _), Variable::Pair(lower, upper)) => *forced == lower || *forced == upper,
            (Force::Typed(forced, _), Variable::Typed(spot) | Variable::Enumerated(spot, _)) => {
                *forced == spot
            }
            _ => false,
        }
    }
}

impl<L: Lanes> Machine<L> {
    /// Holds a relay at a value whatever inputs and program say, until [`Machine::release`]; of a timer or counter the
    /// contact.
    pub fn force(&mut self, device: Device, on: bool) {
        if let Some(cell) = self.code.layout.cell(device) {
            self.hold_at(Variable::Relay(cell), &Value::Bit(on));
        }
    }

    /// Holds a register, or the current value of a timer or counter, at a value.
    pub fn force_word(&mut self, device: Device, value: i64) {
        let value = self.code.layout.held(device, value);
        if let Some(slot) = self.code.layout.slot(device) {
            self.hold_at(Variable::Word(slot), &Value::Number(value));
        }
    }

    /// Lets a forced device go; it keeps its value until something writes it.
    pub fn release(&mut self, device: Device) {
        let relay = self.code.layout.cell(device).map(Variable::Relay);
        let word = self.code.layout.slot(device).map(Variable::Word);
        relay.into_iter().chain(word).for_each(|variable| self.let_go(variable));
    }

    /// Holds a variable at a value, if that is one of its own.
    pub fn hold_at(&mut self, variable: Variable, value: &Value) {
        self.let_go(variable);
        self.add_force(variable, value);
        self.patch();
        self.hold();
    }

    /// Holds these variables at these values, and no others: what a PLC elsewhere has.
    pub fn hold_only(&mut self, values: impl Iterator<Item = (Variable, Value)>) {
        self.forces.clear();
        values.for_each(|(variable, value)| self.add_force(variable, &value));
        self.patch();
        self.hold();
    }

    fn add_force(&mut self, variable: Variable, value: &Value) {
        match (variable, value) {
            (Variable::Relay(cell), _) => {
                self.forces.extend(value.as_bit().map(|on| Force::Relay(cell, on)));
            }
            (Variable::Word(slot), Value::Number(number)) => self.forces.push(Force::Word(slot, *number)),
            (Variable::Pair(lower, upper), Value::Number(number)) => {
                let halves = halves(*number);
                self.forces.extend([Force::Word(lower, halves.0), Force::Word(upper, halves.1)]);
            }
            (Variable::Typed(spot) | Variable::Enumerated(spot, _), _) => {
                let datum = variable.datum(&self.code, value);
                self.forces.extend(datum.map(|datum| Force::Typed(spot, datum)));
            }
            _ => {}
        }
    }

    /// Lets a forced variable go; it keeps its value until something writes it.
    pub fn let_go(&mut self, variable: Variable) {
        self.leave(|force| force.holds(variable));
    }

    /// Lets all that is forced go.
    pub fn let_all_go(&mut self) {
        self.leave(|_| true);
    }

    fn leave(&mut self, is_left: impl Fn(&Force) -> bool) {
        let (left, kept): (Vec<Force>, Vec<Force>) = self.forces.drain(..).partition(is_left);
        self.forces = kept;
        for force in left {
            if let Force::Word(slot, _) = force {
                self.note_written(slot);
            }
        }
        self.patch();
    }

    /// Writes a variable; of an input what is wired to it.
    pub fn write(&mut self, variable: Variable, value: &Value) {
        match (variable, value) {
            (Variable::Relay(cell), _) => {
                if let Some(on) = value.as_bit() {
                    self.write_cell(cell, L::all(on));
                }
            }
            (Variable::Word(slot), Value::Number(number)) => {
                if let Some(device) = self.code.layout.device_of_slot(slot) {
                    self.set_word(device, *number);
                }
            }
            (Variable::Pair(lower, upper), Value::Number(number)) => {
                let halves = halves(*number);
                for lane in 0..L::COUNT {
                    self.memory.set_word(lower, lane, halves.0);
                    self.memory.set_word(upper, lane, halves.1);
                }
            }
            (Variable::Typed(spot) | Variable::Enumerated(spot, _), _) => {
                let Some(datum) = variable.datum(&self.code, value) else { return };
                iec::put(&mut self.memory, &self.code.iec, spot, &datum);
                if let Lies::Bits(first, count) = spot.lies {
                    for cell in (0..Cell::from(count)).map(|bit| first + bit) {
                        let on = self.memory.cell(cell);
                        self.write_cell(cell, on);
                    }
                }
            }
            (Variable::Around(port), _) => {
                self.outside.iter_mut().for_each(|outside| around::put(port, outside, value));
            }
            _ => {}
        }
    }

    /// What is forced stays so in other code, as far as that has a variable of this name.
    pub(super) fn keep_forces(&mut self, code: &Code) {
        let own = &self.code.iec;
        let moved = |force: &Force| match force {
            Force::Word(..) => Some(force.clone()),
            Force::Relay(cell, on) => match own.name_of(Spot::of_cell(*cell)) {
                None => Some(force.clone()),
                Some(name) => match code.variable(&name)? {
                    Variable::Relay(cell) => Some(Force::Relay(cell, *on)),
                    _ => None,
                },
            },
            Force::Typed(spot, value) => match code.variable(&own.name_of(*spot)?)? {
                Variable::Typed(to) | Variable::Enumerated(to, _) if to.kind == spot.kind => {
                    Some(Force::Typed(to, value.clone()))
                }
                _ => None,
            },
        };
        self.forces = self.forces.iter().filter_map(moved).collect();
    }

    /// The names of what is forced.
    pub fn forced(&self) -> Vec<String> {
        let name = |force: &Force| match force {
            Force::Relay(cell, _) => self.name_of_relay(*cell),
            Force::Word(slot, _) => self.code.layout.device_of_slot(*slot).map(|device| device.to_string()),
            Force::Typed(spot, _) => self.code.iec.name_of(*spot),
        };
        self.forces.iter().filter_map(name).collect()
    }

    fn name_of_relay(&self, cell: Cell) -> Option<String> {
        match self.code.layout.device_of_cell(cell) {
            Some(timer) if timer.kind.has_preset() => {
                Some(format!("{}S{}", timer.kind.letter(), timer.number))
            }
            Some(relay) => Some(relay.to_string()),
            None => self.code.iec.name_of(Spot::of_cell(cell)),
        }
    }

    /// What is wired to inputs and stands around the CPU, and what is forced, by name; with whether it is forced.
    pub(super) fn standing(&self) -> Vec<(String, Value, bool)> {
        let inputs = self.code.terminals(Location::Input).into_iter().flatten();
        let wired = inputs.filter_map(|cell| {
            let is_on = self.terminals.input(cell as Cell)?.lane(0);
            is_on.then(|| Some((self.name_of_relay(cell as Cell)?, Value::Bit(true), false)))?
        });
        let forced = self.forces.iter().filter_map(|force| {
            Some(match force {
                Force::Relay(cell, on) => (self.name_of_relay(*cell)?, Value::Bit(*on), true),
                Force::Word(slot, number) => {
                    (self.code.layout.device_of_slot(*slot)?.to_string(), Value::Number(*number), true)
                }
                Force::Typed(spot, datum) => {
                    (self.code.iec.name_of(*spot)?, Value::of_datum(datum.clone(), spot.kind), true)
                }
            })
        });
        let outside = self.outside().first().into_iter();
        let around = outside.flat_map(|outside| {
            let standing = outside.standing().into_iter();
            standing.map(|port| (port.to_string(), around::value(port, outside), false))
        });
        wired.chain(around).chain(forced).collect()
    }

    /// Whether it is forced.
    pub fn is_forced(&self, variable: Variable) -> bool {
        self.forces.iter().any(|force| force.holds(variable))
    }

    /// Whether something is forced.
    pub fn is_any_forced(&self) -> bool {
        !self.forces.is_empty()
    }

    /// Rows do not write relays that are forced.
    pub(super) fn patch(&mut self) {
        let forced: Vec<Cell> = self
            .forces
            .iter()
            .filter_map(|force| match force {
                Force::Relay(cell, _) => Some(*cell),
                Force::Word(..) | Force::Typed(..) => None,
            })
            .collect();
        self.forced_rows = (!forced.is_empty()).then(|| {
            let free = |row: &Row| if forced.contains(&row.dst) { row.to(Row::SINK) } else { *row };
            self.code.rows.iter().map(free).collect()
        });
    }

    /// Puts what is forced back to its value.
    pub(super) fn hold(&mut self) {
        for force in &self.forces {
            match force {
                Force::Relay(cell, on) => self.memory.set_cell(*cell, L::all(*on)),
                Force::Word(slot, value) => {
                    (0..L::COUNT).for_each(|lane| self.memory.set_word(*slot, lane, *value));
                }
                Force::Typed(spot, value) => iec::put(&mut self.memory, &self.code.iec, *spot, value),
            }
        }
    }
}

/// The lower and the upper word of a number of 32 bits.
fn halves(number: i64) -> (i64, i64) {
    (i64::from(number as i16), i64::from((number >> 16) as i16))
}
