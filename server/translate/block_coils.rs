//! Coils of function blocks: a drawing can have one, as exports of LDmicro reset a counter, and the same words call the
//! block in a list.

use super::source::Source;
use crate::logic::{Action, Deed};
use crate::text::Message;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

/// Notes at the drawn rungs with a coil of something that is called elsewhere why nothing is certain of them in a list.
pub(super) fn doubt(sources: &mut [Source]) {
    let instance = |action: &Action| action.terms.first().map(|term| (term.key(), term.text.clone()));
    let actions = |source: &Source| -> Vec<Action> {
        source.path().map(|path| path.actions().into_iter().cloned().collect()).unwrap_or_default()
    };
    let calls = |action: &Action| matches!(action.deed, Deed::Call(_));
    let called: FxHashSet<SmolStr> = sources
        .iter()
        .flat_map(actions)
        .filter(calls)
        .filter_map(|action| instance(&action).map(|(key, _)| key))
        .collect();
    if called.is_empty() {
        return;
    }
    for source in sources.iter_mut().filter(|source| !source.rung.is_list && source.doubt.is_none()) {
        let coils = actions(source).into_iter().filter(|action| matches!(action.deed, Deed::Coil(_)));
        let found = coils.filter_map(|action| instance(&action)).find(|(key, _)| called.contains(key));
        source.doubt = found.map(|(_, word)| Message::new("translate.block-coil").with("word", word));
    }
}
