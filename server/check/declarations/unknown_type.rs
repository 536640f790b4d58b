//! # unknown-type
//!
//! A declaration names a type that exists nowhere: no elementary type, no type of a `TYPE` block, no function block.
//! Nothing is known of a variable of such a type, neither its size nor its members, so no controller takes the
//! program. A `PROGRAM` in a configuration names a program in the same way.
//!
//! Often a letter is missing, or the name is another maker's: the standard says `WORD` and `INT`, not `WORD16`.
//!
//! ```iec
//! PROGRAM Lift
//! VAR
//!     Delay : TONN;
//!             ^^^^
//!     Floor : INTEGER;
//!             ^^^^^^^
//! END_VAR
//!     LD Floor
//! END_PROGRAM
//! ```
//!
//! ```iec
//! TYPE
//!     Speed : INT(0..1500);
//! END_TYPE
//!
//! PROGRAM Lift
//! VAR
//!     Delay : TON;
//!     Floor : INT;
//!     Motor : Speed;
//! END_VAR
//!     LD Floor
//!     ST Motor
//! END_PROGRAM
//! ```

use crate::check::iec::View;
use crate::check::{ChunkContext, Rule, Run};
use crate::il::iec::{ItemKind, PouKind, TypeSpec};
use crate::target::iec::{ElementaryType, FunctionBlock, nearest};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "unknown-type",
    severity: Severity::Error,
    run: Run::Chunk(check),
    source: include_str!("unknown_type.rs"),
};

fn check(context: &ChunkContext<'_>, found: &mut Vec<Diagnostic>) {
    let Some(view) = View::of(context) else { return };
    for written in view.tree.types.iter().filter(|written| written.value == TypeSpec::Named) {
        let name = written.span.of(view.text);
        // Names with a path come from libraries that are not part of the document.
        if name.contains(['.', ' ']) || crate::target::iec::is_keyword(name) {
            continue;
        }
        match view.scopes.pou_named(name).map(|pou| pou.kind) {
            Some(PouKind::FunctionBlock) => continue,
            Some(kind) => {
                let key = match kind {
                    PouKind::Program => "unknown-type.program",
                    _ => "unknown-type.function",
                };
                found.push(Diagnostic::new(RULE.code, written.span, Message::new(key).with("name", name)));
            }
            None if FunctionBlock::named(name).is_some() || view.scopes.is_type(name) => {}
            None => found.push(unknown(&view, written.span)),
        }
    }
    for item in &view.tree.items {
        if let ItemKind::Instance(index) = item.kind
            && let Some(span) = view.tree.instances.get(index as usize).and_then(|instance| instance.program)
        {
            let name = span.of(view.text);
            let is_program = view.scopes.pou_named(name).is_some_and(|pou| pou.kind == PouKind::Program);
            if !is_program {
                let message = Message::new("unknown-type.no-program").with("name", name);
                let programs = view.scopes.pous.iter().filter(|pou| pou.kind == PouKind::Program);
                let near = nearest(name, programs.map(|pou| pou.name.as_str()));
                found.push(with_names(Diagnostic::new(RULE.code, span, message), span, near));
            }
        }
    }
}

fn unknown(view: &View<'_>, span: Span) -> Diagnostic {
    let name = span.of(view.text);
    let blocks = view.scopes.pous.iter().filter(|pou| pou.kind == PouKind::FunctionBlock);
    let known = ElementaryType::ALL.iter().map(|kind| kind.name());
    let known = known.chain(FunctionBlock::all().map(|block| block.name));
    let known = known.chain(blocks.map(|pou| pou.name.as_str())).chain(view.scopes.type_names());
    let mut near = nearest(name, known);
    if let Some(ours) = elsewhere(name) {
        near.insert(0, ours.to_string());
    }
    let message = Message::new("unknown-type.found").with("name", name);
    with_names(Diagnostic::new(RULE.code, span, message), span, near)
}

fn with_names(mut diagnostic: Diagnostic, span: Span, near: Vec<String>) -> Diagnostic {
    for name in near {
        let title = Message::new("unknown-type.replace").with("name", &name);
        diagnostic = diagnostic.fix(title, vec![TextEdit::new(span, name)]);
    }
    diagnostic
}

/// What the standard calls the types of other languages.
fn elsewhere(name: &str) -> Option<&'static str> {
    const NAMES: &[(&str, &str)] = &[
        ("BOOLEAN", "BOOL"),
        ("BIT", "BOOL"),
        ("INTEGER", "INT"),
        ("INT16", "INT"),
        ("INT32", "DINT"),
        ("LONG", "DINT"),
        ("UINT16", "UINT"),
        ("UINT32", "UDINT"),
        ("FLOAT", "REAL"),
        ("DOUBLE", "LREAL"),
        ("S5TIME", "TIME"),
        ("TIMER", "TON"),
        ("COUNTER", "CTU"),
    ];
    NAMES.iter().find(|(other, _)| other.eq_ignore_ascii_case(name)).map(|(_, ours)| *ours)
}
