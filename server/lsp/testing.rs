//! `rungwise.test.…`: scenario tests in the editor.
//!
//! Commands (`workspace/executeCommand`), each with one argument, an object:
//!
//! ```text
//! rungwise.test.list { uri? }    // a file with scenarios, or a program: those beside it that are about it;
//!                                // all of the workspace where it is left out
//! → { files: { uri, program: uri[], scenarios: { name, range }[], problems: Problem[] }[] }
//!
//! rungwise.test.run { uri, names?: string[], coverage?: boolean, update?: boolean, show?: boolean }
//! → { files: { uri, program: uri[], problems: Problem[], golden: { uri, text }[],
//!       scenarios: { name, range, passed, scans, picture?,
//!         failures: { message, range, scan, time_ms, name?, expected?, actual?, program?: { uri, range } }[] }[],
//!       coverage?: { uri, rungs: { range, evaluated,
//!         contacts: { name, range, on, off, decided_on, decided_off, decidable }[] }[] }[] }[],
//!     passed, failed }
//!
//! Problem: { uri, range, message }   // a mistake in the file, or what keeps the program from running
//! ```
//!
//! Programs and files are run as the editor has them, saved or not. With `update` the golden traces that are otherwise
//! come back as text, for the client to write. With `show` the server itself tells what came of it, in a message and in
//! the file with the scenarios: that is what its lenses ask for, in clients that know nothing of tests.

mod subject;

mod told;

use super::answering::{beside, refused, snapshot, wrong_argument};
use super::manifests;
use super::projects::{Around, file_path};
use super::settings::Settings;
use super::to_proto::Place;
use super::workspace::{Snapshot, Workspace, is_suite};
use crate::project::suite_files;
use crate::scenario::{Report, Suite};
use crate::text::Message;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use subject::{SuiteText, suites_about};
use told::Run;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{CodeLens, Command, LSPAny, MessageType, Uri};

/// What both commands begin with.
pub(super) const PREFIX: &str = "rungwise.test.";
/// Lists scenarios.
pub(super) const LIST: &str = "rungwise.test.list";
/// Runs scenarios.
pub(super) const RUN: &str = "rungwise.test.run";

/// The argument of either.
#[derive(Clone, Debug, Deserialize)]
struct Asked {
    uri: Option<Uri>,
    names: Option<Vec<String>>,
    #[serde(default)]
    coverage: bool,
    #[serde(default)]
    update: bool,
    #[serde(default)]
    show: bool,
}

/// Answers a command.
pub(super) async fn answer(
    command: &str,
    argument: Option<&Value>,
    workspace: &Arc<Workspace>,
) -> Result<Option<LSPAny>> {
    let wrong = |reason: String| refused(wrong_argument(command, reason));
    let none = json!({});
    let asked = Asked::deserialize(argument.unwrap_or(&none)).map_err(|reason| wrong(reason.to_string()))?;
    let snapshot = snapshot();
    if command == LIST {
        let folders: Vec<PathBuf> = workspace.state().folders.iter().map(|(_, path)| path.clone()).collect();
        return beside(move |_| Some(list(&snapshot, asked.uri.as_ref(), &folders))).await;
    }
    if command != RUN {
        return Err(refused(Message::new("request.no-command").with("command", command)));
    }
    let uri = asked.uri.clone().ok_or_else(|| wrong("uri".to_string()))?;
    let (seen, wanted) = (snapshot.clone(), asked.clone());
    let runs = beside(move |cancelled| {
        let suites = suites_of(&seen, &uri);
        let run = |suite: SuiteText| {
            Run::of(&seen, suite, &wanted.names, (wanted.coverage, wanted.update), cancelled)
        };
        Some(suites.into_iter().map(run).collect::<Vec<Run>>())
    });
    let runs = runs.await?.unwrap_or_default();
    let count = |is_passed: bool| runs.iter().map(|run| run.count(is_passed)).sum::<usize>();
    let (passed, failed) = (count(true), count(false));
    if asked.show {
        show(&runs, (passed, failed), &snapshot, workspace);
    }
    let files: Vec<Value> = runs.iter().map(|run| run.json(snapshot.manner)).collect();
    Ok(Some(json!({ "files": files, "passed": passed, "failed": failed })))
}

