//! The device comments of projects, read once for each project however many of its files are asked for.

use super::input::{Program, folder_of};
use crate::document::{Comments, Document, Notation};
use crate::project::encoding::Encoding;
use crate::project::{CommentsFile, Manifest};
use crate::target::{Model, Target};
use crate::text::Diagnostic;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The files that were read. A run of the command line sees each file as it was when it first looked.
static READ: Mutex<BTreeMap<PathBuf, Arc<CommentsFile>>> = Mutex::new(BTreeMap::new());

/// What the project of the file at `path` says about its devices.
pub(super) fn of(path: &Path, manifest: &Manifest) -> Arc<Comments> {
    manifest.said_of_devices(file_of(path, manifest).as_deref())
}

fn file_of(path: &Path, manifest: &Manifest) -> Option<Arc<CommentsFile>> {
    let name = manifest.comments.as_ref()?;
    let path = folder_of(path)?.join(name);
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    let file = read.entry(path).or_insert_with_key(|path| {
        Arc::new(CommentsFile::open(path, manifest.target().unwrap_or(Target::of(Model::Fx2n))))
    });
    Some(file.clone())
}

/// The comments files of `programs` in which something is wrong, as files with findings.
pub(super) fn findings(programs: &[Program]) -> Vec<(Program, Vec<Diagnostic>)> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for program in programs {
        let Some(file) = file_of(&program.path, &program.manifest) else { continue };
        let graded = file.graded(&program.manifest.severities());
        if graded.is_empty() || !seen.insert(file.path.clone()) {
            continue;
        }
        let table = Program {
            path: shown(&file.path, program),
            document: Document::unread(file.text(), Notation::FxIl, Target::of(Model::Fx2n)),
            manifest: program.manifest.clone(),
            beside: Arc::default(),
            encoding: Some(Encoding::Utf8),
            fence: None,
        };
        found.push((table, graded));
    }
    found
}

/// The path of the table as the user would write it: beside the paths of programs.
fn shown(path: &Path, program: &Program) -> PathBuf {
    let canonical = program.path.canonicalize().unwrap_or_default();
    let folder = canonical.parent().unwrap_or(Path::new(""));
    match (path.strip_prefix(folder), program.path.parent()) {
        (Ok(rest), Some(parent)) => parent.join(rest),
        _ => path.to_path_buf(),
    }
}
