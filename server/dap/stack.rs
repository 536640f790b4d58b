//! The call stack: the instruction, the routines that it is in, the scan.

use super::adapter::{Adapter, Answer};
use super::debuggee::Here;
use super::launch::Debugged;
use super::variables::value_of;
use crate::simulate::{Caller, Place, milliseconds};
use crate::text::{Language, Message};
use serde_json::{Value, json};
use std::io::Write;

/// The number by which the protocol names what an instruction sees.
pub(super) const INSTRUCTION: i64 = 1 << 24;

impl<W: Write> Adapter<W> {
    pub(super) fn stack(&mut self, first: usize, most: usize) -> Answer {
        let language = self.language;
        let debugged = self.debugged()?;
        let scan = Message::new("debug.scan").with("scan", debugged.debuggee.scan() - 1);
        let scan = scan.with("time", milliseconds(debugged.debuggee.now_ns())).render(language);
        let places =
            debugged.debuggee.here().map(|here| places(debugged, here, language)).unwrap_or_default();
        let debugged = self.debugged.as_ref().ok_or_else(|| Message::new("debug.not-launched"))?;
        let frame = |(number, (place, routine)): (usize, &(Place, String))| {
            let lines = self.lines(&debugged.program.lines(*place));
            json!({
                "id": number + 1,
                "name": format!("{routine} · {}", debugged.program.words(*place)),
                "source": debugged.program.source(*place),
                "line": lines.line,
                "column": lines.column,
                "endLine": lines.end_line,
                "endColumn": lines.end_column,
            })
        };
        let mut frames: Vec<Value> = places.iter().enumerate().map(frame).collect();
        let mut bottom = json!({
            "id": frames.len() + 1, "name": scan, "line": 0, "column": 0, "presentationHint": "label",
        });
        if frames.is_empty() {
            // Somewhere variables must be found.
            bottom["presentationHint"] = json!("normal");
        }
        frames.push(bottom);
        let total = frames.len();
        let most = if most == 0 { total } else { most };
        let shown: Vec<Value> = frames.into_iter().skip(first).take(most).collect();
        Ok(json!({ "stackFrames": shown, "totalFrames": total }))
    }

    pub(super) fn scopes(&mut self, frame: i64) -> Answer {
        let language = self.language;
        let debugged = self.debugged()?;
        let mut scopes = debugged.variables.scopes(language);
        if frame == 1 && debugged.debuggee.here().is_some() {
            let own = json!({
                "name": Message::new("debug.instruction").render(language),
                "presentationHint": "locals",
                "variablesReference": INSTRUCTION,
                "expensive": false,
            });
            scopes.insert(0, own);
        }
        Ok(json!({ "scopes": scopes }))
    }
}

/// The instruction and the callers, the innermost first, each with the name of its routine.
fn places(debugged: &Debugged, here: &Here, language: Language) -> Vec<(Place, String)> {
    let main = debugged.program.files.get(here.place.document as usize).map(|file| file.name());
    let entered = |caller: &Caller| match caller.is_interrupt {
        true => Message::new("debug.interrupt").render(language),
        false => {
            let words = debugged.program.words(caller.place);
            words.rsplit(' ').next().unwrap_or_default().trim_matches([']', ')']).to_string()
        }
    };
    let mut routine = main.unwrap_or_default();
    let mut places = Vec::new();
    for caller in &here.callers {
        places.push((caller.place, routine));
        routine = entered(caller);
    }
    places.push((here.place, routine));
    places.reverse();
    places
}

/// What an instruction sees: whether it conducts, the power that reaches it or leaves it, its operands.
pub(super) fn seen(debugged: &Debugged, language: Language) -> Vec<Value> {
    let Some(here) = debugged.debuggee.here() else { return Vec::new() };
    let words = |key: &'static str| Message::new(key).render(language);
    let bit = |name: &'static str, on: bool| {
        json!({
            "name": words(name),
            "value": if on { "1" } else { "0" },
            "type": words("debug.bit"),
            "variablesReference": 0,
            "presentationHint": { "attributes": ["readOnly"] },
        })
    };
    let mut shown = Vec::new();
    if let Some(conducts) = here.sight.conducts {
        shown.push(bit("debug.conducts", conducts != 0));
        shown.push(bit("debug.power-behind", here.sight.power != 0));
    } else {
        shown.push(bit("debug.power", here.sight.power != 0));
    }
    for name in operands(debugged, here.place) {
        if let Some(variable) = debugged.debuggee.code().variable(&name) {
            let value = value_of(variable, &debugged.debuggee, language);
            shown.push(json!({
                "name": name, "evaluateName": name, "value": value, "variablesReference": 0,
            }));
        }
    }
    shown
}

/// The names of devices in the instruction at a place.
fn operands(debugged: &Debugged, place: Place) -> Vec<String> {
    let Some(document) = debugged.program.document(place) else { return Vec::new() };
    let Some(at) = document.chunk_at(place.span.start as usize) else { return Vec::new() };
    let is_within = |start: u32| {
        let start = start as usize + at.start;
        (place.span.start as usize..place.span.end as usize).contains(&start)
    };
    let reading = at.chunk.reading();
    let mut names: Vec<String> = Vec::new();
    for operation in reading.operations() {
        let own = operation.symbol.start;
        // The name of a drawn contact stands above it.
        let is_own = match operation.element {
            Some(element) => element.span.shifted(at.start) == place.span,
            None => is_within(own),
        };
        let operands = operation.operands.iter().filter(|_| is_own);
        for device in operands.filter_map(|operand| operand.value.device()) {
            let name = device.to_string();
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names
}
