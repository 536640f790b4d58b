//! Devices, constants and labels that an operand takes: those in use first, then free ones, special ones by meaning.

use super::{Place, Proposal};
use crate::document::{Document, Symbol, Use};
use crate::ide::names::{self, Thing};
use crate::ide::{CompletionKind, devices};
use crate::target::{Accepts, Access, Device, DeviceKind, DeviceRange, Form, Operand};
use crate::text::{Encoding, Message, phrase};
use rustc_hash::FxHashMap;

/// More devices in use are not proposed; typing narrows the choice.
const USED_LIMIT: usize = 200;

/// The first special relay and register.
const SPECIAL: u32 = 8000;

/// The first counter that counts an input by itself; which one is free depends on the wiring.
const HIGH_SPEED: u32 = 235;

/// Proposes what operand number `given.len()` of `form` may be, after the operands `given`.
pub(super) fn propose(place: &mut Place<'_>, typed: &str, form: Form, given: &[Operand]) {
    let Some(spec) = form.instruction.operands.get(given.len()) else { return };
    let driven = given.first().and_then(Operand::device);
    let counts = driven.is_some_and(|device| matches!(device.kind, DeviceKind::T | DeviceKind::C));
    if spec.optional && !counts {
        return;
    }
    let accepts = spec.accepts.on(place.document.target().model);
    let wide = form.wide && accepts.contains(Accepts::D);
    let count = if wide { 2 } else { u32::from(spec.count.max(1)) };
    propose_devices(place, typed, accepts, spec.access, count);
    if accepts.contains(Accepts::P) {
        propose_labels(place, typed, form.instruction.mnemonic == "CALL");
    }
    propose_constants(
        place,
        typed,
        accepts,
        form.constant_limits(given.len(), given),
        driven.filter(|_| spec.optional),
    );
}

/// Proposes devices of the kinds in `accepts`, in runs of `count`.
pub(super) fn propose_devices(
    place: &mut Place<'_>,
    typed: &str,
    accepts: Accepts,
    access: Access,
    count: u32,
) {
    let target = place.document.target();
    let takes = |kind: DeviceKind| accepts.contains(Accepts::of_kind(kind));
    let is_label = |kind: DeviceKind| matches!(kind, DeviceKind::P | DeviceKind::I);
    let used = used_devices(place.document);
    let mut listed: Vec<(Device, u32)> = used.iter().map(|(device, uses)| (*device, *uses)).collect();
    listed.retain(|(device, _)| takes(device.kind) && !is_label(device.kind) && starts_with(*device, typed));
    listed.retain(|(device, _)| !(device.kind == DeviceKind::X && access != Access::Read));
    listed.sort_by_key(|(device, uses)| (std::cmp::Reverse(*uses), *device));
    for (rank, (device, uses)) in listed.into_iter().take(USED_LIMIT).enumerate() {
        let message =
            if uses == 1 { Message::new("complete.used-once") } else { Message::new("complete.used") };
        let kind = match device.special_on(target) {
            Some(special) => phrase(special.meaning, place.language).to_string(),
            None => devices::kind_name(device.kind, place.language),
        };
        let detail = message.with("kind", kind).with("count", uses).render(place.language);
        place.propose(
            typed,
            Proposal::new(device.to_string(), CompletionKind::Device, detail, 10 + rank as u16),
        );
    }
    for (rank, range) in target.devices.iter().enumerate() {
        let is_counting_input = range.kind == DeviceKind::C && range.first >= HIGH_SPEED;
        let is_proposed =
            takes(range.kind) && !is_label(range.kind) && range.first < SPECIAL && !is_counting_input;
        if let (true, Some(free)) = (is_proposed, free_in(range, &used, count)) {
            let kind = devices::purpose(range, place.language);
            let detail = Message::new("complete.free").with("kind", kind).render(place.language);
            // Where a word is wanted, registers are what most people want.
            let is_register = matches!(range.kind, DeviceKind::D | DeviceKind::R);
            let aside = accepts.contains(Accepts::D) && !is_register;
            let rank = if aside { 360 } else { 300 } + rank as u16;
            place.propose(typed, Proposal::new(free.to_string(), CompletionKind::Device, detail, rank));
        }
    }
    propose_special(place, typed, accepts, access, &used);
}

/// How often each device is named.
pub(super) fn used_devices(document: &Document) -> FxHashMap<Device, u32> {
    let mut used = FxHashMap::default();
    for page in document.pages() {
        for (symbol, count) in page.names().symbols() {
            // Devices come first in the order of symbols.
            let Symbol::Device(device) = symbol else { break };
            *used.entry(*device).or_insert(0) += count;
        }
    }
    used
}

