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
//! Relays are followed over the rungs of a file, in lists for the FX family and in drawings, where one plain coil is
//! all that writes them: whatever needs a relay that is never on is never on, either, and so is a rung that asks for
//! the opposite of what the rung of a relay above it asks for. That a panel writes such a relay is not considered, for
//! its coil writes it anew in each scan. Relays that keep their value without power, that are set or reset, or that
//! stand where a jump or a master control may leave them out are not followed. Of the rungs that may be such, the
//! first hundred and fifty are proved in one check.
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
//! ```fx
//! LD X0
//! ANI X1
//! OUT M0
//! LD M0
//! AND X1
//! OUT Y0
//!     ^^
//! LD Y0
//! OUT Y1
//!     ^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! ANI X1
//! OUT M0
//! LDI M0
//! AND X1
//! OUT Y0
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
