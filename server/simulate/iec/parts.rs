//! What code of IEC 61131-3 programs has besides rows and steps: calculations, places of values, calls of blocks.

use super::kind::Extent;
use super::names::{Leaf, Names};
use super::quick::Quick;
use crate::simulate::{Cell, Slot};
use crate::target::Location;
use crate::target::iec::{Datum, ElementaryType, Formula, FunctionBlock};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::ops::Range;

/// The parts of a program, which its ops name by number.
#[derive(Debug, Default)]
pub(in crate::simulate) struct Parts {
    pub(super) computings: Vec<Computing>,
    pub(super) indices: Vec<Vec<Index>>,
    /// The least and the greatest numbers of subranges.
    pub(super) ranges: Vec<(i128, i128)>,
    pub(super) copies: Vec<Copying>,
    pub(super) blocks: Vec<BlockCall>,
    /// The first list has the initial values of the program; others are those of units that begin anew at each call.
    pub(super) initials: Vec<Vec<(Spot, Datum)>>,
    pub(super) tasks: Vec<Task>,
    /// Current results before instructions, by the numbers of these.
    pub(super) results: FxHashMap<u32, (Input, ElementaryType)>,
    /// Texts of memory in all.
    pub(in crate::simulate) texts: usize,
    pub(super) names: Names,
}

/// A calculation: the result of a formula goes to a place.
#[derive(Debug)]
pub(super) struct Computing {
    /// The shorter way for whole numbers.
    pub(super) quick: Option<Quick>,
    pub(super) formula: Formula,
    pub(super) inputs: Vec<Input>,
    pub(super) kinds: Vec<ElementaryType>,
    pub(super) result: ElementaryType,
    pub(super) to: Spot,
    /// The relay that tells whether it was done and went well.
    pub(super) ok: Option<Cell>,
}

/// What a calculation is made with.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Input {
    Constant(Datum),
    At(Spot),
}

/// Where an elementary value is.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Spot {
    /// The type of the value.
    pub(in crate::simulate) kind: ElementaryType,
    pub(in crate::simulate) lies: Lies,
    /// The subscripts that are known at run time only, a place among the indices and 1; 0 for none.
    pub(in crate::simulate) index: u32,
    /// The subrange that it is of, a place among the ranges and 1; 0 for none.
    pub(super) range: u32,
}

/// Where something lies in memory.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Lies {
    /// A BOOL.
    Cell(Cell),
    /// Numbers and times as they are, without a sign in 64 bits; reals as IEEE 754 double; dates with times in
    /// microseconds.
    Word(Slot),
    /// A text of at most so many characters.
    Text(Slot, u32),
    /// Bits in cells, the lowest one first.
    Bits(Cell, u8),
    /// So many bits of a word, from one on.
    Part(Slot, u8, u8),
}

/// A subscript: its value is in a word.
#[derive(Clone, Copy, Debug)]
pub(super) struct Index {
    pub(super) word: Slot,
    pub(super) least: i64,
    pub(super) greatest: i64,
    /// From one element to the next.
    pub(super) stride: Extent,
}

/// A copy of a value with parts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Copying {
    pub(super) from: (Extent, u32),
    pub(super) to: (Extent, u32),
    pub(super) size: Extent,
}

/// A call of a standard block.
#[derive(Debug)]
pub(super) struct BlockCall {
    pub(super) block: &'static FunctionBlock,
    /// Where inputs and outputs lie, then the first word of what it notes.
    pub(super) inputs: Vec<Spot>,
    pub(super) outputs: Vec<Spot>,
    pub(super) notes: Slot,
    pub(super) index: u32,
}

/// A task: in which scans its programs run.
#[derive(Debug)]
pub(super) struct Task {
    /// Nothing for a task that runs on an edge only.
    pub(super) interval_ns: Option<i64>,
    /// When it is to run next.
    pub(super) next: Slot,
    /// What an edge starts it, and what that was.
    pub(super) single: Option<(Spot, Cell)>,
    /// On in the scans in which it runs.
    pub(super) due: Cell,
}

impl Parts {
    /// What a name leads to.
    pub(in crate::simulate) fn find(&self, name: &str) -> Option<Leaf> {
        self.names.find(name)
    }

    /// What names mean.
    pub(in crate::simulate) fn names(&self) -> &Names {
        &self.names
    }

    /// The names of variables that are worth watching.
    pub(in crate::simulate) fn watched(&self) -> Vec<String> {
        self.names.watched()
    }

    /// The name of what lies at a place.
    pub(in crate::simulate) fn name_of(&self, spot: Spot) -> Option<String> {
        self.names.name_at(spot)
    }

    /// The name of a value of an enumerated type.
    pub(in crate::simulate) fn name_of_value(&self, enumeration: u32, value: i128) -> Option<&SmolStr> {
        self.names.name_of(enumeration, value)
    }

    /// The value of an enumerated type with a name.
    pub(in crate::simulate) fn value_named(&self, enumeration: u32, name: &str) -> Option<i128> {
        self.names.value_of(enumeration, name)
    }

    /// The numbers that a subrange has; nothing for a value of a whole type.
    pub(in crate::simulate) fn range(&self, spot: Spot) -> Option<(i128, i128)> {
        self.ranges.get((spot.range as usize).checked_sub(1)?).copied()
    }

    /// The cells of a location, in rows.
    pub(in crate::simulate) fn cells(&self, location: Location) -> Vec<Range<usize>> {
        self.names.image.cells(location)
    }
}

impl Spot {
    /// A value of a type at a place that is known.
    pub(super) fn new(kind: ElementaryType, lies: Lies) -> Spot {
        Spot { kind, lies, index: 0, range: 0 }
    }

    /// A BOOL in a cell.
    pub(in crate::simulate) fn of_cell(cell: Cell) -> Spot {
        Spot::new(ElementaryType::Bool, Lies::Cell(cell))
    }
}
