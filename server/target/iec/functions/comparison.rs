//! Comparison.

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

/// GT GE EQ LE LT NE.
pub const ROWS: &[Function] = &[
    Function {
        name: "GT",
        title: "decreasing sequence",
        inputs: IN1_IN2,
        extensible: true,
        result: ParameterType::Elementary(ElementaryType::Bool),
        formula: Formula::new(|inputs| chained(inputs, Ordering::is_gt))
            .with_kernel(|left, right| Some(i64::from(left > right))),
        page: FunctionPage::Own(Page {
            about: "1 if each value is greater than the next, else 0; two or more values of one \
                    elementary type. With three inputs it says whether IN1 > IN2 and IN2 > IN3. In \
                    Instruction List the current result is IN1, and the operator of the same name \
                    compares it with one operand; with more operands, separated by commas, it is this \
                    function.",
            variables: &[
                "Low AT %IW0 : INT",
                "Middle AT %IW1 : INT",
                "High AT %IW2 : INT",
                "Ordered AT %QX0.0 : BOOL",
            ],
            body: &["LD Low", "GT Middle, High", "ST Ordered"],
        }),
    },
    Function {
        name: "GE",
        title: "monotonic sequence",
        inputs: IN1_IN2,
        extensible: true,
        result: ParameterType::Elementary(ElementaryType::Bool),
        formula: Formula::new(|inputs| chained(inputs, Ordering::is_ge))
            .with_kernel(|left, right| Some(i64::from(left >= right))),
        page: FunctionPage::Own(Page {
            about: "1 if no value is less than the next, else 0; two or more values of one elementary \
                    type. With three inputs it says whether IN1 >= IN2 and IN2 >= IN3. In Instruction \
                    List the current result is IN1, and the operator of the same name compares it with \
                    one operand; with more operands, separated by commas, it is this function.",
            variables: &[
                "Low AT %IW0 : INT",
                "Middle AT %IW1 : INT",
                "High AT %IW2 : INT",
                "Ordered AT %QX0.0 : BOOL",
            ],
            body: &["LD Low", "GE Middle, High", "ST Ordered"],
        }),
    },
    Function {
        name: "EQ",
        title: "equality",
        inputs: IN1_IN2,
        extensible: true,
        result: ParameterType::Elementary(ElementaryType::Bool),
        formula: Formula::new(|inputs| chained(inputs, Ordering::is_eq))
            .with_kernel(|left, right| Some(i64::from(left == right))),
        page: FunctionPage::Own(Page {
            about: "1 if all values are equal, else 0; two or more values of one elementary type. With \
                    three inputs it says whether IN1 = IN2 and IN2 = IN3. In Instruction List the \
                    current result is IN1, and the operator of the same name compares it with one \
                    operand; with more operands, separated by commas, it is this function.",
            variables: &[
                "Low AT %IW0 : INT",
                "Middle AT %IW1 : INT",
                "High AT %IW2 : INT",
                "Ordered AT %QX0.0 : BOOL",
            ],
            body: &["LD Low", "EQ Middle, High", "ST Ordered"],
        }),
    },
    Function {
        name: "LE",
        title: "monotonic sequence",
        inputs: IN1_IN2,
        extensible: true,
        result: ParameterType::Elementary(ElementaryType::Bool),
        formula: Formula::new(|inputs| chained(inputs, Ordering::is_le))
            .with_kernel(|left, right| Some(i64::from(left <= right))),
        page: FunctionPage::Own(Page {
            about: "1 if no value is greater than the next, else 0; two or more values of one elementary \
                    type. With three inputs it says whether IN1 <= IN2 and IN2 <= IN3. In Instruction \
                    List the current result is IN1, and the operator of the same name compares it with \
                    one operand; with more operands, separated by commas, it is this function.",
            variables: &[
                "Low AT %IW0 : INT",
                "Middle AT %IW1 : INT",
                "High AT %IW2 : INT",
                "Ordered AT %QX0.0 : BOOL",
            ],
            body: &["LD Low", "LE Middle, High", "ST Ordered"],
        }),
    },
    Function {
        name: "LT",
        title: "increasing sequence",
        inputs: IN1_IN2,
        extensible: true,
        result: ParameterType::Elementary(ElementaryType::Bool),
        formula: Formula::new(|inputs| chained(inputs, Ordering::is_lt))
            .with_kernel(|left, right| Some(i64::from(left < right))),
        page: FunctionPage::Own(Page {
            about: "1 if each value is less than the next, else 0; two or more values of one elementary \
                    type. With three inputs it says whether IN1 < IN2 and IN2 < IN3. In Instruction List \
                    the current result is IN1, and the operator of the same name compares it with one \
                    operand; with more operands, separated by commas, it is this function.",
            variables: &[
                "Low AT %IW0 : INT",
                "Middle AT %IW1 : INT",
                "High AT %IW2 : INT",
                "Ordered AT %QX0.0 : BOOL",
            ],
            body: &["LD Low", "LT Middle, High", "ST Ordered"],
        }),
    },
    Function {
        name: "NE",
        title: "inequality",
        inputs: IN1_IN2,
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Bool),
        formula: Formula::new(|inputs| {
            chained(inputs, Ordering::is_eq).map(|same| Datum::from(same == Datum::from(false)))
        })
        .with_kernel(|left, right| Some(i64::from(left != right))),
        page: FunctionPage::Own(Page {
            about: "1 if the two values differ, else 0; both of one elementary type. Unlike the other \
                    comparisons it takes two inputs only, because a chain of unequal values would say \
                    little.",
            variables: &["Wanted AT %IW0 : INT", "Actual AT %IW1 : INT", "Mismatch AT %QX0.0 : BOOL"],
            body: &["LD Wanted", "NE Actual", "ST Mismatch"],
        }),
    },
];

/// Whether each value stands so to the next.
fn chained(inputs: &Inputs<'_>, holds: fn(Ordering) -> bool) -> Result<Datum, Fault> {
    let pairs = inputs.values.windows(2);
    Ok(Datum::from(pairs.into_iter().all(|pair| pair[0].order(&pair[1]).is_some_and(holds))))
}
