//! The graph of a rung: an orthogonal list in index arenas.
//!
//! Vertices are rails, junctions and elements, arcs are wires. Each arc stands in the out-list of its tail and in the
//! in-list of its head, both ordered top to bottom in the drawing, so degrees and neighbours cost no search.
//! Power flows from tail to head only; a drawing in which it would have to flow back has no arc for that.

use super::{Element, ElementId};
use crate::text::Span;

/// Index of a vertex in its graph.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct VertexId(pub u32);

/// Index of an arc in its graph.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct ArcId(pub u32);

/// The graph of one rung.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Graph {
    /// Vertices; the left rail is number 0, the right rail number 1.
    pub vertices: Vec<Vertex>,
    /// Wires.
    pub arcs: Vec<Arc>,
    /// Elements; the vertex of each names it.
    pub elements: Vec<Element>,
    /// The cells of all wires, one span for each run in a row; arcs and junctions refer to ranges of it.
    pub cells: Vec<Span>,
}

/// A vertex with its lists of arcs.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Vertex {
    /// What it is.
    pub kind: VertexKind,
    /// First arc that leaves it.
    pub first_out: Option<ArcId>,
    /// Last arc that leaves it.
    pub last_out: Option<ArcId>,
    /// First arc that enters it.
    pub first_in: Option<ArcId>,
    /// Last arc that enters it.
    pub last_in: Option<ArcId>,
    /// Number of arcs that leave it.
    pub out_degree: u32,
    /// Number of arcs that enter it.
    pub in_degree: u32,
    /// Range in [`Graph::cells`]: the vertical wire of a junction, the loose end's cell.
    pub cells: (u32, u32),
}

/// What a vertex is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum VertexKind {
    /// The left rail: always energised.
    LeftRail,
    /// The right rail; outputs that end without a wire to it are joined to it all the same.
    RightRail,
    /// A vertical wire, or a bend: the OR of what enters.
    Junction,
    /// An element.
    Element(ElementId),
    /// The end of a wire that meets nothing, or the side of an element where no wire is: an open circuit.
    /// As a tail it has no power, as a head it feeds nothing.
    LooseEnd,
}

/// A wire from a vertex to one further right.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Arc {
    /// Where power comes from.
    pub tail: VertexId,
    /// Output pin number of a function block, else 0.
    pub tail_pin: u16,
    /// Where it goes.
    pub head: VertexId,
    /// Input pin number of a function block, else 0.
    pub head_pin: u16,
    /// Next arc that leaves the same tail, downwards in the drawing.
    pub next_out: Option<ArcId>,
    /// Next arc that enters the same head, downwards.
    pub next_in: Option<ArcId>,
    /// Range in [`Graph::cells`]; empty where symbols touch.
    pub cells: (u32, u32),
}

impl Graph {
    /// The left rail's vertex.
    pub const LEFT_RAIL: VertexId = VertexId(0);
    /// The right rail's vertex.
    pub const RIGHT_RAIL: VertexId = VertexId(1);

    /// A graph of two rails.
    pub fn new() -> Graph {
        let mut graph = Graph::default();
        graph.add_vertex(VertexKind::LeftRail, &[]);
        graph.add_vertex(VertexKind::RightRail, &[]);
        graph
    }

    /// A graph of two rails with room for so many elements and wires.
    pub(super) fn with_room(elements: usize, wires: usize) -> Graph {
        let mut graph = Graph {
            // Each element is a vertex, and seldom there are more junctions than elements.
            vertices: Vec::with_capacity(2 + 2 * elements),
            arcs: Vec::with_capacity(wires),
            elements: Vec::with_capacity(elements),
            cells: Vec::with_capacity(2 * wires),
        };
        graph.add_vertex(VertexKind::LeftRail, &[]);
        graph.add_vertex(VertexKind::RightRail, &[]);
        graph
    }

    /// Adds a vertex that fills `cells`.
    pub fn add_vertex(&mut self, kind: VertexKind, cells: &[Span]) -> VertexId {
        let cells = self.add_cells(cells);
        self.vertices.push(Vertex {
            kind,
            first_out: None,
            last_out: None,
            first_in: None,
            last_in: None,
            out_degree: 0,
            in_degree: 0,
            cells,
        });
        VertexId(self.vertices.len() as u32 - 1)
    }

    /// Adds an element and its vertex.
    pub fn add_element(&mut self, element: Element) -> VertexId {
        let id = ElementId(self.elements.len() as u32);
        self.elements.push(element);
        self.add_vertex(VertexKind::Element(id), &[])
    }

    /// Adds a wire at the end of both lists; callers add the wires of a vertex top to bottom.
    pub fn add_arc(&mut self, tail: (VertexId, u16), head: (VertexId, u16), cells: &[Span]) -> ArcId {
        let id = ArcId(self.arcs.len() as u32);
        let cells = self.add_cells(cells);
        let last_out = self.vertices[tail.0.0 as usize].last_out.replace(id);
        let last_in = self.vertices[head.0.0 as usize].last_in.replace(id);
        self.arcs.push(Arc {
            tail: tail.0,
            tail_pin: tail.1,
            head: head.0,
            head_pin: head.1,
            next_out: None,
            next_in: None,
            cells,
        });
        match last_out {
            Some(last) => self.arcs[last.0 as usize].next_out = Some(id),
            None => self.vertices[tail.0.0 as usize].first_out = Some(id),
        }
        match last_in {
            Some(last) => self.arcs[last.0 as usize].next_in = Some(id),
            None => self.vertices[head.0.0 as usize].first_in = Some(id),
        }
        self.vertices[tail.0.0 as usize].out_degree += 1;
        self.vertices[head.0.0 as usize].in_degree += 1;
        id
    }

    /// The vertex.
    pub fn vertex(&self, id: VertexId) -> &Vertex {
        &self.vertices[id.0 as usize]
    }

    /// The arc.
    pub fn arc(&self, id: ArcId) -> &Arc {
        &self.arcs[id.0 as usize]
    }

    /// The element.
    pub fn element(&self, id: ElementId) -> &Element {
        &self.elements[id.0 as usize]
    }

    /// The element at a vertex, if it is one.
    pub fn element_at(&self, id: VertexId) -> Option<&Element> {
        match self.vertex(id).kind {
            VertexKind::Element(element) => Some(self.element(element)),
            _ => None,
        }
    }

    /// The arcs that leave a vertex, top to bottom.
    pub fn outgoing(&self, id: VertexId) -> impl Iterator<Item = ArcId> {
        std::iter::successors(self.vertex(id).first_out, |arc| self.arc(*arc).next_out)
    }

    /// The arcs that enter a vertex, top to bottom.
    pub fn incoming(&self, id: VertexId) -> impl Iterator<Item = ArcId> {
        std::iter::successors(self.vertex(id).first_in, |arc| self.arc(*arc).next_in)
    }

    /// The cells of a range kept in an arc or a vertex.
    pub fn cells(&self, range: (u32, u32)) -> &[Span] {
        self.cells.get(range.0 as usize..range.1 as usize).unwrap_or(&[])
    }

    /// All vertices by number.
    pub fn vertex_ids(&self) -> impl Iterator<Item = VertexId> + use<> {
        (0..self.vertices.len() as u32).map(VertexId)
    }

    fn add_cells(&mut self, cells: &[Span]) -> (u32, u32) {
        let start = self.cells.len() as u32;
        self.cells.extend_from_slice(cells);
        (start, self.cells.len() as u32)
    }
}
