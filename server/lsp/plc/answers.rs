//! Answers about a PLC as JSON.

use super::drift::Encoded;
use crate::link::{Mode, Plan};
use crate::machine_code::decode;
use crate::text::Language;
use crate::translate::from_machine_code::drawn;
use serde_json::{Value as Json, json};

/// What a download would change, as drawings or as instruction lists.
pub(super) fn planned(encoded: &Encoded, plan: &Plan, is_drawn: bool, language: Language) -> Json {
    let changes = plan.parameter_changes();
    let parameters: Vec<String> = changes.iter().map(|change| change.render(language)).collect();
    let list = |words: &[u16]| match is_drawn {
        true => drawn(words, plan.model),
        false => decode(words, plan.model).text,
    };
    json!({
        "same": plan.before.program() == plan.wanted.program(),
        "bytes": plan.bytes(),
        "sum": format!("{:04X}", plan.found),
        "steps": encoded.words.len(),
        "form": if is_drawn { "ladder" } else { "fx" },
        "before": list(plan.before.program()),
        "after": list(plan.wanted.program()),
        "parameters": parameters,
    })
}

/// What a CPU does, in a word.
pub(super) fn word_of(mode: Mode) -> &'static str {
    match mode {
        Mode::Run => "RUN",
        Mode::Stop => "STOP",
    }
}
