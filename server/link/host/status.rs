//! How a PLC is: its mode, its memory, what has gone wrong.

use super::{Host, Point};
use crate::link::{LinkError, Mode, Part, Transport};
use crate::machine_code::ParameterBlock;
use crate::target::{Device, DeviceKind};

/// How a PLC is.
#[derive(Clone, PartialEq, Debug)]
pub struct Status {
    /// What the CPU does.
    pub mode: Mode,
    /// Its parameters.
    pub parameters: ParameterBlock,
    /// The time of the last scan, in milliseconds.
    pub scan_time_ms: f64,
    /// What has gone wrong.
    pub errors: Vec<StatusError>,
}

/// Something that has gone wrong in a PLC.
#[derive(Clone, PartialEq, Eq, Debug, serde::Serialize)]
pub struct StatusError {
    /// The register with the number of the error.
    pub register: String,
    /// That number.
    pub code: i64,
}

/// The relays that tell of errors; the registers of the same numbers tell which.
const ERRORS: std::ops::RangeInclusive<u32> = 8060..=8068;
/// The time of the last scan in tenths of a millisecond.
const SCAN_TIME: Device = Device::new(DeviceKind::D, 8010);

impl<T: Transport> Host<T> {
    /// How the PLC is.
    ///
    /// # Errors
    /// If the line fails.
    pub fn status(&mut self) -> Result<Status, LinkError> {
        let mode = self.mode()?;
        let parameters = self.raw_parameters()?;
        let relays = ERRORS.map(|number| Point::Bit(Device::new(DeviceKind::M, number), Part::Contact));
        let registers = ERRORS.map(|number| Point::Word(Device::new(DeviceKind::D, number)));
        let points: Vec<Point> = relays.chain(registers).chain([Point::Word(SCAN_TIME)]).collect();
        let values = self.read(&points)?;
        let count = ERRORS.count();
        let error = |number: usize| {
            let is_on = values[number] != 0;
            is_on.then(|| StatusError {
                register: points[count + number].to_string(),
                code: values[count + number],
            })
        };
        Ok(Status {
            mode,
            parameters,
            scan_time_ms: values.last().map_or(0.0, |tenths| *tenths as f64 / 10.0),
            errors: (0..count).filter_map(error).collect(),
        })
    }
}
