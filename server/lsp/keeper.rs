//! The task that looks after projects: it reads their files, links them, and publishes what is found in those that are
//! not open. One task, so that the disk is asked once at a time and no two pictures of a project compete.

use super::known::Known;
use super::projects::{Loaded, OnDisk, canonical};
use super::settings::Settings;
use super::sheets;
use super::to_proto;
use super::workspace::{Open, Snapshot, Workspace, decided, frugal};
use crate::check;
use crate::document::{Document, Exports};
use crate::project::{
    MANIFEST_NAME, MOST_FILE_BYTES, MOST_FILES, MOST_PROJECT_BYTES, Manifest, Project, Stamp, projects_in,
    read_text,
};
use crate::text::Message;
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};
use std::hash::BuildHasher;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Weak};
use std::time::Duration;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::sync::oneshot;
use tower_lsp::ls_types::{Diagnostic, MessageType, Uri};

/// Changes in quick succession are taken together.
const PAUSE: Duration = Duration::from_millis(60);

/// Gives orders to the task.
#[derive(Clone)]
pub(super) struct Keeper {
    orders: UnboundedSender<Order>,
}

/// What is to be done.
enum Order {
    /// Read the project with this canonical folder, which the client spells `root`; files that did not change on the
    /// disk are kept.
    Read { key: Arc<Path>, root: PathBuf },
    /// Read all projects in this folder and below.
    Search { folder: PathBuf },
    /// The project is no longer of interest.
    Forget { key: Arc<Path> },
    /// A document changed in a way that other files see.
    Changed { key: Arc<Path>, uri: Uri },
    /// A document was closed, and its publisher has said its last word.
    Closed { key: Arc<Path>, uri: Uri },
    /// Somebody waits until all that was ordered before is done.
    Settle(oneshot::Sender<()>),
}

impl Keeper {
    /// The task lives as long as the workspace.
    pub(super) fn start(workspace: &Arc<Workspace>) -> Keeper {
        let (orders, receiver) = unbounded_channel();
        let task = Task {
            workspace: Arc::downgrade(workspace),
            published: FxHashMap::default(),
            told: FxHashSet::default(),
        };
        tokio::spawn(task.run(receiver));
        Keeper { orders }
    }

    /// Reads the project in `root`, or reads it again.
    pub(super) fn read(&self, key: Arc<Path>, root: PathBuf) {
        self.send(Order::Read { key, root });
    }

    /// Reads all projects in `folder` and below.
    pub(super) fn search(&self, folder: PathBuf) {
        self.send(Order::Search { folder });
    }

    /// Forgets a project, and takes back what was published about its files.
    pub(super) fn forget(&self, key: Arc<Path>) {
        self.send(Order::Forget { key });
    }

    /// The open document `uri` changed in a way that the other files of its project see.
    pub(super) fn changed(&self, key: Arc<Path>, uri: Uri) {
        self.send(Order::Changed { key, uri });
    }

    /// The document `uri` is open no more; the file on the disk counts from now on.
    pub(super) fn closed(&self, key: Arc<Path>, uri: Uri) {
        self.send(Order::Closed { key, uri });
    }

    /// Waits until projects are known as they were when this was asked.
    pub(super) async fn settled(self) {
        let (done, settled) = oneshot::channel();
        self.send(Order::Settle(done));
        // A task that has ended has nothing left to do.
        let _ = settled.await;
    }

    fn send(&self, order: Order) {
        // Without the task there is no workspace either.
        let _ = self.orders.send(order);
    }
}

/// What the task remembers.
struct Task {
    workspace: Weak<Workspace>,
    /// For each file that is not open what was published about it, as a hash; none stands for an empty list.
    /// With the project to which it belongs.
    published: FxHashMap<Uri, (Arc<Path>, Option<u64>)>,
    /// Projects of which the user was told that they are too large.
    told: FxHashSet<Arc<Path>>,
}

