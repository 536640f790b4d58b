//! The adapter: takes requests one after another, and runs the program between them.

use super::breakpoints::Breakpoints;
use super::launch::Debugged;
use super::program::Lines;
use super::wire::{self, Request};
use crate::simulate::Place;
use crate::text::{Language, Message};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::io::Write;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration;

/// The one thread: the PLC.
pub(super) const THREAD: i64 = 1;

/// What a request gives.
pub(super) type Answer = Result<Value, Message>;

/// A debugging session with a client.
pub(super) struct Adapter<W> {
    output: W,
    /// The number of the last message.
    last: i64,
    pub(super) language: Language,
    is_language_asked: bool,
    /// How the client counts: the numbers of the first line and the first column.
    first: (u32, u32),
    /// Whether the client wants to know that values have changed.
    pub(super) is_invalidated: bool,
    pub(super) breakpoints: Breakpoints,
    /// Whether it stops before an instruction that fails.
    pub(super) stops_at_errors: bool,
    pub(super) debugged: Option<Debugged>,
    /// Events that are sent when the present request is answered.
    events: Vec<Value>,
    pub(super) is_over: bool,
}

impl<W: Write> Adapter<W> {
    pub(super) fn new(output: W, language: Language, is_asked: bool) -> Adapter<W> {
        Adapter {
            output,
            last: 0,
            language,
            is_language_asked: is_asked,
            first: (1, 1),
            is_invalidated: false,
            breakpoints: Breakpoints::default(),
            stops_at_errors: true,
            debugged: None,
            events: Vec::new(),
            is_over: false,
        }
    }

    /// Serves until the client says that it is over, or goes.
    pub(super) fn run(&mut self, requests: &Receiver<Request>) {
        while !self.is_over {
            let wait = self.debugged.as_ref().map_or(Duration::from_secs(60), Debugged::wait);
            match requests.recv_timeout(wait) {
                Ok(request) => self.answer(&request),
                Err(RecvTimeoutError::Timeout) => self.tell_outdated(),
                Err(RecvTimeoutError::Disconnected) => return,
            }
            self.advance();
            self.send_events();
        }
    }

    fn answer(&mut self, request: &Request) {
        let answer = self.obey(request);
        let mut response = json!({
            "type": "response",
            "request_seq": request.seq,
            "command": request.command,
            "success": answer.is_ok(),
        });
        match answer {
            Ok(Value::Null) => {}
            Ok(body) => response["body"] = body,
            Err(reason) => {
                let words = reason.render(self.language);
                response["message"] = json!(words);
                // Braces would be variables of the format.
                let format = words.replace(['{', '}'], "'");
                // Who points at a word that is no name is not to be told so.
                let is_shown = request.command != "evaluate";
                response["body"] = json!({ "error": { "id": 1, "format": format, "showUser": is_shown } });
            }
        }
        self.send(response);
        self.send_events();
    }

    /// Sends an event when the present request is answered.
    pub(super) fn event(&mut self, name: &str, body: Value) {
        self.events.push(json!({ "type": "event", "event": name, "body": body }));
    }

    /// Says something in the console; `place` is what it is about.
    pub(super) fn say(&mut self, category: &str, words: &str, place: Option<Place>) {
        let mut body = json!({ "category": category, "output": format!("{words}\n") });
        if let (Some(debugged), Some(place)) = (&self.debugged, place) {
            let lines = self.lines(&debugged.program.lines(place));
            body["source"] = debugged.program.source(place);
            (body["line"], body["column"]) = (json!(lines.line), json!(lines.column));
        }
        self.event("output", body);
    }

    fn send_events(&mut self) {
        for event in std::mem::take(&mut self.events) {
            self.send(event);
        }
    }

    fn send(&mut self, mut message: Value) {
        self.last += 1;
        message["seq"] = json!(self.last);
        // A client that does not listen any more has gone.
        self.is_over |= wire::write(&mut self.output, &message).is_err();
    }

    /// Notes what the client says of itself.
    pub(super) fn meet(&mut self, arguments: &Value) {
        let is = |name: &str, otherwise: bool| arguments[name].as_bool().unwrap_or(otherwise);
        self.first = (u32::from(is("linesStartAt1", true)), u32::from(is("columnsStartAt1", true)));
        self.is_invalidated = is("supportsInvalidatedEvent", false);
        if let Some(locale) = arguments["locale"].as_str().filter(|_| !self.is_language_asked) {
            self.language = Language::of_locale(locale);
        }
    }

    /// A line and a column of the client, from 1 on.
    pub(super) fn counted(&self, line: u32, column: Option<u32>) -> (u32, Option<u32>) {
        let (first_line, first_column) = self.first;
        (line.saturating_add(1 - first_line), column.map(|column| column.saturating_add(1 - first_column)))
    }

    /// Lines and columns as the client counts them.
    pub(super) fn lines(&self, lines: &Lines) -> Lines {
        let (line, column) = (1 - self.first.0, 1 - self.first.1);
        Lines {
            line: lines.line - line,
            column: lines.column - column,
            end_line: lines.end_line - line,
            end_column: lines.end_column - column,
        }
    }

    /// The program.
    ///
    /// # Errors
    /// Before `launch`.
    pub(super) fn debugged(&mut self) -> Result<&mut Debugged, Message> {
        self.debugged.as_mut().ok_or_else(|| Message::new("debug.not-launched"))
    }

    /// The program, which is stopped.
    ///
    /// # Errors
    /// Before `launch`, and while it runs.
    pub(super) fn stopped(&mut self) -> Result<&mut Debugged, Message> {
        let debugged = self.debugged()?;
        match debugged.going {
            None => Ok(debugged),
            Some(_) => Err(Message::new("debug.running")),
        }
    }
}

/// The arguments of a request.
///
/// # Errors
/// Where they are not what the protocol wants.
pub(super) fn arguments<T: DeserializeOwned>(request: &Request) -> Result<T, Message> {
    // Left out is the same as empty.
    let given = if request.arguments.is_null() { json!({}) } else { request.arguments.clone() };
    T::deserialize(given).map_err(|reason| {
        Message::new("debug.arguments").with("command", &request.command).with("reason", reason)
    })
}
