//! The handlers: a few lines each, from the snapshot of the request to the answer of `ide`.

use super::across;
use super::answering::{aside, beside, refused, settings, snapshot, whole, with_around, with_open};
use super::editing;
use super::manifest_help;
use super::progress::Progress;
use super::pulled::{self, PartialReport, PartialReportParams};
use super::to_proto;
use super::tokens;
use super::typed;
use super::workspace::{SNAPSHOT, Snapshot, Workspace, is_suite};
use super::written::{given, write};
use super::{capabilities, features, plc, proving, simulation, testing, translating, usage};
use crate::ide;
use crate::text::Message;
use serde_json::{Value, json};
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
    simulations: simulation::Simulations,
    plcs: plc::Plcs,
}

impl Backend {
    pub(super) fn new(workspace: Arc<Workspace>) -> Backend {
        Backend {
            workspace,
            resolves_actions: AtomicBool::new(false),
            simulations: simulation::Simulations::default(),
            plcs: plc::Plcs::default(),
        }
    }
}

impl LanguageServer for Backend {
    async fn initialize(&self, params: InitializeParams) -> Result<InitializeResult> {
        self.resolves_actions.store(editing::resolves_actions(&params.capabilities), Ordering::Relaxed);
        // The workspace took what these say when the message was read.
        let Snapshot { manner, settings, .. } = self.workspace.snapshot();
        Ok(capabilities::offered(
            &params.capabilities,
            manner.encoding,
            settings.pulls,
            self.workspace.requests(),
        ))
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
        if let Some(manifest) = manifest_help::asked(&at) {
            return Ok(manifest_help::hover(&manifest, at.position));
        }
        let hover = with_around(&at.text_document.uri, |around, place| {
            let link =
                |file, line| features::link(around, file, line).filter(|_| place.abilities.markdown_hover);
            let hover = ide::hover_in(&around.view(), place.offset(at.position), place.language, &link)?;
            Some(to_proto::hover(place, hover))
        });
        let Some(mut hover) = hover else { return Ok(None) };
        // While the program runs beside its text, what it does comes first.
        if let Some(why) = self.simulations.brief(&at.text_document.uri, at.position, &self.workspace).await
            && let HoverContents::Markup(content) = &mut hover.contents
        {
            content.value = format!("{why}\n\n---\n\n{}", content.value);
        }
        Ok(Some(hover))
    }

    async fn completion(&self, params: CompletionParams) -> Result<Option<CompletionResponse>> {
        let at = params.text_document_position;
        if let Some(manifest) = manifest_help::asked(&at) {
            return manifest_help::completion(manifest, at.position).await;
        } else if manifest_help::is_for_manifests(params.context.as_ref()) {
            return Ok(None);
        }
        Ok(with_around(&at.text_document.uri, |around, place| {
            let offset = place.offset(at.position);
            let proposals = ide::completions_in(&around.view(), offset, place.language);
            let items = proposals.into_iter().map(|proposal| to_proto::completion(place, proposal));
            Some(CompletionResponse::Array(items.collect()))
        }))
    }

    async fn goto_definition(&self, params: GotoDefinitionParams) -> Result<Option<GotoDefinitionResponse>> {
        let at = params.text_document_position_params;
        // Only the chunk at the position is read; elsewhere names are looked up.
        aside(at.text_document.uri, move |around, place| across::definition(around, place, at.position)).await
    }

    async fn references(&self, params: ReferenceParams) -> Result<Option<Vec<Location>>> {
        let at = params.text_document_position;
        let with_declaration = params.context.include_declaration;
        whole(at.text_document.uri, move |around, place| {
            write(&across::references(around, place, at.position, with_declaration))
        })
        .await
        .map(given)
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
        let uri = at.text_document.uri;
        let snapshot = snapshot();
        if let Some(reason) = snapshot.open(&uri).and_then(|open| snapshot.is_incomplete(open)) {
            return Err(refused(reason));
        }
        let renamed = whole(uri.clone(), move |around, place| {
            across::rename(&snapshot, around, place, at.position, &params.new_name)
        });
        self.unless_changed(&uri, renamed.await)?.transpose().map_err(refused)
    }

