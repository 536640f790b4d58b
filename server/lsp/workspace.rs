//! The state of the server: settings and open documents, changed in message order, read through snapshots.

use super::publisher::Publisher;
use super::settings::Settings;
use crate::check::Severities;
use crate::document::{Document, Edit, Notation};
use crate::project::{Manifest, Project, decide};
use crate::text::{Encoding, LineColumn};
use rustc_hash::FxHashMap;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tower_lsp::Client;
use tower_lsp::ls_types::{
    DidChangeConfigurationParams, DidChangeTextDocumentParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, DidSaveTextDocumentParams, LSPAny, TextDocumentContentChangeEvent, Uri,
};

tokio::task_local! {
    /// The state at the moment when the request was read.
    pub(super) static SNAPSHOT: Snapshot;
}

/// The state at one moment. Cloning copies two pointers.
#[derive(Clone, Default)]
pub(super) struct Snapshot {
    pub encoding: Encoding,
    pub settings: Arc<Settings>,
    documents: Arc<FxHashMap<Uri, Arc<Open>>>,
}

/// An open document.
#[derive(Clone)]
pub(super) struct Open {
    pub uri: Uri,
    pub version: i32,
    pub document: Document,
    pub manifest: Arc<Manifest>,
    pub severities: Arc<Severities>,
}

/// The state, and what goes on beside it.
pub(super) struct Workspace {
    pub client: Client,
    state: Mutex<State>,
    shut_down: AtomicBool,
}

#[derive(Default)]
struct State {
    snapshot: Snapshot,
    publishers: FxHashMap<Uri, Publisher>,
}

impl Snapshot {
    /// The open document, if it is one.
    pub(super) fn open(&self, uri: &Uri) -> Option<&Arc<Open>> {
        self.documents.get(uri)
    }
}

impl Workspace {
    pub(super) fn new(client: Client) -> Workspace {
        Workspace { client, state: Mutex::default(), shut_down: AtomicBool::new(false) }
    }

    pub(super) fn snapshot(&self) -> Snapshot {
        self.state().snapshot.clone()
    }

    pub(super) fn was_shut_down(&self) -> bool {
        self.shut_down.load(Ordering::Relaxed)
    }

    pub(super) fn note_method(&self, method: &str) {
        if method == "shutdown" {
            self.shut_down.store(true, Ordering::Relaxed);
        }
    }

    /// Takes what `initialize` says.
    pub(super) fn initialise(&self, encoding: Encoding, settings: Settings) {
        let mut state = self.state();
        state.snapshot.encoding = encoding;
        state.snapshot.settings = Arc::new(settings);
    }

    /// Applies a notification that changes state; false for every other message.
    ///
    /// A notification that cannot be read changes nothing: the client would not look at an answer, the log has it.
    pub(super) fn apply(&self, method: &str, params: Option<&LSPAny>) -> bool {
        match method {
            "textDocument/didOpen" => self.with(params, Workspace::open),
            "textDocument/didChange" => self.with(params, Workspace::change),
            "textDocument/didClose" => self.with(params, Workspace::close),
            "textDocument/didSave" => self.with(params, Workspace::save),
            "workspace/didChangeConfiguration" => self.with(params, Workspace::configure),
            "workspace/didChangeWatchedFiles" => self.reread_projects(),
            _ => return false,
        }
        true
    }

    fn with<P: DeserializeOwned>(&self, params: Option<&LSPAny>, apply: fn(&Workspace, P)) {
        match P::deserialize(params.unwrap_or(&Value::Null)) {
            Ok(params) => apply(self, params),
            Err(reason) => tracing::warn!("a notification could not be read: {reason}"),
        }
    }

    fn open(&self, params: DidOpenTextDocumentParams) {
        let item = params.text_document;
        let mut state = self.state();
        let manifest = Arc::new(manifest_of(&item.uri));
        let is_ladder = item.language_id == "ladder";
        let document = read(&item.uri, &item.text, &manifest, &state.snapshot.settings, is_ladder);
        let severities = Arc::new(manifest.severities());
        let open = Open { uri: item.uri.clone(), version: item.version, document, manifest, severities };
        let publisher =
            Publisher::start(self.client.clone(), state.snapshot.encoding, &state.snapshot.settings);
        state.publishers.insert(item.uri, publisher);
        state.put(open);
    }

