//! Reading and writing devices.

use super::{Dialect, Host, Point};
use crate::link::address::{Address, Extended, Map, Part, Plain};
use crate::link::frame::MOST_DATA;
use crate::link::{LinkError, Transport};
use crate::target::{Device, DeviceKind, Target};

/// Bytes that it costs to ask once more, frames and digits included: what lies between two devices is read too, as long
/// as that is cheaper.
const GAP: usize = 8;
/// Relays that let a CPU run and stop, and a host write its program.
const ORDERS: [u32; 4] = [8035, 8036, 8037, 8118];

/// Where a point lies in a map: its first byte, how many there are, and the place of its bit.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) byte: u16,
    pub(super) length: u16,
    bit: Option<u8>,
}

impl Place {
    pub(super) fn of<M: Map>(point: Point) -> Result<Place, LinkError> {
        let none = || LinkError::NoDevice { device: point.to_string() };
        match point {
            Point::Bit(device, part) => {
                let (address, place) = M::bit(device, part).ok_or_else(none)?.byte();
                Ok(Place { byte: address.byte(), length: 1, bit: Some(place) })
            }
            Point::Word(device) => {
                let (address, width) = M::word(device).ok_or_else(none)?;
                Ok(Place { byte: address.byte(), length: width, bit: None })
            }
            Point::Pair(device) => {
                let (address, _) = M::word(device).ok_or_else(none)?;
                M::word(Device::new(device.kind, device.number + 1)).ok_or_else(none)?;
                Ok(Place { byte: address.byte(), length: 4, bit: None })
            }
        }
    }

    /// The value in bytes that begin where it does.
    fn value(self, bytes: &[u8]) -> i64 {
        match (self.bit, bytes) {
            (Some(bit), [byte, ..]) => i64::from(byte >> bit & 1),
            (None, [low, high]) => i64::from(i16::from_le_bytes([*low, *high])),
            (None, [a, b, c, d]) => i64::from(i32::from_le_bytes([*a, *b, *c, *d])),
            _ => 0,
        }
    }
}

impl Point {
    /// Sees whether somebody may write it in a PLC of this model.
    ///
    /// # Errors
    /// If the port does not reach it, or it is an order to the CPU.
    pub fn check_written(self, target: &Target) -> Result<(), LinkError> {
        match self {
            _ if !self.is_reached(target) => Err(LinkError::NoDevice { device: self.to_string() }),
            Point::Bit(relay, _) if relay.kind == DeviceKind::M && ORDERS.contains(&relay.number) => {
                Err(LinkError::IsOrder { device: relay.to_string() })
            }
            _ => Ok(()),
        }
    }
}

impl<T: Transport> Host<T> {
    /// The values of points, in their order; of bits 0 or 1.
    ///
    /// Devices near each other are read together, so those in one request are from one moment; others are not.
    ///
    /// # Errors
    /// If there is no such device, or the line fails.
    pub fn read(&mut self, points: &[Point]) -> Result<Vec<i64>, LinkError> {
        match self.dialect() {
            Dialect::Plain => self.read_in::<Plain>(points),
            Dialect::Extended => self.read_in::<Extended>(points),
        }
    }

    pub(super) fn read_in<M: Map>(&mut self, points: &[Point]) -> Result<Vec<i64>, LinkError> {
        let places: Vec<Place> =
            points.iter().map(|point| Place::of::<M>(*point)).collect::<Result<_, _>>()?;
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.sort_by_key(|number| places[*number].byte);
        let mut values = vec![0; points.len()];
        let mut rest = &order[..];
        while let Some(first) = rest.first() {
            let start = usize::from(places[*first].byte);
            let mut end = start;
            let is_near = |end: usize, place: Place| {
                let own_end = usize::from(place.byte + place.length);
                usize::from(place.byte) <= end + GAP && own_end - start <= MOST_DATA
            };
            let mut count = 0;
            while let Some(number) = rest.get(count).filter(|number| is_near(end, places[**number])) {
                end = end.max(usize::from(places[*number].byte + places[*number].length));
                count += 1;
            }
            let data = self.line.read(&Address::<M>::new(start as u16).read(end - start))?;
            for number in &rest[..count] {
                let at = usize::from(places[*number].byte) - start;
                let bytes = data.get(at..at + usize::from(places[*number].length)).unwrap_or_default();
                values[*number] = places[*number].value(bytes);
            }
            rest = &rest[count..];
        }
        Ok(values)
    }

    /// Writes a register or a current value, or switches a relay once; the program may write it again.
    ///
    /// # Errors
    /// See [`Point::check_written`], or if the line fails.
    pub fn write(&mut self, point: Point, value: i64) -> Result<(), LinkError> {
        point.check_written(self.identity.target)?;
        self.put(point, value)
    }

    fn put(&mut self, point: Point, value: i64) -> Result<(), LinkError> {
        match self.dialect() {
            Dialect::Plain => self.write_in::<Plain>(point, value),
            Dialect::Extended => self.write_in::<Extended>(point, value),
        }
    }

    fn write_in<M: Map>(&mut self, point: Point, value: i64) -> Result<(), LinkError> {
        let none = || LinkError::NoDevice { device: point.to_string() };
        let command = match point {
            Point::Bit(device, part) => M::bit(device, part).ok_or_else(none)?.force(value != 0),
            Point::Word(_) | Point::Pair(_) => {
                let place = Place::of::<M>(point)?;
                let bytes = value.to_le_bytes();
                Address::<M>::new(place.byte).write(&bytes[..usize::from(place.length)])
            }
        };
        self.line.ask(&command).map(|_| ())
    }

    /// Switches a special relay.
    pub(super) fn order(&mut self, number: u32, on: bool) -> Result<(), LinkError> {
        self.put(Point::Bit(Device::new(DeviceKind::M, number), Part::Contact), i64::from(on))
    }
}
