//! The call stack: the instruction, the routines that it is in, the scan.

use super::adapter::{Adapter, Answer};
use super::debuggee::Here;
use super::launch::Debugged;
use super::program::Program;
use super::variables::value_of;
use crate::document::Notation;
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
            let words = match debugged.program.rung_at(*place) {
                Some(number) => Message::new("debug.rung").with("number", number).render(language),
                None => debugged.program.words(*place),
            };
            let mut frame = json!({
                "id": number + 1,
                "name": format!("{routine} · {words}"),
                "source": debugged.program.source(*place),
                "line": lines.line,
                "column": lines.column,
            });
            // A whole rung would be selected by editors, which hides what is in it.
            if lines.line == lines.end_line {
                (frame["endLine"], frame["endColumn"]) = (json!(lines.end_line), json!(lines.end_column));
            }
            frame
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
        let (code, instruction) = (debugged.debuggee.code(), debugged.instruction(frame));
        let owner = instruction.and_then(|own| code.owner(own));
        let body = instruction.and_then(|own| code.scope_at(own));
        let mut scopes = debugged.variables.scopes(owner.as_deref(), body, language);
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
    let code = debugged.debuggee.code();
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
    for caller in callers(debugged, here) {
        places.push((caller.place, code.owner(caller.instruction).unwrap_or(routine)));
        routine = entered(caller);
    }
    places.push((here.place, code.owner(here.instruction).unwrap_or(routine)));
    places.reverse();
    places
}

/// Where routines were entered. A program of IEC 61131-3 is entered from nowhere in the text.
fn callers<'h>(debugged: &Debugged, here: &'h Here) -> &'h [Caller] {
    let first = usize::from(!debugged.debuggee.code().target.is_fx());
    here.callers.get(first..).unwrap_or_default()
}

impl Debugged {
    /// The instruction at which a frame of the stack is, by its number, the innermost frame having number 1.
    pub(super) fn instruction(&self, frame: i64) -> Option<u32> {
        let here = self.debuggee.here()?;
        let callers = callers(self, here).iter().rev();
        let mut instructions =
            std::iter::once(here.instruction).chain(callers.map(|caller| caller.instruction));
        instructions.nth(usize::try_from(frame.max(1) - 1).ok()?)
    }

    /// The whole name of what a person calls `name` in a frame of the stack.
    pub(super) fn whole(&self, frame: i64, name: &str) -> String {
        let instruction = self.instruction(frame);
        let own = instruction.and_then(|instruction| self.debuggee.code().whole_name(instruction, name));
        own.unwrap_or_else(|| name.trim().to_string())
    }
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
    match here.sight.map(|sight| (sight.conducts, sight.power != 0)) {
        Some((Some(conducts), power)) => {
            shown.push(bit("debug.conducts", conducts != 0));
            shown.push(bit("debug.power-behind", power));
        }
        Some((None, power)) => shown.push(bit("debug.power", power)),
        None => {
            let result = debugged.debuggee.machine().result_before(here.instruction);
            shown.extend(result.map(|value| {
                json!({
                    "name": words("debug.result"),
                    "value": value.to_string(),
                    "variablesReference": 0,
                    "presentationHint": { "attributes": ["readOnly"] },
                })
            }));
        }
    }
    let mut known = Vec::new();
    for word in names_at(&debugged.program, here.place) {
        let name = debugged.whole(1, &word);
        let variable = debugged.debuggee.code().variable(&name);
        if let Some(variable) = variable.filter(|variable| !known.contains(variable)) {
            known.push(variable);
            let value = value_of(variable, &debugged.debuggee, language);
            shown.push(json!({
                "name": word, "evaluateName": name, "value": value, "variablesReference": 0,
            }));
        }
    }
    shown
}

/// The words of the instruction at a place that may be names of variables.
pub(super) fn names_at(program: &Program, place: Place) -> Vec<String> {
    let Some(document) = program.document(place) else { return Vec::new() };
    let is_drawn = document.notation() == Notation::Ladder;
    let text = match is_drawn {
        true => program.words(place),
        false => document.slice(place.span).to_string(),
    };
    let is_inside = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '%' | '[' | ']' | ',');
    let words = text.split(|c: char| !is_inside(c)).filter(|word| !word.is_empty());
    // A line of a list begins with the operator.
    words.skip(usize::from(!is_drawn)).map(|word| word.trim_matches([',', '.']).to_string()).collect()
}
