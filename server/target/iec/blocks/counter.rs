//! Counters.

use super::FunctionBlock;
use crate::target::iec::ElementaryType::{self, *};
use crate::target::iec::page::Page;
use crate::target::iec::{Instance, Parameter};

/// CTU CTD CTUD, each with its typed variants.
pub const ROWS: &[FunctionBlock] = &[
    up(
        "CTU",
        &[CU, R, preset(Int)],
        &[Q_UP, count(Int)],
        &["Part AT %IX0.0 : BOOL", "Restart AT %IX0.1 : BOOL", "Full AT %QX0.0 : BOOL", "Parts : CTU"],
    ),
    up(
        "CTU_DINT",
        &[CU, R, preset(Dint)],
        &[Q_UP, count(Dint)],
        &["Part AT %IX0.0 : BOOL", "Restart AT %IX0.1 : BOOL", "Full AT %QX0.0 : BOOL", "Parts : CTU_DINT"],
    ),
    up(
        "CTU_LINT",
        &[CU, R, preset(Lint)],
        &[Q_UP, count(Lint)],
        &["Part AT %IX0.0 : BOOL", "Restart AT %IX0.1 : BOOL", "Full AT %QX0.0 : BOOL", "Parts : CTU_LINT"],
    ),
    up(
        "CTU_UDINT",
        &[CU, R, preset(Udint)],
        &[Q_UP, count(Udint)],
        &["Part AT %IX0.0 : BOOL", "Restart AT %IX0.1 : BOOL", "Full AT %QX0.0 : BOOL", "Parts : CTU_UDINT"],
    ),
    up(
        "CTU_ULINT",
        &[CU, R, preset(Ulint)],
        &[Q_UP, count(Ulint)],
        &["Part AT %IX0.0 : BOOL", "Restart AT %IX0.1 : BOOL", "Full AT %QX0.0 : BOOL", "Parts : CTU_ULINT"],
    ),
    down(
        "CTD",
        &[CD, LD, preset(Int)],
        &[Q_DOWN, count(Int)],
        &["Bottle AT %IX0.0 : BOOL", "Refill AT %IX0.1 : BOOL", "Empty AT %QX0.0 : BOOL", "Stock : CTD"],
    ),
    down(
        "CTD_DINT",
        &[CD, LD, preset(Dint)],
        &[Q_DOWN, count(Dint)],
        &["Bottle AT %IX0.0 : BOOL", "Refill AT %IX0.1 : BOOL", "Empty AT %QX0.0 : BOOL", "Stock : CTD_DINT"],
    ),
    down(
        "CTD_LINT",
        &[CD, LD, preset(Lint)],
        &[Q_DOWN, count(Lint)],
        &["Bottle AT %IX0.0 : BOOL", "Refill AT %IX0.1 : BOOL", "Empty AT %QX0.0 : BOOL", "Stock : CTD_LINT"],
    ),
    down(
        "CTD_UDINT",
        &[CD, LD, preset(Udint)],
        &[Q_DOWN, count(Udint)],
        &[
            "Bottle AT %IX0.0 : BOOL",
            "Refill AT %IX0.1 : BOOL",
            "Empty AT %QX0.0 : BOOL",
            "Stock : CTD_UDINT",
        ],
    ),
    down(
        "CTD_ULINT",
        &[CD, LD, preset(Ulint)],
        &[Q_DOWN, count(Ulint)],
        &[
            "Bottle AT %IX0.0 : BOOL",
            "Refill AT %IX0.1 : BOOL",
            "Empty AT %QX0.0 : BOOL",
            "Stock : CTD_ULINT",
        ],
    ),
    up_down(
        "CTUD",
        &[CU, CD, R, LD, preset(Int)],
        &[QU, QD, count(Int)],
        &[
            "Entry AT %IX0.0 : BOOL",
            "Leaving AT %IX0.1 : BOOL",
            "Clear AT %IX0.2 : BOOL",
            "Full AT %QX0.0 : BOOL",
            "Cars : CTUD",
        ],
    ),
    up_down(
        "CTUD_DINT",
        &[CU, CD, R, LD, preset(Dint)],
        &[QU, QD, count(Dint)],
        &[
            "Entry AT %IX0.0 : BOOL",
            "Leaving AT %IX0.1 : BOOL",
            "Clear AT %IX0.2 : BOOL",
            "Full AT %QX0.0 : BOOL",
            "Cars : CTUD_DINT",
        ],
    ),
    up_down(
        "CTUD_LINT",
        &[CU, CD, R, LD, preset(Lint)],
        &[QU, QD, count(Lint)],
        &[
            "Entry AT %IX0.0 : BOOL",
            "Leaving AT %IX0.1 : BOOL",
            "Clear AT %IX0.2 : BOOL",
            "Full AT %QX0.0 : BOOL",
            "Cars : CTUD_LINT",
        ],
    ),
    up_down(
        "CTUD_UDINT",
        &[CU, CD, R, LD, preset(Udint)],
        &[QU, QD, count(Udint)],
        &[
            "Entry AT %IX0.0 : BOOL",
            "Leaving AT %IX0.1 : BOOL",
            "Clear AT %IX0.2 : BOOL",
            "Full AT %QX0.0 : BOOL",
            "Cars : CTUD_UDINT",
        ],
    ),
    up_down(
        "CTUD_ULINT",
        &[CU, CD, R, LD, preset(Ulint)],
        &[QU, QD, count(Ulint)],
        &[
            "Entry AT %IX0.0 : BOOL",
            "Leaving AT %IX0.1 : BOOL",
            "Clear AT %IX0.2 : BOOL",
            "Full AT %QX0.0 : BOOL",
            "Cars : CTUD_ULINT",
        ],
    ),
];

