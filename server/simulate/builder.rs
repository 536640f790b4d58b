//! Builds code: contacts and blocks become rows of the contact table, whatever they were written in.

use super::adopting::{Keepers, print_of};
use super::code::{Call, CallCode, Code, Op, Place};
use super::iec::Parts;
use super::row::{CELLS, Cell, Row};
use super::{Layout, Obstacle, Slot};
use crate::ladder::ContactKind;
use crate::logic::{Term, Test};
use crate::target::semantics::NOTES;
use crate::target::{Device, DeviceKind, Form, Operand, Role, Semantics, Target};
use crate::text::Span;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Where a contact stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Position {
    /// It begins a rung or a block.
    First,
    /// Behind what was before.
    Series,
    /// Beside what was before.
    Parallel,
}

/// Where the current result is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Power {
    /// There is none.
    Nothing,
    /// Rows have it at hand.
    Register,
    /// It is in a cell of the rung's own.
    At(Cell),
    /// Both.
    Both(Cell),
}

/// Builds the code of a program, instruction by instruction.
pub(super) struct Builder {
    pub(super) target: &'static Target,
    pub(super) layout: Arc<Layout>,
    rows: Vec<Row>,
    /// The first row that no op runs yet.
    segment: usize,
    ops: Vec<Op>,
    op_places: Vec<u32>,
    calls: Vec<Call>,
    places: Vec<Place>,
    /// The present instruction, a place among `places`.
    now: u32,
    /// Which instruction each row belongs to, where that is watched.
    row_places: Vec<u32>,
    instructions: usize,
    devices: BTreeSet<Device>,
    slots: usize,
    keepers: Keepers,
    /// What edges of a relay from M2800 on share, by the relay.
    shared: FxHashMap<Cell, Cell>,
    power: Power,
    /// Whether the current result has passed the rail.
    is_from_rail: bool,
    /// The left rail.
    rail: Cell,
    /// The first cell of a rung's own, and the one behind those that it has.
    scratch: (usize, usize),
    /// The one behind those that any rung has.
    most_scratch: usize,
    /// The lowest cell that keeps something from scan to scan.
    kept: usize,
    /// Whether each instruction says what it saw.
    is_watched: bool,
    is_straight: bool,
}

impl Builder {
    pub(super) fn new(target: &'static Target, layout: Arc<Layout>, is_watched: bool) -> Builder {
        let (cells, slots) = (layout.cells(), layout.slots());
        Builder {
            target,
            layout,
            rows: Vec::new(),
            segment: 0,
            ops: Vec::new(),
            op_places: Vec::new(),
            calls: Vec::new(),
            places: Vec::new(),
            now: 0,
            row_places: Vec::new(),
            instructions: 0,
            devices: BTreeSet::new(),
            slots,
            keepers: Keepers::default(),
            shared: FxHashMap::default(),
            power: Power::Nothing,
            is_from_rail: false,
            rail: Row::RAIL,
            scratch: (cells, cells),
            most_scratch: cells,
            kept: CELLS,
            is_watched,
            is_straight: true,
        }
    }

    /// Says where in the text the next instruction stands, and how many of them it counts for.
    pub(super) fn at(&mut self, place: Place, instructions: usize) {
        self.now = self.places.len() as u32;
        self.places.push(place);
        self.keepers.begin(self.kept, self.slots);
        self.instructions += instructions;
    }

    /// Goes on with an instruction that others stand within, as in the parameters of a call.
    pub(super) fn again_at(&mut self, instruction: u32) {
        self.now = instruction;
    }

    /// Notes that the program names what stands in an operand.
    pub(super) fn names(&mut self, terms: &[Term]) {
        terms.iter().for_each(|term| self.is_like(print_of(&term.text)));
        let devices = terms.iter().filter_map(|term| term.operand.device());
        let own = devices.filter(|device| !device.is_special() && self.layout.has(*device));
        self.devices.extend(own);
    }

    /// Notes of the present instruction what tells it from others.
    pub(super) fn is_like(&mut self, print: u64) {
        self.keepers.mix(print);
    }

