//! A moment inside a scan: an instruction has seen what reaches it, and has not acted yet.

use super::{Lanes, Machine, Place, Sight, Value, Variable};

/// The PLC in the middle of a scan.
#[derive(Debug)]
pub struct Glimpse<'m, L> {
    /// As it is there.
    pub machine: &'m Machine<L>,
    /// What the instruction sees.
    pub sight: Sight<L>,
    /// The ops that routines go back to, the innermost last.
    pub(super) calls: &'m [usize],
    /// How many of them there were when each routine of an interrupt began.
    pub(super) routines: &'m [usize],
}

/// Where a routine was entered.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Caller {
    /// The CALL, or the instruction behind which the interrupt came.
    pub place: Place,
    /// Whether it was an interrupt.
    pub is_interrupt: bool,
}

impl<L: Lanes> Glimpse<'_, L> {
    /// How many routines deep it is.
    pub fn depth(&self) -> usize {
        self.calls.len()
    }

    /// Where the routines that it is in were entered, the innermost last.
    pub fn callers(&self) -> Vec<Caller> {
        let callers = (1..).zip(self.calls).filter_map(|(depth, back)| {
            let place = self.machine.code().place(back.checked_sub(1)?)?;
            Some(Caller { place, is_interrupt: self.routines.contains(&depth) })
        });
        callers.collect()
    }
}

impl<L: Lanes> Machine<L> {
    /// The value that the program sees, which for an output may not be at its terminal yet.
    pub fn value_inside(&self, variable: Variable, lane: usize) -> Value {
        match variable {
            Variable::Relay(cell) => Value::Bit(self.memory().bit(cell, lane)),
            other => self.value(other, lane),
        }
    }
}
