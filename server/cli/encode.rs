//! `rungwise encode`

use super::across::whole_program;
use super::check::target_named;
use super::input::{Program, complain, put};
use super::{Outcome, render, translate};
use crate::machine_code;
use crate::target::{Model, Target};
use crate::text::{Language, Message};
use crate::translate::to_machine_code;
use clap::ValueEnum;
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A program, or a project.
    file: PathBuf,
    /// The shape of the words.
    #[arg(long, value_enum, default_value = "hex")]
    format: CodeFormat,
    /// The FX model that the words are for [default: that of the project or of the program].
    #[arg(long, value_parser = target_named)]
    target: Option<&'static Target>,
    /// Write the result to this file, not to standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The shape of machine code.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum CodeFormat {
    /// Four hexadecimal digits for each word, an instruction a line.
    Hex,
    /// One JSON document, with the line and the steps of each instruction.
    Json,
}

/// The files of a program with their machine code, in the order of execution.
pub(super) struct Encoded {
    /// What the words are for.
    pub target: &'static Target,
    /// Each file and what it became; the steps of each begin at 0.
    pub files: Vec<(Program, machine_code::Program)>,
}

impl Encoded {
    /// All words, as they lie in the memory of the PLC.
    pub(super) fn words(&self) -> Vec<u16> {
        self.files.iter().flat_map(|(_, program)| program.words.iter().copied()).collect()
    }
}

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let encoded = match encoded(&arguments.file, arguments.target, language) {
        Ok(encoded) => encoded,
        Err(outcome) => return outcome,
    };
    let text = match arguments.format {
        CodeFormat::Hex => hex(&encoded),
        CodeFormat::Json => json(&encoded),
    };
    if put(&text, arguments.output.as_deref(), language) { Outcome::Clean } else { Outcome::Unusable }
}

/// The machine code of the program or project at `path`.
///
/// # Errors
/// With the outcome, after complaints.
pub(super) fn encoded(
    path: &Path,
    asked: Option<&'static Target>,
    language: Language,
) -> Result<Encoded, Outcome> {
    if let Some(asked) = asked.filter(|asked| !asked.is_fx()) {
        let reason = Message::new("cli.no-words").with("target", asked.name).render(language);
        complain("target-refused", &reason, &Message::new("cli.name-fx-model").render(language), language);
        return Err(Outcome::Unusable);
    }
    let is_equations = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("bool"));
    let programs = match is_equations {
        true => translate::read(path, language).map(|program| vec![program]),
        false => whole_program(path, language),
    };
    let programs = programs.ok_or(Outcome::Unusable)?;
    let target = asked.or_else(|| programs.first().and_then(target_of)).unwrap_or(Target::of(Model::Fx2n));
    let last = programs.len().saturating_sub(1);
    let (mut files, mut is_whole) = (Vec::new(), true);
    for (number, program) in programs.into_iter().enumerate() {
        match to_machine_code::encode(&program.document, target, number == last) {
            Ok(words) => files.push((program, words)),
            Err(found) => {
                is_whole = false;
                let colours = render::Colours::new(false);
                let path = program.path.display().to_string();
                for found in found {
                    let told = render::diagnostic(&path, &program, &found, &colours, language);
                    let _ = std::io::stderr().write_all(told.as_bytes());
                }
            }
        }
    }
    let encoded = Encoded { target, files };
    let steps = encoded.words().len();
    if is_whole && steps > target.limits.steps_at_most as usize {
        is_whole = false;
        let reason = Message::new("machine-code.too-many-steps")
            .with("steps", steps)
            .with("target", target.title)
            .with("most", target.limits.steps_at_most)
            .render(language);
        complain(
            machine_code::NO_MACHINE_CODE,
            &reason,
            &Message::new("cli.run-check").render(language),
            language,
        );
    }
    if is_whole { Ok(encoded) } else { Err(Outcome::Findings) }
}

/// The model of a program: its own, or that of its project.
fn target_of(program: &Program) -> Option<&'static Target> {
    let own = program.document.target();
    if own.is_fx() { Some(own) } else { program.manifest.fx_target() }
}

fn hex(encoded: &Encoded) -> String {
    let mut text = String::new();
    for (_, program) in &encoded.files {
        for line in &program.lines {
            text += &digits(program.words_of(line)).join(" ");
            text.push('\n');
        }
    }
    text
}

fn json(encoded: &Encoded) -> String {
    let words = encoded.words();
    let mut map = Vec::new();
    let mut first = 0;
    for (file, program) in &encoded.files {
        for line in &program.lines {
            let code = program.words_of(line);
            let listing = machine_code::decode(code, encoded.target.model);
            let mut entry = json!({
                "line": file.document.line_of(line.span.start as usize) + 1,
                "step": first + line.step,
                "words": digits(code),
                "text": listing.text.trim_end(),
            });
            if encoded.files.len() > 1 {
                entry["path"] = file.path.display().to_string().into();
            }
            map.push(entry);
        }
        first += program.words.len() as u32;
    }
    let document = json!({ "model": encoded.target.name, "steps": words.len(), "words": words, "map": map });
    format!("{document}\n")
}

fn digits(words: &[u16]) -> Vec<String> {
    words.iter().map(|word| format!("{word:04X}")).collect()
}
