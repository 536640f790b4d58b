//! # lenient-form
//!
//! The form departs from IEC 61131-3 but is clear, and tools in the field accept it, so it is read. Where a program is
//! to be moved to another maker's tool, write the standard form: that tool may know only that one.
//!
//! ```iec
//! PROGRAM Main
//! VAR a, b : BOOL; END_VAR
//! ; a comment of another dialect
//! ^
//! LD a
//! ST b
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR a, b : BOOL; END_VAR
//! (* a comment *)
//! LD a
//! ST b
//! END_PROGRAM
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "lenient-form",
    severity: Severity::Hint,
    run: Run::WhileReading,
    source: include_str!("lenient_form.rs"),
};
