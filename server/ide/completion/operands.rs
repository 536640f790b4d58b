//! Devices, constants and labels that an operand takes: those in use first, then free ones, special ones by meaning.

use super::{Place, Proposal, is_abbreviation, is_found_by};
use crate::document::{Symbol, Use};
use crate::ide::bookkeeping::Book;
use crate::ide::names::Thing;
use crate::ide::{CompletionKind, devices, uses};
use crate::target::{Accepts, Access, Device, DeviceKind, DeviceRange, Flow, Form, Operand};
use crate::text::{Message, phrase};

/// More devices in use are not proposed; typing narrows the choice.
const USED_LIMIT: usize = 200;

/// More symbols and devices with a comment are not proposed.
const LIMIT: u16 = 200;

/// The ranks of groups: free devices where a new one is wanted, those in use, those with a comment, free ones.
const FRESH: u16 = 20;
const USED: u16 = 100;
const COMMENTED: u16 = 310;
const FREE: u16 = 600;
const FREE_ASIDE: u16 = 700;

/// The first special relay and register.
const SPECIAL: u32 = 8000;

/// The first counter that counts an input by itself; which one is free depends on the wiring.
const HIGH_SPEED: u32 = 235;

/// Proposes what operand number `given.len()` of `form` may be, after the operands `given`.
pub(super) fn propose(place: &mut Place<'_>, typed: &str, form: Form, given: &[Operand]) {
    let Some(spec) = form.instruction.operands.get(given.len()) else { return };
    let driven = given.first().and_then(Operand::device);
    let counts = driven.is_some_and(|device| device.kind.has_preset());
    if spec.optional && !counts {
        return;
    }
    let accepts = spec.accepts.on(place.document.target().model);
    let wide = form.wide && accepts.contains(Accepts::D);
    let count = if wide { 2 } else { u32::from(spec.count.max(1)) };
    // What is written for the first time wants a new device; a reset, which takes registers as well, is for one that
    // something else sets.
    let is_fresh = spec.access == Access::Write && !accepts.contains(Accepts::D);
    let wanted = Wanted { accepts, access: spec.access, count, is_fresh };
    propose_devices(place, typed, &wanted);
    if accepts.contains(Accepts::P) {
        propose_labels(place, typed, form.instruction.flow() == Flow::Call);
    }
    propose_constants(
        place,
        typed,
        accepts,
        form.constant_limits(given.len(), given),
        driven.filter(|_| spec.optional),
    );
}

/// Which devices fit.
pub(super) struct Wanted {
    /// Of these kinds.
    pub accepts: Accepts,
    /// What is done with them.
    pub access: Access,
    /// In runs of so many.
    pub count: u32,
    /// Whether a device that nothing uses yet is the likeliest.
    pub is_fresh: bool,
}

impl Wanted {
    fn takes(&self, kind: DeviceKind) -> bool {
        let is_label = kind.is_pointer();
        let is_written = self.access != Access::Read;
        self.accepts.contains(Accepts::of_kind(kind)) && !is_label && !(kind == DeviceKind::X && is_written)
    }
}

/// Proposes the devices that are wanted: those in use, those with a comment, and the next free one of each range.
pub(super) fn propose_devices(place: &mut Place<'_>, typed: &str, wanted: &Wanted) {
    let mut book = Book::of(place.view);
    if let Some((device, usage)) = typed_device(place) {
        book.forget(device, usage);
    }
    propose_used(place, typed, wanted, &book);
    propose_commented(place, typed, wanted, &book);
    propose_free(place, typed, wanted, &book);
    propose_special(place, typed, wanted, &book);
}

/// The device that is being typed and the use that it would be.
fn typed_device(place: &Place<'_>) -> Option<(Device, Use)> {
    let inside = place.offset - place.chunk_start;
    let mention = place.chunk?.mentions().iter().find(|mention| mention.span.end as usize == inside)?;
    match mention.symbol {
        Symbol::Device(device) => Some((device, mention.usage)),
        _ => None,
    }
}

