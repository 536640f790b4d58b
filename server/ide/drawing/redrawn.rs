//! Rungs drawn anew as something else, in the look of what stood there.

use super::assemble::Plan;
use super::look::{Look, NEW_ROW};
use super::site::Site;
use crate::document::Document;
use crate::ide::Style;
use crate::ladder::Element;
use crate::text::Span;
use crate::translate::to_ladder;

/// The lines of the rungs at the bytes `places`, one below the other, and what stands there if `plans` are drawn in
/// their place; nothing where words would be lost.
pub(in crate::ide) fn in_place_of(
    document: &Document,
    places: &[usize],
    plans: Vec<to_ladder::Plan>,
    style: Style,
) -> Option<(Span, String)> {
    let sites: Vec<Site<'_>> =
        places.iter().map(|place| Site::at(document, *place)).collect::<Option<_>>()?;
    let (first, last) = (sites.first()?, sites.last()?);
    let lines = |site: &Site<'_>| site.lines().shifted(site.start);
    for pair in sites.windows(2) {
        let between = Span { start: lines(&pair[0]).end, end: lines(&pair[1]).start };
        if pair[1].number == 0 && pair[1].tree.header.is_some() || !document.slice(between).trim().is_empty()
        {
            return None;
        }
    }
    let keeps_words = |site: &Site<'_>| {
        let is_noted = site.rung.graph.elements.iter().any(|element| !element.notes.is_empty());
        !is_noted && site.problems().next().is_none()
    };
    // A comment behind a line, or a number before it, belongs to one rung.
    let is_one = sites.len() == 1 && plans.len() == 1;
    let is_single = |site: &Site<'_>| site.rung.number.is_none() && !has_comments(site);
    if !sites.iter().all(keeps_words) || (!is_one && !sites.iter().all(is_single)) {
        return None;
    }
    let look = Look::of(first, style.ladder().kind);
    let mut drawings = Vec::with_capacity(plans.len());
    for plan in plans {
        let to_ladder::Plan { shape, graph, source } = plan;
        let elements = with_rows(graph.elements, &source, first);
        drawings.push(look.draw(&Plan { shape, elements }, &source, first).ok()?);
    }
    let mut old = Span { start: lines(first).start, end: lines(last).end };
    let mut new = drawings.join(look.line_end());
    if new.is_empty() {
        // The blank line behind a rung that goes goes as well.
        let (_, start, line) = document.line_at(old.end as usize);
        if start == old.end as usize && line.trim().is_empty() {
            old.end += line.len() as u32;
        }
    } else if drawings.len() > 1 && !new.ends_with('\n') && document.slice(old).ends_with('\n') {
        new.push_str(look.line_end());
    }
    Some((old, new))
}

fn has_comments(site: &Site<'_>) -> bool {
    let lines = site.lines();
    site.tree.comments.iter().any(|comment| comment.start < lines.end && lines.start < comment.end)
}

/// The elements, each in the row of an old one with the same words, so that comments behind the rows stay with them.
fn with_rows(elements: Vec<Element>, source: &str, site: &Site<'_>) -> Vec<Element> {
    let words = |element: &Element, text: &str| -> Vec<String> {
        (0..element.operands.len()).map(|index| element.operand_text(index, text).to_string()).collect()
    };
    let mut old: Vec<(Vec<String>, u32)> =
        site.rung.graph.elements.iter().map(|element| (words(element, site.text), element.row)).collect();
    let with_row = |element: Element| {
        let own = words(&element, source);
        let found = old.iter().position(|(words, _)| *words == own);
        let row = found.map_or(NEW_ROW, |found| old.remove(found).1);
        Element { row, ..element }
    };
    elements.into_iter().map(with_row).collect()
}