/// The files with scenarios at an address: it itself, or those about a program.
fn suites_of(snapshot: &Snapshot, uri: &Uri) -> Vec<SuiteText> {
    match is_suite(uri) {
        true => SuiteText::at(snapshot, uri).into_iter().collect(),
        false => suites_about(snapshot, uri),
    }
}

fn list(snapshot: &Snapshot, uri: Option<&Uri>, folders: &[PathBuf]) -> Value {
    let suites = match uri {
        Some(uri) => suites_of(snapshot, uri),
        None => {
            let on_disk =
                folders.iter().flat_map(|folder| suite_files(folder)).filter_map(Uri::from_file_path);
            let open = snapshot.opens().map(|open| open.uri.clone()).filter(is_suite);
            let all: BTreeSet<String> = on_disk.chain(open).map(|uri| uri.to_string()).collect();
            let uris = all.into_iter().filter_map(|uri| uri.parse().ok());
            uris.filter_map(|uri: Uri| SuiteText::at(snapshot, &uri)).collect()
        }
    };
    let files: Vec<Value> = suites.iter().map(|suite| told::listed(snapshot, suite)).collect();
    json!({ "files": files })
}

/// Tells the user what came of a run: in a message, and where it went wrong.
fn show(runs: &[Run], (passed, failed): (usize, usize), snapshot: &Snapshot, workspace: &Arc<Workspace>) {
    let language = snapshot.manner.language;
    for run in runs {
        let Some(open) = snapshot.open(&run.suite.uri) else { continue };
        let place = Place::new(&run.suite.document, snapshot.manner);
        let found = run.wrong().into_iter();
        let found =
            found.map(|(span, message)| manifests::diagnostic(place.range(span), message.render(language)));
        workspace.state().manifests.show(&workspace.client, open, found.collect());
    }
    let problem = runs.iter().find_map(Run::problem);
    let (kind, message) = match problem {
        Some(message) => (MessageType::ERROR, message),
        None if failed == 0 && passed == 0 => (MessageType::WARNING, Message::new("cli.no-suites")),
        None => {
            let first = runs.iter().find_map(Run::first_failure);
            let kind = if first.is_some() { MessageType::ERROR } else { MessageType::INFO };
            let message = match first {
                Some(reason) => Message::new("test.summary-because").with_messages("reason", vec![reason]),
                None => Message::new("test.summary"),
            };
            (kind, message.with("passed", passed).with("failed", failed))
        }
    };
    let (client, text) = (workspace.client.clone(), message.render(language));
    // The client may be slow; no handler waits for it.
    tokio::spawn(async move { client.show_message(kind, text).await });
}

/// Whether there are scenarios about the program that is looked at.
pub(super) fn has_tests(snapshot: &Snapshot, around: &Around) -> bool {
    file_path(&around.here().uri).is_some() && !suites_about(snapshot, &around.here().uri).is_empty()
}

/// The lenses of a file with scenarios: one above each, and one above the first line for all of them.
pub(super) fn lenses(uri: &Uri, settings: &Settings) -> Option<Vec<CodeLens>> {
    let snapshot = snapshot();
    let open = snapshot.open(uri).filter(|_| settings.run_lenses)?;
    let place = Place::new(&open.document, snapshot.manner);
    let (suite, _) = Suite::read(&open.document.text());
    let lens = |span, title: &'static str, names: Value| {
        let mut argument = json!({ "uri": uri, "show": true });
        if !names.is_null() {
            argument["names"] = names;
        }
        let title = Message::new(title).render(place.language);
        let command = Command { title, command: RUN.to_string(), arguments: Some(vec![argument]) };
        CodeLens { range: place.range(span), command: Some(command), data: None }
    };
    let first = crate::text::Span::at(0);
    let all = (suite.scenarios.len() > 1).then(|| lens(first, "lens.run-all", Value::Null));
    let each = suite.scenarios.iter().map(|scenario| lens(scenario.span, "lens.run", json!([scenario.name])));
    Some(all.into_iter().chain(each).collect())
}

/// Whether a report is a success.
fn is_passed(report: &Option<Report>) -> bool {
    report.as_ref().is_some_and(Report::is_passed)
}
