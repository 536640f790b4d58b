//! `rungwise import`

use super::Outcome;
use super::input::{caution, complain, put, say};
use crate::ladder::{self, ImportError};
use crate::text::{Language, Message};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A file of LDmicro (.ld), or its text export.
    file: PathBuf,
    /// Where the .lad file is written; standard output if left out.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// What could not be carried over makes the exit code 1; the file is written all the same.
pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let path = arguments.file.display();
    let words = |key: &'static str| Message::new(key).with("path", path.to_string()).render(language);
    let bytes = match std::fs::read(&arguments.file) {
        Ok(bytes) => bytes,
        Err(reason) => {
            complain(
                "unreadable-input",
                &format!("{path}: {reason}"),
                &words("import.unreadable-help"),
                language,
            );
            return Outcome::Unusable;
        }
    };
    // The program writes the character set of its system; logic and names are ASCII, so comments alone can suffer.
    let source = String::from_utf8_lossy(&bytes);
    let imported = match ladder::import(&source, &program_name(&arguments.file), language) {
        Ok(imported) => imported,
        Err(ImportError::Unknown) => {
            complain("unknown-format", &words("import.unknown"), &words("import.unknown-help"), language);
            return Outcome::Unusable;
        }
        Err(ImportError::Unproven) => {
            complain("import-unproven", &words("import.unproven"), &words("import.unproven-help"), language);
            return Outcome::Findings;
        }
    };
    if !put(&imported.text, arguments.output.as_deref(), language) {
        return Outcome::Unusable;
    }
    if let Some(output) = &arguments.output {
        let done = Message::new("import.done").with("path", output.display()).with("rungs", imported.rungs);
        say(&format!("{}\n", done.render(language)));
    }
    for note in &imported.notes {
        let place = format!("{path}:{}: {}", note.line, note.message.render(language));
        caution("import-note", &place, &words("import.note-help"), language);
    }
    if imported.notes.is_empty() { Outcome::Clean } else { Outcome::Findings }
}

/// The name of the program: that of the file.
fn program_name(path: &Path) -> String {
    path.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned())
}
