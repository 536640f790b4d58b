//! One scenario or many at once: the bits of a relay, a lane for each scenario.

use std::ops::{BitAnd, BitOr, BitXor, Not};

/// The same relay in each of the scenarios that run side by side.
pub trait Lanes:
    Copy
    + Eq
    + std::fmt::Debug
    + Send
    + Sync
    + 'static
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Not<Output = Self>
{
    /// How many scenarios there are.
    const COUNT: usize;
    /// Off in all of them.
    const NONE: Self;
    /// On in all of them.
    const ALL: Self;

    /// On in all or in none.
    #[inline]
    fn all(on: bool) -> Self {
        if on { Self::ALL } else { Self::NONE }
    }

    /// A mask of a [`Row`](super::Row), 0 or 0xFF, for all of them.
    fn spread(mask: u8) -> Self;

    /// Whether it is on in scenario number `lane`.
    fn lane(self, lane: usize) -> bool;

    /// The same but for scenario number `lane`.
    fn with(self, lane: usize, on: bool) -> Self;
}

impl Lanes for u8 {
    const COUNT: usize = 1;
    const NONE: u8 = 0;
    const ALL: u8 = 0xFF;

    #[inline]
    fn spread(mask: u8) -> u8 {
        mask
    }

    #[inline]
    fn lane(self, _lane: usize) -> bool {
        self != 0
    }

    #[inline]
    fn with(self, _lane: usize, on: bool) -> u8 {
        u8::all(on)
    }
}

impl Lanes for u64 {
    const COUNT: usize = 64;
    const NONE: u64 = 0;
    const ALL: u64 = u64::MAX;

    #[inline]
    fn spread(mask: u8) -> u64 {
        mask as i8 as i64 as u64
    }

    #[inline]
    fn lane(self, lane: usize) -> bool {
        self >> (lane & 63) & 1 == 1
    }

    #[inline]
    fn with(self, lane: usize, on: bool) -> u64 {
        let bit = 1 << (lane & 63);
        if on { self | bit } else { self & !bit }
    }
}
