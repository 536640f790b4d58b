//! The requests of the protocol, one after another.

use super::adapter::{Adapter, Answer, THREAD, arguments};
use super::breakpoints::{Placed, Wanted};
use super::going::Going;
use super::launch::{Debugged, Launch};
use super::stack::{INSTRUCTION, seen};
use super::wire::Request;
use crate::simulate::{Touch, Value, Variable};
use crate::text::Message;
use serde::Deserialize;
use serde_json::{Value as Json, json};
use std::io::Write;
use std::path::PathBuf;

/// What many requests have.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Asked {
    thread_id: Option<i64>,
    granularity: String,
    frame_id: i64,
    start_frame: usize,
    levels: usize,
    variables_reference: i64,
    start: usize,
    count: usize,
    name: String,
    value: String,
    expression: String,
    context: String,
    text: String,
    column: usize,
    line: u32,
    end_line: Option<u32>,
    filters: Vec<String>,
    breakpoints: Vec<Wanted>,
    source: Source,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct Source {
    path: Option<PathBuf>,
}

impl<W: Write> Adapter<W> {
    /// Does what is asked.
    pub(super) fn obey(&mut self, request: &Request) -> Answer {
        match request.command.as_str() {
            "initialize" => {
                self.meet(&request.arguments);
                return Ok(self.capabilities());
            }
            "launch" => return self.launch(&arguments::<Launch>(request)?),
            "disconnect" => {
                self.is_over = true;
                return Ok(Json::Null);
            }
            _ => {}
        }
        let asked: Asked = arguments(request)?;
        if asked.thread_id.is_some_and(|thread| thread != THREAD) {
            return Err(Message::new("debug.no-thread"));
        }
        match request.command.as_str() {
            "configurationDone" => self.begin(),
            "restart" => self.restart(),
            "terminate" => self.terminate(),
            "threads" => {
                let name = self.debugged.as_ref().map_or("PLC", |debugged| debugged.program.code.target.name);
                Ok(json!({ "threads": [{ "id": THREAD, "name": name }] }))
            }
            "loadedSources" => {
                let files = &self.debugged()?.program.files;
                Ok(json!({ "sources": files.iter().map(|file| file.source()).collect::<Vec<_>>() }))
            }
            "setBreakpoints" => self.set_breakpoints(asked),
            "breakpointLocations" => self.locations(&asked),
            "dataBreakpointInfo" => self.data_info(&asked),
            "setFunctionBreakpoints" => {
                let wanted = self.numbered(asked.breakpoints);
                self.breakpoints.wanted_functions.clone_from(&wanted);
                Ok(self.placed(&wanted))
            }
            "setDataBreakpoints" => {
                let wanted = self.numbered(asked.breakpoints);
                self.breakpoints.wanted_data.clone_from(&wanted);
                Ok(self.placed(&wanted))
            }
            "setExceptionBreakpoints" => {
                self.stops_at_errors = asked.filters.iter().any(|filter| filter == ERRORS);
                Ok(Json::Null)
            }
            "exceptionInfo" => self.exception(),
            "continue" => {
                self.stopped()?.resume(Going::On);
                Ok(json!({ "allThreadsContinued": true }))
            }
            "pause" => {
                if self.debugged()?.going.is_some() {
                    self.stop("pause", None);
                }
                Ok(Json::Null)
            }
            "next" | "stepIn" | "stepOut" => self.step(&request.command, &asked.granularity),
            "stepBack" => self.step_back(),
            "reverseContinue" => {
                self.reverse()?;
                Ok(Json::Null)
            }
            "stackTrace" => self.stack(asked.start_frame, asked.levels),
            "scopes" => self.scopes(asked.frame_id),
            "variables" => self.variables(&asked),
            "setVariable" => {
                let name = self.named(&asked)?;
                self.set_value(&name, &asked.value)
            }
            "setExpression" => {
                let name = self.debugged()?.whole(asked.frame_id, &asked.expression);
                self.set_value(&name, &asked.value)
            }
            "evaluate" if asked.context == "repl" => self.console(&asked.expression, asked.frame_id),
            "evaluate" => self.evaluate(&asked.expression, asked.frame_id),
            "completions" => self.completions(&asked.text, asked.column),
            other => Err(Message::new("debug.no-request").with("command", other)),
        }
    }

    fn capabilities(&self) -> Json {
        json!({
            "supportsConfigurationDoneRequest": true,
            "supportsConditionalBreakpoints": true,
            "supportsHitConditionalBreakpoints": true,
            "supportsLogPoints": true,
            "supportsBreakpointLocationsRequest": true,
            "supportsDataBreakpoints": true,
            "supportsFunctionBreakpoints": true,
            "supportsStepBack": true,
            "supportsSteppingGranularity": true,
            "supportsRestartRequest": true,
            "supportsTerminateRequest": true,
            "supportTerminateDebuggee": true,
            "supportsSetVariable": true,
            "supportsSetExpression": true,
            "supportsEvaluateForHovers": true,
            "supportsCompletionsRequest": true,
            "supportsExceptionInfoRequest": true,
            "supportsLoadedSourcesRequest": true,
            "exceptionBreakpointFilters": [{
                "filter": ERRORS,
                "label": Message::new("debug.errors").render(self.language),
                "description": Message::new("debug.errors-about").render(self.language),
                "default": true,
            }],
        })
    }

