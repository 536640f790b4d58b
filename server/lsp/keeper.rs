//! Reads the files of projects in the background: one task, so that the disk is asked once at a time.

use super::projects::{Loaded, OnDisk, Stamp, canonical};
use super::settings::Settings;
use super::workspace::{Open, Workspace, decided, read};
use crate::project::{MANIFEST_NAME, MOST_FILE_BYTES, MOST_FILES, MOST_PROJECT_BYTES, Project};
use rustc_hash::FxHashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Weak};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tower_lsp::ls_types::Uri;

/// Gives orders to the task.
pub(super) struct Keeper {
    orders: UnboundedSender<Order>,
}

/// A project that is to be read, or read again.
struct Order {
    /// The canonical folder.
    key: Arc<Path>,
    /// The folder as the client spells it.
    root: PathBuf,
}

impl Keeper {
    /// The task lives as long as the workspace.
    pub(super) fn start(workspace: &Arc<Workspace>) -> Keeper {
        let (orders, receiver) = unbounded_channel();
        tokio::spawn(run(Arc::downgrade(workspace), receiver));
        Keeper { orders }
    }

    /// Reads the project in `root`; files that did not change on the disk are kept.
    pub(super) fn read(&self, key: Arc<Path>, root: PathBuf) {
        // Without the task there is no workspace either.
        let _ = self.orders.send(Order { key, root });
    }
}

async fn run(workspace: Weak<Workspace>, mut orders: UnboundedReceiver<Order>) {
    while let Some(first) = orders.recv().await {
        // What came meanwhile is taken together: a project is read once for many changes of its files.
        let mut roots = FxHashMap::from_iter([(first.key, first.root)]);
        while let Ok(next) = orders.try_recv() {
            roots.insert(next.key, next.root);
        }
        for (key, root) in roots {
            let Some(workspace) = workspace.upgrade() else { return };
            let snapshot = workspace.snapshot();
            let work = {
                let key = key.clone();
                move || {
                    read_project(
                        &key,
                        &root,
                        snapshot.projects.get(&key).map(|old| &**old),
                        snapshot.settings,
                    )
                }
            };
            match tokio::task::spawn_blocking(work).await {
                Ok(loaded) => workspace.adopt(&key, loaded),
                Err(failure) => tracing::error!("reading a project failed: {failure}"),
            }
        }
    }
}

/// The project in `root`; nothing if there is no manifest any more.
fn read_project(
    key: &Arc<Path>,
    root: &Path,
    old: Option<&Loaded>,
    settings: Arc<Settings>,
) -> Option<Loaded> {
    if !root.join(MANIFEST_NAME).is_file() {
        return None;
    }
    let project = Project::read(root);
    // Another target or dialect reads the same text as another program.
    let same =
        old.is_some_and(|old| *old.manifest == project.manifest && Arc::ptr_eq(&old.settings, &settings));
    let known: FxHashMap<&Arc<Path>, &OnDisk> =
        old.into_iter().flat_map(|old| &old.files).map(|file| (&file.path, file)).collect();
    let paths = project.files_in_reach();
    let mut loaded = Loaded {
        root: root.to_path_buf(),
        passed_over: paths.len().saturating_sub(MOST_FILES),
        manifest: Arc::new(project.manifest),
        files: Vec::new(),
        settings,
    };
    let severities = Arc::new(loaded.manifest.severities());
    let mut bytes = 0;
    for path in paths.into_iter().take(MOST_FILES) {
        let canonical_path = canonical(&path);
        let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        let stamp = stamp_of(&path);
        let old = known.get(&canonical_path).filter(|old| same && old.stamp == stamp);
        let length = stamp.map_or(0, |stamp| stamp.bytes);
        bytes += length;
        let too_large = length > MOST_FILE_BYTES || bytes > MOST_PROJECT_BYTES;
        if too_large {
            bytes -= length;
            loaded.passed_over += 1;
        }
        let file = match old {
            Some(old) => old.file.clone(),
            None if too_large => None,
            None => read_file(&path, &loaded.settings, &loaded.manifest).map(|(uri, document)| {
                Arc::new(Open {
                    uri,
                    version: 0,
                    is_open: false,
                    path: Some(canonical_path.clone()),
                    project: Some(key.clone()),
                    document,
                    manifest: loaded.manifest.clone(),
                    severities: severities.clone(),
                })
            }),
        };
        loaded.files.push(OnDisk { path: canonical_path, name, stamp, file });
    }
    Some(loaded)
}

fn stamp_of(path: &Path) -> Option<Stamp> {
    let data = std::fs::metadata(path).ok().filter(|data| data.is_file())?;
    Some(Stamp { modified: data.modified().ok(), bytes: data.len() })
}

fn read_file(
    path: &Path,
    settings: &Settings,
    manifest: &crate::project::Manifest,
) -> Option<(Uri, crate::document::Document)> {
    let uri = Uri::from_file_path(path)?;
    let bytes = std::fs::read(path).ok()?;
    let text = String::from_utf8_lossy(&bytes);
    let (notation, target) = decided(&uri, &text, manifest, settings, false);
    Some((uri, read(&text, notation, target)))
}
