//! Where the text names what is forced.

use super::super::to_proto::Place;
use super::monitor::unit_at;
use crate::document::{Mention, Symbol, Use};
use crate::simulate::{Code, Value, Variable};
use crate::target::Device;
use crate::text::Span;
use serde_json::{Value as Json, json};
use std::ops::Range as Bytes;

/// The names in a window of what is forced, with the values that it is held at, as `held` says.
pub(super) fn forced(
    place: Place<'_>,
    window: &Bytes<usize>,
    code: &Code,
    held: &impl Fn(Variable) -> Option<Value>,
) -> Vec<Json> {
    let mut elements = Vec::new();
    let shown = place.document.chunks().skip_while(|at| at.start < window.start);
    for at in shown.take_while(|at| at.start < window.end) {
        let unit = unit_at(place, at.start);
        for mention in at.chunk.mentions().iter().filter(|mention| mention.usage != Use::Declare) {
            let span = mention.span.shifted(at.start);
            let variables = variables(mention, &name_at(place, span), unit, code);
            let Some(value) = variables.into_iter().find_map(held) else { continue };
            elements.push(json!({
                "range": place.range(span),
                "kind": "forced",
                "energised": false,
                "value": value.json(),
            }));
        }
    }
    elements
}

/// The name at a place with its members and subscripts.
fn name_at(place: Place<'_>, span: Span) -> String {
    let chunk = place.document.chunk_at(span.start as usize);
    let end = chunk.map_or(span.end as usize, |at| at.start + at.chunk.len());
    let text = place.document.slice(Span::new(span.start as usize, end));
    let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']' | ',' | '%');
    text.split(|c| !is_name(c)).next().unwrap_or_default().trim_end_matches(['.', ',']).to_string()
}

/// What a mention means: the relays and words of devices, a variable of each instance.
fn variables(mention: &Mention, name: &str, unit: &str, code: &Code) -> Vec<Variable> {
    match &mention.symbol {
        Symbol::Device(first) => {
            let devices =
                (0..u32::from(mention.count)).map(|next| Device::new(first.kind, first.number + next));
            let of = |device| {
                let relay = code.layout.cell(device).map(Variable::Relay);
                relay.into_iter().chain(code.layout.slot(device).map(Variable::Word))
            };
            devices.flat_map(of).collect()
        }
        Symbol::Direct(address) => code.variable(&address.to_string()).into_iter().collect(),
        Symbol::Variable(_) => {
            let own = code.variables_at(unit, name);
            if own.is_empty() { code.variable(name).into_iter().collect() } else { own }
        }
        _ => Vec::new(),
    }
}
