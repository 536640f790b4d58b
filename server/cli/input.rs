//! Reading programs from files, folders and projects, and telling what cannot be read.

use crate::document::{Document, fences};
use crate::project::{
    MANIFEST_NAME, Manifest, Project, encoding, is_program_file, open_document, program_files, projects_in,
};
use crate::target::Target;
use crate::text::{Encoding, Language, LineColumn, Message, Related};
use std::collections::HashSet;
use std::io::{ErrorKind, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A program file that was read.
pub(super) struct Program {
    pub path: PathBuf,
    pub document: Document,
    pub manifest: Arc<Manifest>,
    /// The files of its project, by the numbers that findings give them; none where it stands alone.
    pub beside: Arc<[Beside]>,
    /// How the file is written; `None` if broken bytes were replaced, so that `fmt` must not write it.
    pub encoding: Option<encoding::Encoding>,
    /// Where it stands in its file, if that is a Markdown text; the document has it at its lines.
    pub fence: Option<InFence>,
}

/// A fence of a Markdown text.
pub(super) struct InFence {
    /// The whole text.
    pub text: Arc<str>,
    /// The bytes of the fence's content.
    pub content: Range<usize>,
    /// Bytes of line ends before the content in the document.
    pub before: usize,
    /// Whether its lines begin with the blanks of a list, so that they are not formatted.
    pub is_indented: bool,
}

impl Program {
    /// The path and text in which `related` lies; `own` is how the program's own path is shown.
    pub(super) fn file<'a>(&'a self, related: &Related, own: &'a str) -> (&'a str, &'a Document) {
        match related.file.and_then(|number| self.beside.get(number)) {
            Some(beside) => (&beside.path, &beside.document),
            None => (own, &self.document),
        }
    }
}

/// A file of a project that a finding in another file names.
pub(super) struct Beside {
    pub path: String,
    pub document: Document,
}

/// Why nothing is read at a path.
enum Unusable {
    /// No program can be read there.
    Input(String),
    /// The manifest of the project has a mistake, said with its place.
    Manifest(String),
}

impl Unusable {
    fn complain(&self, language: Language) {
        let (code, reason, help) = match self {
            Unusable::Input(reason) => ("unreadable-input", reason, "cli.give-program"),
            Unusable::Manifest(reason) => ("manifest", reason, "cli.mend-manifest"),
        };
        complain(code, reason, &Message::new(help).render(language), language);
    }
}

/// The programs at `paths`, or nothing after complaints about what cannot be read or that there are none.
pub(super) fn programs(
    paths: &[PathBuf],
    target: Option<&'static Target>,
    language: Language,
) -> Option<Vec<Program>> {
    let mut programs: Vec<Program> = Vec::new();
    let mut failed = false;
    // A file that two paths name is one program.
    let mut seen = HashSet::new();
    for path in paths {
        match files_at(path, language) {
            Ok(files) => {
                for (file, manifest) in files {
                    if !seen.insert(file.canonicalize().unwrap_or_else(|_| file.clone())) {
                        continue;
                    }
                    match read_programs(&file, &manifest, target) {
                        Ok(read) => {
                            failed |= read.iter().any(|program| refused(program, target, language));
                            programs.extend(read);
                        }
                        Err(reason) => {
                            failed = true;
                            let help = Message::new("cli.check-path").render(language);
                            let reason = format!("{}: {reason}", file.display());
                            complain("unreadable-input", &reason, &help, language);
                        }
                    }
                }
            }
            Err(unusable) => {
                failed = true;
                unusable.complain(language);
            }
        }
    }
    if programs.is_empty() && !failed {
        let reason = Message::new("cli.no-programs").render(language);
        complain("no-programs", &reason, &Message::new("cli.give-input").render(language), language);
        return None;
    }
    (!failed).then_some(programs)
}

/// Whether the target that the user asks for is none for the language of the program; says so.
fn refused(program: &Program, target: Option<&'static Target>, language: Language) -> bool {
    let is = program.document.target();
    let Some(asked) = target.filter(|asked| asked.name != is.name) else { return false };
    let dialect = if is.is_fx() { "fx" } else { "iec" };
    let reason = Message::new("cli.target-refused").with("path", program.path.display());
    let reason = reason.with("target", asked.name).with("dialect", dialect).render(language);
    complain("target-refused", &reason, &Message::new("cli.choose-target").render(language), language);
    true
}

/// Writes `text` to standard output. A reader that went away, as `head` does, is no failure; where nothing can be
/// written for another reason, as on a full disk, the process ends, lest half a result pass for a whole one.
pub(super) fn say(text: &str) {
    say_bytes(text.as_bytes());
}

/// The same for text in another encoding.
pub(super) fn say_bytes(bytes: &[u8]) {
    let mut output = std::io::stdout().lock();
    let Err(reason) = output.write_all(bytes).and_then(|()| output.flush()) else { return };
    if reason.kind() != ErrorKind::BrokenPipe {
        let language = super::language::spoken();
        let help = Message::new("cli.make-room").render(language);
        complain("unwritable-output", &reason.to_string(), &help, language);
        std::process::exit(2);
    }
}

/// Writes a result to `output`, or to standard output where no file is named; whether it could be written.
pub(super) fn put(text: &str, output: Option<&Path>, language: Language) -> bool {
    let Some(path) = output else {
        say(text);
        return true;
    };
    tell_unwritable(path, std::fs::write(path, text), language)
}

