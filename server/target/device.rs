//! Devices of the FX family: kinds, numbers, and what each model has of them.

use super::{Model, Target};
use std::fmt;

/// A kind of device.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum DeviceKind {
    /// Input relay, octal numbers.
    X,
    /// Output relay, octal numbers.
    Y,
    /// Auxiliary relay; from M8000 on special relays.
    M,
    /// State.
    S,
    /// Timer: contact, coil and current value.
    T,
    /// Counter: contact, coil and current value; from C200 on 32 bit.
    C,
    /// Data register; from D8000 on special registers.
    D,
    /// Extension register (FX3U).
    R,
    /// Index register V.
    V,
    /// Index register Z.
    Z,
    /// Pointer: label of a jump or a subroutine.
    P,
    /// Interrupt pointer.
    I,
    /// Nesting level of master control.
    N,
}

impl DeviceKind {
    /// All kinds, in reading order.
    pub const ALL: [DeviceKind; 13] = {
        use DeviceKind::*;
        [X, Y, M, S, T, C, D, R, V, Z, P, I, N]
    };

    /// The letter.
    pub fn letter(self) -> char {
        match self {
            DeviceKind::X => 'X',
            DeviceKind::Y => 'Y',
            DeviceKind::M => 'M',
            DeviceKind::S => 'S',
            DeviceKind::T => 'T',
            DeviceKind::C => 'C',
            DeviceKind::D => 'D',
            DeviceKind::R => 'R',
            DeviceKind::V => 'V',
            DeviceKind::Z => 'Z',
            DeviceKind::P => 'P',
            DeviceKind::I => 'I',
            DeviceKind::N => 'N',
        }
    }

    /// The kind with this letter, upper or lower case.
    pub fn of_letter(letter: char) -> Option<DeviceKind> {
        use DeviceKind::*;
        Some(match letter.to_ascii_uppercase() {
            'X' => X,
            'Y' => Y,
            'M' => M,
            'S' => S,
            'T' => T,
            'C' => C,
            'D' => D,
            'R' => R,
            'V' => V,
            'Z' => Z,
            'P' => P,
            'I' => I,
            'N' => N,
            _ => return None,
        })
    }

    /// 8 for inputs and outputs, else 10.
    pub fn number_base(self) -> u32 {
        if matches!(self, DeviceKind::X | DeviceKind::Y) { 8 } else { 10 }
    }

    /// Whether a contact can read it as one bit (timers and counters by their contact).
    pub fn is_bit(self) -> bool {
        use DeviceKind::*;
        matches!(self, X | Y | M | S | T | C)
    }

    /// Whether it holds a word (timers and counters by their current value).
    pub fn is_word(self) -> bool {
        use DeviceKind::*;
        matches!(self, T | C | D | R | V | Z)
    }

    /// Whether its coil counts up to a preset: timers and counters.
    pub fn has_preset(self) -> bool {
        matches!(self, DeviceKind::T | DeviceKind::C)
    }

    /// Whether it names a place in the program: the pointers of jumps, subroutines and interrupts.
    pub fn is_pointer(self) -> bool {
        matches!(self, DeviceKind::P | DeviceKind::I)
    }
}

/// A device: its kind and its number, the octal number's value for inputs and outputs (X10 is number 8).
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Device {
    /// The kind.
    pub kind: DeviceKind,
    /// The number's value.
    pub number: u32,
}

impl Device {
    /// The special relay that is on while the CPU runs.
    pub const ALWAYS_ON: Device = Device::new(DeviceKind::M, 8000);

    /// The special relay that is off while the CPU runs.
    pub const ALWAYS_OFF: Device = Device::new(DeviceKind::M, 8001);

    /// The special relay that is on in the first scan alone, and the one that is off in it alone.
    pub const FIRST_SCAN: Device = Device::new(DeviceKind::M, 8002);
    /// See [`Device::FIRST_SCAN`].
    pub const OFF_AT_FIRST: Device = Device::new(DeviceKind::M, 8003);

    /// The pointer that means the end of the program.
    pub const PROGRAM_END: Device = Device::new(DeviceKind::P, 63);

    /// Whether it is a timer that forgets its time without power. T246 to T255 of the FX1N, FX2N and FX3U keep it.
    pub fn is_forgetful_timer(self) -> bool {
        self.kind == DeviceKind::T && self.number < 246
    }

    /// Whether contacts for its edge share one memory, so that only the first one that is executed after a change sees
    /// it: M2800 to M3071, which the FX2N and FX3U have. Source: the FX programming manuals on these relays.
    pub fn has_single_edge(self) -> bool {
        self.kind == DeviceKind::M && (2800..=3071).contains(&self.number)
    }

    /// Its value in every scan of a running CPU, if it has only one.
    pub fn always(self) -> Option<bool> {
        match self {
            Device::ALWAYS_ON => Some(true),
            Device::ALWAYS_OFF => Some(false),
            _ => None,
        }
    }

    /// Whether it is a special relay or register, which the CPU knows: M8000 and up, D8000 and up.
    pub fn is_special(self) -> bool {
        matches!(self.kind, DeviceKind::M | DeviceKind::D) && self.number >= 8000
    }

    /// The device of `kind` with this number's value.
    pub const fn new(kind: DeviceKind, number: u32) -> Device {
        Device { kind, number }
    }

    /// The range of `target` in which it lies, if any.
    pub fn range_on(self, target: &Target) -> Option<&'static DeviceRange> {
        target.ranges(self.kind).find(|range| range.first <= self.number && self.number <= range.last)
    }

    /// Whether it [has a single edge](Device::has_single_edge) on `target`.
    pub fn shares_edges(self, target: &Target) -> bool {
        matches!(target.model, Model::Fx2n | Model::Fx3u) && self.has_single_edge()
    }

    /// The device after it, if both lie in one range of `target`.
    pub fn next_in_range(self, target: &Target) -> Option<Device> {
        let range = self.range_on(target)?;
        (self.number < range.last).then(|| Device::new(self.kind, self.number + 1))
    }

    /// The row of the special relays and registers, if it is one with a documented meaning.
    pub fn special_on(self, target: &Target) -> Option<&'static SpecialDevice> {
        let row = target.special.binary_search_by_key(&self, |special| special.device).ok()?;
        target.special.get(row)
    }
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind.number_base() {
            8 => write!(f, "{}{:o}", self.kind.letter(), self.number),
            // Interrupt pointers are always written with three digits, of which each has a meaning.
            _ if self.kind == DeviceKind::I => write!(f, "I{:03}", self.number),
            _ => write!(f, "{}{}", self.kind.letter(), self.number),
        }
    }
}

/// A run of devices with one purpose, such as "T0–T199: 100 ms timers".
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct DeviceRange {
    /// The kind.
    pub kind: DeviceKind,
    /// First number's value.
    pub first: u32,
    /// Last number's value.
    pub last: u32,
    /// What it is, for hover: `general`, `latched`, `100 ms timer`.
    pub purpose: &'static str,
    /// Whether it keeps its value without power.
    pub latched: bool,
    /// For timers, the unit in milliseconds; else 0.
    pub timer_unit_ms: u32,
    /// For registers and counters, 16 or 32 bit; 1 for relays.
    pub bits: u8,
}

/// A special relay or register and what the CPU uses it for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SpecialDevice {
    /// The device.
    pub device: Device,
    /// What it is, one line.
    pub meaning: &'static str,
    /// Whether a program may write it.
    pub writable: bool,
}
