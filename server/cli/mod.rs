//! The command line: one short function for each verb, and the only place with exit codes.

mod across;
mod check;
mod comments;
mod explain;
mod fmt;
mod help;
mod input;
mod language;
mod render;
mod usage;

use crate::text::{Language, Message};
use clap::{Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// PLC programs as text: check, format and explain Instruction List and ladder diagrams.
#[derive(Parser)]
#[command(name = "rungwise", version, about, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
    /// The language of messages: en, zh-CN; that of the system if left out.
    #[arg(long = "lang", value_name = "LANGUAGE", global = true, value_parser = language::named)]
    language: Option<Language>,
}

#[derive(Subcommand)]
enum Verb {
    /// Run the language server on standard input and output.
    Lsp {
        /// Accepted because many editors pass it; standard input and output are the only transport.
        #[arg(long, hide = true)]
        stdio: bool,
    },
    /// Check files, folders or projects with every rule.
    Check(check::Arguments),
    /// Write files in canonical form.
    Fmt(fmt::Arguments),
    /// List the devices that programs use: where read, where written, comment.
    Usage(usage::Arguments),
    /// Show the page of a rule, an instruction, a function or a function block.
    Explain(explain::Arguments),
}

/// The shape of results on standard output.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people.
    Text,
    /// One JSON document.
    Json,
}

/// What a verb found; the process's exit code.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Outcome {
    /// Success and nothing found: 0.
    Clean,
    /// Findings: 1.
    Findings,
    /// Wrong usage or unreadable input: 2.
    Unusable,
}

/// Runs the command that `arguments` say, the program's name first, and returns the exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    start_log();
    let words: Vec<OsString> = arguments.into_iter().collect();
    let language = language::choose(&words);
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(error) => {
            let usage = error.use_stderr();
            // Nothing can be told to anybody if neither stream takes it.
            let _ = help::translated(error, &words, language).print();
            return if usage { Outcome::Unusable.into() } else { Outcome::Clean.into() };
        }
    };
    match arguments.verb {
        Verb::Lsp { stdio: _ } => serve(arguments.language),
        Verb::Check(arguments) => check::run(&arguments, language).into(),
        Verb::Fmt(arguments) => fmt::run(&arguments, language).into(),
        Verb::Usage(arguments) => usage::run(&arguments, language).into(),
        Verb::Explain(arguments) => explain::run(&arguments, language).into(),
    }
}

/// Does not return to the caller: a thread that still reads standard input would hold the runtime, and the process,
/// for as long as the client keeps it open. `asked` is the language that `--lang` says; it goes before the client's.
fn serve(asked: Option<Language>) -> ExitCode {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().worker_threads(4).build();
    match runtime {
        Ok(runtime) => {
            let code = runtime.block_on(crate::lsp::serve(asked, language::spoken()));
            std::process::exit(i32::from(code))
        }
        Err(reason) => {
            let language = language::spoken();
            let help = Message::new("cli.no-threads").render(language);
            input::complain("no-runtime", &reason.to_string(), &help, language);
            Outcome::Unusable.into()
        }
    }
}

/// The log goes to standard error, warnings and worse unless `RUNGWISE_LOG` says otherwise.
fn start_log() {
    let filter = tracing_subscriber::EnvFilter::try_from_env("RUNGWISE_LOG")
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("warn,tower_lsp_server=error"));
    // A second call in one process keeps the first log.
    let _ = tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).try_init();
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> ExitCode {
        match outcome {
            Outcome::Clean => ExitCode::from(0),
            Outcome::Findings => ExitCode::from(1),
            Outcome::Unusable => ExitCode::from(2),
        }
    }
}

/// Paths given on the command line; the current folder where none is.
fn paths_or_here(paths: &[PathBuf]) -> Vec<PathBuf> {
    if paths.is_empty() { vec![PathBuf::from(".")] } else { paths.to_vec() }
}
