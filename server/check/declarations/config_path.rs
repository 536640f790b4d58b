//! # config-path
//!
//! What VAR_CONFIG speaks of is not there. It gives addresses and values to variables of single instances, by the way
//! to them: the resource, the program as the configuration calls it, function blocks within it, the variable. A word of
//! that way that names nothing leaves the variable without its address, and an output without an address moves nothing.
//!
//! A type that is not the one of the declaration is reported too, and so is a variable with two lines: it has one
//! address and one first value, and which of them it is, each maker decides.
//!
//! ```iec
//! PROGRAM Press
//! VAR
//!     Ram AT %Q* : BOOL;
//!     Oil AT %Q* : BOOL;
//! END_VAR
//!     LD TRUE
//!     ST Ram
//! END_PROGRAM
//!
//! CONFIGURATION Plant
//!     RESOURCE Hall ON PLC
//!         PROGRAM Left : Press;
//!     END_RESOURCE
//!     VAR_CONFIG
//!         Hall.Left.Rim AT %QX0.0 : BOOL;
//!                   ^^^
//!         Hall.Right.Ram AT %QX0.1 : BOOL;
//!              ^^^^^
//!         Hall.Left.Oil AT %QW1 : INT;
//!                                 ^^^
//!         Hall.Left.Oil AT %QX0.2 : BOOL;
//!         ^^^^^^^^^^^^^
//!     END_VAR
//! END_CONFIGURATION
//! ```
//!
//! ```iec
//! PROGRAM Press
//! VAR
//!     Ram AT %Q* : BOOL;
//! END_VAR
//!     LD TRUE
//!     ST Ram
//! END_PROGRAM
//!
//! CONFIGURATION Plant
//!     RESOURCE Hall ON PLC
//!         PROGRAM Left : Press;
//!     END_RESOURCE
//!     VAR_CONFIG
//!         Hall.Left.Ram AT %QX0.0 : BOOL;
//!     END_VAR
//! END_CONFIGURATION
//! ```

use super::removal;
use super::unknown_parameter::with_names;
use crate::check::iec::{View, views};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::{DeclaredType, Pou};
use crate::il::iec::{Declaration, ItemKind, SectionKind};
use crate::text::{Diagnostic, Fix, Message, Severity, Span, TextEdit, folded};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

pub(super) const RULE: Rule = Rule {
    code: "config-path",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("config_path.rs"),
};

/// A program that a configuration runs.
struct Instance<'v> {
    /// The resource that runs it; nothing where the configuration has only one, without a name.
    resource: Option<&'v str>,
    name: &'v str,
    program: &'v str,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let (mut resource, mut instances, mut configured) = (None, Vec::new(), Vec::new());
    let mut configurations = 0;
    for (start, view) in views(context) {
        for item in &view.tree.items {
            match item.kind {
                ItemKind::Configuration { .. } => {
                    configurations += 1;
                    resource = None;
                }
                ItemKind::End(_) => resource = None,
                ItemKind::Resource { name, .. } => resource = name.map(|name| name.of(view.text)),
                ItemKind::Instance(index) => {
                    let instance = view.tree.instances.get(index as usize);
                    if let Some((name, program)) = instance.and_then(|own| own.name.zip(own.program)) {
                        let [name, program] = [name, program].map(|word| word.of(view.text));
                        instances.push(Instance { resource, name, program });
                    }
                }
                ItemKind::Section { kind: SectionKind::Config, declarations, .. } => {
                    let declarations = declarations.of(&view.tree.declarations).iter();
                    configured.extend(declarations.map(|own| (configurations, start, view, own)));
                }
                _ => {}
            }
        }
    }
    let mut first: FxHashMap<(usize, SmolStr), (usize, View<'_>, &Declaration)> = FxHashMap::default();
    for (configuration, start, view, declaration) in configured {
        if let Some(path) = declaration.path {
            let words: Vec<&str> = steps(path, view.text).map(|step| step.of(view.text)).collect();
            let key = (configuration, folded(&words.join(".")));
            match first.get(&key) {
                Some(before) => found.push(again((start, &view, declaration), before)),
                None => _ = first.insert(key, (start, view, declaration)),
            }
        }
        found.extend(judge(&view, declaration, &instances).map(|diagnostic| diagnostic.shifted(start)));
    }
}

