//! The graph of a rung as electrical nodes.
//!
//! A node is everything that wires join without changing what flows: bends, chains of junctions, the sides of
//! elements. An edge is an element, or one of the few wires that cannot be contracted, because they run beside
//! another path (a short circuit) or across (a bridge). Two drawings of the same logic contract to the same nodes.

use super::{ArcId, ElementId, Graph, VertexId, VertexKind};
use rustc_hash::FxHashMap;

/// Electrical nodes and the edges between them.
#[derive(Debug, Default)]
pub(super) struct Nodes {
    /// Nodes; [`Nodes::LEFT`] and [`Nodes::RIGHT`] are the rails.
    pub nodes: Vec<Node>,
    /// Edges, those of one tail together and top to bottom.
    pub edges: Vec<Edge>,
    /// Wired pins of function blocks besides the main input and the main output.
    pub sides: Vec<Side>,
}

/// One electrical node.
#[derive(Debug, Default)]
pub(super) struct Node {
    /// Edges that leave it, top to bottom.
    pub outs: Vec<u32>,
    /// Edges that enter it, top to bottom.
    pub ins: Vec<u32>,
    /// The junctions and rails contracted to it.
    pub vertices: Vec<VertexId>,
    /// A wire's loose end.
    pub loose: bool,
}

/// One edge.
#[derive(Debug)]
pub(super) struct Edge {
    pub tail: u32,
    pub head: u32,
    pub kind: EdgeKind,
}

/// What an edge is.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum EdgeKind {
    /// A bare wire: its arcs from left to right, with the bends between them.
    Wire { arcs: Vec<ArcId>, bends: Vec<VertexId> },
    /// An element, from its main input to its main output.
    Element(ElementId),
}

/// A wired pin of a function block besides the main ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub element: ElementId,
    pub pin: u16,
    pub input: bool,
    pub node: u32,
}

impl Nodes {
    pub const LEFT: u32 = 0;
    pub const RIGHT: u32 = 1;

    /// Contracts `graph`; linear in its size.
    pub fn of(graph: &Graph) -> Nodes {
        // A default graph has not even rails.
        if graph.vertices.len() < 2 {
            return Nodes { nodes: vec![Node::default(), Node::default()], ..Nodes::default() };
        }
        let mut raw = Raw::of(graph);
        raw.straighten_bends();
        raw.mark_contractions();
        raw.contract()
    }

    /// The wired pins of `element` besides the main ones.
    pub fn sides_of(&self, element: ElementId) -> impl Iterator<Item = &Side> {
        let start = self.sides.partition_point(|side| side.element < element);
        self.sides[start..].iter().take_while(move |side| side.element == element)
    }
}

/// How a wire is contracted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Contraction {
    /// It stays.
    None,
    /// Its head has no other feed and joins the tail.
    IntoTail,
    /// Its tail has no other way out and joins the head.
    IntoHead,
}

/// Nodes before contraction: one for each junction, rail, loose end and pin.
struct Raw {
    nodes: Vec<Node>,
    edges: Vec<Edge>,
    sides: Vec<Side>,
    contraction: Vec<Contraction>,
}

