//! FNC 160–169: the real-time clock and the hour meter.
//!
//! A time is three words: hour, minute, second. A date with time is seven: year, month, day, hour, minute, second,
//! day of the week (0 is Sunday).

use super::specs::{applied, bits_out, operand, source};
use crate::target::semantics::{BORROW, CARRY, ZERO};
use crate::target::{Accepts, Access, Execution, Fault, Instruction, OperandSpec};

const STORED: Accepts = Accepts::T.or(Accepts::C).or(Accepts::D).or(Accepts::R);

const fn time(name: &'static str, meaning: &'static str) -> OperandSpec {
    operand(name, meaning, Access::Read, STORED).covering(3)
}

/// TCMP TZCP TADD TSUB TRD TWR HOUR.
pub const ROWS: &[Instruction] = &[
    applied(
        160,
        "TCMP",
        "time compare",
        &[
            source("S1", "hour").within(0, 23),
            source("S2", "minute").within(0, 59),
            source("S3", "second").within(0, 59),
            time("S", "time to compare with"),
            bits_out("D", "before, at, after the given time").covering(3),
        ],
        "Compares the time in three registers from `S` on with the given hour, minute and second and \
         switches one of three bits on: `D` while it is earlier than the given time, the next when it \
         is equal, the third when it is later. Fetch the clock first: `TRD` puts the hour into the \
         fourth of its seven words, so `TRD D0` and then `D3` here. The middle bit is on for just one \
         second. When the drive goes off the bits keep their state. An hour above 23, or a minute or \
         second above 59, is an operation error.\n\n\
         ```il\n\
         LD M8000\n\
         TRD D0\n\
         TCMP K6 K30 K0 D3 M0\n\
         LD M2\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(compare_time),
    applied(
        161,
        "TZCP",
        "time zone compare",
        &[
            time("S1", "lower limit"),
            time("S2", "upper limit"),
            time("S", "time to compare"),
            bits_out("D", "before, within, after").covering(3),
        ],
        "Compares a time of three words with two others and switches one of three bits on: `D` before \
         `S1`, the next from `S1` to `S2`, the third after `S2`. The limits must be registers in order \
         hour, minute, second, and `S1` must not be later than `S2`, or `S2` counts as equal to it: a \
         shift across midnight takes the two outer bits, with the limits exchanged. When the drive \
         goes off the bits keep their state.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K6 D10\n\
         MOV K0 D11\n\
         MOV K0 D12\n\
         MOV K14 D13\n\
         MOV K0 D14\n\
         MOV K0 D15\n\
         LD M8000\n\
         TRD D0\n\
         TZCP D10 D13 D3 M0\n\
         LD M1\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(compare_time_zone),
    applied(
        162,
        "TADD",
        "time add",
        &[
            time("S1", "time"),
            time("S2", "time to add"),
            operand("D", "sum", Access::Write, STORED).covering(3),
        ],
        "Adds two times of three words each (hour, minute, second). When the sum reaches 24 hours \
         `M8022` comes on and 24 hours are taken off, so it answers *what time will it be*, not *how \
         long in all*. `M8020` comes on at 0:00:00. Hours above 23 or minutes above 59 in a source are \
         an operation error. With the same registers as source and destination use `TADDP`.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K1 D10\n\
         MOV K30 D11\n\
         MOV K0 D12\n\
         LDP X0\n\
         TRD D0\n\
         TADD D3 D10 D20\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(add_times),
    applied(
        163,
        "TSUB",
        "time subtract",
        &[
            time("S1", "time"),
            time("S2", "time to subtract"),
            operand("D", "difference", Access::Write, STORED).covering(3),
        ],
        "Subtracts the time `S2` from `S1`, three words each (hour, minute, second). When the \
         difference would be negative `M8021` comes on and 24 hours are added, which is right for a \
         stretch of time across midnight. `M8020` comes on at 0:00:00. Stretches of a day or more \
         cannot be told from shorter ones: use `HOUR` to count them.\n\n\
         ```il\n\
         LDP X0\n\
         TRD D0\n\
         LDF X0\n\
         TRD D10\n\
         TSUB D13 D3 D20\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(subtract_times),
    applied(
        166,
        "TRD",
        "read the clock",
        &[operand("D", "first of 7 words", Access::Write, STORED).covering(7)],
        "Copies the real-time clock to seven words: year, month, day, hour, minute, second, day of the \
         week (0 is Sunday). The values come from `D8013` to `D8019` but in the order in which one \
         writes them. The year has two digits unless the program has chosen four by moving 2000 into \
         `D8018` in the first scan. A clock whose battery has run out starts at a wrong date without \
         telling you: test the year for plausibility. In simulation it starts at 0:00:00 on 1 January \
         2000, a Saturday, and goes on with the time of the scans.\n\n\
         ```il\n\
         LD M8000\n\
         TRD D0\n\
         LD= D6 K0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(read_clock),
    applied(
        167,
        "TWR",
        "set the clock",
        &[operand("S", "first of 7 words", Access::Read, STORED).covering(7)],
        "Sets the real-time clock from seven words in the order of `TRD`: year, month, day, hour, \
         minute, second, day of the week. Use `TWRP`: driven in every scan it holds the clock still. \
         Prepare values a minute ahead and press the button when the time comes. An impossible date is \
         an operation error (`M8067`) and changes nothing. The other way is to hold `M8015` on, write \
         `D8013` to `D8019` and let it go; there an impossible date switches `M8019` on and changes \
         nothing either. For small corrections set `M8017`, which rounds to the nearest minute. The \
         day of the week is not computed from the date.\n\n\
         ```il\n\
         LD X0\n\
         MOVP K24 D0\n\
         MOVP K12 D1\n\
         MOVP K31 D2\n\
         MOVP K23 D3\n\
         MOVP K59 D4\n\
         MOVP K0 D5\n\
         MOVP K2 D6\n\
         TWRP D0\n\
         END\n\
         ```\n",
    )
    .pulse()
    .doing(set_clock),
    applied(
        169,
        "HOUR",
        "hour meter",
        &[
            source("S", "hours until the alarm"),
            operand("D1", "hours and seconds run", Access::ReadWrite, Accepts::D.or(Accepts::R)).covering(2),
            bits_out("D2", "alarm"),
        ],
        "Counts how long it is driven: `D1` holds full hours, the next register the seconds of the \
         current hour (with `DHOUR` the hours are a pair and the seconds follow it). `D2` comes on \
         when `S` is exceeded, which is a second later, and the counting goes on, up to 32,767 hours. \
         Choose registers that keep their values without power, or the meter starts again with each \
         day. After maintenance move 0 into all of them; that also switches the alarm off.\n\n\
         ```il\n\
         LD X0\n\
         HOUR K500 D200 Y0\n\
         LD X1\n\
         MOVP K0 D200\n\
         MOVP K0 D201\n\
         END\n\
         ```\n",
    )
    .wide()
    .doing(count_hours),
];

const DAY: i64 = 86_400;
const HOUR: i64 = 3_600;
const SECOND_NS: i64 = 1_000_000_000;

/// D8013 to D8019 in the order of TRD.
const CLOCK: [u32; 7] = [8018, 8017, 8016, 8015, 8014, 8013, 8019];

/// Hour, minute and second as seconds of the day.
fn seconds([hour, minute, second]: [i64; 3], place: usize) -> Result<i64, Fault> {
    let is_time = (0..24).contains(&hour) && (0..60).contains(&minute) && (0..60).contains(&second);
    if is_time { Ok(hour * HOUR + minute * 60 + second) } else { Err(Fault::Value(place as u8)) }
}

/// The time in three registers.
fn stored(execution: &mut dyn Execution, place: usize) -> Result<i64, Fault> {
    let time = [execution.word(place, 0)?, execution.word(place, 1)?, execution.word(place, 2)?];
    seconds(time, place)
}

fn compare_time(execution: &mut dyn Execution) -> Result<(), Fault> {
    let given = seconds([execution.word(0, 0)?, execution.word(1, 0)?, execution.word(2, 0)?], 0)?;
    let time = stored(execution, 3)?;
    execution.answer(4, given.cmp(&time))
}

fn compare_time_zone(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (lower, upper, time) = (stored(execution, 0)?, stored(execution, 1)?, stored(execution, 2)?);
    let upper = upper.max(lower);
    execution.set_relays(3, &[time < lower, (lower..=upper).contains(&time), time > upper])
}

fn add_times(execution: &mut dyn Execution) -> Result<(), Fault> {
    let sum = stored(execution, 0)? + stored(execution, 1)?;
    put_time(execution, sum, CARRY, sum >= DAY)
}

fn subtract_times(execution: &mut dyn Execution) -> Result<(), Fault> {
    let difference = stored(execution, 0)? - stored(execution, 1)?;
    put_time(execution, difference, BORROW, difference < 0)
}

/// Writes a time of the day, and tells whether it is of another one.
fn put_time(execution: &mut dyn Execution, time: i64, flag: u32, is_other_day: bool) -> Result<(), Fault> {
    let time = time.rem_euclid(DAY);
    execution.put_values(2, &[time / HOUR, time / 60 % 60, time % 60])?;
    execution.set_relay(ZERO, time == 0);
    execution.set_relay(flag, is_other_day);
    Ok(())
}

fn read_clock(execution: &mut dyn Execution) -> Result<(), Fault> {
    let clock = CLOCK.map(|number| execution.register(number));
    execution.put_values(0, &clock)
}

fn set_clock(execution: &mut dyn Execution) -> Result<(), Fault> {
    let mut clock = [0; 7];
    for (offset, field) in (0..).zip(&mut clock) {
        *field = execution.word(0, offset)?;
    }
    if execution.set_clock(clock) { Ok(()) } else { Err(Fault::Value(0)) }
}

/// Notes the nanoseconds of a second that is not full.
fn count_hours(execution: &mut dyn Execution) -> Result<(), Fault> {
    let limit = execution.value(0)?;
    let (place, greatest) = (if execution.is_wide() { 2 } else { 1 }, execution.limits().1);
    let (hours, second) = (execution.value(1)?, execution.word(1, place)?);
    execution.bit(2, 0)?;
    // Time without power does not count; a meter that was jumped over goes on with the scan in which it is met again.
    let passed = if execution.is_rising() { 0 } else { execution.scan_ns().max(0) };
    let beyond = execution.noted(0).saturating_add(passed);
    execution.note(0, beyond % SECOND_NS);
    let total = (hours * HOUR + second + beyond / SECOND_NS).min(greatest * HOUR + HOUR - 1);
    execution.put(1, total.div_euclid(HOUR))?;
    execution.set_word(1, place, total.rem_euclid(HOUR))?;
    execution.set_bit(2, 0, total > limit * HOUR)
}
