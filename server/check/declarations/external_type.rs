//! # external-type
//!
//! A program unit takes in a global variable with `VAR_EXTERNAL` and gives it another type than its `VAR_GLOBAL` does.
//! There is only one variable: some compilers refuse the program, others read the same memory as two types. What is
//! 40,000 as a `UINT` is negative as an `INT`, and a longer type reads what belongs to the variable behind it.
//!
//! Two names of one type are the same, subranges with other limits are not. The fix writes the type of the
//! `VAR_GLOBAL`, which may stand in another file of the project.
//!
//! ```iec
//! VAR_GLOBAL
//!     Level : UINT;
//! END_VAR
//! PROGRAM Tank
//! VAR_EXTERNAL
//!     Level : INT;
//!             ^^^
//! END_VAR
//! VAR
//!     Full AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Level
//!     GT 30000
//!     ST Full
//! END_PROGRAM
//! ```
//!
//! ```iec
//! VAR_GLOBAL
//!     Level : UINT;
//! END_VAR
//! PROGRAM Tank
//! VAR_EXTERNAL
//!     Level : UINT;
//! END_VAR
//! VAR
//!     Full AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Level
//!     GT 30000
//!     ST Full
//! END_PROGRAM
//! ```

use crate::check::iec::{View, views_of};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::{DeclaredType, Scopes};
use crate::il::iec::{ItemKind, SectionKind, TypeId, words};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

pub(super) const RULE: Rule = Rule {
    code: "external-type",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("external_type.rs"),
};

/// A variable with its type.
struct Declared<'v> {
    name: Span,
    kind: Span,
    id: TypeId,
    start: usize,
    view: View<'v>,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut globals: FxHashMap<SmolStr, Declared<'_>> = FxHashMap::default();
    let mut externals: Vec<Declared<'_>> = Vec::new();
    for file in context.files() {
        for (start, view) in views_of(*file) {
            for item in &view.tree.items {
                let ItemKind::Section { kind, declarations, .. } = item.kind else { continue };
                if !matches!(kind, SectionKind::Global | SectionKind::External) {
                    continue;
                }
                for declaration in declarations.of(&view.tree.declarations) {
                    let Some(id) = declaration.declared else { continue };
                    let type_span = view.tree.type_spec(id).span;
                    for name in declaration.names.of(&view.tree.names) {
                        let one = Declared { name: *name, kind: type_span, id, start, view };
                        match kind {
                            SectionKind::Global => _ = globals.entry(one.key()).or_insert(one),
                            _ => externals.push(one),
                        }
                    }
                }
            }
        }
    }
    for external in externals {
        if let Some(global) = globals.get(&external.key()).filter(|global| !external.is_of_type(global)) {
            found.push(external.judged(global));
        }
    }
}

impl Declared<'_> {
    fn key(&self) -> SmolStr {
        folded(self.name.of(self.view.text))
    }

    /// Whether both are of one type, however it is written. What cannot be read is another rule's.
    fn is_of_type(&self, other: &Declared<'_>) -> bool {
        let [own, theirs] = [self, other].map(|one| {
            let View { text, tree, scopes, .. } = one.view;
            unnamed(DeclaredType::of(text, tree, one.id), scopes)
        });
        let is_open = |declared: &DeclaredType| matches!(declared, DeclaredType::Unknown);
        let [own_words, other_words] = [self, other].map(|one| words(one.view.text, one.kind));
        // The limits of an array are in its words alone.
        let is_array = matches!(own, DeclaredType::Array(_));
        is_open(&own) || is_open(&theirs) || own_words == other_words || own == theirs && !is_array
    }

    fn judged(&self, global: &Declared<'_>) -> Diagnostic {
        let kind = global.kind.of(global.view.text);
        let message = Message::new("external-type.found")
            .with("name", self.name.of(self.view.text))
            .with("own", self.kind.of(self.view.text))
            .with("global", kind);
        let at = self.kind.shifted(self.start);
        let first = global.name.shifted(global.start);
        let title = Message::new("external-type.write").with("kind", kind);
        Diagnostic::new(RULE.code, at, message)
            .related(first, Message::new("external-type.global"))
            .fix(title, vec![TextEdit::new(at, kind)])
    }
}

/// The type that names of types stand for.
fn unnamed(mut declared: DeclaredType, scopes: &Scopes) -> DeclaredType {
    for _ in 0..scopes.types.len() {
        let DeclaredType::Named(name) = &declared else { break };
        let Some(next) = scopes.types.get(name) else { break };
        declared = next.clone();
    }
    declared
}
