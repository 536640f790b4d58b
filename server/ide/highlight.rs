//! What belongs to the word under the cursor: all uses of a name, and the partners of a structure.

use super::names::{self, Thing};
use crate::document::{Chunk, ChunkRef, Document, Operation, Tree, Use};
use crate::il::iec::ItemKind;
use crate::target::{Flow, Operand, Role};
use crate::text::Span;

/// A word to be marked.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Highlight {
    /// Where.
    pub span: Span,
    /// What is done there.
    pub kind: HighlightKind,
}

/// What is done with a marked name.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum HighlightKind {
    /// It stands there: a declaration, a jump, a partner.
    Text,
    /// Its value is read.
    Read,
    /// Its value is written.
    Write,
}

pub(super) fn at(document: &Document, offset: usize) -> Vec<Highlight> {
    let mut marks = partners(document, offset).unwrap_or_else(|| uses(document, offset));
    marks.sort_unstable();
    marks.dedup_by_key(|mark| mark.span);
    marks
}

fn uses(document: &Document, offset: usize) -> Vec<Highlight> {
    let Some(named) = names::at(document, offset) else { return Vec::new() };
    let thing = match named.thing {
        // In `K4M0` the cursor stands at M0.
        Thing::Devices(device, _) => Thing::Devices(device, 1),
        thing => thing,
    };
    let mut marks = Vec::new();
    names::visit(document, &thing, |place| {
        let kind = match place.usage {
            Use::Declare | Use::Jump => HighlightKind::Text,
            usage if usage.writes() => HighlightKind::Write,
            _ => HighlightKind::Read,
        };
        marks.push(Highlight { span: place.span, kind });
    });
    marks
}

/// The instructions that belong to the one whose word is at `offset`, itself included; nothing for others.
fn partners(document: &Document, offset: usize) -> Option<Vec<Highlight>> {
    let found = document.chunk_at(offset)?;
    let inside = offset.checked_sub(found.start)?;
    let spans = match found.chunk.tree() {
        Tree::Iec(_) => in_iec(found, inside)?,
        _ => in_fx(document, found, inside)?,
    };
    Some(spans.into_iter().map(|span| Highlight { span, kind: HighlightKind::Text }).collect())
}

/// What opens, goes on with or closes a structure.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Part {
    Open,
    Middle,
    Close,
}

/// The structures with partners; master control sections know theirs by the nesting level.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Structure {
    Branch,
    Loop,
    Section(Operand),
    Steps,
}

fn part_of(operation: &Operation<'_>) -> Option<(Structure, Part)> {
    let form = operation.form?;
    let level = operation.operands.first().map(|operand| operand.value);
    Some(match (form.instruction.role, form.instruction.flow()) {
        (Role::BranchPush, _) => (Structure::Branch, Part::Open),
        (Role::BranchRead, _) => (Structure::Branch, Part::Middle),
        (Role::BranchPop, _) => (Structure::Branch, Part::Close),
        (_, Flow::LoopBegin) => (Structure::Loop, Part::Open),
        (_, Flow::LoopEnd) => (Structure::Loop, Part::Close),
        (_, Flow::SectionBegin) => (Structure::Section(level?), Part::Open),
        (_, Flow::SectionEnd) => (Structure::Section(level?), Part::Close),
        (_, Flow::Step) => (Structure::Steps, Part::Middle),
        (_, Flow::StepsEnd) => (Structure::Steps, Part::Close),
        _ => return None,
    })
}

fn in_fx(document: &Document, found: ChunkRef<'_>, inside: usize) -> Option<Vec<Span>> {
    let touched = |operation: &Operation<'_>| operation.is_word && operation.symbol.touches(inside);
    let own = found.chunk.operations().find(touched)?;
    let (structure, part) = part_of(&own)?;
    let own_span = own.symbol.shifted(found.start);
    // Of an open group the words so far; groups of the same structure stand in a stack.
    let mut open: Vec<Vec<Span>> = Vec::new();
    let mut is_own_group = false;
    for at in document.chunks() {
        if !may_have(at.chunk, structure) {
            continue;
        }
        for operation in at.chunk.operations() {
            let Some((_, part)) = part_of(&operation).filter(|(other, _)| *other == structure) else {
                continue;
            };
            let span = operation.symbol.shifted(at.start);
            is_own_group |= span == own_span;
            // A step ladder has no word that opens it.
            if part == Part::Open || open.is_empty() && part == Part::Middle && structure == Structure::Steps
            {
                open.push(Vec::new());
            }
            if let Some(group) = open.last_mut() {
                group.push(span);
            }
            let closes = part == Part::Close;
            let holds_own = open.last().is_some_and(|group| group.contains(&own_span));
            if closes
                && let Some(group) = open.pop()
                && holds_own
            {
                return Some(group);
            }
        }
    }
    let unclosed = open.into_iter().find(|group| group.contains(&own_span));
    // A word that closes nothing stands alone.
    Some(unclosed.unwrap_or_else(|| vec![own_span])).filter(|_| is_own_group || part == Part::Close)
}

/// Chunks without any output cannot have a part; asking the names is cheaper than walking the operations of each.
fn may_have(chunk: &Chunk, structure: Structure) -> bool {
    match structure {
        // A nesting level is named by every MC and MCR.
        Structure::Section(Operand::Device(level)) => {
            chunk.mentions().iter().any(|mention| mention.symbol == crate::document::Symbol::Device(level))
        }
        _ => true,
    }
}

/// The two ends of a parenthesis, of a program unit.
fn in_iec(found: ChunkRef<'_>, inside: usize) -> Option<Vec<Span>> {
    let Tree::Iec(tree) = found.chunk.tree() else { return None };
    let mut open: Vec<Span> = Vec::new();
    for item in &tree.items {
        match item.kind {
            ItemKind::Open { operation, .. } => open.push(operation.word),
            ItemKind::ParameterOpen { .. } => open.push(item.span),
            ItemKind::Close => {
                let Some(begin) = open.pop() else { continue };
                if begin.touches(inside) || item.span.touches(inside) {
                    return Some(vec![begin.shifted(found.start), item.span.shifted(found.start)]);
                }
            }
            _ => {}
        }
    }
    None
}
