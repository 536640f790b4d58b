//! The handlers: a few lines each, from the snapshot of the request to the answer of `ide`.

use super::{capabilities, features};
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
        Ok(capabilities::offered(&params.capabilities, manner.encoding, settings.pulls(), self.workspace.requests()))
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
        Ok(with_around(&at.text_document.uri, |around, place| {
            let link = |file, line| features::link(around, file, line).filter(|_| place.abilities.markdown_hover);
            let hover = ide::hover_in(&around.view(), place.offset(at.position), place.language, &link)?;
            Some(to_proto::hover(place, hover))
        }))
    }

    async fn completion(&self, params: CompletionParams) -> Result<Option<CompletionResponse>> {
        let at = params.text_document_position;
        Ok(with_around(&at.text_document.uri, |around, place| {
            let offset = place.offset(at.position);
            let proposals = ide::completions_in(&around.view(), offset, place.language);
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
        let snapshot: Snapshot = SNAPSHOT.with(Clone::clone);
        let renamed = with_around(&at.text_document.uri, |around, place| {
            let offset = place.offset(at.position);
            if let Some(renamed) = features::rename_symbol(&snapshot, around, offset, &params.new_name) {
                return Some(renamed);
            }
            let edits = ide::rename(place.document, offset, &params.new_name);
            let edits = edits.and_then(|edits| {
                let table = ide::rename_in_comments(place.document, offset, &params.new_name)?;
                let table = table.and_then(|edit| features::table_edit(&snapshot, around, &edit));
                let own = features::document_edit(around.here(), place.edits(&edits));
                Ok(features::workspace_edit(&snapshot, std::iter::once(own).chain(table).collect()))
            });
            Some(edits)
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
        let with_comments = SNAPSHOT.with(|snapshot| snapshot.settings.comment_hints);
        whole(params.text_document.uri, move |_, place| {
            let hints = if with_comments { ide::inlay_hints } else { ide::value_hints };
            let hints = hints(place.document, place.span(params.range), place.language);
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

    async fn range_formatting(&self, params: DocumentRangeFormattingParams) -> Result<Option<Vec<TextEdit>>> {
        let settings = SNAPSHOT.with(|snapshot| snapshot.settings.clone());
        whole(params.text_document.uri, move |around, place| {
            let style = settings.style(&around.here().manifest);
            place.edits(&ide::format_ranges(place.document, style, &[place.span(params.range)]))
        })
        .await
    }

    async fn signature_help(&self, params: SignatureHelpParams) -> Result<Option<SignatureHelp>> {
        let at = params.text_document_position_params;
        Ok(with_open(&at.text_document.uri, |_, place| {
            features::signature_help(place, place.offset(at.position))
        }))
    }

    async fn document_highlight(
        &self,
        params: DocumentHighlightParams,
    ) -> Result<Option<Vec<DocumentHighlight>>> {
        let at = params.text_document_position_params;
        whole(at.text_document.uri, move |_, place| features::highlights(place, place.offset(at.position))).await
    }

    async fn code_lens(&self, params: CodeLensParams) -> Result<Option<Vec<CodeLens>>> {
        let wanted = SNAPSHOT.with(|snapshot| snapshot.settings.lenses);
        whole(params.text_document.uri, move |around, place| features::lenses(around.here(), place, wanted)).await
    }

    async fn code_lens_resolve(&self, lens: CodeLens) -> Result<CodeLens> {
        let snapshot: Snapshot = SNAPSHOT.with(Clone::clone);
        Ok(features::resolved(&snapshot, lens))
    }

    async fn code_action(&self, params: CodeActionParams) -> Result<Option<CodeActionResponse>> {
        whole(params.text_document.uri, move |around, place| {
            let found = around.findings();
            let fixes = ide::fixes(&found, place.span(params.range)).into_iter();
            let fixes = fixes.map(|fix| quick_fix(around, place, &fix));
            let rewrites = features::rewrites(around.here(), place, params.range);
            fixes.chain(rewrites).map(CodeActionOrCommand::from).collect()
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
            "rungwise.usage" => {
                whole(uri, |around, place| features::usage_json(around, place.language)).await
            }
            other => Err(Error::invalid_params(format!("no such command: {other}"))),
        }
    }
}

impl Backend {
    /// `textDocument/rangesFormatting` of LSP 3.18: like the formatting of one range.
    pub(super) async fn ranges_formatting(
        &self,
        params: features::RangesParams,
    ) -> Result<Option<Vec<TextEdit>>> {
        let settings = SNAPSHOT.with(|snapshot| snapshot.settings.clone());
        whole(params.text_document.uri, move |around, place| {
            let style = settings.style(&around.here().manifest);
            let spans: Vec<_> = params.ranges.iter().map(|range| place.span(*range)).collect();
            place.edits(&ide::format_ranges(place.document, style, &spans))
        })
        .await
    }

    /// The content of a virtual document, `workspace/textDocumentContent` of LSP 3.18.
    pub(super) async fn content(&self, params: features::ContentParams) -> Result<Option<features::Content>> {
        let Some(uri) = features::told_document(&params.uri) else { return Ok(None) };
        let text = whole(uri, |around, place| features::usage_text(around, place.language)).await?;
        Ok(text.map(|text| features::Content { text }))
    }

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

/// The same with the files of its project.
fn with_around<T>(uri: &Uri, answer: impl FnOnce(&Around, Place<'_>) -> Option<T>) -> Option<T> {
    let snapshot: Snapshot = SNAPSHOT.with(Clone::clone);
    let around = snapshot.around(snapshot.open(uri)?);
    answer(&around, Place::new(&around.here().document, snapshot.manner))
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
