//! # short-circuit
//!
//! A branch made only of wire lies parallel to elements, or a wire joins the two rails. Power takes the wire: the
//! elements beside it have no effect, whatever their devices do.
//!
//! On a machine this is the bridged emergency stop, the interlock that does not lock: the contact is in the program
//! and changes nothing. Often a wire was drawn to try something out and forgot. Remove the wire, or give the branch
//! the contact that it lacks.
//!
//! ```lad
//! |   X0        X1                           Y0  |
//! +---| |---+---| |---+----------------------( )-+
//! |         |         |                          |
//! |         +---------+                          |
//!            ^^^^^^^^^
//! ```
//!
//! ```lad
//! |   X0        X1                           Y0  |
//! +---| |---+---| |---+----------------------( )-+
//! |         |   X2    |                          |
//! |         +---| |---+                          |
//! ```

use super::prune::Prune;
use super::{Drawn, Picture, first_cell};
use crate::check::{Rule, Run};
use crate::ladder::reduce::{Bypass, bypasses};
use crate::ladder::{ElementId, Graph};
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "short-circuit",
    severity: Severity::Error,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("short_circuit.rs"),
};

pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    let mut picture = None;
    for rung in drawn.sound_rungs() {
        let graph = &rung.graph;
        for bypass in bypasses(graph) {
            let names = names(drawn, graph, &bypass.elements);
            let message = match (bypass.joins_rails, names.is_empty()) {
                (true, _) => Message::new("short-circuit.rails"),
                (false, true) => Message::new("short-circuit.wire"),
                (false, false) => Message::new("short-circuit.elements").with("elements", &names),
            };
            let mut diagnostic = Diagnostic::new(RULE.code, span(graph, &bypass), message);
            for element in bypass.elements.iter().filter(|_| !bypass.joins_rails) {
                let element = graph.element(*element);
                let message = Message::new("short-circuit.killed").with("element", drawn.name(element));
                diagnostic = diagnostic.related(element.span, message);
            }
            if drawn.can_try() {
                let picture = picture.get_or_insert_with(|| Picture::new(drawn.text));
                let mut prune = Prune::new(picture, graph);
                bypass.arcs.iter().for_each(|arc| prune.wire(*arc));
                bypass.bends.iter().for_each(|bend| prune.junction(*bend));
                let title = match names.is_empty() {
                    true => Message::new("short-circuit.remove"),
                    false => Message::new("short-circuit.remove-bypass").with("elements", names),
                };
                drawn.try_fix(&mut diagnostic, title, prune.edits());
            }
            found.push(diagnostic);
        }
    }
}

/// The longest run of the wire's cells.
fn span(graph: &Graph, bypass: &Bypass) -> Span {
    let arcs = bypass.arcs.iter().flat_map(|arc| graph.cells(graph.arc(*arc).cells));
    let fallback = || bypass.arcs.first().map_or(Graph::LEFT_RAIL, |arc| graph.arc(*arc).head);
    arcs.copied()
        .max_by_key(|cells| (cells.len(), cells.start))
        .unwrap_or_else(|| first_cell(graph, fallback()))
}

/// The names of the elements, the first few of many.
fn names(drawn: &Drawn<'_>, graph: &Graph, elements: &[ElementId]) -> String {
    const SHOWN: usize = 4;
    let mut names: Vec<String> =
        elements.iter().take(SHOWN).map(|id| drawn.name(graph.element(*id))).collect();
    names.dedup();
    let more = if elements.len() > SHOWN { " …" } else { "" };
    names.join(", ") + more
}
