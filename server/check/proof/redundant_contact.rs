//! # redundant-contact
//!
//! A contact that makes no difference: without it each output of the rung is on in the same scans. It may name another
//! device than was meant, it may be left over from a change, and it costs a step in each scan.
//!
//! This is proved for all values of the devices; the message says what does the work of the contact. The fix takes it
//! away, and is proved, too. In Instruction List of IEC 61131-3 it is taken away by hand.
//!
//! ```lad
//! |  X0    X1    X0     Y0  |
//! +--| |---| |---| |----( )-+
//!                ^^^
//! ```
//!
//! ```lad
//! |  X0    X1    X2     Y0  |
//! +--| |---| |---| |----( )-+
//! ```
//!
//! ```fx
//! LD X0
//! LDI X0
//! ^^^^^^
//! AND X1
//! ORB
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OR X1
//! OUT Y0
//! END
//! ```
//!
//! ```iec
//! PROGRAM Gate
//! VAR
//!     Open AT %IX0.0 : BOOL;
//!     Free AT %IX0.1 : BOOL;
//!     Lift AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Open
//!     AND Free
//!     AND Open
//!         ^^^^
//!     ST Lift
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Gate
//! VAR
//!     Open AT %IX0.0 : BOOL;
//!     Free AT %IX0.1 : BOOL;
//!     Lift AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Open
//!     AND Free
//!     ST Lift
//! END_PROGRAM
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "redundant-contact",
    severity: Severity::Hint,
    run: Run::With("never-energised"),
    source: include_str!("redundant_contact.rs"),
};
