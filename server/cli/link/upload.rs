//! `rungwise upload`

use super::Connection;
use super::connection::{Bar, failed};
use crate::cli::Outcome;
use crate::cli::input::{complain, put, remark};
use crate::document::{Document, Notation};
use crate::machine_code::decode;
use crate::text::{Language, Message};
use crate::translate::{Options, To, translate};
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
    let image = host.upload(&mut |progress| bar.show(progress));
    bar.clear();
    let image = image.map_err(|error| failed(&error, language))?;
    let target = host.identity().target;
    let listing = decode(image.program(), target.model);
    let unread = listing.lines.iter().filter(|line| !line.is_read).count();
    let is_drawn =
        output.and_then(Path::extension).is_some_and(|extension| extension.eq_ignore_ascii_case("lad"));
    let text = match is_drawn {
        true => {
            let document = Document::new(&listing.text, Notation::FxIl, target);
            translate(&document, None, To::Ladder, &Options::default()).text
        }
        false => listing.text,
    };
    if !put(&text, output, language) {
        return Err(Outcome::Unusable);
    }
    remark(&Message::new("link.uploaded").with("steps", image.program().len()).render(language));
    if unread > 0 {
        remark(&Message::new("link.unread").with("count", unread).render(language));
    }
    Ok(if unread == 0 { Outcome::Clean } else { Outcome::Findings })
}