/// Orders that came together.
#[derive(Default)]
struct Batch {
    reads: FxHashMap<Arc<Path>, PathBuf>,
    changed: FxHashMap<Arc<Path>, Vec<Uri>>,
    folders: Vec<PathBuf>,
    forgotten: Vec<Arc<Path>>,
    waiting: Vec<oneshot::Sender<()>>,
}

impl Task {
    async fn run(mut self, mut orders: UnboundedReceiver<Order>) {
        while let Some(first) = orders.recv().await {
            if matches!(first, Order::Changed { .. }) {
                tokio::time::sleep(PAUSE).await;
            }
            let Some(workspace) = self.workspace.upgrade() else { return };
            let mut batch = Batch::default();
            self.take(&workspace, first, &mut batch);
            while let Ok(next) = orders.try_recv() {
                self.take(&workspace, next, &mut batch);
            }
            for key in std::mem::take(&mut batch.forgotten) {
                self.forget(&workspace, &key).await;
            }
            for folder in std::mem::take(&mut batch.folders) {
                let found = tokio::task::spawn_blocking(move || projects_in(&folder)).await;
                let found = found.unwrap_or_default().into_iter();
                batch.reads.extend(found.map(|root| (canonical(&root), root)));
            }
            let mut changed: FxHashSet<Arc<Path>> = FxHashSet::default();
            for (key, root) in &batch.reads {
                if self.read(&workspace, key, root).await {
                    changed.insert(key.clone());
                }
            }
            let keys: FxHashSet<&Arc<Path>> = batch.reads.keys().chain(batch.changed.keys()).collect();
            for key in keys {
                // A single document that changed is published already; others have to be judged anew.
                let by = batch.changed.get(key).map_or(&[][..], Vec::as_slice);
                let is_known = by.len() == 1 && !changed.contains(key);
                let is_changed = !by.is_empty() || changed.contains(key);
                self.link(&workspace, key, if is_known { by } else { &[] }, is_changed).await;
            }
            // Who waits may have gone.
            batch.waiting.into_iter().for_each(|waiting| _ = waiting.send(()));
        }
    }

    fn take(&mut self, workspace: &Arc<Workspace>, order: Order, batch: &mut Batch) {
        match order {
            Order::Read { key, root } => _ = batch.reads.insert(key, root),
            Order::Changed { key, uri } => {
                let uris = batch.changed.entry(key).or_default();
                if !uris.contains(&uri) {
                    uris.push(uri);
                }
            }
            Order::Search { folder } => batch.folders.push(folder),
            Order::Forget { key } => batch.forgotten.push(key),
            Order::Settle(waiting) => batch.waiting.push(waiting),
            Order::Closed { key, uri } => {
                // What the editor's text made be published is not known here, so it is replaced in any case.
                self.published.insert(uri, (key.clone(), Some(0)));
                if let Some(loaded) = workspace.snapshot().projects.get(&key) {
                    batch.reads.insert(key, loaded.root.clone());
                }
            }
        }
    }

    async fn forget(&mut self, workspace: &Arc<Workspace>, key: &Arc<Path>) {
        let snapshot = workspace.snapshot();
        let Some(loaded) = snapshot.projects.get(key) else { return };
        workspace.adopt(key, None);
        for file in loaded.files.iter().filter_map(|file| file.file.as_ref()) {
            self.publish(workspace, key, file.uri.clone(), Vec::new()).await;
            self.published.remove(&file.uri);
        }
    }

    /// Reads a project; returns whether there is something new for its open documents.
    async fn read(&mut self, workspace: &Arc<Workspace>, key: &Arc<Path>, root: &Path) -> bool {
        let snapshot = workspace.snapshot();
        let progress = workspace.progress(Message::new("project.reading")).await;
        let work = {
            let (key, root) = (key.clone(), root.to_path_buf());
            move || {
                let old = snapshot.projects.get(&key).map(|old| &**old);
                read_project(&key, &root, old, &snapshot, &progress)
            }
        };
        match tokio::task::spawn_blocking(work).await {
            Ok(loaded) => {
                self.tell_size(workspace, key, loaded.as_ref()).await;
                workspace.adopt(key, loaded)
            }
            Err(failure) => {
                tracing::error!("reading a project failed: {failure}");
                false
            }
        }
    }

