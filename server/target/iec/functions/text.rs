//! Character strings; positions count from 1.

use super::{Function, FunctionPage, Parameter, ParameterType};
use crate::target::iec::page::Page;
use crate::target::iec::{ElementaryType, GenericType};

/// LEN LEFT RIGHT MID CONCAT INSERT DELETE REPLACE FIND.
pub const ROWS: &[Function] = &[
    Function {
        name: "LEN",
        title: "length",
        inputs: &[Parameter::any("IN", GenericType::AnyString, "text")],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Int),
        page: FunctionPage::Own(Page {
            about: "The number of characters in a text, 0 for an empty one. The capacity that the \
                    declaration gives, `STRING[20]`, plays no part.",
            variables: &["Code : STRING := 'A-4711'", "Length AT %QW0 : INT"],
            body: &["LD Code", "LEN", "ST Length"],
        }),
    },
    Function {
        name: "LEFT",
        title: "left part",
        inputs: &[
            Parameter::any("IN", GenericType::AnyString, "text"),
            Parameter::any("L", GenericType::AnyInt, "number of characters"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyString),
        page: FunctionPage::Own(Page {
            about: "The first L characters of a text. The current result is the text, the operand L. \
                    With L greater than the length the whole text is the result; a negative L is an \
                    error.",
            variables: &["Code : STRING := 'A-4711'", "Prefix : STRING"],
            body: &["LD Code", "LEFT 1", "ST Prefix"],
        }),
    },
    Function {
        name: "RIGHT",
        title: "right part",
        inputs: &[
            Parameter::any("IN", GenericType::AnyString, "text"),
            Parameter::any("L", GenericType::AnyInt, "number of characters"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyString),
        page: FunctionPage::Own(Page {
            about: "The last L characters of a text. The current result is the text, the operand L. With \
                    L greater than the length the whole text is the result; a negative L is an error.",
            variables: &["Code : STRING := 'A-4711'", "Number : STRING"],
            body: &["LD Code", "RIGHT 4", "ST Number"],
        }),
    },
    Function {
        name: "MID",
        title: "middle part",
        inputs: &[
            Parameter::any("IN", GenericType::AnyString, "text"),
            Parameter::any("L", GenericType::AnyInt, "number of characters"),
            Parameter::any("P", GenericType::AnyInt, "position, from 1"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyString),
        page: FunctionPage::Own(Page {
            about: "L characters of a text from position P on, the first character being number 1. The \
                    order is text, length, position: in a non-formal call the current result is the \
                    text, and the length comes before the position.",
            variables: &["Code : STRING := 'A-4711'", "Series : STRING"],
            body: &["LD Code", "MID 2, 3", "ST Series"],
        }),
    },
    Function {
        name: "CONCAT",
        title: "concatenation",
        inputs: &[
            Parameter::any("IN1", GenericType::AnyString, "first text"),
            Parameter::any("IN2", GenericType::AnyString, "second text"),
        ],
        extensible: true,
        result: ParameterType::Generic(GenericType::AnyString),
        page: FunctionPage::Own(Page {
            about: "Two or more texts of one type joined into one; the current result comes first. What \
                    does not fit into the variable that it is stored to is cut off.",
            variables: &["Order : STRING := '4711'", "Label : STRING"],
            body: &["LD 'No. '", "CONCAT Order, ' - ready'", "ST Label"],
        }),
    },
    Function {
        name: "INSERT",
        title: "insertion",
        inputs: &[
            Parameter::any("IN1", GenericType::AnyString, "text"),
            Parameter::any("IN2", GenericType::AnyString, "text to be inserted"),
            Parameter::any("P", GenericType::AnyInt, "position, from 1"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyString),
        page: FunctionPage::Own(Page {
            about: "IN1 with IN2 put in after its character number P; P = 0 puts it in front. In a \
                    non-formal call the current result is IN1.",
            variables: &["Day : STRING := '20240131'", "Result : STRING"],
            body: &["LD Day", "INSERT '-', 4", "ST Result"],
        }),
    },
    Function {
        name: "DELETE",
        title: "deletion",
        inputs: &[
            Parameter::any("IN", GenericType::AnyString, "text"),
            Parameter::any("L", GenericType::AnyInt, "number of characters"),
            Parameter::any("P", GenericType::AnyInt, "position, from 1"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyString),
        page: FunctionPage::Own(Page {
            about: "A text without the L characters from position P on, the first character being number \
                    1. As with `MID` the length comes before the position.",
            variables: &["Code : STRING := 'A-4711'", "Result : STRING"],
            body: &["LD Code", "DELETE 1, 2", "ST Result"],
        }),
    },
    Function {
        name: "REPLACE",
        title: "replacement",
        inputs: &[
            Parameter::any("IN1", GenericType::AnyString, "text"),
            Parameter::any("IN2", GenericType::AnyString, "new text"),
            Parameter::any("L", GenericType::AnyInt, "number of characters"),
            Parameter::any("P", GenericType::AnyInt, "position, from 1"),
        ],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyString),
        page: FunctionPage::Own(Page {
            about: "IN1 with the L characters from position P on replaced by IN2, which may be longer or \
                    shorter. In a non-formal call the current result is IN1 and the operands are IN2, L, \
                    P in this order.",
            variables: &["Status : STRING := 'Pump off'", "Result : STRING"],
            body: &["LD Status", "REPLACE 'on', 3, 6", "ST Result"],
        }),
    },
    Function {
        name: "FIND",
        title: "search",
        inputs: &[
            Parameter::any("IN1", GenericType::AnyString, "text"),
            Parameter::any("IN2", GenericType::AnyString, "text to be found"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Int),
        page: FunctionPage::Own(Page {
            about: "The position in IN1 where IN2 first occurs, the first character being number 1, and \
                    0 if it does not occur. In a non-formal call the current result is the text that is \
                    searched.",
            variables: &["Message : STRING := 'OK 42'", "Position AT %QW0 : INT"],
            body: &["LD Message", "FIND 'OK'", "ST Position"],
        }),
    },
];
