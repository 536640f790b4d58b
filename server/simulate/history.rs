//! How much of the past of a simulation is kept, and what it is measured by.

use super::session::Touch;
use std::fmt;
use std::ops::RangeInclusive;

/// The memory that the way back of a simulation may take. Its last two states are kept in any case.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct HistoryLimit {
    bytes: u64,
}

/// Units, the greatest first.
const UNITS: [(&str, u64); 3] = [("GiB", 1 << 30), ("MiB", 1 << 20), ("KiB", 1 << 10)];

impl HistoryLimit {
    /// The least has room for two states of any FX.
    const BYTES: RangeInclusive<u64> = 1 << 20..=16 << 30;

    /// A size such as `64 MiB`, from 1 MiB to 16 GiB; nothing for what is none.
    pub fn read(word: &str) -> Option<HistoryLimit> {
        let word = word.trim();
        let digits = word.bytes().take_while(u8::is_ascii_digit).count();
        let (number, unit) = word.split_at(digits);
        let is_unit = |(name, _): &&(&str, u64)| name.eq_ignore_ascii_case(unit.trim());
        let (_, factor) = UNITS.iter().find(is_unit)?;
        let bytes = number.parse::<u64>().ok()?.checked_mul(*factor)?;
        HistoryLimit::BYTES.contains(&bytes).then_some(HistoryLimit { bytes })
    }

    /// How many states of so many bytes it has room for. They have one half of it, and what was done has the other.
    pub(super) fn states(self, bytes: usize) -> usize {
        let most = self.bytes / 2 / bytes.max(1) as u64;
        usize::try_from(most).unwrap_or(usize::MAX).clamp(LEAST_STATES, MOST_STATES)
    }

    /// The bytes that what was done between scans may take.
    pub(super) fn log(self) -> usize {
        usize::try_from(self.bytes / 2).unwrap_or(usize::MAX)
    }
}

/// The way back by a scan begins at a state before it.
const LEAST_STATES: usize = 2;
/// With so many no way to a scan is long; more cost memory and make none shorter that people would notice.
const MOST_STATES: usize = 1024;

impl Default for HistoryLimit {
    fn default() -> HistoryLimit {
        HistoryLimit { bytes: 64 << 20 }
    }
}

impl fmt::Display for HistoryLimit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = UNITS.iter().find(|(_, factor)| self.bytes.is_multiple_of(*factor));
        let (name, factor) = unit.copied().unwrap_or(("B", 1));
        write!(formatter, "{} {name}", self.bytes / factor)
    }
}

/// What was done before which scan, in order, and when scans began.
#[derive(Debug, Default)]
pub(super) struct Log {
    pub(super) touches: Vec<(u64, Touch)>,
    pub(super) times: Times,
}

impl Log {
    /// The memory that it takes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.touches.as_slice()) + size_of_val(self.times.runs.as_slice())
    }

    /// What was done before a scan.
    pub(super) fn touches_before(&self, scan: u64) -> impl Iterator<Item = &Touch> {
        let first = self.touches.partition_point(|(before, _)| *before < scan);
        let touches = self.touches.get(first..).unwrap_or_default().iter();
        touches.take_while(move |(before, _)| *before == scan).map(|(_, touch)| touch)
    }

    /// The scan before which half of it is.
    pub(super) fn middle(&self) -> u64 {
        let touches = self.touches.get(self.touches.len() / 2).map(|(before, _)| *before);
        let runs = self.times.runs.get(self.times.runs.len() / 2).map(|run| run.first);
        let is_of_touches = size_of_val(self.touches.as_slice()) * 2 > self.bytes();
        if is_of_touches { touches } else { runs }.unwrap_or(0)
    }

    /// Leaves out what came after a scan.
    pub(super) fn cut(&mut self, last: u64) {
        self.touches.retain(|(before, _)| *before <= last);
        self.times.cut(last);
    }

    /// Leaves out what is not needed to run on from the state after a scan.
    pub(super) fn forget(&mut self, begin: u64) {
        let old = self.touches.partition_point(|(before, _)| *before <= begin);
        self.touches.drain(..old);
        self.times.forget(begin);
    }
}

/// When scans began: runs of scans that followed each other at one distance.
#[derive(Debug, Default)]
pub(super) struct Times {
    runs: Vec<Run>,
    last: u64,
}

/// A run of scans.
#[derive(Clone, Copy, Debug)]
struct Run {
    first: u64,
    time_ns: i64,
    step_ns: i64,
}

impl Times {
    pub(super) fn push(&mut self, scan: u64, time_ns: i64) {
        self.last = scan;
        match self.runs.last_mut() {
            Some(run) if scan == run.first + 1 => {
                run.step_ns = time_ns - run.time_ns;
            }
            Some(run) if run.at(scan) == time_ns => {}
            _ => self.runs.push(Run { first: scan, time_ns, step_ns: 0 }),
        }
    }

    pub(super) fn of(&self, scan: u64) -> Option<i64> {
        let after = self.runs.partition_point(|run| run.first <= scan);
        let run = self.runs.get(after.checked_sub(1)?)?;
        (scan <= self.last).then(|| run.at(scan))
    }

    fn cut(&mut self, last: u64) {
        self.runs.retain(|run| run.first <= last);
        self.last = self.last.min(last);
    }

    pub(super) fn forget(&mut self, first: u64) {
        let keep = self.runs.partition_point(|run| run.first <= first).saturating_sub(1);
        self.runs.drain(..keep);
    }
}

impl Run {
    fn at(&self, scan: u64) -> i64 {
        self.time_ns + (scan - self.first) as i64 * self.step_ns
    }
}
