//! Where power flowed in a scan: contacts, wires and outputs of the text as they were when they were executed.

use super::{Code, Sight};
use crate::document::{Chunk, Document, Tree};
use crate::ladder::{Element, ElementKind, Graph, LadderTree, VertexId, VertexKind};
use crate::target::Role;
use crate::text::Span;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// A piece of the text, and whether power flowed there.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Energised {
    /// Offsets into the document.
    pub span: Span,
    /// What it is.
    pub kind: EnergisedKind,
    /// Whether power came through; of an output, whether it had power, of an inversion, whether it gave it; of a line
    /// of a list, whether the current result was on behind it, and had come from the rail.
    pub energised: bool,
}

/// What can be energised.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EnergisedKind {
    /// A wire, or a piece of one.
    Wire,
    /// A contact, and whether it conducts, with power or without.
    Contact(bool),
    /// A coil, or an instruction that power drives or goes through.
    Output,
    /// A line of a list.
    Line,
}

/// Power in the chunks of document number `number` that lie in `window`, as `sights` of one scan tell. What the scan
/// did not come to is left out.
pub fn power_flow(
    document: &Document,
    number: u32,
    code: &Code,
    sights: &[Sight<u8>],
    window: Range<usize>,
) -> Vec<Energised> {
    let seen = Seen::new(code, number, sights, &window);
    let mut shown = Vec::new();
    for at in document.chunks() {
        if at.start + at.chunk.len() <= window.start {
            continue;
        }
        if at.start >= window.end {
            break;
        }
        let reading = at.chunk.reading();
        match reading.tree() {
            Tree::Ladder(tree) => {
                drawn(tree, at.start, &seen, &mut shown);
                let lists = at.chunk.boxes().iter();
                lists.for_each(|(start, list)| listed(list, at.start + start, &seen, &mut shown));
            }
            Tree::Fx(_) | Tree::Iec(_) => listed(at.chunk, at.start, &seen, &mut shown),
        }
    }
    shown
}

/// The lines of a list that begins at `start`.
fn listed(list: &Chunk, start: usize, seen: &Seen, shown: &mut Vec<Energised>) {
    match list.reading().tree() {
        Tree::Fx(tree) => {
            let spans = tree.lines.iter().map(|line| line.span.shifted(start));
            shown.extend(spans.filter_map(|span| seen.line(span)));
        }
        _ => shown.extend(seen.lines_within(start..start + list.len())),
    }
}

/// What was seen of one document, by place.
struct Seen(FxHashMap<Span, Sight<u8>>);

impl Seen {
    fn new(code: &Code, number: u32, sights: &[Sight<u8>], window: &Range<usize>) -> Seen {
        let mut seen = FxHashMap::default();
        for sight in sights {
            let Some(place) = code.places.get(sight.instruction as usize) else { continue };
            let is_near = (place.span.start as usize) < window.end + NEAR
                && (place.span.end as usize) + NEAR > window.start;
            if place.document == number && is_near {
                // Of several times in one scan the last one is shown.
                seen.insert(place.span, *sight);
            }
        }
        Seen(seen)
    }

    fn line(&self, span: Span) -> Option<Energised> {
        let sight = self.0.get(&span)?;
        Some(Energised { span, kind: EnergisedKind::Line, energised: sight.power != 0 })
    }

    fn lines_within(&self, bytes: Range<usize>) -> Vec<Energised> {
        let is_within = |span: &&Span| bytes.contains(&(span.start as usize));
        let mut spans: Vec<&Span> = self.0.keys().filter(is_within).collect();
        spans.sort_unstable_by_key(|span| span.start);
        spans.into_iter().filter_map(|span| self.line(*span)).collect()
    }
}

/// A chunk that begins before the window may reach into it by so many bytes and more; what lies further off is noted
/// for nothing.
const NEAR: usize = 1 << 16;

