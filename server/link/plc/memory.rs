//! What a host finds at the addresses of the virtual PLC.

use super::cpu::{PARAMETER_BYTES, Plc, WRITE_ENABLE};
use crate::link::address::{Extended, Lying, Map, Part, Plain};
use crate::link::command::{Command, Reply, Space};
use crate::link::{Mode, Point};
use crate::simulate::{Value, Variable, is_identity};
use crate::target::{Device, DeviceKind, Model};
use std::sync::Arc;

/// Where parameters and program begin, in the plain map too.
const PROGRAM: usize = 0x8000;
/// Device memory ends here in both maps.
const DEVICES: usize = 0x8000;
/// Where a host writes what it wants to watch, and where the answers begin.
const WATCH_LIST: std::ops::Range<usize> = 0x1400..0x1790;
/// The answers to the longest list.
const WATCH_RESULT: std::ops::Range<usize> = 0x1790..0x1790 + 0x388;

impl Plc {
    /// Does what a host asks; nothing where a PLC says no.
    pub fn obey_host(&mut self, command: &Command, now_ns: i64) -> Option<Reply> {
        // The maker's tools speak plainly with it; what it would do otherwise is not known.
        if self.target().model == Model::Fx1s && command.is_extended() {
            return None;
        }
        match command {
            Command::Read { space, address, length } => {
                self.read(*space, usize::from(*address), usize::from(*length)).map(Reply::Data)
            }
            Command::Write { space, address, data } => {
                self.write(*space, usize::from(*address), data, now_ns).then_some(Reply::Done)
            }
            Command::Force { space, bit, on } => {
                let (device, part) = match at_bit(*space, *bit)? {
                    Lying::Bit(device, part) => (device, part),
                    Lying::Byte(..) => return None,
                };
                self.set_bit(device, part, *on, now_ns);
                Some(Reply::Done)
            }
            Command::Search { from, word } => self.search(usize::from(*from), *word).map(Reply::Found),
            Command::Commit if self.mode == Mode::Stop => {
                self.take_over();
                Some(Reply::Done)
            }
            Command::Clear(step) if self.mode == Mode::Stop => {
                self.clear(*step);
                Some(Reply::Done)
            }
            Command::Speed(_) => Some(Reply::Done),
            Command::Commit | Command::Clear(_) => None,
        }
    }

    fn read(&self, space: Space, address: usize, length: usize) -> Option<Vec<u8>> {
        let end = address + length;
        let is_program = space != Space::Extended && address >= PROGRAM;
        if is_program {
            return self.program.get(address - PROGRAM..end - PROGRAM).map(<[u8]>::to_vec);
        }
        if space == Space::Program || end > DEVICES {
            return None;
        }
        if space == Space::Extended && WATCH_RESULT.contains(&address) {
            let result = self.watched()?;
            return result.get(address - WATCH_RESULT.start..end - WATCH_RESULT.start).map(<[u8]>::to_vec);
        }
        Some((address..end).map(|byte| self.byte(space, byte as u16)).collect())
    }

    /// A byte of device memory; 0 where nothing lies.
    fn byte(&self, space: Space, address: u16) -> u8 {
        match at_byte(space, address) {
            Some(Lying::Byte(device, place)) => (self.machine.word(device, 0) >> (8 * place)) as u8,
            _ => (0..8).fold(0, |byte, place| match at_bit_of(space, address, place) {
                Some(Lying::Bit(device, part)) => byte | u8::from(self.bit(device, part)) << place,
                _ => byte,
            }),
        }
    }

    /// What somebody in front of the PLC reads of a device: what a host does, by the names of hosts and of the
    /// simulator.
    pub fn shown(&self, name: &str) -> Option<Value> {
        if let Some(Point::Bit(device, part)) = Point::named(name, self.target) {
            return Some(Value::Bit(self.bit(device, part)));
        }
        let variable = self.machine.code().variable(name)?;
        Some(self.machine.value(variable, 0))
    }

    fn bit(&self, device: Device, part: Part) -> bool {
        match (device.kind, device.number) {
            (DeviceKind::M, 8000) => self.mode == Mode::Run,
            (DeviceKind::M, 8001) => self.mode == Mode::Stop,
            (DeviceKind::M, 8002) if self.mode == Mode::Stop => false,
            (DeviceKind::M, 8003) if self.mode == Mode::Stop => true,
            (DeviceKind::X, _) => self.is_wired(device),
            _ => {
                let layout = &self.machine.code().layout;
                let cell = match part {
                    Part::Contact => layout.cell(device),
                    Part::Coil => layout.coil(device),
                };
                cell.is_some_and(|cell| self.machine.memory().cell(cell) != 0)
            }
        }
    }

    fn write(&mut self, space: Space, address: usize, data: &[u8], now_ns: i64) -> bool {
        let end = address + data.len();
        if space != Space::Extended && address >= PROGRAM {
            return self.write_program(address - PROGRAM, data);
        }
        if space == Space::Program || end > DEVICES {
            return false;
        }
        if space == Space::Extended && WATCH_LIST.contains(&address) && end <= WATCH_LIST.end {
            let place = address - WATCH_LIST.start;
            self.watch_list.resize(self.watch_list.len().max(place + data.len()), 0);
            self.watch_list[place..place + data.len()].copy_from_slice(data);
            return true;
        }
        let mut bytes = (address..end).zip(data).peekable();
        while let Some((address, byte)) = bytes.next() {
            match at_byte(space, address as u16) {
                Some(Lying::Byte(device, place)) => {
                    // A word is written at once, so that no scan sees half of it.
                    let mut word = self.machine.word(device, 0);
                    put_byte(&mut word, place, *byte);
                    while let Some((next, byte)) = bytes.peek()
                        && let Some(Lying::Byte(same, place)) = at_byte(space, *next as u16)
                        && same == device
                    {
                        put_byte(&mut word, place, **byte);
                        bytes.next();
                    }
                    if !is_identity(device) {
                        self.machine.set_word(device, word);
                    }
                    self.is_changed = true;
                }
                _ => {
                    for place in 0..8 {
                        if let Some(Lying::Bit(device, part)) = at_bit_of(space, address as u16, place) {
                            self.set_bit(device, part, byte >> place & 1 == 1, now_ns);
                        }
                    }
                }
            }
        }
        true
    }

