//! Finding projects and their files, and opening a file the way its project wants it.

use super::{CommentsFile, Manifest, ManifestError};
use crate::document::{Document, Notation, Symbol, detect_ladder_target, detect_notation};
use crate::target::{Model, Target};
use crate::text::{Encoding, LineColumn, Message, Span, position_of};
use std::fs::DirEntry;
use std::io;
use std::path::{Path, PathBuf};

/// The manifest's file name.
pub const MANIFEST_NAME: &str = "rungwise.toml";

/// An editor keeps so many files of a project; those behind them are passed over, and the user is told.
pub const MOST_FILES: usize = 2000;

/// An editor keeps no file of a project that is longer, unless it is open.
pub const MOST_FILE_BYTES: u64 = 16 << 20;

/// All files of a project that an editor keeps have no more bytes together.
pub const MOST_PROJECT_BYTES: u64 = 64 << 20;

/// So many entries of folders are looked at in the search for program files.
const MOST_ENTRIES: usize = 100_000;

/// A folder of programs with its settings.
#[derive(Clone, Debug)]
pub struct Project {
    /// The folder in which the manifest stands.
    pub root: PathBuf,
    /// Its settings; the defaults where it could not be read.
    pub manifest: Manifest,
    /// Why it could not be read.
    pub error: Option<ManifestError>,
    /// The text of the manifest.
    source: String,
}

impl Project {
    /// The project whose manifest stands in `folder`. A manifest that cannot be read or has mistakes gives a project
    /// with `error` and the default settings.
    pub fn read(folder: &Path) -> Project {
        let text = std::fs::read_to_string(folder.join(MANIFEST_NAME)).map_err(|reason| ManifestError {
            message: Message::new("manifest.unreadable").with("reason", reason),
            span: Span::default(),
        });
        let (manifest, error) =
            match text.as_ref().map_err(ManifestError::clone).and_then(|text| Manifest::read(text)) {
                Ok(manifest) => (manifest, None),
                Err(error) => (Manifest::default(), Some(error)),
            };
        let manifest = with_target_of_comments(manifest, folder);
        Project { root: folder.to_path_buf(), manifest, error, source: text.unwrap_or_default() }
    }

    /// The position of byte `offset` in the manifest.
    pub fn position(&self, offset: u32, encoding: Encoding) -> LineColumn {
        position_of(&self.source, offset as usize, encoding)
    }

    /// The project to which `path` belongs: the nearest manifest in its folder or above.
    pub fn of(path: &Path) -> Option<Project> {
        Project::folder_of(path).map(|folder| Project::read(&folder))
    }

    /// The folder of that project.
    pub fn folder_of(path: &Path) -> Option<PathBuf> {
        let start = if path.is_dir() { path } else { path.parent()? };
        start.ancestors().find(|folder| folder.join(MANIFEST_NAME).is_file()).map(Path::to_path_buf)
    }

    /// The program files in order of execution: those that the manifest lists, else all in the folder, by name.
    ///
    /// # Errors
    /// Where a folder cannot be read.
    pub fn files(&self) -> io::Result<Vec<PathBuf>> {
        match &self.manifest.files {
            Some(names) => Ok(names.iter().map(|name| self.root.join(name)).collect()),
            None => {
                let mut walk =
                    Walk { files: Vec::new(), nested: false, left: usize::MAX, wanted: is_program_file };
                walk.folder(&self.root, true)?;
                Ok(walk.files)
            }
        }
    }

    /// The same for an editor, which goes on without the folders that cannot be read, and does not search without end.
    pub fn files_in_reach(&self) -> Vec<PathBuf> {
        if self.manifest.files.is_some() {
            return self.files().unwrap_or_default();
        }
        let mut walk = Walk { files: Vec::new(), nested: false, left: MOST_ENTRIES, wanted: is_program_file };
        // A folder that cannot be read ends the walk there; what was found before it stays.
        let _ = walk.folder(&self.root, true);
        walk.files
    }
}

/// A project that says nothing of its target but names devices of the FX family is for one of these: otherwise the
/// symbols in a drawing would be taken for the names of IEC variables.
fn with_target_of_comments(manifest: Manifest, folder: &Path) -> Manifest {
    let (None, Some(name)) = (&manifest.target, &manifest.comments) else { return manifest };
    let file = CommentsFile::open(&folder.join(name), Target::of(Model::Fx3u));
    let has_devices = file.comments.rows().iter().any(|row| matches!(row.thing, Symbol::Device(_)));
    let target = has_devices.then(|| Target::of(Model::Fx2n).name.to_string());
    Manifest { target, ..manifest }
}

/// Whether the name ends in `.lad` or `.il`.
pub fn is_program_file(path: &Path) -> bool {
    ends_in(path, ["lad", "il"])
}

/// Whether the name ends in `.csv` or `.tsv`: it may be a table of device comments.
pub fn is_table_file(path: &Path) -> bool {
    ends_in(path, ["csv", "tsv"])
}

