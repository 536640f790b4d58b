//! # text-too-large
//!
//! A document of this size is kept and can be edited, but it is not read: no PLC of the families that Rungwise knows
//! holds a program a hundredth as long. Most likely the file is not a program.
//!
//! ```fx
//! LD X0
//! OUT Y0
//! END
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "text-too-large",
    severity: Severity::Error,
    run: Run::WhileReading,
    source: include_str!("text_too_large.rs"),
};
