//! Keeps the files of a project informed about each other: what one declares, all others know.

use super::projects::{Loaded, OnDisk};
use super::workspace::{Open, Snapshot, Workspace};
use crate::document::{Comments, Document, Exports, Outer};
use std::path::Path;
use std::sync::Arc;
use tower_lsp::ls_types::Uri;

impl Workspace {
    /// Takes a project as it was read, or forgets one whose manifest is gone; returns whether there is something new
    /// for its open documents.
    pub(super) fn adopt(&self, key: &Arc<Path>, loaded: Option<Loaded>) -> bool {
        let mut state = self.state();
        let old = state.snapshot.projects.get(key).cloned();
        let is_new = match (&old, &loaded) {
            (Some(old), Some(new)) => !state.snapshot.shows_the_same(old, new),
            (old, new) => old.is_some() || new.is_some(),
        };
        let projects = Arc::make_mut(&mut state.snapshot.projects);
        match loaded {
            Some(loaded) => _ = projects.insert(key.clone(), Arc::new(loaded)),
            None => _ = projects.remove(key),
        }
        is_new
    }

    /// Tells every file of a project what the others declare, and publishes the open documents for which that is
    /// something new; returns these. Only the keeper calls it, so no two run at once.
    pub(super) fn link(&self, key: &Arc<Path>) -> Vec<Uri> {
        let snapshot = self.seen_by_project(key);
        let linked = snapshot.projects.get(key).map(|loaded| {
            let exports = loaded.files.iter().map(|file| match snapshot.open_at(&file.path) {
                Some(open) => Arc::new(Exports::of(&open.document)),
                None => file.exports.clone(),
            });
            let outer = Arc::new(Outer::new(key.clone(), exports.collect()));
            let files = (0..).zip(&loaded.files).map(|(number, file)| file.linked(&outer, number));
            Loaded { files: files.collect(), outer, ..Loaded::clone(loaded) }
        });
        let mut state = self.state();
        let waited = state.awaited.remove(key);
        let outer = linked.as_ref().map(|loaded| loaded.outer.clone());
        if let Some(loaded) = linked {
            Arc::make_mut(&mut state.snapshot.projects).insert(key.clone(), Arc::new(loaded));
        }
        let mut published = Vec::new();
        for open in state.snapshot.opens_of(key) {
            let number = state.snapshot.projects.get(key).and_then(|loaded| loaded.number_of(&open));
            let comments = state.snapshot.projects.get(key).map(|loaded| loaded.comments.clone());
            let comments = comments.filter(|_| number.is_some()).unwrap_or_default();
            let commented = *open.document.comments() != comments;
            let open = match commented {
                true => Arc::new(Open { document: open.document.commented(&comments), ..Open::clone(&open) }),
                false => open,
            };
            let document = match (&outer, number) {
                (Some(outer), Some(number)) => relinked(&open.document, outer, number),
                _ => open.document.outer().is_some().then(|| open.document.unlinked()),
            };
            if document.is_some() || waited || commented {
                published.push(open.uri.clone());
                let document = document.unwrap_or_else(|| open.document.clone());
                state.put(Open { document, ..Open::clone(&open) });
            }
        }
        published
    }

    /// Publishes the open documents of a project again, but those that are `done`: what is found in them may have
    /// changed with another file.
    pub(super) fn publish_project(&self, key: &Arc<Path>, done: &[Uri]) {
        let mut state = self.state();
        for open in state.snapshot.opens_of(key) {
            if !done.contains(&open.uri) {
                state.put(Open::clone(&open));
            }
        }
    }

    /// Publishes an open document again; nothing if it is not open.
    pub(super) fn publish_again(&self, uri: &Uri) {
        let mut state = self.state();
        if let Some(open) = state.snapshot.open(uri).cloned() {
            state.put(Open::clone(&open));
        }
    }

    /// Publishes the documents of a project that takes too long to read with what is known without it.
    pub(super) fn wait_no_longer(&self, key: &Arc<Path>) {
        let is_awaited = self.state().awaited.remove(key);
        if is_awaited {
            self.publish_project(key, &[]);
        }
    }
}

impl Snapshot {
    /// Whether two readings of a project have the same files with the same text, those that are open aside.
    fn shows_the_same(&self, old: &Loaded, new: &Loaded) -> bool {
        let same = |(old, new): (&OnDisk, &OnDisk)| {
            let same_text = match (&old.file, &new.file) {
                (Some(old), Some(new)) => Arc::ptr_eq(old, new),
                (old, new) => old.is_none() && new.is_none(),
            };
            old.path == new.path && (same_text || self.open_at(&new.path).is_some())
        };
        old.files.len() == new.files.len()
            && old.manifest == new.manifest
            && old.files.iter().zip(&new.files).all(same)
    }
}

impl Loaded {
    /// The number of the file of an open document.
    pub(super) fn number_of(&self, open: &Open) -> Option<usize> {
        let path = open.path.as_ref()?;
        self.files.iter().position(|file| file.path == *path)
    }

    /// `document` as the file of `open` in this project, if it is one.
    pub(super) fn placed(&self, document: Document, path: Option<&Arc<Path>>) -> Document {
        let number = path.and_then(|path| self.files.iter().position(|file| file.path == *path));
        match number {
            Some(number) => document.commented(&self.comments).linked(self.outer.clone(), number),
            None => document,
        }
    }
}

impl OnDisk {
    /// The same file with what the project says about devices.
    pub(super) fn commented(&self, comments: &Arc<Comments>) -> OnDisk {
        let file = self.file.as_ref().map(|open| match *open.document.comments() == *comments {
            true => open.clone(),
            false => Arc::new(Open { document: open.document.commented(comments), ..Open::clone(open) }),
        });
        OnDisk { file, ..self.clone() }
    }

    fn linked(&self, outer: &Arc<Outer>, number: usize) -> OnDisk {
        let file = self.file.as_ref().map(|open| match relinked(&open.document, outer, number) {
            Some(document) => Arc::new(Open { document, ..Open::clone(open) }),
            None => open.clone(),
        });
        OnDisk { file, ..self.clone() }
    }
}

/// The document with what the others declare; nothing if it knows that.
fn relinked(document: &Document, outer: &Arc<Outer>, number: usize) -> Option<Document> {
    let knows = document.outer().is_some_and(|(old, own)| own == number && old.is_same_for(outer, number));
    (!knows).then(|| document.linked(outer.clone(), number))
}
