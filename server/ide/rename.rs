//! Renaming: the same program with another name, and the drawing kept whole. What would change the program's meaning
//! is refused with a reason.

use super::across::{self, InFile};
use super::aliases;
use super::names::{self, Named, Thing};
use crate::document::{At, Document, Mention, ProjectView, Symbol, Tree};
use crate::target::iec::{is_identifier, is_keyword};
use crate::target::{Device, DeviceKind, DirectAddress, Operand, Target};
use crate::text::{Message, Span, TextEdit, folded};
use drawing::{Misfit, Place};
use smol_str::SmolStr;

pub(super) mod drawing;

pub(super) fn renamable(document: &Document, offset: usize) -> Option<Span> {
    let named = names::at(document, offset)?;
    fixed(document, &named).is_none().then_some(named.span)
}

/// The edits of each file.
pub(super) fn rename(
    view: &ProjectView<'_>,
    offset: usize,
    new: &str,
) -> Result<Vec<At<Vec<TextEdit>>>, Message> {
    let new = new.trim();
    let document = view.here();
    let named = names::at(document, offset).ok_or_else(|| Message::new("rename.nothing"))?;
    if let Some(reason) = fixed(document, &named) {
        return Err(reason);
    }
    let thing = match &named.thing {
        Thing::Devices(device, _) => Thing::Devices(*device, 1),
        thing => thing.clone(),
    };
    let change = Change { view, files: across::files(view, &thing) };
    let written = match &thing {
        Thing::Devices(device, _) => change.device_name(*device, new)?,
        Thing::Direct(address) => change.direct_name(&named, *address, new)?,
        _ => change.identifier(&thing, new)?,
    };
    let mut changes = Vec::new();
    for file in &change.files {
        let edits = change.edits(file, &written)?;
        if !edits.is_empty() {
            changes.push(At { file: file.file, value: edits });
        }
    }
    Ok(changes)
}

/// Why the name cannot be changed, whatever the new one is.
fn fixed(document: &Document, named: &Named<'_>) -> Option<Message> {
    let word = || document.slice(named.span);
    match &named.thing {
        Thing::Devices(device, _) if device.special_on(document.target()).is_some() => {
            Some(Message::new("rename.special").with("name", device))
        }
        Thing::Devices(device, _) if device.kind == DeviceKind::I => {
            Some(Message::new("rename.special").with("name", device))
        }
        Thing::Pou(name) if document.scopes().pou_named(name).is_none() => {
            Some(Message::new("rename.standard").with("name", word()))
        }
        Thing::Type(name) if !document.scopes().types.contains_key(name) => {
            Some(Message::new("rename.standard").with("name", word()))
        }
        _ => None,
    }
}

/// A renaming, and the files in which the thing can be named.
struct Change<'v, 'a> {
    view: &'v ProjectView<'a>,
    files: Vec<InFile<'a>>,
}

