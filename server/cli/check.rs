//! `rungwise check`

use super::input::{Program, caution, programs, say};
use super::{Format, Outcome, paths_or_here, render};
use crate::document::Document;
use crate::ide;
use crate::target::Target;
use crate::text::{Diagnostic, Encoding, Fix, Language, Message, Severity, Span};
use clap::ValueEnum;
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Files, folders or projects; the current folder if left out.
    paths: Vec<PathBuf>,
    /// Check for this PLC, whatever the project says: fx1s, fx1n, fx2n, fx3u, iec.
    #[arg(long, value_parser = target_named)]
    target: Option<&'static Target>,
    /// The least severity that makes the exit code 1.
    #[arg(long, value_enum, default_value = "warning")]
    deny: Deny,
    /// The shape of the result.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Deny {
    Error,
    Warning,
    Hint,
}

/// So many findings of a file are drawn, the others are listed. Nobody reads more, and what is no program at all would
/// make drawings of a thousand times its size.
const MOST_DRAWN: usize = 200;

/// The numbers under a result.
#[derive(Default)]
struct Summary {
    errors: usize,
    warnings: usize,
    hints: usize,
    rungs: usize,
    steps: u32,
    capacity: u32,
}

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let Some(programs) = programs(&paths_or_here(&arguments.paths), arguments.target, language) else {
        return Outcome::Unusable;
    };
    for program in programs.iter().filter(|program| program.damaged) {
        let reason = Message::new("cli.not-utf-8").with("path", program.path.display()).render(language);
        caution("not-utf-8", &reason, &Message::new("cli.save-as-utf-8").render(language), language);
    }
    let tables = super::comments::findings(&programs);
    let mut checked = super::across::checked(programs, arguments.target);
    checked.extend(tables);
    let summary = Summary::of(&checked);
    match arguments.format {
        Format::Text => say_text(&checked, &summary, language),
        Format::Json => say(&format!("{:#}\n", as_json(&checked, &summary, language))),
    }
    if summary.denied(arguments.deny) > 0 { Outcome::Findings } else { Outcome::Clean }
}

impl Summary {
    fn of(checked: &[(Program, Vec<Diagnostic>)]) -> Summary {
        let mut summary = Summary::default();
        for (program, diagnostics) in checked {
            let count =
                |severity| diagnostics.iter().filter(|diagnostic| diagnostic.severity == severity).count();
            summary.errors += count(Severity::Error);
            summary.warnings += count(Severity::Warning);
            summary.hints += count(Severity::Hint);
            let status = ide::status(&program.document);
            summary.rungs += status.rungs;
            summary.steps += status.steps.unwrap_or(0);
            summary.capacity = summary.capacity.max(status.capacity);
        }
        summary
    }

    fn denied(&self, least: Deny) -> usize {
        match least {
            Deny::Error => self.errors,
            Deny::Warning => self.errors + self.warnings,
            Deny::Hint => self.errors + self.warnings + self.hints,
        }
    }

    /// `check passed: 4 rungs, 31 of 8000 steps`, or the numbers of what was found.
    fn sentence(&self) -> Message {
        let rungs = counted(self.rungs, "counted.rung", "counted.rungs");
        let hints = counted(self.hints, "counted.hint", "counted.hints");
        let size = match self.capacity {
            0 => rungs,
            capacity => Message::new("counted.size")
                .with_messages("rungs", vec![rungs])
                .with("steps", self.steps)
                .with("capacity", capacity),
        };
        let message = match (self.errors, self.warnings, self.hints) {
            (0, 0, 0) => Message::new("counted.passed"),
            (0, 0, _) => Message::new("counted.passed-with-hints").with_messages("hints", vec![hints]),
            (errors, warnings, _) => {
                let errors = counted(errors, "counted.error", "counted.errors");
                let warnings = counted(warnings, "counted.warning", "counted.warnings");
                Message::new("counted.failed").with_messages("counts", vec![errors, warnings, hints])
            }
        };
        message.with_messages("size", vec![size])
    }
}

fn counted(count: usize, one: &'static str, many: &'static str) -> Message {
    Message::new(if count == 1 { one } else { many }).with("count", count)
}

fn say_text(checked: &[(Program, Vec<Diagnostic>)], summary: &Summary, language: Language) {
    let colours = render::Colours::new(super::input::coloured());
    for (program, diagnostics) in checked {
        let name = program.path.display().to_string();
        let (drawn, listed) = diagnostics.split_at(diagnostics.len().min(MOST_DRAWN));
        for diagnostic in drawn {
            say(&render::diagnostic(&name, program, diagnostic, &colours, language));
        }
        for diagnostic in listed {
            say(&render::headline(&name, &program.document, diagnostic, &colours, language));
        }
    }
    say(&format!("{}\n", summary.sentence().render(language)));
}

fn as_json(checked: &[(Program, Vec<Diagnostic>)], summary: &Summary, language: Language) -> Value {
    let files: Vec<Value> = checked
        .iter()
        .map(|(program, diagnostics)| {
            let status = ide::status(&program.document);
            let diagnostics: Vec<Value> =
                diagnostics.iter().map(|found| diagnostic_json(program, found, language)).collect();
            json!({
                "path": program.path.display().to_string(),
                "target": status.target,
                "dialect": status.dialect,
                "rungs": status.rungs,
                "steps": status.steps,
                "diagnostics": diagnostics,
            })
        })
        .collect();
    json!({
        "files": files,
        "summary": {
            "errors": summary.errors,
            "warnings": summary.warnings,
            "hints": summary.hints,
            "rungs": summary.rungs,
            "steps": summary.steps,
            "capacity": summary.capacity,
        },
    })
}

fn diagnostic_json(program: &Program, diagnostic: &Diagnostic, language: Language) -> Value {
    let path = program.path.display().to_string();
    let range_in = |document: &Document, span: Span| {
        let position = |offset: u32| {
            let position = document.position(offset as usize, Encoding::Utf32);
            json!({"line": position.line + 1, "column": position.column + 1})
        };
        json!({"start": position(span.start), "end": position(span.end)})
    };
    let range = |span: Span| range_in(&program.document, span);
    let related = diagnostic.related.iter().map(|related| {
        let message = related.message.render(language);
        let (path, document) = program.file(related, &path);
        json!({"path": path, "range": range_in(document, related.span), "message": message})
    });
    let fix = |fix: &Fix| {
        let edits =
            fix.edits.iter().map(|edit| json!({"path": path, "range": range(edit.span), "text": edit.text}));
        json!({"title": fix.title.render(language), "edits": edits.collect::<Vec<_>>()})
    };
    json!({
        "code": diagnostic.code,
        "severity": severity_word(diagnostic.severity),
        "message": diagnostic.message.render(language),
        "range": range(diagnostic.span),
        "related": related.collect::<Vec<_>>(),
        "fixes": diagnostic.fixes.iter().map(fix).collect::<Vec<_>>(),
    })
}

pub(super) fn severity_word(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Hint => "hint",
    }
}

fn target_named(name: &str) -> Result<&'static Target, String> {
    Target::named(name).ok_or_else(|| {
        let names = Target::ALL.iter().map(|target| target.name);
        Message::new("cli.no-such-target").with_words("names", names, ", ").render(super::language::spoken())
    })
}