    async fn document_symbol(&self, params: DocumentSymbolParams) -> Result<Option<DocumentSymbolResponse>> {
        whole(params.text_document.uri, |around, place| {
            let symbols = ide::symbols_unless(place.document, place.language, || around.is_cancelled());
            if around.is_cancelled() {
                return None;
            }
            write(&to_proto::outline(place, symbols, &around.here().uri))
        })
        .await
        .map(given)
    }

    async fn symbol(&self, params: WorkspaceSymbolParams) -> Result<Option<WorkspaceSymbolResponse>> {
        let snapshot = snapshot();
        let found = beside(move |cancelled| {
            let everything = snapshot.everything()?.cancellable(cancelled);
            Some(WorkspaceSymbolResponse::Nested(across::symbols(
                &everything,
                &params.query,
                snapshot.manner,
            )))
        });
        found.await
    }

    async fn prepare_call_hierarchy(
        &self,
        params: CallHierarchyPrepareParams,
    ) -> Result<Option<Vec<CallHierarchyItem>>> {
        let at = params.text_document_position_params;
        whole(at.text_document.uri, move |around, place| across::prepare_calls(around, place, at.position))
            .await
    }

    async fn incoming_calls(
        &self,
        params: CallHierarchyIncomingCallsParams,
    ) -> Result<Option<Vec<CallHierarchyIncomingCall>>> {
        whole(params.item.uri.clone(), move |around, place| {
            across::incoming_calls(around, place, &params.item)
        })
        .await
    }

    async fn outgoing_calls(
        &self,
        params: CallHierarchyOutgoingCallsParams,
    ) -> Result<Option<Vec<CallHierarchyOutgoingCall>>> {
        whole(params.item.uri.clone(), move |around, place| {
            across::outgoing_calls(around, place, &params.item)
        })
        .await
    }

    async fn document_link(&self, params: DocumentLinkParams) -> Result<Option<Vec<DocumentLink>>> {
        let snapshot = snapshot();
        beside(move |_| across::links(&snapshot, &params.text_document.uri)).await
    }

    async fn folding_range(&self, params: FoldingRangeParams) -> Result<Option<Vec<FoldingRange>>> {
        whole(params.text_document.uri, |_, place| {
            let folds = ide::folds(place.document).into_iter().map(|fold| to_proto::fold(place, fold));
            write(&folds.collect::<Vec<_>>())
        })
        .await
        .map(given)
    }

    async fn semantic_tokens_full(
        &self,
        params: SemanticTokensParams,
    ) -> Result<Option<SemanticTokensResult>> {
        let workspace = self.workspace.clone();
        aside(params.text_document.uri, move |around, place| {
            write(&workspace.tokens.full(&around.here().uri, place))
        })
        .await
        .map(given)
    }

    async fn semantic_tokens_full_delta(
        &self,
        params: SemanticTokensDeltaParams,
    ) -> Result<Option<SemanticTokensFullDeltaResult>> {
        let workspace = self.workspace.clone();
        aside(params.text_document.uri, move |around, place| {
            write(&workspace.tokens.delta(&around.here().uri, &params.previous_result_id, place))
        })
        .await
        .map(given)
    }

    async fn semantic_tokens_range(
        &self,
        params: SemanticTokensRangeParams,
    ) -> Result<Option<SemanticTokensRangeResult>> {
        aside(params.text_document.uri, move |_, place| {
            write(&tokens::within(place, place.span(params.range).range()))
        })
        .await
        .map(given)
    }

