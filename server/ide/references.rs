//! Every place of a name.

use super::names;
use crate::document::{Document, Use};
use crate::text::Span;

pub(super) fn of(document: &Document, offset: usize, with_declaration: bool) -> Vec<Span> {
    let Some(named) = names::at(document, offset) else { return Vec::new() };
    let mut spans = Vec::new();
    names::visit(document, &named.thing, |place| {
        if with_declaration || place.usage != Use::Declare {
            spans.push(place.span);
        }
    });
    spans.sort_unstable();
    spans.dedup();
    spans
}
