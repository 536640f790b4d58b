//! # contact-on-vertical
//!
//! An element is drawn on a vertical wire. Power flows through contacts and outputs from left to right; vertical wires
//! only join branches.
//!
//! A contact between two lines would be a bridge, and power would flow through it in both directions. No PLC program
//! can say that. Draw the contact into one of the lines.
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |---+--------------------------------( )-+
//! |         |                                    |
//! |        |/|                                   |
//!          ^^^
//! |         |                                Y1  |
//! |         +--------------------------------( )-+
//! ```
//!
//! ```lad
//! |   X0                                     Y0  |
//! +---| |---+--------------------------------( )-+
//! |         |   X1                           Y1  |
//! |         +---|/|--------------------------( )-+
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "contact-on-vertical",
    severity: Severity::Error,
    run: Run::WhileReading,
    source: include_str!("contact_on_vertical.rs"),
};