    /// The program is written only while the CPU stands still, and behind the parameters only if that is enabled on the
    /// models whose tools do so.
    fn write_program(&mut self, place: usize, data: &[u8]) -> bool {
        let is_enabled = self.machine.bit(Device::new(DeviceKind::M, WRITE_ENABLE)) != 0;
        let is_guarded = self.target.model != Model::Fx1s;
        if self.mode == Mode::Run || (is_guarded && place >= PARAMETER_BYTES && !is_enabled) {
            return false;
        }
        let Some(memory) = self.program.get_mut(place..place + data.len()) else { return false };
        memory.copy_from_slice(data);
        self.is_open = true;
        self.is_changed = true;
        true
    }

    fn set_bit(&mut self, device: Device, part: Part, on: bool, now_ns: i64) {
        let coil = self.machine.code().layout.coil(device);
        match (part, coil) {
            (Part::Coil, Some(coil)) => self.machine.write(Variable::Relay(coil), &Value::Bit(on)),
            _ => self.machine.set(device, if on { 0xFF } else { 0 }),
        }
        self.is_changed = true;
        if device.kind == DeviceKind::M && device.is_special() {
            self.obey(device.number, on, now_ns);
        }
    }

    fn search(&self, from: usize, word: [u8; 2]) -> Option<Option<u16>> {
        let memory = self.program.get(from.checked_sub(PROGRAM)?..)?;
        let found = memory.chunks_exact(2).position(|own| own == word);
        Some(found.map(|steps| (from + steps * 2) as u16))
    }

    /// What a host sees of its list: words, then bits from the lowest place of each byte on. The list has the number of
    /// words and 81h, the number of bits, then the addresses. Of a counter of 32 bits four bytes are shown, as in the
    /// one firmware that was published.
    fn watched(&self) -> Option<Vec<u8>> {
        let (words, _) = self.watch_list.as_chunks::<2>();
        let mut words = words.iter().map(|word| u16::from_le_bytes(*word));
        let (counted, bits) = (usize::from(words.next()? & 0xFF), usize::from(words.next()?));
        let mut result = Vec::new();
        for address in words.by_ref().take(counted) {
            let is_wide = matches!(Extended::at_byte(address), Some(Lying::Byte(device, _))
                if Extended::word(device).is_some_and(|(_, width)| width == 4));
            let bytes = if is_wide { 4 } else { 2 };
            result.extend((0..bytes).map(|place| self.byte(Space::Extended, address.wrapping_add(place))));
        }
        let mut packed = vec![0u8; bits.min(WATCH_LIST.len()).div_ceil(8)];
        for (number, bit) in words.take(bits).enumerate() {
            if let Some(Lying::Bit(device, part)) = Extended::at_bit(bit)
                && let Some(byte) = packed.get_mut(number / 8)
            {
                *byte |= u8::from(self.bit(device, part)) << (number % 8);
            }
        }
        result.extend(packed);
        // A read of an even length may go one byte beyond the last bit.
        result.resize(WATCH_RESULT.len(), 0);
        Some(result)
    }

    /// A step of clearing: what follows each other for the program, and for devices. Which of the last two is which is
    /// a guess.
    fn clear(&mut self, step: u8) {
        match step {
            2 => self.clear_program(),
            4 | 3 => {
                let code = Arc::clone(self.machine.code());
                let is_wanted = |device: &Device| {
                    let is_word = device.kind.is_word() && !device.kind.is_bit();
                    !device.is_special() && device.kind != DeviceKind::X && is_word == (step == 3)
                };
                for device in code.layout.devices().filter(is_wanted) {
                    self.machine.set(device, 0);
                    self.machine.set_word(device, 0);
                }
                self.is_changed = true;
            }
            _ => {}
        }
    }

    fn is_wired(&self, input: Device) -> bool {
        let cell = self.machine.code().layout.cell(input);
        cell.and_then(|cell| self.machine.wired(Variable::Relay(cell))).is_some_and(|on| on != 0)
    }
}

fn put_byte(word: &mut i64, place: u16, byte: u8) {
    *word = *word & !(0xFF << (8 * place)) | i64::from(byte) << (8 * place);
}

fn at_byte(space: Space, address: u16) -> Option<Lying> {
    match space {
        Space::Plain => Plain::at_byte(address),
        Space::Extended => Extended::at_byte(address),
        Space::Program => None,
    }
}

fn at_bit(space: Space, bit: u16) -> Option<Lying> {
    match space {
        Space::Plain => Plain::at_bit(bit),
        Space::Extended => Extended::at_bit(bit),
        Space::Program => None,
    }
}

fn at_bit_of(space: Space, address: u16, place: u16) -> Option<Lying> {
    at_bit(space, address.checked_mul(8)?.checked_add(place)?)
}
