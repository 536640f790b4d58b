//! # undefined-label
//!
//! A jump or a call goes to a label that stands nowhere. The PLC stops with an operation error (6701) at the moment
//! at which the jump is made, which may be long after the machine was tested. `P63` means END and needs no label.
//!
//! ```fx
//! LD X0
//! CJ P2
//!    ^^
//! LD X1
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! CJ P2
//! LD X1
//! OUT Y0
//! P2
//! LD X2
//! OUT Y1
//! END
//! ```
//!
//! ```lad
//! |  X0            |
//! +--| |------->>P3
//!                ^^
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR a : BOOL; END_VAR
//! LD a
//! JMPC nowhere
//!      ^^^^^^^
//! ST a
//! END_PROGRAM
//! ```

use super::labels::{END_POINTER, Labels};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Symbol;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "undefined-label",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("undefined_label.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let target = context.target();
    for labels in Labels::of(context) {
        let placed = labels.placed();
        for jump in labels.jumps.iter().filter(|jump| !placed.contains(&jump.symbol)) {
            // A pointer that the model does not have is reported as such, and the one to END is always there.
            let is_reported = match jump.symbol {
                Symbol::Device(device) => {
                    device == END_POINTER || target.is_fx() && device.range_on(target).is_none()
                }
                _ => false,
            };
            if !is_reported {
                let message = match jump.name.is_empty() {
                    true => Message::new("undefined-label.nameless"),
                    false => Message::new("undefined-label.found").with("label", &jump.name),
                };
                found.push(Diagnostic::new(RULE.code, jump.span, message));
            }
        }
    }
}
