//! `rungwise start`, `rungwise stop` and `rungwise clear`

use super::Connection;
use super::connection::{confirmed, failed};
use crate::cli::Outcome;
use crate::cli::input::{complain, remark};
use crate::text::{Language, Message};
use std::path::Path;

#[derive(clap::Args)]
pub(in crate::cli) struct Start {
    #[command(flatten)]
    connection: Connection,
    /// Do not ask: the machine may move.
    #[arg(long)]
    yes: bool,
}

#[derive(clap::Args)]
pub(in crate::cli) struct Stop {
    #[command(flatten)]
    connection: Connection,
}

#[derive(clap::Args)]
pub(in crate::cli) struct Clear {
    #[command(flatten)]
    connection: Connection,
    /// Clear the values of all devices, not the program.
    #[arg(long)]
    devices: bool,
    /// Do not ask.
    #[arg(long)]
    yes: bool,
}

pub(in crate::cli) fn start(arguments: &Start, language: Language) -> Outcome {
    let started = || -> Result<Outcome, Outcome> {
        let mut host = arguments.connection.open(Path::new("."), language)?;
        if !confirmed(&Message::new("link.ask-start"), arguments.yes, &mut host, language) {
            return Err(Outcome::Findings);
        }
        if host.start().map_err(|error| failed(&error, language))? {
            remark(&Message::new("link.runs").render(language));
            return Ok(Outcome::Clean);
        }
        let reason = Message::new("link.does-not-run").render(language);
        complain("does-not-run", &reason, &Message::new("link.help-does-not-run").render(language), language);
        Ok(Outcome::Findings)
    };
    started().unwrap_or_else(|outcome| outcome)
}

pub(in crate::cli) fn stop(arguments: &Stop, language: Language) -> Outcome {
    let stopped = || -> Result<Outcome, Outcome> {
        let mut host = arguments.connection.open(Path::new("."), language)?;
        host.stop().map_err(|error| failed(&error, language))?;
        remark(&Message::new("link.stands-still").render(language));
        Ok(Outcome::Clean)
    };
    stopped().unwrap_or_else(|outcome| outcome)
}

pub(in crate::cli) fn clear(arguments: &Clear, language: Language) -> Outcome {
    let cleared = || -> Result<Outcome, Outcome> {
        let mut host = arguments.connection.open(Path::new("."), language)?;
        let question = if arguments.devices { "link.ask-clear-devices" } else { "link.ask-clear-program" };
        let parameters = host.status().map_err(|error| failed(&error, language))?.parameters;
        let title = parameters.title();
        let question = Message::new(question)
            .with("model", host.identity().target.title)
            .with("title", if title.is_empty() { String::new() } else { format!(" \"{title}\"") })
            .with("capacity", parameters.capacity())
            .with("sum", format!("{:04X}", parameters.sum()));
        if !confirmed(&question, arguments.yes, &mut host, language) {
            return Err(Outcome::Findings);
        }
        host.clear(!arguments.devices).map_err(|error| failed(&error, language))?;
        remark(&Message::new("link.cleared").render(language));
        Ok(Outcome::Clean)
    };
    cleared().unwrap_or_else(|outcome| outcome)
}
