//! The result of a check as a log of SARIF 2.1.0, the OASIS standard that code hosts and build servers read.

use super::input::Program;
use crate::check::{RULES, Rule};
use crate::document::Document;
use crate::text::{Diagnostic, Encoding, Fix, Language, Severity, Span};
use serde_json::{Value, json};
use std::path::{Component, Path};

/// One run with the rules that found something, their findings and fixes. Columns count Unicode scalar values.
pub(super) fn log(checked: &[(Program, Vec<Diagnostic>)], language: Language) -> Value {
    let found = || checked.iter().flat_map(|(_, found)| found);
    let rules: Vec<&Rule> =
        RULES.iter().copied().filter(|rule| found().any(|found| found.code == rule.code)).collect();
    let results: Vec<Value> = checked
        .iter()
        .flat_map(|(program, found)| found.iter().map(|found| result(program, found, &rules, language)))
        .collect();
    let artifacts: Vec<Value> =
        checked.iter().map(|(program, _)| json!({"location": {"uri": uri(&program.path)}})).collect();
    json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": {"driver": {
                "name": "rungwise",
                "version": env!("CARGO_PKG_VERSION"),
                "semanticVersion": env!("CARGO_PKG_VERSION"),
                "language": language.tag(),
                "rules": rules.iter().map(|rule| descriptor(rule, language)).collect::<Vec<_>>(),
            }},
            "columnKind": "unicodeCodePoints",
            "artifacts": artifacts,
            "results": results,
        }],
    })
}

fn descriptor(rule: &Rule, language: Language) -> Value {
    let page = rule.page_in(language);
    json!({
        "id": rule.code,
        "shortDescription": {"text": rule.summary(language)},
        "help": {"text": page, "markdown": page},
        "defaultConfiguration": {"level": level(rule.severity)},
    })
}

fn result(program: &Program, found: &Diagnostic, rules: &[&Rule], language: Language) -> Value {
    let own = program.path.to_string_lossy();
    let mut result = json!({
        "ruleId": found.code,
        "level": level(found.severity),
        "message": {"text": found.message.render(language)},
        "locations": [location(&program.path, &program.document, found.span)],
    });
    let related = found.related.iter().enumerate().map(|(id, related)| {
        let (path, document) = program.file(related, &own);
        let mut place = location(Path::new(path), document, related.span);
        place["id"] = json!(id);
        place["message"] = json!({"text": related.message.render(language)});
        place
    });
    let parts = [
        ("ruleIndex", rules.iter().position(|rule| rule.code == found.code).map(|index| json!(index))),
        ("relatedLocations", list(related.collect())),
        ("fixes", list(found.fixes.iter().map(|made| fix(program, made, language)).collect())),
    ];
    for (name, value) in parts {
        if let Some(value) = value {
            result[name] = value;
        }
    }
    result
}

/// An empty list is left out.
fn list(values: Vec<Value>) -> Option<Value> {
    (!values.is_empty()).then_some(Value::Array(values))
}

fn fix(program: &Program, fix: &Fix, language: Language) -> Value {
    let replacements = fix.edits.iter().map(|edit| {
        let mut replacement = json!({"deletedRegion": region(&program.document, edit.span)});
        if !edit.text.is_empty() {
            replacement["insertedContent"] = json!({"text": edit.text});
        }
        replacement
    });
    json!({
        "description": {"text": fix.title.render(language)},
        "artifactChanges": [{
            "artifactLocation": {"uri": uri(&program.path)},
            "replacements": replacements.collect::<Vec<_>>(),
        }],
    })
}

fn location(path: &Path, document: &Document, span: Span) -> Value {
    let artifact = json!({"uri": uri(path)});
    json!({"physicalLocation": {"artifactLocation": artifact, "region": region(document, span)}})
}

/// Lines and columns from 1; the end column is one past the last character.
fn region(document: &Document, span: Span) -> Value {
    let place = |offset: u32| document.position(offset as usize, Encoding::Utf32);
    let (start, end) = (place(span.start), place(span.end));
    json!({
        "startLine": start.line + 1,
        "startColumn": start.column + 1,
        "endLine": end.line + 1,
        "endColumn": end.column + 1,
    })
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Hint => "note",
    }
}

/// The path as a URI reference: relative as it was given, with `/` between folders.
fn uri(path: &Path) -> String {
    let mut uri = String::new();
    for part in path.components() {
        match part {
            Component::CurDir => continue,
            Component::RootDir => uri.push('/'),
            Component::Prefix(drive) => {
                uri += &format!("file:///{}", escaped(&drive.as_os_str().to_string_lossy()))
            }
            Component::ParentDir => push(&mut uri, ".."),
            Component::Normal(name) => push(&mut uri, &escaped(&name.to_string_lossy())),
        }
    }
    if path.has_root() && !uri.starts_with("file:") { format!("file://{uri}") } else { uri }
}

fn push(uri: &mut String, part: &str) {
    if !uri.is_empty() && !uri.ends_with('/') {
        uri.push('/');
    }
    uri.push_str(part);
}

/// What a URI cannot hold, percent-encoded.
fn escaped(name: &str) -> String {
    let mut uri = String::new();
    for byte in name.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            uri += &format!("%{byte:02X}");
        }
    }
    uri
}
