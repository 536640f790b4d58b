//! What a page of chunks names: small and sorted, so that a search for one name passes over the pages without it.

use super::{Chunk, Symbol, Tree, Use};
use crate::il::iec::ItemKind;
use crate::target::Device;
use std::sync::Arc;

/// The names of a page.
#[derive(Debug)]
pub struct Names {
    /// Every symbol with the number of its mentions, sorted.
    symbols: Box<[(Symbol, u32)]>,
    /// For each symbol how often it is read and how often written.
    accesses: Box<[(u32, u32)]>,
    /// The runs of several devices (`K4M0`), each once.
    runs: Box<[(Device, u16)]>,
    pou_starts: usize,
    inside_at_end: Option<bool>,
}

impl Names {
    pub(super) fn of(chunks: &[Arc<Chunk>]) -> Names {
        let mut all: Vec<(&Symbol, Use)> = Vec::new();
        let mut runs = Vec::new();
        let (mut pou_starts, mut inside_at_end) = (0, None);
        for chunk in chunks {
            for mention in chunk.mentions() {
                all.push((&mention.symbol, mention.usage));
                if let (Symbol::Device(device), true) = (&mention.symbol, mention.count > 1) {
                    runs.push((*device, mention.count));
                }
            }
            pou_starts += chunk.pou_starts();
            inside_at_end = chunk.ends_inside_pou().or(inside_at_end);
        }
        all.sort_unstable_by_key(|(symbol, _)| *symbol);
        runs.sort_unstable();
        runs.dedup();
        let (mut symbols, mut accesses) = (Vec::new(), Vec::new());
        for run in all.chunk_by(|left, right| left.0 == right.0) {
            symbols.push((run[0].0.clone(), run.len() as u32));
            let count = |is: fn(Use) -> bool| run.iter().filter(|(_, usage)| is(*usage)).count() as u32;
            accesses.push((count(Use::reads), count(Use::writes)));
        }
        let (symbols, accesses) = (symbols.into_boxed_slice(), accesses.into_boxed_slice());
        Names { symbols, accesses, runs: runs.into_boxed_slice(), pou_starts, inside_at_end }
    }

    /// Whether `symbol` is named.
    pub fn contains(&self, symbol: &Symbol) -> bool {
        self.symbols.binary_search_by(|(own, _)| own.cmp(symbol)).is_ok()
    }

    /// Whether any of the `count` devices from `first` on is named, also as a part of a run.
    pub fn touches(&self, first: Device, count: u16) -> bool {
        let end = first.number.saturating_add(u32::from(count));
        let from = self.symbols.partition_point(|(own, _)| *own < Symbol::Device(first));
        let named = self.symbols.get(from).is_some_and(|(own, _)| {
            matches!(own, Symbol::Device(device) if device.kind == first.kind && device.number < end)
        });
        named
            || self.runs.iter().any(|(device, count)| {
                let run_end = device.number.saturating_add(u32::from(*count));
                device.kind == first.kind && device.number < end && first.number < run_end
            })
    }

    /// Every symbol with the number of its mentions, sorted.
    pub fn symbols(&self) -> &[(Symbol, u32)] {
        &self.symbols
    }

    /// How often `symbol` is read and how often written; runs of devices that begin with another one do not count.
    pub fn accesses(&self, symbol: &Symbol) -> (u32, u32) {
        let found = self.symbols.binary_search_by(|(own, _)| own.cmp(symbol));
        found.ok().and_then(|number| self.accesses.get(number).copied()).unwrap_or_default()
    }

    /// Every symbol with the number of its mentions, and of these how many read and how many write it; sorted.
    pub fn tallies(&self) -> impl Iterator<Item = (&Symbol, (u32, (u32, u32)))> {
        self.symbols.iter().zip(&self.accesses).map(|((symbol, count), access)| (symbol, (*count, *access)))
    }

    /// Whether a run of several devices covers `device`.
    pub fn in_run(&self, device: Device) -> bool {
        self.runs.iter().any(|(first, count)| {
            let end = first.number.saturating_add(u32::from(*count));
            first.kind == device.kind && (first.number..end).contains(&device.number)
        })
    }

    /// The runs of several devices, each once.
    pub fn runs(&self) -> &[(Device, u16)] {
        &self.runs
    }

    /// How many POUs start in the page.
    pub fn pou_starts(&self) -> usize {
        self.pou_starts
    }

    /// Whether the end of the page lies inside of a POU; `None` if none starts or ends in the page.
    pub fn inside_at_end(&self) -> Option<bool> {
        self.inside_at_end
    }
}

impl Chunk {
    /// Whether the text behind it lies inside of a POU; `None` if none starts or ends in it.
    pub fn ends_inside_pou(&self) -> Option<bool> {
        if !self.is_iec() {
            return None;
        }
        let Tree::Iec(tree) = self.tree() else { return None };
        tree.items.iter().rev().find_map(|item| match item.kind {
            ItemKind::Pou { .. } => Some(true),
            ItemKind::PouEnd(_) | ItemKind::Configuration { .. } => Some(false),
            _ => None,
        })
    }
}
