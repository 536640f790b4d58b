//! The types of the variables that two programs compare with numbers.

use super::source::Source;
use crate::document::{DeclaredType, Document};
use crate::logic::{Kind, Term, Types};
use crate::target::Operand;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// What all places of both programs together say of the type of a variable.
#[derive(Default)]
struct Said {
    kind: Option<Kind>,
    /// Whether some place does not know it.
    is_open: bool,
    /// Whether it is not the same everywhere: several units have the name, or several names have the address.
    is_disputed: bool,
}

/// The types of what is compared, as far as all places agree about them. Devices of the FX family are the variables of
/// the other program there.
pub(super) fn compared(documents: [&Document; 2], sources: [&[Source]; 2]) -> Types {
    let is_named = |term: &&Term| matches!(term.operand, Operand::Variable | Operand::Direct(_));
    let mut found: FxHashMap<SmolStr, Said> = FxHashMap::default();
    for (document, sources) in documents.into_iter().zip(sources).filter(|(one, _)| !one.target().is_fx()) {
        for source in sources {
            let Some(path) = source.path() else { continue };
            for term in path.compared().into_iter().filter(is_named) {
                let kind = match document.scopes().type_of(source.pou, &term.text) {
                    Some(DeclaredType::Elementary(elementary)) => {
                        let limits = document.scopes().limits_of(source.pou, &term.text);
                        Some(Kind { elementary, limits })
                    }
                    _ => None,
                };
                found.entry(term.key()).or_default().add(kind);
            }
        }
    }
    let told = |(key, said): (SmolStr, Said)| match said {
        Said { is_disputed: true, .. } => Some((key, None)),
        Said { is_open: true, .. } => None,
        Said { kind, .. } => Some((key, Some(kind?))),
    };
    found.into_iter().filter_map(told).collect()
}

impl Said {
    fn add(&mut self, kind: Option<Kind>) {
        self.is_open |= kind.is_none();
        self.is_disputed |= kind.is_some() && self.kind.is_some() && kind != self.kind;
        self.kind = self.kind.or(kind);
    }
}
