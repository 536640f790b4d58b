//! How a chunk's contacts, outputs and instructions are put together, as a number that others can compare.

use super::{Chunk, Tree};
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// Differs whenever a rung may do something else: another instruction, a wire
/// more, another constant. Comments do not count, nor do places in lists.
pub(super) fn of_chunk(chunk: &Chunk) -> u64 {
    let (text, mut hasher) = (chunk.text(), FxHasher::default());
    match chunk.tree() {
        Tree::Fx(tree) => tree.lines.iter().for_each(|line| line.span.of(text).hash(&mut hasher)),
        Tree::Iec(tree) => {
            tree.items.iter().for_each(|item| (item.depth, item.span.of(text)).hash(&mut hasher));
        }
        Tree::Ladder(tree) => {
            for rung in &tree.rungs {
                for arc in &rung.graph.arcs {
                    (arc.tail.0, arc.tail_pin, arc.head.0, arc.head_pin).hash(&mut hasher);
                }
                for element in &rung.graph.elements {
                    let operands = element.operands.iter().map(|operand| operand.span);
                    let words = operands.chain([element.span]).map(|span| span.of(text));
                    words.for_each(|word| word.hash(&mut hasher));
                }
            }
            chunk.boxes().iter().for_each(|(_, list)| of_chunk(list).hash(&mut hasher));
        }
    }
    hasher.finish()
}
