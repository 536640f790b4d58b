//! Shifts and bit logic.

use super::{Function, FunctionPage, Parameter, ParameterType};
use crate::target::Fault;
use crate::target::iec::GenericType;
use crate::target::iec::page::Page;
use crate::target::iec::{Datum, Formula, Inputs};

const SHIFT: &[Parameter] = &[
    Parameter::any("IN", GenericType::AnyBit, "bit string"),
    Parameter::any("N", GenericType::AnyInt, "number of places"),
];
const BITS: &[Parameter] = &[
    Parameter::any("IN1", GenericType::AnyBit, "first bit string"),
    Parameter::any("IN2", GenericType::AnyBit, "second bit string"),
];

/// SHL SHR ROL ROR AND OR XOR NOT.
pub const ROWS: &[Function] = &[
    Function {
        name: "SHL",
        title: "shift left",
        inputs: SHIFT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyBit),
        formula: Formula::new(|inputs| {
            shifted(inputs, |bits, by, width| if by < width { bits << by } else { 0 })
        }),
        page: FunctionPage::Own(Page {
            about: "Shifts a bit string left by N places; zeros come in on the right and the bits pushed \
                    out on the left are lost. The current result is IN, the operand is N. With N as \
                    large as the width or larger nothing but zeros remains; a negative N is an error.",
            variables: &["Pattern : WORD := 16#0F01", "Result AT %QW0 : WORD"],
            body: &["LD Pattern", "SHL 4", "ST Result"],
        }),
    },
    Function {
        name: "SHR",
        title: "shift right",
        inputs: SHIFT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyBit),
        formula: Formula::new(|inputs| {
            shifted(inputs, |bits, by, width| if by < width { bits >> by } else { 0 })
        }),
        page: FunctionPage::Own(Page {
            about: "Shifts a bit string right by N places; zeros come in on the left, so this is no \
                    division of a negative number. The current result is IN, the operand is N. With N as \
                    large as the width or larger nothing but zeros remains.",
            variables: &["Pattern : WORD := 16#0F01", "Result AT %QW0 : WORD"],
            body: &["LD Pattern", "SHR 4", "ST Result"],
        }),
    },
    Function {
        name: "ROL",
        title: "rotate left",
        inputs: SHIFT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyBit),
        formula: Formula::new(|inputs| {
            shifted(inputs, |bits, by, width| bits << (by % width) | bits >> (width - by % width))
        }),
        page: FunctionPage::Own(Page {
            about: "Turns a bit string left by N places; bits pushed out on the left come in again on \
                    the right. The current result is IN, the operand is N. Rotating by the full width \
                    gives the input back; the width is that of the type, 16 for a WORD.",
            variables: &["Pattern : WORD := 16#0F01", "Result AT %QW0 : WORD"],
            body: &["LD Pattern", "ROL 4", "ST Result"],
        }),
    },
    Function {
        name: "ROR",
        title: "rotate right",
        inputs: SHIFT,
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyBit),
        formula: Formula::new(|inputs| {
            shifted(inputs, |bits, by, width| bits >> (by % width) | bits << (width - by % width))
        }),
        page: FunctionPage::Own(Page {
            about: "Turns a bit string right by N places; bits pushed out on the right come in again on \
                    the left. The current result is IN, the operand is N. Rotating by the full width \
                    gives the input back; the width is that of the type, 16 for a WORD.",
            variables: &["Pattern : WORD := 16#0F01", "Result AT %QW0 : WORD"],
            body: &["LD Pattern", "ROR 4", "ST Result"],
        }),
    },
    Function {
        name: "AND",
        title: "and",
        inputs: BITS,
        extensible: true,
        result: ParameterType::Generic(GenericType::AnyBit),
        formula: Formula::new(|inputs| each_bit(inputs, |left, right| left & right))
            .with_kernel(|left, right| Some(left & right)),
        page: FunctionPage::Own(Page {
            about: "The bitwise AND of two or more bit strings of one type, BOOL included. In \
                    Instruction List the operator AND does the same with one operand; with more \
                    operands, separated by commas, it is this function. A word ANDed with a mask keeps \
                    the bits that the mask has set.",
            variables: &[
                "First AT %IW0 : WORD",
                "Second AT %IW1 : WORD",
                "Third AT %IW2 : WORD",
                "Result AT %QW0 : WORD",
            ],
            body: &["LD First", "AND Second, Third", "ST Result"],
        }),
    },
    Function {
        name: "OR",
        title: "or",
        inputs: BITS,
        extensible: true,
        result: ParameterType::Generic(GenericType::AnyBit),
        formula: Formula::new(|inputs| each_bit(inputs, |left, right| left | right))
            .with_kernel(|left, right| Some(left | right)),
        page: FunctionPage::Own(Page {
            about: "The bitwise OR of two or more bit strings of one type, BOOL included. In Instruction \
                    List the operator OR does the same with one operand; with more operands, separated \
                    by commas, it is this function.",
            variables: &[
                "First AT %IW0 : WORD",
                "Second AT %IW1 : WORD",
                "Third AT %IW2 : WORD",
                "Result AT %QW0 : WORD",
            ],
            body: &["LD First", "OR Second, Third", "ST Result"],
        }),
    },
    Function {
        name: "XOR",
        title: "exclusive or",
        inputs: BITS,
        extensible: true,
        result: ParameterType::Generic(GenericType::AnyBit),
        formula: Formula::new(|inputs| each_bit(inputs, |left, right| left ^ right))
            .with_kernel(|left, right| Some(left ^ right)),
        page: FunctionPage::Own(Page {
            about: "The bitwise exclusive OR of two or more bit strings of one type, BOOL included. With \
                    more than two inputs a bit of the result is 1 where an odd number of inputs has it, \
                    which makes a parity.",
            variables: &[
                "First AT %IW0 : WORD",
                "Second AT %IW1 : WORD",
                "Third AT %IW2 : WORD",
                "Result AT %QW0 : WORD",
            ],
            body: &["LD First", "XOR Second, Third", "ST Result"],
        }),
    },
    Function {
        name: "NOT",
        title: "complement",
        inputs: &[Parameter::any("IN", GenericType::AnyBit, "bit string")],
        extensible: false,
        result: ParameterType::Generic(GenericType::AnyBit),
        formula: Formula::new(complement),
        page: FunctionPage::Own(Page {
            about: "The complement of a bit string: every bit turns over, so NOT of WORD 16#F0F0 is \
                    16#0F0F and NOT of TRUE is FALSE. In Instruction List it works on the current result \
                    and has no operand.",
            variables: &["Mask AT %IW0 : WORD", "Inverse AT %QW0 : WORD"],
            body: &["LD Mask", "NOT", "ST Inverse"],
        }),
    },
];

/// Moves bits by a number of places, which is not negative; what leaves the bit string is lost.
fn shifted(inputs: &Inputs<'_>, by: fn(u128, u32, u32) -> u128) -> Result<Datum, Fault> {
    let width = inputs.result.bits().ok_or(Fault::Value(0))?;
    let places = inputs.whole(1);
    if places < 0 {
        return Err(Fault::Value(1));
    }
    // No shift is longer than a few turns of the longest bit string.
    let places = if places < 128 { places as u32 } else { 128 + (places % i128::from(width)) as u32 };
    let shifted = by(inputs.whole(0) as u128, places, width) & ((1 << width) - 1);
    Ok(Datum::Whole(shifted as i128))
}

fn each_bit(inputs: &Inputs<'_>, join: fn(i128, i128) -> i128) -> Result<Datum, Fault> {
    inputs.values.iter().map(Datum::whole).reduce(join).map(Datum::Whole).ok_or(Fault::Value(0))
}

fn complement(inputs: &Inputs<'_>) -> Result<Datum, Fault> {
    Ok(Datum::Whole(!inputs.whole(0)).within(inputs.result))
}
