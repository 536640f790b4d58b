//! Instruction order: the current result, the stacks, labels and program structure.

use super::Rule;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[];
