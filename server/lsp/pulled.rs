//! Diagnostics on demand: of a document, and of the whole workspace, with names for results so that nothing is sent
//! twice.

use super::progress::Progress;
use super::projects::Around;
use super::to_proto;
use super::workspace::Snapshot;
use crate::check;
use crate::text::Diagnostic as Found;
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};
use serde::{Deserialize, Serialize};
use std::hash::BuildHasher;
use std::path::Path;
use std::sync::Arc;
use tokio::sync::mpsc::UnboundedSender;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::*;

/// The name of a result: equal for equal content.
pub(super) fn result_id(items: &[Diagnostic]) -> String {
    format!("{:016x}", FxBuildHasher.hash_one(serde_json::to_string(items).unwrap_or_default()))
}

/// The report about one document.
pub(super) fn of_document(items: Vec<Diagnostic>, previous: Option<&str>) -> DocumentDiagnosticReportResult {
    let result_id = result_id(&items);
    let report = if previous == Some(result_id.as_str()) {
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

/// `$/progress` with a part of the result of `workspace/diagnostic`.
pub(super) enum PartialReport {}

impl Notification for PartialReport {
    type Params = PartialReportParams;
    const METHOD: &'static str = "$/progress";
}

/// The parameters.
#[derive(Serialize, Deserialize)]
pub(super) struct PartialReportParams {
    pub token: ProgressToken,
    pub value: WorkspaceDiagnosticReport,
}

/// The reports about all files of all projects, and about the open documents that belong to none.
///
/// Reports go to `parts` project by project if there is such a channel, else they are returned together.
pub(super) fn of_workspace(
    snapshot: &Snapshot,
    previous: Vec<PreviousResultId>,
    parts: Option<&UnboundedSender<WorkspaceDiagnosticReport>>,
    progress: &Progress,
    is_cancelled: impl Fn() -> bool,
) -> WorkspaceDiagnosticReport {
    #[allow(clippy::mutable_key_type, reason = "a URI is compared by its text")]
    let mut known: FxHashMap<Uri, String> = previous.into_iter().map(|one| (one.uri, one.value)).collect();
    let mut all = Vec::new();
    let mut report = |items: Vec<WorkspaceDocumentDiagnosticReport>| match parts {
        // The handler outlives the work; if it does not, nobody wants the parts.
        Some(parts) => _ = parts.send(WorkspaceDiagnosticReport { items }),
        None => all.extend(items),
    };
    let mut seen: FxHashSet<Arc<Path>> = FxHashSet::default();
    let projects: Vec<&Arc<Path>> = match snapshot.settings.whole_project {
        true => snapshot.projects.keys().collect(),
        false => Vec::new(),
    };
    for (number, key) in projects.iter().enumerate() {
        if is_cancelled() {
            break;
        }
        progress.report(number, projects.len());
        let Some(around) = snapshot.project(key) else { continue };
        let severities = around.here().severities.clone();
        let found = check::project(&around.view(), &severities);
        seen.extend(around.files().iter().filter_map(|file| file.path.clone()));
        let of_file = |(number, found)| Some(of_file(&around.from(number)?, found, snapshot, &mut known));
        report((0..).zip(found).filter_map(of_file).collect());
    }
    let alone = snapshot.opens().filter(|open| open.path.as_ref().is_none_or(|path| !seen.contains(path)));
    let alone: Vec<_> = alone.cloned().collect();
    for open in alone.iter().take_while(|_| !is_cancelled()) {
        let around = snapshot.around(open);
        let findings = around.findings();
        report(vec![of_file(&around, findings.to_vec(), snapshot, &mut known)]);
    }
    // What the client still shows about files that are no more.
    let gone = known.into_keys().map(|uri| full(uri, None, Vec::new()));
    report(gone.collect());
    WorkspaceDiagnosticReport { items: all }
}

fn of_file(
    around: &Around,
    found: Vec<Found>,
    snapshot: &Snapshot,
    #[allow(clippy::mutable_key_type, reason = "a URI is compared by its text")] known: &mut FxHashMap<
        Uri,
        String,
    >,
) -> WorkspaceDocumentDiagnosticReport {
    let open = around.here();
    let items = to_proto::diagnostics(around, found, snapshot.manner);
    let version = open.is_open.then_some(i64::from(open.version));
    let result_id = result_id(&items);
    if known.remove(&open.uri).as_deref() == Some(result_id.as_str()) {
        return WorkspaceDocumentDiagnosticReport::Unchanged(WorkspaceUnchangedDocumentDiagnosticReport {
            uri: open.uri.clone(),
            version,
            unchanged_document_diagnostic_report: UnchangedDocumentDiagnosticReport { result_id },
        });
    }
    full(open.uri.clone(), version, items)
}

fn full(uri: Uri, version: Option<i64>, items: Vec<Diagnostic>) -> WorkspaceDocumentDiagnosticReport {
    let result_id = Some(result_id(&items));
    WorkspaceDocumentDiagnosticReport::Full(WorkspaceFullDocumentDiagnosticReport {
        uri,
        version,
        full_document_diagnostic_report: FullDocumentDiagnosticReport { result_id, items },
    })
}
