//! The handlers: a few lines each, from the snapshot of the request to the answer of `ide`.

use super::capabilities;
use super::projects::Around;
use super::to_proto::{self, Place};
use super::workspace::{Open, SNAPSHOT, Snapshot, Workspace};
use crate::ide;
use crate::text::{Language, Message};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::hash::BuildHasher;
use std::sync::Arc;
use tower_lsp::LanguageServer;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::*;

/// The server's side of the protocol. Its state is in the workspace; handlers see snapshots only.
pub(super) struct Backend {
    workspace: Arc<Workspace>,
}

impl Backend {
    pub(super) fn new(workspace: Arc<Workspace>) -> Backend {
        Backend { workspace }
    }
}

impl LanguageServer for Backend {
    async fn initialize(&self, params: InitializeParams) -> Result<InitializeResult> {
        // The workspace took what these say when the message was read.
        let Snapshot { manner, settings, .. } = self.workspace.snapshot();
        Ok(capabilities::offered(&params.capabilities, manner.encoding, settings.pulls()))
    }

    async fn initialized(&self, _: InitializedParams) {
        let requests = self.workspace.requests();
        let registrations = capabilities::registrations(requests);
        if requests.configuration {
            self.workspace.ask_configuration();
        }
        if registrations.is_empty() {
            return;
        }
        let client = self.workspace.client.clone();
        // The client may answer late or never; no handler waits for it.
        tokio::spawn(async move {
            if let Err(reason) = client.register_capability(registrations).await {
                tracing::warn!("the client does not watch files: {reason}");
            }
        });
    }

    async fn shutdown(&self) -> Result<()> {
        Ok(())
    }

    async fn hover(&self, params: HoverParams) -> Result<Option<Hover>> {
        let at = params.text_document_position_params;
        Ok(with_open(&at.text_document.uri, |_, place| {
            let hover = ide::hover(place.document, place.offset(at.position), place.language)?;
            Some(to_proto::hover(place, hover))
        }))
    }

    async fn completion(&self, params: CompletionParams) -> Result<Option<CompletionResponse>> {
        let at = params.text_document_position;
        Ok(with_open(&at.text_document.uri, |_, place| {
            let proposals = ide::completions(place.document, place.offset(at.position), place.language);
            let items = proposals.into_iter().map(|proposal| to_proto::completion(place, proposal));
            Some(CompletionResponse::Array(items.collect()))
        }))
    }

    async fn goto_definition(&self, params: GotoDefinitionParams) -> Result<Option<GotoDefinitionResponse>> {
        let at = params.text_document_position_params;
        Ok(with_open(&at.text_document.uri, |open, place| {
            let spans = ide::definition(place.document, place.offset(at.position));
            let locations = spans.into_iter().map(|span| Location::new(open.uri.clone(), place.range(span)));
            Some(GotoDefinitionResponse::Array(locations.collect()))
        }))
    }

    async fn references(&self, params: ReferenceParams) -> Result<Option<Vec<Location>>> {
        let at = params.text_document_position;
        let with_declaration = params.context.include_declaration;
        Ok(with_open(&at.text_document.uri, |open, place| {
            let spans = ide::references(place.document, place.offset(at.position), with_declaration);
            Some(spans.into_iter().map(|span| Location::new(open.uri.clone(), place.range(span))).collect())
        }))
    }

    async fn prepare_rename(
        &self,
        params: TextDocumentPositionParams,
    ) -> Result<Option<PrepareRenameResponse>> {
        Ok(with_open(&params.text_document.uri, |_, place| {
            let span = ide::renamable(place.document, place.offset(params.position))?;
            Some(PrepareRenameResponse::Range(place.range(span)))
        }))
    }

    async fn rename(&self, params: RenameParams) -> Result<Option<WorkspaceEdit>> {
        let at = params.text_document_position;
        let renamed = with_open(&at.text_document.uri, |open, place| {
            let edits = ide::rename(place.document, place.offset(at.position), &params.new_name);
            Some(edits.map(|edits| workspace_edit(open, place.edits(&edits))))
        });
        renamed.transpose().map_err(refused)
    }

