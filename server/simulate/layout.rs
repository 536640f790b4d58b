//! Where devices lie in the memory of the simulated PLC.

use super::clock::CLOCK_SLOTS;
use super::row::{CELLS, Cell, Row};
use crate::target::{Device, DeviceKind, Latches, Target};
use std::ops::Range;

/// A place in the memory of words.
pub type Slot = u32;

/// Where each device of a target lies, and the real-time clock behind them. Where they lie depends on the target alone.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Layout {
    kinds: [Vec<Run>; DeviceKind::ALL.len()],
    cells: usize,
    slots: usize,
    clock: Slot,
}

/// Devices that lie one behind the other.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Run {
    first: u32,
    last: u32,
    /// Of relays, timers and counters the cells.
    cells: usize,
    /// Of registers, timers and counters the slots.
    slots: usize,
    /// Whether they keep their values when the CPU leaves RUN.
    latched: bool,
    bits: u8,
}

/// Behind the contact of a timer or counter lie its coil, its reset, which is on while RST drives it, and whether
/// something else than the coil has written the current value.
const CELLS_OF_COUNTER: usize = 4;
/// See [`CELLS_OF_COUNTER`].
pub(super) const RESET: Cell = 2;
/// See [`CELLS_OF_COUNTER`].
pub(super) const WRITTEN: Cell = 3;
/// Behind the current value of a timer lie the nanoseconds that are no whole unit yet, and the scan in which its coil
/// had power last.
pub(super) const SLOTS_OF_TIMER: usize = 3;
/// See [`SLOTS_OF_TIMER`].
pub(super) const NS_BEYOND: Slot = 1;
/// See [`SLOTS_OF_TIMER`].
pub(super) const SCAN_SEEN: Slot = 2;
/// Behind the current value of a high-speed counter lies the preset that its coil had last.
pub(super) const PRESET: Slot = 1;

/// The index register that a special register is: D8028 and D8029 are Z0 and V0, D8182 to D8195 are Z1, V1, Z2 and so
/// on to V7. Source: the device tables of the FX programming manuals, and the machine code, which has no other names.
pub(super) fn index_register(register: Device) -> Option<Device> {
    let number = match (register.kind, register.number) {
        (DeviceKind::D, number @ 8028..=8029) => number - 8028,
        (DeviceKind::D, number @ 8182..=8195) => number - 8180,
        _ => return None,
    };
    let kind = if number % 2 == 0 { DeviceKind::Z } else { DeviceKind::V };
    Some(Device::new(kind, number / 2))
}

impl Layout {
    /// The memory of `target`, of which `latches` are kept.
    pub fn new(target: &Target, latches: &Latches) -> Layout {
        let cells = usize::from(Row::OFF) + 1;
        let mut layout = Layout { kinds: Default::default(), cells, slots: 0, clock: 0 };
        for range in target.devices {
            let kind = range.kind;
            let (cells, slots) = match kind {
                DeviceKind::T | DeviceKind::C => (CELLS_OF_COUNTER, SLOTS_OF_TIMER),
                _ if kind.is_bit() => (1, 0),
                _ if kind.is_word() => (0, 1),
                _ => continue,
            };
            for (numbers, latched) in latches.runs(range, target) {
                let (first, last) = numbers.into_inner();
                let run =
                    Run { first, last, cells: layout.cells, slots: layout.slots, latched, bits: range.bits };
                layout.kinds[kind as usize].push(run);
                let count = (last - first + 1) as usize;
                layout.cells += cells * count;
                layout.slots += slots * count;
            }
        }
        layout.clock = layout.slots as Slot;
        layout.slots += CLOCK_SLOTS;
        debug_assert!(layout.cells < CELLS / 2, "most cells are left to the program");
        layout
    }

    /// How many cells devices take, with those that every program has.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// How many words devices take.
    pub fn slots(&self) -> usize {
        self.slots
    }

    /// The relay, or the contact of the timer or counter.
    pub fn cell(&self, device: Device) -> Option<Cell> {
        let run = self.run(device)?;
        let offset = (device.number - run.first) as usize;
        let offset = match device.kind {
            DeviceKind::T | DeviceKind::C => offset * CELLS_OF_COUNTER,
            kind if kind.is_bit() => offset,
            _ => return None,
        };
        Some((run.cells + offset) as Cell)
    }

    /// The coil of a timer or counter.
    pub fn coil(&self, device: Device) -> Option<Cell> {
        self.cell(device).filter(|_| device.kind.has_preset()).map(|contact| contact + 1)
    }

    /// The register, or the current value of the timer or counter. D8028 is Z0, as [`index_register`] says.
    pub fn slot(&self, device: Device) -> Option<Slot> {
        let device = index_register(device).unwrap_or(device);
        let run = self.run(device)?;
        let offset = (device.number - run.first) as usize;
        let offset = match device.kind {
            DeviceKind::T | DeviceKind::C => offset * SLOTS_OF_TIMER,
            kind if kind.is_word() => offset,
            _ => return None,
        };
        Some((run.slots + offset) as Slot)
    }

    /// The first of [`CLOCK_SLOTS`] slots of the real-time clock.
    pub(super) fn clock(&self) -> Slot {
        self.clock
    }

