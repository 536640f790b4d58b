//! # never-energised
//!
//! An output that no input can ever switch on, or an instruction that is never executed: the condition before it does
//! not hold for any values of its devices. The machine stands still and nobody sees why, for each contact by itself is
//! right.
//!
//! This is proved; the message says the reason in one line, such as two contacts in series that exclude each other.
//! What is switched off by a contact that never conducts in any program, NOT M8000 or M8001, is meant so and not
//! reported.
//!
//! ```lad
//! |  X0    X0     Y0  |
//!                 ^^
//! +--| |---|/|----( )-+
//! ```
//!
//! ```lad
//! |  X0    X1     Y0  |
//! +--| |---|/|----( )-+
//! ```
//!
//! ```fx
//! LD X0
//! OR X1
//! ANI X0
//! ANI X1
//! OUT Y0
//!     ^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OR X1
//! LDI X0
//! ORI X1
//! ANB
//! OUT Y0
//! LD M8001
//! OUT Y1
//! END
//! ```
//!
//! ```iec
//! PROGRAM Gate
//! VAR
//!     Open AT %IX0.0 : BOOL;
//!     Lift AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Open
//!     ANDN Open
//!     ST Lift
//!        ^^^^
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
//!     ANDN Free
//!     ST Lift
//! END_PROGRAM
//! ```

use super::constant::{Reason, Way, place_of};
use crate::check::{Rule, Run};
use crate::logic::Deed;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "never-energised",
    severity: Severity::Warning,
    run: Run::Proof(super::prove),
    source: include_str!("never_energised.rs"),
};

/// The output at the end of `way` is never on, for `reason`.
pub(super) fn diagnostic(way: &Way<'_>, mut reason: Reason) -> Diagnostic {
    let why = std::mem::replace(&mut reason.message, Message::new("energised.whatever"));
    let message = match way.action.deed {
        Deed::Instruction(form) => {
            Message::new("never-energised.instruction").with("mnemonic", form.mnemonic())
        }
        _ => {
            let name = way.action.terms.first().map(|term| term.text.as_str()).unwrap_or_default();
            Message::new("never-energised.found").with("name", name)
        }
    };
    reason.added_to(Diagnostic::new(RULE.code, place_of(way.action), message.with_messages("why", vec![why])))
}
