//! Golden traces: tables of values over time that a scenario must give.

use super::suite::Scenario;
use super::{Expected, Failure};
use crate::simulate::{Trace, Value};
use crate::text::Message;

/// A golden trace, as `Trace::csv` writes it: a row for each scan with a change, for the first and the last.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Golden {
    names: Vec<String>,
    /// Scans, and the values in each.
    rows: Vec<(u64, Vec<Value>)>,
}

impl Golden {
    /// Reads the text of a table.
    ///
    /// # Errors
    /// With the sentence that says in which line it is none.
    pub fn read(text: &str) -> Result<Golden, Message> {
        let wrong = |line: usize| Message::new("scenario.golden-unreadable").with("line", line + 1);
        let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
        let head = lines.next().map(|(_, line)| fields(line)).unwrap_or_default();
        let [scan, time, names @ ..] = &head[..] else { return Err(wrong(0)) };
        if (scan.trim(), time.trim()) != ("scan", "time_ms") || names.is_empty() {
            return Err(wrong(0));
        }
        let mut golden =
            Golden { names: names.iter().map(|name| name.trim().to_string()).collect(), rows: Vec::new() };
        for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
            let row = fields(line);
            let [scan, _, values @ ..] = &row[..] else { return Err(wrong(number)) };
            let values: Option<Vec<Value>> = values.iter().map(|value| Value::read(value)).collect();
            let (Ok(scan), Some(values)) = (scan.trim().parse(), values) else { return Err(wrong(number)) };
            let is_next = golden.rows.last().is_none_or(|(before, _)| *before < scan);
            if values.len() != golden.names.len() || !is_next || scan > MOST_SCANS {
                return Err(wrong(number));
            }
            golden.rows.push((scan, values));
        }
        if golden.rows.is_empty() { Err(Message::new("scenario.golden-names")) } else { Ok(golden) }
    }

    /// The variables, as the columns are called.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The last scan.
    pub fn last(&self) -> Option<u64> {
        self.rows.last().map(|(scan, _)| *scan)
    }

    /// Where `trace` is otherwise: of each variable the first scan.
    pub(super) fn compare(&self, trace: &Trace, scenario: &Scenario) -> Vec<Failure> {
        let span = scenario.golden.as_ref().map_or(scenario.span, |golden| golden.span);
        let time_ns = |scan: u64| (scan as i64).saturating_mul(scenario.scan_ns);
        let last = trace.rows.last().map_or(0, |row| row.scan);
        let mut failures = Vec::new();
        if let Some(own) = self.last().filter(|own| *own != last) {
            let message = Message::new("scenario.golden-length").with("last", own);
            failures.push(Failure::at(last, time_ns(last), span, message));
        }
        for (column, name) in self.names.iter().enumerate() {
            let Some(number) = trace.names.iter().position(|own| own == name) else { continue };
            let actual_in = |scan: u64| {
                let at = trace.rows.partition_point(|row| row.scan <= scan);
                trace.rows.get(at.checked_sub(1)?)?.values.get(number)
            };
            let found = self.moments(trace, scenario.tolerance, last).into_iter().find_map(|scan| {
                let actual = actual_in(scan)?;
                (!self.allows(column, scan, actual, scenario)).then_some((scan, actual))
            });
            let Some((scan, actual)) = found else { continue };
            let expected = self.value(column, scan).map(Value::to_string).unwrap_or_default();
            let message = Message::new("scenario.golden")
                .with("name", name)
                .with("actual", actual)
                .with("expected", &expected);
            let failure = Failure::at(scan, time_ns(scan), span, message);
            let (name, actual) = (Some(name.clone()), Some(actual.to_string()));
            failures.push(Failure { name, actual, expected: Some(expected), ..failure });
        }
        failures.sort_by_key(|failure| failure.scan);
        failures
    }

    /// The scans in which an answer may change: around those in which something changes.
    fn moments(&self, trace: &Trace, tolerance: u64, last: u64) -> Vec<u64> {
        let own = self.rows.iter().map(|(scan, _)| *scan);
        let around = own.flat_map(|scan| {
            [
                scan.saturating_sub(tolerance),
                scan,
                scan.saturating_add(tolerance),
                scan.saturating_add(tolerance + 1),
            ]
        });
        let mut moments: Vec<u64> = around.chain(trace.rows.iter().map(|row| row.scan)).collect();
        moments.retain(|scan| *scan <= last);
        moments.sort_unstable();
        moments.dedup();
        moments
    }

    /// Whether the value of a column may be `actual` in a scan: as it is in one near to it.
    fn allows(&self, column: usize, scan: u64, actual: &Value, scenario: &Scenario) -> bool {
        let first = scan.saturating_sub(scenario.tolerance);
        let end = scan.saturating_add(scenario.tolerance);
        let start = self.rows.partition_point(|(own, _)| *own <= first).saturating_sub(1);
        let near = self.rows.iter().skip(start).take_while(|(own, _)| *own <= end);
        near.filter_map(|(_, values)| values.get(column)).any(|value| {
            // In tables bits are 0 and 1.
            let expected = match value.as_number() {
                Some(number) if actual.as_number().is_some() => Expected::Between(number, number),
                _ => Expected::Is(value.clone()),
            };
            expected.holds(actual, scenario.deviation)
        })
    }

    fn value(&self, column: usize, scan: u64) -> Option<&Value> {
        let at = self.rows.partition_point(|(own, _)| *own <= scan);
        self.rows.get(at.checked_sub(1)?)?.1.get(column)
    }
}

/// No scenario has more.
const MOST_SCANS: u64 = 1_000_000;

/// The fields of a line as RFC 4180 has them.
fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let (mut is_quoted, mut before) = (false, ',');
    for letter in line.chars() {
        match letter {
            '"' => {
                // Two of them within quotes are one.
                if !is_quoted && before == '"' {
                    fields.last_mut().into_iter().for_each(|field| field.push('"'));
                }
                is_quoted = !is_quoted;
            }
            ',' if !is_quoted => fields.push(String::new()),
            _ => fields.last_mut().into_iter().for_each(|field| field.push(letter)),
        }
        before = letter;
    }
    fields
}
