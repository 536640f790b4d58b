//! Where devices lie in a PLC's memory: two maps, and the program memory.
//!
//! Each map is a type, and an address belongs to one of them, so that an address of one cannot be sent with a command
//! of the other. Sources: tables of addresses and firmware that were published for the FX2N, recordings of the maker's
//! tools, and three independent clients; where only one of them knows an area, its row says so.

use super::command::{Command, Space};
use crate::target::{Device, DeviceKind};
use std::marker::PhantomData;

/// The map of the plain commands, which every FX has.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Plain;

/// The map of the extended commands of FX1N, FX2N and FX3U.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Extended;

/// Parameters and program, from 8000 on, by the extended commands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Program;

/// Something that addresses are in.
pub trait Addressed {
    /// Which commands reach it.
    const SPACE: Space;
}

impl Addressed for Plain {
    const SPACE: Space = Space::Plain;
}

impl Addressed for Extended {
    const SPACE: Space = Space::Extended;
}

impl Addressed for Program {
    const SPACE: Space = Space::Program;
}

/// A byte's address.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Address<A> {
    byte: u16,
    map: PhantomData<A>,
}

/// A bit's address: eight times that of its byte, and its place there.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct BitAddress<M> {
    bit: u16,
    map: PhantomData<M>,
}

/// What of a device a bit tells.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Part {
    /// The relay itself; of timers and counters the contact.
    Contact,
    /// The coil of a timer or counter.
    Coil,
}

/// Devices whose bits follow each other.
#[derive(Clone, Copy, Debug)]
pub struct BitArea {
    kind: DeviceKind,
    part: Part,
    first: u32,
    count: u32,
    /// The address of the first one's bit.
    base: u16,
}

/// Devices whose words follow each other.
#[derive(Clone, Copy, Debug)]
pub struct WordArea {
    kind: DeviceKind,
    first: u32,
    count: u32,
    /// The address of the first one's first byte.
    base: u16,
    /// Bytes of each.
    width: u16,
}

/// What lies at an address.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Lying {
    /// Part of a relay, a timer or a counter.
    Bit(Device, Part),
    /// A byte of a register or a current value, counted from its lowest.
    Byte(Device, u16),
}

/// A map of devices.
pub trait Map: Addressed + Copy {
    /// Where bits lie.
    const BITS: &'static [BitArea];
    /// Where words lie.
    const WORDS: &'static [WordArea];

    /// Where a bit of a device lies, if this map has it.
    fn bit(device: Device, part: Part) -> Option<BitAddress<Self>> {
        let area = Self::BITS.iter().find(|area| area.part == part && area.has(device))?;
        let bit = area.base + (device.number - area.first) as u16;
        Some(BitAddress { bit, map: PhantomData })
    }

    /// Where a device's word begins and its bytes, 2 or 4, if this map has it.
    fn word(device: Device) -> Option<(Address<Self>, u16)> {
        let area = Self::WORDS.iter().find(|area| area.has(device))?;
        let byte = area.base + (device.number - area.first) as u16 * area.width;
        Some((Address::new(byte), area.width))
    }

    /// What the bit with this address tells.
    fn at_bit(bit: u16) -> Option<Lying> {
        let within = |area: &&BitArea| bit >= area.base && u32::from(bit - area.base) < area.count;
        let area = Self::BITS.iter().find(within)?;
        Some(Lying::Bit(Device::new(area.kind, area.first + u32::from(bit - area.base)), area.part))
    }

    /// The register or current value that this byte is part of.
    fn at_byte(byte: u16) -> Option<Lying> {
        let number = |area: &WordArea| u32::from((byte - area.base) / area.width);
        let within = |area: &&WordArea| byte >= area.base && number(area) < area.count;
        let area = Self::WORDS.iter().find(within)?;
        let device = Device::new(area.kind, area.first + number(area));
        Some(Lying::Byte(device, (byte - area.base) % area.width))
    }
}

impl BitArea {
    fn has(&self, device: Device) -> bool {
        device.kind == self.kind && device.number >= self.first && device.number - self.first < self.count
    }
}

impl WordArea {
    fn has(&self, device: Device) -> bool {
        device.kind == self.kind && device.number >= self.first && device.number - self.first < self.count
    }
}

const fn bits(kind: DeviceKind, part: Part, first: u32, count: u32, byte: u16) -> BitArea {
    BitArea { kind, part, first, count, base: byte * 8 }
}

