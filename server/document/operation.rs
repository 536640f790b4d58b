//! One view of instructions for both notations: a contact drawn and a contact written are the same operation.

use super::{Chunk, Tree};
use crate::il::fx::LineKind;
use crate::ladder::{CoilKind, CompareOperator, ContactKind, Element, ElementKind};
use crate::target::{Form, Operand};
use crate::text::{Span, Spanned};
use std::sync::LazyLock;

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
    /// The element that it is drawn as.
    pub element: Option<&'a Element>,
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
                let operands = tree.operands(line);
                Some(Operation { form, symbol: line.mnemonic, is_word: true, operands, element: None })
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
        Some(Operation { form, symbol, is_word, operands: &element.operands, element: Some(element) })
    }

    /// The program steps that it takes; an unknown word takes none.
    pub fn steps(&self) -> u32 {
        // The other operands make no difference.
        let first = self.operands.first().map(|operand| operand.value);
        self.form.map_or(0, |form| form.steps(first.as_slice()))
    }
}

/// The instruction of an element, its cells, and whether these are a word.
fn form_of(element: &Element) -> Option<(Option<Form>, Span, bool)> {
    let form = match &element.kind {
        ElementKind::Contact(kind) => contact_form(*kind),
        ElementKind::Compare(operator) => compare_form(*operator),
        ElementKind::Coil(kind) => coil_form(*kind),
        ElementKind::Instruction { form, mnemonic } => return Some((*form, *mnemonic, true)),
        ElementKind::Invert => Form::named("INV"),
        ElementKind::Block(_)
        | ElementKind::Jump(_)
        | ElementKind::Return
        | ElementKind::ConnectorOut(_)
        | ElementKind::ConnectorIn(_) => return None,
    };
    Some((form, element.span, false))
}

/// The instruction that loads a contact of this kind.
pub fn contact_form(kind: ContactKind) -> Option<Form> {
    DRAWN.contacts[kind as usize]
}

/// The instruction that loads this comparison.
pub fn compare_form(operator: CompareOperator) -> Option<Form> {
    Form::named(compare_mnemonic(operator))
}

/// The instruction that drives a coil of this kind; a negated one is driven by OUT behind INV.
pub fn coil_form(kind: CoilKind) -> Option<Form> {
    DRAWN.coils[kind as usize]
}

/// The instructions of the commonest elements, looked up once: each rule asks for them at each element.
struct DrawnForms {
    /// In the order of [`ContactKind::ALL`], which is that of the kinds.
    contacts: [Option<Form>; ContactKind::ALL.len()],
    /// In the order of [`CoilKind::ALL`], which is that of the kinds.
    coils: [Option<Form>; CoilKind::ALL.len()],
}

static DRAWN: LazyLock<DrawnForms> = LazyLock::new(|| DrawnForms {
    contacts: ContactKind::ALL.map(|kind| Form::named(contact_mnemonic(kind))),
    coils: CoilKind::ALL.map(|kind| Form::named(coil_mnemonic(kind))),
});

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

#[cfg(test)]
mod tests {
    use super::*;

    /// The tables of [`DRAWN`] are made in the order of `ALL` and read by the numbers of the kinds.
    #[test]
    fn kinds_are_listed_in_the_order_of_their_numbers() {
        assert!(ContactKind::ALL.iter().enumerate().all(|(place, kind)| *kind as usize == place));
        assert!(CoilKind::ALL.iter().enumerate().all(|(place, kind)| *kind as usize == place));
    }
}
