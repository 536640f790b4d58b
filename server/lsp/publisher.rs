//! One publisher for each open document: diagnostics of the newest version, never of an older one after it.
//!
//! Edits that come while one is worked on are taken together; nothing waits for a pause, except the batch tier,
//! whose findings follow when typing stops and until then move along with the text.

use super::keeper::Keeper;
use super::projects::Around;
use super::status::StatusNotification;
use super::to_proto::{self, Manner};
use super::workspace::{Open, Snapshot, Workspace};
use crate::check;
use crate::text::Diagnostic;
use std::path::Path;
use std::sync::{Arc, Weak};
use std::time::{Duration, Instant};
use tokio::sync::{Notify, watch};
use tokio::task::JoinHandle;
use tower_lsp::Client;
use tower_lsp::ls_types::Uri;

/// A batch run that takes longer than this waits for a pause in typing.
const AT_ONCE: Duration = Duration::from_micros(500);

/// A pause in typing.
const PAUSE: Duration = Duration::from_millis(120);

/// What was published about a closed document stays so long for an editor that opens it again at once, as it does to
/// give it another language.
const REOPENED: Duration = Duration::from_millis(40);

/// Sends what it is given to a task, which sees the newest only.
pub(super) struct Publisher {
    sender: watch::Sender<Order>,
    task: JoinHandle<()>,
    reopened: Arc<Notify>,
}

/// A publisher that has its last word still to say.
pub(super) struct Closing {
    task: JoinHandle<()>,
    reopened: Arc<Notify>,
}

/// Who publishes about the file of a closed document.
type Heir = Option<(Keeper, Arc<Path>)>;

#[derive(Clone, Default)]
enum Order {
    #[default]
    Nothing,
    Publish(Arc<Open>),
    Close(Uri, Heir),
}

/// What the task remembers.
struct Task {
    workspace: Weak<Workspace>,
    client: Client,
    reopened: Arc<Notify>,
    manner: Manner,
    pushes: bool,
    /// The newest batch findings, and the document that they belong to.
    batch: Option<(Arc<Open>, Batch)>,
    batch_took: Duration,
    status: Option<StatusNotification>,
    /// What the other files of the project saw of the document last.
    surface: Option<u64>,
}

/// What the rules about whole programs found.
#[derive(Clone)]
struct Batch {
    found: Vec<Diagnostic>,
    /// The files that the findings name by their numbers.
    around: Around,
    /// What other files see of this one, if there are any.
    surface: Option<u64>,
    /// The same of the file on the disk, where it was asked for.
    surface_of_disk: Option<u64>,
}

impl Publisher {
    /// `before` is the end of the publisher that the document had when it was open before: what that one still has
    /// to say, the clearing at last, must not come after the first word of this one.
    pub(super) fn start(
        workspace: Weak<Workspace>,
        client: &Client,
        snapshot: &Snapshot,
        before: Option<JoinHandle<()>>,
    ) -> Publisher {
        let (sender, receiver) = watch::channel(Order::Nothing);
        let reopened = Arc::new(Notify::new());
        let task = Task {
            workspace,
            client: client.clone(),
            reopened: reopened.clone(),
            manner: snapshot.manner,
            pushes: !snapshot.settings.pulls(),
            batch: None,
            batch_took: Duration::ZERO,
            status: None,
            surface: None,
        };
        let task = tokio::spawn(async move {
            if let Some(before) = before {
                // One that failed has nothing to say any more either.
                let _ = before.await;
            }
            task.run(receiver).await;
        });
        Publisher { sender, task, reopened }
    }

    pub(super) fn publish(&self, open: Arc<Open>) {
        self.sender.send_replace(Order::Publish(open));
    }

    /// Clears what was published, unless an heir goes on.
    pub(super) fn close(self, uri: Uri, heir: Heir) -> Closing {
        self.sender.send_replace(Order::Close(uri, heir));
        Closing { task: self.task, reopened: self.reopened }
    }
}

impl Closing {
    /// Whether the last word is said.
    pub(super) fn is_done(&self) -> bool {
        self.task.is_finished()
    }

    /// The document is open again: nothing is cleared that is not cleared yet. The handle ends when nothing more comes.
    pub(super) fn superseded(self) -> JoinHandle<()> {
        self.reopened.notify_one();
        self.task
    }
}

impl Task {
    async fn run(mut self, mut receiver: watch::Receiver<Order>) {
        while receiver.changed().await.is_ok() {
            let order = receiver.borrow_and_update().clone();
            match order {
                Order::Nothing => {}
                Order::Publish(open) => self.publish(open, &mut receiver).await,
                Order::Close(uri, heir) => return self.close(uri, heir).await,
            }
        }
    }

