//! From plain structs to the protocol's types.

use super::abilities::{Abilities, plain_text};
use super::projects::Around;
use super::workspace::Open;
use crate::document::Document;
use crate::ide;
use crate::text::{Diagnostic, Encoding, Language, LineColumn, Severity, Span, TextEdit};
use tower_lsp::ls_types as lsp;

/// A client draws no more of them; one at the end says how many there are.
const DIAGNOSTICS_LIMIT: usize = 1000;

/// How a client counts columns and which language its user reads.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Manner {
    pub encoding: Encoding,
    pub language: Language,
    pub abilities: Abilities,
}

/// Where answers about one document go: its offsets, the client's way to count and to speak.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub document: &'a Document,
    pub encoding: Encoding,
    pub language: Language,
    pub abilities: Abilities,
}

impl<'a> Place<'a> {
    pub(super) fn new(document: &'a Document, manner: Manner) -> Place<'a> {
        let Manner { encoding, language, abilities } = manner;
        Place { document, encoding, language, abilities }
    }

    pub(super) fn manner(self) -> Manner {
        Manner { encoding: self.encoding, language: self.language, abilities: self.abilities }
    }
}

impl Place<'_> {
    pub(super) fn position(self, offset: usize) -> lsp::Position {
        let LineColumn { line, column } = self.document.position(offset, self.encoding);
        lsp::Position::new(line, column)
    }

    pub(super) fn range(self, span: Span) -> lsp::Range {
        lsp::Range::new(self.position(span.start as usize), self.position(span.end as usize))
    }

    pub(super) fn offset(self, position: lsp::Position) -> usize {
        self.document.offset(LineColumn { line: position.line, column: position.character }, self.encoding)
    }

    pub(super) fn span(self, range: lsp::Range) -> Span {
        let start = self.offset(range.start);
        Span::new(start, self.offset(range.end).max(start))
    }

    pub(super) fn edit(self, edit: &TextEdit) -> lsp::TextEdit {
        lsp::TextEdit::new(self.range(edit.span), edit.text.clone())
    }

    pub(super) fn edits(self, edits: &[TextEdit]) -> Vec<lsp::TextEdit> {
        edits.iter().map(|edit| self.edit(edit)).collect()
    }
}

pub(super) fn encoding(encoding: Encoding) -> lsp::PositionEncodingKind {
    match encoding {
        Encoding::Utf8 => lsp::PositionEncodingKind::UTF8,
        Encoding::Utf16 => lsp::PositionEncodingKind::UTF16,
        Encoding::Utf32 => lsp::PositionEncodingKind::UTF32,
    }
}

pub(super) fn diagnostics(around: &Around, found: Vec<Diagnostic>, manner: Manner) -> Vec<lsp::Diagnostic> {
    let total = found.len();
    let mut shown: Vec<_> =
        found.iter().take(DIAGNOSTICS_LIMIT).map(|found| diagnostic(around, found, manner)).collect();
    if let Some(last) = shown.last_mut().filter(|_| total > DIAGNOSTICS_LIMIT) {
        let message =
            crate::text::Message::new("limits.more-diagnostics").with("count", total - DIAGNOSTICS_LIMIT + 1);
        *last = lsp::Diagnostic {
            range: last.range,
            severity: Some(lsp::DiagnosticSeverity::INFORMATION),
            source: Some("rungwise".to_string()),
            message: message.render(manner.language),
            ..lsp::Diagnostic::default()
        };
    }
    shown
}

/// `around` has the files that the diagnostic names by their numbers.
pub(super) fn diagnostic(around: &Around, found: &Diagnostic, manner: Manner) -> lsp::Diagnostic {
    let place = Place::new(&around.here().document, manner);
    let related = found.related.iter().filter_map(|related| {
        let file = related.file.map_or(Some(around.here()), |number| around.file(number))?;
        Some(lsp::DiagnosticRelatedInformation {
            location: location(file, related.span, manner),
            message: related.message.render(manner.language),
        })
    });
    let has_related = !found.related.is_empty() && manner.abilities.related_information;
    lsp::Diagnostic {
        range: place.range(found.span),
        severity: Some(match found.severity {
            Severity::Error => lsp::DiagnosticSeverity::ERROR,
            Severity::Warning => lsp::DiagnosticSeverity::WARNING,
            Severity::Hint => lsp::DiagnosticSeverity::HINT,
        }),
        code: Some(lsp::NumberOrString::String(found.code.to_string())),
        source: Some("rungwise".to_string()),
        message: found.message.render(manner.language),
        related_information: has_related.then(|| related.collect()),
        ..lsp::Diagnostic::default()
    }
}

