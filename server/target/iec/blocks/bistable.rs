//! Bistables, edge detection and the semaphore.

use super::FunctionBlock;
use crate::target::iec::Instance;
use crate::target::iec::page::Page;
use crate::target::iec::{ElementaryType, Parameter};

/// SR RS R_TRIG F_TRIG SEMA.
pub const ROWS: &[FunctionBlock] = &[
    FunctionBlock {
        name: "SR",
        title: "bistable, set dominant",
        inputs: &[
            Parameter::of("S1", ElementaryType::Bool, "set, dominant"),
            Parameter::of("R", ElementaryType::Bool, "reset"),
        ],
        outputs: &[Parameter::of("Q1", ElementaryType::Bool, "state")],
        input_operators: &["S1", "R"],
        working: set_dominant,
        page: Page {
            about: "Keeps one bit: S1 sets Q1, R resets it, and with both on S1 wins, because Q1 becomes \
                    S1 OR (Q1 AND NOT R). Use it where on is the safe state, such as a ventilation; \
                    elsewhere take RS. All signals are BOOL and act by level, not by edge. The figure 1 \
                    marks the dominant input, and a call by name must write it.",
            variables: &[
                "Smoke AT %IX0.0 : BOOL",
                "Quit AT %IX0.1 : BOOL",
                "Fan AT %QX0.0 : BOOL",
                "Latch : SR",
            ],
            body: &["CAL Latch(", "    S1 := Smoke,", "    R := Quit", ")", "LD Latch.Q1", "ST Fan"],
        },
    },
    FunctionBlock {
        name: "RS",
        title: "bistable, reset dominant",
        inputs: &[
            Parameter::of("S", ElementaryType::Bool, "set"),
            Parameter::of("R1", ElementaryType::Bool, "reset, dominant"),
        ],
        outputs: &[Parameter::of("Q1", ElementaryType::Bool, "state")],
        input_operators: &["S", "R1"],
        working: reset_dominant,
        page: Page {
            about: "Keeps one bit: S sets Q1, R1 resets it, and with both on R1 wins, because Q1 becomes \
                    NOT R1 AND (S OR Q1). The usual choice for drives, where off is the safe state. All \
                    signals are BOOL and act by level, not by edge. The figure 1 marks the dominant \
                    input, and a call by name must write it.",
            variables: &[
                "Start AT %IX0.0 : BOOL",
                "Stop AT %IX0.1 : BOOL",
                "Motor AT %QX0.0 : BOOL",
                "Latch : RS",
            ],
            body: &["CAL Latch(", "    S := Start,", "    R1 := Stop", ")", "LD Latch.Q1", "ST Motor"],
        },
    },
    FunctionBlock {
        name: "R_TRIG",
        title: "rising edge",
        inputs: &[Parameter::of("CLK", ElementaryType::Bool, "signal")],
        outputs: &[Parameter::of("Q", ElementaryType::Bool, "on for one call after a rising edge")],
        input_operators: &["CLK"],
        working: rising,
        page: Page {
            about: "Q is on for one call when CLK, a BOOL, has gone from 0 to 1 since the call before. \
                    Call each instance exactly once in every scan: one that is skipped misses edges, and \
                    one called twice loses Q in the second call. If CLK is on at the very first call, \
                    that counts as an edge.",
            variables: &["Button AT %IX0.0 : BOOL", "Pressed : R_TRIG", "Presses : INT"],
            body: &[
                "CAL Pressed(",
                "    CLK := Button",
                ")",
                "LD Pressed.Q",
                "JMPCN Done",
                "LD Presses",
                "ADD 1",
                "ST Presses",
                "Done:",
            ],
        },
    },
    FunctionBlock {
        name: "F_TRIG",
        title: "falling edge",
        inputs: &[Parameter::of("CLK", ElementaryType::Bool, "signal")],
        outputs: &[Parameter::of("Q", ElementaryType::Bool, "on for one call after a falling edge")],
        input_operators: &["CLK"],
        working: falling,
        page: Page {
            about: "Q is on for one call when CLK, a BOOL, has gone from 1 to 0 since the call before. \
                    Call each instance exactly once in every scan. Its memory starts at 0, so if CLK is \
                    off at the very first call, Q comes on although nothing fell.",
            variables: &["Running AT %IX0.0 : BOOL", "Stopped : F_TRIG", "Brake AT %QX0.0 : BOOL"],
            body: &[
                "CAL Stopped(",
                "    CLK := Running",
                ")",
                "LD Stopped.Q",
                "S Brake",
                "LD Running",
                "R Brake",
            ],
        },
    },
    FunctionBlock {
        name: "SEMA",
        title: "semaphore",
        inputs: &[
            Parameter::of("CLAIM", ElementaryType::Bool, "asks for the resource"),
            Parameter::of("RELEASE", ElementaryType::Bool, "gives it back"),
        ],
        outputs: &[Parameter::of("BUSY", ElementaryType::Bool, "the resource was taken already")],
        input_operators: &[],
        working: semaphore,
        page: Page {
            about: "Guards a resource that only one part of a program may use at a time. CLAIM takes it; \
                    BUSY tells whether it had been taken before this call, so a claim has succeeded when \
                    BUSY stays 0. RELEASE without CLAIM gives it back. All signals are BOOL. A block of \
                    the first edition, which later editions dropped.",
            variables: &[
                "Wanted AT %IX0.0 : BOOL",
                "Finished AT %IX0.1 : BOOL",
                "Crane : SEMA",
                "Wait AT %QX0.0 : BOOL",
            ],
            body: &[
                "CAL Crane(",
                "    CLAIM := Wanted,",
                "    RELEASE := Finished",
                ")",
                "LD Crane.BUSY",
                "ST Wait",
            ],
        },
    },
];

fn set_dominant(instance: &mut dyn Instance) {
    let on = instance.is_on(0) || instance.output(0) != 0 && !instance.is_on(1);
    instance.switch(0, on);
}

fn reset_dominant(instance: &mut dyn Instance) {
    let on = !instance.is_on(1) && (instance.is_on(0) || instance.output(0) != 0);
    instance.switch(0, on);
}

fn rising(instance: &mut dyn Instance) {
    let has_risen = instance.has_risen(0, 0);
    instance.switch(0, has_risen);
}

/// The memory holds the inverse of CLK and is off at first, so that a CLK that is off at the first call is an edge.
fn falling(instance: &mut dyn Instance) {
    let (is_off, was_off) = (!instance.is_on(0), instance.noted(0) != 0);
    instance.note(0, i64::from(is_off));
    instance.switch(0, is_off && !was_off);
}

fn semaphore(instance: &mut dyn Instance) {
    let is_taken = instance.noted(0) != 0;
    instance.switch(0, is_taken);
    if instance.is_on(0) {
        instance.note(0, 1);
    } else if instance.is_on(1) {
        instance.note(0, 0);
        instance.switch(0, false);
    }
}
