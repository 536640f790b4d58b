//! Where and when a program is to stop: breakpoints of lines, data breakpoints, their conditions and counts.

use super::expression::{Expression, holds};
use super::program::Program;
use crate::simulate::{Code, Glimpse, Machine, Place, Value, Variable};
use crate::text::Message;
use rustc_hash::FxHashMap;
use serde::Deserialize;
use std::path::PathBuf;

/// A breakpoint as the client asks for it, of any kind.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Wanted {
    #[serde(default)]
    pub(super) line: u32,
    pub(super) column: Option<u32>,
    /// Of a data breakpoint the name.
    #[serde(default)]
    pub(super) data_id: String,
    condition: Option<String>,
    hit_condition: Option<String>,
    log_message: Option<String>,
}

/// All breakpoints, as asked for and as they are in the program.
#[derive(Default)]
pub(super) struct Breakpoints {
    /// By file.
    pub(super) wanted: FxHashMap<PathBuf, Vec<(i64, Wanted)>>,
    pub(super) wanted_data: Vec<(i64, Wanted)>,
    lines: FxHashMap<u32, Vec<Breakpoint>>,
    data: Vec<Watchpoint>,
    last_id: i64,
}

/// What became of a breakpoint.
#[derive(Debug)]
pub(super) struct Placed {
    pub(super) id: i64,
    /// Where it stops; nothing for a data breakpoint.
    pub(super) place: Option<Place>,
    /// Why it never stops.
    pub(super) reason: Option<Message>,
}

struct Breakpoint {
    id: i64,
    terms: Terms,
}

struct Watchpoint {
    id: i64,
    name: String,
    variable: Variable,
    /// What it was when it was looked at last.
    before: Value,
    terms: Terms,
}

/// On what terms a breakpoint stops.
struct Terms {
    condition: Option<Expression>,
    count: Option<Count>,
    log: Option<Vec<Piece>>,
    hits: u64,
}

/// A piece of a log message.
enum Piece {
    Text(String),
    Value(Expression),
}

/// Which hits count: `5` and `>= 5`, `> 5`, `= 5`, `% 5`.
#[derive(Clone, Copy)]
enum Count {
    From(u64),
    At(u64),
    Every(u64),
    Below(u64),
}

/// Why the program stops.
#[derive(Clone, Debug)]
pub(super) enum Hit {
    /// At breakpoints with these numbers.
    Line(Vec<i64>),
    /// A value is no longer what it was.
    Data { id: i64, name: String, before: Value, after: Value },
}

/// What is found at an instruction.
#[derive(Default)]
pub(super) struct Found {
    pub(super) hit: Option<Hit>,
    /// Messages of log points.
    pub(super) logged: Vec<String>,
}

impl Breakpoints {
    /// A number that no breakpoint has.
    pub(super) fn number(&mut self) -> i64 {
        self.last_id += 1;
        self.last_id
    }

    /// Whether none can stop.
    pub(super) fn is_empty(&self) -> bool {
        self.lines.is_empty() && self.data.is_empty()
    }

    /// Finds their places in a program; counts begin anew.
    pub(super) fn place(&mut self, program: &Program) -> Vec<Placed> {
        self.lines.clear();
        self.data.clear();
        let mut placed = Vec::new();
        for (path, wanted) in &self.wanted {
            let file = program.file_at(path);
            for (id, wanted) in wanted {
                let stop = file.and_then(|file| program.stop_at(file, wanted.line, wanted.column));
                let terms = Terms::of(wanted, &program.code);
                let reason = match (&stop, &terms) {
                    (None, _) if file.is_none() => Some(Message::new("debug.other-program")),
                    (None, _) => Some(Message::new("debug.no-instruction")),
                    (_, Err(reason)) => Some(reason.clone()),
                    _ => None,
                };
                placed.push(Placed { id: *id, place: stop.map(|(place, _)| place), reason });
                if let (Some((_, instruction)), Ok(terms)) = (stop, terms) {
                    self.lines.entry(instruction).or_default().push(Breakpoint { id: *id, terms });
                }
            }
        }
        for (id, wanted) in &self.wanted_data {
            let variable = program.code.variable(&wanted.data_id);
            let variable =
                variable.ok_or_else(|| Message::new("cli.run-unknown").with("name", &wanted.data_id));
            let found = variable.and_then(|variable| Ok((variable, Terms::of(wanted, &program.code)?)));
            placed.push(Placed { id: *id, place: None, reason: found.as_ref().err().cloned() });
            if let Ok((variable, terms)) = found {
                let before = Value::Bit(false);
                self.data.push(Watchpoint { id: *id, name: wanted.data_id.clone(), variable, before, terms });
            }
        }
        placed.sort_by_key(|placed| placed.id);
        placed
    }

    /// Notes what values are before the program goes on.
    pub(super) fn begin(&mut self, machine: &Machine<u8>, is_inside: bool) {
        for watched in &mut self.data {
            watched.before = match is_inside {
                true => machine.value_inside(watched.variable, 0),
                false => machine.value(watched.variable, 0),
            };
        }
    }

