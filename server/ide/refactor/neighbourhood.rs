//! The rungs around the cursor, as the logic sees them.

use super::Change;
use super::{measure, silent};
use crate::document::{Document, Notation, ProjectView, Unit};
use crate::logic::Path;
use crate::logic::stretch::{self, BYTES_MAX, CHUNKS_BEHIND};
use crate::text::Span;
use crate::translate::Source;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::cell::RefCell;

/// The rung at the cursor, those before it in its chunk and in the chunk before, and some behind it.
pub(super) struct Neighbourhood<'d> {
    pub document: &'d Document,
    /// The project that it is a part of.
    pub view: &'d ProjectView<'d>,
    /// In order.
    pub rungs: Vec<Source>,
    /// The number of the rung at the cursor.
    pub here: usize,
    /// The program unit in which it stands.
    pub unit: Unit,
    /// The cursor or the selection, in bytes of the document.
    pub selected: Span,
    /// The bytes of whole chunks in which the rungs stand.
    pub span: Span,
    /// Whether helpers are stored to wherever they are read outside of these bytes, as far as it was asked.
    kept: RefCell<FxHashMap<SmolStr, bool>>,
}

impl<'d> Neighbourhood<'d> {
    /// That of the rung at a cursor or selection in the document of `view`; nothing where none can be read.
    pub fn at(view: &'d ProjectView<'d>, selected: Span) -> Option<Neighbourhood<'d>> {
        let document = view.here();
        let offset = selected.start as usize;
        let at = document.chunk_at(offset)?;
        let unit = document.unit_at(at.start);
        let is_iec = document.notation() == Notation::IecIl;
        let span =
            if is_iec { stretch::around(document, offset, unit)? } else { chunks_around(document, offset)? };
        let rungs = Source::within(document, span);
        let here = match is_iec {
            true => rungs.iter().position(|placed| lines_of(placed).touches(offset))?,
            // A drawn rung has all of its lines; a list has them as well.
            false => {
                rungs.iter().position(|placed| placed.start == at.start && placed.span().touches(offset))?
            }
        };
        rungs.get(here)?.path()?;
        Some(Neighbourhood { document, view, rungs, here, unit, selected, span, kept: RefCell::default() })
    }

    /// Whether there is a selection, and not just a cursor that passes by.
    pub fn is_selected(&self) -> bool {
        !self.selected.is_empty()
    }

    /// Whether the cursor or selection touches this place in the chunk of the rung.
    pub fn is_at_cursor(&self, place: Span) -> bool {
        let place = place.shifted(self.rung().start);
        place.start <= self.selected.end && self.selected.start <= place.end
    }

    /// The rung at the cursor.
    pub fn rung(&self) -> &Source {
        &self.rungs[self.here]
    }

    /// Whether the helper `name` is stored to wherever it is read outside of these rungs. The proposals of a menu ask
    /// for the same ones.
    pub fn is_stored_outside(&self, name: &SmolStr) -> bool {
        let known = self.kept.borrow().get(name).copied();
        known.unwrap_or_else(|| {
            let outside = |start: usize| !self.span.range().contains(&start);
            let found = silent::is_stored_wherever_read(self.document, self.unit, name, &outside);
            self.kept.borrow_mut().insert(name.clone(), found);
            found
        })
    }

    /// The rungs that a change replaces.
    pub fn replaced(&self, change: &Change) -> Option<&[Source]> {
        self.rungs.get(change.first..change.first + change.count)
    }

    /// What it does.
    pub fn path(&self) -> &Path {
        static NOTHING: Path = Path { gates: Vec::new(), drives: Vec::new() };
        self.rung().path().unwrap_or(&NOTHING)
    }

    /// Whether the document is a list.
    pub fn is_list(&self) -> bool {
        self.document.notation() != Notation::Ladder
    }

    /// Whether branches are written with MPS, MRD and MPP.
    pub fn has_branch_stack(&self) -> bool {
        self.document.notation() == Notation::FxIl
    }

    /// The steps, or in IEC 61131-3 the instructions, of a rung as it is written; those of a drawing in the shortest
    /// list.
    pub fn length(&self, number: usize) -> Option<u32> {
        measure::of_rung(self.rungs.get(number)?, self.document)
    }

    /// The length of a rung in the shortest list.
    pub fn shortest(&self, number: usize) -> Option<u32> {
        measure::of_path(self.rungs.get(number)?.path()?, self.document)
    }
}

/// The bytes of the chunk of a byte, with one before and some behind it.
fn chunks_around(document: &Document, offset: usize) -> Option<Span> {
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
    Some(Span::new(start, end))
}

/// The lines of the instructions of a rung, in bytes of the document, without the last line end.
fn lines_of(placed: &Source) -> Span {
    let (text, own) = (placed.chunk.text(), placed.rung.span);
    let start = text[..own.start as usize].rfind('\n').map_or(0, |end| end + 1);
    let end = text[own.end as usize..].find('\n').map_or(text.len(), |length| own.end as usize + length);
    Span::new(start, end).shifted(placed.start)
}
