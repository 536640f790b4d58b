//! Device comments files: those that the editor has open win over the disk, and what is wrong in them is published.

use super::known::Known;
use super::projects::{Around, Loaded, canonical, file_path};
use super::to_proto;
use super::workspace::{Open, Snapshot, Workspace, edit_of, spliced};
use crate::document::{Document, Notation};
use crate::project::{CommentsFile, Manifest, Project, is_table_file};
use crate::target::{Model, Target};
use rustc_hash::FxHashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tower_lsp::ls_types::{self as lsp, DidChangeTextDocumentParams, TextDocumentItem, Uri};

/// The tables that the editor has open, by canonical path.
pub(super) type Sheets = FxHashMap<Arc<Path>, Arc<Sheet>>;

/// A table that the editor has open.
pub(super) struct Sheet {
    pub uri: Uri,
    pub version: i32,
    /// Its text; it is no program and is not read as one.
    pub document: Document,
}

impl Workspace {
    /// Takes a document that is a table; gives back any other.
    pub(super) fn open_sheet(&self, item: TextDocumentItem) -> Option<TextDocumentItem> {
        let path = file_path(&item.uri).filter(|path| is_table_file(path));
        let Some(path) = path else { return Some(item) };
        let document = unread(&item.text);
        self.put_sheet(&path, Some(Sheet { uri: item.uri, version: item.version, document }));
        None
    }

    /// Changes a table; false if no table with that address is open.
    pub(super) fn change_sheet(&self, params: &DidChangeTextDocumentParams) -> bool {
        let Some(path) = file_path(&params.text_document.uri) else { return false };
        let snapshot = self.snapshot();
        let Some(sheet) = snapshot.sheets.get(&canonical(&path)) else { return false };
        let mut document = sheet.document.clone();
        for change in &params.content_changes {
            let edit = edit_of(&document, change.clone(), snapshot.manner.encoding);
            document = unread(&spliced(&document, &edit));
        }
        let (uri, version) = (sheet.uri.clone(), params.text_document.version);
        self.put_sheet(&path, Some(Sheet { uri, version, document }));
        true
    }

    /// Forgets a table that is closed; false if it was none.
    pub(super) fn close_sheet(&self, uri: &Uri) -> bool {
        let Some(path) = file_path(uri) else { return false };
        let is_open = self.snapshot().sheets.contains_key(&canonical(&path));
        if is_open {
            self.put_sheet(&path, None);
        }
        is_open
    }

    /// Puts a table into the state and has the projects read again that take their comments from it.
    fn put_sheet(&self, path: &Path, sheet: Option<Sheet>) {
        let mut state = self.state();
        let key = canonical(path);
        let sheets = Arc::make_mut(&mut state.snapshot.sheets);
        match sheet {
            Some(sheet) => _ = sheets.insert(key.clone(), Arc::new(sheet)),
            None => _ = sheets.remove(&key),
        }
        let Some(keeper) = &state.keeper else { return };
        let names = |root: &Path, manifest: &Manifest| {
            path_of(root, manifest).is_some_and(|one| canonical(&one) == key)
        };
        let mut is_known = false;
        for (project, loaded) in state.snapshot.projects.iter() {
            if names(&loaded.root, &loaded.manifest) {
                is_known = true;
                keeper.read(project.clone(), loaded.root.clone());
            }
        }
        if !is_known
            && let Some(project) = Project::of(path).filter(|project| names(&project.root, &project.manifest))
        {
            keeper.read(canonical(&project.root), project.root);
        }
    }
}

fn unread(text: &str) -> Document {
    Document::unread(text, Notation::FxIl, Target::of(Model::Fx2n))
}

/// Where the comments file of a project is, if it has one.
fn path_of(root: &Path, manifest: &Manifest) -> Option<PathBuf> {
    manifest.comments.as_ref().map(|name| root.join(name))
}

/// The comments file of the project in `root`: as the editor has it, else as the disk.
pub(super) fn comments_file(root: &Path, manifest: &Manifest, sheets: &Sheets) -> Option<Arc<CommentsFile>> {
    let path = path_of(root, manifest)?;
    let target = manifest.target().unwrap_or(Target::of(Model::Fx2n));
    Some(Arc::new(match sheets.get(&canonical(&path)) {
        Some(sheet) => CommentsFile::read(&path, &sheet.document.text(), target),
        None => CommentsFile::open(&path, target),
    }))
}

/// What is wrong in the comments file of a project, for publishing.
pub(super) fn findings(snapshot: &Snapshot, loaded: &Loaded) -> Option<(Uri, Vec<lsp::Diagnostic>)> {
    let file = loaded.comments_file.as_ref()?;
    let graded = file.graded(&loaded.manifest.severities());
    let around = around(snapshot, file)?;
    let uri = around.here().uri.clone();
    Some((uri, to_proto::diagnostics(&around, graded, snapshot.manner)))
}

/// The comments file as a document, with the address that the editor gave it if it is open.
pub(super) fn around(snapshot: &Snapshot, file: &CommentsFile) -> Option<Around> {
    let sheet = snapshot.sheets.get(&canonical(&file.path));
    let uri = sheet.map(|sheet| sheet.uri.clone()).or_else(|| Uri::from_file_path(&file.path))?;
    Some(Around::alone(&Arc::new(Open {
        uri,
        version: sheet.map_or(0, |sheet| sheet.version),
        is_open: sheet.is_some(),
        path: None,
        project: None,
        document: unread(file.text()),
        manifest: Arc::default(),
        severities: Arc::default(),
        known: Known::default(),
    })))
}
