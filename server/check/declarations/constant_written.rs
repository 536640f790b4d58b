//! # constant-written
//!
//! The program writes to something that it may only read: a variable declared `CONSTANT`, an input of its own
//! (`VAR_INPUT`), or an output of a function block that only the block itself sets. Many controllers keep constants
//! in program memory, where the write has no effect or stops the CPU; a written input or output is overwritten by the
//! next call, so the value is there in one part of the scan and gone in another. What a call hands over at a
//! `VAR_IN_OUT` is written by what is called, in lists as at the pins of a drawn box. A coil writes its variable.
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
use crate::il::iec::{Direction, ItemKind, ListForm, OperandId, ParameterValue, SectionKind};
use crate::target::Operand;
use crate::text::{Diagnostic, Message, Severity, Span};

pub(super) const RULE: Rule = Rule {
    code: "constant-written",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("constant_written.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some(view) = View::of(context) else { return super::boxes::variables(context, found) };
    let mut written: Vec<OperandId> = view.written().collect();
    handed_over(&view, &mut written);
    written.sort_unstable_by_key(|id| id.0);
    written.dedup();
    for id in written {
        let operand = view.tree.operand(id);
        if operand.value == Operand::Variable {
            found.extend(judge(&view, view.word(id), operand.span));
        }
    }
}

/// Adds what calls hand over to be changed: the operands of VAR_IN_OUT.
fn handed_over(view: &View<'_>, written: &mut Vec<OperandId>) {
    for item in &view.tree.items {
        let (callee, form, parameters) = match item.kind {
            ItemKind::Call { callee: Some(id), form, parameters, .. } => match view.value(id) {
                ValueType::Instance(block) => (Callee::block(view, &block), form, parameters),
                _ => (Callee::function(view, view.word(id)), form, parameters),
            },
            ItemKind::Function { name, form, parameters } => {
                (Callee::function(view, name.of(view.text)), form, parameters)
            }
            _ => continue,
        };
        let Some(callee) = callee else { continue };
        // The current result is the first input of a function without a list in parentheses.
        let is_first = matches!(item.kind, ItemKind::Function { .. }) && form == ListForm::None;
        for (place, parameter) in parameters.of(&view.tree.parameters).iter().enumerate() {
            let pin = match (parameter.name, form) {
                (Some(name), _) => callee.pin_named(view, name.of(view.text)),
                (None, ListForm::Formal) => None,
                (None, _) => callee.pin_at(view, place + usize::from(is_first)),
            };
            let is_changed =
                parameter.direction == Direction::In && pin.is_some_and(|pin| pin.flow == Flow::InOut);
            if let (ParameterValue::Operand(id), true) = (parameter.value, is_changed) {
                written.push(id);
            }
        }
    }
}

/// What is wrong with writing to `word`, a variable or a part of one.
pub(super) fn judge(view: &View<'_>, word: &str, span: Span) -> Option<Diagnostic> {
    let Root::Variable(variable) = view.root(word) else { return None };
    let message = match variable.section {
        _ if variable.constant => Message::new("constant-written.constant").with("name", &variable.name),
        SectionKind::Input => Message::new("constant-written.input").with("name", &variable.name),
        _ => {
            let block = output_of(view, word)?;
            Message::new("constant-written.output").with("word", word).with("block", block)
        }
    };
    Some(Diagnostic::new(RULE.code, span, message))
}

/// The function block of which the written path is an output.
fn output_of(view: &View<'_>, word: &str) -> Option<String> {
    let (owner, member) = word.rsplit_once('.')?;
    let owner = view.scopes.type_of(view.pou, owner)?;
    let ValueType::Instance(block) = view.value_of(owner) else { return None };
    let block = Callee::block(view, &block)?;
    let pin = block.pin_named(view, member)?;
    (pin.flow == Flow::Out).then(|| block.name().to_string())
}
