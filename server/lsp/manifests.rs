//! Tells the user what is wrong with the manifests of open documents: a message, and a diagnostic in the manifest.

use super::projects::canonical;
use super::to_proto::{Manner, Place};
use super::workspace::{Open, is_suite};
use crate::project::{MANIFEST_NAME, Manifest, Project};
use crate::scenario::Suite;
use crate::text::{LineColumn, Message};
use rustc_hash::{FxHashMap, FxHashSet};
use std::path::Path;
use std::sync::Arc;
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tower_lsp::Client;
use tower_lsp::ls_types::{Diagnostic, DiagnosticSeverity, MessageType, Position, Range, Uri};

/// The mistakes that were told, by manifest. Clones of a sender would not keep the order, so there is one of these.
#[derive(Default)]
pub(super) struct Manifests {
    told: FxHashMap<Uri, (Range, String)>,
    /// Those that the editor has open: their text wins over the disk, and whoever types needs no message on top.
    open: FxHashMap<Uri, Typed>,
    sender: Option<UnboundedSender<Notice>>,
}

/// A manifest that the editor has open.
struct Typed {
    path: Option<Arc<Path>>,
    /// Whether a mistake is shown in it.
    is_told: bool,
}

struct Notice {
    manifest: Uri,
    version: Option<i32>,
    diagnostics: Vec<Diagnostic>,
    message: Option<String>,
}

impl Manifests {
    /// Tells the mistake of `project` unless it was told before, or takes it back; returns its manifest.
    pub(super) fn note(&mut self, client: &Client, project: &Project, manner: Manner) -> Option<Uri> {
        let manifest = Uri::from_file_path(project.root.join(MANIFEST_NAME))?;
        let path = canonical(&project.root.join(MANIFEST_NAME));
        let is_open = self.open.values().any(|typed| typed.path.as_ref() == Some(&path));
        let Some(error) = project.error.as_ref().filter(|_| !is_open) else {
            self.take_back(client, &manifest);
            return Some(manifest);
        };
        let position = |offset| {
            let LineColumn { line, column } = project.position(offset, manner.encoding);
            Position::new(line, column)
        };
        let range = Range::new(position(error.span.start), position(error.span.end));
        let reason = error.message.render(manner.language);
        let mistake = (range, reason.clone());
        if self.told.get(&manifest) != Some(&mistake) {
            let message =
                Message::new("project.manifest").with("line", range.start.line + 1).with("reason", &reason);
            let diagnostics = vec![diagnostic(range, reason)];
            let message = Some(message.render(manner.language));
            self.send(client, Notice { manifest: manifest.clone(), version: None, diagnostics, message });
            self.told.insert(manifest.clone(), mistake);
        }
        Some(manifest)
    }

    /// Takes back what was told of all manifests but `seen`, which are those of open documents.
    pub(super) fn forget_others(&mut self, client: &Client, seen: &FxHashSet<Uri>) {
        let gone: Vec<Uri> = self.told.keys().filter(|manifest| !seen.contains(*manifest)).cloned().collect();
        gone.iter().for_each(|manifest| self.take_back(client, manifest));
    }

    fn take_back(&mut self, client: &Client, manifest: &Uri) {
        if self.told.remove(manifest).is_some() {
            self.send(client, Notice::nothing(manifest));
        }
    }

    /// The editor has a manifest: the disk has no say in it any more.
    pub(super) fn open(&mut self, client: &Client, manifest: &Uri, path: Option<&Arc<Path>>) {
        self.take_back(client, manifest);
        // One that is opened a second time was closed in the client's eyes; what is shown in it stays until it is read.
        let is_told = self.open.get(manifest).is_some_and(|typed| typed.is_told);
        self.open.insert(manifest.clone(), Typed { path: path.cloned(), is_told });
    }

    /// Tells the mistakes in the text of an open manifest or of scenario tests, or that there are none any more.
    pub(super) fn judge(&mut self, client: &Client, open: &Open, manner: Manner) {
        let text = open.document.text();
        let place = Place::new(&open.document, manner);
        let mistake = |message: Message, span| diagnostic(place.range(span), message.render(manner.language));
        let found = match is_suite(&open.uri) {
            true => Suite::read(&text).1.into_iter().map(|flaw| mistake(flaw.message, flaw.span)).collect(),
            false => {
                let error = Manifest::read(&text).err();
                error.into_iter().map(|error| mistake(error.message, error.span)).collect()
            }
        };
        self.show(client, open, found);
    }

    /// Shows this in an open document until its text changes.
    pub(super) fn show(&mut self, client: &Client, open: &Open, diagnostics: Vec<Diagnostic>) {
        let Some(typed) = self.open.get_mut(&open.uri) else { return };
        let was_told = std::mem::replace(&mut typed.is_told, !diagnostics.is_empty());
        if was_told || !diagnostics.is_empty() {
            let (manifest, version) = (open.uri.clone(), Some(open.version));
            self.send(client, Notice { manifest, version, diagnostics, message: None });
        }
    }

    /// The editor has a manifest no longer.
    pub(super) fn close(&mut self, client: &Client, manifest: &Uri) {
        if self.open.remove(manifest).is_some_and(|typed| typed.is_told) {
            self.send(client, Notice::nothing(manifest));
        }
    }

    /// One task sends all notices, so that they arrive in their order and nobody waits for the client.
    fn send(&mut self, client: &Client, notice: Notice) {
        let sender = self.sender.get_or_insert_with(|| {
            let (sender, mut receiver) = unbounded_channel::<Notice>();
            let client = client.clone();
            tokio::spawn(async move {
                while let Some(notice) = receiver.recv().await {
                    client.publish_diagnostics(notice.manifest, notice.diagnostics, notice.version).await;
                    if let Some(message) = notice.message {
                        client.show_message(MessageType::ERROR, message).await;
                    }
                }
            });
            sender
        });
        // The task lives as long as this sender.
        let _ = sender.send(notice);
    }
}

impl Notice {
    fn nothing(manifest: &Uri) -> Notice {
        Notice { manifest: manifest.clone(), version: None, diagnostics: Vec::new(), message: None }
    }
}

pub(super) fn diagnostic(range: Range, message: String) -> Diagnostic {
    Diagnostic {
        range,
        severity: Some(DiagnosticSeverity::ERROR),
        source: Some("rungwise".to_string()),
        message,
        ..Diagnostic::default()
    }
}
