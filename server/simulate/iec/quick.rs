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
    to: To,
    /// What the type of the result holds.
    least: i64,
    greatest: i64,
}

#[derive(Clone, Copy, Debug)]
enum Operand {
    Constant(i64),
    Cell(Cell),
    Word(Slot),
}

#[derive(Clone, Copy, Debug)]
enum To {
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
        let to = match is_plain(to) && to.range == 0 && to.kind == result {
            true => match to.lies {
                Lies::Cell(cell) => To::Cell(cell),
                Lies::Word(slot) => To::Word(slot),
                _ => return None,
            },
            false => return None,
        };
        let range = range_of(result);
        let [least, greatest] = [range.start(), range.end()].map(|end| i64::try_from(*end).ok());
        Some(Quick { kernel: formula.kernel?, left, right, to, least: least?, greatest: greatest? })
    }

    /// Calculates in a scenario; false where that goes wrong or leads too far, and nothing has been written.
    #[inline]
    pub fn run<L: Lanes>(&self, memory: &mut Memory<L>, lane: usize) -> bool {
        let [left, right] = [self.left, self.right].map(|operand| match operand {
            Operand::Constant(number) => number,
            Operand::Cell(cell) => i64::from(memory.bit(cell, lane)),
            Operand::Word(slot) => memory.word(slot, lane),
        });
        let result = (self.kernel)(left, right);
        let Some(result) = result.filter(|number| (self.least..=self.greatest).contains(number)) else {
            return false;
        };
        match self.to {
            To::Cell(cell) => memory.set_bit(cell, lane, result != 0),
            To::Word(slot) => memory.set_word(slot, lane, result),
        }
        true
    }
}

impl Operand {
    fn of(input: &Input) -> Option<Operand> {
        match input {
            Input::Constant(Datum::Whole(number)) => i64::try_from(*number).ok().map(Operand::Constant),
            Input::At(spot) if is_plain(*spot) => match spot.lies {
                Lies::Cell(cell) => Some(Operand::Cell(cell)),
                Lies::Word(slot) => Some(Operand::Word(slot)),
                _ => None,
            },
            _ => None,
        }
    }
}

/// Whether a word has the number itself, and subscripts lead nowhere else.
fn is_plain(spot: Spot) -> bool {
    spot.index == 0 && is_number(spot.kind)
}

/// Whether values of the type are whole numbers of 64 bits with a sign, or durations, which are their nanoseconds.
fn is_number(kind: ElementaryType) -> bool {
    use ElementaryType::*;
    matches!(kind, Time | Ltime) || kind.integers().is_some() && !matches!(kind, Ulint | Lword)
}
