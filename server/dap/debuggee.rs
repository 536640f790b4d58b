//! The PLC that is debugged: where it stands inside a scan, and the ways on and back from there.
//!
//! A place in time is a scan and how many of its instructions have been seen. A scan depends on nothing but the state
//! before it, its time and what was done before it; so each place is reached again by running the scan up to it, with
//! the same values. What a person did is kept: who has gone back and goes on meets it again, until something else is
//! done.

use crate::simulate::{
    Caller, Code, Error, Glimpse, HistoryLimit, Machine, Outcome, Place, Session, Sight, Touch, Variable,
};
use std::sync::Arc;

/// The PLC, somewhere in a scan.
pub(super) struct Debuggee {
    /// All scans before the one that it stands in.
    session: Session,
    /// The scan that it stands in, from 1 on.
    scan: u64,
    /// How many instructions of it were seen; 0 is before the first.
    seen: u64,
    /// The PLC as it is there; between two scans that of the session is.
    machine: Machine<u8>,
    here: Option<Here>,
    /// What is done at times that were given from the start, each before a scan.
    settings: Vec<(u64, Touch)>,
    /// What a person did, each before a scan.
    done: Vec<(u64, Touch)>,
    scan_ns: i64,
}

/// Where it stands: at an instruction that has seen what reaches it, and has not acted yet.
#[derive(Clone, Debug)]
pub(super) struct Here {
    pub(super) place: Place,
    /// The instruction, by its number.
    pub(super) instruction: u32,
    /// What it sees, if there is power to be seen.
    pub(super) sight: Option<Sight<u8>>,
    /// Where the routines that it is in were entered, the innermost last.
    pub(super) callers: Vec<Caller>,
}

/// Where going on through a scan ended.
#[derive(Debug)]
pub(super) enum Ended<T> {
    /// At an instruction for which the watcher gave something.
    Stopped(T),
    /// At an instruction that is about to fail.
    Failing(Error),
    /// At the end of the scan; what went wrong in it.
    Through(Vec<Error>),
}

impl Debuggee {
    /// A PLC that has not run yet; `settings` are done before the scans with these numbers.
    pub(super) fn new(
        code: Arc<Code>,
        history: HistoryLimit,
        scan_ns: i64,
        settings: Vec<(u64, Touch)>,
    ) -> Debuggee {
        let session = Session::new(code).with_limit(history);
        let machine = session.machine().clone();
        let mut new =
            Debuggee { session, scan: 1, seen: 0, machine, here: None, settings, done: Vec::new(), scan_ns };
        new.stand();
        new
    }

    /// The PLC as it is here.
    pub(super) fn machine(&self) -> &Machine<u8> {
        if self.seen == 0 { self.session.machine() } else { &self.machine }
    }

    /// The scans before this one.
    pub(super) fn session(&self) -> &Session {
        &self.session
    }

    pub(super) fn code(&self) -> &Arc<Code> {
        self.session.machine().code()
    }

    /// The instruction; nothing between two scans.
    pub(super) fn here(&self) -> Option<&Here> {
        self.here.as_ref()
    }

    /// The scan, from 1 on.
    pub(super) fn scan(&self) -> u64 {
        self.scan
    }

    /// When this scan began, in nanoseconds.
    pub(super) fn now_ns(&self) -> i64 {
        self.time_of(self.scan)
    }

    pub(super) fn time_of(&self, scan: u64) -> i64 {
        (scan as i64 - 1) * self.scan_ns
    }

    /// What the instructions saw that were executed in this scan: not the one at which it stands.
    pub(super) fn sights(&self) -> Vec<Sight<u8>> {
        let (mut sights, last) = (Vec::new(), self.seen);
        if last > 0 {
            let mut seen = 0;
            self.at_start().scan_inside(self.now_ns(), &mut |glimpse| {
                seen += u64::from(glimpse.is_stop);
                let is_done = seen < last;
                sights.extend(glimpse.sight.filter(|_| is_done));
                is_done
            });
        }
        sights
    }

