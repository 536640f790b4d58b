//! # double-coil
//!
//! The same relay or output has two coils. Each of them writes in every scan, on or off, and the outputs are refreshed
//! only at the end of the scan: the coil that is executed last has the last word, and what the others write never
//! reaches the machine. A motor that one of two buttons should start follows the second button alone.
//!
//! Lead both conditions to one coil, in parallel; or use `SET` and `RST`.
//!
//! Coils in different steps of a step ladder, in different subroutines, and in parts of which jumps choose one do not
//! disturb each other and are not reported. A timer or a counter that is driven twice is a rule of its own.
//!
//! ```fx
//! LD X0
//! OUT Y0
//!     ^^
//! LD X1
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! OR X1
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0        Y0  |
//!              ^^
//! +--| |-------( )-+
//! |                |
//! |  X1        Y0  |
//! +--| |-------( )-+
//! ```
//!
//! ```lad
//! |  X0        Y0  |
//! +--| |---+---( )-+
//! |  X1    |       |
//! +--| |---+       |
//! ```
//!
//! In Instruction List of IEC 61131-3 a variable may hold one result after another. There it is reported that an
//! output is written twice, and that a value is overwritten before anything has read it:
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Pedal AT %IX0.1 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Start
//!     ST Motor
//!        ^^^^^
//!     LD Pedal
//!     ST Motor
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Pedal AT %IX0.1 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Start
//!     OR Pedal
//!     ST Motor
//! END_PROGRAM
//! ```

use super::coils::Coils;
use super::rungs::{MOST_MENDED, PlainRung};
use super::uses::{Use, Uses};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::Act;
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "double-coil",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("double_coil.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let coils = Coils::of(context);
    let is_coil = |one: &Use| one.access.act.is_coil() && one.is_whole();
    let mut mended = 0;
    for driven in coils.driven(&[Act::Coil, Act::Pulse], &[], is_coil) {
        let places: Vec<usize> = (0..driven.all.len()).filter(|place| is_coil(&driven.all[*place])).collect();
        for (number, one) in places.iter().enumerate() {
            let Some(winner) = coils.undone_by(&driven, *one, &places[number + 1..]) else { continue };
            let is_read_between = driven.is_read_between(*one, winner);
            let (loser, winner) = (&driven.all[*one], &driven.all[winner]);
            let name = context.uses().words(loser);
            let message = match (loser.file == winner.file, is_read_between) {
                (true, false) => Message::new("double-coil.found").with("rung", winner.rung),
                (true, true) => Message::new("double-coil.read-between").with("rung", winner.rung),
                (false, _) => Message::new("double-coil.elsewhere"),
            };
            let related = Message::new("double-coil.winner").with("name", &name);
            let diagnostic = Diagnostic::new(RULE.code, loser.span, message.with("name", &name))
                .related(winner.span, related);
            // Who reads it between would read something else if both were one.
            let is_pair = places.len() == 2
                && !is_read_between
                && loser.access.act == winner.access.act
                && mended < MOST_MENDED;
            let joined = is_pair.then(|| joined(context.uses(), loser, winner)).flatten();
            mended += usize::from(joined.is_some());
            found.push(match joined {
                Some(edits) => {
                    let title = Message::new("double-coil.join").with("name", name).with("rung", winner.rung);
                    diagnostic.fix(title, edits)
                }
                None => diagnostic,
            });
        }
    }
}

/// So many blocks may wait, and the conditions of the other rung are one more.
const MOST_LOADS: usize = 6;

/// Leads the conditions of both rungs to the coil of `winner`, in parallel.
fn joined(uses: &Uses<'_>, loser: &Use, winner: &Use) -> Option<Vec<TextEdit>> {
    let (first, second) = (PlainRung::of(uses, loser)?, PlainRung::of(uses, winner)?);
    if loser.file != winner.file || first.loads.max(second.loads) > MOST_LOADS {
        return None;
    }
    let newline = if first.words.ends_with("\r\n") { "\r\n" } else { "\n" };
    let conditions = format!("{}{}ORB{newline}", first.words, indent(&first.words));
    let behind = Span::at(second.conditions.end as usize);
    Some(vec![TextEdit::new(first.all, ""), TextEdit::new(behind, conditions)])
}

fn indent(text: &str) -> &str {
    &text[..text.len() - text.trim_start_matches([' ', '\t']).len()]
}
