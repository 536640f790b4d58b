//! Formatting: small edits that make the document canonical, none where it is so already.

use super::changes;
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

impl Style {
    /// The same for the printer of ladder.
    pub fn ladder(self) -> ladder::Style {
        let kind = match self.kind {
            FormatStyle::Iec => ladder::StyleKind::Iec,
            FormatStyle::Brackets => ladder::StyleKind::Brackets,
            FormatStyle::Unicode => ladder::StyleKind::Unicode,
        };
        ladder::Style { kind, width: self.width }
    }
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
            edits.extend(changes::by_lines(text, &formatted).iter().map(|edit| edit.shifted(at.start)));
        }
    }
    edits.extend(fx::format_chunks(&instructions));
    edits
}

/// What all rungs of the document share.
fn ladder_page(document: &Document, style: Style) -> ladder::Page {
    let drawings = document.chunks().filter_map(|at| match at.chunk.tree() {
        Tree::Ladder(tree) => Some((at.chunk.text(), tree)),
        _ => None,
    });
    ladder::Page::of(drawings, &style.ladder())
}
