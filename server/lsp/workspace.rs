//! The state of the server: settings and open documents, changed in message order, read through snapshots.

use super::abilities::{Abilities, Newer, Requests};
use super::capabilities;
use super::keeper::Keeper;
use super::known::Known;
use super::manifests::Manifests;
use super::projects::{Projects, canonical, file_path};
use super::publisher::{Closing, Publisher};
use super::settings::{Settings, Speech};
use super::sheets::Sheets;
use super::status::ToldLine;
use super::to_proto::Manner;
use super::tokens::SentTokens;
use crate::check::Severities;
use crate::document::{Document, Edit, Notation};
use crate::project::{MANIFEST_NAME, Manifest, Project, decide};
use crate::scenario::SUITE_ENDING;
use crate::target::{Model, Target};
use crate::text::{Encoding, Language, LineColumn};
use rustc_hash::{FxHashMap, FxHashSet};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::Duration;
use tower_lsp::Client;
use tower_lsp::ls_types::{
    DidChangeTextDocumentParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams,
    DidSaveTextDocumentParams, InitializeParams, LSPAny, TextDocumentContentChangeEvent, TextDocumentItem,
    Uri,
};

/// A document up to this size, a rung or so, is looked at after each edit for what it is; a longer one when it is
/// saved, lest a half-typed word turn the whole of it into another language.
const UNDECIDED_BYTES: usize = 128;

/// A document whose project is read for the first time is published without it after this time.
const AWAITED: Duration = Duration::from_millis(150);

tokio::task_local! {
    /// The state at the moment when the request was read.
    pub(super) static SNAPSHOT: Snapshot;
}

/// The state at one moment. Cloning copies some pointers.
#[derive(Clone, Default)]
pub(super) struct Snapshot {
    pub manner: Manner,
    pub settings: Arc<Settings>,
    pub projects: Arc<Projects>,
    pub sheets: Arc<Sheets>,
    documents: Arc<FxHashMap<Uri, Arc<Open>>>,
    /// The open document of each file, by canonical path.
    paths: Arc<FxHashMap<Arc<Path>, Uri>>,
}

/// An open document, or a file of a project as the disk has it.
#[derive(Clone, Debug)]
pub(super) struct Open {
    pub uri: Uri,
    /// That of the editor; 0 for a file that is not open.
    pub version: i32,
    /// Whether the editor has it.
    pub is_open: bool,
    /// The canonical path of its file, if it is one.
    pub path: Option<Arc<Path>>,
    /// The canonical folder of the project to which it belongs, if any.
    pub project: Option<Arc<Path>>,
    pub document: Document,
    pub manifest: Arc<Manifest>,
    pub severities: Arc<Severities>,
    /// What was found in it last.
    pub known: Known,
}

/// The state, and what goes on beside it.
pub(super) struct Workspace {
    pub client: Client,
    pub tokens: SentTokens,
    /// The PLC that is connected, as it was told with the status of programs.
    pub line: ToldLine,
    state: Mutex<State>,
    initialised: AtomicBool,
    shut_down: AtomicBool,
}

/// What may change while messages are read.
#[derive(Default)]
pub(super) struct State {
    pub snapshot: Snapshot,
    publishers: FxHashMap<Uri, Publisher>,
    /// Publishers of closed documents that are not done yet.
    closing: FxHashMap<Uri, Closing>,
    pub manifests: Manifests,
    pub keeper: Option<Keeper>,
    pub speech: Speech,
    /// Projects that are read for the first time: their documents wait for what the other files declare.
    pub awaited: FxHashSet<Arc<Path>>,
    /// Folders that the client has open, as it spells them.
    pub folders: Vec<(Uri, PathBuf)>,
    /// The settings as the client sent them.
    pub settings_source: Option<Value>,
    pub requests: Requests,
    this: Weak<Workspace>,
}

impl Snapshot {
    /// The open document, if it is one.
    pub(super) fn open(&self, uri: &Uri) -> Option<&Arc<Open>> {
        self.documents.get(uri)
    }

    /// The open document, if it is a program.
    pub(super) fn program(&self, uri: &Uri) -> Option<&Arc<Open>> {
        self.open(uri).filter(|open| !is_toml(&open.uri))
    }

    /// The open document of the file at a canonical path.
    pub(super) fn open_at(&self, path: &Arc<Path>) -> Option<&Arc<Open>> {
        self.documents.get(self.paths.get(path)?)
    }

