//! Tells the user what is wrong with the manifests of open documents: a message, and a diagnostic in the manifest.

use super::to_proto::Manner;
use crate::project::{MANIFEST_NAME, Project};
use crate::text::{LineColumn, Message};
use rustc_hash::{FxHashMap, FxHashSet};
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tower_lsp::Client;
use tower_lsp::ls_types::{Diagnostic, DiagnosticSeverity, MessageType, Position, Range, Uri};

/// The mistakes that were told, by manifest. Clones of a sender would not keep the order, so there is one of these.
#[derive(Default)]
pub(super) struct Manifests {
    told: FxHashMap<Uri, (Range, String)>,
    sender: Option<UnboundedSender<Notice>>,
}

struct Notice {
    manifest: Uri,
    diagnostics: Vec<Diagnostic>,
    message: Option<String>,
}

impl Manifests {
    /// Tells the mistake of `project` unless it was told before, or takes it back; returns its manifest.
    pub(super) fn note(&mut self, client: &Client, project: &Project, manner: Manner) -> Option<Uri> {
        let manifest = Uri::from_file_path(project.root.join(MANIFEST_NAME))?;
        let Some(error) = &project.error else {
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
            let diagnostic = Diagnostic {
                range,
                severity: Some(DiagnosticSeverity::ERROR),
                source: Some("rungwise".to_string()),
                message: reason,
                ..Diagnostic::default()
            };
            let message = Some(message.render(manner.language));
            self.send(client, Notice { manifest: manifest.clone(), diagnostics: vec![diagnostic], message });
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
            let notice = Notice { manifest: manifest.clone(), diagnostics: Vec::new(), message: None };
            self.send(client, notice);
        }
    }

    /// One task sends all notices, so that they arrive in their order and nobody waits for the client.
    fn send(&mut self, client: &Client, notice: Notice) {
        let sender = self.sender.get_or_insert_with(|| {
            let (sender, mut receiver) = unbounded_channel::<Notice>();
            let client = client.clone();
            tokio::spawn(async move {
                while let Some(notice) = receiver.recv().await {
                    client.publish_diagnostics(notice.manifest, notice.diagnostics, None).await;
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
