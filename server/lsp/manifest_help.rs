//! Hover and completion in `rungwise.toml` and in scenario tests.

use super::answering::{beside, snapshot};
use super::projects::file_path;
use super::to_proto::{self, Place};
use super::workspace::{Open, is_suite, is_toml};
use crate::ide::{self, FileKind, Schema};
use crate::project::{is_program_file, is_table_file, names_in};
use std::sync::Arc;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::*;

/// A word of a manifest begins with it; in programs it opens no list of proposals.
pub(super) const TRIGGER: &str = "\"";

/// The open manifest or file of scenario tests that is asked about, if it is one.
pub(super) fn asked(at: &TextDocumentPositionParams) -> Option<Arc<Open>> {
    snapshot().open(&at.text_document.uri).filter(|open| is_toml(&open.uri)).cloned()
}

/// Whether proposals are asked for because of a character that asks for none in a program.
pub(super) fn is_for_manifests(context: Option<&CompletionContext>) -> bool {
    context.and_then(|context| context.trigger_character.as_deref()) == Some(TRIGGER)
}

fn schema(open: &Open) -> Schema {
    if is_suite(&open.uri) { Schema::Scenarios } else { Schema::Manifest }
}

pub(super) fn hover(open: &Open, position: Position) -> Option<Hover> {
    let place = Place::new(&open.document, snapshot().manner);
    let hover =
        ide::manifest_hover(schema(open), &open.document.text(), place.offset(position), place.language)?;
    Some(to_proto::hover(place, hover))
}

/// The proposals; those that name files look for them on the disk, on a thread of their own.
pub(super) async fn completion(open: Arc<Open>, position: Position) -> Result<Option<CompletionResponse>> {
    let manner = snapshot().manner;
    beside(move |_| {
        let folder = file_path(&open.uri).and_then(|path| path.parent().map(|folder| folder.to_path_buf()));
        let files = |kind: FileKind| {
            let wanted = match kind {
                FileKind::Program => is_program_file,
                FileKind::Table => is_table_file,
            };
            folder.as_ref().map(|folder| names_in(folder, wanted)).unwrap_or_default()
        };
        let place = Place::new(&open.document, manner);
        let text = open.document.text();
        let proposals =
            ide::manifest_completions(schema(&open), &text, place.offset(position), &files, place.language);
        let items = proposals.into_iter().map(|proposal| to_proto::completion(place, proposal));
        Some(CompletionResponse::Array(items.collect()))
    })
    .await
}
