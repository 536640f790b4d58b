//! # edge-in-skipped-code
//!
//! A contact or a coil for an edge stands in a part of the program that a jump passes over or that a master control
//! switches off. It compares its device with what it was when the instruction was last executed, not a scan ago: an
//! edge that comes meanwhile is missed, or seen late, in the first scan in which the part runs again, as a start that
//! nobody has given.
//!
//! Take the edge before the jump, into a relay, and use that in the part that is passed over.
//!
//! ```fx
//! LD X10
//! CJ P1
//! LDP X0
//!     ^^
//! SET Y0
//! LD X1
//! RST Y0
//! P1
//! LD X2
//! OUT Y1
//! END
//! ```
//!
//! ```fx
//! LD X0
//! PLS M0
//! LD X10
//! CJ P1
//! LD M0
//! SET Y0
//! LD X1
//! RST Y0
//! P1
//! LD X2
//! OUT Y1
//! END
//! ```

use super::free::{FreeDevices, renamed, symbol_of};
use super::rungs::MOST_MENDED;
use super::uses::{Key, Use};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Act;
use crate::target::{Device, DeviceKind};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "edge-in-skipped-code",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("edge_in_skipped_code.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let (uses, regions) = (context.uses(), context.regions());
    if !uses.is_fx || !regions.has_parts() {
        return;
    }
    let mut relays = FreeDevices::of(context, DeviceKind::M);
    let mut mended = 0;
    for (number, name) in uses.names() {
        if !uses.acts(number).has(&[Act::ReadEdge, Act::Pulse]) {
            continue;
        }
        let is_edge = |act: Act| matches!(act, Act::ReadEdge | Act::Pulse);
        for one in uses.of_name(number).filter(|one| is_edge(one.access.act)) {
            let key = match () {
                () if regions.may_be_skipped(one.span.start) => "edge-in-skipped-code.jump",
                () if regions.at(one.span.start).controls > 0 => "edge-in-skipped-code.control",
                () => continue,
            };
            let message = Message::new(key).with("name", uses.words(&one));
            let diagnostic = Diagnostic::new(RULE.code, one.span, message);
            // What the program writes has its edges in the middle of a scan.
            let input = match name.key {
                Key::Device(device) if device.kind == DeviceKind::X && mended < MOST_MENDED => Some(device),
                _ => None,
            };
            let taken = input.and_then(|input| taken_before(context, &one, input, &mut relays));
            mended += usize::from(taken.is_some());
            found.push(match taken {
                Some((relay, edits)) => {
                    let title = Message::new("edge-in-skipped-code.before").with("relay", relay);
                    diagnostic.fix(title.with("name", uses.words(&one)), edits)
                }
                None => diagnostic,
            });
        }
    }
}

/// Takes the edge of an input at the start of the program, which every scan comes to, into a free relay. It is on in
/// the scan of the edge, and the contact asks for that.
fn taken_before(
    context: &ProgramContext<'_>,
    one: &Use,
    input: Device,
    relays: &mut FreeDevices<'_, '_>,
) -> Option<(Device, Vec<TextEdit>)> {
    let uses = context.uses();
    let (symbol, words) = symbol_of(uses, one)?;
    let (contact, pulse) = match words.to_ascii_uppercase().as_str() {
        "LDP" | "ANDP" | "ORP" => (&words[..words.len() - 1], "PLS"),
        "LDF" | "ANDF" | "ORF" => (&words[..words.len() - 1], "PLF"),
        _ => return None,
    };
    let first = context.executed().next()?;
    let relay = relays.take()?;
    let edits = vec![
        first.line_before(&format!("LD {input}\n{pulse} {relay}"))?,
        TextEdit::new(symbol, contact),
        renamed(uses, one, input, relay)?,
    ];
    Some((relay, edits))
}
