//! What of a file can change the findings in the other files of its project.

use super::ProgramContext;
use super::statements::{StatementKind, is_fx_program};
use crate::document::{Document, Exports, Symbol, Tree};
use crate::target::Flow;
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// Differs whenever the rules about whole programs may find something else in the other files. Places do not count:
/// a line that is inserted changes nothing elsewhere.
pub fn surface(document: &Document) -> u64 {
    let mut hasher = FxHasher::default();
    if is_fx_program(document) {
        of_fx(document, &mut hasher);
    } else {
        of_iec(document, &mut hasher);
    }
    hasher.finish()
}

/// Labels, and what the PLC does about the order of execution.
fn of_fx(document: &Document, hasher: &mut FxHasher) {
    let context = ProgramContext::new([(0, document)], None);
    let mut is_empty = true;
    for statement in context.statements() {
        is_empty &= statement.flow() == Some(Flow::Nothing);
        match statement.kind {
            StatementKind::Label(device) => (true, device).hash(hasher),
            StatementKind::Instruction(Flow::Nothing | Flow::Straight) | StatementKind::Unknown => {}
            StatementKind::Instruction(flow) => (flow, statement.text()).hash(hasher),
        }
    }
    is_empty.hash(hasher);
}

/// What it declares for others, which shared names it uses, and what lies at an address.
fn of_iec(document: &Document, hasher: &mut FxHasher) {
    let scopes = document.scopes();
    Exports::of(document).key.hash(hasher);
    for page in document.pages() {
        for (symbol, _) in page.names().symbols() {
            let is_shared = match symbol {
                Symbol::Variable(name) => scopes.globals.contains_key(name),
                Symbol::Pou(_) | Symbol::Type(_) => true,
                _ => false,
            };
            if is_shared {
                symbol.hash(hasher);
            }
        }
    }
    for at in document.chunks().filter(|at| at.chunk.is_iec()) {
        let Tree::Iec(tree) = at.chunk.tree() else { continue };
        for declaration in tree.declarations.iter().filter(|declaration| declaration.address.is_some()) {
            declaration.span.of(at.chunk.text()).hash(hasher);
        }
    }
}
