//! What instructions do while a PLC runs: the code of a row, and what it sees of the PLC.

use super::{Device, DeviceKind, Model, Outside};
use std::cmp::Ordering;
use std::fmt;

/// What an instruction does in a scan.
#[derive(Clone, Copy)]
pub enum Semantics {
    /// What its [`Role`](super::Role), its [`Flow`](super::Flow) and the [`Drive`](super::Drive) of its operand say:
    /// contacts, blocks, branches, coils, jumps.
    Basic,
    /// A contact that conducts while this holds.
    Test(fn(&mut dyn Execution) -> Result<bool, Fault>),
    /// Done in each scan in which it has power; the pulse form when power arrives.
    Powered(Deed),
    /// Done in each scan that comes to it, with power and without; it asks for its power.
    Always(Deed),
}

/// The code of an instruction. Where it gives a fault, it must have changed nothing.
pub type Deed = fn(&mut dyn Execution) -> Result<(), Fault>;

impl fmt::Debug for Semantics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Semantics::Basic => "Basic",
            Semantics::Test(_) => "Test",
            Semantics::Powered(_) => "Powered",
            Semantics::Always(_) => "Always",
        })
    }
}

/// Why the CPU does not execute an instruction. The scan goes on behind it, see [`Fault::code`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Fault {
    /// The divisor is 0.
    DivisionByZero,
    /// The operand at this place, from 0, names a device that the PLC does not have, by an index register or by the
    /// number of devices behind it.
    NoDevice(u8),
    /// The operand at this place, from 0, has a value that the instruction does not take.
    Value(u8),
    /// What comes out does not fit into the destination.
    Overflow,
    /// No special module answers.
    NoModule,
    /// A parameter of PID that the instruction does not take, or what it computes grows too large, with the error code.
    Pid(u16),
    /// A subscript of an array is outside of its bounds (IEC 61131-3 only).
    Index,
    /// A number is outside of the subrange that its variable is declared with (IEC 61131-3 only).
    Subrange,
    /// The simulator does not do what the operand at this place asks for, though a PLC does.
    NotSimulated(u8),
    /// HSZ with a table (M8130) or for a speed pattern (M8132), which the simulator does not do.
    TableMode,
    /// PID that tunes itself by a limit cycle, which the simulator does not do.
    LimitCycle,
}

impl Fault {
    /// The CPU's error code in D8067. Source: the error code list of the FX programming manuals: 6705 for devices that
    /// an applied instruction does not take, 6706 for their numbers and values, 6708 for FROM and TO,
    /// 6730 and up for PID.
    pub fn code(self) -> i64 {
        match self {
            Fault::NoDevice(_) => 6705,
            Fault::DivisionByZero
            | Fault::Value(_)
            | Fault::Overflow
            | Fault::Index
            | Fault::Subrange
            | Fault::NotSimulated(_)
            | Fault::TableMode
            | Fault::LimitCycle => 6706,
            Fault::NoModule => 6708,
            Fault::Pid(code) => i64::from(code),
        }
    }
}

/// An instruction that is being executed: its operands, by their places from 0, and what it may touch of the CPU.
///
/// Devices behind an operand are reached by an `offset`: D10 and offset 2 is D12, K1M0 and offset 2 is K1M8, M0 and
/// offset 2 is M2. Index registers are added before.
pub trait Execution {
    /// Whether it is written in the 32-bit form.
    fn is_wide(&self) -> bool;

    /// Whether power reaches it.
    fn power(&self) -> bool;

    /// Whether power reaches it and did not when the CPU came to it last.
    fn is_rising(&self) -> bool;

    /// How many operands are written.
    fn operands(&self) -> usize;

    /// The 16-bit word at an operand, signed: a constant, a register, the current value of a timer or counter, a group
    /// of bits. A constant has no offsets.
    fn word(&mut self, place: usize, offset: i64) -> Result<i64, Fault>;

    /// The same with 32 bits: a register and the one behind it, a 32-bit counter, a group of up to 32 bits.
    fn double(&mut self, place: usize, offset: i64) -> Result<i64, Fault>;

    /// Writes the lower 16 bits.
    fn set_word(&mut self, place: usize, offset: i64, value: i64) -> Result<(), Fault>;

    /// Writes the lower 32 bits.
    fn set_double(&mut self, place: usize, offset: i64, value: i64) -> Result<(), Fault>;

    /// A bit device, or a bit of a word (`D0.3`).
    fn bit(&mut self, place: usize, offset: i64) -> Result<bool, Fault>;

