//! What is called: a function block or a function of the standard, or one that the program or its project declares.

use crate::document::{DeclaredType, Pou, Scopes, Variable};
use crate::il::iec::{PouKind, SectionKind};
use crate::target::iec::{EN, ENO, ElementaryType, Function, FunctionBlock, Parameter, ParameterType};
use crate::text::folded;
use smol_str::SmolStr;
use std::fmt;
use std::sync::Arc;

/// A function block or a function, as who calls it knows it.
#[derive(Clone)]
pub enum Callee {
    /// A function block of the standard.
    Block(&'static FunctionBlock),
    /// A function of the standard.
    Function(&'static Function),
    /// One that the document declares, or another file of its project.
    Declared(Arc<Pou>),
}

/// A formal parameter of a callee.
#[derive(Clone, Debug)]
pub struct Formal<'c> {
    /// As declared; upper case in the standard.
    pub name: &'c str,
    /// The name of its type; nothing for one of a group of types, or one without a name.
    pub type_name: Option<SmolStr>,
    /// Whether it is a VAR_IN_OUT, which the callee may change.
    pub is_in_out: bool,
}

impl Callee {
    /// The function block called `name`, letter case aside; one that is declared hides one of the standard.
    pub fn block(name: &str, scopes: &Scopes) -> Option<Callee> {
        let declared = declared(name, PouKind::FunctionBlock, scopes);
        declared.or_else(|| FunctionBlock::named(name).map(Callee::Block))
    }

    /// The function called `name`, letter case aside, that is declared with a result.
    pub fn declared_function(name: &str, scopes: &Scopes) -> Option<Callee> {
        let found = declared(name, PouKind::Function, scopes)?;
        matches!(&found, Callee::Declared(pou) if pou.result.is_some()).then_some(found)
    }

    /// Its name: as declared, upper case in the standard.
    pub fn name(&self) -> &str {
        match self {
            Callee::Block(block) => block.name,
            Callee::Function(function) => function.name,
            Callee::Declared(pou) => &pou.name,
        }
    }

    /// Whether it is a part of the program, so that it may look at, and change, what is known to all its units.
    pub fn is_declared(&self) -> bool {
        matches!(self, Callee::Declared(_))
    }

    /// Whether it is the block of this name that the standard has.
    pub fn is_standard(&self, name: &str) -> bool {
        matches!(self, Callee::Block(block) if block.name == name)
    }

    /// The inputs in the order of the declaration, VAR_IN_OUT among them. EN is none of them.
    pub fn inputs(&self) -> Vec<Formal<'_>> {
        match self {
            Callee::Block(block) => block.inputs.iter().map(Formal::standard).collect(),
            Callee::Function(function) => function.inputs.iter().map(Formal::standard).collect(),
            Callee::Declared(pou) => Formal::all(pou, &[SectionKind::Input, SectionKind::InOut]),
        }
    }

    /// The outputs of a block in the order of the declaration. ENO is none of them.
    pub fn outputs(&self) -> Vec<Formal<'_>> {
        match self {
            Callee::Block(block) => block.outputs.iter().map(Formal::standard).collect(),
            Callee::Function(_) => Vec::new(),
            Callee::Declared(pou) => Formal::all(pou, &[SectionKind::Output]),
        }
    }

    /// The input that power can drive: the first one, if it is a bit and there is an output from which power goes on.
    /// Any other block has EN and ENO on the power line.
    pub fn power_in(&self) -> Option<&str> {
        self.power_out()?;
        self.inputs().into_iter().next().filter(|first| first.is_bit() && !first.is_in_out).map(|it| it.name)
    }

    /// The output from which power goes on: the first one that is a bit.
    pub fn power_out(&self) -> Option<&str> {
        self.outputs().into_iter().find(Formal::is_bit).map(|it| it.name)
    }

    /// The name of the type of its result, if it is a function that the program declares and the type has one.
    pub fn result_type(&self) -> Option<SmolStr> {
        match self {
            Callee::Declared(pou) => type_name(pou.result.as_ref()?),
            _ => None,
        }
    }
}

/// Two are the same if who calls them sees no difference.
impl PartialEq for Callee {
    fn eq(&self, other: &Callee) -> bool {
        match (self, other) {
            (Callee::Block(own), Callee::Block(other)) => own.name == other.name,
            (Callee::Function(own), Callee::Function(other)) => own.name == other.name,
            (Callee::Declared(own), Callee::Declared(other)) => {
                Arc::ptr_eq(own, other) || own.kind == other.kind && own.is_seen_as(other)
            }
            _ => false,
        }
    }
}

impl fmt::Debug for Callee {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl<'c> Formal<'c> {
    fn standard(parameter: &Parameter) -> Formal<'static> {
        let type_name = match parameter.kind {
            ParameterType::Elementary(kind) => Some(kind.name().into()),
            ParameterType::Generic(_) => None,
        };
        Formal { name: parameter.name, type_name, is_in_out: false }
    }

    /// The parameters of `pou` in these sections. EN and ENO mean the same whether they are declared or not.
    fn all(pou: &'c Pou, sections: &[SectionKind]) -> Vec<Formal<'c>> {
        let is_enable =
            |name: &str| [EN.name, ENO.name].iter().any(|enable| enable.eq_ignore_ascii_case(name));
        let of = |variable: &&Variable| sections.contains(&variable.section) && !is_enable(&variable.name);
        let formal = |variable: &'c Variable| Formal {
            name: &variable.name,
            type_name: type_name(&variable.declared),
            is_in_out: variable.section == SectionKind::InOut,
        };
        pou.variables.iter().filter(of).map(formal).collect()
    }

    /// Whether it is one bit.
    pub fn is_bit(&self) -> bool {
        self.type_name.as_deref() == Some(ElementaryType::Bool.name())
    }

    /// Whether it is called so, letter case aside.
    pub fn is_called(&self, name: &str) -> bool {
        folded(self.name) == folded(name)
    }
}

fn declared(name: &str, kind: PouKind, scopes: &Scopes) -> Option<Callee> {
    let pou = scopes.pous.get(scopes.pou_number(name)?)?;
    (pou.kind == kind).then(|| Callee::Declared(pou.clone()))
}

fn type_name(declared: &DeclaredType) -> Option<SmolStr> {
    match declared {
        DeclaredType::Elementary(kind) => Some(kind.name().into()),
        DeclaredType::Named(name) => Some(name.clone()),
        DeclaredType::Subrange(base, _) => type_name(base),
        _ => None,
    }
}
