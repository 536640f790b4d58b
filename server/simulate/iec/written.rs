//! What the ops of IEC 61131-3 programs write.

use super::kind::Extent;
use super::parts::{Lies, Parts, Spot};
use super::run::offset;
use crate::simulate::code::Op;
use crate::simulate::{Cell, Memory};
use std::ops::Range;

/// Where an op writes with the subscripts and the power that a memory has, or wherever it ever may if none is given.
type Now<'m> = Option<&'m Memory<u8>>;

/// A stretch of memory: of the cells, of the bits of words, or of the texts.
#[derive(PartialEq, Debug)]
enum Ground {
    Cells,
    Words,
    Texts,
}

const BITS_OF_WORD: u64 = 64;

impl Parts {
    /// Whether an op writes something of what lies at a place.
    pub(in crate::simulate) fn is_written(&self, op: Op, wanted: Spot, now: Now<'_>) -> bool {
        let has_power = |power: Cell| now.is_none_or(|memory| memory.bit(power, 0));
        let wanted = region(wanted.lies);
        let meets = |to: &Spot| {
            self.reach(to.index, now).is_some_and(|(least, most)| {
                let (ground, to) = region(to.lies);
                let own = to.start + on(&ground, least)..to.end + on(&ground, most);
                ground == wanted.0 && overlap(&own, &wanted.1)
            })
        };
        match op {
            Op::Compute { power, number } => self.computings.get(number as usize).is_some_and(|computing| {
                has_power(power) && meets(&computing.to)
                    || computing.ok.is_some_and(|ok| meets(&Spot::of_cell(ok)))
            }),
            Op::Copy { power, number } => self.copies.get(number as usize).is_some_and(|copying| {
                let (at, index) = copying.to;
                has_power(power)
                    && self.reach(index, now).is_some_and(|(least, most)| {
                        let (first, end) = (at.plus(least), at.plus(most).plus(copying.size));
                        overlap(&(on(&wanted.0, first)..on(&wanted.0, end)), &wanted.1)
                    })
            }),
            Op::Block { power, number } => {
                let call = self.blocks.get(number as usize);
                call.is_some_and(|call| has_power(power) && call.outputs.iter().any(meets))
            }
            Op::Initialise(list) => {
                let own = self.initials.get(list as usize).into_iter().flatten();
                own.into_iter().any(|(to, _)| meets(to))
            }
            _ => false,
        }
    }

    /// How far subscripts lead, at least and at most. Nothing if they are out of bounds.
    fn reach(&self, index: u32, now: Now<'_>) -> Option<(Extent, Extent)> {
        if let Some(memory) = now {
            return offset(memory, self, index, 0).map(|at| (at, at));
        }
        let subscripts = index.checked_sub(1).and_then(|number| self.indices.get(number as usize));
        let most = subscripts.into_iter().flatten().fold(Extent::default(), |most, subscript| {
            most.plus(subscript.stride.times((subscript.greatest - subscript.least) as u64))
        });
        Some((Extent::default(), most))
    }
}

fn region(lies: Lies) -> (Ground, Range<u64>) {
    let (ground, first, count) = match lies {
        Lies::Cell(cell) => (Ground::Cells, u64::from(cell), 1),
        Lies::Bits(first, count) => (Ground::Cells, u64::from(first), u64::from(count)),
        Lies::Word(slot) => (Ground::Words, u64::from(slot) * BITS_OF_WORD, BITS_OF_WORD),
        Lies::Part(slot, shift, count) => {
            (Ground::Words, u64::from(slot) * BITS_OF_WORD + u64::from(shift), u64::from(count))
        }
        Lies::Text(slot, _) => (Ground::Texts, u64::from(slot), 1),
    };
    (ground, first..first + count)
}

/// What an extent is on a ground.
fn on(ground: &Ground, at: Extent) -> u64 {
    match ground {
        Ground::Cells => u64::from(at.cells),
        Ground::Words => u64::from(at.words) * BITS_OF_WORD,
        Ground::Texts => u64::from(at.texts),
    }
}

fn overlap(own: &Range<u64>, other: &Range<u64>) -> bool {
    own.start < other.end && other.start < own.end
}
