//! Declarations of IEC variables in words: the section, the text as written, the names of types.

use super::names::{self, Thing};
use crate::document::{DeclaredType, Document, Notation, Scopes, Tree, Use};
use crate::il::iec::{IecTree, ItemKind, PouKind, SectionKind};
use crate::ladder::{ChunkKind, TableRow, kind_of, table_rows};
use crate::target::iec::FunctionBlock;
use crate::text::Span;
use rustc_hash::FxHashMap;

/// The declaration of `thing` as written, with the keyword of its section: `VAR_INPUT Start AT %IX0.0 : BOOL`.
pub(super) fn source(document: &Document, thing: &Thing) -> Option<String> {
    let mut found = None;
    names::visit(document, thing, |place| {
        if place.usage == Use::Declare && found.is_none() {
            found = Some((place.chunk, place.inside()));
        }
    });
    let (chunk, name) = found?;
    let Tree::Iec(tree) = chunk.tree() else { return None };
    let text = chunk.text();
    if let Some(row) = table_row(text, name) {
        return Some(row);
    }
    let (keyword, span) = declaration_at(tree, name)?;
    let written: Vec<&str> = span.of(text).split_whitespace().collect();
    Some(format!("{keyword} {}", written.join(" ")).trim_start().to_string())
}

/// The row of an LDmicro export's table in which the name at `name` stands: `XStart AT 2 : Digital input`.
fn table_row(text: &str, name: Span) -> Option<String> {
    if kind_of(text) != ChunkKind::Ldmicro {
        return None;
    }
    let row = table_rows(text).into_iter().find(|row| row.name == name)?;
    Some(row_words(text, &row))
}

/// The rows of an LDmicro export's tables by their names, as [`source`] shows them.
pub(super) fn table_rows_of(document: &Document) -> FxHashMap<String, String> {
    let mut rows = FxHashMap::default();
    if document.notation() != Notation::Ladder {
        return rows;
    }
    let is_table = |text: &&str| kind_of(text) == ChunkKind::Ldmicro;
    let declaring = document.chunks().filter(|at| at.chunk.is_iec());
    for text in declaring.map(|at| at.chunk.text()).filter(is_table) {
        let words = |row: TableRow| (row.name.of(text).to_string(), row_words(text, &row));
        rows.extend(table_rows(text).into_iter().map(words));
    }
    rows
}

fn row_words(text: &str, row: &TableRow) -> String {
    let pin = row.pin.map_or(String::new(), |pin| format!(" AT {}", pin.of(text)));
    let kind = row.kind.map_or(String::new(), |kind| format!(" : {}", kind.of(text)));
    format!("{}{pin}{kind}", row.name.of(text))
}

/// The section's keywords and all of the declaration in which the name at `name` is declared.
fn declaration_at(tree: &IecTree, name: Span) -> Option<(String, Span)> {
    for item in &tree.items {
        let (keyword, declarations) = match item.kind {
            ItemKind::Section { kind, constant, retain, declarations } => {
                let constant = if constant { " CONSTANT" } else { "" };
                let retain = match retain {
                    Some(true) => " RETAIN",
                    Some(false) => " NON_RETAIN",
                    None => "",
                };
                (format!("{}{constant}{retain}", section_keyword(kind)), declarations)
            }
            ItemKind::Types { declarations } => ("TYPE".to_string(), declarations),
            _ => continue,
        };
        let declaration = declarations
            .of(&tree.declarations)
            .iter()
            .find(|declaration| declaration.names.of(&tree.names).contains(&name));
        if let Some(declaration) = declaration {
            return Some((keyword, declaration.span));
        }
    }
    None
}

/// `VAR_INPUT`
pub(super) fn section_keyword(kind: SectionKind) -> &'static str {
    match kind {
        SectionKind::Local => "VAR",
        SectionKind::Input => "VAR_INPUT",
        SectionKind::Output => "VAR_OUTPUT",
        SectionKind::InOut => "VAR_IN_OUT",
        SectionKind::External => "VAR_EXTERNAL",
        SectionKind::Temporary => "VAR_TEMP",
        SectionKind::Global => "VAR_GLOBAL",
        SectionKind::Access => "VAR_ACCESS",
        SectionKind::Config => "VAR_CONFIG",
    }
}

/// `FUNCTION_BLOCK`
pub(super) fn pou_keyword(kind: PouKind) -> &'static str {
    match kind {
        PouKind::Program => "PROGRAM",
        PouKind::FunctionBlock => "FUNCTION_BLOCK",
        PouKind::Function => "FUNCTION",
    }
}

/// The name of a type as people write it.
pub(super) fn type_name(declared: &DeclaredType, scopes: &Scopes) -> String {
    match declared {
        DeclaredType::Elementary(kind) => kind.name().to_string(),
        DeclaredType::Named(name) => match (FunctionBlock::named(name), scopes.pou_named(name)) {
            (_, Some(pou)) => pou.name.to_string(),
            (Some(block), None) => block.name.to_string(),
            (None, None) => name.to_string(),
        },
        DeclaredType::Subrange(base, None) => type_name(base, scopes),
        DeclaredType::Subrange(base, Some((least, greatest))) => {
            format!("{}({least}..{greatest})", type_name(base, scopes))
        }
        DeclaredType::Array(element) => format!("ARRAY OF {}", type_name(element, scopes)),
        DeclaredType::Enumeration(values) => format!("({})", values.join(", ")),
        DeclaredType::Structure(_) => "STRUCT".to_string(),
        DeclaredType::Unknown => "?".to_string(),
    }
}
