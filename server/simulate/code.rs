//! What a program becomes before it runs: the contact table, and the steps between its pieces.

use super::adopting::Keepers;
use super::iec::Parts;
use super::row::{Cell, Row};
use super::{Lanes, Layout, Memory, Slot};
use crate::target::semantics::Deed;
use crate::target::{Device, DeviceKind, Execution, Fault, Form, Location, Operand, Target};
use crate::text::Span;
use smol_str::SmolStr;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

/// A program that is ready to run.
#[derive(Debug)]
pub struct Code {
    /// What it was compiled for.
    pub target: &'static Target,
    /// Where devices lie.
    pub layout: Arc<Layout>,
    pub(super) rows: Vec<Row>,
    pub(super) ops: Vec<Op>,
    /// The instruction that each op belongs to, a place among `places`.
    pub(super) op_places: Vec<u32>,
    /// The same of each row; only code that says what it sees knows it.
    pub(super) row_places: Vec<u32>,
    pub(super) calls: Vec<Call>,
    /// Words of memory in all, behind those of devices what instructions note.
    pub(super) slots: usize,
    /// The states of steps, for transfers out of them.
    pub(super) states: Vec<Vec<Cell>>,
    /// Where instructions stand.
    pub(super) places: Vec<Place>,
    /// The devices that the program names, but for special relays and registers.
    pub(super) devices: BTreeSet<Device>,
    /// Instructions and contacts in the text.
    pub(super) instructions: usize,
    /// The numbers of interrupts, and the ops at which their routines begin.
    pub(super) interrupts: Vec<(u32, u32)>,
    /// Labels, and the ops behind them.
    pub(super) labels: Vec<(Device, u32)>,
    /// Whether it has high-speed counters.
    pub(super) counts_pulses: bool,
    /// Timers that go on when the scan ends without their coils, see [`super::timing::routine_timer`].
    pub(super) routine_timers: Vec<Timer>,
    /// The instructions, as far as they keep something from scan to scan.
    pub(super) keepers: Keepers,
    /// Whether the order of execution is that of the text in every scan.
    pub(super) is_straight: bool,
    /// What programs in IEC 61131-3 have besides.
    pub(super) iec: Parts,
}

/// Where something of the program stands.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Place {
    /// The number of the document among those that were compiled.
    pub document: u32,
    /// Offsets into the document.
    pub span: Span,
}

impl Place {
    /// The start of the first document, for what has no place of its own.
    pub(super) const START: Place = Place { document: 0, span: Span { start: 0, end: 0 } };
}

/// A step of the program. Cells named `power` tell whether power reaches it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Op {
    /// Runs the rows from one to before the other.
    Rows(u32, u32),
    /// The coil of a timer.
    Timer { power: Cell, timer: Timer },
    /// The coil of a counter.
    Counter { power: Cell, counter: Counter },
    /// The coil of a high-speed counter, which lets it count pulses.
    HighSpeed { power: Cell, counter: Counter },
    /// RST of a timer, a counter or a register.
    Clear { power: Cell, device: Device },
    /// Executes an instruction.
    Execute { power: Cell, call: u32 },
    /// Finds whether a contact conducts that is more than a relay.
    Test { to: Cell, call: u32 },
    /// SET or OUT of a state in a step: the steps in which it stands are left.
    Transfer { power: Cell, state: Cell, list: u32 },
    /// Begins a step of the states in a list, with its rail; goes to `end` where it neither is active nor was.
    Step { rail: Cell, was: Cell, state: Cell, above: Cell, end: u32 },
    /// Goes on at another op.
    Jump { power: Cell, to: u32 },
    /// Goes on at another op until SRET.
    Call { power: Cell, to: u32 },
    /// SRET and IRET.
    Return,
    /// Executes the routines of interrupts that wait, where EI stands.
    Interrupt,
    /// Begins a loop whose number of rounds is the operand of a call; `next` is behind its end.
    For { call: u32, next: u32 },
    /// Ends the loop that began behind `first`.
    Next { first: u32 },
    /// A place where a contact was evaluated: it conducts as its relay says, and power behind it is in a cell, once it
    /// has come from the left rail.
    SeenContact { place: u32, src: Cell, invert: bool, power: Cell, rail: Cell },
    /// A place where power in a cell is what reaches an output, once it has come from the left rail.
    Seen { place: u32, power: Cell, rail: Cell },
    /// The CPU comes to an instruction of which nothing else is to be seen before it acts.
    Reached { place: u32 },
    /// Power in a cell is to be seen at an instruction at which nothing stops: it has come here, or left it.
    Shown { place: u32, power: Cell },
    /// The same, and an operand or the current result is a condition that holds as a relay says.
    ShownCondition { place: u32, src: Cell, invert: bool, power: Cell },
    /// Makes a calculation of an IEC 61131-3 program.
    Compute { power: Cell, number: u32 },
    /// Copies a value with parts.
    Copy { power: Cell, number: u32 },
    /// Calls a standard function block.
    Block { power: Cell, number: u32 },
    /// Gives the variables of a list their initial values.
    Initialise(u32),
    /// Finds whether a task runs in this scan.
    Task(u32),
    /// Ends the scan.
    End,
}

