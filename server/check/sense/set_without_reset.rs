//! # set-without-reset
//!
//! A relay or an output is switched on by `SET`, and nothing in the program ever switches it off: once on, it stays on
//! until the PLC is stopped, a latched one even longer. Either the `RST` was forgotten, or it names another relay.
//!
//! States of a step ladder are left out, since the transfer to the next state resets them.
//!
//! ```fx
//! LD X0
//! SET Y0
//!     ^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! SET Y0
//! LD X1
//! RST Y0
//! END
//! ```
//!
//! ```lad
//! |  X0        Y0  |
//!              ^^
//! +--| |-------(S)-+
//! ```
//!
//! ```lad
//! |  X0        Y0  |
//! +--| |-------(S)-+
//! |                |
//! |  X1        Y0  |
//! +--| |-------(R)-+
//! ```
//!
//! ```iec
//! PROGRAM Alarm
//! VAR
//!     Hot  AT %IX0.0 : BOOL;
//!     Horn AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Hot
//!     S Horn
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
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Act;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "set-without-reset",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("set_without_reset.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let uses = context.uses();
    for (number, name) in uses.names() {
        let acts = uses.acts(number);
        if !acts.has(&[Act::Set]) || acts.writes_but(&[Act::Set]) {
            continue;
        }
        let Some(set) = first_of(uses.of_name(number), Act::Set) else { continue };
        if is_written_in_row(name, uses)
            || !is_latchable(name, context.regions().has_steps)
            // What a jump passes over may be done once and never again on purpose.
            || context.regions().may_be_skipped(set.span.start)
        {
            continue;
        }
        let message = Message::new("set-without-reset.found").with("name", uses.words(&set));
        found.push(Diagnostic::new(RULE.code, set.span, message));
    }
}
