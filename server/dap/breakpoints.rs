//! Where and when a program is to stop: breakpoints of lines, data breakpoints, their conditions and counts.

use super::program::{Program, Stop};
use crate::simulate::{Code, Expression, Glimpse, Machine, NamesOfCode, Place, Value, Variable};
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
    /// Of a data breakpoint what stops: `write` where the value changes, `readWrite` also where it is used.
    access_type: Option<String>,
    /// Of a function breakpoint the label or program unit.
    #[serde(default)]
    name: String,
    condition: Option<String>,
    hit_condition: Option<String>,
    log_message: Option<String>,
}

/// All breakpoints, as asked for and as they are in the program.
#[derive(Default)]
pub(super) struct Breakpoints {
    /// By file.
    pub(super) wanted: FxHashMap<PathBuf, Vec<(i64, Wanted)>>,
    pub(super) wanted_functions: Vec<(i64, Wanted)>,
    pub(super) wanted_data: Vec<(i64, Wanted)>,
    /// By the instruction at which they stop.
    lines: FxHashMap<u32, Vec<Breakpoint>>,
    data: Vec<Watchpoint>,
    /// How often each was come to on its condition, up to where the program stands.
    hits: FxHashMap<i64, u64>,
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
    /// The variable that the instruction uses, for a data breakpoint.
    uses: Option<String>,
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
    /// An instruction is about to use a variable.
    Use { id: i64, name: String },
}

/// What is found at an instruction.
#[derive(Default)]
pub(super) struct Found {
    pub(super) hit: Option<Hit>,
    /// Messages of log points.
    pub(super) logged: Vec<String>,
}

/// A breakpoint that was come to on its condition, on a stretch of the way that is looked back on.
pub(super) struct Passed {
    id: i64,
    count: Option<Count>,
    hit: Hit,
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
        self.hits.clear();
        let mut placed = Vec::new();
        for (path, wanted) in std::mem::take(&mut self.wanted) {
            let file = program.file_at(&path);
            for (id, wanted) in &wanted {
                let stop = file.and_then(|file| program.stop_at(file, wanted.line, wanted.column));
                let missing = if file.is_none() { "debug.other-program" } else { "debug.no-instruction" };
                let stop = stop.ok_or_else(|| Message::new(missing));
                placed.push(self.place_at(*id, wanted, stop, program));
            }
            self.wanted.insert(path, wanted);
        }
        for (id, wanted) in self.wanted_functions.clone() {
            let entry = program.entry(wanted.name.trim());
            let missing = || Message::new("debug.no-routine").with("name", &wanted.name);
            placed.push(self.place_at(id, &wanted, entry.as_ref().ok_or_else(missing), program));
        }
        for (id, wanted) in self.wanted_data.clone() {
            let reason = self.place_data(id, &wanted, program).err();
            placed.push(Placed { id, place: None, reason });
        }
        placed.sort_by_key(|placed| placed.id);
        placed
    }

    /// Puts a breakpoint at the instructions of a place.
    fn place_at(
        &mut self,
        id: i64,
        wanted: &Wanted,
        stop: Result<&Stop, Message>,
        program: &Program,
    ) -> Placed {
        let (place, mut reason) = match &stop {
            Ok(stop) => (Some(stop.place), None),
            Err(reason) => (None, Some(reason.clone())),
        };
        for instruction in stop.map(|stop| stop.instructions.clone()).unwrap_or_default() {
            match Terms::of(wanted, &program.code, Some(instruction)) {
                Ok(terms) => {
                    self.lines.entry(instruction).or_default().push(Breakpoint { id, terms, uses: None });
                }
                Err(wrong) => reason = Some(wrong),
            }
        }
        Placed { id, place, reason }
    }

    fn place_data(&mut self, id: i64, wanted: &Wanted, program: &Program) -> Result<(), Message> {
        let name = wanted.data_id.clone();
        let variable = program.code.variable(&name);
        let variable = variable.ok_or_else(|| Message::new("cli.run-unknown").with("name", &name))?;
        let terms = || Terms::of(wanted, &program.code, None);
        let before = Value::Bit(false);
        self.data.push(Watchpoint { id, name: name.clone(), variable, before, terms: terms()? });
        if wanted.access_type.as_deref() == Some("readWrite") {
            for instruction in program.naming(variable) {
                let uses = Some(name.clone());
                self.lines.entry(instruction).or_default().push(Breakpoint { id, terms: terms()?, uses });
            }
        }
        Ok(())
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
        let mut hits = Vec::new();
        for breakpoint in self.lines.get(&glimpse.instruction).into_iter().flatten() {
            let count = self.hits.entry(breakpoint.id).or_default();
            if breakpoint.terms.stops(&of, count, &mut found.logged) {
                hits.push(breakpoint.hit());
            }
        }
        found.hit = together(hits).or(found.hit);
        found
    }

    /// What is found at the end of a scan.
    pub(super) fn at_end(&mut self, machine: &Machine<u8>) -> Found {
        self.changed(&|variable| machine.value(variable, 0))
    }

    fn changed(&mut self, of: &impl Fn(Variable) -> Value) -> Found {
        let mut found = Found::default();
        for watched in &mut self.data {
            let Some(hit) = watched.look(of) else { continue };
            let count = self.hits.entry(watched.id).or_default();
            if watched.terms.stops(of, count, &mut found.logged) {
                found.hit.get_or_insert(hit);
            }
        }
        found
    }

    /// What the program comes to at an instruction of the way that is looked back on, where nothing is logged.
    pub(super) fn passed(&mut self, glimpse: &Glimpse<'_, u8>) -> Vec<Passed> {
        let of = |variable| glimpse.machine.value_inside(variable, 0);
        let mut passed = Vec::new();
        for watched in &mut self.data {
            let hit = watched.look(&of).filter(|_| watched.terms.is_stop(&of));
            passed.extend(hit.map(|hit| Passed { id: watched.id, count: watched.terms.count, hit }));
        }
        let own = self.lines.get(&glimpse.instruction).into_iter().flatten();
        let own = own.filter(|breakpoint| breakpoint.terms.is_stop(&of));
        passed.extend(own.map(|breakpoint| Passed {
            id: breakpoint.id,
            count: breakpoint.terms.count,
            hit: breakpoint.hit(),
        }));
        passed
    }

    /// Takes back that the program came to these.
    pub(super) fn uncount(&mut self, passed: &[Passed]) {
        for Passed { id, .. } in passed {
            let count = self.hits.entry(*id).or_default();
            *count = count.saturating_sub(1);
        }
    }

    /// Goes back to before what the program has just come to. Gives why it stops there on the way back, if it does:
    /// then this is still counted.
    pub(super) fn take_back(&mut self, passed: Vec<Passed>) -> Option<Hit> {
        let count = |id: i64| self.hits.get(&id).copied().unwrap_or(0);
        let stops = |passed: &&Passed| passed.count.is_none_or(|own| own.holds(count(passed.id)));
        let mut hits: Vec<Hit> = passed.iter().filter(stops).map(|passed| passed.hit.clone()).collect();
        if hits.is_empty() {
            self.uncount(&passed);
        }
        let data = hits.iter().position(|hit| matches!(hit, Hit::Data { .. }));
        let data = data.map(|at| hits.swap_remove(at));
        together(hits).or(data)
    }
}