fn drawn(tree: &LadderTree, start: usize, seen: &Seen, shown: &mut Vec<Energised>) {
    for rung in &tree.rungs {
        // Power at the left rail was seen where the rung begins; else the scan did not come to it.
        let Some(rail) = seen.0.get(&rung.span.shifted(start)) else { continue };
        let flow = Flow::of(&rung.graph, rail.power != 0, |element| {
            seen.0.get(&element.span.shifted(start)).copied()
        });
        flow.show(&rung.graph, start, shown);
    }
}

/// Power at the vertices of a rung.
struct Flow {
    /// What comes in from the left.
    into: Vec<bool>,
    /// What goes out to the right.
    out: Vec<bool>,
    sights: Vec<Option<Sight<u8>>>,
}

impl Flow {
    fn of(graph: &Graph, rail: bool, sight: impl Fn(&Element) -> Option<Sight<u8>>) -> Flow {
        let count = graph.vertices.len();
        let mut flow = Flow { into: vec![false; count], out: vec![false; count], sights: vec![None; count] };
        let mut waiting: Vec<u32> = graph.vertices.iter().map(|vertex| vertex.in_degree).collect();
        let mut ready: Vec<VertexId> =
            (0..count as u32).map(VertexId).filter(|id| waiting[id.0 as usize] == 0).collect();
        while let Some(id) = ready.pop() {
            let at = id.0 as usize;
            let power = flow.into[at];
            flow.sights[at] = graph.element_at(id).and_then(&sight);
            flow.out[at] = match graph.vertex(id).kind {
                VertexKind::LeftRail => rail,
                VertexKind::RightRail | VertexKind::Junction => power,
                VertexKind::LooseEnd => false,
                VertexKind::Element(element) => {
                    rail && passes(graph.element(element), power, flow.sights[at])
                }
            };
            for arc in graph.outgoing(id) {
                let head = graph.arc(arc).head.0 as usize;
                flow.into[head] |= flow.out[at];
                waiting[head] -= 1;
                if waiting[head] == 0 {
                    ready.push(VertexId(head as u32));
                }
            }
        }
        flow
    }

    fn show(&self, graph: &Graph, start: usize, shown: &mut Vec<Energised>) {
        let mut wire = |cells: (u32, u32), energised: bool| {
            let spans = graph.cells(cells).iter();
            shown.extend(spans.map(|span| Energised {
                span: span.shifted(start),
                kind: EnergisedKind::Wire,
                energised,
            }));
        };
        for arc in &graph.arcs {
            wire(arc.cells, self.out[arc.tail.0 as usize]);
        }
        for (vertex, power) in graph.vertices.iter().zip(&self.into) {
            if vertex.kind == VertexKind::Junction {
                wire(vertex.cells, *power);
            }
        }
        for (at, vertex) in graph.vertices.iter().enumerate() {
            let VertexKind::Element(id) = vertex.kind else { continue };
            let element = graph.element(id);
            let (kind, energised) = match (&element.kind, self.sights[at]) {
                // What comes out of it is seen behind it.
                (ElementKind::Invert, _) => (EnergisedKind::Output, self.out[at]),
                (_, None) => continue,
                (_, Some(Sight { conducts: Some(conducts), .. })) => {
                    (EnergisedKind::Contact(conducts != 0), self.out[at])
                }
                (_, Some(sight)) => (EnergisedKind::Output, sight.power != 0),
            };
            shown.push(Energised { span: element.span.shifted(start), kind, energised });
        }
    }
}

/// Whether power goes on behind an element of a rung whose left rail has power.
fn passes(element: &Element, power: bool, sight: Option<Sight<u8>>) -> bool {
    match (&element.kind, sight) {
        (ElementKind::Invert, _) => !power,
        (_, Some(Sight { conducts: Some(conducts), .. })) => power && conducts != 0,
        // A coil passes what it gets; a block tells what comes out of it.
        (ElementKind::Block(_), Some(sight)) => sight.power != 0,
        (ElementKind::Instruction { form: Some(form), .. }, Some(sight))
            if form.instruction.role == Role::Modify =>
        {
            sight.power != 0
        }
        _ => power,
    }
}
