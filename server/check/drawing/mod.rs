//! Drawing: wires, elements and rungs as they are drawn.
//!
//! Each finder looks at the drawing of a chunk. Only sound rungs are judged for what they mean: a rung with a loose
//! end, a dead end or an unreadable cell has that mistake and no other.

mod drawn;
pub(super) use drawn::Drawn;

mod picture;
use picture::Picture;

mod prune;

mod dead_end;

pub(super) mod nesting;

mod loose_end;

mod coil_at_left_rail;
mod contact_after_coil;
mod contact_on_vertical;
mod missing_operand;
mod mixed_connection;
mod open_circuit;
mod ragged_drawing;
mod ragged_rail;
mod reverse_flow;
mod rung_too_large;
mod rung_without_output;
mod short_circuit;
mod stray_operand;
mod tab_in_drawing;
mod unreadable_cell;
mod upper_parallel;

use super::{ChunkContext, Rule};
use crate::document::Scopes;
use crate::ladder::{Graph, VertexId, VertexKind};
use crate::logic::{Comparison, Formulas, Path, compare, of_graph};
use crate::text::{Diagnostic, Span};

pub(super) use contact_after_coil::ALLOWED as CONTACT_AFTER_COIL_ALLOWED;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[
    &open_circuit::RULE,
    &short_circuit::RULE,
    &mixed_connection::RULE,
    &upper_parallel::RULE,
    &coil_at_left_rail::RULE,
    &contact_after_coil::RULE,
    &contact_on_vertical::RULE,
    &rung_without_output::RULE,
    &reverse_flow::RULE,
    &unreadable_cell::RULE,
    &missing_operand::RULE,
    &stray_operand::RULE,
    &ragged_rail::RULE,
    &ragged_drawing::RULE,
    &tab_in_drawing::RULE,
    &rung_too_large::RULE,
];

/// Finds the mistakes of one kind in a drawing.
type Find = fn(&Drawn<'_>, &mut Vec<Diagnostic>);

/// What judges a drawing after a fix: every finder but those whose findings do not touch the logic.
const FINDERS: &[Find] = &[
    open_circuit::find,
    short_circuit::find,
    mixed_connection::find,
    upper_parallel::find,
    coil_at_left_rail::find,
    contact_after_coil::find,
    rung_without_output::find,
    reverse_flow::find,
];

/// Runs a finder on a chunk, if it is a drawing.
fn run(find: Find, context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if let Some(drawn) = Drawn::of(context) {
        find(&drawn, found);
    }
}

/// What is only drawn in another way has mostly the same formula, and the proof that it does is so much work at most.
const REDRAWN: usize = 50_000;

/// Whether the rung of `graph`, whose words stand in `text`, does what `path` does.
pub(super) fn does(path: &Path, (text, graph): (&str, &Graph), scopes: &Scopes) -> bool {
    of_graph(text, graph, scopes).is_ok_and(|drawn| {
        matches!(compare(&[path], &[&drawn], &mut Formulas::limited(REDRAWN)), Comparison::Same { .. })
    })
}

/// The first cell of a vertex: the top of a vertical wire, an element's symbol.
fn first_cell(graph: &Graph, id: VertexId) -> Span {
    let vertex = graph.vertex(id);
    match vertex.kind {
        VertexKind::Element(element) => graph.element(element).span,
        _ => graph.cells(vertex.cells).first().copied().unwrap_or_default(),
    }
}
