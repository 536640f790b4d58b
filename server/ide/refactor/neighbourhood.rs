//! The rungs around the cursor, as the logic sees them.

use super::steps_of;
use crate::document::{Chunk, Document, Notation, Tree};
use crate::il::fx::LineKind;
use crate::logic::{self, Path, Rung};
use crate::text::Span;
use std::sync::Arc;

/// A rung with its chunk.
#[derive(Debug)]
pub(super) struct Placed {
    /// Where the chunk starts in the document.
    pub start: usize,
    pub chunk: Arc<Chunk>,
    pub rung: Rung,
}

impl Placed {
    /// Where it stands in the document.
    pub fn span(&self) -> Span {
        self.rung.span.shifted(self.start)
    }

    /// What it does, if it can be read and does something.
    pub fn path(&self) -> Option<&Path> {
        self.rung.path.as_ref().ok()?.as_ref()
    }

    /// Its text without the comments before it.
    pub fn text(&self) -> &str {
        self.rung.span.of(self.chunk.text())
    }

    /// The rungs whose chunks lie in these bytes of `document`.
    pub fn within(document: &Document, bytes: Span) -> Vec<Placed> {
        let mut placed = Vec::new();
        let mut offset = bytes.start as usize;
        while offset < bytes.end as usize
            && let Some(at) = document.chunk_at(offset)
            && at.start >= offset
        {
            let rungs = logic::rungs(&at.chunk.reading(), document.target()).into_iter();
            placed.extend(rungs.map(|rung| Placed { start: at.start, chunk: at.chunk.clone(), rung }));
            offset = at.start + at.chunk.len();
        }
        placed
    }
}

/// The rung at the cursor, those before it in its chunk and in the chunk before, and some behind it.
pub(super) struct Neighbourhood<'d> {
    pub document: &'d Document,
    /// In order.
    pub rungs: Vec<Placed>,
    /// The number of the rung at the cursor.
    pub here: usize,
}

/// So many chunks behind the cursor are looked at.
const CHUNKS_BEHIND: usize = 24;
/// And so many bytes.
const BYTES_MAX: usize = 64 * 1024;

impl<'d> Neighbourhood<'d> {
    /// That of the rung at a byte of `document`; nothing where there is none that can be read.
    pub fn at(document: &'d Document, offset: usize) -> Option<Neighbourhood<'d>> {
        if document.notation() == Notation::IecIl {
            return None;
        }
        let at = document.chunk_at(offset)?;
        let before = document.chunk_before(offset).filter(|before| before.start < at.start);
        let start = before.map_or(at.start, |before| before.start);
        let mut end = at.start + at.chunk.len();
        for _ in 0..CHUNKS_BEHIND {
            let Some(next) = document.chunk_at(end).filter(|next| next.start == end) else { break };
            end += next.chunk.len();
            if end - start > BYTES_MAX {
                break;
            }
        }
        let rungs = Placed::within(document, Span::new(start, end));
        // A drawn rung has all of its lines; a list has them as well.
        let here =
            rungs.iter().position(|placed| placed.start == at.start && placed.span().touches(offset))?;
        rungs.get(here)?.path()?;
        Some(Neighbourhood { document, rungs, here })
    }

    /// The rung at the cursor.
    pub fn rung(&self) -> &Placed {
        &self.rungs[self.here]
    }

    /// What it does.
    pub fn path(&self) -> &Path {
        static NOTHING: Path = Path { gates: Vec::new(), drives: Vec::new() };
        self.rung().path().unwrap_or(&NOTHING)
    }

    /// Whether the document is a list.
    pub fn is_list(&self) -> bool {
        self.document.notation() == Notation::FxIl
    }

    /// The steps of a rung as it is written; those of a drawing in the shortest list.
    pub fn steps(&self, number: usize) -> Option<u32> {
        let placed = self.rungs.get(number)?;
        let reading = placed.chunk.reading();
        let Tree::Fx(tree) = reading.tree() else { return steps_of(placed.path()?, self.document) };
        let written = tree.lines.iter().filter(|line| matches!(line.kind, LineKind::Instruction(_)));
        let steps = written.map(|line| tree.steps_of(line)).fold(0, u32::saturating_add);
        Some(steps)
    }
}
