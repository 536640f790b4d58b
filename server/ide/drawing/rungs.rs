//! New rungs, and the line of bare rails above a rung in which its names have room.

use super::Edited;
use super::assemble::Plan;
use super::look::Look;
use super::proof::Window;
use super::site::Site;
use crate::document::{Document, Tree};
use crate::ide::Style;
use crate::ladder::Element;
use crate::ladder::reduce::Shape;
use crate::text::{BYTE_ORDER_MARK, Message, Span, TextEdit};

/// A new rung, a wire from rail to rail, below or above the rung at a byte of the document, or at the blank line there.
pub(super) fn insert(
    document: &Document,
    offset: usize,
    above: bool,
    style: Style,
) -> Result<Edited, Message> {
    let site = Site::at(document, offset);
    let near = site.clone().or_else(|| nearest(document, offset));
    let fallback = style.ladder().kind;
    let look = near.map_or_else(|| Look::plain(fallback, style.width), |site| Look::of(&site, fallback));
    let place = match site {
        Some(site) => beside(&site, above),
        None => free_line(document, offset),
    };
    let end = look.line_end();
    let before = match place.checked_sub(1).map(|last| document.line_at(last).2) {
        None => String::new(),
        Some(line) if !line.ends_with('\n') => [end, end].concat(),
        Some(line) if line.trim().is_empty() => String::new(),
        Some(_) => end.to_string(),
    };
    let lines = look.empty_rung();
    let is_last = place >= document.len();
    let after = if is_last || document.line_at(place).2.trim().is_empty() { "" } else { end };
    let edit = TextEdit::new(Span::at(place), format!("{before}{lines}{after}"));
    let wire = place + before.len() + lines.trim_end().rfind('\n').map_or(0, |end| end + 1);
    let selection = Span::at(wire + look.wire_inset());
    // An empty document has nothing that could be changed.
    if let Some(window) = Window::around(document, place) {
        let plan = Plan { shape: Shape::Wire, elements: Vec::new() };
        let new = window.with(edit.span, &edit.text);
        let proved = window.prove(new, window.rungs_before(place), &plan.graph(), "", true);
        proved.ok_or_else(|| Message::new("edit.not-the-same"))?;
    }
    Ok(Edited { edits: vec![edit], selection })
}

/// The first byte of a new rung beside one: below its last line, or above its first and the comments on it.
fn beside(site: &Site<'_>, above: bool) -> usize {
    if !above {
        return site.start + site.lines().end as usize;
    }
    if site.number > 0 {
        return site.start + site.lines().start as usize;
    }
    let blank =
        site.text.len() - site.text.trim_start_matches(['\n', '\r', ' ', '\t', BYTE_ORDER_MARK]).len();
    let mark = site.text.find(BYTE_ORDER_MARK).map_or(0, |_| BYTE_ORDER_MARK.len_utf8());
    site.start + site.line_start(site.line_of(blank)).max(mark)
}

/// The start of a line between rungs: that of the byte if it is blank, else behind the chunk.
fn free_line(document: &Document, offset: usize) -> usize {
    let (_, start, line) = document.line_at(offset);
    let ends_unit = line.trim_start().get(..4).is_some_and(|word| word.eq_ignore_ascii_case("END_"));
    if line.trim().is_empty() || ends_unit && !line.to_ascii_uppercase().contains("END_VAR") {
        return start;
    }
    document.chunk_at(offset).map_or(document.len(), |at| at.start + at.chunk.len())
}

/// A rung of the chunk at a byte, or of the one before or after it.
fn nearest(document: &Document, offset: usize) -> Option<Site<'_>> {
    let at = document.chunk_at(offset)?;
    let after = document.chunk_at(at.start + at.chunk.len());
    let candidates = [Some(at), document.chunk_before(offset), after];
    candidates.into_iter().flatten().find_map(|at| {
        let Tree::Ladder(tree) = at.chunk.tree() else { return None };
        let rung = tree.rungs.last()?;
        Site::at(document, at.start + rung.span.start as usize)
    })
}

/// The start, in the document, of a line of bare rails directly above the rung, if the new drawing needs a line more
/// for its names and has the same rails.
pub(super) fn rails_above(site: &Site<'_>, lines: &str) -> Option<usize> {
    let start = site.start + site.lines().start as usize;
    let above = start.checked_sub(1).map(|above| site.document.line_at(above))?;
    let is_bare = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        matches!(words.as_slice(), [left, right] if left == right && matches!(*left, "|" | "||" | "│" | "││"))
    };
    let (_, above_start, above) = above;
    let old = site.lines().of(site.text);
    let old_first = old.lines().next()?;
    let new_first = lines.lines().next()?;
    let is_power = |line: &str| line.trim_start().starts_with(['+', '├']);
    let grows = lines.lines().count() > old.lines().count();
    // Between two rungs it may be all that parts them.
    let parted = above_start == 0 || site.document.line_at(above_start - 1).2.trim().is_empty();
    (is_bare(&above) && is_power(old_first) && !is_power(new_first) && grows && parted).then_some(above_start)
}

/// The edit that puts an empty rung below the one at `site` after Enter behind its last cell, with the cursor at byte
/// `offset` in the new line; none where something follows or the rung is not complete.
pub(super) fn after_end(
    document: &Document,
    site: &Site<'_>,
    cut: usize,
    offset: usize,
    style: Style,
) -> Vec<TextEdit> {
    let last = site.rung.lines.1.saturating_sub(1);
    let inside = cut.saturating_sub(site.start);
    let complete = site.rung.graph.elements.iter().any(Element::is_output)
        && site.tree.problems.is_empty()
        && !site.rung.right_rail.is_empty();
    let (_, start, line) = document.line_at(offset);
    let next = start + line.len();
    let follows = next < document.len() && !document.line_at(next).2.trim().is_empty();
    if site.line_of(inside) != last || !complete || follows {
        return Vec::new();
    }
    let look = Look::of(site, style.ladder().kind);
    let rung = look.empty_rung();
    vec![TextEdit::new(
        Span::at(offset),
        format!("{}{}", look.line_end(), rung.trim_end_matches(['\n', '\r'])),
    )]
}
