//! How a proof about two programs is told.

use super::{Counterexample, Proof, Shown, Value};
use crate::document::Document;
use crate::target::iec::real_spelled;
use crate::text::{Encoding, Language, Message, Span, text_width};
use serde_json::{Map, Value as Json, json};
use std::collections::{BTreeMap, BTreeSet};

/// The JSON of `prove`: `{"equal", "counterexample": {"inputs", "before", "left", "right", "lines", "run", "reason"}}`.
/// `run` says how the simulated PLC shows the difference: `{"scan_ms", "first", "last"}`, the time of a scan, the
/// number of the one that begins with the inputs and that of the one that shows it, from 0. Where it is `null`,
/// `reason` says why the simulated PLC does not.
pub fn json(proof: &Proof, sides: [&Document; 2], language: Language) -> Json {
    let place = |at: &[Option<Span>; 2]| {
        let [left, right] = [0, 1].map(|side| at[side].map(|span| line(sides[side], span)));
        json!({ "left": left, "right": right })
    };
    match proof {
        Proof::Equal { is_reordered } => json!({ "equal": true, "reordered": is_reordered }),
        Proof::Undecided { reason, at, .. } => {
            json!({ "equal": null, "reason": reason.render(language), "lines": place(at) })
        }
        Proof::Different(found) => {
            let values = |of: &BTreeMap<String, Value>| -> Map<String, Json> {
                of.iter().map(|(name, value)| (name.clone(), value_json(value))).collect()
            };
            let [left, right] =
                found.sides.each_ref().map(|value| json!({ found.what.clone(): value_json(value) }));
            let run = found.run().map(|run| {
                let first = run.lead + u64::from(!found.before.is_empty());
                json!({ "scan_ms": run.scan_ns / 1_000_000, "first": first, "last": first + run.hold })
            });
            let reason = match &found.shown {
                Shown::Not(reason) => Some(reason.render(language)),
                Shown::Untried | Shown::Runs(_) => None,
            };
            json!({
                "equal": false,
                "counterexample": {
                    "inputs": values(&found.inputs),
                    "before": values(&found.before),
                    "left": left,
                    "right": right,
                    "lines": place(&found.at),
                    "run": run,
                    "reason": reason,
                },
            })
        }
    }
}

fn value_json(value: &Value) -> Json {
    match value {
        Value::Bit(value) => json!(value),
        Value::Word(value) => json!(value),
        // JSON has no number for these.
        Value::Real(value) if !value.is_finite() => json!(real_spelled(*value).as_str()),
        Value::Real(value) => json!(value),
        Value::Time(_) | Value::Named(_) => json!(value.to_string()),
    }
}

/// A sentence, and the picture of a scan in which the programs differ. `names` are those of the two programs.
pub fn text(proof: &Proof, sides: [&Document; 2], names: &[String; 2], language: Language) -> String {
    let place = |at: &[Option<Span>; 2]| {
        let places = [0, 1].map(|side| at[side].map(|span| (side, line(sides[side], span))));
        let shown = places.iter().flatten().map(|(side, line)| format!("{}:{line}", names[*side]));
        let shown: Vec<String> = shown.collect();
        if shown.is_empty() { names.join(", ") } else { shown.join(", ") }
    };
    match proof {
        Proof::Equal { is_reordered: false } => Message::new("prove.equal").render(language) + "\n",
        Proof::Equal { is_reordered: true } => Message::new("prove.equal-reordered").render(language) + "\n",
        Proof::Undecided { reason, at, .. } => {
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
    let named: BTreeSet<&String> = found.inputs.keys().chain(found.before.keys()).collect();
    for name in named {
        let (before, now) = (found.before.get(name), found.inputs.get(name));
        rows.push((
            name.clone(),
            match (before.or(now), now) {
                (Some(Value::Bit(before)), Some(Value::Bit(now))) => {
                    format!("{}{}", level(*before), level(*now))
                }
                (Some(Value::Bit(before)), None) => level(*before).to_string(),
                (Some(before), Some(now)) if before != now => format!("{before} → {now}"),
                (before, _) => before.map(Value::to_string).unwrap_or_default(),
            },
        ));
    }
    for (name, value) in names.iter().zip(&found.sides) {
        let shown = match value {
            Value::Bit(value) => format!("  {}", level(*value)),
            value => value.to_string(),
        };
        rows.push((
            Message::new("prove.in").with("what", &found.what).with("path", name).render(language),
            shown,
        ));
    }
    let width = rows.iter().map(|(name, _)| text_width(name)).max().unwrap_or(0);
    let pad = |name: &str| " ".repeat(width - text_width(name));
    let rows: String = rows.iter().map(|(name, shown)| format!("  {name}{}  {shown}\n", pad(name))).collect();
    match remark(found) {
        Some(remark) => format!("{rows}\n{}\n", remark.render(language)),
        None => rows,
    }
}

/// What is to be said of a picture: that it takes more scans than it shows, or that the simulated PLC does not show it.
fn remark(found: &Counterexample) -> Option<Message> {
    match &found.shown {
        Shown::Not(reason) => {
            Some(Message::new("prove.not-shown").with_messages("reason", vec![reason.clone()]))
        }
        Shown::Runs(run) if run.hold > 0 => {
            Some(Message::new("prove.later").with("scans", run.hold).with("time", run.scan_ns / 1_000_000))
        }
        Shown::Runs(_) | Shown::Untried => None,
    }
}

fn line(document: &Document, span: Span) -> u32 {
    document.position(span.start as usize, Encoding::Utf32).line + 1
}
