//! The terminals of the simulated PLC: what inputs are wired to, and what outputs give.

use super::row::Cell;
use super::{Lanes, Layout, Machine, Memory, Variable};
use crate::target::{DeviceKind, Outside};
use std::ops::Range;

/// What is wired to the PLC, beside the images of it that the program sees.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Terminals<L> {
    x: Range<usize>,
    y: Range<usize>,
    inputs: Vec<L>,
    outputs: Vec<L>,
    /// Where all outputs are off, whatever their images are.
    off: L,
}

impl<L: Lanes> Terminals<L> {
    /// The terminals of a PLC, all off.
    pub(super) fn new(layout: &Layout) -> Terminals<L> {
        let (x, y) = (layout.terminals(DeviceKind::X), layout.terminals(DeviceKind::Y));
        Terminals { inputs: vec![L::NONE; x.len()], outputs: vec![L::NONE; y.len()], off: L::NONE, x, y }
    }

    /// The images of inputs become what is wired, also through keypads.
    pub(super) fn sample(&self, memory: &mut Memory<L>, outside: &[Outside]) {
        memory.cells[self.x.clone()].copy_from_slice(&self.inputs);
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
            let cell = self.x.start + x as usize;
            (is_fed && cell < self.x.end).then_some(cell as Cell)
        })
    }

    /// Output terminals become what their images are.
    pub(super) fn publish(&mut self, memory: &Memory<L>) {
        self.outputs.copy_from_slice(&memory.cells[self.y.clone()]);
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
        self.inputs.get_mut(usize::from(cell).checked_sub(self.x.start)?)
    }

    /// The same, to look at it.
    pub(super) fn input(&self, cell: Cell) -> Option<L> {
        self.inputs.get(usize::from(cell).checked_sub(self.x.start)?).copied()
    }

    /// What is at the terminal of the output in a cell.
    pub(super) fn output(&self, cell: Cell) -> Option<L> {
        self.outputs.get(usize::from(cell).checked_sub(self.y.start)?).copied()
    }

    /// One input or output in the middle of the scan.
    pub(super) fn refresh(&mut self, memory: &mut Memory<L>, outside: &Outside, cell: Cell, lane: usize) {
        let at = usize::from(cell);
        if self.x.contains(&at) {
            let is_fed = self.fed(outside, lane).any(|fed| fed == cell);
            let on = self.inputs[at - self.x.start].lane(lane) || is_fed;
            memory.set_bit(cell, lane, on);
        } else if self.y.contains(&at) {
            let output = &mut self.outputs[at - self.y.start];
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
