//! What the rules about IEC 61131-3 share: the types of operands, what can be called with which parameters, and the
//! walk that follows the current result.

mod view;
pub(super) use view::{Place, Root, ValueType, View, views, views_of};

mod callee;
pub(super) use callee::{Callee, Expected, Flow, Pin};

mod fit;
pub(super) use fit::{Fit, fit};

mod current_result;
pub(super) use current_result::follow;

mod words;
pub(super) use words::{
    misplaced_words, operand_counts, unknown_instructions, unknown_values, unreadable_operands,
};

mod initial;
pub(super) use initial::initial_values;

mod arguments;
pub(super) use arguments::{constant_written, expression_written, out_of_range};
