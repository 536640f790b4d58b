//! # reverse-flow
//!
//! Power could only flow from right to left here. In a ladder it flows from the left rail to the right one: a
//! vertical wire joins what comes from its left and feeds what leaves to its right, and nothing else.
//!
//! With relays and wires the current would find its way back through the contact, and the coil would be on. A PLC
//! evaluates from left to right, so the part without power stays off for ever: on a machine that is an output that
//! never comes on, or, in the wired original, one that came on when nobody expected it. Draw the branch from the
//! place where its power is meant to come from.
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |-------------+----------------------( )-+
//! |             X1    |                          |
//! |         +---| |---+                          |
//!               ^^^
//! |         |                                Y1  |
//! |         +--------------------------------( )-+
//! ```
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |---+--------------------------------( )-+
//! |         |   X1                           Y1  |
//! |         +---| |--------------------------( )-+
//! ```

use super::dead_end::dead_ends;
use super::{Drawn, first_cell};
use crate::check::{Rule, Run};
use crate::ladder::{ArcId, Graph};
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "reverse-flow",
    severity: Severity::Error,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("reverse_flow.rs"),
};

pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    for rung in &drawn.tree.rungs {
        let graph = &rung.graph;
        for end in dead_ends(graph) {
            let Some(first) = end.backwards.first() else { continue };
            let (span, name) = place(drawn, graph, *first, end.lacks_left);
            let message = match (name, end.lacks_left) {
                (Some(name), _) => Message::new("reverse-flow.element").with("element", name),
                (None, _) => Message::new("reverse-flow.wire"),
            };
            let side = match end.lacks_left {
                true => Message::new("reverse-flow.no-feed"),
                false => Message::new("reverse-flow.no-way-out"),
            };
            let mut diagnostic =
                Diagnostic::new(RULE.code, span, message).related(first_cell(graph, end.junction), side);
            for arc in &end.backwards[1..] {
                let (span, _) = place(drawn, graph, *arc, end.lacks_left);
                diagnostic = diagnostic.related(span, Message::new("reverse-flow.also"));
            }
            found.push(diagnostic);
        }
    }
}

/// The element at the dead side of a wire, or the wire's own cells.
fn place(drawn: &Drawn<'_>, graph: &Graph, arc: ArcId, lacks_left: bool) -> (Span, Option<String>) {
    let arc = graph.arc(arc);
    let (dead, live) = if lacks_left { (arc.tail, arc.head) } else { (arc.head, arc.tail) };
    match graph.element_at(dead) {
        Some(element) => (element.span, Some(drawn.name(element))),
        None => {
            let cells = graph.cells(arc.cells).first().copied();
            (cells.unwrap_or_else(|| first_cell(graph, live)), None)
        }
    }
}
