//! `rungwise prove`

use super::across::linked;
use super::input::{Program, complain, programs, put, say};
use super::{Outcome, translate};
use crate::scenario;
use crate::text::{Language, Message};
use crate::translate::{Proof, prove, told};
use clap::ValueEnum;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A program.
    left: PathBuf,
    /// Another program for the same PLC.
    right: PathBuf,
    /// The shape of the result.
    #[arg(long, value_enum, default_value = "text")]
    format: ProofFormat,
    /// Write a scenario test that tells the programs apart to this file.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
}

/// The shape of a proof on standard output.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ProofFormat {
    /// For people.
    Text,
    /// One JSON document.
    Json,
}

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let [Some(left), Some(right)] =
        [&arguments.left, &arguments.right].map(|path| translate::read(path, language))
    else {
        return Outcome::Unusable;
    };
    let sides = [&left.document, &right.document];
    let proof = prove(sides[0], sides[1]);
    let names = [left.path.display().to_string(), right.path.display().to_string()];
    match arguments.format {
        ProofFormat::Json => say(&format!("{:#}\n", told::json(&proof, sides, language))),
        ProofFormat::Text => say(&told::text(&proof, sides, &names, language)),
    }
    if let (Some(path), Proof::Different(found)) = (&arguments.scenario, &proof)
        && !put(&scenario::of_counterexample(found, &names, language), Some(path), language)
    {
        return Outcome::Unusable;
    }
    match proof {
        Proof::Equal { .. } => Outcome::Clean,
        Proof::Different(_) | Proof::Undecided { .. } => Outcome::Findings,
    }
}

/// The one program at `path`, which knows what the other files of its project declare; nothing after a complaint.
pub(super) fn read(path: &Path, language: Language) -> Option<Program> {
    let mut programs = programs(&[path.to_path_buf()], None, language)?;
    if programs.len() == 1 {
        return programs.pop().map(linked);
    }
    let reason = Message::new("cli.one-program").with("path", path.display());
    let help = Message::new("cli.name-one-file").render(language);
    complain("several-programs", &reason.render(language), &help, language);
    None
}
