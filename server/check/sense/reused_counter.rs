//! # reused-counter
//!
//! One counter is driven in two places. Its count and the memory for its edge are the same in both: while one of them
//! is on and the other off, it sees an edge in every scan, and counts scans. Lead both conditions to one coil, in
//! parallel, or use two counters.
//!
//! Counters in different steps, in different subroutines, and in parts of which jumps choose one may share a number. In
//! IEC 61131-3 the same holds for the calls of one instance.
//!
//! ```fx
//! LD X0
//! OUT C0 K50
//! LD X1
//! OUT C0 K30
//!     ^^
//! LD X2
//! RST C0
//! LD C0
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT C0 K50
//! LD X1
//! OUT C1 K30
//! LD X2
//! RST C0
//! RST C1
//! LD C0
//! OR C1
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0     C0 K50 |
//! +--| |-------( )-+
//! |                |
//! |  X1     C0 K30 |
//!           ^^
//! +--| |-------( )-+
//! |                |
//! |  C0        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```lad
//! |  X0     C0 K50 |
//! +--| |-------( )-+
//! |                |
//! |  C0        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Stop  AT %IX0.1 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Pieces : CTU;
//! END_VAR
//!     CAL Pieces(CU := Start, PV := 5)
//!     CAL Pieces(CU := Stop, PV := 3)
//!         ^^^^^^
//!     LD Pieces.Q
//!     ST Motor
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Pieces : CTU;
//! END_VAR
//!     CAL Pieces(CU := Start, PV := 5)
//!     LD Pieces.Q
//!     ST Motor
//! END_PROGRAM
//! ```

use super::again::driven_again;
use crate::check::{ProgramContext, Rule, Run};
use crate::target::DeviceKind;
use crate::text::{Diagnostic, Severity};

pub(super) const RULE: Rule = Rule {
    code: "reused-counter",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("reused_counter.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    driven_again(context, RULE.code, DeviceKind::C, "PV", found);
}
