//! What some variables were while a program runs: every change of late, and of long ago the least and the greatest
//! value in each of equal spans of time.
//!
//! A change costs some bytes and a scan without one a comparison, so a chart of a run of any length is kept beside it.
//! What was before a variable was recorded is found by running the history again, in portions.

use super::machine::Machine;
use super::session::Session;
use super::{Value, Variable};

/// The recorded variables. Scans are counted as those of a [`Session`].
#[derive(Debug, Default)]
pub struct Recorder {
    signals: Vec<Signal>,
}

/// A variable over time.
#[derive(Clone, Debug)]
pub struct Signal {
    /// As people call it.
    pub name: String,
    variable: Variable,
    /// From this scan on every change is there; before it, the extremes of some at a time.
    exact_from: u64,
    /// How many scans have their extremes together before that.
    span: u64,
    /// In the order of scans; the first one is the earliest value that is known.
    changes: Vec<Change>,
}

/// A value, and the scan after which it was there.
pub type Change = (u64, Value);

/// More changes of a variable are thinned out.
const MOST_CHANGES: usize = 1 << 15;
/// Scans of which the first, the least, the greatest and the last value are kept; more in a longer run.
const FIRST_SPAN: u64 = 16;
/// More variables are not recorded at once.
const MOST_SIGNALS: usize = 64;
/// Instructions that are run again at most to look back once; a fraction of a second.
const MOST_RUN_AGAIN: u64 = 40_000_000;

impl Recorder {
    /// Records these variables from now on; of others as many as there is room for, and none that the code lacks.
    pub fn record(&mut self, names: &[String], machine: &Machine<u8>) {
        for name in names.iter().take(MOST_SIGNALS) {
            let known = self.signals.iter().position(|signal| signal.name == *name);
            let signal = match known {
                Some(at) => self.signals.remove(at),
                None => match machine.code().variable(name) {
                    Some(variable) => Signal::new(name.clone(), variable, machine),
                    None => continue,
                },
            };
            // Those that were asked for last stand last.
            self.signals.push(signal);
        }
        let beyond = self.signals.len().saturating_sub(MOST_SIGNALS);
        self.signals.drain(..beyond);
    }

    /// Notes what the variables are after a scan.
    pub fn note(&mut self, machine: &Machine<u8>) {
        self.signals.iter_mut().for_each(|signal| signal.note(machine));
    }

    /// Forgets what came after a scan that was gone back to.
    pub fn cut(&mut self, machine: &Machine<u8>) {
        let last = machine.scans();
        for signal in &mut self.signals {
            signal.changes.retain(|(scan, _)| *scan <= last);
            signal.exact_from = signal.exact_from.min(last);
            signal.note(machine);
        }
    }

    /// Begins anew with a PLC that was just switched on.
    pub fn clear(&mut self) {
        for signal in &mut self.signals {
            signal.changes.clear();
            (signal.exact_from, signal.span) = (0, FIRST_SPAN);
        }
    }

    /// Goes on with other code for the same PLC; what it does not have is no longer recorded.
    pub fn adopt(&mut self, machine: &Machine<u8>) {
        self.signals.retain_mut(|signal| {
            let found = machine.code().variable(&signal.name);
            found.map(|variable| signal.variable = variable).is_some()
        });
    }

    /// What is recorded of a variable.
    pub fn signal(&self, name: &str) -> Option<&Signal> {
        self.signals.iter().find(|signal| signal.name == name)
    }

    /// Finds what was before variables were recorded, back to `first`, a portion at a time while `goes_on`. History
    /// that is too long to be run again stays unknown.
    pub fn look_back(&mut self, session: &Session, first: u64, mut goes_on: impl FnMut() -> bool) {
        let first = first.max(session.first_scan()).max(1);
        loop {
            let latest = self.signals.iter().map(Signal::since).max().unwrap_or(0);
            if latest <= first || latest > session.machine().scans() || !goes_on() {
                return;
            }
            let from = session.moment_of(latest - 1).max(first);
            if !is_affordable(session, from, latest - 1) {
                return;
            }
            let wanted = self.signals.iter_mut().filter(|signal| signal.since() == latest);
            let mut wanted: Vec<&mut Signal> = wanted.collect();
            let mut before: Vec<Vec<Change>> = vec![Vec::new(); wanted.len()];
            session.walk(from, latest - 1, |machine| {
                wanted
                    .iter()
                    .zip(&mut before)
                    .for_each(|(signal, changes)| signal.note_into(changes, machine));
                true
            });
            for (signal, mut changes) in wanted.iter_mut().zip(before) {
                if changes.is_empty() {
                    return;
                }
                changes.append(&mut signal.changes);
                changes.dedup_by(|later, earlier| later.1 == earlier.1);
                signal.changes = changes;
                if signal.exact_from <= latest {
                    signal.exact_from = from;
                }
                signal.thin();
            }
        }
    }

