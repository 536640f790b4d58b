//! What of a file can change the findings in the other files of its project.

use super::ProgramContext;
use super::statements::{StatementKind, is_fx_program};
use crate::document::{Access, Document, Exports, Symbol, Tree};
use crate::target::Flow;
use rustc_hash::{FxHashSet, FxHasher};
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

/// Labels, what the PLC does about the order of execution, and between them who reads and who drives what.
fn of_fx(document: &Document, hasher: &mut FxHasher) {
    let context = ProgramContext::new([(0, document)], None);
    let mut is_empty = true;
    let mut accesses = accesses(document).peekable();
    for statement in context.statements() {
        is_empty &= statement.flow() == Some(Flow::Nothing);
        let mut hash_before = |hasher: &mut FxHasher| {
            while let Some((_, name, access)) = accesses.next_if(|one| one.0 < statement.span.start as usize)
            {
                (&name.1, access.act, access.part, access.count).hash(hasher);
            }
        };
        match statement.kind {
            StatementKind::Label(device) => {
                hash_before(hasher);
                (true, device).hash(hasher);
            }
            StatementKind::Instruction(Flow::Nothing | Flow::Straight) | StatementKind::Unknown => {}
            StatementKind::Instruction(flow) => {
                hash_before(hasher);
                (flow, statement.text()).hash(hasher);
            }
        }
    }
    accesses.for_each(|(_, name, access)| (&name.1, access.act, access.part, access.count).hash(hasher));
    // Proofs go through the rungs of relays in other files.
    let circuits = document.pages().iter().flat_map(|page| page.circuits());
    circuits.for_each(|(_, circuit)| circuit.hash(hasher));
    is_empty.hash(hasher);
}

/// The accesses of all pages with their offsets in the document and what they name.
fn accesses(document: &Document) -> impl Iterator<Item = (usize, &(u32, Symbol), &Access)> {
    let mut end = 0;
    document.pages().iter().flat_map(move |page| {
        let start = end;
        end += page.bytes();
        let accesses = page.accesses();
        let at = move |access: &'_ Access| start + access.span.start as usize;
        accesses
            .all
            .iter()
            .filter_map(move |access| Some((at(access), accesses.names.get(access.name as usize)?, access)))
    })
}

/// What it declares for others, which shared names it uses and how, and what lies at an address.
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
    let mut pous = 0;
    for page in document.pages() {
        let accesses = page.accesses();
        // The chunks that read or drive what other files know.
        let mut circuits = FxHashSet::default();
        for access in &accesses.all {
            let Some((pou, symbol)) = accesses.names.get(access.name as usize) else { continue };
            let variable = match symbol {
                Symbol::Variable(name) => scopes.variable((pous + *pou as usize).checked_sub(1), name),
                _ => None,
            };
            let address = variable.and_then(|variable| variable.address);
            let is_global = variable.is_some_and(|variable| variable.section.is_global());
            if is_global || address.is_some() || matches!(symbol, Symbol::Direct(_)) {
                (symbol, address, access.act, access.part).hash(hasher);
                circuits.insert(access.chunk);
            }
        }
        let shared = page.circuits().filter(|(number, _)| circuits.contains(number));
        shared.for_each(|(_, circuit)| circuit.hash(hasher));
        pous += page.pou_starts();
    }
    for at in document.chunks().filter(|at| at.chunk.is_iec()) {
        let Tree::Iec(tree) = at.chunk.tree() else { continue };
        for declaration in tree.declarations.iter().filter(|declaration| declaration.address.is_some()) {
            declaration.span.of(at.chunk.text()).hash(hasher);
        }
    }
}
