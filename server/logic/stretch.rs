//! Stretches of an instruction list of IEC 61131-3 that can be read by themselves.
//!
//! What a rung is there can depend on the chunk before: a call belongs to the load of its output, a helper keeps power
//! for the load that follows, a jump skips the calculations behind it. A menu must not read a program unit of thousands
//! of rungs, so the stretch around the cursor begins and ends where none of these goes on. What it depends on in the
//! rest of the unit, names used there as well, is what [`Elsewhere`](super::Elsewhere) finds.

use super::from_iec::{end_of_line, is_fall_name, is_helper_name};
use crate::document::{Chunk, ChunkRef, DeclaredType, Document, Unit};
use crate::il::iec::{Condition, IecTree, Item, ItemKind};
use crate::target::iec::{ElementaryType, OperatorRole};
use crate::text::Span;

/// So many chunks behind the cursor are looked at.
pub const CHUNKS_BEHIND: usize = 24;
/// And so many bytes.
pub const BYTES_MAX: usize = 64 * 1024;
/// The place where a rung begins is looked for in so many chunks.
const CHUNKS_MAX: usize = 64;
/// So many calculations behind a jump are seen through; one behind more of them may be skipped.
const SKIPPED_MAX: usize = 32;

/// The bytes of the rung at a byte of `document`, with one rung before it and some behind it in its program unit;
/// nothing where no instructions are, or where rungs do not end.
pub fn around(document: &Document, offset: usize, unit: Unit) -> Option<Span> {
    let at = document.chunk_at(offset)?;
    if at.chunk.len() > BYTES_MAX || !at.chunk.iec()?.items.iter().any(is_instruction) {
        return None;
    }
    let mut start = at.start;
    let mut begins = begins_rung(document, start, unit.number).then_some(start);
    for _ in 0..CHUNKS_MAX {
        let Some(before) = document.chunk_before(start).filter(|before| before.start < start) else { break };
        if !before.chunk.iec()?.items.last().is_some_and(is_instruction) {
            break;
        }
        start = before.start;
        if begins_rung(document, start, unit.number) && begins.replace(start).is_some() {
            break;
        }
    }
    let start = begins?;
    let mut end = at.start + at.chunk.len();
    for number in 0.. {
        let next = document.chunk_at(end).filter(|next| next.start == end);
        let is_over = next.is_none_or(|next| !begins_with_instruction(next));
        let is_enough = number >= CHUNKS_BEHIND || end - start > BYTES_MAX;
        if is_over || is_enough && begins_rung(document, end, unit.number) {
            break;
        }
        if number > CHUNKS_BEHIND + CHUNKS_MAX || end - start > 2 * BYTES_MAX {
            return None;
        }
        end += next.map_or(0, |next| next.chunk.len());
    }
    Some(Span::new(start, end))
}

/// The bytes of the rungs that touch `part`, with the comments above the first one, where nothing but instructions of
/// one program unit stands; nothing where that is not so, or where rungs do not end.
pub fn holding(document: &Document, part: Span) -> Option<(Span, Unit)> {
    let at = document.chunk_at(part.start as usize)?;
    let unit = document.unit_at(at.start);
    let mut start = at.start;
    let mut chunks = 0;
    while !begins_rung(document, start, unit.number) {
        let before = document.chunk_before(start).filter(|before| before.start < start)?;
        chunks += 1;
        if chunks > CHUNKS_MAX || !before.chunk.iec()?.items.iter().all(is_instruction) {
            return None;
        }
        start = before.start;
    }
    let mut last = at;
    let end = loop {
        let items = &last.chunk.iec()?.items;
        let end = last.start + last.chunk.len();
        let is_far = end - start > BYTES_MAX;
        let next = document.chunk_at(end).filter(|next| next.start == end);
        if end > part.end as usize || next.is_none() {
            // The end of the unit may stand behind its last instruction.
            let declared = items.iter().skip_while(|item| is_instruction(item));
            let ends_unit = declared.clone().next().is_some();
            if !items.first().is_some_and(is_instruction) || declared.clone().any(is_instruction) {
                return None;
            }
            match next {
                Some(next) if next.chunk.pou_starts() == 0 => {
                    if ends_unit || begins_rung(document, end, unit.number) {
                        break behind_items(last)?;
                    }
                }
                _ => break end,
            }
        }
        if is_far || !items.iter().all(is_instruction) {
            return None;
        }
        last = next?;
    };
    // What stands between two rungs belongs to the second one.
    let before = document.chunk_before(start).filter(|before| before.start < start);
    let start = before.map_or(Some(start), behind_items)?;
    Some((Span::new(start, end), unit))
}

/// Where the line of the last item of a chunk ends, or a comment that begins on it.
fn behind_items(at: ChunkRef<'_>) -> Option<usize> {
    let tree = at.chunk.iec()?;
    let line_end = end_of_line(at.chunk.text(), tree.items.last()?.span.end as usize);
    let remarks = tree.comments.iter().chain(&tree.pragmas);
    let begun = remarks.filter(|remark| (remark.start as usize) < line_end);
    let end = begun.map(|remark| remark.end as usize).fold(line_end, usize::max);
    Some(at.start + end)
}

