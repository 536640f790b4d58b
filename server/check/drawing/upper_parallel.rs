//! # upper-parallel
//!
//! A parallel branch is drawn above the line that it belongs to. The line that comes from the left goes on in its
//! own row, and branches hang below it.
//!
//! The logic is not in doubt, but programming tools draw branches downwards only: the rung looks different there,
//! and whoever compares the print in the cabinet with the screen looks for the wrong line.
//!
//! ```lad
//! |             X1                               |
//! |         +---| |---+                          |
//!           ^
//! |   X0    |   X2    |                      Y0  |
//! +---| |---+---| |---+----------------------( )-+
//! ```
//!
//! ```lad
//! |   X0        X2                           Y0  |
//! +---| |---+---| |---+----------------------( )-+
//! |         |   X1    |                          |
//! |         +---| |---+                          |
//! ```

use super::{Drawn, first_cell};
use crate::check::{Rule, Run};
use crate::ladder::reduce::{NotSeriesParallel, reduce};
use crate::ladder::{ArcId, Graph, Page, Rung, Style, VertexId, VertexKind, format_chunk};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};
use rustc_hash::FxHashSet;

pub(super) const RULE: Rule = Rule {
    code: "upper-parallel",
    severity: Severity::Warning,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("upper_parallel.rs"),
};

pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    let lines = Lines::of(drawn.text);
    for rung in drawn.sound_rungs() {
        let graph = &rung.graph;
        let uppers = uppers(rung, &lines);
        // Where a bridge is drawn, above and below say nothing.
        if uppers.is_empty() || matches!(reduce(graph), Err(NotSeriesParallel::Bridge(_))) {
            continue;
        }
        for upper in uppers {
            let message = match upper.element {
                Some(id) => {
                    Message::new("upper-parallel.element").with("element", drawn.name(graph.element(id)))
                }
                None => Message::new("upper-parallel.branch"),
            };
            let mut diagnostic = Diagnostic::new(RULE.code, first_cell(graph, upper.junction), message);
            if let Some(line) = upper.line {
                diagnostic = diagnostic.related(line, Message::new("upper-parallel.line"));
            }
            if drawn.can_try() {
                let page = Page::of([(drawn.text, drawn.tree)], &Style::default());
                let edits = format_chunk(drawn.text, drawn.tree, drawn.target, &page)
                    .map(|text| vec![TextEdit::new(Span::new(0, drawn.text.len()), text)]);
                drawn.try_fix(&mut diagnostic, Message::new("upper-parallel.redraw"), edits);
            }
            found.push(diagnostic);
        }
    }
}

/// A branch above its line.
struct Upper {
    junction: VertexId,
    /// The first element on the branch.
    element: Option<crate::ladder::ElementId>,
    /// The cells of the line that it belongs to.
    line: Option<Span>,
}

fn uppers(rung: &Rung, lines: &Lines) -> Vec<Upper> {
    let graph = &rung.graph;
    let (mut found, mut covered) = (Vec::new(), FxHashSet::default());
    for junction in graph.vertex_ids().filter(|id| graph.vertex(*id).kind == VertexKind::Junction) {
        let vertex = graph.vertex(junction);
        let (Some(out), Some(into)) = (vertex.first_out, vertex.first_in) else { continue };
        let (out_row, in_row) = (row(graph, out, true, lines), row(graph, into, false, lines));
        if out_row < in_row && vertex.out_degree > 1 {
            let (element, end) = follow(graph, out);
            covered.insert(end);
            let line = graph.cells(graph.arc(into).cells).last().copied();
            found.push(Upper { junction, element, line });
        } else if in_row < out_row && vertex.in_degree > 1 && !covered.contains(&into) {
            let element = element_before(graph, into);
            let line = graph.cells(graph.arc(out).cells).first().copied();
            found.push(Upper { junction, element, line });
        }
    }
    // A branch is named at its left end, whatever the order of the vertices: drop right ends that are covered.
    found.retain(|upper| graph.vertex(upper.junction).first_in.is_none_or(|arc| !covered.contains(&arc)));
    found.sort_by_key(|upper| first_cell(graph, upper.junction));
    found
}

/// The first element on the way from an arc, and the arc at which it joins other wires.
fn follow(graph: &Graph, mut arc: ArcId) -> (Option<crate::ladder::ElementId>, ArcId) {
    let mut first = None;
    loop {
        let head = graph.arc(arc).head;
        let vertex = graph.vertex(head);
        if let VertexKind::Element(element) = vertex.kind {
            first = first.or(Some(element));
        }
        match vertex.first_out {
            Some(next) if vertex.in_degree == 1 && vertex.out_degree == 1 => arc = next,
            _ => return (first, arc),
        }
    }
}

fn element_before(graph: &Graph, arc: ArcId) -> Option<crate::ladder::ElementId> {
    match graph.vertex(graph.arc(arc).tail).kind {
        VertexKind::Element(element) => Some(element),
        _ => None,
    }
}

/// The line in which an arc leaves its tail, or enters its head.
fn row(graph: &Graph, arc: ArcId, leaves: bool, lines: &Lines) -> u32 {
    let arc = graph.arc(arc);
    let cells = graph.cells(arc.cells);
    let cell = if leaves { cells.first() } else { cells.last() };
    let other = if leaves { arc.head } else { arc.tail };
    match (cell, graph.element_at(other)) {
        (Some(cell), _) => lines.row(*cell),
        (None, Some(element)) => element.row,
        (None, None) => lines.row(first_cell(graph, other)),
    }
}

/// Where the lines of a text start.
struct Lines(Vec<u32>);

impl Lines {
    fn of(text: &str) -> Lines {
        let ends = memchr::memchr_iter(b'\n', text.as_bytes()).map(|at| at as u32 + 1);
        Lines(std::iter::once(0).chain(ends).collect())
    }

    fn row(&self, span: Span) -> u32 {
        self.0.partition_point(|start| *start <= span.start) as u32 - 1
    }
}
