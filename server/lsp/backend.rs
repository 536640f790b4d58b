//! The handlers: a few lines each, from the snapshot of the request to the answer of `ide`.

use super::capabilities;
use super::editing;
use super::to_proto::{self, Place};
use super::tokens;
use super::workspace::{Open, SNAPSHOT, Snapshot, Workspace};
use crate::check;
use crate::ide;
use crate::text::{Diagnostic, Language, Message};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::hash::BuildHasher;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use tower_lsp::LanguageServer;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::*;

/// The server's side of the protocol. Its state is in the workspace; handlers see snapshots only.
pub(super) struct Backend {
    workspace: Arc<Workspace>,
    /// Whether the client asks for the edits of code actions later.
    resolves_actions: AtomicBool,
}

impl Backend {
    pub(super) fn new(workspace: Arc<Workspace>) -> Backend {
        Backend { workspace, resolves_actions: AtomicBool::new(false) }
    }
}

impl LanguageServer for Backend {
    async fn initialize(&self, params: InitializeParams) -> Result<InitializeResult> {
        self.resolves_actions.store(editing::resolves_actions(&params.capabilities), Ordering::Relaxed);
        // The workspace took what these say when the message was read.
        let Snapshot { manner, settings, .. } = self.workspace.snapshot();
        Ok(capabilities::offered(&params.capabilities, manner.encoding, settings.pulls()))
    }