    async fn inlay_hint(&self, params: InlayHintParams) -> Result<Option<Vec<InlayHint>>> {
        let settings = settings();
        if !settings.inlay_hints {
            return Ok(None);
        }
        whole(params.text_document.uri, move |_, place| {
            let hints = if settings.comment_hints { ide::inlay_hints } else { ide::value_hints };
            let hints = hints(place.document, place.span(params.range), place.language);
            let hints = hints.into_iter().map(|hint| to_proto::inlay_hint(place, hint));
            write(&hints.collect::<Vec<_>>())
        })
        .await
        .map(given)
    }

    async fn formatting(&self, params: DocumentFormattingParams) -> Result<Option<Vec<TextEdit>>> {
        let settings = settings();
        let uri = params.text_document.uri;
        let edits = whole(uri.clone(), move |around, place| {
            place.edits(&ide::format(place.document, settings.style(&around.here().manifest)))
        });
        self.unless_changed(&uri, edits.await)
    }

    async fn range_formatting(&self, params: DocumentRangeFormattingParams) -> Result<Option<Vec<TextEdit>>> {
        let settings = settings();
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
        whole(at.text_document.uri, move |_, place| {
            write(&features::highlights(place, place.offset(at.position)))
        })
        .await
        .map(given)
    }

    async fn code_lens(&self, params: CodeLensParams) -> Result<Option<Vec<CodeLens>>> {
        let settings = settings();
        if is_suite(&params.text_document.uri) {
            return Ok(testing::lenses(&params.text_document.uri, &settings));
        }
        let snapshot = snapshot();
        whole(params.text_document.uri, move |around, place| {
            let has_tests = settings.run_lenses && testing::has_tests(&snapshot, around);
            write(&features::lenses(around.here(), place, &settings, has_tests))
        })
        .await
        .map(given)
    }

    async fn code_lens_resolve(&self, lens: CodeLens) -> Result<CodeLens> {
        let snapshot = snapshot();
        Ok(features::resolved(&snapshot, lens))
    }

    async fn code_action(&self, params: CodeActionParams) -> Result<Option<CodeActionResponse>> {
        let settings = settings();
        let resolves = self.resolves_actions.load(Ordering::Relaxed);
        whole(params.text_document.uri.clone(), move |around, place| {
            let open = around.here();
            let only = params.context.only.as_deref();
            // To find what could be mended, all rules run.
            let found = match editing::is_wanted(&CodeActionKind::QUICKFIX, only) {
                true => around.findings(),
                false => Arc::default(),
            };
            let fixes = ide::fixes(&found, place.span(params.range)).into_iter();
            let fixes = fixes.map(|fix| features::quick_fix(around, place, &fix));
            let edits = editing::actions(open, place, &params, settings.style(&open.manifest), resolves);
            let rewrites = features::rewrites(around.here(), place, &params);
            let allowing = ide::allowing(place.document, &found, place.span(params.range));
            let allow = allowing.iter().map(|(diagnostic, fix)| {
                features::quick_fix(around, place, &ide::FixOf { diagnostic, fix, is_preferred: false })
            });
            let style = settings.style(&open.manifest);
            let refactorings = features::refactorings(around, place, &params, style);
            let translations = translating::actions(around, place, &params, &settings);
            fixes
                .chain(edits)
                .chain(rewrites)
                .chain(refactorings)
                .chain(translations)
                .chain(allow)
                .map(|action| across::code_action(action, place.abilities))
                .collect()
        })
        .await
    }

    async fn on_type_formatting(
        &self,
        params: DocumentOnTypeFormattingParams,
    ) -> Result<Option<Vec<TextEdit>>> {
        let settings = settings();
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
        let settings = settings();
        let edit = with_open(&asked.text_document.uri, |open, place| {
            let result = editing::edit(open, place, &asked, settings.style(&open.manifest));
            Some(result.map(|result| editing::changes(open, result.edits)))
        });
        Ok(CodeAction { edit: edit.transpose()?, ..action })
    }

    async fn diagnostic(&self, params: DocumentDiagnosticParams) -> Result<DocumentDiagnosticReportResult> {
        let manner = snapshot().manner;
        let uri = params.text_document.uri;
        let items =
            whole(uri, move |around, _| to_proto::diagnostics(around, around.findings().to_vec(), manner));
        let items = items.await?.unwrap_or_default();
        Ok(pulled::of_document(items, params.previous_result_id.as_deref()))
    }