    /// Whether each instruction says what it saw.
    pub(super) fn is_watched(&self) -> bool {
        self.is_watched
    }

    /// Where the instruction of an op stands.
    pub(super) fn place_of(&self, op: u32) -> Place {
        let place = self.op_places.get(op as usize).and_then(|place| self.places.get(*place as usize));
        place.copied().unwrap_or(Place { document: 0, span: Span::at(0) })
    }

    /// Begins a rung: what cells the one before had are free.
    pub(super) fn rung(&mut self) {
        self.power = Power::Nothing;
        self.scratch.1 = self.scratch.0;
    }

    /// Goes on with cells that no rung before has, and that none behind the next such place gets: what is called in the
    /// middle of a rung leaves its cells alone.
    pub(super) fn routine(&mut self) {
        self.power = Power::Nothing;
        self.scratch = (self.most_scratch, self.most_scratch);
    }

    /// The number of the next op; rows before it have run.
    pub(super) fn here(&mut self) -> u32 {
        self.flush();
        self.ops.len() as u32
    }

    /// The op with this number, to say later where it goes.
    pub(super) fn op_mut(&mut self, op: u32) -> Option<&mut Op> {
        self.ops.get_mut(op as usize)
    }

    pub(super) fn finish(mut self) -> Result<Code, Obstacle> {
        self.op(Op::End);
        if self.kept <= self.most_scratch {
            return Err(Obstacle::TooLarge);
        }
        self.keepers.end(self.kept, self.slots);
        let counts_pulses = self.ops.iter().any(|op| matches!(op, Op::HighSpeed { .. }));
        Ok(Code {
            target: self.target,
            layout: self.layout,
            rows: self.rows,
            ops: self.ops,
            op_places: self.op_places,
            row_places: self.row_places,
            calls: self.calls,
            slots: self.slots,
            places: self.places,
            states: Vec::new(),
            interrupts: Vec::new(),
            labels: Vec::new(),
            counts_pulses,
            routine_timers: Vec::new(),
            keepers: self.keepers,
            instructions: self.instructions,
            iec: Parts::default(),
            devices: self.devices,
            is_straight: self.is_straight,
        })
    }

    /// Puts an op behind all rows so far; the current result is in a cell behind it. Gives its number.
    pub(super) fn op(&mut self, op: Op) -> u32 {
        self.flush();
        self.op_places.push(self.now);
        self.ops.push(op);
        self.is_straight &= !op.leads_elsewhere();
        self.ops.len() as u32 - 1
    }

    fn flush(&mut self) {
        if self.power != Power::Nothing {
            self.power = Power::At(self.power());
        }
        let (from, to) = (self.segment, self.rows.len());
        if from < to {
            self.segment = to;
            self.op_places.push(self.now);
            self.ops.push(Op::Rows(from as u32, to as u32));
        }
    }

    fn row(&mut self, row: Row) {
        self.rows.push(row);
        if self.is_watched {
            self.row_places.push(self.now);
        }
        self.power = Power::Register;
    }

    /// A cell that the rung has for itself.
    pub(super) fn scratch(&mut self) -> Cell {
        let cell = self.scratch.1;
        // Beyond the last cell the program is refused as too large.
        self.scratch.1 = (cell + 1).min(CELLS - 1);
        self.most_scratch = self.most_scratch.max(self.scratch.1);
        cell as Cell
    }

    /// A cell that keeps something from scan to scan.
    pub(super) fn kept(&mut self) -> Cell {
        self.kept = self.kept.saturating_sub(1).max(1);
        self.kept as Cell
    }

    /// So many cells side by side that keep something from scan to scan.
    pub(super) fn kept_row(&mut self, count: u32) -> u32 {
        self.kept = self.kept.saturating_sub(count as usize).max(1);
        self.kept as u32
    }

    /// So many words side by side.
    pub(super) fn words(&mut self, count: u32) -> Slot {
        let first = self.slots as Slot;
        self.slots = self.slots.saturating_add(count as usize);
        first
    }

    /// Where the present instruction stands.
    pub(super) fn here_place(&self) -> Place {
        self.places.get(self.now as usize).copied().unwrap_or(Place::START)
    }

