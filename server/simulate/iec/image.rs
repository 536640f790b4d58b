//! Direct addresses: the inputs, outputs and the memory of the simulated PLC.
//!
//! Words are counted by their own size: `%QW1` is `%QX2.0` to `%QX3.7`. Values without a size of their own (TIME,
//! dates) and addresses with more levels lie by themselves.

use super::kind::{Extent, Kind};
use super::parts::{Lies, Spot};
use crate::simulate::Cell;
use crate::target::iec::ElementaryType;
use crate::target::{DirectAddress, Location, Width};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// Where addresses lie, as far as the program names them.
#[derive(Clone, Debug, Default)]
pub(in crate::simulate) struct Image {
    /// 64 cells each, by the number of the first bit divided by 64.
    blocks: FxHashMap<(Location, u64), Cell>,
    /// What lies by itself.
    alone: FxHashMap<(DirectAddress, ElementaryType), Extent>,
    /// Addresses that the program names where it has no name for them.
    pub(in crate::simulate) named: BTreeSet<DirectAddress>,
}

/// So many bits lie side by side.
pub(super) const BLOCK: u64 = 64;

/// Memory that is given out.
pub(super) trait Ground {
    fn take(&mut self, size: Extent) -> Extent;
}

impl Image {
    /// Where a value of type `kind` lies at an address. Nothing if the address has another size, or none.
    pub(super) fn place(
        &mut self,
        address: DirectAddress,
        kind: ElementaryType,
        ground: &mut impl Ground,
    ) -> Option<Lies> {
        let (width, first) = (width(address.width), first_bit(address));
        address.path[0]?;
        match (first, kind.bits()) {
            (Some(first), Some(bits)) if bits == width => {
                let key = (address.location, first / BLOCK);
                let block = *self
                    .blocks
                    .entry(key)
                    .or_insert_with(|| ground.take(Extent::BIT.times(BLOCK)).cells as Cell);
                Some(in_block(block, first, bits))
            }
            (_, Some(bits)) if bits != width => None,
            _ => {
                let size = Kind::of(kind).size();
                let at = *self.alone.entry((address, kind)).or_insert_with(|| ground.take(size));
                Some(super::place::lies(at, kind, super::kind::TEXT_LENGTH))
            }
        }
    }

    /// Where an array lies from an address on: the cell of its first bit. Nothing if its elements have another size.
    pub(super) fn row(
        &mut self,
        address: DirectAddress,
        kind: &Kind,
        ground: &mut impl Ground,
    ) -> Option<Cell> {
        let (first, bits) = extent(address, kind)?;
        self.reserve(address.location, [(first, bits)], ground);
        let block = *self.blocks.get(&(address.location, first / BLOCK))?;
        Some(block.wrapping_add((first % BLOCK) as Cell))
    }

    /// Lets bits of a location, their first ones and how many they are, lie side by side as far as they belong
    /// together. What has its place keeps it.
    pub(super) fn reserve(
        &mut self,
        location: Location,
        rows: impl IntoIterator<Item = (u64, u64)>,
        ground: &mut impl Ground,
    ) {
        let blocks = rows.into_iter().map(|(first, bits)| (first / BLOCK, (first + bits.max(1) - 1) / BLOCK));
        let mut blocks: Vec<(u64, u64)> = blocks.collect();
        blocks.sort_unstable();
        blocks.dedup_by(|next, own| {
            let meet = next.0 <= own.1;
            own.1 = if meet { own.1.max(next.1) } else { own.1 };
            meet
        });
        for (first, last) in blocks {
            if self.blocks.contains_key(&(location, first)) {
                continue;
            }
            let cells = ground.take(Extent::BIT.times((last - first + 1).saturating_mul(BLOCK))).cells;
            for (block, cell) in (first..=last).zip((cells..).step_by(BLOCK as usize)) {
                self.blocks.insert((location, block), cell as Cell);
            }
        }
    }

    /// Where an address lies that the program has named, as the type that its size tells.
    pub(in crate::simulate) fn find(&self, address: DirectAddress) -> Option<Spot> {
        let (kind, first) = (kind_of(address.width), first_bit(address));
        let lies = match first {
            Some(first) => {
                let block = self.blocks.get(&(address.location, first / BLOCK))?;
                in_block(*block, first, width(address.width))
            }
            None => super::place::lies(*self.alone.get(&(address, kind))?, kind, 0),
        };
        Some(Spot::new(kind, lies))
    }

    /// The cells of a location, in blocks.
    pub(in crate::simulate) fn cells(&self, location: Location) -> Vec<std::ops::Range<usize>> {
        let own = self.blocks.iter().filter(|((of, _), _)| *of == location);
        let mut ranges: Vec<_> =
            own.map(|(_, first)| usize::from(*first)..usize::from(*first) + BLOCK as usize).collect();
        ranges.sort_unstable_by_key(|range| range.start);
        ranges
    }

    /// The addresses of blocks, with their first cells.
    pub(in crate::simulate) fn blocks(&self) -> impl Iterator<Item = ((Location, u64), Cell)> {
        self.blocks.iter().map(|(key, cell)| (*key, *cell))
    }
}

/// The first bit of an array at an address, and how many they are.
pub(super) fn extent(address: DirectAddress, kind: &Kind) -> Option<(u64, u64)> {
    let mut element = kind;
    while let Kind::Array(_, inner) = element {
        element = inner;
    }
    let first = first_bit(address).filter(|_| element.bits() == Some(u64::from(width(address.width))))?;
    // More than all cells is refused where memory is given out.
    kind.bits().filter(|bits| *bits <= MOST_BITS).map(|bits| (first, bits))
}

/// More bits do not lie at addresses.
const MOST_BITS: u64 = 1 << 16;

/// A value of so many bits from one on.
pub(super) fn in_block(block: Cell, first: u64, bits: u32) -> Lies {
    let cell = block.wrapping_add((first % BLOCK) as Cell);
    if bits == 1 { Lies::Cell(cell) } else { Lies::Bits(cell, bits as u8) }
}

/// The bits of an address.
fn width(width: Width) -> u32 {
    match width {
        Width::Bit => 1,
        Width::Byte => 8,
        Width::Word => 16,
        Width::Double => 32,
        Width::Long => 64,
    }
}

/// The bit string that an address is where nothing declares another type.
pub(super) fn kind_of(width: Width) -> ElementaryType {
    match width {
        Width::Bit => ElementaryType::Bool,
        Width::Byte => ElementaryType::Byte,
        Width::Word => ElementaryType::Word,
        Width::Double => ElementaryType::Dword,
        Width::Long => ElementaryType::Lword,
    }
}

/// The number of the first bit of an address among those of its location; nothing for those that lie by themselves.
fn first_bit(address: DirectAddress) -> Option<u64> {
    match (address.width, address.path) {
        (Width::Bit, [Some(byte), Some(bit @ 0..=7), None, None]) => {
            Some(u64::from(byte) * 8 + u64::from(bit))
        }
        (Width::Bit, _) => None,
        (size, [Some(number), None, None, None]) => Some(u64::from(number) * u64::from(width(size))),
        _ => None,
    }
}
