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
use crate::check::{ProgramContext, Rule, Run};
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "double-coil",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("double_coil.rs"),
};

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let coils = Coils::of(context);
    let is_coil = |one: &super::uses::Use| one.access.act.is_coil() && one.is_whole();
    for driven in coils.driven(is_coil) {
        let places: Vec<usize> = (0..driven.all.len()).filter(|place| is_coil(&driven.all[*place])).collect();
        for (number, one) in places.iter().enumerate() {
            let Some(winner) = coils.undone_by(&driven, *one, &places[number + 1..]) else { continue };
            let (loser, winner) = (&driven.all[*one], &driven.all[winner]);
            let name = context.uses().words(loser);
            let message = match loser.file == winner.file {
                true => Message::new("double-coil.found").with("rung", winner.rung),
                false => Message::new("double-coil.elsewhere"),
            };
            let related = Message::new("double-coil.winner").with("name", &name);
            found.push(
                Diagnostic::new(RULE.code, loser.span, message.with("name", &name))
                    .related(winner.span, related),
            );
        }
    }
}
