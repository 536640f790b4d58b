//! What is around the CPU, by names that people have for it: `U0\G5`, `VR0`, `X0.pulses`.

use super::{FIRST_HIGH_SPEED, Outside};
use crate::target::{Device, DeviceKind};
use std::fmt;
use std::ops::RangeInclusive;

/// A place around the CPU that has a value: what a scenario says and looks at there.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Port {
    /// A word in the buffer memory of a special module: `U0\G5`.
    Buffer(u8, u16),
    /// Whether a special module is there: `U0`.
    Module(u8),
    /// The position of a trimmer: `VR0`.
    Trimmer(u8),
    /// The position that a servo amplifier gives over its absolute interface, in 32 bits: `ABS`.
    Absolute,
    /// A contact of a keypad between an output and an input: `Y10.X0`.
    Contact(u32, u32),
    /// Pulses at an input before a scan: `X0.pulses`.
    InputPulses(u8),
    /// Pulses for a high-speed counter before a scan, negative for those backwards: `C235.pulses`.
    CounterPulses(u8),
    /// The frame that waits for the serial port to receive it; each one that is written waits behind the others:
    /// `RS.received`.
    Received,
    /// The frame that the serial port has sent in this scan: `RS.sent`.
    Sent,
    /// The last frame that it has sent: `RS.last`.
    LastSent,
    /// Where the drive at an output stands, in pulses: `Y0.position`.
    Position(u8),
    /// Its pulses in a second, negative for those backwards: `Y0.frequency`.
    Frequency(u8),
    /// All pulses of an output so far: `Y0.pulses`.
    OutputPulses(u8),
}

/// What values a port has.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum PortKind {
    /// On and off.
    Bit,
    /// Numbers.
    Number(RangeInclusive<i64>),
    /// Bytes.
    Frame,
}

impl Port {
    /// Reads a name, letter case aside; `device` reads those of devices.
    pub fn read(name: &str, device: impl Fn(&str) -> Option<Device>) -> Option<Port> {
        let upper = name.to_ascii_uppercase();
        match upper.as_str() {
            "ABS" => return Some(Port::Absolute),
            "RS.RECEIVED" => return Some(Port::Received),
            "RS.SENT" => return Some(Port::Sent),
            "RS.LAST" => return Some(Port::LastSent),
            _ => {}
        }
        let small = |digits: &str| digits.parse::<u8>().ok().filter(|number| *number < 8);
        if let Some(number) = upper.strip_prefix("VR").and_then(small) {
            return Some(Port::Trimmer(number));
        }
        let (head, tail) =
            upper.split_once(['\\', '.']).map_or((upper.as_str(), None), |(head, tail)| (head, Some(tail)));
        if let Some(module) = head.strip_prefix('U').and_then(small) {
            let Some(tail) = tail else { return Some(Port::Module(module)) };
            let number = tail.strip_prefix('G')?.parse::<u16>().ok()?;
            return (number <= MOST_BUFFER).then_some(Port::Buffer(module, number));
        }
        let (owner, tail) = (device(head)?, tail?);
        match (owner.kind, owner.number, tail) {
            (DeviceKind::X, number @ 0..8, "PULSES") => Some(Port::InputPulses(number as u8)),
            (DeviceKind::C, number, "PULSES") => {
                let place = number.checked_sub(FIRST_HIGH_SPEED).filter(|place| *place < 21)?;
                Some(Port::CounterPulses(place as u8))
            }
            (DeviceKind::Y, number @ 0..4, "POSITION") => Some(Port::Position(number as u8)),
            (DeviceKind::Y, number @ 0..4, "FREQUENCY") => Some(Port::Frequency(number as u8)),
            (DeviceKind::Y, number @ 0..4, "PULSES") => Some(Port::OutputPulses(number as u8)),
            (DeviceKind::Y, number, tail) => {
                let input = device(tail).filter(|input| input.kind == DeviceKind::X)?;
                Some(Port::Contact(number, input.number))
            }
            _ => None,
        }
    }

    /// What values it has.
    pub fn kind(self) -> PortKind {
        match self {
            Port::Module(_) | Port::Contact(..) => PortKind::Bit,
            Port::Received | Port::Sent | Port::LastSent => PortKind::Frame,
            Port::Buffer(..) => PortKind::Number(i64::from(i16::MIN)..=i64::from(i16::MAX)),
            Port::Trimmer(_) => PortKind::Number(0..=255),
            Port::InputPulses(_) => PortKind::Number(0..=MOST_PULSES),
            Port::CounterPulses(_) => PortKind::Number(-MOST_PULSES..=MOST_PULSES),
            Port::Absolute | Port::Position(_) | Port::Frequency(_) | Port::OutputPulses(_) => {
                PortKind::Number(i64::from(i32::MIN)..=i64::from(i32::MAX))
            }
        }
    }

