//! # constant-written
//!
//! The program writes to something that it may only read: a variable declared `CONSTANT`, an input of its own
//! (`VAR_INPUT`), or an output of a function block that only the block itself sets. Many controllers keep constants
//! in program memory, where the write has no effect or stops the CPU; a written input or output is overwritten by the
//! next call, so the value is there in one part of the scan and gone in another.
//!
//! ```iec
//! FUNCTION_BLOCK Dose
//! VAR_INPUT
//!     Request : INT;
//! END_VAR
//! VAR_OUTPUT
//!     Valve : BOOL;
//! END_VAR
//! VAR CONSTANT
//!     Limit : INT := 100;
//! END_VAR
//! VAR
//!     Delay : TON;
//! END_VAR
//!     LD Request
//!     ST Limit
//!        ^^^^^
//!     ST Request
//!        ^^^^^^^
//!     LD FALSE
//!     ST Delay.Q
//!        ^^^^^^^
//!     ST Valve
//! END_FUNCTION_BLOCK
//! ```
//!
//! ```iec
//! FUNCTION_BLOCK Dose
//! VAR_INPUT
//!     Request : INT;
//! END_VAR
//! VAR_OUTPUT
//!     Valve : BOOL;
//! END_VAR
//! VAR CONSTANT
//!     Limit : INT := 100;
//! END_VAR
//! VAR
//!     Delay : TON;
//! END_VAR
//!     LD Request
//!     GT Limit
//!     ST Delay.IN
//!     CAL Delay(
//!         PT := T#1s
//!     )
//!     LD Delay.Q
//!     ST Valve
//! END_FUNCTION_BLOCK
//! ```

use crate::check::iec::{Callee, Flow, Root, ValueType, View};
use crate::check::{ChunkContext, Rule, Run};
use crate::il::iec::{OperandId, SectionKind};
use crate::target::Operand;
use crate::text::{Diagnostic, Message, Severity};

pub(super) const RULE: Rule = Rule {
    code: "constant-written",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("constant_written.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some(view) = View::of(context) else { return };
    for id in view.written() {
        let operand = view.tree.operand(id);
        if operand.value != Operand::Variable {
            continue;
        }
        let word = view.word(id);
        let Root::Variable(variable) = view.root(word) else { continue };
        let message = match variable.section {
            _ if variable.constant => Message::new("constant-written.constant").with("name", &variable.name),
            SectionKind::Input => Message::new("constant-written.input").with("name", &variable.name),
            _ => match output_of(&view, id) {
                Some(block) => {
                    Message::new("constant-written.output").with("word", word).with("block", block)
                }
                None => continue,
            },
        };
        found.push(Diagnostic::new(RULE.code, operand.span, message));
    }
}

/// The function block of which the written operand is an output.
fn output_of(view: &View<'_>, id: OperandId) -> Option<String> {
    let (owner, member) = view.word(id).rsplit_once('.')?;
    let owner = view.scopes.type_of(view.pou, owner)?;
    let ValueType::Instance(block) = view.value_of(owner) else { return None };
    let block = Callee::block(view, &block)?;
    let pin = block.pin_named(view, member)?;
    (pin.flow == Flow::Out).then(|| block.name().to_string())
}