    /// Does something to the PLC. It arrives between two scans, as with a real one: before this scan where nothing of
    /// it was executed yet, else before the next.
    pub(super) fn touch(&mut self, touch: Touch) {
        let scan = if self.seen <= 1 { self.scan } else { self.scan + 1 };
        // Another past has another future.
        self.done.retain(|(before, _)| *before <= scan);
        self.done.push((scan, touch));
        if self.seen == 1 {
            self.look(1);
        }
    }

    /// What was done that arrives before the next scan.
    pub(super) fn arriving(&self) -> impl Iterator<Item = &Touch> {
        let next = if self.seen == 0 { self.scan } else { self.scan + 1 };
        self.done.iter().filter(move |(before, _)| *before == next).map(|(_, touch)| touch)
    }

    /// The PLC where this scan begins.
    fn at_start(&self) -> Machine<u8> {
        let mut machine = self.session.machine().clone();
        self.touches(self.scan).for_each(|touch| touch.apply(&mut machine));
        machine
    }

    pub(super) fn touches(&self, scan: u64) -> impl Iterator<Item = &Touch> {
        let all = self.settings.iter().chain(&self.done);
        all.filter(move |(before, _)| *before == scan).map(|(_, touch)| touch)
    }

    /// Goes to the moment of this scan with this number, from 1 on; whether there is one.
    fn look(&mut self, number: u64) -> bool {
        let mut machine = self.at_start();
        let (mut seen, mut here) = (0, None);
        run_to_stop(&mut machine, self.now_ns(), &mut |glimpse| {
            seen += 1;
            if seen == number {
                here = Here::of(glimpse);
            }
            seen < number
        });
        if here.is_none() {
            return false;
        }
        (self.machine, self.seen, self.here) = (machine, number, here);
        true
    }

    /// Goes to the first instruction of this scan, if it stands before it.
    pub(super) fn stand(&mut self) {
        if self.seen == 0 {
            self.look(1);
        }
    }