impl<'a> Change<'_, 'a> {
    /// The edits that write the new name in one file.
    fn edits(&self, file: &InFile<'a>, written: &str) -> Result<Vec<TextEdit>, Message> {
        let mut plain: Vec<Span> = Vec::new();
        let mut drawn: Result<Vec<Place>, Misfit> = Ok(Vec::new());
        names::visit(file.document, &file.thing, |place| {
            // A symbol stays: the comments file gives it the new device.
            if aliases::written_at(file.document, place.span).is_some() {
                return;
            }
            match (place.chunk.tree(), &mut drawn) {
                (Tree::Ladder(_), Ok(places)) => match drawing::place(&place, written) {
                    Ok(found) => places.push(found),
                    Err(misfit) => drawn = Err(misfit),
                },
                (Tree::Ladder(_), Err(_)) => {}
                _ => plain.push(place.span),
            }
        });
        let misfit = |misfit: Misfit| {
            let message = self.placed(misfit.keys(), file, misfit.place());
            misfit.fill(message).with("name", written)
        };
        let places = (plain, drawn.map_err(misfit)?);
        drawing::written(file.document, file.document, places, written).map_err(misfit)
    }

    /// The first of two messages for a place in the file that is looked at, the second for another file.
    fn placed(&self, [here, elsewhere]: [&'static str; 2], file: &InFile<'a>, span: Span) -> Message {
        let line = file.document.line_of(span.start as usize) + 1;
        if file.file == self.view.here_number() {
            return Message::new(here).with("line", line);
        }
        let name = self.view.members().get(file.file).map_or("", |member| member.name);
        Message::new(elsewhere).with("line", line).with("file", name)
    }

    fn taken(&self, file: &InFile<'a>, span: Span, new: impl ToString) -> Message {
        self.placed(["rename.taken", "rename.taken-elsewhere"], file, span).with("new", new)
    }

    /// The canonical spelling of `new` if `old` can become that device.
    fn device_name(&self, old: Device, new: &str) -> Result<String, Message> {
        let target = self.view.here().target();
        let device = device_like(old, new, target)?;
        // Devices that are used together with `old` would stay behind.
        let mut count = 1;
        for file in &self.files {
            names::visit(file.document, &Thing::Devices(old, 1), |place| {
                if let Thing::Devices(first, run) = place.thing
                    && first == old
                {
                    count = count.max(run);
                }
            });
        }
        for file in &self.files {
            let mut torn = None;
            names::visit(file.document, &Thing::Devices(old, count), |place| {
                if let Thing::Devices(first, _) = place.thing
                    && first != old
                {
                    torn.get_or_insert((first, place.span));
                }
            });
            if let Some((first, span)) = torn {
                let message = self.placed(["rename.run", "rename.run-elsewhere"], file, span);
                return Err(message.with("old", old).with("other", first.min(old)));
            }
        }
        let last = Device::new(device.kind, device.number.saturating_add(u32::from(count) - 1));
        if last.range_on(target).is_none() {
            return Err(Message::new("rename.not-on-target").with("target", target.title).with("new", last));
        }
        for file in self.files.iter().filter(|_| device != old) {
            let mut taken = None;
            names::visit(file.document, &Thing::Devices(device, count), |place| {
                if !matches!(place.thing, Thing::Devices(first, _) if first == old) {
                    taken.get_or_insert(place.span);
                }
            });
            if let Some(span) = taken {
                return Err(self.taken(file, span, device));
            }
        }
        Ok(device.to_string())
    }

    fn direct_name(&self, named: &Named<'_>, old: DirectAddress, new: &str) -> Result<String, Message> {
        let new_address = match Operand::read(new, crate::target::Model::Iec) {
            Operand::Direct(address) if (address.location, address.width) == (old.location, old.width) => {
                address
            }
            _ => {
                let message = Message::new("rename.no-address").with("name", new);
                return Err(message.with("old", self.view.here().slice(named.span)));
            }
        };
        for file in self.files.iter().filter(|_| new_address != old) {
            if let Some(span) = first_place(file.document, &Thing::Direct(new_address)) {
                return Err(self.taken(file, span, new));
            }
        }
        Ok(new.to_string())
    }

    /// A name that the language allows and that nothing else has where the old one is known.
    fn identifier(&self, thing: &Thing, new: &str) -> Result<String, Message> {
        if !is_identifier(new) {
            return Err(Message::new("rename.no-identifier").with("name", new));
        }
        // Words that the language gives a meaning elsewhere can be labels and connectors, too.
        if is_keyword(new) {
            return Err(Message::new("rename.keyword").with("name", new));
        }
        let folded = folded(new);
        let is_same = match thing {
            Thing::Variable { name, .. }
            | Thing::Label { name, .. }
            | Thing::Connector { name, .. }
            | Thing::Pou(name)
            | Thing::Type(name) => *name == folded,
            Thing::Devices(..) | Thing::Direct(_) => false,
        };
        for file in self.files.iter().filter(|_| !is_same) {
            if let Some(span) = taken(file.document, &file.thing, &folded) {
                return Err(self.taken(file, span, new));
            }
        }
        Ok(new.to_string())
    }
}

/// The device called `new` if it can take the part of `old`.
fn device_like(old: Device, new: &str, target: &'static Target) -> Result<Device, Message> {
    let Operand::Device(device) = Operand::read(new, target.model) else {
        return Err(Message::new("rename.no-device").with("name", new));
    };
    if device.kind != old.kind {
        let kind = super::devices::kind_message(old.kind);
        let message = Message::new("rename.other-kind").with("old", old).with("new", device);
        return Err(message.with_messages("kind", vec![kind]));
    }
    let Some(range) = device.range_on(target) else {
        return Err(Message::new("rename.not-on-target").with("target", target.title).with("new", device));
    };
    if device.special_on(target).is_some() {
        return Err(Message::new("rename.special").with("name", device));
    }
    if let Some(own) = old.range_on(target)
        && (own.timer_unit_ms, own.bits) != (range.timer_unit_ms, range.bits)
    {
        let message = Message::new("rename.other-purpose").with("old", old).with("new", device);
        return Err(message.with_phrase("purpose", own.purpose));
    }
    Ok(device)
}

/// A place where the folded name `new` already means something that the renamed `thing` would meet.
fn taken(document: &Document, thing: &Thing, new: &SmolStr) -> Option<Span> {
    let same = |symbol: &Symbol| match (thing, symbol) {
        (Thing::Label { .. }, Symbol::Label(name)) | (Thing::Connector { .. }, Symbol::Connector(name)) => {
            name == new
        }
        (Thing::Label { .. } | Thing::Connector { .. }, _) => false,
        (_, Symbol::Variable(name) | Symbol::Pou(name) | Symbol::Type(name)) => name == new,
        _ => false,
    };
    let within = match thing {
        Thing::Variable { pou, .. } | Thing::Label { pou, .. } | Thing::Connector { pou, .. } => *pou,
        _ => None,
    };
    let mut walk = names::PouWalk::default();
    for at in document.chunks() {
        let pou = walk.enter(at.chunk);
        let is_met = |mention: &&Mention| same(&mention.symbol) && (within.is_none() || pou == within);
        if let Some(mention) = at.chunk.mentions().iter().find(is_met) {
            return Some(mention.span.shifted(at.start));
        }
    }
    None
}

fn first_place(document: &Document, thing: &Thing) -> Option<Span> {
    let mut first = None;
    names::visit(document, thing, |place| {
        first.get_or_insert(place.span);
    });
    first
}
