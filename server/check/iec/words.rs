//! What is written in an instruction: unknown words, numbers of operands, words that are no operand.

use super::{Callee, View, out_of_range};
use crate::document::DeclaredType;
use crate::il::iec::{Item, ItemKind, ListForm, Parameter, PouKind};
use crate::target::iec::{
    ElementaryType, FunctionBlock, Literal, LiteralProblem, LiteralValue, OperatorRole, nearest, suggestions,
};
use crate::target::{Operand, OperandProblem};
use crate::text::{Diagnostic, Message, Span, TextEdit, folded};
use smol_str::SmolStr;

/// Words at the place of an instruction that are none: the IEC part of `unknown-instruction`.
pub fn unknown_instructions(view: &View<'_>, found: &mut Vec<Diagnostic>) {
    for item in &view.tree.items {
        let ItemKind::Function { name, parameters, .. } = item.kind else { continue };
        let word = name.of(view.text);
        if Callee::function(view, word).is_some() || view.has_problem_at(name) {
            continue;
        }
        // Methods of instances are an addition of the third edition that nothing is known about.
        let root = word.split('.').next().unwrap_or(word);
        let is_variable = view.scopes.variable(view.pou, root).is_some();
        if word.contains('.') && is_variable {
            continue;
        }
        let is_unit = view.scopes.pou_named(word).is_some_and(|pou| pou.kind != PouKind::Function);
        let key = match () {
            () if is_variable => "unknown-instruction.variable",
            () if is_unit || FunctionBlock::named(word).is_some() => "unknown-instruction.block",
            () => {
                found.push(unknown(view, name));
                continue;
            }
        };
        let diagnostic = Diagnostic::new("unknown-instruction", name, Message::new(key).with("word", word));
        found.push(match is_variable && parameters.is_empty() {
            true => {
                let title = Message::new("unknown-instruction.load").with("word", word);
                diagnostic.fix(title, vec![TextEdit::new(Span::at(name.start as usize), "LD ")])
            }
            false => diagnostic,
        });
    }
}

fn unknown(view: &View<'_>, name: Span) -> Diagnostic {
    let word = name.of(view.text);
    let functions = view.scopes.pous.iter().filter(|pou| pou.kind == PouKind::Function);
    let near = suggestions(word, functions.map(|pou| pou.name.as_str()));
    let key = if near.is_empty() { "unknown-instruction.iec" } else { "unknown-instruction.iec-near" };
    let message = Message::new(key).with("word", word).with("near", near.join(", "));
    let mut diagnostic = Diagnostic::new("unknown-instruction", name, message);
    let lower = word.bytes().any(|byte| byte.is_ascii_lowercase());
    for other in near {
        let other = if lower { other.to_ascii_lowercase() } else { other };
        let title = Message::new("unknown-instruction.replace").with("mnemonic", &other);
        diagnostic = diagnostic.fix(title, vec![TextEdit::new(name, other)]);
    }
    diagnostic
}

/// Missing and surplus operands of operators and functions: the IEC part of `operand-count`.
pub fn operand_counts(view: &View<'_>, found: &mut Vec<Diagnostic>) {
    for item in &view.tree.items {
        match item.kind {
            ItemKind::Operation { operation, operand } => match (operation.operator.role, operand) {
                (OperatorRole::Complement, Some(id)) => {
                    let word = view.word(id);
                    let message = Message::new("operand-count.not").with("word", word);
                    let title = Message::new("operand-count.load-negated").with("word", word);
                    let diagnostic = Diagnostic::new("operand-count", view.tree.operand(id).span, message);
                    found.push(diagnostic.fix(title, vec![TextEdit::new(operation.word, "LDN")]));
                }
                (OperatorRole::Complement, None) | (_, Some(_)) => {}
                (_, None) if view.has_problem(item.span) => {}
                (_, None) => {
                    let message =
                        Message::new("operand-count.lacks").with("operator", view.operator(operation));
                    found.push(Diagnostic::new("operand-count", operation.word, message));
                }
            },
            ItemKind::Function { name, form, parameters } if form != ListForm::Formal => {
                found.extend(function(view, item, name, form, parameters.of(&view.tree.parameters)));
            }
            _ => {}
        }
    }
}

fn function(
    view: &View<'_>,
    item: &Item,
    name: Span,
    form: ListForm,
    parameters: &[Parameter],
) -> Option<Diagnostic> {
    let callee = Callee::function(view, name.of(view.text))?;
    let (inputs, extensible) = callee.inputs();
    let takes_current = form == ListForm::None && inputs > 0;
    let wanted = inputs - usize::from(takes_current);
    let pins: Vec<&str> =
        callee.pins(view).iter().skip(usize::from(takes_current)).map(|pin| pin.name).collect();
    let message = |key| {
        let message = Message::new(key).with("function", callee.name()).with("inputs", pins.join(", "));
        message.with("count", wanted)
    };
    if parameters.len() < wanted {
        let key = if takes_current { "operand-count.few" } else { "operand-count.few-listed" };
        let no_problem = !view.has_problem(item.span);
        return no_problem.then(|| Diagnostic::new("operand-count", name, message(key)));
    }
    let surplus = parameters.get(wanted).filter(|_| !extensible)?;
    let last = parameters.last().unwrap_or(surplus);
    let key = match (takes_current, wanted) {
        (true, 0) => "operand-count.current-alone",
        (true, _) => "operand-count.many",
        (false, _) => "operand-count.many-listed",
    };
    let diagnostic = Diagnostic::new("operand-count", surplus.span.to(last.span), message(key));
    if !takes_current || parameters.len() != inputs {
        return Some(diagnostic);
    }
    // Whoever writes all inputs behind the name means the first one to be loaded.
    let words: Vec<&str> = parameters.iter().map(|parameter| parameter.span.of(view.text)).collect();
    let (first, others) = words.split_first()?;
    let blank = if others.is_empty() { "" } else { " " };
    let (indent, function) = (view.indentation(name.start), name.of(view.text));
    let mended = format!("LD {first}\n{indent}{function}{blank}{}", others.join(", "));
    let title = Message::new("operand-count.load-first").with("word", first);
    Some(diagnostic.fix(title, vec![TextEdit::new(item.span, mended)]))
}

