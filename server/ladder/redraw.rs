//! One rung drawn anew, as it reads or as it is meant, and everything else of its chunk left alone.

use super::format::{Lines, Page, drawing, may_be_redrawn, same, same_but};
use super::{Drawing, Graph, LadderTree, OperandPlace, Style, StyleKind, parse_with};
use crate::target::Target;
use crate::text::{Span, TextEdit};

/// The edit that draws the rung with `offset` in it as it was read, and leaves the rest of the chunk as it is.
/// `tree` may be one of several readings of the chunk. Nothing if the rung cannot be drawn, or is drawn so already.
pub fn redraw(chunk: &str, tree: &LadderTree, offset: u32, target: &Target) -> Option<TextEdit> {
    let number = tree.rungs.iter().position(|rung| rung.span.start <= offset && offset < rung.span.end)?;
    let lines = Lines::of(chunk);
    let rung = &tree.rungs[number];
    let (formatted, edit) =
        redrawn(chunk, tree, number, |kind| drawing(chunk, tree, rung, &lines, kind).ok())?;
    same(chunk, tree, &formatted, target).then_some(edit)
}

/// The edit that puts another drawing in the place of rung `number` and leaves the rest of the chunk as it is. Nothing
/// unless, read again, its graph with the words of the new text is what `is_meant` asks for, and everything else says
/// the same.
pub fn redraw_as(
    chunk: &str,
    tree: &LadderTree,
    number: usize,
    drawing: impl FnOnce(StyleKind) -> Option<Drawing>,
    is_meant: impl FnOnce(&Graph, &str) -> bool,
    target: &Target,
) -> Option<TextEdit> {
    let lines = Lines::of(chunk);
    let rung = tree.rungs.get(number)?;
    may_be_redrawn(chunk, tree, rung, &lines).ok()?;
    let (formatted, edit) = redrawn(chunk, tree, number, drawing)?;
    let again = parse_with(&formatted, target, tree.names);
    let says_so = same_but((chunk, tree), (&formatted, &again), Some(number))
        && is_meant(&again.rungs.get(number)?.graph, &formatted);
    says_so.then_some(edit)
}

/// The chunk with a new drawing of one rung, and the edit that makes it; nothing if it is drawn so already.
fn redrawn(
    chunk: &str,
    tree: &LadderTree,
    number: usize,
    drawing: impl FnOnce(StyleKind) -> Option<Drawing>,
) -> Option<(String, TextEdit)> {
    let rung = tree.rungs.get(number)?;
    let lines = Lines::of(chunk);
    let is_box_drawing = |c: char| ('\u{2500}'..='\u{257F}').contains(&c);
    let inside = rung.graph.elements.iter().filter(|element| element.place == OperandPlace::Inside);
    let kind = match inside.count() * 2 > rung.graph.elements.len() {
        true => StyleKind::Brackets,
        false if rung.span.of(chunk).contains(is_box_drawing) => StyleKind::Unicode,
        false => StyleKind::Iec,
    };
    // Other rungs of the chunk that have their rail further right keep it there, and so does this one.
    let usual = tree.rungs.iter().flat_map(|rung| &rung.right_rail).map(|rail| rail.value + 1).max();
    let style = Style { kind, width: usual.unwrap_or(0).max(Style::default().width) };
    let drawing = drawing(kind)?;
    let mut page = Page::of([(chunk, tree)], &style);
    page.rail = page.rail.max(drawing.rail_column_min());
    let text = drawing.paint(page.rail)?;
    let mut drawn = vec![None; tree.rungs.len()];
    drawn[number] = Some(text);
    let formatted = lines.with_rungs(tree, &drawn, &page);
    if formatted == chunk {
        return None;
    }
    // The lines that stay are no part of the edit.
    let (old, new) = (Lines::of(chunk), Lines::of(&formatted));
    let common = old.lines.iter().zip(&new.lines).take_while(|(a, b)| a == b).count();
    let (old_rest, new_rest) = (&old.lines[common..], &new.lines[common..]);
    let tail = old_rest.iter().rev().zip(new_rest.iter().rev()).take_while(|(a, b)| a == b).count();
    let (start, end) = (old.starts[common], old.starts[old.lines.len() - tail]);
    let new_end = new.starts[new.lines.len() - tail];
    let edit = TextEdit::new(Span::new(start, end), formatted.get(new.starts[common]..new_end)?);
    Some((formatted, edit))
}