    /// What is found at an instruction that the program comes to.
    pub(super) fn at(&mut self, glimpse: &Glimpse<'_, u8>) -> Found {
        let of = |variable| glimpse.machine.value_inside(variable, 0);
        let mut found = self.changed(&of);
        let mut ids = Vec::new();
        for breakpoint in self.lines.get_mut(&glimpse.sight.instruction).into_iter().flatten() {
            if breakpoint.terms.stops(&of, true, &mut found.logged) {
                ids.push(breakpoint.id);
            }
        }
        if !ids.is_empty() {
            found.hit = Some(Hit::Line(ids));
        }
        found
    }

    /// What is found at the end of a scan.
    pub(super) fn at_end(&mut self, machine: &Machine<u8>) -> Found {
        self.changed(&|variable| machine.value(variable, 0))
    }

    fn changed(&mut self, of: &impl Fn(Variable) -> Value) -> Found {
        let mut found = Found::default();
        for watched in &mut self.data {
            let after = of(watched.variable);
            if after == watched.before {
                continue;
            }
            let before = std::mem::replace(&mut watched.before, after.clone());
            if watched.terms.stops(of, true, &mut found.logged) && found.hit.is_none() {
                found.hit = Some(Hit::Data { id: watched.id, name: watched.name.clone(), before, after });
            }
        }
        found
    }

    /// The same on the way back, where nothing is counted and nothing is logged.
    pub(super) fn at_back(&mut self, glimpse: &Glimpse<'_, u8>) -> Option<Hit> {
        let of = |variable| glimpse.machine.value_inside(variable, 0);
        let mut hit = None;
        for watched in &mut self.data {
            let after = of(watched.variable);
            if after != watched.before {
                let before = std::mem::replace(&mut watched.before, after.clone());
                if watched.terms.stops(&of, false, &mut Vec::new()) {
                    hit = Some(Hit::Data { id: watched.id, name: watched.name.clone(), before, after });
                }
            }
        }
        let own = self.lines.get_mut(&glimpse.sight.instruction).into_iter().flatten();
        let stops = own.filter_map(|breakpoint| {
            breakpoint.terms.stops(&of, false, &mut Vec::new()).then_some(breakpoint.id)
        });
        let ids: Vec<i64> = stops.collect();
        if ids.is_empty() { hit } else { Some(Hit::Line(ids)) }
    }
}

impl Terms {
    fn of(wanted: &Wanted, code: &Code) -> Result<Terms, Message> {
        let given = |text: &Option<String>| text.clone().filter(|text| !text.trim().is_empty());
        let condition = given(&wanted.condition).map(|text| Expression::read(&text, code)).transpose()?;
        let count = given(&wanted.hit_condition).map(|text| Count::read(&text)).transpose()?;
        let log = given(&wanted.log_message).map(|text| pieces(&text, code)).transpose()?;
        Ok(Terms { condition, count, log, hits: 0 })
    }

    /// Whether it stops here; a log point says its message instead.
    fn stops(&mut self, of: &impl Fn(Variable) -> Value, is_counted: bool, logged: &mut Vec<String>) -> bool {
        let holds = |condition: &Expression| condition.value(of).is_ok_and(|value| holds(&value));
        if !self.condition.as_ref().is_none_or(holds) {
            return false;
        }
        if is_counted {
            self.hits += 1;
            if !self.count.is_none_or(|count| count.holds(self.hits)) {
                return false;
            }
        }
        let Some(pieces) = &self.log else { return true };
        let words = pieces.iter().map(|piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Value(expression) => {
                expression.value(of).map_or_else(|_| "?".to_string(), |value| value.to_string())
            }
        });
        logged.push(words.collect());
        false
    }
}

impl Count {
    fn read(text: &str) -> Result<Count, Message> {
        let text = text.trim();
        let digits = text.trim_start_matches(|c: char| !c.is_ascii_digit());
        let sign = text[..text.len() - digits.len()].trim();
        let wrong = || Message::new("debug.count").with("text", text);
        let number: u64 = digits.parse().map_err(|_| wrong())?;
        Ok(match sign {
            "" | ">=" => Count::From(number),
            ">" => Count::From(number.saturating_add(1)),
            "=" | "==" => Count::At(number),
            "<" => Count::Below(number),
            "<=" => Count::Below(number.saturating_add(1)),
            "%" if number > 0 => Count::Every(number),
            _ => return Err(wrong()),
        })
    }

    fn holds(self, hits: u64) -> bool {
        match self {
            Count::From(number) => hits >= number,
            Count::At(number) => hits == number,
            Count::Every(number) => hits.is_multiple_of(number),
            Count::Below(number) => hits < number,
        }
    }
}

/// The pieces of a log message: `{…}` is an expression.
fn pieces(text: &str, code: &Code) -> Result<Vec<Piece>, Message> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('{') {
        pieces.push(Piece::Text(before.to_string()));
        let (inside, after) =
            behind.split_once('}').ok_or_else(|| Message::new("debug.expression").with("text", text))?;
        pieces.push(Piece::Value(Expression::read(inside, code)?));
        rest = after;
    }
    pieces.push(Piece::Text(rest.to_string()));
    Ok(pieces)
}
