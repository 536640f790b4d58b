//! The standard functions; the order of inputs matters for non-formal calls.

use super::page::Page;
use super::{ElementaryType, GenericType};

/// One standard function.
#[derive(Debug)]
pub struct Function {
    /// Upper case: `LIMIT`. Conversions have one row for each pair, made from a pattern.
    pub name: &'static str,
    /// A few words.
    pub title: &'static str,
    /// The inputs in the order of the declaration.
    pub inputs: &'static [Parameter],
    /// Whether the last input may be repeated (`ADD(IN1, IN2, IN3 …)`).
    pub extensible: bool,
    /// The result.
    pub result: ParameterType,
    pub(super) page: FunctionPage,
}

/// Where the page of a function comes from.
#[derive(Debug)]
pub(super) enum FunctionPage {
    /// Written out.
    Own(Page),
}

/// An input or output of a function or a function block.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Parameter {
    /// Upper case.
    pub name: &'static str,
    /// The type.
    pub kind: ParameterType,
    /// A few words for hover and signature help.
    pub meaning: &'static str,
}

/// The type of a parameter.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ParameterType {
    /// This one.
    Elementary(ElementaryType),
    /// Any of the group; all parameters of a function with the same group have the same type.
    Generic(GenericType),
}
