//! Names of files in comments and in the manifest.

use crate::document::Document;
use crate::text::Span;

/// How the files end to which links go.
const ENDINGS: &[&str] = &[".lad", ".il", ".csv", ".toml"];

/// The names of files in the comments of `document`, as they are written there.
pub(super) fn of(document: &Document) -> Vec<(Span, String)> {
    let mut links = Vec::new();
    for at in document.chunks() {
        if in_text(at.chunk.text()).is_empty() {
            continue;
        }
        let reading = at.chunk.reading();
        for comment in reading.tree().comments() {
            let found = in_text(comment.of(at.chunk.text())).into_iter();
            let start = at.start + comment.start as usize;
            links.extend(found.map(|(span, name)| (span.shifted(start), name)));
        }
    }
    links
}

/// The names of files in any text.
pub(super) fn in_text(text: &str) -> Vec<(Span, String)> {
    let part = |c: char| c.is_alphanumeric() || "_-./\\~+".contains(c);
    let mut links = Vec::new();
    for word in text.split(|c: char| !part(c)).filter(|word| !word.is_empty()) {
        let name = word.trim_end_matches('.');
        let folded = name.to_ascii_lowercase();
        let has_ending = ENDINGS.iter().any(|ending| folded.len() > ending.len() && folded.ends_with(ending));
        if has_ending {
            let start = word.as_ptr() as usize - text.as_ptr() as usize;
            links.push((Span::new(start, start + name.len()), name.to_string()));
        }
    }
    links
}
