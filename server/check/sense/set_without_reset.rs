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

use super::free::{renamed, symbol_of};
use super::relays::{first_of, is_latchable, is_written_in_row};
use super::rungs::MOST_MENDED;
use super::uses::{Key, Use, Uses};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Act;
use crate::target::Device;
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "set-without-reset",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("set_without_reset.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let uses = context.uses();
    let mut mended = 0;
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
        let diagnostic = Diagnostic::new(RULE.code, set.span, message);
        mended += 1;
        found.push(match (mended <= MOST_MENDED, name.key) {
            (true, Key::Device(device)) => {
                with_other_reset(uses, &set, device, with_coil(uses, number, &set, diagnostic))
            }
            (true, _) => with_coil(uses, number, &set, diagnostic),
            (false, _) => diagnostic,
        });
    }
}

/// The coil that holds nothing. Behind an edge it would be on for one scan, which nobody means.
fn with_coil(uses: &Uses<'_>, number: u32, set: &Use, diagnostic: Diagnostic) -> Diagnostic {
    let is_edge = |act: Act| matches!(act, Act::ReadEdge | Act::Pulse);
    let is_only = uses.of_name(number).filter(|one| one.access.act == Act::Set).count() == 1;
    if !is_only || uses.in_rung(set).any(|(_, one)| is_edge(one.access.act)) {
        return diagnostic;
    }
    let coil = match symbol_of(uses, set).or_else(|| operator_of(uses, set)) {
        Some((span, words)) => match words.to_ascii_uppercase().as_str() {
            "SET" => TextEdit::new(span, "OUT"),
            "S" => TextEdit::new(span, "ST"),
            "(S)" => TextEdit::new(span, "( )"),
            _ => return diagnostic,
        },
        None => return diagnostic,
    };
    let title = Message::new("set-without-reset.coil").with("name", uses.words(set));
    diagnostic.fix(title, vec![coil])
}

/// The word before an operand in a list of IEC 61131-3.
fn operator_of(uses: &Uses<'_>, one: &Use) -> Option<(Span, String)> {
    let (start, chunk) = uses.chunk(one).filter(|(_, chunk)| chunk.iec().is_some())?;
    let before = chunk.text().get(..one.span.start as usize - start)?.trim_end();
    let word = before.rfind(|c: char| c.is_whitespace() || c == ':').map_or(0, |gap| gap + 1);
    Some((Span::new(word, before.len()).shifted(start), before[word..].to_string()))
}

/// A device whose number is that far away may be the one that is meant.
const NEAR: u32 = 8;

/// The reset of a device that nothing ever switches on is the one that is missing here, if the number is nearly this.
fn with_other_reset(uses: &Uses<'_>, set: &Use, device: Device, diagnostic: Diagnostic) -> Diagnostic {
    let idle = |(number, name): (u32, &super::uses::Name<'_>)| {
        let Key::Device(other) = name.key else { return None };
        let (acts, distance) = (uses.acts(number), other.number.abs_diff(device.number));
        let is_idle = other.kind == device.kind && acts.has(&[Act::Reset]) && !acts.writes_but(&[Act::Reset]);
        let mut resets = uses.of_name(number).filter(|one| one.access.act == Act::Reset);
        let (reset, None) = (resets.next()?, resets.next()) else { return None };
        (is_idle && distance <= NEAR).then_some((distance, other, reset))
    };
    let nearest = uses.names().filter_map(idle).min_by_key(|(distance, ..)| *distance);
    let Some((_, other, reset)) = nearest else { return diagnostic };
    let Some(edit) = renamed(uses, &reset, other, device) else { return diagnostic };
    let title = Message::new("set-without-reset.reset").with("name", uses.words(set));
    diagnostic.fix(title.with("other", other).with("rung", reset.rung), vec![edit])
}
