//! Instruction order: the current result, the stacks, labels and program structure.

use super::Rule;

pub(super) mod rung;

mod no_current_result;

mod result_type_mismatch;

mod block_stack;

mod branch_stack;

mod nesting_too_deep;

mod labels;
pub(super) use labels::END_POINTER;

mod duplicate_label;

mod undefined_label;

mod unused_label;

mod jump_into_loop;

mod master_control_order;

mod for_next_balance;

mod step_ladder_structure;

mod subroutine_structure;

mod missing_end;

mod code_after_end;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[
    &no_current_result::RULE,
    &result_type_mismatch::RULE,
    &block_stack::RULE,
    &branch_stack::RULE,
    &nesting_too_deep::RULE,
    &duplicate_label::RULE,
    &undefined_label::RULE,
    &unused_label::RULE,
    &jump_into_loop::RULE,
    &master_control_order::RULE,
    &for_next_balance::RULE,
    &step_ladder_structure::RULE,
    &subroutine_structure::RULE,
    &missing_end::RULE,
    &code_after_end::RULE,
];
