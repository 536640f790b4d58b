//! # malformed-literal
//!
//! A constant that cannot be read. `K` is followed by a decimal number, `H` by a hexadecimal one, `E` by a real one;
//! `K4M0` stands for four groups of four relays, and there are at most eight groups.
//!
//! ```fx
//! LD X0
//! MOV K1.5 D0
//!     ^^^^
//! MOV H12G D1
//!     ^^^^
//! MOV K9M0 D2
//!     ^^^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! MOV K15 D0
//! MOV H12F D1
//! DMOV K8M0 D2
//! END
//! ```
//!
//! ```lad
//! |  X0                     |
//! +--| |---[MOV H1G D0]-----+
//!               ^^^
//! ```
//!
//! In IEC programs the units of a duration descend and only the first may overflow, real numbers have a digit on both
//! sides of the point, and bases are 2, 8 and 16:
//!
//! ```iec
//! PROGRAM Main
//! VAR
//!     Delay : TIME := T#1h90m;
//!                     ^^^^^^^
//!     Bits : WORD;
//!     Speed : REAL;
//! END_VAR
//!     LD 2#1021
//!        ^^^^^^
//!     ST Bits
//!     LD 1E3
//!        ^^^
//!     ST Speed
//!     LD %IZ0
//!        ^^^^
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR
//!     Delay : TIME := T#2h30m;
//!     Bits : WORD;
//!     Speed : REAL;
//! END_VAR
//!     LD 2#1011
//!     ST Bits
//!     LD 1.0E3
//!     ST Speed
//! END_PROGRAM
//! ```

use crate::check::iec::{View, unreadable_operands};
use crate::check::{ChunkContext, Rule, Run};
use crate::target::{Operand, OperandProblem};
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "malformed-literal",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("malformed_literal.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if let Some(view) = View::of(context) {
        return unreadable_operands(&view, found);
    }
    for operand in context.doubtful.iter().flat_map(|operation| operation.operands) {
        if operand.value == Operand::Invalid(OperandProblem::MalformedConstant) {
            found.push(fx_constant(operand.span, operand.span.of(context.chunk.text())));
        }
    }
}

/// Says what the letter of an FX constant asks for.
fn fx_constant(span: Span, word: &str) -> Diagnostic {
    let body = word.get(1..).unwrap_or("");
    let is_group = body.contains(|letter: char| "xymsXYMS".contains(letter));
    let key = match word.chars().next().map(|letter| letter.to_ascii_uppercase()) {
        Some('K') if is_group => "malformed-literal.group",
        Some('K') if body.contains('.') => "malformed-literal.point",
        Some('H') => "malformed-literal.hexadecimal",
        Some('E') => "malformed-literal.real",
        _ => "malformed-literal.decimal",
    };
    Diagnostic::new(RULE.code, span, Message::new(key).with("word", word))
}
