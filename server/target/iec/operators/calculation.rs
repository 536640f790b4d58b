//! Arithmetic and comparison.

use super::{Modifiers, Operator, OperatorRole};
use crate::target::iec::page::Page;
use crate::target::iec::{ElementaryType, GenericType};

const DEFER: Modifiers = Modifiers { negate: false, defer: true, condition: false };
const CALCULATE: OperatorRole = OperatorRole::Combine { comparison: false };
const COMPARE: OperatorRole = OperatorRole::Combine { comparison: true };

/// The arithmetic of times and dates with unequal types, or with a result of another type.
pub fn time_arithmetic(
    operator: &str,
    current: ElementaryType,
    operand: ElementaryType,
) -> Option<ElementaryType> {
    use ElementaryType::*;
    match (operator, current, operand) {
        ("ADD", point @ (TimeOfDay | DateAndTime), Time) => Some(point),
        ("ADD", point @ (LtimeOfDay | LdateAndTime), Ltime) => Some(point),
        ("SUB", point @ (TimeOfDay | DateAndTime), Time) => Some(point),
        ("SUB", point @ (LtimeOfDay | LdateAndTime), Ltime) => Some(point),
        ("SUB", Date, Date) | ("SUB", TimeOfDay, TimeOfDay) | ("SUB", DateAndTime, DateAndTime) => Some(Time),
        ("SUB", Ldate, Ldate) | ("SUB", LtimeOfDay, LtimeOfDay) | ("SUB", LdateAndTime, LdateAndTime) => {
            Some(Ltime)
        }
        ("MUL" | "DIV", time @ (Time | Ltime), number) if number.belongs_to(GenericType::AnyNum) => {
            Some(time)
        }
        _ => None,
    }
}