fn ends_in(path: &Path, extensions: [&str; 2]) -> bool {
    path.extension().is_some_and(|end| extensions.iter().any(|extension| end.eq_ignore_ascii_case(extension)))
}

/// The files of which `wanted` says so in the project of `folder`, from there, with `/`, by name. What cannot be read
/// is left out, and a search that has no end is ended.
pub fn names_in(folder: &Path, wanted: fn(&Path) -> bool) -> Vec<String> {
    let mut walk = Walk { files: Vec::new(), nested: false, left: MOST_ENTRIES, wanted };
    // What was found before a folder that cannot be read stays.
    let _ = walk.folder(folder, true);
    let names = walk.files.iter().filter_map(|path| path.strip_prefix(folder).ok()?.to_str());
    names.map(|name| name.replace('\\', "/")).collect()
}

/// The program files below `folder`, by name; what is hidden, and links to folders, are passed over.
pub fn program_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut walk = Walk { files: Vec::new(), nested: true, left: usize::MAX, wanted: is_program_file };
    walk.folder(folder, true)?;
    Ok(walk.files)
}

/// Whether the name is that of a file with scenario tests.
pub fn is_suite_file(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy().to_ascii_lowercase());
    name.is_some_and(|name| name.ends_with(".test.toml"))
}

/// The files with scenario tests in `folder` and below, by name; what is hidden is passed over, and a search that has
/// no end is ended.
pub fn suite_files(folder: &Path) -> Vec<PathBuf> {
    let mut walk = Walk { files: Vec::new(), nested: true, left: MOST_ENTRIES, wanted: is_suite_file };
    // What was found before a folder that cannot be read stays.
    let _ = walk.folder(folder, true);
    walk.files
}

/// The folders with a manifest in `folder` and below, by name; what is hidden is passed over.
pub fn projects_in(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    let mut left = MOST_ENTRIES;
    while let Some(folder) = folders.pop() {
        if folder.join(MANIFEST_NAME).is_file() {
            found.push(folder.clone());
        }
        for entry in entries(&folder).unwrap_or_default() {
            left = left.saturating_sub(1);
            if left > 0 && !is_hidden(&entry) && entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                folders.push(entry.path());
            }
        }
    }
    found.sort();
    found
}

/// A walk through folders.
struct Walk {
    files: Vec<PathBuf>,
    /// Whether folders with a manifest of their own are entered, too.
    nested: bool,
    /// How many entries may still be looked at.
    left: usize,
    /// Which files are taken.
    wanted: fn(&Path) -> bool,
}

impl Walk {
    fn folder(&mut self, folder: &Path, is_first: bool) -> io::Result<()> {
        if !is_first && !self.nested && folder.join(MANIFEST_NAME).is_file() {
            return Ok(());
        }
        for entry in entries(folder)? {
            self.left = self.left.saturating_sub(1);
            // Beside the folders of tools these are the lock files of editors and what other systems put into archives.
            if self.left == 0 || is_hidden(&entry) {
                continue;
            }
            let path = entry.path();
            if entry.file_type()?.is_dir() {
                self.folder(&path, false)?;
            } else if (self.wanted)(&path) && !path.is_dir() {
                self.files.push(path);
            }
        }
        Ok(())
    }
}

fn entries(folder: &Path) -> io::Result<Vec<DirEntry>> {
    let mut entries: Vec<_> = std::fs::read_dir(folder)?.collect::<Result<_, _>>()?;
    entries.sort_by_key(|entry| entry.file_name());
    Ok(entries)
}

fn is_hidden(entry: &DirEntry) -> bool {
    entry.file_name().to_string_lossy().starts_with('.')
}

/// Reads `text` as the document called `name`, with what the user and then the project want; without either, by the
/// name's ending and the content.
pub fn open_document(
    name: &str,
    text: &str,
    manifest: &Manifest,
    target: Option<&'static Target>,
    notation: Option<Notation>,
) -> Document {
    let (notation, target) = decide(name, text, manifest, target, notation);
    Document::new(text, notation, target)
}

/// The language and target of a document, as [`open_document`] decides.
pub fn decide(
    name: &str,
    text: &str,
    manifest: &Manifest,
    target: Option<&'static Target>,
    notation: Option<Notation>,
) -> (Notation, &'static Target) {
    let target = target.or_else(|| manifest.target());
    if name.to_ascii_lowercase().ends_with(".lad") || notation == Some(Notation::Ladder) {
        return (Notation::Ladder, target.unwrap_or_else(|| detect_ladder_target(text)));
    }
    match notation.or_else(|| manifest.notation()).unwrap_or_else(|| detect_notation(text)) {
        Notation::IecIl => (Notation::IecIl, Target::of(Model::Iec)),
        notation => (notation, target.filter(|target| target.is_fx()).unwrap_or(Target::of(Model::Fx2n))),
    }
}
