//! The answers, plain data with offsets into the document.

use crate::il::iec::PouKind;
use crate::text::{Span, TextEdit};

/// What a hover shows.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Hover {
    /// The word.
    pub span: Span,
    /// Markdown.
    pub markdown: String,
}

/// One proposal.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Completion {
    /// What is shown.
    pub label: String,
    /// What it is.
    pub kind: CompletionKind,
    /// A few words beside it.
    pub detail: String,
    /// Markdown.
    pub documentation: String,
    /// What is replaced and by what.
    pub edit: TextEdit,
    /// Whether the text has `$1`, `${2:name}` places.
    pub is_snippet: bool,
    /// Orders the list; smaller comes first.
    pub rank: u16,
    /// What typed letters are compared with, if not the label.
    pub filter: String,
}

/// What a proposal is.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub enum CompletionKind {
    Instruction,
    Device,
    Variable,
    Label,
    Function,
    FunctionBlock,
    Keyword,
    Type,
    Constant,
    Snippet,
}

/// Lines that fold.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Fold {
    /// From the first to the last byte.
    pub span: Span,
    /// What it is.
    pub kind: FoldKind,
}

/// What folds.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum FoldKind {
    /// A rung, a network, a POU, a VAR section.
    Region,
    /// A comment of several lines.
    Comment,
}

/// A node of the outline.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SymbolNode {
    /// `Network 3: Start`, `P0`, `Motor`.
    pub name: String,
    /// The outputs of a rung, the type of a variable.
    pub detail: String,
    /// What it is.
    pub kind: SymbolKind,
    /// All of it.
    pub span: Span,
    /// The name.
    pub selection: Span,
    /// What is inside.
    pub children: Vec<SymbolNode>,
}

/// What a node of the outline is.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub enum SymbolKind {
    Program,
    FunctionBlock,
    Function,
    Network,
    Rung,
    Label,
    Step,
    Section,
    Variable,
    Type,
    Configuration,
}

impl From<PouKind> for SymbolKind {
    fn from(kind: PouKind) -> SymbolKind {
        match kind {
            PouKind::Program => SymbolKind::Program,
            PouKind::FunctionBlock => SymbolKind::FunctionBlock,
            PouKind::Function => SymbolKind::Function,
        }
    }
}

/// Text shown behind `offset`.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct InlayHint {
    /// Behind which byte.
    pub offset: usize,
    /// `= 5 s`
    pub label: String,
    /// Why.
    pub tooltip: String,
}

/// What the status bar shows.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Status {
    /// `fx2n`
    pub target: &'static str,
    /// `ladder`, `fx`, `iec`
    pub dialect: &'static str,
    /// Rungs, or statements blocks.
    pub rungs: usize,
    /// Program steps used; `None` where the notion has no meaning.
    pub steps: Option<u32>,
    /// Program steps that fit.
    pub capacity: u32,
}
