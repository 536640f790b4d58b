//! What the rest of a program unit of IEC 61131-3 says of the names in a stretch of it.
//!
//! Three things make rungs of what stands far apart: a detector is an edge contact only if nobody else asks for its
//! output, a jump only skips calculations if nobody else jumps to its label, and a helper keeps power only if it does
//! so wherever the unit names it. The pages of the document know where names stand, so little else is looked at.

use super::from_iec::{
    self, Detector, block_of, detects_rise, is_declared_fall, is_declared_helper, is_fall_name,
    is_helper_name,
};
use super::{Declared, stretch};
use crate::document::{Chunk, Document, Scopes, Symbol, Unit};
use crate::il::iec::{Condition, IecTree, ItemKind, Operation};
use crate::target::Operand;
use crate::target::iec::OperatorRole;
use crate::text::{Span, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

/// So many stretches are read for one helper; where more are needed the unit is sooner read whole.
const STRETCHES_MAX: usize = 64;

/// What is known of names, folded, from all of a program unit but a stretch.
#[derive(Default)]
pub struct Elsewhere {
    /// How often labels are named.
    pub(super) labels: FxHashMap<SmolStr, usize>,
    /// How instances that may be detectors of edges are used.
    pub(super) detectors: FxHashMap<SmolStr, Detector>,
    /// The helpers that are used for something else than to keep the power of a rung, and those that find falling
    /// edges and are named there.
    pub(super) loose: FxHashSet<SmolStr>,
}

/// What a chunk does with a helper.
enum Keeping {
    Nothing,
    /// Its first instruction loads the helper, or a later one stores to it, and nothing but the rung of these stands in
    /// the chunk.
    Plainly {
        loads: bool,
        stores: bool,
    },
    /// What it does must be read.
    Somehow,
}

impl Elsewhere {
    /// What `unit` of `document` says outside of these bytes, of which `own` is the text; nothing where finding it
    /// would take longer than to read the unit.
    pub fn of(document: &Document, unit: Unit, bytes: Span, own: &Chunk) -> Option<Elsewhere> {
        let (text, tree, scopes) = (own.text(), own.iec()?, document.scopes());
        let mut helpers: FxHashSet<SmolStr> = FxHashSet::default();
        let mut falls: FxHashSet<SmolStr> = FxHashSet::default();
        let mut detectors: FxHashMap<SmolStr, Detector> = FxHashMap::default();
        for operand in tree.operands.iter().filter(|operand| operand.value == Operand::Variable) {
            let name = operand.span.of(text);
            let instance = name.split('.').next().unwrap_or_default();
            if is_helper_name(name) {
                helpers.insert(folded(name));
            } else if is_fall_name(name) {
                falls.insert(folded(name));
            } else if is_detector(scopes, unit.number, instance) {
                detectors.entry(folded(instance)).or_default();
            }
        }
        count_detectors(document, unit, bytes, &mut detectors);
        let labels = labels(document, unit, bytes, (text, tree));
        let mut loose = FxHashSet::default();
        for name in helpers.into_iter().filter(|name| is_declared_helper(scopes, unit.number, name)) {
            if is_loose(document, unit, bytes, &name)? {
                loose.insert(name);
            }
        }
        falls.retain(|name| is_declared_fall(scopes, unit.number, name));
        let symbols: Vec<Symbol> = falls.iter().cloned().map(Symbol::Variable).collect();
        each_naming((document, unit, bytes), &symbols, &mut |chunk, tree| {
            let words = tree.operands.iter().map(|operand| folded(operand.span.of(chunk.text())));
            loose.extend(words.filter(|word| falls.contains(word)));
        });
        Some(Elsewhere { labels, detectors, loose })
    }
}

fn is_detector(scopes: &Scopes, pou: Option<usize>, instance: &str) -> bool {
    block_of(scopes, pou, instance).is_some_and(|block| detects_rise(&block))
}

/// Calls `see` with the chunks of the unit outside of these bytes that name any of `symbols`.
fn each_naming<'d>(
    (document, unit, bytes): (&'d Document, Unit, Span),
    symbols: &[Symbol],
    see: &mut dyn FnMut(&'d Chunk, &'d IecTree),
) {
    if symbols.is_empty() {
        return;
    }
    let names_any = |names: &crate::document::Names| symbols.iter().any(|symbol| names.contains(symbol));
    unit.each_part(document, &names_any, &mut |start, chunk| {
        let is_inside = bytes.range().contains(&start);
        if !is_inside && chunk.mentions().iter().any(|mention| symbols.contains(&mention.symbol)) {
            chunk.iec().into_iter().for_each(|tree| see(chunk, tree));
        }
    });
}

fn count_detectors(
    document: &Document,
    unit: Unit,
    bytes: Span,
    detectors: &mut FxHashMap<SmolStr, Detector>,
) {
    let symbols: Vec<Symbol> = detectors.keys().cloned().map(Symbol::Variable).collect();
    each_naming((document, unit, bytes), &symbols, &mut |chunk, tree| {
        for operand in tree.operands.iter().filter(|operand| operand.value == Operand::Variable) {
            let path = operand.span.of(chunk.text());
            let (instance, member) =
                path.split_once('.').map_or((path, None), |(root, rest)| (root, Some(rest)));
            if let Some(detector) = detectors.get_mut(&folded(instance)) {
                detector.count_elsewhere(member);
            }
        }
    });
}

/// How often the labels of jumps that may skip calculations are named outside of these bytes.
fn labels(
    document: &Document,
    unit: Unit,
    bytes: Span,
    (text, tree): (&str, &IecTree),
) -> FxHashMap<SmolStr, usize> {
    let skipping = tree.items.iter().filter_map(|item| match item.kind {
        ItemKind::Jump { condition: Condition::IfFalse, label: Some(label), .. } => {
            Some((folded(label.of(text)), 0))
        }
        _ => None,
    });
    let mut labels: FxHashMap<SmolStr, usize> = skipping.collect();
    let symbols: Vec<Symbol> = labels.keys().cloned().map(Symbol::Label).collect();
    each_naming((document, unit, bytes), &symbols, &mut |chunk, tree| {
        for item in &tree.items {
            if let ItemKind::Label { name } | ItemKind::Jump { label: Some(name), .. } = item.kind
                && let Some(count) = labels.get_mut(&folded(name.of(chunk.text())))
            {
                *count += 1;
            }
        }
    });
    labels
}

/// Whether the helper is used for something else than to keep power in the unit outside of these bytes. Where a chunk
/// plainly stores to it and the next one loads it, that is known at a look; other places are read.
fn is_loose(document: &Document, unit: Unit, bytes: Span, name: &SmolStr) -> Option<bool> {
    let symbol = Symbol::Variable(name.clone());
    let mut doubtful: Vec<usize> = Vec::new();
    // The last chunk in which the helper keeps power, where it ends, and where it starts if that power is still to be
    // loaded.
    let mut kept: Option<(&Chunk, usize, Option<usize>)> = None;
    unit.each_part(document, &|names| names.contains(&symbol), &mut |start, chunk| {
        if bytes.range().contains(&start) {
            return;
        }
        let (loads, stores) = match keeping(chunk, &symbol, name) {
            Keeping::Nothing => return,
            Keeping::Plainly { loads, stores } => (loads, stores),
            Keeping::Somehow => {
                doubtful.push(start);
                (false, false)
            }
        };
        let before = kept.take();
        let goes_on = before
            .is_some_and(|(before, end, _)| loads && end == start && !stretch::are_parted(before, chunk));
        if !goes_on {
            doubtful.extend(before.and_then(|(_, _, waits)| waits));
            doubtful.extend(loads.then_some(start));
        }
        kept = (goes_on || stores).then(|| (chunk, start + chunk.len(), stores.then_some(start)));
    });
    doubtful.extend(kept.and_then(|(_, _, waits)| waits));
    // That a store waits in vain is known only behind it.
    doubtful.sort_unstable();
    let mut read_to = 0;
    let mut left = STRETCHES_MAX;
    for start in doubtful {
        if start < read_to {
            continue;
        }
        left = left.checked_sub(1)?;
        let (span, _) = stretch::holding(document, Span::at(start))?;
        let chunk = document.chunk_of(&document.slice(span));
        let tree = chunk.iec()?;
        let labels = labels(document, unit, span, (chunk.text(), tree));
        let around = Elsewhere { labels, ..Elsewhere::default() };
        let declared = Declared { scopes: document.scopes(), pous: unit.started() };
        if from_iec::loose_helpers(chunk.text(), tree, declared, &around)
            .contains(&(unit.number, name.clone()))
        {
            return Some(true);
        }
        read_to = span.end as usize;
    }
    Some(false)
}

fn keeping(chunk: &Chunk, symbol: &Symbol, name: &str) -> Keeping {
    if !chunk.mentions().iter().any(|mention| mention.symbol == *symbol) {
        return Keeping::Nothing;
    }
    let Some(tree) = chunk.iec() else { return Keeping::Somehow };
    let text = chunk.text();
    let is_it = |word: Span| word.of(text).eq_ignore_ascii_case(name);
    let mentions = tree.operands.iter().filter(|operand| is_it(operand.span)).count();
    if mentions == 0 {
        return Keeping::Nothing;
    }
    let named = |(number, kind): (usize, ItemKind)| match kind {
        ItemKind::Operation { operation, operand: Some(id) } if is_it(tree.operand(id).span) => {
            Some((number, operation))
        }
        _ => None,
    };
    let plain = tree.items.iter().all(|item| {
        matches!(item.kind, ItemKind::Operation { .. } | ItemKind::Open { .. } | ItemKind::Close)
    });
    let outside = tree.items.iter().enumerate().filter(|(_, item)| item.depth == 0);
    let found: Vec<(usize, Operation)> =
        outside.map(|(number, item)| (number, item.kind)).filter_map(named).collect();
    let is_load = |(number, operation): &(usize, Operation)| *number == 0 && loads_plainly(operation);
    let is_store = |(_, operation): &(usize, Operation)| stores_plainly(operation, text);
    match &found[..] {
        _ if !plain || found.len() != mentions => Keeping::Somehow,
        [one] if is_load(one) => Keeping::Plainly { loads: true, stores: false },
        [one] if is_store(one) => Keeping::Plainly { loads: false, stores: true },
        [one, other] if is_load(one) && is_store(other) => Keeping::Plainly { loads: true, stores: true },
        _ => Keeping::Somehow,
    }
}

/// Whether an operation gives back the power that a helper keeps.
pub(super) fn loads_plainly(operation: &Operation) -> bool {
    operation.operator.role == OperatorRole::Load && !operation.negated
}

/// Whether an operation keeps power in a helper.
pub(super) fn stores_plainly(operation: &Operation, text: &str) -> bool {
    let is_store = operation.operator.role == OperatorRole::Store && !operation.negated;
    is_store && !operation.word.of(text).ends_with('?')
}
