//! The program files among which a program is found: those of its project, of a folder, or one that stands alone.

use super::{Project, program_files};
use crate::check;
use crate::document::{Document, Member, ProjectView};
use std::io;
use std::path::{Path, PathBuf};

/// The program files around a path.
#[derive(Debug)]
pub struct Surroundings {
    /// The project to which they belong.
    pub project: Option<Project>,
    /// In the order of execution. Where the path leads to the folder of the project they begin with it, as the user
    /// would write them.
    pub files: Vec<PathBuf>,
    /// The number of the file at the path; nothing where that is a folder, or no program file.
    pub here: Option<usize>,
}

impl Surroundings {
    /// What is around a file, or in a folder. A file that its project does not list stands alone.
    ///
    /// # Errors
    /// Where a folder cannot be read.
    pub fn of(path: &Path) -> io::Result<Surroundings> {
        let canonical = path.canonicalize()?;
        let project = Project::of(&canonical);
        let files = match &project {
            Some(project) => as_written(project.files()?, project, path),
            None if path.is_dir() => program_files(path)?,
            None => Vec::new(),
        };
        let is_here = |file: &PathBuf| file.canonicalize().is_ok_and(|file| file == canonical);
        match files.iter().position(is_here) {
            None if path.is_file() => {
                Ok(Surroundings { project, files: vec![path.to_path_buf()], here: Some(0) })
            }
            here => Ok(Surroundings { project, files, here }),
        }
    }

    /// The programs in these files, whose documents are given in their order: the one with the file at the path, or all
    /// of the folder; each as numbers of files in the order of execution.
    pub fn programs(&self, documents: &[&Document]) -> Vec<Vec<usize>> {
        let members = documents.iter().map(|document| Member { name: "", document }).collect();
        let is_listed = self.project.as_ref().is_some_and(|project| project.manifest.files.is_some());
        let Some(view) = ProjectView::new(members, self.here.unwrap_or(0), is_listed) else {
            return Vec::new();
        };
        match self.here {
            Some(_) => vec![check::program_around(&view)],
            None => check::programs(&view),
        }
    }
}

/// The files of a project, whose root is a real path, as below the folder that `path` names.
fn as_written(files: Vec<PathBuf>, project: &Project, path: &Path) -> Vec<PathBuf> {
    // `..` may lead out of a project, in whose folder the path begins, so the folder is looked at.
    let written = Project::folder_of(path).filter(|folder| {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        folder.canonicalize().is_ok_and(|folder| folder == project.root)
    });
    let Some(written) = written else { return files };
    let below =
        |file: PathBuf| file.strip_prefix(&project.root).map_or(file.clone(), |below| written.join(below));
    files.into_iter().map(below).collect()
}
