//! # tab-in-drawing
//!
//! The drawing is laid out with tabs, which other programs may show in other columns.
//!
//! A drawing says what it says by its columns. A tab is read as blanks up to the next column that is a multiple
//! of 8, as terminals show it; an editor with tabs of 4 columns shows the same file with names beside their contacts
//! and branches that miss their junction, and who corrects what he sees there changes the program. The first tab is
//! reported; the fix replaces all tabs of the file by the blanks for which they were read.
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |------------------------------------( )-+
//! ```

use crate::check::{ProgramContext, Rule, Run};
use crate::document::{Document, Notation, Tree};
use crate::ladder::column_after;
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "tab-in-drawing",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("tab_in_drawing.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    context.each_file(found, check_file);
}

fn check_file(document: &Document, found: &mut Vec<Diagnostic>) {
    let is_drawn = document.notation() == Notation::Ladder;
    let Some(first) = is_drawn.then(|| first_tab(document)).flatten() else { return };
    let diagnostic = Diagnostic::new(RULE.code, first, Message::new("tab-in-drawing.found"));
    found.push(diagnostic.fix(Message::new("tab-in-drawing.expand"), expanded(document)));
}

/// The first tab on the lines of a rung; tabs in comments and declarations move nothing.
fn first_tab(document: &Document) -> Option<Span> {
    let mut start = 0;
    for chunk in document.pages().iter().flat_map(|page| page.chunks()) {
        // Few drawings have tabs, and only these have to be read for it.
        if chunk.text().contains('\t')
            && let Tree::Ladder(tree) = chunk.reading().tree()
        {
            let commented = |at: usize| {
                tree.comments.iter().any(|span| (span.start as usize..span.end as usize).contains(&at))
            };
            let mut line_start = 0;
            for (number, line) in (0u32..).zip(chunk.text().split_inclusive('\n')) {
                let drawn = tree.rungs.iter().any(|rung| rung.lines.0 <= number && number < rung.lines.1);
                // A tab behind everything in its line moves nothing either.
                let tabs = line.trim_end().match_indices('\t').map(|(at, _)| line_start + at);
                if let Some(at) = tabs.filter(|at| drawn && !commented(*at)).min() {
                    return Some(Span::new(start + at, start + at + 1));
                }
                line_start += line.len();
            }
        }
        start += chunk.len();
    }
    None
}

/// Blanks for every tab of the document.
fn expanded(document: &Document) -> Vec<TextEdit> {
    let (mut start, mut column) = (0, 0);
    let mut edits = Vec::new();
    for chunk in document.pages().iter().flat_map(|page| page.chunks()) {
        for (at, character) in chunk.text().char_indices() {
            let after = column_after(column, character);
            if character == '\t' {
                let span = Span::new(start + at, start + at + 1);
                edits.push(TextEdit::new(span, " ".repeat((after - column) as usize)));
            }
            column = if matches!(character, '\n' | '\r') { 0 } else { after };
        }
        start += chunk.len();
    }
    edits
}
