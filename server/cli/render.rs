//! Diagnostics for people: the rung as it is drawn, with carets under the cells.

use super::input::Program;
use crate::document::{Document, Notation};
use crate::text::{
    Diagnostic, Encoding, Language, LineColumn, Message, Severity, Span, cell_width, text_width,
};

/// Lines shown above and below the marked one in instruction list.
const CONTEXT_LINES: u32 = 2;

/// The longest drawing that is shown whole; of a larger one the lines around the mark are shown.
const WHOLE_RUNG_LINES: u32 = 24;

/// Escape sequences, or nothing.
pub(super) struct Colours {
    error: &'static str,
    warning: &'static str,
    hint: &'static str,
    dim: &'static str,
    off: &'static str,
}

impl Colours {
    pub(super) fn new(on: bool) -> Colours {
        if on {
            Colours {
                error: "\x1b[1;31m",
                warning: "\x1b[1;33m",
                hint: "\x1b[1;36m",
                dim: "\x1b[2m",
                off: "\x1b[0m",
            }
        } else {
            Colours { error: "", warning: "", hint: "", dim: "", off: "" }
        }
    }

    fn of(&self, severity: Severity) -> &'static str {
        match severity {
            Severity::Error => self.error,
            Severity::Warning => self.warning,
            Severity::Hint => self.hint,
        }
    }
}

/// `path:line:column: severity[code]: message`
pub(super) fn headline(
    path: &str,
    document: &Document,
    found: &Diagnostic,
    colours: &Colours,
    language: Language,
) -> String {
    let LineColumn { line, column } = document.position(found.span.start as usize, Encoding::Utf32);
    let (colour, off) = (colours.of(found.severity), colours.off);
    let message = found.message.render(language);
    let word = found.severity.word();
    format!("{path}:{}:{}: {colour}{word}[{}]{off}: {message}\n", line + 1, column + 1, found.code)
}

/// The headline, the rung with carets, related places and fixes.
pub(super) fn diagnostic(
    path: &str,
    program: &Program,
    found: &Diagnostic,
    colours: &Colours,
    language: Language,
) -> String {
    let document = &program.document;
    let (colour, off, dim) = (colours.of(found.severity), colours.off, colours.dim);
    let mut text = headline(path, document, found, colours, language);
    let (first, last) = shown_lines(document, found.span);
    let gutter = (last + 1).to_string().len();
    for line in first..=last {
        let span = line_span(document, line);
        let content = document.slice(span);
        let content = content.trim_end_matches(['\n', '\r']);
        text += &format!("{dim}{:>gutter$} |{off} {}\n", line + 1, visible(content)).replace(" \n", "\n");
        if let Some(carets) = carets(span, content, found) {
            text += &format!("{dim}{:>gutter$} |{off} {colour}{carets}{off}\n", "");
        }
    }
    for related in &found.related {
        let (path, document) = program.file(related, path);
        let LineColumn { line, column } = document.position(related.span.start as usize, Encoding::Utf32);
        let place = format!("{path}:{}:{}", line + 1, column + 1);
        let note = Message::new("cli.note").with("place", place);
        let note = note.with_messages("message", vec![related.message.clone()]);
        text += &format!("  {}\n", note.render(language));
    }
    for fix in &found.fixes {
        let fix = Message::new("cli.fix").with_messages("title", vec![fix.title.clone()]);
        text += &format!("  {}\n", fix.render(language));
    }
    text.push('\n');
    text
}

/// The diagnostic's own cells and those of its related places.
fn marks(found: &Diagnostic) -> impl Iterator<Item = (Span, char)> {
    std::iter::once((found.span, '^')).chain(
        found.related.iter().filter(|related| related.file.is_none()).map(|related| (related.span, '~')),
    )
}

/// The lines of the rung in a drawing, a few lines around in instruction list.
fn shown_lines(document: &Document, span: Span) -> (u32, u32) {
    let line_of = |offset: usize| document.line_of(offset);
    let (first, last) = (line_of(span.start as usize), line_of(span.end as usize));
    let end = document.line_count().saturating_sub(1) as u32;
    let around =
        (first.saturating_sub(CONTEXT_LINES), (last.min(first + CONTEXT_LINES) + CONTEXT_LINES).min(end));
    let Some(at) = document.chunk_at(span.start as usize) else { return around };
    let chunk = (line_of(at.start), line_of((at.start + at.chunk.len()).saturating_sub(1)));
    let blank = |line: u32| document.slice(line_span(document, line)).trim().is_empty();
    if document.notation() == Notation::Ladder && chunk.1 - chunk.0 < WHOLE_RUNG_LINES {
        let first = (chunk.0..=first).find(|&line| !blank(line)).unwrap_or(first);
        let last = (last..=chunk.1).rev().find(|&line| !blank(line)).unwrap_or(last);
        return (first, last);
    }
    (around.0.max(chunk.0), around.1.min(chunk.1.max(last)))
}

fn line_span(document: &Document, line: u32) -> Span {
    let offset = |line: u32| document.offset(LineColumn { line, column: 0 }, Encoding::Utf8);
    Span::new(
        offset(line),
        if line as usize + 1 >= document.line_count() { document.len() } else { offset(line + 1) },
    )
}

/// The marks under one line, the diagnostic's own above those of related places; nothing if none touches it.
fn carets(line: Span, content: &str, found: &Diagnostic) -> Option<String> {
    let mut signs: Vec<char> = Vec::new();
    for (mark, sign) in marks(found) {
        let Some((start, width)) = cells(line, content, mark) else { continue };
        signs.resize(signs.len().max(start + width), ' ');
        let free = |cell: &&mut char| **cell == ' ';
        signs[start..start + width].iter_mut().filter(free).for_each(|cell| *cell = sign);
    }
    (!signs.is_empty()).then(|| signs.into_iter().collect())
}

/// First cell and width of a mark in a line that it touches. An empty mark is one cell wide.
fn cells(line: Span, content: &str, mark: Span) -> Option<(usize, usize)> {
    let content_end = line.start + content.len() as u32;
    if mark.end < line.start
        || mark.start > content_end
        || (mark.start < line.start && mark.end == line.start)
    {
        return None;
    }
    let from = mark.start.max(line.start) - line.start;
    let to = mark.end.min(content_end) - line.start;
    let width = |text: &str| text_width(&visible(text));
    let before = width(content.get(..from as usize).unwrap_or(content));
    Some((before, width(content.get(from as usize..to as usize).unwrap_or("")).max(1)))
}

/// Tabs as the grid counts them from column 0, control characters as a replacement, so that carets line up.
fn visible(content: &str) -> String {
    let mut shown = String::with_capacity(content.len());
    let mut column = 0;
    for character in content.chars() {
        if character == '\t' {
            let blanks = 8 - column % 8;
            shown.extend(std::iter::repeat_n(' ', blanks));
            column += blanks;
        } else {
            let character =
                if character.is_control() || character == '\u{feff}' { '\u{fffd}' } else { character };
            shown.push(character);
            column += cell_width(character);
        }
    }
    shown
}
