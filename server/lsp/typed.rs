//! On-type formatting of a text that the client does not have yet.
//!
//! # `rungwise/typed`
//!
//! A person types faster than a client can ask and apply: when the answer to one character comes, the next ones are in
//! the text, and what belongs to the first can no longer be read from it. A client that notes the keystrokes answers
//! them one after another with this request, on lines of its own making, and changes the text once at the end.
//! Parameters:
//!
//! ```text
//! {
//!   textDocument: { uri, version? },        // a version that is not current fails with ContentModified
//!   lines: { first, end, text },            // what to read instead of these lines, `end` being the first one behind
//!   position: Position,                     // behind the character, in the text with these lines
//!   ch: string                              // a character, or "\n" for Enter
//! }
//! ```
//!
//! `text` ends with a line end, unless the lines are the last of the document.
//!
//! Result: `TextEdit[]` as of `textDocument/onTypeFormatting`, in the text with these lines. Nothing is kept.

use super::editing::MaybeVersioned;
use super::to_proto::Place;
use super::workspace::Open;
use crate::document::Edit;
use crate::ide::{self, Style};
use serde::Deserialize;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{Position, Range, TextEdit};

/// Parameters of `rungwise/typed`.
#[derive(Clone, Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct TypedParams {
    pub text_document: MaybeVersioned,
    pub lines: Lines,
    pub position: Position,
    pub ch: String,
}

/// Lines of the document, counted from 0, and what stands there instead.
#[derive(Clone, Deserialize, Debug)]
pub(super) struct Lines {
    pub first: u32,
    pub end: u32,
    pub text: String,
}

/// Answers `rungwise/typed`.
pub(super) fn edits(
    open: &Open,
    place: Place<'_>,
    params: &TypedParams,
    style: Style,
) -> Result<Vec<TextEdit>> {
    params.text_document.refuse_other(open, place.language)?;
    let Lines { first, end, text } = &params.lines;
    let range = Range::new(Position::new(*first, 0), Position::new((*end).max(*first), 0));
    let mut document = place.document.clone();
    document.apply(&[Edit { range: Some(place.span(range).range()), text: text.clone() }]);
    let there = Place { document: &document, ..place };
    Ok(there.edits(&ide::typed(&document, there.offset(params.position), &params.ch, style)))
}
