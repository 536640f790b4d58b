//! Finds files with scenario tests, and the programs that they are about.

use super::super::across::{linked, whole_program};
use super::super::input::{Program, complain, folder_of, programs};
use crate::document::Document;
use crate::project::{
    MANIFEST_NAME, Project, encoding, is_program_file, is_suite_file, suite_files, suites_in,
};
use crate::scenario::{Bench, Coverage, Flaw, Suite, programs_beside};
use crate::simulate::Problem;
use crate::text::{Language, Message, Span};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// A file with scenario tests that was read.
pub(super) struct SuiteFile {
    pub path: PathBuf,
    /// The path as it is shown.
    pub shown: String,
    pub text: String,
    pub suite: Suite,
    pub flaws: Vec<Flaw>,
    /// The number of the program that it is about.
    pub subject: Option<usize>,
}

/// A program that is tested.
pub(super) struct Subject {
    /// Its files in the order of execution.
    pub programs: Vec<Program>,
    pub bench: Result<Bench, Vec<Problem>>,
    pub coverage: Option<Coverage>,
}

impl Subject {
    fn of(programs: Vec<Program>, has_coverage: bool) -> Subject {
        let documents: Vec<&Document> = programs.iter().map(|program| &program.document).collect();
        let bench = Bench::new(&documents);
        let coverage = if has_coverage { Coverage::new(&documents).ok() } else { None };
        Subject { bench, coverage, programs }
    }

    /// How its files are shown.
    pub fn paths(&self) -> impl Iterator<Item = String> {
        self.programs.iter().map(|program| shown(&program.path))
    }
}

/// A path without the folder that needs no word.
pub(super) fn shown(path: &Path) -> String {
    path.strip_prefix(".").unwrap_or(path).display().to_string()
}

/// The files with scenario tests at `paths`, and the programs that they are about; nothing after complaints.
pub(super) fn found(
    paths: &[PathBuf],
    has_coverage: bool,
    language: Language,
) -> Option<(Vec<SuiteFile>, Vec<Subject>)> {
    let mut files: Vec<PathBuf> = Vec::new();
    let mut is_usable = true;
    for path in paths {
        let own = match () {
            () if path.is_dir() => suite_files(path),
            () if path.file_name().is_some_and(|name| name == MANIFEST_NAME) => suite_files(
                path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")),
            ),
            () if is_suite_file(path) && path.is_file() => vec![path.clone()],
            () if is_program_file(path) && path.is_file() => about(path),
            () => {
                let key = if path.exists() { "cli.no-suite-file" } else { "cli.no-such-file" };
                let reason = Message::new(key).with("path", path.display()).render(language);
                complain(
                    "unreadable-input",
                    &reason,
                    &Message::new("cli.give-suite").render(language),
                    language,
                );
                is_usable = false;
                Vec::new()
            }
        };
        files.extend(own.into_iter().filter(|file| !files.contains(file)).collect::<Vec<_>>());
    }
    if files.is_empty() && is_usable {
        let reason = Message::new("cli.no-suites").render(language);
        complain("no-tests", &reason, &Message::new("cli.give-suite").render(language), language);
        is_usable = false;
    }
    let mut suites = Vec::new();
    let mut subjects = Subjects { all: Vec::new(), known: HashMap::new(), has_coverage };
    for path in files {
        match std::fs::read(&path) {
            Ok(bytes) => {
                let mut file = read(path, encoding::read(bytes).0);
                match subjects.of(&file, language) {
                    Ok(subject) => file.subject = subject,
                    Err(flaw) => file.flaws.push(flaw),
                }
                suites.push(file);
            }
            Err(reason) => {
                let reason = format!("{}: {reason}", path.display());
                complain(
                    "unreadable-input",
                    &reason,
                    &Message::new("cli.check-path").render(language),
                    language,
                );
                is_usable = false;
            }
        }
    }
    is_usable.then_some((suites, subjects.all))
}

fn read(path: PathBuf, text: String) -> SuiteFile {
    let (suite, flaws) = Suite::read(&text);
    SuiteFile { shown: shown(&path), path, text, suite, flaws, subject: None }
}

/// The files in the folder of a program that are about it.
fn about(program: &Path) -> Vec<PathBuf> {
    let folder = program.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let wanted = program.canonicalize().ok();
    let is_about = |file: &PathBuf| {
        let text = std::fs::read(file).map(|bytes| encoding::read(bytes).0).unwrap_or_default();
        let file = read(file.clone(), text);
        file.subject_path().is_some_and(|path| {
            let files = match Project::read(&path).files() {
                Ok(files) if path.is_dir() => files,
                _ => vec![path],
            };
            files.iter().any(|path| path.canonicalize().ok() == wanted)
        })
    };
    suites_in(folder).into_iter().filter(is_about).collect()
}

impl SuiteFile {
    /// Where the program is: a file, or the folder of a project.
    fn subject_path(&self) -> Option<PathBuf> {
        let folder = self.path.parent()?;
        if let Some(named) = &self.suite.program {
            let path = folder.join(&named.name);
            let is_manifest = path.file_name().is_some_and(|name| name == MANIFEST_NAME);
            return Some(if is_manifest { path.parent()?.to_path_buf() } else { path });
        }
        let name = self.path.file_name()?.to_string_lossy().into_owned();
        let beside =
            programs_beside(&name).into_iter().map(|name| folder.join(name)).find(|path| path.is_file());
        let root = || {
            let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
            folder_of(folder)
        };
        beside.or_else(root)
    }
}

/// The programs that are tested, each compiled once.
struct Subjects {
    all: Vec<Subject>,
    known: HashMap<Vec<PathBuf>, usize>,
    has_coverage: bool,
}

impl Subjects {
    /// The number of the program that a file is about; nothing where it has flaws already.
    fn of(&mut self, file: &SuiteFile, language: Language) -> Result<Option<usize>, Flaw> {
        let span = file.suite.program.as_ref().map_or(Span::default(), |named| named.span);
        let flaw = |message: Message| Flaw { message, span };
        let Some(path) = file.subject_path() else {
            return Err(flaw(Message::new("scenario.which-program")));
        };
        if !path.exists() {
            return Err(flaw(Message::new("cli.no-such-file").with("path", path.display())));
        }
        let programs = match path.is_dir() {
            true => programs(std::slice::from_ref(&path), None, language),
            false => whole_program(&path, language),
        };
        let programs = programs.filter(|programs| !programs.is_empty());
        let Some(programs) = programs else {
            return Err(flaw(Message::new("scenario.unreadable-program").with("path", path.display())));
        };
        let canonical =
            |program: &Program| program.path.canonicalize().unwrap_or_else(|_| program.path.clone());
        let key: Vec<PathBuf> = programs.iter().map(canonical).collect();
        if let Some(known) = self.known.get(&key) {
            return Ok(Some(*known));
        }
        self.known.insert(key, self.all.len());
        self.all.push(Subject::of(programs.into_iter().map(linked).collect(), self.has_coverage));
        Ok(Some(self.all.len() - 1))
    }
}
