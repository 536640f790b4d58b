//! # program-too-large
//!
//! The program has more steps than the memory of the PLC holds, so it cannot be written to it. The first instruction
//! that finds no room is marked. An FX1S has 2,000 steps, an FX1N 8,000, an FX3U 64,000; an FX2N has 8,000, and 16,000
//! with a memory cassette, which is said as a warning.
//!
//! A drawing counts the instructions that stand for its elements. Those that join branches come on top once it is
//! translated, so a drawing may be too large a little earlier.
//!
//! Subroutines for what is done several times, `FMOV` for rows of equal values and `BMOV` for tables save most.
//!
//! ```fx
//! LD X0
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0        Y0  |
//! +--| |-------( )-+
//! ```

use crate::check::statements::is_fx_program;
use crate::check::{ProgramContext, Rule, Run};
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "program-too-large",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("program_too_large.rs"),
};

/// The message for a program that fits once memory is added.
pub(in crate::check) const WITH_CASSETTE: &str = "program-too-large.cassette";

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    if !context.files().first().is_some_and(|file| is_fx_program(file.document)) {
        return;
    }
    let limits = context.target().limits;
    let total = context.files().iter().map(|file| file.document.size().steps).fold(0, u32::saturating_add);
    let (capacity, key) = match total {
        _ if total <= limits.steps => return,
        _ if total <= limits.steps_at_most => (limits.steps, WITH_CASSETTE),
        _ => (limits.steps_at_most, "program-too-large.found"),
    };
    let Some(span) = first_beyond(context, capacity) else { return };
    let message = Message::new(key)
        .with("steps", total)
        .with("capacity", limits.steps)
        .with("most", limits.steps_at_most)
        .with("target", context.target().title);
    found.push(Diagnostic::new(RULE.code, span, message));
}

/// The first instruction that reaches beyond `capacity` steps. Pages and chunks that fit are passed over.
fn first_beyond(context: &ProgramContext<'_>, capacity: u32) -> Option<crate::text::Span> {
    let mut steps = 0u32;
    for file in context.files() {
        let mut start = file.start;
        for page in file.document.pages() {
            if steps.saturating_add(page.size().steps) <= capacity {
                steps += page.size().steps;
                start += page.bytes();
                continue;
            }
            for chunk in page.chunks() {
                if steps.saturating_add(chunk.size().steps) <= capacity {
                    steps += chunk.size().steps;
                    start += chunk.len();
                    continue;
                }
                let reading = chunk.reading();
                let beyond = reading.operations().find(|operation| {
                    steps = steps.saturating_add(operation.steps());
                    steps > capacity
                });
                // Labels have their steps too; then it is the last instruction behind them.
                let beyond = beyond.or_else(|| reading.operations().last());
                return beyond.map(|operation| operation.symbol.shifted(start));
            }
        }
    }
    None
}
