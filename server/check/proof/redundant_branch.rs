//! # redundant-branch
//!
//! A branch that makes no difference: wherever it conducts, the branches beside it do, so that each output of the rung
//! is on in the same scans without it. A contact in it may name another device than was meant, or the branch is left
//! over from a change.
//!
//! This is proved for all values of the devices; the mark is on the first contact of the branch. The fix takes it away,
//! and is proved, too. In Instruction List of IEC 61131-3 it is taken away by hand.
//!
//! ```lad
//! |   X0                     Y0  |
//! +---| |-----------+--------( )-+
//! |   X0       X1   |            |
//! +---| |------| |--+            |
//!     ^^^
//! ```
//!
//! ```lad
//! |   X0                     Y0  |
//! +---| |-----------+--------( )-+
//! |   Y0       X1   |            |
//! +---| |------| |--+            |
//! ```
//!
//! ```fx
//! LD X0
//! LD X1
//! ^^^^^
//! AND X0
//! ORB
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! ANI X1
//! LDI X0
//! AND X1
//! ORB
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
//!     OR( Free
//!         ^^^^
//!     AND Open
//!     )
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
//!     OR( Lift
//!     AND Free
//!     )
//!     ST Lift
//! END_PROGRAM
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "redundant-branch",
    severity: Severity::Hint,
    run: Run::With("never-energised"),
    source: include_str!("redundant_branch.rs"),
};
