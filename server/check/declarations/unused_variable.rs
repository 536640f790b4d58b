//! # unused-variable
//!
//! A variable is declared and never named again in its program unit, or a global one in no file of the project. Either
//! it is left over, or the name that should have been used is another one: an interlock that was declared and then
//! forgotten is worth a look.
//!
//! Variables with an address are left out, because a list of the terminals is useful by itself; so are units
//! without instructions.
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Guard : BOOL;
//!     ^^^^^
//! END_VAR
//!     LD Start
//!     ST Motor
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Saw
//! VAR
//!     Start AT %IX0.0 : BOOL;
//!     Motor AT %QX0.0 : BOOL;
//!     Guard : BOOL;
//! END_VAR
//!     LD Start
//!     AND Guard
//!     ST Motor
//! END_PROGRAM
//! ```

use super::removal;
use crate::check::{ProgramContext, Rule, Run};
use crate::document::{ChunkRef, Document, Symbol, Use};
use crate::il::iec::{IecTree, ItemKind, SectionKind};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit, folded};
use rustc_hash::FxHashSet;

pub(super) const RULE: Rule = Rule {
    code: "unused-variable",
    severity: Severity::Hint,
    run: Run::Program(check),
    source: include_str!("unused_variable.rs"),
};

/// A name that is declared, perhaps the only one of its declaration.
struct Declared<'a> {
    name: &'a str,
    span: Span,
    removal: Option<TextEdit>,
}

#[derive(Default)]
struct Unit<'a> {
    declared: Vec<Declared<'a>>,
    used: FxHashSet<&'a str>,
    has_body: bool,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let declares_nothing = |document: &Document| {
        let scopes = document.scopes();
        scopes.pous.is_empty() && scopes.globals.is_empty()
    };
    if context.files().iter().all(|file| declares_nothing(file.document)) {
        return;
    }
    let mut unit = Unit::default();
    let mut globals = Unit::default();
    for file in context.files() {
        for at in file.chunks() {
            if at.chunk.pou_starts() > 0 {
                std::mem::take(&mut unit).report(found);
            }
            match at.chunk.iec() {
                Some(tree) => {
                    unit.has_body |= tree.items.iter().any(|item| is_instruction(&item.kind));
                    sections(at, tree, &mut unit, &mut globals);
                }
                None => unit.has_body = true,
            }
            for mention in at.chunk.mentions() {
                if let Symbol::Variable(name) = &mention.symbol
                    && mention.usage != Use::Declare
                {
                    unit.used.insert(name);
                    globals.used.insert(name);
                }
            }
        }
        std::mem::take(&mut unit).report(found);
        // A file of globals alone is used by other files.
        globals.has_body |= !file.document.scopes().own_pous().is_empty();
    }
    globals.report(found);
}

fn is_instruction(kind: &ItemKind) -> bool {
    matches!(
        kind,
        ItemKind::Operation { .. }
            | ItemKind::Open { .. }
            | ItemKind::Call { .. }
            | ItemKind::Function { .. }
            | ItemKind::InputOperator { .. }
            | ItemKind::Jump { .. }
            | ItemKind::Return { .. }
    )
}

fn sections<'a>(at: ChunkRef<'a>, tree: &'a IecTree, unit: &mut Unit<'a>, globals: &mut Unit<'a>) {
    let text = at.chunk.text();
    for item in &tree.items {
        let ItemKind::Section { kind, declarations, .. } = item.kind else { continue };
        for declaration in declarations.of(&tree.declarations).iter().filter(|one| one.address.is_none()) {
            let names = declaration.names.of(&tree.names);
            for name in names {
                let removal = if names.len() == 1 { removal(text, declaration, at.start) } else { None };
                let declared = Declared { name: name.of(text), span: name.shifted(at.start), removal };
                match kind {
                    SectionKind::Global => globals.declared.push(declared),
                    SectionKind::Access | SectionKind::Config => {}
                    // An import counts as a use of the global variable.
                    _ => unit.declared.push(declared),
                }
            }
        }
    }
}

impl Unit<'_> {
    fn report(self, found: &mut Vec<Diagnostic>) {
        if !self.has_body {
            return;
        }
        for declared in self.declared {
            if self.used.contains(folded(declared.name).as_str()) {
                continue;
            }
            let message = Message::new("unused-variable.found").with("name", declared.name);
            let diagnostic = Diagnostic::new(RULE.code, declared.span, message);
            found.push(match declared.removal {
                Some(edit) => diagnostic.fix(Message::new("unused-variable.remove"), vec![edit]),
                None => diagnostic,
            });
        }
    }
}
