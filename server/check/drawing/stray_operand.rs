//! # stray-operand
//!
//! A name that belongs to no element, or one name over two of them.
//!
//! A name names the element whose columns it overlaps. One that stands over a wire names nothing, and a contact that is
//! taken for another is a fault that nobody sees in the logic. If an element without a name is near, moving the name
//! over it is offered.
//!
//! ```lad
//! |   X0                X1                   Y0  |
//!                       ^^
//! +---| |------------------------------------( )-+
//! ```
//!
//! ```lad
//! |   X0      X1                             Y0  |
//! +---| |-----| |----------------------------( )-+
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "stray-operand",
    severity: Severity::Error,
    run: Run::WhileReading,
    source: include_str!("stray_operand.rs"),
};
