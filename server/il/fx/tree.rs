//! The tree of a chunk: flat records with offsets, no heap node for each token.

use crate::target::instructions::LABEL;
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

/// What a word of a program is, for colouring and hovering.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum WordKind {
    /// A step number.
    Step,
    /// A mnemonic or a label.
    Mnemonic(LineKind),
    /// An operand.
    Operand(Operand),
    /// A comment; it may span lines.
    Comment,
}

impl FxTree {
    /// The operands of a line.
    pub fn operands(&self, line: &FxLine) -> &[Spanned<Operand>] {
        self.operands.get(line.operands.0 as usize..line.operands.1 as usize).unwrap_or(&[])
    }

    /// The program steps that a line takes, see [`steps`].
    pub fn steps_of(&self, line: &FxLine) -> u32 {
        let form = match line.kind {
            LineKind::Instruction(form) => form,
            LineKind::Label(_) => Form { instruction: &LABEL, wide: false, pulse: false },
            LineKind::Unknown => return 0,
        };
        // The others make no difference.
        let first = self.operands(line).first().map(|operand| operand.value);
        form.steps(first.as_slice())
    }

    /// The last line that begins at or before `offset`: the one in which a cursor stands, or is about to add to.
    pub fn line_before(&self, offset: usize) -> Option<&FxLine> {
        let after = self.lines.partition_point(|line| line.span.start as usize <= offset);
        self.lines.get(after.checked_sub(1)?)
    }

    /// The line that a cursor at `offset` touches, from the mnemonic to the last operand.
    pub fn line_at(&self, offset: usize) -> Option<&FxLine> {
        self.line_before(offset).filter(|line| line.span.touches(offset))
    }

    /// The operand that a cursor at `offset` touches, as an index into [`FxTree::operands`], and its line; the later
    /// one where two meet.
    pub fn operand_at(&self, offset: usize) -> Option<(&FxLine, usize)> {
        let line = self.line_at(offset)?;
        let place = self.operands(line).iter().rposition(|operand| operand.span.touches(offset))?;
        Some((line, line.operands.0 as usize + place))
    }

    /// The comment in which `offset` lies, its delimiters included.
    pub fn comment_at(&self, offset: usize) -> Option<Span> {
        let after = self.comments.partition_point(|comment| comment.start as usize <= offset);
        self.comments.get(after.checked_sub(1)?).copied().filter(|comment| comment.touches(offset))
    }

    /// All words and comments in order.
    pub fn words(&self) -> impl Iterator<Item = Spanned<WordKind>> {
        let mut comments = self.comments.iter().peekable();
        let mut words = self.lines.iter().flat_map(|line| self.words_of(line)).peekable();
        std::iter::from_fn(move || {
            let comment = comments.peek().map(|comment| comment.start);
            let word = words.peek().map(|word| word.span.start);
            match (comment, word) {
                (Some(comment), Some(word)) if comment > word => words.next(),
                (Some(_), _) => comments.next().map(|span| Spanned::new(WordKind::Comment, *span)),
                (None, _) => words.next(),
            }
        })
    }

    fn words_of<'t>(&'t self, line: &'t FxLine) -> impl Iterator<Item = Spanned<WordKind>> + 't {
        let step = line.step.map(|step| Spanned::new(WordKind::Step, step.span));
        let mnemonic = Spanned::new(WordKind::Mnemonic(line.kind), line.mnemonic);
        let operands = self.operands(line).iter();
        let operands = operands.map(|operand| Spanned::new(WordKind::Operand(operand.value), operand.span));
        step.into_iter().chain([mnemonic]).chain(operands)
    }
}

/// The program steps that the chunk takes: a label one, unknown words none.
pub fn steps(tree: &FxTree) -> u32 {
    tree.lines.iter().fold(0, |sum, line| sum.saturating_add(tree.steps_of(line)))
}
