//! Boxes in drawings, whose parameters have the names of the declaration like those of a call in a list.

use super::constant_written;
use super::unknown_parameter::{RULE, with_names};
use crate::check::ChunkContext;
use crate::check::iec::{View, constant_written as constant_at_pin, expression_written};
use crate::document::Tree;
use crate::il::iec::IecTree;
use crate::ladder::{Block, Element, ElementKind, Pin, PinWire};
use crate::logic::{Callee, Formal};
use crate::target::Operand;
use crate::target::iec::{EN, ENO};
use crate::text::{Diagnostic, Message, Span, folded};

/// The pins of function blocks, and of functions of the program, that these do not have.
pub(super) fn parameters(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    each(context, |_, block, callee| unknown_pins(context.chunk.text(), block, callee, found));
}

/// What coils and the pins of boxes write that is only to be read: variables declared so, and outputs of blocks.
pub(super) fn variables(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let text = context.chunk.text();
    let tree = IecTree::default();
    let view = View { text, tree: &tree, scopes: context.scopes, pou: context.pou };
    let judge = |element: &Element, place: usize| {
        let operand = element.operands.get(place).filter(|operand| operand.value == Operand::Variable)?;
        constant_written::judge(&view, &element.operand_text(place, text), operand.span)
    };
    for element in elements(context) {
        if matches!(element.kind, ElementKind::Coil(_)) {
            found.extend(judge(element, 0));
        }
    }
    each(context, |element, block, callee| {
        for (_, place) in written(text, block, callee) {
            if let Written::Operand(place) = place {
                found.extend(judge(element, place));
            }
        }
    });
}

/// What is drawn in IEC 61131-3.
fn elements<'c>(context: &'c ChunkContext<'_>) -> impl Iterator<Item = &'c Element> {
    let rungs = match context.chunk.tree() {
        Tree::Ladder(tree) if !context.target.is_fx() => &tree.rungs[..],
        _ => &[],
    };
    rungs.iter().flat_map(|rung| &rung.graph.elements)
}

/// What the pins of boxes would have to write and that is no variable: constants, inverted values, power.
pub(in crate::check) fn values(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let text = context.chunk.text();
    // What looks like power may be a name that could not be read.
    let is_read = matches!(context.chunk.tree(), Tree::Ladder(tree) if tree.problems.is_empty());
    each(context, |element, block, callee| {
        for (name, place) in written(text, block, callee) {
            match place {
                Written::Expression(_) if !is_read => {}
                Written::Expression(span) => found.push(expression_written(span, name)),
                Written::Operand(place) => {
                    let operand = element.operands.get(place);
                    let literal = operand.filter(|one| matches!(one.value, Operand::Literal(_)));
                    found.extend(literal.map(|one| constant_at_pin(one.span, one.span.of(text), name)));
                }
            }
        }
    });
}

/// What is at a pin that writes.
enum Written {
    /// The operand of the element at this place.
    Operand(usize),
    /// Power, or an inverted value, at the pin of this name.
    Expression(Span),
}

/// The pins that write to what is connected to them, by name: outputs, and inputs that are VAR_IN_OUT.
fn written<'t>(text: &'t str, block: &Block, callee: &'t Callee) -> Vec<(&'t str, Written)> {
    let inputs = callee.inputs();
    let named = |pin: &Pin| match pin.name.map_or("", |name| name.of(text)) {
        "" => callee.name(),
        name => name,
    };
    let is_in_out = |pin: &&Pin| {
        let name = pin.formal(text);
        inputs.iter().any(|formal| formal.is_in_out && formal.is_called(name))
    };
    let handed_over = block.inputs.iter().filter(is_in_out).filter_map(|pin| {
        let place = match (&pin.wire, pin.name) {
            (PinWire::Operand(place), _) if !pin.negated => Written::Operand(*place),
            (PinWire::Operand(_) | PinWire::Power, Some(name)) => Written::Expression(name),
            _ => return None,
        };
        Some((named(pin), place))
    });
    let outputs = block.outputs.iter().filter_map(|pin| match pin.wire {
        PinWire::Operand(place) => Some((named(pin), Written::Operand(place))),
        _ => None,
    });
    handed_over.chain(outputs).collect()
}

/// Calls `found` with each box that has a name, and with what it calls.
fn each(context: &ChunkContext<'_>, mut found: impl FnMut(&Element, &Block, &Callee)) {
    let text = context.chunk.text();
    for element in elements(context) {
        let ElementKind::Block(block) = &element.kind else { continue };
        // The boxes of LDmicro have no names but what stands in for them.
        let Some(name) = block.type_text(text).filter(|_| block.ldmicro.is_none()) else { continue };
        let function = Callee::declared_function(name, context.scopes).filter(|_| block.instance.is_none());
        if let Some(callee) = function.or_else(|| Callee::block(name, context.scopes)) {
            found(element, block, &callee);
        }
    }
}

fn unknown_pins(text: &str, block: &Block, callee: &Callee, found: &mut Vec<Diagnostic>) {
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
