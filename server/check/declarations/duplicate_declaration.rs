//! # duplicate-declaration
//!
//! A name is declared twice where it may stand for one thing only: two variables of a program unit, in whichever
//! sections; two program units, types, tasks or instances; two members of a structure. Which of the two a use means
//! nobody can tell, and their types or addresses may differ.
//!
//! The first declaration holds for the other rules; the later ones are reported. Program units, types and global
//! variables are known in all files of a project, so their names must differ across the files, too.
//!
//! ```iec
//! PROGRAM Gate
//! VAR_INPUT
//!     Open : BOOL;
//! END_VAR
//! VAR
//!     Motor AT %QX0.0 : BOOL;
//!     open : BOOL;
//!     ^^^^
//! END_VAR
//!     LD Open
//!     ST Motor
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Gate
//! VAR_INPUT
//!     Open : BOOL;
//! END_VAR
//! VAR
//!     Motor AT %QX0.0 : BOOL;
//! END_VAR
//!     LD Open
//!     ST Motor
//! END_PROGRAM
//! ```

use super::removal;
use crate::check::iec::{View, views_of};
use crate::check::{ProgramContext, Rule, Run};
use crate::il::iec::{Declaration, ItemKind, Run as Records, SectionKind, TypeSpec};
use crate::text::{Diagnostic, Message, Severity, Span, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

pub(super) const RULE: Rule = Rule {
    code: "duplicate-declaration",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("duplicate_declaration.rs"),
};

/// Names that must differ from each other, with their places and what they are declared as.
#[derive(Default)]
struct Names(FxHashMap<SmolStr, (Span, Option<SmolStr>)>);

impl Names {
    fn add(&mut self, view: &View<'_>, start: usize, span: Span, found: &mut Vec<Diagnostic>) {
        self.add_declared(view, start, (span, None), found);
    }

    fn add_declared(
        &mut self,
        view: &View<'_>,
        start: usize,
        (span, declaration): (Span, Option<&Declaration>),
        found: &mut Vec<Diagnostic>,
    ) {
        let name = span.of(view.text);
        let at = span.shifted(start);
        let said = declaration.map(|own| said_of(view, own));
        let Some((first, before)) = self.0.get(&folded(name)) else {
            self.0.insert(folded(name), (at, said));
            return;
        };
        let message = Message::new("duplicate-declaration.found").with("name", name);
        let diagnostic = Diagnostic::new(RULE.code, at, message)
            .related(*first, Message::new("duplicate-declaration.first"));
        // Of two that say something else nobody knows which is meant.
        let again = declaration.filter(|own| said == *before && own.names.of(&view.tree.names).len() == 1);
        found.push(match again.and_then(|own| removal(view.text, own, start)) {
            Some(edit) => diagnostic.fix(Message::new("duplicate-declaration.remove"), vec![edit]),
            None => diagnostic,
        });
    }
}

/// What stands behind the names of a declaration, however it is spaced.
fn said_of(view: &View<'_>, declaration: &Declaration) -> SmolStr {
    let last = declaration.names.of(&view.tree.names).last().map_or(declaration.span.start, |name| name.end);
    let said = Span { start: last, end: declaration.span.end }.of(view.text);
    folded(&said.split_whitespace().collect::<Vec<_>>().join(""))
}

#[derive(Default)]
struct Scope {
    /// Those of the whole project.
    units: Names,
    types: Names,
    globals: Names,
    /// Those of one program unit.
    variables: Names,
    /// Tasks and instances of one resource.
    runtime: Names,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut scope = Scope::default();
    for file in context.files() {
        scope.variables = Names::default();
        for (start, view) in views_of(*file) {
            scope.take(start, &view, found);
            inside_types(&view, start, found);
        }
    }
}

impl Scope {
    fn take(&mut self, start: usize, view: &View<'_>, found: &mut Vec<Diagnostic>) {
        for item in &view.tree.items {
            match item.kind {
                ItemKind::Pou { name, .. } => {
                    self.variables = Names::default();
                    if let Some(name) = name {
                        self.units.add(view, start, name, found);
                    }
                }
                ItemKind::Section { kind, declarations, .. } => {
                    let names = match kind {
                        SectionKind::Global => &mut self.globals,
                        // Their names are paths to variables that are declared elsewhere.
                        SectionKind::Access | SectionKind::Config => continue,
                        _ => &mut self.variables,
                    };
                    each_name(view, declarations, |name| names.add_declared(view, start, name, found));
                }
                ItemKind::Types { declarations } => {
                    each_name(view, declarations, |name| self.types.add_declared(view, start, name, found));
                }
                ItemKind::Configuration { .. } | ItemKind::Resource { .. } => self.runtime = Names::default(),
                ItemKind::Task(index) => {
                    if let Some(name) = view.tree.tasks.get(index as usize).and_then(|task| task.name) {
                        self.runtime.add(view, start, name, found);
                    }
                }
                ItemKind::Instance(index) => {
                    if let Some(name) = view.tree.instances.get(index as usize).and_then(|one| one.name) {
                        self.runtime.add(view, start, name, found);
                    }
                }
                _ => {}
            }
        }
    }
}

fn each_name<'v>(
    view: &View<'v>,
    declarations: Records,
    mut take: impl FnMut((Span, Option<&'v Declaration>)),
) {
    for declaration in declarations.of(&view.tree.declarations) {
        declaration.names.of(&view.tree.names).iter().for_each(|name| take((*name, Some(declaration))));
    }
}

/// The members of structures and the values of enumerations.
fn inside_types(view: &View<'_>, start: usize, found: &mut Vec<Diagnostic>) {
    for written in &view.tree.types {
        let mut names = Names::default();
        match written.value {
            TypeSpec::Structure { fields } => {
                each_name(view, fields, |name| names.add_declared(view, start, name, found));
            }
            TypeSpec::Enumeration { values } => {
                for name in values.of(&view.tree.names) {
                    names.add(view, start, *name, found);
                }
            }
            _ => {}
        }
    }
}
