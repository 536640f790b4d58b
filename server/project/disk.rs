//! Program files on the disk.

use super::encoding;
use std::path::Path;
use std::time::{Duration, UNIX_EPOCH};

/// What tells a changed file from an unchanged one without reading it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Stamp {
    /// When it was written, since 1970, where the system tells.
    pub modified: Option<Duration>,
    /// Its length.
    pub bytes: u64,
}

impl Stamp {
    /// That of the file at `path`; nothing if there is none, or if it is a pipe or the like, which might never end.
    pub fn of(path: &Path) -> Option<Stamp> {
        let data = std::fs::metadata(path).ok().filter(|data| data.is_file())?;
        let modified = data.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        Some(Stamp { modified, bytes: data.len() })
    }
}

/// The text of a program file in whatever encoding it is written, with a replacement for what means nothing; nothing if
/// it cannot be read.
pub fn read_text(path: &Path) -> Option<String> {
    Some(encoding::read(std::fs::read(path).ok()?).0)
}
