//! `rungwise status`

use super::Connection;
use super::connection::{AnyHost, failed};
use super::contents::words_at;
use crate::cli::Outcome;
use crate::cli::input::say;
use crate::link::{LinkError, Mode};
use crate::text::{Language, Message};
use clap::ValueEnum;
use serde_json::json;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// A program to compare with the one in the PLC.
    file: Option<PathBuf>,
    #[command(flatten)]
    connection: Connection,
    /// The shape of the result.
    #[arg(long, value_enum, default_value = "text")]
    format: StatusFormat,
}

/// The shape of what is told of a PLC.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum StatusFormat {
    /// For people.
    Text,
    /// One JSON document.
    Json,
}

pub(in crate::cli) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let told = || -> Result<Outcome, Outcome> {
        let here = Path::new(".");
        let wanted = match &arguments.file {
            Some(path) => Some(words_at(path, language)?.0),
            None => None,
        };
        let mut host = arguments.connection.open(arguments.file.as_deref().unwrap_or(here), language)?;
        let status = host.status().map_err(|error| failed(&error, language))?;
        let is_same = match wanted {
            Some(words) => Some(same(&mut host, &words).map_err(|error| failed(&error, language))?),
            None => None,
        };
        let identity = host.identity();
        let mode = match status.mode {
            Mode::Run => "RUN",
            Mode::Stop => "STOP",
        };
        match arguments.format {
            StatusFormat::Json => {
                let document = json!({
                    "model": identity.target.name,
                    "version": identity.version(),
                    "mode": mode,
                    "capacity": status.parameters.capacity(),
                    "title": status.parameters.title(),
                    "keyword": status.parameters.has_keyword(),
                    "sum": format!("{:04X}", status.parameters.sum()),
                    "scan_time_ms": status.scan_time_ms,
                    "errors": status.errors,
                    "same": is_same,
                });
                say(&format!("{document:#}\n"));
            }
            StatusFormat::Text => {
                let mut text = Message::new("link.status")
                    .with("model", identity.target.title)
                    .with("version", identity.version())
                    .with("mode", mode)
                    .with("capacity", status.parameters.capacity())
                    .with("sum", format!("{:04X}", status.parameters.sum()))
                    .with("scan", format!("{}", status.scan_time_ms))
                    .render(language);
                text.push('\n');
                for error in &status.errors {
                    let line = Message::new("link.status-error")
                        .with("register", &error.register)
                        .with("code", error.code);
                    text += &format!("{}\n", line.render(language));
                }
                if let Some(is_same) = is_same {
                    let line = Message::new(if is_same { "link.same" } else { "link.other" });
                    text += &format!("{}\n", line.render(language));
                }
                say(&text);
            }
        }
        Ok(if is_same == Some(false) { Outcome::Findings } else { Outcome::Clean })
    };
    told().unwrap_or_else(|outcome| outcome)
}

fn same(host: &mut AnyHost, words: &[u16]) -> Result<bool, LinkError> {
    Ok(host.upload(&mut |_| {})?.image.program() == words)
}
