//! Reads the steps of a scenario: what is done and expected, and when.

use super::suite::{Check, CheckKind, Expected, Input, InputKind, Named, Want};
use super::surroundings::{self, Train};
use super::table::{Entry, Reading};
use crate::simulate::{Value, duration};
use crate::target::Port;
use crate::text::{Message, Span};
use toml::de::{DeTable, DeValue};

/// The keys of a step.
const STEP_KEYS: [&str; 19] = [
    "at",
    "after",
    "every",
    "times",
    "set",
    "force",
    "release",
    "pulse",
    "pulses",
    "receive",
    "expect",
    "sent",
    "within",
    "always",
    "never",
    "for",
    "until",
    "tolerance",
    "deviation",
];

/// More scans a scenario does not have: nearly three hours at 10 ms.
const MOST_SCANS: u64 = 1_000_000;
/// More lines of inputs and checks a scenario does not have.
const MOST_PARTS: usize = 100_000;

/// How times become scans.
#[derive(Clone, Copy)]
pub(super) struct Clock {
    pub scan_ns: i64,
}

impl Clock {
    /// A time, in nanoseconds: `"50ms"`, `"3 scans"`, or a number of milliseconds.
    pub fn moment(self, reading: &mut Reading<'_>, entry: Entry<'_>) -> Option<i64> {
        let time_ns = match entry.value {
            DeValue::String(word) => self.written(word),
            DeValue::Integer(_) | DeValue::Float(_) => {
                let ms = reading.number_of(entry)?;
                (ms >= 0.0).then_some((ms * 1e6) as i64)
            }
            _ => None,
        };
        let Some(time_ns) = time_ns else {
            reading.flaw(entry.span, Message::new("scenario.time"));
            return None;
        };
        self.is_within_reach(reading, entry.span, time_ns).then_some(time_ns)
    }

    /// Whether a scenario may be so long; tells if not.
    pub fn is_within_reach(self, reading: &mut Reading<'_>, span: Span, time_ns: i64) -> bool {
        let is_within = self.first(time_ns) <= MOST_SCANS;
        if !is_within {
            reading.flaw(span, Message::new("scenario.too-long").with("scans", MOST_SCANS));
        }
        is_within
    }

    /// A time as a number of scans.
    pub fn scans(self, reading: &mut Reading<'_>, entry: Entry<'_>) -> Option<u64> {
        self.moment(reading, entry).map(|time_ns| self.last(time_ns))
    }

    fn written(self, word: &str) -> Option<i64> {
        let scans = word.trim().strip_suffix("scans").or_else(|| word.trim().strip_suffix("scan"));
        match scans {
            Some(count) => {
                count.trim().parse::<u32>().ok().map(|count| i64::from(count).saturating_mul(self.scan_ns))
            }
            None => duration(word),
        }
    }

    /// The first scan at or after a time.
    pub fn first(self, time_ns: i64) -> u64 {
        (time_ns / self.scan_ns + i64::from(time_ns % self.scan_ns != 0)).unsigned_abs()
    }

    /// The last scan at or before a time.
    pub fn last(self, time_ns: i64) -> u64 {
        (time_ns / self.scan_ns).unsigned_abs()
    }
}

/// What the steps read so far say.
pub(super) struct Plan {
    clock: Clock,
    tolerance: u64,
    deviation: f64,
    /// The time of the step that was read last.
    now_ns: i64,
    pub inputs: Vec<Input>,
    pub checks: Vec<Check>,
    /// The last scan that something is said of.
    pub last: u64,
}

impl Plan {
    pub fn new(clock: Clock, tolerance: u64, deviation: f64) -> Plan {
        Plan { clock, tolerance, deviation, now_ns: 0, inputs: Vec::new(), checks: Vec::new(), last: 0 }
    }

    /// Another list of steps begins at time 0.
    pub fn begin(&mut self) {
        self.now_ns = 0;
    }