    async fn document_symbol(&self, params: DocumentSymbolParams) -> Result<Option<DocumentSymbolResponse>> {
        whole(params.text_document.uri, |_, place| {
            let nodes = ide::symbols(place.document, place.language)
                .into_iter()
                .map(|node| to_proto::symbol(place, node));
            DocumentSymbolResponse::Nested(nodes.collect())
        })
        .await
    }

    async fn folding_range(&self, params: FoldingRangeParams) -> Result<Option<Vec<FoldingRange>>> {
        whole(params.text_document.uri, |_, place| {
            ide::folds(place.document).into_iter().map(|fold| to_proto::fold(place, fold)).collect()
        })
        .await
    }

    async fn semantic_tokens_full(
        &self,
        params: SemanticTokensParams,
    ) -> Result<Option<SemanticTokensResult>> {
        whole(params.text_document.uri, |_, place| {
            to_proto::semantic_tokens(place, &ide::semantic_tokens(place.document)).into()
        })
        .await
    }

    async fn inlay_hint(&self, params: InlayHintParams) -> Result<Option<Vec<InlayHint>>> {
        if !SNAPSHOT.with(|snapshot| snapshot.settings.inlay_hints) {
            return Ok(None);
        }
        whole(params.text_document.uri, move |_, place| {
            let hints = ide::inlay_hints(place.document, place.span(params.range), place.language);
            hints.into_iter().map(|hint| to_proto::inlay_hint(place, hint)).collect()
        })
        .await
    }

    async fn formatting(&self, params: DocumentFormattingParams) -> Result<Option<Vec<TextEdit>>> {
        let settings = SNAPSHOT.with(|snapshot| snapshot.settings.clone());
        whole(params.text_document.uri, move |around, place| {
            place.edits(&ide::format(place.document, settings.style(&around.here().manifest)))
        })
        .await
    }

    async fn code_action(&self, params: CodeActionParams) -> Result<Option<CodeActionResponse>> {
        whole(params.text_document.uri, move |around, place| {
            let found = around.findings();
            let fixes = ide::fixes(&found, place.span(params.range)).into_iter();
            fixes.map(|fix| quick_fix(around, place, &fix).into()).collect()
        })
        .await
    }

    async fn diagnostic(&self, params: DocumentDiagnosticParams) -> Result<DocumentDiagnosticReportResult> {
        let manner = SNAPSHOT.with(|snapshot| snapshot.manner);
        let uri = params.text_document.uri;
        let items = whole(uri, move |around, _| to_proto::diagnostics(around, around.findings(), manner));
        Ok(report(items.await?.unwrap_or_default(), params.previous_result_id))
    }

    async fn execute_command(&self, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
        let Some(uri) =
            params.arguments.first().and_then(|value| value.as_str()).and_then(|text| text.parse().ok())
        else {
            return Err(Error::invalid_params(format!(
                "{}: the first argument is a document's URI",
                params.command
            )));
        };
        match params.command.as_str() {
            "rungwise.check" => whole(uri, |around, place| check_summary(around, place.language)).await,
            "rungwise.format" => self.format(uri).await,
            other => Err(Error::invalid_params(format!("no such command: {other}"))),
        }
    }
}

impl Backend {
    /// Computes the edits and asks the client to apply them; the answer says how many there are.
    async fn format(&self, uri: Uri) -> Result<Option<LSPAny>> {
        let settings = SNAPSHOT.with(|snapshot| snapshot.settings.clone());
        let edit = whole(uri, move |around, place| {
            let open = around.here();
            let edits = place.edits(&ide::format(place.document, settings.style(&open.manifest)));
            (edits.len(), workspace_edit(open, edits))
        });
        let Some((count, edit)) = edit.await? else { return Ok(None) };
        let client = self.workspace.client.clone();
        // The client may answer late or never; no handler waits for it.
        tokio::spawn(async move {
            if let Err(reason) = client.apply_edit(edit).await {
                tracing::warn!("the client did not apply the edits: {reason}");
            }
        });
        Ok(Some(json!({"edits": count})))
    }
}

