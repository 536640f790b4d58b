//! How long rungs are: in program steps on the FX family, in instructions of a list in IEC 61131-3.

use crate::document::{Document, Tree};
use crate::il::fx::LineKind;
use crate::logic::Path;
use crate::logic::stretch::is_instruction;
use crate::translate::Source;
use crate::translate::to_iec::Helpers;
use crate::translate::{to_fx, to_iec};

/// The length of a rung as it is written; that of a drawing in the shortest list.
pub(super) fn of_rung(placed: &Source, document: &Document) -> Option<u32> {
    let reading = placed.chunk.reading();
    match reading.tree() {
        Tree::Fx(tree) => {
            let written = tree.lines.iter().filter(|line| matches!(line.kind, LineKind::Instruction(_)));
            Some(written.map(|line| tree.steps_of(line)).fold(0, u32::saturating_add))
        }
        Tree::Iec(tree) => {
            let own = placed.rung.span;
            let first = tree.items.partition_point(|item| item.span.start < own.start);
            let inside = tree.items[first..].iter().take_while(|item| item.span.start < own.end);
            u32::try_from(inside.filter(|item| is_instruction(item)).count()).ok()
        }
        Tree::Ladder(_) => of_path(placed.path()?, document),
    }
}

/// The length of a path in the shortest list.
pub(super) fn of_path(path: &Path, document: &Document) -> Option<u32> {
    if !document.target().is_fx() {
        let lines = to_iec::lines(path, &mut Helpers::default()).ok()?;
        return u32::try_from(lines.len()).ok();
    }
    let lines = to_fx::lines(path, document.target()).ok()?;
    Some(lines.iter().map(to_fx::Line::steps).fold(0, u32::saturating_add))
}
