//! Variables of a ladder without header: nothing declares them, and their type is that of their first use.

use super::declared;
use super::names::{self, Thing};
use crate::document::{Chunk, Document, Mention, Notation, Symbol, Tree};
use crate::ladder::{Block, Element, ElementKind, LadderTree, PinWire};
use crate::target::Operand;
use crate::target::iec::{Function, FunctionBlock, LiteralValue, ParameterType};
use crate::text::Span;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

/// The type of the variable `thing` by the first of its uses that tells: a contact or coil makes it BOOL, a box of
/// which it is the instance that function block, a parameter or a literal beside it their type.
///
/// Nothing if it is no variable of a ladder without header; `Some(None)` if no use tells.
pub(super) fn type_of(document: &Document, thing: &Thing) -> Option<Option<String>> {
    let Thing::Variable { name, .. } = thing else { return None };
    if !is_without_header(document) || document.scopes().variable(None, name).is_some() {
        return None;
    }
    let mut found = None;
    names::visit(document, thing, |place| {
        if found.is_none() {
            found = type_at(place.chunk, place.inside());
        }
    });
    Some(found)
}

/// Whether the names in `document` are variables without being declared.
fn is_without_header(document: &Document) -> bool {
    document.notation() == Notation::Ladder && document.scopes().own_pous().is_empty()
}

/// The first uses of implicit variables in the chunks between two offsets, with their types; those whose first use
/// does not tell are left out.
pub(super) fn first_uses(document: &Document, first: usize, last: usize) -> Vec<(Span, String)> {
    let mut uses = Vec::new();
    if !is_without_header(document) {
        return uses;
    }
    // The tables of an LDmicro export declare, wherever they stand.
    let rows = declared::table_rows_of(document);
    let declared: FxHashSet<String> = rows.into_keys().map(|name| name.to_lowercase()).collect();
    let is_declared =
        |name: &SmolStr| declared.contains(name.as_str()) || document.scopes().variable(None, name).is_some();
    let mut seen: FxHashSet<&SmolStr> = FxHashSet::default();
    let mut page_start = 0;
    for page in document.pages() {
        let mut start = page_start;
        page_start += page.bytes();
        if start > last {
            break;
        }
        if page_start < first {
            seen.extend(page.names().symbols().iter().filter_map(|(symbol, _)| variable(symbol)));
            continue;
        }
        for chunk in page.chunks() {
            let within = start <= last && start + chunk.len() >= first;
            for mention in chunk.mentions() {
                let Some(name) = variable(&mention.symbol).filter(|name| seen.insert(name)) else { continue };
                if within && !is_declared(name) {
                    uses.extend(first_use(chunk, mention, start));
                }
            }
            start += chunk.len();
        }
    }
    uses
}

fn first_use(chunk: &Chunk, mention: &Mention, start: usize) -> Option<(Span, String)> {
    Some((mention.span.shifted(start), type_at(chunk, mention.span)?))
}

fn variable(symbol: &Symbol) -> Option<&SmolStr> {
    match symbol {
        Symbol::Variable(name) => Some(name),
        _ => None,
    }
}

/// The type that the use of a variable at `span` asks for.
fn type_at(chunk: &Chunk, span: Span) -> Option<String> {
    let Tree::Ladder(tree) = chunk.tree() else { return None };
    type_in(tree, chunk.text(), span)
}

fn type_in(tree: &LadderTree, text: &str, span: Span) -> Option<String> {
    let holds = |whole: Span| whole.start <= span.start && span.end <= whole.end;
    let rungs = tree.rungs.iter().filter(|rung| holds(rung.span));
    for element in rungs.flat_map(|rung| &rung.graph.elements) {
        if let Some(block) = element.block()
            && block.instance == Some(span)
        {
            return block.type_text(text).map(str::to_string);
        }
        let lines = element.name_lines.iter().any(|line| holds(*line));
        let number = element.operands.iter().position(|operand| holds(operand.span));
        if let Some(number) = number.or(lines.then_some(0)) {
            let path = element.operands.get(number)?.span;
            // Of `T1.Q` the use says nothing about `T1` itself.
            let is_whole = path == span || lines;
            return if is_whole { type_of_operand(element, number, text) } else { None };
        }
    }
    None
}

fn type_of_operand(element: &Element, number: usize, text: &str) -> Option<String> {
    match &element.kind {
        ElementKind::Contact(_) | ElementKind::Coil(_) => Some("BOOL".to_string()),
        ElementKind::Compare(_) => {
            element.operands.iter().find_map(|operand| type_of_literal(&operand.value)).map(str::to_string)
        }
        ElementKind::Block(block) => type_of_pin(block, number, text),
        _ => None,
    }
}

/// The type of the parameter to which operand `number` is given.
fn type_of_pin(block: &Block, number: usize, text: &str) -> Option<String> {
    let pin = block.inputs.iter().chain(&block.outputs).find(|pin| pin.wire == PinWire::Operand(number))?;
    let (formal, kind) = (pin.formal(text), block.type_text(text)?);
    let of_block = || {
        let block = FunctionBlock::named(kind)?;
        block.input_named(formal).or_else(|| block.output_named(formal))
    };
    let of_function = || Function::named(kind)?.input_named(formal);
    match of_block().or_else(of_function)?.kind {
        ParameterType::Elementary(kind) => Some(kind.name().to_string()),
        _ => None,
    }
}

/// The type that a value beside a variable suggests.
fn type_of_literal(operand: &Operand) -> Option<&'static str> {
    let Operand::Literal(literal) = operand else { return None };
    if let Some(kind) = literal.named_type {
        return Some(kind.name());
    }
    Some(match literal.value {
        LiteralValue::Bool(_) => "BOOL",
        LiteralValue::Integer(_) => "INT",
        LiteralValue::Real(_) => "REAL",
        LiteralValue::Time(_) => "TIME",
        LiteralValue::Date(_) => "DATE",
        LiteralValue::TimeOfDay(_) => "TIME_OF_DAY",
        LiteralValue::DateAndTime(_) => "DATE_AND_TIME",
        LiteralValue::Text | LiteralValue::WideText | LiteralValue::Enumerated => return None,
    })
}
