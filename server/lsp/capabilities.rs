//! What the server offers, and what the client can do.

use super::abilities::{Abilities, Requests};
use super::{editing, manifest_help, proving, testing, to_proto, translating, usage};
use crate::text::Encoding;
use serde_json::json;
use tower_lsp::ls_types::*;

/// The commands of `workspace/executeCommand`.
pub(super) const COMMANDS: &[&str] = &[
    "rungwise.check",
    "rungwise.format",
    "rungwise.usage",
    translating::TRANSLATE,
    translating::BESIDE,
    proving::PROVE,
    APPLY,
    "rungwise.simulate.start",
    "rungwise.simulate.stop",
    "rungwise.simulate.pause",
    "rungwise.simulate.run",
    "rungwise.simulate.step",
    "rungwise.simulate.stepBack",
    "rungwise.simulate.reset",
    "rungwise.simulate.set",
    "rungwise.simulate.force",
    "rungwise.simulate.release",
    "rungwise.simulate.watch",
    "rungwise.simulate.state",
    "rungwise.simulate.panel",
    "rungwise.simulate.trace",
    "rungwise.simulate.export",
    "rungwise.simulate.record",
    testing::LIST,
    testing::RUN,
    "rungwise.simulate.why",
    "rungwise.plc.ports",
    "rungwise.plc.connect",
    "rungwise.plc.disconnect",
    "rungwise.plc.state",
    "rungwise.plc.plan",
    "rungwise.plc.verify",
    "rungwise.plc.download",
    "rungwise.plc.upload",
    "rungwise.plc.start",
    "rungwise.plc.stop",
    "rungwise.plc.monitor",
    "rungwise.plc.unmonitor",
    "rungwise.plc.write",
    "rungwise.plc.force",
    "rungwise.plc.hold",
    "rungwise.plc.release",
    "rungwise.plc.panel",
    "rungwise.plc.trace",
    "rungwise.plc.export",
];

/// Applies the `WorkspaceEdit` that is its argument: what a code action does where clients know commands alone.
pub(super) const APPLY: &str = "rungwise.applyEdit";

/// The best encoding that the client offers: bytes cost nothing, UTF-16 is what every client knows.
pub(super) fn encoding_for(client: &ClientCapabilities) -> Encoding {
    let offered =
        client.general.as_ref().and_then(|general| general.position_encodings.as_deref()).unwrap_or(&[]);
    if offered.contains(&PositionEncodingKind::UTF8) {
        Encoding::Utf8
    } else if offered.contains(&PositionEncodingKind::UTF32)
        && !offered.contains(&PositionEncodingKind::UTF16)
    {
        Encoding::Utf32
    } else {
        Encoding::Utf16
    }
}

/// What the client is asked to tell about while the server runs: files of projects, and its configuration.
pub(super) fn registrations(requests: Requests) -> Vec<Registration> {
    let registration = |id: &str, method: &str, register_options| Registration {
        id: id.to_string(),
        method: method.to_string(),
        register_options,
    };
    let watchers = json!({"watchers": [
        {"globPattern": "**/rungwise.toml"},
        {"globPattern": "**/*.test.toml"},
        {"globPattern": "**/*.{lad,LAD,il,IL,csv,CSV}"},
    ]});
    let files = requests
        .watch
        .then(|| registration("rungwise-files", "workspace/didChangeWatchedFiles", Some(watchers)));
    let configuration = requests.watch_configuration.then(|| {
        let section = json!({"section": "rungwise"});
        registration("rungwise-configuration", "workspace/didChangeConfiguration", Some(section))
    });
    let content = requests.newer.content.then(|| {
        let options = json!({"schemes": [usage::SCHEME]});
        registration("rungwise-content", "workspace/textDocumentContent", Some(options))
    });
    let ranges = requests.newer.ranges.then(|| {
        let languages = ["ladder", "plc-il"].map(|language| json!({"language": language}));
        let options = json!({"documentSelector": languages, "rangesSupport": true});
        registration("rungwise-ranges", "textDocument/rangeFormatting", Some(options))
    });
    files.into_iter().chain(configuration).chain(content).chain(ranges).collect()
}

