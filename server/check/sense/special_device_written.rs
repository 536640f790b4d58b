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

use super::free::{FreeDevices, renamed};
use super::rungs::{MOST_MENDED, PlainRung};
use super::uses::{Key, Use};
use crate::check::{ProgramContext, Rule, Run};
use crate::target::Device;
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "special-device-written",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("special_device_written.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let uses = context.uses();
    let mut mended = 0;
    for (number, name) in uses.names() {
        let Key::Device(device) = name.key else { continue };
        let special = device.is_special().then(|| device.special_on(context.target())).flatten();
        // What no table has may be an order to a unit that is not known here.
        let Some(special) = special.filter(|special| !special.writable) else { continue };
        for one in uses.of_name(number).filter(|one| one.access.act.writes()) {
            let message = Message::new("special-device-written.found")
                .with("device", device)
                .with_phrase("meaning", special.meaning);
            let diagnostic = Diagnostic::new(RULE.code, one.span, message);
            mended += 1;
            found.push(if mended <= MOST_MENDED {
                with_fixes(context, &one, device, diagnostic)
            } else {
                diagnostic
            });
        }
    }
}

/// Another device for what is written, and the program without what is lost anyway.
fn with_fixes(
    context: &ProgramContext<'_>,
    one: &Use,
    device: Device,
    mut diagnostic: Diagnostic,
) -> Diagnostic {
    let free = FreeDevices::of(context, device.kind).take();
    if let Some((free, edit)) =
        free.and_then(|free| Some((free, renamed(context.uses(), one, device, free)?)))
    {
        let title = Message::new("special-device-written.replace").with("free", free);
        diagnostic = diagnostic.fix(title, vec![edit]);
    }
    if let Some(rung) = PlainRung::of(context.uses(), one) {
        let title = Message::new("special-device-written.remove").with("rung", one.rung);
        diagnostic = diagnostic.fix(title, vec![TextEdit::new(rung.all, "")]);
    }
    diagnostic
}
