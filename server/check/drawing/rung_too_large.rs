//! # rung-too-large
//!
//! More contacts in series, or more rows, than the programming tools of this PLC can show: eleven contacts and an
//! output in a line, 24 rows in a rung. Connections that nest hundreds of times are reported as well.
//!
//! The PLC would run it, but the rung cannot be opened in the maker's software next to the machine, which is where
//! somebody will look for the fault. Give a part of the conditions an internal relay of its own.
//!
//! ```lad
//! |  X0   X1   X2   X3   X4   X5   X6   X7   X10  X11  X12  X13       Y0  |
//! +--| |--| |--| |--| |--| |--| |--| |--| |--| |--| |--| |--| |-------( )-+
//!                                                           ^^^
//! ```
//!
//! ```lad
//! |   X0      X1      X2      X3      X4      X5      X6      M0  |
//! +---| |-----| |-----| |-----| |-----| |-----| |-----| |-----( )-+
//!
//! |   M0      X7      X10     X11     X12     X13             Y0  |
//! +---| |-----| |-----| |-----| |-----| |-----| |-------------( )-+
//! ```

use super::Drawn;
use crate::check::{Rule, Run};
use crate::ladder::reduce::{NotSeriesParallel, Shape, reduce};
use crate::ladder::{Element, Graph, Rung, VertexId};
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "rung-too-large",
    severity: Severity::Warning,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("rung_too_large.rs"),
};

pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    for rung in drawn.sound_rungs() {
        if drawn.target.is_fx() {
            let limits = drawn.target.limits;
            if let Some(element) = contact_number(&rung.graph, limits.contacts_in_series + 1) {
                let message = Message::new("rung-too-large.series")
                    .with("contact", drawn.name(element))
                    .with("limit", limits.contacts_in_series)
                    .with("target", drawn.target.title);
                found.push(Diagnostic::new(RULE.code, element.span, message));
            }
            if let Some(element) = first_in_row_after(rung, limits.rows) {
                let message = Message::new("rung-too-large.rows")
                    .with("limit", limits.rows)
                    .with("target", drawn.target.title);
                found.push(Diagnostic::new(RULE.code, element.span, message));
            }
        }
        if rung.graph.elements.len() > Shape::DEPTH_MAX
            && reduce(&rung.graph) == Err(NotSeriesParallel::TooDeep)
            && let Some(element) = rung.graph.elements.first()
        {
            let message = Message::new("rung-too-large.depth").with("limit", Shape::DEPTH_MAX);
            found.push(Diagnostic::new(RULE.code, element.span, message));
        }
    }
}

/// The first contact in the drawing that is the `limit`th in its line.
fn contact_number(graph: &Graph, limit: u32) -> Option<&Element> {
    if graph.elements.len() < limit as usize {
        return None;
    }
    let mut waiting: Vec<u32> = graph.vertices.iter().map(|vertex| vertex.in_degree).collect();
    let mut contacts = vec![0u32; graph.vertices.len()];
    let mut stack: Vec<VertexId> = graph.vertex_ids().filter(|id| graph.vertex(*id).in_degree == 0).collect();
    let mut found: Option<&Element> = None;
    while let Some(vertex) = stack.pop() {
        for arc in graph.outgoing(vertex) {
            let head = graph.arc(arc).head;
            let before = contacts[vertex.0 as usize];
            let longest = &mut contacts[head.0 as usize];
            *longest = before.max(*longest);
            waiting[head.0 as usize] -= 1;
            if waiting[head.0 as usize] == 0 {
                if let Some(element) = graph.element_at(head).filter(|element| element.is_contact()) {
                    *longest += 1;
                    let first = found.is_none_or(|found| element.span < found.span);
                    if *longest == limit && first {
                        found = Some(element);
                    }
                }
                stack.push(head);
            }
        }
    }
    found
}

/// The first element in the row after the first `rows` rows with elements.
fn first_in_row_after(rung: &Rung, rows: u32) -> Option<&Element> {
    let mut lines: Vec<u32> = rung.graph.elements.iter().map(|element| element.row).collect();
    lines.sort_unstable();
    lines.dedup();
    let line = *lines.get(rows as usize)?;
    rung.graph.elements.iter().filter(|element| element.row == line).min_by_key(|element| element.span)
}