/// A place in a file.
pub(super) fn location(file: &Open, span: Span, manner: Manner) -> lsp::Location {
    lsp::Location { uri: file.uri.clone(), range: Place::new(&file.document, manner).range(span) }
}

pub(super) fn hover(place: Place<'_>, hover: ide::Hover) -> lsp::Hover {
    let contents = markup(hover.markdown, place.abilities.markdown_hover);
    lsp::Hover { contents: lsp::HoverContents::Markup(contents), range: Some(place.range(hover.span)) }
}

/// Markdown, or the text of it for a client that shows no Markdown.
fn markup(markdown: String, is_known: bool) -> lsp::MarkupContent {
    match is_known {
        true => lsp::MarkupContent { kind: lsp::MarkupKind::Markdown, value: markdown },
        false => lsp::MarkupContent { kind: lsp::MarkupKind::PlainText, value: plain_text(&markdown) },
    }
}

pub(super) fn completion(place: Place<'_>, mut proposal: ide::Completion) -> lsp::CompletionItem {
    let abilities = place.abilities;
    let documentation = markup(proposal.documentation, abilities.markdown_completion);
    if proposal.is_snippet && !abilities.snippets {
        proposal.edit.text = without_places(&proposal.edit.text);
        proposal.is_snippet = false;
    }
    let label_details = (abilities.label_details && !proposal.detail.is_empty()).then(|| {
        lsp::CompletionItemLabelDetails { detail: None, description: Some(proposal.detail.clone()) }
    });
    lsp::CompletionItem {
        label_details,
        kind: Some(completion_kind(proposal.kind)),
        detail: (!proposal.detail.is_empty()).then_some(proposal.detail),
        documentation: (!documentation.value.is_empty())
            .then_some(lsp::Documentation::MarkupContent(documentation)),
        sort_text: Some(format!("{:05}{}", proposal.rank, proposal.label)),
        filter_text: (!proposal.filter.is_empty()).then_some(proposal.filter),
        insert_text_format: proposal.is_snippet.then_some(lsp::InsertTextFormat::SNIPPET),
        text_edit: Some(lsp::CompletionTextEdit::Edit(place.edit(&proposal.edit))),
        label: proposal.label,
        ..lsp::CompletionItem::default()
    }
}

/// The text of a snippet for a client that knows none: places are left out, their names stay.
fn without_places(snippet: &str) -> String {
    let mut text = String::with_capacity(snippet.len());
    let mut characters = snippet.chars().peekable();
    let mut depth = 0usize;
    while let Some(character) = characters.next() {
        match character {
            '\\' => text.extend(characters.next()),
            '$' => {
                let named = characters.next_if_eq(&'{').is_some();
                while characters.next_if(char::is_ascii_digit).is_some() {}
                if named && characters.next_if_eq(&'|').is_some() {
                    // Of words to choose from the first one stands for all.
                    let choices: String = characters.by_ref().take_while(|other| *other != '}').collect();
                    text.push_str(choices.split([',', '|']).next().unwrap_or(""));
                } else if named {
                    depth += 1;
                    characters.next_if_eq(&':');
                }
            }
            '}' if depth > 0 => depth -= 1,
            other => text.push(other),
        }
    }
    text
}

fn completion_kind(kind: ide::CompletionKind) -> lsp::CompletionItemKind {
    match kind {
        ide::CompletionKind::Instruction => lsp::CompletionItemKind::OPERATOR,
        ide::CompletionKind::Device | ide::CompletionKind::Variable => lsp::CompletionItemKind::VARIABLE,
        ide::CompletionKind::Label => lsp::CompletionItemKind::REFERENCE,
        ide::CompletionKind::Function => lsp::CompletionItemKind::FUNCTION,
        ide::CompletionKind::FunctionBlock => lsp::CompletionItemKind::CLASS,
        ide::CompletionKind::Keyword => lsp::CompletionItemKind::KEYWORD,
        ide::CompletionKind::Type => lsp::CompletionItemKind::TYPE_PARAMETER,
        ide::CompletionKind::Constant => lsp::CompletionItemKind::CONSTANT,
        ide::CompletionKind::Snippet => lsp::CompletionItemKind::SNIPPET,
    }
}

