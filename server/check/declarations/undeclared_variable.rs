//! # undeclared-variable
//!
//! A name is used that no `VAR` section of the program unit and no `VAR_GLOBAL` declares. Without a declaration the
//! controller knows neither type nor place of the variable. Often it is a spelling mistake, and a write to the wrong
//! name would leave an output as it was.
//!
//! The first use in each program unit is reported, the others beside it. One fix declares the variable, with the
//! type that its use asks for; another one takes the name that was perhaps meant. Instruction List and ladder
//! without any `PROGRAM` declare their variables by using them.
//!
//! ```iec
//! PROGRAM Pump
//! VAR
//!     Level : INT;
//!     Motor : BOOL;
//! END_VAR
//!     LD Level
//!     GT Limit
//!        ^^^^^
//!     ST Moter
//!        ^^^^^
//!     LD Limit
//!     ST Level
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Pump
//! VAR
//!     Level : INT;
//!     Motor : BOOL;
//!     Limit : INT := 80;
//! END_VAR
//!     LD Level
//!     GT Limit
//!     ST Motor
//! END_PROGRAM
//! ```

use super::guess::types_of;
use crate::check::iec::View;
use crate::check::{ProgramContext, Rule, Run};
use crate::document::{Chunk, ChunkRef, DeclaredType, Document, Mention, Pou, Scopes, Symbol, Use};
use crate::il::iec::{self, IecTree, ItemKind, PouKind, SectionEnd, SectionKind, TypeSpec};
use crate::target::iec::{Function, FunctionBlock, nearest};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

pub(super) const RULE: Rule = Rule {
    code: "undeclared-variable",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("undeclared_variable.rs"),
};

/// More uses than this are not listed beside the first one.
const MOST_RELATED: usize = 8;

/// Near names are looked for so many times in a POU; who misses more has another trouble than misspellings.
const MOST_GUESSED: usize = 100;

/// The names without a declaration in one POU.
#[derive(Default)]
struct Unit<'a> {
    chunks: Vec<ChunkRef<'a>>,
    /// Each name with its uses; `order` has the names as they come.
    uses: FxHashMap<SmolStr, Vec<Span>>,
    order: Vec<SmolStr>,
}

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    context.each_file(found, check_file);
}

fn check_file(document: &Document, found: &mut Vec<Diagnostic>) {
    let scopes = document.scopes();
    if scopes.own_pous().is_empty() {
        return;
    }
    let enumerators = enumerators(document);
    let mut unit = Unit::default();
    let mut pou: Option<usize> = None;
    for at in document.chunks() {
        let started = at.chunk.pou_starts();
        if started > 0 {
            std::mem::take(&mut unit).report(scopes, pou, found);
            pou = Some(pou.map_or(started - 1, |number| number + started));
        }
        let Some(number) = pou else { continue };
        if !is_body_or_section(at.chunk) {
            continue;
        }
        for mention in at.chunk.mentions().iter().filter(|mention| mention.usage != Use::Declare) {
            if let Symbol::Variable(name) = &mention.symbol
                && !enumerators.contains(name)
                && !is_declared(scopes, number, name, mention)
            {
                unit.add(name, mention.span.shifted(at.start));
            }
        }
        unit.chunks.push(at);
    }
    unit.report(scopes, pou, found);
}

/// Types and configurations name other things than variables of a POU.
fn is_body_or_section(chunk: &Chunk) -> bool {
    let is_other = |tree: &IecTree| {
        tree.items.iter().any(|item| {
            matches!(item.kind, ItemKind::Types { .. } | ItemKind::Configuration { .. } | ItemKind::End(_))
        })
    };
    !chunk.iec().is_some_and(is_other)
}

/// Also what CAL calls although it is no instance; `unknown-function-block` says so.
fn is_declared(scopes: &Scopes, pou: usize, name: &str, mention: &Mention) -> bool {
    let is_result = |own: &Pou| own.kind == PouKind::Function && own.name.eq_ignore_ascii_case(name);
    let is_callee = || {
        Function::named(name).is_some()
            || FunctionBlock::named(name).is_some()
            || scopes.pou_named(name).is_some_and(|pou| pou.kind != PouKind::Program)
    };
    scopes.variable(Some(pou), name).is_some()
        || scopes.pous.get(pou).is_some_and(|pou| is_result(pou))
        || mention.usage == Use::ReadWrite && is_callee()
}

/// The folded names of all values of enumerations.
fn enumerators(document: &Document) -> FxHashSet<SmolStr> {
    let mut names = FxHashSet::default();
    let scopes = document.scopes();
    // Those of other files are known through what they declare.
    let variables = scopes.globals.values().map(|variable| &variable.declared);
    for declared in scopes.types.values().chain(variables) {
        if let DeclaredType::Enumeration(values) = declared {
            names.extend(values.iter().cloned());
        }
    }
    for (at, _) in document.iec_chunks() {
        let Some(tree) = at.chunk.iec() else { continue };
        for written in &tree.types {
            if let TypeSpec::Enumeration { values } = written.value {
                names.extend(values.of(&tree.names).iter().map(|span| folded(span.of(at.chunk.text()))));
            }
        }
    }
    names
}

