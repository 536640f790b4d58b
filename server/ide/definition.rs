//! Where a name comes from: its declaration, or the places that drive a device.

use super::names::{self, Thing};
use crate::document::{Document, Use};
use crate::text::Span;

pub(super) fn of(document: &Document, offset: usize) -> Vec<Span> {
    let Some(named) = names::at(document, offset) else { return Vec::new() };
    let (mut declared, mut driven, mut read) = (Vec::new(), Vec::new(), Vec::new());
    names::visit(document, &named.thing, |place| match place.usage {
        Use::Declare => declared.push(place.span),
        Use::Write | Use::ReadWrite => driven.push(place.span),
        // An input is driven from outside; its first reader is the best place to begin with.
        Use::Read | Use::Jump if read.is_empty() => read.push(place.span),
        Use::Read | Use::Jump => {}
    });
    if !declared.is_empty() {
        return declared;
    }
    match named.thing {
        Thing::Pou(_) | Thing::Type(_) | Thing::Label { .. } => Vec::new(),
        _ if driven.is_empty() => read,
        _ => driven,
    }
}