    /// Says once that files of a project were passed over.
    async fn tell_size(&mut self, workspace: &Workspace, key: &Arc<Path>, loaded: Option<&Loaded>) {
        let Some(loaded) = loaded.filter(|loaded| loaded.passed_over > 0) else {
            self.told.remove(key);
            return;
        };
        if self.told.insert(key.clone()) {
            let message = Message::new("project.too-large")
                .with("folder", loaded.root.display())
                .with("count", loaded.passed_over)
                .with("files", MOST_FILES)
                .with("megabytes", MOST_PROJECT_BYTES >> 20);
            let language = workspace.snapshot().manner.language;
            workspace.client.show_message(MessageType::WARNING, message.render(language)).await;
        }
    }

    /// Links the files of a project and publishes what changed thereby; `by` is the only document that changed, if
    /// it was one: it is published already.
    async fn link(&mut self, workspace: &Arc<Workspace>, key: &Arc<Path>, by: &[Uri], is_changed: bool) {
        let linking = {
            let (workspace, key) = (workspace.clone(), key.clone());
            tokio::task::spawn_blocking(move || workspace.link(&key)).await
        };
        let mut done = linking.unwrap_or_default();
        let is_changed = is_changed || !done.is_empty();
        done.extend_from_slice(by);
        if is_changed {
            workspace.publish_project(key, &done);
            workspace.refresh();
        }
        self.publish_closed(workspace, key).await;
    }

    /// Publishes what is found in the files of a project that are not open.
    async fn publish_closed(&mut self, workspace: &Arc<Workspace>, key: &Arc<Path>) {
        let snapshot = workspace.seen_by_project(key);
        let wanted = !snapshot.settings.pulls && snapshot.settings.whole_project;
        let found = match wanted {
            true => {
                let (snapshot, key) = (snapshot.clone(), key.clone());
                tokio::task::spawn_blocking(move || closed_findings(&snapshot, &key))
                    .await
                    .unwrap_or_default()
            }
            false => Vec::new(),
        };
        let sheet = snapshot.projects.get(key).and_then(|loaded| sheets::findings(&snapshot, loaded));
        let sheet = sheet.filter(|_| !snapshot.settings.pulls);
        let found = found.into_iter().chain(sheet);
        let of_project = |entry: &(&Uri, &(Arc<Path>, Option<u64>))| entry.1.0 == *key;
        let mut gone: FxHashSet<Uri> =
            self.published.iter().filter(of_project).map(|(uri, _)| uri.clone()).collect();
        for (uri, diagnostics) in found {
            gone.remove(&uri);
            self.publish(workspace, key, uri, diagnostics).await;
        }
        for uri in gone {
            self.publish(workspace, key, uri.clone(), Vec::new()).await;
            self.published.remove(&uri);
        }
    }

    async fn publish(
        &mut self,
        workspace: &Workspace,
        key: &Arc<Path>,
        uri: Uri,
        diagnostics: Vec<Diagnostic>,
    ) {
        if workspace.snapshot().open(&uri).is_some() {
            self.published.remove(&uri);
            return;
        }
        let text = serde_json::to_string(&diagnostics).unwrap_or_default();
        let hash = (!diagnostics.is_empty()).then(|| FxBuildHasher.hash_one(text) | 1);
        if self.published.get(&uri).and_then(|(_, hash)| *hash) == hash {
            return;
        }
        self.published.insert(uri.clone(), (key.clone(), hash));
        workspace.client.publish_diagnostics(uri.clone(), diagnostics, None).await;
        // Opened in this moment, it would show what the disk had.
        workspace.publish_again(&uri);
    }
}

