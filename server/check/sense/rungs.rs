//! Rungs as pieces of text that fixes move, join and take out.

use super::uses::{Use, Uses};
use crate::document::{Chunk, Tree};
use crate::il::fx::LineKind;
use crate::ladder::ElementKind;
use crate::target::{Flow, Form, Role};
use crate::text::Span;

/// So many findings of a rule get a fix, for which the text of their rungs is read; the others have theirs once these
/// are mended.
pub(super) const MOST_MENDED: usize = 100;

/// A rung of instruction list with one output, which is its last instruction, and nothing but contacts before it.
pub(super) struct PlainRung {
    /// From the first contact to the output, whole lines.
    pub all: Span,
    /// The lines of the contacts.
    pub conditions: Span,
    /// The lines of the contacts, as they are written.
    pub words: String,
    /// How many blocks they load.
    pub loads: usize,
}

impl PlainRung {
    /// The rung of `one`, if it is plain. Spans are those of the program.
    pub fn of(uses: &Uses<'_>, one: &Use) -> Option<PlainRung> {
        let (start, chunk) = uses.chunk(one)?;
        let reading = chunk.reading();
        let Tree::Fx(tree) = reading.tree() else { return None };
        let forms = tree.lines.iter().map(|line| match line.kind {
            // Step numbers would no longer be right.
            LineKind::Instruction(form) if line.step.is_none() => Some(form),
            _ => None,
        });
        let forms: Vec<Form> = forms.collect::<Option<_>>()?;
        let (output, contacts) = forms.split_last()?;
        let is_condition = |form: &Form| {
            use Role::{BlockParallel, BlockSeries, Load, Modify, Parallel, Series};
            matches!(form.instruction.role, Load | Series | Parallel | BlockSeries | BlockParallel | Modify)
        };
        let is_plain = output.instruction.role == Role::Output
            && output.instruction.flow() == Flow::Straight
            && contacts.first().is_some_and(|form| form.instruction.role == Role::Load)
            && contacts.iter().all(is_condition)
            && tree.problems.is_empty();
        let (first, last) = (tree.lines.first()?, tree.lines.last()?);
        let text = chunk.text();
        let line_start = |offset: u32| text[..offset as usize].rfind('\n').map_or(0, |newline| newline + 1);
        let (from, middle) = (line_start(first.span.start), line_start(last.span.start));
        let end = last.span.end as usize;
        let end = text[end..].find('\n').map_or(text.len(), |newline| end + newline + 1);
        is_plain.then(|| PlainRung {
            all: Span::new(from, end).shifted(start),
            conditions: Span::new(from, middle).shifted(start),
            words: text[from..middle].to_string(),
            loads: contacts.iter().filter(|form| form.instruction.role == Role::Load).count(),
        })
    }
}

/// The place of the chunk of `one` in the program and its text, if it is one rung without labels that runs straight on,
/// so that it may stand elsewhere as well.
pub(super) fn movable<'a>(uses: &Uses<'a>, one: &Use) -> Option<(Span, &'a str)> {
    let (start, chunk) = uses.chunk(one)?;
    let is_movable = chunk.size().rungs == 1 && runs_straight_on(chunk);
    is_movable.then(|| (Span::new(start, start + chunk.len()), chunk.text()))
}

fn runs_straight_on(chunk: &Chunk) -> bool {
    let reading = chunk.reading();
    let is_straight = |form: Option<Form>| form.is_some_and(|form| form.instruction.flow() == Flow::Straight);
    match reading.tree() {
        Tree::Fx(tree) => {
            tree.problems.is_empty()
                && tree.lines.iter().all(|line| match line.kind {
                    LineKind::Instruction(form) => line.step.is_none() && is_straight(Some(form)),
                    _ => false,
                })
        }
        Tree::Ladder(tree) => {
            let leaves = |kind: &ElementKind| match kind {
                ElementKind::Instruction { form, .. } => !is_straight(*form),
                ElementKind::Jump(_) | ElementKind::Return => true,
                ElementKind::ConnectorIn(_) | ElementKind::ConnectorOut(_) => true,
                _ => false,
            };
            let mut elements = tree.rungs.iter().flat_map(|rung| &rung.graph.elements);
            tree.problems.is_empty()
                && tree.header.is_none()
                && !elements.any(|element| leaves(&element.kind))
        }
        Tree::Iec(_) => false,
    }
}
