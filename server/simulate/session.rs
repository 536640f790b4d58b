//! A simulation that can be looked back into: what was done to the PLC is kept, what it did then is run again.
//!
//! A scan depends on nothing but the state before it, its time and what was set, so a log of these and the state at a
//! few moments are a history of any length. Recent moments are close together and old ones far apart: their number is
//! bounded, and any scan is reached by running on from the moment before it.

use super::code::Code;
use super::history::{HistoryLimit, Log};
use super::machine::{Machine, Outcome, Sight};
use super::search::ChangeSearch;
use super::writes::{Tracer, Write};
use super::{Spot, Value, Variable};
use std::sync::Arc;

/// What is done to a PLC between two scans.
#[derive(Clone, PartialEq, Debug)]
pub enum Touch {
    /// Writes a variable; of an input what is wired to it, of what is around the CPU what happens there.
    Write(Variable, Value),
    /// Holds a variable at a value.
    Hold(Variable, Value),
    /// Lets a variable go.
    LetGo(Variable),
    /// Lets all that is forced go.
    LetAllGo,
}

impl Touch {
    /// Does it.
    pub fn apply(&self, machine: &mut Machine<u8>) {
        match *self {
            Touch::Write(variable, ref value) => machine.write(variable, value),
            Touch::Hold(variable, ref value) => machine.hold_at(variable, value),
            Touch::LetGo(variable) => machine.let_go(variable),
            Touch::LetAllGo => machine.let_all_go(),
        }
    }
}

/// A simulation with its history. Scans are counted from 1; 0 is the state before the first.
#[derive(Debug)]
pub struct Session {
    machine: Machine<u8>,
    log: Log,
    /// States after scans, in order; the first one is where history begins.
    moments: Vec<Machine<u8>>,
    /// Scans from one moment to the next while they are recent.
    stride: u64,
    /// What the log may grow to before there is another moment.
    log_due: usize,
    limit: HistoryLimit,
    /// Whether scans were forgotten because of it.
    is_cut: bool,
}

/// With room for fewer moments than that, history becomes shorter; with more of it, its old moments lie further apart.
const THINNED: usize = 16;
/// Rows and ops that are run again at most to reach a recent scan; some milliseconds.
const STRIDE_OPS: usize = 2_000_000;
/// The log is forgotten in so many portions at most, each of which ends with a moment.
const PORTIONS: usize = 8;

impl Session {
    /// A PLC with this program that has not run yet, and a history of the usual length.
    pub fn new(code: Arc<Code>) -> Session {
        let stride = stride(&code);
        let machine = Machine::new(code);
        let moments = vec![machine.clone()];
        let limit = HistoryLimit::default();
        let mut session =
            Session { machine, log: Log::default(), moments, stride, log_due: 0, limit, is_cut: false };
        session.log_due = session.portion();
        session
    }

    /// The same with another limit of its history, which counts from the next scan on.
    pub fn with_limit(mut self, limit: HistoryLimit) -> Session {
        self.set_limit(limit);
        self
    }

    /// Sets the limit of its history, which counts from the next scan on.
    pub fn set_limit(&mut self, limit: HistoryLimit) {
        if limit == self.limit {
            return;
        }
        self.limit = limit;
        self.log_due = self.log.bytes() + self.portion();
    }

    /// What its history may take.
    pub fn limit(&self) -> HistoryLimit {
        self.limit
    }

    /// The PLC as it is now.
    pub fn machine(&self) -> &Machine<u8> {
        &self.machine
    }

    /// The earliest scan whose state is known.
    pub fn first_scan(&self) -> u64 {
        self.moments.first().map_or(0, Machine::scans)
    }

    /// Whether what was before that is no longer known because of the limit.
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// How many states it keeps.
    pub fn moments(&self) -> usize {
        self.moments.len()
    }

    /// Does something to the PLC before its next scan.
    pub fn touch(&mut self, touch: Touch) {
        touch.apply(&mut self.machine);
        self.log.touches.push((self.machine.scans() + 1, touch));
    }

    /// Runs a scan that begins at `now_ns`, which is not before the last one began.
    pub fn scan(&mut self, now_ns: i64) -> Outcome {
        let outcome = self.machine.scan(now_ns);
        self.done(now_ns);
        outcome
    }

    /// The same with what instructions see, as `watched` tells, which is code of the same program.
    pub fn scan_seen(&mut self, now_ns: i64, watched: &Arc<Code>, mut see: impl FnMut(Sight<u8>)) -> Outcome {
        let own = Arc::clone(self.machine.code());
        self.machine.set_code(Arc::clone(watched));
        let outcome = self.machine.scan_watched(now_ns, &mut |sight| {
            see(sight);
            true
        });
        self.machine.set_code(own);
        self.done(now_ns);
        outcome
    }

