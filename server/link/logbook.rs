//! What a host saw of devices, look by look: the changes of their values, of which the latest are kept.

use super::Point;
use crate::simulate::{Change, Trace, Value, thinned};
use std::collections::{BTreeSet, VecDeque};

/// Changes of values while a PLC is watched. Times are nanoseconds from the first look on.
#[derive(Clone, Debug)]
pub struct Logbook {
    signals: Vec<Logged>,
    /// How many changes are kept, of all points together.
    most: usize,
    count: usize,
    last_ns: u64,
    beginnings: u64,
}

/// A point over time.
#[derive(Clone, Debug)]
struct Logged {
    point: Point,
    changes: VecDeque<Change>,
}

/// Changes that are kept if nobody says otherwise: some megabytes, and days of a machine that does little.
pub const USUAL_CHANGES: usize = 100_000;

impl Default for Logbook {
    fn default() -> Logbook {
        Logbook { signals: Vec::new(), most: USUAL_CHANGES, count: 0, last_ns: 0, beginnings: 0 }
    }
}

impl Logbook {
    /// Forgets all: the next look is the first one. Keeps so many changes from now on.
    pub fn begin(&mut self, most: usize) {
        let beginnings = self.beginnings + 1;
        *self = Logbook { most: most.max(1), beginnings, ..Logbook::default() };
    }

    /// How often it began.
    pub fn beginnings(&self) -> u64 {
        self.beginnings
    }

    /// Notes what was read in a look.
    pub fn note<'a>(&mut self, time_ns: u64, read: impl Iterator<Item = (Point, &'a Value)>) {
        self.last_ns = time_ns;
        for (point, value) in read {
            let known = self.signals.iter().position(|signal| signal.point == point);
            let at = known.unwrap_or_else(|| {
                self.signals.push(Logged { point, changes: VecDeque::new() });
                self.signals.len() - 1
            });
            let changes = &mut self.signals[at].changes;
            if changes.back().is_none_or(|(_, before)| before != value) {
                changes.push_back((time_ns, value.clone()));
                self.count += 1;
            }
        }
        while self.count > self.most {
            let longest = self.signals.iter_mut().max_by_key(|signal| signal.changes.len());
            // Of each point the last value remains.
            let Some(longest) = longest.filter(|signal| signal.changes.len() > 1) else { return };
            longest.changes.pop_front();
            self.count -= 1;
        }
    }

    /// The time of the last look.
    pub fn last_ns(&self) -> u64 {
        self.last_ns
    }

    /// What is known, in the order in which it was first read.
    pub fn points(&self) -> Vec<Point> {
        self.signals.iter().map(|signal| signal.point).collect()
    }

    /// From when on the values of a point are known.
    pub fn known_from_ns(&self, point: Point) -> Option<u64> {
        self.logged(point)?.changes.front().map(|(time_ns, _)| *time_ns)
    }

    /// The value at `from_ns`, or the earliest one behind it, and the changes up to `to_ns`, `most` or a few more.
    pub fn changes(&self, point: Point, from_ns: u64, to_ns: u64, most: usize) -> Vec<Change> {
        let changes = self.logged(point).map(|signal| signal.changes.iter().cloned().collect::<Vec<_>>());
        thinned(&changes.unwrap_or_default(), from_ns, to_ns, most)
    }

    /// The values of points with all changes that are kept; what no look has read is left out.
    pub fn trace(&self, points: &[Point]) -> Trace {
        let signals: Vec<&Logged> = points.iter().filter_map(|point| self.logged(*point)).collect();
        let mut trace = Trace::of_names(signals.iter().map(|signal| signal.point.to_string()).collect());
        let mut times: BTreeSet<u64> =
            signals.iter().flat_map(|signal| signal.changes.iter().map(|(time_ns, _)| *time_ns)).collect();
        times.insert(self.last_ns);
        let mut next = vec![0; signals.len()];
        for time_ns in times {
            for (signal, next) in signals.iter().zip(&mut next) {
                *next += usize::from(signal.changes.get(*next).is_some_and(|(own, _)| *own == time_ns));
            }
            let value = |(signal, next): (&&Logged, &usize)| {
                next.checked_sub(1).and_then(|at| signal.changes.get(at)).map(|(_, value)| value.clone())
            };
            let values = signals.iter().zip(&next).map(value).collect();
            trace.push_known(trace.rows.len() as u64, time_ns as i64, values);
        }
        trace.end();
        trace
    }

    fn logged(&self, point: Point) -> Option<&Logged> {
        self.signals.iter().find(|signal| signal.point == point)
    }
}
