//! # unread-word
//!
//! A word of program memory that is no instruction of the model, as far as is known: the program was read from a PLC
//! or a file, and this is what could not be read. It goes back as it is, but what the PLC does with it is not known,
//! so nothing is proved of its rung, and the program cannot be simulated.
//!
//! Look at the place in the maker's tool, and write the instruction that it shows. Several such lines one behind the
//! other are one instruction with its operands.
//!
//! ```fx
//! LD X0
//! NOP? H01FF
//! ^^^^^^^^^^
//! OUT Y0
//! END
//! ```
//!
//! ```fx
//! LD X0
//! NOP
//! OUT Y0
//! END
//! ```

use crate::check::{ChunkContext, Rule, Run};
use crate::target::Opcode;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "unread-word",
    severity: Severity::Warning,
    run: Run::Chunk(check),
    source: include_str!("unread_word.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    for operation in &context.doubtful {
        let Some(form) = operation.form else { continue };
        if form.instruction.opcode != Opcode::Itself {
            continue;
        }
        let operand = operation.operands.first();
        let span = operand.map_or(operation.symbol, |operand| operation.symbol.to(operand.span));
        let message = Message::new("unread-word.found").with("target", context.target.title);
        found.push(Diagnostic::new(RULE.code, span, message));
    }
}