    /// Reads a step.
    pub fn step<'a>(&mut self, reading: &mut Reading<'_>, span: Span, table: &'a DeTable<'a>) {
        reading.known(table, &STEP_KEYS);
        let clock = self.clock;
        let mut time = |key: &str| {
            let entry = reading.entry(table, key)?;
            clock.moment(reading, entry)
        };
        let (at, after) = (time("at"), time("after"));
        let (within, lasts) = (time("within"), time("for"));
        if let (Some(_), Some(again)) = (at, reading.entry(table, "after").filter(|_| after.is_some())) {
            reading.flaw(again.key, Message::new("scenario.at-and-after"));
        }
        self.now_ns = at.unwrap_or_else(|| self.now_ns.saturating_add(after.unwrap_or(0)));
        let before = self.inputs.len() + self.checks.len();
        let (every_ns, times) = self.repeated(reading, table);
        for time in 0..times {
            self.now_ns = self.now_ns.saturating_add(if time == 0 { 0 } else { every_ns });
            let scan = clock.first(self.now_ns);
            if scan > MOST_SCANS || self.inputs.len() + self.checks.len() > MOST_PARTS {
                reading.flaw(span, Message::new("scenario.too-long").with("scans", MOST_SCANS));
                return;
            }
            self.last = self.last.max(scan);
            let next = (time + 1 < times).then(|| clock.first(self.now_ns.saturating_add(every_ns)));
            self.inputs(reading, table, scan, next);
            self.checks(reading, span, table, (scan, within, lasts));
        }
        if before == self.inputs.len() + self.checks.len() && reading.flaws.is_empty() {
            reading.flaw(span, Message::new("scenario.empty-step"));
        }
    }

    /// How often a step is done, and the time from one to the next.
    fn repeated<'a>(&self, reading: &mut Reading<'_>, table: &'a DeTable<'a>) -> (i64, u64) {
        let (every, times) = (reading.entry(table, "every"), reading.entry(table, "times"));
        let (Some(every), Some(times)) = (every, times) else {
            if let Some(alone) = every.or(times) {
                reading.flaw(alone.key, Message::new("scenario.every-and-times"));
            }
            return (0, 1);
        };
        let every_ns = self.clock.moment(reading, every);
        if every_ns.is_some_and(|every_ns| every_ns < self.clock.scan_ns) {
            reading.flaw(every.span, Message::new("scenario.every-scan"));
            return (0, 1);
        }
        let count = match times.value {
            DeValue::Integer(number) => u64::from_str_radix(number.as_str(), number.radix()).ok(),
            _ => None,
        };
        let count = count.filter(|count| (1..=MOST_SCANS).contains(count));
        if count.is_none() {
            reading.flaw(times.span, Message::new("scenario.times").with("most", MOST_SCANS));
        }
        (every_ns.unwrap_or(0), if every_ns.is_some() { count.unwrap_or(1) } else { 1 })
    }

    /// The inputs of a step in a scan; `next` is the scan in which it is done again.
    fn inputs<'a>(
        &mut self,
        reading: &mut Reading<'_>,
        table: &'a DeTable<'a>,
        scan: u64,
        next: Option<u64>,
    ) {
        for (key, make) in [("set", InputKind::Set as fn(Value) -> InputKind), ("force", InputKind::Force)] {
            for (name, entry) in named(reading, table, key) {
                if let Some(value) = value_of(reading, entry) {
                    self.inputs.push(Input { scan, name, kind: make(value) });
                }
            }
        }
        let released =
            reading.entry(table, "release").map(|entry| reading.list_of(entry)).unwrap_or_default();
        for entry in released {
            if let Some((name, span)) = reading.text_of(entry) {
                self.inputs.push(Input { scan, name: Named { name, span }, kind: InputKind::Release });
            }
        }
        for (name, entry) in named(reading, table, "pulse") {
            let Some(lasts) = self.clock.moment(reading, entry) else { continue };
            // A pulse that is shorter than a scan is seen all the same.
            let off = self.clock.first(self.now_ns.saturating_add(lasts)).max(scan + 1);
            self.last = self.last.max(off);
            if next.is_some_and(|next| next <= off) {
                reading.flaw(entry.span, Message::new("scenario.pulses-touch"));
            }
            let set = |on| InputKind::Set(Value::Bit(on));
            self.inputs.push(Input { scan, name: name.clone(), kind: set(true) });
            self.inputs.push(Input { scan: off, name, kind: set(false) });
        }
        for (name, entry) in named(reading, table, "pulses") {
            self.pulses(reading, &name, entry, scan);
        }
        if let Some(entry) = reading.entry(table, "receive") {
            let name = Named { name: Port::Received.to_string(), span: entry.key };
            for frame in surroundings::frames(reading, entry) {
                let kind = InputKind::Set(Value::Text(frame));
                self.inputs.push(Input { scan, name: name.clone(), kind });
            }
        }
    }

    /// Pulses before a scan, or in each of those that begin in a time.
    fn pulses(&mut self, reading: &mut Reading<'_>, name: &Named, entry: Entry<'_>, scan: u64) {
        let name = Named { name: format!("{}.pulses", name.name), span: name.span };
        let Some(train) = Train::read(reading, entry, self.clock) else { return };
        let counts = train.counts(self.clock);
        self.last = self.last.max(scan.saturating_add(counts.len().saturating_sub(1) as u64));
        for (scan, count) in (scan..).zip(counts).filter(|(_, count)| *count != 0) {
            let kind = InputKind::Set(Value::Number(count));
            self.inputs.push(Input { scan, name: name.clone(), kind });
        }
    }

    fn checks<'a>(
        &mut self,
        reading: &mut Reading<'_>,
        span: Span,
        table: &'a DeTable<'a>,
        (scan, within, lasts): (u64, Option<i64>, Option<i64>),
    ) {
        let clock = self.clock;
        let tolerance = reading.entry(table, "tolerance").and_then(|entry| clock.scans(reading, entry));
        let tolerance = tolerance.unwrap_or(self.tolerance);
        let deviation = reading.entry(table, "deviation").and_then(|entry| reading.number_of(entry));
        let deviation = deviation.map_or(self.deviation, f64::abs);
        let until = self.until(reading, table);
        if let (Some(again), Some(_)) = (reading.entry(table, "for"), reading.entry(table, "until")) {
            reading.flaw(again.key, Message::new("scenario.for-and-until"));
        }
        let kinds = [
            ("expect", CheckKind::Once),
            ("sent", CheckKind::Once),
            ("always", CheckKind::Always),
            ("never", CheckKind::Never),
        ];
        let mut has_range = false;
        for (key, kind) in kinds {
            let wants = match key {
                "sent" => sent(reading, table),
                key => wants(reading, table, key),
            };
            if wants.is_empty() {
                continue;
            }
            let check = match kind {
                CheckKind::Once => {
                    let window = within.map_or(scan, |within| clock.last(self.now_ns.saturating_add(within)));
                    let last = window.max(scan).saturating_add(tolerance);
                    self.last = self.last.max(last);
                    let first = scan.saturating_sub(tolerance);
                    let until = Vec::new();
                    Check { kind, first, last: Some(last), until, wants, deviation, tolerance: 0, span }
                }
                CheckKind::Always | CheckKind::Never => {
                    has_range = true;
                    let (end_ns, until) = match &until {
                        Until::Nothing => (lasts.map(|lasts| self.now_ns.saturating_add(lasts)), Vec::new()),
                        Until::Time(end_ns) => (Some(*end_ns), Vec::new()),
                        Until::Values(values) => (None, values.clone()),
                    };
                    // At the end itself the value may be another already.
                    let last = end_ns.map(|end_ns| clock.first(end_ns).saturating_sub(1).max(scan));
                    self.last = self.last.max(last.unwrap_or(0));
                    Check { kind, first: scan, last, until, wants, deviation, tolerance, span }
                }
            };
            self.checks.push(check);
        }
        let belongs = [
            ("within", table.contains_key("expect") || table.contains_key("sent"), "expect"),
            ("for", has_range, "always"),
            ("until", has_range, "always"),
        ];
        for (key, is_used, owner) in belongs {
            if let (Some(entry), false) = (reading.entry(table, key), is_used) {
                let message = Message::new("scenario.belongs-to").with("key", key).with("owner", owner);
                reading.flaw(entry.key, message);
            }
        }
    }

    fn until<'a>(&mut self, reading: &mut Reading<'_>, table: &'a DeTable<'a>) -> Until {
        let Some(entry) = reading.entry(table, "until") else { return Until::Nothing };
        match entry.value {
            DeValue::Table(_) => Until::Values(wants(reading, table, "until")),
            _ => self.clock.moment(reading, entry).map_or(Until::Nothing, Until::Time),
        }
    }

    /// The scenario ends with scan `last`: what is said of later ones counts for nothing.
    pub fn ends_at(&self, reading: &mut Reading<'_>, last: u64, time: Span) {
        if self.last > last {
            reading.flaw(time, Message::new("scenario.ends-before").with("last", self.last));
        }
    }

    /// The steps say how long the scenario is: what waits for values needs more.
    pub fn has_end(&self, reading: &mut Reading<'_>) {
        if let Some(waits) = self.checks.iter().find(|check| !check.until.is_empty()) {
            reading.flaw(waits.span, Message::new("scenario.until-needs-time"));
        }
    }
}

