//! `rungwise translate`

use super::Outcome;
use super::fmt::style_of;
use super::input::{Program, complain, remark, say};
use super::prove;
use crate::text::{Encoding, Language, Message};
use crate::translate::to_boolean::Notation;
use crate::translate::{Certificate, Options, To, Translation, translate};
use clap::ValueEnum;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The program.
    file: PathBuf,
    /// The form to translate it to.
    #[arg(long, value_enum)]
    to: Form,
    /// Write the result to this file, not to standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Say what is proved of each rung, and fail unless all are.
    #[arg(long)]
    prove: bool,
    /// Write equations with ∧ ∨ ¬.
    #[arg(long)]
    symbols: bool,
}

/// A form of a program.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// A ladder diagram.
    Ladder,
    /// FX instruction list.
    Fx,
    /// Instruction list of IEC 61131-3.
    Iec,
    /// Equations, one for each output.
    Boolean,
}

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let Some(program) = prove::read(&arguments.file, language) else { return Outcome::Unusable };
    let program = &program;
    let to = match arguments.to {
        Form::Ladder => To::Ladder,
        Form::Fx => To::Fx,
        Form::Iec => To::Iec,
        Form::Boolean => To::Boolean,
    };
    let options = Options {
        style: style_of(program, None).ladder(),
        notation: if arguments.symbols { Notation::Symbols } else { Notation::Algebra },
        ..Options::default()
    };
    let translation = translate(&program.document, None, to, &options);
    tell(program, &translation, arguments.prove, language);
    let is_certain = translation.is_certain();
    if arguments.prove && !is_certain {
        return Outcome::Findings;
    }
    match &arguments.output {
        None => say(&translation.text),
        Some(path) => {
            if let Err(error) = std::fs::write(path, &translation.text) {
                let reason = format!("{}: {error}", path.display());
                complain("not-written", &reason, &Message::new("cli.make-room").render(language), language);
                return Outcome::Unusable;
            }
        }
    }
    // Equations are not read again, so nothing is proved of them.
    let is_whole =
        is_certain || (to == To::Boolean && translation.rungs.iter().all(|rung| rung.note.is_none()));
    if is_whole { Outcome::Clean } else { Outcome::Findings }
}

/// Notes about rungs, and with `--prove` how many are proved.
fn tell(program: &Program, translation: &Translation, proves: bool, language: Language) {
    for rung in &translation.rungs {
        let Some(note) = &rung.note else { continue };
        let line = program.document.position(rung.span.start as usize, Encoding::Utf32).line + 1;
        remark(
            &Message::new("cli.not-translated")
                .with("path", program.path.display())
                .with("line", line)
                .with_messages("reason", vec![note.clone()])
                .render(language),
        );
    }
    if proves {
        let count = |certificate| {
            translation.rungs.iter().filter(|rung| rung.certificate == Some(certificate)).count()
        };
        let summary = Message::new("cli.certificates")
            .with("rungs", translation.rungs.len())
            .with("proved", count(Certificate::Proved))
            .with("construction", count(Certificate::Construction))
            .with("undecided", count(Certificate::Undecided));
        remark(&summary.render(language));
    }
}
