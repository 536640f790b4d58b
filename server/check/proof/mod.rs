//! What can be proved of single rungs and of what they do together: conditions that never hold or always do, contacts
//! that make no difference.
//!
//! A rung is looked at closely only where one device occurs twice in it, and the decision diagrams are asked only where
//! a few hundred samples do not tell the difference.

use super::{ChunkContext, Rule};
use crate::text::Diagnostic;

mod rung;

mod constant;

mod removal;

mod rewrite;

mod contradiction_on_path;

mod redundant_contact;

mod redundant_branch;

mod never_energised;

mod always_energised;

mod across;

mod slice;

mod mutual_exclusion;
pub(super) use mutual_exclusion::NOT_PROVED;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[
    &contradiction_on_path::RULE,
    &redundant_contact::RULE,
    &redundant_branch::RULE,
    &never_energised::RULE,
    &always_energised::RULE,
    &mutual_exclusion::RULE,
];

/// What all of them find in the rungs of a chunk. They share the reading, and one mistake is told once: in a rung with
/// an output that is never on, no contact makes a difference.
fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    for rung in rung::rungs(context) {
        let contradictions = contradiction_on_path::find(&rung);
        let constants = constant::find(&rung, &contradictions);
        if rung.is_as_written {
            found.extend(contradictions.iter().map(|one| one.diagnostic()));
            if contradictions.is_empty() && constants.is_empty() {
                removal::find(&rung, context, found);
            }
        }
        found.extend(constants);
    }
}