fn begins_with_instruction(at: ChunkRef<'_>) -> bool {
    at.chunk.iec().and_then(|tree| tree.items.first()).is_some_and(is_instruction)
}

/// Whether the byte is where a chunk starts with which no rung goes on that began before, in program unit `pou`.
/// May say no where one does begin.
pub fn begins_rung(document: &Document, offset: usize, pou: Option<usize>) -> bool {
    if offset >= document.len() {
        return offset == document.len();
    }
    let Some(at) = document.chunk_at(offset).filter(|at| at.start == offset) else { return false };
    let Some(before) = document.chunk_before(offset).filter(|before| before.start < offset) else {
        return true;
    };
    let (Some(tree), Some(tree_before)) = (at.chunk.iec(), before.chunk.iec()) else { return false };
    let (Some(first), Some(last)) = (tree.items.first(), tree_before.items.last()) else { return false };
    if !is_instruction(first) || !is_instruction(last) {
        return true;
    }
    let is_parted = are_parted(before.chunk, at.chunk);
    let finds_falls = |item: &Item, tree: &IecTree, chunk: &Chunk| match item.kind {
        ItemKind::Operation { operand: Some(id), .. } => is_fall_name(tree.operand(id).span.of(chunk.text())),
        _ => false,
    };
    let goes_on = is_call(last)
        || loads_helper(first, tree, at.chunk.text())
        || finds_falls(last, tree_before, before.chunk)
        || finds_falls(first, tree, at.chunk);
    (is_parted || !goes_on) && !may_be_skipped(document, before, pou)
}

/// Whether a comment or a blank line stands between the instructions of two chunks, one directly behind the other.
pub(super) fn are_parted(before: &Chunk, at: &Chunk) -> bool {
    let (Some(tree_before), Some(tree)) = (before.iec(), at.iec()) else { return true };
    let (Some(last), Some(first)) = (tree_before.items.last(), tree.items.first()) else { return true };
    let between = [
        before.text().get(last.span.end as usize..).unwrap_or_default(),
        at.text().get(..first.span.start as usize).unwrap_or_default(),
    ];
    between.iter().map(|text| text.matches('\n').count()).sum::<usize>() > 1
        || tree_before.comments.last().is_some_and(|comment| comment.start >= last.span.end)
        || tree.comments.first().is_some_and(|comment| comment.start < first.span.start)
}

fn is_call(item: &Item) -> bool {
    matches!(item.kind, ItemKind::Call { condition: Condition::Always, .. })
}

fn loads_helper(item: &Item, tree: &IecTree, text: &str) -> bool {
    match item.kind {
        ItemKind::Operation { operation, operand: Some(id) } => {
            operation.operator.role == OperatorRole::Load && is_helper_name(tree.operand(id).span.of(text))
        }
        _ => is_call(item),
    }
}

/// Whether a jump before the end of this chunk may skip what follows it: calculations alone stand between.
fn may_be_skipped(document: &Document, before: ChunkRef<'_>, pou: Option<usize>) -> bool {
    let mut at = before;
    for _ in 0..SKIPPED_MAX {
        let Some(tree) = at.chunk.iec() else { return false };
        let jumps = |item: &Item| matches!(item.kind, ItemKind::Jump { condition: Condition::IfFalse, .. });
        if tree.items.iter().any(jumps) {
            return true;
        }
        if !may_calculate(document, tree, at.chunk.text(), pou) {
            return false;
        }
        match document.chunk_before(at.start).filter(|before| before.start < at.start) {
            Some(before) => at = before,
            None => return false,
        }
    }
    true
}

/// Whether the chunk may be calculations with words: a load, perhaps an operation, and a store of something else than a
/// bit; or calls of functions.
fn may_calculate(document: &Document, tree: &IecTree, text: &str, pou: Option<usize>) -> bool {
    let Some(ItemKind::Operation { operation, operand: Some(id) }) = tree.items.last().map(|item| item.kind)
    else {
        return false;
    };
    let result = tree.operand(id).span.of(text);
    let is_bit = || {
        let kind = document.scopes().type_of(pou, result);
        kind == Some(DeclaredType::Elementary(ElementaryType::Bool))
    };
    let calls = tree.items.iter().any(|item| matches!(item.kind, ItemKind::Function { .. }));
    operation.operator.role == OperatorRole::Store && (calls || tree.items.len() <= 3 && !is_bit())
}

/// Whether an item is an instruction or a label, and no declaration.
pub fn is_instruction(item: &Item) -> bool {
    use ItemKind::*;
    matches!(
        item.kind,
        Label { .. }
            | Operation { .. }
            | Open { .. }
            | Close
            | Jump { .. }
            | Return { .. }
            | Call { .. }
            | Function { .. }
            | InputOperator { .. }
            | ParameterOpen { .. }
    )
}