impl Op {
    /// Whether the next op may be another one than that behind it.
    pub(super) fn leads_elsewhere(self) -> bool {
        matches!(
            self,
            Op::Jump { .. }
                | Op::Call { .. }
                | Op::Return
                | Op::Interrupt
                | Op::For { .. }
                | Op::Next { .. }
                | Op::Step { .. }
        )
    }
}

/// The coil of a timer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Timer {
    pub(super) contact: Cell,
    pub(super) coil: Cell,
    /// The current value, in units; then nanoseconds beyond; then the scan in which it ran last.
    pub(super) current: Slot,
    pub(super) preset: Preset,
    /// What it counts, in milliseconds, at most 100.
    pub(super) unit_ms: u16,
    pub(super) is_retentive: bool,
    /// The relay that makes it count in 10 ms instead.
    pub(super) finer: Option<Cell>,
}

/// The coil of a counter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Counter {
    pub(super) contact: Cell,
    pub(super) coil: Cell,
    pub(super) current: Slot,
    pub(super) preset: Preset,
    /// For a counter of 32 bits the relay that is on while it counts down.
    pub(super) down: Option<Cell>,
}

/// The preset of a timer or counter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Preset {
    Constant(i64),
    /// A register, or a place where an instruction has noted it.
    Word(Slot),
    /// A register with the lower half of the number, and the one with the upper half.
    Pair(Slot, Slot),
}

impl Preset {
    /// The preset in a scenario.
    pub(super) fn value<L: Lanes>(self, memory: &Memory<L>, lane: usize) -> i64 {
        match self {
            Preset::Constant(value) => value,
            Preset::Word(slot) => memory.word(slot, lane),
            Preset::Pair(lower, upper) => {
                let (lower, upper) = (memory.word(lower, lane) as u16, memory.word(upper, lane) as i32);
                i64::from(upper << 16 | i32::from(lower))
            }
        }
    }
}

/// An instruction with its operands.
#[derive(Debug)]
pub(super) struct Call {
    pub(super) form: Form,
    pub(super) operands: Vec<Operand>,
    /// The words of operands that are text.
    pub(super) texts: Vec<SmolStr>,
    /// The first slot of what it notes.
    pub(super) notes: Slot,
    /// Whether it had power when the CPU came to it last.
    pub(super) was: Cell,
    /// Whether it is executed with power and without.
    pub(super) is_always: bool,
    pub(super) code: CallCode,
}

/// The code of an instruction by what it is asked for.
#[derive(Clone, Copy)]
pub(super) enum CallCode {
    Deed(Deed),
    Test(fn(&mut dyn Execution) -> Result<bool, Fault>),
}

