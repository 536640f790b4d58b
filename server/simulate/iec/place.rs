//! Places of variables while a program is compiled.

use super::kind::{Extent, Kind};
use super::parts::{Lies, Spot};
use crate::simulate::Cell;
use crate::target::iec::ElementaryType;

/// A variable, or a part of one.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub(super) kind: Kind,
    pub(super) at: At,
    /// The subscripts that are known at run time only, as in [`Spot`].
    pub(super) index: u32,
    /// Whether it may be written.
    pub(super) is_constant: bool,
}

/// Where a place is.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum At {
    /// From here on.
    Memory(Extent),
    /// An array at an address, from this cell on: elements are as wide as their types.
    Image(Cell),
    /// At an address, or a part of a bit string.
    Other(Lies),
}

/// Where a value of an elementary type lies that begins at an extent.
pub(super) fn lies(at: Extent, kind: ElementaryType, length: usize) -> Lies {
    match kind {
        ElementaryType::Bool => Lies::Cell(at.cells as Cell),
        ElementaryType::String | ElementaryType::Wstring => Lies::Text(at.texts, length as u32),
        _ => Lies::Word(at.words),
    }
}

impl Place {
    pub(super) fn new(kind: Kind, at: Extent) -> Place {
        Place { kind, at: At::Memory(at), index: 0, is_constant: false }
    }

    /// The elementary value that it is; nothing for one with parts.
    pub(super) fn spot(&self) -> Option<Spot> {
        let kind = self.kind.elementary()?;
        let length = match self.kind {
            Kind::Elementary(_, length) => length,
            _ => 0,
        };
        let lies = match self.at {
            At::Memory(at) => lies(at, kind, length),
            At::Image(cell) => super::image::in_block(cell, 0, kind.bits()?),
            At::Other(lies) => lies,
        };
        let range = match self.kind {
            Kind::Subrange(_, range) => range,
            _ => 0,
        };
        Some(Spot { kind, lies, index: self.index, range })
    }

    /// The relay that it is; nothing where that is known at run time only.
    pub(super) fn cell(&self) -> Option<Cell> {
        match self.spot()? {
            Spot { kind: ElementaryType::Bool, lies: Lies::Cell(cell), index: 0, .. } => Some(cell),
            _ => None,
        }
    }

    /// Its part of this kind that begins so far behind its start.
    pub(super) fn part(&self, kind: Kind, behind: Extent) -> Option<Place> {
        let at = match self.at {
            At::Memory(at) => At::Memory(at.plus(behind)),
            At::Image(cell) => At::Image(cell.checked_add(Cell::try_from(behind.cells).ok()?)?),
            At::Other(_) => return None,
        };
        Some(Place { kind, at, ..self.clone() })
    }

    /// What a part of this kind takes where it lies.
    pub(super) fn size_of(&self, kind: &Kind) -> Extent {
        match self.at {
            At::Image(_) => Extent::BIT.times(kind.bits().unwrap_or(0)),
            _ => kind.size(),
        }
    }
}
