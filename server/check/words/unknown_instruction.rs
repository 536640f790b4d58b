//! # unknown-instruction
//!
//! The word is no instruction of the FX family. Nothing of the rung reaches the PLC until it is one, and what was
//! meant is often one letter away, or called otherwise by another maker: `ST` is `OUT`, `ANDN` is `ANI`.
//!
//! The nearest instructions that the model has are offered as fixes.
//!
//! ```fx
//! LD X0
//! ANDN X1
//! ^^^^
//! OUTT Y0
//! ^^^^
//! END
//! ```
//!
//! ```fx
//! LD X0
//! ANI X1
//! OUT Y0
//! END
//! ```
//!
//! ```lad
//! |  X0                    |
//! +--| |---[MVO K10 D0]----+
//!           ^^^
//! ```
//!
//! In IEC programs an instruction is an operator, a function, standard or declared, or an input operator of a block.
//!
//! ```iec
//! PROGRAM Main
//! VAR Start, Motor : BOOL; END_VAR
//!     LD Start
//!     OUT Motor
//!     ^^^
//!     dbg Motor
//!     ^^^
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Main
//! VAR Start, Motor : BOOL; END_VAR
//!     LD Start
//!     ST Motor
//! END_PROGRAM
//! ```

use crate::check::iec::{View, unknown_instructions};
use crate::check::{ChunkContext, Rule, Run};
use crate::target::instructions::suggestions;
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "unknown-instruction",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("unknown_instruction.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if let Some(view) = View::of(context) {
        return unknown_instructions(&view, found);
    }
    if !context.target.is_fx() {
        return;
    }
    for operation in context.doubtful.iter().filter(|operation| operation.form.is_none()) {
        let word = operation.symbol.of(context.chunk.text());
        let near = suggestions(word, context.target.model);
        let key = if near.is_empty() { "unknown-instruction.found" } else { "unknown-instruction.near" };
        let message = Message::new(key).with("word", word).with("near", near.join(", "));
        let mut diagnostic = Diagnostic::new(RULE.code, operation.symbol, message);
        let lower = word.bytes().any(|byte| byte.is_ascii_lowercase());
        for mnemonic in near {
            let mnemonic = if lower { mnemonic.to_ascii_lowercase() } else { mnemonic };
            let title = Message::new("unknown-instruction.replace").with("mnemonic", &mnemonic);
            diagnostic = diagnostic.fix(title, vec![TextEdit::new(operation.symbol, mnemonic)]);
        }
        found.push(diagnostic);
    }
}
