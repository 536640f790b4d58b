//! # contact-after-coil
//!
//! A contact stands to the right of an output. Conditions come first, outputs last: an output takes what reaches it
//! from the left, and nothing to its right has any influence on it.
//!
//! FX programs cannot express it, and programming tools refuse to draw it. On a machine it is mostly an interlock
//! that was added on the wrong side of the coil, where it locks nothing. For IEC 61131-3, whose coils pass their
//! power on, the drawing is allowed, and the finding is a hint.
//!
//! A narrower rung directly below a wider one can look so, when its right rail meets a corner of the other: a blank
//! line between makes it a rung of its own.
//!
//! ```lad
//! |   X0        Y0        X1                     |
//! +---| |-------( )-------| |--------------------+
//!                         ^^^
//! ```
//!
//! ```lad
//! |   X0      X1                             Y0  |
//! +---| |-----| |----------------------------( )-+
//! ```

use super::Drawn;
use crate::check::{Rule, Run};
use crate::ladder::{Element, ElementKind, Graph, VertexId};
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "contact-after-coil",
    severity: Severity::Error,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("contact_after_coil.rs"),
};

/// The message where the language allows it; it is a hint.
pub(in crate::check) const ALLOWED: &str = "contact-after-coil.allowed";

pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    for rung in drawn.sound_rungs() {
        let graph = &rung.graph;
        let mut seen = vec![false; graph.vertices.len()];
        for id in graph.vertex_ids() {
            let Some(output) = graph.element_at(id).filter(|element| element.is_output()) else { continue };
            let contacts = behind(graph, id, &mut seen);
            let Some((first, others)) = contacts.split_first() else { continue };
            let key = if drawn.target.is_fx() { "contact-after-coil.found" } else { ALLOWED };
            let message =
                Message::new(key).with("contact", drawn.name(first)).with("output", drawn.name(output));
            let related = Message::new("contact-after-coil.output").with("output", drawn.name(output));
            let mut diagnostic =
                Diagnostic::new(RULE.code, first.span, message).related(output.span, related);
            for other in others {
                let message = Message::new("contact-after-coil.also").with("contact", drawn.name(other));
                diagnostic = diagnostic.related(other.span, message);
            }
            part(drawn, first, output, &mut diagnostic);
            found.push(diagnostic);
        }
    }
}

/// Rungs that stand directly below a wider one can meet a corner of it with their right rail. Where a blank line
/// between makes rungs of them, that is what was meant most likely.
fn part(drawn: &Drawn<'_>, contact: &Element, output: &Element, diagnostic: &mut Diagnostic) {
    let starts = drawn.text.match_indices('\n').map(|(end, _)| end + 1);
    let starts = starts.skip(contact.row as usize).take(output.row.saturating_sub(contact.row) as usize);
    for at in starts {
        let title = Message::new("contact-after-coil.part").with("output", drawn.name(output));
        if drawn.try_parting(diagnostic, title, at) {
            return;
        }
    }
}

/// The conditions to the right of an output that were not seen behind another one, in the order of the drawing.
fn behind<'g>(graph: &'g Graph, output: VertexId, seen: &mut [bool]) -> Vec<&'g Element> {
    let mut contacts = Vec::new();
    let mut stack = vec![output];
    while let Some(vertex) = stack.pop() {
        for arc in graph.outgoing(vertex) {
            let head = graph.arc(arc).head;
            if std::mem::replace(&mut seen[head.0 as usize], true) {
                continue;
            }
            stack.push(head);
            let condition = |element: &&Element| element.is_contact() || element.kind == ElementKind::Invert;
            contacts.extend(graph.element_at(head).filter(condition));
        }
    }
    contacts.sort_by_key(|element| element.span);
    contacts
}
