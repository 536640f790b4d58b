//! # rung-without-output
//!
//! The contacts of a rung lead to no output, or a line of it reaches the right rail without an output on its way. The
//! PLC would evaluate the condition and do nothing with it, so the maker's tools refuse such a rung; mostly the output
//! was forgotten or deleted, or the instruction that follows stands without contacts, as `END` and `FEND` do.
//!
//! ```lad
//! |   X0        X1                               |
//! +---| |-------| |------------------------------+
//!               ^^^
//! ```
//!
//! ```lad
//! |   X0      X1                             Y0  |
//! +---| |-----| |----------------------------( )-+
//! ```
//!
//! ```fx
//! LD X0
//! AND X1
//! ^^^^^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! AND X1
//! OUT Y0
//! END
//! ```

use super::Drawn;
use crate::check::order::rung::Finding;
use crate::check::statements::removal;
use crate::check::{ChunkContext, Rule, Run};
use crate::document::Tree;
use crate::ladder::reduce::bypasses;
use crate::ladder::{ArcId, Element, Graph, VertexId, VertexKind};
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "rung-without-output",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("rung_without_output.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    match context.chunk.tree() {
        Tree::Fx(_) => of_list(context, found),
        Tree::Ladder(_) => super::run(find, context, found),
        Tree::Iec(_) => {}
    }
}

/// Contacts of an instruction list. The last of them is marked: an output is missing right behind it.
fn of_list(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some((tree, findings)) = context.rung() else { return };
    let text = context.chunk.text();
    for finding in findings {
        let &Finding::NoOutput { first, last, before } = finding else { continue };
        let (first, last) = (tree.lines[first].span, tree.lines[last].span);
        let before = before.map_or(Span::at(0), |line| tree.lines[line].span);
        let key = if before.is_empty() { "rung-without-output.list" } else { "rung-without-output.before" };
        let message = Message::new(key).with("last", last.of(text)).with("before", before.of(text));
        let mut diagnostic = Diagnostic::new(RULE.code, last, message);
        if first != last {
            diagnostic = diagnostic.related(first, Message::new("rung-without-output.first"));
        }
        let title = Message::new("rung-without-output.remove");
        found.push(diagnostic.fix(title, vec![removal(text, Span { start: first.start, end: last.end })]));
    }
}

/// Lines of a drawing, marked at the element after which an output is missing.
pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    for rung in drawn.sound_rungs() {
        let graph = &rung.graph;
        let elements = last_before_rail(graph);
        // A bare wire past the outputs is a short circuit, and reported as that.
        if elements.is_empty() || !bypasses(graph).is_empty() {
            continue;
        }
        for element in elements {
            let message = Message::new("rung-without-output.drawn").with("element", drawn.name(element));
            found.push(Diagnostic::new(RULE.code, element.span, message));
        }
    }
}

/// For each wire to the right rail on which power can come from the left one without passing an output or a
/// function block: the element on its way that is nearest to the right rail. A way without any is a short circuit.
fn last_before_rail(graph: &Graph) -> Vec<&Element> {
    let idle = idle_from_left(graph);
    let mut found = Vec::new();
    let mut seen = vec![false; graph.vertices.len()];
    for arc in graph.incoming(Graph::RIGHT_RAIL) {
        found.extend(nearest(graph, arc, &idle, &mut seen));
    }
    found.sort_by_key(|element| element.span);
    found
}

/// The vertices that power reaches without an output on its way.
fn idle_from_left(graph: &Graph) -> Vec<bool> {
    let mut idle = vec![false; graph.vertices.len()];
    let mut stack = vec![Graph::LEFT_RAIL];
    while let Some(vertex) = stack.pop() {
        if std::mem::replace(&mut idle[vertex.0 as usize], true) {
            continue;
        }
        stack.extend(
            graph.outgoing(vertex).map(|arc| graph.arc(arc).head).filter(|head| passes(graph, *head)),
        );
    }
    idle
}

/// Whether power goes on from a vertex without having done anything there.
fn passes(graph: &Graph, vertex: VertexId) -> bool {
    match graph.element_at(vertex) {
        Some(element) => !element.is_output() && element.block().is_none(),
        None => graph.vertex(vertex).kind != VertexKind::LooseEnd,
    }
}

/// The first element to the left of a wire, upwards in the drawing, through junctions and no further.
fn nearest<'g>(graph: &'g Graph, arc: ArcId, idle: &[bool], seen: &mut [bool]) -> Option<&'g Element> {
    let mut stack = vec![graph.arc(arc).tail];
    while let Some(vertex) = stack.pop() {
        if !idle[vertex.0 as usize] || std::mem::replace(&mut seen[vertex.0 as usize], true) {
            continue;
        }
        if let Some(element) = graph.element_at(vertex) {
            return Some(element);
        }
        let mut before: Vec<VertexId> = graph.incoming(vertex).map(|arc| graph.arc(arc).tail).collect();
        before.reverse();
        stack.extend(before);
    }
    None
}
