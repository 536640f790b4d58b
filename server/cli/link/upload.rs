//! `rungwise upload`

use super::Connection;
use super::connection::{Bar, failed};
use super::contents::is_drawn;
use crate::cli::Outcome;
use crate::cli::input::{caution, complain, put, remark};
use crate::link::Uploaded;
use crate::machine_code::decode;
use crate::text::{Language, Message};
use crate::translate::from_machine_code::drawn;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// The file to write: a list (.il) or a drawing (.lad); standard output if left out.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    connection: Connection,
    /// Replace a file that is there.
    #[arg(long)]
    overwrite: bool,
}

pub(in crate::cli) fn run(arguments: &Arguments, language: Language) -> Outcome {
    carry_out(arguments, language).unwrap_or_else(|outcome| outcome)
}

fn carry_out(arguments: &Arguments, language: Language) -> Result<Outcome, Outcome> {
    let output = arguments.output.as_deref();
    if let Some(path) = output.filter(|path| path.exists() && !arguments.overwrite) {
        let reason = Message::new("link.exists").with("path", path.display()).render(language);
        complain("file-exists", &reason, &Message::new("link.help-exists").render(language), language);
        return Err(Outcome::Unusable);
    }
    let mut host = arguments.connection.open(output.unwrap_or(Path::new(".")), language)?;
    let mut bar = Bar::new(language);
    let uploaded = host.upload(&mut |progress| bar.show(progress));
    bar.clear();
    let Uploaded { image, is_whole } = uploaded.map_err(|error| failed(&error, language))?;
    let target = host.identity().target;
    let listing = decode(image.program(), target.model);
    let unread = listing.lines.iter().filter(|line| !line.is_read).count();
    let text = match output.is_some_and(is_drawn) {
        true => drawn(image.program(), target.model),
        false => listing.text,
    };
    if !put(&text, output, language) {
        return Err(Outcome::Unusable);
    }
    remark(&Message::new("link.uploaded").with("steps", image.program().len()).render(language));
    if unread > 0 {
        remark(&Message::new("link.unread").with("count", unread).render(language));
    }
    if !is_whole {
        let reason = Message::new("link.not-whole").render(language);
        caution("sum", &reason, &Message::new("link.help-not-whole").render(language), language);
    }
    Ok(if unread == 0 && is_whole { Outcome::Clean } else { Outcome::Findings })
}