const CU: Parameter = Parameter::of("CU", Bool, "counts up on a rising edge");
const CD: Parameter = Parameter::of("CD", Bool, "counts down on a rising edge");
const R: Parameter = Parameter::of("R", Bool, "reset");
const LD: Parameter = Parameter::of("LD", Bool, "loads PV");
const Q_UP: Parameter = Parameter::of("Q", Bool, "CV has reached PV");
const Q_DOWN: Parameter = Parameter::of("Q", Bool, "CV is 0 or less");
const QU: Parameter = Parameter::of("QU", Bool, "CV has reached PV");
const QD: Parameter = Parameter::of("QD", Bool, "CV is 0 or less");

const fn preset(kind: ElementaryType) -> Parameter {
    Parameter::of("PV", kind, "preset value")
}

const fn count(kind: ElementaryType) -> Parameter {
    Parameter::of("CV", kind, "current value")
}

const fn up(
    name: &'static str,
    inputs: &'static [Parameter],
    outputs: &'static [Parameter],
    variables: &'static [&'static str],
) -> FunctionBlock {
    FunctionBlock {
        name,
        title: "up counter",
        inputs,
        outputs,
        input_operators: &["CU", "R", "PV"],
        working: count_up,
        page: Page {
            about: "Counts rising edges of CU in CV; Q is on while CV is PV or more, and R, which has \
            precedence, clears CV. PV and CV are of the type that the name ends in, as with `CTU_DINT`, \
            and INT if it names none. By the standard counting goes on past PV up to a limit of the \
            maker's, some controllers stop at PV, so test Q rather than CV for equality. Give PV before \
            the first call counts: with PV left at 0, Q is on from the start.",
            variables,
            body: &[
                "CAL Parts(",
                "    CU := Part,",
                "    R := Restart,",
                "    PV := 24",
                ")",
                "LD Parts.Q",
                "ST Full",
            ],
        },
    }
}

const fn down(
    name: &'static str,
    inputs: &'static [Parameter],
    outputs: &'static [Parameter],
    variables: &'static [&'static str],
) -> FunctionBlock {
    FunctionBlock {
        name,
        title: "down counter",
        inputs,
        outputs,
        input_operators: &["CD", "PV"],
        working: count_down,
        page: Page {
            about: "Counts CV down on rising edges of CD; Q is on while CV is 0 or less, and LD, which has \
            precedence, loads PV into CV. PV and CV are of the type that the name ends in, as with \
            `CTD_DINT`, and INT if it names none. Before the first load CV is 0, so Q is on from the \
            start. By the standard counting goes on below 0, some controllers stop there. The input LD \
            is no input operator: the word would mean load.",
            variables,
            body: &[
                "CAL Stock(",
                "    CD := Bottle,",
                "    LD := Refill,",
                "    PV := 12",
                ")",
                "LD Stock.Q",
                "ST Empty",
            ],
        },
    }
}

const fn up_down(
    name: &'static str,
    inputs: &'static [Parameter],
    outputs: &'static [Parameter],
    variables: &'static [&'static str],
) -> FunctionBlock {
    FunctionBlock {
        name,
        title: "up-down counter",
        inputs,
        outputs,
        input_operators: &["CU", "CD", "R", "PV"],
        working: count_up_down,
        page: Page {
            about: "Counts up on rising edges of CU and down on those of CD; both at once change nothing. R \
            clears CV and goes before LD, which loads PV, and both go before counting. QU is on while CV \
            is PV or more, QD while it is 0 or less. PV and CV are of the type that the name ends in, as \
            with `CTUD_DINT`, and INT if it names none. The usual counter of a store with an entrance \
            and an exit.",
            variables,
            body: &[
                "CAL Cars(",
                "    CU := Entry,",
                "    CD := Leaving,",
                "    R := Clear,",
                "    LD := FALSE,",
                "    PV := 80",
                ")",
                "LD Cars.QU",
                "ST Full",
            ],
        },
    }
}

/// CU, R, PV to Q, CV. Counting ends at the greatest number that CV holds.
fn count_up(instance: &mut dyn Instance) {
    let is_edge = instance.has_risen(0, 0);
    let count = match () {
        () if instance.is_on(1) => 0,
        () if is_edge => (instance.output(1) + 1).min(*instance.range(1).end()),
        () => instance.output(1),
    };
    instance.set_output(1, count);
    instance.switch(0, count >= instance.input(2));
}

/// CD, LD, PV to Q, CV. Counting ends at the least number that CV holds.
fn count_down(instance: &mut dyn Instance) {
    let is_edge = instance.has_risen(0, 0);
    let count = match () {
        () if instance.is_on(1) => instance.input(2),
        () if is_edge => (instance.output(1) - 1).max(*instance.range(1).start()),
        () => instance.output(1),
    };
    instance.set_output(1, count);
    instance.switch(0, count <= 0);
}

/// CU, CD, R, LD, PV to QU, QD, CV.
fn count_up_down(instance: &mut dyn Instance) {
    let (up, down) = (instance.has_risen(0, 0), instance.has_risen(1, 1));
    let (count, range) = (instance.output(2), instance.range(2));
    let count = match (up, down) {
        _ if instance.is_on(2) => 0,
        _ if instance.is_on(3) => instance.input(4),
        (true, false) => (count + 1).min(*range.end()),
        (false, true) => (count - 1).max(*range.start()),
        _ => count,
    };
    instance.set_output(2, count);
    instance.switch(0, count >= instance.input(4));
    instance.switch(1, count <= 0);
}
