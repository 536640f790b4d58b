//! Checks the files of a project together, also where only some of them were asked for.

use super::input::{Beside, Program, complain, folder_of, programs, read_programs};
use crate::check;
use crate::document::{Document, Exports, Member, Outer, ProjectView};
use crate::project::{MOST_PROJECT_BYTES, Project, Surroundings};
use crate::target::Target;
use crate::text::{Diagnostic, Language, Message};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is found in each program; programs of one project see each other and the project's other files.
pub(super) fn checked(
    programs: Vec<Program>,
    target: Option<&'static Target>,
) -> Vec<(Program, Vec<Diagnostic>)> {
    let mut groups: BTreeMap<PathBuf, Vec<usize>> = BTreeMap::new();
    for (number, program) in programs.iter().enumerate() {
        if let Some(root) = folder_of(&program.path) {
            groups.entry(root).or_default().push(number);
        }
    }
    let mut found: Vec<Option<Vec<Diagnostic>>> = programs.iter().map(|_| None).collect();
    let mut programs = programs;
    for (root, numbers) in groups {
        check_project(&root, &numbers, &mut programs, &mut found, target);
    }
    let alone = |program: &Program| check::once(&program.document, &program.manifest.severities());
    let results = programs.into_iter().zip(found);
    results
        .map(|(program, found)| {
            let found = found.unwrap_or_else(|| alone(&program));
            (program, found)
        })
        .collect()
}

/// A file of a project, and its number among the programs that were asked for.
struct File {
    name: String,
    asked: Option<usize>,
    program: Option<Program>,
}

fn check_project(
    root: &Path,
    numbers: &[usize],
    programs: &mut [Program],
    found: &mut [Option<Vec<Diagnostic>>],
    target: Option<&'static Target>,
) {
    let project = Project::read(root);
    let Some(first) = numbers.first().and_then(|number| programs.get(*number)) else { return };
    let manifest = first.manifest.clone();
    let canonical_of = |number: &usize| Some((programs[*number].path.canonicalize().ok()?, *number));
    let asked_for: BTreeMap<PathBuf, usize> = numbers.iter().filter_map(canonical_of).collect();
    let mut bytes = 0;
    let mut files: Vec<File> = Vec::new();
    for path in project.files_in_reach() {
        let name = path.strip_prefix(root).unwrap_or(&path).display().to_string();
        let asked = path.canonicalize().ok().and_then(|path| asked_for.get(&path).copied());
        bytes += std::fs::metadata(&path).map_or(0, |data| data.len());
        // What was not asked for and cannot be read or kept is left out; who asks for it is told.
        let program = match asked {
            None if bytes <= MOST_PROJECT_BYTES => match read_programs(&path, &manifest, target) {
                Ok(programs) => programs.into_iter().next(),
                Err(_) => continue,
            },
            None => continue,
            Some(_) => None,
        };
        files.push(File { name, asked, program });
    }
    if files.len() < 2 {
        return;
    }
    let documents = |programs: &[Program]| {
        let of = |file: &File| match (&file.program, file.asked) {
            (Some(program), _) => program.document.clone(),
            (None, asked) => programs[asked.unwrap_or(0)].document.clone(),
        };
        files.iter().map(of).collect::<Vec<_>>()
    };
    let unlinked = documents(programs);
    let outer = Arc::new(outer_of(root, &unlinked));
    let linked: Vec<_> =
        unlinked.iter().enumerate().map(|(own, document)| document.linked(outer.clone(), own)).collect();
    let members = files.iter().zip(&linked).map(|(file, document)| Member { name: &file.name, document });
    let is_listed = manifest.files.is_some();
    let Some(view) = ProjectView::new(members.collect(), 0, is_listed) else { return };
    let results = check::project(&view, &manifest.severities());
    let beside: Arc<[Beside]> = files
        .iter()
        .zip(&linked)
        .map(|(file, document)| Beside { path: shown_path(file, programs), document: document.clone() })
        .collect();
    for ((file, document), diagnostics) in files.iter().zip(linked).zip(results) {
        let Some(number) = file.asked else { continue };
        found[number] = Some(diagnostics);
        programs[number].document = document;
        programs[number].beside = beside.clone();
    }
}

/// What the files of the project in the folder `root` know of each other.
fn outer_of(root: &Path, documents: &[Document]) -> Outer {
    Outer::new(root.into(), documents.iter().map(|document| Arc::new(Exports::of(document))).collect())
}

/// A program that knows what the other files of its project declare. Those that cannot be read are left out.
pub(super) fn linked(program: Program) -> Program {
    let Some(root) = folder_of(&program.path).filter(|_| !program.document.target().is_fx()) else {
        return program;
    };
    let own_path = program.path.canonicalize().ok();
    let (mut documents, mut own, mut bytes) = (Vec::new(), None, 0);
    for path in Project::read(&root).files_in_reach() {
        bytes += std::fs::metadata(&path).map_or(0, |data| data.len());
        if own_path.is_some() && path.canonicalize().ok() == own_path {
            own = Some(documents.len());
            documents.push(program.document.clone());
        } else if bytes <= MOST_PROJECT_BYTES
            && let Ok(read) = read_programs(&path, &program.manifest, None)
        {
            documents.extend(read.into_iter().next().map(|other| other.document));
        }
    }
    let Some(own) = own.filter(|_| documents.len() > 1) else { return program };
    let document = program.document.linked(Arc::new(outer_of(&root, &documents)), own);
    Program { document, ..program }
}

fn shown_path(file: &File, programs: &[Program]) -> String {
    let path = match (&file.program, file.asked) {
        (Some(program), _) => &program.path,
        (None, asked) => &programs[asked.unwrap_or(0)].path,
    };
    path.display().to_string()
}

/// The files that are one program with the one at `path`, or those of the one program in the folder there; nothing
/// after complaints.
pub(super) fn whole_program(path: &Path, language: Language) -> Option<Vec<Program>> {
    let alone = || programs(&[path.to_path_buf()], None, language);
    let around = match Surroundings::of(path) {
        Ok(around) if around.files.len() > 1 => around,
        Err(reason) if path.exists() => {
            let help = Message::new("cli.check-path").render(language);
            let reason = format!("{}: {reason}", path.display());
            complain("unreadable-input", &reason, &help, language);
            return None;
        }
        _ => return alone(),
    };
    let all = programs(&around.files, None, language)?;
    let documents: Vec<&Document> = all.iter().map(|program| &program.document).collect();
    match around.programs(&documents).as_slice() {
        [numbers] => {
            let mut all: Vec<Option<Program>> = all.into_iter().map(Some).collect();
            Some(numbers.iter().filter_map(|number| all.get_mut(*number).and_then(Option::take)).collect())
        }
        _ => {
            several_programs(path, language);
            None
        }
    }
}

/// Complains of a folder in which each file, or each few of them, is a program of its own.
pub(super) fn several_programs(path: &Path, language: Language) {
    let reason = Message::new("cli.one-program").with("path", path.display());
    let help = Message::new("cli.name-one-file").render(language);
    complain("several-programs", &reason.render(language), &help, language);
}
