//! Program sense: what reads like a program and does something else than its author meant.

use super::Rule;

mod uses;
pub(super) use uses::Uses;

mod regions;
pub(super) use regions::Regions;

mod coils;

mod double_coil;

mod coil_and_set_reset;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[&double_coil::RULE, &coil_and_set_reset::RULE];
