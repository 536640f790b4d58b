//! Wires that lie parallel to elements.

use super::super::contract::{EdgeKind, Nodes};
use super::{Label, LabelId, Reduction, find_open_circuit};
use crate::ladder::{ArcId, ElementId, Graph, Vertex, VertexId, VertexKind};

/// A bare wire beside other branches: whatever they do, power goes past them.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Bypass {
    /// The arcs of the wire, left to right.
    pub arcs: Vec<ArcId>,
    /// The bends between them.
    pub bends: Vec<VertexId>,
    /// The elements that have no effect because of it; empty for a wire beside a wire.
    pub elements: Vec<ElementId>,
    /// Whether it leads from the left rail to the right rail.
    pub joins_rails: bool,
}

/// The bypasses of `graph`, and a wire that joins the rails even if nothing lies beside it; near-linear time.
/// Nothing for a graph with an open circuit.
pub fn bypasses(graph: &Graph) -> Vec<Bypass> {
    if !may_leave_wires(graph) {
        return Vec::new();
    }
    let nodes = Nodes::of(graph);
    // Every bypass is a wire that contraction has left over, and most rungs have none.
    let wires = nodes.edges.iter().any(|edge| matches!(edge.kind, EdgeKind::Wire { .. }));
    if !wires || find_open_circuit(graph, &nodes).is_err() {
        return Vec::new();
    }
    let mut reduction = Reduction::of(&nodes);
    reduction.run();
    let mut within = vec![false; reduction.labels.len()];
    for label in &reduction.labels {
        if let Label::Parallel((_, upper), (_, lower)) = label {
            within[*upper as usize] = true;
            within[*lower as usize] = true;
        }
    }
    let mut found = Vec::new();
    for label in 0..reduction.labels.len() as LabelId {
        if matches!(reduction.labels[label as usize], Label::Parallel(..)) && !within[label as usize] {
            among_branches(&reduction, label, &mut found);
        }
    }
    if let Some(link) = reduction.only_link(Nodes::LEFT, Nodes::RIGHT)
        && let Label::Wire(edge) = reduction.labels[link.label as usize]
    {
        found.extend(bypass(&nodes, edge, Vec::new()));
    }
    found.sort_by_key(|bypass| bypass.arcs.first().copied());
    found
}

/// Whether contraction can leave a wire over, told from the degrees of the vertices: it takes in every wire whose head
/// has no other feed, or whose tail has no other way out. A bend may lead to such ends, so it counts as one.
fn may_leave_wires(graph: &Graph) -> bool {
    let is_bend = |vertex: &Vertex| vertex.in_degree == 1 && vertex.out_degree == 1;
    graph.arcs.iter().any(|arc| {
        let (tail, head) = (graph.vertex(arc.tail), graph.vertex(arc.head));
        let tail_stays = match tail.kind {
            VertexKind::Element(_) => tail.out_degree != 1,
            VertexKind::Junction => tail.out_degree != 1 || is_bend(tail),
            VertexKind::LeftRail | VertexKind::RightRail | VertexKind::LooseEnd => true,
        };
        let head_stays = match head.kind {
            VertexKind::Element(_) => head.in_degree != 1,
            VertexKind::Junction => head.in_degree != 1 || is_bend(head),
            VertexKind::LeftRail | VertexKind::RightRail | VertexKind::LooseEnd => true,
        };
        tail_stays && head_stays
    })
}

/// The bypasses among the branches of one parallel connection.
fn among_branches(reduction: &Reduction<'_>, label: LabelId, found: &mut Vec<Bypass>) {
    let (mut wires, mut others) = (Vec::new(), Vec::new());
    for branch in reduction.branches(label) {
        match reduction.labels[branch as usize] {
            Label::Wire(edge) => wires.push(edge),
            _ => others.push(branch),
        }
    }
    if wires.is_empty() {
        return;
    }
    let mut elements: Vec<ElementId> =
        others.into_iter().flat_map(|branch| reduction.elements(branch)).collect();
    // Of wires beside each other and nothing else, the topmost is the line itself.
    let surplus = if elements.is_empty() { 1 } else { 0 };
    elements.sort_unstable();
    for (number, edge) in wires.into_iter().skip(surplus).enumerate() {
        let killed = if number == 0 { std::mem::take(&mut elements) } else { Vec::new() };
        found.extend(bypass(reduction.nodes, edge, killed));
    }
}

fn bypass(nodes: &Nodes, edge: u32, elements: Vec<ElementId>) -> Option<Bypass> {
    let edge = nodes.edges.get(edge as usize)?;
    let EdgeKind::Wire { arcs, bends } = &edge.kind else { return None };
    let joins_rails = edge.tail == Nodes::LEFT && edge.head == Nodes::RIGHT;
    Some(Bypass { arcs: arcs.clone(), bends: bends.clone(), elements, joins_rails })
}