/// Constants and addresses that cannot be read: the IEC part of `malformed-literal`, and of `constant-out-of-range`
/// where a constant names a type that is too small for it.
pub fn unreadable_operands(view: &View<'_>, found: &mut Vec<Diagnostic>) {
    for operand in view.tree.operands.iter().filter(|operand| !view.has_problem_at(operand.span)) {
        let word = operand.span.of(view.text);
        let key = match operand.value {
            Operand::Invalid(OperandProblem::MalformedLiteral(LiteralProblem::Range)) => {
                let kind = word.split('#').next().and_then(ElementaryType::named);
                found.extend(kind.map(|kind| out_of_range(operand.span, word, kind)));
                continue;
            }
            Operand::Invalid(OperandProblem::MalformedLiteral(problem)) => key_of(problem),
            Operand::Invalid(OperandProblem::MalformedAddress) => "malformed-literal.address",
            Operand::Invalid(OperandProblem::Unreadable) => "malformed-literal.form",
            _ => continue,
        };
        let message = Message::new(key).with("word", word);
        let diagnostic = Diagnostic::new("malformed-literal", operand.span, message);
        found.push(match mended(word) {
            Some(other) => {
                let title = Message::new("malformed-literal.replace").with("word", &other);
                diagnostic.fix(title, vec![TextEdit::new(operand.span, other)])
            }
            None => diagnostic,
        });
    }
}

fn key_of(problem: LiteralProblem) -> &'static str {
    match problem {
        LiteralProblem::Digit => "malformed-literal.digit",
        LiteralProblem::Base => "malformed-literal.base",
        LiteralProblem::Underscore => "malformed-literal.underscore",
        LiteralProblem::RealForm => "malformed-literal.real-form",
        LiteralProblem::Sign => "malformed-literal.sign",
        LiteralProblem::DurationForm => "malformed-literal.duration-form",
        LiteralProblem::DurationOverflow => "malformed-literal.duration-overflow",
        LiteralProblem::DateForm => "malformed-literal.date-form",
        LiteralProblem::NoSuchDate => "malformed-literal.no-such-date",
        LiteralProblem::Type => "malformed-literal.type",
        LiteralProblem::Range | LiteralProblem::Form => "malformed-literal.form",
        LiteralProblem::Text => "malformed-literal.text",
    }
}

/// A real number with the digit that the standard wants: `0.5` for `.5`, `1.0E3` for `1E3`.
fn mended(word: &str) -> Option<String> {
    let (sign, digits) = match word.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", word),
    };
    let candidate = match digits.find(['e', 'E']) {
        _ if digits.starts_with('.') => format!("{sign}0{digits}"),
        Some(exponent) if !digits.contains('.') => {
            format!("{sign}{}.0{}", &digits[..exponent], &digits[exponent..])
        }
        _ => return None,
    };
    matches!(Operand::read(&candidate, crate::target::Model::Iec), Operand::Literal(_)).then_some(candidate)
}

/// Reserved words and broken names in the place of an operand: a part of `operand-kind`.
pub fn misplaced_words(view: &View<'_>, found: &mut Vec<Diagnostic>) {
    for operand in view.tree.operands.iter().filter(|operand| !view.has_problem_at(operand.span)) {
        let word = operand.span.of(view.text);
        let key = match operand.value {
            Operand::Invalid(OperandProblem::Keyword) => "operand-kind.keyword",
            Operand::Invalid(OperandProblem::MalformedName) => {
                // A broken name is reported where it is declared.
                let root = word.split(['.', '[', '^']).next().unwrap_or(word);
                if view.scopes.variable(view.pou, &folded(root)).is_some() && root == word {
                    continue;
                }
                "operand-kind.name"
            }
            _ => continue,
        };
        found.push(Diagnostic::new("operand-kind", operand.span, Message::new(key).with("word", word)));
    }
}

/// Values that their enumerated type does not have, as `Mode#Runing`: a part of `operand-kind`.
pub fn unknown_values(view: &View<'_>, found: &mut Vec<Diagnostic>) {
    let is_value = |literal: &Literal| literal.value == LiteralValue::Enumerated;
    for operand in &view.tree.operands {
        if !matches!(&operand.value, Operand::Literal(literal) if is_value(literal)) {
            continue;
        }
        let Some((of, value)) = operand.span.of(view.text).split_once('#') else { continue };
        let Some(DeclaredType::Enumeration(values)) = view.scopes.resolved(DeclaredType::Named(folded(of)))
        else {
            continue;
        };
        if values.contains(&folded(value)) {
            continue;
        }
        let message = Message::new("operand-kind.value").with("value", value).with("type", of);
        let mut diagnostic =
            Diagnostic::new("operand-kind", operand.span, message.with("values", values.join(", ")));
        for near in nearest(value, values.iter().map(SmolStr::as_str)) {
            let word = format!("{of}#{near}");
            let title = Message::new("operand-kind.write").with("word", &word);
            diagnostic = diagnostic.fix(title, vec![TextEdit::new(operand.span, word)]);
        }
        found.push(diagnostic);
    }
}