    /// Lets the calculation that was put last be done with power from a cell only.
    pub(super) fn only_with(&mut self, cell: Cell) {
        if let Some(Op::Compute { power, .. }) = self.ops.last_mut() {
            *power = cell;
        }
    }

    /// The cell in which the current result is, which later rows leave alone.
    pub(super) fn power(&mut self) -> Cell {
        match self.power {
            Power::At(cell) | Power::Both(cell) => cell,
            Power::Nothing => self.rail,
            Power::Register => {
                let cell = self.scratch();
                self.write(cell);
                self.power = Power::Both(cell);
                cell
            }
        }
    }

    /// Goes on with power in a cell that has come from the rail.
    pub(super) fn set_power(&mut self, cell: Cell) {
        self.power = Power::At(cell);
        self.is_from_rail = true;
    }

    /// Goes on with no current result, as at the start of a block.
    pub(super) fn forget_power(&mut self) {
        self.power = Power::Nothing;
    }

    /// Whether a contact has begun the rung.
    pub(super) fn has_power(&self) -> bool {
        self.power != Power::Nothing
    }

    fn at_hand(&mut self) {
        match self.power {
            Power::Register | Power::Both(_) => {}
            Power::At(cell) => {
                self.row(Row::load(cell, false));
                self.power = Power::Both(cell);
            }
            Power::Nothing => self.row(Row::load(Row::RAIL, false)),
        }
    }

    /// Writes the current result, which is at hand, to a cell.
    fn write(&mut self, cell: Cell) {
        let segment = self.segment;
        match self.rows[segment..].last_mut() {
            Some(row) if row.dst == Row::SINK => row.dst = cell,
            _ => {
                let power = self.power;
                self.row(Row::keep().to(cell));
                self.power = power;
            }
        }
    }

    /// Puts a relay into the circuit.
    pub(super) fn connect(&mut self, position: Position, cell: Cell, is_inverse: bool) {
        match position {
            Position::First => {
                self.row(Row::load(cell, is_inverse));
                self.is_from_rail = false;
            }
            Position::Series => {
                self.at_hand();
                self.row(Row::and(cell, is_inverse));
            }
            Position::Parallel => {
                self.at_hand();
                self.row(Row::or(cell, is_inverse));
                self.is_from_rail = false;
            }
        }
    }

    /// Puts a contact into the circuit.
    pub(super) fn contact(&mut self, position: Position, test: Test, terms: &[Term]) -> Result<(), Obstacle> {
        self.is_like(print_of(&test));
        self.names(terms);
        let (cell, is_inverse) = match test {
            Test::Bit(kind) => {
                let cell = self.relay(terms)?;
                match kind {
                    ContactKind::NormallyOpen => (cell, false),
                    ContactKind::NormallyClosed => (cell, true),
                    ContactKind::Rising => (self.contact_edge(cell, true), false),
                    ContactKind::Falling => (self.contact_edge(cell, false), false),
                }
            }
            Test::Compare(_) => {
                let form = test.form().ok_or(Obstacle::Unreadable)?;
                (self.test(form, terms)?, false)
            }
        };
        self.connect(position, cell, is_inverse);
        self.saw_contact(cell, is_inverse);
        Ok(())
    }

    /// Says what a contact saw that was put into the circuit.
    pub(super) fn saw_contact(&mut self, src: Cell, invert: bool) {
        if self.is_watched {
            let power = self.power();
            let (place, rail) = (self.now, self.rail);
            self.op(Op::SeenContact { place, src, invert, power, rail });
        }
    }

    /// The cell of a relay of the PLC.
    pub(super) fn cell(&self, device: Device) -> Result<Cell, Obstacle> {
        let missing = || match self.layout.has(device) {
            // A register has no contact.
            true => Obstacle::Unreadable,
            false => Obstacle::NoDevice(device),
        };
        self.layout.cell(device).ok_or_else(missing)
    }