    /// The open documents that belong to a project.
    pub(super) fn opens_of(&self, project: &Arc<Path>) -> Vec<Arc<Open>> {
        let opens = self.documents.values().filter(|open| open.project.as_ref() == Some(project));
        opens.cloned().collect()
    }

    /// All open documents, in no order.
    pub(super) fn opens(&self) -> impl Iterator<Item = &Arc<Open>> {
        self.documents.values()
    }

    /// How many documents are open.
    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.documents.len()
    }
}

impl Workspace {
    pub(super) fn new(client: Client, speech: Speech) -> Arc<Workspace> {
        Arc::new(Workspace {
            client,
            tokens: SentTokens::default(),
            line: ToldLine::default(),
            state: Mutex::new(State { speech, ..State::default() }),
            initialised: AtomicBool::new(false),
            shut_down: AtomicBool::new(false),
        })
    }

    pub(super) fn snapshot(&self) -> Snapshot {
        self.state().snapshot.clone()
    }

    pub(super) fn was_shut_down(&self) -> bool {
        self.shut_down.load(Ordering::Relaxed)
    }

    /// What the client may be asked for.
    pub(super) fn requests(&self) -> Requests {
        self.state().requests
    }

    /// Takes from a message what it says about the life of the server. What `initialize` says is in force before the
    /// next message is read, although its answer is made later.
    pub(super) fn note_lifecycle(self: &Arc<Workspace>, method: &str, source: Option<&LSPAny>) {
        match method {
            "initialize" if !self.initialised.load(Ordering::Relaxed) => {
                if let Ok(params) = InitializeParams::deserialize(source.unwrap_or(&Value::Null)) {
                    self.initialise(&params, Newer::of(source));
                }
            }
            "shutdown" if self.initialised.load(Ordering::Relaxed) => {
                self.shut_down.store(true, Ordering::Relaxed);
            }
            _ => {}
        }
    }

    fn initialise(self: &Arc<Workspace>, params: &InitializeParams, newer: Newer) {
        let mut state = self.state();
        state.keeper = Some(Keeper::start(self));
        state.speech.client = params.locale.as_deref().map(Language::of_locale);
        let settings = Settings::read(params.initialization_options.as_ref()).unwrap_or_default();
        state.snapshot.manner = Manner {
            encoding: capabilities::encoding_for(&params.capabilities),
            language: settings.language(state.speech),
            abilities: Abilities::of(&params.capabilities),
        };
        state.settings_source = params.initialization_options.clone();
        state.snapshot.settings = Arc::new(settings);
        state.requests = Requests { newer, ..Requests::of(&params.capabilities) };
        // A client that sends its settings of its own accord would answer with something else, such as its defaults.
        if state.settings_source.as_ref().is_some_and(|source| !source.is_null()) {
            state.requests.configuration = false;
            state.requests.watch_configuration = false;
        }
        state.this = Arc::downgrade(self);
        self.take_folders(&mut state, params);
        self.initialised.store(true, Ordering::Relaxed);
    }

    /// Applies a notification that changes state; false for every other message.
    ///
    /// A notification that cannot be read changes nothing: the client would not look at an answer, the log has it.
    /// Before `initialize` and after `shutdown` they are dropped, as the protocol wants.
    pub(super) fn apply(self: &Arc<Workspace>, method: &str, params: Option<&LSPAny>) -> bool {
        let runs = self.initialised.load(Ordering::Relaxed) && !self.was_shut_down();
        match method {
            _ if !runs => return is_change_of_state(method),
            "textDocument/didOpen" => self.with(params, Workspace::open),
            "textDocument/didChange" => self.with(params, Workspace::change),
            "textDocument/didClose" => self.with(params, Workspace::close),
            "textDocument/didSave" => self.with(params, Workspace::save),
            "workspace/didChangeConfiguration" => self.with(params, |_, params| self.configure(&params)),
            "workspace/didChangeWatchedFiles" => self.with(params, Workspace::change_files),
            "workspace/didChangeWorkspaceFolders" => self.with(params, Workspace::change_folders),
            _ => return false,
        }
        true
    }

    fn with<P: DeserializeOwned>(&self, params: Option<&LSPAny>, apply: impl FnOnce(&Workspace, P)) {
        match P::deserialize(params.unwrap_or(&Value::Null)) {
            Ok(params) => apply(self, params),
            Err(reason) => tracing::warn!("a notification could not be read: {reason}"),
        }
    }

