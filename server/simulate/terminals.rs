//! The terminals of the simulated PLC: what inputs are wired to, and what outputs give.

use super::row::Cell;
use super::{Code, Lanes, Machine, Memory, Variable};
use crate::target::{Location, Outside};
use std::ops::Range;

/// What is wired to the PLC, beside the images of it that the program sees.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Terminals<L> {
    /// The cells of inputs and outputs, in rows.
    x: Vec<Range<usize>>,
    y: Vec<Range<usize>>,
    inputs: Vec<L>,
    outputs: Vec<L>,
    /// Where all outputs are off, whatever their images are.
    off: L,
}

impl<L: Lanes> Terminals<L> {
    /// The terminals of a PLC, all off.
    pub(super) fn new(code: &Code) -> Terminals<L> {
        let (x, y) = (code.terminals(Location::Input), code.terminals(Location::Output));
        let off = |rows: &[Range<usize>]| vec![L::NONE; rows.iter().map(ExactSizeIterator::len).sum()];
        Terminals { inputs: off(&x), outputs: off(&y), off: L::NONE, x, y }
    }

    /// The same with what is wired to, and given by, the terminals of another program; `cells` has those of both.
    pub(super) fn rewired(mut self, other: &Terminals<L>, cells: &[(Cell, Cell)]) -> Terminals<L> {
        for (from, to) in cells {
            if let (Some(old), Some(new)) = (place(&other.x, *from), place(&self.x, *to)) {
                self.inputs[new] = other.inputs[old];
            }
            if let (Some(old), Some(new)) = (place(&other.y, *from), place(&self.y, *to)) {
                self.outputs[new] = other.outputs[old];
            }
        }
        self
    }

    /// The same, with what is wired to the terminals of a PLC of the same model.
    pub(super) fn wired_as(mut self, other: &Terminals<L>) -> Terminals<L> {
        self.inputs.clone_from(&other.inputs);
        self
    }

    /// The images of inputs become what is wired, also through keypads.
    pub(super) fn sample(&self, memory: &mut Memory<L>, outside: &[Outside]) {
        let mut first = 0;
        for row in &self.x {
            memory.cells[row.clone()].copy_from_slice(&self.inputs[first..first + row.len()]);
            first += row.len();
        }
        for (lane, outside) in outside.iter().enumerate() {
            for cell in self.fed(outside, lane) {
                memory.set_bit(cell, lane, true);
            }
        }
    }

    /// The inputs that get their voltage from an output through a keypad.
    fn fed(&self, outside: &Outside, lane: usize) -> impl Iterator<Item = Cell> {
        outside.contacts().filter_map(move |(y, x)| {
            let is_fed = self.outputs.get(y as usize).is_some_and(|output| output.lane(lane));
            let row = self.x.first().filter(|_| is_fed)?;
            let cell = row.start + x as usize;
            row.contains(&cell).then_some(cell as Cell)
        })
    }

    /// Output terminals become what their images are.
    pub(super) fn publish(&mut self, memory: &Memory<L>) {
        let mut first = 0;
        for row in &self.y {
            self.outputs[first..first + row.len()].copy_from_slice(&memory.cells[row.clone()]);
            first += row.len();
        }
        if self.off != L::NONE {
            self.outputs.iter_mut().for_each(|output| *output = *output & !self.off);
        }
    }

    /// Output terminals are off from now on where `off` says so.
    pub(super) fn switch_off(&mut self, off: L) {
        self.off = off;
    }

    /// What is wired to the input in a cell.
    pub(super) fn input_mut(&mut self, cell: Cell) -> Option<&mut L> {
        self.inputs.get_mut(place(&self.x, cell)?)
    }

    /// The same, to look at it.
    pub(super) fn input(&self, cell: Cell) -> Option<L> {
        self.inputs.get(place(&self.x, cell)?).copied()
    }

    /// What is at the terminal of the output in a cell.
    pub(super) fn output(&self, cell: Cell) -> Option<L> {
        self.outputs.get(place(&self.y, cell)?).copied()
    }

    /// One input or output in the middle of the scan.
    pub(super) fn refresh(&mut self, memory: &mut Memory<L>, outside: &Outside, cell: Cell, lane: usize) {
        if let Some(at) = place(&self.x, cell) {
            let is_fed = self.fed(outside, lane).any(|fed| fed == cell);
            let on = self.inputs[at].lane(lane) || is_fed;
            memory.set_bit(cell, lane, on);
        } else if let Some(at) = place(&self.y, cell) {
            let output = &mut self.outputs[at];
            *output = output.with(lane, memory.bit(cell, lane) && !self.off.lane(lane));
        }
    }
}

impl<L: Lanes> Machine<L> {
    /// What is wired to an input, which the next scan will see; nothing for what is none.
    pub fn wired(&self, variable: Variable) -> Option<L> {
        match variable {
            Variable::Relay(cell) => self.terminals.input(cell),
            _ => None,
        }
    }
}

/// The number of a terminal by its cell.
fn place(rows: &[Range<usize>], cell: Cell) -> Option<usize> {
    let cell = usize::from(cell);
    let row = rows.partition_point(|row| row.end <= cell);
    let own = rows.get(row).filter(|own| own.contains(&cell))?;
    let before: usize = rows[..row].iter().map(ExactSizeIterator::len).sum();
    Some(before + cell - own.start)
}
