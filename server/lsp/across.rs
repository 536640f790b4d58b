//! Answers that name several files: places, edits, calls, links.

use super::abilities::Abilities;
use super::projects::{Around, file_path};
use super::to_proto::{self, Manner, Place};
use super::workspace::{Open, Snapshot};
use super::{capabilities, features};
use crate::document::{At, ProjectView};
use crate::ide::{self, CallItem};
use crate::project::MANIFEST_NAME;
use crate::text::{Message, Span, TextEdit as Edit};
use serde_json::json;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;
use tower_lsp::ls_types::*;

/// The places in the files of `around`; those in files that went away are left out.
pub(super) fn locations(around: &Around, places: Vec<At<Span>>, manner: Manner) -> Vec<Location> {
    let location = |at: At<Span>| Some(to_proto::location(around.file(at.file)?, at.value, manner));
    places.into_iter().filter_map(location).collect()
}

/// Where the name at `position` comes from; with the range of the name where the client shows it.
pub(super) fn definition(around: &Around, place: Place<'_>, position: Position) -> GotoDefinitionResponse {
    let offset = place.offset(position);
    let found = ide::definition_in(&around.view(), offset);
    let locations = locations(around, found, place.manner());
    if !place.abilities.links {
        return GotoDefinitionResponse::Array(locations);
    }
    let origin = ide::references_in(&around.view().alone_here(), offset, true);
    let origin = origin.into_iter().find(|at| at.value.touches(offset)).map(|at| place.range(at.value));
    let links = locations.into_iter().map(|Location { uri, range }| LocationLink {
        origin_selection_range: origin,
        target_uri: uri,
        target_range: range,
        target_selection_range: range,
    });
    GotoDefinitionResponse::Link(links.collect())
}

pub(super) fn references(
    around: &Around,
    place: Place<'_>,
    position: Position,
    with_declaration: bool,
) -> Vec<Location> {
    let found = ide::references_in(&around.view(), place.offset(position), with_declaration);
    locations(around, found, place.manner())
}

/// The edits that rename the name at `position` in all files, the device comments file of the project among them.
///
/// # Errors
/// With the reason why it cannot be renamed so.
pub(super) fn rename(
    snapshot: &Snapshot,
    around: &Around,
    place: Place<'_>,
    position: Position,
    new: &str,
) -> Result<WorkspaceEdit, Message> {
    let (view, offset) = (around.view(), place.offset(position));
    let (changes, table) = match ide::rename_symbol(&view, offset, new) {
        Some(renamed) => renamed.map(|renamed| (renamed.files, renamed.table))?,
        None => {
            let changes = ide::rename_in(&view, offset, new)?;
            (changes, ide::rename_in_comments(place.document, offset, new)?)
        }
    };
    let table = table.and_then(|edit| Some((features::table(snapshot, around)?, vec![edit])));
    let files = changes.into_iter().filter_map(|at| Some((around.file(at.file)?.clone(), at.value)));
    Ok(workspace_edit(files.chain(table), place.manner()))
}

/// Edits of several files: bound to their versions where the client knows that.
pub(super) fn workspace_edit(
    files: impl IntoIterator<Item = (Arc<Open>, Vec<Edit>)>,
    manner: Manner,
) -> WorkspaceEdit {
    let files = files.into_iter().map(|(file, edits)| {
        let edits = Place::new(&file.document, manner).edits(&edits);
        (file, edits)
    });
    if !manner.abilities.document_changes {
        #[allow(clippy::mutable_key_type, reason = "the protocol's struct has such a map")]
        let changes: HashMap<Uri, Vec<TextEdit>> =
            files.map(|(file, edits)| (file.uri.clone(), edits)).collect();
        return WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() };
    }
    let edits = files.map(|(file, edits)| TextDocumentEdit {
        text_document: OptionalVersionedTextDocumentIdentifier {
            uri: file.uri.clone(),
            // A file that is not open has no version.
            version: file.is_open.then_some(file.version),
        },
        edits: edits.into_iter().map(OneOf::Left).collect(),
    });
    let document_changes = DocumentChanges::Edits(edits.collect());
    WorkspaceEdit { document_changes: Some(document_changes), ..WorkspaceEdit::default() }
}

/// A code action, or the command that does the same in a client that knows no code actions.
pub(super) fn code_action(action: CodeAction, abilities: Abilities) -> CodeActionOrCommand {
    match (abilities.code_actions, &action.edit) {
        (false, Some(edit)) => CodeActionOrCommand::Command(Command {
            title: action.title,
            command: capabilities::APPLY.to_string(),
            arguments: Some(vec![json!(edit)]),
        }),
        (false, None) if action.command.is_some() => {
            let command = action.command.unwrap_or_default();
            CodeActionOrCommand::Command(command)
        }
        _ => CodeActionOrCommand::CodeAction(action),
    }
}