    /// The cell of the relay that a contact reads; of a bit of a word and an indexed one a copy.
    fn relay(&mut self, terms: &[Term]) -> Result<Cell, Obstacle> {
        let operand = terms.first().ok_or(Obstacle::Unreadable)?.operand;
        match operand {
            Operand::Device(device) => self.cell(device),
            Operand::WordBit { .. } | Operand::Indexed { .. } => {
                let form = Form::named("LD").ok_or(Obstacle::Unreadable)?;
                let call = self.call(form, terms, CallCode::Test(|execution| execution.bit(0, 0)))?;
                let to = self.scratch();
                self.op(Op::Test { to, call });
                Ok(to)
            }
            _ => Err(Obstacle::Unreadable),
        }
    }

    fn test(&mut self, form: Form, terms: &[Term]) -> Result<Cell, Obstacle> {
        let Semantics::Test(holds) = form.instruction.semantics else { return Err(Obstacle::Unreadable) };
        let call = self.call(form, terms, CallCode::Test(holds))?;
        let to = self.scratch();
        self.op(Op::Test { to, call });
        Ok(to)
    }

    /// The edge that a contact sees: of some relays the first one that is executed after the change, so that one signal
    /// takes a sequence on by one step.
    fn contact_edge(&mut self, cell: Cell, is_rising: bool) -> Cell {
        let device = self.layout.device_of_cell(cell);
        if !device.is_some_and(|device| device.shares_edges(self.target)) {
            return self.edge(cell, is_rising);
        }
        let before = match self.shared.get(&cell) {
            Some(before) => *before,
            None => self.kept(),
        };
        self.shared.insert(cell, before);
        self.edge_since(before, cell, is_rising)
    }

    /// A cell that is on for the scan in which a relay changes.
    pub(super) fn edge(&mut self, cell: Cell, is_rising: bool) -> Cell {
        let before = self.kept();
        self.edge_since(before, cell, is_rising)
    }

    /// The same with the cell that keeps what the relay was.
    fn edge_since(&mut self, before: Cell, cell: Cell, is_rising: bool) -> Cell {
        let power = self.power;
        let saved = (power != Power::Nothing).then(|| self.power());
        let edge = self.scratch();
        self.row(Row::load(cell, !is_rising));
        self.row(Row::and(before, is_rising).to(edge));
        self.row(Row::load(cell, false).to(before));
        self.power = saved.map_or(Power::Nothing, Power::At);
        edge
    }

    /// Finds the edge of an input: behind its cell lie what it was, and the edge.
    pub(super) fn edge_of_input(&mut self, input: Cell, is_rising: bool) {
        let (before, edge) = (input.saturating_add(1), input.saturating_add(2));
        self.row(Row::load(input, !is_rising));
        self.row(Row::and(before, is_rising).to(edge));
        self.row(Row::load(input, false).to(before));
        self.power = Power::Nothing;
    }

    /// Joins a block that was kept in a cell with the current result.
    pub(super) fn join(&mut self, block: Cell, position: Position) {
        self.connect(position, block, false);
        self.is_from_rail = false;
    }

    /// Turns the current result round.
    pub(super) fn invert(&mut self) {
        let power = self.power();
        self.row(Row::load(power, true));
        // Without power at the left rail there is none behind it, either.
        self.is_from_rail = false;
    }

    /// The left rail from here on.
    pub(super) fn set_rail(&mut self, rail: Cell) {
        self.rail = rail;
    }

    pub(super) fn rail(&self) -> Cell {
        self.rail
    }

    /// Power at an output: it has come from the rail.
    pub(super) fn settle(&mut self) -> Cell {
        if self.power == Power::Nothing {
            self.power = Power::At(self.rail);
        } else if self.rail != Row::RAIL && !self.is_from_rail {
            let rail = self.rail;
            self.connect(Position::Series, rail, false);
        }
        self.is_from_rail = true;
        self.power()
    }

    /// Says what reaches an output.
    pub(super) fn seen(&mut self) {
        if self.is_watched {
            let power = self.power();
            self.saw(power);
        }
    }

    /// The number of the present instruction among the places of the code.
    pub(super) fn instruction(&self) -> u32 {
        self.now
    }

    /// The number of the one that stands last.
    pub(super) fn last_instruction(&self) -> u32 {
        self.places.len().saturating_sub(1) as u32
    }

