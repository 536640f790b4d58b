//! Answers of features about devices and one document, in the protocol's types.

use super::editing;
use super::projects::Around;
use super::settings::Settings;
use super::sheets;
use super::testing;
use super::to_proto::{self, Place};
use super::workspace::{Open, Snapshot};
use crate::document::Document;
use crate::ide::{self, HighlightKind, LensKind};
use crate::target::{Device, Operand};
use crate::text::{Encoding, Language, Message, Span, column_of_offset};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::sync::Arc;
use tower_lsp::ls_types::*;

/// The parameters of `textDocument/rangesFormatting`; the client's options of formatting are the project's matter.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct RangesParams {
    pub text_document: TextDocumentIdentifier,
    pub ranges: Vec<Range>,
}

/// The address of a line of a file, for links in Markdown.
pub(super) fn link(around: &Around, file: usize, line: u32) -> Option<String> {
    let uri = &around.file(file)?.uri;
    let is_file = uri.scheme().as_str().eq_ignore_ascii_case("file");
    is_file.then(|| format!("{}#L{}", uri.as_str(), line + 1))
}

pub(super) fn signature_help(place: Place<'_>, offset: usize) -> Option<SignatureHelp> {
    let signature = ide::signature(place.document, offset, place.language)?;
    // Labels are counted in UTF-16, whatever the encoding of positions is.
    let unit = |byte: u32| column_of_offset(&signature.label, byte as usize, Encoding::Utf16);
    let text = |value: &str| Some(Documentation::String(value.to_string()));
    let parameters = signature.parameters.iter().map(|parameter| ParameterInformation {
        label: ParameterLabel::LabelOffsets([unit(parameter.span.start), unit(parameter.span.end)]),
        documentation: text(&parameter.documentation),
    });
    let parameters: Vec<_> = parameters.collect();
    // A number behind the last one marks no parameter.
    let active = signature.active.unwrap_or(parameters.len()) as u32;
    let information = SignatureInformation {
        documentation: text(&signature.documentation),
        parameters: Some(parameters),
        active_parameter: Some(active),
        label: signature.label,
    };
    Some(SignatureHelp {
        signatures: vec![information],
        active_signature: Some(0),
        active_parameter: Some(active),
    })
}

pub(super) fn highlights(place: Place<'_>, offset: usize) -> Vec<DocumentHighlight> {
    let marks = ide::highlights(place.document, offset).into_iter();
    let kind = |kind| match kind {
        HighlightKind::Text => DocumentHighlightKind::TEXT,
        HighlightKind::Read => DocumentHighlightKind::READ,
        HighlightKind::Write => DocumentHighlightKind::WRITE,
    };
    marks
        .map(|mark| DocumentHighlight { range: place.range(mark.span), kind: Some(kind(mark.kind)) })
        .collect()
}

/// What a lens carries until it is resolved.
#[derive(Serialize, Deserialize)]
struct LensData {
    uri: String,
    offset: usize,
    kind: String,
}

/// What can be done with a program stands above its first line, then come the lenses of its rungs.
pub(super) fn lenses(open: &Open, place: Place<'_>, settings: &Settings, has_tests: bool) -> Vec<CodeLens> {
    let lenses = ide::lenses(place.document, settings.lenses).into_iter();
    let lens = |offset: usize, kind: String| {
        let data = LensData { uri: open.uri.to_string(), offset, kind };
        let range = place.range(Span::at(offset));
        CodeLens { range, command: None, data: serde_json::to_value(data).ok() }
    };
    let runs = [SIMULATE, RUN].into_iter().filter(|kind| *kind == SIMULATE || has_tests);
    let runs = runs.filter(|_| settings.run_lenses && !place.document.is_empty());
    let runs: Vec<CodeLens> = runs.map(|kind| lens(0, kind.to_string())).collect();
    let of_rungs = lenses.map(|found| {
        let kind = match found.kind {
            LensKind::Steps => "steps".to_string(),
            LensKind::NextFree => "next-free".to_string(),
            LensKind::More => "more".to_string(),
            LensKind::References(device) => device.to_string(),
        };
        lens(found.span.start as usize, kind)
    });
    runs.into_iter().chain(of_rungs).collect()
}

/// The lens that simulates a program, and the one that runs its scenarios.
const SIMULATE: &str = "simulate";
const RUN: &str = "run";

