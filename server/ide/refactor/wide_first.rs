//! Moves a branch before the contacts in its connection: what comes first needs no ANB or ORB, and no
//! parentheses.

use super::Proposal;
use super::algebra::with_conditions;
use super::neighbourhood::Neighbourhood;
use crate::logic::Expression;

pub(super) fn propose(around: &Neighbourhood<'_>) -> Option<Proposal> {
    let path = with_conditions(around.path(), &moved);
    let proposal =
        Proposal::here("refactor.rewrite.rung.wideFirst", "refactor.wide-first", around, vec![path]);
    Some(proposal.if_it_saves())
}

/// `condition` with a connection first where there is one. Parts in series behind others are joined one by one anyway,
/// and stay in their order.
fn moved(condition: &Expression, starts: bool) -> Expression {
    let inner = |parts: &[Expression]| parts.iter().map(|part| moved(part, true)).collect::<Vec<_>>();
    match condition {
        Expression::And(parts) if !starts => Expression::And(inner(parts)),
        Expression::And(parts) => Expression::And(wide_first(inner(parts))),
        Expression::Or(parts) => Expression::Or(wide_first(inner(parts))),
        Expression::Not(part) => Expression::Not(Box::new(moved(part, true))),
        leaf => leaf.clone(),
    }
}

fn wide_first(mut parts: Vec<Expression>) -> Vec<Expression> {
    let is_wide = |part: &Expression| !matches!(part, Expression::Contact(_) | Expression::Constant(_));
    if let Some(wide) = parts.iter().position(is_wide) {
        let first = parts.remove(wide);
        parts.insert(0, first);
    }
    parts
}
