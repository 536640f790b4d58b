//! `rungwise fmt`

use super::colour::Colour;
use super::diff;
use super::input::{Program, complain, programs, remark, say, say_bytes};
use super::{Outcome, paths_or_here};
use crate::ide::{self, Style};
use crate::project::{FormatStyle, encoding};
use crate::text::{Language, Message, Span, TextEdit};
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
pub(super) enum StyleName {
    Iec,
    Brackets,
    Unicode,
}

pub(super) fn run(arguments: &Arguments, colour: Colour, language: Language) -> Outcome {
    let Some(programs) = programs(&paths_or_here(&arguments.paths), None, language) else {
        return Outcome::Unusable;
    };
    let mut outcome = Outcome::Clean;
    for file in programs.chunk_by(|one, next| one.path == next.path) {
        let result = format_file(file, arguments, colour, language);
        if outcome != Outcome::Unusable && result != Outcome::Clean {
            outcome = result;
        }
    }
    outcome
}

/// `programs` are those of one file: one, or the fences of a Markdown text.
fn format_file(programs: &[Program], arguments: &Arguments, colour: Colour, language: Language) -> Outcome {
    let Some(program) = programs.first() else { return Outcome::Clean };
    let path = program.path.display();
    let left = |code: &str, reason: &'static str, help: &'static str| {
        let reason = Message::new(reason).with("path", program.path.display()).render(language);
        complain(code, &reason, &Message::new(help).render(language), language);
        Outcome::Unusable
    };
    let Some(encoding) = program.encoding else {
        return left("not-utf-8", "cli.not-utf-8-left", "cli.save-as-utf-8");
    };
    let style = style_of(program, arguments.style);
    let (text, formatted) = match &program.fence {
        None => (program.document.text(), formatted(program, style)),
        Some(fence) => {
            let mut text = fence.text.to_string();
            // From the last to the first, so that the places of the others hold.
            for program in programs.iter().rev() {
                if let Some(fence) = &program.fence {
                    text.replace_range(fence.content.clone(), &formatted(program, style));
                }
            }
            (fence.text.to_string(), text)
        }
    };
    programs.iter().for_each(|program| tell_kept(program, style_of(program, arguments.style), language));
    // The canonical form has no characters that the program has not, but those of a style.
    let Some(bytes) = encoding::write(&formatted, encoding) else {
        return left("not-utf-8", "cli.not-utf-8-left", "cli.save-as-utf-8");
    };
    if arguments.stdout {
        say_bytes(&bytes);
        return Outcome::Clean;
    }
    if formatted == text {
        return Outcome::Clean;
    }
    if arguments.check {
        say(&diff::unified([&path.to_string(); 2], &text, &formatted, colour));
        return Outcome::Findings;
    }
    // Renaming would replace a file that its owner locked.
    if std::fs::metadata(&program.path).is_ok_and(|file| file.permissions().readonly()) {
        return left("unwritable", "cli.read-only", "cli.file-as-it-was");
    }
    match write_whole(&program.path, &bytes) {
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

/// Says which rungs of a program stay as they were drawn, and why.
fn tell_kept(program: &Program, style: Style, language: Language) {
    // Lines are counted from the start of the file, also those of a fence.
    let above = program.fence.as_ref().map_or(0, |fence| {
        let lines = |text: &str| text.matches('\n').count();
        let own = lines(&program.document.slice(Span::new(0, fence.before)));
        lines(fence.text.get(..fence.content.start).unwrap_or("")).saturating_sub(own) as u32
    });
    for (span, reason) in ide::kept_rungs(&program.document, style) {
        let message = Message::new("cli.kept")
            .with("path", program.path.display())
            .with("line", program.document.line_of(span.start as usize) + 1 + above)
            .with("reason", reason.render(language));
        remark(&message.render(language));
    }
}

/// The canonical text of a program; that of a fence without the lines before it, which stay as they are.
fn formatted(program: &Program, style: Style) -> String {
    let before = program.fence.as_ref().map_or(0, |fence| fence.before);
    let mut edits = match &program.fence {
        Some(fence) if fence.is_indented => Vec::new(),
        _ => ide::format(&program.document, style),
    };
    edits.retain(|edit| edit.span.start as usize >= before);
    let text = TextEdit::apply_all(&edits, &program.document.text());
    text.get(before..).unwrap_or("").to_string()
}

pub(super) fn style_of(program: &Program, name: Option<StyleName>) -> Style {
    let kind = match name {
        Some(StyleName::Iec) => FormatStyle::Iec,
        Some(StyleName::Brackets) => FormatStyle::Brackets,
        Some(StyleName::Unicode) => FormatStyle::Unicode,
        None => program.manifest.format.style,
    };
    Style { kind, width: program.manifest.format.width }
}

/// Writes beside the file and then renames, so that a full disk or a pulled plug never leaves half a program.
fn write_whole(path: &std::path::Path, bytes: &[u8]) -> std::io::Result<()> {
    let path = path.canonicalize()?;
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".rungwise-new");
    let beside = path.with_file_name(name);
    let result = std::fs::write(&beside, bytes)
        .and_then(|()| std::fs::set_permissions(&beside, std::fs::metadata(&path)?.permissions()))
        .and_then(|()| std::fs::rename(&beside, &path));
    if result.is_err() {
        // The first failure is the one to tell; a file left over is only untidy.
        let _ = std::fs::remove_file(&beside);
    }
    result
}