/// Names in all projects and open documents that have the letters of `query`.
pub(super) fn symbols(everything: &Around, query: &str, manner: Manner) -> Vec<WorkspaceSymbol> {
    let found = ide::workspace_symbols(&everything.view(), query).into_iter();
    let symbols = found.filter_map(|symbol| {
        let location = to_proto::location(everything.file(symbol.file)?, symbol.span, manner);
        Some(WorkspaceSymbol {
            name: symbol.name,
            kind: to_proto::symbol_kind(symbol.kind),
            tags: None,
            container_name: (!symbol.container.is_empty()).then_some(symbol.container),
            location: OneOf::Left(location),
            data: None,
        })
    });
    symbols.collect()
}

pub(super) fn prepare_calls(around: &Around, place: Place<'_>, position: Position) -> Vec<CallHierarchyItem> {
    let item = ide::call_item(&around.view(), place.offset(position));
    item.and_then(|item| call_item(around, item, place.manner())).into_iter().collect()
}

pub(super) fn incoming_calls(
    around: &Around,
    place: Place<'_>,
    item: &CallHierarchyItem,
) -> Vec<CallHierarchyIncomingCall> {
    let view = around.view();
    let Some(item) = called_back(&view, place, item) else { return Vec::new() };
    let calls = ide::incoming_calls(&view, &item).into_iter().filter_map(|(from, spans)| {
        let from_ranges = ranges(around, from.file, &spans, place.manner())?;
        Some(CallHierarchyIncomingCall { from: call_item(around, from, place.manner())?, from_ranges })
    });
    calls.collect()
}

pub(super) fn outgoing_calls(
    around: &Around,
    place: Place<'_>,
    item: &CallHierarchyItem,
) -> Vec<CallHierarchyOutgoingCall> {
    let view = around.view();
    let Some(item) = called_back(&view, place, item) else { return Vec::new() };
    let calls = ide::outgoing_calls(&view, &item).into_iter().filter_map(|(to, spans)| {
        let from_ranges = ranges(around, item.file, &spans, place.manner())?;
        Some(CallHierarchyOutgoingCall { to: call_item(around, to, place.manner())?, from_ranges })
    });
    calls.collect()
}

fn ranges(around: &Around, file: usize, spans: &[Span], manner: Manner) -> Option<Vec<Range>> {
    let place = Place::new(&around.file(file)?.document, manner);
    Some(spans.iter().map(|span| place.range(*span)).collect())
}

/// The item that the client gives back, as the program has it now.
fn called_back(view: &ProjectView<'_>, place: Place<'_>, item: &CallHierarchyItem) -> Option<CallItem> {
    let is_main = item.data.as_ref().and_then(|data| data.get("main")).is_some();
    if is_main {
        ide::main_item(view)
    } else {
        ide::call_item(view, place.offset(item.selection_range.start))
    }
}

fn call_item(around: &Around, item: CallItem, manner: Manner) -> Option<CallHierarchyItem> {
    let file = around.file(item.file)?;
    let place = Place::new(&file.document, manner);
    let own_name = || file.uri.path().as_str().rsplit('/').next().unwrap_or("").to_string();
    Some(CallHierarchyItem {
        name: if item.name.is_empty() { own_name() } else { item.name },
        kind: to_proto::symbol_kind(item.kind),
        tags: None,
        detail: (!item.detail.is_empty()).then_some(item.detail),
        uri: file.uri.clone(),
        range: place.range(item.span),
        selection_range: place.range(item.selection),
        data: item.is_main.then(|| json!({"main": true})),
    })
}

/// The names of files in the document's comments, or in a manifest, that are files.
pub(super) fn links(snapshot: &Snapshot, uri: &Uri) -> Option<Vec<DocumentLink>> {
    let path = file_path(uri)?;
    let folder = path.parent()?;
    let open = snapshot.open(uri);
    let is_manifest = path.file_name().is_some_and(|name| name == MANIFEST_NAME);
    let (document, found) = match (open, is_manifest) {
        (Some(open), false) => (open.document.clone(), ide::links(&open.document)),
        (Some(open), true) => (open.document.clone(), ide::links_in_text(&open.document.text())),
        (None, _) => return None,
    };
    let place = Place::new(&document, snapshot.manner);
    let root = open.and_then(|open| snapshot.projects.get(open.project.as_ref()?)).map(|loaded| &loaded.root);
    let links = found.into_iter().filter_map(|(span, name)| {
        // A file is named from the folder of the one that names it, or from that of the project.
        let folders = std::iter::once(folder).chain(root.map(PathBuf::as_path));
        let target =
            folders.map(|folder| folder.join(name.replace('\\', "/"))).find(|path| path.is_file())?;
        Some(DocumentLink {
            range: place.range(span),
            target: Some(Uri::from_file_path(target)?),
            tooltip: None,
            data: None,
        })
    });
    Some(links.collect())
}
