//! The rungs around the cursor, as the logic sees them.

use super::steps_of;
use crate::document::{Document, Notation, Tree};
use crate::il::fx::LineKind;
use crate::logic::Path;
use crate::text::Span;
use crate::translate::Source;

/// The rung at the cursor, those before it in its chunk and in the chunk before, and some behind it.
pub(super) struct Neighbourhood<'d> {
    pub document: &'d Document,
    /// In order.
    pub rungs: Vec<Source>,
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
        let rungs = Source::within(document, Span::new(start, end));
        // A drawn rung has all of its lines; a list has them as well.
        let here =
            rungs.iter().position(|placed| placed.start == at.start && placed.span().touches(offset))?;
        rungs.get(here)?.path()?;
        Some(Neighbourhood { document, rungs, here })
    }

    /// The rung at the cursor.
    pub fn rung(&self) -> &Source {
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
