//! Symbols of devices in programs: renamed together with the comments file, and exchanged for their devices.

use super::across;
use super::names::{self, Thing};
use super::rename::drawing::{self, Misfit, Place};
use crate::document::{At, Comments, DeviceComment, Document, ProjectView, Symbol, Tree};
use crate::target::{Device, Operand, Symbols};
use crate::text::{Message, Span, TextEdit};
use std::sync::Arc;

/// A new name for a symbol, in the files of a project and in its comments file.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct SymbolRename {
    /// The edits of each file that has any.
    pub files: Vec<At<Vec<TextEdit>>>,
    /// The edit of the comments file.
    pub table: Option<TextEdit>,
}

/// A change that the user may want at a place.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Rewrite {
    /// What it does, as an imperative.
    pub title: Message,
    /// Edits that do not overlap.
    pub edits: Vec<TextEdit>,
}

/// The device whose symbol is written at `span`; nothing where its own name is written, or something else.
pub(super) fn written_at(document: &Document, span: Span) -> Option<Device> {
    let word = document.slice(span);
    let own = Operand::read(&word, document.target().model);
    if !matches!(own, Operand::Invalid(_)) {
        return None;
    }
    document.comments().symbols().device(&word)
}

/// The symbol at `offset`, its device and its row in the comments file.
fn at(document: &Document, offset: usize) -> Option<(Span, Device, &DeviceComment)> {
    let named = names::at(document, offset)?;
    let device = written_at(document, named.span)?;
    Some((named.span, device, document.comments().of_device(device)?))
}

/// The symbol at `offset`, if there is one.
pub(super) fn span_at(document: &Document, offset: usize) -> Option<Span> {
    at(document, offset).map(|(span, ..)| span)
}

/// Renames the symbol at `offset`; nothing if something else stands there.
pub(super) fn rename(
    view: &ProjectView<'_>,
    offset: usize,
    new: &str,
) -> Option<Result<SymbolRename, Message>> {
    let (_, device, row) = at(view.here(), offset)?;
    Some(renamed(view, device, row, new.trim()))
}

fn renamed(
    view: &ProjectView<'_>,
    device: Device,
    row: &DeviceComment,
    new: &str,
) -> Result<SymbolRename, Message> {
    let document = view.here();
    if let Some(problem) = Symbols::problem(new, document.target()) {
        return Err(problem.message().with("symbol", new));
    }
    if let Some(other) = document.comments().symbols().device(new).filter(|other| *other != device) {
        return Err(Message::new("alias.taken").with("symbol", new).with("device", other));
    }
    // Drawings are read again with the new name to see that they still say the same.
    let rows = document.comments().rows().iter().map(|other| match other.thing == row.thing {
        true => DeviceComment { symbol: new.into(), ..other.clone() },
        false => other.clone(),
    });
    let comments = Arc::new(Comments::new(rows.collect()));
    let mut renamed = SymbolRename { files: Vec::new(), table: Some(TextEdit::new(row.symbol_span, new)) };
    for file in across::files(view, &Thing::Devices(device, 1)) {
        let (file, document) = (file.file, file.document);
        let is_symbol = |span: Span| written_at(document, span) == Some(device);
        let edits = exchanged(document, device, new, &comments, is_symbol)?;
        if !edits.is_empty() {
            renamed.files.push(At { file, value: edits });
        }
    }
    Ok(renamed)
}

/// The edits that write `new` wherever `device` stands in a way that `wanted` takes.
fn exchanged(
    document: &Document,
    device: Device,
    new: &str,
    comments: &Arc<Comments>,
    wanted: impl Fn(Span) -> bool,
) -> Result<Vec<TextEdit>, Message> {
    let mut plain: Vec<Span> = Vec::new();
    let mut drawn: Vec<Place> = Vec::new();
    names::visit(document, &Thing::Devices(device, 1), |place| {
        let is_own = matches!(place.thing, Thing::Devices(first, _) if first == device);
        if !is_own || !wanted(place.span) {
            return;
        }
        match place.chunk.tree() {
            Tree::Ladder(_) => drawn.push(Place { span: place.span, text: new.to_string() }),
            _ => plain.push(place.span),
        }
    });
    let misfit = |misfit: Misfit| {
        let line = document.line_of(misfit.place().start as usize) + 1;
        misfit.fill(Message::new(misfit.keys()[0])).with("name", new).with("line", line)
    };
    let reader = Document::with_comments("", document.notation(), document.target(), comments.clone());
    drawing::written(document, &reader, (plain, drawn), new).map_err(misfit)
}