/// The answer about an open document; nothing for one that is not open.
fn with_open<T>(uri: &Uri, answer: impl FnOnce(&Open, Place<'_>) -> Option<T>) -> Option<T> {
    let snapshot: Snapshot = SNAPSHOT.with(Clone::clone);
    let open = snapshot.open(uri)?;
    answer(open, Place::new(&open.document, snapshot.manner))
}

/// The same for answers that walk the whole document: they run on a thread of their own.
async fn whole<T: Send + 'static>(
    uri: Uri,
    answer: impl FnOnce(&Around, Place<'_>) -> T + Send + 'static,
) -> Result<Option<T>> {
    let snapshot: Snapshot = SNAPSHOT.with(Clone::clone);
    let work = tokio::task::spawn_blocking(move || {
        let around = snapshot.around(snapshot.open(&uri)?);
        Some(answer(&around, Place::new(&around.here().document, snapshot.manner)))
    });
    work.await.map_err(|failure| {
        tracing::error!("a request failed: {failure}");
        Error::internal_error()
    })
}

fn workspace_edit(open: &Open, edits: Vec<TextEdit>) -> WorkspaceEdit {
    let identifier =
        OptionalVersionedTextDocumentIdentifier { uri: open.uri.clone(), version: Some(open.version) };
    let edits = edits.into_iter().map(OneOf::Left).collect();
    let document_changes =
        DocumentChanges::Edits(vec![TextDocumentEdit { text_document: identifier, edits }]);
    WorkspaceEdit { document_changes: Some(document_changes), ..WorkspaceEdit::default() }
}

fn quick_fix(around: &Around, place: Place<'_>, fix: &ide::FixOf<'_>) -> CodeAction {
    // Plain changes reach every client, also one that knows no versioned edits.
    let changes = HashMap::from([(around.here().uri.clone(), place.edits(&fix.fix.edits))]);
    CodeAction {
        title: fix.fix.title.render(place.language),
        kind: Some(CodeActionKind::QUICKFIX),
        diagnostics: Some(vec![to_proto::diagnostic(around, fix.diagnostic, place.manner())]),
        edit: Some(WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() }),
        is_preferred: Some(fix.is_preferred),
        ..CodeAction::default()
    }
}

/// `{"errors", "warnings", "hints", "rungs", "steps", "capacity", "message"}`
fn check_summary(around: &Around, language: Language) -> Value {
    let found = around.findings();
    let count = |severity| found.iter().filter(|diagnostic| diagnostic.severity == severity).count();
    let [errors, warnings, hints] =
        [crate::text::Severity::Error, crate::text::Severity::Warning, crate::text::Severity::Hint]
            .map(count);
    let status = ide::status(&around.here().document);
    let key = match (errors + warnings, status.steps) {
        (0, Some(_)) => "summary.passed-steps",
        (0, None) => "summary.passed",
        _ => "summary.failed",
    };
    let message = Message::new(key)
        .with("errors", errors)
        .with("warnings", warnings)
        .with("hints", hints)
        .with("rungs", status.rungs)
        .with("steps", status.steps.unwrap_or(0))
        .with("capacity", status.capacity);
    json!({
        "errors": errors,
        "warnings": warnings,
        "hints": hints,
        "rungs": status.rungs,
        "steps": status.steps,
        "capacity": status.capacity,
        "message": message.render(language),
    })
}

/// The pulled report; its `resultId` stands for the content, so that nothing is sent twice.
fn report(
    items: Vec<tower_lsp::ls_types::Diagnostic>,
    previous: Option<String>,
) -> DocumentDiagnosticReportResult {
    let hash = rustc_hash::FxBuildHasher.hash_one(serde_json::to_string(&items).unwrap_or_default());
    let result_id = format!("{hash:016x}");
    let report = if previous.as_deref() == Some(result_id.as_str()) {
        DocumentDiagnosticReport::Unchanged(RelatedUnchangedDocumentDiagnosticReport {
            related_documents: None,
            unchanged_document_diagnostic_report: UnchangedDocumentDiagnosticReport { result_id },
        })
    } else {
        DocumentDiagnosticReport::Full(RelatedFullDocumentDiagnosticReport {
            related_documents: None,
            full_document_diagnostic_report: FullDocumentDiagnosticReport {
                result_id: Some(result_id),
                items,
            },
        })
    };
    DocumentDiagnosticReportResult::Report(report)
}

/// A refusal that the editor shows to the user.
fn refused(message: Message) -> Error {
    let language = SNAPSHOT.with(|snapshot| snapshot.manner.language);
    Error::invalid_params(message.render(language))
}
