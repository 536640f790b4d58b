//! Junctions without a way in or without a way out, and whether the way is only drawn in the wrong direction.

use crate::ladder::{ArcId, Graph, VertexId, VertexKind};

/// A junction that no wire reaches from its left, or that none leaves to its right, and has no loose end itself.
#[derive(Clone, Debug)]
pub(super) struct DeadEnd {
    pub(super) junction: VertexId,
    /// Whether the wire on its left is lacking, else that on its right.
    pub(super) lacks_left: bool,
    /// Wires between it and the live part of the rung through which power would have to flow right to left,
    /// top to bottom; empty if it lacks nothing but a connection.
    pub(super) backwards: Vec<ArcId>,
}

/// All dead ends of a graph, in linear time.
pub(super) fn dead_ends(graph: &Graph) -> Vec<DeadEnd> {
    let lacking = |left: bool| {
        let ends = graph.vertex_ids().filter(move |id| {
            let vertex = graph.vertex(*id);
            let degree = if left { vertex.in_degree } else { vertex.out_degree };
            vertex.kind == VertexKind::Junction && degree == 0 && !has_loose_end(graph, *id)
        });
        ends.collect::<Vec<_>>()
    };
    let mut found = Vec::new();
    for left in [true, false] {
        let junctions = lacking(left);
        if junctions.is_empty() {
            continue;
        }
        let live = live(graph, left);
        let mut seen = vec![false; graph.vertices.len()];
        for junction in junctions {
            let backwards = backwards(graph, junction, left, &live, &mut seen);
            found.push(DeadEnd { junction, lacks_left: left, backwards });
        }
    }
    found
}

fn has_loose_end(graph: &Graph, junction: VertexId) -> bool {
    let loose = |id: VertexId| graph.vertex(id).kind == VertexKind::LooseEnd;
    graph.outgoing(junction).any(|arc| loose(graph.arc(arc).head))
        || graph.incoming(junction).any(|arc| loose(graph.arc(arc).tail))
}

/// The arcs of a vertex to its right, or to its left, with the vertices there.
fn next(graph: &Graph, vertex: VertexId, right: bool) -> Vec<(ArcId, VertexId)> {
    match right {
        true => graph.outgoing(vertex).map(|arc| (arc, graph.arc(arc).head)).collect(),
        false => graph.incoming(vertex).map(|arc| (arc, graph.arc(arc).tail)).collect(),
    }
}

/// The vertices that power reaches from the left rail, or from which it reaches the right one.
fn live(graph: &Graph, from_left: bool) -> Vec<bool> {
    let mut live = vec![false; graph.vertices.len()];
    let mut stack = vec![if from_left { Graph::LEFT_RAIL } else { Graph::RIGHT_RAIL }];
    while let Some(vertex) = stack.pop() {
        if !std::mem::replace(&mut live[vertex.0 as usize], true) {
            stack.extend(next(graph, vertex, from_left).into_iter().map(|(_, to)| to));
        }
    }
    live
}

/// The wires at which the dead part behind `junction` meets live junctions, if there is more than one place to go:
/// then power would flow through the dead part from one of them to another.
fn backwards(graph: &Graph, junction: VertexId, left: bool, live: &[bool], seen: &mut [bool]) -> Vec<ArcId> {
    let (mut borders, mut places) = (Vec::new(), Vec::new());
    let mut stack = vec![junction];
    while let Some(vertex) = stack.pop() {
        if std::mem::replace(&mut seen[vertex.0 as usize], true) {
            continue;
        }
        for (arc, to) in next(graph, vertex, left) {
            let rail = to == Graph::LEFT_RAIL || to == Graph::RIGHT_RAIL;
            if rail || live[to.0 as usize] {
                places.push(to);
            }
            if live[to.0 as usize] && graph.vertex(to).kind == VertexKind::Junction {
                borders.push(arc);
            } else if !rail && !live[to.0 as usize] {
                stack.push(to);
            }
        }
    }
    places.sort_unstable();
    places.dedup();
    if places.len() < 2 {
        borders.clear();
    }
    borders.sort_unstable();
    borders
}
