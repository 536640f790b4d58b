//! Linked editing: the name at the cursor and its other uses in the same rung, typed at once.
//!
//! In a drawing every further letter pushes what follows on its row out of its column, and on-type formatting sees
//! only the row of the cursor. So there it is offered only where nothing is drawn behind any of the places; renaming
//! keeps columns everywhere.

use crate::document::{Document, Tree};
use crate::text::Span;

/// The places of the name at a byte in its rung, in order; empty where there is no more than one.
pub(super) fn of(document: &Document, offset: usize) -> Vec<Span> {
    let Some(at) = document.chunk_at(offset) else { return Vec::new() };
    let text = at.chunk.text();
    let inside = offset.saturating_sub(at.start);
    let mentions = at.chunk.mentions();
    let Some(own) = mentions.iter().find(|mention| mention.span.touches(inside) && !mention.span.is_empty())
    else {
        return Vec::new();
    };
    let word = own.span.of(text);
    let same = mentions.iter().filter(|other| other.symbol == own.symbol && other.span.of(text) == word);
    let mut places: Vec<Span> = same.map(|mention| mention.span).collect();
    places.dedup();
    let rest_of_line =
        |span: &Span| text.get(span.end as usize..).and_then(|rest| rest.lines().next()).unwrap_or("");
    let is_drawing = matches!(at.chunk.tree(), Tree::Ladder(_));
    let keeps_columns = !is_drawing || places.iter().all(|span| rest_of_line(span).trim().is_empty());
    if places.len() < 2 || !keeps_columns {
        return Vec::new();
    }
    places.into_iter().map(|span| span.shifted(at.start)).collect()
}
