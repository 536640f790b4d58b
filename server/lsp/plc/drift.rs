//! What of a program is not in the PLC as it stands in the text.

use super::super::simulation::files_around;
use super::super::to_proto::Place;
use super::super::workspace::Workspace;
use crate::document::{Document, Notation};
use crate::machine_code::{Image, Program, executed};
use crate::target::{Model, Target};
use crate::text::Message;
use crate::translate::to_machine_code;
use similar::{Algorithm, DiffTag, capture_diff_slices};
use tower_lsp::ls_types::{Range, Uri};

/// A program in words.
pub(super) struct Encoded {
    /// Those that are executed, as they lie in memory.
    pub(super) words: Vec<u16>,
    /// What they are for.
    pub(super) target: &'static Target,
    /// Each file, and its part.
    files: Vec<(Uri, Document, Program)>,
}

/// The document is none that the editor has open.
pub(super) fn not_open(uri: &Uri) -> Message {
    Message::new("link.not-open").with("uri", uri.as_str())
}

/// Whether the document is a ladder diagram.
pub(super) fn is_drawn(workspace: &Workspace, uri: &Uri) -> bool {
    workspace.snapshot().open(uri).is_some_and(|open| open.document.notation() == Notation::Ladder)
}

/// The words of the program that the document at `uri` is a part of.
///
/// # Errors
/// With the first thing that has no words, and its line.
pub(super) fn encoded(workspace: &Workspace, uri: &Uri) -> Result<Encoded, Message> {
    let files = files_around(workspace, uri).ok_or_else(|| not_open(uri))?;
    let own = files.first().map(|(_, _, document)| document.target());
    let of_project = workspace.snapshot().open(uri).and_then(|open| open.manifest.fx_target());
    let model = own.filter(|target| target.is_fx()).or(of_project).map_or(Model::Fx2n, |target| target.model);
    let mut encoded = Encoded { words: Vec::new(), target: Target::of(model), files: Vec::new() };
    let last = files.len().saturating_sub(1);
    for (number, (uri, _, document)) in files.into_iter().enumerate() {
        let program =
            to_machine_code::encode(&document, encoded.target, number == last).map_err(|problems| {
                let first = problems.first();
                let line = first.map_or(0, |first| document.line_of(first.span.start as usize) + 1);
                let reasons = first.map(|first| first.message.clone()).into_iter().collect();
                Message::new("link.no-words").with("line", line).with_messages("reason", reasons)
            })?;
        encoded.words.extend_from_slice(&program.words);
        encoded.files.push((uri, document, program));
    }
    let executed = executed(&encoded.words).len();
    encoded.words.truncate(executed);
    Ok(encoded)
}

/// The instructions of the document at `uri` that are not so in the PLC.
pub(super) fn drift(encoded: &Encoded, image: &Image, workspace: &Workspace, uri: &Uri) -> Vec<Range> {
    let mut is_other = vec![false; encoded.words.len()];
    for part in capture_diff_slices(Algorithm::Myers, image.program(), &encoded.words) {
        if part.tag() != DiffTag::Equal {
            is_other[part.new_range()].fill(true);
        }
    }
    let manner = workspace.snapshot().manner;
    let mut first = 0;
    let mut ranges = Vec::new();
    for (file, document, program) in &encoded.files {
        let place = Place::new(document, manner);
        for line in program.lines.iter().filter(|_| file == uri) {
            let start = first + line.step as usize;
            let steps = is_other.get(start..start + usize::from(line.steps)).unwrap_or_default();
            if steps.contains(&true) {
                ranges.push(place.range(line.span));
            }
        }
        first += program.words.len();
    }
    // What a rung became has its place as a whole.
    ranges.dedup();
    ranges
}
