//! Words and operands: what is written in an instruction or beside an element.

use super::Rule;

mod octal_digit;
mod text_too_large;
mod unknown_device;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[&unknown_device::RULE, &octal_digit::RULE, &text_too_large::RULE];