    /// Writes a bit device, or a bit of a word.
    fn set_bit(&mut self, place: usize, offset: i64, value: bool) -> Result<(), Fault>;

    /// The device that an operand names, index registers added: of a group of bits the first, of a bit of a word the
    /// word. Nothing for constants and text.
    fn device(&mut self, place: usize) -> Result<Option<Device>, Fault>;

    /// How many bits a group of bits (`K2M0` has 8) has; nothing for other operands.
    fn group_bits(&self, place: usize) -> Option<u32>;

    /// A real number: a pair of registers as IEEE 754 single, a constant as its number.
    fn real(&mut self, place: usize, offset: i64) -> Result<f64, Fault>;

    /// Writes a real number of single precision to a pair of registers.
    fn set_real(&mut self, place: usize, offset: i64, value: f64) -> Result<(), Fault>;

    /// The text of an operand, without its quotes.
    fn text(&self, place: usize) -> &str;

    /// A special relay, by its number from 8000.
    fn relay(&self, number: u32) -> bool;

    /// Writes a special relay.
    fn set_relay(&mut self, number: u32, on: bool);

    /// A special register, by its number from 8000.
    fn register(&self, number: u32) -> i64;

    /// Writes a special register.
    fn set_register(&mut self, number: u32, value: i64);

    /// Whether a relay is on, whatever the operands name; false for what is no relay of the PLC.
    fn is_on(&self, device: Device) -> bool;

    /// Sets the real-time clock: year (two digits, or four from 1980 to 2079), month, day, hour, minute, second, day of
    /// the week (0 is Sunday). False for what is no date or time, which changes nothing.
    fn set_clock(&mut self, clock: [i64; 7]) -> bool;

    /// Switches any device off, or to 0: of timers and counters the contact and the current value.
    fn clear(&mut self, device: Device) -> Result<(), Fault>;

    /// Switches the state of a step on.
    fn set_state(&mut self, number: u32);

    /// What the instruction noted at the same place in its memory, 0 at first. It has [`NOTES`] places, which are kept
    /// from scan to scan.
    fn noted(&self, cell: usize) -> i64;

    /// Notes a number for the next scans.
    fn note(&mut self, cell: usize, value: i64);

    /// Time since the CPU came to RUN, in nanoseconds, as sampled at the start of the scan.
    fn now_ns(&self) -> i64;

    /// Time between the starts of this scan and of the one before, in nanoseconds.
    fn scan_ns(&self) -> i64;

    /// Whether this is the first scan in RUN.
    fn is_first_scan(&self) -> bool;

    /// Copies `count` inputs from the first on to their relays, or such outputs to their terminals, at once.
    fn refresh(&mut self, first: Device, count: i64) -> Result<(), Fault>;

    /// The model of the PLC.
    fn model(&self) -> Model;

    /// What is around the CPU.
    fn outside(&mut self) -> &mut Outside;

    /// Allows interrupts, or no longer does.
    fn allow_interrupts(&mut self, are_allowed: bool);

    /// Restarts the watchdog.
    fn restart_watchdog(&mut self);
}

/// How many numbers an instruction can note, see [`Execution::noted`].
pub const NOTES: usize = 8;

