//! The monitor of annunciators: while M8049 is on, M8048 tells that one of S900 to S999 is on and D8049 which one.

use super::{Lanes, Layout, Memory};
use crate::target::{Device, DeviceKind};

/// The states that are annunciators.
const ANNUNCIATORS: std::ops::RangeInclusive<u32> = 900..=999;

/// Writes M8048, and D8049 while it is watched, at the start of a scan.
pub(super) fn monitor<L: Lanes>(memory: &mut Memory<L>, layout: &Layout) {
    let relay = |number| layout.cell(Device::new(DeviceKind::M, number));
    let (Some(any), Some(watched)) = (relay(8048), relay(8049)) else { return };
    let Some(lowest) = layout.slot(Device::new(DeviceKind::D, 8049)) else { return };
    let watched = memory.cell(watched);
    let mut on = L::NONE;
    if watched != L::NONE {
        for lane in (0..L::COUNT).filter(|lane| watched.lane(*lane)) {
            memory.set_word(lowest, lane, 0);
        }
        for number in ANNUNCIATORS {
            let Some(cell) = layout.cell(Device::new(DeviceKind::S, number)) else { continue };
            let first = memory.cell(cell) & watched & !on;
            on = on | first;
            for lane in (0..L::COUNT).filter(|lane| first.lane(*lane)) {
                memory.set_word(lowest, lane, i64::from(number));
            }
        }
    }
    memory.set_cell(any, on);
}
