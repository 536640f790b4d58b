//! # syntax-error
//!
//! The text cannot be read here. Reading goes on at the next instruction, so one mistake hides no others; but
//! nothing can be sent to a PLC before it is mended.
//!
//! Common causes: two instructions on one line, a comma with nothing behind it, a missing quote, full-width letters
//! from an input method.
//!
//! ```fx
//! LD X0 OUT Y0
//!       ^^^
//! MOV K1,
//!       ^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT Y0
//! MOV K1,D0
//! END
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR a : BOOL; END_VAR
//! LD a b
//!      ^
//! END_PROGRAM
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "syntax-error",
    severity: Severity::Error,
    run: Run::WhileReading,
    source: include_str!("syntax_error.rs"),
};
