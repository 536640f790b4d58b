//! One publisher for each open document: diagnostics of the newest version, never of an older one after it.
//!
//! Edits that come while one is worked on are taken together; nothing waits for a pause, except the batch tier,
//! whose findings follow when typing stops and until then move along with the text.

use super::settings::Settings;
use super::status::StatusNotification;
use super::to_proto::{self, Manner};
use super::workspace::Open;
use crate::check;
use crate::text::Diagnostic;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::watch;
use tokio::task::JoinHandle;
use tower_lsp::Client;
use tower_lsp::ls_types::Uri;

/// A batch run that takes longer than this waits for a pause in typing.
const AT_ONCE: Duration = Duration::from_micros(500);

/// A pause in typing.
const PAUSE: Duration = Duration::from_millis(120);

/// A document that is opened with more bytes than this shows what the real-time tier finds before the batch tier runs.
const LARGE_BYTES: usize = 256 << 10;

/// Sends what it is given to a task, which sees the newest only.
pub(super) struct Publisher {
    sender: watch::Sender<Order>,
    task: JoinHandle<()>,
}

#[derive(Clone, Default)]
enum Order {
    #[default]
    Nothing,
    Publish(Arc<Open>, Manner),
    Close(Uri),
}

/// What the task remembers.
struct Task {
    client: Client,
    manner: Manner,
    pushes: bool,
    /// The newest batch findings, and the document that they belong to.
    batch: Option<(Arc<Open>, Vec<Diagnostic>)>,
    batch_took: Duration,
    status: Option<StatusNotification>,
}

/// What both tiers found in one version.
struct Judged {
    realtime: Vec<Diagnostic>,
    batch: Vec<Diagnostic>,
    batch_took: Duration,
    status: Option<StatusNotification>,
}

impl Publisher {
    /// `before` is the end of the publisher that the document had when it was open before: what that one still has
    /// to say, the clearing at last, must not come after the first word of this one.
    pub(super) fn start(
        client: Client,
        manner: Manner,
        settings: &Settings,
        before: Option<JoinHandle<()>>,
    ) -> Publisher {
        let (sender, receiver) = watch::channel(Order::Nothing);
        let pushes = !settings.pulls();
        let task = Task { client, manner, pushes, batch: None, batch_took: Duration::ZERO, status: None };
        let task = tokio::spawn(async move {
            if let Some(before) = before {
                // One that failed has nothing to say any more either.
                let _ = before.await;
            }
            task.run(receiver).await;
        });
        Publisher { sender, task }
    }

    pub(super) fn publish(&self, open: Arc<Open>, manner: Manner) {
        self.sender.send_replace(Order::Publish(open, manner));
    }

    /// Clears what was published; the handle ends when that is done.
    pub(super) fn close(self, uri: Uri) -> JoinHandle<()> {
        self.sender.send_replace(Order::Close(uri));
        self.task
    }
}

impl Task {
    async fn run(mut self, mut receiver: watch::Receiver<Order>) {
        while receiver.changed().await.is_ok() {
            let order = receiver.borrow_and_update().clone();
            match order {
                Order::Nothing => {}
                Order::Publish(open, manner) => {
                    self.manner = manner;
                    self.publish(open, &mut receiver).await;
                }
                Order::Close(uri) => {
                    self.client.publish_diagnostics(uri, Vec::new(), None).await;
                    return;
                }
            }
        }
    }

    async fn publish(&mut self, open: Arc<Open>, receiver: &mut watch::Receiver<Order>) {
        // How long the batch run of a large document takes is not known when it is opened.
        let is_first = self.batch.is_none() && open.document.len() > LARGE_BYTES;
        if is_first || self.batch_took >= AT_ONCE {
            let realtime = self.find(&open, check::realtime).await;
            let mut diagnostics = self.carried(&open);
            diagnostics.extend(realtime);
            self.push(&open, diagnostics).await;
            let pause = if is_first { Duration::ZERO } else { PAUSE };
            match tokio::time::timeout(pause, receiver.changed()).await {
                Ok(Ok(())) => return receiver.mark_changed(),
                // Nobody is there any more to give orders.
                Ok(Err(_)) => return,
                Err(_) => {}
            }
        }
        let judged = self.judge(&open).await;
        self.batch_took = judged.batch_took;
        let mut diagnostics = judged.realtime;
        diagnostics.extend(judged.batch.iter().cloned());
        // What was shown first is all there is if the batch run found nothing.
        if !is_first || !judged.batch.is_empty() {
            self.push(&open, diagnostics).await;
        }
        let opened = self.batch.is_none().then(|| open.clone());
        self.batch = Some((open, judged.batch));
        self.tell_status(judged.status).await;
        if let Some(open) = opened {
            // The first hover or completion finds the names of all pages ready.
            tokio::task::spawn_blocking(move || {
                open.document.pages().iter().for_each(|page| _ = page.names())
            });
        }
    }

    /// Both tiers and the status, beside the other tasks; if one of them fails the log has it, and that one finds
    /// nothing.
    async fn judge(&self, open: &Arc<Open>) -> Judged {
        let own = open.clone();
        let judged = tokio::task::spawn_blocking(move || {
            let realtime = check::realtime(&own.document, &own.severities);
            let started = Instant::now();
            let batch = check::program(&own.document, &own.severities);
            let batch_took = started.elapsed();
            Judged { realtime, batch, batch_took, status: Some(StatusNotification::of(&own)) }
        });
        match judged.await {
            Ok(judged) => judged,
            Err(failure) => {
                tracing::error!("a check failed: {failure}");
                let realtime = self.find(open, check::realtime).await;
                let batch = self.find(open, check::program).await;
                Judged { realtime, batch, batch_took: AT_ONCE, status: None }
            }
        }
    }

    /// Runs `find` beside the other tasks; if it fails the log has it and nothing is found.
    async fn find(
        &self,
        open: &Arc<Open>,
        find: fn(&crate::document::Document, &check::Severities) -> Vec<Diagnostic>,
    ) -> Vec<Diagnostic> {
        let open = open.clone();
        let found = tokio::task::spawn_blocking(move || find(&open.document, &open.severities)).await;
        found.unwrap_or_else(|failure| {
            tracing::error!("a check failed: {failure}");
            Vec::new()
        })
    }

    /// The last batch findings, moved along with the text; those in changed text are dropped.
    fn carried(&self, open: &Open) -> Vec<Diagnostic> {
        let Some((old, batch)) = &self.batch else { return Vec::new() };
        let Some((before, after)) = open.document.changed_since(&old.document) else { return batch.clone() };
        let moved = batch.iter().filter_map(|diagnostic| {
            if diagnostic.span.end as usize <= before.start {
                Some(diagnostic.clone())
            } else if diagnostic.span.start as usize >= before.end {
                Some(diagnostic.moved(before.end, after.end))
            } else {
                None
            }
        });
        moved.collect()
    }

    async fn push(&self, open: &Open, diagnostics: Vec<Diagnostic>) {
        if self.pushes {
            let diagnostics = to_proto::diagnostics(open, check::sorted(diagnostics), self.manner);
            self.client.publish_diagnostics(open.uri.clone(), diagnostics, Some(open.version)).await;
        }
    }

    async fn tell_status(&mut self, status: Option<StatusNotification>) {
        if let Some(status) = status
            && self.status.as_ref() != Some(&status)
        {
            self.client.send_notification::<super::status::StatusMethod>(status.clone()).await;
            self.status = Some(status);
        }
    }
}
