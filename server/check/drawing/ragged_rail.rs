//! # ragged-rail
//!
//! The right rail of this block of rungs is not in one column.
//!
//! Nothing is wrong with the logic. A rail that wavers hides the row in which a wire really does not reach it, which
//! is the one to find.
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |------------------------------------( )-+
//! |   X1                                     Y1    |
//! +---| |------------------------------------( )---+
//!                                                  ^
//! ```
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |------------------------------------( )-+
//! |   X1                                     Y1  |
//! +---| |------------------------------------( )-+
//! ```

use super::Drawn;
use crate::check::{Rule, Run};
use crate::ladder::{Page, Style, format_chunk, parse_with};
use crate::text::{Diagnostic, Fix, Message, Severity, Span, Spanned, TextEdit};
use rustc_hash::FxHashMap;
use std::cmp::Reverse;

pub(super) const RULE: Rule = Rule {
    code: "ragged-rail",
    severity: Severity::Hint,
    run: Run::Chunk(|context, found| super::run(find, context, found)),
    source: include_str!("ragged_rail.rs"),
};

fn find(drawn: &Drawn<'_>, found: &mut Vec<Diagnostic>) {
    let rails: Vec<Spanned<u32>> =
        drawn.sound_rungs().flat_map(|rung| rung.right_rail.iter().copied()).collect();
    let Some(column) = usual_column(&rails) else { return };
    let mut odd = rails.iter().filter(|rail| rail.value != column);
    let Some(first) = odd.next() else { return };
    let message = Message::new("ragged-rail.found").with("column", first.value + 1).with("usual", column + 1);
    let mut diagnostic = Diagnostic::new(RULE.code, first.span, message);
    const SHOWN: usize = 8;
    for rail in odd.take(SHOWN) {
        let message = Message::new("ragged-rail.also").with("column", rail.value + 1);
        diagnostic = diagnostic.related(rail.span, message);
    }
    diagnostic.fixes.extend(formatted(drawn));
    found.push(diagnostic);
}

/// The column in which most rows have their rail; of several the one that comes first in the drawing.
fn usual_column(rails: &[Spanned<u32>]) -> Option<u32> {
    let mut counts: FxHashMap<u32, (usize, Reverse<usize>)> = FxHashMap::default();
    for (number, rail) in rails.iter().enumerate() {
        counts.entry(rail.value).or_insert((0, Reverse(number))).0 += 1;
    }
    counts.into_iter().max_by_key(|(_, count)| *count).map(|(column, _)| column)
}

/// The block as the formatter draws it, if the rail is straight there.
fn formatted(drawn: &Drawn<'_>) -> Option<Fix> {
    if !drawn.can_try() {
        return None;
    }
    let page = Page::of([(drawn.text, drawn.tree)], &Style::default());
    let text = format_chunk(drawn.text, drawn.tree, drawn.target, &page)?;
    let tree = parse_with(&text, drawn.target, drawn.tree.names);
    let mut columns = tree.rungs.iter().flat_map(|rung| &rung.right_rail).map(|rail| rail.value);
    let first = columns.next();
    let straight = columns.all(|column| Some(column) == first);
    let edits = vec![TextEdit::new(Span::new(0, drawn.text.len()), text)];
    straight.then(|| Fix { title: Message::new("ragged-rail.format"), edits })
}
