//! Watching many devices: the PLC gets a list of them once, and each exchange brings all their values.
//!
//! An FX1S has no such list; its devices are read where they lie. Counters of 32 bits are too, because sources do not
//! agree how many bytes a list shows of them.

use super::devices::Place;
use super::{Dialect, Host, Point};
use crate::link::Map;
use crate::link::address::{Extended, Part};
use crate::link::frame::MOST_DATA;
use crate::link::{LinkError, Transport};
use crate::target::Device;

/// Devices that a host watches.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    points: Vec<Point>,
    /// Addresses of words in the list, in its order.
    words: Vec<u16>,
    /// Addresses of bits in it.
    bits: Vec<u16>,
    /// Where each point's value is found.
    found: Vec<Found>,
    is_registered: bool,
    /// How many requests the last look took.
    exchanges: u64,
}

/// Where a value is found.
#[derive(Clone, Copy, Debug)]
enum Found {
    Word(usize),
    Pair(usize),
    Bit(usize),
    /// Not in the list: among those that are read where they lie.
    Aside(usize),
}

/// As many entries fit between the list and its answers.
const MOST_ENTRIES: usize = (0x1790 - 0x1400 - 4) / 2;
/// What stands in the list behind the number of words.
const LIST_MARK: u8 = 0x81;

impl Watch {
    /// A list of these points, which are not sent yet.
    pub fn new(points: Vec<Point>) -> Watch {
        let mut watch = Watch { points, ..Watch::default() };
        let mut aside = 0;
        for point in watch.points.clone() {
            let found = watch.entered(point).unwrap_or_else(|| {
                aside += 1;
                Found::Aside(aside - 1)
            });
            watch.found.push(found);
        }
        watch
    }

    /// What is watched.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// How many exchanges brought the values of the last look. Those of one are of one moment between two scans; a PLC
    /// that runs may have scanned between any two of them.
    pub fn exchanges(&self) -> u64 {
        self.exchanges
    }

    /// Enters a point into the list, if it belongs there.
    fn entered(&mut self, point: Point) -> Option<Found> {
        let entries = self.words.len() + self.bits.len();
        let word_of = |device: Device| Extended::word(device).filter(|(_, width)| *width == 2);
        match point {
            _ if entries + 2 > MOST_ENTRIES || self.words.len() + 2 > 0xFF => None,
            Point::Bit(device, part) => {
                self.bits.push(Extended::bit(device, part)?.bit());
                Some(Found::Bit(self.bits.len() - 1))
            }
            Point::Word(device) => {
                self.words.push(word_of(device)?.0.byte());
                Some(Found::Word(self.words.len() - 1))
            }
            Point::Pair(device) => {
                let (low, _) = word_of(device)?;
                let (high, _) = word_of(Device::new(device.kind, device.number + 1))?;
                self.words.extend([low.byte(), high.byte()]);
                Some(Found::Pair(self.words.len() - 2))
            }
        }
    }

    fn aside(&self) -> Vec<Point> {
        let all = self.points.iter().zip(&self.found);
        all.filter(|(_, found)| matches!(found, Found::Aside(_))).map(|(point, _)| *point).collect()
    }

    fn list(&self) -> Vec<u8> {
        let counts = [self.words.len() as u8, LIST_MARK, self.bits.len() as u8, (self.bits.len() >> 8) as u8];
        let addresses = self.words.iter().chain(&self.bits).flat_map(|address| address.to_le_bytes());
        counts.into_iter().chain(addresses).collect()
    }

    fn result_bytes(&self) -> usize {
        // Reads of odd lengths belong to the line.
        (self.words.len() * 2 + self.bits.len().div_ceil(8)).next_multiple_of(2)
    }

    fn value(&self, found: Found, result: &[u8], aside: &[i64]) -> i64 {
        let word = |number: usize| match result.get(number * 2..number * 2 + 2) {
            Some([low, high]) => u16::from_le_bytes([*low, *high]),
            _ => 0,
        };
        match found {
            Found::Word(number) => i64::from(word(number) as i16),
            Found::Pair(number) => {
                i64::from((u32::from(word(number + 1)) << 16 | u32::from(word(number))) as i32)
            }
            Found::Bit(number) => {
                let byte = result.get(self.words.len() * 2 + number / 8).copied().unwrap_or(0);
                i64::from(byte >> (number % 8) & 1)
            }
            Found::Aside(number) => aside.get(number).copied().unwrap_or(0),
        }
    }
}

impl<T: Transport> Host<T> {
    /// The values of all that is watched, in the order of the points; of bits 0 or 1. Each 64 bytes of them are from
    /// one moment, 512 bits or 32 words; [`Watch::exchanges`] says then how many moments there were.
    ///
    /// # Errors
    /// If there is no such device, or the line fails.
    pub fn poll(&mut self, watch: &mut Watch) -> Result<Vec<i64>, LinkError> {
        if self.dialect() == Dialect::Plain {
            let before = self.line.exchanges();
            let values = self.read(&watch.points)?;
            watch.exchanges = self.line.exchanges() - before;
            return Ok(values);
        }
        for point in &watch.points {
            Place::of::<Extended>(*point)?;
        }
        if !watch.is_registered {
            self.register(watch)?;
        }
        let mut before = self.line.exchanges();
        let result = match self.result(watch) {
            // A PLC that has lost the list, as after a change of its mode, says no.
            Err(LinkError::Refused { .. }) => {
                self.register(watch)?;
                before = self.line.exchanges();
                self.result(watch)?
            }
            other => other?,
        };
        let aside = self.read(&watch.aside())?;
        watch.exchanges = self.line.exchanges() - before;
        Ok(watch.found.iter().map(|found| watch.value(*found, &result, &aside)).collect())
    }

    fn register(&mut self, watch: &mut Watch) -> Result<(), LinkError> {
        for (number, piece) in watch.list().chunks(MOST_DATA).enumerate() {
            self.line.ask(&Extended::WATCH_LIST.behind(number * MOST_DATA).write(piece))?;
        }
        watch.is_registered = true;
        Ok(())
    }

    fn result(&mut self, watch: &Watch) -> Result<Vec<u8>, LinkError> {
        let length = watch.result_bytes();
        let mut result = Vec::with_capacity(length);
        while result.len() < length {
            let piece = (length - result.len()).min(MOST_DATA);
            result.extend(self.line.read(&Extended::WATCH_RESULT.behind(result.len()).read(piece))?);
        }
        Ok(result)
    }
}

impl Point {
    /// The point that a contact, or the word of an operand, reads.
    pub fn of_device(device: Device) -> Option<Point> {
        match device.kind {
            kind if kind.is_bit() => Some(Point::Bit(device, Part::Contact)),
            kind if kind.is_word() => Some(Point::Word(device)),
            _ => None,
        }
    }
}
