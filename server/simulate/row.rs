//! The contact table: contacts, blocks and coils without a branch for the processor to guess.

use super::Lanes;

/// How many cells there are: relays, contacts of timers and counters, and what the program needs besides. A fixed
/// number of which every index is one, so that no access has a bound to check.
pub const CELLS: usize = 1 << 16;

/// The number of a cell.
pub type Cell = u16;

/// One step of power: `w = cell[src] ^ invert; power = power & (w & and | keep) | w & take; cell[dst] = power`.
///
/// LD takes, AND has `and` alone, OR keeps and takes. Where nothing is to be written, `dst` is [`Row::SINK`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Row {
    pub(super) src: Cell,
    pub(super) dst: Cell,
    invert: u8,
    and: u8,
    keep: u8,
    take: u8,
}

impl Row {
    /// The cell that nobody reads.
    pub const SINK: Cell = 0;
    /// The cell that is always on: the left rail.
    pub const RAIL: Cell = 1;
    /// The cell that is always off.
    pub const OFF: Cell = 2;

    const fn new(src: Cell, invert: bool, [and, keep, take]: [u8; 3]) -> Row {
        let invert = if invert { 0xFF } else { 0 };
        Row { src, dst: Row::SINK, invert, and, keep, take }
    }

    /// Power is what the contact passes from the rail.
    pub const fn load(src: Cell, invert: bool) -> Row {
        Row::new(src, invert, [0, 0, 0xFF])
    }

    /// The contact is in series with what was before.
    pub const fn and(src: Cell, invert: bool) -> Row {
        Row::new(src, invert, [0xFF, 0, 0])
    }

    /// The contact is in parallel with what was before.
    pub const fn or(src: Cell, invert: bool) -> Row {
        Row::new(src, invert, [0, 0xFF, 0xFF])
    }

    /// Power stays as it is.
    pub const fn keep() -> Row {
        Row::new(Row::RAIL, false, [0, 0xFF, 0])
    }

    /// The same, and writes power to `dst`.
    pub const fn to(self, dst: Cell) -> Row {
        Row { dst, ..self }
    }
}

/// Runs rows one after the other.
#[inline]
pub fn run<L: Lanes>(rows: &[Row], cells: &mut [L; CELLS]) {
    let mut power = L::NONE;
    for row in rows {
        let contact = cells[usize::from(row.src)] ^ L::spread(row.invert);
        let passes = contact & L::spread(row.and) | L::spread(row.keep);
        power = power & passes | contact & L::spread(row.take);
        cells[usize::from(row.dst)] = power;
    }
}
