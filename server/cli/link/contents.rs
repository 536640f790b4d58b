//! Programs for a PLC: from files of every kind, and from what was kept of it before a download.

use crate::cli::Outcome;
use crate::cli::encode::encoded;
use crate::cli::input::complain;
use crate::link::Identity;
use crate::machine_code::Image;
use crate::project::Project;
use crate::target::Target;
use crate::text::{Language, Message};
use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What was in a PLC before a download. `rungwise decode` reads it too.
#[derive(Serialize, Deserialize)]
pub(super) struct Backup {
    model: String,
    /// When it was read.
    time: String,
    steps: usize,
    /// Parameters, in words as they lie in memory.
    parameters: Vec<u16>,
    words: Vec<u16>,
}

/// The words of the program, or the backup, at `path`, and the model that they are for.
///
/// # Errors
/// With the outcome, after complaints.
pub(super) fn words_at(path: &Path, language: Language) -> Result<(Vec<u16>, &'static Target), Outcome> {
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("json")) {
        let encoded = encoded(path, None, language)?;
        return Ok((encoded.words(), encoded.target));
    }
    let read = || -> Option<(Vec<u16>, &'static Target)> {
        let text = std::fs::read_to_string(path).ok()?;
        let backup: Backup = serde_json::from_str(&text).ok()?;
        Some((backup.words, Target::named(&backup.model)?))
    };
    read().ok_or_else(|| {
        let reason = Message::new("link.no-backup-file").with("path", path.display()).render(language);
        complain("bad-backup", &reason, &Message::new("link.help-backup").render(language), language);
        Outcome::Unusable
    })
}

/// Where backups of the project of `beside` are.
fn folder(beside: &Path) -> PathBuf {
    let root = Project::folder_of(beside);
    let near = || beside.parent().filter(|folder| !folder.as_os_str().is_empty()).map(Path::to_path_buf);
    root.or_else(near).unwrap_or_else(|| PathBuf::from(".")).join(".rungwise").join("backup")
}

/// Keeps what was read from a PLC, for nobody else to read.
///
/// # Errors
/// If that cannot be written.
pub(super) fn keep(beside: &Path, identity: Identity, image: &Image) -> io::Result<PathBuf> {
    let folder = folder(beside);
    private_folder(&folder)?;
    let time = Timestamp::now();
    let backup = Backup {
        model: identity.target.name.into(),
        time: time.to_string(),
        steps: image.program().len(),
        parameters: image.parameters().to_words().to_vec(),
        words: image.program().to_vec(),
    };
    let mut file = tempfile::NamedTempFile::new_in(&folder)?;
    serde_json::to_writer_pretty(&mut file, &backup)?;
    file.flush()?;
    let path = folder.join(format!("{}-{}.json", time.strftime("%Y%m%dT%H%M%S%.3fZ"), identity.target.name));
    file.persist(&path)?;
    Ok(path)
}

#[cfg(unix)]
fn private_folder(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::DirBuilderExt;
    std::fs::DirBuilder::new().recursive(true).mode(0o700).create(folder)
}

#[cfg(not(unix))]
fn private_folder(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)
}

/// The latest backup of the project of `beside`.
pub(super) fn latest(beside: &Path) -> Option<PathBuf> {
    let files = std::fs::read_dir(folder(beside)).ok()?.flatten().map(|entry| entry.path());
    files.filter(|path| path.extension().is_some_and(|extension| extension == "json")).max()
}