/// What is wrong with a line of VAR_CONFIG, in the chunk that it stands in.
fn judge(view: &View<'_>, declaration: &Declaration, instances: &[Instance<'_>]) -> Option<Diagnostic> {
    let path = declaration.path?;
    let mut steps = steps(path, view.text);
    let is = |step: &Span, name: &str| step.of(view.text).eq_ignore_ascii_case(name);
    let mut step = steps.next()?;
    let resource = instances.iter().filter_map(|own| own.resource).find(|name| is(&step, name));
    let here = |own: &&Instance<'_>| own.resource == resource;
    if resource.is_some() {
        step = steps.next()?;
    }
    let Some(instance) = instances.iter().filter(here).find(|own| is(&step, own.name)) else {
        // In a configuration with resources the first word is one of these.
        let firsts = || instances.iter().map(|own| own.resource.unwrap_or(own.name));
        let names: Vec<&str> = match resource {
            Some(_) => instances.iter().filter(here).map(|own| own.name).collect(),
            None => firsts().collect(),
        };
        return Some(unknown("config-path.program", view, step, "", names));
    };
    let number = view.scopes.pou_number(instance.program)?;
    let pou: &Pou = view.scopes.pous.get(number)?;
    let first = steps.next()?;
    if pou.variable(&folded(first.of(view.text))).is_none() {
        let names = pou.variables.iter().map(|variable| variable.name.as_str());
        return Some(unknown("config-path.variable", view, first, &pou.name, names.collect()));
    }
    let within = |end: u32| Span { start: first.start, end }.of(view.text);
    let mut owner = view.scopes.type_of(Some(number), within(first.end))?;
    for step in steps {
        let Some(inner) = view.scopes.type_of(Some(number), within(step.end)) else {
            let DeclaredType::Named(block) = owner else { return None };
            let block = view.scopes.pou_named(&block)?;
            let names = block.variables.iter().map(|variable| variable.name.as_str());
            return Some(unknown("config-path.variable", view, step, &block.name, names.collect()));
        };
        owner = inner;
    }
    let said = declaration.declared?;
    let own = view.scopes.resolved(DeclaredType::of(view.text, view.tree, said))?;
    match (own, owner) {
        (DeclaredType::Elementary(own), DeclaredType::Elementary(declared)) if own != declared => {
            let message = Message::new("config-path.type").with("name", path.of(view.text));
            let span = view.tree.type_spec(said).span;
            Some(Diagnostic::new(RULE.code, span, message.with("type", declared.name())))
        }
        _ => None,
    }
}

/// A second line about a variable.
fn again(
    (start, view, declaration): (usize, &View<'_>, &Declaration),
    (first, other_view, other): &(usize, View<'_>, &Declaration),
) -> Diagnostic {
    let span = |declaration: &Declaration, start| declaration.path.unwrap_or_default().shifted(start);
    let name = declaration.path.unwrap_or_default().of(view.text);
    let message = Message::new("config-path.twice").with("name", name);
    let mut diagnostic = Diagnostic::new(RULE.code, span(declaration, start), message)
        .related(span(other, *first), Message::new("config-path.first"));
    let said = |view: &View<'_>, declaration: &Declaration| {
        let behind = declaration.path.map_or(declaration.span.start, |path| path.end);
        let said = Span { start: behind, end: declaration.span.end }.of(view.text);
        folded(&said.split_whitespace().collect::<String>())
    };
    let mut offer = |key, edit: Option<TextEdit>| {
        if let Some(edit) = edit {
            diagnostic.fixes.push(Fix { title: Message::new(key), edits: vec![edit] });
        }
    };
    offer("config-path.remove", removal(view.text, declaration, start));
    if said(view, declaration) != said(other_view, other) {
        offer("config-path.remove-first", removal(other_view.text, other, *first));
    }
    diagnostic
}

/// The words of a path.
fn steps(path: Span, text: &str) -> impl Iterator<Item = Span> {
    let whole = path.of(text);
    whole.split('.').map(move |step| {
        let start = path.start as usize + (step.as_ptr() as usize - whole.as_ptr() as usize);
        let blanks = step.len() - step.trim_start().len();
        Span::new(start + blanks, start + blanks + step.trim().len())
    })
}

fn unknown(key: &'static str, view: &View<'_>, word: Span, owner: &str, names: Vec<&str>) -> Diagnostic {
    let message = Message::new(key).with("word", word.of(view.text)).with("name", owner);
    let message = message.with("names", names.join(", "));
    with_names(Diagnostic::new(RULE.code, word, message), view.text, word, names.into_iter())
}
