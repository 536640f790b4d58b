//! `rungwise fmt`

use super::colour::Colour;
use super::diff;
use super::input::{Program, complain, programs, say};
use super::{Outcome, paths_or_here};
use crate::ide::{self, Style};
use crate::project::FormatStyle;
use crate::text::{Language, Message, TextEdit};
use clap::ValueEnum;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Files, folders or projects; the current folder if left out.
    paths: Vec<PathBuf>,
    /// Change nothing; show what would change as a diff, and exit with 1 if anything would.
    #[arg(long, conflicts_with = "stdout")]
    check: bool,
    /// Write the result to standard output and leave the files alone.
    #[arg(long)]
    stdout: bool,
    /// The look of ladder, whatever the project says.
    #[arg(long, value_enum)]
    style: Option<StyleName>,
}

#[derive(Clone, Copy, ValueEnum)]
enum StyleName {
    Iec,
    Brackets,
    Unicode,
}

pub(super) fn run(arguments: &Arguments, colour: Colour, language: Language) -> Outcome {
    let Some(programs) = programs(&paths_or_here(&arguments.paths), None, language) else {
        return Outcome::Unusable;
    };
    let mut outcome = Outcome::Clean;
    for program in programs {
        let result = format_one(&program, arguments, colour, language);
        if outcome != Outcome::Unusable && result != Outcome::Clean {
            outcome = result;
        }
    }
    outcome
}

fn format_one(program: &Program, arguments: &Arguments, colour: Colour, language: Language) -> Outcome {
    let path = program.path.display();
    if program.damaged {
        let reason = Message::new("cli.not-utf-8-left").with("path", path).render(language);
        complain("not-utf-8", &reason, &Message::new("cli.save-as-utf-8").render(language), language);
        return Outcome::Unusable;
    }
    let style = style_of(program, arguments.style);
    let text = program.document.text();
    let formatted = TextEdit::apply_all(&ide::format(&program.document, style), &text);
    if arguments.stdout {
        say(&formatted);
        return Outcome::Clean;
    }
    if formatted == text {
        return Outcome::Clean;
    }
    if arguments.check {
        say(&diff::unified(&path.to_string(), &text, &formatted, colour));
        return Outcome::Findings;
    }
    // Renaming would replace a file that its owner locked.
    if std::fs::metadata(&program.path).is_ok_and(|file| file.permissions().readonly()) {
        let reason = Message::new("cli.read-only").with("path", path).render(language);
        complain("unwritable", &reason, &Message::new("cli.file-as-it-was").render(language), language);
        return Outcome::Unusable;
    }
    match write_whole(&program.path, &formatted) {
        Ok(()) => {
            say(&format!("{path}\n"));
            Outcome::Clean
        }
        Err(reason) => {
            let help = Message::new("cli.file-as-it-was").render(language);
            complain("unwritable", &format!("{path}: {reason}"), &help, language);
            Outcome::Unusable
        }
    }
}

fn style_of(program: &Program, name: Option<StyleName>) -> Style {
    let kind = match name {
        Some(StyleName::Iec) => FormatStyle::Iec,
        Some(StyleName::Brackets) => FormatStyle::Brackets,
        Some(StyleName::Unicode) => FormatStyle::Unicode,
        None => program.manifest.format.style,
    };
    Style { kind, width: program.manifest.format.width }
}

/// Writes beside the file and then renames, so that a full disk or a pulled plug never leaves half a program.
fn write_whole(path: &std::path::Path, text: &str) -> std::io::Result<()> {
    let path = path.canonicalize()?;
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".rungwise-new");
    let beside = path.with_file_name(name);
    let result = std::fs::write(&beside, text)
        .and_then(|()| std::fs::set_permissions(&beside, std::fs::metadata(&path)?.permissions()))
        .and_then(|()| std::fs::rename(&beside, &path));
    if result.is_err() {
        // The first failure is the one to tell; a file left over is only untidy.
        let _ = std::fs::remove_file(&beside);
    }
    result
}
