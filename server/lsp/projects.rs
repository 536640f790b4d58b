//! The projects of the workspace at one moment: their files in order, each as the editor has it or else as the disk.

use super::settings::Settings;
use super::workspace::{Open, Snapshot};
use crate::check;
use crate::document::{Comments, Exports, Member, Outer, ProjectView};
use crate::project::{CommentsFile, Manifest, Stamp};
use crate::text::{Diagnostic, Message};
use rustc_hash::{FxHashMap, FxHashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use tower_lsp::ls_types::Uri;

/// The projects that were read, by the canonical path of their folder.
pub(super) type Projects = FxHashMap<Arc<Path>, Arc<Loaded>>;

/// A project as it was read from the disk.
#[derive(Clone, Debug, Default)]
pub(super) struct Loaded {
    /// The folder of the manifest, as the client spells it.
    pub root: PathBuf,
    /// Its settings.
    pub manifest: Arc<Manifest>,
    /// The program files in the order of execution.
    pub files: Vec<OnDisk>,
    /// Files that were not read because the project is too large.
    pub passed_over: usize,
    /// What the user wanted when the files were read.
    pub settings: Arc<Settings>,
    /// What the files declare for each other, in their order.
    pub outer: Arc<Outer>,
    /// The device comments file, if the manifest names one.
    pub comments_file: Option<Arc<CommentsFile>>,
    /// What it says.
    pub comments: Arc<Comments>,
}

/// A program file of a project on the disk.
#[derive(Clone, Debug)]
pub(super) struct OnDisk {
    /// The canonical path, by which an open document is known to be this file.
    pub path: Arc<Path>,
    /// The path from the project's folder with `/`, for people.
    pub name: Arc<str>,
    /// When and how long the file was, to know whether it must be read again.
    pub stamp: Option<Stamp>,
    /// What was read; nothing if the file is not there, too large or unreadable.
    pub file: Option<Arc<Open>>,
    /// What it declares for the other files.
    pub exports: Arc<Exports>,
}

/// The files of the project of a document; a document that belongs to none stands alone.
#[derive(Clone)]
pub(super) struct Around {
    files: Vec<Arc<Open>>,
    names: Vec<Arc<str>>,
    here: usize,
    is_listed: bool,
    /// Set when nobody waits for the answer any more.
    cancelled: Arc<AtomicBool>,
}

impl Around {
    /// The view that `ide` and `check` take. The number of a member is that of [`Around::file`].
    pub fn view(&self) -> ProjectView<'_> {
        let members = self.files.iter().zip(&self.names);
        let members = members.map(|(file, name)| Member { name, document: &file.document }).collect();
        ProjectView::new(members, self.here, self.is_listed)
            .unwrap_or_else(|| ProjectView::alone(&self.files[self.here].document))
            .cancellable(&self.cancelled)
    }

    /// The file that is looked at.
    pub fn here(&self) -> &Arc<Open> {
        &self.files[self.here]
    }

    /// What both tiers find in the file that is looked at, sorted by place.
    pub fn findings(&self) -> Arc<[Diagnostic]> {
        let open = self.here();
        if let Some(known) = open.known.among(&self.files) {
            return known;
        }
        let mut found = check::realtime(&open.document, &open.severities);
        found.extend(check::within_project(&self.view(), &open.severities));
        let found = check::sorted(found);
        match self.is_cancelled() {
            true => found.into(),
            false => self.keep(found),
        }
    }

    /// Keeps what both tiers found in the file that is looked at, sorted by place, for those who ask for it next.
    pub fn keep(&self, found: Vec<Diagnostic>) -> Arc<[Diagnostic]> {
        let found = found.into();
        self.here().known.keep(&self.files, &found);
        found
    }

    /// The same files seen from file number `here`.
    pub fn from(&self, here: usize) -> Option<Around> {
        (here < self.files.len()).then(|| Around { here, ..self.clone() })
    }

    /// The same files with a newer text of the one that is looked at.
    pub fn with_here(&self, open: &Arc<Open>) -> Around {
        let mut around = self.clone();
        around.files[self.here] = open.clone();
        around
    }

    fn empty() -> Around {
        let cancelled = Arc::default();
        Around { files: Vec::new(), names: Vec::new(), here: 0, is_listed: false, cancelled }
    }

    /// The same files for work that ends early once `flag` is set.
    pub fn cancellable(self, flag: &Arc<AtomicBool>) -> Around {
        Around { cancelled: flag.clone(), ..self }
    }

    /// Whether nobody waits for the answer any more.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// A file without others.
    pub fn alone(open: &Arc<Open>) -> Around {
        Around { files: vec![open.clone()], names: vec![Arc::from("")], ..Around::empty() }
    }

    /// File number `number`.
    pub fn file(&self, number: usize) -> Option<&Arc<Open>> {
        self.files.get(number)
    }

    /// All files in order.
    pub fn files(&self) -> &[Arc<Open>] {
        &self.files
    }
}