/// Short forms for what most instructions do.
impl dyn Execution + '_ {
    /// The number at an operand in the width of the instruction.
    pub fn value(&mut self, place: usize) -> Result<i64, Fault> {
        if self.is_wide() { self.double(place, 0) } else { self.word(place, 0) }
    }

    /// Writes a number in the width of the instruction.
    pub fn put(&mut self, place: usize, value: i64) -> Result<(), Fault> {
        if self.is_wide() { self.set_double(place, 0, value) } else { self.set_word(place, 0, value) }
    }

    /// The numbers that the width of the instruction holds.
    pub fn limits(&self) -> (i64, i64) {
        match self.is_wide() {
            true => (i64::from(i32::MIN), i64::from(i32::MAX)),
            false => (i64::from(i16::MIN), i64::from(i16::MAX)),
        }
    }

    /// How many bits the numbers have.
    pub fn width(&self) -> u32 {
        if self.is_wide() { 32 } else { 16 }
    }

    /// The count at an operand, which lies in `least..=most`.
    pub fn count(&mut self, place: usize, least: i64, most: i64) -> Result<i64, Fault> {
        let count = self.value(place)?;
        if (least..=most).contains(&count) { Ok(count) } else { Err(Fault::Value(place as u8)) }
    }

    /// What is left of a number in the width of the instruction.
    pub fn wrapped(&self, number: i64) -> i64 {
        if self.is_wide() { i64::from(number as i32) } else { i64::from(number as i16) }
    }

    /// The numbers of a row of `count` from an operand on.
    pub fn values(&mut self, place: usize, count: i64) -> Result<Vec<i64>, Fault> {
        (0..count).map(|behind| self.value_at(place, behind)).collect()
    }

    /// Writes a row of numbers, or nothing where the PLC has not all of their places.
    pub fn put_values(&mut self, place: usize, values: &[i64]) -> Result<(), Fault> {
        // The last one is there only if all are.
        self.value_at(place, values.len().saturating_sub(1) as i64)?;
        (0..).zip(values).try_for_each(|(behind, value)| self.put_at(place, behind, *value))
    }

    /// The relays of a row of `count` from an operand on.
    pub fn relays(&mut self, place: usize, count: i64) -> Result<Vec<bool>, Fault> {
        (0..count).map(|offset| self.bit(place, offset)).collect()
    }

    /// Writes a row of relays, or nothing where the PLC has not all of them.
    pub fn set_relays(&mut self, place: usize, bits: &[bool]) -> Result<(), Fault> {
        self.bit(place, bits.len().saturating_sub(1) as i64)?;
        (0..).zip(bits).try_for_each(|(offset, bit)| self.set_bit(place, offset, *bit))
    }

    /// Switches on the first of three relays for greater, the second for equal, the third for less.
    pub fn answer(&mut self, place: usize, ordering: Ordering) -> Result<(), Fault> {
        self.set_relays(place, &[ordering.is_gt(), ordering.is_eq(), ordering.is_lt()])
    }

    /// Writes the flags of arithmetic: [`ZERO`], [`BORROW`], [`CARRY`].
    pub fn set_flags(&mut self, zero: bool, borrow: bool, carry: bool) {
        self.set_relay(ZERO, zero);
        self.set_relay(BORROW, borrow);
        self.set_relay(CARRY, carry);
    }
}

/// The numbers of instructions that go on over several scans.
impl dyn Execution + '_ {
    /// From one number of the instruction's width to the next behind an operand: 2 for a pair of registers.
    pub fn stride(&mut self, place: usize) -> Result<i64, Fault> {
        let is_one = !self.is_wide() || self.group_bits(place).is_some();
        let device = self.device(place)?;
        let is_wide_counter = device.is_some_and(|it| it.kind == DeviceKind::C && it.number >= 200);
        Ok(if is_one || is_wide_counter { 1 } else { 2 })
    }

    /// The number behind an operand, so many numbers of the instruction's width on.
    pub fn value_at(&mut self, place: usize, number: i64) -> Result<i64, Fault> {
        let offset = number * self.stride(place)?;
        if self.is_wide() { self.double(place, offset) } else { self.word(place, offset) }
    }

    /// Writes the number behind an operand, so many numbers of the instruction's width on.
    pub fn put_at(&mut self, place: usize, number: i64, value: i64) -> Result<(), Fault> {
        let offset = number * self.stride(place)?;
        if self.is_wide() {
            self.set_double(place, offset, value)
        } else {
            self.set_word(place, offset, value)
        }
    }

    /// Writes bits from an operand on, the lowest one first: all of them, or none.
    pub fn set_bits(&mut self, place: usize, offset: i64, count: i64, pattern: i64) -> Result<(), Fault> {
        self.bit(place, offset + count - 1)?;
        (0..count).try_for_each(|bit| self.set_bit(place, offset + bit, pattern >> bit & 1 == 1))
    }

    /// Reads bits from an operand on, the lowest one first.
    pub fn bits(&mut self, place: usize, offset: i64, count: i64) -> Result<i64, Fault> {
        let mut pattern = 0;
        for bit in 0..count {
            pattern |= i64::from(self.bit(place, offset + bit)?) << bit;
        }
        Ok(pattern)
    }

    /// Whether power has left it since it noted 1 in the first cell, which it is to do while it has power.
    pub fn is_left(&mut self) -> bool {
        let is_left = !self.power() && self.noted(0) != 0;
        if is_left {
            (0..NOTES).for_each(|cell| self.note(cell, 0));
        }
        is_left
    }
}

/// On while an instruction that takes several scans is complete.
pub const COMPLETE: u32 = 8029;

/// The flags of arithmetic.
pub const ZERO: u32 = 8020;
/// See [`ZERO`].
pub const BORROW: u32 = 8021;
/// See [`ZERO`].
pub const CARRY: u32 = 8022;
