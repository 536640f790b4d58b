//! Loose ends of a chunk, and which of them are one mistake.

use super::dead_end::dead_ends;
use super::first_cell;
use super::picture::{Picture, Place, Side, is_junction};
use crate::ladder::{Arc, ArcId, ElementId, Graph, Rung, VertexId, VertexKind};
use crate::text::Span;
use rustc_hash::FxHashMap;

/// A place in a drawing where a connection is lacking.
#[derive(Clone, Debug)]
pub(super) struct End {
    /// The rung's number in its tree.
    pub(super) rung: usize,
    /// The exact cell.
    pub(super) span: Span,
    pub(super) place: Place,
    pub(super) kind: EndKind,
    /// The sides on which a connection would mend it, the likeliest first.
    pub(super) sides: Vec<Side>,
    /// The element at the other end of the wire.
    pub(super) element: Option<ElementId>,
    /// The wire, if it is no more than that.
    pub(super) arc: Option<ArcId>,
    vertex: VertexId,
}

/// What ends there.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum EndKind {
    /// A wire that goes nowhere to its right.
    WireRight,
    /// The right side of an element.
    ElementRight,
    /// A wire that comes from nowhere.
    WireLeft,
    /// The left side of an element.
    ElementLeft,
    /// An end of a vertical wire.
    Vertical,
    /// A corner with one wire.
    Corner,
    /// A vertical wire to whose left nothing is joined.
    JunctionLeft,
    /// A vertical wire to whose right nothing is joined.
    JunctionRight,
}

/// The mistakes of a chunk, each with its ends, the one to report first.
pub(super) fn mistakes(rungs: &[Rung], picture: &Picture) -> Vec<Vec<End>> {
    let mut ends = Vec::new();
    for (number, rung) in rungs.iter().enumerate() {
        let first = ends.len();
        collect(number, &rung.graph, picture, &mut ends);
        debug_assert!(ends.len() >= first);
    }
    let mut groups = Groups::new(ends.len());
    join_facing(&ends, picture, &mut groups);
    join_floating(rungs, &ends, &mut groups);
    let mut mistakes: FxHashMap<usize, Vec<End>> = FxHashMap::default();
    for (number, end) in ends.into_iter().enumerate() {
        mistakes.entry(groups.root(number)).or_default().push(end);
    }
    let mut mistakes: Vec<Vec<End>> = mistakes.into_values().collect();
    for mistake in &mut mistakes {
        mistake.sort_by_key(|end| (end.kind, end.span));
    }
    mistakes.sort_by_key(|mistake| mistake.first().map(|end| end.span));
    mistakes
}

fn collect(rung: usize, graph: &Graph, picture: &Picture, ends: &mut Vec<End>) {
    for vertex in graph.vertex_ids().filter(|id| graph.vertex(*id).kind == VertexKind::LooseEnd) {
        let span = first_cell(graph, vertex);
        let place = picture.place(span.start);
        let arc = graph.outgoing(vertex).next().map(|arc| (arc, true));
        let Some((arc, lacks_left)) = arc.or_else(|| graph.incoming(vertex).next().map(|arc| (arc, false)))
        else {
            continue;
        };
        let (kind, sides) = kind_of(graph, graph.arc(arc), lacks_left, span, picture.at(place));
        let other = if lacks_left { graph.arc(arc).head } else { graph.arc(arc).tail };
        let element = match graph.vertex(other).kind {
            VertexKind::Element(element) => Some(element),
            _ => None,
        };
        ends.push(End { rung, span, place, kind, sides, element, arc: Some(arc), vertex });
    }
    for end in dead_ends(graph).into_iter().filter(|end| end.backwards.is_empty()) {
        let span = first_cell(graph, end.junction);
        let (kind, side) = match end.lacks_left {
            true => (EndKind::JunctionLeft, Side::Left),
            false => (EndKind::JunctionRight, Side::Right),
        };
        let place = picture.place(span.start);
        ends.push(End {
            rung,
            span,
            place,
            kind,
            sides: vec![side],
            element: None,
            arc: None,
            vertex: end.junction,
        });
    }
}

