//! Which instructions write a variable of an IEC 61131-3 program: in a scan that is run again, or ever.

use super::code::{Code, Op};
use super::row::Row;
use super::{Cell, Glimpse, Lies, Machine, Spot};
use std::ops::Range;

/// An instruction that has written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Write {
    /// Its number among those of the code.
    pub(super) instruction: u32,
    /// How much had been seen in the scan by then.
    pub(super) sights: usize,
}

/// Who looks on while a scan runs.
pub(super) trait Watch<L> {
    /// Whether it is shown each op before that is done.
    const EACH_OP: bool;

    /// Is shown what an instruction sees; false ends the scan.
    fn sees(&mut self, glimpse: Glimpse<'_, L>) -> bool;

    /// Is shown the PLC before the op with this number.
    fn comes(&mut self, machine: &Machine<L>, op: usize);
}

impl<L, F: FnMut(Glimpse<'_, L>) -> bool> Watch<L> for F {
    const EACH_OP: bool = false;

    fn sees(&mut self, glimpse: Glimpse<'_, L>) -> bool {
        self(glimpse)
    }

    fn comes(&mut self, _machine: &Machine<L>, _op: usize) {}
}

/// Notes who writes what lies at a place.
pub(super) struct Tracer {
    wanted: Spot,
    sights: usize,
    /// Whether the instruction that was seen last has power.
    has_power: bool,
    pub(super) found: Vec<Write>,
}

impl Tracer {
    pub(super) fn of(wanted: Spot) -> Tracer {
        Tracer { wanted, sights: 0, has_power: false, found: Vec::new() }
    }
}

impl Watch<u8> for Tracer {
    const EACH_OP: bool = true;

    fn sees(&mut self, glimpse: Glimpse<'_, u8>) -> bool {
        if let Some(sight) = glimpse.sight {
            self.sights += 1;
            self.has_power = sight.power != 0;
        }
        true
    }

    fn comes(&mut self, machine: &Machine<u8>, op: usize) {
        let code = machine.code();
        let note = |instruction| self.found.push(Write { instruction, sights: self.sights });
        match code.ops.get(op) {
            Some(Op::Rows(from, to)) => {
                let own = code.rows_to(self.wanted, *from..*to);
                // What sets or resets does so with power only.
                let done = own.filter(|(row, _)| self.has_power || row.src != row.dst);
                done.map(|(_, instruction)| instruction).for_each(note);
            }
            Some(op_of) if code.iec.is_written(*op_of, self.wanted, Some(machine.memory())) => {
                code.op_places.get(op).copied().into_iter().for_each(note);
            }
            _ => {}
        }
    }
}

impl Code {
    /// The rows among these that write what lies at a place, with their instructions.
    fn rows_to(&self, wanted: Spot, rows: Range<u32>) -> impl Iterator<Item = (&Row, u32)> {
        let within = move |row: &usize| is_within(self.rows[*row].dst, wanted);
        let own = (rows.start as usize..rows.end as usize).filter(within);
        own.filter_map(|row| Some((&self.rows[row], *self.row_places.get(row)?)))
    }

    /// The instructions that may write what lies at a place, in the order of the code, which says what it sees.
    pub(super) fn writers_of(&self, wanted: Spot) -> Vec<u32> {
        let mut found: Vec<u32> = self.rows_to(wanted, 0..self.rows.len() as u32).map(|(_, it)| it).collect();
        let ops = self.ops.iter().zip(&self.op_places);
        found.extend(ops.filter(|(op, _)| self.iec.is_written(**op, wanted, None)).map(|(_, place)| *place));
        found.sort_unstable();
        found.dedup();
        found
    }
}

fn is_within(cell: Cell, wanted: Spot) -> bool {
    match wanted.lies {
        Lies::Cell(own) => own == cell,
        Lies::Bits(first, count) => {
            (u32::from(first)..u32::from(first) + u32::from(count)).contains(&u32::from(cell))
        }
        _ => false,
    }
}