    fn done(&mut self, now_ns: i64) {
        let scans = self.machine.scans();
        self.log.times.push(scans, now_ns);
        if scans.is_multiple_of(self.stride) || self.log.bytes() > self.log_due {
            self.moments.push(self.machine.clone());
            self.keep_to_limit();
            self.log_due = self.log.bytes() + self.portion();
        }
    }

    /// When a scan began, in nanoseconds.
    pub fn time_of(&self, scan: u64) -> Option<i64> {
        self.log.times.of(scan)
    }

    /// The PLC as it was after a scan, if that is known.
    pub fn at(&self, scan: u64) -> Option<Machine<u8>> {
        if scan == self.machine.scans() {
            return Some(self.machine.clone());
        }
        let mut machine = self.moment_before(scan)?.clone();
        self.replay(&mut machine, scan, |_| true);
        Some(machine)
    }

    /// The last scan up to `scan` after which `of` gave something else than before it; nothing if that is not known.
    pub fn last_change<T: PartialEq>(
        &self,
        scan: u64,
        of: impl Fn(&Machine<u8>) -> T + Send + 'static,
    ) -> Option<u64> {
        ChangeSearch::new(scan, of).look(self, || true).flatten()
    }

    /// The same for a variable that nothing but people change: only scans before which something was done are looked
    /// at, so that a switch that nobody has touched in a long history is soon known. Nothing as well if it was not
    /// found while `goes_on`.
    pub(super) fn last_switching(
        &self,
        scan: u64,
        variable: Variable,
        goes_on: impl FnMut() -> bool,
    ) -> Option<u64> {
        let of = move |machine: &Machine<u8>| machine.value_inside(variable, 0);
        if self.log.touches.iter().any(|(_, touch)| matches!(touch, Touch::Write(Variable::Around(_), _))) {
            // Keypads feed inputs from outputs.
            return ChangeSearch::new(scan, of).look(self, goes_on).flatten();
        }
        let last = scan.min(self.machine.scans());
        let switches = self.log.touches.iter().rev().filter(|(_, touch)| match *touch {
            Touch::Write(own, _) | Touch::Hold(own, _) | Touch::LetGo(own) => own == variable,
            Touch::LetAllGo => true,
        });
        let mut scans: Vec<u64> = switches.map(|(before, _)| *before).collect();
        scans.dedup();
        let mut known = scans.into_iter().filter(|scan| (self.first_scan() + 1..=last).contains(scan));
        known.find(|scan| {
            let (before, after) = (self.at(scan - 1), self.at(*scan));
            before.zip(after).is_some_and(|(before, after)| of(&before) != of(&after))
        })
    }

    /// Goes back to the PLC as it was after a scan; what came later is forgotten. Gives whether that was known.
    pub fn back_to(&mut self, scan: u64) -> bool {
        if scan == self.machine.scans() {
            // What is to be done before the next scan stays.
            return true;
        }
        let Some(machine) = self.at(scan) else { return false };
        self.machine = machine;
        self.moments.retain(|moment| moment.scans() <= scan);
        self.log.cut(scan);
        true
    }

    /// What the instructions saw in a scan that was run, in the order of execution; `watched` is code of the same
    /// program that says it. Nothing if the scan is not known.
    pub fn sights(&self, scan: u64, watched: &Arc<Code>) -> Option<Vec<Sight<u8>>> {
        let mut machine = self.at(scan.checked_sub(1)?)?;
        machine.set_code(Arc::clone(watched));
        let mut sights = Vec::new();
        self.log.touches_before(scan).for_each(|touch| touch.apply(&mut machine));
        machine.scan_watched(self.log.times.of(scan)?, &mut |sight| {
            sights.push(sight);
            true
        });
        Some(sights)
    }

    /// Runs a scan that begins at `now_ns` anew up to the sight with a number, and shows the PLC as it is there.
    /// Nothing if the scan is not known, or has not as many sights.
    pub(super) fn inside<T>(
        &self,
        scan: u64,
        now_ns: i64,
        watched: &Arc<Code>,
        number: usize,
        see: impl FnOnce(&Machine<u8>) -> T,
    ) -> Option<T> {
        let mut machine = self.at(scan.checked_sub(1)?)?;
        machine.set_code(Arc::clone(watched));
        self.log.touches_before(scan).for_each(|touch| touch.apply(&mut machine));
        let (mut left, mut see, mut seen) = (number, Some(see), None);
        machine.scan_inside(now_ns, &mut |glimpse| {
            // Where nothing is to be seen a debugger stops, and no sight is counted.
            if glimpse.sight.is_none() {
                return true;
            }
            let is_there = left == 0;
            if is_there {
                seen = see.take().map(|see| see(glimpse.machine));
            }
            left = left.saturating_sub(1);
            !is_there
        });
        seen
    }

