//! Selection.

use super::{Function, FunctionPage, Parameter, ParameterType};
use crate::target::Fault;
use crate::target::iec::page::Page;
use crate::target::iec::{Datum, Formula, Inputs};
use crate::target::iec::{ElementaryType, GenericType};
use std::cmp::Ordering;

const IN1_IN2: &[Parameter] = &[
    Parameter::any("IN1", GenericType::AnyElementary, "first value"),
    Parameter::any("IN2", GenericType::AnyElementary, "second value"),
];

/// SEL MAX MIN LIMIT MUX.
pub const ROWS: &[Function] = &[
    Function {
        name: "SEL",
        title: "binary selection",
        inputs: &[
            Parameter::of("G", ElementaryType::Bool, "selector"),
            Parameter::any("IN0", GenericType::Any, "result while G is 0"),
            Parameter::any("IN1", GenericType::Any, "result while G is 1"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::Any),
        formula: Formula::new(|inputs| picked(inputs, 1 + inputs.whole(0))),
        page: FunctionPage::Own(Page {
            about: "One of two values of the same type: IN0 while the selector G is 0, IN1 while it is \
                    1. In a non-formal call the current result is G. Mind the order: the value for FALSE \
                    comes first, the other way round than in an IF.",
            variables: &[
                "Automatic AT %IX0.0 : BOOL",
                "Manual : INT := 20",
                "Computed AT %IW1 : INT",
                "Setpoint AT %QW0 : INT",
            ],
            body: &["LD Automatic", "SEL Manual, Computed", "ST Setpoint"],
        }),
    },
    Function {
        name: "MAX",
        title: "maximum",
        inputs: IN1_IN2,
        extensible: true,
        result: ParameterType::Generic(GenericType::AnyElementary),
        formula: Formula::new(|inputs| outermost(inputs, Ordering::is_gt))
            .with_kernel(|left, right| Some(left.max(right))),
        page: FunctionPage::Own(Page {
            about: "The greatest of two or more values of one elementary type. The current result is the \
                    first of them. `MAX` with a constant is a lower limit: `MAX 0` lets nothing below 0 \
                    through.",
            variables: &[
                "North AT %IW0 : INT",
                "South AT %IW1 : INT",
                "East AT %IW2 : INT",
                "Result AT %QW0 : INT",
            ],
            body: &["LD North", "MAX South, East", "ST Result"],
        }),
    },
    Function {
        name: "MIN",
        title: "minimum",
        inputs: IN1_IN2,
        extensible: true,
        result: ParameterType::Generic(GenericType::AnyElementary),
        formula: Formula::new(|inputs| outermost(inputs, Ordering::is_lt))
            .with_kernel(|left, right| Some(left.min(right))),
        page: FunctionPage::Own(Page {
            about: "The smallest of two or more values of one elementary type. The current result is the \
                    first of them. `MIN` with a constant is an upper limit: `MIN 100` lets nothing above \
                    100 through.",
            variables: &[
                "North AT %IW0 : INT",
                "South AT %IW1 : INT",
                "East AT %IW2 : INT",
                "Result AT %QW0 : INT",
            ],
            body: &["LD North", "MIN South, East", "ST Result"],
        }),
    },
    Function {
        name: "LIMIT",
        title: "limiter",
        inputs: &[
            Parameter::any("MN", GenericType::AnyElementary, "lower limit"),
            Parameter::any("IN", GenericType::AnyElementary, "value"),
            Parameter::any("MX", GenericType::AnyElementary, "upper limit"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyElementary),
        formula: Formula::new(limited),
        page: FunctionPage::Own(Page {
            about: "IN, but no less than MN and no more than MX; all of one elementary type. The trap is \
                    the order: MN is declared first, so in a non-formal call the current result is the \
                    lower limit and not the value: `LD Value`, `LIMIT 0, 100` would limit 0 to the range \
                    from Value to 100. Name the inputs as below, or load the lower limit.",
            variables: &["Request AT %IW0 : INT", "Speed AT %QW0 : INT"],
            body: &["LIMIT(", "    MN := 0,", "    IN := Request,", "    MX := 1500", ")", "ST Speed"],
        }),
    },
    Function {
        name: "MUX",
        title: "multiplexer",
        inputs: &[
            Parameter::any("K", GenericType::AnyInt, "selector, from 0"),
            Parameter::any("IN0", GenericType::Any, "result for 0"),
            Parameter::any("IN1", GenericType::Any, "result for 1"),
        ],
        extensible: true,
        result: ParameterType::Generic(GenericType::Any),
        formula: Formula::new(|inputs| picked(inputs, 1 + inputs.whole(0))),
        page: FunctionPage::Own(Page {
            about: "One of several values of the same type: IN0 for K = 0, IN1 for K = 1 and so on, \
                    counted from zero. In a non-formal call the current result is K. A selector below 0 \
                    or past the last input is an error.",
            variables: &["Recipe AT %IW0 : INT", "Temperature AT %QW0 : INT"],
            body: &["LD Recipe", "MUX 60, 75, 90", "ST Temperature"],
        }),
    },
];

/// The input at a place, if the selector names one behind itself.
fn picked(inputs: &Inputs<'_>, place: i128) -> Result<Datum, Fault> {
    let place = usize::try_from(place).ok().filter(|place| *place > 0);
    place.and_then(|place| inputs.values.get(place)).cloned().ok_or(Fault::Value(0))
}

fn outermost(inputs: &Inputs<'_>, is_beyond: fn(Ordering) -> bool) -> Result<Datum, Fault> {
    let beyond = |best: &'_ Datum, value: &Datum| value.order(best).is_some_and(is_beyond);
    let best = inputs.values.iter().reduce(|best, value| if beyond(best, value) { value } else { best });
    best.cloned().ok_or(Fault::Value(0))
}

/// The lesser of the upper limit and of the greater of the value and the lower limit: limits the wrong way round give
/// the upper one.
fn limited(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    let [least, value, greatest] = inputs.values else { return Err(Fault::Value(0)) };
    let value = if least.order(value).is_some_and(Ordering::is_gt) { least } else { value };
    Ok(if value.order(greatest).is_some_and(Ordering::is_gt) { greatest } else { value }.clone())
}