    fn open(&self, params: DidOpenTextDocumentParams) {
        let Some(item) = self.open_sheet(params.text_document) else { return };
        let TextDocumentItem { uri, language_id, version, text } = item;
        let mut state = self.state();
        // A document that is opened a second time was closed in the client's eyes.
        if let Some(publisher) = state.publishers.remove(&uri) {
            let closing = publisher.close(uri.clone(), None);
            state.closing.insert(uri.clone(), closing);
        }
        // Before the text is read, which may take a while: what was published is not to be cleared.
        let before = state.closing.remove(&uri).map(Closing::superseded);
        let path = file_path(&uri).map(|path| canonical(&path));
        if is_toml(&uri) {
            state.manifests.open(&self.client, &uri, path.as_ref());
        }
        let Belonging { manifest, project, .. } = self.belonging(&mut state, &uri);
        let manifest = Arc::new(manifest);
        let is_ladder = language_id == "ladder";
        let (notation, target) = decided(&uri, &text, &manifest, &state.snapshot.settings, is_ladder);
        let document = match is_toml(&uri) {
            true => Document::unread(&text, notation, target),
            false => read(&text, notation, target),
        };
        let loaded = project.as_ref().and_then(|key| state.snapshot.projects.get(key));
        let document = match loaded {
            Some(loaded) => loaded.placed(document, path.as_ref()),
            None => document,
        };
        let snapshot = &state.snapshot;
        if !is_toml(&uri) {
            let publisher = Publisher::start(state.this.clone(), &self.client, snapshot, before);
            state.publishers.insert(uri.clone(), publisher);
        }
        let severities = Arc::new(manifest.severities());
        if let Some(path) = &path {
            Arc::make_mut(&mut state.snapshot.paths).entry(path.clone()).or_insert_with(|| uri.clone());
        }
        state.put(Open {
            uri,
            version,
            is_open: true,
            path,
            project,
            document,
            manifest,
            severities,
            known: Known::default(),
        });
    }

