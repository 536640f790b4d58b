//! What was seen of a PLC while a program was monitored: for the chart of a panel, and for files. It is kept when the
//! line is gone, until something is monitored again.

use super::Asked;
use crate::link::{Logbook, Point, USUAL_CHANGES};
use crate::simulate::{Change, Value};
use crate::target::{Model, Target};
use crate::text::Message;
use serde_json::{Value as Json, json};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The logbook, and what is to be read for it in any case.
pub(super) struct Recording {
    book: Logbook,
    target: &'static Target,
    wanted: Vec<String>,
}

/// The thread that has the line writes it, and who asks reads it meanwhile.
#[derive(Clone)]
pub(super) struct SharedRecording(Arc<Mutex<Recording>>);

/// As many names are read because somebody has a chart of them.
const MOST_WANTED: usize = 64;
/// Points of a name, if nothing is said; and at most.
const POINTS: (usize, usize) = (2_000, 20_000);
const NS_PER_MS: u64 = 1_000_000;

impl Default for SharedRecording {
    fn default() -> SharedRecording {
        let (book, target) = (Logbook::default(), Target::of(Model::Fx2n));
        SharedRecording(Arc::new(Mutex::new(Recording { book, target, wanted: Vec::new() })))
    }
}

impl SharedRecording {
    fn lock(&self) -> MutexGuard<'_, Recording> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Forgets what was seen before: so many changes of a PLC are kept from now on.
    pub(super) fn begin(&self, target: &'static Target, most: Option<usize>) {
        let mut recording = self.lock();
        recording.target = target;
        recording.book.begin(most.unwrap_or(USUAL_CHANGES));
    }

    /// Notes a look.
    pub(super) fn note<'a>(&self, time_ns: i64, read: impl Iterator<Item = (Point, &'a Value)>) {
        self.lock().book.note(time_ns.unsigned_abs(), read);
    }

    /// What is to be read in any case.
    pub(super) fn wanted(&self) -> Vec<String> {
        self.lock().wanted.clone()
    }

    /// How often a recording began, as charts want to know it.
    pub(super) fn branch(&self) -> u64 {
        self.lock().book.beginnings()
    }

    /// The answer to `rungwise.plc.trace`.
    pub(super) fn trace(&self, asked: &Asked) -> Json {
        let mut recording = self.lock();
        let names = asked.names.clone().unwrap_or_default();
        recording.want(&names);
        let last = recording.book.last_ns() / NS_PER_MS;
        let to = asked.to.unwrap_or(last).min(last);
        let from = asked.from.unwrap_or(0).min(to);
        let most = asked.most.unwrap_or(POINTS.0).clamp(8, POINTS.1);
        let point = |(time_ns, value): &Change| json!([time_ns / NS_PER_MS, value.json()]);
        let signals = names.iter().filter_map(|name| {
            let own = Point::named(name, recording.target)?;
            let known_from = recording.book.known_from_ns(own)? / NS_PER_MS;
            let end = to * NS_PER_MS + NS_PER_MS - 1;
            let changes = recording.book.changes(own, from * NS_PER_MS, end, most);
            let points: Vec<Json> = changes.iter().map(point).collect();
            Some(json!({ "name": name, "known_from": known_from, "points": points }))
        });
        let signals: Vec<Json> = signals.collect();
        json!({ "from": from, "to": to, "branch": recording.book.beginnings(), "signals": signals })
    }

    /// The answer to `rungwise.plc.export`.
    pub(super) fn export(&self, asked: &Asked) -> Result<Json, Message> {
        let recording = self.lock();
        let named = asked.names.iter().flatten();
        let points: Vec<Point> = match asked.names.as_ref().is_none_or(Vec::is_empty) {
            true => recording.book.points(),
            false => named.filter_map(|name| Point::named(name, recording.target)).collect(),
        };
        let trace = recording.book.trace(&points);
        if trace.rows.is_empty() || trace.names.is_empty() {
            return Err(Message::new("link.nothing-recorded"));
        }
        let from = trace.rows.first().map_or(0, |row| row.time_ns) / NS_PER_MS as i64;
        let text = match asked.format.as_deref() {
            Some("csv") => trace.csv(),
            _ => {
                let written = trace
                    .vcd()
                    .map_err(|reason| Message::new("link.failed").with("reasons", reason.to_string()))?;
                String::from_utf8_lossy(&written).into_owned()
            }
        };
        Ok(json!({ "from": from, "to": recording.book.last_ns() / NS_PER_MS, "text": text }))
    }
}

impl Recording {
    /// Has these read from now on; of others as many as there is room for.
    fn want(&mut self, names: &[String]) {
        if names.iter().all(|name| self.wanted.contains(name)) {
            return;
        }
        self.wanted.retain(|known| !names.contains(known));
        self.wanted.extend(names.iter().cloned());
        let beyond = self.wanted.len().saturating_sub(MOST_WANTED);
        self.wanted.drain(..beyond);
    }
}
