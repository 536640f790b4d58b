//! The tree of a chunk: flat records with offsets, no heap node for each token.

use crate::target::{Device, Form, Operand};
use crate::text::{Diagnostic, Span, Spanned};

/// One chunk of FX instruction list. All spans are offsets into the chunk.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct FxTree {
    /// Instructions and labels in order; blank and comment lines leave no record.
    pub lines: Vec<FxLine>,
    /// The operands of all lines; each line names its range.
    pub operands: Vec<Spanned<Operand>>,
    /// Comments, delimiters included, in order.
    pub comments: Vec<Span>,
    /// What could not be read.
    pub problems: Vec<Diagnostic>,
}

/// One instruction or label.
#[derive(Clone, PartialEq, Debug)]
pub struct FxLine {
    /// From the mnemonic to the last operand; step number and comment left out.
    pub span: Span,
    /// The step number before it, if written.
    pub step: Option<Spanned<u32>>,
    /// The mnemonic, or the whole label.
    pub mnemonic: Span,
    /// What it is.
    pub kind: LineKind,
    /// Range in [`FxTree::operands`].
    pub operands: (u32, u32),
}

/// What a line is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum LineKind {
    /// An instruction of the table.
    Instruction(Form),
    /// A label, `P0` or `I001`, alone before an instruction.
    Label(Device),
    /// A word that the table does not have.
    Unknown,
}

impl FxTree {
    /// The operands of a line.
    pub fn operands(&self, line: &FxLine) -> &[Spanned<Operand>] {
        self.operands.get(line.operands.0 as usize..line.operands.1 as usize).unwrap_or(&[])
    }
}
