//! Initial values against the types of what they initialise.

use super::{Expected, Fit, ValueType, View, fit, out_of_range};
use crate::document::DeclaredType;
use crate::il::iec::{Declaration, ItemKind, TypeSpec, ValueKind};
use crate::target::Operand;
use crate::target::iec::LiteralValue;
use crate::text::{Diagnostic, Message, folded};

/// Constants that do not fit the declared type: a part of `constant-out-of-range` and of `operand-kind`.
pub fn initial_values(view: &View<'_>, found: &mut Vec<Diagnostic>) {
    for item in &view.tree.items {
        let (ItemKind::Section { declarations, .. } | ItemKind::Types { declarations }) = item.kind else {
            continue;
        };
        for declaration in declarations.of(&view.tree.declarations) {
            let (Some(index), Some(id)) = (declaration.initial, declaration.declared) else { continue };
            let declared = view.scopes.resolved(DeclaredType::of(view.text, view.tree, id));
            value(view, index, declared.unwrap_or(DeclaredType::Unknown), found);
            subrange(view, declaration, found);
        }
    }
}

/// One initial value and those inside it. Values nest no deeper than the grammar lets them.
fn value(view: &View<'_>, index: u32, declared: DeclaredType, found: &mut Vec<Diagnostic>) {
    let Some(record) = view.tree.values.get(index as usize) else { return };
    let inside = view.tree.values_inside(index);
    match (record.kind, declared) {
        (ValueKind::Constant(id), DeclaredType::Elementary(kind)) => {
            let operand = view.tree.operand(id);
            let given = view.value(id);
            if !matches!(given, ValueType::Literal(_)) {
                return;
            }
            let word = operand.span.of(view.text);
            match fit(&given, Expected::Elementary(kind)) {
                Fit::Fits => {}
                Fit::OutOfRange(kind) => found.push(out_of_range(operand.span, word, kind)),
                Fit::Mismatch => {
                    let message = Message::new("operand-kind.initial")
                        .with("word", word)
                        .with("found", given.title(word))
                        .with("expected", kind);
                    found.push(Diagnostic::new("operand-kind", operand.span, message));
                }
            }
        }
        (ValueKind::Array, DeclaredType::Array(element)) => {
            let element = view.scopes.resolved(*element).unwrap_or(DeclaredType::Unknown);
            for one in inside {
                value(view, one, element.clone(), found);
            }
        }
        // Inside an array: the values that are repeated are elements too.
        (ValueKind::Repeat { .. }, element) => {
            for one in inside {
                value(view, one, element.clone(), found);
            }
        }
        (ValueKind::Structure, DeclaredType::Structure(fields)) => {
            for one in inside {
                let field = view.tree.values.get(one as usize).and_then(|record| record.field);
                let name = field.map(|span| folded(span.of(view.text)));
                let declared = fields.iter().find(|(own, _)| Some(own) == name.as_ref());
                let declared = declared.and_then(|(_, declared)| view.scopes.resolved(declared.clone()));
                value(view, one, declared.unwrap_or(DeclaredType::Unknown), found);
            }
        }
        _ => {}
    }
}

/// The initial value of a subrange, such as `INT(0..9) := 12`.
fn subrange(view: &View<'_>, declaration: &Declaration, found: &mut Vec<Diagnostic>) {
    let (Some(id), Some(index)) = (declaration.declared, declaration.initial) else { return };
    let TypeSpec::Subrange { least, greatest, .. } = view.tree.type_spec(id).value else { return };
    let Some(ValueKind::Constant(given)) = view.tree.values.get(index as usize).map(|record| record.kind)
    else {
        return;
    };
    let integer = |id| match view.tree.operand(id).value {
        Operand::Literal(literal) => match literal.value {
            LiteralValue::Integer(value) => Some(value),
            _ => None,
        },
        _ => None,
    };
    let (Some(least), Some(greatest), Some(value)) = (integer(least), integer(greatest), integer(given))
    else {
        return;
    };
    if value < least || value > greatest {
        let operand = view.tree.operand(given);
        let message = Message::new("constant-out-of-range.type")
            .with("word", operand.span.of(view.text))
            .with("type", view.tree.type_spec(id).span.of(view.text))
            .with("least", least)
            .with("greatest", greatest);
        found.push(Diagnostic::new("constant-out-of-range", operand.span, message));
    }
}
