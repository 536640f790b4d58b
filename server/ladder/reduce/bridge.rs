//! Which part of a rung makes it a mixed connection.

use super::super::contract::{EdgeKind, Nodes};
use super::{Bridge, Label, Link, Reduction};
use crate::ladder::{Graph, VertexId};
use crate::text::Span;

/// How many links are tried, cheapest first. The links left over by the reduction are few in any rung that a person
/// draws; the limit keeps a generated one from costing the square of its size.
const TRIALS_MAX: usize = 64;

/// The bridge of a graph that `stuck` could not reduce.
pub(super) fn find(stuck: &Reduction<'_>, graph: &Graph) -> Bridge {
    let mut core: Vec<Link> = stuck.between.values().map(|link| stuck.links[*link as usize]).collect();
    core.sort_by_key(|link| (weight(stuck, link), link.tail, link.order));
    let across: Vec<&Link> =
        core.iter().take(4 * TRIALS_MAX).filter(|link| runs_across(&core, link)).collect();
    let mends = across.iter().take(TRIALS_MAX).find(|link| reduces_without(stuck, &core, link));
    let link = mends.or(across.first()).copied().or(core.first());
    link.map_or_else(nothing, |link| describe(stuck, graph, &core, link))
}

/// Bare wires first, then by the number of elements.
fn weight(stuck: &Reduction<'_>, link: &Link) -> usize {
    match stuck.labels[link.label as usize] {
        Label::Wire(_) => 0,
        _ => 1 + stuck.elements(link.label).len(),
    }
}

/// Whether power gets to the link's right end without passing its left end, and from its left end to the right rail
/// without passing its right end: the sign of a rung in a ladder's frame, in either direction.
fn runs_across(core: &[Link], link: &Link) -> bool {
    reaches(core, Nodes::LEFT, link.head, link.tail) && reaches(core, link.tail, Nodes::RIGHT, link.head)
}

fn reaches(core: &[Link], from: u32, to: u32, avoiding: u32) -> bool {
    let nodes = core.iter().map(|link| link.tail.max(link.head)).max().unwrap_or(0) as usize + 1;
    let mut heads = vec![Vec::new(); nodes.max(from as usize + 1)];
    core.iter().for_each(|link| heads[link.tail as usize].push(link.head));
    let mut seen = vec![false; heads.len()];
    let mut stack = vec![from];
    while let Some(node) = stack.pop() {
        if node == to {
            return true;
        }
        if node != avoiding && !std::mem::replace(&mut seen[node as usize], true) {
            stack.extend(&heads[node as usize]);
        }
    }
    false
}

fn reduces_without(stuck: &Reduction<'_>, core: &[Link], without: &Link) -> bool {
    let mut trial = Reduction::new(stuck.nodes);
    trial.labels = vec![Label::Wire(0)];
    for link in core.iter().filter(|link| *link != without) {
        trial.insert(Link { label: 0, ..*link });
    }
    trial.run();
    trial.is_reduced()
}

fn describe(stuck: &Reduction<'_>, graph: &Graph, core: &[Link], link: &Link) -> Bridge {
    let nodes = &stuck.nodes.nodes;
    let junction =
        |node: u32| nodes[node as usize].vertices.iter().max_by_key(|id| height(graph, **id)).copied();
    let vertical = |id: VertexId| graph.cells(graph.vertex(id).cells).to_vec();
    let mut bridge = Bridge { from: junction(link.tail), to: junction(link.head), ..nothing() };
    bridge.elements = stuck.elements(link.label);
    if let Label::Wire(edge) = stuck.labels[link.label as usize]
        && let EdgeKind::Wire { arcs, bends } = &stuck.nodes.edges[edge as usize].kind
    {
        bridge.arcs.clone_from(arcs);
        bridge.wire = arcs.iter().flat_map(|arc| graph.cells(graph.arc(*arc).cells)).copied().collect();
        let tallest = bends.iter().copied().max_by_key(|id| height(graph, *id));
        bridge.vertical = tallest.filter(|id| height(graph, *id) > 1).map(vertical).unwrap_or_default();
    }
    if bridge.vertical.is_empty() {
        bridge.vertical = bridge.to.or(bridge.from).map(vertical).unwrap_or_default();
    }
    let ends = [link.tail, link.head];
    let meets = |other: &&Link| ends.contains(&other.tail) || ends.contains(&other.head);
    for other in core.iter().filter(meets).filter(|other| *other != link) {
        bridge.beside.extend(stuck.elements(other.label));
    }
    bridge.beside.sort_unstable();
    bridge
}

/// Rows that a junction fills.
fn height(graph: &Graph, id: VertexId) -> usize {
    graph.cells(graph.vertex(id).cells).len()
}

fn nothing() -> Bridge {
    let vertical: Vec<Span> = Vec::new();
    Bridge {
        from: None,
        to: None,
        arcs: Vec::new(),
        elements: Vec::new(),
        wire: Vec::new(),
        vertical,
        beside: Vec::new(),
    }
}
