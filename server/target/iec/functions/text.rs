//! Character strings; positions count from 1.

use super::{Function, FunctionPage, Parameter, ParameterType};
use crate::target::Fault;
use crate::target::iec::page::Page;
use crate::target::iec::{Datum, Formula, Inputs};
use crate::target::iec::{ElementaryType, GenericType};

/// LEN LEFT RIGHT MID CONCAT INSERT DELETE REPLACE FIND.
pub const ROWS: &[Function] = &[
    Function {
        name: "LEN",
        title: "length",
        inputs: &[Parameter::any("IN", GenericType::AnyString, "text")],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Int),
        formula: Formula::new(|inputs| Ok(Datum::Whole(count(inputs.text(0))))),
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
        formula: Formula::new(|inputs| part(inputs.text(0), 1, length(inputs, 1)?)),
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
        formula: Formula::new(right),
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
        formula: Formula::new(|inputs| part(inputs.text(0), position(inputs, 2)?, length(inputs, 1)?)),
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
        formula: Formula::new(concatenated),
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
        formula: Formula::new(inserted),
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
        formula: Formula::new(deleted),
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
        formula: Formula::new(replaced),
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
        formula: Formula::new(found),
        page: FunctionPage::Own(Page {
            about: "The position in IN1 where IN2 first occurs, the first character being number 1, and \
                    0 if it does not occur. In a non-formal call the current result is the text that is \
                    searched.",
            variables: &["Message : STRING := 'OK 42'", "Position AT %QW0 : INT"],
            body: &["LD Message", "FIND 'OK'", "ST Position"],
        }),
    },
];

fn count(text: &str) -> i128 {
    text.chars().count() as i128
}

/// A number of characters, which is not negative.
fn length(inputs: &Inputs<'_>, place: usize) -> Result<i128, Fault> {
    let length = inputs.whole(place);
    if length < 0 { Err(Fault::Value(place as u8)) } else { Ok(length) }
}

/// A position from 1.
fn position(inputs: &Inputs<'_>, place: usize) -> Result<i128, Fault> {
    let position = inputs.whole(place);
    if position < 1 { Err(Fault::Value(place as u8)) } else { Ok(position) }
}

/// As many characters as there are from a position on, `length` at most.
fn part(text: &str, position: i128, length: i128) -> Result<Datum, Fault> {
    let least = |number: i128| usize::try_from(number).unwrap_or(usize::MAX);
    Ok(Datum::Text(text.chars().skip(least(position - 1)).take(least(length)).collect()))
}

fn right(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    let (text, length) = (inputs.text(0), length(inputs, 1)?);
    part(text, (count(text) - length).max(0) + 1, length)
}

fn concatenated(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    Ok(Datum::Text(inputs.values.iter().map(Datum::text).collect()))
}

/// The text with what stands from a position on, `length` characters, replaced.
fn spliced(text: &str, position: i128, length: i128, with: &str) -> Datum {
    let least = |number: i128| usize::try_from(number).unwrap_or(usize::MAX);
    let before = text.chars().take(least(position - 1));
    let after = text.chars().skip(least((position - 1).saturating_add(length)));
    Datum::Text(before.chain(with.chars()).chain(after).collect())
}

fn inserted(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    let behind = length(inputs, 2)?;
    if behind > count(inputs.text(0)) {
        return Err(Fault::Value(2));
    }
    Ok(spliced(inputs.text(0), behind + 1, 0, inputs.text(1)))
}

fn deleted(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    Ok(spliced(inputs.text(0), position(inputs, 2)?, length(inputs, 1)?, ""))
}

fn replaced(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    Ok(spliced(inputs.text(0), position(inputs, 3)?, length(inputs, 2)?, inputs.text(1)))
}

fn found(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    let (text, wanted) = (inputs.text(0), inputs.text(1));
    // An empty text occurs nowhere.
    let at = text.find(wanted).filter(|_| !wanted.is_empty());
    Ok(Datum::Whole(at.map_or(0, |at| count(&text[..at]) + 1)))
}
