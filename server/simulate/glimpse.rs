//! A moment inside a scan: an instruction has seen what reaches it, and has not acted yet.

use super::iec;
use super::{Lanes, Machine, Place, Sight, Value, Variable};

/// The PLC in the middle of a scan.
#[derive(Debug)]
pub struct Glimpse<'m, L> {
    /// As it is there.
    pub machine: &'m Machine<L>,
    /// The instruction, by its number among those of the code.
    pub instruction: u32,
    /// What it sees; nothing where there is no power to be seen.
    pub sight: Option<Sight<L>>,
    /// Whether it has not acted yet, so that a debugger can stop here.
    pub is_stop: bool,
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
    /// Its number among the instructions of the code.
    pub instruction: u32,
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
            let code = self.machine.code();
            let op = back.checked_sub(1)?;
            let (place, instruction) = (code.place(op)?, *code.op_places.get(op)?);
            Some(Caller { place, instruction, is_interrupt: self.routines.contains(&depth) })
        });
        callers.collect()
    }
}

impl<L: Lanes> Machine<L> {
    /// The value that the program sees, which for an output may not be at its terminal yet.
    pub fn value_inside(&self, variable: Variable, lane: usize) -> Value {
        match variable {
            Variable::Relay(cell) => Value::Bit(self.memory().bit(cell, lane)),
            Variable::Typed(spot) => match iec::read(self.memory(), &self.code().iec, spot, lane) {
                Some(datum) => Value::of_datum(datum, spot.kind),
                None => self.value(variable, lane),
            },
            other => self.value(other, lane),
        }
    }

    /// The current result before an instruction of an instruction list of IEC 61131-3; nothing where there is none.
    pub fn result_before(&self, instruction: u32) -> Option<Value> {
        let result = iec::result_before(self.memory(), &self.code().iec, instruction);
        result.map(|(datum, kind)| Value::of_datum(datum, kind))
    }
}
