//! Pulses faster than the scan: high-speed counters, and what watches them.
//!
//! All pulses between two scans are counted when the second one begins, by the coils and comparisons of the first.
//! Which inputs belong to which counter is the same on all FX models; the source is their programming manuals.

use super::layout::{PRESET, RESET};
use super::{Lanes, Machine, Slot};
use crate::target::outside::{FIRST_HIGH_SPEED, Watch, WatchDeed};
use crate::target::{Device, DeviceKind};

/// The inputs of a high-speed counter.
struct Wiring {
    /// Where pulses arrive that count in the direction of its relay, or up where there is a second input; phase A.
    pulses: u8,
    /// Where pulses arrive that count down; phase B.
    down: Option<u8>,
    /// Resets it while it is on.
    reset: Option<u8>,
    /// Lets it count while it is on.
    start: Option<u8>,
}

const fn wired(pulses: u8, down: Option<u8>, reset: Option<u8>, start: Option<u8>) -> Wiring {
    Wiring { pulses, down, reset, start }
}

/// From C235 on. The last five have two phases, of which the levels tell, and not pulses at single inputs.
const WIRING: [Wiring; 21] = [
    wired(0, None, None, None),
    wired(1, None, None, None),
    wired(2, None, None, None),
    wired(3, None, None, None),
    wired(4, None, None, None),
    wired(5, None, None, None),
    wired(0, None, Some(1), None),
    wired(2, None, Some(3), None),
    wired(4, None, Some(5), None),
    wired(0, None, Some(1), Some(6)),
    wired(2, None, Some(3), Some(7)),
    wired(0, Some(1), None, None),
    wired(0, Some(1), Some(2), None),
    wired(3, Some(4), Some(5), None),
    wired(0, Some(1), Some(2), Some(6)),
    wired(3, Some(4), Some(5), Some(7)),
    wired(0, Some(1), None, None),
    wired(0, Some(1), Some(2), None),
    wired(3, Some(4), Some(5), None),
    wired(0, Some(1), Some(2), Some(6)),
    wired(3, Some(4), Some(5), Some(7)),
];

/// Counters whose direction the program chooses: C235 to C245.
const ONE_PHASE: u32 = 245;
/// Counters with an input for each direction: up to C250.
const TWO_INPUTS: u32 = 250;
/// The relay that makes C251, C252 and C254 count every edge; the next one is that of C253 and C255.
const EVERY_EDGE: u32 = 8198;

/// Pulses for one counter in a scan; more are lost.
const MOST_PULSES: i64 = 1_000_000;

/// A counter that counts.
#[derive(Clone, Copy)]
struct HighSpeed {
    number: u32,
    slot: Slot,
    preset: i32,
    lane: usize,
}

impl<L: Lanes> Machine<L> {
    /// Lets pulses arrive before the next scan, in all scenarios: at an input from X0 to X7, or for a counter from C235
    /// to C255 whatever its inputs, where a negative number is pulses backwards; C235 to C245 take their direction from
    /// their relays. The coil must be driven.
    pub fn pulse(&mut self, device: Device, count: i32) {
        for outside in &mut self.outside {
            match device.kind {
                DeviceKind::X => outside.pulse_input(device.number, count.max(0) as u32),
                DeviceKind::C => outside.pulse_counter(device.number, count),
                _ => {}
            }
        }
    }

    /// Counts the pulses that arrived before this scan; `before` are the inputs from X0 on in the scan before it.
    pub(super) fn count_pulses(&mut self, before: [L; 8]) {
        for lane in 0..L::COUNT {
            let watches = self.outside[lane].take_watches();
            for (wiring, number) in WIRING.iter().zip(FIRST_HIGH_SPEED..) {
                let device = Device::new(DeviceKind::C, number);
                let layout = &self.code.layout;
                let (Some(coil), Some(contact), Some(slot)) =
                    (layout.coil(device), layout.cell(device), layout.slot(device))
                else {
                    continue;
                };
                let fed = self.outside[lane].take_counting(number);
                if !self.memory.bit(coil, lane) || self.memory.bit(contact + RESET, lane) {
                    continue;
                }
                let preset = self.memory.word(slot + PRESET, lane) as i32;
                self.count(HighSpeed { number, slot, preset, lane }, wiring, fed, before, &watches);
            }
        }
    }

    fn count(&mut self, counter: HighSpeed, wiring: &Wiring, fed: i32, before: [L; 8], watches: &[Watch]) {
        let HighSpeed { number, slot, lane, .. } = counter;
        if wiring.reset.is_some_and(|x| self.is_input_on(x, lane)) {
            // It acts as RST does.
            self.memory.set_word(slot, lane, 0);
            if let Some(contact) = self.code.layout.cell(Device::new(DeviceKind::C, number)) {
                self.memory.set_bit(contact, lane, false);
            }
            return;
        }
        let is_started = wiring.start.is_none_or(|x| self.is_input_on(x, lane));
        let arrived = |x: u8| {
            let is_counted = is_started && number <= TWO_INPUTS;
            if is_counted { i64::from(self.outside[lane].arrived[usize::from(x)]) } else { 0 }
        };
        let (up, down) = (arrived(wiring.pulses), wiring.down.map_or(0, arrived));
        let relay = self.code.layout.cell(Device::new(DeviceKind::M, 8000 + number));
        let turned = if is_started { self.turned(number, wiring, before, lane) } else { 0 };
        let fed = i64::from(fed) + turned;
        let pulses = if number <= ONE_PHASE {
            let is_down = relay.is_some_and(|relay| self.memory.bit(relay, lane));
            let pulses = up + fed.abs();
            if is_down { -pulses } else { pulses }
        } else {
            up - down + fed
        };
        if pulses == 0 {
            return;
        }
        if let Some(relay) = relay.filter(|_| number > ONE_PHASE) {
            self.memory.set_bit(relay, lane, pulses < 0);
        }
        self.advance(counter, pulses.clamp(-MOST_PULSES, MOST_PULSES), watches);
    }

