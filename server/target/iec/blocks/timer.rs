//! Timers and the clock.

use super::FunctionBlock;
use crate::target::iec::Instance;
use crate::target::iec::page::Page;
use crate::target::iec::{ElementaryType, Parameter};

const INPUTS: &[Parameter] = &[
    Parameter::of("IN", ElementaryType::Bool, "start"),
    Parameter::of("PT", ElementaryType::Time, "preset time"),
];
const OUTPUTS: &[Parameter] = &[
    Parameter::of("Q", ElementaryType::Bool, "output"),
    Parameter::of("ET", ElementaryType::Time, "elapsed time"),
];

/// TP TON TOF RTC.
pub const ROWS: &[FunctionBlock] = &[
    FunctionBlock {
        name: "TP",
        title: "pulse timer",
        inputs: INPUTS,
        outputs: OUTPUTS,
        input_operators: &["IN", "PT"],
        working: pulse,
        page: Page {
            about: "A rising edge of IN, a BOOL, starts a pulse on Q of the length PT, a TIME, whatever \
                    IN does meanwhile; another edge during the pulse does not prolong it. ET counts up \
                    to PT and goes back to T#0s once IN is off. With PT = T#0s some controllers give a \
                    pulse of one call and some none. Time passes from call to call, so call the block in \
                    every scan.",
            variables: &["Button AT %IX0.0 : BOOL", "Glue AT %QX0.0 : BOOL", "Dose : TP"],
            body: &["CAL Dose(", "    IN := Button,", "    PT := T#800ms", ")", "LD Dose.Q", "ST Glue"],
        },
    },
    FunctionBlock {
        name: "TON",
        title: "on-delay timer",
        inputs: INPUTS,
        outputs: OUTPUTS,
        input_operators: &["IN", "PT"],
        working: on_delay,
        page: Page {
            about: "Q comes on when IN, a BOOL, has been on for the time PT, and goes off with IN at \
                    once. ET shows the time so far, up to PT. An IN that is on at the first call starts \
                    the time there. PT is read in every call, so a shorter PT can end the delay early. \
                    With PT = T#0s some controllers switch Q in the same call and some in the next. Call \
                    the block in every scan, also while IN is off, or it never sees IN go off.",
            variables: &["Start AT %IX0.0 : BOOL", "Motor AT %QX0.0 : BOOL", "Delay : TON"],
            body: &["CAL Delay(", "    IN := Start,", "    PT := T#5s", ")", "LD Delay.Q", "ST Motor"],
        },
    },
    FunctionBlock {
        name: "TOF",
        title: "off-delay timer",
        inputs: INPUTS,
        outputs: OUTPUTS,
        input_operators: &["IN", "PT"],
        working: off_delay,
        page: Page {
            about: "Q comes on with IN, a BOOL, at once and goes off when IN has been off for the time \
                    PT. ET counts from the falling edge up to PT, stays there, and goes back to T#0s \
                    when IN comes on. Before IN has been on for the first time Q is off. Call the block \
                    in every scan, also while IN is off, because that is when its time runs.",
            variables: &["Light AT %IX0.0 : BOOL", "Fan AT %QX0.0 : BOOL", "Overrun : TOF"],
            body: &["CAL Overrun(", "    IN := Light,", "    PT := T#3m", ")", "LD Overrun.Q", "ST Fan"],
        },
    },
    FunctionBlock {
        name: "RTC",
        title: "real-time clock",
        inputs: &[
            Parameter::of("IN", ElementaryType::Bool, "on: the clock runs from PDT"),
            Parameter::of("PDT", ElementaryType::DateAndTime, "preset date and time"),
        ],
        outputs: &[
            Parameter::of("Q", ElementaryType::Bool, "copy of IN"),
            Parameter::of("CDT", ElementaryType::DateAndTime, "current date and time"),
        ],
        input_operators: &[],
        working: clock,
        page: Page {
            about: "A clock that is set by the program: a rising edge of IN, a BOOL, takes PDT over, and \
                    while IN is on CDT runs on from it. Q copies IN and tells that CDT is valid. While \
                    IN is off the standard says nothing of CDT; some controllers give their system's \
                    time. PDT and CDT are of type DT. A block of the first edition, which later editions \
                    dropped.",
            variables: &["Set AT %IX0.0 : BOOL", "Clock : RTC", "Moment : DT"],
            body: &[
                "CAL Clock(",
                "    IN := Set,",
                "    PDT := DT#2024-01-31-12:00:00",
                ")",
                "LD Clock.CDT",
                "ST Moment",
            ],
        },
    },
];

