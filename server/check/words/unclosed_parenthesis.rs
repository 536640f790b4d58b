//! # unclosed-parenthesis
//!
//! A parenthesis is opened and never closed. In instruction list of IEC 61131-3 `AND(` defers the operation until its
//! `)`; without it the rest of the network would be part of the operand, and nothing would be stored.
//!
//! ```iec
//! PROGRAM Main
//! VAR a, b, c : BOOL; END_VAR
//! LD a
//! AND( b
//!    ^
//! OR c
//! ST a
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR a, b, c : BOOL; END_VAR
//! LD a
//! AND( b
//! OR c
//! )
//! ST a
//! END_PROGRAM
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "unclosed-parenthesis",
    severity: Severity::Error,
    run: Run::WhileReading,
    source: include_str!("unclosed_parenthesis.rs"),
};
