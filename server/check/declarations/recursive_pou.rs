//! # recursive-pou
//!
//! A function calls itself, or a function block contains an instance of itself, directly or by way of others. The
//! standard forbids it: the memory of a controller is laid out before it runs, and a block inside itself would need
//! memory without end.
//!
//! ```iec
//! FUNCTION Power : INT
//! VAR_INPUT
//!     Base, Exponent : INT;
//! END_VAR
//!     LD Base
//!     Power Exponent
//!     ^^^^^
//!     ST Power
//! END_FUNCTION
//! ```
//!
//! ```iec
//! FUNCTION Power : INT
//! VAR_INPUT
//!     Base, Exponent : INT;
//! END_VAR
//!     LD 1
//!     ST Power
//! Next:
//!     LD Exponent
//!     LE 0
//!     RETC
//!     LD Power
//!     MUL Base
//!     ST Power
//! END_FUNCTION
//! ```
//!
//! Two blocks that contain each other:
//!
//! ```iec
//! FUNCTION_BLOCK Master
//! VAR
//!     Helper : Slave;
//! END_VAR
//!     CAL Helper
//! END_FUNCTION_BLOCK
//!
//! FUNCTION_BLOCK Slave
//! VAR
//!     Boss : Master;
//!            ^^^^^^
//! END_VAR
//!     CAL Boss
//! END_FUNCTION_BLOCK
//! ```

use crate::check::iec::{View, views_of};
use crate::check::{ProgramContext, ProgramFile, Rule, Run};
use crate::document::Pou;
use crate::il::iec::{ItemKind, PouKind, SectionKind, TypeSpec};
use crate::text::{Diagnostic, Message, Severity, Span, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::sync::Arc;

pub(super) const RULE: Rule = Rule {
    code: "recursive-pou",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("recursive_pou.rs"),
};

/// The POU that is used, and where.
type Edge = (usize, Span);

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let of_file = |file: &ProgramFile<'_>| file.document.scopes().own_pous().to_vec();
    let pous: Vec<Arc<Pou>> = context.files().iter().flat_map(of_file).collect();
    let mut numbers: FxHashMap<SmolStr, usize> = FxHashMap::default();
    for (number, pou) in pous.iter().enumerate() {
        numbers.entry(folded(&pou.name)).or_insert(number);
    }
    let mut uses: Vec<Vec<Edge>> = vec![Vec::new(); pous.len()];
    let mut first = 0;
    for file in context.files() {
        for (start, view) in views_of(*file) {
            let Some(own) = view.pou.and_then(|number| uses.get_mut(first + number)) else { continue };
            for (name, span) in used(&view) {
                if let Some(other) = numbers.get(&folded(name)) {
                    own.push((*other, span.shifted(start)));
                }
            }
        }
        first += file.document.scopes().own_pous().len();
    }
    find_cycles(&pous, &uses, found);
}

/// The function blocks and functions that a chunk contains or calls.
fn used<'a>(view: &View<'a>) -> Vec<(&'a str, Span)> {
    let mut used = Vec::new();
    let is = |name: &str, kind| view.scopes.pou_named(name).is_some_and(|pou| pou.kind == kind);
    for item in &view.tree.items {
        match item.kind {
            // What is passed by reference or lies elsewhere is not contained.
            ItemKind::Section { kind: SectionKind::InOut | SectionKind::External, .. } => {}
            ItemKind::Section { kind, declarations, .. } if kind != SectionKind::Global => {
                for declaration in declarations.of(&view.tree.declarations) {
                    let mut next = declaration.declared;
                    while let Some(id) = next.take() {
                        let written = view.tree.type_spec(id);
                        let name = written.span.of(view.text);
                        match written.value {
                            TypeSpec::Named if is(name, PouKind::FunctionBlock) => {
                                used.push((name, written.span))
                            }
                            TypeSpec::Array { element, .. } => next = Some(element),
                            _ => {}
                        }
                    }
                }
            }
            ItemKind::Function { name, .. } if is(name.of(view.text), PouKind::Function) => {
                used.push((name.of(view.text), name));
            }
            ItemKind::Call { callee: Some(id), .. } if is(view.word(id), PouKind::Function) => {
                used.push((view.word(id), view.tree.operand(id).span));
            }
            _ => {}
        }
    }
    used
}

/// Goes through the uses depth first, without the stack of the machine: chains of POUs may be long.
fn find_cycles(pous: &[Arc<Pou>], uses: &[Vec<Edge>], found: &mut Vec<Diagnostic>) {
    let mut done = vec![false; uses.len()];
    // For each POU on the path its place there, and the number of its next edge.
    let mut place: Vec<Option<usize>> = vec![None; uses.len()];
    for first in 0..uses.len() {
        if done[first] {
            continue;
        }
        let mut path = vec![(first, 0usize)];
        place[first] = Some(0);
        while let Some((pou, next)) = path.last_mut() {
            let pou = *pou;
            let Some((other, span)) = uses[pou].get(*next).copied() else {
                done[pou] = true;
                place[pou] = None;
                path.pop();
                continue;
            };
            *next += 1;
            match place[other] {
                Some(from) => found.push(cycle(pous, uses, &path[from..], other, span)),
                None if !done[other] => {
                    place[other] = Some(path.len());
                    path.push((other, 0));
                }
                None => {}
            }
        }
    }
}

fn cycle(
    pous: &[Arc<Pou>],
    uses: &[Vec<Edge>],
    path: &[(usize, usize)],
    back_to: usize,
    span: Span,
) -> Diagnostic {
    let names = path.iter().map(|(pou, _)| *pou).chain([back_to]);
    let names: Vec<&str> = names.filter_map(|pou| pous.get(pou)).map(|pou| pou.name.as_str()).collect();
    let is_function = pous.get(back_to).is_some_and(|pou| pou.kind == PouKind::Function);
    let key = if is_function { "recursive-pou.calls" } else { "recursive-pou.contains" };
    let message = Message::new(key).with("name", names.last().unwrap_or(&"")).with("path", names.join(" → "));
    let mut diagnostic = Diagnostic::new(RULE.code, span, message);
    // The edge that was followed is the one before the next.
    let followed = path.iter().take(path.len().saturating_sub(1));
    for (_, at) in followed.filter_map(|(pou, next)| uses.get(*pou)?.get(next.checked_sub(1)?)) {
        diagnostic = diagnostic.related(*at, Message::new("recursive-pou.by-way-of"));
    }
    diagnostic
}
