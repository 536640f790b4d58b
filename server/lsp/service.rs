//! The ordering service: state changes in message order, requests on tasks of their own.
//!
//! The protocol library polls all handlers on one task and starts them in any order once one awaits. Here
//! notifications that change documents are applied while the message is taken in, before the next is read; a request
//! gets the snapshot of that moment and runs beside all others, so neither stale answers nor a slow neighbour occur.

use super::backend::Backend;
use super::workspace::{SNAPSHOT, Workspace};
use std::future::Future;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use tower::Service;
use tower_lsp::jsonrpc::{Error, Request, Response};
use tower_lsp::{ExitedError, LspService};

/// The service around the library's own.
pub(super) struct Ordered {
    inner: LspService<Backend>,
    workspace: Arc<Workspace>,
}

type Answer = Pin<Box<dyn Future<Output = Result<Option<Response>, ExitedError>> + Send>>;

impl Ordered {
    pub(super) fn new(inner: LspService<Backend>, workspace: Arc<Workspace>) -> Ordered {
        Ordered { inner, workspace }
    }
}

impl Service<Request> for Ordered {
    type Response = Option<Response>;
    type Error = ExitedError;
    type Future = Answer;

    fn poll_ready(&mut self, context: &mut Context<'_>) -> Poll<Result<(), ExitedError>> {
        // The library is not ready while it initialises, which would hold up the reading of `$/cancelRequest`;
        // it refuses early requests by itself.
        match self.inner.poll_ready(context) {
            Poll::Pending => Poll::Ready(Ok(())),
            ready => ready,
        }
    }

    fn call(&mut self, request: Request) -> Answer {
        self.workspace.note_method(request.method());
        if self.workspace.apply(request.method(), request.params()) {
            return Box::pin(std::future::ready(Ok(None)));
        }
        let is_lifecycle = matches!(request.method(), "initialize" | "initialized" | "shutdown" | "exit");
        let id = request.id().cloned();
        let answer = self.inner.call(request);
        if is_lifecycle {
            return Box::pin(answer);
        }
        let snapshot = self.workspace.snapshot();
        let task = tokio::spawn(SNAPSHOT.scope(snapshot, answer));
        Box::pin(async move {
            task.await.unwrap_or_else(|failure| {
                tracing::error!("a request failed: {failure}");
                Ok(id.map(|id| Response::from_error(id, Error::internal_error())))
            })
        })
    }
}
