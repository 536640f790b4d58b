//! Work-done progress: what takes long says how far it is, where the client shows that.

use super::workspace::Workspace;
use crate::text::Message;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tower_lsp::Client;
use tower_lsp::ls_types::notification::Progress as ProgressNotification;
use tower_lsp::ls_types::{
    NumberOrString, ProgressParams, ProgressParamsValue, WorkDoneProgress, WorkDoneProgressBegin,
    WorkDoneProgressEnd, WorkDoneProgressReport,
};

/// Work that is done sooner shows nothing.
const SHOWN_AFTER: Duration = Duration::from_millis(300);

/// Reports of work; silent where the client shows none. Its end, or its being dropped, ends what the client shows.
pub(super) struct Progress {
    reports: Option<UnboundedSender<Reported>>,
    last: Mutex<Reported>,
}

/// How far something is.
#[derive(Clone, PartialEq, Eq, Default)]
struct Reported {
    percentage: u32,
    /// The same in words.
    message: Option<String>,
}

static NEXT_TOKEN: AtomicI32 = AtomicI32::new(1);

impl Progress {
    /// Shows nothing.
    pub(super) fn silent() -> Progress {
        Progress { reports: None, last: Mutex::default() }
    }

    /// Reports to the token that the client sent with a request.
    pub(super) fn of_request(client: &Client, token: Option<NumberOrString>, title: String) -> Progress {
        match token {
            Some(token) => Progress::start(client.clone(), token, title, false),
            None => Progress::silent(),
        }
    }

    /// Asks the client for a place to show work that it did not order; the work goes on meanwhile.
    fn of_server(client: &Client, title: String) -> Progress {
        let token = NEXT_TOKEN.fetch_add(1, Ordering::Relaxed);
        Progress::start(client.clone(), NumberOrString::String(format!("rungwise-{token}")), title, true)
    }

    fn start(client: Client, token: NumberOrString, title: String, asks: bool) -> Progress {
        let (sender, mut receiver) = unbounded_channel::<Reported>();
        tokio::spawn(async move {
            let mut first = None;
            if asks {
                // Short work is over before anybody could read of it.
                let waited = tokio::time::timeout(SHOWN_AFTER, async {
                    while let Some(reported) = receiver.recv().await {
                        first = Some(reported);
                    }
                });
                if waited.await.is_ok() || client.create_work_done_progress(token.clone()).await.is_err() {
                    return;
                }
            }
            let first = first.unwrap_or_default();
            let begin = WorkDoneProgressBegin {
                title,
                cancellable: Some(false),
                message: first.message,
                percentage: Some(first.percentage),
            };
            send(&client, &token, WorkDoneProgress::Begin(begin)).await;
            while let Some(Reported { percentage, message }) = receiver.recv().await {
                let report =
                    WorkDoneProgressReport { percentage: Some(percentage), message, cancellable: None };
                send(&client, &token, WorkDoneProgress::Report(report)).await;
            }
            send(&client, &token, WorkDoneProgress::End(WorkDoneProgressEnd::default())).await;
        });
        Progress { reports: Some(sender), last: Mutex::default() }
    }

    /// `done` of `total` parts are done.
    pub(super) fn report(&self, done: usize, total: usize) {
        self.report_in_words(done, total, || None);
    }

    /// The same, and what `message` says of it, which nobody asks where nothing is shown.
    pub(super) fn report_in_words(
        &self,
        done: usize,
        total: usize,
        message: impl FnOnce() -> Option<String>,
    ) {
        let Some(reports) = &self.reports else { return };
        let percentage = (done * 100 / total.max(1)).min(100) as u32;
        let reported = Reported { percentage, message: message() };
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if *last != reported {
            last.clone_from(&reported);
            // The task outlives this sender.
            let _ = reports.send(reported);
        }
    }
}

async fn send(client: &Client, token: &NumberOrString, progress: WorkDoneProgress) {
    let value = ProgressParamsValue::WorkDone(progress);
    client.send_notification::<ProgressNotification>(ProgressParams { token: token.clone(), value }).await;
}

impl Workspace {
    /// Progress of work that the server does of its own accord.
    pub(super) async fn progress(&self, title: Message) -> Progress {
        match self.requests().progress {
            true => Progress::of_server(&self.client, title.render(self.snapshot().manner.language)),
            false => Progress::silent(),
        }
    }
}