    fn change(&self, params: DidChangeTextDocumentParams) {
        if self.change_sheet(&params) {
            return;
        }
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
            if is_toml(&open.uri) {
                open.document = Document::unread(&spliced(&open.document, &edit), notation, target);
                continue;
            }
            let edited = guarded(|| {
                let mut document = open.document.clone();
                document.apply(std::slice::from_ref(&edit));
                document
            });
            // The text must stay the client's text even if reading it fails.
            open.document = edited
                .or_else(|| {
                    let document =
                        guarded(|| Document::new(&spliced(&open.document, &edit), notation, target));
                    Some(document?.linked_as(&open.document))
                })
                .unwrap_or_else(|| Document::unread(&spliced(&open.document, &edit), notation, target));
        }
        if was_short || open.document.len() <= UNDECIDED_BYTES {
            open.decide_again(&state.snapshot.settings);
        }
        state.put(open);
    }

    fn close(&self, params: DidCloseTextDocumentParams) {
        if self.close_sheet(&params.text_document.uri) {
            return;
        }
        let mut state = self.state();
        let uri = params.text_document.uri;
        self.tokens.forget(&uri);
        let closed = Arc::make_mut(&mut state.snapshot.documents).remove(&uri);
        let Some(closed) = closed else { return };
        state.forget_path(&closed);
        if is_toml(&uri) {
            state.manifests.close(&self.client, &uri);
            drop(state);
            if is_manifest(&uri) {
                // From now on the disk has the say.
                self.reread_projects();
            }
            return;
        }
        if let Some(publisher) = state.publishers.remove(&uri) {
            state.closing.retain(|_, closing| !closing.is_done());
            let heir = state.heir(&closed);
            let closing = publisher.close(uri.clone(), heir);
            state.closing.insert(uri, closing);
        }
    }

    fn save(&self, params: DidSaveTextDocumentParams) {
        let mut state = self.state();
        if let Some(open) = state.snapshot.open(&params.text_document.uri) {
            let mut open = Open::clone(open);
            open.decide_again(&state.snapshot.settings);
            state.put(open);
        }
        drop(state);
        if is_manifest(&params.text_document.uri) {
            self.reread_projects();
        }
        self.look_around(&params.text_document.uri);
    }

    /// Reads manifests anew, and the documents whose language, target or severities thereby change.
    pub(super) fn reread_projects(&self) {
        let mut state = self.state();
        let opens: Vec<Arc<Open>> = state.snapshot.documents.values().cloned().collect();
        let mut seen = FxHashSet::default();
        for open in opens {
            let Belonging { manifest, place, project } = self.belonging(&mut state, &open.uri);
            seen.extend(place);
            let mut open = Open::clone(&open);
            if open.project != project {
                open.document = open.document.unlinked();
                open.project = project;
            }
            if *open.manifest != manifest {
                open.severities = Arc::new(manifest.severities());
                open.manifest = Arc::new(manifest);
            }
            open.decide_again(&state.snapshot.settings);
            state.put(open);
        }
        state.manifests.forget_others(&self.client, &seen);
        if let Some(keeper) = &state.keeper {
            for (key, loaded) in state.snapshot.projects.iter() {
                keeper.read(key.clone(), loaded.root.clone());
            }
        }
    }

    /// To which project a document belongs. What is wrong with its manifest is told to the user. A project that is met
    /// for the first time is read in the background.
    fn belonging(&self, state: &mut State, uri: &Uri) -> Belonging {
        let Some(project) = file_path(uri).and_then(|path| Project::of(&path)) else {
            return Belonging::default();
        };
        let place = state.manifests.note(&self.client, &project, state.snapshot.manner);
        let key = canonical(&project.root);
        if !state.snapshot.projects.contains_key(&key) && state.awaited.insert(key.clone()) {
            state.await_project(&key, &project.root);
        }
        Belonging { manifest: project.manifest, place, project: Some(key) }
    }

    /// Has the client ask again for what other files have a part in. Nobody waits for it.
    pub(super) fn refresh(&self) {
        let state = self.state();
        let (requests, pulls) = (state.requests, state.snapshot.settings.pulls);
        let client = self.client.clone();
        tokio::spawn(async move {
            if requests.refresh_diagnostics && pulls {
                let _ = client.workspace_diagnostic_refresh().await;
            }
            if requests.refresh_hints {
                let _ = client.inlay_hint_refresh().await;
            }
        });
    }

    /// The state of this moment for the judgement of `own`, which sees the other open documents of its project.
    pub(super) fn seen_by(&self, own: &Open) -> Snapshot {
        let state = self.state();
        own.project.iter().for_each(|key| state.note_looks(key, Some(&own.uri)));
        state.snapshot.clone()
    }

    /// The state of this moment for work that looks at all files of a project.
    pub(super) fn seen_by_project(&self, key: &Arc<Path>) -> Snapshot {
        let state = self.state();
        state.note_looks(key, None);
        state.snapshot.clone()
    }

    /// A document changed in a way that the other files of its project see.
    pub(super) fn note_change(&self, key: &Arc<Path>, uri: &Uri) {
        if let Some(keeper) = &self.state().keeper {
            keeper.changed(key.clone(), uri.clone());
        }
    }

    /// Waits until the projects of the documents that are open are read.
    pub(super) async fn settled(&self) {
        let keeper = self.state().keeper.clone();
        if let Some(keeper) = keeper {
            keeper.settled().await;
        }
    }

    /// A panic while the lock was held leaves whole values behind it: each is put in one assignment.
    pub(super) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// To which project a document belongs.
#[derive(Default)]
struct Belonging {
    manifest: Manifest,
    /// The manifest's own place.
    place: Option<Uri>,
    /// The canonical folder.
    project: Option<Arc<Path>>,
}

impl State {
    /// The open documents of a project but `own` are seen as they are. The snapshot that is looked at has to be taken
    /// under the same lock, so that a later version is judged afterwards.
    fn note_looks(&self, key: &Arc<Path>, own: Option<&Uri>) {
        for open in self.snapshot.opens_of(key) {
            if let (Some(publisher), true) = (self.publishers.get(&open.uri), own != Some(&open.uri)) {
                publisher.note_look(open.version);
            }
        }
    }

    /// Who publishes about the file of `closed` from now on, if it belongs to a project.
    fn heir(&self, closed: &Open) -> Option<(Keeper, Arc<Path>)> {
        let key = closed.project.as_ref()?;
        self.snapshot.projects.get(key)?.number_of(closed)?;
        Some((self.keeper.clone()?, key.clone()))
    }

    /// Has a project read for the first time. Its documents wait for it, but not for long.
    fn await_project(&mut self, key: &Arc<Path>, root: &Path) {
        let Some(keeper) = &self.keeper else {
            self.awaited.remove(key);
            return;
        };
        keeper.read(key.clone(), root.to_path_buf());
        let (workspace, key) = (self.this.clone(), key.clone());
        tokio::spawn(async move {
            tokio::time::sleep(AWAITED).await;
            if let Some(workspace) = workspace.upgrade() {
                workspace.wait_no_longer(&key);
            }
        });
    }

