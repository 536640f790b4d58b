//! Program files on the disk.

use std::path::Path;
use std::time::SystemTime;

/// What tells a changed file from an unchanged one without reading it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Stamp {
    /// When it was written, where the system tells.
    pub modified: Option<SystemTime>,
    /// Its length.
    pub bytes: u64,
}

impl Stamp {
    /// That of the file at `path`; nothing if there is none, or if it is a pipe or the like, which might never end.
    pub fn of(path: &Path) -> Option<Stamp> {
        let data = std::fs::metadata(path).ok().filter(|data| data.is_file())?;
        Some(Stamp { modified: data.modified().ok(), bytes: data.len() })
    }
}

/// The text of a file, with a replacement for what is no UTF-8; nothing if it cannot be read.
pub fn read_text(path: &Path) -> Option<String> {
    let bytes = std::fs::read(path).ok()?;
    Some(match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(broken) => String::from_utf8_lossy(broken.as_bytes()).into_owned(),
    })
}
