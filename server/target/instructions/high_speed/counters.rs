//! HSCS, HSCR, HSZ: they ask for what is done when a high-speed counter counts.

use crate::target::outside::{FIRST_HIGH_SPEED, Watch, WatchDeed};
use crate::target::{Device, DeviceKind, Execution, Fault};

fn counter(execution: &mut dyn Execution, place: usize) -> Result<u32, Fault> {
    match execution.device(place)? {
        Some(device) if device.kind == DeviceKind::C && device.number >= FIRST_HIGH_SPEED => {
            Ok(device.number)
        }
        _ => Err(Fault::Value(place as u8)),
    }
}

fn destination(execution: &mut dyn Execution, place: usize) -> Result<Device, Fault> {
    execution.device(place)?.ok_or(Fault::NoDevice(place as u8))
}

pub(super) fn set(execution: &mut dyn Execution) -> Result<(), Fault> {
    let deed = WatchDeed::Set(execution.double(0, 0)? as i32, destination(execution, 2)?);
    let counter = counter(execution, 1)?;
    execution.outside().watch(Watch { counter, deed });
    Ok(())
}

pub(super) fn reset(execution: &mut dyn Execution) -> Result<(), Fault> {
    let deed = WatchDeed::Reset(execution.double(0, 0)? as i32, destination(execution, 2)?);
    let counter = counter(execution, 1)?;
    execution.outside().watch(Watch { counter, deed });
    Ok(())
}

pub(super) fn zone(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (lower, upper) = (execution.double(0, 0)?, execution.double(1, 0)?);
    if lower > upper {
        return Err(Fault::Value(0));
    }
    let counter = counter(execution, 2)?;
    let first = destination(execution, 3)?;
    // M8130 and M8132 ask for the modes that follow a table.
    if first.kind == DeviceKind::M && matches!(first.number, 8130 | 8132) {
        return Err(Fault::TableMode);
    }
    execution.bit(3, 2)?;
    execution.outside().watch(Watch { counter, deed: WatchDeed::Zone(lower as i32, upper as i32, first) });
    Ok(())
}