    /// Goes on through this scan: `watch` is shown each instruction that is still to come. With `fails` it stops also
    /// before an instruction that fails.
    pub(super) fn advance<T>(
        &mut self,
        fails: bool,
        watch: &mut impl FnMut(&Glimpse<'_, u8>) -> Option<T>,
    ) -> Ended<T> {
        let failing = if fails { self.failing() } else { None };
        let last = failing.map_or(u64::MAX, |(number, _)| number);
        let mut machine = self.at_start();
        let (mut number, mut found, mut here) = (0, None, None);
        run_to_stop(&mut machine, self.now_ns(), &mut |glimpse| {
            number += 1;
            if number > self.seen {
                found = watch(glimpse);
            }
            let is_end = found.is_some() || number == last;
            if is_end {
                here = Here::of(glimpse);
            }
            !is_end
        });
        match (found, failing) {
            (Some(found), _) => {
                (self.machine, self.seen, self.here) = (machine, number, here);
                Ended::Stopped(found)
            }
            (None, Some((_, error))) => {
                (self.machine, self.seen, self.here) = (machine, number, here);
                Ended::Failing(error)
            }
            (None, None) => Ended::Through(self.finish()),
        }
    }

    /// Runs this scan to its end; gives what went wrong in it.
    pub(super) fn finish(&mut self) -> Vec<Error> {
        let touches: Vec<Touch> = self.touches(self.scan).cloned().collect();
        touches.into_iter().for_each(|touch| self.session.touch(touch));
        let outcome = self.session.scan(self.now_ns());
        self.begin(self.scan + 1);
        outcome.errors
    }

    /// The next instruction of this scan that fails, by the number of its moment, if it is not the one of here.
    fn failing(&self) -> Option<(u64, Error)> {
        let mut count = 0;
        let now_ns = self.now_ns();
        let all = run_to_stop(&mut self.at_start(), now_ns, &mut |_| {
            count += 1;
            true
        });
        all.errors.first()?;
        // So many went wrong before the moment with this number.
        let errors = |number: u64| {
            let mut seen = 0;
            let outcome = run_to_stop(&mut self.at_start(), now_ns, &mut |_| {
                seen += 1;
                seen < number
            });
            outcome.errors.len()
        };
        let passed = if self.seen == 0 { 0 } else { errors(self.seen + 1) };
        let error = *all.errors.get(passed)?;
        // It has not failed where the lower end is seen, and has where the upper one is.
        let (mut lower, mut upper) = (self.seen + 1, count + 1);
        while lower + 1 < upper {
            let middle = lower + (upper - lower) / 2;
            match errors(middle) > passed {
                true => upper = middle,
                false => lower = middle,
            }
        }
        (upper > self.seen + 1).then_some((upper - 1, error))
    }

    /// Goes back by one instruction; whether there is one before.
    pub(super) fn step_back(&mut self) -> bool {
        if self.seen > 1 {
            return self.look(self.seen - 1);
        }
        if !self.back_to(self.scan - 1) {
            return false;
        }
        let last = self.count();
        // A scan in which nothing is seen has no instruction to stand at.
        last == 0 || self.look(last)
    }

    /// Goes back to before an earlier scan; whether that is known.
    pub(super) fn back_to(&mut self, scan: u64) -> bool {
        if scan <= self.session.first_scan() || scan > self.scan || !self.session.back_to(scan - 1) {
            return false;
        }
        self.begin(scan);
        true
    }

    /// Stands before the first instruction of a scan.
    fn begin(&mut self, scan: u64) {
        (self.scan, self.seen, self.here) = (scan, 0, None);
    }

    fn count(&self) -> u64 {
        let mut count = 0;
        run_to_stop(&mut self.at_start(), self.now_ns(), &mut |_| {
            count += 1;
            true
        });
        count
    }

    /// How many instructions of this scan were seen.
    pub(super) fn seen(&self) -> u64 {
        self.seen
    }

    /// What `of` makes of the moment where it stands; nothing between two scans.
    pub(super) fn at_here<T>(&self, of: impl FnOnce(&Glimpse<'_, u8>) -> T) -> Option<T> {
        let (mut number, mut of, mut made) = (0, Some(of), None);
        if self.seen > 0 {
            run_to_stop(&mut self.at_start(), self.now_ns(), &mut |glimpse| {
                number += 1;
                if number == self.seen {
                    made = of.take().map(|of| of(glimpse));
                }
                number < self.seen
            });
        }
        made
    }

    /// Goes back to a moment of an earlier scan, or of this one.
    pub(super) fn back_into(&mut self, scan: u64, number: u64) -> bool {
        self.back_to(scan) && self.look(number)
    }

    /// Goes back to before the scan in which a variable changed last before this one; whether there is one.
    pub(super) fn back_to_change(&mut self, variable: Variable) -> bool {
        let last = self.session.machine().scans();
        match self.session.last_change(last, move |machine| machine.value(variable, 0)) {
            Some(scan) => {
                let is_known = self.back_to(scan);
                self.stand();
                is_known
            }
            None => false,
        }
    }
}

/// Runs a scan, and shows each moment in which a debugger can stop, until `watch` returns false.
pub(super) fn run_to_stop(
    machine: &mut Machine<u8>,
    now_ns: i64,
    watch: &mut impl FnMut(&Glimpse<'_, u8>) -> bool,
) -> Outcome {
    machine.scan_inside(now_ns, &mut |glimpse| !glimpse.is_stop || watch(&glimpse))
}

impl Here {
    fn of(glimpse: &Glimpse<'_, u8>) -> Option<Here> {
        let instruction = glimpse.instruction;
        let place = glimpse.machine.place(instruction)?;
        Some(Here { place, instruction, sight: glimpse.sight, callers: glimpse.callers() })
    }
}