    fn launch(&mut self, launch: &Launch) -> Answer {
        let debugged = launch.start()?;
        self.debugged = Some(debugged);
        self.place_breakpoints();
        self.event("initialized", Json::Null);
        Ok(Json::Null)
    }

    /// Begins to run, or stops at the first instruction.
    fn begin(&mut self) -> Answer {
        let debugged = self.debugged()?;
        match debugged.launch.stop_on_entry && !debugged.launch.no_debug {
            true => self.stop("entry", None),
            false => debugged.resume(Going::On),
        }
        Ok(Json::Null)
    }

    /// Reads the program anew, and begins at the first scan.
    fn restart(&mut self) -> Answer {
        let launch = self.debugged()?.launch.clone();
        self.debugged = Some(launch.start()?);
        for placed in self.place_breakpoints() {
            let breakpoint = self.breakpoint(&placed);
            self.event("breakpoint", json!({ "reason": "changed", "breakpoint": breakpoint }));
        }
        self.begin()
    }

    fn terminate(&mut self) -> Answer {
        if let Some(debugged) = &mut self.debugged {
            debugged.going = None;
        }
        self.event("terminated", Json::Null);
        Ok(Json::Null)
    }

    fn place_breakpoints(&mut self) -> Vec<Placed> {
        match &mut self.debugged {
            Some(debugged) => {
                debugged.is_fresh = true;
                self.breakpoints.place(&debugged.program)
            }
            None => Vec::new(),
        }
    }

    fn set_breakpoints(&mut self, asked: Asked) -> Answer {
        let path = asked.source.path.unwrap_or_default();
        let path = path.canonicalize().unwrap_or(path);
        let mut wanted = self.numbered(asked.breakpoints);
        for (_, breakpoint) in &mut wanted {
            (breakpoint.line, breakpoint.column) = self.counted(breakpoint.line, breakpoint.column);
        }
        self.breakpoints.wanted.insert(path, wanted.clone());
        Ok(self.placed(&wanted))
    }

    /// Breakpoints with numbers by which they are known from now on.
    fn numbered(&mut self, breakpoints: Vec<Wanted>) -> Vec<(i64, Wanted)> {
        breakpoints.into_iter().map(|wanted| (self.breakpoints.number(), wanted)).collect()
    }

    /// Places all breakpoints; gives what became of these.
    fn placed(&mut self, wanted: &[(i64, Wanted)]) -> Json {
        let placed = self.place_breakpoints();
        let waiting = || Message::new("debug.not-launched").render(self.language);
        let own = wanted.iter().map(|(id, _)| match placed.iter().find(|placed| placed.id == *id) {
            Some(placed) => self.breakpoint(placed),
            None => json!({ "id": id, "verified": false, "message": waiting() }),
        });
        json!({ "breakpoints": own.collect::<Vec<_>>() })
    }

    fn breakpoint(&self, placed: &Placed) -> Json {
        let mut breakpoint = json!({ "id": placed.id, "verified": placed.reason.is_none() });
        if let Some(reason) = &placed.reason {
            breakpoint["message"] = json!(reason.render(self.language));
        }
        if let (Some(place), Some(debugged)) = (placed.place, &self.debugged) {
            let lines = self.lines(&debugged.program.lines(place));
            breakpoint["source"] = debugged.program.source(place);
            (breakpoint["line"], breakpoint["column"]) = (json!(lines.line), json!(lines.column));
            (breakpoint["endLine"], breakpoint["endColumn"]) =
                (json!(lines.end_line), json!(lines.end_column));
        }
        breakpoint
    }

    fn locations(&mut self, asked: &Asked) -> Answer {
        let (line, _) = self.counted(asked.line, None);
        let (last, _) = self.counted(asked.end_line.unwrap_or(asked.line), None);
        let path = asked.source.path.clone().unwrap_or_default();
        let program = &self.debugged()?.program;
        let stops = program.file_at(&path).map(|file| program.stops_in(file, line, last)).unwrap_or_default();
        let places: Vec<_> = stops.into_iter().map(|place| program.lines(place)).collect();
        let locations = places.iter().map(|lines| {
            let lines = self.lines(lines);
            json!({ "line": lines.line, "column": lines.column })
        });
        Ok(json!({ "breakpoints": locations.collect::<Vec<_>>() }))
    }

    /// The whole name of a variable that the client shows as a part of another, or has from a frame.
    fn named(&mut self, asked: &Asked) -> Result<String, Message> {
        let debugged = self.debugged()?;
        let name = asked.name.trim();
        Ok(match asked.variables_reference {
            0 | INSTRUCTION => debugged.whole(asked.frame_id, name),
            reference => debugged.variables.whole(reference, name),
        })
    }

