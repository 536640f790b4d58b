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
//! Where one way without branches runs backwards, the fix turns it round: it leaves the live line, and the part that
//! was dead gets its power. This changes the logic, as the title says; nothing else of the rung changes. Where several
//! ways run backwards, nobody can know which of them was meant, and the rung must be drawn by hand.
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

use super::dead_end::{DeadEnd, dead_ends};
use super::{Drawn, first_cell};
use crate::check::{Rule, Run};
use crate::ladder::reduce::reduce;
use crate::ladder::{ArcId, Drawing, Graph, VertexKind, redraw_as};
use crate::logic::of_graph;
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "reverse-flow",
    severity: Severity::Error,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("reverse_flow.rs"),
};

pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    for (number, rung) in drawn.tree.rungs.iter().enumerate() {
        let graph = &rung.graph;
        for end in dead_ends(graph) {
            let Some(first) = end.backwards.first() else { continue };
            let (span, name) = place(drawn, graph, *first, end.lacks_left);
            let (message, title) = match name {
                Some(name) => (
                    Message::new("reverse-flow.element").with("element", &name),
                    Message::new("reverse-flow.turn").with("element", name),
                ),
                None => (Message::new("reverse-flow.wire"), Message::new("reverse-flow.turn-wire")),
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
            if let [arc] = end.backwards[..]
                && drawn.can_try()
                && let Some(plan) = turned(graph, &end, arc)
                && let Ok(shape) = reduce(&plan)
            {
                let drawing = |kind| Drawing::new(&shape, &plan, drawn.text, kind);
                let is_meant = |graph: &Graph, text: &str| {
                    of_graph(drawn.text, &plan, drawn.scopes)
                        .is_ok_and(|path| super::does(&path, (text, graph), drawn.scopes))
                };
                let edit = redraw_as(drawn.text, drawn.tree, number, drawing, is_meant, drawn.target);
                drawn.try_fix(&mut diagnostic, title, edit.map(|edit| vec![edit]));
            }
            found.push(diagnostic);
        }
    }
}

/// The graph with the way between a dead end and the live part turned round, if `backwards` is the last wire of one
/// way without branches.
fn turned(graph: &Graph, end: &DeadEnd, backwards: ArcId) -> Option<Graph> {
    let mut way = vec![backwards];
    loop {
        let arc = graph.arc(*way.last()?);
        let dead = if end.lacks_left { arc.tail } else { arc.head };
        if dead == end.junction {
            break;
        }
        let vertex = graph.vertex(dead);
        if !matches!(vertex.kind, VertexKind::Element(_)) || (vertex.in_degree, vertex.out_degree) != (1, 1) {
            return None;
        }
        way.push(if end.lacks_left { graph.incoming(dead).next()? } else { graph.outgoing(dead).next()? });
    }
    let mut plan = Graph::new();
    for id in graph.vertex_ids().skip(2) {
        match graph.vertex(id).kind {
            VertexKind::Element(element) => plan.add_element(graph.element(element).clone()),
            kind => plan.add_vertex(kind, &[]),
        };
    }
    let arcs = || (0..graph.arcs.len() as u32).map(ArcId);
    // What is turned goes below: it was drawn beside the line that it now leaves.
    for id in arcs().filter(|id| !way.contains(id)) {
        let arc = graph.arc(id);
        plan.add_arc((arc.tail, arc.tail_pin), (arc.head, arc.head_pin), &[]);
    }
    for id in way {
        let arc = graph.arc(id);
        plan.add_arc((arc.head, 0), (arc.tail, 0), &[]);
    }
    Some(plan)
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
