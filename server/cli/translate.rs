//! `rungwise translate`

use super::Outcome;
use super::check::target_named;
use super::fmt::style_of;
use super::input::{Program, complain, put, remark};
use super::prove;
use crate::document::{Document, Notation};
use crate::ide::rungs_counted;
use crate::target::{Model, Target};
use crate::text::{Encoding, Language, Message, position_of};
use crate::translate::to_boolean::Notation as Equations;
use crate::translate::{Certificate, Options, To, Translation, from_boolean, translate};
use clap::ValueEnum;
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The program: a .lad or .il file, or equations in a .bool file.
    file: PathBuf,
    /// The form to translate it to.
    #[arg(long, value_enum)]
    to: Form,
    /// The FX model that an FX list is for [default: that of the project or of the program].
    #[arg(long, value_parser = target_named)]
    target: Option<&'static Target>,
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
    let Some(program) = read(&arguments.file, language) else { return Outcome::Unusable };
    let program = &program;
    let to = match arguments.to {
        Form::Ladder => To::Ladder,
        Form::Fx => To::Fx,
        Form::Iec => To::Iec,
        Form::Boolean => To::Boolean,
    };
    if let Some(asked) = arguments.target.filter(|asked| to != To::Fx || !asked.is_fx()) {
        let reason = Message::new("cli.no-model").with("target", asked.name).with("form", to.name());
        let help = Message::new("cli.choose-model").render(language);
        complain("target-refused", &reason.render(language), &help, language);
        return Outcome::Unusable;
    }
    let of_project = program.manifest.fx_target().filter(|_| !program.document.target().is_fx());
    let options = Options {
        model: arguments.target.or(of_project).map(|target| target.model),
        style: style_of(program, None).ladder(),
        notation: if arguments.symbols { Equations::Symbols } else { Equations::Algebra },
        ..Options::default()
    };
    let translation = translate(&program.document, None, to, &options);
    tell(program, &translation, arguments.prove, language);
    let is_certain = translation.is_certain();
    if arguments.prove && !is_certain {
        if let Some(output) = &arguments.output {
            let message = Message::new("cli.not-written").with("path", output.display());
            remark(&message.render(language));
        }
        return Outcome::Findings;
    }
    if !put(&translation.text, arguments.output.as_deref(), language) {
        return Outcome::Unusable;
    }
    if is_certain { Outcome::Clean } else { Outcome::Findings }
}

/// The program at `path`: a list, a drawing, or equations, which stand for a list.
pub(super) fn read(path: &Path, language: Language) -> Option<Program> {
    let is_equations = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("bool"));
    if !is_equations {
        return prove::read(path, language);
    }
    let unusable = |reason: &str, help: &'static str| {
        let reason = format!("{}: {reason}", path.display());
        complain("unreadable-input", &reason, &Message::new(help).render(language), language);
        None
    };
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) => return unusable(&error.to_string(), "cli.check-path"),
    };
    let target = Target::of(Model::Fx2n);
    match from_boolean::list(&text, target) {
        Ok(list) => Some(Program {
            path: path.to_path_buf(),
            document: Document::new(&list, Notation::FxIl, target),
            manifest: Arc::default(),
            beside: Arc::default(),
            encoding: None,
            fence: None,
        }),
        Err(problems) => {
            for problem in problems {
                let at = position_of(&text, problem.span.start as usize, Encoding::Utf32);
                let reason =
                    format!("{}:{}: {}", at.line + 1, at.column + 1, problem.message.render(language));
                unusable(&reason, "cli.equation-form");
            }
            None
        }
    }
}

/// Notes about rungs, and with `--prove` how many are proved.
fn tell(program: &Program, translation: &Translation, proves: bool, language: Language) {
    for rung in &translation.rungs {
        let Some(note) = &rung.note else { continue };
        let line = program.document.line_of(rung.span.start as usize) + 1;
        remark(
            &Message::new(if rung.is_kept { "cli.not-translated" } else { "cli.not-certain" })
                .with("path", program.path.display())
                .with("line", line)
                .with_messages("reason", vec![note.clone()])
                .render(language),
        );
    }
    if proves {
        // What is only a comment has nothing to prove.
        let rungs = || translation.rungs.iter().filter(|rung| !rung.result.is_empty());
        let count = |certificate| rungs().filter(|rung| rung.certificate == Some(certificate)).count();
        let summary = Message::new("cli.certificates")
            .with_messages("rungs", vec![rungs_counted(rungs().count())])
            .with("proved", count(Certificate::Proved))
            .with("construction", count(Certificate::Construction))
            .with("undecided", count(Certificate::Undecided));
        remark(&summary.render(language));
    }
}
