//! `rungwise check`

use super::colour::Colour;
use super::input::{Program, caution, programs, say};
use super::{Format, Outcome, paths_or_here, render, sarif};
use crate::document::Document;
use crate::ide::{self, Summary};
use crate::target::Target;
use crate::text::{Diagnostic, Encoding, Fix, Language, Message, Span};
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

pub(super) fn run(arguments: &Arguments, colour: Colour, language: Language) -> Outcome {
    let Some(programs) = programs(&paths_or_here(&arguments.paths), arguments.target, language) else {
        return Outcome::Unusable;
    };
    for program in programs.iter().filter(|program| program.encoding.is_none()) {
        let reason = Message::new("cli.not-utf-8").with("path", program.path.display()).render(language);
        caution("not-utf-8", &reason, &Message::new("cli.save-as-utf-8").render(language), language);
    }
    let tables = super::comments::findings(&programs);
    let mut checked = super::across::checked(programs, arguments.target);
    checked.extend(tables);
    let mut summary = Summary::default();
    checked.iter().for_each(|(program, found)| summary.add(&program.document, found));
    match arguments.format {
        Format::Text => say_text(&checked, &summary, colour, language),
        Format::Json => say(&format!("{:#}\n", as_json(&checked, &summary, language))),
        Format::Sarif => say(&format!("{:#}\n", sarif::log(&checked, language))),
    }
    // The process ends now; giving back a million pieces of memory one by one would take longer than the system does.
    std::mem::forget(checked);
    if denied(&summary, arguments.deny) > 0 { Outcome::Findings } else { Outcome::Clean }
}

fn denied(summary: &Summary, least: Deny) -> usize {
    match least {
        Deny::Error => summary.errors,
        Deny::Warning => summary.errors + summary.warnings,
        Deny::Hint => summary.errors + summary.warnings + summary.hints,
    }
}

fn say_text(checked: &[(Program, Vec<Diagnostic>)], summary: &Summary, colour: Colour, language: Language) {
    let colours = render::Colours::new(colour.on());
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
            "steps": summary.steps.unwrap_or(0),
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
        "severity": diagnostic.severity.word(),
        "message": diagnostic.message.render(language),
        "range": range(diagnostic.span),
        "related": related.collect::<Vec<_>>(),
        "fixes": diagnostic.fixes.iter().map(fix).collect::<Vec<_>>(),
    })
}

pub(super) fn target_named(name: &str) -> Result<&'static Target, String> {
    Target::named(name).ok_or_else(|| {
        let names = Target::ALL.iter().map(|target| target.name);
        Message::new("cli.no-such-target").with_words("names", names, ", ").render(super::language::spoken())
    })
}
