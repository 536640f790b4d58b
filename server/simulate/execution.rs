//! An instruction at work: its operands in the memory of the simulated PLC.

use super::clock;
use super::code::Call;
use super::interrupts::Interrupts;
use super::layout::index_register;
use super::terminals::Terminals;
use super::{Cell, Lanes, Layout, Memory, Slot};
use crate::target::semantics::NOTES;
use crate::target::{Constant, Device, DeviceKind, Execution, Fault, Model, Operand, Outside};

/// An instruction that is executed in one scenario.
pub(super) struct Executing<'m, L> {
    pub(super) memory: &'m mut Memory<L>,
    pub(super) terminals: &'m mut Terminals<L>,
    pub(super) outside: &'m mut Outside,
    pub(super) interrupts: &'m mut Interrupts,
    pub(super) model: Model,
    pub(super) layout: &'m Layout,
    pub(super) call: &'m Call,
    pub(super) lane: usize,
    pub(super) power: bool,
    pub(super) is_rising: bool,
    pub(super) now_ns: i64,
    pub(super) scan_ns: i64,
    pub(super) is_first_scan: bool,
}

/// The first special relay and the first special register.
const SPECIAL: u32 = 8000;
/// The first counter of 32 bits.
const WIDE_COUNTERS: u32 = 200;

/// Where a word is.
enum Where {
    Number(i64),
    Slot {
        slot: Slot,
        device: Device,
    },
    /// So many bits from a device on.
    Bits {
        first: Device,
        count: u32,
    },
}

/// The number of 32 bits whose halves are two words.
fn joined(lower: i64, upper: i64) -> i64 {
    i64::from((upper as i32) << 16 | i32::from(lower as u16))
}

impl<L: Lanes> Executing<'_, L> {
    fn operand(&self, place: usize) -> Result<Operand, Fault> {
        self.call.operands.get(place).copied().ok_or(Fault::NoDevice(place as u8))
    }

    /// What an index register adds. In the 32-bit form Z has V as its upper half, and V by itself is none. Source: the
    /// FX programming manuals on index registers.
    fn index(&self, register: Option<Device>, place: usize) -> Result<i64, Fault> {
        let none = Fault::NoDevice(place as u8);
        let Some(register) = register else { return Ok(0) };
        let slot = self.layout.slot(register).ok_or(none)?;
        let lower = self.memory.word(slot, self.lane);
        if !self.call.form.wide {
            return Ok(lower);
        }
        let upper = self.memory.word(self.upper(register, place)?, self.lane);
        Ok(joined(lower, upper))
    }

    /// Special relays and registers do not follow on others, nor 32-bit counters on those of 16 bits, as they lie
    /// elsewhere in the memory of a PLC.
    fn moved(device: Device, by: i64, place: usize) -> Result<Device, Fault> {
        let none = Fault::NoDevice(place as u8);
        let number = u32::try_from(i64::from(device.number) + by).map_err(|_| none)?;
        let moved = Device::new(device.kind, number);
        let border = match device.kind {
            DeviceKind::M | DeviceKind::D => SPECIAL,
            DeviceKind::C => WIDE_COUNTERS,
            _ => 0,
        };
        if (device.number < border) == (number < border) { Ok(moved) } else { Err(none) }
    }

    fn find(&self, place: usize, offset: i64, is_wide: bool) -> Result<Where, Fault> {
        let none = Fault::NoDevice(place as u8);
        match self.operand(place)? {
            Operand::Constant { value, index } => {
                let number = match value {
                    Constant::Decimal(number) => number,
                    Constant::Hexadecimal(bits) if is_wide => i64::from(bits as u32 as i32),
                    Constant::Hexadecimal(bits) => i64::from(bits as u16 as i16),
                    Constant::Real(number) => number as i64,
                };
                Ok(Where::Number(number + self.index(index, place)?))
            }
            Operand::Device(device) => self.slot_of(Self::moved(device, offset, place)?).ok_or(none),
            Operand::Indexed { device, index } => {
                let device = Self::moved(device, offset + self.index(Some(index), place)?, place)?;
                self.slot_of(device).ok_or(none)
            }
            Operand::Nibbles { digits, first, index } => {
                let count = u32::from(digits) * 4;
                let first = Self::moved(first, self.index(index, place)? + offset * i64::from(count), place)?;
                Ok(Where::Bits { first, count })
            }
            Operand::WordBit { word, .. } => self.slot_of(Self::moved(word, offset, place)?).ok_or(none),
            _ => Err(none),
        }
    }

    fn slot_of(&self, device: Device) -> Option<Where> {
        let device = index_register(device).unwrap_or(device);
        Some(Where::Slot { slot: self.layout.slot(device)?, device })
    }

    fn cell_of(&self, device: Device, place: usize) -> Result<Cell, Fault> {
        self.layout.cell(device).ok_or(Fault::NoDevice(place as u8))
    }

    fn read_bits(&self, first: Device, count: u32, place: usize) -> Result<i64, Fault> {
        let mut pattern = 0;
        for bit in 0..count {
            let cell = self.cell_of(Self::moved(first, i64::from(bit), place)?, place)?;
            pattern |= i64::from(self.memory.bit(cell, self.lane)) << bit;
        }
        Ok(pattern)
    }

    fn write_bits(&mut self, first: Device, count: u32, place: usize, pattern: i64) -> Result<(), Fault> {
        // All of them are there, or nothing is written.
        self.cell_of(Self::moved(first, i64::from(count) - 1, place)?, place)?;
        for bit in 0..count {
            let cell = self.cell_of(Self::moved(first, i64::from(bit), place)?, place)?;
            self.memory.set_bit(cell, self.lane, pattern >> bit & 1 == 1);
        }
        Ok(())
    }

    /// The slot of the register behind, which has the upper half of a number of 32 bits.
    fn upper(&self, device: Device, place: usize) -> Result<Slot, Fault> {
        let upper = match device.kind {
            // The upper half of Z0 is V0.
            DeviceKind::Z => Device::new(DeviceKind::V, device.number),
            // V is an upper half itself.
            DeviceKind::V => return Err(Fault::NoDevice(place as u8)),
            _ => Self::moved(device, 1, place)?,
        };
        self.layout.slot(upper).ok_or(Fault::NoDevice(place as u8))
    }

    fn store(&mut self, slot: Slot, kind: DeviceKind, value: i64) {
        self.memory.store(slot, kind, self.lane, value);
    }

    fn relay_cell(&self, number: u32) -> Option<Cell> {
        self.layout.cell(Device::new(DeviceKind::M, number))
    }

    fn bit_device(&self, place: usize, offset: i64) -> Result<Device, Fault> {
        match self.operand(place)? {
            Operand::Device(device) => Self::moved(device, offset, place),
            Operand::Indexed { device, index } => {
                Self::moved(device, offset + self.index(Some(index), place)?, place)
            }
            Operand::Nibbles { first, index, .. } => {
                Self::moved(first, offset + self.index(index, place)?, place)
            }
            _ => Err(Fault::NoDevice(place as u8)),
        }
    }
}

