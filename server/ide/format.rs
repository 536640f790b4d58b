//! Formatting: small edits that make the document canonical, none where it is so already.

use crate::document::{Document, Tree};
use crate::il::{fx, iec};
use crate::ladder;
use crate::project::FormatStyle;
use crate::text::{Message, Span, TextEdit};

/// How to format.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Style {
    /// The look of ladder.
    pub kind: FormatStyle,
    /// The least width of ladder, in cells.
    pub width: u32,
}

pub(super) fn edits(document: &Document, style: Style) -> Vec<TextEdit> {
    edits_where(document, style, |_| true)
}

/// The edits in the rungs, blocks and declarations that one of `spans` touches.
pub(super) fn edits_within(document: &Document, style: Style, spans: &[Span]) -> Vec<TextEdit> {
    let is_touched = |chunk: Span| {
        let meets = |span: &Span| {
            span.start < chunk.end && (chunk.start < span.end || span.touches(chunk.start as usize))
        };
        spans.iter().any(meets)
    };
    let mut edits = edits_where(document, style, is_touched);
    // Step numbers of the whole program are one thing; of its edits only those in touched chunks are wanted.
    edits.retain(|edit| {
        let at = document.chunk_at(edit.span.start as usize);
        at.is_some_and(|at| is_touched(Span::new(at.start, at.start + at.chunk.len())))
    });
    edits
}

/// The rungs that formatting leaves as they were drawn, and why.
pub(super) fn kept(document: &Document, style: Style) -> Vec<(Span, Message)> {
    let mut kept = Vec::new();
    let page = ladder_page(document, style);
    for at in document.chunks() {
        let Tree::Ladder(tree) = at.chunk.tree() else { continue };
        for (span, reason) in ladder::kept_rungs(at.chunk.text(), tree, document.reader(), &page) {
            kept.push((span.shifted(at.start), Message::new(key_of(reason))));
        }
    }
    kept
}

fn key_of(reason: ladder::Kept) -> &'static str {
    match reason {
        ladder::Kept::Mistake => "kept.mistake",
        ladder::Kept::Comment => "kept.comment",
        ladder::Kept::Words => "kept.words",
        ladder::Kept::Bridge => "kept.bridge",
        ladder::Kept::Order => "kept.order",
        ladder::Kept::Surroundings => "kept.surroundings",
    }
}

fn edits_where(document: &Document, style: Style, wanted: impl Fn(Span) -> bool) -> Vec<TextEdit> {
    let mut edits = Vec::new();
    let mut instructions = Vec::new();
    let page = ladder_page(document, style);
    for at in document.chunks() {
        let text = at.chunk.text();
        let formatted = match at.chunk.tree() {
            Tree::Fx(tree) => {
                instructions.push((text, tree));
                None
            }
            _ if !wanted(Span::new(at.start, at.start + text.len())) => None,
            // The tables of an LDmicro export are declarations, but not as the standard writes them.
            Tree::Iec(_) if ladder::kind_of(text) == ladder::ChunkKind::Ldmicro => None,
            Tree::Iec(tree) => Some(iec::format_chunk(text, tree, &iec::FormatOptions::default())),
            Tree::Ladder(tree) => ladder::format_chunk(text, tree, document.reader(), &page),
        };
        if let Some(formatted) = formatted {
            edits.extend(line_edits(text, &formatted).iter().map(|edit| edit.shifted(at.start)));
        }
    }
    edits.extend(fx::format_chunks(&instructions));
    edits
}

/// What all rungs of the document share.
fn ladder_page(document: &Document, style: Style) -> ladder::Page {
    let kind = match style.kind {
        FormatStyle::Iec => ladder::StyleKind::Iec,
        FormatStyle::Brackets => ladder::StyleKind::Brackets,
        FormatStyle::Unicode => ladder::StyleKind::Unicode,
    };
    let drawings = document.chunks().filter_map(|at| match at.chunk.tree() {
        Tree::Ladder(tree) => Some((at.chunk.text(), tree)),
        _ => None,
    });
    ladder::Page::of(drawings, &ladder::Style { kind, width: style.width })
}

/// The edits that turn `old` into `new`: common lines at both ends stay, and where the rest has as many lines, only
/// those that differ are replaced, so that the editor keeps its cursor and marks.
pub(super) fn line_edits(old: &str, new: &str) -> Vec<TextEdit> {
    if old == new {
        return Vec::new();
    }
    let old_lines: Vec<&str> = old.split_inclusive('\n').collect();
    let new_lines: Vec<&str> = new.split_inclusive('\n').collect();
    let same = |(left, right): &(&&str, &&str)| left == right;
    let head = old_lines.iter().zip(&new_lines).take_while(same).count();
    let rest = old_lines.len().min(new_lines.len()) - head;
    let tail = old_lines.iter().rev().zip(new_lines.iter().rev()).take(rest).take_while(same).count();
    let (old_middle, new_middle) =
        (&old_lines[head..old_lines.len() - tail], &new_lines[head..new_lines.len() - tail]);
    let mut start: usize = old_lines[..head].iter().map(|line| line.len()).sum();
    if old_middle.len() != new_middle.len() {
        let length: usize = old_middle.iter().map(|line| line.len()).sum();
        return vec![TextEdit::new(Span::new(start, start + length), new_middle.concat())];
    }
    let mut edits = Vec::new();
    for (old_line, new_line) in old_middle.iter().zip(new_middle) {
        if old_line != new_line {
            edits.push(TextEdit::new(Span::new(start, start + old_line.len()), *new_line));
        }
        start += old_line.len();
    }
    edits
}
