//! Operands that stand in words of their own: two in the 16-bit form of an instruction, four in the 32-bit form.
//!
//! | word | bits 15–12 | bits 11–8 | bits 7–0 |
//! |---|---|---|---|
//! | 1 | `8`, `A` with an index register | kind | byte 0 of the value |
//! | 2 | `8` or `9`, with the area below: | area | byte 1 |
//! | 3, 4 | `8` | 0 | bytes 2 and 3 of a constant, else 0 |
//!
//! Kinds: 0 decimal constant, 2 hexadecimal constant, 4 bit device, 6 word device, 8 pointer. The area is 5 bits:
//! twice the number of groups of four bits, or what kind of word device it is. An index register Z has its number
//! modulo 4 in the two upper bits of the value, which is left 14, and the rest in the lowest bit of the area.

use super::bits;
use crate::target::{Constant, Device, DeviceKind, Operand, Target};

/// Why an operand has no words.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Uncoded {
    /// It is no operand, or none of FX.
    Unreadable,
    /// The instruction does not take it.
    NotTaken,
    /// The model has no such device.
    NoDevice,
    /// No source tells how such an operand is coded.
    Unknown,
    /// No source tells how an index register V is coded.
    IndexV,
    /// A constant that does not fit into this many bits.
    TooLarge(u8),
    /// A text that is too long, or has characters other than those of ASCII.
    Text,
}

const DECIMAL: u8 = 0;
const HEXADECIMAL: u8 = 2;
const BIT: u8 = 4;
const WORD: u8 = 6;
const POINTER: u8 = 8;

/// In the first word of an operand with an index register.
const INDEXED: u16 = 0x2000;
/// The bits of a value that an index register leaves.
const VALUE_BITS: u32 = 14;

/// The last pointer of the first models.
pub const LAST_POINTER: u32 = 127;

/// Word devices: kind, first device, how many, area.
const AREAS: [(DeviceKind, u32, u32, u8); 5] = [
    (DeviceKind::D, 8000, 256, 0),
    (DeviceKind::T, 0, 512, 2),
    (DeviceKind::C, 0, 256, 4),
    (DeviceKind::D, 0, 1000, 6),
    (DeviceKind::D, 1000, 7000, 8),
];

/// What the words of an operand say, index register aside.
#[derive(Clone, Copy)]
struct Coded {
    kind: u8,
    area: u8,
    value: u32,
}

/// Appends the words of `operand`: four if `is_wide`, else two.
pub fn write(operand: &Operand, is_wide: bool, target: &Target, words: &mut Vec<u16>) -> Result<(), Uncoded> {
    let (mut coded, index) = match *operand {
        Operand::Device(device) => (of_device(device, target)?, None),
        Operand::Indexed { device, index } => (of_device(device, target)?, Some(index)),
        Operand::Nibbles { digits, first, index } => {
            on(first, target)?;
            let is_group =
                matches!(first.kind, DeviceKind::X | DeviceKind::Y | DeviceKind::M | DeviceKind::S);
            if !is_group || !(1..=8).contains(&digits) {
                return Err(Uncoded::Unreadable);
            }
            let value = bits::number(first).ok_or(Uncoded::Unknown)?;
            (Coded { kind: BIT, area: 2 * digits, value: u32::from(value) }, index)
        }
        Operand::Constant { index: Some(_), .. } => return Err(Uncoded::Unknown),
        Operand::Constant { value, .. } => (of_constant(value, is_wide)?, None),
        Operand::WordBit { .. } => return Err(Uncoded::Unknown),
        Operand::Text => return Err(Uncoded::NotTaken),
        _ => return Err(Uncoded::Unreadable),
    };
    let mut mark = 0x8000;
    if let Some(index) = index {
        on(index, target)?;
        if index.kind != DeviceKind::Z {
            return Err(Uncoded::IndexV);
        }
        mark |= INDEXED;
        coded.value |= (index.number & 3) << VALUE_BITS;
        coded.area |= (index.number >> 2) as u8;
    }
    let [first, second, third, fourth] = coded.value.to_le_bytes().map(u16::from);
    words.push(mark | u16::from(coded.kind) << 8 | first);
    words.push(0x8000 + (u16::from(coded.area) << 8) + second);
    if is_wide {
        words.extend([0x8000 | third, 0x8000 | fourth]);
    }
    Ok(())
}

/// The operand that begins with these words, of which there are four if `is_wide`. Words that only look like one are
/// told by writing it again.
pub fn read(words: &[u16], is_wide: bool) -> Option<Operand> {
    let &[first, second, ..] = words else { return None };
    let upper = match is_wide {
        false => 0,
        true => (u32::from(*words.get(2)?) & 0xFF) << 16 | (u32::from(*words.get(3)?) & 0xFF) << 24,
    };
    let area = u8::try_from(second.checked_sub(0x8000)? >> 8).ok()?;
    let value = u32::from(first & 0xFF) | u32::from(second & 0xFF) << 8 | upper;
    let coded = Coded { kind: (first >> 8) as u8 & 0xF, area, value };
    if first & INDEXED == 0 {
        return coded.operand(is_wide, None);
    }
    let number = value >> VALUE_BITS & 3 | u32::from(area & 1) << 2;
    let base = Coded { area: area & !1, value: value & ((1 << VALUE_BITS) - 1), ..coded };
    base.operand(is_wide, Some(Device::new(DeviceKind::Z, number)))
}

