//! Words and operands: what is written in an instruction or beside an element.

use super::Rule;

pub(super) mod plain;

mod unknown_instruction;

mod unread_word;

mod instruction_not_on_target;

mod operand_count;

mod operand_kind;

mod unknown_device;

mod octal_digit;

mod device_out_of_range;

mod constant_out_of_range;

mod missing_preset;

mod write_to_input;

mod malformed_literal;

mod unclosed_comment;

mod unclosed_parenthesis;

mod syntax_error;

mod lenient_form;

mod text_too_large;

mod device_comments;

/// The rules of this group.
pub(super) const RULES: &[&Rule] = &[
    &unknown_instruction::RULE,
    &unread_word::RULE,
    &instruction_not_on_target::RULE,
    &operand_count::RULE,
    &operand_kind::RULE,
    &unknown_device::RULE,
    &octal_digit::RULE,
    &device_out_of_range::RULE,
    &constant_out_of_range::RULE,
    &missing_preset::RULE,
    &write_to_input::RULE,
    &malformed_literal::RULE,
    &unclosed_comment::RULE,
    &unclosed_parenthesis::RULE,
    &syntax_error::RULE,
    &lenient_form::RULE,
    &text_too_large::RULE,
    &device_comments::RULE,
];
