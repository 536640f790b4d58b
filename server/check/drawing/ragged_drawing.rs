//! # ragged-drawing
//!
//! A line or a name is off by a column or two, and was read all the same, because only one reading is possible.
//!
//! Drawings by hand waver. What was read is what everybody reads, but the next edit may make it ambiguous; redrawing
//! puts every line into its column.
//!
//! Where two readings are possible neither is taken: the finding is a warning, shows both places and offers to redraw
//! the rung in either way. Until then the rung is not judged any further, and nothing should be built from it.
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |---+--------------------------------( )-+
//! |   X1     |                                   |
//!            ^
//! +---| |----+                                   |
//! ```
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |---+--------------------------------( )-+
//! |   X1    |                                    |
//! +---| |---+                                    |
//! ```

use super::Drawn;
use crate::check::{Rule, Run};
use crate::ladder::{Choice, TWO_READINGS, parse_choosing, redraw};
use crate::text::{Diagnostic, Message, Severity, TextEdit};
use rustc_hash::FxHashMap;

pub(super) const RULE: Rule = Rule {
    code: "ragged-drawing",
    severity: Severity::Hint,
    run: Run::Chunk(|context, found| {
        super::run(|drawn, found| offer_redrawing(drawn, found), context, found)
    }),
    source: include_str!("ragged_drawing.rs"),
};

/// More rungs of one chunk, or more doubts, get no fix, so that a keystroke in them stays cheap.
const REDRAWN_MAX: usize = 8;

/// Adds the fixes to what was found while reading: the rung as it was read, or as it would be in each reading.
fn offer_redrawing(drawn: &Drawn<'_>, found: &mut [Diagnostic]) {
    if !drawn.can_try() {
        return;
    }
    let mut redrawn: FxHashMap<usize, Option<TextEdit>> = FxHashMap::default();
    let mut doubts = 0;
    for finding in found.iter_mut().filter(|finding| finding.code == RULE.code) {
        if finding.message.key() == TWO_READINGS {
            doubts += 1;
            if doubts <= REDRAWN_MAX {
                offer_readings(drawn, finding);
            }
            continue;
        }
        let offset = finding.span.start;
        let holds = |span: crate::text::Span| span.start <= offset && offset < span.end;
        let Some(rung) = drawn.tree.rungs.iter().position(|rung| holds(rung.span)) else { continue };
        if redrawn.len() >= REDRAWN_MAX && !redrawn.contains_key(&rung) {
            continue;
        }
        let edit = || redraw(drawn.text, drawn.tree, offset, drawn.target);
        if let Some(edit) = redrawn.entry(rung).or_insert_with(edit) {
            *finding = finding.clone().fix(Message::new("ragged-drawing.redraw"), vec![edit.clone()]);
        }
    }
}

fn offer_readings(drawn: &Drawn<'_>, finding: &mut Diagnostic) {
    let end = finding.span;
    for reading in finding.related.clone() {
        let choice = Choice { end, joint: reading.span };
        let tree = parse_choosing(drawn.text, drawn.target, drawn.tree.names, choice);
        if let Some(edit) = redraw(drawn.text, &tree, end.start, drawn.target) {
            let column = crate::ladder::column_of(drawn.text, reading.span.start) + 1;
            let title = Message::new("ragged-drawing.redraw-as").with("column", column);
            *finding = finding.clone().fix(title, vec![edit]);
        }
    }
}
