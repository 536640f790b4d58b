//! The state of the server: settings and open documents, changed in message order, read through snapshots.

use super::capabilities;
use super::manifests::Manifests;
use super::publisher::Publisher;
use super::settings::{Settings, Speech};
use super::to_proto::Manner;
use crate::check::Severities;
use crate::document::{Document, Edit, Notation};
use crate::project::{Manifest, Project, decide};
use crate::target::{Model, Target};
use crate::text::{Encoding, Language, LineColumn};
use rustc_hash::{FxHashMap, FxHashSet};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::task::JoinHandle;
use tower_lsp::Client;
use tower_lsp::ls_types::{
    DidChangeConfigurationParams, DidChangeTextDocumentParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, DidSaveTextDocumentParams, InitializeParams, LSPAny,
    TextDocumentContentChangeEvent, TextDocumentItem, Uri,
};

/// A document up to this size, a rung or so, is looked at after each edit for what it is; a longer one when it is
/// saved, lest a half-typed word turn the whole of it into another language.
const UNDECIDED_BYTES: usize = 128;

tokio::task_local! {
    /// The state at the moment when the request was read.
    pub(super) static SNAPSHOT: Snapshot;
}

/// The state at one moment. Cloning copies two pointers.
#[derive(Clone, Default)]
pub(super) struct Snapshot {
    pub manner: Manner,
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
    initialised: AtomicBool,
    shut_down: AtomicBool,
}

#[derive(Default)]
struct State {
    snapshot: Snapshot,
    publishers: FxHashMap<Uri, Publisher>,
    /// Publishers of closed documents that are not done yet.
    closing: FxHashMap<Uri, JoinHandle<()>>,
    manifests: Manifests,
    speech: Speech,
    watches: bool,
}

impl Snapshot {
    /// The open document, if it is one.
    pub(super) fn open(&self, uri: &Uri) -> Option<&Arc<Open>> {
        self.documents.get(uri)
    }

    /// How many documents are open.
    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.documents.len()
    }
}

impl Workspace {
    pub(super) fn new(client: Client, speech: Speech) -> Workspace {
        Workspace {
            client,
            state: Mutex::new(State { speech, ..State::default() }),
            initialised: AtomicBool::new(false),
            shut_down: AtomicBool::new(false),
        }
    }

    pub(super) fn snapshot(&self) -> Snapshot {
        self.state().snapshot.clone()
    }

    pub(super) fn was_shut_down(&self) -> bool {
        self.shut_down.load(Ordering::Relaxed)
    }

    /// Whether the client wants to be asked to watch files.
    pub(super) fn watches(&self) -> bool {
        self.state().watches
    }

    /// Takes from a message what it says about the life of the server. What `initialize` says is in force before the
    /// next message is read, although its answer is made later.
    pub(super) fn note_lifecycle(&self, method: &str, params: Option<&LSPAny>) {
        match method {
            "initialize" if !self.initialised.load(Ordering::Relaxed) => {
                if let Ok(params) = InitializeParams::deserialize(params.unwrap_or(&Value::Null)) {
                    self.initialise(&params);
                }
            }
            "shutdown" if self.initialised.load(Ordering::Relaxed) => {
                self.shut_down.store(true, Ordering::Relaxed);
            }
            _ => {}
        }
    }

    fn initialise(&self, params: &InitializeParams) {
        let mut state = self.state();
        state.speech.client = params.locale.as_deref().map(Language::of_locale);
        let settings = Settings::read(params.initialization_options.as_ref()).unwrap_or_default();
        state.snapshot.manner = Manner {
            encoding: capabilities::encoding_for(&params.capabilities),
            language: settings.language(state.speech),
        };
        state.snapshot.settings = Arc::new(settings);
        state.watches = capabilities::can_watch(&params.capabilities);
        self.initialised.store(true, Ordering::Relaxed);
    }

