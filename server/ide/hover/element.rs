//! The symbols of ladder in words.

use crate::ladder::{CoilKind, ContactKind, Element, ElementKind};
use crate::target::DeviceKind;
use crate::text::{Language, Message};

/// What `element` does; nothing for boxes, which have pages. `chunk` is the text in which it is drawn.
pub fn describe(element: &Element, chunk: &str, language: Language) -> Option<String> {
    let nameless = || Message::new("element.nameless").render(language);
    let operand = |index: usize| match element.operands.get(index) {
        Some(_) => format!("`{}`", element.operand_text(index, chunk)),
        None => nameless(),
    };
    let message = match &element.kind {
        ElementKind::Contact(kind) => contact(*kind).with("name", operand(0)),
        ElementKind::Compare(operator) => Message::new("element.compare")
            .with("left", operand(0))
            .with("operator", operator.sign())
            .with("right", operand(1)),
        ElementKind::Invert => Message::new("element.invert"),
        ElementKind::Coil(kind) => {
            coil(*kind, element.device().map(|device| device.kind)).with("name", operand(0))
        }
        ElementKind::Jump(label) => Message::new("element.jump").with("name", label.of(chunk)),
        ElementKind::Return => Message::new("element.return"),
        ElementKind::ConnectorOut(name) => Message::new("element.connector-out").with("name", name.of(chunk)),
        ElementKind::ConnectorIn(name) => Message::new("element.connector-in").with("name", name.of(chunk)),
        ElementKind::Instruction { .. } | ElementKind::Block(_) => return None,
    };
    Some(message.render(language))
}

fn contact(kind: ContactKind) -> Message {
    match kind {
        ContactKind::NormallyOpen => Message::new("element.contact-normally-open"),
        ContactKind::NormallyClosed => Message::new("element.contact-normally-closed"),
        ContactKind::Rising => Message::new("element.contact-rising"),
        ContactKind::Falling => Message::new("element.contact-falling"),
    }
}

fn coil(kind: CoilKind, device: Option<DeviceKind>) -> Message {
    match (kind, device) {
        (CoilKind::Plain, Some(DeviceKind::T)) => Message::new("element.coil-timer"),
        (CoilKind::Plain, Some(DeviceKind::C)) => Message::new("element.coil-counter"),
        (CoilKind::Plain, _) => Message::new("element.coil-plain"),
        (CoilKind::Negated, _) => Message::new("element.coil-negated"),
        (CoilKind::Set, _) => Message::new("element.coil-set"),
        (CoilKind::Reset, _) => Message::new("element.coil-reset"),
        (CoilKind::Rising, _) => Message::new("element.coil-rising"),
        (CoilKind::Falling, _) => Message::new("element.coil-falling"),
        (CoilKind::Toggle, _) => Message::new("element.coil-toggle"),
    }
}
