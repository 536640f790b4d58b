//! The command line: one short function for each verb, and the only place with exit codes.

mod across;
mod check;
mod colour;
mod comments;
mod completions;
mod decode;
mod diff;
mod encode;
mod explain;
mod fmt;
mod help;
mod import;
mod input;
mod language;
mod link;
mod plc;
mod progress;
mod prove;
mod render;
mod run;
mod sarif;
mod server;
mod test;
mod translate;
mod usage;
mod why;

use crate::text::Language;
use clap::{Parser, Subcommand, ValueEnum};
use colour::Colour;
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
    /// When results have colours.
    #[arg(long, global = true, value_enum, default_value = "auto")]
    color: Colour,
}

#[derive(Subcommand)]
enum Verb {
    /// Run the language server on standard input and output.
    Lsp {
        /// Accepted because many editors pass it; standard input and output are the only transport.
        #[arg(long, hide = true)]
        stdio: bool,
        /// Write what the client sends to this file, for a bug report.
        #[arg(long, value_name = "FILE", conflicts_with = "replay")]
        mirror: Option<PathBuf>,
        /// Play such a file to the server, write its answers to standard output, and end.
        #[arg(long, value_name = "FILE")]
        replay: Option<PathBuf>,
    },
    /// Run the debug adapter on standard input and output.
    Dap,
    /// Check files, folders or projects with every rule.
    Check(check::Arguments),
    /// Write files in canonical form.
    Fmt(fmt::Arguments),
    /// Translate a program between ladder, instruction list and equations.
    Translate(translate::Arguments),
    /// Tell whether two programs do the same, and if not, for which inputs.
    Prove(prove::Arguments),
    /// Run a program on a simulated PLC.
    Run(run::Arguments),
    /// Run scenario tests.
    Test(test::Arguments),
    /// List the devices that programs use: where read, where written, comment.
    Usage(usage::Arguments),
    /// Make machine code of a program: the words of a PLC's program memory.
    Encode(encode::Arguments),
    /// Write machine code as instruction list.
    Decode(decode::Arguments),
    /// Show the page of a rule, an instruction, a function or a function block.
    Explain(explain::Arguments),
    /// Carry a program of LDmicro over: its own file (.ld) or its text export.
    Import(import::Arguments),
    /// Run a virtual PLC, which answers on TCP or a pseudo terminal as an FX does on its programming port.
    Plc(plc::Arguments),
    /// List the serial ports of this computer.
    Ports,
    /// Tell which PLC is there, what it does, and what has gone wrong in it.
    Status(link::status::Arguments),
    /// Write a program into a PLC: show what changes, ask, keep what was there, write, read back, compare.
    Download(link::download::Arguments),
    /// Read the program of a PLC into a file.
    Upload(link::upload::Arguments),
    /// Compare the program of a PLC with a file.
    Verify(link::verify::Arguments),
    /// Let a PLC run.
    Start(link::control::Start),
    /// Let a PLC stop.
    Stop(link::control::Stop),
    /// Clear the program or the devices of a PLC that stands still.
    Clear(link::control::Clear),
    /// Watch devices of a PLC.
    Monitor(link::monitor::Arguments),
    /// Write registers, current values and relays of a PLC.
    Write(link::devices::Arguments),
    /// Switch relays of a PLC; what the program writes is as it says after the next scan.
    Force(link::devices::Arguments),
    /// Write a completion script for a shell to standard output.
    Completions(completions::Arguments),
}

/// The shape of results on standard output.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people.
    Text,
    /// One JSON document.
    Json,
    /// A log of SARIF 2.1.0.
    Sarif,
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
    /// The line to a PLC failed: 3.
    LinkFailed,
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
        Verb::Lsp { stdio: _, mirror, replay } => {
            server::run(mirror.as_deref(), replay.as_deref(), arguments.language)
        }
        Verb::Dap => server::debug(arguments.language, language),
        Verb::Check(verb) => check::run(&verb, arguments.color, language).into(),
        Verb::Fmt(verb) => fmt::run(&verb, arguments.color, language).into(),
        Verb::Translate(verb) => translate::run(&verb, language).into(),
        Verb::Prove(verb) => prove::run(&verb, language).into(),
        Verb::Run(verb) => run::run(&verb, language).into(),
        Verb::Test(verb) => test::run(&verb, language).into(),
        Verb::Usage(verb) => usage::run(&verb, language).into(),
        Verb::Encode(verb) => encode::run(&verb, language).into(),
        Verb::Decode(verb) => decode::run(&verb, language).into(),
        Verb::Explain(arguments) => explain::run(&arguments, language).into(),
        Verb::Import(arguments) => import::run(&arguments, language).into(),
        Verb::Plc(verb) => plc::run(&verb, language).into(),
        Verb::Ports => link::ports::run(language).into(),
        Verb::Status(verb) => link::status::run(&verb, language).into(),
        Verb::Download(verb) => link::download::run(&verb, arguments.color, language).into(),
        Verb::Upload(verb) => link::upload::run(&verb, language).into(),
        Verb::Verify(verb) => link::verify::run(&verb, arguments.color, language).into(),
        Verb::Start(verb) => link::control::start(&verb, language).into(),
        Verb::Stop(verb) => link::control::stop(&verb, language).into(),
        Verb::Clear(verb) => link::control::clear(&verb, language).into(),
        Verb::Monitor(verb) => link::monitor::run(&verb, language).into(),
        Verb::Write(verb) => link::devices::write(&verb, language).into(),
        Verb::Force(verb) => link::devices::force(&verb, language).into(),
        Verb::Completions(arguments) => completions::run(&arguments).into(),
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
            Outcome::LinkFailed => ExitCode::from(3),
        }
    }
}

/// Paths given on the command line; the current folder where none is.
fn paths_or_here(paths: &[PathBuf]) -> Vec<PathBuf> {
    if paths.is_empty() { vec![PathBuf::from(".")] } else { paths.to_vec() }
}
