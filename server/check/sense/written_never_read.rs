//! # written-never-read
//!
//! An internal relay, a timer, a counter, a register or a variable is written, but nothing in the program ever reads
//! it: the rung does nothing. Either it is left over, or a contact elsewhere names the wrong number.
//!
//! Outputs, special and latched devices are left out, and what may be read as a part of a row of devices. A register
//! that only an operator panel reads looks the same; write `// rungwise: allow(written-never-read)` above the rung.
//!
//! ```fx
//! LD X0
//! OUT M20
//!     ^^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OUT M20
//! LD M20
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0     T5 K50 |
//!           ^^
//! +--| |-------( )-+
//! ```
//!
//! ```lad
//! |  X0     T5 K50 |
//! +--| |-------( )-+
//! |                |
//! |  T5        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Ready : BOOL;
//! END_VAR
//!     LD Start
//!     ST Ready
//!        ^^^^^
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Ready : BOOL;
//! END_VAR
//!     LD Start
//!     ST Ready
//!     LD Ready
//!     ST Motor
//! END_PROGRAM
//! ```

use super::relays::{Wiring, is_general};
use super::rungs::{MOST_MENDED, PlainRung};
use super::uses::{Key, Name, Use};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::{Act, Part};
use crate::target::{Device, DeviceKind};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "written-never-read",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("written_never_read.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let (uses, wiring) = (context.uses(), Wiring::of(context));
    let mut mended = 0;
    for (number, name) in uses.names() {
        if uses.acts(number).reads() || !may_only_the_program_read(context, &wiring, name) {
            continue;
        }
        let all = || uses.of_name(number);
        let is_written = |one: &Use| {
            let writes = one.access.act.writes() && !one.access.act.reads();
            // What is only reset is told of by its own rule.
            writes && one.access.act != Act::Reset && (one.access.part == Part::Pair || one.access.count == 1)
        };
        let Some(written) = all().find(is_written) else { continue };
        if let Key::Device(device) = name.key {
            let second = Device::new(device.kind, device.number.saturating_add(1));
            let is_pair = uses.acts(number).has_pair();
            let half = || uses.device(second).is_some_and(|other| uses.acts(other).reads());
            if uses.is_read_in_row(device) || (is_pair && (uses.is_read_in_row(second) || half())) {
                continue;
            }
        }
        let message = Message::new("written-never-read.found").with("name", uses.words(&written));
        let diagnostic = Diagnostic::new(RULE.code, written.span, message);
        // A rung that does nothing else may go.
        let is_alone = uses.of_name(number).len() == 1 && mended < MOST_MENDED;
        let rung = is_alone.then(|| PlainRung::of(uses, &written)).flatten();
        mended += usize::from(rung.is_some());
        found.push(match rung {
            Some(rung) => {
                let title = Message::new("written-never-read.remove").with("rung", written.rung);
                diagnostic.fix(title, vec![TextEdit::new(rung.all, "")])
            }
            None => diagnostic,
        });
    }
}

fn may_only_the_program_read(context: &ProgramContext<'_>, wiring: &Wiring, name: &Name<'_>) -> bool {
    match name.key {
        Key::Device(device) => match device.kind {
            DeviceKind::T | DeviceKind::C => device.range_on(context.target()).is_some(),
            DeviceKind::M | DeviceKind::D => is_general(device, context),
            _ => false,
        },
        _ => wiring.is_inside(name),
    }
}