    fn data_info(&mut self, asked: &Asked) -> Answer {
        let language = self.language;
        let name = self.named(asked)?;
        Ok(match self.debugged()?.program.code.variable(&name) {
            Some(_) => json!({
                "dataId": name,
                "description": Message::new("debug.change-of").with("name", &name).render(language),
                "accessTypes": ["write", "readWrite"],
                "canPersist": true,
            }),
            None => json!({
                "dataId": null,
                "description": Message::new("cli.run-unknown").with("name", name).render(language),
            }),
        })
    }

    fn exception(&mut self) -> Answer {
        let language = self.language;
        let debugged = self.stopped()?;
        let error = debugged.failing.ok_or_else(|| Message::new("debug.no-error"))?;
        let place = error.place.map(|place| debugged.program.shown(place)).unwrap_or_default();
        let words = error.kind.message().render(language);
        Ok(json!({
            "exceptionId": place,
            "description": words,
            "breakMode": "always",
            "details": { "message": words, "typeName": ERRORS },
        }))
    }

    fn step(&mut self, command: &str, granularity: &str) -> Answer {
        let debugged = self.stopped()?;
        let scan = debugged.debuggee.scan();
        let going = match (command, debugged.debuggee.here()) {
            ("stepOut", Some(here)) if !here.callers.is_empty() => Going::Out { depth: here.callers.len() },
            ("stepOut", _) => Going::Scan(scan + 1),
            ("next", Some(here)) if granularity != "instruction" => {
                Going::Rung { rung: debugged.program.rung(here.place), depth: here.callers.len() }
            }
            _ => Going::Instruction,
        };
        debugged.resume(going);
        Ok(Json::Null)
    }

    /// Back by an instruction.
    pub(super) fn step_back(&mut self) -> Answer {
        let debugged = self.stopped()?;
        let is_back = debugged.debuggee.step_back();
        debugged.failing = None;
        if !is_back {
            self.tell_cut();
        }
        self.stop(if is_back { "step" } else { "entry" }, None);
        Ok(Json::Null)
    }

    fn variables(&mut self, asked: &Asked) -> Answer {
        let language = self.language;
        let debugged = self.debugged()?;
        let all = match asked.variables_reference {
            INSTRUCTION => seen(debugged, language),
            reference => {
                let (variables, own) = (&debugged.variables, Some(reference));
                let names = variables.names(reference);
                let count = if asked.count == 0 { names.len() } else { asked.count };
                let shown = names.iter().skip(asked.start).take(count).filter_map(|name| {
                    variables.shown(own, name, &debugged.debuggee, &debugged.program, language)
                });
                shown.collect()
            }
        };
        Ok(json!({ "variables": all }))
    }

    fn set_value(&mut self, name: &str, value: &str) -> Answer {
        let language = self.language;
        self.change(name, value, false)?;
        let debugged = self.debugged()?;
        let (variables, name) = (&debugged.variables, name.trim());
        let shown = variables.shown(None, name, &debugged.debuggee, &debugged.program, language);
        shown.ok_or_else(|| Message::new("cli.run-unknown").with("name", name))
    }

    /// Sets or forces a variable.
    pub(super) fn change(&mut self, name: &str, value: &str, is_force: bool) -> Result<(), Message> {
        let debugged = self.debugged()?;
        let variable = debugged.variable(name)?;
        // The words behind a value are said by the adapter; a text has its quotes, and may have blanks between them.
        let value = value.trim();
        let value = match value.rfind('\'').filter(|end| *end > 0 && value.starts_with('\'')) {
            Some(end) => &value[..=end],
            None => value.split([' ', '（']).next().unwrap_or_default(),
        };
        let unread = || Message::new("cli.run-no-value").with("name", name);
        let value = Value::read(value).ok_or_else(unread)?;
        let code = debugged.debuggee.code();
        let touch = match is_force {
            true => variable.force(code, &value),
            false => variable.set(code, &value),
        };
        let touch = touch.ok_or_else(|| variable.refusal(code, name, &value))?;
        self.touch(touch)
    }

    /// Does something to the PLC, after which values are no longer what the client shows.
    pub(super) fn touch(&mut self, touch: Touch) -> Result<(), Message> {
        self.debugged()?.debuggee.touch(touch);
        if self.is_invalidated {
            self.event("invalidated", json!({ "areas": ["variables"] }));
        }
        Ok(())
    }
}

/// The filter of runtime errors.
const ERRORS: &str = "errors";

impl Debugged {
    /// The variable that a person calls `name`.
    pub(super) fn variable(&self, name: &str) -> Result<Variable, Message> {
        let found = self.debuggee.code().variable(name);
        found.ok_or_else(|| Message::new("cli.run-unknown").with("name", name.trim()))
    }
}
