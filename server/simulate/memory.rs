//! What the simulated PLC remembers.

use super::row::{CELLS, Cell};
use super::{Lanes, Slot};
use smol_str::SmolStr;
use std::ops::Range;

/// Relays and words of all scenarios that run side by side.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Memory<L> {
    pub(super) cells: Box<[L; CELLS]>,
    /// The words of slot 0 in all scenarios, then those of slot 1.
    words: Vec<i64>,
    /// The texts, likewise.
    texts: Vec<SmolStr>,
}

impl<L: Lanes> Memory<L> {
    /// Memory in which all is off, 0 and empty, of `slots` words and `texts` texts in each scenario.
    pub fn new(slots: usize, texts: usize) -> Memory<L> {
        let cells = vec![L::NONE; CELLS].into_boxed_slice();
        // The length is right, so nothing is lost.
        let cells = cells.try_into().unwrap_or_else(|_| Box::new([L::NONE; CELLS]));
        Memory { cells, words: vec![0; slots * L::COUNT], texts: vec![SmolStr::default(); texts * L::COUNT] }
    }

    /// The memory of the computer that it takes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.cells.as_slice())
            + size_of_val(self.words.as_slice())
            + size_of_val(self.texts.as_slice())
    }

    /// Takes relays and words over from a memory of the same layout.
    pub(super) fn keep(&mut self, from: &Memory<L>, cells: Range<usize>, slots: Range<usize>) {
        self.cells[cells.clone()].copy_from_slice(&from.cells[cells]);
        let words = slots.start * L::COUNT..slots.end * L::COUNT;
        self.words[words.clone()].copy_from_slice(&from.words[words]);
    }

    /// The relay in all scenarios.
    #[inline]
    pub fn cell(&self, cell: Cell) -> L {
        self.cells[usize::from(cell)]
    }

    /// Writes the relay in all scenarios.
    #[inline]
    pub fn set_cell(&mut self, cell: Cell, value: L) {
        self.cells[usize::from(cell)] = value;
    }

    /// The relay in one scenario.
    #[inline]
    pub fn bit(&self, cell: Cell, lane: usize) -> bool {
        self.cell(cell).lane(lane)
    }

    /// Writes the relay in one scenario.
    #[inline]
    pub fn set_bit(&mut self, cell: Cell, lane: usize, on: bool) {
        let value = self.cell(cell).with(lane, on);
        self.set_cell(cell, value);
    }

    /// The word in one scenario; 0 for a slot that there is not.
    #[inline]
    pub fn word(&self, slot: Slot, lane: usize) -> i64 {
        self.words.get(slot as usize * L::COUNT + lane).copied().unwrap_or(0)
    }

    /// Writes the word in one scenario.
    #[inline]
    pub fn set_word(&mut self, slot: Slot, lane: usize, value: i64) {
        if let Some(word) = self.words.get_mut(slot as usize * L::COUNT + lane) {
            *word = value;
        }
    }

    /// The text in one scenario; empty for a slot that there is not.
    pub fn text(&self, slot: Slot, lane: usize) -> &SmolStr {
        static EMPTY: SmolStr = SmolStr::new_static("");
        self.texts.get(slot as usize * L::COUNT + lane).unwrap_or(&EMPTY)
    }

    /// Writes the text in one scenario.
    pub fn set_text(&mut self, slot: Slot, lane: usize, value: SmolStr) {
        if let Some(text) = self.texts.get_mut(slot as usize * L::COUNT + lane) {
            *text = value;
        }
    }

    /// All words, those of a slot in all scenarios together.
    pub fn words(&self) -> &[i64] {
        &self.words
    }
}
