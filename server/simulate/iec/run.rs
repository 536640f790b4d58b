//! Runs what IEC 61131-3 programs have besides rows: each scenario by itself.

use super::kind::Extent;
use super::parts::{BlockCall, Computing, Copying, Index, Input, Lies, Parts, Spot};
use crate::simulate::{Cell, Lanes, Memory, Slot};
use crate::target::Fault;
use crate::target::iec::semantics::{NOTES, range_of};
use crate::target::iec::{Datum, ElementaryType, Inputs, Instance};
use smol_str::SmolStr;
use std::ops::RangeInclusive;

/// A value as a word of memory has it, see [`Lies::Word`].
pub(super) fn packed(value: &Datum, kind: ElementaryType) -> i64 {
    use ElementaryType::*;
    match kind {
        Real | Lreal => value.real().to_bits() as i64,
        DateAndTime | LdateAndTime => value.whole().div_euclid(NS_OF_MICROSECOND) as i64,
        _ => value.whole() as i64,
    }
}

/// The value that a word of memory has.
pub(super) fn unpacked(word: i64, kind: ElementaryType) -> Datum {
    use ElementaryType::*;
    match kind {
        Real | Lreal => Datum::Real(f64::from_bits(word as u64)),
        DateAndTime | LdateAndTime => Datum::Whole(i128::from(word) * NS_OF_MICROSECOND),
        Ulint | Lword => Datum::Whole(i128::from(word as u64)),
        _ => Datum::Whole(i128::from(word)),
    }
}

const NS_OF_MICROSECOND: i128 = 1000;

/// Memory and what leads into it, in one scenario.
struct Store<'m, L> {
    memory: &'m mut Memory<L>,
    parts: &'m Parts,
    lane: usize,
}

/// How far subscripts lead on; nothing if one is out of its bounds.
pub(super) fn offset<L: Lanes>(memory: &Memory<L>, parts: &Parts, index: u32, lane: usize) -> Option<Extent> {
    let Some(number) = index.checked_sub(1) else { return Some(Extent::default()) };
    let subscripts = parts.indices.get(number as usize)?;
    subscripts.iter().try_fold(Extent::default(), |offset, subscript: &Index| {
        let value = memory.word(subscript.word, lane);
        let is_within = (subscript.least..=subscript.greatest).contains(&value);
        is_within.then(|| offset.plus(subscript.stride.times((value - subscript.least) as u64)))
    })
}

fn moved<L: Lanes>(memory: &Memory<L>, parts: &Parts, spot: Spot, lane: usize) -> Option<Lies> {
    if spot.index == 0 {
        return Some(spot.lies);
    }
    let offset = offset(memory, parts, spot.index, lane)?;
    Some(match spot.lies {
        Lies::Cell(cell) => Lies::Cell(cell + offset.cells as Cell),
        Lies::Word(slot) => Lies::Word(slot + offset.words),
        Lies::Text(slot, length) => Lies::Text(slot + offset.texts, length),
        Lies::Bits(first, count) => Lies::Bits(first + offset.cells as Cell, count),
        Lies::Part(slot, shift, count) => Lies::Part(slot + offset.words, shift, count),
    })
}

/// What a place has in a scenario; nothing where a subscript is out of bounds.
pub(in crate::simulate) fn read<L: Lanes>(
    memory: &Memory<L>,
    parts: &Parts,
    spot: Spot,
    lane: usize,
) -> Option<Datum> {
    Some(match moved(memory, parts, spot, lane)? {
        Lies::Cell(cell) => Datum::from(memory.bit(cell, lane)),
        Lies::Word(slot) => unpacked(memory.word(slot, lane), spot.kind),
        Lies::Text(slot, _) => Datum::Text(memory.text(slot, lane).clone()),
        Lies::Bits(first, count) => {
            let bits = (0..count).map(|bit| memory.bit(first + Cell::from(bit), lane));
            of_pattern(bits.rev().fold(0, |pattern, on| pattern << 1 | u64::from(on)), spot.kind)
        }
        Lies::Part(slot, shift, count) => {
            let pattern = memory.word(slot, lane) as u64 >> shift;
            Datum::Whole(i128::from(pattern & mask(count)))
        }
    })
}

