//! # result-type-mismatch
//!
//! The current result is of one type and meets a place of another: a BOOL is added to an INT, an INT is stored to a
//! BOOL, a jump depends on a number. The standard has no conversion that happens by itself and loses something; what
//! a controller that lets it pass makes of the upper bits is a matter of luck.
//!
//! Conversions are functions (`DINT_TO_INT`), and a number becomes a BOOL by a comparison. Widening without loss,
//! such as INT to DINT, happens by itself in the third edition and is not reported; a controller of the second
//! edition asks for the conversion there too. Constants without a type take the type that they meet.
//!
//! ```iec
//! PROGRAM Filling
//! VAR
//!     Full : BOOL;
//!     Level, Doses : INT;
//!     Total : DINT;
//!     Done : TON;
//! END_VAR
//!     LD Level
//!     GT 90
//!     ADD Doses
//!     ^^^
//!     ST Doses
//!     LD Total
//!     ST Level
//!        ^^^^^
//!     LD Level
//!     JMPC Over
//!     ^^^^
//!     CAL Done(
//!         IN := Full,
//!         PT := Level
//!               ^^^^^
//!     )
//! Over:
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Filling
//! VAR
//!     Full : BOOL;
//!     Level, Doses : INT;
//!     Total : DINT;
//!     Done : TON;
//! END_VAR
//!     LD Level
//!     GT 90
//!     ST Full
//!     LD Total
//!     DINT_TO_INT
//!     ST Level
//!     LD Level
//!     NE 0
//!     JMPC Over
//!     CAL Done(
//!         IN := Full,
//!         PT := T#5s
//!     )
//!     LD Doses
//!     ADD 1
//!     ST Doses
//! Over:
//! END_PROGRAM
//! ```

use crate::check::{Rule, Run};
use crate::text::Severity;

pub(super) const RULE: Rule = Rule {
    code: "result-type-mismatch",
    severity: Severity::Error,
    run: Run::With("no-current-result"),
    source: include_str!("result_type_mismatch.rs"),
};
