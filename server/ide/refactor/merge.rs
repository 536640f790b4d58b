//! One rung of this and the next, with the condition that both begin with.

use super::algebra::{alike, factors, joined};
use super::neighbourhood::Neighbourhood;
use super::{Change, Proposal};
use crate::logic::{Deed, Drive, Expression, Gate, Path};
use crate::target::Flow;
use crate::text::Message;

pub(super) fn propose(around: &Neighbourhood<'_>) -> Option<Proposal> {
    let next = around.rungs.get(around.here + 1)?;
    if !next.rung.labels.is_empty() || next.rung.network.is_some() || next.pou != around.rung().pou {
        return None;
    }
    let (first, second) = (around.path(), next.path()?);
    // What a jump leaves out would stand in one network with it.
    if first.actions().iter().any(|action| leaves(&action.deed)) {
        return None;
    }
    let (Some(Gate::Pass(one)), Some(Gate::Pass(other))) = (first.gates.first(), second.gates.first()) else {
        return None;
    };
    let others = factors(other);
    let (common, own): (Vec<_>, Vec<_>) =
        factors(one).iter().cloned().partition(|factor| is_in(factor, others));
    let rest: Vec<_> = others.iter().filter(|factor| !is_in(factor, &common)).cloned().collect();
    if common.is_empty() {
        return None;
    }
    let mut drives = behind(own, first);
    drives.extend(behind(rest, second));
    let branches = drives.iter().any(|drive| matches!(drive, Drive::Path(_)));
    let title =
        if branches && around.has_branch_stack() { "refactor.merge-branches" } else { "refactor.merge" };
    let merged = Path { gates: vec![Gate::Pass(Expression::and(common))], drives };
    let changes = vec![Change { first: around.here, count: 2, paths: vec![merged] }];
    Some(Proposal::of("refactor.rewrite.rung.merge", Message::new(title), changes))
}

fn leaves(deed: &Deed) -> bool {
    match deed {
        Deed::Jump | Deed::Return => true,
        Deed::Instruction(form) => form.instruction.flow() == Flow::Jump,
        _ => false,
    }
}

fn is_in(factor: &Expression, factors: &[Expression]) -> bool {
    factors.iter().any(|other| alike(factor, other))
}

/// What a path drives behind the rest of its first condition and its further gates.
fn behind(rest: Vec<Expression>, path: &Path) -> Vec<Drive> {
    let further = path.gates.get(1..).unwrap_or_default();
    let gates = match rest.is_empty() {
        true => further.to_vec(),
        false => joined(&[Gate::Pass(Expression::and(rest))], further),
    };
    match gates.is_empty() {
        true => path.drives.clone(),
        false => vec![Drive::Path(Path { gates, drives: path.drives.clone() })],
    }
}
