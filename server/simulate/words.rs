//! How an instruction is called where it is told of.

use crate::document::{Document, Tree};
use crate::ladder::ElementKind;
use crate::text::Span;

/// The words at a place of a program, with single blanks, up to the end of the first line; of a drawn element its
/// symbol and the names that stand above it: `( ) Y0`; of a box its type and the name of the instance: `TON Delay`.
pub fn instruction_words(document: &Document, span: Span) -> String {
    let text = document.slice(span);
    let line = text.lines().next().unwrap_or_default();
    let mut words: Vec<String> = line.split_whitespace().map(str::to_string).collect();
    if let Some(at) = document.chunk_at(span.start as usize) {
        let reading = at.chunk.reading();
        if let Tree::Ladder(tree) = reading.tree() {
            let elements = tree.rungs.iter().flat_map(|rung| &rung.graph.elements);
            let element = elements.into_iter().find(|element| element.span.shifted(at.start) == span);
            if let Some(ElementKind::Block(block)) = element.map(|element| &element.kind) {
                let instance = block.instance.map(|name| name.of(reading.text()));
                return block
                    .type_text(reading.text())
                    .into_iter()
                    .chain(instance)
                    .collect::<Vec<_>>()
                    .join(" ");
            }
            let operands = element.into_iter().flat_map(|element| &element.operands);
            let above = operands.filter(|operand| !span.touches(operand.span.start as usize + at.start));
            words.extend(above.map(|operand| operand.span.of(reading.text()).to_string()));
        }
    }
    words.join(" ")
}