impl Snapshot {
    /// The project around `open` at this moment.
    pub(super) fn around(&self, open: &Arc<Open>) -> Around {
        let mut around = Around { here: usize::MAX, ..Around::empty() };
        if let Some(loaded) = open.project.as_ref().and_then(|key| self.projects.get(key)) {
            around.is_listed = loaded.manifest.files.is_some();
            for (file, name) in self.files_of(loaded) {
                if Some(&file.path) == Some(&open.path) {
                    around.here = around.files.len();
                    // The same file may be open under two spellings; the one that is asked about counts.
                    around.files.push(open.clone());
                } else {
                    around.files.push(file);
                }
                around.names.push(name.clone());
            }
        }
        if around.here == usize::MAX {
            return Around::alone(open);
        }
        around
    }

    /// The project around a file of it that is not open.
    pub(super) fn around_closed(&self, uri: &Uri) -> Option<Around> {
        let path = canonical(&file_path(uri)?);
        // Folders of projects may lie in each other; a file belongs to the innermost.
        let around = self.projects.keys().filter(|key| path.starts_with(key));
        let key = around.max_by_key(|key| key.components().count())?;
        let around = self.project(key)?;
        let here = around.files.iter().position(|file| file.path.as_ref() == Some(&path))?;
        around.from(here)
    }

    /// The file of an open document as the disk has it.
    pub(super) fn on_disk(&self, open: &Open) -> Option<&Arc<Open>> {
        let loaded = self.projects.get(open.project.as_ref()?)?;
        loaded.files.get(loaded.number_of(open)?)?.file.as_ref()
    }

    /// Why nothing can be renamed in all files of the project of `open`, if so: they are not all known.
    pub(super) fn is_incomplete(&self, open: &Open) -> Option<Message> {
        let key = open.project.as_ref()?;
        match self.projects.get(key) {
            None => Some(Message::new("rename.reading")),
            Some(loaded) if loaded.passed_over > 0 && loaded.number_of(open).is_some() => {
                Some(Message::new("rename.passed-over").with("count", loaded.passed_over))
            }
            Some(_) => None,
        }
    }

    /// All of a project, seen from its first file; nothing if it has none.
    pub(super) fn project(&self, key: &Arc<Path>) -> Option<Around> {
        let loaded = self.projects.get(key)?;
        let (files, names): (Vec<_>, Vec<_>) =
            self.files_of(loaded).map(|(file, name)| (file, name.clone())).unzip();
        let is_listed = loaded.manifest.files.is_some();
        (!files.is_empty()).then(|| Around { files, names, is_listed, ..Around::empty() })
    }

    /// The files of all projects and the open documents that belong to none; nothing if there are neither.
    pub(super) fn everything(&self) -> Option<Around> {
        let mut around = Around::empty();
        let mut seen: FxHashSet<&Arc<Path>> = FxHashSet::default();
        for loaded in self.projects.values() {
            seen.extend(loaded.files.iter().map(|file| &file.path));
            around.files.extend(self.files_of(loaded).map(|(file, _)| file));
        }
        let is_alone = |open: &&Arc<Open>| open.path.as_ref().is_none_or(|path| !seen.contains(path));
        around.files.extend(self.opens().filter(is_alone).cloned());
        around.files.sort_by(|left, right| left.uri.as_str().cmp(right.uri.as_str()));
        around.names = vec![Arc::from(""); around.files.len()];
        (!around.files.is_empty()).then_some(around)
    }

    /// The files of a project in order with their names, those that cannot be read left out.
    pub(super) fn files_of<'a>(
        &'a self,
        loaded: &'a Loaded,
    ) -> impl Iterator<Item = (Arc<Open>, &'a Arc<str>)> + 'a {
        loaded.files.iter().filter_map(|file| {
            let open = self.open_at(&file.path).or(file.file.as_ref())?;
            Some((open.clone(), &file.name))
        })
    }
}

/// The path of a document on the disk; nothing for documents of other schemes, such as `untitled:`.
pub(super) fn file_path(uri: &Uri) -> Option<PathBuf> {
    let is_file = uri.scheme().as_str().eq_ignore_ascii_case("file");
    is_file
        .then(|| uri.to_file_path())
        .flatten()
        .map(|path| path.into_owned())
        .filter(|path| path.is_absolute())
}

/// The one path of a file however it is spelled, links followed; for a file that is not there yet, that of its folder.
pub(super) fn canonical(path: &Path) -> Arc<Path> {
    let canonical = path.canonicalize().or_else(|missing| match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) => parent.canonicalize().map(|parent| parent.join(name)),
        _ => Err(missing),
    });
    Arc::from(canonical.unwrap_or_else(|_| path.to_path_buf()))
}
