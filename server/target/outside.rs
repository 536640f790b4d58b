//! What is around the CPU while it runs: special modules, the serial port, pulses, trimmers, keypads.
//!
//! It is part of the state of a simulated PLC and changes only by what instructions and scenarios do to it, so that a
//! scan depends on nothing else than the state before it.

mod port;
pub use port::{Port, PortKind};

use super::Device;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// The surroundings of one PLC.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Outside {
    /// Buffer memories that are not 0, by module and number.
    buffers: BTreeMap<(u8, u16), i16>,
    /// Modules that do not answer.
    absent: BTreeSet<u8>,
    /// The serial port.
    pub serial: Serial,
    /// The positions of trimmers, 0 to 255.
    pub trimmers: [u8; 8],
    /// The drives at Y0 to Y3.
    pub axes: [Axis; 4],
    /// The position that a servo amplifier gives over its absolute interface.
    pub absolute: i32,
    /// Pulses that arrived at X0 to X7 between the scan before and this one.
    pub arrived: [u32; 8],
    /// The same for the next scan.
    arriving: [u32; 8],
    /// Pulses for the counters from C235 on before the next scan, negative for those backwards.
    counting: [i32; 21],
    /// The same before this scan.
    counted: [i32; 21],
    /// What watches high-speed counters.
    watches: Vec<Watch>,
    /// Contacts of keypads and switches between outputs and inputs, each with a diode: numbers of Y and X.
    contacts: BTreeSet<(u32, u32)>,
}

/// A serial port with its peer.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Serial {
    /// The frames that the PLC has sent, at most [`Serial::MOST_FRAMES`], the latest last.
    pub sent: VecDeque<Vec<u8>>,
    /// The frames that wait for the PLC to receive them, the first one first.
    pub waiting: VecDeque<Vec<u8>>,
    /// Whether the latest was sent in this scan.
    has_sent: bool,
}

impl Serial {
    /// Of sent frames more are forgotten.
    pub const MOST_FRAMES: usize = 64;

    /// The PLC sends a frame.
    pub fn send(&mut self, frame: Vec<u8>) {
        self.sent.push_back(frame);
        while self.sent.len() > Self::MOST_FRAMES {
            self.sent.pop_front();
        }
        self.has_sent = true;
    }
}

/// What a drive does with the pulses of an output.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Axis {
    /// Pulses forward less pulses backward.
    pub position: i64,
    /// All pulses, whatever their direction.
    pub pulses: i64,
    /// Pulses in a second at present, negative for those backwards.
    pub frequency: i64,
}

/// An instruction that waits for a high-speed counter. It acts on the pulses before the next scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Watch {
    /// The number of the counter.
    pub counter: u32,
    /// What it does, and when.
    pub deed: WatchDeed,
}

/// What becomes of a high-speed counter that is watched.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum WatchDeed {
    /// At this count the device goes on, or its interrupt is asked for.
    Set(i32, Device),
    /// At this count the device goes off, or the counter to 0.
    Reset(i32, Device),
    /// One of the three bits from the device on is on: below the first limit, within both, above the second.
    Zone(i32, i32, Device),
}

/// The first high-speed counter.
pub const FIRST_HIGH_SPEED: u32 = 235;

impl Outside {
    /// More instructions than these are not watched at a time.
    const MOST_WATCHES: usize = 64;

    /// The word in a buffer memory, 0 where nothing has written one; nothing if no module answers.
    pub fn buffer(&self, module: u8, number: u16) -> Option<i16> {
        let is_there = module < 8 && !self.absent.contains(&module);
        is_there.then(|| self.buffers.get(&(module, number)).copied().unwrap_or(0))
    }

    /// Writes a word to a buffer memory; gives whether a module has taken it.
    pub fn set_buffer(&mut self, module: u8, number: u16, word: i16) -> bool {
        let is_there = module < 8 && !self.absent.contains(&module);
        match word {
            _ if !is_there => {}
            0 => {
                self.buffers.remove(&(module, number));
            }
            _ => {
                self.buffers.insert((module, number), word);
            }
        }
        is_there
    }

    /// Plugs a special module in, or takes it away with what it had.
    pub fn set_module(&mut self, module: u8, is_there: bool) {
        if is_there {
            self.absent.remove(&module);
        } else {
            self.absent.insert(module);
            self.buffers.retain(|(of, _), _| *of != module);
        }
    }

    /// Opens or closes a contact of a keypad: while it is closed and output `y` is on, input `x` is on.
    pub fn set_contact(&mut self, y: u32, x: u32, is_closed: bool) {
        match is_closed {
            true => self.contacts.insert((y, x)),
            false => self.contacts.remove(&(y, x)),
        };
    }

    /// The closed contacts of keypads: numbers of Y and X.
    pub fn contacts(&self) -> impl Iterator<Item = (u32, u32)> {
        self.contacts.iter().copied()
    }

    /// Lets pulses arrive at an input from X0 to X7 before the next scan.
    pub fn pulse_input(&mut self, x: u32, count: u32) {
        if let Some(arriving) = self.arriving.get_mut(x as usize) {
            *arriving = arriving.saturating_add(count);
        }
    }

    /// Lets pulses arrive for a high-speed counter before the next scan, whatever its inputs.
    pub fn pulse_counter(&mut self, counter: u32, count: i32) {
        let place = counter.checked_sub(FIRST_HIGH_SPEED).map(|place| place as usize);
        if let Some(counting) = place.and_then(|place| self.counting.get_mut(place)) {
            *counting = counting.saturating_add(count);
        }
    }

    /// The pulses that arrived become those of a scan that begins; the inputs in `risen` went on in it.
    pub fn begin_scan(&mut self, risen: [bool; 8]) {
        self.serial.has_sent = false;
        self.counted = [0; 21];
        self.arrived = std::mem::take(&mut self.arriving);
        for (arrived, risen) in self.arrived.iter_mut().zip(risen) {
            *arrived = arrived.saturating_add(u32::from(risen));
        }
    }

    /// Takes the pulses for a high-speed counter.
    pub fn take_counting(&mut self, counter: u32) -> i32 {
        let place = counter.saturating_sub(FIRST_HIGH_SPEED) as usize;
        let pulses = self.counting.get_mut(place).map(std::mem::take).unwrap_or(0);
        if let Some(counted) = self.counted.get_mut(place) {
            *counted = pulses;
        }
        pulses
    }

    /// Watches a high-speed counter until the next scan has begun.
    pub fn watch(&mut self, watch: Watch) {
        if self.watches.len() < Self::MOST_WATCHES && !self.watches.contains(&watch) {
            self.watches.push(watch);
        }
    }

    /// Takes what watches high-speed counters, in the order of execution.
    pub fn take_watches(&mut self) -> Vec<Watch> {
        std::mem::take(&mut self.watches)
    }
}
