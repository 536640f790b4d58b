//! Where a program drives a variable.

use crate::document::{Document, Symbol};
use crate::simulate::Place;
use crate::target::{Device, DeviceKind, Operand};
use crate::text::folded;

/// The last place among `documents` that writes the variable which people call `name`; nothing if none does.
pub fn driver(documents: &[&Document], name: &str) -> Option<Place> {
    let symbol = |document: &Document| match Operand::read(&device_of(name), document.target().model) {
        Operand::Device(device) => Symbol::Device(device),
        Operand::Direct(address) => Symbol::Direct(address),
        _ => Symbol::Variable(folded(name.rsplit('.').next().unwrap_or(name))),
    };
    let mut found = None;
    for (number, document) in (0..).zip(documents) {
        let wanted = symbol(document);
        for at in document.chunks() {
            let mut own = at.chunk.mentions().iter().filter(|mention| mention.usage.writes());
            let last = own.rfind(|mention| covers(&mention.symbol, mention.count, &wanted));
            if let Some(mention) = last {
                found = Some(Place { document: number, span: mention.span.shifted(at.start) });
            }
        }
    }
    found
}

/// `T0` of `TS0`, the contact of the timer, and its kin; `D0` of the pair `D0:32`.
fn device_of(name: &str) -> String {
    let name = name.trim().trim_end_matches(":32");
    let mut letters = name.chars();
    let has_parts = letters.next().and_then(DeviceKind::of_letter).is_some_and(DeviceKind::has_preset);
    match (letters.next(), has_parts) {
        (Some('S' | 'C' | 'N' | 's' | 'c' | 'n'), true) => format!("{}{}", &name[..1], letters.as_str()),
        _ => name.to_string(),
    }
}

fn covers(symbol: &Symbol, count: u16, wanted: &Symbol) -> bool {
    match (symbol, wanted) {
        (Symbol::Device(first), Symbol::Device(device)) => is_within(*first, count, *device),
        _ => symbol == wanted,
    }
}

fn is_within(first: Device, count: u16, device: Device) -> bool {
    let numbers = first.number..first.number.saturating_add(u32::from(count.max(1)));
    first.kind == device.kind && numbers.contains(&device.number)
}

/// Whether devices of this kind are at the terminals of the PLC.
pub(super) fn is_output(name: &str) -> bool {
    let mut letters = name.trim().chars();
    let is_numbered =
        name.trim().get(1..).is_some_and(|rest| rest.starts_with(|letter: char| letter.is_ascii_digit()));
    let is_device = letters.next().and_then(DeviceKind::of_letter) == Some(DeviceKind::Y) && is_numbered;
    is_device || name.trim().to_ascii_uppercase().starts_with("%Q")
}
