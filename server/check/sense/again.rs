//! Timers and counters, and instances of their blocks, that are driven in more than one place.

use super::free::next_free;
use super::rungs::MOST_MENDED;
use super::uses::{Key, Name, Use};
use crate::check::ProgramContext;
use crate::document::{Act, DeclaredType};
use crate::target::DeviceKind;
use crate::target::iec::FunctionBlock;
use crate::text::{Diagnostic, Message, TextEdit};

/// So many places before one are compared with it, besides the first.
const COMPARED: usize = 16;

/// Reports under `code` each place but the first that drives a device of `kind`, or an instance of a standard block
/// with the input `pin`.
pub(super) fn driven_again(
    context: &ProgramContext<'_>,
    code: &'static str,
    kind: DeviceKind,
    pin: &str,
    found: &mut Vec<Diagnostic>,
) {
    let (uses, regions) = (context.uses(), context.regions());
    for (number, name) in uses.names() {
        let act = match name.key {
            Key::Device(device) if device.kind == kind => Act::Coil,
            Key::Device(_) | Key::Direct(_) => continue,
            Key::Global(_) | Key::Local(..) => Act::Call,
        };
        if !uses.acts(number).has(&[act]) {
            continue;
        }
        let drives = |one: &Use| one.access.act == act && one.is_whole();
        if uses.of_name(number).filter(drives).take(2).count() < 2
            || (act == Act::Call && !has_input(name, pin))
        {
            continue;
        }
        let places: Vec<Use> = uses.of_name(number).filter(drives).collect();
        for (place, one) in places.iter().enumerate().skip(1) {
            let near = places[..place].iter().rev().take(COMPARED);
            let meets = |other: &&Use| {
                let by_turns =
                    act == Act::Call && (regions.may_skip(one, other) || regions.may_skip(other, one));
                !regions.are_apart(one, other) && !by_turns
            };
            let Some(other) = places.first().into_iter().chain(near).find(meets) else { continue };
            let words = uses.words(one);
            let message = Message::new(match (kind, act) {
                (DeviceKind::T, Act::Coil) => "driven-again.timer",
                (_, Act::Coil) => "driven-again.counter",
                (DeviceKind::T, _) => "driven-again.timer-instance",
                _ => "driven-again.counter-instance",
            });
            let related = Message::new("driven-again.first").with("name", &words);
            let diagnostic = Diagnostic::new(code, one.span, message.with("name", &words));
            let diagnostic = diagnostic.related(other.span, related);
            let free = match name.key {
                Key::Device(device) if found.len() < MOST_MENDED => {
                    next_free(uses, device, 1, context.target())
                }
                _ => None,
            };
            found.push(match free {
                Some(free) => {
                    let title = Message::new("driven-again.free").with("free", free).with("name", words);
                    diagnostic.fix(title, vec![TextEdit::new(one.span, free.to_string())])
                }
                None => diagnostic,
            });
        }
    }
}

fn has_input(name: &Name<'_>, pin: &str) -> bool {
    let Some(DeclaredType::Named(block)) = name.variable.map(|variable| &variable.declared) else {
        return false;
    };
    FunctionBlock::named(block).is_some_and(|block| block.input_named(pin).is_some())
}