    async fn workspace_diagnostic(
        &self,
        params: WorkspaceDiagnosticParams,
    ) -> Result<WorkspaceDiagnosticReportResult> {
        let snapshot = snapshot();
        let client = self.workspace.client.clone();
        let title = Message::new("project.checking").render(snapshot.manner.language);
        let progress = Progress::of_request(&client, params.work_done_progress_params.work_done_token, title);
        let (parts, mut received) = tokio::sync::mpsc::unbounded_channel();
        let token = params.partial_result_params.partial_result_token;
        let parts = token.is_some().then_some(parts);
        let work = beside(move |cancelled| {
            let is_cancelled = || cancelled.load(Ordering::Relaxed);
            let previous = params.previous_result_ids;
            Some(pulled::of_workspace(&snapshot, previous, parts.as_ref(), &progress, is_cancelled))
        });
        let send_parts = async {
            while let (Some(value), Some(token)) = (received.recv().await, token.clone()) {
                let params = PartialReportParams { token, value };
                client.send_notification::<PartialReport>(params).await;
            }
        };
        let (report, ()) = tokio::join!(work, send_parts);
        let empty = WorkspaceDiagnosticReport { items: Vec::new() };
        Ok(WorkspaceDiagnosticReportResult::Report(report?.unwrap_or(empty)))
    }

    async fn execute_command(&self, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
        if params.command == capabilities::APPLY {
            return self.apply(params.arguments);
        }
        if [translating::TRANSLATE, translating::BESIDE].contains(&params.command.as_str()) {
            return self.translate(&params.command, params.arguments.first()).await;
        }
        if params.command == proving::PROVE {
            return proving::answer(params.arguments.first()).await;
        }
        if params.command.starts_with(testing::PREFIX) {
            return testing::answer(&params.command, params.arguments.first(), &self.workspace).await;
        }
        if params.command.starts_with(simulation::PREFIX) {
            let argument = params.arguments.first();
            return self.simulations.answer(&params.command, argument, &self.workspace).await;
        }
        if params.command.starts_with(plc::PREFIX) {
            let token = params.work_done_progress_params.work_done_token;
            return self.plcs.answer(&params.command, params.arguments.first(), token, &self.workspace).await;
        }
        let Some(uri) =
            params.arguments.first().and_then(|value| value.as_str()).and_then(|text| text.parse().ok())
        else {
            return Err(refused(Message::new("request.no-document").with("command", params.command)));
        };
        match params.command.as_str() {
            "rungwise.check" => {
                whole(uri, |around, place| features::check_summary(around, place.language)).await
            }
            "rungwise.format" => self.format(uri).await,
            "rungwise.usage" => {
                let Some(asked) = usage::Asked::of(params.arguments.get(1)) else {
                    return Err(refused(Message::new("request.no-usage").with("command", params.command)));
                };
                whole(uri, |around, place| usage::answer(around, place, asked)).await
            }
            other => Err(refused(Message::new("request.no-command").with("command", other))),
        }
    }
}

impl Backend {
    /// `textDocument/rangesFormatting` of LSP 3.18: like the formatting of one range.
    pub(super) async fn ranges_formatting(
        &self,
        params: features::RangesParams,
    ) -> Result<Option<Vec<TextEdit>>> {
        let settings = settings();
        whole(params.text_document.uri, move |around, place| {
            let style = settings.style(&around.here().manifest);
            let spans: Vec<_> = params.ranges.iter().map(|range| place.span(*range)).collect();
            place.edits(&ide::format_ranges(place.document, style, &spans))
        })
        .await
    }

    /// The content of a virtual document, `workspace/textDocumentContent` of LSP 3.18.
    pub(super) async fn content(&self, params: usage::ContentParams) -> Result<Option<usage::Content>> {
        let Some(uri) = usage::told_document(&params.uri) else { return Ok(None) };
        let text = whole(uri, |around, place| usage::page(around, place.language)).await?;
        Ok(text.map(|text| usage::Content { text }))
    }

