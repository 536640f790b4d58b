//! From the graph of a rung to its series-parallel shape.

mod bridge;

mod bypass;
pub use bypass::{Bypass, bypasses};

use super::contract::{EdgeKind, Nodes};
use super::{ElementId, Graph, VertexId, VertexKind};
use crate::text::Span;
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;

/// How a rung is put together: series and parallel connections of elements, from the left rail to the right.
///
/// Canonical: no series stands directly in a series, no parallel directly in a parallel, both have at least two
/// parts, and a bare wire stands only in a parallel or alone. Depth is at most [`Shape::DEPTH_MAX`], so that
/// recursion over it is safe.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Shape {
    /// Parts from left to right.
    Series(Vec<Shape>),
    /// Branches from top to bottom. Branches that end at the right rail are parallel there.
    Parallel(Vec<Shape>),
    /// An element.
    Element(ElementId),
    /// A function block with more than one wired input or output.
    Block(Box<BlockShape>),
    /// A bare wire: as a branch, a short circuit.
    Wire,
}

/// A function block on a power line with further wires at its pins.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct BlockShape {
    /// The block.
    pub element: ElementId,
    /// Further wired inputs by pin number, each with what lies between the left rail and the pin.
    pub inputs: Vec<(u16, Shape)>,
    /// Further wired outputs by pin number, each with what lies between the pin and the right rail.
    pub outputs: Vec<(u16, Shape)>,
}

impl Shape {
    /// How deep connections may nest. No hand draws a tenth of it; the limit keeps the stack safe.
    pub const DEPTH_MAX: usize = 200;

    /// The elements, series left to right, branches top to bottom.
    pub fn elements(&self) -> Vec<ElementId> {
        let mut elements = Vec::new();
        self.visit(&mut |element| elements.push(element));
        elements
    }

    fn visit(&self, found: &mut impl FnMut(ElementId)) {
        match self {
            Shape::Series(parts) | Shape::Parallel(parts) => {
                parts.iter().for_each(|part| part.visit(found));
            }
            Shape::Element(element) => found(*element),
            Shape::Block(block) => {
                block.inputs.iter().for_each(|(_, shape)| shape.visit(found));
                found(block.element);
                block.outputs.iter().for_each(|(_, shape)| shape.visit(found));
            }
            Shape::Wire => {}
        }
    }
}

/// Why a graph has no [`Shape`].
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum NotSeriesParallel {
    /// A loose end, or an element or junction that power cannot reach or leave: this vertex. Nothing is reduced.
    OpenCircuit(VertexId),
    /// Nothing leads from rail to rail.
    Empty,
    /// Two paths share a part of their way.
    Bridge(Box<Bridge>),
    /// A wire at a further pin of this function block leads to the block's own power line, not to a rail of its own.
    SharedPin(ElementId),
    /// Connections nest deeper than [`Shape::DEPTH_MAX`].
    TooDeep,
}

/// The part of a rung that makes it a mixed connection: without it the rung is series-parallel,
/// or, if several parts do that, less mixed.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Bridge {
    /// The junction at its left, the first of those drawn for it; `None` where an element touches.
    pub from: Option<VertexId>,
    /// The junction at its right.
    pub to: Option<VertexId>,
    /// The arcs of which it consists, where it is a bare wire.
    pub arcs: Vec<super::ArcId>,
    /// The elements on it; empty for a bare wire.
    pub elements: Vec<ElementId>,
    /// The cells of the vertical wire to name: the one within the bridge if it has one, else that at its right end.
    pub vertical: Vec<Span>,
    /// The cells of its own wires.
    pub wire: Vec<Span>,
    /// The elements whose wires meet the bridge at either end.
    pub beside: Vec<ElementId>,
}

/// The series-parallel shape of `graph`; near-linear time, no recursion on the graph.
///
/// A connector that starts a line starts at the left rail, and a jump, return or connector that ends one ends at
/// the right rail: so they are drawn.
pub fn reduce(graph: &Graph) -> Result<Shape, NotSeriesParallel> {
    let nodes = Nodes::of(graph);
    find_open_circuit(graph, &nodes)?;
    let mut reduction = Reduction::of(&nodes);
    reduction.run();
    reduction.shape(graph)
}

