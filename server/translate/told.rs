//! How a proof about two programs is told.

use super::{Counterexample, Proof, Value};
use crate::document::Document;
use crate::target::iec::real_spelled;
use crate::text::{Encoding, Language, Message, Span, text_width};
use serde_json::{Map, Value as Json, json};

/// The JSON of `prove`: `{"equal", "counterexample": {"inputs", "before", "left", "right", "lines"}}`.
pub fn json(proof: &Proof, sides: [&Document; 2], language: Language) -> Json {
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

fn value_json(value: &Value) -> Json {
    match value {
        Value::Bit(value) => json!(value),
        Value::Word(value) => json!(value),
        // JSON has no number for these.
        Value::Real(value) if !value.is_finite() => json!(real_spelled(*value).as_str()),
        Value::Real(value) => json!(value),
        Value::Time(_) => json!(value.to_string()),
    }
}

/// A sentence, and the picture of a scan in which the programs differ. `names` are those of the two programs.
pub fn text(proof: &Proof, sides: [&Document; 2], names: &[String; 2], language: Language) -> String {
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
            value => (name.clone(), value.to_string()),
        });
    }
    for (name, value) in names.iter().zip(found.sides) {
        rows.push((
            Message::new("prove.in").with("what", &found.what).with("path", name).render(language),
            { format!("  {}", level(value)) },
        ));
    }
    let width = rows.iter().map(|(name, _)| text_width(name)).max().unwrap_or(0);
    let pad = |name: &str| " ".repeat(width - text_width(name));
    rows.iter().map(|(name, shown)| format!("  {name}{}  {shown}\n", pad(name))).collect()
}

fn line(document: &Document, span: Span) -> u32 {
    document.position(span.start as usize, Encoding::Utf32).line + 1
}
