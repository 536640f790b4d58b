//! What can be called, and which parameters it has.

use super::{ValueType, View};
use crate::document::{DeclaredType, Pou, Variable};
use crate::il::iec::{PouKind, SectionKind};
use crate::target::iec::{
    EN, ENO, ElementaryType, Function, FunctionBlock, GenericType, Parameter, ParameterType,
};
use crate::text::folded;

/// A function or a function block.
#[derive(Clone, Copy)]
pub enum Callee<'a> {
    /// A standard function.
    Function(&'static Function),
    /// A standard function block.
    Block(&'static FunctionBlock),
    /// A function or a function block that the document declares.
    Declared(&'a Pou),
}

/// Which way the value of a parameter goes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Flow {
    /// An input.
    In,
    /// An output.
    Out,
    /// VAR_IN_OUT.
    InOut,
}

/// What type a place wants.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Expected {
    /// This one.
    Elementary(ElementaryType),
    /// Any of a group.
    Group(GenericType),
    /// Anything, or something that the rules do not judge.
    Unknown,
}

/// A parameter of a callee.
#[derive(Clone, Copy, Debug)]
pub struct Pin<'a> {
    /// As declared.
    pub name: &'a str,
    /// Which way the value goes.
    pub flow: Flow,
    /// Its type.
    pub expected: Expected,
}

impl<'a> Callee<'a> {
    /// The function called `name`; one that the document declares hides a standard one.
    pub fn function(view: &View<'a>, name: &str) -> Option<Callee<'a>> {
        match view.scopes.pou_named(name) {
            Some(pou) if pou.kind == PouKind::Function => Some(Callee::Declared(pou)),
            _ => Function::named(name).map(Callee::Function),
        }
    }

    /// The function block with the folded name `name`.
    pub fn block(view: &View<'a>, name: &str) -> Option<Callee<'a>> {
        match view.scopes.pou_named(name) {
            Some(pou) if pou.kind == PouKind::FunctionBlock => Some(Callee::Declared(pou)),
            _ => FunctionBlock::named(name).map(Callee::Block),
        }
    }

    /// Its name as declared.
    pub fn name(&self) -> &'a str {
        match self {
            Callee::Function(function) => function.name,
            Callee::Block(block) => block.name,
            Callee::Declared(pou) => pou.name.as_str(),
        }
    }

    /// How many inputs a call without names has, and whether there may be more of the last.
    pub fn inputs(&self) -> (usize, bool) {
        match self {
            Callee::Function(function) => (function.inputs.len(), function.extensible),
            Callee::Block(block) => (block.inputs.len(), false),
            Callee::Declared(pou) => (pou.variables.iter().filter(|one| is_input(one)).count(), false),
        }
    }

    /// The parameters in the order of a call without names: inputs, then the outputs of blocks.
    pub fn pins(&self, view: &View<'a>) -> Vec<Pin<'a>> {
        let standard = |parameters: &'static [Parameter], flow| {
            parameters.iter().map(move |parameter| Pin::of(parameter, flow))
        };
        match self {
            Callee::Function(function) => standard(function.inputs, Flow::In).collect(),
            Callee::Block(block) => {
                standard(block.inputs, Flow::In).chain(standard(block.outputs, Flow::Out)).collect()
            }
            Callee::Declared(pou) => {
                let inputs = pou.variables.iter().filter(|one| is_input(one));
                let outputs = pou.variables.iter().filter(|one| one.section == SectionKind::Output);
                inputs.chain(outputs).map(|variable| Pin::declared(view, variable)).collect()
            }
        }
    }

    /// The parameter at `position` of a call without names.
    pub fn pin_at(&self, view: &View<'a>, position: usize) -> Option<Pin<'a>> {
        match self {
            Callee::Function(function) => function.input(position).map(|input| Pin::of(input, Flow::In)),
            Callee::Block(block) => {
                block.inputs.get(position).map(|input| Pin::of(input, Flow::In)).or_else(|| {
                    block.outputs.get(position - block.inputs.len()).map(|out| Pin::of(out, Flow::Out))
                })
            }
            Callee::Declared(_) => self.pins(view).get(position).copied(),
        }
    }

    /// The parameter called `name`, EN and ENO included.
    pub fn pin_named(&self, view: &View<'a>, name: &str) -> Option<Pin<'a>> {
        let own = match self {
            Callee::Function(function) => function.input_named(name).map(|input| Pin::of(input, Flow::In)),
            Callee::Block(block) => block
                .input_named(name)
                .map(|input| Pin::of(input, Flow::In))
                .or_else(|| block.output_named(name).map(|output| Pin::of(output, Flow::Out))),
            Callee::Declared(pou) => {
                let variable = pou.variable(&folded(name));
                variable.filter(|one| is_parameter(one)).map(|variable| Pin::declared(view, variable))
            }
        };
        let implied = [Pin::of(&EN, Flow::In), Pin::of(&ENO, Flow::Out)];
        own.or_else(|| implied.into_iter().find(|pin| pin.name.eq_ignore_ascii_case(name)))
    }

    /// The type of a function's result; nothing for one that depends on the inputs.
    pub fn result(&self, view: &View<'a>) -> Expected {
        match self {
            Callee::Function(function) => Expected::of(function.result),
            Callee::Declared(pou) => {
                pou.result.as_ref().map_or(Expected::Unknown, |result| Expected::declared(view, result))
            }
            Callee::Block(_) => Expected::Unknown,
        }
    }
}

impl<'a> Pin<'a> {
    fn of(parameter: &'static Parameter, flow: Flow) -> Pin<'a> {
        Pin { name: parameter.name, flow, expected: Expected::of(parameter.kind) }
    }

    fn declared(view: &View<'a>, variable: &'a Variable) -> Pin<'a> {
        let flow = match variable.section {
            SectionKind::Output => Flow::Out,
            SectionKind::InOut => Flow::InOut,
            _ => Flow::In,
        };
        Pin { name: variable.name.as_str(), flow, expected: Expected::declared(view, &variable.declared) }
    }
}

impl Expected {
    fn of(kind: ParameterType) -> Expected {
        match kind {
            ParameterType::Elementary(kind) => Expected::Elementary(kind),
            ParameterType::Generic(group) => Expected::Group(group),
        }
    }

    fn declared(view: &View<'_>, declared: &DeclaredType) -> Expected {
        match view.value_of(declared.clone()) {
            ValueType::Elementary(kind) => Expected::Elementary(kind),
            _ => Expected::Unknown,
        }
    }

    /// The keyword: `INT`, `ANY_NUM`.
    pub fn name(self) -> &'static str {
        match self {
            Expected::Elementary(kind) => kind.name(),
            Expected::Group(group) => group.name(),
            Expected::Unknown => "ANY",
        }
    }
}

fn is_input(variable: &Variable) -> bool {
    matches!(variable.section, SectionKind::Input | SectionKind::InOut)
}

fn is_parameter(variable: &Variable) -> bool {
    is_input(variable) || variable.section == SectionKind::Output
}
