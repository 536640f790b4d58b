//! # reset-without-set
//!
//! A relay or an output is switched off by `RST`, but nothing in the program ever switches it on; or a timer or a
//! counter is reset that nothing drives. The `RST` has nothing to do. Often the number is wrong by one, and the relay
//! that should be reset stays on.
//!
//! A relay that an operator panel or another PLC switches on looks the same; write
//! `// rungwise: allow(reset-without-set)` above the rung.
//!
//! ```fx
//! LD X0
//! RST M10
//!     ^^^
//! LD M10
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X1
//! SET M10
//! LD X0
//! RST M10
//! LD M10
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0        Y0  |
//!              ^^
//! +--| |-------(R)-+
//! ```
//!
//! ```lad
//! |  X1        Y0  |
//! +--| |-------(S)-+
//! |                |
//! |  X0        Y0  |
//! +--| |-------(R)-+
//! ```
//!
//! ```iec
//! PROGRAM Alarm
//! VAR
//!     Seen AT %IX0.1 : BOOL;
//!     Horn AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Seen
//!     R Horn
//!       ^^^^
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Alarm
//! VAR
//!     Hot  AT %IX0.0 : BOOL;
//!     Seen AT %IX0.1 : BOOL;
//!     Horn AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Hot
//!     S Horn
//!     LD Seen
//!     R Horn
//! END_PROGRAM
//! ```

use super::relays::{first_of, is_latchable, is_written_in_row};
use super::rungs::PlainRung;
use super::uses::Key;
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Act;
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "reset-without-set",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("reset_without_set.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let uses = context.uses();
    for (number, name) in uses.names() {
        let acts = uses.acts(number);
        let is_switched_on = acts.writes_but(&[Act::Reset]) || acts.has(&[Act::DeclareValue]);
        if !acts.has(&[Act::Reset]) || is_switched_on {
            continue;
        }
        let Some(reset) = first_of(uses.of_name(number), Act::Reset) else { continue };
        let counts = matches!(name.key, Key::Device(device) if device.kind.has_preset());
        if is_written_in_row(name, uses) || !(counts || is_latchable(name, context.regions().has_steps)) {
            continue;
        }
        let key = if counts { "reset-without-set.undriven" } else { "reset-without-set.found" };
        let message = Message::new(key).with("name", uses.words(&reset));
        let diagnostic = Diagnostic::new(RULE.code, reset.span, message);
        // Of what keeps its value without power nobody knows what it was before.
        let begins_off = matches!(name.key, Key::Device(device) if !context.keeps(device));
        let is_only = uses.of_name(number).filter(|one| one.access.act == Act::Reset).count() == 1;
        let rung = (begins_off && is_only).then(|| PlainRung::of(uses, &reset)).flatten();
        found.push(match rung {
            Some(rung) => {
                let title = Message::new("reset-without-set.remove").with("name", uses.words(&reset));
                diagnostic.fix(title, vec![TextEdit::new(rung.all, "")])
            }
            None => diagnostic,
        });
    }
}
