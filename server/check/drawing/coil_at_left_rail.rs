//! # coil-at-left-rail
//!
//! An output hangs on the left rail without any condition. Instructions that stand by themselves, such as END and
//! FEND, need none, and neither do jumps, connectors and function blocks.
//!
//! FX programs cannot have it: OUT needs a result to write, and programming tools refuse the rung. An output that is
//! meant to be on always gets the contact M8000, which is on while the PLC runs; more often a contact was forgotten,
//! and then the motor starts as soon as the PLC does. For IEC 61131-3, where the left rail is a condition that holds
//! always, the drawing is allowed.
//!
//! ```lad
//! |                                          Y0  |
//! +------------------------------------------( )-+
//!                                            ^^^
//! ```
//!
//! ```lad
//! |  M8000                                   Y0  |
//! +---| |------------------------------------( )-+
//! ```

use super::{Drawn, Picture};
use crate::check::{Rule, Run};
use crate::ladder::{ArcId, Element, ElementKind, Graph, OperandPlace, VertexId, VertexKind};
use crate::target::Role;
use crate::text::{Diagnostic, Message, Severity, TextEdit};

/// The relay that is on while an FX runs.
const ALWAYS_ON: &str = "M8000";

pub(super) const RULE: Rule = Rule {
    code: "coil-at-left-rail",
    severity: Severity::Error,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("coil_at_left_rail.rs"),
};

pub(super) fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    if !drawn.target.is_fx() {
        return;
    }
    for rung in drawn.sound_rungs() {
        let graph = &rung.graph;
        for id in unconditional(graph) {
            let Some(element) = graph.element_at(id).filter(|element| needs_condition(element)) else {
                continue;
            };
            let message = Message::new("coil-at-left-rail.found").with("element", drawn.name(element));
            let mut diagnostic = Diagnostic::new(RULE.code, element.span, message);
            if drawn.can_try() {
                let title = Message::new("coil-at-left-rail.insert").with("device", ALWAYS_ON);
                drawn.try_fix(&mut diagnostic, title, with_contact(drawn, graph, id));
            }
            found.push(diagnostic);
        }
    }
}

/// The elements that power reaches through nothing but wires and outputs, in the order of the drawing.
fn unconditional(graph: &Graph) -> Vec<VertexId> {
    let mut conditions: Vec<u32> = graph.vertices.iter().map(|vertex| vertex.in_degree).collect();
    let (mut found, mut stack) = (Vec::new(), vec![Graph::LEFT_RAIL]);
    while let Some(vertex) = stack.pop() {
        for arc in graph.outgoing(vertex) {
            let head = graph.arc(arc).head;
            // A junction is without condition when all that enters it is.
            let waiting = &mut conditions[head.0 as usize];
            *waiting = waiting.saturating_sub(1);
            if *waiting > 0 {
                continue;
            }
            match graph.vertex(head).kind {
                VertexKind::Junction => stack.push(head),
                VertexKind::Element(element) => {
                    found.push(head);
                    // What is not known may well be a condition.
                    let unknown =
                        matches!(graph.element(element).kind, ElementKind::Instruction { form: None, .. });
                    if graph.element(element).is_output() && !unknown {
                        stack.push(head);
                    }
                }
                _ => {}
            }
        }
    }
    found.sort_by_key(|id| graph.element_at(*id).map(|element| element.span));
    found
}

fn needs_condition(element: &Element) -> bool {
    match &element.kind {
        ElementKind::Coil(_) => true,
        ElementKind::Instruction { form: Some(form), .. } => form.instruction.role == Role::Output,
        _ => false,
    }
}

/// Draws the always-on contact into the wire before the output, if there is room for it and its name.
fn with_contact(drawn: &Drawn<'_>, graph: &Graph, id: VertexId) -> Option<Vec<TextEdit>> {
    let picture = Picture::new(drawn.text);
    let arc: ArcId = graph.incoming(id).next()?;
    let wire = *graph.cells(graph.arc(arc).cells).first()?;
    let cells: Vec<(usize, usize)> = picture.places(wire).collect();
    let element = graph.element_at(id)?;
    let put = |start: (usize, usize), word: &str| {
        let cells = word.chars().enumerate();
        cells.map(|(at, character)| ((start.0, start.1 + at), character)).collect::<Vec<_>>()
    };
    let (row, first) = *cells.first()?;
    if element.place == OperandPlace::Inside || row == 0 {
        let contact = format!("[{ALWAYS_ON}]");
        return (cells.len() > contact.len() + 1)
            .then(|| picture.draw(&put((row, first + 1), &contact)))
            .flatten();
    }
    // As the formatter draws it: three cells of wire, the contact, its name centred above.
    const LEAD: usize = 3;
    const ROOM: usize = 9;
    let name = (row - 1, first + LEAD - 1);
    let free = (name.1 - 1..=name.1 + ALWAYS_ON.len()).all(|column| picture.at((row - 1, column)) == ' ');
    if cells.len() < ROOM || !free {
        return None;
    }
    let mut marks = put((row, first + LEAD), "| |");
    marks.extend(put(name, ALWAYS_ON));
    picture.draw(&marks)
}
