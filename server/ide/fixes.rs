//! Quick fixes: the changes that diagnostics offer.

use crate::text::{Diagnostic, Fix, Span};

/// A fix and the diagnostic that it mends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FixOf<'a> {
    /// What is mended.
    pub diagnostic: &'a Diagnostic,
    /// How.
    pub fix: &'a Fix,
    /// Whether it is the diagnostic's first and only fix, which an editor may apply without asking.
    pub is_preferred: bool,
}

pub(super) fn within(diagnostics: &[Diagnostic], span: Span) -> Vec<FixOf<'_>> {
    let touched = diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.span.start <= span.end && span.start <= diagnostic.span.end);
    touched
        .flat_map(|diagnostic| {
            let is_preferred = diagnostic.fixes.len() == 1;
            diagnostic.fixes.iter().map(move |fix| FixOf { diagnostic, fix, is_preferred })
        })
        .collect()
}
