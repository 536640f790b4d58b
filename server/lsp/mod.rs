//! The language server: the protocol around `ide` and `check`, and nothing about languages.
//!
//! A message comes through [`frames`] to [`service`], which applies changes of state in the order of arrival and
//! gives every request the snapshot of that moment; [`backend`] answers from the snapshot; [`publisher`] sends
//! diagnostics.

mod abilities;
mod backend;
mod capabilities;
mod features;
mod folders;
mod frames;
mod keeper;
mod linking;
mod manifests;
mod progress;
mod projects;
mod publisher;
mod service;
mod sheets;
mod settings;
mod status;
mod to_proto;
mod workspace;

use service::Ordered;
use tokio::io::{AsyncRead, AsyncWrite};
use tower_lsp::{LspService, Server};
use workspace::Workspace;

/// How many requests may be under way at once. Each is a task of its own, so this bounds memory, not speed.
const CONCURRENCY: usize = 4096;

/// Serves one client on standard input and output until it says `exit` or goes away.
/// Returns the process's exit code: 0 after a `shutdown`, else 1, as the protocol wants.
pub async fn serve() -> u8 {
    serve_between(tokio::io::stdin(), tokio::io::stdout()).await
}

/// Serves one client that sends `input` and reads `output`; ends and returns as [`serve`] does.
pub async fn serve_between(
    input: impl AsyncRead + Send + Unpin + 'static,
    output: impl AsyncWrite + Send + Unpin,
) -> u8 {
    let mut workspace = None;
    let (service, socket) = LspService::build(|client| {
        let shared = Workspace::new(client);
        workspace = Some(shared.clone());
        backend::Backend::new(shared)
    })
    .custom_method("textDocument/rangesFormatting", backend::Backend::ranges_formatting)
    .custom_method("workspace/textDocumentContent", backend::Backend::content)
    .finish();
    let Some(workspace) = workspace else { return 1 };
    let ordered = Ordered::new(service, workspace.clone());
    Server::new(frames::sound(input), output, socket)
        .concurrency_level(CONCURRENCY)
        .serve(ordered)
        .await;
    u8::from(!workspace.was_shut_down())
}