impl Coded {
    fn operand(self, is_wide: bool, index: Option<Device>) -> Option<Operand> {
        let value = match self.kind {
            DECIMAL if is_wide => Constant::Decimal(i64::from(self.value as i32)),
            DECIMAL => Constant::Decimal(i64::from(self.value as u16 as i16)),
            HEXADECIMAL => Constant::Hexadecimal(u64::from(self.value)),
            _ => return self.device_operand(index),
        };
        Some(Operand::Constant { value, index })
    }

    fn device_operand(self, index: Option<Device>) -> Option<Operand> {
        let number = || bits::device(u16::try_from(self.value).ok()?);
        let device = match (self.kind, self.area) {
            (BIT, 0) => number()?,
            (BIT, area) => return Some(Operand::Nibbles { digits: area / 2, first: number()?, index }),
            (WORD, area) => {
                let (kind, first, ..) = *AREAS.iter().find(|(.., known)| *known == area)?;
                named(Device::new(kind, first + self.value / 2))
            }
            (POINTER, _) => Device::new(DeviceKind::P, self.value / 2),
            _ => return None,
        };
        Some(match index {
            None => Operand::Device(device),
            Some(index) => Operand::Indexed { device, index },
        })
    }
}

fn on(device: Device, target: &Target) -> Result<(), Uncoded> {
    device.range_on(target).map(|_| ()).ok_or(Uncoded::NoDevice)
}

fn of_device(device: Device, target: &Target) -> Result<Coded, Uncoded> {
    on(device, target)?;
    if device.kind == DeviceKind::P {
        // No capture has a pointer that only the FX3U has.
        if device.number > LAST_POINTER {
            return Err(Uncoded::Unknown);
        }
        return Ok(Coded { kind: POINTER, area: 0, value: 2 * device.number });
    }
    let device = register(device);
    let in_words = AREAS.iter().find_map(|&(kind, first, count, area)| {
        let place = device.number.checked_sub(first).filter(|place| *place < count)?;
        (device.kind == kind).then_some(Coded { kind: WORD, area, value: 2 * place })
    });
    // Timers and counters have a number as bits too, but here their current value is meant.
    in_words
        .or_else(|| {
            let value = u32::from(bits::number(device)?);
            Some(Coded { kind: BIT, area: 0, value })
        })
        .ok_or(Uncoded::Unknown)
}

fn of_constant(value: Constant, is_wide: bool) -> Result<Coded, Uncoded> {
    let too_large = Uncoded::TooLarge(if is_wide { 32 } else { 16 });
    let (kind, value) = match value {
        Constant::Decimal(value) if is_wide => (DECIMAL, i32::try_from(value).ok().map(|value| value as u32)),
        Constant::Decimal(value) => (DECIMAL, i16::try_from(value).ok().map(|value| u32::from(value as u16))),
        Constant::Hexadecimal(value) if is_wide => (HEXADECIMAL, u32::try_from(value).ok()),
        Constant::Hexadecimal(value) => (HEXADECIMAL, u16::try_from(value).ok().map(u32::from)),
        Constant::Real(_) => return Err(Uncoded::Unknown),
    };
    value.map(|value| Coded { kind, area: 0, value }).ok_or(too_large)
}

/// The index registers lie among the special registers: Z in D8028, V in D8029, then Z1, V1 … from D8182 on.
const INDEX_REGISTERS: (u32, u32) = (8028, 8182);

/// Where an index register lies; any other device itself.
fn register(device: Device) -> Device {
    let offset = match device.kind {
        DeviceKind::Z => 0,
        DeviceKind::V => 1,
        _ => return device,
    };
    let pair = match device.number {
        0 => INDEX_REGISTERS.0,
        number => INDEX_REGISTERS.1 + 2 * (number - 1),
    };
    Device::new(DeviceKind::D, pair + offset)
}

/// The index register that lies at a special register; any other device itself. Machine code knows no difference.
fn named(device: Device) -> Device {
    const PAIRS: u32 = 7;
    let (first, others) = INDEX_REGISTERS;
    let index = match device.number {
        number if device.kind != DeviceKind::D || number < first => return device,
        number if number - first < 2 => number - first,
        number if (others..others + 2 * PAIRS).contains(&number) => number - others + 2,
        _ => return device,
    };
    let kind = if index.is_multiple_of(2) { DeviceKind::Z } else { DeviceKind::V };
    Device::new(kind, index / 2)
}
