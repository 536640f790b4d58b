//! The numbers of bit devices.
//!
//! Twelve bits name every bit device of the first models, and the instructions of one word have them inside. The
//! auxiliary relays from M1536 on came later: their number stands in a word of its own, marked in bit 13.

use crate::target::{Device, DeviceKind};

/// In the number of a device that does not fit into twelve bits.
const EXTENDED: u16 = 0x2000;

/// One after the other: kind, first device, how many, number of the first.
const AREAS: [(DeviceKind, u32, u16, u16); 8] = [
    (DeviceKind::S, 0, 0x400, 0x000),
    (DeviceKind::X, 0, 0x100, 0x400),
    (DeviceKind::Y, 0, 0x100, 0x500),
    (DeviceKind::T, 0, 0x200, 0x600),
    (DeviceKind::M, 0, 0x600, 0x800),
    (DeviceKind::C, 0, 0x100, 0xE00),
    (DeviceKind::M, 8000, 0x100, 0xF00),
    (DeviceKind::M, 1536, 0x600, EXTENDED + 0x800),
];

/// The number of a bit device; nothing for devices that have none, as far as is known.
pub fn number(device: Device) -> Option<u16> {
    AREAS.iter().find_map(|&(kind, first, count, number)| {
        let place = device.number.checked_sub(first)?;
        (device.kind == kind && place < u32::from(count)).then(|| number + place as u16)
    })
}

/// The bit device of a number.
pub fn device(number: u16) -> Option<Device> {
    AREAS.iter().find_map(|&(kind, first, count, start)| {
        let place = number.checked_sub(start).filter(|place| *place < count)?;
        Some(Device::new(kind, first + u32::from(place)))
    })
}

/// Whether the number has a place inside an instruction of one word.
pub fn is_short(number: u16) -> bool {
    number < EXTENDED
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_names_one_device() {
        for number in 0..0x1000 {
            assert_eq!(device(number).and_then(super::number), Some(number), "{number:04X}");
        }
        assert_eq!(device(0x1000), None);
        let extended = (0x2000..0x4000).filter(|number| device(*number).is_some());
        assert_eq!(extended.count(), 1536);
    }
}
