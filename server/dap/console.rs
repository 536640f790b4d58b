//! The console: words that people write to the debugger, and expressions.
//!
//! ```text
//! run TIME    scan [N]    back [NAME]    set NAME=VALUE    force NAME=VALUE    release [NAME]    why NAME    help
//! ```

use super::adapter::{Adapter, Answer, THREAD};
use super::going::Going;
use super::launch::Debugged;
use super::variables::value_of;
use crate::document::Document;
use crate::simulate::{Drivers, Expression, Inquiry, NamesOfCode, Touch, Value, duration};
use crate::text::Message;
use serde_json::{Value as Json, json};
use std::io::Write;
use std::time::{Duration, Instant};

/// The words that something can begin with.
const VERBS: [&str; 8] = ["run", "scan", "back", "set", "force", "release", "why", "help"];
/// So long the history is looked through for one answer to why.
const PATIENCE: Duration = Duration::from_secs(2);
/// So many names are offered.
const MOST_TARGETS: usize = 200;

impl<W: Write> Adapter<W> {
    /// Does what a line of the console says.
    pub(super) fn console(&mut self, line: &str, frame: i64) -> Answer {
        let line = line.trim();
        let (verb, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        match verb.to_ascii_lowercase().as_str() {
            "run" => self.run_for(rest),
            "scan" => self.run_scans(rest),
            "back" => self.back(rest, frame),
            "set" => self.assign(rest, frame, false),
            "force" => self.assign(rest, frame, true),
            "release" => self.release(rest, frame),
            "why" => self.why(rest, frame),
            "help" | "?" => Ok(self.result("debug.help")),
            _ => self.evaluate(line, frame),
        }
    }

    /// The value of an expression; of a name what there is to know of it.
    pub(super) fn evaluate(&mut self, text: &str, frame: i64) -> Answer {
        let language = self.language;
        let debugged = self.debugged()?;
        let name = debugged.whole(frame, text);
        let variables = &debugged.variables;
        if let Some(shown) = variables.shown(None, &name, &debugged.debuggee, &debugged.program, language) {
            return Ok(json!({
                "result": shown["value"], "type": shown["type"], "variablesReference": shown["variablesReference"],
            }));
        }
        let value = debugged.value_of(text, frame)?;
        Ok(json!({ "result": value.to_string(), "variablesReference": 0 }))
    }

    fn result(&self, key: &'static str) -> Json {
        json!({ "result": Message::new(key).render(self.language), "variablesReference": 0 })
    }

    fn run_for(&mut self, time: &str) -> Answer {
        let wrong = || Message::new("debug.time").with("text", time);
        let time_ns = duration(time).ok_or_else(wrong)?;
        let debuggee = &self.stopped()?.debuggee;
        let step_ns = debuggee.time_of(2).max(1);
        let scan = later(debuggee.scan(), time_ns / step_ns + i64::from(time_ns % step_ns > 0));
        self.go_to(scan)
    }

    fn run_scans(&mut self, count: &str) -> Answer {
        let count = match count {
            "" => 1,
            count => count.parse().map_err(|_| Message::new("debug.count").with("text", count))?,
        };
        let scan = self.stopped()?.debuggee.scan();
        self.go_to(later(scan, count))
    }

    fn go_to(&mut self, scan: u64) -> Answer {
        self.stopped()?.resume(Going::Scan(scan));
        self.event("continued", json!({ "threadId": THREAD, "allThreadsContinued": true }));
        Ok(json!({ "result": "", "variablesReference": 0 }))
    }

    fn back(&mut self, name: &str, frame: i64) -> Answer {
        if name.is_empty() {
            self.step_back()?;
        } else {
            let debugged = self.stopped()?;
            let variable = debugged.variable(&debugged.whole(frame, name))?;
            if !debugged.debuggee.back_to_change(variable) {
                return Err(Message::new("debug.never-changed").with("name", name));
            }
            self.stop("step", None);
        }
        Ok(json!({ "result": "", "variablesReference": 0 }))
    }

    fn assign(&mut self, assignment: &str, frame: i64, is_force: bool) -> Answer {
        let wrong = || Message::new("debug.assignment").with("text", assignment);
        let (name, value) = assignment.split_once('=').ok_or_else(wrong)?;
        let (name, value) = (name.trim_end_matches(':').trim(), value.trim());
        let name = self.debugged()?.whole(frame, name);
        self.change(&name, value, is_force)?;
        self.evaluate(&name, frame)
    }

    fn release(&mut self, name: &str, frame: i64) -> Answer {
        let debugged = self.debugged()?;
        let touches: Vec<Touch> = match name {
            "" => vec![Touch::LetAllGo],
            name => {
                let variable = debugged.variable(&debugged.whole(frame, name))?;
                vec![variable.release()]
            }
        };
        touches.into_iter().try_for_each(|touch| self.touch(touch))?;
        if name.is_empty() { Ok(self.result("debug.released")) } else { self.evaluate(name, frame) }
    }

    /// Why a device is what it is, here.
    fn why(&mut self, name: &str, frame: i64) -> Answer {
        let language = self.language;
        let debugged = self.stopped()?;
        let name = &debugged.whole(frame, name);
        let variable = debugged.variable(name)?;
        let program = &debugged.program;
        let documents: Vec<&Document> = program.files.iter().map(|file| &file.document).collect();
        let debuggee = &debugged.debuggee;
        let drivers = program.drivers.get_or_init(|| Drivers::of(&documents));
        let asked = Instant::now();
        let goes_on = || asked.elapsed() < PATIENCE;
        let inquiry = Inquiry::new(debuggee.session(), debuggee.code(), &documents, drivers);
        let inquiry = inquiry.patient(&goes_on);
        let sights = debuggee.sights();
        // Where a scan begins, the one before it is the answer.
        let is_inside = !sights.is_empty() || debuggee.scan() == 1;
        let reason = match is_inside && debuggee.here().is_some() {
            true => inquiry.within(debuggee.machine(), sights).why(name, None),
            false => inquiry.why(name, None),
        };
        let told = match reason {
            Some(reason) => reason.told(language, |place| program.shown(place)),
            None => value_of(variable, debuggee, language),
        };
        Ok(json!({ "result": told.trim_end(), "variablesReference": 0 }))
    }

    /// What the word before a column may become.
    pub(super) fn completions(&mut self, text: &str, column: usize) -> Answer {
        let before: String = text.chars().take(column.saturating_sub(1)).collect();
        let word = before.rsplit(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.'))).next();
        let word = word.unwrap_or_default().to_ascii_uppercase();
        let is_first = before.trim_start().len() == word.len();
        let verbs = VERBS.into_iter().filter(|_| is_first).map(|verb| (verb.to_string(), "keyword"));
        let names = self.debugged()?.variables.all().map(|name| (name.clone(), "variable"));
        let known = verbs.chain(names).filter(|(name, _)| name.to_ascii_uppercase().starts_with(&word));
        let start = before.chars().count() - word.chars().count();
        let targets = known.take(MOST_TARGETS).map(|(label, kind)| {
            json!({ "label": label, "type": kind, "start": start, "length": word.chars().count() })
        });
        Ok(json!({ "targets": targets.collect::<Vec<_>>() }))
    }
}

/// So many scans on.
fn later(scan: u64, count: i64) -> u64 {
    scan.saturating_add(count.max(0) as u64)
}

impl Debugged {
    /// The value of an expression here.
    fn value_of(&self, text: &str, frame: i64) -> Result<Value, Message> {
        let names = NamesOfCode { code: self.debuggee.code(), instruction: self.instruction(frame) };
        let expression = Expression::read(text, &names)?;
        let machine = self.debuggee.machine();
        expression.value(&|variable| match self.debuggee.here() {
            Some(_) => machine.value_inside(variable, 0),
            None => machine.value(variable, 0),
        })
    }
}
