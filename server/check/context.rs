//! What a rule may look at.

use crate::document::{Chunk, Document, Notation, Pou, Scopes};
use crate::target::Target;

/// A chunk and what it depends on. Offsets are those of the chunk.
pub struct ChunkContext<'a> {
    /// The chunk.
    pub chunk: &'a Chunk,
    /// The language of its document.
    pub notation: Notation,
    /// What it is written for.
    pub target: &'static Target,
    /// The POU in which it stands, and all others of the document.
    pub scopes: &'a Scopes,
    /// The number of that POU in `scopes`; `None` outside of any.
    pub pou: Option<usize>,
}

impl ChunkContext<'_> {
    /// The POU in which the chunk stands.
    pub fn pou(&self) -> Option<&Pou> {
        self.scopes.pous.get(self.pou?).map(|pou| &**pou)
    }
}

/// A whole program. Offsets are those of the document.
pub struct ProgramContext<'a> {
    /// The document.
    pub document: &'a Document,
}
