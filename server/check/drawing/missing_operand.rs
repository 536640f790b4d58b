//! # missing-operand
//!
//! A contact, a coil or a comparison without an operand: no name stands above it or inside its symbol.
//!
//! A contact without a device asks for nothing, and a PLC cannot run it. Write the name above the symbol, so that it
//! overlaps its columns, or inside: `[X0]`, `(Y0)`.
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |-------| |--------------------------( )-+
//!               ^^^
//! ```
//!
//! ```lad
//! |   X0      X1                             Y0  |
//! +---| |-----| |----------------------------( )-+
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "missing-operand",
    severity: Severity::Error,
    run: Run::WhileReading,
    source: include_str!("missing_operand.rs"),
};
