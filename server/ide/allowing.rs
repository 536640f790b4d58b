//! Quick fixes that write a comment which allows what a rule reports, for a rung or for a file.

use crate::check::is_suppressible;
use crate::document::{Allowance, Document, Notation};
use crate::text::{Diagnostic, Fix, Message, Severity, Span, TextEdit};

/// For each warning and hint that `span` touches and that may be allowed: the comment above its rung, and the one at
/// the top of the file. A comment that is there already gets the code into its list.
pub(super) fn within<'d>(
    document: &Document,
    diagnostics: &'d [Diagnostic],
    span: Span,
) -> Vec<(&'d Diagnostic, Fix)> {
    let may_be_allowed = |diagnostic: &&Diagnostic| {
        diagnostic.severity != Severity::Error
            && diagnostic.span.start <= span.end
            && span.start <= diagnostic.span.end
            && is_suppressible(diagnostic.code)
    };
    let mut found: Vec<&Diagnostic> = diagnostics.iter().filter(may_be_allowed).collect();
    found.dedup_by_key(|diagnostic| diagnostic.code);
    if found.is_empty() {
        return Vec::new();
    }
    let allowances = document.allowances();
    let fixes = found.into_iter().flat_map(|diagnostic| {
        let code = diagnostic.code;
        let rung = for_rung(document, &allowances, diagnostic);
        let rung = rung.map(|edit| (Message::new("allow.rung"), edit));
        let file = (Message::new("allow.file"), for_file(document, &allowances, code));
        rung.into_iter().chain([file]).map(move |(title, edit)| {
            (diagnostic, Fix { title: title.with("code", code), edits: vec![edit] })
        })
    });
    fixes.collect()
}

fn for_rung(document: &Document, allowances: &[Allowance], diagnostic: &Diagnostic) -> Option<TextEdit> {
    let at = document.chunk_at(diagnostic.span.start as usize)?;
    let own = |one: &&Allowance| !one.is_for_file && one.covers.start == at.start;
    if let Some(edit) = allowances.iter().find(own).and_then(|one| extended(one, diagnostic.code)) {
        return Some(edit);
    }
    let first = at.start + at.chunk.content_start()?;
    let (_, line, text) = document.line_at(first);
    let indent: String = text.chars().take_while(|c| matches!(c, ' ' | '\t')).collect();
    // Drawings begin in a column that means something, and so do comments beside them.
    let indent = if document.notation() == Notation::Ladder { String::new() } else { indent };
    let comment = comment(document, diagnostic.code);
    Some(TextEdit::new(Span::at(line), format!("{indent}{comment}{}", newline(document))))
}

fn for_file(document: &Document, allowances: &[Allowance], code: &str) -> TextEdit {
    let own = allowances.iter().find(|one| one.is_for_file);
    own.and_then(|one| extended(one, code)).unwrap_or_else(|| {
        let start = if document.line_at(0).2.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        let (comment, newline) = (comment(document, code), newline(document));
        TextEdit::new(Span::at(start), format!("{comment}{newline}{newline}"))
    })
}

/// The code behind the last one of a list that has any.
fn extended(allowance: &Allowance, code: &str) -> Option<TextEdit> {
    let last = allowance.codes.last()?;
    Some(TextEdit::new(Span::at(last.end as usize), format!(", {code}")))
}

/// In the way of comments that every reader of the notation knows.
fn comment(document: &Document, code: &str) -> String {
    match document.notation() {
        Notation::IecIl => format!("(* rungwise: allow({code}) *)"),
        Notation::FxIl | Notation::Ladder => format!("// rungwise: allow({code})"),
    }
}

fn newline(document: &Document) -> &'static str {
    if document.line_at(0).2.ends_with("\r\n") { "\r\n" } else { "\n" }
}
