//! Goes on with another program: variables that are still there with the same type keep their values.

use super::parts::{Lies, Parts};
use super::run::{put, read};
use crate::simulate::{Cell, Lanes, Memory};
use rustc_hash::FxHashMap;

/// Takes the values of variables over from the memory of another program.
pub(in crate::simulate) fn adopt<L: Lanes>(old: (&Parts, &Memory<L>), new: (&Parts, &mut Memory<L>)) {
    let known: FxHashMap<_, _> = old.0.names.all().into_iter().collect();
    for (name, spot) in new.0.names.all() {
        let Some(before) = known.get(&name).filter(|before| before.kind == spot.kind) else { continue };
        match (before.lies, spot.lies) {
            (Lies::Cell(from), Lies::Cell(to)) => new.1.set_cell(to, old.1.cell(from)),
            (Lies::Word(from), Lies::Word(to)) => {
                (0..L::COUNT).for_each(|lane| new.1.set_word(to, lane, old.1.word(from, lane)));
            }
            _ => {
                if let Some(value) = read(old.1, old.0, *before, 0) {
                    put(new.1, new.0, spot, &value);
                }
            }
        }
    }
    for (from, to) in blocks(old.0, new.0) {
        new.1.set_cell(to, old.1.cell(from));
    }
}

/// The cells of addresses that both programs have: in the one, and in the other.
pub(in crate::simulate) fn blocks(old: &Parts, new: &Parts) -> Vec<(Cell, Cell)> {
    let known: FxHashMap<_, _> = old.names.image.blocks().collect();
    let both = new.names.image.blocks().filter_map(|(key, to)| Some((*known.get(&key)?, to)));
    both.flat_map(|(from, to)| (0..super::image::BLOCK as Cell).map(move |bit| (from + bit, to + bit)))
        .collect()
}
