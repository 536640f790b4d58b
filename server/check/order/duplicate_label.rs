//! # duplicate-label
//!
//! A label stands twice in a program, so a jump to it has two places to go to. The PLC refuses the program
//! (error 6504). `P63` always means END and needs no place: where it is written as a label it is one too many.
//!
//! ```fx
//! LD X0
//! CJ P1
//! LD X1
//! OUT Y0
//! P1
//! LD X2
//! OUT Y1
//! P1
//! ^^
//! LD X3
//! OUT Y2
//! END
//! ```
//!
//! ```fx
//! LD X0
//! CJ P1
//! LD X1
//! OUT Y0
//! P1
//! LD X2
//! OUT Y1
//! LD X3
//! CJ P63
//! LD X4
//! OUT Y2
//! END
//! ```
//!
//! ```lad
//! P1:
//! |  X0        Y0  |
//! +--| |-------( )-+
//!
//! P1:
//! ^^
//! |  X1        Y1  |
//! +--| |-------( )-+
//! ```
//!
//! The files of an FX project are one program, so a label may stand in one of them only. In IEC programs a label
//! belongs to its POU.
//!
//! ```iec
//! PROGRAM Main
//! VAR a : BOOL; END_VAR
//! LD a
//! JMPC there
//! there: LD a
//! ST a
//! there: LDN a
//! ^^^^^
//! ST a
//! END_PROGRAM
//! ```

use super::labels::{END_POINTER, Labels};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Symbol;
use crate::text::{Diagnostic, Message, Severity, Span};
use rustc_hash::FxHashMap;

pub(super) const RULE: Rule = Rule {
    code: "duplicate-label",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("duplicate_label.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    for labels in Labels::of(context) {
        let mut first: FxHashMap<&Symbol, Span> = FxHashMap::default();
        for label in &labels.declared {
            let is_end = label.symbol == Symbol::Device(END_POINTER);
            let key = if is_end { "duplicate-label.end" } else { "duplicate-label.found" };
            let other = *first.entry(&label.symbol).or_insert(label.span);
            if other == label.span && !is_end {
                continue;
            }
            let message = Message::new(key).with("label", &label.name);
            let mut diagnostic = Diagnostic::new(RULE.code, label.span, message);
            if other != label.span {
                diagnostic = diagnostic.related(other, Message::new("duplicate-label.first"));
            }
            if let Some(removal) = label.removal.clone() {
                diagnostic = diagnostic.fix(Message::new("duplicate-label.remove"), vec![removal]);
            }
            found.push(diagnostic);
        }
    }
}
