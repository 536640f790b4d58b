//! Leaves out what comments allow, and finds the comments that allow nothing.

use super::Rule;
use crate::document::{Allowance, Document};
use crate::text::{Diagnostic, Severity, Span};
use rustc_hash::FxHashMap;

/// What the comments of a document allow.
pub struct Suppression {
    allowances: Vec<Allowance>,
    /// The codes of all comments, in the order of the text.
    entries: Vec<Entry>,
    /// For each code the entries that are about a piece of the text, in order, and those about the whole file.
    by_code: FxHashMap<String, (Vec<usize>, Vec<usize>)>,
}

/// One code in a comment.
pub(super) struct Entry {
    /// The code as written.
    pub code: String,
    /// Its cells.
    pub span: Span,
    /// The number of its comment.
    pub comment: usize,
}

/// Whether a comment can allow what the rule `code` reports: everything but errors of reading.
pub fn is_suppressible(code: &str) -> bool {
    // A table of devices has no rungs, and the rule about comments has the last word.
    let is_apart = matches!(code, "device-comments" | "unused-suppression");
    Rule::named(code).is_some_and(|rule| !is_apart && !rule.is_error_of_reading())
}

impl Suppression {
    /// What the comments of `document` allow; `None` if there are none.
    pub fn of(document: &Document) -> Option<Suppression> {
        let allowances = document.allowances();
        if allowances.is_empty() {
            return None;
        }
        let mut suppression = Suppression { allowances, entries: Vec::new(), by_code: FxHashMap::default() };
        for (comment, allowance) in suppression.allowances.iter().enumerate() {
            for span in &allowance.codes {
                let code = document.slice(*span);
                let (pieces, file) = suppression.by_code.entry(code.clone()).or_default();
                let list = if allowance.is_for_file { file } else { pieces };
                list.push(suppression.entries.len());
                suppression.entries.push(Entry { code, span: *span, comment });
            }
        }
        Some(suppression)
    }

    /// The findings that no comment allows.
    pub fn filtered(&self, mut found: Vec<Diagnostic>) -> Vec<Diagnostic> {
        found.retain(|diagnostic| self.entry_for(diagnostic).is_none());
        found
    }

    /// The number of the code that allows `diagnostic`, that of the smallest piece.
    fn entry_for(&self, diagnostic: &Diagnostic) -> Option<usize> {
        let (pieces, file) = self.by_code.get(diagnostic.code)?;
        if !is_suppressible(diagnostic.code) {
            return None;
        }
        let start = diagnostic.span.start as usize;
        let covers = |entry: usize| &self.allowances[self.entries[entry].comment].covers;
        let behind = pieces.partition_point(|entry| covers(*entry).start <= start);
        let last = behind.checked_sub(1).and_then(|last| pieces.get(last)).copied();
        last.filter(|entry| covers(*entry).contains(&start)).or_else(|| file.first().copied())
    }

    /// The codes that allow nothing of `found`, with their comments.
    pub(super) fn unused<'f>(
        &self,
        found: impl Iterator<Item = &'f Diagnostic>,
    ) -> impl Iterator<Item = (&Entry, &Allowance)> {
        let mut is_used = vec![false; self.entries.len()];
        found.filter_map(|diagnostic| self.entry_for(diagnostic)).for_each(|entry| is_used[entry] = true);
        let entries = self.entries.iter().zip(is_used).filter(|(_, is_used)| !is_used);
        entries.map(|(entry, _)| (entry, &self.allowances[entry.comment]))
    }
}

impl Rule {
    fn is_error_of_reading(&self) -> bool {
        self.severity == Severity::Error && matches!(self.run, super::Run::WhileReading)
    }
}
