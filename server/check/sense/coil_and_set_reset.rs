//! # coil-and-set-reset
//!
//! A relay or an output has a coil, and elsewhere `SET` or `RST` act on it. The coil writes in every scan, on or off:
//! it takes back in the next scan what `SET` has switched on, and switches on again what `RST` has switched off. What
//! looks like a latch holds for a part of one scan.
//!
//! Drive the relay in one way: let the latch act on a relay of its own, and lead that to the coil as a contact.
//!
//! ```fx
//! LD X0
//! SET Y0
//!     ^^
//! LD X1
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! SET M0
//! LD X2
//! RST M0
//! LD X1
//! OR M0
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0        Y0  |
//! +--| |-------( )-+
//! |                |
//! |  X1        Y0  |
//!              ^^
//! +--| |-------(R)-+
//! ```
//!
//! ```lad
//! |  X0   X1   Y0  |
//! +--| |--|/|--( )-+
//! ```
//!
//! In Instruction List of IEC 61131-3 a value that is stored first and changed by `S` or `R` behind it is a way to
//! write a default; there only the other order is reported.
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Pedal AT %IX0.1 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Start
//!     S Motor
//!       ^^^^^
//!     LD Pedal
//!     ST Motor
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Stop  AT %IX0.1 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Start
//!     ST Motor
//!     LD Stop
//!     R Motor
//! END_PROGRAM
//! ```

use super::coils::Coils;
use super::free::symbol_of;
use super::rungs::MOST_MENDED;
use super::uses::Use;
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Act;
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "coil-and-set-reset",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("coil_and_set_reset.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let coils = Coils::of(context);
    let is_coil = |one: &Use| one.access.act == Act::Coil && one.is_whole();
    let is_latch = |one: &Use| matches!(one.access.act, Act::Set | Act::Reset) && one.is_whole();
    for driven in coils.driven(&[Act::Coil], &[Act::Set, Act::Reset], |one| is_coil(one) || is_latch(one)) {
        let select = |wanted: &dyn Fn(&Use) -> bool| -> Vec<usize> {
            (0..driven.all.len()).filter(|place| wanted(&driven.all[*place])).collect()
        };
        let (writes, latches) = (select(&is_coil), select(&is_latch));
        if writes.is_empty() || latches.is_empty() {
            continue;
        }
        for place in latches {
            let later = &writes[writes.partition_point(|write| *write < place)..];
            let coil = match coils.undone_by(&driven, place, later) {
                Some(coil) => Some(coil),
                // A coil before it writes again in the next scan.
                None => coils.undoing_before(&driven, place, &writes[..writes.len() - later.len()]),
            };
            let Some(coil) = coil else { continue };
            let (latch, coil) = (&driven.all[place], &driven.all[coil]);
            let name = context.uses().words(latch);
            let message = Message::new(match latch.access.act {
                Act::Set => "coil-and-set-reset.set",
                _ => "coil-and-set-reset.reset",
            });
            let related = Message::new("coil-and-set-reset.coil").with("name", &name);
            let diagnostic = Diagnostic::new(RULE.code, latch.span, message.with("name", &name));
            let diagnostic = diagnostic.related(coil.span, related);
            let has_set = driven.all.iter().any(|one| one.access.act == Act::Set);
            let is_one = writes.len() == 1 && !has_set && found.len() < MOST_MENDED;
            found.push(match is_one.then(|| latched(context, coil)).flatten() {
                Some(edit) => {
                    let title = Message::new("coil-and-set-reset.latch").with("name", &name);
                    diagnostic.fix(title, vec![edit])
                }
                None => diagnostic,
            });
        }
    }
}

/// Has the coil set its device: what is reset elsewhere and never set was meant to hold.
fn latched(context: &ProgramContext<'_>, coil: &Use) -> Option<TextEdit> {
    let (symbol, words) = symbol_of(context.uses(), coil)?;
    let set = match words.to_ascii_uppercase().as_str() {
        "OUT" => "SET",
        "( )" => "(S)",
        _ => return None,
    };
    Some(TextEdit::new(symbol, set))
}
