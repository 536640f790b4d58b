//! Writes a rung that does the same in other words, in the look of its text.

use super::rung::ProofRung;
use crate::check::ChunkContext;
use crate::check::drawing::{Drawn, does};
use crate::document::Tree;
use crate::il::fx::{FxLine, FxTree, LineKind};
use crate::ladder::{Drawing, Graph, redraw_as};
use crate::logic::Path;
use crate::target::Flow;
use crate::text::{Span, TextEdit};
use crate::translate::{to_fx, to_ladder};

/// The edits that put `path` in the place of `rung`; nothing where a comment or a number of a step would be lost, or in
/// Instruction List of IEC 61131-3.
pub(super) fn edits(context: &ChunkContext<'_>, rung: &ProofRung, path: &Path) -> Option<Vec<TextEdit>> {
    match (context.chunk.tree(), rung.drawn) {
        (Tree::Ladder(_), Some(number)) => redrawn(context, number, path),
        (Tree::Fx(tree), None) => list(context, tree, path),
        _ => None,
    }
}

/// The edits that draw `path` in the place of the rung with this number in a drawing.
pub(super) fn redrawn(context: &ChunkContext<'_>, number: usize, path: &Path) -> Option<Vec<TextEdit>> {
    let drawn = Drawn::of(context)?;
    let plan = to_ladder::plan(path, context.target.model).ok()?;
    let drawing = |kind| Drawing::new(&plan.shape, &plan.graph, &plan.source, kind);
    let is_meant = |graph: &Graph, text: &str| does(path, (text, graph), drawn.scopes);
    let edit = redraw_as(drawn.text, drawn.tree, number, drawing, is_meant, context.target)?;
    Some(vec![edit])
}

/// The lines that differ.
fn list(context: &ChunkContext<'_>, tree: &FxTree, path: &Path) -> Option<Vec<TextEdit>> {
    let text = context.chunk.text();
    let is_label = |line: &&FxLine| matches!(line.kind, LineKind::Label(_));
    let old: Vec<&FxLine> = tree.lines.iter().skip_while(is_label).collect();
    let is_plain = |line: &&FxLine| match line.kind {
        LineKind::Instruction(form) => line.step.is_none() && form.instruction.flow() != Flow::Nothing,
        _ => false,
    };
    if !old.iter().all(is_plain) {
        return None;
    }
    let new: Vec<String> =
        to_fx::lines(path, context.target).ok()?.iter().map(|line| line.to_string()).collect();
    let words = |line: &FxLine| line.span.of(text).split_whitespace().collect::<Vec<_>>().join(" ");
    let is_same = |(old, new): &(&&FxLine, &String)| words(old).eq_ignore_ascii_case(new);
    let head = old.iter().zip(&new).take_while(is_same).count();
    let tail = old[head..].iter().rev().zip(new[head..].iter().rev()).take_while(is_same).count();
    let (gone, come) = (&old[head..old.len() - tail], &new[head..new.len() - tail]);
    let line_start = |offset: u32| text[..offset as usize].rfind('\n').map_or(0, |newline| newline + 1);
    let start = line_start(gone.first().or(old.get(head))?.span.start);
    // The output at the end stays.
    let end = line_start(old.get(old.len() - tail)?.span.start);
    let span = Span::new(start, end);
    if tree.comments.iter().any(|comment| comment.start < span.end && span.start < comment.end) {
        return None;
    }
    let margin = text.get(start..old.get(head)?.span.start as usize)?;
    let line_end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let come: String = come.iter().map(|line| format!("{margin}{line}{line_end}")).collect();
    margin.trim().is_empty().then(|| vec![TextEdit::new(span, come)])
}
