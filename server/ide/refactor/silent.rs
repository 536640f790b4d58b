//! Names that stand in the rungs of a list and not in their paths: detectors of edges, helpers that keep power, labels
//! behind calculations. Whoever writes such a rung anew moves or drops them, so nothing else may ask for them.

use super::unit::is_use;
use crate::document::{Chunk, Document, Symbol, Unit};
use crate::il::iec::{Item, ItemKind};
use crate::logic::stretch::is_instruction;
use crate::logic::{Path, is_helper_name};
use crate::target::iec::OperatorRole;
use crate::text::{Span, folded};
use crate::translate::Source;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

/// A helper that is named more often is not followed through its program unit.
const MENTIONS_MAX: usize = 4096;
/// The store before a load is looked for in so many chunks.
const CHUNKS_MAX: usize = 64;

/// The names in a rung that its path does not show, in order, each once.
pub(super) fn names(placed: &Source) -> Vec<Symbol> {
    let own = placed.rung.span;
    let shown = placed.path().map(shown).unwrap_or_default();
    let mut found: Vec<Symbol> = Vec::new();
    for mention in placed.chunk.mentions() {
        let is_inside = own.start <= mention.span.start && mention.span.end <= own.end;
        let is_silent = match &mention.symbol {
            Symbol::Variable(name) | Symbol::Label(name) => !shown.contains(name),
            _ => false,
        };
        if is_inside && is_silent && !found.contains(&mention.symbol) {
            found.push(mention.symbol.clone());
        }
    }
    found
}

/// The folded names of what the operands of a path are, or are parts of.
fn shown(path: &Path) -> FxHashSet<SmolStr> {
    let mut names = FxHashSet::default();
    for term in path.terms() {
        let end = term.text.find(['.', '[', '^']).unwrap_or(term.text.len());
        names.insert(folded(&term.text[..end]));
        // A subscript is read as well.
        let words = term.text[end..].split(|c: char| !c.is_alphanumeric() && c != '_');
        names.extend(words.filter(|word| !word.is_empty()).map(folded));
    }
    names
}

/// Whether nothing in `unit` of a document but `rungs` names `symbol`.
pub(super) fn is_named_only_in(document: &Document, unit: Unit, symbol: &Symbol, rungs: &[Source]) -> bool {
    let inside = |placed: &Source| {
        let own = placed.rung.span;
        let mentions = placed.chunk.mentions().iter();
        let own = mentions.filter(|mention| {
            mention.symbol == *symbol
                && is_use(mention)
                && own.start <= mention.span.start
                && mention.span.end <= own.end
        });
        own.count()
    };
    unit.tally(document, symbol).mentions == rungs.iter().map(inside).sum::<usize>()
}

/// The name of a helper that keeps power, which several rungs may use.
pub(super) fn helper(symbol: &Symbol) -> Option<&SmolStr> {
    match symbol {
        Symbol::Variable(name) if is_helper_name(name) => Some(name),
        _ => None,
    }
}

/// What an item does with a variable.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Touch {
    Stores,
    Reads,
}

/// Whether each read of the helper `name` in those chunks of the unit of which `wanted` says so by their start has a
/// store before it in chunks of which it says so, too, without a place between at which a jump could arrive.
pub(super) fn is_stored_wherever_read(
    document: &Document,
    unit: Unit,
    name: &SmolStr,
    wanted: &dyn Fn(usize) -> bool,
) -> bool {
    let symbol = Symbol::Variable(name.clone());
    let mut left = MENTIONS_MAX;
    let mut is_stored = true;
    unit.each_part(document, &|names| names.contains(&symbol), &mut |start, chunk| {
        if !is_stored || !wanted(start) {
            return;
        }
        let places: Vec<Span> = places(chunk, &symbol);
        if !places.is_empty() {
            let before = || stored_before(document, start, &symbol, wanted);
            is_stored = places.len() <= left && reads_what_is_stored(chunk, &places, name, before);
            left = left.saturating_sub(places.len());
        }
    });
    is_stored
}

fn places(chunk: &Chunk, symbol: &Symbol) -> Vec<Span> {
    let mentions = chunk.mentions().iter().filter(|mention| mention.symbol == *symbol && is_use(mention));
    mentions.map(|mention| mention.span).collect()
}

fn reads_what_is_stored(chunk: &Chunk, places: &[Span], name: &str, before: impl Fn() -> bool) -> bool {
    let Some(tree) = chunk.iec() else { return false };
    let mut stored = None;
    for item in &tree.items {
        if !is_instruction(item) || matches!(item.kind, ItemKind::Label { .. }) {
            stored = Some(false);
        }
        match touch(chunk, item, places, name) {
            Some(Touch::Stores) => stored = Some(true),
            Some(Touch::Reads) if !*stored.get_or_insert_with(&before) => return false,
            _ => {}
        }
    }
    true
}

/// Whether the last that happens to the variable before the chunk at `start` is a store.
fn stored_before(document: &Document, start: usize, symbol: &Symbol, wanted: &dyn Fn(usize) -> bool) -> bool {
    let Some(name) = helper(symbol) else { return false };
    let mut start = start;
    for _ in 0..CHUNKS_MAX {
        let before = document.chunk_before(start).filter(|before| before.start < start);
        let Some(at) = before.filter(|before| wanted(before.start)) else { return false };
        let Some(tree) = at.chunk.iec() else { return false };
        let places = places(at.chunk, symbol);
        for item in tree.items.iter().rev() {
            if !is_instruction(item) || matches!(item.kind, ItemKind::Label { .. }) {
                return false;
            }
            // A read has a store of its own before it, or that is found out where the read is looked at.
            if touch(at.chunk, item, &places, name) == Some(Touch::Stores) {
                return true;
            }
        }
        start = at.start;
    }
    false
}

fn touch(chunk: &Chunk, item: &Item, places: &[Span], name: &str) -> Option<Touch> {
    let is_inside = |place: &&Span| item.span.start <= place.start && place.end <= item.span.end;
    places.iter().find(is_inside)?;
    match item.kind {
        ItemKind::Operation { operation, operand: Some(id) } if item.depth == 0 => {
            let stored = chunk.iec()?.operand(id).span.of(chunk.text());
            let word = operation.word.of(chunk.text());
            let stores = operation.operator.role == OperatorRole::Store && !word.ends_with('?');
            Some(if stores && stored.eq_ignore_ascii_case(name) { Touch::Stores } else { Touch::Reads })
        }
        _ => Some(Touch::Reads),
    }
}