/// The edit of the comments file that goes with the renaming of the device at `offset` to `new`.
///
/// # Errors
/// If the file has a line for the new device already.
pub(super) fn table_edit(document: &Document, offset: usize, new: &str) -> Result<Option<TextEdit>, Message> {
    let Some(named) = names::at(document, offset) else { return Ok(None) };
    let (old, new_thing) = match named.thing {
        Thing::Devices(old, _) => match Operand::read(new.trim(), document.target().model) {
            Operand::Device(new) => (Symbol::Device(old), Symbol::Device(new)),
            _ => return Ok(None),
        },
        Thing::Direct(old) => match Operand::read(new.trim(), crate::target::Model::Iec) {
            Operand::Direct(new) => (Symbol::Direct(old), Symbol::Direct(new)),
            _ => return Ok(None),
        },
        _ => return Ok(None),
    };
    let comments = document.comments();
    let Some(row) = comments.of(&old).filter(|_| old != new_thing) else { return Ok(None) };
    if comments.of(&new_thing).is_some() {
        return Err(Message::new("device-comments.device-twice").with("device", new.trim()));
    }
    Ok(Some(TextEdit::new(row.thing_span, new.trim())))
}

/// The symbol in place of the device at `offset`, or the device in place of the symbol: there, and in the whole file.
pub(super) fn rewrites(document: &Document, offset: usize) -> Vec<Rewrite> {
    let Some(named) = names::at(document, offset) else { return Vec::new() };
    let Thing::Devices(device, 1) = named.thing else { return Vec::new() };
    let comments = document.comments();
    let Some(row) = comments.of_device(device).filter(|row| !row.symbol.is_empty()) else {
        return Vec::new();
    };
    let is_symbol = written_at(document, named.span).is_some();
    let (new, old) = match is_symbol {
        true => (device.to_string(), row.symbol.to_string()),
        false => (row.symbol.to_string(), device.to_string()),
    };
    let says_the_same = |span: Span| says_the_same(document, span, &new);
    let same_way = |span: Span| written_at(document, span).is_some() == is_symbol && says_the_same(span);
    let mut found = Vec::new();
    let here = exchanged(document, device, &new, comments, |span| span == named.span && says_the_same(span));
    if let Some(edits) = here.ok().filter(|edits| !edits.is_empty()) {
        let title = Message::new("alias.here").with("new", &new).with("old", &old);
        found.push(Rewrite { title, edits });
    }
    let everywhere = exchanged(document, device, &new, comments, same_way);
    if let Some(edits) = everywhere.ok().filter(|edits| edits.len() > 1) {
        let title = Message::new("alias.everywhere").with("new", &new).with("old", &old);
        found.push(Rewrite { title, edits });
    }
    found
}

/// Whether the operand with the name at `span` reads as it does now when `new` stands there: `M0` in `K4M0` may have a
/// symbol `Lamps`, unless the project calls something else `K4Lamps`.
fn says_the_same(document: &Document, span: Span, new: &str) -> bool {
    let Some(at) = document.chunk_at(span.start as usize) else { return false };
    let start = at.start as u32;
    let (Some(first), Some(last)) = (span.start.checked_sub(start), span.end.checked_sub(start)) else {
        return false;
    };
    at.chunk.operations().flat_map(|operation| operation.operands).any(|operand| {
        let own = operand.span;
        let word = own.of(at.chunk.text());
        let inside = (first.checked_sub(own.start), own.end.checked_sub(last));
        let (Some(before), Some(behind)) = inside else { return false };
        let (Some(head), Some(tail)) = (
            word.get(..before as usize),
            word.len().checked_sub(behind as usize).and_then(|end| word.get(end..)),
        ) else {
            return false;
        };
        document.reader().read(&format!("{head}{new}{tail}")) == operand.value
    })
}
