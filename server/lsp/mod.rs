//! The language server: the protocol around `ide` and `check`, and nothing about languages.
//!
//! A message comes through [`frames`] to [`service`], which applies changes of state in the order of arrival and
//! gives every request the snapshot of that moment; [`backend`] answers from the snapshot; [`publisher`] sends
//! diagnostics.

mod abilities;
mod across;
mod alarms;
mod answering;
mod backend;
mod capabilities;
mod editing;
mod features;
mod fences;
mod folders;
mod frames;
mod keeper;
mod known;
mod linking;
mod manifest_help;
mod manifests;
mod outlet;
mod plc;
mod progress;
mod projects;
mod proving;
mod publisher;
mod pulled;
mod recording;
mod service;
mod settings;
mod sheets;

mod simulation;
mod status;
mod testing;
mod to_proto;
mod tokens;
mod translating;
mod typed;
mod usage;
mod workspace;
mod written;

pub use recording::{NoEntry, replay, serve_mirrored};

use crate::text::Language;
use service::Ordered;
use settings::Speech;
use tokio::io::{AsyncRead, AsyncWrite};
use tower_lsp::{LspService, Server};
use workspace::Workspace;
use written::Written;

/// How many requests may be under way at once. Each is a task of its own, so this bounds memory, not speed.
const CONCURRENCY: usize = 4096;

/// Serves one client on standard input and output until it says `exit` or goes away.
/// Returns the process's exit code: 0 after a `shutdown`, else 1, as the protocol wants.
///
/// `asked` is the language that the user asked the program for, which goes before the client's; `otherwise` is taken if
/// the client says none.
pub async fn serve(asked: Option<Language>, otherwise: Language) -> u8 {
    serve_between(tokio::io::stdin(), tokio::io::stdout(), asked, otherwise).await
}

/// Serves one client that sends `input` and reads `output`; ends and returns as [`serve`] does.
pub async fn serve_between(
    input: impl AsyncRead + Send + Unpin + 'static,
    output: impl AsyncWrite + Send + Unpin,
    asked: Option<Language>,
    otherwise: Language,
) -> u8 {
    let mut workspace = None;
    let (service, socket) = LspService::build(|client| {
        let shared = Workspace::new(client, Speech { asked, otherwise, ..Speech::default() });
        workspace = Some(shared.clone());
        backend::Backend::new(shared)
    })
    .custom_method("rungwise/edit", backend::Backend::edit)
    .custom_method("rungwise/object", backend::Backend::object)
    .custom_method("rungwise/typed", backend::Backend::typed)
    .custom_method("textDocument/rangesFormatting", backend::Backend::ranges_formatting)
    .custom_method("workspace/textDocumentContent", backend::Backend::content)
    .finish();
    let Some(workspace) = workspace else { return 1 };
    let written = Written::default();
    let ordered = Ordered::new(service, workspace.clone(), written.clone());
    let translator = fences::Translator::default();
    let (inward, asked) = (translator.clone(), workspace.clone());
    let input = frames::sound(input, move |body| inward.incoming(body, || asked.snapshot().manner.encoding));
    Server::new(input, outlet::Outlet::new(output, translator, written), socket)
        .concurrency_level(CONCURRENCY)
        .serve(ordered)
        .await;
    u8::from(!workspace.was_shut_down())
}
