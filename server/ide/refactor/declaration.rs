//! Declarations of the variables that a refactoring adds to a program unit.

use super::neighbourhood::Neighbourhood;
use crate::document::{DeclaredType, Document, Pou, Scopes, Unit};
use crate::il::iec::{self, ItemKind, SectionEnd, SectionKind};
use crate::target::iec::ElementaryType;
use crate::text::{Span, TextEdit};
use smol_str::SmolStr;
use std::sync::Arc;

/// A local variable.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Declaration {
    pub name: SmolStr,
    /// `BOOL`, `R_TRIG`, `F_TRIG`.
    pub type_name: &'static str,
}

impl Declaration {
    fn declared(&self) -> DeclaredType {
        match self.type_name {
            "BOOL" => DeclaredType::Elementary(ElementaryType::Bool),
            other => DeclaredType::Named(other.to_lowercase().into()),
        }
    }
}

/// A longer section is only read again for who selected something: a menu that opens late helps nobody.
const SECTION_MAX: usize = 32 * 1024;

/// A place for more declarations, by its offset in the document.
enum Gap {
    /// Behind the header and the sections of a unit without a plain section of local variables.
    Header(usize),
    /// Before an END_VAR that stands alone in its line: where names begin, and the column of the colons, if any.
    Line(usize, String, Option<usize>),
    /// Before an END_VAR that does not.
    InLine(usize),
}

/// The edit that adds `declarations` to the unit; nothing if there is no place for them.
pub(super) fn edit(around: &Neighbourhood<'_>, declarations: &[Declaration]) -> Option<TextEdit> {
    let document = around.document;
    let gap = gap(document, around.unit)?;
    let (Gap::Header(at) | Gap::Line(at, ..) | Gap::InLine(at)) = gap;
    let section = document.chunk_at(at)?.chunk;
    if section.len() > SECTION_MAX && !around.is_selected() {
        return None;
    }
    let end = if document.line_at(at).2.ends_with("\r\n") { "\r\n" } else { "\n" };
    let lines = |indent: &str, colons: Option<usize>| -> String {
        let line = |declaration: &Declaration| {
            let used = indent.chars().count() + declaration.name.chars().count();
            let blanks = colons.map_or(1, |column| column.saturating_sub(used).max(1));
            format!("{indent}{}{}: {};{end}", declaration.name, " ".repeat(blanks), declaration.type_name)
        };
        declarations.iter().map(line).collect()
    };
    let text = match &gap {
        Gap::Header(_) => format!("{end}VAR{end}{}END_VAR", lines("    ", None)),
        Gap::Line(_, indent, colons) => lines(indent, *colons),
        Gap::InLine(_) => {
            let one = |own: &Declaration| format!("{} : {}; ", own.name, own.type_name);
            declarations.iter().map(one).collect()
        }
    };
    Some(TextEdit::new(Span::at(at), text))
}

/// At the end of the last plain VAR section, or behind the header.
fn gap(document: &Document, unit: Unit) -> Option<Gap> {
    unit.number?;
    let (mut header, mut section) = (None, None);
    let mut start = unit.span.start as usize;
    // Sections stand before the instructions.
    while start < unit.span.end as usize
        && let Some(at) = document.chunk_at(start).filter(|at| at.start == start)
        && let Some(tree) = at.chunk.iec()
    {
        let mut declares = false;
        for item in &tree.items {
            match item.kind {
                ItemKind::Section { kind: SectionKind::Local, constant: false, retain: None, .. } => {
                    section = Some((at, item.span));
                    header = Some(at.start + item.span.end as usize);
                }
                ItemKind::Pou { .. } | ItemKind::Section { .. } => {
                    header = Some(at.start + item.span.end as usize);
                }
                _ => continue,
            }
            declares = true;
        }
        if !declares && !tree.items.is_empty() {
            break;
        }
        start += at.chunk.len();
    }
    let Some((at, span)) = section else {
        // What stands behind the header on its line stays there.
        let (_, line, text) = document.line_at(header?);
        return Some(Gap::Header(line + text.trim_end_matches(['\r', '\n']).len()));
    };
    let text = at.chunk.text();
    let (line, before) = match iec::section_end(text, span)? {
        SectionEnd::Behind(end) => return Some(Gap::InLine(at.start + end)),
        SectionEnd::Alone(line, before) => (line, before),
    };
    let declares = !before.trim_start().starts_with("(*") && !before.trim_start().starts_with("//");
    let colons = before.split_once(':').filter(|_| declares).map(|(names, _)| names.chars().count());
    Some(Gap::Line(at.start + line, SectionEnd::margin(before).to_string(), colons))
}

/// Whether `after` declares what `before` does, and `declarations` in program unit number `unit` besides.
pub(super) fn adds_only(
    before: &Scopes,
    after: &Scopes,
    unit: Option<usize>,
    declarations: &[Declaration],
) -> bool {
    let is_kept = |(number, (old, new)): (usize, (&Arc<Pou>, &Arc<Pou>))| match Some(number) == unit {
        true => grows_by(old, new, declarations),
        false => Arc::ptr_eq(old, new) || old == new,
    };
    let is_unit_there =
        declarations.is_empty() || unit.is_some_and(|number| number < before.own_pous().len());
    before.key == after.key && declarations.is_empty()
        || is_unit_there
            && before.pous.len() == after.pous.len()
            && before.pous.iter().zip(&after.pous).enumerate().all(is_kept)
            && before.globals == after.globals
            && before.types == after.types
            && before.has_configuration == after.has_configuration
}

fn grows_by(old: &Pou, new: &Pou, declarations: &[Declaration]) -> bool {
    let same_head = (&old.name, old.kind, &old.result) == (&new.name, new.kind, &new.result);
    let mut known = old.variables.iter().peekable();
    let mut added = declarations.iter();
    let in_order = new.variables.iter().all(|variable| {
        if known.next_if(|known| *known == variable).is_some() {
            return true;
        }
        added.next().is_some_and(|own| {
            variable.name == own.name
                && variable.declared == own.declared()
                && variable.section == SectionKind::Local
                && !variable.constant
                && variable.address.is_none()
        })
    });
    same_head && in_order && known.next().is_none() && added.next().is_none()
}