fn kind_of(graph: &Graph, arc: &Arc, lacks_left: bool, span: Span, character: char) -> (EndKind, Vec<Side>) {
    use Side::*;
    let bare = graph.cells(arc.cells).is_empty();
    if bare && graph.vertex(arc.tail).kind == VertexKind::Junction {
        let top = first_cell(graph, arc.tail) == span;
        let mut sides = vec![if top { Up } else { Down }];
        if is_junction(character) {
            sides.extend([Right, Left]);
        }
        return (EndKind::Vertical, sides);
    }
    if is_junction(character) {
        return (EndKind::Corner, vec![Up, Down, if lacks_left { Left } else { Right }]);
    }
    match (lacks_left, bare) {
        (true, true) => (EndKind::ElementLeft, vec![Left]),
        (true, false) => (EndKind::WireLeft, vec![Left]),
        (false, true) => (EndKind::ElementRight, vec![Right]),
        (false, false) => (EndKind::WireRight, vec![Right]),
    }
}

/// Joins ends with nothing but blank cells between them, and ends beside the same blank cell: a gap is one mistake.
fn join_facing(ends: &[End], picture: &Picture, groups: &mut Groups) {
    let at: FxHashMap<Place, usize> =
        ends.iter().enumerate().map(|(number, end)| (end.place, number)).collect();
    let mut beside: FxHashMap<Place, usize> = FxHashMap::default();
    for (number, end) in ends.iter().enumerate() {
        if let Some(other) = at.get(&end.place) {
            groups.join(number, *other);
        }
        for side in &end.sides {
            if let Some((place, _)) = picture.look(end.place, *side)
                && let Some(other) = at.get(&place)
            {
                groups.join(number, *other);
            }
            if let Some(missing) = side.of(end.place).filter(|place| picture.at(*place) == ' ') {
                match beside.get(&missing) {
                    Some(other) => groups.join(number, *other),
                    None => _ = beside.insert(missing, number),
                }
            }
        }
    }
}

/// Joins the ends of each part of a drawing that no rail reaches: what stands alone is one mistake.
fn join_floating(rungs: &[Rung], ends: &[End], groups: &mut Groups) {
    let mut rest = ends.iter().enumerate().peekable();
    while let Some((_, first)) = rest.peek() {
        let number = first.rung;
        let graph = &rungs[number].graph;
        let mut parts = Groups::new(graph.vertices.len());
        let rail = |id: VertexId| id == Graph::LEFT_RAIL || id == Graph::RIGHT_RAIL;
        for arc in graph.arcs.iter().filter(|arc| !rail(arc.tail) && !rail(arc.head)) {
            parts.join(arc.tail.0 as usize, arc.head.0 as usize);
        }
        let mut held = vec![false; graph.vertices.len()];
        for arc in graph.arcs.iter().filter(|arc| rail(arc.tail) || rail(arc.head)) {
            let inner = if rail(arc.tail) { arc.head } else { arc.tail };
            held[parts.root(inner.0 as usize)] = true;
        }
        let mut first_of: FxHashMap<usize, usize> = FxHashMap::default();
        while let Some((end, _)) = rest.next_if(|(_, end)| end.rung == number) {
            let part = parts.root(ends[end].vertex.0 as usize);
            if !held[part] {
                groups.join(*first_of.entry(part).or_insert(end), end);
            }
        }
    }
}

/// Disjoint sets of numbers.
struct Groups(Vec<usize>);

impl Groups {
    fn new(count: usize) -> Groups {
        Groups((0..count).collect())
    }

    fn root(&mut self, mut number: usize) -> usize {
        while self.0[number] != number {
            self.0[number] = self.0[self.0[number]];
            number = self.0[number];
        }
        number
    }

    /// The smaller root stays, so that results do not depend on anything but the order of the drawing.
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}
