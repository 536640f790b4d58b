//! A rung for each output instead of one for all, which needs no branch to come back to.

use super::Proposal;
use super::algebra::joined;
use super::neighbourhood::Neighbourhood;
use crate::logic::{Drive, Path};

pub(super) fn propose(around: &Neighbourhood<'_>) -> Option<Proposal> {
    let path = around.path();
    if path.drives.len() < 2 {
        return None;
    }
    let rungs = path.drives.iter().map(|drive| match drive {
        Drive::Action(_) => Path { gates: path.gates.clone(), drives: vec![drive.clone()] },
        Drive::Path(inner) => Path { gates: joined(&path.gates, &inner.gates), drives: inner.drives.clone() },
    });
    let branches = path.drives.iter().any(|drive| matches!(drive, Drive::Path(_)));
    let title =
        if branches && around.has_branch_stack() { "refactor.split-branches" } else { "refactor.split" };
    Some(Proposal::here("refactor.rewrite.rung.split", title, around, rungs.collect()))
}