/// The outline as a tree, or as a list for a client that knows no tree.
pub(super) fn outline(
    place: Place<'_>,
    nodes: Vec<ide::SymbolNode>,
    uri: &lsp::Uri,
) -> lsp::DocumentSymbolResponse {
    if place.abilities.nested_symbols {
        let nodes = nodes.into_iter().map(|node| symbol(place, node));
        return lsp::DocumentSymbolResponse::Nested(nodes.collect());
    }
    let mut list = Vec::new();
    let mut open: Vec<(ide::SymbolNode, Option<String>)> =
        nodes.into_iter().rev().map(|node| (node, None)).collect();
    while let Some((node, container_name)) = open.pop() {
        let children = node.children.into_iter().rev();
        open.extend(children.map(|child| (child, Some(node.name.clone()))));
        #[allow(deprecated, reason = "the protocol's struct still has the field")]
        list.push(lsp::SymbolInformation {
            name: node.name,
            kind: symbol_kind(node.kind),
            tags: None,
            deprecated: None,
            location: lsp::Location { uri: uri.clone(), range: place.range(node.span) },
            container_name,
        });
    }
    lsp::DocumentSymbolResponse::Flat(list)
}

pub(super) fn symbol(place: Place<'_>, node: ide::SymbolNode) -> lsp::DocumentSymbol {
    let children: Vec<_> = node.children.into_iter().map(|child| symbol(place, child)).collect();
    #[allow(deprecated, reason = "the protocol's struct still has the field")]
    lsp::DocumentSymbol {
        name: node.name,
        detail: (!node.detail.is_empty()).then_some(node.detail),
        kind: symbol_kind(node.kind),
        tags: None,
        deprecated: None,
        range: place.range(node.span),
        selection_range: place.range(node.selection),
        children: (!children.is_empty()).then_some(children),
    }
}

pub(super) fn symbol_kind(kind: ide::SymbolKind) -> lsp::SymbolKind {
    match kind {
        ide::SymbolKind::Program => lsp::SymbolKind::MODULE,
        ide::SymbolKind::FunctionBlock => lsp::SymbolKind::CLASS,
        ide::SymbolKind::Function => lsp::SymbolKind::FUNCTION,
        ide::SymbolKind::Network | ide::SymbolKind::Section => lsp::SymbolKind::NAMESPACE,
        ide::SymbolKind::Rung => lsp::SymbolKind::EVENT,
        ide::SymbolKind::Label => lsp::SymbolKind::KEY,
        ide::SymbolKind::Step => lsp::SymbolKind::METHOD,
        ide::SymbolKind::Variable => lsp::SymbolKind::VARIABLE,
        ide::SymbolKind::Type => lsp::SymbolKind::STRUCT,
        ide::SymbolKind::Configuration => lsp::SymbolKind::PACKAGE,
    }
}

pub(super) fn fold(place: Place<'_>, fold: ide::Fold) -> lsp::FoldingRange {
    lsp::FoldingRange {
        start_line: place.position(fold.span.start as usize).line,
        end_line: place.position(fold.span.end as usize).line,
        kind: Some(match fold.kind {
            ide::FoldKind::Region => lsp::FoldingRangeKind::Region,
            ide::FoldKind::Comment => lsp::FoldingRangeKind::Comment,
        }),
        ..lsp::FoldingRange::default()
    }
}

pub(super) fn inlay_hint(place: Place<'_>, hint: ide::InlayHint) -> lsp::InlayHint {
    lsp::InlayHint {
        position: place.position(hint.offset),
        label: lsp::InlayHintLabel::String(hint.label),
        kind: None,
        text_edits: None,
        tooltip: Some(lsp::InlayHintTooltip::String(hint.tooltip)),
        padding_left: Some(true),
        padding_right: None,
        data: None,
    }
}

/// The token types in the order of [`ide::TokenKind`], by the names that themes know. Mnemonics are keywords: themes
/// leave operators in the colour of plain text.
pub(super) fn legend() -> lsp::SemanticTokensLegend {
    let types = [
        "comment", "keyword", "keyword", "variable", "variable", "label", "number", "string", "function",
        "class", "type", "wire", "contact",
    ];
    lsp::SemanticTokensLegend {
        token_types: types.into_iter().map(lsp::SemanticTokenType::new).collect(),
        token_modifiers: vec![lsp::SemanticTokenModifier::MODIFICATION],
    }
}