    /// Applies a notification that changes state; false for every other message.
    ///
    /// A notification that cannot be read changes nothing: the client would not look at an answer, the log has it.
    /// Before `initialize` and after `shutdown` they are dropped, as the protocol wants.
    pub(super) fn apply(&self, method: &str, params: Option<&LSPAny>) -> bool {
        let runs = self.initialised.load(Ordering::Relaxed) && !self.was_shut_down();
        match method {
            _ if !runs => return is_change_of_state(method),
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
        let TextDocumentItem { uri, language_id, version, text } = params.text_document;
        let mut state = self.state();
        let manifest = Arc::new(self.manifest_of(&mut state, &uri).0);
        let is_ladder = language_id == "ladder";
        let (notation, target) = decided(&uri, &text, &manifest, &state.snapshot.settings, is_ladder);
        let document = read(&text, notation, target);
        // A document that is opened a second time was closed in the client's eyes.
        if let Some(publisher) = state.publishers.remove(&uri) {
            let task = publisher.close(uri.clone());
            state.closing.insert(uri.clone(), task);
        }
        let before = state.closing.remove(&uri);
        let snapshot = &state.snapshot;
        let publisher = Publisher::start(self.client.clone(), snapshot.manner, &snapshot.settings, before);
        state.publishers.insert(uri.clone(), publisher);
        let severities = Arc::new(manifest.severities());
        state.put(Open { uri, version, document, manifest, severities });
    }

    fn change(&self, params: DidChangeTextDocumentParams) {
        let mut state = self.state();
        let Some(open) = state.snapshot.open(&params.text_document.uri) else {
            tracing::warn!("a change of a document that is not open");
            return;
        };
        let mut open = Open::clone(open);
        let was_short = open.document.len() <= UNDECIDED_BYTES;
        open.version = params.text_document.version;
        for change in params.content_changes {
            let edit = edit_of(&open.document, change, state.snapshot.manner.encoding);
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
        if was_short || open.document.len() <= UNDECIDED_BYTES {
            open.decide_again(&state.snapshot.settings);
        }
        state.put(open);
    }

    fn close(&self, params: DidCloseTextDocumentParams) {
        let mut state = self.state();
        let uri = params.text_document.uri;
        Arc::make_mut(&mut state.snapshot.documents).remove(&uri);
        if let Some(publisher) = state.publishers.remove(&uri) {
            state.closing.retain(|_, task| !task.is_finished());
            let task = publisher.close(uri.clone());
            state.closing.insert(uri, task);
        }
    }

    fn save(&self, params: DidSaveTextDocumentParams) {
        let mut state = self.state();
        if let Some(open) = state.snapshot.open(&params.text_document.uri) {
            let mut open = Open::clone(open);
            open.decide_again(&state.snapshot.settings);
            state.put(open);
        }
    }

    fn configure(&self, params: DidChangeConfigurationParams) {
        // A client without settings says so with `null`; what `initialize` said stays in force.
        let Some(settings) = Settings::read(Some(&params.settings)) else { return };
        let mut state = self.state();
        state.snapshot.manner.language = settings.language(state.speech);
        state.snapshot.settings = Arc::new(settings);
        drop(state);
        self.reread_projects();
    }

    /// Reads manifests anew, and the documents whose language, target or severities thereby change.
    fn reread_projects(&self) {
        let mut state = self.state();
        let opens: Vec<Arc<Open>> = state.snapshot.documents.values().cloned().collect();
        let mut seen = FxHashSet::default();
        for open in opens {
            let (manifest, place) = self.manifest_of(&mut state, &open.uri);
            seen.extend(place);
            let mut open = Open::clone(&open);
            if *open.manifest != manifest {
                open.severities = Arc::new(manifest.severities());
                open.manifest = Arc::new(manifest);
            }
            open.decide_again(&state.snapshot.settings);
            state.put(open);
        }
        state.manifests.forget_others(&self.client, &seen);
    }

    /// The manifest for a document, and where it is. What is wrong with it is told to the user.
    fn manifest_of(&self, state: &mut State, uri: &Uri) -> (Manifest, Option<Uri>) {
        let project = uri.to_file_path().and_then(|path| Project::of(&path));
        let Some(project) = project else { return (Manifest::default(), None) };
        let place = state.manifests.note(&self.client, &project, state.snapshot.manner);
        (project.manifest, place)
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
            publisher.publish(open, self.snapshot.manner);
        }
    }
}

impl Open {
    /// Decides anew in which language and for which target the document is written, and reads it anew if that
    /// changed: what is typed into an empty file says what it is only after some lines.
    fn decide_again(&mut self, settings: &Settings) {
        let text = self.document.text();
        let is_ladder = self.document.notation() == Notation::Ladder;
        let (notation, target) = decided(&self.uri, &text, &self.manifest, settings, is_ladder);
        if (notation, target.name) != (self.document.notation(), self.document.target().name) {
            self.document = read(&text, notation, target);
        }
    }
}

fn is_change_of_state(method: &str) -> bool {
    method.starts_with("textDocument/did") || method.starts_with("workspace/didChange")
}

/// `is_ladder` is what the client says of the language: a text that has no file yet has no ending to tell by.
fn decided(
    uri: &Uri,
    text: &str,
    manifest: &Manifest,
    settings: &Settings,
    is_ladder: bool,
) -> (Notation, &'static Target) {
    let name = uri.path().as_str();
    let notation = if is_ladder { Some(Notation::Ladder) } else { settings.notation() };
    guarded(|| decide(name, text, manifest, settings.target(), notation))
        .unwrap_or((Notation::FxIl, Target::of(Model::Fx2n)))
}

fn read(text: &str, notation: Notation, target: &'static Target) -> Document {
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
