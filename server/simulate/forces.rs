//! Values that are held whatever inputs and program say.

use super::iec::{self, Lies, Spot};
use super::row::{Cell, Row};
use super::{Lanes, Machine, Slot, Value, Variable};
use crate::target::Device;
use crate::target::iec::Datum;

/// Something that keeps a value whatever the program does.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Force {
    Relay(Cell, bool),
    Word(Slot, i64),
    /// A variable that is no relay.
    Typed(Spot, Datum),
}

impl Force {
    /// Whether it holds this.
    fn holds(&self, variable: Variable) -> bool {
        match (self, variable) {
            (Force::Relay(forced, _), Variable::Relay(cell)) => *forced == cell,
            (Force::Word(forced, _), Variable::Word(slot) | Variable::Pair(slot, _)) => *forced == slot,
            (Force::Typed(forced, _), Variable::Typed(spot) | Variable::Enumerated(spot, _)) => {
                *forced == spot
            }
            _ => false,
        }
    }
}

impl<L: Lanes> Machine<L> {
    /// Holds a relay at a value whatever inputs and program say, until [`Machine::release`].
    pub fn force(&mut self, device: Device, on: bool) {
        self.release(device);
        if let Some(cell) = self.code.layout.cell(device) {
            self.forces.push(Force::Relay(cell, on));
        }
        self.patch();
        self.hold();
    }

    /// Holds a register, or the current value of a timer or counter, at a value.
    pub fn force_word(&mut self, device: Device, value: i64) {
        self.release(device);
        let value = self.code.layout.held(device, value);
        self.forces.extend(self.code.layout.slot(device).map(|slot| Force::Word(slot, value)));
        self.hold();
    }

    /// Lets a forced device go; it keeps its value until something writes it.
    pub fn release(&mut self, device: Device) {
        let layout = &self.code.layout;
        let relay = layout.cell(device).map(Variable::Relay);
        let word = layout.slot(device).map(Variable::Word);
        relay.into_iter().chain(word).for_each(|variable| self.let_go(variable));
    }

    /// Holds a variable at a value, if that is one of its type.
    pub fn hold_at(&mut self, variable: Variable, value: &Value) {
        self.let_go(variable);
        match variable {
            Variable::Relay(cell) => {
                self.forces.extend(value.as_bit().map(|on| Force::Relay(cell, on)));
            }
            Variable::Typed(spot) | Variable::Enumerated(spot, _) => {
                let datum = variable.datum(&self.code, value);
                self.forces.extend(datum.map(|datum| Force::Typed(spot, datum)));
            }
            Variable::Word(_) | Variable::Pair(..) => {}
        }
        self.patch();
        self.hold();
    }

    /// Lets a forced variable go; it keeps its value until something writes it.
    pub fn let_go(&mut self, variable: Variable) {
        self.forces.retain(|force| !force.holds(variable));
        self.patch();
    }

    /// What is forced stays so in other code, as far as it has a variable of this name.
    pub(super) fn keep_forces(&mut self, code: &super::Code) {
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

    /// Lets all that is forced go.
    pub fn let_all_go(&mut self) {
        self.forces.clear();
        self.patch();
    }

    /// The names of what is forced.
    pub fn forced(&self) -> Vec<String> {
        let layout = &self.code.layout;
        let device = |device: Option<Device>| device.map(|device| device.to_string());
        let name = |force: &Force| match force {
            Force::Relay(cell, _) => {
                device(layout.device_of_cell(*cell)).or_else(|| self.code.iec.name_of(Spot::of_cell(*cell)))
            }
            Force::Word(slot, _) => device(layout.device_of_slot(*slot)),
            Force::Typed(spot, _) => self.code.iec.name_of(*spot),
        };
        self.forces.iter().filter_map(name).collect()
    }

    /// Whether it is forced.
    pub fn is_forced(&self, variable: Variable) -> bool {
        self.forces.iter().any(|force| force.holds(variable))
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

    /// Writes a variable; of an input what is wired to it.
    pub fn write(&mut self, variable: Variable, value: &Value) {
        match variable {
            Variable::Relay(cell) => {
                if let Some(on) = value.as_bit() {
                    self.write_cell(cell, L::all(on));
                }
            }
            Variable::Typed(spot) | Variable::Enumerated(spot, _) => {
                let Some(datum) = variable.datum(&self.code, value) else { return };
                iec::put(&mut self.memory, &self.code.iec, spot, &datum);
                if let Lies::Bits(first, count) = spot.lies {
                    for cell in first..first + Cell::from(count) {
                        let on = self.memory.cell(cell);
                        self.write_cell(cell, on);
                    }
                }
            }
            Variable::Word(_) | Variable::Pair(..) => {}
        }
    }
}