/// The lens with its words, as a command that does nothing where it only tells; every client shows that as text.
pub(super) fn resolved(snapshot: &Snapshot, mut lens: CodeLens) -> CodeLens {
    let data = lens.data.as_ref().and_then(|data| LensData::deserialize(data).ok());
    let does = |title: &'static str, command: &str, argument: Value| Command {
        title: Message::new(title).render(snapshot.manner.language),
        command: command.to_string(),
        arguments: Some(vec![argument]),
    };
    let command = match &data {
        Some(data) if data.kind == SIMULATE => {
            does("lens.simulate", "rungwise.simulate.start", json!({ "uri": data.uri }))
        }
        Some(data) if data.kind == RUN => {
            does("lens.run-all", testing::RUN, json!({ "uri": data.uri, "show": true }))
        }
        _ => {
            let title = data.and_then(|data| told(snapshot, &data)).unwrap_or_else(|| "–".to_string());
            Command { title, command: String::new(), arguments: None }
        }
    };
    lens.command = Some(command);
    lens
}

fn told(snapshot: &Snapshot, data: &LensData) -> Option<String> {
    let around = snapshot.around(snapshot.open(&data.uri.parse().ok()?)?);
    let kind = match data.kind.as_str() {
        "steps" => LensKind::Steps,
        "next-free" => LensKind::NextFree,
        "more" => LensKind::More,
        name => LensKind::References(device_named(&around.here().document, name)?),
    };
    ide::lens_title(&around.view(), data.offset, &kind, snapshot.manner.language)
}

fn device_named(document: &Document, name: &str) -> Option<Device> {
    match Operand::read(name, document.target().model) {
        Operand::Device(device) => Some(device),
        _ => None,
    }
}

/// The comments file of the project around a document, as a document of its own.
pub(super) fn table(snapshot: &Snapshot, around: &Around) -> Option<Arc<Open>> {
    let loaded = snapshot.projects.get(around.here().project.as_ref()?)?;
    let table = sheets::around(snapshot, loaded.comments_file.as_ref()?)?;
    Some(table.here().clone())
}

/// The actions that write a symbol for the device at the cursor, or the device for a symbol.
pub(super) fn rewrites(open: &Open, place: Place<'_>, params: &CodeActionParams) -> Vec<CodeAction> {
    if !editing::is_wanted(&CodeActionKind::REFACTOR_REWRITE, params.context.only.as_deref()) {
        return Vec::new();
    }
    let rewrites = ide::rewrites(place.document, place.offset(params.range.start)).into_iter();
    let action = |rewrite: ide::Rewrite| CodeAction {
        title: rewrite.title.render(place.language),
        kind: Some(CodeActionKind::REFACTOR_REWRITE),
        edit: Some(editing::changes(open, place.edits(&rewrite.edits))),
        ..CodeAction::default()
    };
    rewrites.map(action).collect()
}

/// The refactorings of the rung at a range as code actions.
pub(super) fn refactorings(
    around: &Around,
    place: Place<'_>,
    params: &CodeActionParams,
    style: ide::Style,
) -> Vec<CodeAction> {
    let only = params.context.only.as_deref();
    let groups = ["refactor.rewrite.rung", "refactor.extract.relay", "refactor.inline.relay"];
    let is_asked = |only: &&[CodeActionKind]| {
        let own = only.iter().any(|kind| kind.as_str().starts_with(groups[0]));
        own || groups.iter().any(|group| editing::is_wanted(&(*group).into(), Some(only)))
    };
    if only.is_some_and(|only| !is_asked(&only)) {
        return Vec::new();
    }
    let refactorings = ide::refactorings(&around.view(), place.span(params.range), style).into_iter();
    let wanted = refactorings.filter(|refactoring| editing::is_wanted(&refactoring.kind.into(), only));
    let action = |refactoring: ide::Refactoring| CodeAction {
        title: refactoring.title.render(place.language),
        kind: Some(refactoring.kind.into()),
        edit: Some(editing::changes(around.here(), place.edits(&refactoring.edits))),
        ..CodeAction::default()
    };
    wanted.map(action).collect()
}

/// A fix as a code action.
pub(super) fn quick_fix(around: &Around, place: Place<'_>, fix: &ide::FixOf<'_>) -> CodeAction {
    CodeAction {
        title: fix.fix.title.render(place.language),
        kind: Some(CodeActionKind::QUICKFIX),
        diagnostics: Some(vec![to_proto::diagnostic(around, fix.diagnostic, place.manner())]),
        edit: Some(editing::changes(around.here(), place.edits(&fix.fix.edits))),
        is_preferred: Some(fix.is_preferred),
        ..CodeAction::default()
    }
}

/// `{"errors", "warnings", "hints", "rungs", "steps", "capacity", "message"}`
pub(super) fn check_summary(around: &Around, language: Language) -> Value {
    let mut summary = ide::Summary::default();
    summary.add(&around.here().document, &around.findings());
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
