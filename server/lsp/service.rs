//! The ordering service: state changes in message order, requests on tasks of their own.
//!
//! The protocol library polls all handlers on one task and starts them in any order once one awaits. Here
//! notifications that change documents are applied while the message is taken in, before the next is read; a request
//! gets the snapshot of that moment and runs beside all others, so neither stale answers nor a slow neighbour occur.
//! What a simulation is told is handed over before the next message is read, too, and answered when it is done.

use super::simulation;
use super::workspace::{SNAPSHOT, Workspace};
use super::written::Written;
use std::future::Future;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker};
use tower::Service;
use tower_lsp::ExitedError;
use tower_lsp::jsonrpc::{Error, Request, Response};

/// The service around `S`, the library's own.
pub(super) struct Ordered<S> {
    inner: S,
    workspace: Arc<Workspace>,
    written: Written,
}

type Answer = Pin<Box<dyn Future<Output = Result<Option<Response>, ExitedError>> + Send>>;

impl<S> Ordered<S> {
    /// What handlers write by themselves waits in `written`.
    pub(super) fn new(inner: S, workspace: Arc<Workspace>, written: Written) -> Ordered<S> {
        Ordered { inner, workspace, written }
    }
}

impl<S> Service<Request> for Ordered<S>
where
    S: Service<Request, Response = Option<Response>, Error = ExitedError>,
    S::Future: Send + 'static,
{
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
        self.workspace.note_lifecycle(request.method(), request.params());
        if self.workspace.apply(request.method(), request.params()) {
            return Box::pin(std::future::ready(Ok(None)));
        }
        let is_lifecycle = matches!(request.method(), "initialize" | "initialized" | "shutdown" | "exit");
        let is_order = is_order(&request);
        let id = request.id().cloned();
        let answer = self.inner.call(request);
        if is_lifecycle {
            return Box::pin(answer);
        }
        let snapshot = self.workspace.snapshot();
        let mut answer = Box::pin(SNAPSHOT.scope(snapshot, self.written.clone().scope(answer)));
        if is_order && let Poll::Ready(done) = answer.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            return Box::pin(std::future::ready(done));
        }
        let task = tokio::spawn(answer);
        Box::pin(async move {
            task.await.unwrap_or_else(|failure| {
                tracing::error!("a request failed: {failure}");
                Ok(id.map(|id| Response::from_error(id, Error::internal_error())))
            })
        })
    }
}

/// Whether a request tells a simulation something, which its handler does before it first waits.
fn is_order(request: &Request) -> bool {
    let command = || request.params()?.get("command")?.as_str();
    request.method() == "workspace/executeCommand"
        && command().is_some_and(|command| command.starts_with(simulation::PREFIX))
}

#[cfg(test)]
mod tests {
    use super::{Ordered, SNAPSHOT, Workspace, Written};
    use crate::lsp::backend::Backend;
    use crate::lsp::settings::Speech;
    use serde_json::json;
    use std::pin::Pin;
    use std::task::{Context, Poll};
    use tower::Service;
    use tower_lsp::jsonrpc::{Id, Request, Response};
    use tower_lsp::{ExitedError, LspService};

    /// Answers `panic` with a panic and everything else with how many documents its snapshot has.
    struct Fragile;

    impl Service<Request> for Fragile {
        type Response = Option<Response>;
        type Error = ExitedError;
        type Future = Pin<Box<dyn Future<Output = Result<Option<Response>, ExitedError>> + Send>>;

        fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), ExitedError>> {
            Poll::Ready(Ok(()))
        }

        fn call(&mut self, request: Request) -> Self::Future {
            Box::pin(async move {
                // The snapshot must be that of the message even if the handler starts late.
                tokio::task::yield_now().await;
                assert_ne!(request.method(), "panic");
                let count = SNAPSHOT.with(|snapshot| snapshot.len());
                Ok(request.id().cloned().map(|id| Response::from_ok(id, json!(count))))
            })
        }
    }

    fn service() -> Ordered<Fragile> {
        let mut workspace = None;
        let _library = LspService::new(|client| {
            let shared = Workspace::new(client, Speech::default());
            workspace = Some(shared.clone());
            Backend::new(shared)
        });
        let mut service = Ordered::new(Fragile, workspace.unwrap(), Written::default());
        drop(service.call(Request::build("initialize").params(json!({"capabilities": {}})).finish()));
        service
    }

    fn request(method: &'static str, id: i64) -> Request {
        Request::build(method).id(id).finish()
    }

    #[tokio::test]
    async fn a_panic_is_answered_as_an_error_and_the_next_request_as_ever() {
        let mut service = service();
        let answer = service.call(request("panic", 7)).await.unwrap().unwrap();
        assert_eq!(answer.id(), &Id::Number(7));
        assert_eq!(answer.error().unwrap().code.code(), -32603);
        let answer = service.call(request("count", 8)).await.unwrap().unwrap();
        assert_eq!(answer.result(), Some(&json!(0)));
        assert_eq!(service.call(Request::build("panic").finish()).await.unwrap(), None, "a notification");
    }

    #[tokio::test]
    async fn a_request_sees_the_state_of_its_moment() {
        let mut service = service();
        let open = |name: &str| {
            let item = json!({"uri": format!("file:///{name}.il"), "languageId": "plc-il", "version": 1, "text": ""});
            Request::build("textDocument/didOpen").params(json!({"textDocument": item})).finish()
        };
        let mut counts = Vec::new();
        for name in ["a", "b", "c"] {
            counts.push(service.call(request("count", 1)));
            drop(service.call(open(name)));
        }
        for (number, count) in counts.into_iter().enumerate() {
            assert_eq!(count.await.unwrap().unwrap().result(), Some(&json!(number)));
        }
    }
}
