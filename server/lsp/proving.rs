//! `rungwise.prove`: whether two programs do the same.
//!
//! A command (`workspace/executeCommand`) with one argument:
//!
//! ```text
//! { uri: string, with: string }
//! ```
//!
//! Both are addresses of programs; what is not open is read from the disk. The answer is what `rungwise prove --format
//! json` prints, with two members more:
//!
//! ```text
//! {
//!   equal: boolean | null,             // null: not decided
//!   …
//!   places: { uri, range }[],          // the rungs that differ, or from which on nothing is decided
//!   page: string                       // Markdown: the answer in a sentence, and a picture of the scan that differs
//! }
//! ```
//!
//! A program that cannot be read is an error whose message says so.

use super::answering::{beside, refused, settings, snapshot};
use super::keeper::read_program;
use super::projects::{canonical, file_path};
use super::to_proto::Place;
use super::workspace::{Open, Snapshot, is_toml};
use crate::document::Document;
use crate::scenario::shown;
use crate::text::{Message, Span};
use crate::translate::{Proof, prove, told};
use serde::Deserialize;
use serde_json::{Value, json};
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{LSPAny, Uri};

/// The command.
pub(super) const PROVE: &str = "rungwise.prove";

/// Its argument.
#[derive(Deserialize)]
struct Asked {
    uri: Uri,
    with: Uri,
}

/// Answers it.
pub(super) async fn answer(argument: Option<&Value>) -> Result<Option<LSPAny>> {
    let wrong = |reason: String| {
        refused(Message::new("translating.argument").with("command", PROVE).with("reason", reason))
    };
    let argument = argument.ok_or_else(|| wrong("arguments[0]".to_string()))?;
    let Asked { uri, with } = Asked::deserialize(argument).map_err(|reason| wrong(reason.to_string()))?;
    let (snapshot, settings) = (snapshot(), settings());
    let answer = beside(move |_| {
        let left = program(&snapshot, &uri, None, &settings);
        let right = program(&snapshot, &with, snapshot.open(&uri).map(|open| &**open), &settings);
        Some(match (left, right) {
            (Some(left), Some(right)) => Ok(told_of(&snapshot, [(&uri, &left), (&with, &right)])),
            (None, _) => Err(uri),
            (_, None) => Err(with),
        })
    });
    let answer = answer.await?.transpose();
    answer.map_err(|uri| refused(Message::new("proving.unreadable").with("uri", uri.as_str())))
}

/// The program at `uri`: as the editor has it, as a file of a project that is known, else as the disk has it, read as
/// one for the PLC of `beside`.
fn program(
    snapshot: &Snapshot,
    uri: &Uri,
    beside: Option<&Open>,
    settings: &super::settings::Settings,
) -> Option<Document> {
    if let Some(open) = snapshot.open(uri) {
        return (!is_toml(&open.uri)).then(|| open.document.lean());
    }
    if let Some(around) = snapshot.around_closed(uri) {
        return Some(around.here().document.clone());
    }
    let manifest = beside.map(|open| open.manifest.clone()).unwrap_or_default();
    read_program(&canonical(&file_path(uri)?), settings, &manifest)
}

fn told_of(snapshot: &Snapshot, sides: [(&Uri, &Document); 2]) -> Value {
    let documents = sides.map(|(_, document)| document);
    let names = sides.map(|(uri, _)| name_of(uri));
    let proof = shown(prove(documents[0], documents[1]), documents, &names);
    let at: [Option<Span>; 2] = match &proof {
        Proof::Equal { .. } => [None, None],
        Proof::Different(found) => found.at,
        Proof::Undecided { at, .. } => *at,
    };
    let places = sides.iter().zip(at).filter_map(|((uri, document), span)| {
        Some(json!({"uri": uri, "range": Place::new(document, snapshot.manner).range(span?)}))
    });
    let language = snapshot.manner.language;
    let mut answer = told::json(&proof, documents, language);
    answer["places"] = places.collect();
    answer["page"] = page(&told::text(&proof, documents, &names, language), &names).into();
    answer
}

/// The last part of an address, for people.
fn name_of(uri: &Uri) -> String {
    let name = file_path(uri).and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    name.unwrap_or_else(|| uri.as_str().rsplit('/').next().unwrap_or_default().to_string())
}

/// The sentence as it is, the picture in a fence.
fn page(text: &str, [left, right]: &[String; 2]) -> String {
    let (sentence, picture) = text.split_once("\n\n").unwrap_or((text, ""));
    let head = format!("# {left} · {right}\n\n{}\n", sentence.trim_end());
    match picture.is_empty() {
        true => head,
        false => format!("{head}\n```text\n{picture}```\n"),
    }
}
