//! Selection ranges: what grows around the cursor. In a drawing name, element, branch, rung, network; in instruction
//! list operand, instruction, rung, program unit; then the document.

use super::drawing;
use crate::document::{Document, Tree};
use crate::text::Span;

/// The ranges around a byte, smallest first, each inside the next and none twice.
pub(super) fn around(document: &Document, offset: usize) -> Vec<Span> {
    let offset = offset.min(document.len());
    let mut ranges = match document.chunk_at(offset) {
        Some(at) => match at.chunk.tree() {
            Tree::Ladder(_) => drawing::ranges::around(document, offset),
            Tree::Fx(_) | Tree::Iec(_) => in_list(at.chunk.text(), at.chunk.tree(), at.start, offset),
        },
        None => Vec::new(),
    };
    ranges.extend(unit_around(document, offset));
    ranges.push(Span::new(0, document.len()));
    let mut nested: Vec<Span> = Vec::with_capacity(ranges.len());
    for range in ranges.into_iter().filter(|range| range.touches(offset)) {
        let range = nested.last().map_or(range, |inner| inner.to(range));
        if nested.last() != Some(&range) {
            nested.push(range);
        }
    }
    nested
}

/// Operand, instruction and chunk.
fn in_list(text: &str, tree: &Tree, start: usize, offset: usize) -> Vec<Span> {
    let inside = offset - start;
    let operands: Vec<Span> = match tree {
        Tree::Fx(tree) => tree.operands.iter().map(|operand| operand.span).collect(),
        Tree::Iec(tree) => {
            tree.operands.iter().map(|operand| operand.span).chain(tree.names.clone()).collect()
        }
        Tree::Ladder(_) => Vec::new(),
    };
    let touched = operands.into_iter().filter(|span| span.touches(inside) && !span.is_empty());
    let mut ranges: Vec<Span> = touched.min_by_key(|span| span.len()).into_iter().collect();
    let statement = match tree {
        Tree::Fx(tree) => tree.line_at(inside).map(|line| line.span),
        Tree::Iec(tree) => {
            let items = tree.items.iter().map(|item| item.span).filter(|span| span.touches(inside));
            items.min_by_key(|span| span.len())
        }
        Tree::Ladder(_) => None,
    };
    ranges.extend(statement);
    let before = text.len() - text.trim_start().len();
    ranges.push(Span::new(before, before + text.trim().len()));
    ranges.iter().map(|span| span.shifted(start)).collect()
}

/// The program unit around a byte, from its first chunk to its last.
fn unit_around(document: &Document, offset: usize) -> Option<Span> {
    let mut unit: Option<(usize, usize)> = None;
    for at in document.chunks() {
        let end = at.start + at.chunk.len();
        if at.chunk.pou_starts() > 0 {
            if unit.is_some_and(|(start, _)| start <= offset && at.start > offset) {
                break;
            }
            unit = Some((at.start, end));
        } else if let Some((_, unit_end)) = &mut unit {
            *unit_end = end;
        }
        let is_over = at.chunk.ends_inside_pou() == Some(false);
        if is_over {
            match unit {
                Some((start, end)) if start <= offset && offset < end => break,
                _ => unit = None,
            }
        }
    }
    let (start, end) = unit.filter(|(start, end)| *start <= offset && offset <= *end)?;
    let text = document.slice(Span::new(start, end));
    let blank = text.len() - text.trim_start().len();
    Some(Span::new(start + blank, start + blank + text.trim().len()))
}