fn propose_used(place: &mut Place<'_>, typed: &str, wanted: &Wanted, book: &Book) {
    let target = place.document.target();
    let comments = place.document.comments().clone();
    let search = |device: Device| comments.of_device(device).map(|row| row.words()).unwrap_or_default();
    let fits = |device: Device| starts_with(device, typed) || is_found_by(typed, &search(device));
    let mut listed: Vec<(Device, u32)> = book
        .devices
        .iter()
        .filter(|(device, _)| wanted.takes(device.kind) && fits(**device))
        .map(|(device, tally)| (*device, tally.mentions))
        .collect();
    listed.sort_by_key(|(device, uses)| (std::cmp::Reverse(*uses), *device));
    for (rank, (device, _)) in listed.into_iter().take(USED_LIMIT).enumerate() {
        let kind = match device.special_on(target) {
            Some(special) => phrase(special.meaning, place.language).to_string(),
            None => devices::kind_name(device.kind, place.language),
        };
        let uses = book.words(device, place.view, place.language);
        let parts = [search(device), kind, uses];
        let detail = parts.iter().filter(|part| !part.is_empty()).cloned().collect::<Vec<_>>().join(", ");
        let mut proposal =
            Proposal::new(device.to_string(), CompletionKind::Device, detail, USED + rank as u16);
        proposal.search = search(device);
        place.propose(typed, proposal);
    }
}

/// Symbols, and devices that have a comment and are not used yet.
fn propose_commented(place: &mut Place<'_>, typed: &str, wanted: &Wanted, book: &Book) {
    let comments = place.document.comments().clone();
    let target = place.document.target();
    let mut rank = COMMENTED;
    for row in comments.rows() {
        let Symbol::Device(device) = row.thing else { continue };
        if !wanted.takes(device.kind) || device.range_on(target).is_none() || rank >= COMMENTED + LIMIT {
            continue;
        }
        let words = row.words();
        let fits = starts_with(device, typed) || is_found_by(typed, &words);
        if !row.symbol.is_empty() && (fits || is_abbreviation(typed, &row.symbol)) {
            let detail = [device.to_string().as_str(), row.comment.as_str()].join(" ").trim().to_string();
            let mut proposal = Proposal::new(row.symbol.as_str(), CompletionKind::Variable, detail, rank);
            proposal.search = format!("{device} {}", row.comment);
            place.propose(typed, proposal);
            rank += 1;
        }
        if fits && !book.devices.contains_key(&device) {
            let kind = devices::kind_name(device.kind, place.language);
            let unused = Message::new("usage-words.unused").render(place.language);
            let detail = format!("{words}, {kind}, {unused}");
            let mut proposal = Proposal::new(device.to_string(), CompletionKind::Device, detail, rank);
            proposal.search = words;
            place.propose(typed, proposal);
            rank += 1;
        }
    }
}

fn propose_free(place: &mut Place<'_>, typed: &str, wanted: &Wanted, book: &Book) {
    let target = place.document.target();
    let comments = place.document.comments().clone();
    let mut seen: Vec<&DeviceRange> = Vec::new();
    for (rank, range) in target.devices.iter().enumerate() {
        let is_counting_input = range.kind == DeviceKind::C && range.first >= HIGH_SPEED;
        let is_proposed = wanted.takes(range.kind) && range.first < SPECIAL && !is_counting_input;
        // Of two ranges of the same purpose the first one that has room is enough.
        let is_same = |other: &&DeviceRange| other.kind == range.kind && other.purpose == range.purpose;
        if !is_proposed || seen.iter().any(is_same) {
            continue;
        }
        let reserved = |device| comments.of_device(device).is_some();
        let Some(free) = book.free(range, wanted.count, reserved) else { continue };
        seen.push(range);
        let kind = devices::purpose(range, place.language);
        let detail = Message::new("complete.free").with("kind", kind).render(place.language);
        // Where a word is wanted, registers are what most people want.
        let is_register = matches!(range.kind, DeviceKind::D | DeviceKind::R);
        let is_aside = wanted.accepts.contains(Accepts::D) && !is_register;
        let first = match (wanted.is_fresh, is_aside) {
            (true, _) => FRESH,
            (false, false) => FREE,
            (false, true) => FREE_ASIDE,
        };
        let rank = first + rank as u16;
        place.propose(typed, Proposal::new(free.to_string(), CompletionKind::Device, detail, rank));
    }
}

fn starts_with(device: Device, typed: &str) -> bool {
    typed.is_empty()
        || device.to_string().get(..typed.len()).is_some_and(|head| head.eq_ignore_ascii_case(typed))
}

