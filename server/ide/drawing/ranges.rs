//! Selection ranges in a drawing: name, element, branch, rung, network.

use super::object::{self, ObjectKind};
use super::site::{Site, Spot, cells_of};
use crate::document::Document;
use crate::text::Span;

/// The ranges around a byte of a drawing, smallest first; not yet nested in each other.
pub(in crate::ide) fn around(document: &Document, offset: usize) -> Vec<Span> {
    let mut ranges = Vec::new();
    if let Some(site) = Site::at(document, offset) {
        let inside = offset.saturating_sub(site.start);
        if let Some(Spot::Element(id)) = site.spot_on(inside) {
            let cells = cells_of(site.element(id));
            let touched = cells.iter().filter(|span| span.touches(inside));
            ranges.extend(touched.min_by_key(|span| span.len()).copied());
            ranges.extend(cells.iter().copied().reduce(Span::to));
        }
        if let Some(branch) = object::branch_at(&site, offset) {
            let cells = branch.iter().flat_map(|id| cells_of(site.element(*id)));
            ranges.extend(cells.reduce(Span::to));
        }
        let trimmed = site.lines().of(site.text).trim_end().len();
        let start = site.lines().start as usize;
        ranges.push(Span::new(start, start + trimmed));
        ranges.iter_mut().for_each(|span| *span = span.shifted(site.start));
    }
    let network = object::at(document, offset, ObjectKind::Network, true);
    ranges.extend(network.map(|network| network.span));
    ranges
}