    /// What two phases count. While A is on, B going on counts up and B going off counts down, as the FX programming
    /// manuals say; every edge counts where a relay wants that. Of two phases that change in one scan nobody knows
    /// which was first: they count nothing.
    fn turned(&self, number: u32, wiring: &Wiring, before: [L; 8], lane: usize) -> i64 {
        let (Some(b), true) = (wiring.down, number > TWO_INPUTS) else { return 0 };
        let was = [wiring.pulses, b].map(|x| before[usize::from(x)].lane(lane));
        let is = [wiring.pulses, b].map(|x| self.is_input_on(x, lane));
        let relay = Device::new(DeviceKind::M, EVERY_EDGE + u32::from(matches!(number, 253 | 255)));
        let counts_edges = self.code.layout.cell(relay).is_some_and(|relay| self.memory.bit(relay, lane));
        let way = |is_up: bool| if is_up { 1 } else { -1 };
        match (was, is) {
            ([true, was], [true, is]) if was != is => way(is),
            _ if !counts_edges => 0,
            // A leads upwards.
            ([false, was], [false, is]) if was != is => way(!is),
            ([was, false], [is, false]) if was != is => way(is),
            ([was, true], [is, true]) if was != is => way(!is),
            _ => 0,
        }
    }

    fn is_input_on(&self, x: u8, lane: usize) -> bool {
        let cell = self.code.layout.cell(Device::new(DeviceKind::X, u32::from(x)));
        cell.is_some_and(|cell| self.memory.bit(cell, lane))
    }

    /// Counts on, from one count at which something happens to the next.
    fn advance(&mut self, counter: HighSpeed, pulses: i64, watches: &[Watch]) {
        let HighSpeed { number, slot, preset, lane } = counter;
        let is_down = pulses < 0;
        let contact = self.code.layout.cell(Device::new(DeviceKind::C, number));
        // Upwards the contact closes at the preset, downwards it opens when the preset is left.
        let turns = if is_down { preset.wrapping_sub(1) } else { preset };
        let watches = watches.iter().filter(|watch| watch.counter == number);
        let mut left = pulses.abs();
        while left > 0 {
            let current = self.memory.word(slot, lane) as i32;
            let distance = |count: i32| {
                let way = if is_down { current.wrapping_sub(count) } else { count.wrapping_sub(current) };
                match i64::from(way as u32) {
                    0 => 1 << 32,
                    way => way,
                }
            };
            let counts = watches.clone().filter_map(|watch| match watch.deed {
                WatchDeed::Set(count, _) | WatchDeed::Reset(count, _) => Some(count),
                WatchDeed::Zone(..) => None,
            });
            let step = counts.chain([turns]).map(distance).min().unwrap_or(left).min(left);
            left -= step;
            let way = if is_down { -step } else { step };
            let next = current.wrapping_add(way as i32);
            self.memory.set_word(slot, lane, i64::from(next));
            if let Some(contact) = contact.filter(|_| next == turns) {
                self.memory.set_bit(contact, lane, !is_down);
            }
            for watch in watches.clone() {
                self.act(watch.deed, next, lane);
            }
        }
        let current = self.memory.word(slot, lane) as i32;
        for watch in watches {
            self.compare_zone(watch.deed, current, lane);
        }
    }

    fn act(&mut self, deed: WatchDeed, current: i32, lane: usize) {
        match deed {
            WatchDeed::Set(count, device) if count == current && device.kind == DeviceKind::I => {
                self.interrupts.ask(device.number);
            }
            WatchDeed::Set(count, device) if count == current => self.switch(device, true, lane),
            WatchDeed::Reset(count, device) if count == current => {
                self.switch(device, false, lane);
                if let Some(slot) = self.code.layout.slot(device) {
                    self.memory.set_word(slot, lane, 0);
                }
            }
            _ => {}
        }
    }

    fn compare_zone(&mut self, deed: WatchDeed, current: i32, lane: usize) {
        let WatchDeed::Zone(lower, upper, first) = deed else { return };
        let holds = [current < lower, lower <= current && current <= upper, current > upper];
        for (on, number) in holds.into_iter().zip(first.number..) {
            self.switch(Device::new(first.kind, number), on, lane);
        }
    }

    /// Switches a relay, and its output terminal with it.
    fn switch(&mut self, device: Device, on: bool, lane: usize) {
        let Some(cell) = self.code.layout.cell(device) else { return };
        self.memory.set_bit(cell, lane, on);
        if device.kind == DeviceKind::Y {
            self.terminals.refresh(&mut self.memory, &self.outside[lane], cell, lane);
        }
    }
}
