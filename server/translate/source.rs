//! The rungs of a document that are to be translated.

use crate::document::{Chunk, Document};
use crate::logic::{self, Rung};
use crate::text::Span;
use std::sync::Arc;

/// A rung with its chunk.
pub(super) struct Source {
    /// Where the chunk starts in the document.
    pub start: usize,
    /// The chunk, in which the spans of the rung are places.
    pub chunk: Arc<Chunk>,
    /// The rung.
    pub rung: Rung,
}

impl Source {
    /// Where it stands in the document.
    pub fn span(&self) -> Span {
        self.rung.span.shifted(self.start)
    }

    /// Its comments as written.
    pub fn comments(&self) -> impl Iterator<Item = &str> {
        self.rung.comments.iter().map(|comment| comment.of(self.chunk.text()).trim_end())
    }

    /// Whether there is nothing of it but blank lines.
    pub fn is_blank(&self) -> bool {
        let Rung { labels, network, comments, path, .. } = &self.rung;
        labels.is_empty() && network.is_none() && comments.is_empty() && matches!(path, Ok(None))
    }
}

/// The rungs of `document`; with `part` only those that touch these bytes.
pub(super) fn rungs(document: &Document, part: Option<Span>) -> Vec<Source> {
    let touches = |span: Span| part.is_none_or(|part| span.start <= part.end && part.start <= span.end);
    let mut rungs = Vec::new();
    for at in document.chunks() {
        if !touches(Span::new(at.start, at.start + at.chunk.len())) {
            continue;
        }
        let reading = at.chunk.reading();
        for rung in logic::rungs(&reading, document.reader()) {
            let source = Source { start: at.start, chunk: at.chunk.clone(), rung };
            if !source.is_blank() && touches(source.span()) {
                rungs.push(source);
            }
        }
    }
    rungs
}
