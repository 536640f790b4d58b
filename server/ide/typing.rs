//! On-type formatting: drawings stay whole while one types in them, and an instruction list that is aligned stays so.

use super::{Style, changes, drawing};
use crate::document::{Document, Notation, Tree};
use crate::il::{fx, iec};
use crate::text::{Span, TextEdit};

/// The edits after `typed` was typed with the cursor now at byte `offset`.
pub(super) fn after(document: &Document, offset: usize, typed: &str, style: Style) -> Vec<TextEdit> {
    let mut characters = typed.chars();
    match (characters.next(), characters.next(), document.notation()) {
        (Some('\n' | '\r'), _, Notation::Ladder) => drawing::typing::after_enter(document, offset, style),
        (Some('\n' | '\r'), ..) => line_left(document, offset),
        (Some(character), None, Notation::Ladder) => {
            drawing::typing::after_character(document, offset, character)
        }
        _ => Vec::new(),
    }
}

/// The canonical form of the line that Enter has left, if all others of its rung have it.
fn line_left(document: &Document, offset: usize) -> Vec<TextEdit> {
    let (_, start, _) = document.line_at(offset);
    let Some(end) = start.checked_sub(1) else { return Vec::new() };
    let (_, left, _) = document.line_at(end);
    let Some(at) = document.chunk_at(left) else { return Vec::new() };
    let text = at.chunk.text();
    let edits = match at.chunk.tree() {
        // Step numbers come from a listing, and depend on the whole program.
        Tree::Fx(tree) if tree.lines.iter().all(|line| line.step.is_none()) => {
            fx::format_chunks(&[(text, tree)])
        }
        Tree::Iec(tree) => {
            changes::by_lines(text, &iec::format_chunk(text, tree, &iec::FormatOptions::default()))
        }
        _ => Vec::new(),
    };
    let line = Span::new(left - at.start, end - at.start);
    let inside = |edit: &TextEdit| line.start <= edit.span.start && edit.span.end <= line.end + 1;
    let written = text.lines().filter(|other| !other.trim().is_empty()).count();
    if written < 2 || !edits.iter().all(inside) {
        return Vec::new();
    }
    edits.iter().map(|edit| edit.shifted(at.start)).collect()
}
