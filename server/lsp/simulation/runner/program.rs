//! The files of a program as the editor has them, and its code.

use super::super::super::projects::Around;
use super::super::super::workspace::Workspace;
use crate::check;
use crate::document::Document;
use crate::simulate::{Code, compile};
use crate::text::Message;
use std::sync::Arc;
use tower_lsp::ls_types::Uri;

/// The files around the document at `uri` as they are now.
pub(super) fn around(workspace: &Workspace, uri: &Uri) -> Option<Around> {
    let snapshot = workspace.snapshot();
    let open = snapshot.program(uri)?;
    Some(snapshot.around(open))
}

/// The files that are one program with the one that is looked at, in the order of execution.
pub(super) fn files(around: &Around) -> Vec<(Uri, i32, Document)> {
    let numbers = check::program_around(&around.view());
    let files = numbers.into_iter().filter_map(|number| around.file(number));
    files.map(|open| (open.uri.clone(), open.version, open.document.clone())).collect()
}

/// Code that is fast, or that says what it sees.
pub(in crate::lsp) fn compiled(
    files: &[(Uri, i32, Document)],
    is_watched: bool,
) -> Result<Arc<Code>, Message> {
    let documents: Vec<&Document> = files.iter().map(|(_, _, document)| document).collect();
    compile(&documents, is_watched).map(Arc::new).map_err(|problems| {
        let first = problems.first();
        let place = first.and_then(|problem| {
            let (uri, _, document) = files.get(problem.place.document as usize)?;
            let line = document.line_of(problem.place.span.start as usize) + 1;
            let name = uri.path().as_str().rsplit('/').next().unwrap_or_default();
            Some(if files.len() > 1 { format!("{line} ({name})") } else { line.to_string() })
        });
        let reason = first.map(|problem| problem.obstacle.message());
        Message::new("simulate.refused")
            .with("line", place.unwrap_or_default())
            .with_messages("reason", reason.into_iter().collect())
    })
}

/// The files of the program that the document at `uri` is a part of, as the editor has them now.
pub(in crate::lsp) fn files_around(workspace: &Workspace, uri: &Uri) -> Option<Vec<(Uri, i32, Document)>> {
    around(workspace, uri).map(|around| files(&around))
}