/// ADD SUB MUL DIV MOD GT GE EQ NE LE LT.
pub const ROWS: &[Operator] = &[
    Operator {
        name: "ADD",
        title: "add",
        modifiers: DEFER,
        role: CALCULATE,
        operand: Some(GenericType::AnyMagnitude),
        page: Page {
            about: "Current result plus operand, two numbers of the same type or two TIMEs; a TIME may also be added \
                    to a TOD or a DT, which stay what they are. A sum that the type cannot hold is an error by the \
                    standard; many controllers wrap it around instead, so that INT 32767 plus 1 gives -32768.",
            variables: &["Batch AT %IW0 : INT", "Total : INT"],
            body: &["LD Total", "ADD Batch", "ST Total"],
        },
    },
    Operator {
        name: "SUB",
        title: "subtract",
        modifiers: DEFER,
        role: CALCULATE,
        operand: Some(GenericType::AnyMagnitude),
        page: Page {
            about: "Current result minus operand, in this order, two numbers of the same type or two TIMEs. TOD or DT \
                    minus TIME keeps its type; DATE minus DATE, TOD minus TOD and DT minus DT give the TIME between \
                    them. Unsigned types cannot go below 0: UINT 0 minus 1 is an error, or 65535 where the controller \
                    wraps around. `SUB(` subtracts what the parentheses gave.",
            variables: &["Gross AT %IW0 : INT", "Tare : INT := 25", "Net AT %QW0 : INT"],
            body: &["LD Gross", "SUB Tare", "ST Net"],
        },
    },
    Operator {
        name: "MUL",
        title: "multiply",
        modifiers: DEFER,
        role: CALCULATE,
        operand: Some(GenericType::AnyMagnitude),
        page: Page {
            about: "Current result times operand, numbers of the same type; a TIME may be multiplied by a number and \
                    stays a TIME. The product has the type of its factors, not twice the width: INT 200 times 200 is \
                    out of range, so widen with `INT_TO_DINT` first.",
            variables: &["Pieces AT %IW0 : INT", "Weight : INT := 12", "Load AT %QW0 : INT"],
            body: &["LD Pieces", "MUL Weight", "ST Load"],
        },
    },
    Operator {
        name: "DIV",
        title: "divide",
        modifiers: DEFER,
        role: CALCULATE,
        operand: Some(GenericType::AnyMagnitude),
        page: Page {
            about: "Current result divided by operand, in this order, numbers of the same type; a TIME may be divided \
                    by a number. Integers are truncated towards zero: 7 DIV 3 is 2 and -7 DIV 3 is -2. Division by \
                    zero is an error that stops many controllers, so guard it with a comparison and a jump.",
            variables: &["Length AT %IW0 : INT", "Parts : INT := 4", "Part AT %QW0 : INT"],
            body: &["LD Length", "DIV Parts", "ST Part"],
        },
    },
    Operator {
        name: "MOD",
        title: "remainder",
        modifiers: DEFER,
        role: CALCULATE,
        operand: Some(GenericType::AnyInt),
        page: Page {
            about: "The remainder of the current result divided by the operand, integers of the same type. It has the \
                    sign of the dividend, because division truncates: -7 MOD 3 is -1, not 2. The standard defines \
                    MOD by 0 as 0; controllers differ. REAL is not allowed.",
            variables: &["Count AT %IW0 : INT", "Column AT %QW0 : INT"],
            body: &["LD Count", "MOD 8", "ST Column"],
        },
    },
    Operator {
        name: "GT",
        title: "greater than",
        modifiers: DEFER,
        role: COMPARE,
        operand: Some(GenericType::AnyElementary),
        page: Page {
            about: "1 if the current result is greater than the operand, else 0; both of the same elementary type. \
                    The current result, which is BOOL afterwards, stands on the left, also with parentheses: `GT(` \
                    compares the result before them with what they gave. Texts are compared character by character \
                    from the left, dates by which is later.",
            variables: &["Level AT %IW0 : INT", "Overflow AT %QX0.0 : BOOL"],
            body: &["LD Level", "GT 900", "ST Overflow"],
        },
    },
    Operator {
        name: "GE",
        title: "greater than or equal",
        modifiers: DEFER,
        role: COMPARE,
        operand: Some(GenericType::AnyElementary),
        page: Page {
            about: "1 if the current result is greater than the operand or equal to it, else 0; both of the same \
                    elementary type. The current result stands on the left and is BOOL afterwards. The usual test of \
                    a count against its target, because it also holds when a count has been stepped over.",
            variables: &["Count AT %IW0 : INT", "Target : INT := 50", "Done AT %QX0.0 : BOOL"],
            body: &["LD Count", "GE Target", "ST Done"],
        },
    },
    Operator {
        name: "EQ",
        title: "equal",
        modifiers: DEFER,
        role: COMPARE,
        operand: Some(GenericType::AnyElementary),
        page: Page {
            about: "1 if the current result equals the operand, else 0; both of the same elementary type, and the \
                    current result is BOOL afterwards. Two REALs that were calculated in different ways are seldom \
                    equal to the last bit: compare their distance with a tolerance instead.",
            variables: &["Recipe AT %IW0 : INT", "Standard AT %QX0.0 : BOOL"],
            body: &["LD Recipe", "EQ 1", "ST Standard"],
        },
    },
    Operator {
        name: "NE",
        title: "not equal",
        modifiers: DEFER,
        role: COMPARE,
        operand: Some(GenericType::AnyElementary),
        page: Page {
            about: "1 if the current result differs from the operand, else 0; both of the same elementary type, and \
                    the current result is BOOL afterwards. With a variable that holds the value of the scan before it \
                    tells that a number has changed.",
            variables: &["Order AT %IW0 : INT", "Last : INT", "Changed AT %QX0.0 : BOOL"],
            body: &["LD Order", "NE Last", "ST Changed", "LD Order", "ST Last"],
        },
    },
    Operator {
        name: "LE",
        title: "less than or equal",
        modifiers: DEFER,
        role: COMPARE,
        operand: Some(GenericType::AnyElementary),
        page: Page {
            about: "1 if the current result is less than the operand or equal to it, else 0; both of the same \
                    elementary type. The current result stands on the left and is BOOL afterwards.",
            variables: &["Pressure AT %IW0 : INT", "Low AT %QX0.0 : BOOL"],
            body: &["LD Pressure", "LE 120", "ST Low"],
        },
    },
    Operator {
        name: "LT",
        title: "less than",
        modifiers: DEFER,
        role: COMPARE,
        operand: Some(GenericType::AnyElementary),
        page: Page {
            about: "1 if the current result is less than the operand, else 0; both of the same elementary type. The \
                    current result stands on the left and is BOOL afterwards, so a second comparison needs its own \
                    load, or parentheses as in `AND(`, `LD Temperature`, `GT 5`, `)`.",
            variables: &["Temperature AT %IW0 : INT", "Heater AT %QX0.0 : BOOL"],
            body: &["LD Temperature", "LT 20", "ST Heater"],
        },
    },
];