/// Of timers: IN and PT, then Q and ET.
const IN: usize = 0;
const PT: usize = 1;
const Q: usize = 0;
const ET: usize = 1;
/// What timers note: IN in the call before, whether time runs, since when.
const WAS_ON: usize = 0;
const RUNS: usize = 1;
const SINCE: usize = 2;

/// Starts the time with this call.
fn start(instance: &mut dyn Instance) {
    instance.note(RUNS, 1);
    instance.note(SINCE, instance.now_ns());
    instance.set_output(ET, 0);
}

/// Whether the time that runs is over; ET shows it, up to PT. A time that was started in this call is not over yet.
fn is_over(instance: &mut dyn Instance) -> bool {
    let elapsed = i128::from(instance.now_ns() - instance.noted(SINCE));
    let preset = instance.input(PT);
    let is_over = elapsed >= preset;
    instance.set_output(ET, elapsed.min(preset));
    if is_over {
        instance.note(RUNS, 0);
    }
    is_over
}

fn on_delay(instance: &mut dyn Instance) {
    let is_edge = instance.has_risen(IN, WAS_ON);
    match () {
        () if !instance.is_on(IN) => {
            instance.note(RUNS, 0);
            instance.set_output(ET, 0);
            instance.switch(Q, false);
        }
        () if is_edge => {
            start(instance);
            instance.switch(Q, false);
        }
        () if instance.noted(RUNS) != 0 => {
            let is_over = is_over(instance);
            instance.switch(Q, is_over);
        }
        () => {}
    }
}

fn off_delay(instance: &mut dyn Instance) {
    let was_on = instance.noted(WAS_ON) != 0;
    instance.has_risen(IN, WAS_ON);
    match () {
        () if instance.is_on(IN) => {
            instance.note(RUNS, 0);
            instance.set_output(ET, 0);
            instance.switch(Q, true);
        }
        () if was_on => start(instance),
        () if instance.noted(RUNS) != 0 => {
            let is_over = is_over(instance);
            instance.switch(Q, !is_over);
        }
        () => {}
    }
}

/// An edge starts a pulse only where none runs and ET is back at 0.
fn pulse(instance: &mut dyn Instance) {
    let is_edge = instance.has_risen(IN, WAS_ON);
    match () {
        () if instance.noted(RUNS) != 0 => {
            let is_over = is_over(instance);
            instance.switch(Q, !is_over);
            if is_over && !instance.is_on(IN) {
                instance.set_output(ET, 0);
            }
        }
        () if is_edge => {
            start(instance);
            instance.switch(Q, true);
        }
        () if !instance.is_on(IN) => instance.set_output(ET, 0),
        () => {}
    }
}

/// While IN is off, CDT stays as it is.
fn clock(instance: &mut dyn Instance) {
    if instance.has_risen(IN, WAS_ON) {
        instance.note(SINCE, instance.now_ns());
        // What PDT is at the edge counts.
        instance.set_output(1, instance.input(1));
        instance.note(RUNS, (instance.input(1) / NS_OF_MICROSECOND) as i64);
    }
    let is_on = instance.is_on(IN);
    instance.switch(Q, is_on);
    if is_on {
        let preset = i128::from(instance.noted(RUNS)) * NS_OF_MICROSECOND;
        instance.set_output(1, preset + i128::from(instance.now_ns() - instance.noted(SINCE)));
    }
}

/// The clock notes its preset in microseconds, of which 64 bits hold enough.
const NS_OF_MICROSECOND: i128 = 1000;
