//! Timers and counters: what their coils do in a scan.
//!
//! A timer counts only while its coil has power in one scan after the other. Its current value is time in its units;
//! what is beyond a whole unit is kept beside it. A contact closes in the scan in which its coil is executed, not
//! between; only timers for routines go on without it. Sources: the FX programming manuals on timers and counters; that
//! a preset of 0 works as 1, and that a counter whose RST is driven does not count, is theirs as well.

use super::code::{Counter, Timer};
use super::layout::{NS_BEYOND, PRESET, RESET, SCAN_SEEN, WRITTEN};
use super::{Lanes, Layout, Memory, Slot};
use crate::target::{Device, DeviceKind};

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
    // Without power it is held at 0, which it is unless one of these says otherwise.
    let (contact, written) = (memory.cell(timer.contact), memory.cell(timer.contact + WRITTEN));
    if (power | before | contact | written) == L::NONE {
        return;
    }
    memory.set_cell(timer.contact + WRITTEN, L::NONE);
    let reset = memory.cell(timer.contact + RESET);
    let mut contact = contact;
    for lane in 0..L::COUNT {
        if !power.lane(lane) {
            if !timer.is_retentive {
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
        let unit_ns = unit_ns(timer, memory, lane);
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

/// Nanoseconds that a timer counts.
fn unit_ns<L: Lanes>(timer: Timer, memory: &Memory<L>, lane: usize) -> i64 {
    match timer.finer {
        Some(relay) if memory.bit(relay, lane) => 10 * MS,
        _ => i64::from(timer.unit_ms.max(1)) * MS,
    }
}

/// Lets a timer of routines go on at the end of a scan that did not come to its coil, while that has power. The
/// contact of those that count 1 ms closes at their coil only. Source: the sections on timers in routines of the FX
/// programming manuals; that they go on as well while CJ leaves their coils out is theirs of CJ.
pub(super) fn routine_timer<L: Lanes>(memory: &mut Memory<L>, of: Timer, moment: Moment) {
    let coil = memory.cell(of.coil);
    let is_left_out =
        |lane: &usize| coil.lane(*lane) && memory.word(of.current + SCAN_SEEN, *lane) != moment.scan;
    if coil == L::NONE || !(0..L::COUNT).any(|lane| is_left_out(&lane)) {
        return;
    }
    let contact = memory.cell(of.contact);
    timer(memory, of, coil, moment);
    if of.unit_ms == 1 {
        memory.set_cell(of.contact, contact);
    }
}

/// Writes a register, or the current value of a timer or counter. What is written to a timer is whole units, and its
/// coil sees it.
pub(super) fn store<L: Lanes>(
    memory: &mut Memory<L>,
    layout: &Layout,
    (slot, device): (Slot, Device),
    lane: usize,
    value: i64,
) {
    memory.set_word(slot, lane, value);
    if device.kind == DeviceKind::T {
        memory.set_word(slot + NS_BEYOND, lane, 0);
        if let Some(contact) = layout.cell(device) {
            memory.set_bit(contact + WRITTEN, lane, true);
        }
    }
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
            None => {
                // A count that was written beyond the preset comes back to it.
                let next = (current + 1).min(preset.max(1));
                (next, (next >= preset.max(1)).then_some(true))
            }
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
