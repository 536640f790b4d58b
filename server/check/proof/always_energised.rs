//! # always-energised
//!
//! An output that is on in every scan, whatever its devices are: the conditions before it hold for all of their values.
//! A contact names the wrong device, or a series was meant where a branch is drawn.
//!
//! This is proved; the message says the reason in one line. An output that M8000 alone drives is meant to be always on,
//! and not reported; so say what you mean where you need a relay that is on. In a master control or a step the output
//! is on whenever that is, and the message says so.
//!
//! ```lad
//! |   X0                     Y0  |
//!                            ^^
//! +---| |-----------+--------( )-+
//! |   X0            |            |
//! +---|/|-----------+            |
//! ```
//!
//! ```lad
//! |   X0                     Y0  |
//! +---| |-----------+--------( )-+
//! |   X1            |            |
//! +---|/|-----------+            |
//! ```
//!
//! ```fx
//! LDI X0
//! OR X1
//! OR X0
//! OUT Y0
//!     ^^
//! END
//! ```
//!
//! ```fx
//! LD M8000
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
//!     ORN Open
//!     ST Lift
//!        ^^^^
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Gate
//! VAR
//!     Lift AT %QX0.0 : BOOL;
//! END_VAR
//!     LD TRUE
//!     ST Lift
//! END_PROGRAM
//! ```

use super::constant::{Reason, Way, place_of};
use crate::check::sense::Region;
use crate::check::{Rule, Run};
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "always-energised",
    severity: Severity::Warning,
    run: Run::With("never-energised"),
    source: include_str!("always_energised.rs"),
};

/// The output at the end of `way` is always on, for `reason`.
pub(super) fn diagnostic(way: &Way<'_>, mut reason: Reason) -> Diagnostic {
    let why = std::mem::replace(&mut reason.message, Message::new("energised.whatever"));
    let name = way.action.terms.first().map(|term| term.text.as_str()).unwrap_or_default();
    let message = Message::new("always-energised.found").with("name", name).with_messages("why", vec![why]);
    reason.added_to(Diagnostic::new(RULE.code, place_of(way.action), message))
}

/// What was proved of a rung alone, as it holds in a `region` of the program: in a master control or a step, an output
/// that is always on is on when that is.
pub(in crate::check) fn within(found: Diagnostic, region: impl FnOnce(Span) -> Region) -> Diagnostic {
    if found.code != RULE.code {
        return found;
    }
    let region = region(found.span);
    match region.controls > 0 || region.step.is_some() {
        true => Diagnostic { message: found.message.under("always-energised.in-part"), ..found },
        false => found,
    }
}
