//! Helpers that do more than to keep the power of a rung.

use super::Source;
use crate::il::iec::ItemKind;
use crate::logic::elsewhere::{loads_plainly, stores_plainly};
use crate::logic::is_helper_name;
use crate::target::Operand;
use crate::text::folded;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

/// A helper, by program unit and folded name.
pub(super) type Helper = (Option<usize>, SmolStr);

impl Source<'_> {
    /// The helpers that the text uses in another way than to keep power: each store must be followed by a load, and
    /// each load have a store before it, in segments that go on with each other. For others nothing is left out, for
    /// whoever reads them elsewhere must find what was stored, be it a rung that cannot be read.
    pub(super) fn loose_helpers(&self, starts: &[u32], pous: usize) -> FxHashSet<Helper> {
        let mut named: FxHashMap<Helper, usize> = FxHashMap::default();
        for operand in &self.tree.operands {
            let name = operand.span.of(self.text);
            if operand.value == Operand::Variable && is_helper_name(name) {
                let before = starts.partition_point(|start| *start <= operand.span.start);
                *named.entry(((pous + before).checked_sub(1), folded(name))).or_default() += 1;
            }
        }
        named.retain(|(pou, name), _| self.is_helper(*pou, name));
        if named.is_empty() {
            return FxHashSet::default();
        }
        let mut loose: FxHashSet<Helper> = FxHashSet::default();
        // The helpers that keep power, and whether it is still to be loaded.
        let mut kept: FxHashMap<Helper, bool> = FxHashMap::default();
        for segment in &self.segments {
            if !segment.goes_on {
                loose.extend(kept.drain().filter_map(|(helper, waits)| waits.then_some(helper)));
            }
            for item in &self.tree.items[segment.items.clone()] {
                let ItemKind::Operation { operation, operand: Some(id) } = item.kind else { continue };
                let name = self.tree.operand(id).span.of(self.text);
                let is_load = loads_plainly(&operation);
                if item.depth > 0
                    || !is_helper_name(name)
                    || !is_load && !stores_plainly(&operation, self.text)
                {
                    continue;
                }
                let helper = (segment.pou, folded(name));
                if let Some(left) = named.get_mut(&helper) {
                    *left -= 1;
                    let before = kept.insert(helper.clone(), !is_load);
                    let is_kept = if is_load { before.is_some() } else { before != Some(true) };
                    loose.extend((!is_kept).then_some(helper));
                }
            }
        }
        loose.extend(kept.into_iter().filter_map(|(helper, waits)| waits.then_some(helper)));
        loose.extend(named.into_iter().filter_map(|(helper, left)| (left > 0).then_some(helper)));
        loose
    }
}
