//! Structural edits of ladder drawings over the protocol.
//!
//! # `rungwise/edit`
//!
//! A request. Parameters:
//!
//! ```text
//! {
//!   textDocument: { uri, version? },   // an edit for a version that is not current fails with ContentModified
//!   range: Range,                      // the cursor (empty) or the selection
//!   edit: string,                      // see below
//!   operand?: string                   // the name (`T0 K50`, `MOV K10 D0`, `Delay : TON`) of what is inserted
//! }
//! ```
//!
//! `edit` is one of `insertContact`, `insertNegatedContact`, `insertCoil`, `insertSetCoil`, `insertResetCoil`,
//! `insertBox`, `insertBranch` (a new branch parallel to the element at the cursor or to the selected ones),
//! `insertRung` (below), `insertRungAbove`, `moveBranchUp`, `moveBranchDown`, `wrapInBranch` (the selection becomes one
//! branch of a parallel pair), `deleteElement` (and the gap is closed), `deleteBranch`, `negate` (toggles), `mend`
//! (re-aligns the rung after a paste or a deletion).
//!
//! Result: `{ edits: TextEdit[], selection: Range }`. The edits are minimal and do not overlap; the selection is in the
//! text after them: over the placeholder `???` of a name that is to be typed, behind an element that was inserted
//! with its operand, else where the edit was made. A rung that needs no mending gives no edits.
//!
//! Errors: a JSON-RPC error whose message says in the user's language why not; nothing is ever changed in part.
//!
//! # `rungwise/object`
//!
//! A request about text objects. Parameters:
//!
//! ```text
//! { textDocument: { uri }, position: Position, object: "element" | "branch" | "rung" | "network", around: bool }
//! ```
//!
//! Result: `{ range: Range, blockwise: bool }`, or null where there is none. A blockwise range is a rectangle of
//! cells from its start to before its end; others are the text between. Around an element is its name on another row,
//! around a branch its wires up to the vertical ones, around a rung its comment and the blank lines below, around a
//! network its header.
//!
//! # Code actions
//!
//! The same edits as actions of kind `refactor.rewrite.ladder.<edit>`, offered where they make sense. A client that
//! resolves the property `edit` gets them without it.

use super::to_proto::Place;
use super::workspace::Open;
use crate::ide::{self, EditKind, ObjectKind, Style};
use crate::text::{Language, Message};
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::HashMap;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::*;

/// Parameters of `rungwise/edit`.
#[derive(Clone, Serialize, Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct EditParams {
    pub text_document: MaybeVersioned,
    pub range: Range,
    pub edit: String,
    pub operand: Option<String>,
}

/// A document, and the version that the client had when it asked.
#[derive(Clone, Serialize, Deserialize, Debug)]
pub(super) struct MaybeVersioned {
    pub uri: Uri,
    pub version: Option<i32>,
}

impl MaybeVersioned {
    /// Refuses what was asked about another version than the one that is open.
    pub(super) fn refuse_other(&self, open: &Open, language: Language) -> Result<()> {
        if self.version.is_none_or(|version| version == open.version) {
            return Ok(());
        }
        let message = Message::new("edit.stale").render(language);
        Err(Error { message: message.into(), ..Error::content_modified() })
    }
}

/// Result of `rungwise/edit`.
#[derive(Clone, Serialize, Debug)]
pub(super) struct EditResult {
    pub edits: Vec<TextEdit>,
    pub selection: Range,
}

/// Answers `rungwise/edit`.
pub(super) fn edit(open: &Open, place: Place<'_>, params: &EditParams, style: Style) -> Result<EditResult> {
    params.text_document.refuse_other(open, place.language)?;
    let refused = |message: Message| Error::invalid_params(message.render(place.language));
    let unknown = || refused(Message::new("edit.unknown").with("edit", &params.edit));
    let kind = EditKind::named(&params.edit).ok_or_else(unknown)?;
    let span = place.span(params.range);
    let edited = ide::edit(place.document, span, kind, params.operand.as_deref(), style).map_err(refused)?;
    let mut after = place.document.clone();
    let edits = edited
        .edits
        .iter()
        .rev()
        .map(|edit| crate::document::Edit { range: Some(edit.span.range()), text: edit.text.clone() });
    after.apply(&edits.collect::<Vec<_>>());
    let selection = Place { document: &after, ..place }.range(edited.selection);
    Ok(EditResult { edits: place.edits(&edited.edits), selection })
}

/// Parameters of `rungwise/object`.
#[derive(Clone, Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub(super) struct ObjectParams {
    pub text_document: TextDocumentIdentifier,
    pub position: Position,
    pub object: String,
    #[serde(default)]
    pub around: bool,
}

