//! What a PLC keeps when its program is edited while it runs.
//!
//! Code that does the same goes on as if nothing had happened. Otherwise devices keep their values, and instructions
//! that stand before and behind the edit what they remember: edges, steps, notes. What is new remembers what it finds
//! now, so that nothing happens merely because of an edit.

use super::clock::CLOCK_SLOTS;
use super::code::{Call, Code, Op};
use super::layout::{SCAN_SEEN, SLOTS_OF_TIMER};
use super::row::Cell;
use super::{Lanes, Machine, Memory, Slot, iec};
use crate::target::{DeviceKind, Form};
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};
use std::ops::Range;
use std::sync::Arc;

/// What the instructions of a program keep from scan to scan, in the order of the text.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct Keepers {
    list: Vec<Keeper>,
    end: (usize, usize),
}

/// An instruction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Keeper {
    /// Tells it from others: what it does, and its operands.
    print: u64,
    /// The lowest kept cell and the first free slot before it; cells are taken downwards.
    start: (usize, usize),
}

/// A number that tells things apart.
pub(super) fn print_of(what: &(impl Hash + ?Sized)) -> u64 {
    let mut hasher = FxHasher::default();
    what.hash(&mut hasher);
    hasher.finish()
}

/// The same for an instruction.
pub(super) fn print_of_form(form: Form) -> u64 {
    print_of(&(form.instruction.mnemonic, form.wide, form.pulse))
}

impl Keepers {
    /// An instruction begins; kept cells begin at `cell`, free slots at `slot`.
    pub(super) fn begin(&mut self, cell: usize, slot: usize) {
        self.list.push(Keeper { print: 0, start: (cell, slot) });
    }

    /// The present instruction has this besides.
    pub(super) fn mix(&mut self, print: u64) {
        if let Some(keeper) = self.list.last_mut() {
            keeper.print = print_of(&(keeper.print, print));
        }
    }

    /// The last instruction has ended.
    pub(super) fn end(&mut self, cell: usize, slot: usize) {
        self.end = (cell, slot);
    }

    /// The cells and slots that an instruction keeps.
    fn kept(&self, number: usize) -> (Range<usize>, Range<usize>) {
        let Some(keeper) = self.list.get(number) else { return (0..0, 0..0) };
        let end = self.list.get(number + 1).map_or(self.end, |next| next.start);
        (end.0..keeper.start.0, keeper.start.1..end.1)
    }

    fn is_same(&self, number: usize, other: &Keepers, other_number: usize) -> bool {
        let ((cells, slots), (other_cells, other_slots)) = (self.kept(number), other.kept(other_number));
        let is_like = self.list[number].print == other.list[other_number].print;
        is_like && cells.len() == other_cells.len() && slots.len() == other_slots.len()
    }

    /// For each instruction the one of `old` that it was, if it stands before or behind all that differs.
    fn known_in(&self, old: &Keepers) -> Vec<Option<usize>> {
        let (count, old_count) = (self.list.len(), old.list.len());
        let shared = count.min(old_count);
        let before = (0..shared).take_while(|number| self.is_same(*number, old, *number)).count();
        let behind = (1..=shared - before)
            .take_while(|back| self.is_same(count - back, old, old_count - back))
            .count();
        let known = |number: usize| match number {
            _ if number < before => Some(number),
            _ if number >= count - behind => Some(number + old_count - count),
            _ => None,
        };
        (0..count).map(known).collect()
    }
}

impl Code {
    /// Whether it does the same, whatever its text looks like, with the same memory.
    pub(super) fn does_the_same_as(&self, other: &Code) -> bool {
        let is_same = |(one, other): (&Call, &Call)| {
            (one.form, &one.operands, &one.texts, one.notes, one.was)
                == (other.form, &other.operands, &other.texts, other.notes, other.was)
        };
        self.target.is_fx()
            && self.has_layout_of(other)
            && self.keepers == other.keepers
            && self.rows == other.rows
            && self.ops == other.ops
            && self.states == other.states
            && self.interrupts == other.interrupts
            && self.slots == other.slots
            && self.calls.len() == other.calls.len()
            && self.calls.iter().zip(&other.calls).all(is_same)
    }

    /// Whether devices lie where they do in `other`.
    pub(super) fn has_layout_of(&self, other: &Code) -> bool {
        self.target.model == other.target.model
    }
}