impl Unit<'_> {
    fn add(&mut self, name: &SmolStr, span: Span) {
        let uses = self.uses.entry(name.clone()).or_default();
        if uses.is_empty() {
            self.order.push(name.clone());
        }
        uses.push(span);
    }

    fn report(self, scopes: &Scopes, pou: Option<usize>, found: &mut Vec<Diagnostic>) {
        let Some(own) = pou.and_then(|number| scopes.pous.get(number)).filter(|_| !self.order.is_empty())
        else {
            return;
        };
        let views: Vec<View<'_>> = self
            .chunks
            .iter()
            .filter_map(|at| Some(View { text: at.chunk.text(), tree: at.chunk.iec()?, scopes, pou }))
            .collect();
        let types = types_of(&views, &self.uses.keys().cloned().collect());
        let gap = self.gap();
        for (number, name) in self.order.iter().enumerate() {
            let Some((first, others)) = self.uses.get(name).and_then(|uses| uses.split_first()) else {
                continue;
            };
            let word = self.word(*first);
            let message = Message::new("undeclared-variable.found").with("name", word).with("pou", &own.name);
            let mut diagnostic = Diagnostic::new(RULE.code, *first, message);
            for other in others.iter().take(MOST_RELATED) {
                diagnostic = diagnostic.related(*other, Message::new("undeclared-variable.again"));
            }
            let declared = own.variables.iter().map(|variable| variable.name.as_str());
            let globals = scopes.globals.values().map(|variable| variable.name.as_str());
            let candidates = declared.chain(globals).filter(|_| number < MOST_GUESSED);
            for near in nearest(word, candidates) {
                let edits = std::iter::once(first)
                    .chain(others)
                    .map(|span| TextEdit::new(*span, near.clone()))
                    .collect();
                let title = Message::new("undeclared-variable.rename").with("name", &near);
                diagnostic = diagnostic.fix(title, edits);
            }
            if let Some(kind) = types.get(name)
                && let Some(gap) = &gap
            {
                let edit = gap.declaration(word, kind);
                let title = Message::new("undeclared-variable.declare").with("name", word).with("type", kind);
                diagnostic = diagnostic.fix(title, vec![edit]);
            }
            found.push(diagnostic);
        }
    }

    fn word(&self, span: Span) -> &str {
        let index = self.chunks.partition_point(|at| at.start <= span.start as usize);
        let Some(at) = index.checked_sub(1).and_then(|index| self.chunks.get(index)) else { return "" };
        let (start, end) = (span.start as usize - at.start, span.end as usize - at.start);
        at.chunk.text().get(start..end).unwrap_or("")
    }

    /// Where a declaration can be inserted: at the end of the last plain VAR section, or in a new one behind the
    /// header.
    fn gap(&self) -> Option<Gap> {
        let mut header = None;
        let mut section = None;
        for at in &self.chunks {
            let Some(tree) = at.chunk.iec() else { continue };
            for item in &tree.items {
                match item.kind {
                    ItemKind::Pou { .. } => header = Some(at.start + item.span.end as usize),
                    ItemKind::Section { kind: SectionKind::Local, constant: false, .. } => {
                        section = Some((at, item.span));
                    }
                    _ => {}
                }
            }
        }
        let Some((at, span)) = section else { return header.map(Gap::Header) };
        Some(match iec::section_end(at.chunk.text(), span)? {
            SectionEnd::Behind(end) => Gap::InLine(at.start + end),
            SectionEnd::Alone(line, before) => {
                Gap::Line(at.start + line, SectionEnd::margin(before).to_string())
            }
        })
    }
}

/// A place for one more declaration, by its offset in the document.
enum Gap {
    /// Behind the header of a POU without a section.
    Header(usize),
    /// Before an END_VAR that stands alone in its line; declarations are indented like this.
    Line(usize, String),
    /// Before an END_VAR that does not.
    InLine(usize),
}

impl Gap {
    fn declaration(&self, name: &str, kind: &str) -> TextEdit {
        match self {
            Gap::Header(end) => {
                TextEdit::new(Span::at(*end), format!("\nVAR\n    {name} : {kind};\nEND_VAR"))
            }
            Gap::Line(line, indent) => TextEdit::new(Span::at(*line), format!("{indent}{name} : {kind};\n")),
            Gap::InLine(end) => TextEdit::new(Span::at(*end), format!("{name} : {kind}; ")),
        }
    }
}
