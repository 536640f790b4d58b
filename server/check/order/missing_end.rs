//! # missing-end
//!
//! A program in instruction list has no `END`. The PLC would go on through its whole empty memory, so it refuses to run
//! without it, and the maker's tools add none. The fix appends it.
//!
//! Of the files of a project only the one that is executed last needs it.
//!
//! A drawing needs no `END`: it ends with its last rung. Only where `FEND` divides it into a main program and
//! subroutines is the `END` asked for, as the end of the last part.
//!
//! ```fx
//! LD X0
//! OUT Y0
//! ^^^^^^
//! ```
//!
//! ```fx
//! LD X0
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0            |
//! +--| |--[CALL P1]+
//!
//! |                |
//! +--------[FEND]--+
//!           ^^^^
//!
//! P1:
//! |  X1        Y1  |
//! +--| |-------( )-+
//!
//! |                |
//! +--------[SRET]--+
//! ```

use crate::check::statements::StatementKind;
use crate::check::{ProgramContext, ProgramFile, Rule, Run};
use crate::document::{Document, Notation};
use crate::target::Flow;
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "missing-end",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("missing_end.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some(ProgramFile { document, start, .. }) = context.last() else { return };
    let (mut last, mut last_main_end) = (None, None);
    for statement in context.statements() {
        match statement.kind {
            StatementKind::Instruction(Flow::ProgramEnd) => return,
            StatementKind::Instruction(Flow::MainEnd) => last_main_end = Some(statement.span),
            _ => {}
        }
        // The program ends in its last file, and only there END is missing.
        last = Some(statement.span).filter(|span| span.start as usize >= start);
    }
    let is_list = document.notation() == Notation::FxIl;
    let Some(span) = (if is_list { last } else { last_main_end }) else { return };
    // A comment that is never closed has swallowed the END, if there is one.
    let last_chunk = document.chunk_at(document.len());
    let problems = last_chunk.iter().flat_map(|at| at.chunk.problems());
    if problems.into_iter().any(|problem| problem.code == "unclosed-comment") {
        return;
    }
    let diagnostic = Diagnostic::new(RULE.code, span, Message::new("missing-end.found"));
    found.push(match is_list {
        true => diagnostic.fix(Message::new("missing-end.append"), vec![appended(document).shifted(start)]),
        false => diagnostic,
    });
}

/// END on a line of its own at the end of the text.
fn appended(document: &Document) -> TextEdit {
    let text = document.chunk_at(document.len()).map_or("", |at| at.chunk.text());
    let newline = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let before = if text.ends_with('\n') { "" } else { newline };
    TextEdit::new(Span::at(document.len()), format!("{before}END{newline}"))
}
