//! `rungwise verify`

use super::Connection;
use super::connection::{Bar, failed};
use super::contents::{is_drawn, words_at};
use super::download::changes;
use crate::cli::Outcome;
use crate::cli::colour::Colour;
use crate::cli::input::{remark, say};
use crate::text::{Language, Message};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// A program, a project, or a backup.
    file: PathBuf,
    #[command(flatten)]
    connection: Connection,
}

pub(in crate::cli) fn run(arguments: &Arguments, colour: Colour, language: Language) -> Outcome {
    let compared = || -> Result<Outcome, Outcome> {
        let (words, target) = words_at(&arguments.file, language)?;
        let mut host = arguments.connection.open(&arguments.file, language)?;
        let mut bar = Bar::new(language);
        let plan = host.plan(&words, target, &mut |progress| bar.show(progress));
        bar.clear();
        let plan = plan.map_err(|error| failed(&error, language))?;
        say(&changes(&plan, is_drawn(&arguments.file), colour, language));
        let is_same = plan.before.program() == plan.wanted.program();
        remark(&Message::new(if is_same { "link.same" } else { "link.other" }).render(language));
        Ok(if is_same { Outcome::Clean } else { Outcome::Findings })
    };
    compared().unwrap_or_else(|outcome| outcome)
}
