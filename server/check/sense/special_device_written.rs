//! # special-device-written
//!
//! A special relay or register is written that belongs to the CPU: it writes the device itself in every scan, so what
//! the program writes is lost or, worse, is believed by another rung for the rest of the scan. Clocks such as M8013,
//! flags such as M8020 and the scan times in D8010 are there to be read. The page of the device says what it is.
//!
//! Special devices with which a program gives orders to the CPU, such as M8034 or D8000, may be written.
//!
//! ```fx
//! LD X0
//! OUT M8013
//!     ^^^^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT M8034
//! END
//! ```
//!
//! ```lad
//! |  X0                |
//! +--| |-[MOV K0 D8010]+
//!                ^^^^^
//! ```
//!
//! ```lad
//! |  X0      M8034 |
//! +--| |-------( )-+
//! ```

use super::uses::Key;
use crate::check::{ProgramContext, Rule, Run};
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "special-device-written",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("special_device_written.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let uses = context.uses();
    for (number, name) in uses.names() {
        let Key::Device(device) = name.key else { continue };
        let special = device.is_special().then(|| device.special_on(context.target())).flatten();
        // What no table has may be an order to a unit that is not known here.
        let Some(special) = special.filter(|special| !special.writable) else { continue };
        for one in uses.of_name(number).filter(|one| one.access.act.writes()) {
            let message = Message::new("special-device-written.found")
                .with("device", device)
                .with_phrase("meaning", special.meaning);
            found.push(Diagnostic::new(RULE.code, one.span, message));
        }
    }
}
