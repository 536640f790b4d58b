//! A rung for each output instead of one for all, which needs no branch to come back to.

use super::Proposal;
use super::algebra::joined;
use super::neighbourhood::Neighbourhood;
use crate::logic::{Drive, Gate, Path};

pub(super) fn propose(around: &Neighbourhood<'_>) -> Option<Proposal> {
    let path = around.path();
    let mut rungs = Vec::new();
    each_output(&path.gates, &path.drives, &mut rungs);
    if rungs.len() < 2 {
        return None;
    }
    let branches = path.drives.iter().any(|drive| matches!(drive, Drive::Path(_)));
    let title =
        if branches && around.has_branch_stack() { "refactor.split-branches" } else { "refactor.split" };
    Some(Proposal::here("refactor.rewrite.rung.split", title, around, rungs))
}

/// Adds a rung for each output of `drives` and of the branches among them, however deep, all behind `gates`.
fn each_output(gates: &[Gate], drives: &[Drive], rungs: &mut Vec<Path>) {
    for drive in drives {
        match drive {
            Drive::Action(_) => rungs.push(Path { gates: gates.to_vec(), drives: vec![drive.clone()] }),
            Drive::Path(inner) => each_output(&joined(gates, &inner.gates), &inner.drives, rungs),
        }
    }
}
