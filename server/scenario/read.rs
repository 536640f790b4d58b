//! Reads a file with scenario tests.

use super::steps::{self, Clock};
use super::table::{Entry, Reading};
use super::{Flaw, Named, Scenario, Suite};
use crate::simulate::duration;
use crate::text::{Language, Message, Span};
use toml::de::{DeTable, DeValue};

/// The keys of the file.
const SUITE_KEYS: [&str; 6] = ["program", "scan-time", "tolerance", "deviation", "steps", "scenario"];
/// The keys of a scenario.
const SCENARIO_KEYS: [&str; 9] =
    ["name", "time", "scan-time", "tolerance", "deviation", "steps", "watch", "golden", "allow-errors"];

/// From one scan to the next where nothing is said.
const SCAN_NS: i64 = 10_000_000;
/// Shorter and longer scans there are not.
const SCAN_RANGE_NS: std::ops::RangeInclusive<i64> = 1_000..=60_000_000_000;

impl Suite {
    /// Reads the text of a file, and tells what is wrong with it, in the order of the text. A scenario with a flaw is
    /// there with what could be read of it.
    pub fn read(text: &str) -> (Suite, Vec<Flaw>) {
        let mut reading = Reading { text, flaws: Vec::new() };
        let (table, errors) = DeTable::parse_recoverable(text);
        for error in errors {
            let span = reading.span(error.span().unwrap_or(0..0));
            reading.flaw(span, Message::new("manifest.toml").with("reason", error.message()));
        }
        let suite = suite(&mut reading, table.get_ref());
        if suite.scenarios.is_empty() && reading.flaws.is_empty() {
            reading.flaw(Span::default(), Message::new("scenario.none"));
        }
        reading.flaws.sort_by_key(|flaw| flaw.span.start);
        reading.flaws.dedup();
        (suite, reading.flaws)
    }
}

fn suite<'a>(reading: &mut Reading<'_>, table: &'a DeTable<'a>) -> Suite {
    reading.known(table, &SUITE_KEYS);
    let program = word(reading, table, "program");
    let common =
        Common { scan_ns: scan_time(reading, table, SCAN_NS), steps: reading.entry(table, "steps"), table };
    let listed = reading.entry(table, "scenario");
    let entries = listed.map(|entry| reading.list_of(entry)).unwrap_or_default();
    let mut scenarios: Vec<Scenario> = Vec::new();
    for entry in entries {
        let Some(own) = reading.table_of(entry) else { continue };
        let scenario = scenario(reading, &common, entry, own, scenarios.len());
        if scenarios.iter().any(|other| other.name == scenario.name) {
            reading.flaw(scenario.span, Message::new("scenario.twice").with("name", &scenario.name));
        }
        scenarios.push(scenario);
    }
    Suite { program, scenarios }
}

/// What holds in all scenarios of a file.
struct Common<'a> {
    scan_ns: i64,
    steps: Option<Entry<'a>>,
    table: &'a DeTable<'a>,
}

fn scenario<'a>(
    reading: &mut Reading<'_>,
    common: &Common<'a>,
    entry: Entry<'a>,
    table: &'a DeTable<'a>,
    number: usize,
) -> Scenario {
    reading.known(table, &SCENARIO_KEYS);
    let name = word(reading, table, "name").unwrap_or_else(|| {
        let name = Message::new("scenario.unnamed").with("number", number + 1);
        Named { name: name.render(Language::English), span: header_of(reading, entry) }
    });
    let scan_ns = scan_time(reading, table, common.scan_ns);
    let clock = Clock { scan_ns };
    // What the scenario says goes before what the file says.
    let setting = |key: &str| match reading.entry(table, key) {
        Some(entry) => Some(entry),
        None => reading.entry(common.table, key),
    };
    let (tolerance, deviation) = (setting("tolerance"), setting("deviation"));
    let tolerance = tolerance.and_then(|entry| clock.scans(reading, entry)).unwrap_or(0);
    let deviation = deviation.and_then(|entry| reading.number_of(entry)).unwrap_or(0.0).abs();
    let time =
        reading.entry(table, "time").and_then(|entry| Some((clock.moment(reading, entry)?, entry.span)));
    let golden = word(reading, table, "golden");
    let watch = reading.entry(table, "watch").map(|entry| reading.list_of(entry)).unwrap_or_default();
    let watch = watch.into_iter().filter_map(|entry| {
        let (name, span) = reading.text_of(entry)?;
        Some(Named { name, span })
    });
    let watch = watch.collect();
    let allows_errors = reading.entry(table, "allow-errors").is_some_and(|entry| reading.is_true(entry));
    let mut plan = steps::Plan::new(clock, tolerance, deviation);
    for list in common.steps.into_iter().chain(reading.entry(table, "steps")) {
        plan.begin();
        for entry in reading.list_of(list) {
            if let Some(step) = reading.table_of(entry) {
                plan.step(reading, entry.span, step);
            }
        }
    }
    let last = match time {
        Some((time_ns, span)) => {
            let last = clock.last(time_ns);
            plan.ends_at(reading, last, span);
            Some(last)
        }
        None if golden.is_some() => None,
        None => {
            plan.has_end(reading);
            Some(plan.last)
        }
    };
    if plan.checks.is_empty() && golden.is_none() && reading.flaws.is_empty() {
        reading.flaw(name.span, Message::new("scenario.expects-nothing").with("name", &name.name));
    }
    plan.inputs.sort_by_key(|input| input.scan);
    Scenario {
        name: name.name,
        span: name.span,
        scan_ns,
        last,
        inputs: plan.inputs,
        checks: plan.checks,
        watch,
        golden,
        tolerance,
        deviation,
        allows_errors,
    }
}

/// The header `[[scenario]]` of a table, or the first line of it.
fn header_of(reading: &Reading<'_>, entry: Entry<'_>) -> Span {
    let text = entry.span.of(reading.text);
    let line = text.lines().next().map_or(0, str::len);
    Span::new(entry.span.start as usize, entry.span.start as usize + line)
}

fn word<'a>(reading: &mut Reading<'_>, table: &'a DeTable<'a>, key: &str) -> Option<Named> {
    let entry = reading.entry(table, key)?;
    let (name, span) = reading.text_of(entry)?;
    Some(Named { name, span })
}

fn scan_time<'a>(reading: &mut Reading<'_>, table: &'a DeTable<'a>, otherwise: i64) -> i64 {
    let Some(entry) = reading.entry(table, "scan-time") else { return otherwise };
    let time_ns = match entry.value {
        DeValue::String(word) => duration(word),
        DeValue::Integer(_) | DeValue::Float(_) => reading.number_of(entry).map(|ms| (ms * 1e6) as i64),
        _ => None,
    };
    match time_ns.filter(|time_ns| SCAN_RANGE_NS.contains(time_ns)) {
        Some(time_ns) => time_ns,
        None => {
            reading.flaw(entry.span, Message::new("scenario.scan-time"));
            otherwise
        }
    }
}
