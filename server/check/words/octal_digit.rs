//! # octal-digit
//!
//! The numbers of inputs and outputs are octal: X7 is followed by X10, and there is no X8, X9 or Y19. The terminal
//! strip of the PLC is labelled in the same way. Timers, relays and registers count in decimal.
//!
//! On a machine the mistake means that somebody counted terminals in decimal; the input that was meant may be two
//! terminals further on. Two readings are possible and both are offered: the same position on the strip
//! (the ninth input, `X8` counted in decimal, is X10), or the digit mistyped.
//!
//! ```fx
//! LD X8
//!    ^^
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X10
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X9                Y0   |
//!    ^^
//! +--| |---------------( )--+
//! ```

use crate::check::{ChunkContext, Rule, Run};
use crate::target::{Device, DeviceKind, Operand, OperandProblem};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "octal-digit",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("octal_digit.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let operands = context.doubtful.iter().flat_map(|operation| operation.operands);
    for operand in operands.filter(|operand| operand.value == Operand::Invalid(OperandProblem::OctalDigit)) {
        let word = operand.span.of(context.chunk.text());
        let message = Message::new("octal-digit.found").with("word", word);
        found.push(with_readings(Diagnostic::new(RULE.code, operand.span, message), word, operand.span));
    }
}

/// Adds the two readings: counted in decimal, and with the wrong digits replaced by 7.
fn with_readings(mut diagnostic: Diagnostic, word: &str, span: Span) -> Diagnostic {
    let Some(kind) = word.chars().next().and_then(DeviceKind::of_letter) else { return diagnostic };
    let digits = &word[1..];
    let counted = digits.parse().ok();
    let mistyped = u32::from_str_radix(&digits.replace(['8', '9'], "7"), 8).ok();
    for (key, number) in [("octal-digit.counted", counted), ("octal-digit.mistyped", mistyped)] {
        if let Some(number) = number {
            let device = Device::new(kind, number);
            let title = Message::new(key).with("word", word).with("device", device);
            diagnostic = diagnostic.fix(title, vec![TextEdit::new(span, device.to_string())]);
        }
    }
    diagnostic
}
