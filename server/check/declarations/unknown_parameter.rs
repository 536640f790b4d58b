//! # unknown-parameter
//!
//! A call gives a parameter that the function or block does not have, or reads a member that it lacks. Names are
//! those of the declaration: a timer has the inputs `IN` and `PT` and the outputs `Q` and `ET`. Inputs are given with
//! `:=` and outputs taken with `=>`; in a list without names the order of the declaration counts, inputs first. The box
//! of a drawing has its inputs on the left side and its outputs on the right.
//!
//! ```iec
//! PROGRAM Oven
//! VAR
//!     Hot : BOOL;
//!     Delay : TON;
//! END_VAR
//!     CAL Delay(
//!         IN := Hot,
//!         PRESET := T#5s
//!         ^^^^^^
//!     )
//!     LD Delay.QQ
//!              ^^
//!     ST Hot
//!     CU Delay
//!     ^^
//! END_PROGRAM
//! ```
//!
//! ```lad iec
//! |                Delay                |
//! |             +---------+             |
//! |   Hot       |   TON   |       Late  |
//! +---| |-------|IN      Q|-------( )---+
//! |      T#5s---|TP       |             |
//!                ^^
//! |             +---------+             |
//! ```
//!
//! An output that is given as if it were an input:
//!
//! ```iec
//! PROGRAM Oven
//! VAR
//!     Hot, Late : BOOL;
//!     Delay : TON;
//! END_VAR
//!     CAL Delay(
//!         IN := Hot,
//!         PT := T#5s,
//!         Q := Late
//!         ^
//!     )
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Oven
//! VAR
//!     Hot, Late : BOOL;
//!     Delay : TON;
//! END_VAR
//!     CAL Delay(
//!         IN := Hot,
//!         PT := T#5s,
//!         Q => Late
//!     )
//!     LD Delay.Q
//!     ST Hot
//! END_PROGRAM
//! ```

use crate::check::iec::{Callee, Flow, Pin, Place, ValueType, View};
use crate::check::{ChunkContext, Rule, Run};
use crate::document::DeclaredType;
use crate::il::iec::{Direction, ItemKind, ListForm, OperandId, Parameter, PouKind, Run as Records};
use crate::target::Operand;
use crate::target::iec::nearest;
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "unknown-parameter",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("unknown_parameter.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some(view) = View::of(context) else { return super::boxes::parameters(context, found) };
    for item in &view.tree.items {
        match item.kind {
            ItemKind::Call { callee: Some(id), form, parameters, .. } => {
                let callee = match view.value(id) {
                    ValueType::Instance(block) => Callee::block(&view, &block),
                    _ => Callee::function(&view, view.word(id)),
                };
                if let Some(callee) = callee {
                    list(&view, callee, form, parameters, found);
                }
            }
            ItemKind::Function { name, form, parameters } => {
                if let Some(callee) = Callee::function(&view, name.of(view.text)) {
                    list(&view, callee, form, parameters, found);
                }
            }
            ItemKind::InputOperator { input, instance } => {
                if let ValueType::Instance(block) = view.value(instance)
                    && let Some(block) = Callee::block(&view, &block)
                {
                    let pin = block.pin_named(&view, input.of(view.text));
                    if pin.is_none_or(|pin| pin.flow == Flow::Out) {
                        found.push(unknown(&view, block, input, Flow::In));
                    }
                }
            }
            // A program that a configuration runs, with what it is connected to.
            ItemKind::Instance(index) => {
                if let Some(instance) = view.tree.instances.get(index as usize)
                    && let Some(program) = instance.program
                    && let Some(pou) = view.scopes.pou_named(program.of(view.text))
                    && pou.kind == PouKind::Program
                {
                    list(&view, Callee::Declared(pou), ListForm::Formal, instance.parameters, found);
                }
            }
            _ => {}
        }
    }
    for (index, operand) in view.tree.operands.iter().enumerate() {
        if operand.value == Operand::Variable
            && operand.span.of(view.text).contains('.')
            && let Place::NoMember { member, owner } = view.place(OperandId(index as u32))
        {
            found.push(no_member(&view, member, &owner));
        }
    }
}

