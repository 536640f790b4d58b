//! Lists in boxes `{il … }`, in which a drawing carries along what has no drawing. They are part of the program: who
//! looks at a chunk of a drawing looks at them, too.

use super::chunk::Dialect;
use super::{Chunk, Notation, Tree};
use std::sync::Arc;

/// What such a box begins with.
const OPENING: &str = "{il";

/// The list in a comment that is a box, and where it starts in the comment.
pub fn boxed(comment: &str) -> Option<(&str, usize)> {
    let inside = comment.strip_prefix(OPENING)?.strip_suffix('}')?;
    let list = inside.trim_start();
    (list.len() < inside.len()).then(|| (list.trim_end(), OPENING.len() + inside.len() - list.len()))
}

/// The lists in the boxes of a drawing in the order of the text, each with its start.
pub(super) fn of_chunk(chunk: &Chunk, dialect: &Dialect) -> Vec<(usize, Chunk)> {
    if !chunk.text().contains(OPENING) {
        return Vec::new();
    }
    let Tree::Ladder(tree) = chunk.tree() else { return Vec::new() };
    let notation = if dialect.target.is_fx() { Notation::FxIl } else { Notation::IecIl };
    let dialect = Arc::new(Dialect { notation, ..dialect.clone() });
    let list = |(comment, start): (&str, usize)| {
        let (list, within) = boxed(comment)?;
        (!list.is_empty()).then(|| (start + within, Chunk::new(list, &dialect, true)))
    };
    let comments = tree.comments.iter().map(|span| (span.of(chunk.text()), span.start as usize));
    comments.filter_map(list).collect()
}
