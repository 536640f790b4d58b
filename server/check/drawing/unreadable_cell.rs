//! # unreadable-cell
//!
//! A character, or a bar, that is no part of a drawing: it is no wire, junction, contact, output or name.
//!
//! The cell is not guessed at, because a guess could close a circuit that was meant to be open. The rung is not judged
//! further until it can be read.
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |------&-----------------------------( )-+
//!              ^
//! ```
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |------------------------------------( )-+
//! ```
//!
//! A bar is a vertical wire if a wire end, a `+` or another bar is directly above or below it, and it is a rail in the
//! first and last column. A bar that is none of these joins nothing.

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "unreadable-cell",
    severity: Severity::Error,
    run: Run::WhileReading,
    source: include_str!("unreadable_cell.rs"),
};
