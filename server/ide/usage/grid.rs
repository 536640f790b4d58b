//! The list of used devices as text: a grid for each kind of device, then every device with its uses.

use super::{Usage, UsageKey, UsageKind, UsageRow, access_words};
use crate::document::ProjectView;
use crate::ide::{devices, uses};
use crate::target::{Device, DeviceKind};
use crate::text::{Language, Message, text_width};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// So many runs of free devices of a kind are listed.
const GAPS: usize = 16;

/// What is done with a device, for its cell.
#[derive(Clone, Copy, Default)]
struct Mark {
    read: bool,
    written: bool,
    coil: bool,
    other: bool,
}

impl Mark {
    /// Two characters: how it is read, how it is written.
    fn cell(self) -> String {
        let left = if self.read { 'r' } else { '-' };
        let right = match (self.coil, self.written, self.other) {
            (true, ..) => 'o',
            (_, true, _) => 'w',
            (_, _, true) => '*',
            _ => '-',
        };
        format!("{left}{right}")
    }
}

pub(super) fn text(usage: &Usage, view: &ProjectView<'_>, language: Language) -> String {
    let marks = marks(usage);
    let mut text = Message::new("usage.title").render(language) + "\n";
    text += &(Message::new("usage.legend").render(language) + "\n");
    if usage.rows.is_empty() {
        return text + "\n" + &Message::new("usage.nothing").render(language) + "\n";
    }
    for kind in DeviceKind::ALL {
        text += &grid(kind, &marks, language);
        text += &unused(kind, usage, language);
    }
    text.push('\n');
    for row in &usage.rows {
        text += &listed(row, view, language);
    }
    text
}

fn marks(usage: &Usage) -> FxHashMap<Device, Mark> {
    let mut marks: FxHashMap<Device, Mark> = FxHashMap::default();
    for row in &usage.rows {
        let UsageKey::Device(device) = row.key else { continue };
        for at in &row.uses {
            let end = device.number.saturating_add(u32::from(at.count.max(1)));
            for number in device.number..end {
                let mark = marks.entry(Device::new(device.kind, number)).or_default();
                mark.read |= at.usage.reads();
                mark.written |= at.usage.writes();
                mark.coil |= at.by_coil;
                mark.other |= !at.usage.reads() && !at.usage.writes();
            }
        }
    }
    marks
}

/// Rows of ten devices; of eight for inputs and outputs, whose numbers are octal. Rows without a device are left out.
fn grid(kind: DeviceKind, marks: &FxHashMap<Device, Mark>, language: Language) -> String {
    let columns = kind.number_base();
    let used = marks.keys().filter(|device| device.kind == kind);
    let rows: BTreeSet<u32> = used.map(|device| device.number / columns).collect();
    if rows.is_empty() {
        return String::new();
    }
    let mut text = format!("\n{} {}\n{:8}", kind.letter(), devices::kind_name(kind, language), "");
    for column in 0..columns {
        text += &format!("  {column} ");
    }
    for row in rows {
        text.truncate(text.trim_end().len());
        let first = Device::new(kind, row * columns);
        text += &format!("\n{:<8}", first.to_string());
        for number in first.number..first.number.saturating_add(columns) {
            match marks.get(&Device::new(kind, number)) {
                Some(mark) => text += &format!(" {} ", mark.cell()),
                None => text += "  . ",
            }
        }
    }
    text.truncate(text.trim_end().len());
    text + "\n"
}

/// `free in between: M3–M5, M8; next free: M9`
fn unused(kind: DeviceKind, usage: &Usage, language: Language) -> String {
    let Some(own) = usage.kinds.iter().find(|own| own.kind == UsageKind::Device(kind)) else {
        return String::new();
    };
    let gaps = usage.rows.iter().filter(|row| row.key.kind() == own.kind).flat_map(|row| &row.gaps);
    let mut names: Vec<String> =
        gaps.clone().take(GAPS).map(|(first, last)| run_name(*first, *last)).collect();
    let more = gaps.count().saturating_sub(GAPS);
    if more > 0 {
        names.push(Message::new("usage.more-gaps").with("count", more).render(language));
    }
    let between = Message::new("usage.gaps").with_words("devices", names.iter().map(String::as_str), ", ");
    let next = own.next.map(|device| Message::new("lens.next-free").with("devices", device));
    let parts = [Some(between).filter(|_| !names.is_empty()), next];
    let parts: Vec<String> = parts.into_iter().flatten().map(|part| part.render(language)).collect();
    if parts.is_empty() { String::new() } else { parts.join("; ") + "\n" }
}

/// `M3–M5`, or one device.
fn run_name(first: Device, last: Device) -> String {
    if first == last { first.to_string() } else { format!("{first}–{last}") }
}

/// `Y0       Motor: contactor`, and below each use in a line.
fn listed(row: &UsageRow, view: &ProjectView<'_>, language: Language) -> String {
    let said = match (row.symbol.is_empty(), row.comment.is_empty()) {
        (false, false) => format!("{}: {}", row.symbol, row.comment),
        _ => format!("{}{}", row.symbol, row.comment),
    };
    let name = row.full_name();
    let blanks = " ".repeat(9usize.saturating_sub(text_width(&name)).max(1));
    let mut text = format!("{name}{blanks}{}", [said.as_str(), row.preset.as_str()].join("  ").trim());
    text.truncate(text.trim_end().len());
    for at in &row.uses {
        let place = uses::place_words(at.rung, at.line, language);
        let file = view.members().get(at.file).map_or("", |member| member.name);
        let file = if file.is_empty() { String::new() } else { format!("{file}, ") };
        text += &format!("\n    {file}{place}: {} — {}", access_words(at.usage, language), at.text);
    }
    text + "\n"
}
