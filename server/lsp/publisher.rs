//! One publisher for each open document: diagnostics of the newest version, never of an older one after it.
//!
//! Edits that come while one is worked on are taken together; nothing waits for a pause, except the batch tier,
//! whose findings follow when typing stops and until then move along with the text. A batch run that takes long shows
//! what it has found so far, and ends when the text moves on.

use super::keeper::Keeper;
use super::projects::Around;
use super::status::StatusNotification;
use super::to_proto::{self, Manner};
use super::workspace::{Open, Snapshot, Workspace};
use crate::check;
use crate::text::{Diagnostic, Span};
use rustc_hash::FxHashSet;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};
use tokio::sync::{Notify, mpsc, watch};
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

/// What is found at once is shown with what the whole run finds if that does not take longer than this,
const PATIENCE: Duration = Duration::from_millis(8);

/// and what is found later not more often than this.
const STREAMED: Duration = Duration::from_millis(150);

/// Sends what it is given to a task, which sees the newest only.
pub(super) struct Publisher {
    sender: watch::Sender<Order>,
    task: JoinHandle<()>,
    reopened: Arc<Notify>,
    looks: Arc<Looks>,
}

/// Which versions of a document the judgement of other files has seen.
///
/// Of edits in quick succession only the last is judged. What others saw of one between, they must be told to forget,
/// also if the last one shows them the same as the one before all of them.
#[derive(Default)]
struct Looks(Mutex<(i32, Vec<i32>)>);

impl Looks {
    fn state(&self) -> MutexGuard<'_, (i32, Vec<i32>)> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, version: i32) {
        let (judged, seen) = &mut *self.state();
        if version != *judged && !seen.contains(&version) {
            seen.push(version);
        }
    }

    /// The version is judged; whether others have seen one that was not.
    fn judged(&self, version: i32) -> bool {
        let (judged, seen) = &mut *self.state();
        *judged = version;
        std::mem::take(seen).into_iter().any(|seen| seen != version)
    }
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
    Publish(Arc<Open>, Manner),
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
    looks: Arc<Looks>,
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

/// What is found on the way.
enum News {
    /// All that the real-time tier finds.
    Realtime(Vec<Diagnostic>),
    /// The files that findings of the batch tier name by their numbers.
    Around(Around),
    /// Some of what the batch tier finds.
    Batch(Vec<Diagnostic>),
}

/// What is known of a version while it is judged.
#[derive(Default)]
struct Partial {
    realtime: Option<Vec<Diagnostic>>,
    around: Option<Around>,
    batch: Vec<Diagnostic>,
    has_news: bool,
}

impl Partial {
    fn take(&mut self, news: News) {
        match news {
            News::Around(around) => self.around = Some(around),
            News::Realtime(found) => {
                self.realtime = Some(found);
                self.has_news = true;
            }
            News::Batch(found) => {
                self.has_news |= !found.is_empty();
                self.batch.extend(found);
            }
        }
    }
}

/// What both tiers found in one version.
struct Judged {
    realtime: Vec<Diagnostic>,
    batch: Batch,
    batch_took: Duration,
    status: Option<StatusNotification>,
}

