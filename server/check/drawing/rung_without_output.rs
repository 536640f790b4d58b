//! # rung-without-output
//!
//! The contacts of a rung lead to no output. The PLC would do nothing with them, so the maker's tools refuse such a
//! rung; mostly the output was forgotten, or the instruction that follows stands without contacts, as `END` and `FEND`
//! do.
//!
//! ```fx
//! LD X0
//! AND X1
//! ^^^^^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! AND X1
//! OUT Y0
//! END
//! ```

use crate::check::order::rung::{Finding, findings};
use crate::check::{ChunkContext, Rule, Run};
use crate::document::Tree;
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "rung-without-output",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("rung_without_output.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    match context.chunk.tree() {
        Tree::Fx(_) => of_list(context, found),
        Tree::Ladder(_) | Tree::Iec(_) => {}
    }
}

/// Contacts of an instruction list. The last of them is marked: an output is missing right behind it.
fn of_list(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some((tree, findings)) = findings(context) else { return };
    let text = context.chunk.text();
    for finding in findings {
        let Finding::NoOutput { first, last, before } = finding else { continue };
        let (first, last) = (tree.lines[first].span, tree.lines[last].span);
        let before = before.map_or(Span::at(0), |line| tree.lines[line].span);
        let key = if before.is_empty() { "rung-without-output.list" } else { "rung-without-output.before" };
        let message = Message::new(key).with("last", last.of(text)).with("before", before.of(text));
        let mut diagnostic = Diagnostic::new(RULE.code, last, message);
        if first != last {
            diagnostic = diagnostic.related(first, Message::new("rung-without-output.first"));
        }
        found.push(diagnostic);
    }
}
