//! What the refactorings have in common: parts of conditions compared and joined.

use crate::logic::{Expression, Gate, Path};

/// Whether two conditions are written with the same contacts in the same places, wherever they stand.
pub(super) fn alike(left: &Expression, right: &Expression) -> bool {
    let all = |left: &[Expression], right: &[Expression]| {
        left.len() == right.len() && left.iter().zip(right).all(|(left, right)| alike(left, right))
    };
    match (left, right) {
        (Expression::Constant(left), Expression::Constant(right)) => left == right,
        (Expression::Contact(left), Expression::Contact(right)) => {
            left.test == right.test && left.terms == right.terms
        }
        (Expression::Not(left), Expression::Not(right)) => alike(left, right),
        (Expression::And(left), Expression::And(right)) | (Expression::Or(left), Expression::Or(right)) => {
            all(left, right)
        }
        _ => false,
    }
}

/// The parts in series, of one that is none itself.
pub(super) fn factors(condition: &Expression) -> &[Expression] {
    match condition {
        Expression::And(parts) => parts,
        other => std::slice::from_ref(other),
    }
}

/// How many contacts a condition has.
pub(super) fn size(condition: &Expression) -> usize {
    let mut contacts = 0;
    condition.visit(&mut |_| contacts += 1);
    contacts
}

/// The gates of one path and of another that leaves it, as those of one path.
pub(super) fn joined(before: &[Gate], behind: &[Gate]) -> Vec<Gate> {
    let mut gates = before.to_vec();
    for gate in behind {
        match (gates.last_mut(), gate) {
            (Some(Gate::Pass(condition)), Gate::Pass(more)) => condition.and_with(more.clone()),
            _ => gates.push(gate.clone()),
        }
    }
    gates
}

/// The path with `change` made of each condition; it is told whether the condition begins at the left rail.
pub(super) fn with_conditions(path: &Path, change: &impl Fn(&Expression, bool) -> Expression) -> Path {
    fn of(path: &Path, starts: bool, change: &impl Fn(&Expression, bool) -> Expression) -> Path {
        use crate::logic::Drive;
        let gates = path.gates.iter().enumerate().map(|(number, gate)| match gate {
            Gate::Pass(condition) => Gate::Pass(change(condition, starts && number == 0)),
            other => other.clone(),
        });
        let drives = path.drives.iter().map(|drive| match drive {
            Drive::Path(inner) => Drive::Path(of(inner, starts && path.gates.is_empty(), change)),
            other => other.clone(),
        });
        Path { gates: gates.collect(), drives: drives.collect() }
    }
    of(path, true, change)
}
