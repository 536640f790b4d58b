//! `rungwise lsp` and `rungwise dap`

use super::{Outcome, input, language};
use crate::text::{Language, Message};
use crate::{dap, lsp};
use std::future::Future;
use std::num::NonZero;
use std::path::Path;
use std::process::ExitCode;

/// Serves a client; `mirror` is the file into which it records what the client sends, `replay` one that it plays
/// instead of serving. `asked` is the language that `--lang` says; it goes before the client's.
pub(super) fn run(mirror: Option<&Path>, replay: Option<&Path>, asked: Option<Language>) -> ExitCode {
    let otherwise = language::spoken();
    match (mirror, replay) {
        (_, Some(path)) => match std::fs::read_to_string(path) {
            Ok(recording) => on_runtime(async move {
                match lsp::replay(&recording, tokio::io::stdout(), asked, otherwise).await {
                    Ok(code) => code,
                    Err(lsp::NoEntry(line)) => {
                        let reason = Message::new("cli.no-entry").with("line", line).render(otherwise);
                        refuse("unreadable-input", &reason, "cli.give-recording")
                    }
                }
            }),
            Err(reason) => {
                refuse("unreadable-input", &format!("{}: {reason}", path.display()), "cli.check-path").into()
            }
        },
        (Some(path), None) => match std::fs::File::create(path) {
            Ok(log) => on_runtime(lsp::serve_mirrored(std::io::BufWriter::new(log), asked, otherwise)),
            Err(reason) => {
                refuse("unwritable", &format!("{}: {reason}", path.display()), "cli.check-path").into()
            }
        },
        (None, None) => on_runtime(lsp::serve(asked, otherwise)),
    }
}

/// Serves a client of the debug adapter. `asked` is the language that `--lang` says; it goes before the client's.
pub(super) fn debug(asked: Option<Language>, otherwise: Language) -> ExitCode {
    dap::serve(std::io::stdin(), std::io::stdout(), asked.unwrap_or(otherwise), asked.is_some());
    // A thread still reads standard input; it ends with the process.
    Outcome::Clean.into()
}

/// The exit code of wrong usage, after a complaint.
fn refuse(code: &str, reason: &str, help: &'static str) -> u8 {
    let language = language::spoken();
    input::complain(code, reason, &Message::new(help).render(language), language);
    2
}

/// Does not return to the caller: a thread that still reads standard input would hold the runtime, and the process,
/// for as long as the client keeps it open.
fn on_runtime(serve: impl Future<Output = u8>) -> ExitCode {
    // Two threads read and write. The others share the processors: more of them would be no faster, and the allocator
    // keeps some memory back for each.
    let processors = std::thread::available_parallelism().map_or(2, NonZero::get).max(2);
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .worker_threads(4)
        .max_blocking_threads(2 + 2 * processors)
        .build();
    match runtime {
        Ok(runtime) => {
            let code = runtime.block_on(serve);
            std::process::exit(i32::from(code))
        }
        Err(reason) => {
            refuse("no-runtime", &reason.to_string(), "cli.no-threads");
            Outcome::Unusable.into()
        }
    }
}
