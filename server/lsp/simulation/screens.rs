//! What the client shows of each file of a program that is simulated.

use super::super::to_proto::{Manner, Place};
use super::monitor::Monitor;
use crate::document::Document;
use crate::simulate::Code;
use std::ops::Range;
use tower_lsp::ls_types::Uri;

/// A file of a program: its address, the version that runs, and its document.
pub(super) type File = (Uri, i32, Document);

/// A monitor for each file that somebody has looked at.
#[derive(Default)]
pub(super) struct Screens(Vec<(Uri, Monitor)>);

impl Screens {
    /// What is shown of a file.
    pub(super) fn of(&self, uri: &Uri) -> Option<&Monitor> {
        self.0.iter().find(|(own, _)| own == uri).map(|(_, monitor)| monitor)
    }

    /// The same to change it.
    pub(super) fn of_mut(&mut self, uri: &Uri) -> &mut Monitor {
        let at = self.0.iter().position(|(own, _)| own == uri).unwrap_or_else(|| {
            self.0.push((uri.clone(), Monitor::default()));
            self.0.len() - 1
        });
        &mut self.0[at].1
    }

    /// Each of which something is shown, with its address.
    pub(super) fn shown(&self) -> impl Iterator<Item = (&Uri, &Monitor)> {
        self.0.iter().filter(|(_, monitor)| !monitor.is_empty()).map(|(uri, monitor)| (uri, monitor))
    }

    /// Whether lines of some text are shown.
    pub(super) fn has_text(&self) -> bool {
        self.0.iter().any(|(_, monitor)| monitor.has_text())
    }

    /// The instructions that are shown.
    pub(super) fn instructions(&self, code: &Code) -> Vec<Range<u32>> {
        self.shown().map(|(_, monitor)| monitor.instructions(code)).collect()
    }

    /// Finds the bytes that are shown in the files of the program as they are now; what is none of them is forgotten.
    pub(super) fn place(&mut self, files: &[File], manner: Manner) {
        self.0.retain_mut(|(uri, monitor)| {
            let Some(number) = files.iter().position(|(file, ..)| file == uri) else { return false };
            monitor.place(number as u32, Place::new(&files[number].2, manner));
            true
        });
    }
}
