//! Whether two graphs say the same, however they are drawn.

use super::contract::{EdgeKind, Nodes};
use super::{Block, Element, ElementKind, Graph, Pin, PinWire};
use crate::target::Operand;
use std::collections::VecDeque;
use std::fmt::Write;

impl Graph {
    /// Whether both graphs have the same elements with the same operands in the same connections, branches in the
    /// same order. Where they stand, how wires bend and how operands are spelled makes no difference.
    /// The chunks are those from which the graphs were read; names are compared by their letters.
    pub fn same_logic(&self, chunk: &str, other: &Graph, other_chunk: &str) -> bool {
        self.logic_text(chunk) == other.logic_text(other_chunk)
    }

    /// The logic as text, one line for each way out of a node: equal for graphs with the [same
    /// logic](Graph::same_logic), and readable where they differ.
    pub fn logic_text(&self, chunk: &str) -> String {
        let nodes = Nodes::of(self);
        let mut walk = Walk { numbers: vec![None; nodes.nodes.len()], queue: VecDeque::new(), count: 0 };
        let mut text = String::new();
        walk.number(Nodes::LEFT);
        walk.number(Nodes::RIGHT);
        // Nodes that the rail does not feed come after, found from the nodes that they feed, then by their order.
        let mut unfed = 0;
        loop {
            while let Some(node) = walk.queue.pop_front() {
                self.write_node(&nodes, node, chunk, &mut walk, &mut text);
            }
            let fed_by = |node: &u32| {
                let lists = &nodes.nodes[*node as usize];
                let feeds = |edge: &u32| walk.numbers[nodes.edges[*edge as usize].head as usize].is_some();
                walk.numbers[*node as usize].is_none() && lists.outs.iter().any(feeds)
            };
            let known = (unfed..nodes.nodes.len() as u32).find(fed_by);
            let rest =
                || (unfed..nodes.nodes.len() as u32).find(|node| walk.numbers[*node as usize].is_none());
            match known.or_else(rest) {
                Some(node) => walk.number(node),
                None => return text,
            };
            while walk.numbers.get(unfed as usize).is_some_and(Option::is_some) {
                unfed += 1;
            }
        }
    }

    fn write_node(&self, nodes: &Nodes, node: u32, chunk: &str, walk: &mut Walk, text: &mut String) {
        let number = walk.number(node);
        if nodes.nodes[node as usize].loose {
            let _ = writeln!(text, "{number} loose");
        }
        for edge in &nodes.nodes[node as usize].outs {
            let edge = &nodes.edges[*edge as usize];
            let what = match &edge.kind {
                EdgeKind::Wire { .. } => "wire".to_string(),
                EdgeKind::Element(id) => self.element(*id).logic_text(chunk),
            };
            let _ = write!(text, "{number} {what}");
            if let EdgeKind::Element(id) = edge.kind {
                for side in nodes.sides_of(id) {
                    let way = if side.input { "from" } else { "to" };
                    let _ = write!(text, " [pin {} {way} {}]", side.pin, walk.number(side.node));
                }
            }
            let _ = writeln!(text, " > {}", walk.number(edge.head));
        }
    }
}

/// Numbers of nodes in the order in which they are met.
struct Walk {
    numbers: Vec<Option<u32>>,
    queue: VecDeque<u32>,
    count: u32,
}

impl Walk {
    fn number(&mut self, node: u32) -> u32 {
        if let Some(number) = self.numbers[node as usize] {
            return number;
        }
        let number = self.count;
        self.count += 1;
        self.numbers[node as usize] = Some(number);
        self.queue.push_back(node);
        number
    }
}

impl Element {
    /// Kind and operands, values by value and names by their letters.
    fn logic_text(&self, chunk: &str) -> String {
        let mut text = match &self.kind {
            ElementKind::Instruction { form: None, mnemonic } => mnemonic.of(chunk).to_uppercase(),
            ElementKind::Instruction { form: Some(form), .. } => form.mnemonic(),
            ElementKind::Jump(label) => format!("Jump {}", label.of(chunk)),
            ElementKind::ConnectorOut(name) => format!("ConnectorOut {}", name.of(chunk)),
            ElementKind::ConnectorIn(name) => format!("ConnectorIn {}", name.of(chunk)),
            ElementKind::Block(block) => return self.block_text(block, chunk),
            kind => format!("{kind:?}"),
        };
        for index in 0..self.operands.len() {
            let _ = write!(text, " {}", self.operand_logic(index, chunk));
        }
        text
    }

    fn operand_logic(&self, index: usize, chunk: &str) -> String {
        let word = self.operand_text(index, chunk);
        match self.operands.get(index).map(|operand| operand.value) {
            Some(Operand::Variable) => word.to_uppercase(),
            Some(Operand::Text | Operand::Literal(_) | Operand::Invalid(_)) | None => word.into_owned(),
            Some(value) => format!("{value:?}"),
        }
    }

    /// Pins with what is connected to them; the order in which operands were found makes no difference.
    fn block_text(&self, block: &Block, chunk: &str) -> String {
        let pin = |pin: &Pin| {
            let wire = match pin.wire {
                PinWire::Operand(index) => format!("={}", self.operand_logic(index, chunk)),
                PinWire::Power => "-".to_string(),
                PinWire::Open => String::new(),
            };
            format!("{}{}{wire}", pin.formal(chunk), if pin.negated { "!" } else { "" })
        };
        let pins = |pins: &[Pin]| pins.iter().map(pin).collect::<Vec<_>>().join(",");
        let instance = block.instance.map_or("", |span| span.of(chunk));
        let type_name = block.type_text(chunk).unwrap_or("");
        format!("Block {instance}:{type_name}({};{})", pins(&block.inputs), pins(&block.outputs))
    }
}
