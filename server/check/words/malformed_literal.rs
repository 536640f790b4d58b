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
    for operand in context.chunk.operations().flat_map(|operation| operation.operands) {
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
