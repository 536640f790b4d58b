//! The real-time clock: D8013 to D8019, and the relays with which a program sets it.
//!
//! It starts at 2000-01-01 0:00:00, a Saturday, when the CPU comes to RUN first, and goes on with the time of the
//! scans. M8015 stops it, and what the registers hold when M8015 goes off is the new time; M8016 lets it go on behind
//! registers that stand still; M8017 rounds it to the nearest minute. Source: the sections on the real-time clock in
//! the FX programming manuals. That an impossible time leaves the clock as it was is decided here.

use super::{Lanes, Layout, Memory, Slot};
use crate::target::{Device, DeviceKind};

/// Whether a clock relay with this period, such as M8012 with 100 ms, is in its second half, in which it is on. One
/// whose half is shorter than a scan changes with every scan: a scan as long as its period would see it stand still.
pub(super) fn is_second_half(period_ms: i64, now_ns: i64, scan_ns: i64, scan: u64) -> bool {
    let half_ns = period_ms * 1_000_000 / 2;
    if scan_ns > half_ns { scan.is_multiple_of(2) } else { now_ns / half_ns % 2 == 1 }
}

/// Words of the clock, in the order of D8013 to D8019: second, minute, hour, day, month, year in four digits, day of
/// the week. Then come those below.
const FIELDS: usize = 7;
/// Nanoseconds beyond the second.
const BEYOND: Slot = 7;
/// 1 if M8015 was on in the scan before.
const WAS_STOPPED: Slot = 8;
/// 1 if M8017 was.
const WAS_ROUNDED: Slot = 9;
/// 1 if D8018 shows years in four digits.
const FOUR_DIGITS: Slot = 10;
/// All of them.
pub(super) const CLOCK_SLOTS: usize = 11;

/// A Saturday.
const START: [i64; FIELDS] = [0, 0, 0, 1, 1, 2000, 6];

const SECOND_NS: i64 = 1_000_000_000;
const DAY_SECONDS: i64 = 86_400;

/// The clock in a scenario.
struct Clock {
    fields: [i64; FIELDS],
    beyond_ns: i64,
}

/// Lets time pass at the start of the scan with this number, from 1.
pub(super) fn advance<L: Lanes>(memory: &mut Memory<L>, layout: &Layout, scan: u64, elapsed_ns: i64) {
    let relay = |number| layout.cell(Device::new(DeviceKind::M, number));
    let (Some(stop), Some(freeze), Some(round), Some(fitted), Some(wrong)) =
        (relay(8015), relay(8016), relay(8017), relay(8018), relay(8019))
    else {
        return;
    };
    let Some(registers) = layout.slot(Device::new(DeviceKind::D, 8013)) else { return };
    let at = layout.clock();
    memory.set_cell(fitted, L::ALL);
    for lane in 0..L::COUNT {
        let (is_stopped, is_rounded) = (memory.bit(stop, lane), memory.bit(round, lane));
        let was_stopped = memory.word(at + WAS_STOPPED, lane) != 0;
        let was_rounded = memory.word(at + WAS_ROUNDED, lane) != 0;
        let mut clock = Clock::load(memory, at, lane);
        if scan == 2 && memory.word(registers + 5, lane) == 2000 {
            memory.set_word(at + FOUR_DIGITS, lane, 1);
        }
        if was_stopped && !is_stopped {
            let written = checked(std::array::from_fn(|field| memory.word(registers + field as Slot, lane)));
            memory.set_bit(wrong, lane, written.is_none());
            if let Some(fields) = written {
                clock = Clock { fields, beyond_ns: 0 };
            }
        } else if !is_stopped {
            clock.pass(elapsed_ns.max(0));
        }
        if is_rounded && !was_rounded {
            clock.round();
        }
        clock.store(memory, at, lane);
        memory.set_word(at + WAS_STOPPED, lane, i64::from(is_stopped));
        memory.set_word(at + WAS_ROUNDED, lane, i64::from(is_rounded));
        if scan == 1 || !is_stopped && !memory.bit(freeze, lane) {
            show(memory, layout, registers, lane);
        }
    }
}

