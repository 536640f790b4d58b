//! De Morgan's two forms of a condition: inverted as a whole, and inverted contact by contact with series and
//! parallel exchanged.

use super::Proposal;
use super::algebra::{size, with_conditions};
use super::neighbourhood::Neighbourhood;
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Deed, Drive, Expression, Gate, Path, Test};

pub(super) fn propose(around: &Neighbourhood<'_>) -> Vec<Proposal> {
    let proposal = |kind, title, path| Proposal::here(kind, title, around, vec![path]);
    let spread = spread(around.path());
    let spread =
        spread.map(|path| proposal("refactor.rewrite.rung.invertContacts", "refactor.invert-contacts", path));
    let gathered = gathered(around.path());
    let gathered =
        gathered.map(|path| proposal("refactor.rewrite.rung.invertWhole", "refactor.invert-whole", path));
    spread.into_iter().chain(gathered).collect()
}

/// With each inversion moved into the contacts before it; nothing if there is none, or it stays before an edge.
fn spread(original: &Path) -> Option<Path> {
    let path = with_conditions(original, &|condition, _| without_inversion(condition));
    let mut spread = path.clone();
    if let [Gate::Pass(condition), Gate::Invert, rest @ ..] = &path.gates[..] {
        spread.gates = [&[Gate::Pass(condition.negated())], rest].concat();
    } else if let ([Gate::Pass(condition)], [Drive::Action(action)]) = (&path.gates[..], &path.drives[..])
        && action.deed == Deed::Coil(CoilKind::Negated)
    {
        spread.gates = vec![Gate::Pass(condition.negated())];
        let plain = Action { deed: Deed::Coil(CoilKind::Plain), ..action.clone() };
        spread.drives = vec![Drive::Action(plain)];
    } else if path.gates.iter().all(|gate| *gate != Gate::Invert) && !has_inversion(&path) {
        // Inside of a condition there was one, or there was none anywhere.
        return (path != *original).then_some(path);
    }
    (!has_inversion(&spread)).then_some(spread)
}

fn without_inversion(condition: &Expression) -> Expression {
    let all = |parts: &[Expression]| parts.iter().map(without_inversion).collect::<Vec<_>>();
    match condition {
        Expression::And(parts) => Expression::and(all(parts)),
        Expression::Or(parts) => Expression::or(all(parts)),
        Expression::Not(part) => without_inversion(part).negated(),
        leaf => leaf.clone(),
    }
}

fn has_inversion(path: &Path) -> bool {
    fn inside(condition: &Expression) -> bool {
        matches!(condition, Expression::Not(_)) || condition.parts().iter().any(inside)
    }
    let mut found = false;
    path.visit(&mut |_| {}, &mut |condition| found |= inside(condition));
    found
}

/// With a condition of normally closed contacts alone written as the inverse of one of normally open ones.
fn gathered(path: &Path) -> Option<Path> {
    let Some((Gate::Pass(condition), rest)) = path.gates.split_first() else { return None };
    let is_closed = |test: Test| test == Test::Bit(ContactKind::NormallyClosed);
    let is_whole = size(condition) > 1 && condition.contacts().iter().all(|contact| is_closed(contact.test));
    let gates = [&[Gate::Pass(condition.negated()), Gate::Invert], rest].concat();
    is_whole.then(|| Path { gates, drives: path.drives.clone() })
}
