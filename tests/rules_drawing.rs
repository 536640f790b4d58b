//! Rules about drawings where a page is too small to show them.

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Notation};
use rungwise::ladder::{self, Style};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Language, Severity, TextEdit};

fn found_for(text: &str, model: Model) -> Vec<Diagnostic> {
    let document = Document::new(text, Notation::Ladder, Target::of(model));
    check::realtime(&document, &Severities::default())
}

fn found(text: &str) -> Vec<Diagnostic> {
    found_for(text, Model::Fx2n)
}

/// `code at line:column` of each finding above a hint, or of all.
fn places(text: &str, found: &[Diagnostic]) -> Vec<String> {
    let place = |diagnostic: &Diagnostic| {
        let before = &text[..diagnostic.span.start as usize];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        format!("{} {line}:{column}", diagnostic.code)
    };
    found.iter().filter(|diagnostic| diagnostic.severity != Severity::Hint).map(place).collect()
}
