//! Renaming: the same program with another name, and the drawing kept whole. What would change the program's meaning
//! is refused with a reason.

use super::aliases;
use super::names::{self, Named, Thing};
use crate::document::{Document, Mention, Symbol, Tree};
use crate::target::iec::{is_identifier, is_keyword};
use crate::target::{Device, DeviceKind, DirectAddress, Operand};
use crate::text::{Encoding, Message, Span, TextEdit};
use smol_str::SmolStr;

pub(super) mod drawing;

pub(super) fn renamable(document: &Document, offset: usize) -> Option<Span> {
    let named = names::at(document, offset)?;
    fixed(document, &named).is_none().then_some(named.span)
}

pub(super) fn rename(document: &Document, offset: usize, new: &str) -> Result<Vec<TextEdit>, Message> {
    let new = new.trim();
    let named = names::at(document, offset).ok_or_else(|| Message::new("rename.nothing"))?;
    if let Some(reason) = fixed(document, &named) {
        return Err(reason);
    }
    let written = match &named.thing {
        Thing::Devices(device, _) => device_name(document, *device, new)?,
        Thing::Direct(address) => direct_name(document, &named, *address, new)?,
        _ => identifier(document, &named, new)?,
    };
    let mut places: Vec<(Span, bool)> = Vec::new();
    let thing = match named.thing {
        Thing::Devices(device, _) => Thing::Devices(device, 1),
        thing => thing,
    };
    names::visit(document, &thing, |place| {
        // A symbol stays: the comments file gives it the new device.
        if aliases::written_at(document, place.span).is_some() {
            return;
        }
        let is_drawn = matches!(place.chunk.tree(), Tree::Ladder(_));
        places.push((place.span, is_drawn));
    });
    places.sort_unstable();
    places.dedup();
    let drawn: Vec<Span> = places.iter().filter(|(_, is_drawn)| *is_drawn).map(|(span, _)| *span).collect();
    let plain = places.iter().filter(|(_, is_drawn)| !is_drawn);
    let mut edits: Vec<TextEdit> = plain.map(|(span, _)| TextEdit::new(*span, written.as_str())).collect();
    edits.extend(drawing::edits(document, &drawn, &written)?);
    edits.sort_by_key(|edit| edit.span);
    match drawing::still_say_the_same(document, document.reader(), &edits, &drawn) {
        Ok(()) => Ok(edits),
        Err(span) => {
            Err(Message::new("rename.drawing").with("name", written).with("line", line_of(document, span)))
        }
    }
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

/// The canonical spelling of `new` if `old` can become that device.
fn device_name(document: &Document, old: Device, new: &str) -> Result<String, Message> {
    let target = document.target();
    let Operand::Device(device) = Operand::read(new, target.model) else {
        return Err(Message::new("rename.no-device").with("name", new));
    };
    if device.kind != old.kind {
        let kind = super::devices::kind_name(old.kind, crate::text::Language::English);
        let message = Message::new("rename.other-kind").with("old", old).with("new", device);
        return Err(message.with("kind", kind));
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
        return Err(message.with("purpose", own.purpose));
    }
    // Devices that are used together with `old` would stay behind.
    let mut count = 1;
    names::visit(document, &Thing::Devices(old, 1), |place| {
        if let Thing::Devices(first, run) = place.thing
            && first == old
        {
            count = count.max(run);
        }
    });
    let mut torn = None;
    names::visit(document, &Thing::Devices(old, count), |place| {
        if let Thing::Devices(first, _) = place.thing
            && first != old
        {
            torn.get_or_insert((first, place.span));
        }
    });
    if let Some((first, span)) = torn {
        let message = Message::new("rename.run").with("old", old).with("other", first.min(old));
        return Err(message.with("line", line_of(document, span)));
    }
    let last = Device::new(device.kind, device.number.saturating_add(u32::from(count) - 1));
    if last.range_on(target).is_none() {
        return Err(Message::new("rename.not-on-target").with("target", target.title).with("new", last));
    }
    if device != old {
        let mut taken = None;
        names::visit(document, &Thing::Devices(device, count), |place| {
            if !matches!(place.thing, Thing::Devices(first, _) if first == old) {
                taken.get_or_insert((place.span, place.thing.clone()));
            }
        });
        if let Some((span, _)) = taken {
            return Err(Message::new("rename.taken")
                .with("new", device)
                .with("line", line_of(document, span)));
        }
    }
    Ok(device.to_string())
}

fn direct_name(
    document: &Document,
    named: &Named<'_>,
    old: DirectAddress,
    new: &str,
) -> Result<String, Message> {
    let new_address = match Operand::read(new, crate::target::Model::Iec) {
        Operand::Direct(address) if (address.location, address.width) == (old.location, old.width) => address,
        _ => {
            let message = Message::new("rename.no-address").with("name", new);
            return Err(message.with("old", document.slice(named.span)));
        }
    };
    let taken = first_place(document, &Thing::Direct(new_address)).filter(|_| new_address != old);
    match taken {
        Some(span) => {
            Err(Message::new("rename.taken").with("new", new).with("line", line_of(document, span)))
        }
        None => Ok(new.to_string()),
    }
}

/// A name that the language allows and that nothing else has where the old one is known.
fn identifier(document: &Document, named: &Named<'_>, new: &str) -> Result<String, Message> {
    if !is_identifier(new) {
        return Err(Message::new("rename.no-identifier").with("name", new));
    }
    // Words that the language gives a meaning elsewhere can be labels and connectors, too.
    if is_keyword(new) {
        return Err(Message::new("rename.keyword").with("name", new));
    }
    let folded = SmolStr::from(if new.is_ascii() { new.to_ascii_lowercase() } else { new.to_lowercase() });
    let is_same = match &named.thing {
        Thing::Variable { name, .. }
        | Thing::Label { name, .. }
        | Thing::Connector { name, .. }
        | Thing::Pou(name)
        | Thing::Type(name) => *name == folded,
        Thing::Devices(..) | Thing::Direct(_) => false,
    };
    let taken = if is_same { None } else { taken(document, &named.thing, &folded) };
    match taken {
        Some(span) => {
            Err(Message::new("rename.taken").with("new", new).with("line", line_of(document, span)))
        }
        None => Ok(new.to_string()),
    }
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

fn line_of(document: &Document, span: Span) -> u32 {
    document.position(span.start as usize, Encoding::Utf8).line + 1
}
