//! # ragged-drawing
//!
//! A line or a name is off by a column or two, and was read all the same, because only one reading is possible.
//!
//! Drawings by hand waver. What was read is what everybody reads, but the next edit may make it ambiguous; redrawing
//! puts every line into its column.
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

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "ragged-drawing",
    severity: Severity::Hint,
    run: Run::WhileReading,
    source: include_str!("ragged_drawing.rs"),
};