    /// The same variables from `first` to `last` with every change, run again; nothing if that would take too long.
    pub fn again(&self, names: &[String], session: &Session, first: u64, last: u64) -> Option<Recorder> {
        let start = session.moment_of(first.max(1));
        if first < session.first_scan() || !is_affordable(session, start, last) {
            return None;
        }
        let signals = self.signals.iter().filter(|signal| names.contains(&signal.name));
        let empty = |signal: &Signal| Signal { changes: Vec::new(), exact_from: first, ..signal.clone() };
        let mut again = Recorder { signals: signals.map(empty).collect() };
        session.walk(first.max(1), last, |machine| {
            again.signals.iter_mut().for_each(|signal| signal.note(machine));
            true
        });
        Some(again)
    }
}

/// Whether scans can be run again while somebody waits.
pub fn is_affordable(session: &Session, first: u64, last: u64) -> bool {
    let each = session.machine().code().instructions().max(1) as u64;
    last.saturating_sub(first).saturating_mul(each) <= MOST_RUN_AGAIN
}

impl Signal {
    fn new(name: String, variable: Variable, machine: &Machine<u8>) -> Signal {
        let mut signal =
            Signal { name, variable, exact_from: machine.scans(), span: FIRST_SPAN, changes: Vec::new() };
        signal.note(machine);
        signal
    }

    /// The earliest scan whose value is known.
    pub fn since(&self) -> u64 {
        self.changes.first().map_or(u64::MAX, |(scan, _)| *scan)
    }

    /// From this scan on every change is known.
    pub fn exact_from(&self) -> u64 {
        self.exact_from
    }

    fn note(&mut self, machine: &Machine<u8>) {
        let mut changes = std::mem::take(&mut self.changes);
        self.note_into(&mut changes, machine);
        self.changes = changes;
        self.thin();
    }

    fn note_into(&self, changes: &mut Vec<Change>, machine: &Machine<u8>) {
        let value = machine.value(self.variable, 0);
        if changes.last().is_none_or(|(_, before)| *before != value) {
            changes.push((machine.scans(), value));
        }
    }

    /// Of the older half of what is exact only the extremes of equal spans of time are kept from now on, as of what is
    /// older; spans grow with the time that there is.
    fn thin(&mut self) {
        if self.changes.len() <= MOST_CHANGES {
            return;
        }
        let exact = self.changes.partition_point(|(scan, _)| *scan < self.exact_from);
        let half = ((exact + self.changes.len()) / 2).min(self.changes.len() - 1);
        let late = self.changes.split_off(half);
        self.exact_from = late[0].0;
        loop {
            let span = self.span;
            let old = self.changes.chunk_by(|one, other| one.0 / span == other.0 / span);
            self.changes = old.flat_map(extremes).collect();
            if self.changes.len() <= MOST_CHANGES / 2 {
                break;
            }
            self.span *= 2;
        }
        self.changes.extend(late);
    }

    /// The value at `first`, or the earliest one if that is later, and the changes up to `last`, see [`thinned`].
    pub fn changes(&self, first: u64, last: u64, most: usize) -> Vec<Change> {
        thinned(&self.changes, first, last, most)
    }
}

/// Of changes in the order of their times the value at `first`, or the earliest one if that is later, and what comes up
/// to `last`, `most` or a few more of them: of more changes the first, the least, the greatest and the last in each of
/// equal spans of time.
pub fn thinned(changes: &[Change], first: u64, last: u64, most: usize) -> Vec<Change> {
    let behind = changes.partition_point(|(scan, _)| *scan <= first);
    let end = changes.partition_point(|(scan, _)| *scan <= last);
    let begin = behind.saturating_sub(1);
    let Some(shown) = changes.get(begin..end).filter(|shown| !shown.is_empty()) else {
        return Vec::new();
    };
    let mut kept: Vec<Change> = if shown.len() <= most {
        shown.to_vec()
    } else {
        let span = (last - first) / (most as u64 / 4).max(1) + 1;
        let same = |one: &Change, other: &Change| {
            one.0.saturating_sub(first) / span == other.0.saturating_sub(first) / span
        };
        shown.chunk_by(same).flat_map(extremes).collect()
    };
    kept[0].0 = kept[0].0.max(first);
    kept
}

/// The first, the least, the greatest and the last of some changes, in their order.
fn extremes(changes: &[Change]) -> Vec<Change> {
    let sizes: Vec<f64> = changes.iter().map(|(_, value)| size(value)).collect();
    let least = (0..sizes.len()).min_by(|a, b| sizes[*a].total_cmp(&sizes[*b])).unwrap_or(0);
    let greatest = (0..sizes.len()).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b])).unwrap_or(0);
    let mut kept = vec![0, least, greatest, changes.len() - 1];
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|at| changes[at].clone()).collect()
}

/// A value as a number, for comparing.
fn size(value: &Value) -> f64 {
    value.as_number().unwrap_or(0.0)
}
