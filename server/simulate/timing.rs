//! Timers and counters: what their coils do in a scan.
//!
//! A timer counts only while its coil has power in one scan after the other. Its current value is time in its units;
//! what is beyond a whole unit is kept beside it. A contact closes in the scan in which its coil is executed, not
//! between. Sources: the FX programming manuals on timers and counters; that a preset of 0 works as 1, and that a
//! counter whose RST is driven does not count, is theirs as well.

use super::code::{Counter, Timer};
use super::layout::{NS_BEYOND, PRESET, RESET, SCAN_SEEN};
use super::{Lanes, Memory};

/// Nanoseconds in a millisecond.
const MS: i64 = 1_000_000;

/// When a scan is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// Its number, from 1 on.
    pub(super) scan: i64,
    /// Since the scan before, in nanoseconds.
    pub(super) elapsed_ns: i64,
}

/// Executes the coil of a timer with `power`.
pub(super) fn timer<L: Lanes>(memory: &mut Memory<L>, timer: Timer, power: L, moment: Moment) {
    let before = memory.cell(timer.coil);
    memory.set_cell(timer.coil, power);
    if (power | before) == L::NONE {
        return;
    }
    let reset = memory.cell(timer.contact + RESET);
    let mut contact = memory.cell(timer.contact);
    for lane in 0..L::COUNT {
        if !power.lane(lane) {
            if before.lane(lane) && !timer.is_retentive {
                contact = contact.with(lane, false);
                memory.set_word(timer.current, lane, 0);
                memory.set_word(timer.current + NS_BEYOND, lane, 0);
            }
            continue;
        }
        let seen = memory.word(timer.current + SCAN_SEEN, lane);
        memory.set_word(timer.current + SCAN_SEEN, lane, moment.scan);
        if contact.lane(lane) || reset.lane(lane) {
            continue;
        }
        let unit_ns = i64::from(timer.unit_ms.max(1)) * MS;
        let runs_on = before.lane(lane) && seen + 1 == moment.scan;
        let passed = if runs_on { moment.elapsed_ns } else { 0 };
        let beyond = memory.word(timer.current + NS_BEYOND, lane);
        let time_ns = memory.word(timer.current, lane) * unit_ns + beyond + passed;
        let preset = timer.preset.value(memory, lane).max(1);
        let is_done = time_ns >= preset * unit_ns;
        contact = contact.with(lane, is_done);
        let (units, rest) = if is_done { (preset, 0) } else { (time_ns / unit_ns, time_ns % unit_ns) };
        memory.set_word(timer.current, lane, units);
        memory.set_word(timer.current + NS_BEYOND, lane, rest);
    }
    memory.set_cell(timer.contact, contact);
}

/// Executes the coil of a counter with `power`.
pub(super) fn counter<L: Lanes>(memory: &mut Memory<L>, counter: Counter, power: L) {
    let before = memory.cell(counter.coil);
    memory.set_cell(counter.coil, power);
    let counts = power & !before & !memory.cell(counter.contact + RESET);
    if counts == L::NONE {
        return;
    }
    let mut contact = memory.cell(counter.contact);
    for lane in (0..L::COUNT).filter(|lane| counts.lane(*lane)) {
        let current = memory.word(counter.current, lane);
        let preset = counter.preset.value(memory, lane);
        let (next, is_on) = match counter.down {
            // A ring of 32 bits: it goes on beyond its preset, and the contact follows the direction.
            Some(down) if memory.bit(down, lane) => {
                (i64::from((current as i32).wrapping_sub(1)), (current == preset).then_some(false))
            }
            Some(_) => {
                let next = i64::from((current as i32).wrapping_add(1));
                (next, (next == preset).then_some(true))
            }
            None if contact.lane(lane) => continue,
            None => (current + 1, (current + 1 >= preset.max(1)).then_some(true)),
        };
        memory.set_word(counter.current, lane, next);
        if let Some(is_on) = is_on {
            contact = contact.with(lane, is_on);
        }
    }
    memory.set_cell(counter.contact, contact);
}

/// Executes the coil of a high-speed counter with `power`: later pulses are counted by the preset that it has now.
pub(super) fn high_speed<L: Lanes>(memory: &mut Memory<L>, counter: Counter, power: L) {
    memory.set_cell(counter.coil, power);
    for lane in (0..L::COUNT).filter(|lane| power.lane(*lane)) {
        let preset = counter.preset.value(memory, lane);
        memory.set_word(counter.current + PRESET, lane, preset);
    }
}
