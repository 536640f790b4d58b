//! # instruction-not-on-target
//!
//! The instruction exists in the FX family, but not on this model. The programming tool would refuse it, or the PLC
//! would stop with a syntax error in D8065. Choose the model that stands in the cabinet as the target, or write the
//! rung with what the model has.
//!
//! ```fx fx1n
//! LD X0
//! SORT D0 K10 K2 D100 K1
//! ^^^^
//! END
//! ```
//!
//! ```fx fx2n
//! LD X0
//! SORT D0 K10 K2 D100 K1
//! END
//! ```
//!
//! ```lad fx1s
//! |  X0                     |
//! +--| |---[FLT D0 D2]------+
//!           ^^^
//! ```

use crate::check::{ChunkContext, Rule, Run};
use crate::target::Target;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "instruction-not-on-target",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("instruction_not_on_target.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    if !context.target.is_fx() {
        return;
    }
    for operation in &context.doubtful {
        let Some(form) = operation.form.filter(|form| !form.is_on(context.target.model)) else { continue };
        let models: Vec<&str> =
            form.instruction.models.iter().map(|&model| Target::of(model).title).collect();
        let message = Message::new("instruction-not-on-target.found")
            .with("word", form.mnemonic())
            .with("target", context.target.title)
            .with("models", models.join(", "));
        found.push(Diagnostic::new(RULE.code, operation.symbol, message));
    }
}