impl Raw {
    fn of(graph: &Graph) -> Raw {
        let mut raw =
            Raw { nodes: Vec::new(), edges: Vec::new(), sides: Vec::new(), contraction: Vec::new() };
        // Rails come first in every graph, so their raw nodes are those of `Nodes`.
        let mut plain = vec![u32::MAX; graph.vertices.len()];
        for id in graph.vertex_ids() {
            let kind = graph.vertex(id).kind;
            if !matches!(kind, VertexKind::Element(_)) {
                plain[id.0 as usize] = raw.node(vec![id], kind == VertexKind::LooseEnd);
            }
        }
        let mut inputs: FxHashMap<(VertexId, u16), u32> = FxHashMap::default();
        let mut outputs: FxHashMap<(VertexId, u16), u32> = FxHashMap::default();
        for id in graph.vertex_ids() {
            if let VertexKind::Element(element) = graph.vertex(id).kind {
                raw.element(graph, id, element, &mut inputs, &mut outputs);
            }
        }
        let mut edge_of_arc = vec![u32::MAX; graph.arcs.len()];
        for (number, arc) in graph.arcs.iter().enumerate() {
            let tail = outputs.get(&(arc.tail, arc.tail_pin)).copied();
            let head = inputs.get(&(arc.head, arc.head_pin)).copied();
            let tail = tail.unwrap_or(plain[arc.tail.0 as usize]);
            let head = head.unwrap_or(plain[arc.head.0 as usize]);
            edge_of_arc[number] = raw.edges.len() as u32;
            let kind = EdgeKind::Wire { arcs: vec![ArcId(number as u32)], bends: Vec::new() };
            raw.edges.push(Edge { tail, head, kind });
        }
        // The lists of a vertex give the order, which the numbers of arcs need not.
        for id in graph.vertex_ids() {
            for arc in graph.outgoing(id) {
                let edge = edge_of_arc[arc.0 as usize];
                let tail = raw.edges[edge as usize].tail;
                raw.nodes[tail as usize].outs.push(edge);
            }
            for arc in graph.incoming(id) {
                let edge = edge_of_arc[arc.0 as usize];
                let head = raw.edges[edge as usize].head;
                raw.nodes[head as usize].ins.push(edge);
            }
        }
        raw.sort_sources(graph);
        raw
    }

    fn node(&mut self, vertices: Vec<VertexId>, loose: bool) -> u32 {
        self.nodes.push(Node { vertices, loose, ..Node::default() });
        self.nodes.len() as u32 - 1
    }

    /// Adds the edge of an element and the nodes of its pins. The main pins are the first wired ones.
    fn element(
        &mut self,
        graph: &Graph,
        vertex: VertexId,
        element: ElementId,
        inputs: &mut FxHashMap<(VertexId, u16), u32>,
        outputs: &mut FxHashMap<(VertexId, u16), u32>,
    ) {
        let kind = &graph.element(element).kind;
        let mut input_pins: Vec<u16> = graph.incoming(vertex).map(|arc| graph.arc(arc).head_pin).collect();
        let mut output_pins: Vec<u16> = graph.outgoing(vertex).map(|arc| graph.arc(arc).tail_pin).collect();
        for pins in [&mut input_pins, &mut output_pins] {
            pins.sort_unstable();
            pins.dedup();
        }
        let tail = match input_pins.is_empty() && kind.is_source() {
            true => Nodes::LEFT,
            false => self.node(Vec::new(), false),
        };
        let head = match output_pins.is_empty() && kind.is_sink() {
            true => Nodes::RIGHT,
            false => self.node(Vec::new(), false),
        };
        let edge = self.edges.len() as u32;
        self.edges.push(Edge { tail, head, kind: EdgeKind::Element(element) });
        self.nodes[tail as usize].outs.push(edge);
        self.nodes[head as usize].ins.push(edge);
        for (pins, input, main) in [(input_pins, true, tail), (output_pins, false, head)] {
            for (number, pin) in pins.into_iter().enumerate() {
                let node = if number == 0 { main } else { self.node(Vec::new(), false) };
                if number > 0 {
                    self.sides.push(Side { element, pin, input, node });
                }
                let nodes = if input { &mut *inputs } else { &mut *outputs };
                nodes.insert((vertex, pin), node);
            }
        }
    }