impl<L: Lanes> Execution for Executing<'_, L> {
    fn is_wide(&self) -> bool {
        self.call.form.wide
    }

    fn power(&self) -> bool {
        self.power
    }

    fn is_rising(&self) -> bool {
        self.is_rising
    }

    fn operands(&self) -> usize {
        self.call.operands.len()
    }

    fn word(&mut self, place: usize, offset: i64) -> Result<i64, Fault> {
        match self.find(place, offset, false)? {
            Where::Number(number) => Ok(i64::from(number as i16)),
            Where::Slot { slot, .. } => Ok(i64::from(self.memory.word(slot, self.lane) as i16)),
            Where::Bits { first, count } => {
                self.read_bits(first, count.min(16), place).map(|bits| i64::from(bits as i16))
            }
        }
    }

    fn double(&mut self, place: usize, offset: i64) -> Result<i64, Fault> {
        match self.find(place, offset, true)? {
            Where::Number(number) => Ok(i64::from(number as i32)),
            Where::Slot { slot, device } if self.layout.is_wide(device) => {
                Ok(self.memory.word(slot, self.lane))
            }
            Where::Slot { slot, device } => {
                let upper = self.memory.word(self.upper(device, place)?, self.lane);
                Ok(joined(self.memory.word(slot, self.lane), upper))
            }
            Where::Bits { first, count } => {
                self.read_bits(first, count, place).map(|bits| i64::from(bits as i32))
            }
        }
    }

    fn set_word(&mut self, place: usize, offset: i64, value: i64) -> Result<(), Fault> {
        match self.find(place, offset, false)? {
            Where::Number(_) => Err(Fault::NoDevice(place as u8)),
            Where::Slot { slot, device } => {
                self.store(slot, device.kind, i64::from(value as i16));
                Ok(())
            }
            Where::Bits { first, count } => self.write_bits(first, count, place, i64::from(value as u16)),
        }
    }

    fn set_double(&mut self, place: usize, offset: i64, value: i64) -> Result<(), Fault> {
        match self.find(place, offset, true)? {
            Where::Number(_) => Err(Fault::NoDevice(place as u8)),
            Where::Slot { slot, device } if self.layout.is_wide(device) => {
                self.store(slot, device.kind, i64::from(value as i32));
                Ok(())
            }
            Where::Slot { slot, device } => {
                let upper = self.upper(device, place)?;
                self.store(slot, device.kind, i64::from(value as i16));
                self.store(upper, device.kind, i64::from((value >> 16) as i16));
                Ok(())
            }
            Where::Bits { first, count } => self.write_bits(first, count, place, i64::from(value as u32)),
        }
    }

    fn bit(&mut self, place: usize, offset: i64) -> Result<bool, Fault> {
        if let Operand::WordBit { bit, .. } = self.operand(place)? {
            let at = i64::from(bit) + offset;
            return Ok(self.word(place, at.div_euclid(16))? >> at.rem_euclid(16) & 1 == 1);
        }
        let device = self.bit_device(place, offset)?;
        Ok(self.memory.bit(self.cell_of(device, place)?, self.lane))
    }

    fn set_bit(&mut self, place: usize, offset: i64, value: bool) -> Result<(), Fault> {
        if let Operand::WordBit { bit, .. } = self.operand(place)? {
            let at = i64::from(bit) + offset;
            let (word, mask) = (at.div_euclid(16), 1 << at.rem_euclid(16));
            let old = self.word(place, word)?;
            return self.set_word(place, word, if value { old | mask } else { old & !mask });
        }
        let device = self.bit_device(place, offset)?;
        let cell = self.cell_of(device, place)?;
        self.memory.set_bit(cell, self.lane, value);
        Ok(())
    }

    fn device(&mut self, place: usize) -> Result<Option<Device>, Fault> {
        match self.operand(place)? {
            Operand::Indexed { device, index } => {
                Self::moved(device, self.index(Some(index), place)?, place).map(Some)
            }
            Operand::Nibbles { first, index, .. } => {
                Self::moved(first, self.index(index, place)?, place).map(Some)
            }
            operand => Ok(operand.device()),
        }
    }

    fn group_bits(&self, place: usize) -> Option<u32> {
        match self.operand(place) {
            Ok(Operand::Nibbles { digits, .. }) => Some(u32::from(digits) * 4),
            _ => None,
        }
    }

    fn real(&mut self, place: usize, offset: i64) -> Result<f64, Fault> {
        match self.operand(place)? {
            Operand::Constant { value: Constant::Real(number), .. } => Ok(f64::from(number as f32)),
            // Whole numbers are converted, registers hold reals as they are.
            Operand::Constant { .. } => self.double(place, offset).map(|number| number as f64),
            _ => self.double(place, offset).map(|bits| f64::from(f32::from_bits(bits as u32))),
        }
    }

    fn set_real(&mut self, place: usize, offset: i64, value: f64) -> Result<(), Fault> {
        self.set_double(place, offset, i64::from((value as f32).to_bits() as i32))
    }

    fn text(&self, place: usize) -> &str {
        self.call.texts.get(place).map_or("", |text| text.as_str())
    }

    fn relay(&self, number: u32) -> bool {
        self.relay_cell(number).is_some_and(|cell| self.memory.bit(cell, self.lane))
    }

    fn set_relay(&mut self, number: u32, on: bool) {
        if let Some(cell) = self.relay_cell(number) {
            self.memory.set_bit(cell, self.lane, on);
        }
    }

    fn register(&self, number: u32) -> i64 {
        let slot = self.layout.slot(Device::new(DeviceKind::D, number));
        slot.map_or(0, |slot| self.memory.word(slot, self.lane))
    }

    fn set_register(&mut self, number: u32, value: i64) {
        if let Some(slot) = self.layout.slot(Device::new(DeviceKind::D, number)) {
            self.memory.set_word(slot, self.lane, i64::from(value as i16));
        }
    }

    fn is_on(&self, device: Device) -> bool {
        self.layout.cell(device).is_some_and(|cell| self.memory.bit(cell, self.lane))
    }

    fn set_clock(&mut self, clock: [i64; 7]) -> bool {
        clock::set(self.memory, self.layout, self.lane, clock)
    }

    fn clear(&mut self, device: Device) -> Result<(), Fault> {
        let (cell, slot) = (self.layout.cell(device), self.layout.slot(device));
        if cell.is_none() && slot.is_none() {
            return Err(Fault::NoDevice(0));
        }
        if let Some(cell) = cell {
            self.memory.set_bit(cell, self.lane, false);
        }
        if let Some(slot) = slot {
            self.store(slot, device.kind, 0);
        }
        Ok(())
    }

    fn set_state(&mut self, number: u32) {
        if let Some(cell) = self.layout.cell(Device::new(DeviceKind::S, number)) {
            self.memory.set_bit(cell, self.lane, true);
        }
    }

    fn noted(&self, cell: usize) -> i64 {
        self.memory.word(self.call.notes + cell.min(NOTES - 1) as Slot, self.lane)
    }

    fn note(&mut self, cell: usize, value: i64) {
        self.memory.set_word(self.call.notes + cell.min(NOTES - 1) as Slot, self.lane, value);
    }

    fn now_ns(&self) -> i64 {
        self.now_ns
    }

    fn scan_ns(&self) -> i64 {
        self.scan_ns
    }

    fn is_first_scan(&self) -> bool {
        self.is_first_scan
    }

    fn refresh(&mut self, first: Device, count: i64) -> Result<(), Fault> {
        self.cell_of(Self::moved(first, count - 1, 0)?, 0)?;
        for offset in 0..count {
            let cell = self.cell_of(Self::moved(first, offset, 0)?, 0)?;
            self.terminals.refresh(self.memory, self.outside, cell, self.lane);
        }
        Ok(())
    }

    fn model(&self) -> Model {
        self.model
    }

    fn outside(&mut self) -> &mut Outside {
        self.outside
    }

    fn allow_interrupts(&mut self, are_allowed: bool) {
        self.interrupts.are_allowed = are_allowed;
    }

    fn restart_watchdog(&mut self) {
        self.interrupts.is_watchdog_restarted = true;
    }
}