/// Whether [`reduce`] can find a [`Bridge`] at all, told from the degrees of the vertices: two paths can share a part
/// of their way only between two junctions, or at a function block with several wires.
pub fn may_be_mixed(graph: &Graph) -> bool {
    let mut junctions = 0;
    for vertex in &graph.vertices {
        match vertex.kind {
            VertexKind::Element(_) if vertex.in_degree > 1 || vertex.out_degree > 1 => return true,
            VertexKind::Junction if vertex.in_degree + vertex.out_degree > 2 => junctions += 1,
            _ => {}
        }
    }
    junctions > 1
}

fn find_open_circuit(graph: &Graph, nodes: &Nodes) -> Result<(), NotSeriesParallel> {
    let open = |node: usize, fallback: ElementId| {
        let junction = nodes.nodes[node].vertices.first().copied();
        NotSeriesParallel::OpenCircuit(junction.unwrap_or_else(|| vertex_of(graph, fallback)))
    };
    for (id, node) in nodes.nodes.iter().enumerate() {
        let side =
            |input: bool| nodes.sides.iter().find(|side| side.node as usize == id && side.input == input);
        let unfed = node.ins.is_empty() && id != Nodes::LEFT as usize;
        let ends = node.outs.is_empty() && id != Nodes::RIGHT as usize;
        let starts_at_pin = unfed && !nodes.sides.is_empty() && side(false).is_some();
        let ends_at_pin = ends && !nodes.sides.is_empty() && side(true).is_some();
        let unused_rail = id <= Nodes::RIGHT as usize && node.ins.is_empty() && node.outs.is_empty();
        if unused_rail || !(node.loose || unfed && !starts_at_pin || ends && !ends_at_pin) {
            continue;
        }
        let beside =
            node.outs.iter().chain(&node.ins).find_map(|edge| match nodes.edges[*edge as usize].kind {
                EdgeKind::Element(element) => Some(element),
                EdgeKind::Wire { .. } => None,
            });
        return Err(open(id, beside.unwrap_or(ElementId(0))));
    }
    if nodes.nodes[Nodes::LEFT as usize].outs.is_empty() {
        return Err(NotSeriesParallel::Empty);
    }
    Ok(())
}

fn vertex_of(graph: &Graph, element: ElementId) -> VertexId {
    let is = |id: &VertexId| graph.vertex(*id).kind == VertexKind::Element(element);
    graph.vertex_ids().find(is).unwrap_or(Graph::LEFT_RAIL)
}

/// Index of a [`Label`].
type LabelId = u32;

/// What a link of the reduction stands for. Binary and in an arena: long chains and deep nests cost no recursion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Label {
    /// The bare wire that is this edge of [`Nodes`].
    Wire(u32),
    Element(ElementId),
    Series(LabelId, LabelId),
    /// Two branches, each with its place among the ways out of their common tail.
    Parallel((u32, LabelId), (u32, LabelId)),
}

/// What is left between two nodes while reducing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Link {
    tail: u32,
    head: u32,
    /// Place of its first edge among the ways out of the tail, from the top.
    order: u32,
    label: LabelId,
}

/// The classic reduction: joins parallel links and links in series until nothing changes.
#[derive(Clone)]
struct Reduction<'a> {
    nodes: &'a Nodes,
    labels: Vec<Label>,
    links: Vec<Link>,
    /// The one link between two nodes.
    between: FxHashMap<(u32, u32), u32>,
    states: Vec<NodeState>,
    waiting: Vec<u32>,
}

/// What the reduction must know about a node: the xor of the links at one side is the link, once it is alone.
#[derive(Clone, Copy, Default)]
struct NodeState {
    outs: u32,
    out_xor: u32,
    ins: u32,
    in_xor: u32,
    terminal: bool,
}

