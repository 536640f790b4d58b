//! # constant-out-of-range
//!
//! The number is larger or smaller than its place holds. 16-bit instructions work with -32768 to 32767 (`HFFFF` is
//! the pattern of -1), 32-bit ones with -2147483648 to 2147483647; presets of timers and of 16-bit counters go from
//! 1 to 32767; a place such as the shift of SFTL has limits of its own. What does not fit would be cut off, and a
//! machine would wait for a time that nobody wrote.
//!
//! ```fx
//! LD X0
//! MOV K40000 D0
//!     ^^^^^^
//! OUT T0 K0
//!        ^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! DMOV K40000 D0
//! OUT T0 K1
//! END
//! ```
//!
//! ```lad
//! |  X0                      |
//! +--| |--------(T0 K32768)--+
//!                   ^^^^^^
//! ```
//!
//! In IEC programs a constant takes the type of what it meets or initialises, and must fit it:
//!
//! ```iec
//! PROGRAM Main
//! VAR
//!     Small : SINT := 200;
//!                     ^^^
//!     Level : INT;
//! END_VAR
//!     LD Level
//!     ADD 40000
//!         ^^^^^
//!     ST Level
//!     LD SINT#128
//!        ^^^^^^^^
//!     ST Small
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR
//!     Small : SINT := 127;
//!     Level : INT;
//! END_VAR
//!     LD Level
//!     ADD 30000
//!     ST Level
//!     LD SINT#12
//!     ST Small
//! END_PROGRAM
//! ```

use crate::check::{ChunkContext, Rule, Run};
use crate::target::{Constant, Form, Operand, Wide};
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "constant-out-of-range",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("constant_out_of_range.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if !context.target.is_fx() {
        return;
    }
    for operation in &context.doubtful {
        let Some(form) = operation.form else { continue };
        // The others make no difference to the limits.
        let first = operation.operands.first().map(|operand| operand.value);
        let operands = first.as_slice();
        for (place, operand) in operation.operands.iter().enumerate() {
            let Operand::Constant { value, .. } = operand.value else { continue };
            let takes = form.takes(place, &operand.value, context.target.model);
            if !takes || fits(form, place, value, operands) {
                continue;
            }
            let (least, greatest) = form.constant_limits(place, operands);
            let spec = &form.instruction.operands[place];
            let key = match (value, spec.optional) {
                (Constant::Real(_), _) => "constant-out-of-range.real",
                (_, true) => "constant-out-of-range.preset",
                _ => "constant-out-of-range.found",
            };
            let message = Message::new(key)
                .with("word", operand.span.of(context.chunk.text()))
                .with("place", spec.name)
                .with("instruction", form.mnemonic())
                .with(
                    "device",
                    operands.first().and_then(Operand::device).map_or(String::new(), |d| d.to_string()),
                )
                .with("least", least)
                .with("greatest", greatest);
            let diagnostic = Diagnostic::new(RULE.code, operand.span, message);
            found.push(match fitting_form(form, place, value, operands).filter(|_| operation.is_word) {
                Some(wide) => {
                    let title = Message::new("constant-out-of-range.use-wide").with("instruction", &wide);
                    diagnostic.fix(title, vec![TextEdit::new(operation.symbol, wide)])
                }
                None => diagnostic,
            });
        }
    }
}

/// Real constants are kept in 32 bits.
fn fits(form: Form, place: usize, value: Constant, operands: &[Operand]) -> bool {
    match value {
        Constant::Real(value) => value.abs() <= f64::from(f32::MAX),
        _ => form.constant_fits(place, value, operands),
    }
}

/// The mnemonic of the 32-bit form, if the constant fits there.
fn fitting_form(form: Form, place: usize, value: Constant, operands: &[Operand]) -> Option<String> {
    let wide = Form { wide: true, ..form };
    let exists = form.instruction.wide == Wide::Yes && !form.wide;
    (exists && fits(wide, place, value, operands)).then(|| wide.mnemonic())
}
