//! `rungwise prove`

use super::across::{linked, several_programs, whole_program};
use super::encode::encoded;
use super::input::{Program, programs, put, remark, say};
use super::{Outcome, translate};
use crate::document::{Document, Notation};
use crate::machine_code::decode;
use crate::scenario::{of_counterexample, shown};
use crate::text::{Language, Message};
use crate::translate::{Counterexample, Proof, prove, told};
use clap::ValueEnum;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A program, or a project.
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
    let [Some(left), Some(right)] = [&arguments.left, &arguments.right].map(|path| side(path, language))
    else {
        return Outcome::Unusable;
    };
    let sides = [&left.document, &right.document];
    let names = [left.path.display().to_string(), right.path.display().to_string()];
    let proof = shown(prove(sides[0], sides[1]), sides, &names);
    match arguments.format {
        ProofFormat::Json => say(&format!("{:#}\n", told::json(&proof, sides, language))),
        ProofFormat::Text => say(&told::text(&proof, sides, &names, language)),
    }
    if let (Some(path), Proof::Different(found)) = (&arguments.scenario, &proof) {
        match scenario(found, &names, path, language) {
            Some(text) if !put(&text, Some(path), language) => return Outcome::Unusable,
            Some(_) => {}
            None => {
                remark(&Message::new("cli.scenario-unshown").with("path", path.display()).render(language))
            }
        }
    }
    match proof {
        Proof::Equal { .. } => Outcome::Clean,
        Proof::Different(_) | Proof::Undecided { .. } => Outcome::Findings,
    }
}

/// A scenario test for the file at `path`, which names the first program as it is found from there; nothing if the
/// simulated PLC does not show the difference.
fn scenario(found: &Counterexample, names: &[String; 2], path: &Path, language: Language) -> Option<String> {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let left = absolute(Path::new(&names[0]));
    let folder = absolute(path).parent().map(Path::to_path_buf).unwrap_or_default();
    let left = left.strip_prefix(&folder).unwrap_or(&left).display().to_string();
    of_counterexample(found, &[left, names[1].clone()], language)
}

/// The program or project at `path`; nothing after a complaint. The files of an FX project that are one program are the
/// list that a PLC with their machine code has.
fn side(path: &Path, language: Language) -> Option<Program> {
    let mut files = match path.is_dir() {
        true => whole_program(path, language)?,
        false => Vec::new(),
    };
    if files.len() < 2 || files.iter().any(|file| !file.document.target().is_fx()) {
        return translate::read(path, language);
    }
    let encoded = encoded(path, None, language).ok()?;
    let listing = decode(&encoded.words(), encoded.target.model);
    let document = Document::new(&listing.text, Notation::FxIl, encoded.target);
    files.pop().map(|file| Program { path: path.to_path_buf(), document, ..file })
}

/// The one program at `path`, which knows what the other files of its project declare; nothing after a complaint.
pub(super) fn read(path: &Path, language: Language) -> Option<Program> {
    let mut programs = programs(&[path.to_path_buf()], None, language)?;
    if programs.len() == 1 {
        return programs.pop().map(linked);
    }
    several_programs(path, language);
    None
}
