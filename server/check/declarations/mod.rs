//! Declarations of IEC 61131-3 programs.

use super::Rule;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[];