    /// Takes note that `closed` is no longer open; its file may still be so under another spelling.
    fn forget_path(&mut self, closed: &Open) {
        let Some(path) = &closed.path else { return };
        let other = self.snapshot.documents.values().find(|open| open.path.as_ref() == Some(path));
        let other = other.map(|open| open.uri.clone());
        let paths = Arc::make_mut(&mut self.snapshot.paths);
        match other {
            Some(uri) => _ = paths.insert(path.clone(), uri),
            None => _ = paths.remove(path),
        }
    }

    /// Makes `open` the document's state, and publishes it.
    pub(super) fn put(&mut self, open: Open) {
        let is_awaited = open.project.as_ref().is_some_and(|project| self.awaited.contains(project));
        let open = Arc::new(open);
        Arc::make_mut(&mut self.snapshot.documents).insert(open.uri.clone(), open.clone());
        if is_toml(&open.uri)
            && let Some(workspace) = self.this.upgrade()
        {
            self.manifests.judge(&workspace.client, &open, self.snapshot.manner);
        }
        if let Some(publisher) = self.publishers.get(&open.uri).filter(|_| !is_awaited) {
            publisher.publish(open, self.snapshot.manner);
        }
    }
}

impl Open {
    /// Decides anew in which language and for which target the document is written, and reads it anew if that
    /// changed: what is typed into an empty file says what it is only after some lines.
    fn decide_again(&mut self, settings: &Settings) {
        if is_toml(&self.uri) {
            return;
        }
        let text = self.document.text();
        let is_ladder = self.document.notation() == Notation::Ladder;
        let (notation, target) = decided(&self.uri, &text, &self.manifest, settings, is_ladder);
        if (notation, target.name) != (self.document.notation(), self.document.target().name) {
            self.document = read(&text, notation, target).linked_as(&self.document);
        }
    }
}

fn is_change_of_state(method: &str) -> bool {
    method.starts_with("textDocument/did") || method.starts_with("workspace/didChange")
}

/// `is_ladder` is what the client says of the language: a text that has no file yet has no ending to tell by.
pub(super) fn decided(
    uri: &Uri,
    text: &str,
    manifest: &Manifest,
    settings: &Settings,
    is_ladder: bool,
) -> (Notation, &'static Target) {
    let name = uri.path().as_str();
    let notation = if is_ladder { Some(Notation::Ladder) } else { settings.notation };
    guarded(|| decide(name, text, manifest, settings.target, notation))
        .unwrap_or((Notation::FxIl, Target::of(Model::Fx2n)))
}

/// A file of the disk, of which nothing is kept that can be read again.
pub(super) fn frugal(text: &str, notation: Notation, target: &'static Target) -> Document {
    guarded(|| Document::frugal(text, notation, target))
        .unwrap_or_else(|| Document::unread(text, notation, target))
}

fn read(text: &str, notation: Notation, target: &'static Target) -> Document {
    guarded(|| Document::new(text, notation, target))
        .unwrap_or_else(|| Document::unread(text, notation, target))
}

/// Whether a document is a manifest: its text is kept for the links in it, and it is no program.
pub(super) fn is_manifest(uri: &Uri) -> bool {
    uri.path().as_str().rsplit('/').next() == Some(MANIFEST_NAME)
}

/// Whether a document has scenario tests.
pub(super) fn is_suite(uri: &Uri) -> bool {
    uri.path().as_str().to_ascii_lowercase().ends_with(SUITE_ENDING)
}

/// Whether a document is a manifest or has scenario tests: neither is a program.
pub(super) fn is_toml(uri: &Uri) -> bool {
    is_manifest(uri) || is_suite(uri)
}

/// The value, or nothing and a line in the log if making it panics.
fn guarded<T>(make: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(make))
        .inspect_err(|_| tracing::error!("reading a document failed; it is kept without analysis"))
        .ok()
}

pub(super) fn edit_of(
    document: &Document,
    change: TextDocumentContentChangeEvent,
    encoding: Encoding,
) -> Edit {
    let offset = |position: tower_lsp::ls_types::Position| {
        document.offset(LineColumn { line: position.line, column: position.character }, encoding)
    };
    let range = change.range.map(|range| {
        let start = offset(range.start);
        start..offset(range.end).max(start)
    });
    Edit { range, text: change.text }
}

pub(super) fn spliced(document: &Document, edit: &Edit) -> String {
    let Some(range) = &edit.range else { return edit.text.clone() };
    let mut text = document.text();
    text.replace_range(range.clone(), &edit.text);
    text
}