    /// Puts elements without a wire to the left rail among its wires, by their place in the text.
    /// Graphs that were not drawn have no places and keep the order of their lists.
    fn sort_sources(&mut self, graph: &Graph) {
        let outs = std::mem::take(&mut self.nodes[Nodes::LEFT as usize].outs);
        let place = |edge: &u32| match &self.edges[*edge as usize].kind {
            EdgeKind::Element(element) => Some(graph.element(*element).span.start),
            EdgeKind::Wire { arcs, .. } => {
                arcs.first().and_then(|arc| graph.cells(graph.arc(*arc).cells).first()).map(|cell| cell.start)
            }
        };
        let mut placed: Vec<(Option<u32>, u32)> = outs.iter().map(|edge| (place(edge), *edge)).collect();
        let elements =
            outs.iter().any(|edge| matches!(self.edges[*edge as usize].kind, EdgeKind::Element(_)));
        if elements && placed.iter().all(|(place, _)| place.is_some()) {
            placed.sort();
        }
        self.nodes[Nodes::LEFT as usize].outs = placed.into_iter().map(|(_, edge)| edge).collect();
    }

    /// Joins the two wires of every junction that has just these, so that only real junctions remain.
    fn straighten_bends(&mut self) {
        let bends: Vec<bool> = (self.nodes.iter().enumerate())
            .map(|(id, node)| {
                let junction = id > Nodes::RIGHT as usize && !node.vertices.is_empty() && !node.loose;
                junction && node.ins.len() == 1 && node.outs.len() == 1
            })
            .collect();
        let mut replaced: FxHashMap<u32, u32> = FxHashMap::default();
        for edge in 0..self.edges.len() {
            if bends[self.edges[edge].tail as usize] {
                continue;
            }
            let mut last = edge;
            let mut joined = (Vec::new(), Vec::new());
            while bends[self.edges[last].head as usize] {
                let bend = self.edges[last].head as usize;
                last = self.nodes[bend].outs[0] as usize;
                if let EdgeKind::Wire { arcs, .. } = &self.edges[last].kind {
                    joined.0.extend_from_slice(arcs);
                }
                joined.1.append(&mut self.nodes[bend].vertices);
            }
            if last != edge {
                self.edges[edge].head = self.edges[last].head;
                replaced.insert(last as u32, edge as u32);
                if let EdgeKind::Wire { arcs, bends } = &mut self.edges[edge].kind {
                    arcs.append(&mut joined.0);
                    bends.append(&mut joined.1);
                }
            }
        }
        for (id, node) in self.nodes.iter_mut().enumerate() {
            if bends[id] {
                *node = Node::default();
            }
            for edge in &mut node.ins {
                *edge = replaced.get(edge).copied().unwrap_or(*edge);
            }
        }
    }

    /// Decides for every wire whether its ends are one node.
    ///
    /// A head without other feed is on exactly when its tail is; a tail without other way out feeds exactly what
    /// its head feeds. With bends gone no node is both, so contractions never join the rails.
    fn mark_contractions(&mut self) {
        let contraction = self.edges.iter().map(|edge| {
            let (tail, head) = (&self.nodes[edge.tail as usize], &self.nodes[edge.head as usize]);
            if matches!(edge.kind, EdgeKind::Element(_)) || tail.loose || head.loose {
                Contraction::None
            } else if edge.head != Nodes::RIGHT && head.ins.len() == 1 {
                Contraction::IntoTail
            } else if edge.tail != Nodes::LEFT && tail.outs.len() == 1 {
                Contraction::IntoHead
            } else {
                Contraction::None
            }
        });
        self.contraction = contraction.collect();
    }

    /// The node that stands for `node` after contraction, found by walking along contracted wires.
    fn roots(&self) -> Vec<u32> {
        let mut roots = vec![u32::MAX; self.nodes.len()];
        let mut path = Vec::new();
        for start in 0..self.nodes.len() as u32 {
            let mut node = start;
            while roots[node as usize] == u32::MAX {
                path.push(node);
                let lists = &self.nodes[node as usize];
                let is = |edge: &&u32, kind| self.contraction[**edge as usize] == kind;
                let up = lists.ins.iter().find(|edge| is(edge, Contraction::IntoTail));
                let down = lists.outs.iter().find(|edge| is(edge, Contraction::IntoHead));
                match (up, down) {
                    (Some(edge), _) => node = self.edges[*edge as usize].tail,
                    (None, Some(edge)) => node = self.edges[*edge as usize].head,
                    (None, None) => break,
                }
                // Power flows left to right, so a path is no longer than the nodes; a graph that is not so
                // must not hang the editor.
                if path.len() > self.nodes.len() {
                    break;
                }
            }
            let root = if roots[node as usize] == u32::MAX { node } else { roots[node as usize] };
            for node in path.drain(..) {
                roots[node as usize] = root;
            }
        }
        roots
    }

