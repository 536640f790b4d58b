//! # unclosed-comment
//!
//! A comment begins with `(*` and is never closed by `*)`, so the rest of the program is a comment and never runs.
//! The fix closes it at the end of its first line.
//!
//! ```fx
//! LD X0
//! OUT Y0 (* the motor
//!        ^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT Y0 (* the motor *)
//! END
//! ```
//!
//! ```iec
//! PROGRAM Main
//! LD %IX0.0 (* the start button
//!           ^^
//! END_PROGRAM
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "unclosed-comment",
    severity: Severity::Error,
    run: Run::WhileReading,
    source: include_str!("unclosed_comment.rs"),
};
