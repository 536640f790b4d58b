//! Which program units of two programs are the same.

use crate::document::Document;
use crate::il::iec::PouKind;
use crate::text::folded;

/// The units of one program with those of another: by their names, and programs that nobody else has the names of in
/// the order in which they stand, for nothing calls a program by its name.
pub(super) struct Paired {
    /// For each unit of the left program that of the right one.
    right: Vec<Option<usize>>,
    /// Whether a program has no units, so that its rungs may be those of any.
    is_open: bool,
}

impl Paired {
    pub(super) fn of(documents: [&Document; 2]) -> Paired {
        let [left, right] = documents.map(|document| document.scopes().own_pous());
        let alike = |own: usize| {
            let is_it = |other: &std::sync::Arc<crate::document::Pou>| {
                folded(&left[own].name) == folded(&other.name) && left[own].kind == other.kind
            };
            right.iter().position(is_it)
        };
        let mut pairs: Vec<Option<usize>> = (0..left.len()).map(alike).collect();
        let mut rest = (0..right.len())
            .filter(|other| right[*other].kind == PouKind::Program && !pairs.contains(&Some(*other)))
            .collect::<Vec<_>>()
            .into_iter();
        for (own, pair) in pairs.iter_mut().enumerate() {
            if pair.is_none() && left[own].kind == PouKind::Program {
                *pair = rest.next();
            }
        }
        Paired { right: pairs, is_open: left.is_empty() || right.is_empty() }
    }

    /// Whether what stands in these units is compared with each other.
    pub(super) fn are(&self, left: Option<usize>, right: Option<usize>) -> bool {
        match (left, right) {
            (Some(left), Some(right)) => self.right.get(left) == Some(&Some(right)),
            (None, None) => true,
            _ => self.is_open,
        }
    }

    /// The units that are the same.
    pub(super) fn units(&self) -> impl Iterator<Item = (usize, usize)> {
        self.right.iter().enumerate().filter_map(|(left, right)| Some((left, (*right)?)))
    }
}
