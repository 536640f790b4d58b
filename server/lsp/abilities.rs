//! What the client can show and do, as it said in `initialize`.

use super::translating;
use serde_json::Value;
use tower_lsp::ls_types::*;

/// What answers depend on. A client that says nothing at all about a side of the protocol is taken for one that knows
/// that side whole, as small clients do; one that describes it is taken at its word.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Abilities {
    /// Edits of versions of documents, `documentChanges`.
    pub document_changes: bool,
    /// `textDocument/prepareRename`.
    pub prepare_rename: bool,
    /// Outlines with children.
    pub nested_symbols: bool,
    /// Code actions that carry their edit; else a command that applies it.
    pub code_actions: bool,
    /// Hovers in Markdown; else plain text.
    pub markdown_hover: bool,
    /// Documentation of proposals in Markdown; else plain text.
    pub markdown_completion: bool,
    /// Proposals with places to fill in.
    pub snippets: bool,
    /// A description beside the label of a proposal.
    pub label_details: bool,
    /// Places beside a diagnostic.
    pub related_information: bool,
    /// Definitions with the range of the name that was asked about.
    pub links: bool,
    /// Edits that make files.
    pub makes_files: bool,
    /// The command that opens a translation as a new document.
    pub opens_translations: bool,
    /// The command that puts a translation on the clipboard.
    pub copies_translations: bool,
}

/// What the server may ask of the client. Here silence means no.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Requests {
    /// `client/registerCapability` for watched files.
    pub watch: bool,
    /// `client/registerCapability` for changes of the configuration.
    pub watch_configuration: bool,
    /// `workspace/configuration`.
    pub configuration: bool,
    /// `window/workDoneProgress/create`.
    pub progress: bool,
    /// `workspace/diagnostic/refresh`.
    pub refresh_diagnostics: bool,
    /// `workspace/inlayHint/refresh`.
    pub refresh_hints: bool,
    /// `window/showDocument`.
    pub show_document: bool,
    /// Parts of LSP 3.18 that the protocol's types do not know yet.
    pub newer: Newer,
}

/// What a client of LSP 3.18 takes registrations for.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Newer {
    /// `workspace/textDocumentContent`.
    pub content: bool,
    /// `textDocument/rangesFormatting`.
    pub ranges: bool,
}

impl Newer {
    /// From the parameters of `initialize` as they were sent.
    pub(super) fn of(params: Option<&Value>) -> Newer {
        let is = |path: &str| {
            params.and_then(|params| params.pointer(path)).and_then(Value::as_bool) == Some(true)
        };
        let ranges = "/capabilities/textDocument/rangeFormatting";
        Newer {
            content: is("/capabilities/workspace/textDocumentContent/dynamicRegistration"),
            ranges: is(&format!("{ranges}/dynamicRegistration")) && is(&format!("{ranges}/rangesSupport")),
        }
    }
}

impl Default for Abilities {
    fn default() -> Abilities {
        Abilities {
            document_changes: true,
            prepare_rename: true,
            nested_symbols: true,
            code_actions: true,
            markdown_hover: true,
            markdown_completion: true,
            snippets: true,
            label_details: false,
            related_information: true,
            links: false,
            makes_files: false,
            opens_translations: false,
            copies_translations: false,
        }
    }
}

impl Abilities {
    pub(super) fn of(client: &ClientCapabilities) -> Abilities {
        let mut abilities = Abilities::default();
        if let Some(workspace) = &client.workspace {
            let edit = workspace.workspace_edit.as_ref();
            abilities.document_changes = edit.is_some_and(|edit| edit.document_changes == Some(true));
            let operations = edit.and_then(|edit| edit.resource_operations.as_deref()).unwrap_or_default();
            abilities.makes_files =
                abilities.document_changes && operations.contains(&ResourceOperationKind::Create);
        }
        let commands = client.experimental.as_ref().map(|more| &more["commands"]["commands"]);
        let has = |name: &str| {
            let names = commands.and_then(Value::as_array).into_iter().flatten();
            names.into_iter().any(|command| command == name)
        };
        abilities.opens_translations = has(translating::OPEN);
        abilities.copies_translations = has(translating::COPY);
        let Some(text) = &client.text_document else { return abilities };
        let has_markdown = |kinds: Option<&Vec<MarkupKind>>| {
            kinds.is_some_and(|kinds| kinds.contains(&MarkupKind::Markdown))
        };
        let hover = text.hover.as_ref().and_then(|hover| hover.content_format.as_ref());
        let symbols = text.document_symbol.as_ref();
        let item = text.completion.as_ref().and_then(|completion| completion.completion_item.as_ref());
        Abilities {
            prepare_rename: text.rename.as_ref().is_some_and(|rename| rename.prepare_support == Some(true)),
            nested_symbols: symbols
                .is_some_and(|symbols| symbols.hierarchical_document_symbol_support == Some(true)),
            code_actions: text
                .code_action
                .as_ref()
                .is_some_and(|action| action.code_action_literal_support.is_some()),
            markdown_hover: has_markdown(hover),
            markdown_completion: has_markdown(item.and_then(|item| item.documentation_format.as_ref())),
            snippets: item.is_some_and(|item| item.snippet_support == Some(true)),
            label_details: item.is_some_and(|item| item.label_details_support == Some(true)),
            related_information: text
                .publish_diagnostics
                .as_ref()
                .is_some_and(|publish| publish.related_information == Some(true)),
            links: text.definition.as_ref().is_some_and(|definition| definition.link_support == Some(true)),
            ..abilities
        }
    }
}