    /// Edits that were made for a text that has changed meanwhile help nobody.
    fn unless_changed<T>(&self, uri: &Uri, answer: Result<Option<T>>) -> Result<Option<T>> {
        let version = |snapshot: &Snapshot| snapshot.open(uri).map(|open| open.version);
        let now = version(&self.workspace.snapshot());
        if now != SNAPSHOT.with(version) { Err(Error::content_modified()) } else { answer }
    }

    /// Has the client apply the edit that a code action stands for in a client that only knows commands.
    fn apply(&self, arguments: Vec<Value>) -> Result<Option<LSPAny>> {
        let edit = arguments.into_iter().next().and_then(|value| serde_json::from_value(value).ok());
        let Some(edit) = edit else {
            return Err(refused(Message::new("request.no-edit").with("command", capabilities::APPLY)));
        };
        self.have_applied(edit);
        Ok(None)
    }

    /// Asks the client to apply an edit. It may answer late or never; no handler waits for it.
    fn have_applied(&self, edit: WorkspaceEdit) {
        let client = self.workspace.client.clone();
        tokio::spawn(async move {
            if let Err(reason) = client.apply_edit(edit).await {
                tracing::warn!("the client did not apply the edits: {reason}");
            }
        });
    }

    /// `rungwise.translate` and `rungwise.translateBeside`
    async fn translate(&self, command: &str, argument: Option<&Value>) -> Result<Option<LSPAny>> {
        let settings = settings();
        let wanted = translating::Wanted::of(command, argument).map_err(refused)?;
        let unknown = || refused(Message::new("translating.not-open").with("command", command));
        let uri = wanted.asked.uri.clone();
        if command == translating::TRANSLATE {
            let answer = whole(uri, move |around, place| wanted.answer(around, place, &settings)).await?;
            return answer.ok_or_else(unknown);
        }
        let made = whole(uri, move |around, place| wanted.beside(around, place, &settings)).await?;
        let Some((edit, uri)) = made.ok_or_else(unknown)?.transpose().map_err(refused)? else {
            return Ok(None);
        };
        let client = self.workspace.client.clone();
        let shown =
            ShowDocumentParams { uri: uri.clone(), external: None, take_focus: Some(true), selection: None };
        let shows = self.workspace.requests().show_document;
        // The client may answer late or never; no handler waits for it.
        tokio::spawn(async move {
            match client.apply_edit(edit).await {
                Ok(answer) if answer.applied && shows => drop(client.show_document(shown).await),
                Ok(_) => {}
                Err(reason) => tracing::warn!("the client did not make the file: {reason}"),
            }
        });
        Ok(Some(json!({"uri": uri})))
    }

    /// `rungwise/edit`
    pub(super) async fn edit(&self, params: editing::EditParams) -> Result<Option<editing::EditResult>> {
        let settings = settings();
        let edited = with_open(&params.text_document.uri, |open, place| {
            Some(editing::edit(open, place, &params, settings.style(&open.manifest)))
        });
        edited.transpose()
    }

    /// `rungwise/typed`
    pub(super) async fn typed(&self, params: typed::TypedParams) -> Result<Option<Vec<TextEdit>>> {
        let settings = settings();
        let edits = with_open(&params.text_document.uri, |open, place| {
            Some(typed::edits(open, place, &params, settings.style(&open.manifest)))
        });
        edits.transpose()
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
        let settings = settings();
        let edit = whole(uri, move |around, place| {
            let open = around.here();
            let edits = ide::format(place.document, settings.style(&open.manifest));
            (edits.len(), across::workspace_edit([(open.clone(), edits)], place.manner()))
        });
        let Some((count, edit)) = edit.await? else { return Ok(None) };
        self.have_applied(edit);
        Ok(Some(json!({"edits": count})))
    }
}