    fn change(&self, params: DidChangeTextDocumentParams) {
        let mut state = self.state();
        let Some(open) = state.snapshot.open(&params.text_document.uri) else {
            tracing::warn!("a change of a document that is not open");
            return;
        };
        let mut open = Open::clone(open);
        open.version = params.text_document.version;
        for change in params.content_changes {
            let edit = edit_of(&open.document, change, state.snapshot.encoding);
            let (notation, target) = (open.document.notation(), open.document.target());
            let edited = guarded(|| {
                let mut document = open.document.clone();
                document.apply(std::slice::from_ref(&edit));
                document
            });
            // The text must stay the client's text even if reading it fails.
            open.document = edited
                .or_else(|| guarded(|| Document::new(&spliced(&open.document, &edit), notation, target)))
                .unwrap_or_else(|| Document::unread(&spliced(&open.document, &edit), notation, target));
        }
        state.put(open);
    }

    fn close(&self, params: DidCloseTextDocumentParams) {
        let mut state = self.state();
        let uri = params.text_document.uri;
        Arc::make_mut(&mut state.snapshot.documents).remove(&uri);
        if let Some(publisher) = state.publishers.remove(&uri) {
            publisher.close(uri);
        }
    }

    fn save(&self, params: DidSaveTextDocumentParams) {
        let state = self.state();
        let uri = params.text_document.uri;
        if let (Some(publisher), Some(open)) = (state.publishers.get(&uri), state.snapshot.open(&uri)) {
            publisher.publish(open.clone());
        }
    }

    fn configure(&self, params: DidChangeConfigurationParams) {
        self.state().snapshot.settings = Arc::new(Settings::read(Some(&params.settings)));
        self.reread_projects();
    }

    /// Reads manifests anew, and the documents whose language, target or severities thereby change.
    fn reread_projects(&self) {
        let mut state = self.state();
        let opens: Vec<Arc<Open>> = state.snapshot.documents.values().cloned().collect();
        for open in opens {
            let manifest = Arc::new(manifest_of(&open.uri));
            let text = open.document.text();
            let is_ladder = open.document.notation() == Notation::Ladder;
            let document = read(&open.uri, &text, &manifest, &state.snapshot.settings, is_ladder);
            let severities = Arc::new(manifest.severities());
            state.put(Open { document, manifest, severities, ..Open::clone(&open) });
        }
    }

    /// A panic while the lock was held leaves whole values behind it: each is put in one assignment.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Makes `open` the document's state, and publishes it.
    fn put(&mut self, open: Open) {
        let open = Arc::new(open);
        Arc::make_mut(&mut self.snapshot.documents).insert(open.uri.clone(), open.clone());
        if let Some(publisher) = self.publishers.get(&open.uri) {
            publisher.publish(open);
        }
    }
}

fn manifest_of(uri: &Uri) -> Manifest {
    let project = uri.to_file_path().and_then(|path| Project::of(&path));
    project.map(|project| project.manifest).unwrap_or_default()
}

/// `is_ladder` is what the client says of the language: a text that has no file yet has no ending to tell by.
fn read(uri: &Uri, text: &str, manifest: &Manifest, settings: &Settings, is_ladder: bool) -> Document {
    let name = uri.path().as_str();
    let notation = if is_ladder { Some(Notation::Ladder) } else { settings.notation() };
    let decided = guarded(|| decide(name, text, manifest, settings.target(), notation));
    let (notation, target) =
        decided.unwrap_or((Notation::FxIl, crate::target::Target::of(crate::target::Model::Fx2n)));
    guarded(|| Document::new(text, notation, target))
        .unwrap_or_else(|| Document::unread(text, notation, target))
}

/// The value, or nothing and a line in the log if making it panics.
fn guarded<T>(make: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(make))
        .inspect_err(|_| tracing::error!("reading a document failed; it is kept without analysis"))
        .ok()
}

fn edit_of(document: &Document, change: TextDocumentContentChangeEvent, encoding: Encoding) -> Edit {
    let offset = |position: tower_lsp::ls_types::Position| {
        document.offset(LineColumn { line: position.line, column: position.character }, encoding)
    };
    let range = change.range.map(|range| {
        let start = offset(range.start);
        start..offset(range.end).max(start)
    });
    Edit { range, text: change.text }
}

fn spliced(document: &Document, edit: &Edit) -> String {
    let Some(range) = &edit.range else { return edit.text.clone() };
    let mut text = document.text();
    text.replace_range(range.clone(), &edit.text);
    text
}