/// Result of `rungwise/object`.
#[derive(Clone, Serialize, Debug)]
pub(super) struct ObjectResult {
    pub range: Range,
    pub blockwise: bool,
}

/// Answers `rungwise/object`.
pub(super) fn object(place: Place<'_>, params: &ObjectParams) -> Option<ObjectResult> {
    let kind = match params.object.as_str() {
        "element" => ObjectKind::Element,
        "branch" => ObjectKind::Branch,
        "rung" => ObjectKind::Rung,
        "network" => ObjectKind::Network,
        _ => return None,
    };
    let object = ide::object(place.document, place.offset(params.position), kind, params.around)?;
    Some(ObjectResult { range: place.range(object.span), blockwise: object.blockwise })
}

/// The selection ranges at a position, each with the next larger one as its parent.
pub(super) fn selection_range(place: Place<'_>, position: Position) -> SelectionRange {
    let spans = ide::selection_ranges(place.document, place.offset(position));
    let outward = spans.into_iter().rev().fold(None, |parent, span| {
        Some(SelectionRange { range: place.range(span), parent: parent.map(Box::new) })
    });
    outward.unwrap_or(SelectionRange { range: Range::new(position, position), parent: None })
}

/// The kind of the code action for an edit.
fn action_kind(kind: EditKind) -> CodeActionKind {
    format!("refactor.rewrite.ladder.{}", kind.name()).into()
}

/// Whether a client that asks for these kinds only would take an action of that kind.
pub(super) fn is_wanted(kind: &CodeActionKind, only: Option<&[CodeActionKind]>) -> bool {
    let within = |outer: &CodeActionKind| {
        let rest = kind.as_str().strip_prefix(outer.as_str());
        outer.as_str().is_empty() || rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    only.is_none_or(|only| only.iter().any(within))
}

/// The structural edits at a range as code actions; with their edits if the client does not resolve these.
pub(super) fn actions(
    open: &Open,
    place: Place<'_>,
    params: &CodeActionParams,
    style: Style,
    resolves: bool,
) -> Vec<CodeAction> {
    let only = params.context.only.as_deref();
    if !is_wanted(&CodeActionKind::new("refactor.rewrite.ladder"), only)
        && !EditKind::all().any(|kind| is_wanted(&action_kind(kind), only))
    {
        return Vec::new();
    }
    let kinds = ide::applicable_edits(place.document, place.span(params.range)).into_iter();
    let actions = kinds.filter(|kind| is_wanted(&action_kind(*kind), only)).filter_map(|kind| {
        let asked = EditParams {
            text_document: MaybeVersioned { uri: open.uri.clone(), version: Some(open.version) },
            range: params.range,
            edit: kind.name().to_string(),
            operand: None,
        };
        let action = CodeAction {
            title: kind.title().render(place.language),
            kind: Some(action_kind(kind)),
            ..CodeAction::default()
        };
        if resolves {
            return Some(CodeAction { data: Some(json!(asked)), ..action });
        }
        let result = edit(open, place, &asked, style).ok()?;
        Some(CodeAction { edit: Some(changes(open, result.edits)), ..action })
    });
    actions.collect()
}

/// What an action that was offered without its edit stands for; nothing for other actions.
pub(super) fn asked_by(action: &CodeAction) -> Option<EditParams> {
    EditParams::deserialize(action.data.as_ref()?).ok()
}

/// The edits of one document. Plain changes reach every client.
pub(super) fn changes(open: &Open, edits: Vec<TextEdit>) -> WorkspaceEdit {
    WorkspaceEdit { changes: Some(HashMap::from([(open.uri.clone(), edits)])), ..WorkspaceEdit::default() }
}

/// On-type formatting after Enter and every character of which drawings and their names are made.
pub(super) fn on_type() -> DocumentOnTypeFormattingOptions {
    let printable = (' '..='~').chain("─│┌┐└┘├┤┬┴┼".chars()).map(String::from);
    DocumentOnTypeFormattingOptions {
        first_trigger_character: "\n".to_string(),
        more_trigger_character: Some(printable.collect()),
    }
}

/// Whether a client asks for the edits of code actions when one is chosen.
pub(super) fn resolves_actions(client: &ClientCapabilities) -> bool {
    let action = client.text_document.as_ref().and_then(|document| document.code_action.as_ref());
    let resolve = action.and_then(|action| action.resolve_support.as_ref());
    resolve.is_some_and(|resolve| resolve.properties.iter().any(|property| property == "edit"))
}