    /// Whether it is the program that gives it its value, and nobody else.
    pub fn is_of_program(self) -> bool {
        matches!(
            self,
            Port::Sent | Port::LastSent | Port::Position(_) | Port::Frequency(_) | Port::OutputPulses(_)
        )
    }

    /// Whether what is written does not replace what was written before it: pulses and frames that are received.
    pub fn adds_up(self) -> bool {
        matches!(self, Port::InputPulses(_) | Port::CounterPulses(_) | Port::Received)
    }
}

/// The last number of a buffer memory.
const MOST_BUFFER: u16 = 32_767;
/// More pulses do not arrive between two scans.
const MOST_PULSES: i64 = 1_000_000;

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let device = |kind, number: u32| Device::new(kind, number);
        let (x, y) = (|n| device(DeviceKind::X, n), |n| device(DeviceKind::Y, n));
        match *self {
            Port::Buffer(module, number) => write!(f, "U{module}\\G{number}"),
            Port::Module(module) => write!(f, "U{module}"),
            Port::Trimmer(number) => write!(f, "VR{number}"),
            Port::Absolute => f.write_str("ABS"),
            Port::Contact(output, input) => write!(f, "{}.{}", y(output), x(input)),
            Port::InputPulses(input) => write!(f, "{}.pulses", x(input.into())),
            Port::CounterPulses(place) => write!(f, "C{}.pulses", FIRST_HIGH_SPEED + u32::from(place)),
            Port::Received => f.write_str("RS.received"),
            Port::Sent => f.write_str("RS.sent"),
            Port::LastSent => f.write_str("RS.last"),
            Port::Position(output) => write!(f, "{}.position", y(output.into())),
            Port::Frequency(output) => write!(f, "{}.frequency", y(output.into())),
            Port::OutputPulses(output) => write!(f, "{}.pulses", y(output.into())),
        }
    }
}

impl Outside {
    /// The number at a port, 1 and 0 for on and off; of a module's buffer memory 0 if it is not there.
    pub fn number(&self, port: Port) -> i64 {
        let axis = |output: u8| self.axes[usize::from(output)];
        match port {
            Port::Buffer(module, number) => self.buffer(module, number).map_or(0, i64::from),
            Port::Module(module) => i64::from(!self.absent.contains(&module)),
            Port::Trimmer(number) => i64::from(self.trimmers[usize::from(number)]),
            Port::Absolute => i64::from(self.absolute),
            Port::Contact(y, x) => i64::from(self.contacts.contains(&(y, x))),
            Port::InputPulses(input) => i64::from(self.arrived[usize::from(input)]),
            Port::CounterPulses(place) => i64::from(self.counted[usize::from(place)]),
            Port::Position(output) => axis(output).position,
            Port::Frequency(output) => axis(output).frequency,
            Port::OutputPulses(output) => axis(output).pulses,
            Port::Received | Port::Sent | Port::LastSent => 0,
        }
    }

    /// The bytes at a port of the serial line; none where there is no frame.
    pub fn frame(&self, port: Port) -> &[u8] {
        let frame = match port {
            Port::Received => self.serial.waiting.front(),
            Port::Sent => self.serial.sent.back().filter(|_| self.serial.has_sent),
            Port::LastSent => self.serial.sent.back(),
            _ => None,
        };
        frame.map_or(&[], Vec::as_slice)
    }

    /// Something happens at a port between two scans: it gets a number, or pulses arrive.
    pub fn put(&mut self, port: Port, number: i64) {
        match port {
            Port::Buffer(module, at) => _ = self.set_buffer(module, at, number as i16),
            Port::Module(module) => self.set_module(module, number != 0),
            Port::Trimmer(trimmer) => self.trimmers[usize::from(trimmer)] = number as u8,
            Port::Absolute => self.absolute = number as i32,
            Port::Contact(y, x) => self.set_contact(y, x, number != 0),
            Port::InputPulses(input) => self.pulse_input(input.into(), number as u32),
            Port::CounterPulses(place) => {
                self.pulse_counter(FIRST_HIGH_SPEED + u32::from(place), number as i32);
            }
            Port::Received | Port::Sent | Port::LastSent => {}
            Port::Position(_) | Port::Frequency(_) | Port::OutputPulses(_) => {}
        }
    }

    /// What stays when the CPU is switched off: trimmers, keypads, modules that are not there, where an amplifier
    /// stands.
    pub fn standing(&self) -> Vec<Port> {
        let modules = self.absent.iter().map(|module| Port::Module(*module));
        let trimmers = (0..8).map(Port::Trimmer).filter(|port| self.number(*port) != 0);
        let contacts = self.contacts.iter().map(|(y, x)| Port::Contact(*y, *x));
        let absolute = (self.absolute != 0).then_some(Port::Absolute);
        modules.chain(trimmers).chain(contacts).chain(absolute).collect()
    }
}