/// The answer to `initialize`. `pulls` is the setting that turns pushed diagnostics off.
pub(super) fn offered(
    client: &ClientCapabilities,
    encoding: Encoding,
    pulls: bool,
    requests: Requests,
) -> InitializeResult {
    let can_pull = client.text_document.as_ref().is_some_and(|document| document.diagnostic.is_some());
    // A client that pulls as well would show what is pushed twice. One that cannot pull ignores the offer.
    let diagnostic_provider = (pulls || !can_pull).then(|| {
        DiagnosticServerCapabilities::Options(DiagnosticOptions {
            identifier: Some("rungwise".to_string()),
            inter_file_dependencies: true,
            workspace_diagnostics: true,
            ..DiagnosticOptions::default()
        })
    });
    let capabilities = ServerCapabilities {
        position_encoding: Some(to_proto::encoding(encoding)),
        text_document_sync: Some(TextDocumentSyncCapability::Options(TextDocumentSyncOptions {
            open_close: Some(true),
            change: Some(TextDocumentSyncKind::INCREMENTAL),
            save: Some(TextDocumentSyncSaveOptions::Supported(true)),
            ..TextDocumentSyncOptions::default()
        })),
        hover_provider: Some(HoverProviderCapability::Simple(true)),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some(
                [".", "%", "[", "(", manifest_help::TRIGGER].map(str::to_string).to_vec(),
            ),
            ..CompletionOptions::default()
        }),
        definition_provider: Some(OneOf::Left(true)),
        workspace_symbol_provider: Some(OneOf::Left(true)),
        call_hierarchy_provider: Some(CallHierarchyServerCapability::Simple(true)),
        document_link_provider: Some(DocumentLinkOptions {
            resolve_provider: Some(false),
            work_done_progress_options: WorkDoneProgressOptions::default(),
        }),
        workspace: Some(WorkspaceServerCapabilities {
            workspace_folders: Some(WorkspaceFoldersServerCapabilities {
                supported: Some(true),
                change_notifications: Some(OneOf::Left(true)),
            }),
            ..WorkspaceServerCapabilities::default()
        }),
        references_provider: Some(OneOf::Left(true)),
        document_symbol_provider: Some(OneOf::Left(true)),
        folding_range_provider: Some(FoldingRangeProviderCapability::Simple(true)),
        document_formatting_provider: Some(OneOf::Left(true)),
        // A client that takes several ranges at once gets a registration for both.
        document_range_formatting_provider: (!requests.newer.ranges).then_some(OneOf::Left(true)),
        document_highlight_provider: Some(OneOf::Left(true)),
        signature_help_provider: Some(SignatureHelpOptions {
            trigger_characters: Some(["(", ",", " "].map(str::to_string).to_vec()),
            retrigger_characters: Some([",", " ", "="].map(str::to_string).to_vec()),
            work_done_progress_options: WorkDoneProgressOptions::default(),
        }),
        code_lens_provider: Some(CodeLensOptions { resolve_provider: Some(true) }),
        rename_provider: Some(match Abilities::of(client).prepare_rename {
            true => OneOf::Right(RenameOptions {
                prepare_provider: Some(true),
                work_done_progress_options: WorkDoneProgressOptions::default(),
            }),
            false => OneOf::Left(true),
        }),
        code_action_provider: Some(CodeActionProviderCapability::Options(CodeActionOptions {
            code_action_kinds: Some(vec![
                CodeActionKind::QUICKFIX,
                CodeActionKind::REFACTOR_REWRITE,
                CodeActionKind::REFACTOR_EXTRACT,
                CodeActionKind::REFACTOR_INLINE,
                CodeActionKind::SOURCE,
            ]),
            resolve_provider: Some(true),
            ..CodeActionOptions::default()
        })),
        document_on_type_formatting_provider: Some(editing::on_type()),
        selection_range_provider: Some(SelectionRangeProviderCapability::Simple(true)),
        linked_editing_range_provider: Some(LinkedEditingRangeServerCapabilities::Simple(true)),
        inlay_hint_provider: Some(OneOf::Left(true)),
        semantic_tokens_provider: Some(SemanticTokensServerCapabilities::SemanticTokensOptions(
            SemanticTokensOptions {
                legend: to_proto::legend(),
                range: Some(true),
                full: Some(SemanticTokensFullOptions::Delta { delta: Some(true) }),
                ..SemanticTokensOptions::default()
            },
        )),
        execute_command_provider: Some(ExecuteCommandOptions {
            commands: COMMANDS.iter().map(|command| command.to_string()).collect(),
            work_done_progress_options: WorkDoneProgressOptions::default(),
        }),
        diagnostic_provider,
        ..ServerCapabilities::default()
    };
    let server_info =
        ServerInfo { name: "rungwise".to_string(), version: Some(env!("CARGO_PKG_VERSION").to_string()) };
    InitializeResult { capabilities, server_info: Some(server_info), offset_encoding: None }
}
