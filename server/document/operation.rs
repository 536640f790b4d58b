//! One view of instructions for both notations: a contact drawn and a contact written are the same operation.

use super::{Chunk, Tree};
use crate::il::fx::LineKind;
use crate::ladder::{CoilKind, CompareOperator, ContactKind, Element, ElementKind};
use crate::target::{Form, Operand};
use crate::text::{Span, Spanned};

/// An FX instruction of a chunk, written in a line or drawn as an element.
#[derive(Clone, Copy, Debug)]
pub struct Operation<'a> {
    /// The instruction; `None` where its word is not in the table.
    pub form: Option<Form>,
    /// Its word, or the cells of the symbol that stands for it.
    pub symbol: Span,
    /// Whether `symbol` is a word that a person wrote.
    pub is_word: bool,
    /// Its operands.
    pub operands: &'a [Spanned<Operand>],
}

impl Chunk {
    /// The FX instructions in it, in the order of the text. Function blocks, jumps to names and connectors are none.
    pub fn operations(&self) -> impl Iterator<Item = Operation<'_>> {
        let (fx, ladder) = match self.tree() {
            Tree::Fx(tree) => (Some(tree), None),
            Tree::Ladder(tree) => (None, Some(tree)),
            Tree::Iec(_) => (None, None),
        };
        let lines = fx.into_iter().flat_map(|tree| {
            tree.lines.iter().filter_map(|line| {
                let form = match line.kind {
                    LineKind::Instruction(form) => Some(form),
                    LineKind::Unknown => None,
                    LineKind::Label(_) => return None,
                };
                Some(Operation { form, symbol: line.mnemonic, is_word: true, operands: tree.operands(line) })
            })
        });
        let elements =
            ladder.into_iter().flat_map(|tree| tree.rungs.iter()).flat_map(|rung| &rung.graph.elements);
        lines.chain(elements.filter_map(Operation::of_element))
    }
}

impl<'a> Operation<'a> {
    /// The instruction that an element stands for, if any.
    pub fn of_element(element: &'a Element) -> Option<Operation<'a>> {
        let (form, symbol, is_word) = form_of(element)?;
        Some(Operation { form, symbol, is_word, operands: &element.operands })
    }
}

/// The instruction of an element, its cells, and whether these are a word.
fn form_of(element: &Element) -> Option<(Option<Form>, Span, bool)> {
    Some(match &element.kind {
        ElementKind::Contact(kind) => (Form::named(contact_mnemonic(*kind)), element.span, false),
        ElementKind::Compare(operator) => (Form::named(compare_mnemonic(*operator)), element.span, false),
        ElementKind::Coil(kind) => (Form::named(coil_mnemonic(*kind)), element.span, false),
        ElementKind::Instruction { form, mnemonic } => (*form, *mnemonic, true),
        ElementKind::Invert => (Form::named("INV"), element.span, false),
        ElementKind::Block(_)
        | ElementKind::Jump(_)
        | ElementKind::Return
        | ElementKind::ConnectorOut(_)
        | ElementKind::ConnectorIn(_) => return None,
    })
}

fn contact_mnemonic(kind: ContactKind) -> &'static str {
    match kind {
        ContactKind::NormallyOpen => "LD",
        ContactKind::NormallyClosed => "LDI",
        ContactKind::Rising => "LDP",
        ContactKind::Falling => "LDF",
    }
}

/// A negated coil is written INV, OUT; its operand is that of OUT.
fn coil_mnemonic(kind: CoilKind) -> &'static str {
    match kind {
        CoilKind::Plain | CoilKind::Negated => "OUT",
        CoilKind::Set => "SET",
        CoilKind::Reset => "RST",
        CoilKind::Rising => "PLS",
        CoilKind::Falling => "PLF",
        CoilKind::Toggle => "ALTP",
    }
}

fn compare_mnemonic(operator: CompareOperator) -> &'static str {
    match operator {
        CompareOperator::Equal { wide: false } => "LD=",
        CompareOperator::Equal { wide: true } => "LDD=",
        CompareOperator::NotEqual { wide: false } => "LD<>",
        CompareOperator::NotEqual { wide: true } => "LDD<>",
        CompareOperator::Greater { wide: false } => "LD>",
        CompareOperator::Greater { wide: true } => "LDD>",
        CompareOperator::Less { wide: false } => "LD<",
        CompareOperator::Less { wide: true } => "LDD<",
        CompareOperator::GreaterOrEqual { wide: false } => "LD>=",
        CompareOperator::GreaterOrEqual { wide: true } => "LDD>=",
        CompareOperator::LessOrEqual { wide: false } => "LD<=",
        CompareOperator::LessOrEqual { wide: true } => "LDD<=",
    }
}
