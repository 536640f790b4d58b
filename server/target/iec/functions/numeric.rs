//! Functions of one number, and arithmetic.

use super::{Function, FunctionPage, Parameter, ParameterType};
use crate::target::Fault;
use crate::target::iec::GenericType;
use crate::target::iec::page::Page;
use crate::target::iec::semantics::NS_OF_DAY;
use crate::target::iec::{Datum, ElementaryType, Formula, Inputs};

const REAL_INPUT: &[Parameter] = &[Parameter::any("IN", GenericType::AnyReal, "number")];
const IN1_IN2_NUM: &[Parameter] = &[
    Parameter::any("IN1", GenericType::AnyNum, "first number"),
    Parameter::any("IN2", GenericType::AnyNum, "second number"),
];

/// ABS SQRT LN LOG EXP SIN COS TAN ASIN ACOS ATAN ATAN2 ADD MUL SUB DIV MOD EXPT MOVE.
pub const ROWS: &[Function] = &[
    Function {
        name: "ABS",
        title: "absolute value",
        inputs: &[Parameter::any("IN", GenericType::AnyNum, "number")],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyNum),
        formula: Formula::new(absolute).with_kernel(|number, _| number.checked_abs()),
        page: FunctionPage::Own(Page {
            about: "The absolute value of a number of any type, in the same type. The most negative \
                    signed integer has none: ABS of INT -32768 does not fit and is an error, or -32768 \
                    again where the controller wraps around.",
            variables: &["Deviation AT %IW0 : INT", "Distance AT %QW0 : INT"],
            body: &["LD Deviation", "ABS", "ST Distance"],
        }),
    },
    Function {
        name: "SQRT",
        title: "square root",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::sqrt)),
        page: FunctionPage::Own(Page {
            about: "The square root of a REAL or an LREAL, in the same type. A negative input is an \
                    error. A flow from a differential pressure is the usual case; cut the pressure off \
                    at 0 with `MAX` first, because a sensor at rest may show a little less.",
            variables: &["Pressure : REAL := 6.25", "Flow : REAL"],
            body: &["LD Pressure", "MAX 0.0", "SQRT", "ST Flow"],
        }),
    },
    Function {
        name: "LN",
        title: "natural logarithm",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::ln)),
        page: FunctionPage::Own(Page {
            about: "The logarithm to base e of a REAL or an LREAL, in the same type. The input must be \
                    greater than 0, or the result is an error.",
            variables: &["Ratio : REAL := 2.5", "Result : REAL"],
            body: &["LD Ratio", "LN", "ST Result"],
        }),
    },
    Function {
        name: "LOG",
        title: "common logarithm",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::log10)),
        page: FunctionPage::Own(Page {
            about: "The logarithm to base 10 of a REAL or an LREAL, in the same type. The input must be \
                    greater than 0, or the result is an error. Mind the name: in many programming \
                    languages `log` is the natural logarithm, here that is `LN`.",
            variables: &["Power : REAL := 100.0", "Level : REAL"],
            body: &["LD Power", "LOG", "MUL 10.0", "ST Level"],
        }),
    },
    Function {
        name: "EXP",
        title: "natural exponential",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::exp)),
        page: FunctionPage::Own(Page {
            about: "e to the power of a REAL or an LREAL, in the same type. The result grows out of a \
                    REAL's range above 88.7, which is an error.",
            variables: &["Exponent : REAL := -0.5", "Decay : REAL"],
            body: &["LD Exponent", "EXP", "ST Decay"],
        }),
    },
    Function {
        name: "SIN",
        title: "sine",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::sin)),
        page: FunctionPage::Own(Page {
            about: "The sine of an angle in radians, REAL or LREAL, in the same type. Multiply degrees \
                    by 0.01745329 first. Large angles lose accuracy, so keep them within a turn.",
            variables: &["Degrees : REAL := 30.0", "Result : REAL"],
            body: &["LD Degrees", "MUL 0.01745329", "SIN", "ST Result"],
        }),
    },
    Function {
        name: "COS",
        title: "cosine",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::cos)),
        page: FunctionPage::Own(Page {
            about: "The cosine of an angle in radians, REAL or LREAL, in the same type. Multiply degrees \
                    by 0.01745329 first.",
            variables: &["Degrees : REAL := 30.0", "Result : REAL"],
            body: &["LD Degrees", "MUL 0.01745329", "COS", "ST Result"],
        }),
    },
    Function {
        name: "TAN",
        title: "tangent",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::tan)),
        page: FunctionPage::Own(Page {
            about: "The tangent of an angle in radians, REAL or LREAL, in the same type. Near a quarter \
                    turn, 1.570796, it grows beyond every bound and the result is of no use.",
            variables: &["Degrees : REAL := 30.0", "Result : REAL"],
            body: &["LD Degrees", "MUL 0.01745329", "TAN", "ST Result"],
        }),
    },
    Function {
        name: "ASIN",
        title: "arc sine",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::asin)),
        page: FunctionPage::Own(Page {
            about: "The angle in radians, from -1.570796 to 1.570796, whose sine is the input, REAL or \
                    LREAL, in the same type. An input outside -1.0 to 1.0 is an error, so limit a \
                    measured ratio first.",
            variables: &["Ratio : REAL := 0.5", "Angle : REAL"],
            body: &["LD Ratio", "ASIN", "ST Angle"],
        }),
    },
    Function {
        name: "ACOS",
        title: "arc cosine",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::acos)),
        page: FunctionPage::Own(Page {
            about: "The angle in radians, from 0.0 to 3.141593, whose cosine is the input, REAL or \
                    LREAL, in the same type. An input outside -1.0 to 1.0 is an error, so limit a \
                    measured ratio first.",
            variables: &["Ratio : REAL := 0.5", "Angle : REAL"],
            body: &["LD Ratio", "ACOS", "ST Angle"],
        }),
    },
    Function {
        name: "ATAN",
        title: "arc tangent",
        inputs: REAL_INPUT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| defined(inputs, f64::atan)),
        page: FunctionPage::Own(Page {
            about: "The angle in radians, from -1.570796 to 1.570796, whose tangent is the input, REAL \
                    or LREAL, in the same type. Every input is allowed. For the direction of a point use \
                    `ATAN2`, which knows the quadrant.",
            variables: &["Slope : REAL := 1.0", "Angle : REAL"],
            body: &["LD Slope", "ATAN", "ST Angle"],
        }),
    },
    Function {
        name: "ATAN2",
        title: "arc tangent of two",
        inputs: &[
            Parameter::any("Y", GenericType::AnyReal, "distance upwards"),
            Parameter::any("X", GenericType::AnyReal, "distance to the right"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(|inputs| Ok(Datum::Real(inputs.real(0).atan2(inputs.real(1))))),
        page: FunctionPage::Own(Page {
            about: "The angle in radians between the X axis and the point (X, Y), from -3.141593 to \
                    3.141593; REAL or LREAL, all of one type. Y comes first, so in a non-formal call the \
                    current result is Y. An addition of the third edition.",
            variables: &["Height : REAL := 1.0", "Width : REAL := -1.0", "Angle : REAL"],
            body: &["LD Height", "ATAN2 Width", "ST Angle"],
        }),
    },
    Function {
        name: "ADD",
        title: "sum",
        inputs: IN1_IN2_NUM,
        extensible: true,
        result: ParameterType::Generic(GenericType::AnyNum),
        formula: Formula::new(sum).with_kernel(i64::checked_add),
        page: FunctionPage::Own(Page {
            about: "The sum of two or more numbers of one type. In Instruction List the operator ADD \
                    does the same with the current result and one operand; with more operands after it, \
                    separated by commas, it is this function. For times see `ADD_TIME`.",
            variables: &[
                "First AT %IW0 : INT",
                "Second AT %IW1 : INT",
                "Third AT %IW2 : INT",
                "Total AT %QW0 : INT",
            ],
            body: &["LD First", "ADD Second, Third", "ST Total"],
        }),
    },
    Function {
        name: "MUL",
        title: "product",
        inputs: IN1_IN2_NUM,
        extensible: true,
        result: ParameterType::Generic(GenericType::AnyNum),
        formula: Formula::new(product).with_kernel(i64::checked_mul),
        page: FunctionPage::Own(Page {
            about: "The product of two or more numbers of one type, in that type and not in a wider one. \
                    In Instruction List the operator MUL does the same with one operand; with more \
                    operands, separated by commas, it is this function.",
            variables: &[
                "Length AT %IW0 : INT",
                "Width AT %IW1 : INT",
                "Height AT %IW2 : INT",
                "Volume AT %QW0 : INT",
            ],
            body: &["LD Length", "MUL Width, Height", "ST Volume"],
        }),
    },
    Function {
        name: "SUB",
        title: "difference",
        inputs: IN1_IN2_NUM,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyNum),
        formula: Formula::new(difference).with_kernel(i64::checked_sub),
        page: FunctionPage::Own(Page {
            about: "IN1 minus IN2, numbers of one type. In Instruction List the current result is IN1, \
                    as with the operator of the same name. An unsigned type cannot go below 0.",
            variables: &["Target AT %IW0 : INT", "Actual AT %IW1 : INT", "Error AT %QW0 : INT"],
            body: &["LD Target", "SUB Actual", "ST Error"],
        }),
    },
    Function {
        name: "DIV",
        title: "quotient",
        inputs: IN1_IN2_NUM,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyNum),
        formula: Formula::new(quotient).with_kernel(i64::checked_div),
        page: FunctionPage::Own(Page {
            about: "IN1 divided by IN2, numbers of one type; in Instruction List the current result is \
                    IN1. Integers are truncated towards zero: -7 divided by 2 gives -3. Division by zero \
                    is an error: with EN and ENO the call reports it on ENO instead of stopping the \
                    controller. In the simulator the result is then 0, as it is where EN keeps a \
                    function from being executed.",
            variables: &["Sum AT %IW0 : INT", "Samples : INT := 10", "Mean AT %QW0 : INT"],
            body: &["LD Sum", "DIV Samples", "ST Mean"],
        }),
    },
    Function {
        name: "MOD",
        title: "remainder",
        inputs: &[
            Parameter::any("IN1", GenericType::AnyInt, "dividend"),
            Parameter::any("IN2", GenericType::AnyInt, "divisor"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyInt),
        formula: Formula::new(remainder).with_kernel(i64::checked_rem),
        page: FunctionPage::Own(Page {
            about: "The remainder of IN1 divided by IN2, integers of one type; in Instruction List the \
                    current result is IN1. It has the sign of IN1, and with IN2 = 0 the standard gives \
                    0.",
            variables: &["Scans AT %IW0 : UINT", "Phase AT %QW0 : UINT"],
            body: &["LD Scans", "MOD 4", "ST Phase"],
        }),
    },
    Function {
        name: "EXPT",
        title: "power",
        inputs: &[
            Parameter::any("IN1", GenericType::AnyReal, "base"),
            Parameter::any("IN2", GenericType::AnyNum, "exponent"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyReal),
        formula: Formula::new(power),
        page: FunctionPage::Own(Page {
            about: "IN1 to the power of IN2; in Instruction List the current result is the base, a REAL \
                    or an LREAL, and the result has its type. The exponent may be of any numeric type. A \
                    negative base with a fraction in the exponent is an error.",
            variables: &["Radius : REAL := 1.5", "Square : REAL"],
            body: &["LD Radius", "EXPT 2", "ST Square"],
        }),
    },
    Function {
        name: "MOVE",
        title: "assignment",
        inputs: &[Parameter::any("IN", GenericType::Any, "value")],
        extensible: false,
        result: ParameterType::Generic(GenericType::Any),
        formula: Formula::COPY,
        page: FunctionPage::Own(Page {
            about: "Gives its input unchanged, of any type. In Instruction List it does nothing that \
                    `LD` and `ST` do not do; in ladder it is the block that copies a value while its EN \
                    is on.",
            variables: &["Setpoint AT %IW0 : INT", "Copy AT %QW0 : INT"],
            body: &["LD Setpoint", "MOVE", "ST Copy"],
        }),
    },
];

/// A function of one real number. Where it has none, the input is what is wrong; where it grows too large, the result.
fn defined(inputs: &Inputs<'_>, function: fn(f64) -> f64) -> Result<Datum, Fault> {
    finite(function(inputs.real(0)), inputs)
}

/// The result, if there is one; one that grows too large is infinite.
fn finite(result: f64, inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    // The logarithm of 0 is no overflow: there is none.
    let is_none = result.is_nan() || result == f64::NEG_INFINITY && inputs.real(0) == 0.0;
    let is_told = inputs.values.iter().any(|value| !value.real().is_finite());
    if is_none && !is_told { Err(Fault::Value(0)) } else { Ok(Datum::Real(result)) }
}

fn absolute(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    Ok(match &inputs.values[0] {
        Datum::Real(number) => Datum::Real(number.abs()),
        other => Datum::Whole(other.whole().abs()),
    })
}

/// Puts the inputs together from left to right: all of them as reals, or all as whole numbers.
fn joined(
    inputs: &Inputs<'_>,
    whole: fn(i128, i128) -> Option<i128>,
    real: fn(f64, f64) -> f64,
) -> Result<Datum, Fault> {
    let Some((first, rest)) = inputs.values.split_first() else { return Err(Fault::Value(0)) };
    if inputs.result.belongs_to(GenericType::AnyReal) {
        // Each step has the digits of the type.
        let step =
            |left: f64, right: &Datum| Datum::Real(real(left, right.real())).held(inputs.result).0.real();
        return finite(rest.iter().fold(first.real(), step), inputs);
    }
    let joined = rest.iter().try_fold(first.whole(), |left, right| whole(left, right.whole()));
    joined.map(Datum::Whole).ok_or(Fault::Overflow)
}

pub(super) fn sum(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    joined(inputs, i128::checked_add, |left, right| left + right)
}

pub(super) fn difference(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    match (inputs.kind(0), inputs.kind(1)) {
        // Days become a duration.
        (ElementaryType::Date, ElementaryType::Date) | (ElementaryType::Ldate, ElementaryType::Ldate) => {
            Ok(Datum::Whole((inputs.whole(0) - inputs.whole(1)) * NS_OF_DAY))
        }
        _ => joined(inputs, i128::checked_sub, |left, right| left - right),
    }
}

pub(super) fn product(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    // A duration times a real number is a duration again.
    let is_scaled = inputs.has_real() && !inputs.result.belongs_to(GenericType::AnyReal);
    match is_scaled {
        true => scaled(inputs.real(0) * inputs.real(1)),
        false => joined(inputs, i128::checked_mul, |left, right| left * right),
    }
}

pub(super) fn quotient(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    if inputs.real(1) == 0.0 {
        return Err(Fault::DivisionByZero);
    }
    let is_scaled = inputs.has_real() && !inputs.result.belongs_to(GenericType::AnyReal);
    match is_scaled {
        true => scaled(inputs.real(0) / inputs.real(1)),
        false => joined(inputs, i128::checked_div, |left, right| left / right),
    }
}

fn scaled(nanoseconds: f64) -> Result<Datum, Fault> {
    match nanoseconds.is_finite() {
        true => Ok(Datum::Whole(nanoseconds.round_ties_even() as i128)),
        false => Err(Fault::Overflow),
    }
}

/// By the standard's definition nothing is left of a division by 0.
fn remainder(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    Ok(Datum::Whole(inputs.whole(0).checked_rem(inputs.whole(1)).unwrap_or(0)))
}

fn power(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    finite(inputs.real(0).powf(inputs.real(1)), inputs)
}
