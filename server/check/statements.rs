//! A program as one sequence of instructions and labels, for the rules that look at the whole of it.
//!
//! Lines of FX instruction list and elements of FX ladders come alike, whichever file of the program they stand in.

use super::ProgramContext;
use crate::document::{ChunkRef, Document, Notation, Operation, Tree};
use crate::il::fx::LineKind;
use crate::ladder::{Element, ElementKind};
use crate::target::{Device, DeviceKind, Flow, Operand};
use crate::text::{Span, Spanned, TextEdit};

/// An instruction or a label of an FX program.
#[derive(Clone, Copy, Debug)]
pub(super) struct Statement<'a> {
    /// What it is.
    pub kind: StatementKind,
    /// The mnemonic, the label, or the cells of a drawn element.
    pub word: Span,
    /// From the mnemonic to the last operand.
    pub span: Span,
    /// The first operand.
    pub first: Option<Spanned<Operand>>,
    at: ChunkRef<'a>,
}

/// What a statement is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum StatementKind {
    /// A label.
    Label(Device),
    /// An instruction, by its part in the structure of the program.
    Instruction(Flow),
    /// A word that the table does not have.
    Unknown,
}

/// Whether the document is an FX program, in a list or drawn.
pub(super) fn is_fx_program(document: &Document) -> bool {
    match document.notation() {
        Notation::FxIl => true,
        Notation::Ladder => document.target().is_fx(),
        Notation::IecIl => false,
    }
}

impl<'a> ProgramContext<'a> {
    /// All statements, in the order of execution; none if it is no FX program.
    pub(super) fn statements(&self) -> impl Iterator<Item = Statement<'a>> + use<'a> {
        let is_fx = self.files().first().is_some_and(|file| is_fx_program(file.document));
        is_fx.then(|| self.chunks()).into_iter().flatten().flat_map(of_chunk)
    }

    /// The statements up to END, it included: what the PLC executes.
    pub(super) fn executed(&self) -> impl Iterator<Item = Statement<'a>> + use<'a> {
        let mut ended = false;
        self.statements().take_while(move |statement| {
            let goes_on = !ended;
            ended |= statement.flow() == Some(Flow::ProgramEnd);
            goes_on
        })
    }
}

impl<'a> Statement<'a> {
    /// Its part in the structure of the program, if it is an instruction.
    pub fn flow(&self) -> Option<Flow> {
        match self.kind {
            StatementKind::Instruction(flow) => Some(flow),
            _ => None,
        }
    }

    /// The device of its first operand.
    pub fn device(&self) -> Option<Device> {
        match self.first?.value {
            Operand::Device(device) => Some(device),
            _ => None,
        }
    }

    /// Its mnemonic as it is written.
    pub fn mnemonic(&self) -> &'a str {
        self.relative(self.word).of(self.at.chunk.text())
    }

    /// The words of it.
    pub fn text(&self) -> &'a str {
        self.relative(self.span).of(self.at.chunk.text())
    }

    /// Puts `line` on a line of its own before this one; nothing where there are no lines but a drawing.
    pub fn line_before(&self, line: &str) -> Option<TextEdit> {
        let edit = line_before(self.list()?, self.relative(self.word), line);
        Some(edit.shifted(self.at.start))
    }

    /// Takes it out with its line; nothing in a drawing.
    pub fn removal(&self) -> Option<TextEdit> {
        Some(removal(self.list()?, self.relative(self.span)).shifted(self.at.start))
    }

    /// The text of its chunk, if that is a list.
    fn list(&self) -> Option<&'a str> {
        matches!(self.at.chunk.tree(), Tree::Fx(_)).then(|| self.at.chunk.text())
    }

    fn relative(&self, span: Span) -> Span {
        let start = self.at.start as u32;
        Span { start: span.start - start, end: span.end - start }
    }
}