    fn contract(mut self) -> Nodes {
        let roots = self.roots();
        let mut number = vec![u32::MAX; self.nodes.len()];
        let mut contracted = Nodes::default();
        for (id, node) in self.nodes.iter().enumerate() {
            let rail = id <= Nodes::RIGHT as usize;
            let used = rail || !node.vertices.is_empty() || !node.ins.is_empty() || !node.outs.is_empty();
            if roots[id] == id as u32 && used {
                number[id] = contracted.nodes.len() as u32;
                contracted.nodes.push(Node { loose: node.loose, ..Node::default() });
            }
        }
        let mut edge_number = vec![u32::MAX; self.edges.len()];
        let end = |node: u32| number[roots[node as usize] as usize];
        for id in 0..self.nodes.len() as u32 {
            if roots[id as usize] != id || number[id as usize] == u32::MAX {
                continue;
            }
            let node = number[id as usize] as usize;
            for edge in self.list(id, false) {
                edge_number[edge as usize] = contracted.edges.len() as u32;
                contracted.nodes[node].outs.push(contracted.edges.len() as u32);
                let Edge { tail, head, kind } = &mut self.edges[edge as usize];
                // Each edge leaves one node, so nobody else asks for its kind.
                let kind = std::mem::replace(kind, EdgeKind::Wire { arcs: Vec::new(), bends: Vec::new() });
                contracted.edges.push(Edge { tail: end(*tail), head: end(*head), kind });
            }
        }
        for id in 0..self.nodes.len() as u32 {
            if roots[id as usize] == id && number[id as usize] != u32::MAX {
                let ins = self.list(id, true).into_iter().map(|edge| edge_number[edge as usize]);
                contracted.nodes[number[id as usize] as usize].ins =
                    ins.filter(|edge| *edge != u32::MAX).collect();
            }
        }
        for (id, node) in self.nodes.iter().enumerate() {
            if end(id as u32) != u32::MAX {
                contracted.nodes[end(id as u32) as usize].vertices.extend_from_slice(&node.vertices);
            }
        }
        contracted.sides = self.sides.iter().map(|side| Side { node: end(side.node), ..*side }).collect();
        contracted
    }

    /// The edges that leave (or enter) the node whose root is `root`, contracted wires replaced by what they lead
    /// to, so that the order stays top to bottom. Every edge is walked once over all roots.
    fn list(&self, root: u32, ins: bool) -> Vec<u32> {
        let list = |node: u32| {
            let lists = &self.nodes[node as usize];
            if ins { &lists.ins } else { &lists.outs }
        };
        let direct = list(root);
        if direct.iter().all(|edge| self.contraction[*edge as usize] == Contraction::None) {
            return direct.clone();
        }
        let mut stack: Vec<u32> = direct.iter().rev().copied().collect();
        let mut edges = Vec::with_capacity(direct.len());
        while let Some(edge) = stack.pop() {
            let Edge { tail, head, .. } = self.edges[edge as usize];
            match (self.contraction[edge as usize], ins) {
                (Contraction::IntoTail, false) => stack.extend(list(head).iter().rev()),
                (Contraction::IntoHead, true) => stack.extend(list(tail).iter().rev()),
                (Contraction::None, _) => edges.push(edge),
                // The other direction leads out of the root only where the graph is not a ladder's.
                (Contraction::IntoHead, false) | (Contraction::IntoTail, true) => {}
            }
        }
        edges
    }
}
