//! Files with scenario tests and the programs that they are about, as the editor has them or else the disk.

use super::super::projects::{Around, canonical, file_path};
use super::super::workspace::{Snapshot, is_suite, is_toml};
use crate::check;
use crate::document::{Document, Exports, Member, Notation, Outer, ProjectView};
use crate::project::{MANIFEST_NAME, Manifest, Project, open_document, read_text, suite_files};
use crate::scenario::{Flaw, Suite, programs_beside};
use crate::target::Target;
use crate::text::{Message, Span};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tower_lsp::ls_types::Uri;

/// A file with scenario tests that was read.
pub(super) struct SuiteText {
    pub uri: Uri,
    pub document: Document,
    pub suite: Suite,
    pub flaws: Vec<Flaw>,
}

/// The files of a program in the order of execution.
pub(super) type Files = Vec<(Uri, Document)>;

impl SuiteText {
    /// The file at an address.
    pub fn at(snapshot: &Snapshot, uri: &Uri) -> Option<SuiteText> {
        let document = match snapshot.open(uri) {
            Some(open) => open.document.clone(),
            None => {
                let text = read_text(&file_path(uri)?)?;
                Document::unread(&text, Notation::FxIl, Target::ALL[0])
            }
        };
        let (suite, flaws) = Suite::read(&document.text());
        Some(SuiteText { uri: uri.clone(), document, suite, flaws })
    }

    /// Where the program is: a file, or the folder of a project.
    fn program_path(&self, snapshot: &Snapshot) -> Option<PathBuf> {
        let path = file_path(&self.uri)?;
        let folder = path.parent()?;
        if let Some(named) = &self.suite.program {
            let path = folder.join(&named.name);
            let is_manifest = path.file_name().is_some_and(|name| name == MANIFEST_NAME);
            return Some(if is_manifest { path.parent()?.to_path_buf() } else { path });
        }
        let name = path.file_name()?.to_string_lossy().into_owned();
        let is_there = |path: &PathBuf| path.is_file() || snapshot.open_at(&canonical(path)).is_some();
        let beside = programs_beside(&name).into_iter().map(|name| folder.join(name)).find(is_there);
        beside.or_else(|| Project::folder_of(folder))
    }

    /// The files of the program that it is about.
    ///
    /// # Errors
    /// With the flaw of a file that names none.
    pub fn program(&self, snapshot: &Snapshot) -> Result<Files, Flaw> {
        let span = self.suite.program.as_ref().map_or(Span::default(), |named| named.span);
        let flaw = |message: Message| Flaw { message, span };
        let path = self.program_path(snapshot).ok_or_else(|| flaw(Message::new("scenario.which-program")))?;
        let missing = || flaw(Message::new("cli.no-such-file").with("path", path.display()));
        program_at(snapshot, &path).filter(|files| !files.is_empty()).ok_or_else(missing)
    }

    /// A file beside it.
    pub fn beside(&self, name: &str) -> Option<PathBuf> {
        Some(file_path(&self.uri)?.parent()?.join(name))
    }
}

/// The files in the folder of a program that are about it.
pub(super) fn suites_about(snapshot: &Snapshot, program: &Uri) -> Vec<SuiteText> {
    let Some(path) = file_path(program) else { return Vec::new() };
    let Some(folder) = path.parent() else { return Vec::new() };
    let wanted = canonical(&path);
    let is_here = |path: &PathBuf| path.parent() == Some(folder);
    let on_disk = suite_files(folder).into_iter().filter(is_here).filter_map(Uri::from_file_path);
    let open = snapshot.opens().map(|open| open.uri.clone()).filter(is_suite);
    let open = open.filter(|uri| file_path(uri).is_some_and(|path| is_here(&path)));
    let mut all: Vec<String> = on_disk.chain(open).map(|uri| uri.to_string()).collect();
    all.sort();
    all.dedup();
    let suites = all.into_iter().filter_map(|uri| SuiteText::at(snapshot, &uri.parse().ok()?));
    suites
        .filter(|suite| {
            let Some(path) = suite.program_path(snapshot) else { return false };
            let own = canonical(&path);
            own == wanted || path.is_dir() && in_project(&path, &wanted)
        })
        .collect()
}

fn in_project(root: &Path, wanted: &Arc<Path>) -> bool {
    Project::read(root).files_in_reach().iter().any(|path| canonical(path) == *wanted)
}

/// The files that are one program with the one at `path`, or all of a project in this folder.
fn program_at(snapshot: &Snapshot, path: &Path) -> Option<Files> {
    let key = canonical(path);
    let around = match snapshot.open_at(&key).filter(|open| !is_toml(&open.uri)) {
        Some(open) => Some(snapshot.around(open)),
        None if path.is_dir() => snapshot.project(&key),
        None => Uri::from_file_path(path).and_then(|uri| snapshot.around_closed(&uri)),
    };
    let Some(around) = around else { return from_disk(path) };
    let numbers = match path.is_dir() {
        true => (0..around.files().len()).collect(),
        false => check::program_around(&around.view()),
    };
    Some(files_of(&around, &numbers))
}

fn files_of(around: &Around, numbers: &[usize]) -> Files {
    let files = numbers.iter().filter_map(|number| around.file(*number));
    files.map(|open| (open.uri.clone(), open.document.clone())).collect()
}

/// The same of a project that the server does not know, such as one of which nothing is open.
fn from_disk(path: &Path) -> Option<Files> {
    let project = Project::of(path);
    let listed = project.as_ref().map(Project::files_in_reach).unwrap_or_default();
    let here = listed.iter().position(|file| canonical(file) == canonical(path));
    let is_project = path.is_dir() || here.is_some();
    let paths = if is_project { listed } else { vec![path.to_path_buf()] };
    let manifest = project.map_or_else(Manifest::default, |project| project.manifest);
    let read = paths.iter().filter_map(|path| {
        let document = open_document(&path.to_string_lossy(), &read_text(path)?, &manifest, None, None);
        Some((Uri::from_file_path(path)?, document))
    });
    let mut files: Files = read.collect();
    if files.len() > 1 {
        let exports = files.iter().map(|(_, document)| Arc::new(Exports::of(document))).collect();
        let outer = Arc::new(Outer::new(path.into(), exports));
        for (number, (_, document)) in files.iter_mut().enumerate() {
            *document = document.linked(outer.clone(), number);
        }
    }
    let Some(here) = here.filter(|_| files.len() == paths.len()) else { return Some(files) };
    let members = files.iter().map(|(_, document)| Member { name: "", document }).collect();
    let numbers =
        ProjectView::new(members, here, manifest.files.is_some()).map(|view| check::program_around(&view));
    let numbers = numbers.unwrap_or_default();
    Some(numbers.into_iter().filter_map(|number| files.get(number).cloned()).collect())
}
