//! `rungwise prove`

use super::Outcome;
use super::input::{Program, complain, programs, put, say};
use crate::document::Document;
use crate::text::{Language, Message, Span};
use crate::translate::{Counterexample, Proof, Value, prove};
use clap::ValueEnum;
use serde_json::{Map, json};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A program.
    left: PathBuf,
    /// Another program for the same PLC.
    right: PathBuf,
    /// The shape of the result.
    #[arg(long, value_enum, default_value = "text")]
    format: ProofFormat,
    /// Write a scenario test that tells the programs apart to this file.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
}

/// The shape of a proof on standard output.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ProofFormat {
    /// For people.
    Text,
    /// One JSON document.
    Json,
}

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let [Some(left), Some(right)] = [&arguments.left, &arguments.right].map(|path| read(path, language))
    else {
        return Outcome::Unusable;
    };
    let sides = [&left.document, &right.document];
    let proof = prove(sides[0], sides[1]);
    let names = [left.path.display().to_string(), right.path.display().to_string()];
    match arguments.format {
        ProofFormat::Json => say(&format!("{:#}\n", as_json(&proof, sides, language))),
        ProofFormat::Text => say(&as_text(&proof, sides, &names, language)),
    }
    if let (Some(path), Proof::Different(found)) = (&arguments.scenario, &proof)
        && !put(&scenario(found, &names), Some(path), language)
    {
        return Outcome::Unusable;
    }
    match proof {
        Proof::Equal { .. } => Outcome::Clean,
        Proof::Different(_) | Proof::Undecided { .. } => Outcome::Findings,
    }
}

/// The one program at `path`; nothing after a complaint.
pub(super) fn read(path: &Path, language: Language) -> Option<Program> {
    let mut programs = programs(&[path.to_path_buf()], None, language)?;
    if programs.len() == 1 {
        return programs.pop();
    }
    let reason = Message::new("cli.one-program").with("path", path.display());
    let help = Message::new("cli.name-one-file").render(language);
    complain("several-programs", &reason.render(language), &help, language);
    None
}

fn as_json(proof: &Proof, sides: [&Document; 2], language: Language) -> serde_json::Value {
    let place = |at: &[Option<Span>; 2]| {
        let [left, right] = [0, 1].map(|side| at[side].map(|span| line(sides[side], span)));
        json!({ "left": left, "right": right })
    };
    match proof {
        Proof::Equal { is_reordered } => json!({ "equal": true, "reordered": is_reordered }),
        Proof::Undecided { reason, at } => {
            json!({ "equal": null, "reason": reason.render(language), "lines": place(at) })
        }
        Proof::Different(found) => {
            let inputs: Map<_, _> =
                found.inputs.iter().map(|(name, value)| (name.clone(), value_json(value))).collect();
            let [left, right] = found.sides.map(|value| json!({ found.what.clone(): value }));
            json!({
                "equal": false,
                "counterexample": {
                    "inputs": inputs,
                    "before": found.before,
                    "left": left,
                    "right": right,
                    "lines": place(&found.at),
                },
            })
        }
    }
}

fn value_json(value: &Value) -> serde_json::Value {
    match value {
        Value::Bit(value) => json!(value),
        Value::Word(value) => json!(value),
    }
}

fn as_text(proof: &Proof, sides: [&Document; 2], names: &[String; 2], language: Language) -> String {
    let place = |at: &[Option<Span>; 2]| {
        let places = [0, 1].map(|side| at[side].map(|span| (side, line(sides[side], span))));
        let shown = places.iter().flatten().map(|(side, line)| format!("{}:{line}", names[*side]));
        shown.collect::<Vec<_>>().join(", ")
    };
    match proof {
        Proof::Equal { is_reordered: false } => Message::new("prove.equal").render(language) + "\n",
        Proof::Equal { is_reordered: true } => Message::new("prove.equal-reordered").render(language) + "\n",
        Proof::Undecided { reason, at } => {
            let message = Message::new("prove.not-decided").with_messages("reason", vec![reason.clone()]);
            format!("{}\n", message.with("places", place(at)).render(language))
        }
        Proof::Different(found) => {
            let message = Message::new("prove.different").with("what", &found.what);
            let head = message.with("places", place(&found.at)).render(language);
            format!("{head}\n\n{}", picture(found, names, language))
        }
    }
}

/// The scan before and the scan that differs, side by side: `X0  __▆▆`.
fn picture(found: &Counterexample, names: &[String; 2], language: Language) -> String {
    let level = |on: bool| if on { "▆▆" } else { "__" };
    let mut rows: Vec<(String, String)> = Vec::new();
    for (name, value) in &found.inputs {
        rows.push(match value {
            Value::Bit(value) => {
                let before = found.before.get(name).copied().unwrap_or(*value);
                (name.clone(), format!("{}{}", level(before), level(*value)))
            }
            Value::Word(value) => (name.clone(), value.to_string()),
        });
    }
    for (name, value) in names.iter().zip(found.sides) {
        rows.push((
            Message::new("prove.in").with("what", &found.what).with("path", name).render(language),
            { format!("  {}", level(value)) },
        ));
    }
    let width = rows.iter().map(|(name, _)| crate::text::text_width(name)).max().unwrap_or(0);
    let pad = |name: &str| " ".repeat(width - crate::text::text_width(name));
    rows.iter().map(|(name, shown)| format!("  {name}{}  {shown}\n", pad(name))).collect()
}

/// A scenario test that the first program passes and the second fails.
fn scenario(found: &Counterexample, names: &[String; 2]) -> String {
    let mut text = format!(
        "# {} = {} in {}, {} in {}\n[[scenario]]\nname = \"{}\"\n",
        found.what, found.sides[0], names[0], found.sides[1], names[1], found.what
    );
    let quoted = |name: &str| format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""));
    let values = |values: Vec<(String, String)>| {
        let pairs = values.into_iter().map(|(name, value)| format!("{} = {value}", quoted(&name)));
        pairs.collect::<Vec<_>>().join(", ")
    };
    let now = found.inputs.iter().map(|(name, value)| {
        let value = match value {
            Value::Bit(value) => value.to_string(),
            Value::Word(value) => value.to_string(),
        };
        (name.clone(), value)
    });
    let before: Vec<_> = found.before.iter().map(|(name, value)| (name.clone(), value.to_string())).collect();
    let scan = if before.is_empty() { 0 } else { 1 };
    text += "set = [\n";
    if scan > 0 {
        text += &format!("  {{ scan = 0, values = {{ {} }} }},\n", values(before));
    }
    text += &format!("  {{ scan = {scan}, values = {{ {} }} }},\n]\n", values(now.collect()));
    let expected = values(vec![(found.what.clone(), found.sides[0].to_string())]);
    text + &format!("expect = [{{ scan = {scan}, values = {{ {expected} }} }}]\n")
}

fn line(document: &Document, span: Span) -> u32 {
    document.line_of(span.start as usize) + 1
}
