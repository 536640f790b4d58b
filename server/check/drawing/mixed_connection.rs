//! # mixed-connection
//!
//! A bridge: the branches of this rung are neither in series nor in parallel, because a part of the way is shared
//! by paths that come from different sides and go to different sides. The mark is on the vertical wire that makes
//! it so.
//!
//! Instruction List has AND for series and OR for parallel and nothing for a bridge, so no PLC of this kind can run
//! the rung; programming tools refuse it. Draw the paths apart: the contacts that they share are drawn twice.
//!
//! The fix does so where power goes through contacts and comparisons to outputs on at most 64 ways. Contacts that
//! several ways have in common are drawn once where that can be, and ways that others cover are left out. It is offered
//! only if the new rung is proved to drive each output under the same condition; with inverters and function blocks,
//! and where an output changes what another one is driven by, the rung must be drawn by hand.
//!
//! ```lad
//! |   X0                    X1                       Y0  |
//! +---| |---+---------------| |-----+----------------( )-+
//! |         |   X2                  |                    |
//! |         +---| |---+             |                    |
//! |                   |             |                    |
//!                     ^
//! |   X3              |     X4      |                    |
//! +---| |-------------+-----| |-----+                    |
//! ```
//!
//! ```lad
//! |   X0      X1                             Y0  |
//! +---| |-----| |-------------+--------------( )-+
//! |   X0      X2        X4    |                  |
//! +---| |-----| |---+---| |---+                  |
//! |   X3            |                            |
//! +---| |-----------+                            |
//! ```

use super::{Drawn, first_cell};
use crate::check::{Rule, Run};
use crate::ladder::reduce::{Bridge, NotSeriesParallel, may_be_mixed, reduce};
use crate::ladder::{Drawing, Element, ElementId, Graph, redraw_as};
use crate::logic::{self, Path};
use crate::text::{Diagnostic, Message, Severity, Span};
use crate::translate::to_ladder;

pub(super) const RULE: Rule = Rule {
    code: "mixed-connection",
    severity: Severity::Error,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("mixed_connection.rs"),
};

pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    for (number, rung) in drawn.sound_numbered().filter(|(_, rung)| may_be_mixed(&rung.graph)) {
        let graph = &rung.graph;
        let Err(NotSeriesParallel::Bridge(bridge)) = reduce(graph) else { continue };
        let names: Vec<String> = bridge.elements.iter().map(|id| drawn.name(graph.element(*id))).collect();
        let message = match names.is_empty() {
            true => Message::new("mixed-connection.wire"),
            false => Message::new("mixed-connection.elements").with("elements", names.join(", ")),
        };
        let mut diagnostic = Diagnostic::new(RULE.code, vertical(graph, &bridge), message);
        let mut relate = |elements: &[ElementId], key: &'static str| {
            const SHOWN: usize = 8;
            for id in elements.iter().take(SHOWN) {
                let element = graph.element(*id);
                let message = match key {
                    "across" => Message::new("mixed-connection.across"),
                    _ => Message::new("mixed-connection.beside"),
                };
                let related = crate::text::Related {
                    file: None,
                    span: element.span,
                    message: message.with("element", drawn.name(element)),
                };
                diagnostic.related.push(related);
            }
        };
        relate(&bridge.elements, "across");
        relate(&bridge.beside, "beside");
        if drawn.can_try()
            && let Some(path) = logic::apart(drawn.text, graph)
            && let Ok(plan) = to_ladder::plan(&path, drawn.target.model)
        {
            let drawing = |kind| Drawing::new(&plan.shape, &plan.graph, &plan.source, kind);
            let is_meant = |graph: &Graph, text: &str| super::does(&path, (text, graph), drawn.scopes);
            let edit = redraw_as(drawn.text, drawn.tree, number, drawing, is_meant, drawn.target);
            let title = Message::new("mixed-connection.redraw").with("elements", twice(drawn, graph, &path));
            drawn.try_fix(&mut diagnostic, title, edit.map(|edit| vec![edit]));
        }
        found.push(diagnostic);
    }
}

/// The names of the elements that are contacts of a path more than once.
fn twice(drawn: &Drawn<'_>, graph: &Graph, path: &Path) -> String {
    let mut spans = Vec::new();
    path.visit(&mut |_| {}, &mut |condition| {
        condition.visit(&mut |contact| spans.push(contact.span));
    });
    let is_double = |element: &&Element| spans.iter().filter(|span| **span == element.span).count() > 1;
    let double = graph.elements.iter().filter(is_double);
    double.map(|element| drawn.name(element)).collect::<Vec<_>>().join(", ")
}

/// The middle cell of the bridge's vertical wire.
fn vertical(graph: &Graph, bridge: &Bridge) -> Span {
    let cell =
        bridge.vertical.get(bridge.vertical.len().saturating_sub(1) / 2).or(bridge.wire.first()).copied();
    cell.or_else(|| bridge.elements.first().map(|id| graph.element(*id).span))
        .unwrap_or_else(|| first_cell(graph, bridge.from.or(bridge.to).unwrap_or(Graph::LEFT_RAIL)))
}
