//! Why a device is on or off, as the protocol tells it.

use super::super::to_proto::Place;
use crate::document::{Document, Symbol, Tree};
use crate::simulate::{Place as CodePlace, Reason};
use crate::text::Language;
use serde_json::{Value as Json, json};
use tower_lsp::ls_types::Uri;

/// A reason with those behind it: `{ text, scan, time_ms, uri?, range?, because }`.
pub(super) fn told(reason: &Reason, files: &[(Uri, i32, Document)], here: Place<'_>) -> Json {
    let because: Vec<Json> = reason.because.iter().map(|reason| told(reason, files, here)).collect();
    let mut json = json!({
        "text": reason.message.render(here.language),
        "scan": reason.scan,
        "time_ms": reason.time_ns as f64 / 1e6,
        "because": because,
    });
    let file = |at: CodePlace| Some((at, files.get(at.document as usize)?));
    if let Some((at, (uri, _, document))) = reason.place.and_then(file) {
        json["uri"] = json!(uri);
        json["range"] = json!(Place::new(document, here.manner()).range(at.span));
    }
    json
}

/// The same in a few lines of Markdown: the reason, and those right behind it.
pub(super) fn brief(reason: &Reason, language: Language) -> String {
    let behind = reason.because.iter().map(|reason| format!("\n- {}", reason.message.render(language)));
    std::iter::once(reason.message.render(language)).chain(behind).collect()
}

/// The device or variable at an offset: its name, or an element that bears it.
pub(super) fn name_at(document: &Document, offset: usize) -> Option<String> {
    let at = document.chunk_at(offset)?;
    let inside = offset.checked_sub(at.start)?;
    let named = at.chunk.mentions().iter().find(|mention| mention.span.touches(inside));
    let name = named.and_then(|mention| match &mention.symbol {
        Symbol::Device(device) => Some(device.to_string()),
        Symbol::Direct(address) => Some(address.to_string()),
        Symbol::Variable(name) => Some(name.to_string()),
        _ => None,
    });
    let reading = at.chunk.reading();
    name.or_else(|| match reading.tree() {
        Tree::Fx(tree) => {
            let line = tree.line_at(inside)?;
            tree.operands(line).first()?.value.device().map(|device| device.to_string())
        }
        Tree::Ladder(tree) => {
            let elements = tree.rungs.iter().flat_map(|rung| &rung.graph.elements);
            let mut around = elements.filter(|element| element.span.touches(inside));
            let operand = around.find_map(|element| element.operands.first())?;
            Some(operand.span.of(reading.text()).to_string())
        }
        Tree::Iec(_) => None,
    })
}
