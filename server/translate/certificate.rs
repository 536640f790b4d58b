//! The proof that comes with a translation: the result is read again, as a file would be, and compared rung by rung.

use super::source::{self, Source};
use super::{To, Translation, page};
use crate::document::Document;
use crate::target::Target;
use crate::logic::{Comparison, Formulas, Path, compare_but};
use crate::text::{Message, folded};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

/// What is known of a translated rung.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Certificate {
    /// The same bits are driven in the same order under equal conditions.
    Proved,
    /// The same actions in the same order under equal conditions, some of them instructions of which only the words
    /// were compared.
    Construction,
    /// Nothing is proved; the note says why.
    Undecided,
}

impl Certificate {
    /// Whether the translation can be relied upon.
    pub fn is_certain(self) -> bool {
        self != Certificate::Undecided
    }

    /// The word in requests and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Certificate::Proved => "proved",
            Certificate::Construction => "construction",
            Certificate::Undecided => "undecided",
        }
    }
}

/// Certifies each rung of `translation`, which was made of `sources`.
pub(super) fn add(target: &'static Target, sources: &[Source], to: To, translation: &mut Translation) {
    let Some(notation) = page::notation(to) else { return };
    let again = Document::frugal(&translation.text, notation, target);
    let written = source::rungs(&again, None);
    let mut written = written.iter().peekable();
    let helpers: FxHashSet<SmolStr> = translation.helpers.iter().map(|name| folded(name)).collect();
    for (source, translated) in sources.iter().zip(&mut translation.rungs) {
        let mut paths = Vec::new();
        let mut is_readable = true;
        while let Some(rung) = written.next_if(|rung| (rung.span().start as usize) < translated.result.end) {
            match &rung.rung.path {
                Ok(path) => paths.extend(path),
                Err(_) => is_readable = false,
            }
        }
        if translated.note.is_some() {
            // A list is carried along word by word; a drawing in a list is but a comment.
            let carried = source.rung.is_list && to != To::Boolean;
            let certificate = if carried { Certificate::Construction } else { Certificate::Undecided };
            translated.certificate = Some(certificate);
            continue;
        }
        let own: Vec<&Path> = source.rung.path.iter().flatten().collect();
        let (certificate, note) = match is_readable {
            true => judge(&own, &paths, &helpers),
            false => (Certificate::Undecided, Some("translate.unreadable")),
        };
        translated.certificate = Some(certificate);
        translated.note = note.map(Message::new);
    }
}

fn judge(
    own: &[&Path],
    written: &[&Path],
    helpers: &FxHashSet<SmolStr>,
) -> (Certificate, Option<&'static str>) {
    match compare_but(own, written, helpers, &mut Formulas::default()) {
        Comparison::Same { is_boolean: true } => (Certificate::Proved, None),
        Comparison::Same { is_boolean: false } => (Certificate::Construction, None),
        Comparison::Different { .. } | Comparison::Unlike => {
            (Certificate::Undecided, Some("translate.different"))
        }
        Comparison::Undecided => (Certificate::Undecided, Some("translate.undecided")),
    }
}
