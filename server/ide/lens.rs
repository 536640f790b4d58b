//! Lines of information above rungs: program steps, uses of what the rung drives, the next free devices.

use super::bookkeeping::Book;
use super::names::Thing;
use super::uses;
use crate::document::{Chunk, Document, Operation, ProjectView, Symbol, Tree};
use crate::ladder::Rung;
use crate::target::{Device, DeviceKind};
use crate::text::{Language, Message, Span};

/// A client asks for all lenses of a file after each edit, and makes a line of its view of each rung with some: with
/// more of them the list itself would slow the editor down. A last lens says so where they end.
const MOST: usize = 3000;

/// So many outputs of one rung have a lens.
const OUTPUTS: usize = 4;

/// The kinds of which the head of a file tells the next free one.
const COUNTED: [DeviceKind; 5] = [DeviceKind::M, DeviceKind::T, DeviceKind::C, DeviceKind::D, DeviceKind::S];

/// Which lenses are wanted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LensSettings {
    /// The program steps of each rung.
    pub steps: bool,
    /// How often the outputs of a rung are used.
    pub references: bool,
    /// The next free devices, above the first line.
    pub next_free: bool,
}

/// A lens without its words.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Lens {
    /// The line above which it stands.
    pub span: Span,
    /// What it tells.
    pub kind: LensKind,
}

/// What a lens tells.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum LensKind {
    /// The program steps of the rung.
    Steps,
    /// How often the device is used.
    References(Device),
    /// The next free devices.
    NextFree,
    /// The rungs from here on have none.
    More,
}

pub(super) fn of(document: &Document, wanted: LensSettings) -> Vec<Lens> {
    let mut lenses = Vec::new();
    if wanted.next_free && document.target().is_fx() && !document.is_empty() {
        lenses.push(Lens { span: Span::at(0), kind: LensKind::NextFree });
    }
    if !wanted.steps && !wanted.references {
        return lenses;
    }
    for at in document.chunks() {
        for (span, outputs) in rungs(at.chunk) {
            let span = span.shifted(at.start);
            if lenses.len() + 1 + OUTPUTS > MOST {
                lenses.push(Lens { span, kind: LensKind::More });
                return lenses;
            }
            if wanted.steps && document.target().is_fx() {
                lenses.push(Lens { span, kind: LensKind::Steps });
            }
            if wanted.references {
                let outputs = outputs.into_iter().take(OUTPUTS);
                lenses.extend(outputs.map(|device| Lens { span, kind: LensKind::References(device) }));
            }
        }
    }
    lenses
}

/// The first line of each rung of a chunk, and the devices that it drives.
fn rungs(chunk: &Chunk) -> Vec<(Span, Vec<Device>)> {
    let driven = |within: Span| {
        let mentions = chunk.mentions().iter().filter(|mention| {
            mention.usage.writes() && within.start <= mention.span.start && mention.span.end <= within.end
        });
        let mut devices: Vec<Device> = Vec::new();
        for mention in mentions {
            if let Symbol::Device(device) = mention.symbol
                && !devices.contains(&device)
            {
                devices.push(device);
            }
        }
        devices
    };
    match chunk.tree() {
        Tree::Ladder(tree) => {
            tree.rungs.iter().map(|rung| (Span::at(rung.span.start as usize), driven(rung.span))).collect()
        }
        Tree::Fx(tree) if chunk.size().rungs > 0 => {
            let first = tree.lines.first().map_or(0, |line| line.span.start as usize);
            vec![(Span::at(first), driven(Span::new(0, chunk.len())))]
        }
        _ => Vec::new(),
    }
}

pub(super) fn title(
    view: &ProjectView<'_>,
    offset: usize,
    kind: &LensKind,
    language: Language,
) -> Option<String> {
    let counted = |one: Message, many: Message, count: usize| match count {
        1 => one,
        _ => many.with("count", count),
    };
    let message = match kind {
        LensKind::Steps => {
            let found = view.here().chunk_at(offset)?;
            let steps = steps(found.chunk, offset.checked_sub(found.start)?)?;
            counted(Message::new("lens.step"), Message::new("lens.steps"), steps as usize)
        }
        LensKind::References(device) => {
            let uses = uses::collect(view, &Thing::Devices(*device, 1), 0);
            let count = uses.reads.total.max(uses.jumps.total);
            let said = view.here().comments().of_device(*device).filter(|row| !row.symbol.is_empty());
            let name = said.map_or_else(|| device.to_string(), |row| format!("{device} {}", row.symbol));
            let one = Message::new("lens.reference").with("name", &name);
            counted(one, Message::new("lens.references").with("name", &name), count)
        }
        LensKind::More => Message::new("lens.more").with("count", MOST),
        LensKind::NextFree => {
            let devices = next_free(view);
            Message::new("lens.next-free").with("devices", devices.join(", "))
        }
    };
    Some(message.render(language))
}

/// The program steps of the rung at byte `inside` of a chunk.
fn steps(chunk: &Chunk, inside: usize) -> Option<u32> {
    let Tree::Ladder(tree) = chunk.tree() else { return Some(chunk.size().steps) };
    let rung: &Rung = tree.rungs.iter().find(|rung| rung.span.touches(inside))?;
    let operations = rung.graph.elements.iter().filter_map(Operation::of_element);
    Some(operations.map(|operation| operation.steps()).fold(0, u32::saturating_add))
}

/// The next free device of each kind that the program uses, in its first range with room.
fn next_free(view: &ProjectView<'_>) -> Vec<String> {
    let book = Book::of(view);
    let target = view.here().target();
    let comments = view.here().comments();
    let is_used = |kind: &DeviceKind| book.devices.keys().any(|device| device.kind == *kind);
    let kinds: Vec<DeviceKind> = COUNTED.into_iter().filter(is_used).collect();
    let kinds = if kinds.is_empty() { vec![DeviceKind::M] } else { kinds };
    let free = kinds.into_iter().filter_map(|kind| {
        target
            .ranges(kind)
            .find_map(|range| book.free(range, 1, |device| comments.of_device(device).is_some()))
    });
    free.map(|device| device.to_string()).collect()
}
