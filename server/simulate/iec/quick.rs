//! Calculations with whole numbers in words and cells whose places are known: no value is looked at twice.

use super::parts::{Input, Lies, Spot};
use crate::simulate::{Cell, Lanes, Memory, Slot};
use crate::target::iec::semantics::range_of;
use crate::target::iec::{Datum, ElementaryType, Formula, Kernel};

/// The shorter way of a calculation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quick {
    kernel: Kernel,
    left: Operand,
    right: Operand,
    to: Near,
    /// What the type of the result holds.
    least: i64,
    greatest: i64,
}

#[derive(Clone, Copy, Debug)]
enum Operand {
    Constant(i64),
    At(Near),
}

/// A place that is known.
#[derive(Clone, Copy, Debug)]
enum Near {
    Cell(Cell),
    Word(Slot),
}

impl Quick {
    /// The shorter way, if the formula has one and all values are whole numbers at places that are known.
    pub fn of(
        formula: Formula,
        (inputs, kinds): (&[Input], &[ElementaryType]),
        result: ElementaryType,
        to: Spot,
    ) -> Option<Quick> {
        if !kinds.iter().all(|kind| is_number(*kind)) {
            return None;
        }
        let (left, right) = match inputs {
            [only] => (Operand::of(only)?, Operand::Constant(0)),
            [left, right] => (Operand::of(left)?, Operand::of(right)?),
            _ => return None,
        };
        let to = Near::of(to).filter(|_| to.range == 0 && to.kind == result)?;
        let range = range_of(result);
        let [least, greatest] = [range.start(), range.end()].map(|end| i64::try_from(*end).ok());
        Some(Quick { kernel: formula.kernel?, left, right, to, least: least?, greatest: greatest? })
    }

    /// Calculates in a scenario; false where that goes wrong or leads too far, and nothing has been written.
    #[inline]
    pub fn run<L: Lanes>(&self, memory: &mut Memory<L>, lane: usize) -> bool {
        let [left, right] = [self.left, self.right].map(|operand| match operand {
            Operand::Constant(number) => number,
            Operand::At(Near::Cell(cell)) => i64::from(memory.bit(cell, lane)),
            Operand::At(Near::Word(slot)) => memory.word(slot, lane),
        });
        let result = (self.kernel)(left, right);
        let Some(result) = result.filter(|number| (self.least..=self.greatest).contains(number)) else {
            return false;
        };
        match self.to {
            Near::Cell(cell) => memory.set_bit(cell, lane, result != 0),
            Near::Word(slot) => memory.set_word(slot, lane, result),
        }
        true
    }
}

impl Operand {
    fn of(input: &Input) -> Option<Operand> {
        match input {
            Input::Constant(Datum::Whole(number)) => i64::try_from(*number).ok().map(Operand::Constant),
            Input::At(spot) => Near::of(*spot).map(Operand::At),
            Input::Constant(_) => None,
        }
    }
}

impl Near {
    /// Where a word or a cell has the number itself, and subscripts lead nowhere else.
    fn of(spot: Spot) -> Option<Near> {
        match spot.lies {
            _ if spot.index != 0 || !is_number(spot.kind) => None,
            Lies::Cell(cell) => Some(Near::Cell(cell)),
            Lies::Word(slot) => Some(Near::Word(slot)),
            _ => None,
        }
    }
}

/// Whether values of the type are whole numbers of 64 bits with a sign, or durations, which are their nanoseconds.
fn is_number(kind: ElementaryType) -> bool {
    use ElementaryType::*;
    matches!(kind, Time | Ltime) || kind.integers().is_some() && !matches!(kind, Ulint | Lword)
}
