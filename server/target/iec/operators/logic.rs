//! Loading, storing, latches and bit logic.

use super::{Modifiers, Operator, OperatorRole};
use crate::target::iec::GenericType;
use crate::target::iec::page::Page;

const NEGATE: Modifiers = Modifiers { negate: true, defer: false, condition: false };
const NEGATE_DEFER: Modifiers = Modifiers { negate: true, defer: true, condition: false };
const NONE: Modifiers = Modifiers { negate: false, defer: false, condition: false };

/// LD ST S R AND & OR XOR NOT.
pub const ROWS: &[Operator] = &[
    Operator {
        name: "LD",
        title: "load",
        modifiers: NEGATE,
        role: OperatorRole::Load,
        operand: Some(GenericType::Any),
        page: Page {
            about: "Makes the operand the current result, whatever the result was before; every sequence starts with \
                    it. The operand may be of any type, and the instructions that follow must fit that type. `LDN` \
                    loads the complement, so its operand must be a BOOL or a bit string; on a word it turns every bit \
                    over. There is no `LD(`: parentheses belong to the operators that combine.",
            variables: &["Start AT %IX0.0 : BOOL", "Stop AT %IX0.1 : BOOL", "Motor AT %QX0.0 : BOOL"],
            body: &["LD Start", "OR Motor", "ANDN Stop", "ST Motor"],
        },
    },
    Operator {
        name: "ST",
        title: "store",
        modifiers: NEGATE,
        role: OperatorRole::Store,
        operand: Some(GenericType::Any),
        page: Page {
            about: "Copies the current result into a variable of the same type. The current result stays as it is, so \
                    several `ST` may follow each other. `STN` stores the complement and needs a BOOL or a bit string. \
                    An input, a constant and a literal cannot be stored to, and nothing is converted on the way: an \
                    INT result needs a conversion function before it goes into a REAL variable. A number outside of \
                    the subrange of its variable is an error; the simulator stores the nearest one within, and tells.",
            variables: &["Door AT %IX0.0 : BOOL", "Lamp AT %QX0.0 : BOOL", "Lock AT %QX0.1 : BOOL"],
            body: &["LD Door", "ST Lamp", "STN Lock"],
        },
    },
    Operator {
        name: "S",
        title: "set",
        modifiers: NONE,
        role: OperatorRole::Latch { on: true },
        operand: Some(GenericType::AnyBit),
        page: Page {
            about: "Sets a BOOL variable to 1 if the current result is 1, and leaves it alone if it is 0; the current \
                    result, a BOOL, is kept. The variable stays on until an `R` or a store clears it, so every `S` \
                    needs its counterpart. If both act in one scan, the one further down wins. With an instance of a \
                    function block that has an input S, such as RS, the same word calls the block with that input.",
            variables: &["High AT %IX0.0 : BOOL", "Low AT %IX0.1 : BOOL", "Valve AT %QX0.0 : BOOL"],
            body: &["LD High", "S Valve", "LD Low", "R Valve"],
        },
    },
    Operator {
        name: "R",
        title: "reset",
        modifiers: NONE,
        role: OperatorRole::Latch { on: false },
        operand: Some(GenericType::AnyBit),
        page: Page {
            about: "Resets a BOOL variable to 0 if the current result is 1, and leaves it alone if it is 0; the \
                    current result, a BOOL, is kept. Put it below the matching `S` where the reset must win. With an \
                    instance of a function block that has an input R, such as a counter or SR, the same word calls \
                    the block with that input.",
            variables: &["Fault AT %IX0.0 : BOOL", "Quit AT %IX0.1 : BOOL", "Alarm AT %QX0.0 : BOOL"],
            body: &["LD Fault", "S Alarm", "LD Quit", "R Alarm"],
        },
    },
    Operator {
        name: "AND",
        title: "and",
        modifiers: NEGATE_DEFER,
        role: OperatorRole::Combine { comparison: false },
        operand: Some(GenericType::AnyBit),
        page: Page {
            about: "Current result AND operand, bit by bit; both are BOOL or bit strings of the same width. A contact \
                    in series. `ANDN` takes the complement of the operand. `AND(` keeps the current result, starts \
                    afresh inside the parentheses, and combines at `)`; `ANDN(` complements what the parentheses \
                    gave, not their first operand.",
            variables: &[
                "Guard AT %IX0.0 : BOOL",
                "Button AT %IX0.1 : BOOL",
                "Pedal AT %IX0.2 : BOOL",
                "Press AT %QX0.0 : BOOL",
            ],
            body: &["LD Guard", "AND(", "    LD Button", "    OR Pedal", ")", "ST Press"],
        },
    },
    Operator {
        name: "&",
        title: "and",
        modifiers: NEGATE_DEFER,
        role: OperatorRole::Combine { comparison: false },
        operand: Some(GenericType::AnyBit),
        page: Page {
            about: "Another spelling of `AND`, with the same modifiers: `&N`, `&(` and `&N(`. Both operands are BOOL \
                    or bit strings of the same width. Ladder tools and other editors write `AND`, so that is the \
                    spelling to prefer in new programs.",
            variables: &["Ready AT %IX0.0 : BOOL", "Fault AT %IX0.1 : BOOL", "Run AT %QX0.0 : BOOL"],
            body: &["LD Ready", "&N Fault", "ST Run"],
        },
    },
    Operator {
        name: "OR",
        title: "or",
        modifiers: NEGATE_DEFER,
        role: OperatorRole::Combine { comparison: false },
        operand: Some(GenericType::AnyBit),
        page: Page {
            about: "Current result OR operand, bit by bit; both are BOOL or bit strings of the same width. A contact \
                    in parallel to everything loaded so far: instructions have no precedence, so `LD A`, `OR B`, \
                    `AND C` means (A OR B) AND C. A branch with several contacts in series goes into `OR(` … `)`. \
                    `ORN` takes the complement of the operand.",
            variables: &[
                "Hand AT %IX0.0 : BOOL",
                "Auto AT %IX0.1 : BOOL",
                "Level AT %IX0.2 : BOOL",
                "Pump AT %QX0.0 : BOOL",
            ],
            body: &["LD Hand", "OR(", "    LD Auto", "    AND Level", ")", "ST Pump"],
        },
    },
    Operator {
        name: "XOR",
        title: "exclusive or",
        modifiers: NEGATE_DEFER,
        role: OperatorRole::Combine { comparison: false },
        operand: Some(GenericType::AnyBit),
        page: Page {
            about: "Current result XOR operand, bit by bit; both are BOOL or bit strings of the same width. The result \
                    is 1 where the two differ, so it serves for a lamp with two switches and to see which bits of a \
                    word have changed. `XORN` takes the complement of the operand and is 1 where the two agree.",
            variables: &[
                "Upstairs AT %IX0.0 : BOOL",
                "Downstairs AT %IX0.1 : BOOL",
                "Light AT %QX0.0 : BOOL",
            ],
            body: &["LD Upstairs", "XOR Downstairs", "ST Light"],
        },
    },
    Operator {
        name: "NOT",
        title: "complement",
        modifiers: NONE,
        role: OperatorRole::Complement,
        operand: Some(GenericType::AnyBit),
        page: Page {
            about: "Complements the current result, which is a BOOL or a bit string: every bit of a word turns over. \
                    It has no operand; the third edition's grammar would allow one but gives it no meaning, and \
                    compilers refuse it. To complement an operand instead, use `LDN`, `ANDN`, `ORN` or `STN`.",
            variables: &["Full AT %IX0.0 : BOOL", "Empty AT %IX0.1 : BOOL", "Between AT %QX0.0 : BOOL"],
            body: &["LD Full", "OR Empty", "NOT", "ST Between"],
        },
    },
];