/// Puts `line` on a line of its own before the one in which `word` stands. Offsets are those of `text`.
pub(super) fn line_before(text: &str, word: Span, line: &str) -> TextEdit {
    let head = text.get(..word.start as usize).unwrap_or("");
    let start = head.rfind(['\n', '\r']).map_or(0, |newline| newline + 1);
    // The line end of the line before tells the habit of the file, or else that of this line.
    let tail = text.get(word.start as usize..).unwrap_or("");
    let own = tail.find('\n').is_some_and(|newline| tail[..newline].ends_with('\r'));
    let newline = if head[..start].ends_with("\r\n") || own { "\r\n" } else { "\n" };
    // Behind something else on the same line, such as a label, a new line begins right before the word.
    let is_first = head[start..].chars().all(|c| c.is_whitespace() || c.is_ascii_digit() || c == '\u{feff}');
    match is_first {
        true => TextEdit::new(Span::at(start), format!("{line}{newline}")),
        false => TextEdit::new(Span::at(word.start as usize), format!("{newline}{line}{newline}")),
    }
}

/// Takes `span` out of `text`, and its line if nothing else stands there.
pub(super) fn removal(text: &str, span: Span) -> TextEdit {
    let (head, tail) =
        (text.get(..span.start as usize).unwrap_or(""), text.get(span.end as usize..).unwrap_or(""));
    let start = head.rfind(['\n', '\r']).map_or(0, |newline| newline + 1);
    let length = tail.find('\n').map_or(tail.len(), |newline| newline + 1);
    let is_blank = |part: &str| part.chars().all(|c| c.is_whitespace() || c.is_ascii_digit());
    match is_blank(&head[start..]) && tail[..length].trim().is_empty() {
        true => TextEdit::new(Span::new(start, span.end as usize + length), ""),
        false => TextEdit::new(span, ""),
    }
}

fn of_chunk(at: ChunkRef<'_>) -> impl Iterator<Item = Statement<'_>> {
    // A chunk is a list or a drawing; the other half is empty.
    let (list, drawing) = match at.chunk.tree() {
        Tree::Fx(tree) => (Some(tree), None),
        Tree::Ladder(tree) => (None, Some(tree)),
        Tree::Iec(_) => (None, None),
    };
    let lines = list.into_iter().flat_map(move |tree| {
        tree.lines.iter().map(move |line| {
            let kind = match line.kind {
                LineKind::Label(device) => StatementKind::Label(device),
                LineKind::Instruction(form) => StatementKind::Instruction(form.instruction.flow()),
                LineKind::Unknown => StatementKind::Unknown,
            };
            statement(at, kind, line.mnemonic, line.span, tree.operands(line).first().copied())
        })
    });
    let header = drawing.and_then(|tree| tree.header.as_ref()).and_then(|header| header.label);
    let label = header.and_then(|label| {
        let device = pointer(label.of(at.chunk.text()))?;
        Some(statement(at, StatementKind::Label(device), label, label, None))
    });
    let elements = drawing.into_iter().flat_map(|tree| &tree.rungs).flat_map(|rung| &rung.graph.elements);
    lines.chain(label).chain(elements.filter_map(move |element| of_element(at, element)))
}

fn of_element<'a>(at: ChunkRef<'a>, element: &'a Element) -> Option<Statement<'a>> {
    if let ElementKind::Jump(label) = element.kind {
        let target = pointer(label.of(at.chunk.text()))?;
        let first = Spanned::new(Operand::Device(target), label);
        let kind = StatementKind::Instruction(Flow::Jump);
        return Some(statement(at, kind, element.span, element.span.to(label), Some(first)));
    }
    let operation = Operation::of_element(element)?;
    let kind = match operation.form {
        Some(form) => StatementKind::Instruction(form.instruction.flow()),
        None => StatementKind::Unknown,
    };
    let last = operation.operands.last().filter(|_| operation.is_word);
    let span = last.map_or(operation.symbol, |operand| operation.symbol.to(operand.span));
    Some(statement(at, kind, operation.symbol, span, operation.operands.first().copied()))
}

fn statement<'a>(
    at: ChunkRef<'a>,
    kind: StatementKind,
    word: Span,
    span: Span,
    first: Option<Spanned<Operand>>,
) -> Statement<'a> {
    let first = first.map(|operand| Spanned::new(operand.value, operand.span.shifted(at.start)));
    Statement { kind, word: word.shifted(at.start), span: span.shifted(at.start), first, at }
}

/// The pointer of the PLC that a label names.
fn pointer(name: &str) -> Option<Device> {
    let device = Operand::read(name, crate::target::Model::Fx3u).device()?;
    matches!(device.kind, DeviceKind::P | DeviceKind::I).then_some(device)
}
