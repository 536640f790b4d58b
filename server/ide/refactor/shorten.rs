//! The same rung in the fewest steps that its order of contacts and outputs allows.

use super::Proposal;
use super::neighbourhood::Neighbourhood;

pub(super) fn propose(around: &Neighbourhood<'_>) -> Option<Proposal> {
    // A drawing has no steps that it could do without.
    let paths = vec![around.path().clone()];
    let proposal = Proposal::here("refactor.rewrite.rung.shorten", "refactor.shorten", around, paths);
    around.is_list().then(|| proposal.if_it_saves())
}
