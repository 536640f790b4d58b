//! Declarations of IEC 61131-3 programs.

use super::Rule;
use crate::il::iec::Declaration;
use crate::text::{Span, TextEdit};

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

/// Takes out the line of a declaration that has it for itself.
fn removal(text: &str, declaration: &Declaration, start: usize) -> Option<TextEdit> {
    let (from, to) = (declaration.span.start as usize, declaration.span.end as usize);
    let line = text.get(..from)?.rfind('\n').map_or(0, |newline| newline + 1);
    let end = to + text.get(to..)?.find('\n')? + 1;
    let alone = text.get(line..from)?.trim().is_empty() && text.get(to..end)?.trim() == ";";
    alone.then(|| TextEdit::new(Span::new(line, end).shifted(start), ""))
}