/// The current result before an instruction, with its type; nothing where there is none.
pub(in crate::simulate) fn result_before<L: Lanes>(
    memory: &Memory<L>,
    parts: &Parts,
    instruction: u32,
) -> Option<(Datum, ElementaryType)> {
    let (input, kind) = parts.results.get(&instruction)?;
    let value = match input {
        Input::Constant(value) => value.clone(),
        Input::At(spot) => read(memory, parts, *spot, 0)?,
    };
    Some((value, *kind))
}

impl<L: Lanes> Store<'_, L> {
    fn offset(&self, index: u32) -> Option<Extent> {
        offset(self.memory, self.parts, index, self.lane)
    }

    fn read(&self, spot: Spot) -> Option<Datum> {
        read(self.memory, self.parts, spot, self.lane)
    }

    /// Writes what the type holds of a value; whether that is all of it.
    fn write(&mut self, spot: Spot, value: Datum) -> Result<(), Fault> {
        let lies = moved(self.memory, self.parts, spot, self.lane).ok_or(Fault::Index)?;
        let (value, is_all) = value.held(spot.kind);
        let range = self.parts.range(spot);
        let beyond = range.filter(|(least, greatest)| !(least..=greatest).contains(&&value.whole()));
        let value = match beyond {
            Some((least, greatest)) => Datum::Whole(value.whole().clamp(least, greatest)),
            None => value,
        };
        match lies {
            Lies::Cell(cell) => self.memory.set_bit(cell, self.lane, value.whole() != 0),
            Lies::Word(slot) => self.memory.set_word(slot, self.lane, packed(&value, spot.kind)),
            Lies::Text(slot, length) => {
                let text = match value.text().chars().nth(length as usize) {
                    // What there is no room for is cut off.
                    Some(_) => value.text().chars().take(length as usize).collect(),
                    None => SmolStr::from(value.text()),
                };
                self.memory.set_text(slot, self.lane, text);
            }
            Lies::Bits(first, count) => {
                let pattern = pattern_of(&value, spot.kind);
                for bit in 0..count {
                    self.memory.set_bit(first + Cell::from(bit), self.lane, pattern >> bit & 1 == 1);
                }
            }
            Lies::Part(slot, shift, count) => {
                let (before, mask) = (self.memory.word(slot, self.lane) as u64, mask(count) << shift);
                let pattern = (value.whole() as u64) << shift & mask;
                self.memory.set_word(slot, self.lane, (before & !mask | pattern) as i64);
            }
        }
        match (is_all, beyond) {
            (true, None) => Ok(()),
            (true, Some(_)) => Err(Fault::Subrange),
            (false, _) => Err(Fault::Overflow),
        }
    }
}

fn mask(bits: u8) -> u64 {
    if bits >= 64 { u64::MAX } else { (1 << bits) - 1 }
}

/// The bits of a value at an address.
fn pattern_of(value: &Datum, kind: ElementaryType) -> u64 {
    match kind {
        ElementaryType::Real => u64::from((value.real() as f32).to_bits()),
        _ => packed(value, kind) as u64,
    }
}

/// The value that bits at an address are.
pub(in crate::simulate) fn of_pattern(pattern: u64, kind: ElementaryType) -> Datum {
    match kind {
        ElementaryType::Real => Datum::Real(f64::from(f32::from_bits(pattern as u32))),
        ElementaryType::Lreal => Datum::Real(f64::from_bits(pattern)),
        _ => Datum::Whole(i128::from(pattern)).within(kind),
    }
}