    /// Says that the CPU comes to the present instruction.
    pub(super) fn reached(&mut self) {
        if self.is_watched {
            let place = self.instruction();
            self.op(Op::Reached { place });
        }
    }

    /// Says what is in a cell at an instruction, where nothing stops.
    pub(super) fn shown(&mut self, place: u32, power: Cell) {
        if self.is_watched {
            self.op(Op::Shown { place, power });
        }
    }

    /// The same with a condition that holds as a relay says.
    pub(super) fn shown_condition(&mut self, place: u32, (src, invert): (Cell, bool), power: Cell) {
        if self.is_watched {
            self.op(Op::ShownCondition { place, src, invert, power });
        }
    }

    /// Says what is in a cell at the present instruction.
    pub(super) fn saw(&mut self, power: Cell) {
        let (place, rail) = (self.now, self.rail);
        self.op(Op::Seen { place, power, rail });
    }

    /// Drives relays with the current result.
    pub(super) fn out(&mut self, cell: Cell, is_inverse: bool) {
        if is_inverse {
            let power = self.settle();
            match self.rail {
                Row::RAIL => self.row(Row::load(power, true).to(cell)),
                rail => {
                    self.row(Row::load(power, true));
                    self.row(Row::and(rail, false).to(cell));
                }
            }
            self.power = Power::At(power);
            return;
        }
        // An output alone needs no cell for what it drives.
        if self.power == Power::Nothing || self.rail != Row::RAIL {
            self.settle();
        }
        self.is_from_rail = true;
        self.at_hand();
        self.write(cell);
    }

    pub(super) fn set(&mut self, cell: Cell) {
        let power = self.settle();
        self.at_hand();
        self.row(Row::or(cell, false).to(cell));
        self.power = Power::At(power);
    }

    pub(super) fn reset(&mut self, cell: Cell) {
        let power = self.settle();
        self.row(Row::load(power, true));
        self.row(Row::and(cell, false).to(cell));
        self.power = Power::At(power);
    }

    /// Drives a relay for one scan when power arrives, or leaves.
    pub(super) fn pulse(&mut self, cell: Cell, is_rising: bool) {
        let power = self.settle();
        let before = self.kept();
        self.row(Row::load(power, !is_rising));
        self.row(Row::and(before, is_rising).to(cell));
        self.row(Row::load(power, false).to(before));
        self.power = Power::Both(power);
    }

    /// The number of an instruction with these operands.
    pub(super) fn call(&mut self, form: Form, terms: &[Term], code: CallCode) -> Result<u32, Obstacle> {
        let operands: Vec<Operand> = terms.iter().map(|term| term.operand).collect();
        if let Some(device) = operands.iter().find_map(|operand| self.missing(operand)) {
            return Err(Obstacle::NoDevice(device));
        }
        let is_text = operands.contains(&Operand::Text);
        let texts =
            if is_text { terms.iter().map(|term| unquoted(&term.text)).collect() } else { Vec::new() };
        let notes = self.slots as Slot;
        self.slots += if form.instruction.role == Role::Output { NOTES } else { 0 };
        let was = self.kept();
        let is_always = !matches!(form.instruction.semantics, Semantics::Powered(_));
        self.calls.push(Call { form, operands, texts, notes, was, is_always, code });
        Ok(self.calls.len() as u32 - 1)
    }

    /// Where the instruction with this number notes something.
    pub(super) fn notes_of(&self, call: u32) -> Slot {
        self.calls.get(call as usize).map_or(0, |call| call.notes)
    }

    /// A device with a value that the PLC does not have.
    fn missing(&self, operand: &Operand) -> Option<Device> {
        let device = match *operand {
            Operand::Indexed { .. } => return None,
            Operand::Nibbles { index: Some(_), .. } => return None,
            ref other => other.device()?,
        };
        let has_value = !matches!(device.kind, DeviceKind::P | DeviceKind::I | DeviceKind::N);
        (has_value && !self.layout.has(device)).then_some(device)
    }
}

fn unquoted(word: &str) -> SmolStr {
    word.strip_prefix('"').and_then(|word| word.strip_suffix('"')).unwrap_or(word).into()
}