/// How long something is expected.
enum Until {
    Nothing,
    Time(i64),
    Values(Vec<Want>),
}

/// The names under a key with what stands behind them. Names with dots need no quotes.
fn named<'a>(reading: &mut Reading<'_>, table: &'a DeTable<'a>, key: &str) -> Vec<(Named, Entry<'a>)> {
    let Some(entry) = reading.entry(table, key) else { return Vec::new() };
    let Some(names) = reading.table_of(entry) else { return Vec::new() };
    let mut found = Vec::new();
    let mut waiting: Vec<(String, &'a DeTable<'a>)> = vec![(String::new(), names)];
    while let Some((before, names)) = waiting.pop() {
        for (name, entry) in reading.entries(names) {
            let name = format!("{before}{name}");
            match entry.value {
                DeValue::Table(inner) => waiting.push((format!("{name}."), inner)),
                _ => found.push((Named { name, span: entry.key }, entry)),
            }
        }
    }
    found.sort_by_key(|(name, _)| name.span.start);
    found
}

fn wants<'a>(reading: &mut Reading<'_>, table: &'a DeTable<'a>, key: &str) -> Vec<Want> {
    let names = named(reading, table, key);
    let want = |(name, entry): (Named, Entry<'a>)| {
        let expected = match entry.value {
            DeValue::String(word) => Expected::read(word),
            DeValue::Float(_) => reading.number_of(entry).map(|number| Expected::Between(number, number)),
            _ => return value_of(reading, entry).map(|value| Want { name, expected: Expected::Is(value) }),
        };
        if expected.is_none() {
            reading.flaw(entry.span, Message::new("scenario.expected-value"));
        }
        expected.map(|expected| Want { name, expected })
    };
    names.into_iter().filter_map(want).collect()
}

/// The frame that is to be sent.
fn sent<'a>(reading: &mut Reading<'_>, table: &'a DeTable<'a>) -> Vec<Want> {
    let Some(entry) = reading.entry(table, "sent") else { return Vec::new() };
    let name = Named { name: Port::Sent.to_string(), span: entry.key };
    let frame = surroundings::frame(reading, entry);
    frame.map(|frame| Want { name, expected: Expected::Is(Value::Text(frame)) }).into_iter().collect()
}

fn value_of(reading: &mut Reading<'_>, entry: Entry<'_>) -> Option<Value> {
    let value = match entry.value {
        DeValue::Boolean(on) => Some(Value::Bit(*on)),
        DeValue::Integer(number) => {
            i64::from_str_radix(number.as_str(), number.radix()).ok().map(Value::Number)
        }
        DeValue::String(word) => Value::read(word),
        DeValue::Float(number) => Value::read(number.as_str()),
        _ => None,
    };
    if value.is_none() {
        reading.flaw(entry.span, Message::new("scenario.value"));
    }
    value
}