/// Writes a place in all scenarios.
pub(in crate::simulate) fn put<L: Lanes>(memory: &mut Memory<L>, parts: &Parts, spot: Spot, value: &Datum) {
    for lane in 0..L::COUNT {
        // A value that the type does not hold is cut.
        let _ = Store { memory, parts, lane }.write(spot, value.clone());
    }
}

/// Runs a calculation in the scenarios in which it has power; `fault` is told what went wrong. What `values` had before
/// is no matter.
pub(in crate::simulate) fn compute<L: Lanes>(
    memory: &mut Memory<L>,
    parts: &Parts,
    number: u32,
    power: L,
    values: &mut Vec<Datum>,
    mut fault: impl FnMut(Fault, usize),
) {
    let Some(computing) = parts.computings.get(number as usize) else { return };
    for lane in (0..L::COUNT).filter(|lane| power.lane(*lane)) {
        let is_done = computing.quick.as_ref().is_some_and(|quick| quick.run(memory, lane));
        let done = match is_done {
            true => Ok(()),
            false => Store { memory, parts, lane }.computed(computing, values),
        };
        if let Some(ok) = computing.ok {
            memory.set_bit(ok, lane, done.is_ok());
        }
        if let Err(what) = done {
            fault(what, lane);
        }
    }
    if let Some(ok) = computing.ok {
        let on = memory.cell(ok);
        memory.set_cell(ok, on & power);
    }
}

impl<L: Lanes> Store<'_, L> {
    fn computed(&mut self, computing: &Computing, values: &mut Vec<Datum>) -> Result<(), Fault> {
        values.clear();
        let mut fault = None;
        for input in &computing.inputs {
            values.push(match input {
                Input::Constant(value) => value.clone(),
                Input::At(spot) => self.read(*spot).unwrap_or_else(|| {
                    fault = Some(Fault::Index);
                    Datum::default_of(spot.kind)
                }),
            });
        }
        let inputs = Inputs { values, kinds: &computing.kinds, result: computing.result };
        let result = match fault {
            Some(fault) => Err(fault),
            None => computing.formula.apply(&inputs),
        };
        let (result, is_all) = match result {
            Ok(result) => {
                let (held, is_all) = result.held(computing.result);
                let is_infinite = |value: &Datum| value.real().is_infinite();
                (held.clone(), is_all && (!is_infinite(&held) || inputs.values.iter().any(is_infinite)))
            }
            Err(what) => {
                fault = Some(what);
                (Datum::default_of(computing.result), true)
            }
        };
        let stored = self.write(computing.to, result);
        match fault {
            Some(fault) => Err(fault),
            None if !is_all => Err(Fault::Overflow),
            None => stored,
        }
    }
}

/// Copies a value with parts; false where a subscript is out of bounds.
pub(in crate::simulate) fn copy<L: Lanes>(
    memory: &mut Memory<L>,
    parts: &Parts,
    number: u32,
    power: L,
) -> bool {
    let Some(Copying { from, to, size }) = parts.copies.get(number as usize).copied() else { return true };
    let mut is_done = true;
    for lane in (0..L::COUNT).filter(|lane| power.lane(*lane)) {
        let store = Store { memory, parts, lane };
        let (Some(source), Some(target)) = (store.offset(from.1), store.offset(to.1)) else {
            is_done = false;
            continue;
        };
        let (source, target) = (from.0.plus(source), to.0.plus(target));
        let cells: Vec<bool> =
            (0..size.cells).map(|cell| memory.bit((source.cells + cell) as Cell, lane)).collect();
        for (cell, on) in (target.cells..).zip(cells) {
            memory.set_bit(cell as Cell, lane, on);
        }
        let words: Vec<i64> = (0..size.words).map(|word| memory.word(source.words + word, lane)).collect();
        for (word, value) in (target.words..).zip(words) {
            memory.set_word(word, lane, value);
        }
        let texts: Vec<SmolStr> =
            (0..size.texts).map(|text| memory.text(source.texts + text, lane).clone()).collect();
        for (text, value) in (target.texts..).zip(texts) {
            memory.set_text(text, lane, value);
        }
    }
    is_done
}