impl<'a> Reduction<'a> {
    fn new(nodes: &'a Nodes) -> Reduction<'a> {
        let mut states = vec![NodeState::default(); nodes.nodes.len()];
        let ends = nodes.sides.iter().map(|side| side.node).chain([Nodes::LEFT, Nodes::RIGHT]);
        ends.for_each(|node| states[node as usize].terminal = true);
        Reduction {
            nodes,
            labels: Vec::new(),
            links: Vec::new(),
            between: FxHashMap::default(),
            states,
            waiting: Vec::new(),
        }
    }

    /// All edges of `nodes` as links, nothing reduced yet but parallel ones.
    fn of(nodes: &'a Nodes) -> Reduction<'a> {
        let mut reduction = Reduction::new(nodes);
        for (number, edge) in nodes.edges.iter().enumerate() {
            // Edges are numbered tail by tail, top to bottom.
            let order = number as u32;
            let label = match &edge.kind {
                EdgeKind::Wire { .. } => Label::Wire(number as u32),
                EdgeKind::Element(element) => Label::Element(*element),
            };
            let label = reduction.label(label);
            reduction.insert(Link { tail: edge.tail, head: edge.head, order, label });
        }
        reduction
    }

    fn label(&mut self, label: Label) -> LabelId {
        self.labels.push(label);
        self.labels.len() as LabelId - 1
    }

    /// Adds a link, joined with the one that is parallel to it, if any.
    fn insert(&mut self, mut link: Link) {
        if let Entry::Occupied(other) = self.between.entry((link.tail, link.head)) {
            let other = other.remove();
            self.detach(other);
            let other = self.links[other as usize];
            link.label = self.label(Label::Parallel((other.order, other.label), (link.order, link.label)));
            link.order = link.order.min(other.order);
        }
        let id = self.links.len() as u32;
        self.links.push(link);
        self.between.insert((link.tail, link.head), id);
        let tail = &mut self.states[link.tail as usize];
        tail.outs += 1;
        tail.out_xor ^= id;
        let head = &mut self.states[link.head as usize];
        head.ins += 1;
        head.in_xor ^= id;
        self.waiting.extend([link.tail, link.head]);
    }

    fn detach(&mut self, id: u32) {
        let link = self.links[id as usize];
        self.between.remove(&(link.tail, link.head));
        let tail = &mut self.states[link.tail as usize];
        tail.outs -= 1;
        tail.out_xor ^= id;
        let head = &mut self.states[link.head as usize];
        head.ins -= 1;
        head.in_xor ^= id;
    }

    fn run(&mut self) {
        while let Some(node) = self.waiting.pop() {
            let state = self.states[node as usize];
            if state.terminal || state.ins != 1 || state.outs != 1 || state.in_xor == state.out_xor {
                continue;
            }
            self.detach(state.in_xor);
            self.detach(state.out_xor);
            let (left, right) = (self.links[state.in_xor as usize], self.links[state.out_xor as usize]);
            let label = match (self.labels[left.label as usize], self.labels[right.label as usize]) {
                (Label::Wire(_), _) => right.label,
                (_, Label::Wire(_)) => left.label,
                _ => self.label(Label::Series(left.label, right.label)),
            };
            self.insert(Link { tail: left.tail, head: right.head, order: left.order, label });
        }
    }

    /// The link between two nodes if it is the only one at both inner ends.
    fn only_link(&self, tail: u32, head: u32) -> Option<Link> {
        let link = self.links[*self.between.get(&(tail, head))? as usize];
        let alone = (tail == Nodes::LEFT || self.states[tail as usize].outs == 1)
            && (head == Nodes::RIGHT || self.states[head as usize].ins == 1);
        alone.then_some(link)
    }

    fn is_reduced(&self) -> bool {
        let pins = self.nodes.sides.iter().filter(|side| side.node > Nodes::RIGHT).count();
        self.between.len() == pins + 1 && self.between.contains_key(&(Nodes::LEFT, Nodes::RIGHT))
    }

    fn shape(self, graph: &Graph) -> Result<Shape, NotSeriesParallel> {
        if !self.is_reduced() {
            return Err(match self.shared_pin() {
                Some(element) => NotSeriesParallel::SharedPin(element),
                None => NotSeriesParallel::Bridge(Box::new(bridge::find(&self, graph))),
            });
        }
        match self.only_link(Nodes::LEFT, Nodes::RIGHT) {
            Some(link) => self.build(link.label, 0),
            None => Err(NotSeriesParallel::Empty),
        }
    }

    /// A function block one of whose further pins is not on a line of its own.
    fn shared_pin(&self) -> Option<ElementId> {
        let shared = self.nodes.sides.iter().find(|side| {
            let state = self.states[side.node as usize];
            let own_line = match side.input {
                true => side.node == Nodes::LEFT || self.only_link(Nodes::LEFT, side.node).is_some(),
                false => side.node == Nodes::RIGHT || self.only_link(side.node, Nodes::RIGHT).is_some(),
            };
            !own_line || side.node > Nodes::RIGHT && state.ins + state.outs > 1
        });
        shared.map(|side| side.element)
    }

    fn build(&self, label: LabelId, depth: usize) -> Result<Shape, NotSeriesParallel> {
        if depth > Shape::DEPTH_MAX {
            return Err(NotSeriesParallel::TooDeep);
        }
        let shapes = |labels: Vec<LabelId>| -> Result<Vec<Shape>, NotSeriesParallel> {
            labels.into_iter().map(|part| self.build(part, depth + 1)).collect()
        };
        Ok(match self.labels[label as usize] {
            Label::Wire(_) => Shape::Wire,
            Label::Series(..) => Shape::Series(shapes(self.series(label))?),
            Label::Parallel(..) => Shape::Parallel(shapes(self.branches(label))?),
            Label::Element(element) if self.nodes.sides_of(element).next().is_some() => {
                self.build_block(element, depth)?
            }
            Label::Element(element) => Shape::Element(element),
        })
    }

    fn build_block(&self, element: ElementId, depth: usize) -> Result<Shape, NotSeriesParallel> {
        let mut block = BlockShape { element, inputs: Vec::new(), outputs: Vec::new() };
        for side in self.nodes.sides_of(element) {
            let (tail, head) = if side.input { (Nodes::LEFT, side.node) } else { (side.node, Nodes::RIGHT) };
            let shape = match self.only_link(tail, head) {
                _ if tail == head => Shape::Wire,
                Some(link) => self.build(link.label, depth + 1)?,
                None => return Err(NotSeriesParallel::SharedPin(element)),
            };
            if side.input { &mut block.inputs } else { &mut block.outputs }.push((side.pin, shape));
        }
        Ok(Shape::Block(Box::new(block)))
    }

    /// The parts of a series, left to right.
    fn series(&self, label: LabelId) -> Vec<LabelId> {
        let mut stack = vec![label];
        let mut parts = Vec::new();
        while let Some(label) = stack.pop() {
            match self.labels[label as usize] {
                Label::Series(left, right) => stack.extend([right, left]),
                _ => parts.push(label),
            }
        }
        parts
    }

    /// The branches of a parallel, top to bottom.
    fn branches(&self, label: LabelId) -> Vec<LabelId> {
        let mut stack = vec![(0, label)];
        let mut branches = Vec::new();
        while let Some((order, label)) = stack.pop() {
            match self.labels[label as usize] {
                Label::Parallel(upper, lower) => stack.extend([lower, upper]),
                _ => branches.push((order, label)),
            }
        }
        branches.sort_by_key(|(order, _)| *order);
        branches.into_iter().map(|(_, label)| label).collect()
    }

    /// The elements of a label.
    fn elements(&self, label: LabelId) -> Vec<ElementId> {
        let mut stack = vec![label];
        let mut elements = Vec::new();
        while let Some(label) = stack.pop() {
            match self.labels[label as usize] {
                Label::Wire(_) => {}
                Label::Element(element) => elements.push(element),
                Label::Series(left, right) => stack.extend([right, left]),
                Label::Parallel(upper, lower) => stack.extend([lower.1, upper.1]),
            }
        }
        elements
    }
}
