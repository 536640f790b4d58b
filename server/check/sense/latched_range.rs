//! # latched-range
//!
//! A relay of the latched range is used for a passing result: one coil writes it in every scan, and the rung does not
//! hold itself. Keeping it without power is of no use, but it has an effect: in the first scan after power comes back,
//! rungs above the coil see what was on when it went, perhaps days ago.
//!
//! Use a general relay and leave the latched ones to what the machine must remember. A relay that holds itself, or
//! that `SET` and `RST` switch, is such a memory and not reported. Nor is one of M2800 to M3071 of which a contact asks
//! for the edge: these share one memory of it, as general relays do not.
//!
//! ```fx
//! LD X0
//! AND X1
//! OUT M500
//!     ^^^^
//! LD M500
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OR M500
//! ANI X1
//! OUT M500
//! LD M500
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0       M500 |
//!             ^^^^
//! +--| |-------( )-+
//! |                |
//! |  M500      Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```lad
//! |  X0       M0   |
//! +--| |-------( )-+
//! |                |
//! |  M0        Y0  |
//! +--| |-------( )-+
//! ```

use super::uses::{Key, Use, Uses};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::{Act, Part};
use crate::target::{Device, DeviceKind, Operand};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "latched-range",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("latched_range.rs"),
};

/// A relay that stands in more places is renamed by hand.
const MOST_PLACES: usize = 200;

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let (uses, target) = (context.uses(), context.target());
    let mut free = FreeRelays { uses, context, next: 0 };
    for (number, name) in uses.names() {
        let Key::Device(device) = name.key else { continue };
        if device.kind != DeviceKind::M || device.is_special() || !context.keeps(device) {
            continue;
        }
        if uses.acts(number).writes_but(&[Act::Coil, Act::Pulse]) {
            continue;
        }
        // Whoever asks for its edge may want it for the one memory that contacts for it share.
        if device.shares_edges(target) && uses.acts(number).has(&[Act::ReadEdge]) {
            continue;
        }
        let mut writes = uses.of_name(number).filter(|one| one.access.act.writes());
        let (Some(coil), None) = (writes.next(), writes.next()) else { continue };
        let place = context.regions().at(coil.span.start);
        let passing = coil.access.act.is_coil()
            && coil.is_whole()
            && place.is_plain()
            && !context.regions().may_be_skipped(coil.span.start)
            && !uses.of_name(number).any(|one| one.access.act.reads() && one.in_rung_of(&coil));
        if !passing || uses.is_written_in_row(device) {
            continue;
        }
        let message = Message::new("latched-range.found").with("name", device);
        let diagnostic = Diagnostic::new(RULE.code, coil.span, message);
        let places: Vec<Use> = uses.of_name(number).take(MOST_PLACES + 1).collect();
        let is_renamed = places.len() <= MOST_PLACES
            && !uses.is_read_in_row(device)
            && places.iter().all(|one| is_plain_word(uses, one, device));
        found.push(match is_renamed.then(|| free.take()).flatten() {
            Some(other) => {
                let edits = places.iter().map(|one| TextEdit::new(one.span, other.to_string()));
                let title = Message::new("latched-range.replace").with("name", device).with("other", other);
                diagnostic.fix(title, edits.collect())
            }
            None => diagnostic,
        });
    }
}

/// Whether the word at the place is the name of the device and nothing else.
fn is_plain_word(uses: &Uses<'_>, one: &Use, device: Device) -> bool {
    one.access.part == Part::Whole
        && Operand::read(&uses.words(one), crate::target::Model::Fx3u) == Operand::Device(device)
}

/// General relays that the program does not name, each given once.
struct FreeRelays<'c, 'a> {
    uses: &'c Uses<'a>,
    context: &'c ProgramContext<'a>,
    next: u32,
}

impl FreeRelays<'_, '_> {
    fn take(&mut self) -> Option<Device> {
        loop {
            let device = Device::new(DeviceKind::M, self.next);
            device.range_on(self.context.target()).filter(|_| !device.is_special())?;
            self.next += 1;
            if self.context.keeps(device) {
                continue;
            }
            let named = self.uses.device(device).is_some();
            if !named && !self.uses.is_read_in_row(device) && !self.uses.is_written_in_row(device) {
                return Some(device);
            }
        }
    }
}
