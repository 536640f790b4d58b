//! Declarations of IEC 61131-3 programs.

use super::Rule;

mod undeclared_variable;

mod duplicate_declaration;

mod unknown_type;

mod unknown_function_block;

mod unknown_parameter;

pub(super) mod boxes;

mod external_type;

mod constant_written;

mod address_overlap;

mod unused_variable;

mod recursive_pou;

mod missing_task;

mod config_path;

mod similar_names;

mod guess;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[
    &undeclared_variable::RULE,
    &duplicate_declaration::RULE,
    &external_type::RULE,
    &unknown_type::RULE,
    &unknown_function_block::RULE,
    &unknown_parameter::RULE,
    &constant_written::RULE,
    &address_overlap::RULE,
    &unused_variable::RULE,
    &recursive_pou::RULE,
    &missing_task::RULE,
    &config_path::RULE,
    &similar_names::RULE,
];