/// One hit of several at one instruction.
fn together(hits: Vec<Hit>) -> Option<Hit> {
    let mut ids = Vec::new();
    let mut other = None;
    for hit in hits {
        match hit {
            Hit::Line(own) => ids.extend(own),
            hit => other = Some(hit),
        }
    }
    if ids.is_empty() { other } else { Some(Hit::Line(ids)) }
}

impl Breakpoint {
    fn hit(&self) -> Hit {
        match &self.uses {
            Some(name) => Hit::Use { id: self.id, name: name.clone() },
            None => Hit::Line(vec![self.id]),
        }
    }
}

impl Watchpoint {
    /// How the value has changed since it was looked at last.
    fn look(&mut self, of: &impl Fn(Variable) -> Value) -> Option<Hit> {
        let after = of(self.variable);
        if after == self.before {
            return None;
        }
        let before = std::mem::replace(&mut self.before, after.clone());
        Some(Hit::Data { id: self.id, name: self.name.clone(), before, after })
    }
}

impl Terms {
    fn of(wanted: &Wanted, code: &Code, instruction: Option<u32>) -> Result<Terms, Message> {
        let names = NamesOfCode { code, instruction };
        let given = |text: &Option<String>| text.clone().filter(|text| !text.trim().is_empty());
        let condition = given(&wanted.condition).map(|text| Expression::read(&text, &names)).transpose()?;
        let count = given(&wanted.hit_condition).map(|text| Count::read(&text)).transpose()?;
        let log = given(&wanted.log_message).map(|text| pieces(&text, code, instruction)).transpose()?;
        Ok(Terms { condition, count, log })
    }

    fn holds(&self, of: &impl Fn(Variable) -> Value) -> bool {
        self.condition.as_ref().is_none_or(|condition| condition.holds(of))
    }

    /// Whether it stops here but for its count.
    fn is_stop(&self, of: &impl Fn(Variable) -> Value) -> bool {
        self.log.is_none() && self.holds(of)
    }

    /// Whether it stops here, which is counted; a log point says its message instead.
    fn stops(&self, of: &impl Fn(Variable) -> Value, hits: &mut u64, logged: &mut Vec<String>) -> bool {
        if !self.holds(of) {
            return false;
        }
        *hits += 1;
        if !self.count.is_none_or(|count| count.holds(*hits)) {
            return false;
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
fn pieces(text: &str, code: &Code, instruction: Option<u32>) -> Result<Vec<Piece>, Message> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('{') {
        pieces.push(Piece::Text(before.to_string()));
        let (inside, after) =
            behind.split_once('}').ok_or_else(|| Message::new("debug.expression").with("text", text))?;
        pieces.push(Piece::Value(Expression::read(inside, &NamesOfCode { code, instruction })?));
        rest = after;
    }
    pieces.push(Piece::Text(rest.to_string()));
    Ok(pieces)
}
