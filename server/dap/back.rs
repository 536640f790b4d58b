//! Going back to the last breakpoint, slice by slice, so that it can be stopped.
//!
//! Scans can only be run forwards. So stretches of them are run again, the last one first, and what the program comes
//! to in one is noted; from its end back the first thing that stops is where the way ends.

use super::breakpoints::{Breakpoints, Hit, Passed};
use super::debuggee::{Debuggee, run_to_stop};
use crate::simulate::Machine;

/// A search back from where the program stands.
pub(super) struct BackSearch {
    /// The scan behind which the next stretch ends, and how many of its moments count.
    end: u64,
    counting: u64,
    /// Scans of the next stretch.
    length: u64,
    stretch: Option<Stretch>,
}

/// Scans that are run again.
struct Stretch {
    start: u64,
    machine: Machine<u8>,
    /// The next scan.
    scan: u64,
    /// What the program came to, by scan and number of the moment in it.
    moments: Vec<(u64, u64, Vec<Passed>)>,
}

/// Where the way back ends.
pub(super) struct Reached {
    pub(super) scan: u64,
    /// Which moment of the scan, from 1 on.
    pub(super) number: u64,
    pub(super) hit: Hit,
}

/// More scans are not run again at once.
const LONGEST_STRETCH: u64 = 4096;

impl BackSearch {
    /// A search for what comes before the place where the program stands.
    pub(super) fn new(debuggee: &Debuggee, breakpoints: &mut Breakpoints) -> BackSearch {
        // Of what it stands at was counted that it came there.
        if let Some(passed) = debuggee.at_here(|glimpse| breakpoints.passed(glimpse)) {
            breakpoints.uncount(&passed);
        }
        let counting = debuggee.seen().saturating_sub(1);
        BackSearch { end: debuggee.scan(), counting, length: 1, stretch: None }
    }

    /// Goes on while there is time. Gives where the way ends, of which there is nothing if no breakpoint comes before;
    /// nothing at all as long as that is not known.
    pub(super) fn look(
        &mut self,
        debuggee: &Debuggee,
        breakpoints: &mut Breakpoints,
        has_time: impl Fn() -> bool,
    ) -> Option<Option<Reached>> {
        let first = debuggee.session().first_scan() + 1;
        loop {
            let mut stretch = match self.stretch.take() {
                Some(stretch) => stretch,
                None => {
                    let start = self.end.saturating_sub(self.length - 1).max(first);
                    let Some(machine) = debuggee.session().at(start - 1) else { return Some(None) };
                    breakpoints.begin(&machine, false);
                    Stretch { start, machine, scan: start, moments: Vec::new() }
                }
            };
            while stretch.scan <= self.end {
                if !has_time() {
                    self.stretch = Some(stretch);
                    return None;
                }
                let most = if stretch.scan == self.end { self.counting } else { u64::MAX };
                stretch.run(most, debuggee, breakpoints);
            }
            while let Some((scan, number, passed)) = stretch.moments.pop() {
                if let Some(hit) = breakpoints.take_back(passed) {
                    return Some(Some(Reached { scan, number, hit }));
                }
            }
            if stretch.start <= first {
                return Some(None);
            }
            self.end = stretch.start - 1;
            (self.counting, self.length) = (u64::MAX, (self.length * 2).min(LONGEST_STRETCH));
        }
    }
}

impl Stretch {
    /// Runs its next scan, of which so many moments count.
    fn run(&mut self, most: u64, debuggee: &Debuggee, breakpoints: &mut Breakpoints) {
        let scan = self.scan;
        self.scan += 1;
        if most == 0 {
            return;
        }
        debuggee.touches(scan).for_each(|touch| touch.apply(&mut self.machine));
        let (mut number, moments) = (0, &mut self.moments);
        run_to_stop(&mut self.machine, debuggee.time_of(scan), &mut |glimpse| {
            number += 1;
            let passed = breakpoints.passed(glimpse);
            if !passed.is_empty() {
                moments.push((scan, number, passed));
            }
            number < most
        });
    }
}