/// Special relays and registers, once their number is begun: there are hundreds.
fn propose_special(place: &mut Place<'_>, typed: &str, wanted: &Wanted, book: &Book) {
    let begun = typed.get(1..).is_some_and(|number| number.starts_with('8'));
    if !begun {
        return;
    }
    for special in place.document.target().special {
        let device = special.device;
        let takes = wanted.takes(device.kind) && (special.writable || wanted.access == Access::Read);
        if takes && !book.devices.contains_key(&device) && starts_with(device, typed) {
            let rank = 900 + (device.number.saturating_sub(SPECIAL) as u16).min(999);
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
        let rank = if driven.is_some() { 5 } else { 840 };
        place.propose(typed, Proposal::new("K", kind, detail, rank).snippet("K${1:1}"));
        let detail = Message::new("complete.constant-hexadecimal").render(language);
        place.propose(typed, Proposal::new("H", kind, detail, 841).snippet("H${1:0}"));
    }
    if accepts.contains(Accepts::E) {
        let detail = Message::new("complete.constant-real").render(language);
        place.propose(typed, Proposal::new("E", kind, detail, 842).snippet("E${1:1.0}"));
    }
    let groups = [(Accepts::KNX, 'X'), (Accepts::KNY, 'Y'), (Accepts::KNM, 'M'), (Accepts::KNS, 'S')];
    for (rank, (group, letter)) in groups.into_iter().enumerate() {
        if accepts.contains(group) {
            let detail = format!("16 × {}", devices::kind_name(group_kind(letter), language));
            let label = format!("K4{letter}0");
            let snippet = format!("K${{1:4}}{letter}${{2:0}}");
            place.propose(
                typed,
                Proposal::new(label, CompletionKind::Device, detail, 850 + rank as u16).snippet(snippet),
            );
        }
    }
}

fn group_kind(letter: char) -> DeviceKind {
    DeviceKind::of_letter(letter).unwrap_or(DeviceKind::M)
}

/// The labels of the program, where they stand, and a free one.
fn propose_labels(place: &mut Place<'_>, typed: &str, calls: bool) {
    let book = Book::of(place.view);
    let mut pointers: Vec<Device> =
        book.devices.keys().filter(|device| device.kind == DeviceKind::P).copied().collect();
    pointers.sort();
    for pointer in pointers {
        let uses = uses::collect(place.view, &Thing::Devices(pointer, 1), 1);
        if let Some(defined) = uses.declared.places.first() {
            let style = uses::Style { view: place.view, language: place.language, link: &|_, _| None };
            let jumps =
                Message::new("usage-words.jumped").with("count", uses.jumps.total).render(place.language);
            let label = Message::new("usage-words.label").with("place", style.words(defined));
            let detail = match uses.jumps.total {
                0 => label.render(place.language),
                _ => format!("{}, {jumps}", label.render(place.language)),
            };
            place.propose(typed, Proposal::new(pointer.to_string(), CompletionKind::Label, detail, 5));
        }
    }
    // P63 means the end of the program to a jump, and nothing to a call.
    let mut ranges =
        place.document.target().ranges(DeviceKind::P).filter(|range| !calls || range.first != 63);
    if let Some(free) = ranges.find_map(|range| book.free(range, 1, |_| false)) {
        let detail = Message::new("complete.label-free").render(place.language);
        place.propose(typed, Proposal::new(free.to_string(), CompletionKind::Label, detail, 310));
    }
}

/// Labels that something jumps to and that stand nowhere yet, for the start of a line.
pub(super) fn propose_missing_labels(place: &mut Place<'_>, typed: &str) {
    if !typed.starts_with(['P', 'p', 'I', 'i']) {
        return;
    }
    let book = Book::of(place.view);
    let is_label = |device: &&Device| device.kind == DeviceKind::P && starts_with(**device, typed);
    let mut pointers: Vec<Device> = book.devices.keys().filter(is_label).copied().collect();
    pointers.sort();
    for pointer in pointers {
        let uses = uses::collect(place.view, &Thing::Devices(pointer, 1), 1);
        if uses.declared.total == 0 {
            let detail = Message::new("usage-words.jumped-nowhere").with("count", uses.jumps.total);
            let detail = detail.render(place.language);
            place.propose(typed, Proposal::new(pointer.to_string(), CompletionKind::Label, detail, 3));
        }
    }
}