/// Whether a result can be written to `path` later; complains if not. What is there already stays.
pub(super) fn is_writable(path: &Path, language: Language) -> bool {
    let opened = std::fs::OpenOptions::new().create(true).append(true).open(path);
    tell_unwritable(path, opened, language)
}

fn tell_unwritable<T>(path: &Path, written: std::io::Result<T>, language: Language) -> bool {
    if let Err(reason) = &written {
        let help = Message::new("cli.make-room").render(language);
        complain("unwritable", &format!("{}: {reason}", path.display()), &help, language);
    }
    written.is_ok()
}

/// An error on standard error: `error[code]: reason`, and a sentence that helps.
pub(super) fn complain(code: &str, reason: &str, help: &str, language: Language) {
    let help = Message::new("cli.help").with("help", help).render(language);
    let _ = writeln!(std::io::stderr(), "error[{code}]: {reason}\n  {help}");
}

/// A line on standard error that is no complaint.
pub(super) fn remark(words: &str) {
    let _ = writeln!(std::io::stderr(), "{words}");
}

/// A warning on standard error, of the same form; it changes no exit code.
pub(super) fn caution(code: &str, reason: &str, help: &str, language: Language) {
    let help = Message::new("cli.help").with("help", help).render(language);
    let _ = writeln!(std::io::stderr(), "warning[{code}]: {reason}\n  {help}");
}

/// The files at `path` with the manifest of their project.
fn files_at(path: &Path, language: Language) -> Result<Vec<(PathBuf, Arc<Manifest>)>, Unusable> {
    if !path.exists() {
        let reason = Message::new("cli.no-such-file").with("path", path.display());
        return Err(Unusable::Input(reason.render(language)));
    }
    if path.file_name().is_some_and(|name| name == MANIFEST_NAME) {
        return files_at(
            path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")),
            language,
        );
    }
    if path.is_file() {
        if !is_program_file(path) && !is_markdown(path) {
            let reason = Message::new("cli.no-program-file").with("path", path.display());
            return Err(Unusable::Input(reason.render(language)));
        }
        let manifest = manifest_for(path, language)?;
        return Ok(vec![(path.to_path_buf(), manifest)]);
    }
    let unread = |folder: &Path, reason| Unusable::Input(format!("{}: {reason}", folder.display()));
    if path.join(MANIFEST_NAME).is_file() {
        let mut files = Vec::new();
        for project in projects_in(path).iter().map(|folder| Project::read(folder)) {
            let manifest = usable(&project, language)?;
            let own = project.files().map_err(|reason| unread(&project.root, reason))?;
            files.extend(own.into_iter().map(|file| (file, manifest.clone())));
        }
        return Ok(files);
    }
    let files = program_files(path).map_err(|reason| unread(path, reason))?;
    files.into_iter().map(|file| manifest_for(&file, language).map(|manifest| (file, manifest))).collect()
}

/// The folder of the project to which a file belongs.
pub(super) fn folder_of(path: &Path) -> Option<PathBuf> {
    Project::folder_of(&path.canonicalize().ok()?)
}

/// The manifest of the project to which a file or a folder belongs; nothing after a complaint about its mistake.
pub(super) fn usable_manifest(path: &Path, language: Language) -> Option<Arc<Manifest>> {
    manifest_for(path, language).inspect_err(|unusable| unusable.complain(language)).ok()
}

fn manifest_for(path: &Path, language: Language) -> Result<Arc<Manifest>, Unusable> {
    match Project::of(&path.canonicalize().unwrap_or_else(|_| path.to_path_buf())) {
        Some(project) => usable(&project, language),
        None => Ok(Arc::default()),
    }
}

/// The manifest, or its mistake with the place.
fn usable(project: &Project, language: Language) -> Result<Arc<Manifest>, Unusable> {
    let Some(error) = &project.error else { return Ok(Arc::new(project.manifest.clone())) };
    let path = project.root.join(MANIFEST_NAME);
    let LineColumn { line, column } = project.position(error.span.start, Encoding::Utf32);
    let reason = error.message.render(language);
    Err(Unusable::Manifest(format!("{}:{}:{}: {reason}", path.display(), line + 1, column + 1)))
}

/// The program in a file, or all those in the fences of a Markdown text.
pub(super) fn read_programs(
    path: &Path,
    manifest: &Arc<Manifest>,
    target: Option<&'static Target>,
) -> std::io::Result<Vec<Program>> {
    let (text, encoding) = encoding::read(std::fs::read(path)?);
    let program = |name: &str, text: &str, fence: Option<InFence>| {
        let document = open_document(name, text, manifest, target, None);
        let document = document.commented(&super::comments::of(path, manifest));
        let (path, manifest) = (path.to_path_buf(), manifest.clone());
        Program { path, document, manifest, beside: Arc::default(), encoding, fence }
    };
    if !is_markdown(path) {
        return Ok(vec![program(&path.to_string_lossy(), &text, None)]);
    }
    let text: Arc<str> = text.into();
    let programs = fences(&text).into_iter().map(|fence| {
        let isolated = fence.isolated(&text);
        let before = isolated.len() - fence.content.len();
        let (content, is_indented) = (fence.content.clone(), fence.is_indented);
        let place = InFence { text: text.clone(), content, before, is_indented };
        program(fence.ending(), &isolated, Some(place))
    });
    Ok(programs.collect())
}

/// Whether the name is that of a Markdown text. Only those that are named are read, not all of a folder.
fn is_markdown(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("md") || end.eq_ignore_ascii_case("markdown"))
}