fn list(
    view: &View<'_>,
    callee: Callee<'_>,
    form: ListForm,
    parameters: Records,
    found: &mut Vec<Diagnostic>,
) {
    let parameters = parameters.of(&view.tree.parameters);
    if form == ListForm::Formal {
        found.extend(parameters.iter().filter_map(|parameter| named(view, callee, parameter)));
    } else if !matches!(callee, Callee::Function(_)) {
        // Too many operands of a function are the matter of `operand-count`.
        let is_block = callee.result(view) == crate::check::iec::Expected::Unknown;
        let most = callee.pins(view).len();
        if let (true, Some(surplus)) = (is_block, parameters.get(most)) {
            let message =
                Message::new("unknown-parameter.too-many").with("name", callee.name()).with("count", most);
            let last = parameters.last().unwrap_or(surplus);
            found.push(Diagnostic::new(RULE.code, surplus.span.to(last.span), message));
        }
    }
}

fn named(view: &View<'_>, callee: Callee<'_>, parameter: &Parameter) -> Option<Diagnostic> {
    let name = parameter.name?;
    let is_output = matches!(parameter.direction, Direction::Out { .. });
    let Some(pin) = callee.pin_named(view, name.of(view.text)) else {
        return Some(unknown(view, callee, name, if is_output { Flow::Out } else { Flow::In }));
    };
    let key = match (is_output, pin.flow) {
        (false, Flow::Out) => "unknown-parameter.is-output",
        (true, Flow::In | Flow::InOut) => "unknown-parameter.is-input",
        _ => return None,
    };
    let message = Message::new(key).with("pin", pin.name).with("name", callee.name());
    Some(with_sign(Diagnostic::new(RULE.code, name, message), view, parameter, name))
}

/// Offers the other sign between name and value.
fn with_sign(diagnostic: Diagnostic, view: &View<'_>, parameter: &Parameter, name: Span) -> Diagnostic {
    let (from, to) = match parameter.direction {
        Direction::In => (":=", "=>"),
        Direction::Out { negated: false } => ("=>", ":="),
        Direction::Out { negated: true } => return diagnostic,
    };
    let end = name.end as usize;
    let rest = view.text.get(end..parameter.span.end as usize).unwrap_or("");
    let Some(offset) = rest.find(from) else { return diagnostic };
    let sign = Span::new(end + offset, end + offset + 2);
    diagnostic.fix(Message::new("unknown-parameter.sign").with("sign", to), vec![TextEdit::new(sign, to)])
}

fn unknown(view: &View<'_>, callee: Callee<'_>, name: Span, flow: Flow) -> Diagnostic {
    let pins = callee.pins(view);
    let same_flow = |pin: &&Pin<'_>| (pin.flow == Flow::Out) == (flow == Flow::Out);
    let names: Vec<&str> = pins.iter().filter(same_flow).map(|pin| pin.name).collect();
    let key = match (flow == Flow::Out, names.is_empty()) {
        (true, false) => "unknown-parameter.no-output",
        (false, false) => "unknown-parameter.no-input",
        (true, true) => "unknown-parameter.no-outputs",
        (false, true) => "unknown-parameter.no-inputs",
    };
    let message = Message::new(key)
        .with("word", name.of(view.text))
        .with("name", callee.name())
        .with("names", names.join(", "));
    with_names(Diagnostic::new(RULE.code, name, message), view.text, name, names.into_iter())
}

fn no_member(view: &View<'_>, member: Span, owner: &DeclaredType) -> Diagnostic {
    let word = member.of(view.text);
    let names: Vec<String> = match owner {
        DeclaredType::Structure(fields) => fields.iter().map(|(name, _)| name.to_string()).collect(),
        DeclaredType::Named(block) => {
            let pins = Callee::block(view, block).map(|block| block.pins(view)).unwrap_or_default();
            pins.iter().map(|pin| pin.name.to_string()).collect()
        }
        _ => Vec::new(),
    };
    let title = match owner {
        DeclaredType::Named(block) => Callee::block(view, block).map_or("", |block| block.name()),
        _ => "STRUCT",
    };
    let message = Message::new("unknown-parameter.no-member")
        .with("word", word)
        .with("name", title)
        .with("names", names.join(", "));
    let diagnostic = Diagnostic::new(RULE.code, member, message);
    with_names(diagnostic, view.text, member, names.iter().map(String::as_str))
}

pub(super) fn with_names<'n>(
    mut diagnostic: Diagnostic,
    text: &str,
    span: Span,
    names: impl Iterator<Item = &'n str>,
) -> Diagnostic {
    for name in nearest(span.of(text), names) {
        let title = Message::new("unknown-parameter.replace").with("name", &name);
        diagnostic = diagnostic.fix(title, vec![TextEdit::new(span, name)]);
    }
    diagnostic
}