/// Sets the clock as [`Execution::set_clock`](crate::target::Execution::set_clock) says.
pub(super) fn set<L: Lanes>(memory: &mut Memory<L>, layout: &Layout, lane: usize, clock: [i64; 7]) -> bool {
    let [year, month, day, hour, minute, second, weekday] = clock;
    let Some(fields) = checked([second, minute, hour, day, month, year, weekday]) else { return false };
    Clock { fields, beyond_ns: 0 }.store(memory, layout.clock(), lane);
    if let Some(registers) = layout.slot(Device::new(DeviceKind::D, 8013)) {
        show(memory, layout, registers, lane);
    }
    true
}

/// Writes the clock to D8013 and on.
fn show<L: Lanes>(memory: &mut Memory<L>, layout: &Layout, registers: Slot, lane: usize) {
    let at = layout.clock();
    let has_four_digits = memory.word(at + FOUR_DIGITS, lane) != 0;
    for field in 0..FIELDS as Slot {
        let value = memory.word(at + field, lane);
        let value = if field == 5 && !has_four_digits { value % 100 } else { value };
        memory.set_word(registers + field, lane, value);
    }
}

/// The fields with the year in four digits, if they are a date and a time. Two digits are 1980 to 2079.
fn checked(fields: [i64; FIELDS]) -> Option<[i64; FIELDS]> {
    let [second, minute, hour, day, month, year, weekday] = fields;
    let year = match year {
        0..=79 => 2000 + year,
        80..=99 => 1900 + year,
        1980..=2079 => year,
        _ => return None,
    };
    let is_time = (0..60).contains(&second) && (0..60).contains(&minute) && (0..24).contains(&hour);
    let is_date =
        (1..=12).contains(&month) && (1..=days_of(month, year)).contains(&day) && (0..7).contains(&weekday);
    (is_time && is_date).then_some([second, minute, hour, day, month, year, weekday])
}

/// Days of a month between 1980 and 2079, in which every fourth year is a leap year.
fn days_of(month: i64, year: i64) -> i64 {
    match month {
        2 if year % 4 == 0 => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

impl Clock {
    fn load<L: Lanes>(memory: &Memory<L>, at: Slot, lane: usize) -> Clock {
        let fields: [i64; FIELDS] = std::array::from_fn(|field| memory.word(at + field as Slot, lane));
        // No date has day 0: memory is as it was made.
        let fields = if fields[3] == 0 { START } else { fields };
        Clock { fields, beyond_ns: memory.word(at + BEYOND, lane) }
    }

    fn store<L: Lanes>(&self, memory: &mut Memory<L>, at: Slot, lane: usize) {
        for (field, value) in (0..).zip(self.fields) {
            memory.set_word(at + field, lane, value);
        }
        memory.set_word(at + BEYOND, lane, self.beyond_ns);
    }

    fn pass(&mut self, elapsed_ns: i64) {
        let beyond_ns = self.beyond_ns.saturating_add(elapsed_ns);
        self.beyond_ns = beyond_ns % SECOND_NS;
        self.add_seconds(beyond_ns / SECOND_NS);
    }

    /// To the nearest minute, half a minute upwards.
    fn round(&mut self) {
        let second = self.fields[0];
        self.add_seconds(if second < 30 { -second } else { 60 - second });
        self.beyond_ns = 0;
    }

    fn add_seconds(&mut self, seconds: i64) {
        if seconds == 0 {
            return;
        }
        let [second, minute, hour, ..] = self.fields;
        let total = hour * 3600 + minute * 60 + second + seconds;
        for _ in 0..total / DAY_SECONDS {
            self.next_day();
        }
        let rest = total % DAY_SECONDS;
        self.fields[..3].copy_from_slice(&[rest % 60, rest / 60 % 60, rest / 3600]);
    }

    fn next_day(&mut self) {
        let [_, _, _, mut day, mut month, mut year, weekday] = self.fields;
        day += 1;
        if day > days_of(month, year) {
            (day, month) = (1, month + 1);
        }
        if month > 12 {
            (month, year) = (1, if year == 2079 { 1980 } else { year + 1 });
        }
        self.fields[3..].copy_from_slice(&[day, month, year, (weekday + 1) % 7]);
    }
}
