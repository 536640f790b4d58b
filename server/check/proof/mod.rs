//! What can be proved of single rungs and of what they do together: conditions that never hold or always do, contacts
//! that make no difference.
//!
//! A rung is looked at closely only where one device occurs twice in it, and the decision diagrams are asked only where
//! a few hundred samples do not tell the difference.

use super::{ChunkContext, Rule};
use crate::document::Proofs;
use crate::logic::Effort;
use crate::text::Diagnostic;

mod rung;

mod constant;

mod removal;

mod interlock;

mod rewrite;

mod contradiction_on_path;

mod redundant_contact;

mod redundant_branch;

mod never_energised;

pub(super) mod always_energised;

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

/// What is found at once: contradictions are seen by looking at contacts two by two.
fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let rungs = rung::rungs(context);
    context.is_worth_a_proof.set(!rungs.is_empty());
    for rung in rungs.iter().filter(|rung| rung.is_as_written) {
        found.extend(contradiction_on_path::find(rung).iter().map(|one| one.diagnostic()));
    }
}

/// What the others find in the rungs of a chunk. They share the reading, and one mistake is told once: in a rung with
/// an output that is never on, no contact makes a difference.
fn prove(context: &ChunkContext<'_>, prover: &mut Prover<'_>) {
    for rung in rung::rungs(context) {
        if !prover.goes_on() {
            return;
        }
        let contradictions = contradiction_on_path::find(&rung);
        let constants = prover.rung(|effort| constant::find(&rung, &contradictions, effort));
        if rung.is_as_written && contradictions.is_empty() && constants.is_empty() {
            let removals = prover.rung(|effort| removal::find(&rung, context, effort));
            prover.found.extend(removals);
        }
        prover.found.extend(constants);
    }
}

/// The proofs about one thing in a rung may be so much work, counted as proofs count it: some milliseconds.
const RUNG: usize = 50_000;

/// The same where work is scarce.
const SMALL_RUNG: usize = 500;

/// The proofs about a chunk may be so much work. A chunk of a list of IEC 61131-3 may have many rungs.
const CHUNK: usize = 1_000_000;

/// How much work is left for proofs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Thrift {
    /// Enough for rungs that are hard to prove.
    Ample,
    /// Little: the rungs before took what there was.
    Scarce,
}

/// Collects what is proved of the rungs of a chunk.
pub struct Prover<'a> {
    found: Vec<Diagnostic>,
    effort: usize,
    thrift: Thrift,
    is_cancelled: &'a dyn Fn() -> bool,
}

impl<'a> Prover<'a> {
    /// Nothing is proved yet; `is_cancelled` says whether nobody waits for it any more.
    pub fn new(thrift: Thrift, is_cancelled: &'a dyn Fn() -> bool) -> Prover<'a> {
        Prover { found: Vec::new(), effort: 0, thrift, is_cancelled }
    }

    /// What is proved; nothing if nobody waits for it.
    pub fn finished(self) -> Option<Proofs> {
        // What was looked at is some work in any case.
        (!(self.is_cancelled)()).then(|| Proofs { found: self.found.into(), effort: self.effort + 1 })
    }

    /// Proves what `judge` does of a list that starts so many bytes behind the chunk's start.
    pub fn inside(&mut self, start: usize, judge: impl FnOnce(&mut Self)) {
        let known = self.found.len();
        judge(self);
        for found in &mut self.found[known..] {
            *found = found.shifted(start);
        }
    }

    fn goes_on(&self) -> bool {
        self.effort < CHUNK && !(self.is_cancelled)()
    }

    fn rung<T>(&mut self, find: impl FnOnce(&mut Effort) -> T) -> T {
        let given = match self.thrift {
            Thrift::Ample => RUNG,
            Thrift::Scarce => SMALL_RUNG,
        };
        let mut effort = Effort::of(given, given);
        let found = find(&mut effort);
        self.effort += given - effort.left();
        found
    }
}
