//! The numbers under a check, and the sentence that says them.

use super::status;
use crate::document::Document;
use crate::text::{Diagnostic, Message, Severity};

/// What a check of one document or of many came to.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Summary {
    /// Findings of the gravest kind.
    pub errors: usize,
    /// Findings of the middle kind.
    pub warnings: usize,
    /// Findings of the least kind.
    pub hints: usize,
    /// Rungs.
    pub rungs: usize,
    /// Program steps; `None` if no document is counted in steps.
    pub steps: Option<u32>,
    /// Steps that the largest of the targets has room for; 0 if none counts.
    pub capacity: u32,
}

impl Summary {
    /// Counts `document`, in which `found` was found.
    pub fn add(&mut self, document: &Document, found: &[Diagnostic]) {
        let count = |severity| found.iter().filter(|diagnostic| diagnostic.severity == severity).count();
        self.errors += count(Severity::Error);
        self.warnings += count(Severity::Warning);
        self.hints += count(Severity::Hint);
        let status = status::of(document);
        self.rungs += status.rungs;
        self.steps = match (self.steps, status.steps) {
            (None, None) => None,
            (one, other) => Some(one.unwrap_or(0).saturating_add(other.unwrap_or(0))),
        };
        self.capacity = self.capacity.max(status.capacity);
    }

    /// `check passed: 4 rungs, 31 of 8000 steps`, or the numbers of what was found.
    pub fn sentence(&self) -> Message {
        let rungs = rungs_counted(self.rungs);
        let hints = counted(self.hints, "counted.hint", "counted.hints");
        let size = match self.capacity {
            0 => rungs,
            capacity => Message::new("counted.size")
                .with_messages("rungs", vec![rungs])
                .with("steps", self.steps.unwrap_or(0))
                .with("capacity", capacity),
        };
        let message = match (self.errors, self.warnings, self.hints) {
            (0, 0, 0) => Message::new("counted.passed"),
            (0, 0, _) => Message::new("counted.passed-with-hints").with_messages("hints", vec![hints]),
            (errors, warnings, _) => {
                let errors = counted(errors, "counted.error", "counted.errors");
                let warnings = counted(warnings, "counted.warning", "counted.warnings");
                Message::new("counted.failed").with_messages("counts", vec![errors, warnings, hints])
            }
        };
        message.with_messages("size", vec![size])
    }
}

/// `1 rung`, `2 rungs`.
pub fn rungs_counted(count: usize) -> Message {
    counted(count, "counted.rung", "counted.rungs")
}

fn counted(count: usize, one: &'static str, many: &'static str) -> Message {
    Message::new(if count == 1 { one } else { many }).with("count", count)
}
