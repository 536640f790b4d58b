//! The projects of the workspace at one moment: their files in order, each as the editor has it or else as the disk.

use super::settings::Settings;
use super::workspace::{Open, Snapshot};
use crate::document::{Member, ProjectView};
use crate::project::Manifest;
use rustc_hash::FxHashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;
use tower_lsp::ls_types::Uri;

/// The projects that were read, by the canonical path of their folder.
pub(super) type Projects = FxHashMap<Arc<Path>, Arc<Loaded>>;

/// A project as it was read from the disk.
#[derive(Debug, Default)]
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
}

/// A program file of a project on the disk.
#[derive(Clone, Debug)]
pub(super) struct OnDisk {
    /// The canonical path, by which an open document is known to be this file.
    pub path: Arc<Path>,
    /// The path from the project's folder with `/`, for people.
    pub name: String,
    /// When and how long the file was, to know whether it must be read again.
    pub stamp: Option<Stamp>,
    /// What was read; nothing if the file is not there, too large or unreadable.
    pub file: Option<Arc<Open>>,
}

/// What tells a changed file from an unchanged one without reading it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Stamp {
    pub modified: Option<SystemTime>,
    pub bytes: u64,
}

/// The files of the project of a document; a document that belongs to none stands alone.
pub(super) struct Around {
    files: Vec<Arc<Open>>,
    names: Vec<String>,
    here: usize,
    is_listed: bool,
}

impl Around {
    /// The view that `ide` and `check` take. The number of a member is that of [`Around::file`].
    pub fn view(&self) -> ProjectView<'_> {
        let members = self.files.iter().zip(&self.names);
        let members = members.map(|(file, name)| Member { name, document: &file.document }).collect();
        ProjectView::new(members, self.here, self.is_listed)
            .unwrap_or_else(|| ProjectView::alone(&self.files[self.here].document))
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
        let mut around = Around { files: Vec::new(), names: Vec::new(), here: usize::MAX, is_listed: false };
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
                around.names.push(name.to_string());
            }
        }
        if around.here == usize::MAX {
            return Around { files: vec![open.clone()], names: vec![String::new()], here: 0, is_listed: false };
        }
        around
    }

    /// The files of a project in order with their names, those that cannot be read left out.
    pub(super) fn files_of<'a>(
        &'a self,
        loaded: &'a Loaded,
    ) -> impl Iterator<Item = (Arc<Open>, &'a str)> + 'a {
        loaded.files.iter().filter_map(|file| {
            let open = self.open_at(&file.path).or(file.file.as_ref())?;
            Some((open.clone(), file.name.as_str()))
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
