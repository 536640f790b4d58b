//! Contacts that branches have in common are drawn once: A·B + A·C becomes A·(B + C), and (A + B)·(A + C) becomes
//! A + B·C.

use super::Proposal;
use super::algebra::{alike, size, with_conditions};
use super::neighbourhood::Neighbourhood;
use crate::logic::{Expression, Path};

pub(super) fn propose(around: &Neighbourhood<'_>) -> Option<Proposal> {
    let path = with_conditions(around.path(), &|condition, _| factored(condition));
    let is_smaller = contacts(&path) < contacts(around.path());
    let proposal = Proposal::here("refactor.rewrite.rung.factor", "refactor.factor", around, vec![path]);
    is_smaller.then(|| proposal.if_it_saves())
}

fn contacts(path: &Path) -> usize {
    let mut count = 0;
    path.visit(&mut |_| {}, &mut |condition| count += size(condition));
    count
}

fn factored(condition: &Expression) -> Expression {
    match condition {
        Expression::And(parts) => connection(parts.iter().map(factored).collect(), true),
        Expression::Or(parts) => connection(parts.iter().map(factored).collect(), false),
        Expression::Not(part) => Expression::Not(Box::new(factored(part))),
        leaf => leaf.clone(),
    }
}

/// A connection of `parts`, in series or in parallel, with what they have in common taken out of them.
fn connection(mut parts: Vec<Expression>, in_series: bool) -> Expression {
    let join = |parts: Vec<Expression>, in_series: bool| match in_series {
        true => Expression::and(parts),
        false => Expression::or(parts),
    };
    while let Some(common) = most_common(&parts, in_series) {
        let has = |part: &Expression| inner(part, in_series).iter().any(|inner| alike(inner, &common));
        let Some(first) = parts.iter().position(has) else { break };
        let sharing: Vec<Expression> = parts.iter().filter(|part| has(part)).cloned().collect();
        let is_shared = |one: &Expression| {
            sharing.iter().all(|part| inner(part, in_series).iter().any(|inner| alike(inner, one)))
        };
        // What stood before the first difference stays before it, the rest goes behind.
        let own = inner(&sharing[0], in_series);
        let ahead = own.iter().take_while(|one| is_shared(one)).count();
        let before = own[..ahead].to_vec();
        let behind: Vec<Expression> = own[ahead..].iter().filter(|one| is_shared(one)).cloned().collect();
        let rests: Vec<Vec<Expression>> = sharing
            .iter()
            .map(|part| inner(part, in_series).iter().filter(|one| !is_shared(one)).cloned().collect())
            .collect();
        // Where nothing is left of one, the others make no difference: A + A·B is A.
        let middle = match rests.iter().any(Vec::is_empty) {
            true => None,
            false => {
                let rests = rests.into_iter().map(|rest| join(rest, !in_series)).collect();
                Some(connection(rests, in_series))
            }
        };
        let whole = join(before.into_iter().chain(middle).chain(behind).collect(), !in_series);
        parts.retain(|part| !has(part));
        parts.insert(first, whole);
    }
    join(parts, in_series)
}

/// The parts of the other kind of connection, of one that is none itself.
fn inner(part: &Expression, in_series: bool) -> &[Expression] {
    match part {
        Expression::Or(parts) if in_series => parts,
        Expression::And(parts) if !in_series => parts,
        other => std::slice::from_ref(other),
    }
}

/// What most of `parts` have in common, and two at least.
fn most_common(parts: &[Expression], in_series: bool) -> Option<Expression> {
    let sharing = |one: &Expression| {
        parts.iter().filter(|part| inner(part, in_series).iter().any(|inner| alike(inner, one))).count()
    };
    let candidates = parts.iter().flat_map(|part| inner(part, in_series));
    let counted = candidates.map(|one| (sharing(one), one)).filter(|(count, _)| *count > 1);
    // Of several the first.
    let best = counted.reduce(|best, other| if other.0 > best.0 { other } else { best });
    best.map(|(_, one)| one.clone())
}
