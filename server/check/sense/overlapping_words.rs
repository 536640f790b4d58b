//! # overlapping-words
//!
//! A 32-bit instruction takes a register and the next one together, and the program writes that next one as a word of
//! its own: writing it changes the upper half of the number, and the 32-bit instruction destroys the word. `DMOV` to
//! D10 fills D10 and D11. Keep pairs on even numbers and leave the odd one alone.
//!
//! A number that is put together of two words, each written on its own, is meant and not reported.
//!
//! ```fx
//! LD X0
//! DMOV K100000 D10
//! LD X1
//! MOV K5 D11
//!        ^^^
//! LD> D11 K3
//! OUT Y0
//! LDD> D10 K3
//! OUT Y1
//! END
//! ```
//!
//! ```fx
//! LD X0
//! DMOV K100000 D10
//! LD X1
//! MOV K5 D12
//! LD> D12 K3
//! OUT Y0
//! LDD> D10 K3
//! OUT Y1
//! END
//! ```
//!
//! ```lad
//! |  X0                    |
//! +--| |---[DADD D0 D10 D1]+
//!                       ^^
//! ```
//!
//! ```lad
//! |  X0                   |
//! +--| |---[DADD D0 D2 D4]+
//! ```

use super::free::next_free;
use super::rungs::MOST_MENDED;
use super::uses::{Key, Use};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Part;
use crate::target::Device;
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "overlapping-words",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("overlapping_words.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let uses = context.uses();
    for (number, name) in uses.names() {
        let Key::Device(device) = name.key else { continue };
        if !uses.acts(number).has_pair() {
            continue;
        }
        let is_pair = |one: &Use| one.access.part == Part::Pair;
        let Some(some_pair) = uses.of_name(number).find(is_pair) else { continue };
        let second = Device::new(device.kind, device.number.saturating_add(1));
        let Some(other) = uses.device(second) else { continue };
        let pair_written = uses.of_name(number).find(|one| is_pair(one) && one.access.act.writes());
        let pair = pair_written.unwrap_or(some_pair);
        let word = |one: &Use| one.is_whole() && one.access.act.writes();
        // Both halves written on their own make a number on purpose.
        let alone = uses.of_name(other).find(word).filter(|_| !uses.of_name(number).any(|one| word(&one)));
        let crossing = || {
            let crossing = uses.of_name(other).find(|one| is_pair(one) && one.access.act.writes());
            crossing.or_else(|| uses.of_name(other).find(is_pair).filter(|_| pair_written.is_some()))
        };
        let (one, key) = match alone {
            Some(alone) => (alone, "overlapping-words.word"),
            None => match crossing() {
                Some(crossing) => (crossing, "overlapping-words.pair"),
                None => continue,
            },
        };
        let message = Message::new(key).with("name", second).with("first", device);
        let related = Message::new("overlapping-words.related").with("name", second).with("first", device);
        let diagnostic = Diagnostic::new(RULE.code, one.span, message).related(pair.span, related);
        found.push(match moved(context, number, device) {
            Some((free, edits)) => {
                let title = Message::new("overlapping-words.move").with("first", device).with("free", free);
                diagnostic.fix(title, edits)
            }
            None => diagnostic,
        });
    }
}

/// Gives a number of 32 bits, which is only ever used as a whole, a pair of registers of its own in all places.
fn moved(context: &ProgramContext<'_>, number: u32, device: Device) -> Option<(Device, Vec<TextEdit>)> {
    let uses = context.uses();
    let mut all = uses.of_name(number);
    let is_alone = all.len() <= MOST_MENDED && !device.is_special();
    let words = device.to_string();
    // A symbol or a part of an operand is no place for the bare name of another register.
    let is_plain = |one: Use| one.access.part == Part::Pair && uses.words(&one).eq_ignore_ascii_case(&words);
    if !is_alone || !all.all(is_plain) {
        return None;
    }
    let free = next_free(uses, device, 2, context.target())?;
    Some((free, uses.of_name(number).map(|one| TextEdit::new(one.span, free.to_string())).collect()))
}