impl Batch {
    /// Runs the rules about whole programs over the files of the project as they are now. `is_first` says that
    /// nothing is known of this file yet. Nothing if it is cancelled.
    fn of(
        (snapshot, around): (&Snapshot, Around),
        own: &Arc<Open>,
        is_first: bool,
        tell: &dyn Fn(News),
    ) -> Option<Batch> {
        tell(News::Around(around.clone()));
        let found = check::batch(&around.view(), &own.severities, &mut |found| tell(News::Batch(found)))?;
        if around.files().len() == 1 {
            return Some(Batch { found, around, surface: None, surface_of_disk: None });
        }
        let on_disk = is_first.then(|| snapshot.on_disk(own)).flatten();
        let surface_of_disk = on_disk.map(|file| check::surface(&file.document));
        Some(Batch { found, around, surface: Some(check::surface(&own.document)), surface_of_disk })
    }
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
        let looks = Arc::new(Looks::default());
        let task = Task {
            workspace,
            client: client.clone(),
            reopened: reopened.clone(),
            manner: snapshot.manner,
            pushes: !snapshot.settings.pulls,
            batch: None,
            batch_took: Duration::ZERO,
            status: None,
            surface: None,
            looks: looks.clone(),
        };
        let task = tokio::spawn(async move {
            if let Some(before) = before {
                // One that failed has nothing to say any more either.
                let _ = before.await;
            }
            task.run(receiver).await;
        });
        Publisher { sender, task, reopened, looks }
    }

    /// The judgement of another file sees the document in this version.
    pub(super) fn note_look(&self, version: i32) {
        self.looks.note(version);
    }

    pub(super) fn publish(&self, open: Arc<Open>, manner: Manner) {
        self.sender.send_replace(Order::Publish(open, manner));
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
                Order::Publish(open, manner) => {
                    self.manner = manner;
                    self.publish(open, &mut receiver).await;
                }
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
        let mut shown = None;
        if self.batch_took >= AT_ONCE {
            let realtime = self.find(&open, check::realtime).await;
            shown = Some(self.push_partial(&open, &realtime, &Partial::default()).await);
            match tokio::time::timeout(PAUSE, receiver.changed()).await {
                Ok(Ok(())) => return receiver.mark_changed(),
                // Nobody is there any more to give orders.
                Ok(Err(_)) => return,
                Err(_) => {}
            }
        }
        let started = Instant::now();
        let Some(judged) = self.judge(&open, receiver, &mut shown).await else {
            if started.elapsed() > PATIENCE {
                self.batch_took = AT_ONCE;
            }
            return;
        };
        self.batch_took = judged.batch_took;
        let mut diagnostics = judged.realtime;
        diagnostics.extend(judged.batch.found.iter().cloned());
        let diagnostics = check::sorted(diagnostics);
        judged.batch.around.keep(diagnostics.clone());
        if shown.as_ref() != Some(&diagnostics) {
            self.push(&judged.batch.around, diagnostics).await;
        }
        self.tell_project(&open, &judged.batch);
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

    /// Both tiers and the status, beside the other tasks. What is known after a while is put into `shown` and pushed.
    /// Nothing if the text moves on: then what the real-time tier found is pushed, and the batch run ends. If a run
    /// fails the log has it, and its tier finds nothing.
    async fn judge(
        &mut self,
        open: &Arc<Open>,
        receiver: &mut watch::Receiver<Order>,
        shown: &mut Option<Vec<Diagnostic>>,
    ) -> Option<Judged> {
        let cancelled: Arc<AtomicBool> = Arc::default();
        let (sender, mut news) = mpsc::unbounded_channel();
        let mut run = self.start(open, &cancelled, sender);
        let mut partial = Partial::default();
        let mut next = tokio::time::Instant::now() + PATIENCE;
        let mut is_old = false;
        loop {
            tokio::select! {
                biased;
                changed = receiver.changed(), if !is_old => {
                    is_old = true;
                    cancelled.store(true, Relaxed);
                    if changed.is_ok() {
                        receiver.mark_changed();
                    }
                }
                told = news.recv(), if !news.is_closed() || !news.is_empty() => {
                    told.into_iter().for_each(|told| partial.take(told));
                }
                judged = &mut run => match judged {
                    Ok(judged) => return judged,
                    Err(failure) => {
                        tracing::error!("a check failed: {failure}");
                        return Some(self.judge_apart(open).await);
                    }
                },
                () = tokio::time::sleep_until(next), if partial.has_news && !is_old => {
                    if let Some(realtime) = partial.realtime.take() {
                        *shown = Some(self.push_partial(open, &realtime, &partial).await);
                        partial.realtime = Some(realtime);
                    }
                    partial.has_news = false;
                    next = tokio::time::Instant::now() + STREAMED;
                }
            }
            if is_old && let Some(realtime) = &partial.realtime {
                if shown.is_none() {
                    self.push_partial(open, realtime, &partial).await;
                }
                return None;
            }
        }
    }

    /// Starts both tiers on a thread of their own.
    fn start(
        &self,
        open: &Arc<Open>,
        cancelled: &Arc<AtomicBool>,
        news: mpsc::UnboundedSender<News>,
    ) -> JoinHandle<Option<Judged>> {
        let (workspace, own, is_first) = (self.workspace.clone(), open.clone(), self.surface.is_none());
        let cancelled = cancelled.clone();
        tokio::task::spawn_blocking(move || {
            // Nobody listens any more to what is found in an old text.
            let tell = |told| drop(news.send(told));
            let realtime = check::realtime(&own.document, &own.severities);
            tell(News::Realtime(realtime.clone()));
            let started = Instant::now();
            let snapshot = workspace.upgrade().map(|workspace| workspace.seen_by(&own)).unwrap_or_default();
            let around = snapshot.around(&own).cancellable(&cancelled);
            let batch = Batch::of((&snapshot, around), &own, is_first, &tell)?;
            let batch_took = started.elapsed();
            Some(Judged { realtime, batch, batch_took, status: Some(StatusNotification::of(&own)) })
        })
    }

    /// Each tier on a thread of its own, so that one finds what it can if the other fails.
    async fn judge_apart(&self, open: &Arc<Open>) -> Judged {
        let realtime = self.find(open, check::realtime).await;
        let found = self.find(open, check::program).await;
        let around = Around::alone(open);
        let batch = Batch { found, around, surface: None, surface_of_disk: None };
        Judged { realtime, batch, batch_took: AT_ONCE, status: None }
    }

    /// Has the other files of the project judged again if they see something new.
    fn tell_project(&mut self, open: &Open, batch: &Batch) {
        let known = self.surface.or(batch.surface_of_disk);
        let was_seen_between = self.looks.judged(open.version);
        let is_new = batch.surface.is_some() && (was_seen_between || known != batch.surface);
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

    /// Pushes what is known while a run goes on, and says what that is: what was found in the last run stays until this
    /// one is done.
    async fn push_partial(
        &self,
        open: &Arc<Open>,
        realtime: &[Diagnostic],
        partial: &Partial,
    ) -> Vec<Diagnostic> {
        let (mut diagnostics, around) = self.carried(open);
        let around = partial.around.as_ref().unwrap_or(&around);
        let known: FxHashSet<(Span, &str)> = diagnostics.iter().map(|one| (one.span, one.code)).collect();
        let new = partial.batch.iter().filter(|one| !known.contains(&(one.span, one.code)));
        let new: Vec<Diagnostic> = new.cloned().collect();
        diagnostics.extend(new);
        diagnostics.extend(realtime.iter().cloned());
        let diagnostics = check::sorted(diagnostics);
        self.push(around, diagnostics.clone()).await;
        diagnostics
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
            let diagnostics = to_proto::diagnostics(around, diagnostics, self.manner);
            self.client.publish_diagnostics(open.uri.clone(), diagnostics, Some(open.version)).await;
        }
    }

    async fn tell_status(&mut self, status: Option<StatusNotification>) {
        let (Some(status), Some(workspace)) = (status, self.workspace.upgrade()) else { return };
        let line = workspace.line.lock().await;
        let status = status.on(&line);
        if self.status.as_ref() != Some(&status) {
            self.client.send_notification::<super::status::StatusMethod>(status.clone()).await;
            self.status = Some(status);
        }
    }
}