/// What is found in each file of a project that is not open.
fn closed_findings(snapshot: &Snapshot, key: &Arc<Path>) -> Vec<(Uri, Vec<Diagnostic>)> {
    let Some(around) = snapshot.project(key) else { return Vec::new() };
    let Some(severities) = around.files().first().map(|file| file.severities.clone()) else {
        return Vec::new();
    };
    let found = check::project(&around.view(), &severities);
    let of_file = |(number, found)| {
        let seen = around.from(number)?;
        let uri = seen.here().uri.clone();
        (!seen.here().is_open).then(|| (uri, to_proto::diagnostics(&seen, found, snapshot.manner)))
    };
    (0..).zip(found).filter_map(of_file).collect()
}

/// The project in `root`; nothing if there is no manifest any more.
fn read_project(
    key: &Arc<Path>,
    root: &Path,
    old: Option<&Loaded>,
    snapshot: &Snapshot,
    progress: &super::progress::Progress,
) -> Option<Loaded> {
    if !root.join(MANIFEST_NAME).is_file() {
        return None;
    }
    let project = Project::read(root);
    let settings = snapshot.settings.clone();
    let comments_file = sheets::comments_file(root, &project.manifest, &snapshot.sheets);
    let comments = project.manifest.said_of_devices(comments_file.as_deref());
    // Another target or dialect reads the same text as another program.
    let same = old.is_some_and(|old| *old.manifest == project.manifest && old.settings.reads_like(&settings));
    let known: FxHashMap<&Arc<Path>, &OnDisk> =
        old.into_iter().flat_map(|old| &old.files).map(|file| (&file.path, file)).collect();
    let paths = project.files_in_reach();
    let mut loaded = Loaded {
        root: root.to_path_buf(),
        passed_over: paths.len().saturating_sub(MOST_FILES),
        manifest: Arc::new(project.manifest),
        settings,
        comments_file,
        comments: comments.clone(),
        ..Loaded::default()
    };
    let severities = Arc::new(loaded.manifest.severities());
    // A manifest may list a file twice.
    let mut seen = FxHashSet::default();
    let (mut bytes, total) = (0, paths.len().min(MOST_FILES));
    for (number, path) in paths.into_iter().take(MOST_FILES).enumerate() {
        progress.report(number, total);
        let canonical_path = canonical(&path);
        if !seen.insert(canonical_path.clone()) {
            continue;
        }
        let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        let name = Arc::from(name);
        let stamp = Stamp::of(&path);
        let length = stamp.map_or(0, |stamp| stamp.bytes);
        let too_large = length > MOST_FILE_BYTES || bytes + length > MOST_PROJECT_BYTES;
        if too_large {
            loaded.passed_over += 1;
        } else {
            bytes += length;
        }
        if let Some(old) = known.get(&canonical_path).filter(|old| same && old.stamp == stamp) {
            loaded.files.push(OnDisk { name, ..old.commented(&comments) });
            continue;
        }
        // What is no file, such as a pipe, might never end.
        let read = if too_large || stamp.is_none() {
            None
        } else {
            read_file(&path, &loaded.settings, &loaded.manifest)
        };
        let read = read.map(|(uri, document)| (uri, document.commented(&comments)));
        let exports = read.as_ref().map(|(_, document)| Arc::new(Exports::of(document)));
        let file = read.map(|(uri, document)| {
            Arc::new(Open {
                uri,
                version: 0,
                is_open: false,
                path: Some(canonical_path.clone()),
                project: Some(key.clone()),
                document,
                manifest: loaded.manifest.clone(),
                severities: severities.clone(),
                known: Known::default(),
            })
        });
        let exports = exports.unwrap_or_default();
        loaded.files.push(OnDisk { path: canonical_path, name, stamp, file, exports });
    }
    Some(loaded)
}

/// The program in a file of the disk, read for the PLC of a manifest; nothing if it is not there or too large.
pub(super) fn read_program(path: &Path, settings: &Settings, manifest: &Manifest) -> Option<Document> {
    read_file(path, settings, manifest).map(|(_, document)| document)
}

fn read_file(path: &Path, settings: &Settings, manifest: &Manifest) -> Option<(Uri, Document)> {
    let uri = Uri::from_file_path(path)?;
    let text = read_text(path)?;
    let (notation, target) = decided(&uri, &text, manifest, settings, false);
    Some((uri, frugal(&text, notation, target)))
}