    async fn close(self, uri: Uri, heir: Heir) {
        if tokio::time::timeout(REOPENED, self.reopened.notified()).await.is_ok() {
            return;
        }
        match heir {
            Some((keeper, key)) => keeper.closed(key, uri),
            None => self.client.publish_diagnostics(uri, Vec::new(), None).await,
        }
    }

    async fn publish(&mut self, open: Arc<Open>, receiver: &mut watch::Receiver<Order>) {
        let at_once = self.batch_took < AT_ONCE;
        if !at_once {
            let realtime = self.find(&open, check::realtime).await;
            let (mut diagnostics, around) = self.carried(&open);
            diagnostics.extend(realtime);
            self.push(&around, diagnostics).await;
            match tokio::time::timeout(PAUSE, receiver.changed()).await {
                Ok(Ok(())) => return receiver.mark_changed(),
                // Nobody is there any more to give orders.
                Ok(Err(_)) => return,
                Err(_) => {}
            }
        }
        let started = Instant::now();
        let batch = self.find_batch(&open).await;
        self.batch_took = started.elapsed();
        let mut diagnostics = self.find(&open, check::realtime).await;
        diagnostics.extend(batch.found.iter().cloned());
        self.push(&batch.around, diagnostics).await;
        self.tell_status(&open).await;
        self.tell_project(&open, &batch);
        self.batch = Some((open, batch));
    }

    /// Runs the rules about whole programs beside the other tasks, over all files of the project as they are now.
    async fn find_batch(&self, open: &Arc<Open>) -> Batch {
        let (workspace, own) = (self.workspace.clone(), open.clone());
        let is_first = self.surface.is_none();
        let work = tokio::task::spawn_blocking(move || {
            let snapshot = workspace.upgrade().map(|workspace| workspace.snapshot()).unwrap_or_default();
            let around = snapshot.around(&own);
            let is_alone = around.files().len() == 1;
            let found = match is_alone {
                true => check::program(&own.document, &own.severities),
                false => check::within_project(&around.view(), &own.severities),
            };
            let surface = (!is_alone).then(|| check::surface(&own.document));
            let on_disk = is_first.then(|| snapshot.on_disk(&own)).flatten();
            let surface_of_disk = on_disk.map(|file| check::surface(&file.document));
            Batch { found, around, surface, surface_of_disk }
        });
        work.await.unwrap_or_else(|failure| {
            tracing::error!("a check failed: {failure}");
            Batch { found: Vec::new(), around: Around::alone(open), surface: None, surface_of_disk: None }
        })
    }

    /// Has the other files of the project judged again if they see something new.
    fn tell_project(&mut self, open: &Open, batch: &Batch) {
        let known = self.surface.or(batch.surface_of_disk);
        let is_new = batch.surface.is_some() && known != batch.surface;
        self.surface = batch.surface;
        if let (true, Some(key), Some(workspace)) = (is_new, &open.project, self.workspace.upgrade()) {
            workspace.note_change(key, &open.uri);
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
    fn carried(&self, open: &Arc<Open>) -> (Vec<Diagnostic>, Around) {
        let Some((old, batch)) = &self.batch else { return (Vec::new(), Around::alone(open)) };
        let around = batch.around.with_here(open);
        let Some((before, after)) = open.document.changed_since(&old.document) else {
            return (batch.found.clone(), around);
        };
        let moved = batch.found.iter().filter_map(|diagnostic| {
            if diagnostic.span.end as usize <= before.start {
                Some(diagnostic.clone())
            } else if diagnostic.span.start as usize >= before.end {
                Some(diagnostic.moved(before.end, after.end))
            } else {
                None
            }
        });
        (moved.collect(), around)
    }

    async fn push(&self, around: &Around, diagnostics: Vec<Diagnostic>) {
        if self.pushes {
            let open = around.here();
            let diagnostics = to_proto::diagnostics(around, check::sorted(diagnostics), self.manner);
            self.client.publish_diagnostics(open.uri.clone(), diagnostics, Some(open.version)).await;
        }
    }

    async fn tell_status(&mut self, open: &Arc<Open>) {
        let open = open.clone();
        // As a check it counts on a thread of its own, where a failure does not end the publisher.
        let Ok(status) = tokio::task::spawn_blocking(move || StatusNotification::of(&open)).await else {
            return;
        };
        if self.status.as_ref() != Some(&status) {
            self.client.send_notification::<super::status::StatusMethod>(status.clone()).await;
            self.status = Some(status);
        }
    }
}
