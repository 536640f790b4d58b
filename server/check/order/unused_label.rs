//! # unused-label
//!
//! Nothing jumps to this label or calls it. It costs a step, and a reader looks for the jump; a subroutine behind it
//! never runs. An interrupt routine is run by its input, but only in a program that allows interrupts with `EI`.
//!
//! ```fx
//! LD X0
//! OUT Y0
//! P5
//! ^^
//! LD X1
//! OUT Y1
//! END
//! ```
//!
//! ```fx
//! LD X0
//! CJ P5
//! LD X2
//! OUT Y0
//! P5
//! LD X1
//! OUT Y1
//! END
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR a : BOOL; END_VAR
//! there: LD a
//! ^^^^^
//! ST a
//! END_PROGRAM
//! ```

use super::labels::{END_POINTER, Labels};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Symbol;
use crate::target::DeviceKind;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "unused-label",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("unused_label.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    for labels in Labels::of(context) {
        let named = labels.named();
        for label in labels.declared.iter().filter(|label| !named.contains(&label.symbol)) {
            let key = match label.symbol {
                Symbol::Device(device) if device == END_POINTER => continue,
                Symbol::Device(device) if device.kind == DeviceKind::I => {
                    if labels.interrupts_allowed {
                        continue;
                    }
                    "unused-label.interrupt"
                }
                _ if labels.any_may_be_meant => continue,
                _ => "unused-label.found",
            };
            let message = Message::new(key).with("label", &label.name);
            let diagnostic = Diagnostic::new(RULE.code, label.span, message);
            found.push(match label.removal.clone().filter(|_| key == "unused-label.found") {
                Some(removal) => diagnostic.fix(Message::new("unused-label.remove"), vec![removal]),
                None => diagnostic,
            });
        }
    }
}
