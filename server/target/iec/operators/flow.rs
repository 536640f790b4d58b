//! Jumps, calls, returns.

use super::{Modifiers, Operator, OperatorRole};
use crate::target::iec::page::Page;

const CONDITION: Modifiers = Modifiers { negate: false, defer: false, condition: true };

/// JMP CAL RET.
pub const ROWS: &[Operator] = &[
    Operator {
        name: "JMP",
        title: "jump",
        modifiers: CONDITION,
        role: OperatorRole::Jump,
        operand: None,
        page: Page {
            about: "Continues at a label of the same program, function or function block. `JMPC` jumps only if the \
                    current result, a BOOL, is 1 and `JMPCN` only if it is 0; otherwise the next instruction follows, \
                    with the current result kept. What is jumped over is not executed: outputs keep their values and \
                    timers are not called. A jump backwards makes a loop inside one scan, which the watchdog ends if \
                    the condition never does. A label cannot stand inside parentheses.",
            variables: &["Manual AT %IX0.0 : BOOL", "Level AT %IX0.1 : BOOL", "Pump AT %QX0.0 : BOOL"],
            body: &["LD Manual", "JMPC Done", "LD Level", "ST Pump", "Done:"],
        },
    },
    Operator {
        name: "CAL",
        title: "call",
        modifiers: CONDITION,
        role: OperatorRole::Call,
        operand: None,
        page: Page {
            about: "Calls an instance of a function block. `CALC` calls only if the current result, a BOOL, is 1 and \
                    `CALCN` only if it is 0. Parameters stand in parentheses, either by name, one on each line, with \
                    `:=` for inputs and `=>` for outputs, or by position on one line, inputs then outputs in the \
                    order of the declaration. Inputs that are left out keep their last value. `EN := FALSE` leaves out \
                    the call, and ENO is then FALSE. Do not rely on the current result after a call: the third \
                    edition leaves it undefined, the simulator keeps it.",
            variables: &["Start AT %IX0.0 : BOOL", "Delay : TON", "Motor AT %QX0.0 : BOOL"],
            body: &["CAL Delay(", "    IN := Start,", "    PT := T#5s", ")", "LD Delay.Q", "ST Motor"],
        },
    },
    Operator {
        name: "RET",
        title: "return",
        modifiers: CONDITION,
        role: OperatorRole::Return,
        operand: None,
        page: Page {
            about: "Leaves the program, function or function block. `RETC` leaves only if the current result, a BOOL, \
                    is 1 and `RETCN` only if it is 0. The end of the text returns by itself, so a `RET` without a \
                    condition on the last line is not needed. A conditional return near the top makes the rest of the \
                    program sleep: its outputs keep their values.",
            variables: &["Disabled AT %IX0.0 : BOOL", "Sensor AT %IX0.1 : BOOL", "Horn AT %QX0.0 : BOOL"],
            body: &["LD Disabled", "RETC", "LD Sensor", "ST Horn"],
        },
    },
];