    async fn initialized(&self, _: InitializedParams) {
        if !self.workspace.watches() {
            return;
        }
        let client = self.workspace.client.clone();
        // The client may answer late or never; no handler waits for it.
        tokio::spawn(async move {
            if let Err(reason) = client.register_capability(vec![capabilities::watched_manifests()]).await {
                tracing::warn!("the client does not watch manifests: {reason}");
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
        let workspace = self.workspace.clone();
        aside(params.text_document.uri, move |open, place| workspace.tokens.full(&open.uri, place).into())
            .await
    }

    async fn semantic_tokens_full_delta(
        &self,
        params: SemanticTokensDeltaParams,
    ) -> Result<Option<SemanticTokensFullDeltaResult>> {
        let workspace = self.workspace.clone();
        aside(params.text_document.uri, move |open, place| {
            workspace.tokens.delta(&open.uri, &params.previous_result_id, place)
        })
        .await
    }

    async fn semantic_tokens_range(
        &self,
        params: SemanticTokensRangeParams,
    ) -> Result<Option<SemanticTokensRangeResult>> {
        aside(params.text_document.uri, move |_, place| {
            tokens::within(place, place.span(params.range).range()).into()
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
        whole(params.text_document.uri, move |open, place| {
            place.edits(&ide::format(place.document, settings.style(&open.manifest)))
        })
        .await
    }

    async fn code_action(&self, params: CodeActionParams) -> Result<Option<CodeActionResponse>> {
        let settings = SNAPSHOT.with(|snapshot| snapshot.settings.clone());
        let resolves = self.resolves_actions.load(Ordering::Relaxed);
        whole(params.text_document.uri.clone(), move |open, place| {
            let found = check::all(&open.document, &open.severities);
            let fixes = ide::fixes(&found, place.span(params.range)).into_iter();
            let fixes = fixes.map(|fix| quick_fix(open, place, &fix).into());
            let edits = editing::actions(open, place, &params, settings.style(&open.manifest), resolves);
            fixes.chain(edits.into_iter().map(CodeActionOrCommand::from)).collect()
        })
        .await
    }

    async fn on_type_formatting(
        &self,
        params: DocumentOnTypeFormattingParams,
    ) -> Result<Option<Vec<TextEdit>>> {
        let settings = SNAPSHOT.with(|snapshot| snapshot.settings.clone());
        let at = params.text_document_position;
        Ok(with_open(&at.text_document.uri, |open, place| {
            let style = settings.style(&open.manifest);
            let edits = ide::typed(place.document, place.offset(at.position), &params.ch, style);
            Some(place.edits(&edits))
        }))
    }

    async fn selection_range(&self, params: SelectionRangeParams) -> Result<Option<Vec<SelectionRange>>> {
        Ok(with_open(&params.text_document.uri, |_, place| {
            let positions = params.positions.iter();
            Some(positions.map(|position| editing::selection_range(place, *position)).collect())
        }))
    }

    async fn linked_editing_range(
        &self,
        params: LinkedEditingRangeParams,
    ) -> Result<Option<LinkedEditingRanges>> {
        let at = params.text_document_position_params;
        Ok(with_open(&at.text_document.uri, |_, place| {
            let places = ide::linked_places(place.document, place.offset(at.position));
            let ranges = places.into_iter().map(|span| place.range(span)).collect::<Vec<_>>();
            (!ranges.is_empty()).then_some(LinkedEditingRanges { ranges, word_pattern: None })
        }))
    }

    async fn code_action_resolve(&self, action: CodeAction) -> Result<CodeAction> {
        let Some(asked) = editing::asked_by(&action) else { return Ok(action) };
        let settings = SNAPSHOT.with(|snapshot| snapshot.settings.clone());
        let edit = with_open(&asked.text_document.uri, |open, place| {
            let result = editing::edit(open, place, &asked, settings.style(&open.manifest));
            Some(result.map(|result| editing::changes(open, result.edits)))
        });
        Ok(CodeAction { edit: edit.transpose()?, ..action })
    }

    async fn diagnostic(&self, params: DocumentDiagnosticParams) -> Result<DocumentDiagnosticReportResult> {
        let manner = SNAPSHOT.with(|snapshot| snapshot.manner);
        let uri = params.text_document.uri;
        let items = whole(uri, move |open, _| {
            to_proto::diagnostics(open, check::all(&open.document, &open.severities), manner)
        });
        Ok(report(items.await?.unwrap_or_default(), params.previous_result_id))
    }

    async fn execute_command(&self, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
        let Some(uri) =
            params.arguments.first().and_then(|value| value.as_str()).and_then(|text| text.parse().ok())
        else {
            return Err(refused(Message::new("request.no-document").with("command", params.command)));
        };
        match params.command.as_str() {
            "rungwise.check" => whole(uri, |open, place| check_summary(open, place.language)).await,
            "rungwise.format" => self.format(uri).await,
            other => Err(refused(Message::new("request.no-command").with("command", other))),
        }
    }
}

impl Backend {
    /// `rungwise/edit`
    pub(super) async fn edit(&self, params: editing::EditParams) -> Result<Option<editing::EditResult>> {
        let settings = SNAPSHOT.with(|snapshot| snapshot.settings.clone());
        let edited = with_open(&params.text_document.uri, |open, place| {
            Some(editing::edit(open, place, &params, settings.style(&open.manifest)))
        });
        edited.transpose()
    }

    /// `rungwise/object`
    pub(super) async fn object(
        &self,
        params: editing::ObjectParams,
    ) -> Result<Option<editing::ObjectResult>> {
        Ok(with_open(&params.text_document.uri, |_, place| editing::object(place, &params)))
    }

    /// Computes the edits and asks the client to apply them; the answer says how many there are.
    async fn format(&self, uri: Uri) -> Result<Option<LSPAny>> {
        let settings = SNAPSHOT.with(|snapshot| snapshot.settings.clone());
        let edit = whole(uri, move |open, place| {
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

/// The same for answers that walk the whole document: they run on a thread of their own, and the trees that they read
/// go away with them.
async fn whole<T: Send + 'static>(
    uri: Uri,
    answer: impl FnOnce(&Open, Place<'_>) -> T + Send + 'static,
) -> Result<Option<T>> {
    aside(uri, move |open, place| answer(open, Place { document: &place.document.lean(), ..place })).await
}

/// The same on a thread of its own, for answers that look at much of a document but read no trees.
async fn aside<T: Send + 'static>(
    uri: Uri,
    answer: impl FnOnce(&Open, Place<'_>) -> T + Send + 'static,
) -> Result<Option<T>> {
    let snapshot: Snapshot = SNAPSHOT.with(Clone::clone);
    let work = tokio::task::spawn_blocking(move || {
        let open = snapshot.open(&uri)?;
        Some(answer(open, Place::new(&open.document, snapshot.manner)))
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

fn quick_fix(open: &Open, place: Place<'_>, fix: &ide::FixOf<'_>) -> CodeAction {
    // Plain changes reach every client, also one that knows no versioned edits.
    let changes = HashMap::from([(open.uri.clone(), place.edits(&fix.fix.edits))]);
    CodeAction {
        title: fix.fix.title.render(place.language),
        kind: Some(CodeActionKind::QUICKFIX),
        diagnostics: Some(vec![to_proto::diagnostic(open, fix.diagnostic, place.manner())]),
        edit: Some(WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() }),
        is_preferred: Some(fix.is_preferred),
        ..CodeAction::default()
    }
}

/// `{"errors", "warnings", "hints", "rungs", "steps", "capacity", "message"}`
fn check_summary(open: &Open, language: Language) -> Value {
    let found: Vec<Diagnostic> = check::all(&open.document, &open.severities);
    let mut summary = ide::Summary::default();
    summary.add(&open.document, &found);
    json!({
        "errors": summary.errors,
        "warnings": summary.warnings,
        "hints": summary.hints,
        "rungs": summary.rungs,
        "steps": summary.steps,
        "capacity": summary.capacity,
        "message": summary.sentence().render(language),
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
