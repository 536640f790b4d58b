//! # reused-timer
//!
//! One timer is driven in two places. It has one current value: the place whose contacts are off sets it back to 0 in
//! each scan, and the other one never gets to its preset; or both presets fight. Give each its own timer.
//!
//! Timers in different steps, in different subroutines, and in parts of which jumps choose one may share a number. In
//! IEC 61131-3 the same holds for the calls of one instance.
//!
//! ```fx
//! LD X0
//! OUT T0 K50
//! LD X1
//! OUT T0 K30
//!     ^^
//! LD T0
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT T0 K50
//! LD X1
//! OUT T1 K30
//! LD T0
//! OR T1
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0     T0 K50 |
//! +--| |-------( )-+
//! |                |
//! |  X1     T0 K30 |
//!           ^^
//! +--| |-------( )-+
//! |                |
//! |  T0        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```lad
//! |  X0     T0 K50 |
//! +--| |-------( )-+
//! |                |
//! |  T0        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Stop  AT %IX0.1 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Delay : TON;
//! END_VAR
//!     CAL Delay(IN := Start, PT := T#5s)
//!     CAL Delay(IN := Stop, PT := T#3s)
//!         ^^^^^
//!     LD Delay.Q
//!     ST Motor
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Delay : TON;
//! END_VAR
//!     CAL Delay(IN := Start, PT := T#5s)
//!     LD Delay.Q
//!     ST Motor
//! END_PROGRAM
//! ```

use super::again::driven_again;
use crate::check::{ProgramContext, Rule, Run};
use crate::target::DeviceKind;
use crate::text::{Diagnostic, Severity};

pub(super) const RULE: Rule = Rule {
    code: "reused-timer",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("reused_timer.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    driven_again(context, RULE.code, DeviceKind::T, "PT", found);
}
