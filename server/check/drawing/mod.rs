//! Drawing: wires, elements and rungs as they are drawn.

use super::Rule;

mod rung_without_output;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[&rung_without_output::RULE];
