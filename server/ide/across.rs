//! A name across the files of a project: which other files can name the same thing, and what it is there.

use super::names::{self, Named, Thing};
use crate::check::program_around;
use crate::document::{At, Document, ProjectView, Use};
use crate::text::Span;

/// A file in which a thing can be named.
pub(super) struct InFile<'a> {
    /// The number of the file.
    pub file: usize,
    pub document: &'a Document,
    /// The thing as the scopes of that file number it.
    pub thing: Thing,
}

/// The files in which the `thing` of the file that is looked at can be named, in the order of execution.
pub(super) fn files<'a>(view: &ProjectView<'a>, thing: &Thing) -> Vec<InFile<'a>> {
    let here = view.here();
    let in_file = |file: usize| {
        let document = view.members()[file].document;
        let is_here = file == view.here_number();
        let thing = if is_here { Some(thing.clone()) } else { seen_from(thing, here, document) };
        Some(InFile { file, document, thing: thing? })
    };
    program_around(view).into_iter().filter_map(in_file).collect()
}

/// What the `thing` of `here` is in another file of the same program; nothing if it is not known there.
fn seen_from(thing: &Thing, here: &Document, other: &Document) -> Option<Thing> {
    match thing {
        Thing::Devices(..) | Thing::Direct(_) | Thing::Pou(_) | Thing::Type(_) => Some(thing.clone()),
        // A name that no file declares belongs to the drawing or list in which it stands.
        Thing::Variable { pou: None, name } => {
            here.scopes().globals.contains_key(name).then(|| thing.clone())
        }
        Thing::Variable { pou: Some(_), .. } => {
            let (unit, name) = thing.parameter_of(here.scopes())?;
            let unit = other.scopes().pou_number(&here.scopes().pous.get(unit)?.name)?;
            Some(Thing::Variable { pou: Some(unit), name: name.clone() })
        }
        Thing::Label { .. } | Thing::Connector { .. } => None,
    }
}

/// Calls `see` for every place of `thing` in all files that can name it.
pub(super) fn visit<'a>(view: &ProjectView<'a>, thing: &Thing, mut see: impl FnMut(usize, Named<'a>)) {
    for file in files(view, thing) {
        if view.is_cancelled() {
            return;
        }
        names::visit(file.document, &file.thing, |place| see(file.file, place));
    }
}

pub(super) fn references(view: &ProjectView<'_>, offset: usize, with_declaration: bool) -> Vec<At<Span>> {
    let Some(named) = names::at(view.here(), offset) else { return Vec::new() };
    let mut places = Vec::new();
    visit(view, &named.thing, |file, place| {
        if with_declaration || place.usage != Use::Declare {
            places.push(At { file, value: place.span });
        }
    });
    places.sort_unstable();
    places.dedup();
    places
}

pub(super) fn definition(view: &ProjectView<'_>, offset: usize) -> Vec<At<Span>> {
    let Some(named) = names::at(view.here(), offset) else { return Vec::new() };
    let (mut declared, mut driven, mut read) = (Vec::new(), Vec::new(), Vec::new());
    visit(view, &named.thing, |file, place| {
        let at = At { file, value: place.span };
        match place.usage {
            Use::Declare => declared.push(at),
            Use::Write | Use::ReadWrite => driven.push(at),
            // An input is driven from outside; its first reader is the best place to begin with.
            Use::Read | Use::Jump if read.is_empty() => read.push(at),
            Use::Read | Use::Jump => {}
        }
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
