//! What the files of a project know of each other: POUs by their parameters, global variables, types.

use super::scope::{DeclaredType, Pou, Variable};
use super::{Document, Scopes};
use crate::text::folded;
use rustc_hash::FxHasher;
use smol_str::SmolStr;
use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::path::Path;
use std::sync::Arc;

/// What other files see of a document.
#[derive(Debug, Default)]
pub struct Exports {
    /// Differs whenever something differs that other files see.
    pub key: u64,
    pub(super) pous: Vec<Arc<Pou>>,
    pub(super) globals: Vec<(SmolStr, Variable)>,
    pub(super) types: Vec<(SmolStr, DeclaredType)>,
    pub(super) type_words: Vec<(SmolStr, SmolStr)>,
    pub(super) configured: BTreeMap<SmolStr, SmolStr>,
    pub(super) has_configuration: bool,
}

/// The exports of all files of a project, in the order of its [`ProjectView`](super::ProjectView).
#[derive(Debug)]
pub struct Outer {
    folder: Arc<Path>,
    files: Vec<Arc<Exports>>,
}

impl Exports {
    /// Those of `document`; what it knows from others is not among them.
    pub fn of(document: &Document) -> Exports {
        let scopes = document.scopes();
        let mut exports = Exports {
            pous: scopes.own_pous().iter().map(|pou| Arc::new(pou.seen_from_outside())).collect(),
            globals: own(&scopes.globals, &scopes.own_globals),
            types: own(&scopes.types, &scopes.own_types),
            type_words: own(&scopes.type_words, &scopes.own_types),
            configured: scopes.own_configured.clone(),
            has_configuration: scopes.own_configuration,
            key: 0,
        };
        let mut hasher = FxHasher::default();
        for pou in &exports.pous {
            (&pou.name, pou.kind as u8, format!("{:?}", (&pou.result, &pou.variables))).hash(&mut hasher);
        }
        format!("{:?}", (&exports.globals, &exports.types)).hash(&mut hasher);
        (&exports.type_words, &exports.configured).hash(&mut hasher);
        exports.has_configuration.hash(&mut hasher);
        exports.key = hasher.finish();
        exports
    }
}

/// The entries of `all` with the names `own`, in the order of the text.
fn own<T: Clone>(all: &rustc_hash::FxHashMap<SmolStr, T>, own: &[SmolStr]) -> Vec<(SmolStr, T)> {
    own.iter().filter_map(|name| Some((name.clone(), all.get(name)?.clone()))).collect()
}

impl Default for Outer {
    fn default() -> Outer {
        Outer::new(Path::new("").into(), Vec::new())
    }
}

impl Outer {
    /// From the exports of each file of the project in a folder.
    pub fn new(folder: Arc<Path>, files: Vec<Arc<Exports>>) -> Outer {
        Outer { folder, files }
    }

    /// Whether it is of the same project, whose units are the same for all its files.
    pub fn is_of_project(&self, other: &Outer) -> bool {
        self.folder == other.folder
    }

    /// Whether file number `own` learns the same from both.
    pub fn is_same_for(&self, other: &Outer, own: usize) -> bool {
        let pairs = || self.files.iter().zip(&other.files).enumerate().filter(|(number, _)| *number != own);
        self.files.len() == other.files.len() && pairs().all(|(_, (left, right))| left.key == right.key)
    }

    /// Those of each file.
    pub fn files(&self) -> &[Arc<Exports>] {
        &self.files
    }
}

impl Pou {
    /// The same POU with its parameters alone.
    fn seen_from_outside(&self) -> Pou {
        let variables = self.variables.iter().filter(|variable| variable.section.is_parameter());
        Pou::new(self.name.clone(), self.kind, self.result.clone(), variables.cloned())
    }

    /// Whether who calls it sees no difference to `other`: the name, the parameters in their order, the result.
    pub fn is_seen_as(&self, other: &Pou) -> bool {
        let parameters = |pou: &'_ Pou| -> Vec<_> {
            let variables = pou.variables.iter().filter(|variable| variable.section.is_parameter());
            variables.map(|one| (folded(&one.name), one.section, one.declared.clone())).collect()
        };
        folded(&self.name) == folded(&other.name)
            && self.result == other.result
            && parameters(self) == parameters(other)
    }
}

impl Scopes {
    /// Adds what the files of `outer` but number `own` declare. What is declared here holds before it.
    pub(super) fn add_outer(&mut self, outer: &Outer, own: usize, hasher: &mut FxHasher) {
        let others = outer.files.iter().enumerate().filter(|(number, _)| *number != own);
        for (_, file) in others {
            file.key.hash(hasher);
            for pou in &file.pous {
                self.add_pou(pou.clone());
            }
            for (name, variable) in &file.globals {
                self.globals.entry(name.clone()).or_insert_with(|| variable.clone());
            }
            for (name, declared) in &file.types {
                self.types.entry(name.clone()).or_insert_with(|| declared.clone());
            }
            for (name, words) in &file.type_words {
                self.type_words.entry(name.clone()).or_insert_with(|| words.clone());
            }
            self.configured.extend(file.configured.iter().map(|(path, words)| (path.clone(), words.clone())));
            self.has_configuration |= file.has_configuration;
        }
    }
}
