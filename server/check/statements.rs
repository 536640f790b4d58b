//! A program as one sequence of instructions and labels, for the rules that look at the whole of it.
//!
//! Lines of FX instruction list and elements of FX ladders come alike, whichever file of the program they stand in.

use super::{ProgramContext, ProgramFile};
use crate::document::{Chunk, ChunkRef, Document, Notation};
use crate::target::{Device, Flow, Operand};
use crate::text::{Span, Spanned, TextEdit};

pub(super) use crate::document::MilestoneKind as StatementKind;

/// An instruction or a label of an FX program.
#[derive(Clone, Copy, Debug)]
pub(super) struct Statement<'a> {
    /// What it is.
    pub kind: StatementKind,
    /// How many statements it stands for: itself, and those before it that are left out because they are like it.
    pub count: usize,
    /// The mnemonic, the label, or the cells of a drawn element.
    pub word: Span,
    /// From the mnemonic to the last operand.
    pub span: Span,
    /// The first operand of a statement that has a part in the structure.
    pub first: Option<Spanned<Operand>>,
    at: ChunkRef<'a>,
    is_list: bool,
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
    /// All statements, in the order of execution; none if it is no FX program. Of a run of equal statements that have
    /// no part in the structure only the first and the last are there.
    pub(super) fn statements(&self) -> impl Iterator<Item = Statement<'a>> + use<'a> {
        let is_fx = self.files().first().is_some_and(|file| is_fx_program(file.document));
        let files = if is_fx { self.files().to_vec() } else { Vec::new() };
        files.into_iter().flat_map(of_file)
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

    /// The chunk in which it stands, and its word there.
    pub fn in_chunk(&self) -> (&'a Chunk, Span) {
        (self.at.chunk, self.relative(self.word))
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

    /// Puts `line` on a line of its own behind this one; nothing where there are no lines but a drawing.
    pub fn line_behind(&self, line: &str) -> Option<TextEdit> {
        let text = self.list()?;
        let span = self.relative(self.span);
        let tail = text.get(span.end as usize..)?;
        let length = tail.find('\n').map_or(tail.len(), |newline| newline + 1);
        let newline = if text.contains("\r\n") { "\r\n" } else { "\n" };
        let before = if tail[..length].ends_with('\n') { "" } else { newline };
        let at = Span::at(span.end as usize + length);
        Some(TextEdit::new(at, format!("{before}{line}{newline}")).shifted(self.at.start))
    }

    /// Takes it out with its line; nothing in a drawing.
    pub fn removal(&self) -> Option<TextEdit> {
        Some(removal(self.list()?, self.relative(self.span)).shifted(self.at.start))
    }

    /// The text of its chunk, if that is a list.
    fn list(&self) -> Option<&'a str> {
        self.is_list.then(|| self.at.chunk.text())
    }

    fn relative(&self, span: Span) -> Span {
        let start = self.at.start as u32;
        Span { start: span.start - start, end: span.end - start }
    }
}

/// Puts `line` on a line of its own before the one in which `word` stands; it may be several. Offsets are those of
/// `text`.
pub(super) fn line_before(text: &str, word: Span, line: &str) -> TextEdit {
    let head = text.get(..word.start as usize).unwrap_or("");
    let start = head.rfind(['\n', '\r']).map_or(0, |newline| newline + 1);
    // The line end of the line before tells the habit of the file, or else that of this line.
    let tail = text.get(word.start as usize..).unwrap_or("");
    let own = tail.find('\n').is_some_and(|newline| tail[..newline].ends_with('\r'));
    let newline = if head[..start].ends_with("\r\n") || own { "\r\n" } else { "\n" };
    let line = line.replace('\n', newline);
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

fn of_file(file: ProgramFile<'_>) -> impl Iterator<Item = Statement<'_>> {
    let is_list = file.document.notation() == Notation::FxIl;
    let mut end = file.start;
    file.document.pages().iter().flat_map(move |page| {
        let page_start = end;
        end += page.bytes();
        page.milestones().iter().filter_map(move |milestone| {
            let first = milestone.first();
            Some(Statement {
                kind: milestone.kind,
                count: milestone.count as usize,
                word: milestone.word.shifted(page_start),
                span: milestone.span.shifted(page_start),
                first: first.map(|first| Spanned::new(first.value, first.span.shifted(page_start))),
                at: ChunkRef {
                    start: page_start + milestone.chunk_start(),
                    chunk: page.chunks().get(milestone.chunk())?,
                },
                is_list,
            })
        })
    })
}
