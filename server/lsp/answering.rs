//! How handlers answer: from the snapshot of their request, at once or on a thread of their own.

use super::projects::Around;
use super::settings::Settings;
use super::to_proto::Place;
use super::workspace::{Open, SNAPSHOT, Snapshot, is_toml};
use crate::text::Message;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::Uri;

/// The state at the moment when the request was read.
pub(super) fn snapshot() -> Snapshot {
    SNAPSHOT.with(Clone::clone)
}

/// The settings at that moment.
pub(super) fn settings() -> Arc<Settings> {
    SNAPSHOT.with(|snapshot| snapshot.settings.clone())
}

/// The answer about an open program; nothing for what is not open or is none.
pub(super) fn with_open<T>(uri: &Uri, answer: impl FnOnce(&Open, Place<'_>) -> Option<T>) -> Option<T> {
    let snapshot = snapshot();
    let open = snapshot.program(uri)?;
    answer(open, Place::new(&open.document, snapshot.manner))
}

/// The same with the files of its project.
pub(super) fn with_around<T>(uri: &Uri, answer: impl FnOnce(&Around, Place<'_>) -> Option<T>) -> Option<T> {
    let snapshot = snapshot();
    let around = snapshot.around(snapshot.program(uri)?);
    answer(&around, Place::new(&around.here().document, snapshot.manner))
}

/// The same for answers that walk the whole document or other files: they run on a thread of their own, and the trees
/// that they read go away with them.
pub(super) async fn whole<T: Send + 'static>(
    uri: Uri,
    answer: impl FnOnce(&Around, Place<'_>) -> T + Send + 'static,
) -> Result<Option<T>> {
    aside(uri, move |around, place| answer(around, Place { document: &place.document.lean(), ..place })).await
}

/// The same on a thread of its own, for answers that look at much of a document but read no trees.
pub(super) async fn aside<T: Send + 'static>(
    uri: Uri,
    answer: impl FnOnce(&Around, Place<'_>) -> T + Send + 'static,
) -> Result<Option<T>> {
    let snapshot = snapshot();
    beside(move |cancelled| {
        // What was named by an answer of before, such as a call in a file that is not open, is a file of a project.
        let around = match snapshot.open(&uri) {
            Some(open) if is_toml(&open.uri) => return None,
            Some(open) => snapshot.around(open),
            None => snapshot.around_closed(&uri)?,
        };
        let around = around.cancellable(cancelled);
        Some(answer(&around, Place::new(&around.here().document, snapshot.manner)))
    })
    .await
}

/// Sets its flag when the handler that has it is dropped: the request was cancelled.
struct Waiting(Arc<AtomicBool>);

impl Drop for Waiting {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Work on a thread of its own, with the flag that tells it that nobody waits any more.
pub(super) async fn beside<T: Send + 'static>(
    work: impl FnOnce(&Arc<AtomicBool>) -> Option<T> + Send + 'static,
) -> Result<Option<T>> {
    let waiting = Waiting(Arc::default());
    let cancelled = waiting.0.clone();
    let done = tokio::task::spawn_blocking(move || {
        // Cancelled while all threads were busy.
        if cancelled.load(Ordering::Relaxed) { None } else { work(&cancelled) }
    });
    done.await.map_err(|failure| {
        tracing::error!("a request failed: {failure}");
        Error::internal_error()
    })
}

/// What is wrong with the argument of a command.
pub(super) fn wrong_argument(command: &str, reason: impl ToString) -> Message {
    Message::new("translating.argument").with("command", command).with("reason", reason.to_string())
}

/// A refusal that the editor shows to the user.
pub(super) fn refused(message: Message) -> Error {
    let language = SNAPSHOT.with(|snapshot| snapshot.manner.language);
    Error::invalid_params(message.render(language))
}