const fn words(kind: DeviceKind, first: u32, count: u32, base: u16, width: u16) -> WordArea {
    WordArea { kind, first, count, base, width }
}

use DeviceKind::{C, D, M, S, T, X, Y};
use Part::{Coil, Contact};

impl Map for Plain {
    const BITS: &'static [BitArea] = &[
        bits(S, Contact, 0, 1000, 0x0000),
        bits(X, Contact, 0, 256, 0x0080),
        bits(Y, Contact, 0, 256, 0x00A0),
        bits(T, Contact, 0, 256, 0x00C0),
        bits(M, Contact, 0, 1536, 0x0100),
        bits(C, Contact, 0, 256, 0x01C0),
        bits(M, Contact, 8000, 256, 0x01E0),
        // The coils are known from one table and one client.
        bits(T, Coil, 0, 256, 0x02C0),
        bits(C, Coil, 0, 256, 0x03C0),
    ];

    const WORDS: &'static [WordArea] = &[
        words(T, 0, 256, 0x0800, 2),
        words(C, 0, 200, 0x0A00, 2),
        words(C, 200, 56, 0x0C00, 4),
        words(D, 8000, 256, 0x0E00, 2),
        // Certain up to D999; one firmware goes on to D7999 without a gap.
        words(D, 0, 8000, 0x1000, 2),
    ];
}

impl Map for Extended {
    const BITS: &'static [BitArea] = &[
        bits(M, Contact, 0, 3072, 0x0000),
        bits(Y, Contact, 0, 256, 0x0180),
        bits(M, Contact, 8000, 256, 0x01C0),
        bits(C, Contact, 0, 256, 0x01E0),
        bits(T, Contact, 0, 256, 0x0200),
        bits(X, Contact, 0, 256, 0x0240),
        bits(S, Contact, 0, 1000, 0x0280),
        bits(C, Coil, 0, 256, 0x04E0),
        bits(T, Coil, 0, 256, 0x0500),
    ];

    const WORDS: &'static [WordArea] = &[
        words(C, 0, 200, 0x0A00, 2),
        // One table says 0B90, two firmwares 0C00.
        words(C, 200, 56, 0x0C00, 4),
        words(D, 8000, 256, 0x0E00, 2),
        words(T, 0, 256, 0x1000, 2),
        words(D, 0, 8000, 0x4000, 2),
    ];
}

impl Extended {
    /// Where a host writes what it wants to watch.
    pub const WATCH_LIST: Address<Extended> = Address::new(0x1400);
    /// Where it reads what that was.
    pub const WATCH_RESULT: Address<Extended> = Address::new(0x1790);
}

impl Plain {
    /// Parameters and program of an FX1S, which has no extended commands.
    pub const PROGRAM: Address<Plain> = Address::new(0x8000);
}

impl Program {
    /// Where the parameters begin.
    pub const START: Address<Program> = Address::new(0x8000);
}

impl<A> Address<A> {
    /// The address of a byte.
    pub const fn new(byte: u16) -> Address<A> {
        Address { byte, map: PhantomData }
    }

    /// The address so many bytes behind it.
    pub fn behind(self, bytes: usize) -> Address<A> {
        Address::new(self.byte.wrapping_add(bytes as u16))
    }

    /// Its number.
    pub fn byte(self) -> u16 {
        self.byte
    }
}

impl<A: Addressed> Address<A> {
    /// The request to read bytes from here on, at most [`super::frame::MOST_DATA`].
    pub fn read(self, length: usize) -> Command {
        Command::Read { space: A::SPACE, address: self.byte, length: length as u8 }
    }

    /// The request to write bytes from here on, likewise.
    pub fn write(self, data: &[u8]) -> Command {
        Command::Write { space: A::SPACE, address: self.byte, data: data.to_vec() }
    }
}

impl<M> BitAddress<M> {
    /// Its number.
    pub fn bit(self) -> u16 {
        self.bit
    }

    /// The byte that it is in, and its place there.
    pub fn byte(self) -> (Address<M>, u8) {
        (Address::new(self.bit / 8), (self.bit % 8) as u8)
    }
}

impl<M: Map> BitAddress<M> {
    /// The request to switch the bit.
    pub fn force(self, on: bool) -> Command {
        Command::Force { space: M::SPACE, bit: self.bit, on }
    }
}
