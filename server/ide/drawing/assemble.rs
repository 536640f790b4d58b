//! From a shape back to a graph: what an edited rung is to say, before it is drawn.

use crate::ladder::reduce::{BlockShape, Shape};
use crate::ladder::{Element, ElementId, ElementKind, Graph, Pin, PinWire, VertexId, VertexKind};

/// A shape with the elements that it names; the words of the elements stand in a text that the maker knows.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub shape: Shape,
    pub elements: Vec<Element>,
}

impl Plan {
    /// The plan without the elements that its shape no longer names. `watched` are followed to their new numbers.
    pub fn compacted(self, watched: &mut [ElementId]) -> Plan {
        let mut order = self.shape.elements();
        order.sort_unstable();
        order.dedup();
        let new_id = |id: ElementId| ElementId(order.partition_point(|other| *other < id) as u32);
        let elements = order.iter().filter_map(|id| self.elements.get(id.0 as usize).cloned()).collect();
        watched.iter_mut().for_each(|id| *id = new_id(*id));
        Plan { shape: renumbered(&self.shape, &new_id), elements }
    }

    /// The graph that the shape stands for.
    pub fn graph(&self) -> Graph {
        let mut graph = Graph::new();
        let vertices = self.elements.iter().map(|element| graph.add_element(element.clone())).collect();
        let mut assembly = Assembly { graph, vertices };
        assembly.add(&self.shape, (Graph::LEFT_RAIL, 0), Some((Graph::RIGHT_RAIL, 0)));
        assembly.graph
    }
}

fn renumbered(shape: &Shape, new_id: &impl Fn(ElementId) -> ElementId) -> Shape {
    let all = |shapes: &[Shape]| shapes.iter().map(|shape| renumbered(shape, new_id)).collect();
    let sides =
        |sides: &[(u16, Shape)]| sides.iter().map(|(pin, shape)| (*pin, renumbered(shape, new_id))).collect();
    match shape {
        Shape::Series(parts) => Shape::Series(all(parts)),
        Shape::Parallel(branches) => Shape::Parallel(all(branches)),
        Shape::Element(element) => Shape::Element(new_id(*element)),
        Shape::Block(block) => Shape::Block(Box::new(BlockShape {
            element: new_id(block.element),
            inputs: sides(&block.inputs),
            outputs: sides(&block.outputs),
        })),
        Shape::Wire => Shape::Wire,
    }
}

/// A place to which a wire can be joined: a vertex and its pin.
type End = (VertexId, u16);

struct Assembly {
    graph: Graph,
    vertices: Vec<VertexId>,
}

impl Assembly {
    /// Adds a part from one end to another, which is a new junction where none is given. Returns the other end.
    fn add(&mut self, part: &Shape, from: End, to: Option<End>) -> End {
        match part {
            Shape::Wire => {
                let to = to.unwrap_or_else(|| self.junction());
                self.graph.add_arc(from, to, &[]);
                to
            }
            Shape::Element(element) => self.element(*element, from, to),
            Shape::Block(block) => {
                let end = self.element(block.element, from, to);
                let vertex = self.vertex(block.element);
                for (pin, shape) in &block.inputs {
                    self.add(shape, (Graph::LEFT_RAIL, 0), Some((vertex, *pin)));
                }
                for (pin, shape) in &block.outputs {
                    self.add(shape, (vertex, *pin), Some((Graph::RIGHT_RAIL, 0)));
                }
                end
            }
            Shape::Series(parts) => {
                let mut at = from;
                for (number, part) in parts.iter().enumerate() {
                    at = self.add(part, at, if number + 1 == parts.len() { to } else { None });
                }
                at
            }
            Shape::Parallel(branches) => {
                // An element has one wire on each side: branches start at a junction behind it.
                let open = match self.graph.vertex(from.0).kind {
                    VertexKind::Element(_) => {
                        let junction = self.junction();
                        self.graph.add_arc(from, junction, &[]);
                        junction
                    }
                    _ => from,
                };
                let close = to.unwrap_or_else(|| self.junction());
                // An element has one wire on each side here, too.
                let meet = match self.graph.vertex(close.0).kind {
                    VertexKind::Element(_) => self.junction(),
                    _ => close,
                };
                branches.iter().for_each(|branch| {
                    self.add(branch, open, Some(meet));
                });
                if meet != close {
                    self.graph.add_arc(meet, close, &[]);
                }
                close
            }
        }
    }

    fn junction(&mut self) -> End {
        (self.graph.add_vertex(VertexKind::Junction, &[]), 0)
    }

    fn vertex(&self, element: ElementId) -> VertexId {
        self.vertices.get(element.0 as usize).copied().unwrap_or(Graph::LEFT_RAIL)
    }

    fn element(&mut self, id: ElementId, from: End, to: Option<End>) -> End {
        let vertex = self.vertex(id);
        let kind = self.graph.element_at(vertex).map(|element| &element.kind);
        let block = match kind {
            Some(ElementKind::Block(block)) => Some((main_pin(&block.inputs), main_pin(&block.outputs))),
            _ => None,
        };
        let (input, output) = block.unwrap_or((0, 0));
        let starts = kind.is_some_and(ElementKind::is_source);
        let ends = kind.is_some_and(ElementKind::is_sink);
        if !starts {
            self.graph.add_arc(from, (vertex, input), &[]);
        }
        let own_end = (vertex, output);
        match to {
            Some(to) if ends => to,
            Some(to) => {
                self.graph.add_arc(own_end, to, &[]);
                to
            }
            None => own_end,
        }
    }
}

/// The first wired pin of a side of a block; of one without such a pin no wire comes.
fn main_pin(pins: &[Pin]) -> u16 {
    pins.iter().position(|pin| pin.wire == PinWire::Power).map_or(0, |pin| pin as u16)
}
