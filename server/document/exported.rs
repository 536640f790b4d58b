//! The tables of an LDmicro export as declarations, so that everything that asks for declared names finds them.

use crate::il::iec::{Declaration, IecTree, Item, ItemKind, Run, SectionKind, TypeId, TypeSpec};
use crate::ladder::{NameKind, table_rows};
use crate::target::iec::ElementaryType;
use crate::text::{Span, Spanned};

/// Whether a chunk of an export has any names to declare.
pub(super) fn declares(text: &str) -> bool {
    !table_rows(text).is_empty()
}

/// One section of global variables. The type of a name is that of its first letter, which is the same in every
/// language of the program that wrote the table; the words of the table are kept as the type's place.
pub(super) fn read(text: &str) -> IecTree {
    let mut tree = IecTree::default();
    let rows = table_rows(text);
    for row in &rows {
        let names = Run { start: tree.names.len() as u32, end: tree.names.len() as u32 + 1 };
        tree.names.push(row.name);
        let kind = match NameKind::of(row.name.of(text)) {
            NameKind::Input | NameKind::Output | NameKind::Relay => ElementaryType::Bool,
            // The name of a timer or counter is also that of its count.
            NameKind::Timer | NameKind::Counter | NameKind::Number => ElementaryType::Int,
        };
        let declared = TypeId(tree.types.len() as u32);
        tree.types.push(Spanned::new(TypeSpec::Elementary(kind), row.kind.unwrap_or(row.name)));
        tree.declarations.push(Declaration {
            span: row.span,
            names,
            address: None,
            path: None,
            declared: Some(declared),
            edge: None,
            writable: None,
            initial: None,
        });
    }
    let declarations = Run { start: 0, end: tree.declarations.len() as u32 };
    let end = text.trim_end().len();
    let start = text.len() - text.trim_start().len();
    let kind = ItemKind::Section { kind: SectionKind::Global, constant: false, retain: None, declarations };
    tree.items.push(Item { span: Span::new(start.min(end), end), depth: 0, kind });
    tree
}