fn starts_with(device: Device, typed: &str) -> bool {
    typed.is_empty()
        || device.to_string().get(..typed.len()).is_some_and(|head| head.eq_ignore_ascii_case(typed))
}

/// The first run of `count` devices of `range` that nothing uses.
fn free_in(range: &DeviceRange, used: &FxHashMap<Device, u32>, count: u32) -> Option<Device> {
    let device = |number| Device::new(range.kind, number);
    let is_free = |first: u32| (first..first + count).all(|number| !used.contains_key(&device(number)));
    let last = range.last.checked_sub(count - 1)?;
    (range.first..=last).find(|first| is_free(*first)).map(device)
}

/// Special relays and registers, once their number is begun: there are hundreds.
fn propose_special(
    place: &mut Place<'_>,
    typed: &str,
    accepts: Accepts,
    access: Access,
    used: &FxHashMap<Device, u32>,
) {
    let begun = typed.get(1..).is_some_and(|number| number.starts_with('8'));
    if !begun {
        return;
    }
    for special in place.document.target().special {
        let device = special.device;
        let takes =
            accepts.contains(Accepts::of_kind(device.kind)) && (special.writable || access == Access::Read);
        if takes && !used.contains_key(&device) && starts_with(device, typed) {
            let rank = 500 + (device.number.saturating_sub(SPECIAL) as u16).min(999);
            place.propose(
                typed,
                Proposal::new(
                    device.to_string(),
                    CompletionKind::Device,
                    phrase(special.meaning, place.language),
                    rank,
                ),
            );
        }
    }
}

fn propose_constants(
    place: &mut Place<'_>,
    typed: &str,
    accepts: Accepts,
    (least, greatest): (i64, i64),
    driven: Option<Device>,
) {
    let kind = CompletionKind::Constant;
    let language = place.language;
    if accepts.contains(Accepts::K) {
        let unit = driven.and_then(|device| devices::timer_unit(device, place.document.target()));
        let limits = match unit {
            Some(unit) => format!("{least}–{greatest}, × {unit} ms"),
            None => format!("{least}–{greatest}"),
        };
        let detail = format!("{}, {limits}", Message::new("complete.constant-decimal").render(language));
        let rank = if driven.is_some() { 5 } else { 440 };
        place.propose(typed, Proposal::new("K", kind, detail, rank).snippet("K${1:1}"));
        let detail = Message::new("complete.constant-hexadecimal").render(language);
        place.propose(typed, Proposal::new("H", kind, detail, 441).snippet("H${1:0}"));
    }
    if accepts.contains(Accepts::E) {
        let detail = Message::new("complete.constant-real").render(language);
        place.propose(typed, Proposal::new("E", kind, detail, 442).snippet("E${1:1.0}"));
    }
    let groups = [(Accepts::KNX, 'X'), (Accepts::KNY, 'Y'), (Accepts::KNM, 'M'), (Accepts::KNS, 'S')];
    for (rank, (group, letter)) in groups.into_iter().enumerate() {
        if accepts.contains(group) {
            let detail = format!("16 × {}", devices::kind_name(group_kind(letter), language));
            let label = format!("K4{letter}0");
            let snippet = format!("K${{1:4}}{letter}${{2:0}}");
            place.propose(
                typed,
                Proposal::new(label, CompletionKind::Device, detail, 450 + rank as u16).snippet(snippet),
            );
        }
    }
}

fn group_kind(letter: char) -> DeviceKind {
    DeviceKind::of_letter(letter).unwrap_or(DeviceKind::M)
}

/// The labels of the program, where they stand, and a free one.
fn propose_labels(place: &mut Place<'_>, typed: &str, calls: bool) {
    let document = place.document;
    let used = used_devices(document);
    let mut pointers: Vec<Device> =
        used.keys().filter(|device| device.kind == DeviceKind::P).copied().collect();
    pointers.sort();
    for pointer in pointers {
        let mut line = None;
        names::visit(document, &Thing::Devices(pointer, 1), |named| {
            if named.usage == Use::Declare && line.is_none() {
                line = Some(document.position(named.span.start as usize, Encoding::Utf8).line + 1);
            }
        });
        if let Some(line) = line {
            let detail = Message::new("complete.label").with("line", line).render(place.language);
            place.propose(typed, Proposal::new(pointer.to_string(), CompletionKind::Label, detail, 5));
        }
    }
    // P63 means the end of the program to a jump, and nothing to a call.
    let ranges = document.target().ranges(DeviceKind::P).filter(|range| !calls || range.first != 63);
    let mut free = ranges.filter_map(|range| free_in(range, &used, 1));
    if let Some(free) = free.next() {
        let detail = Message::new("complete.label-free").render(place.language);
        place.propose(typed, Proposal::new(free.to_string(), CompletionKind::Label, detail, 310));
    }
}