impl std::fmt::Debug for CallCode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            CallCode::Deed(_) => "Deed",
            CallCode::Test(_) => "Test",
        })
    }
}

impl Code {
    /// Instructions and contacts in the text, whatever they became.
    pub fn instructions(&self) -> usize {
        self.instructions
    }

    /// Whether every scan executes the program from the first to the last instruction, so that many scenarios can run
    /// side by side.
    pub fn is_straight(&self) -> bool {
        self.is_straight
    }

    /// The instructions, by the numbers that [`Sight`](super::Sight) gives them, that may stand in a window of a
    /// document.
    pub fn instructions_in(&self, document: u32, window: Range<usize>) -> Range<u32> {
        // Within a drawn rung the order of execution is not that of the text.
        let is_within =
            |place: &Place| place.document == document && window.contains(&(place.span.start as usize));
        let first = self.places.iter().position(is_within).unwrap_or(0);
        let end = self.places.iter().rposition(is_within).map_or(first, |last| last + 1);
        first as u32..end as u32
    }

    /// The cells of input terminals, or of outputs, in rows.
    pub(super) fn terminals(&self, location: Location) -> Vec<Range<usize>> {
        let kind = match location {
            Location::Input => DeviceKind::X,
            Location::Output => DeviceKind::Y,
            Location::Memory => return Vec::new(),
        };
        match self.target.is_fx() {
            true => vec![self.layout.terminals(kind)],
            false => self.iec.cells(location),
        }
    }

    /// How deep calls may nest. Units in IEC 61131-3 do not call themselves, so there nothing limits them.
    pub(super) fn most_calls(&self) -> usize {
        if self.target.is_fx() { self.target.limits.calls as usize } else { usize::MAX }
    }

    /// The instructions at which a debugger can stop, by their numbers, with their places in the order of the code.
    pub fn stops(&self) -> impl Iterator<Item = (u32, Place)> {
        let numbers = self.ops.iter().filter_map(|op| match op {
            Op::Seen { place, .. } | Op::SeenContact { place, .. } | Op::Reached { place } => Some(*place),
            _ => None,
        });
        numbers.filter_map(|number| Some((number, *self.places.get(number as usize)?)))
    }

    /// Where the instructions stand that code which says what it sees tells of, by their numbers.
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// The instructions that tell whether a condition holds, by their numbers, in the order of the code.
    pub fn conditions(&self) -> impl Iterator<Item = u32> {
        self.ops.iter().filter_map(|op| match op {
            Op::SeenContact { place, .. } | Op::ShownCondition { place, .. } => Some(*place),
            _ => None,
        })
    }

    /// The labels of an FX program.
    pub(super) fn labels(&self) -> impl Iterator<Item = Device> {
        self.labels.iter().map(|(label, _)| *label)
    }

    /// The first instructions of a routine, by its label, or of the bodies of a program unit of IEC 61131-3, by their
    /// numbers; letter case is no matter.
    pub fn entries(&self, name: &str) -> Vec<u32> {
        let number = |op: &Op| match op {
            Op::Seen { place, .. } | Op::SeenContact { place, .. } | Op::Reached { place } => Some(*place),
            _ => None,
        };
        if !self.target.is_fx() {
            let names = self.iec.names();
            let firsts: Vec<u32> =
                names.scopes_of(name).map(|scope| names.instructions_of(scope).start).collect();
            let behind = |first: u32| self.stops().map(|(number, _)| number).find(|number| *number >= first);
            return firsts.into_iter().filter_map(behind).collect();
        }
        let own = self.labels.iter().filter(|(label, _)| label.to_string().eq_ignore_ascii_case(name));
        own.filter_map(|(_, op)| self.ops[*op as usize..].iter().find_map(number)).collect()
    }

    /// Where the op stands in the text.
    pub(super) fn place(&self, op: usize) -> Option<Place> {
        self.places.get(*self.op_places.get(op)? as usize).copied()
    }
}
