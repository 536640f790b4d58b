//! Drawing: wires, elements and rungs as they are drawn.

use super::Rule;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[];