impl<L: Lanes> Machine<L> {
    /// Goes on with other code for the same PLC, as the head of this file says. For another PLC it begins anew.
    pub fn adopt(&mut self, code: Arc<Code>) {
        if !self.code.has_layout_of(&code) {
            *self = Machine::new(code);
            return;
        }
        if !code.target.is_fx() {
            self.adopt_variables(code);
            return;
        }
        if self.code.does_the_same_as(&code) {
            self.set_code(code);
            return;
        }
        let known = code.keepers.known_in(&self.code.keepers);
        let mut memory = Memory::new(code.slots, 0);
        let layout = &code.layout;
        memory.cells[..layout.cells()].copy_from_slice(&self.memory.cells[..layout.cells()]);
        for slot in 0..layout.slots() {
            self.keep_slot(slot, &mut memory, slot);
        }
        for (number, old) in known.iter().enumerate() {
            let Some(old) = old else { continue };
            let ((old_cells, old_slots), (cells, slots)) =
                (self.code.keepers.kept(*old), code.keepers.kept(number));
            memory.cells[cells].copy_from_slice(&self.memory.cells[old_cells]);
            for (old_slot, slot) in old_slots.zip(slots) {
                self.keep_slot(old_slot, &mut memory, slot);
            }
        }
        self.memory = memory;
        self.set_code(code);
        self.seed(&known);
    }

    /// The PLC as it comes to RUN with this program: latched devices, special registers, the clock and what is wired to
    /// inputs stay as they are; the rest is off and 0. Of another model nothing stays.
    pub fn restarted(&self, code: Arc<Code>) -> Machine<L> {
        let mut new = Machine::new(Arc::clone(&code));
        if !self.code.has_layout_of(&code) || !code.target.is_fx() {
            return new;
        }
        let layout = &code.layout;
        for (kind, cells, slots) in layout.latched_runs() {
            new.memory.keep(&self.memory, cells, slots.clone());
            if kind == DeviceKind::T {
                // Scans are counted from 0 again.
                for timer in slots.step_by(SLOTS_OF_TIMER) {
                    let seen = timer as Slot + SCAN_SEEN;
                    (0..L::COUNT).for_each(|lane| new.memory.set_word(seen, lane, 0));
                }
            }
        }
        for register in layout.special_registers() {
            let (cells, slots) = layout.whole(register);
            new.memory.keep(&self.memory, cells, slots);
        }
        let clock = layout.clock() as usize;
        (clock..clock + CLOCK_SLOTS).for_each(|slot| self.keep_slot(slot, &mut new.memory, slot));
        new.terminals = new.terminals.wired_as(&self.terminals);
        new
    }

    /// Goes on with another program in IEC 61131-3: variables that have the same name and type keep their values.
    fn adopt_variables(&mut self, code: Arc<Code>) {
        let mut new = Machine::new(Arc::clone(&code));
        iec::adopt((&self.code.iec, &self.memory), (&code.iec, &mut new.memory));
        self.keep_forces(&code);
        let blocks = iec::blocks(&self.code.iec, &code.iec);
        let terminals = new.terminals.rewired(&self.terminals, &blocks);
        (self.memory, self.terminals) = (new.memory, terminals);
        self.set_code(code);
    }

    fn keep_slot(&self, from: usize, memory: &mut Memory<L>, to: usize) {
        for lane in 0..L::COUNT {
            memory.set_word(to as Slot, lane, self.memory.word(from as Slot, lane));
        }
    }

    /// Lets instructions that are not known from before remember what they find now: what they would after a scan that
    /// is run for this alone. A step may have been left just now, so it is executed once more to switch its coils off.
    fn seed(&mut self, known: &[Option<usize>]) {
        if self.scans() == 0 {
            return;
        }
        let mut trial = self.clone();
        trial.scan(self.now_ns());
        let code = Arc::clone(&self.code);
        let mut is_new = vec![false; self.memory.cells.len()];
        for number in (0..known.len()).filter(|number| known[*number].is_none()) {
            let (cells, _) = code.keepers.kept(number);
            is_new[cells.clone()].fill(true);
            self.memory.cells[cells.clone()].copy_from_slice(&trial.memory.cells[cells]);
        }
        let steps = code.ops.iter().filter_map(|op| match op {
            Op::Step { was, .. } => Some(*was),
            _ => None,
        });
        for was in steps.filter(|was: &Cell| is_new[usize::from(*was)]) {
            self.memory.set_cell(was, L::ALL);
        }
    }
}
