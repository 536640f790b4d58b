//! Relays on the way that only one of two programs has, so that they are nothing to compare.

use super::source::Source;
use crate::document::Document;
use crate::il::iec::{PouKind, SectionKind};
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Deed, Term, Test, is_helper_name};
use crate::text::folded;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;
use std::cell::RefCell;

/// The variables, by their keys, that keep the power of a rung and that nobody outside of their program unit knows, and
/// those that are made anew in each call. A program of the FX family has nothing that stands for them; in one of IEC
/// 61131-3 they are only looked at behind the store that gives them their value, so that no scan knows what they were
/// in the one before.
pub(super) fn of(documents: [&Document; 2], sources: [&[Source]; 2]) -> FxHashSet<SmolStr> {
    let mut helpers = FxHashSet::default();
    let mut known = FxHashSet::default();
    for scopes in documents.map(Document::scopes) {
        known.extend(scopes.globals.keys().cloned());
        for (pou, variable) in
            scopes.pous.iter().flat_map(|pou| pou.variables.iter().map(move |one| (pou, one)))
        {
            let is_own = match variable.section {
                SectionKind::Local => pou.kind == PouKind::Function || is_helper_name(&variable.name),
                SectionKind::Temporary => true,
                _ => false,
            };
            let kind = if is_own && variable.address.is_none() { &mut helpers } else { &mut known };
            kind.insert(folded(&variable.name));
        }
    }
    if !documents.iter().any(|document| document.target().is_fx()) {
        sources.into_iter().for_each(|sources| known.extend(remembered(&helpers, sources)));
    }
    helpers.retain(|name| !known.contains(name));
    helpers
}

/// Those of `helpers` that a program looks at without having stored to them before, or uses for something else.
fn remembered(helpers: &FxHashSet<SmolStr>, sources: &[Source]) -> FxHashSet<SmolStr> {
    let found = RefCell::new(FxHashSet::default());
    let stored: RefCell<FxHashSet<SmolStr>> = RefCell::default();
    let looks_at = |term: &Term| {
        let key = term.key();
        if helpers.contains(&key) && !stored.borrow().contains(&key) {
            found.borrow_mut().insert(key);
        }
    };
    let mut unit = None;
    for source in sources {
        if source.pou != unit || !source.rung.labels.is_empty() || source.rung.path.is_err() {
            stored.borrow_mut().clear();
            unit = source.pou;
        }
        match &source.rung.path {
            Ok(path) => path.iter().for_each(|path| {
                path.visit(
                    &mut |action| match (&action.deed, &action.terms[..]) {
                        (Deed::Coil(CoilKind::Plain | CoilKind::Negated), [term]) => {
                            stored.borrow_mut().insert(term.key());
                        }
                        _ => action.terms.iter().for_each(looks_at),
                    },
                    &mut |condition| {
                        for contact in condition.contacts() {
                            match contact.test {
                                Test::Bit(ContactKind::NormallyOpen | ContactKind::NormallyClosed) => {
                                    contact.terms.iter().for_each(looks_at);
                                }
                                // What an edge remembers of it goes on to the next scan.
                                _ => found.borrow_mut().extend(contact.terms.iter().map(Term::key)),
                            }
                        }
                    },
                );
            }),
            Err(_) => {
                let words = source.words();
                found.borrow_mut().extend(words.split(' ').map(SmolStr::new));
            }
        }
    }
    found.into_inner()
}
