//! `rungwise usage`

use super::input::{Program, folder_of, programs, say};
use super::{Outcome, paths_or_here};
use crate::document::{Document, Member, ProjectView};
use crate::ide::{self, Usage};
use crate::text::{Language, csv_line};
use clap::ValueEnum;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Files, folders or projects; the current folder if left out.
    paths: Vec<PathBuf>,
    /// The shape of the result.
    #[arg(long, value_enum, default_value = "text")]
    format: TableFormat,
}

/// The shape of a table on standard output.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TableFormat {
    /// For people.
    Text,
    /// One JSON document.
    Json,
    /// One line for each device, for spreadsheets.
    Csv,
}

/// The programs of one project, or one program that stands alone.
struct Group {
    files: Vec<(String, Document)>,
}

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let Some(programs) = programs(&paths_or_here(&arguments.paths), None, language) else {
        return Outcome::Unusable;
    };
    let groups = groups(programs);
    let mut projects = Vec::new();
    let mut output = String::new();
    for group in &groups {
        let members = group.files.iter().map(|(name, document)| Member { name, document }).collect();
        let Some(view) = ProjectView::new(members, 0, true) else { continue };
        let usage = ide::usage(&view);
        match arguments.format {
            TableFormat::Json => projects.push(as_json(&usage, group, language)),
            TableFormat::Csv => output += &as_csv(&usage, group, output.is_empty()),
            TableFormat::Text => {
                let separator = if output.is_empty() { "" } else { "\n" };
                output += &format!("{separator}{}", usage.text(&view, language));
            }
        }
    }
    if arguments.format == TableFormat::Json {
        output = format!("{:#}\n", json!({ "projects": projects }));
    }
    say(&output);
    Outcome::Clean
}

/// Files of one project belong together, in the order in which they came; others stand alone.
fn groups(programs: Vec<Program>) -> Vec<Group> {
    let mut places: BTreeMap<PathBuf, usize> = BTreeMap::new();
    let mut groups: Vec<Group> = Vec::new();
    for program in programs {
        let file = (program.path.display().to_string(), program.document);
        let root = folder_of(&program.path);
        let known = root.as_ref().and_then(|root| places.get(root)).copied();
        match known.and_then(|place| groups.get_mut(place)) {
            Some(group) => group.files.push(file),
            None => {
                if let Some(root) = root {
                    places.insert(root, groups.len());
                }
                groups.push(Group { files: vec![file] });
            }
        }
    }
    groups
}

impl Group {
    fn path(&self, number: usize) -> &str {
        self.files.get(number).map_or("", |(path, _)| path)
    }
}

/// `{"target", "files", "kinds": […], "devices": […]}` with a row of [`UsedKind::json`] for each kind, and one of
/// [`UsageRow::json`] for each device, whose uses have a `path`.
///
/// [`UsedKind::json`]: crate::ide::UsedKind::json
/// [`UsageRow::json`]: crate::ide::UsageRow::json
fn as_json(usage: &Usage, group: &Group, language: Language) -> Value {
    let path = |file: usize| vec![("path", json!(group.path(file)))];
    let files: Vec<&str> = group.files.iter().map(|(path, _)| path.as_str()).collect();
    json!({
        "target": group.files.first().map(|(_, document)| document.target().name),
        "files": files,
        "kinds": usage.kinds.iter().map(|kind| kind.json(language)).collect::<Vec<_>>(),
        "devices": usage.rows.iter().map(|row| row.json(path)).collect::<Vec<_>>(),
    })
}

/// One line for each device. Parted by blanks are its uses, `main.il:3:read`, and, in the last field, the free devices
/// between it and the next one in use, `M3 M5-M7`.
fn as_csv(usage: &Usage, group: &Group, with_header: bool) -> String {
    let mut text = String::new();
    if with_header {
        text += "device,symbol,comment,latched,preset,reads,writes,uses,gaps\n";
    }
    for row in &usage.rows {
        let uses =
            row.uses.iter().map(|at| format!("{}:{}:{}", group.path(at.file), at.line + 1, at.access_word()));
        let gaps = row.gaps.iter().map(|(first, last)| match first == last {
            true => first.to_string(),
            false => format!("{first}-{last}"),
        });
        let fields = [
            row.full_name(),
            row.symbol.clone(),
            row.comment.clone(),
            row.is_latched.to_string(),
            row.preset.clone(),
            row.reads.to_string(),
            row.writes.to_string(),
            uses.collect::<Vec<_>>().join(" "),
            gaps.collect::<Vec<_>>().join(" "),
        ];
        text += &csv_line(fields);
    }
    text
}