/// Writes the initial values of a list.
pub(in crate::simulate) fn initialise<L: Lanes>(memory: &mut Memory<L>, parts: &Parts, list: u32) {
    for (spot, value) in parts.initials.get(list as usize).into_iter().flatten() {
        put(memory, parts, *spot, value);
    }
}

/// Finds whether a task runs in the scan that begins at `now_ns`, and says so in its relay.
pub(in crate::simulate) fn schedule<L: Lanes>(
    memory: &mut Memory<L>,
    parts: &Parts,
    number: u32,
    now_ns: i64,
) {
    let Some(task) = parts.tasks.get(number as usize) else { return };
    let mut due = L::NONE;
    for lane in 0..L::COUNT {
        let store = Store { memory, parts, lane };
        let single = task.single.map(|(spot, was)| {
            let is_on = store.read(spot).is_some_and(|value| value.whole() != 0);
            let was_on = store.memory.bit(was, lane);
            store.memory.set_bit(was, lane, is_on);
            (is_on, was_on)
        });
        let is_edge = matches!(single, Some((true, false)));
        // While its trigger is on, time does not start it.
        let is_time = !matches!(single, Some((true, _)))
            && task.interval_ns.is_some_and(|interval| {
                let next = store.memory.word(task.next, lane);
                let is_time = now_ns >= next;
                if is_time {
                    // What came too late for a whole interval is left out.
                    let missed = (now_ns - next) / interval;
                    store.memory.set_word(task.next, lane, next + (missed + 1) * interval);
                }
                is_time
            });
        due = due.with(lane, is_edge || is_time);
    }
    memory.set_cell(task.due, due);
}

/// Calls a standard block; false where a subscript is out of bounds.
pub(in crate::simulate) fn call_block<L: Lanes>(
    memory: &mut Memory<L>,
    parts: &Parts,
    number: u32,
    power: L,
    now_ns: i64,
) -> bool {
    let Some(call) = parts.blocks.get(number as usize) else { return true };
    let mut is_done = true;
    for lane in (0..L::COUNT).filter(|lane| power.lane(*lane)) {
        let store = Store { memory, parts, lane };
        match store.offset(call.index) {
            Some(offset) => {
                (call.block.working)(&mut Called { store, call, notes: call.notes + offset.words, now_ns })
            }
            None => is_done = false,
        }
    }
    is_done
}

/// An instance that is called in one scenario.
struct Called<'m, L> {
    store: Store<'m, L>,
    call: &'m BlockCall,
    notes: Slot,
    now_ns: i64,
}

impl<L: Lanes> Instance for Called<'_, L> {
    fn input(&self, place: usize) -> i128 {
        self.call.inputs.get(place).and_then(|spot| self.store.read(*spot)).map_or(0, |value| value.whole())
    }

    fn output(&self, place: usize) -> i128 {
        self.call.outputs.get(place).and_then(|spot| self.store.read(*spot)).map_or(0, |value| value.whole())
    }

    fn set_output(&mut self, place: usize, value: i128) {
        if let Some(spot) = self.call.outputs.get(place) {
            // What its type does not hold is cut.
            let _ = self.store.write(*spot, Datum::Whole(value));
        }
    }

    fn noted(&self, place: usize) -> i64 {
        self.store.memory.word(self.notes + place.min(NOTES - 1) as Slot, self.store.lane)
    }

    fn note(&mut self, place: usize, value: i64) {
        self.store.memory.set_word(self.notes + place.min(NOTES - 1) as Slot, self.store.lane, value);
    }

    fn range(&self, place: usize) -> RangeInclusive<i128> {
        self.call.outputs.get(place).map_or(0..=0, |spot| range_of(spot.kind))
    }

    fn now_ns(&self) -> i64 {
        self.now_ns
    }
}
