//! What was in a PLC before a download, kept beside the project in `.rungwise/backup`.

use super::Project;
use crate::machine_code::{Image, ParameterBlock};
use crate::target::Target;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What was in a PLC before a download. `rungwise decode` reads such a file too.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Backup {
    /// The name of the model, as in `rungwise.toml`.
    pub model: String,
    /// When it was read.
    pub time: String,
    /// Through which port.
    #[serde(default)]
    pub port: String,
    /// The version of the PLC, `3.10`.
    #[serde(default)]
    pub version: String,
    /// The sum of the program that was to take the place of this one.
    #[serde(default)]
    pub replaced_by: Option<u16>,
    /// Whether it was a program that the PLC had taken over, and not one that was written in part.
    #[serde(default)]
    pub whole: bool,
    /// Whether the download before which it was read is known to have ended. Older files do not say.
    #[serde(default = "yes")]
    pub ended: bool,
    steps: usize,
    /// Parameters, in words as they lie in memory.
    parameters: Vec<u16>,
    /// The program up to END.
    pub words: Vec<u16>,
}

/// The PLC that a backup is read from, and what will be in it.
pub struct Origin<'a> {
    /// The model.
    pub target: &'a Target,
    /// The port.
    pub port: &'a str,
    /// The version, `3.10`.
    pub version: String,
    /// The sum of the program that takes the place of what is read.
    pub replaced_by: u16,
}

impl Backup {
    /// The backup in a file; nothing if there is none, or none that can be read.
    pub fn read(path: &Path) -> Option<Backup> {
        serde_json::from_str(&std::fs::read_to_string(path).ok()?).ok()
    }

    /// Why what a file holds makes no sense as a backup, with the place in it; nothing if it does.
    pub fn fault(path: &Path) -> Option<String> {
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) => return Some(error.to_string()),
        };
        match serde_json::from_str::<Backup>(&text) {
            Ok(backup) => backup.senseless_member().map(|member| format!("`{member}`")),
            Err(error) => Some(error.to_string()),
        }
    }

    /// The first member that no PLC can have had.
    fn senseless_member(&self) -> Option<&'static str> {
        let target = Target::named(&self.model).filter(|target| target.is_fx());
        let most = target.map_or(0, |target| target.limits.steps_at_most);
        let capacity = self.parameters().capacity();
        let is_wrong = [
            ("model", target.is_none()),
            ("parameters", self.parameters.len() != ParameterBlock::WORDS || !(1..=most).contains(&capacity)),
            ("words", self.words.is_empty() || self.words.len() > capacity as usize),
            ("steps", self.steps != self.words.len()),
        ];
        is_wrong.into_iter().find(|(_, is_wrong)| *is_wrong).map(|(member, _)| member)
    }

    /// The parameters.
    pub fn parameters(&self) -> ParameterBlock {
        ParameterBlock::from_words(&self.parameters)
    }

    /// Whether a file may be one, by its name.
    pub fn is_named_so(path: &Path) -> bool {
        path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
    }

    /// Keeps what was read from a PLC for the project of `beside`, for nobody else to read.
    ///
    /// # Errors
    /// If that cannot be written.
    pub fn keep(beside: &Path, from: &Origin<'_>, (image, is_whole): (&Image, bool)) -> io::Result<PathBuf> {
        let folder = folder(beside);
        private_folder(&folder)?;
        let time = Timestamp::now();
        let backup = Backup {
            model: from.target.name.into(),
            time: time.to_string(),
            port: from.port.into(),
            version: from.version.clone(),
            replaced_by: Some(from.replaced_by),
            whole: is_whole,
            ended: false,
            steps: image.program().len(),
            parameters: image.parameters().to_words().to_vec(),
            words: image.program().to_vec(),
        };
        let path = folder.join(format!("{}-{}.json", time.strftime("%Y%m%dT%H%M%S%.3fZ"), from.target.name));
        backup.write(&path)?;
        Ok(path)
    }

    fn write(&self, path: &Path) -> io::Result<()> {
        let mut file = tempfile::NamedTempFile::new_in(path.parent().unwrap_or(Path::new(".")))?;
        serde_json::to_writer_pretty(&mut file, self)?;
        file.flush()?;
        file.as_file().sync_all()?;
        file.persist(path)?;
        Ok(())
    }

    /// Notes in the backups at `paths` that a download has ended, so that what is in the PLC is whole.
    ///
    /// # Errors
    /// If that cannot be written.
    pub fn note_end<'a>(paths: impl IntoIterator<Item = &'a Path>) -> io::Result<()> {
        for path in paths {
            if let Some(backup) = Backup::read(path).filter(|backup| !backup.ended) {
                Backup { ended: true, ..backup }.write(path)?;
            }
        }
        Ok(())
    }

    /// What a download began to replace that is not known to have ended.
    pub fn replaced(&self) -> Option<&[u16]> {
        (!self.ended).then_some(&self.words[..])
    }

    /// The newest file among the backups of the project of `beside` that is newer than `known` and cannot be read.
    pub fn unreadable_behind(beside: &Path, known: Option<&Path>) -> Option<PathBuf> {
        let files = std::fs::read_dir(folder(beside)).ok()?.flatten().map(|entry| entry.path());
        // Their names begin with the time.
        let newer = files
            .filter(|path| Backup::is_named_so(path) && path.file_name() > known.and_then(Path::file_name));
        newer.filter(|path| Backup::read(path).is_none()).max()
    }

    /// The latest whole one of the project of `beside`. What a download left that did not end is none to go back to.
    pub fn latest(beside: &Path) -> Option<(PathBuf, Backup)> {
        let files = std::fs::read_dir(folder(beside)).ok()?.flatten().map(|entry| entry.path());
        let backups = files.filter_map(|path| Backup::read(&path).map(|backup| (path, backup)));
        backups.filter(|(_, backup)| backup.whole).max_by(|(_, one), (_, other)| one.time.cmp(&other.time))
    }
}

fn yes() -> bool {
    true
}

fn folder(beside: &Path) -> PathBuf {
    let own = if beside.is_dir() { Some(beside) } else { beside.parent() };
    let near = own.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let root = Project::folder_of(beside).unwrap_or_else(|| near.to_path_buf());
    root.join(".rungwise").join("backup")
}

#[cfg(unix)]
fn private_folder(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::{DirBuilderExt, PermissionsExt};
    std::fs::DirBuilder::new().recursive(true).mode(0o700).create(folder)?;
    // It may have been made by something else.
    std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o700))
}

#[cfg(not(unix))]
fn private_folder(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)
}