    /// Whether the device is a counter or a register of 32 bits.
    pub fn is_wide(&self, device: Device) -> bool {
        self.run(device).is_some_and(|run| run.bits == 32)
    }

    /// What the register, or the current value of the timer or counter, holds of a number.
    pub(super) fn held(&self, device: Device, value: i64) -> i64 {
        if self.is_wide(device) { i64::from(value as i32) } else { i64::from(value as i16) }
    }

    /// All cells and all slots of a device, also those of which only the simulator knows.
    pub(super) fn whole(&self, device: Device) -> (Range<usize>, Range<usize>) {
        let is_counted = device.kind.has_preset();
        let (cells, slots) = if is_counted { (CELLS_OF_COUNTER, SLOTS_OF_TIMER) } else { (1, 1) };
        let cell = self.cell(device).map_or(0..0, |cell| usize::from(cell)..usize::from(cell) + cells);
        let slot = self.slot(device).map_or(0..0, |slot| slot as usize..slot as usize + slots);
        (cell, slot)
    }

    /// The cells of inputs, or of outputs, one behind the other in the order of their numbers.
    pub fn terminals(&self, kind: DeviceKind) -> Range<usize> {
        match self.kinds[kind as usize].first() {
            Some(run) => run.cells..run.cells + (run.last - run.first + 1) as usize,
            None => 0..0,
        }
    }

    /// Whether it is there.
    pub fn has(&self, device: Device) -> bool {
        self.run(device).is_some()
    }

    /// The device that lies in a cell; coils of timers and counters are those.
    pub fn device_of_cell(&self, cell: Cell) -> Option<Device> {
        let cell = usize::from(cell);
        self.find(|kind, run| {
            let each = if kind.has_preset() { CELLS_OF_COUNTER } else { usize::from(kind.is_bit()) };
            (each > 0 && run.cells <= cell).then(|| ((cell - run.cells) / each) as u32)
        })
    }

    /// The device that lies in a slot.
    pub fn device_of_slot(&self, slot: Slot) -> Option<Device> {
        let slot = slot as usize;
        self.find(|kind, run| {
            let each = if kind.has_preset() { SLOTS_OF_TIMER } else { usize::from(kind.is_word()) };
            (each > 0 && run.slots <= slot).then(|| ((slot - run.slots) / each) as u32)
        })
    }

    /// The devices that forget their values when the CPU leaves RUN.
    pub fn forgetful(&self) -> impl Iterator<Item = Device> {
        self.all(|run| !run.latched)
    }

    /// The devices that keep them, those that lie one behind the other together: all of their cells and slots.
    pub(super) fn latched_runs(&self) -> impl Iterator<Item = (DeviceKind, Range<usize>, Range<usize>)> {
        DeviceKind::ALL.into_iter().flat_map(move |kind| {
            let (cells, slots) = match kind {
                _ if kind.has_preset() => (CELLS_OF_COUNTER, SLOTS_OF_TIMER),
                _ if kind.is_bit() => (1, 0),
                _ => (0, 1),
            };
            self.kinds[kind as usize].iter().filter(|run| run.latched).map(move |run| {
                let count = (run.last - run.first + 1) as usize;
                (kind, run.cells..run.cells + cells * count, run.slots..run.slots + slots * count)
            })
        })
    }

    /// The devices that keep them.
    pub fn latched(&self) -> impl Iterator<Item = Device> {
        self.all(|run| run.latched)
    }

    /// All devices with a value.
    pub fn devices(&self) -> impl Iterator<Item = Device> {
        self.all(|_| true)
    }

    /// The registers of the system. They are asked for at each start of a PLC, so others are not looked at.
    pub(super) fn special_registers(&self) -> impl Iterator<Item = Device> {
        let register = |number| Device::new(DeviceKind::D, number);
        let runs = self.kinds[DeviceKind::D as usize].iter();
        let runs = runs.filter(move |run| register(run.last).is_special());
        runs.flat_map(move |run| (run.first..=run.last).map(register))
            .filter(|register| register.is_special())
    }

    fn all(&self, wanted: impl Fn(&Run) -> bool) -> impl Iterator<Item = Device> {
        DeviceKind::ALL.into_iter().flat_map(move |kind| {
            let runs: Vec<Run> =
                self.kinds[kind as usize].iter().filter(|run| wanted(run)).copied().collect();
            runs.into_iter()
                .flat_map(move |run| (run.first..=run.last).map(move |number| Device::new(kind, number)))
        })
    }

    fn find(&self, offset: impl Fn(DeviceKind, &Run) -> Option<u32>) -> Option<Device> {
        let all = DeviceKind::ALL
            .into_iter()
            .flat_map(|kind| self.kinds[kind as usize].iter().map(move |run| (kind, run)));
        all.filter_map(|(kind, run)| {
            let offset = offset(kind, run)?;
            (offset <= run.last - run.first).then(|| Device::new(kind, run.first + offset))
        })
        .next()
    }

    fn run(&self, device: Device) -> Option<&Run> {
        self.kinds[device.kind as usize]
            .iter()
            .find(|run| run.first <= device.number && device.number <= run.last)
    }
}
