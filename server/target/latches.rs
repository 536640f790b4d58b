//! Which devices keep their values without power, where the parameters of a PLC set that.

use super::{Device, DeviceKind, DeviceRange, Model, Target};
use std::ops::RangeInclusive;

/// Devices of an FX2N of which the parameters say one range that is latched. Others are always latched, or never.
/// Source: the lists of devices in the FX programming manuals.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Latch {
    /// M0 to M1023.
    Relays,
    /// S0 to S999.
    States,
    /// Counters of 16 bits: C0 to C199.
    Counters,
    /// Counters of 32 bits: C200 to C255.
    WideCounters,
    /// D0 to D511.
    Registers,
}

impl Latch {
    /// All of them.
    pub const ALL: [Latch; 5] =
        [Latch::Relays, Latch::States, Latch::Counters, Latch::WideCounters, Latch::Registers];

    /// The kind and the numbers of these devices.
    pub const fn devices(self) -> (DeviceKind, RangeInclusive<u32>) {
        match self {
            Latch::Relays => (DeviceKind::M, 0..=1023),
            Latch::States => (DeviceKind::S, 0..=999),
            Latch::Counters => (DeviceKind::C, 0..=199),
            Latch::WideCounters => (DeviceKind::C, 200..=255),
            Latch::Registers => (DeviceKind::D, 0..=511),
        }
    }

    /// Those to which a device belongs, if its latch can be set at all.
    pub fn of(device: Device) -> Option<Latch> {
        Latch::ALL.into_iter().find(|latch| {
            let (kind, numbers) = latch.devices();
            kind == device.kind && numbers.contains(&device.number)
        })
    }
}

/// Which devices keep their values without power: those that a new PLC keeps, but for what was set.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Latches {
    /// The numbers of the first and the last one.
    set: [Option<(u32, u32)>; Latch::ALL.len()],
}

impl Latches {
    /// With this range in place of that of a new PLC. None is latched where the first stands behind the last.
    pub fn with(mut self, latch: Latch, first: Device, last: Device) -> Latches {
        self.set[latch as usize] = Some((first.number, last.number));
        self
    }

    /// Whether a PLC with these parameters keeps the device. Only those of an FX2N are followed.
    pub fn keep(&self, device: Device, target: &Target) -> bool {
        match Latch::of(device).and_then(|latch| self.range(latch, target)) {
            Some((first, last)) => (first..=last).contains(&device.number),
            None => device.range_on(target).is_some_and(|range| range.latched),
        }
    }

    /// The devices of a range of `target` in runs of which all are kept, or none, in order.
    pub fn runs(&self, range: &DeviceRange, target: &Target) -> Vec<(RangeInclusive<u32>, bool)> {
        let mut starts = vec![range.first, range.last + 1];
        for latch in Latch::ALL.into_iter().filter(|latch| latch.devices().0 == range.kind) {
            let Some((first, last)) = self.range(latch, target) else { continue };
            let (_, own) = latch.devices();
            starts.extend([*own.start(), first, last + 1, *own.end() + 1]);
        }
        starts.retain(|start| (range.first..=range.last + 1).contains(start));
        starts.sort_unstable();
        starts.dedup();
        let run = |ends: &[u32]| {
            let is_kept = self.keep(Device::new(range.kind, ends[0]), target);
            (ends[0]..=ends[1] - 1, is_kept)
        };
        starts.windows(2).map(run).collect()
    }

    fn range(&self, latch: Latch, target: &Target) -> Option<(u32, u32)> {
        self.set[latch as usize].filter(|_| target.model == Model::Fx2n)
    }
}
