//! The folder `examples/mistakes`: each file has the mistake that its name says, and no other.

use rungwise::check::{self, RULES, Severities};
use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::text::{Encoding, Language, Severity};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Rules whose finding needs more than a drawing by hand.
const WITHOUT_FILE: &[&str] = &[];

fn drawings(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(folder);
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|end| end == "lad")).collect();
    files.sort();
    files
}

/// What is found in a drawing, one line each: severity, code, place, words.
fn findings(path: &Path, target: &'static Target) -> Vec<(Severity, &'static str, String)> {
    let text = std::fs::read_to_string(path).unwrap();
    let document = Document::new(&text, Notation::Ladder, target);
    let found = check::all(&document, &Severities::default());
    let line = |diagnostic: &rungwise::text::Diagnostic| {
        let at = document.position(diagnostic.span.start as usize, Encoding::Utf32);
        let words = diagnostic.message.render(Language::English);
        format!("{}:{} {} {words}", at.line + 1, at.column + 1, diagnostic.code)
    };
    found.iter().map(|diagnostic| (diagnostic.severity, diagnostic.code, line(diagnostic))).collect()
}

#[test]
fn each_file_has_its_mistake_and_no_other() {
    let mut wrong = Vec::new();
    for path in drawings("mistakes") {
        let code = path.file_stem().unwrap().to_str().unwrap().to_string();
        let found = findings(&path, Target::of(Model::Fx2n));
        let own = found.iter().filter(|(_, found, _)| *found == code).count();
        let others = found.iter().any(|(severity, found, _)| *found != code && *severity != Severity::Hint);
        if own != 1 || others {
            let lines: Vec<&str> = found.iter().map(|(_, _, line)| line.as_str()).collect();
            wrong.push(format!("{code}:\n    {}", lines.join("\n    ")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn each_rule_about_drawings_has_a_file() {
    let files: BTreeSet<String> = drawings("mistakes")
        .iter()
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_string())
        .collect();
    let group = Path::new(env!("CARGO_MANIFEST_DIR")).join("server/check/drawing");
    let rules: BTreeSet<String> = RULES
        .iter()
        .map(|rule| rule.code.to_string())
        .filter(|code| group.join(format!("{}.rs", code.replace('-', "_"))).exists())
        .filter(|code| !WITHOUT_FILE.contains(&code.as_str()))
        .collect();
    assert_eq!(files, rules);
}

#[test]
fn the_other_drawings_are_clean_and_canonical() {
    let mut wrong = Vec::new();
    for (folder, model) in
        [("motor", Model::Fx2n), ("traffic-lights", Model::Fx1s), ("tank-level", Model::Fx2n)]
    {
        for path in drawings(folder) {
            let target = Target::of(model);
            wrong.extend(findings(&path, target).into_iter().map(|(_, _, line)| format!("{folder}: {line}")));
            let text = std::fs::read_to_string(&path).unwrap();
            let formatted = rungwise::ladder::format(&text, target, &rungwise::ladder::Style::default());
            if formatted != text {
                wrong.push(format!("{folder} is not canonical; formatted:\n{formatted}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
