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

use super::free::{FreeDevices, renamed};
use super::uses::{Key, Use};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Act;
use crate::target::DeviceKind;
use crate::text::{Diagnostic, Message, Severity};

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
    let mut free = FreeDevices::of(context, DeviceKind::M);
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
        let may_be_renamed = places.len() <= MOST_PLACES && !uses.is_read_in_row(device);
        let other = may_be_renamed.then(|| free.take()).flatten();
        let renamed = other.and_then(|other| {
            let edits = places.iter().map(|one| renamed(uses, one, device, other));
            Some((other, edits.collect::<Option<Vec<_>>>()?))
        });
        found.push(match renamed {
            Some((other, edits)) => {
                let title = Message::new("latched-range.replace").with("name", device).with("other", other);
                diagnostic.fix(title, edits)
            }
            None => diagnostic,
        });
    }
}