impl Requests {
    pub(super) fn of(client: &ClientCapabilities) -> Requests {
        let window = client.window.as_ref();
        let progress = window.is_some_and(|window| window.work_done_progress == Some(true));
        let show_document =
            window.and_then(|window| window.show_document.as_ref()).is_some_and(|show| show.support);
        let Some(workspace) = &client.workspace else {
            return Requests { progress, show_document, ..Requests::default() };
        };
        let watched = workspace.did_change_watched_files.as_ref();
        let configuration = workspace.did_change_configuration.as_ref();
        let diagnostics = workspace.diagnostics.as_ref();
        Requests {
            watch: watched.is_some_and(|watched| watched.dynamic_registration == Some(true)),
            watch_configuration: configuration.is_some_and(|one| one.dynamic_registration == Some(true)),
            configuration: workspace.configuration == Some(true),
            progress,
            show_document,
            refresh_diagnostics: diagnostics.is_some_and(|one| one.refresh_support == Some(true)),
            refresh_hints: workspace.inlay_hint.as_ref().is_some_and(|one| one.refresh_support == Some(true)),
            newer: Newer::default(),
        }
    }
}

/// Markdown as plain text, for clients that show the signs: fences, emphasis and code marks are taken out.
pub(super) fn plain_text(markdown: &str) -> String {
    let mut plain = String::with_capacity(markdown.len());
    let mut in_fence = false;
    for line in markdown.lines() {
        if line.trim_start().starts_with("```") {
            in_fence = !in_fence;
            continue;
        }
        if in_fence {
            plain.push_str(line);
        } else {
            let heading = line.trim_start_matches('#');
            let text = if heading.len() < line.len() { heading.trim_start() } else { line };
            plain.push_str(&text.replace("**", "").replace('`', ""));
        }
        plain.push('\n');
    }
    plain.truncate(plain.trim_end().len());
    plain
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_client_is_taken_at_its_word() {
        let silent: ClientCapabilities = serde_json::from_value(json!({})).unwrap();
        assert_eq!(Abilities::of(&silent), Abilities::default());
        assert_eq!(Requests::of(&silent), Requests::default());
        let poor: ClientCapabilities =
            serde_json::from_value(json!({"textDocument": {"hover": {}}, "workspace": {}})).unwrap();
        let abilities = Abilities::of(&poor);
        assert!(!abilities.markdown_hover && !abilities.nested_symbols && !abilities.document_changes);
        let rich: ClientCapabilities = serde_json::from_value(json!({
            "textDocument": {"hover": {"contentFormat": ["markdown"]}, "rename": {"prepareSupport": true}},
            "workspace": {"workspaceEdit": {"documentChanges": true}, "configuration": true},
            "window": {"workDoneProgress": true},
        }))
        .unwrap();
        let abilities = Abilities::of(&rich);
        assert!(abilities.markdown_hover && abilities.prepare_rename && abilities.document_changes);
        assert!(!abilities.snippets);
        assert!(Requests::of(&rich).configuration && Requests::of(&rich).progress);
    }

    #[test]
    fn plain_text_has_no_signs() {
        let markdown = "## LD\n\n**Load** `X0`.\n\n```fx\nLD X0 **2\n```\n- one";
        assert_eq!(plain_text(markdown), "LD\n\nLoad X0.\n\nLD X0 **2\n- one");
    }
}