    /// Who wrote what lies at a place in a scan that begins at `now_ns`, in the order of execution. Nothing if the scan
    /// is not known.
    pub(super) fn writes(&self, scan: u64, now_ns: i64, watched: &Arc<Code>, to: Spot) -> Option<Vec<Write>> {
        let mut machine = self.at(scan.checked_sub(1)?)?;
        machine.set_code(Arc::clone(watched));
        self.log.touches_before(scan).for_each(|touch| touch.apply(&mut machine));
        let mut tracer = Tracer::of(to);
        machine.scan_with(now_ns, &mut tracer);
        Some(tracer.found)
    }

    /// Goes on with an edited program. One that does the same keeps its history; for any other [`Machine::adopt`] says
    /// what is kept, and history begins anew. Gives whether it goes on.
    pub fn adopt(&mut self, code: Arc<Code>) -> bool {
        if self.machine.code().does_the_same_as(&code) {
            self.moments.iter_mut().for_each(|moment| moment.set_code(Arc::clone(&code)));
            self.machine.set_code(code);
            return true;
        }
        if !self.machine.code().has_layout_of(&code) {
            *self = Session::new(code).with_limit(self.limit);
            return false;
        }
        self.stride = stride(&code);
        self.machine.adopt(code);
        self.moments = vec![self.machine.clone()];
        self.is_cut = false;
        self.log.touches.clear();
        self.log.times.forget(self.machine.scans());
        false
    }

    /// Does to this PLC what stays done when another is switched off: what is wired to its inputs, and what is forced.
    pub fn take_over(&mut self, before: &Machine<u8>) {
        let own = Arc::clone(self.machine.code());
        for (name, value, is_forced) in before.standing() {
            let Some(variable) = own.variable(&name) else { continue };
            let touch = if is_forced { variable.force(&own, &value) } else { variable.set(&own, &value) };
            touch.into_iter().for_each(|touch| self.touch(touch));
        }
    }

    /// The last scan up to `scan` whose state is kept, from which others are run again.
    pub fn moment_of(&self, scan: u64) -> u64 {
        self.moment_before(scan).map_or_else(|| self.first_scan(), Machine::scans)
    }

    /// Shows the PLC as it was after each scan from `first` to `last`, until `see` returns false. Gives whether the
    /// first one is known.
    pub fn walk(&self, first: u64, last: u64, mut see: impl FnMut(&Machine<u8>) -> bool) -> bool {
        let Some(mut machine) = self.at(first.min(self.machine.scans())) else { return false };
        if see(&machine) {
            self.replay(&mut machine, last, see);
        }
        true
    }

    /// Whether a variable was set or forced before a scan.
    pub fn is_touched(&self, scan: u64, variable: Variable) -> bool {
        self.log.touches_before(scan).any(|touch| match *touch {
            Touch::Write(own, _) | Touch::Hold(own, _) | Touch::LetGo(own) => own == variable,
            _ => false,
        })
    }

    pub(super) fn moment_before(&self, scan: u64) -> Option<&Machine<u8>> {
        let after = self.moments.partition_point(|moment| moment.scans() <= scan);
        self.moments.get(after.checked_sub(1)?)
    }

    /// Runs a PLC of an earlier moment on to `last`, and shows it after each scan until `see` returns false.
    pub(super) fn replay(
        &self,
        machine: &mut Machine<u8>,
        last: u64,
        mut see: impl FnMut(&Machine<u8>) -> bool,
    ) {
        while machine.scans() < last {
            let scan = machine.scans() + 1;
            let Some(time) = self.log.times.of(scan) else { return };
            self.log.touches_before(scan).for_each(|touch| touch.apply(machine));
            machine.scan(time);
            if !see(machine) {
                return;
            }
        }
    }

    /// The log grows by so many bytes before there is another moment.
    fn portion(&self) -> usize {
        self.limit.log() / self.limit.states(self.machine.bytes()).min(PORTIONS)
    }

    /// Makes room for what comes.
    fn keep_to_limit(&mut self) {
        let most = self.limit.states(self.machine.bytes());
        while self.moments.len() > most && most >= THINNED {
            self.thin(most / 2);
        }
        let beyond = self.moments.len().saturating_sub(most);
        let half = self.log.middle();
        let first = match self.log.bytes() > self.limit.log() {
            // At least one portion, and never the state that was just kept.
            true => {
                let behind = self.moments.partition_point(|moment| moment.scans() <= half);
                behind.saturating_sub(1).clamp(1, self.moments.len() - 1)
            }
            false => 0,
        };
        let forgotten = first.max(beyond);
        self.is_cut |= forgotten > 0;
        self.moments.drain(..forgotten);
        self.log.forget(self.first_scan());
    }

    /// Leaves out every other one of the moments but for the first, and so many latest.
    fn thin(&mut self, recent: usize) {
        let old = self.moments.len().saturating_sub(recent);
        let mut number = 0;
        self.moments.retain(|_| {
            number += 1;
            number > old || number % 2 == 1
        });
    }
}

/// Scans between moments of a program.
fn stride(code: &Code) -> u64 {
    (STRIDE_OPS / code.instructions().max(1)).clamp(16, 16_384) as u64
}
