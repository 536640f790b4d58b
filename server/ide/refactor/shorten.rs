//! The same rung in the fewest steps or instructions that its order of contacts and outputs allows.

use super::Proposal;
use super::neighbourhood::Neighbourhood;

pub(super) fn propose(around: &Neighbourhood<'_>) -> Option<Proposal> {
    // A drawing has none that it could do without.
    let paths = vec![around.path().clone()];
    let has_steps = around.document.target().is_fx();
    let title = if has_steps { "refactor.shorten" } else { "refactor.shorten-instructions" };
    let proposal = Proposal::here("refactor.rewrite.rung.shorten", title, around, paths);
    let proposal = Proposal { keeps_forms: false, ..proposal.if_it_saves() };
    around.is_list().then_some(proposal)
}
