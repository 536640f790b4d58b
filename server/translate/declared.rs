//! What two programs declare under the same name, in other words.

use crate::document::Document;
use crate::il::iec::{Declaration, IecTree, ItemKind};
use crate::text::{Span, folded};
use smol_str::SmolStr;
use std::collections::BTreeMap;

/// A variable by the program unit and its own name.
type Key = (SmolStr, SmolStr);

/// The first variable that both documents declare, and not alike: in another section, at another address, of another
/// type, or with another value at first; with the places of both declarations.
pub(super) fn difference(left: &Document, right: &Document) -> Option<(SmolStr, [Span; 2])> {
    let [left, right] = [left, right].map(declarations);
    left.into_iter().find_map(|(key, (words, span))| {
        let (other, other_span) = right.get(&key)?;
        (words != *other).then_some((key.1, [span, *other_span]))
    })
}

/// What is said of each variable, and where.
fn declarations(document: &Document) -> BTreeMap<Key, (String, Span)> {
    let mut found = BTreeMap::new();
    let mut unit = SmolStr::default();
    for (at, _) in document.iec_chunks() {
        let text = at.chunk.text();
        let Some(tree) = at.chunk.iec() else { continue };
        for item in &tree.items {
            match &item.kind {
                ItemKind::Pou { name, .. } => {
                    unit = name.map(|name| folded(name.of(text))).unwrap_or_default()
                }
                ItemKind::PouEnd(_) => unit = SmolStr::default(),
                ItemKind::Section { kind, constant, retain, declarations } => {
                    let section = format!("{kind:?} {constant} {retain:?} ");
                    for (name, said, span) in variables(tree, declarations.of(&tree.declarations), text) {
                        let key = (unit.clone(), folded(name));
                        found.insert(key, (section.clone() + &said, span.shifted(at.start)));
                    }
                }
                _ => {}
            }
        }
    }
    found
}

/// Each name with what is said behind the names, blanks aside, and where it stands.
fn variables<'t>(
    tree: &'t IecTree,
    declarations: &'t [Declaration],
    text: &'t str,
) -> impl Iterator<Item = (&'t str, String, Span)> {
    declarations.iter().flat_map(move |declaration| {
        let names = declaration.names.of(&tree.names);
        let end = names.last().map_or(declaration.span.start, |last| last.end);
        let words = Span { start: end, ..declaration.span }.of(text);
        // Capitals count in texts alone.
        let words = if words.contains(['\'', '"']) { words.to_string() } else { words.to_uppercase() };
        let said: String = words.split_whitespace().collect();
        names.iter().map(move |name| (name.of(text), said.clone(), *name))
    })
}
