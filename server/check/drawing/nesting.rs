//! How many blocks and branches a drawn rung needs at once when the PLC evaluates it: it runs as Instruction List.
//!
//! Of parts in series or in parallel the first is loaded; a single contact joins it at once, anything else is a block
//! of its own that waits for `ANB` or `ORB`. Between outputs, a branch with conditions is kept by `MPS`.

use super::Drawn;
use crate::check::ChunkContext;
use crate::ladder::reduce::{Shape, reduce};
use crate::ladder::{ElementId, Graph};
use crate::text::{Diagnostic, Message};

/// Reports as `code` the rungs of a drawing that need more blocks or branches than the PLC has.
pub(in crate::check) fn find(code: &'static str, context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some(drawn) = Drawn::of(context).filter(|drawn| drawn.target.is_fx()) else { return };
    let limits = &drawn.target.limits;
    for rung in drawn.sound_rungs() {
        let graph = &rung.graph;
        // Each level takes an element at least.
        if graph.elements.len() <= limits.blocks.min(limits.branches) as usize {
            continue;
        }
        let Ok(shape) = reduce(graph) else { continue };
        let mut depth = Depth { graph, blocks: limits.blocks, branches: limits.branches, found: None };
        depth.walk(&shape, 1, 0);
        let Some((element, key)) = depth.found else { continue };
        let element = graph.element(element);
        let limit = if key == BLOCKS { limits.blocks } else { limits.branches };
        let message = Message::new(key).with("limit", limit).with("element", drawn.name(element));
        found.push(Diagnostic::new(code, element.span, message));
    }
}

const BLOCKS: &str = "nesting-too-deep.drawn-blocks";
const BRANCHES: &str = "nesting-too-deep.drawn-branches";

struct Depth<'g> {
    graph: &'g Graph,
    blocks: u32,
    branches: u32,
    /// The first element that is nested too deep.
    found: Option<(ElementId, &'static str)>,
}

impl Depth<'_> {
    /// Goes through a part; `blocks` have been loaded with it, `branches` are open.
    fn walk(&mut self, shape: &Shape, blocks: u32, branches: u32) {
        let key = match (blocks > self.blocks, branches > self.branches) {
            (true, _) => Some(BLOCKS),
            (_, true) => Some(BRANCHES),
            _ => None,
        };
        if let Some(key) = key {
            self.found = self.found.or_else(|| Some((*shape.elements().first()?, key)));
        }
        if self.found.is_some() {
            return;
        }
        match shape {
            Shape::Parallel(parts) if self.drives(shape) => {
                let conditional = |part: &Shape| !matches!(part, Shape::Element(_) | Shape::Wire);
                for (number, part) in parts.iter().enumerate() {
                    let kept = conditional(part) && number + 1 < parts.len();
                    self.walk(part, blocks, branches + u32::from(kept));
                }
            }
            Shape::Series(parts) | Shape::Parallel(parts) => {
                for (number, part) in parts.iter().enumerate() {
                    let joins = number == 0 || matches!(part, Shape::Element(_) | Shape::Wire);
                    let own = if joins || self.drives(part) { blocks } else { blocks + 1 };
                    self.walk(part, own, branches);
                }
            }
            Shape::Element(_) | Shape::Block(_) | Shape::Wire => {}
        }
    }

    /// Whether there is an output in a part.
    fn drives(&self, shape: &Shape) -> bool {
        // Outputs come last, so the last part tells.
        match shape {
            Shape::Series(parts) => parts.last().is_some_and(|part| self.drives(part)),
            Shape::Parallel(parts) => parts.iter().any(|part| self.drives(part)),
            Shape::Element(element) => self.graph.element(*element).is_output(),
            Shape::Block(_) | Shape::Wire => false,
        }
    }
}
