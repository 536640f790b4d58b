//! # stray-operand
//!
//! A name that belongs to no element, or one name over two of them.
//!
//! A name names the element whose columns it overlaps. One that stands over a wire names nothing, and a contact that is
//! taken for another is a fault that nobody sees in the logic. Moving the name over the nearest element without one is
//! offered, or drawing a contact below it where there is none, or leaving the name out.
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
