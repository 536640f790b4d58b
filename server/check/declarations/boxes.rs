//! Boxes in drawings, whose parameters have the names of the declaration like those of a call in a list.

use super::unknown_parameter::{RULE, with_names};
use crate::check::ChunkContext;
use crate::document::Tree;
use crate::ladder::{Block, ElementKind, Pin};
use crate::logic::{Callee, Formal};
use crate::target::iec::{EN, ENO};
use crate::text::{Diagnostic, Message, Span, folded};

/// The pins of function blocks, and of functions of the program, that these do not have.
pub(super) fn parameters(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Tree::Ladder(tree) = context.chunk.tree() else { return };
    if context.target.is_fx() {
        return;
    }
    for element in tree.rungs.iter().flat_map(|rung| &rung.graph.elements) {
        if let ElementKind::Block(block) = &element.kind {
            of_box(context, block, found);
        }
    }
}

fn of_box(context: &ChunkContext<'_>, block: &Block, found: &mut Vec<Diagnostic>) {
    let text = context.chunk.text();
    // The boxes of LDmicro have no names but what stands in for them.
    let Some(name) = block.type_text(text).filter(|_| block.ldmicro.is_none()) else { return };
    let function = || Callee::declared_function(name, context.scopes).filter(|_| block.instance.is_none());
    let Some(callee) = function().or_else(|| Callee::block(name, context.scopes)) else { return };
    // The result of a function has no name of its own, so people give it many.
    let has_result = callee.result_type().is_some();
    let sides = [
        (&block.inputs, callee.inputs(), EN.name, "unknown-parameter.no-input"),
        (&block.outputs, callee.outputs(), ENO.name, "unknown-parameter.no-output"),
    ];
    for (pins, formals, enable, key) in sides.into_iter().take(if has_result { 1 } else { 2 }) {
        let names: Vec<&str> = formals.iter().map(|formal| formal.name).collect();
        for span in pins.iter().filter_map(|pin| unknown(text, pin, &formals, enable)) {
            let message = Message::new(key)
                .with("word", span.of(text))
                .with("name", callee.name())
                .with("names", names.join(", "));
            let diagnostic = Diagnostic::new(RULE.code, span, message);
            found.push(with_names(diagnostic, text, span, names.iter().copied().filter(fits(span.of(text)))));
        }
    }
}

/// The name of a pin, if neither a parameter nor `enable` is called so.
fn unknown(text: &str, pin: &Pin, formals: &[Formal<'_>], enable: &str) -> Option<Span> {
    let name = pin.name?;
    let word = name.of(text);
    let is_known = word.is_empty() || folded(word) == folded(enable);
    let is_known = is_known || formals.iter().any(|formal| formal.is_called(word));
    (!is_known).then_some(name)
}

/// Whether a name can stand in the place of `word` without moving the border of the box.
fn fits(word: &str) -> impl Fn(&&str) -> bool {
    let width = word.chars().count();
    move |name| name.chars().count() == width
}
