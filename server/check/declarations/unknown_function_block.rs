//! # unknown-function-block
//!
//! `CAL` and the input operators (`CU`, `IN` …) work on an instance of a function block, which is declared like a
//! variable: `Delay : TON;`. Here stands something else: a plain variable, or the name of the block itself. The
//! block keeps its state, such as the time that has passed, in the instance; without one there is nowhere to keep it.
//!
//! ```iec
//! PROGRAM Fan
//! VAR
//!     Start : BOOL;
//!     Delay : TIME;
//! END_VAR
//!     LD Start
//!     CAL Delay
//!         ^^^^^
//!     CAL TON(IN := Start, PT := T#5s)
//!         ^^^
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Fan
//! VAR
//!     Start : BOOL;
//!     Delay : TON;
//! END_VAR
//!     CAL Delay(
//!         IN := Start,
//!         PT := T#5s
//!     )
//! END_PROGRAM
//! ```

use crate::check::iec::{Callee, Place, Root, ValueType, View};
use crate::check::{ChunkContext, Rule, Run};
use crate::document::{DeclaredType, Variable};
use crate::il::iec::{ItemKind, OperandId};
use crate::target::Operand;
use crate::text::{Diagnostic, Message, Severity, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "unknown-function-block",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("unknown_function_block.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some(view) = View::of(context) else { return };
    for item in &view.tree.items {
        match item.kind {
            ItemKind::Call { callee: Some(id), .. } => {
                let is_function = Callee::function(&view, view.word(id)).is_some();
                if !is_function || matches!(view.root(view.word(id)), Root::Variable(_)) {
                    found.extend(judge(&view, id));
                }
            }
            ItemKind::InputOperator { instance, .. } => found.extend(judge(&view, instance)),
            _ => {}
        }
    }
}

fn judge(view: &View<'_>, id: OperandId) -> Option<Diagnostic> {
    let operand = view.tree.operand(id);
    let word = view.word(id);
    let diagnostic =
        |message: Message| Some(Diagnostic::new(RULE.code, operand.span, message.with("word", word)));
    match operand.value {
        Operand::Literal(_) | Operand::Direct(_) => diagnostic(Message::new("unknown-function-block.value")),
        Operand::Variable => match view.place(id) {
            // The block itself instead of an instance; any other name is an undeclared variable.
            Place::Undeclared if view.is_block(word) => {
                let found = diagnostic(Message::new("unknown-function-block.block"))?;
                Some(instances(view, word).fold(found, |found, name| {
                    let title = Message::new("unknown-function-block.call").with("name", name);
                    found.fix(title, vec![TextEdit::new(operand.span, name)])
                }))
            }
            Place::Typed(declared) => {
                let title = match view.value_of(declared.clone()) {
                    ValueType::Elementary(kind) => kind.name().to_string(),
                    ValueType::Unknown => match view.scopes.resolved(declared)? {
                        DeclaredType::Array(_) => "ARRAY".to_string(),
                        DeclaredType::Structure(_) => "STRUCT".to_string(),
                        DeclaredType::Enumeration(_) => "enumeration".to_string(),
                        _ => return None,
                    },
                    _ => return None,
                };
                diagnostic(Message::new("unknown-function-block.variable").with("type", title))
            }
            _ => None,
        },
        _ => None,
    }
}

/// So many instances are offered.
const MOST_INSTANCES: usize = 4;

/// The instances of a block in the unit of the call.
fn instances<'v>(view: &View<'v>, block: &str) -> impl Iterator<Item = &'v str> {
    let own = view.pou.and_then(|pou| view.scopes.pous.get(pou));
    let variables = own.map_or(&[][..], |pou| &pou.variables);
    let is_instance = move |variable: &&Variable| match &variable.declared {
        DeclaredType::Named(name) => name.eq_ignore_ascii_case(block),
        _ => false,
    };
    variables.iter().filter(is_instance).map(|variable| variable.name.as_str()).take(MOST_INSTANCES)
}
