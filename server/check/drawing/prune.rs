//! Takes wires out of a drawing, with the ends of vertical wires that nothing reaches any more.

use super::picture::{Picture, Place};
use crate::ladder::{ArcId, Graph, VertexId, VertexKind};
use crate::text::TextEdit;

/// The cells of one rung that are to become blank.
pub(super) struct Prune<'a> {
    picture: &'a Picture,
    graph: &'a Graph,
    arcs: Vec<ArcId>,
    cells: Vec<Place>,
}

impl<'a> Prune<'a> {
    pub(super) fn new(picture: &'a Picture, graph: &'a Graph) -> Prune<'a> {
        Prune { picture, graph, arcs: Vec::new(), cells: Vec::new() }
    }

    /// Takes out a wire, and the loose end that it leads to.
    pub(super) fn wire(&mut self, arc: ArcId) {
        let (graph, picture) = (self.graph, self.picture);
        self.arcs.push(arc);
        let arc = graph.arc(arc);
        let cells = graph.cells(arc.cells);
        self.cells.extend(cells.iter().flat_map(|span| picture.places(*span)));
        for end in [arc.tail, arc.head] {
            let vertex = graph.vertex(end);
            if vertex.kind == VertexKind::LooseEnd && !cells.is_empty() {
                let cells = graph.cells(vertex.cells);
                self.cells.extend(cells.iter().flat_map(|span| picture.places(*span)));
            }
        }
    }

    /// Takes out a whole vertical wire.
    pub(super) fn junction(&mut self, id: VertexId) {
        let cells = self.graph.cells(self.graph.vertex(id).cells);
        self.cells.extend(cells.iter().flat_map(|span| self.picture.places(*span)));
    }

    /// The edits; nothing if a cell cannot be replaced.
    pub(super) fn edits(mut self) -> Option<Vec<TextEdit>> {
        self.shorten_verticals();
        let marks: Vec<(Place, char)> = self.cells.iter().map(|place| (*place, ' ')).collect();
        self.picture.draw(&marks)
    }

    /// Blanks the ends of the vertical wires at both ends of the removed wires, up to a row that is still joined.
    fn shorten_verticals(&mut self) {
        let graph = self.graph;
        let ends = self.arcs.iter().flat_map(|arc| [graph.arc(*arc).tail, graph.arc(*arc).head]);
        let mut junctions: Vec<VertexId> =
            ends.filter(|id| graph.vertex(*id).kind == VertexKind::Junction).collect();
        junctions.sort_unstable();
        junctions.dedup();
        for junction in junctions {
            let rows = self.joined_rows(junction);
            let (Some(first), Some(last)) = (rows.iter().min(), rows.iter().max()) else {
                self.junction(junction);
                continue;
            };
            let places =
                graph.cells(graph.vertex(junction).cells).iter().flat_map(|c| self.picture.places(*c));
            self.cells.extend(places.filter(|(row, _)| row < first || last < row));
        }
    }

    /// The rows in which wires stay at a vertical wire.
    fn joined_rows(&self, junction: VertexId) -> Vec<usize> {
        let arcs = self.graph.outgoing(junction).chain(self.graph.incoming(junction));
        let staying = arcs.filter(|arc| !self.arcs.contains(arc));
        // An arc without cells leads to the vertical's own loose end, or to a symbol that touches it.
        staying.filter_map(|arc| self.row(arc, junction)).collect()
    }

    fn row(&self, arc: ArcId, junction: VertexId) -> Option<usize> {
        let arc = self.graph.arc(arc);
        if let Some(cells) = self.graph.cells(arc.cells).first() {
            return Some(self.picture.row(cells.start));
        }
        let other = if arc.tail == junction { arc.head } else { arc.tail };
        let element = self.graph.element_at(other).map(|element| element.row as usize);
        let cells = self.graph.cells(self.graph.vertex(other).cells).first();
        match self.graph.vertex(other).kind {
            VertexKind::LooseEnd => None,
            _ => element.or_else(|| cells.map(|cells| self.picture.row(cells.start))),
        }
    }
}
