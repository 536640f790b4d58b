//! # unused-suppression
//!
//! A comment allows something that no rule reports there. The mistake that it was written for is mended, or the code is
//! not that of any rule; and one day it will hide a mistake that somebody should see. The fix removes it.
//!
//! `// rungwise: allow(double-coil)` directly above a rung, or beside its instructions, holds for that rung; several
//! codes are separated by commas. At the top of a file, with a blank line behind it or above the first declaration, it
//! holds for the whole file. What cannot be read cannot be allowed.
//!
//! ```fx
//! // rungwise: allow(double-coil)
//!                    ^^^^^^^^^^^
//! LD X0
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! // Overwritten on purpose: rungwise: allow(double-coil)
//! LD X0
//! OUT Y0
//! LD X1
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! // rungwise: allow(double-coli)
//!                    ^^^^^^^^^^^
//! |  X0        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```lad
//! // rungwise: allow(double-coil)
//! |  X0        Y0  |
//! +--| |-------( )-+
//!
//! |  X1        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```iec
//! (* rungwise: allow(set-without-reset, reset-without-set) *)
//!                                       ^^^^^^^^^^^^^^^^^
//! PROGRAM Alarm
//! VAR
//!     Hot  AT %IX0.0 : BOOL;
//!     Horn AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Hot
//!     S Horn
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Alarm
//! VAR
//!     Hot  AT %IX0.0 : BOOL;
//!     Horn AT %QX0.0 : BOOL;
//! END_VAR
//!     (* rungwise: allow(set-without-reset) *)
//!     LD Hot
//!     S Horn
//! END_PROGRAM
//! ```

use crate::check::suppression::{Entry, Suppression, is_suppressible};
use crate::check::{RULES, Rule, Run};
use crate::document::{Allowance, Document};
use crate::target::iec::nearest;
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "unused-suppression",
    severity: Severity::Hint,
    run: Run::Last,
    source: include_str!("unused_suppression.rs"),
};

/// The codes in comments of `document` that allow nothing of `found`, all that was found in it.
pub(in crate::check) fn unused<'f>(
    document: &Document,
    suppression: &Suppression,
    found: impl Iterator<Item = &'f Diagnostic>,
) -> Vec<Diagnostic> {
    suppression.unused(found).map(|(entry, comment)| diagnostic(document, entry, comment)).collect()
}

fn diagnostic(document: &Document, entry: &Entry, comment: &Allowance) -> Diagnostic {
    let code = entry.code.as_str();
    let mut fixes = Vec::new();
    let message = if Rule::named(code).is_none() {
        let near = nearest(code, RULES.iter().map(|rule| rule.code));
        for other in &near {
            let title = Message::new("unused-suppression.replace").with("other", other);
            fixes.push((title, TextEdit::new(entry.span, other.clone())));
        }
        match near.is_empty() {
            true => Message::new("unused-suppression.unknown"),
            false => Message::new("unused-suppression.near").with_alternatives("near", near),
        }
    } else if !is_suppressible(code) {
        Message::new("unused-suppression.reading")
    } else {
        Message::new("unused-suppression.found")
    };
    fixes.push((
        Message::new("unused-suppression.remove").with("code", code),
        removal(document, entry, comment),
    ));
    let diagnostic = Diagnostic::new(RULE.code, entry.span, message.with("code", code));
    fixes.into_iter().fold(diagnostic, |diagnostic, (title, edit)| diagnostic.fix(title, vec![edit]))
}

/// Takes the code out of its list, or the whole comment where it has nothing else to say.
fn removal(document: &Document, entry: &Entry, comment: &Allowance) -> TextEdit {
    let place = comment.codes.iter().position(|span| *span == entry.span).unwrap_or(0);
    let neighbour = |number: usize| comment.codes.get(number);
    if let Some(next) = neighbour(place + 1) {
        return TextEdit::new(Span { start: entry.span.start, end: next.start }, "");
    }
    if let Some(previous) = place.checked_sub(1).and_then(neighbour) {
        return TextEdit::new(Span { start: previous.end, end: entry.span.end }, "");
    }
    if !comment.is_alone {
        return TextEdit::new(directive(document, comment), "");
    }
    let (_, start, line) = document.line_at(comment.comment.start as usize);
    let end = start + line.len();
    let around = Span::new(start, end);
    let own = document.slice(around).trim().len() == comment.comment.len();
    TextEdit::new(if own { around } else { comment.comment }, "")
}

/// `rungwise: allow(…)` inside of a comment that says more.
fn directive(document: &Document, comment: &Allowance) -> Span {
    let text = document.slice(comment.comment);
    let start = text.find(crate::document::DIRECTIVE).unwrap_or(0);
    let end = text[start..].find(')').map_or(text.len(), |end| start + end + 1);
    Span::new(start, end).shifted(comment.comment.start as usize)
}
