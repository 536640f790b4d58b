//! Which devices and addresses a project uses, how often and where first: folds of the names of pages.

use super::uses;
use crate::document::{ChunkRef, Mention, ProjectView, Symbol, Use};
use crate::target::{Device, DeviceRange, DirectAddress, Width};
use crate::text::{Language, Message};
use rustc_hash::{FxHashMap, FxHashSet};

/// How a device or address is used.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Tally {
    pub mentions: u32,
    pub reads: u32,
    pub writes: u32,
    /// The first page that writes it: the numbers of file and page.
    first_write: Option<(usize, usize)>,
}

/// The devices and addresses in use.
#[derive(Debug, Default)]
pub(super) struct Book {
    pub devices: FxHashMap<Device, Tally>,
    pub addresses: FxHashMap<DirectAddress, Tally>,
    /// Devices that are used as a part of a run, as M3 in K4M0.
    in_runs: FxHashSet<Device>,
}

impl Book {
    /// The book of all files of `view`.
    pub(super) fn of(view: &ProjectView<'_>) -> Book {
        let mut book = Book::default();
        for (file, member) in view.members().iter().enumerate() {
            for (number, page) in member.document.pages().iter().enumerate() {
                let names = page.names();
                for (symbol, (mentions, (reads, writes))) in names.tallies() {
                    // Devices and addresses come first in the order of symbols.
                    let tally = match symbol {
                        Symbol::Device(device) => book.devices.entry(*device).or_default(),
                        Symbol::Direct(address) => book.addresses.entry(*address).or_default(),
                        _ => break,
                    };
                    tally.mentions += mentions;
                    tally.reads += reads;
                    tally.writes += writes;
                    if writes > 0 {
                        tally.first_write.get_or_insert((file, number));
                    }
                }
                for (first, count) in names.runs() {
                    let end = first.number.saturating_add(u32::from(*count));
                    book.in_runs.extend((first.number..end).map(|number| Device::new(first.kind, number)));
                }
            }
        }
        book
    }

    /// Takes one use of `device` out.
    pub(super) fn forget(&mut self, device: Device, usage: Use) {
        let Some(tally) = self.devices.get_mut(&device) else { return };
        tally.mentions = tally.mentions.saturating_sub(1);
        tally.reads = tally.reads.saturating_sub(u32::from(usage.reads()));
        tally.writes = tally.writes.saturating_sub(u32::from(usage.writes()));
        if tally.mentions == 0 {
            self.devices.remove(&device);
        }
    }

    /// Whether the program uses `device`, alone or as a part of a run.
    pub(super) fn uses(&self, device: Device) -> bool {
        self.devices.contains_key(&device) || self.in_runs.contains(&device)
    }

    /// Whether `device` is used as a part of a run, as M3 in K4M0.
    pub(super) fn is_in_run(&self, device: Device) -> bool {
        self.in_runs.contains(&device)
    }

    /// The first run of `count` devices of `range` that are neither used nor `taken`.
    pub(super) fn free(
        &self,
        range: &DeviceRange,
        count: u32,
        taken: impl Fn(Device) -> bool,
    ) -> Option<Device> {
        let device = |number| Device::new(range.kind, number);
        let is_free = |number: u32| !self.uses(device(number)) && !taken(device(number));
        let last = range.last.checked_sub(count.saturating_sub(1))?;
        (range.first..=last).find(|first| (*first..first + count).all(is_free)).map(device)
    }

    /// `written in rung 3, read in 5 places`; labels are jumped to instead.
    pub(super) fn words(&self, device: Device, view: &ProjectView<'_>, language: Language) -> String {
        let Some(tally) = self.devices.get(&device) else { return String::new() };
        let rung = match tally.first_write {
            Some(page) if tally.writes == 1 => first_writing_rung(&Symbol::Device(device), page, view),
            _ => None,
        };
        tally.words_with(rung, language)
    }
}

impl Tally {
    /// `written 3 ×, read in 5 places`
    pub(super) fn words(&self, language: Language) -> String {
        self.words_with(None, language)
    }

    /// The same, with the rung of the only place that writes.
    fn words_with(&self, rung: Option<usize>, language: Language) -> String {
        let written = match (self.writes, rung) {
            (0, _) => None,
            (_, Some(rung)) => Some(Message::new("usage-words.written-rung").with("rung", rung)),
            (count, None) => Some(Message::new("usage-words.written").with("count", count)),
        };
        let read = match self.reads {
            0 => None,
            1 => Some(Message::new("usage-words.read-once")),
            count => Some(Message::new("usage-words.read").with("count", count)),
        };
        let parts = [written, read].into_iter().flatten().map(|part| part.render(language));
        parts.collect::<Vec<_>>().join(&Message::new("usage-words.comma").render(language))
    }
}

/// The number of the rung in a page that writes `symbol`.
fn first_writing_rung(
    symbol: &Symbol,
    (file, number): (usize, usize),
    view: &ProjectView<'_>,
) -> Option<usize> {
    let document = view.members().get(file)?.document;
    let pages = document.pages();
    let mut start: usize = pages.get(..number)?.iter().map(|page| page.bytes()).sum();
    let writes = |mention: &&Mention| mention.symbol == *symbol && Use::writes(mention.usage);
    for chunk in pages.get(number)?.chunks() {
        if let Some(mention) = chunk.mentions().iter().find(writes) {
            return uses::rung_number(document, ChunkRef { start, chunk }, mention.span.start as usize);
        }
        start += chunk.len();
    }
    None
}

/// The address behind the last one in use of the same area and size; the first one if none is.
pub(super) fn next_address(book: &Book, model: DirectAddress) -> DirectAddress {
    let same = |address: &&DirectAddress| {
        address.location == model.location && address.width == model.width && address.path[0].is_some()
    };
    let Some(last) = book.addresses.keys().filter(same).max_by_key(|address| address.path) else {
        return model;
    };
    let mut next = *last;
    let deepest = next.path.iter().rposition(Option::is_some).unwrap_or(0);
    let number = next.path[deepest].unwrap_or(0);
    // Bits are written by byte and bit.
    if model.width == Width::Bit && deepest > 0 && number >= 7 {
        next.path[deepest] = Some(0);
        next.path[deepest - 1] = next.path[deepest - 1].map(|byte| byte.saturating_add(1));
    } else {
        next.path[deepest] = Some(number.saturating_add(1));
    }
    next
}
