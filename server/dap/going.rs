//! Going on until there is a reason to stop.

use super::adapter::{Adapter, THREAD};
use super::back::{BackSearch, Reached};
use super::breakpoints::{Found, Hit};
use super::debuggee::Ended;
use super::launch::Debugged;
use crate::simulate::{Error, Glimpse, Place, milliseconds};
use crate::text::Message;
use serde_json::json;
use std::io::Write;
use std::time::{Duration, Instant};

/// How the program goes on, besides stopping at breakpoints.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Going {
    /// Until something stops it.
    On,
    /// To the next instruction.
    Instruction,
    /// To the next rung that is no deeper in routines.
    Rung { rung: usize, depth: usize },
    /// Out of a routine that is so deep.
    Out { depth: usize },
    /// To the beginning of this scan.
    Scan(u64),
    /// Back to the last breakpoint, else to where history begins.
    Back,
}

/// So long scans are run before the next request is looked for.
const SLICE: Duration = Duration::from_millis(10);
/// A program that is so far behind does not catch up.
const TOO_LATE: Duration = Duration::from_millis(500);
/// How often files are looked at while nothing happens.
const IDLE: Duration = Duration::from_secs(1);

impl Debugged {
    /// Simulated time goes on from here.
    pub(super) fn resume(&mut self, going: Going) {
        self.since = (Instant::now(), self.debuggee.now_ns());
        self.going = Some(going);
        (self.failing, self.is_fresh) = (None, true);
    }

    /// How long there is nothing to do.
    pub(super) fn wait(&self) -> Duration {
        match self.going {
            None => IDLE,
            Some(Going::On) if self.launch.speed() > 0.0 => {
                let ahead_ns = (self.debuggee.now_ns() - self.due_ns()).max(0);
                Duration::from_nanos((ahead_ns as f64 / self.launch.speed()) as u64).min(IDLE)
            }
            Some(_) => Duration::ZERO,
        }
    }

    /// The simulated time that it should be.
    fn due_ns(&self) -> i64 {
        let (real, simulated) = self.since;
        simulated + (real.elapsed().as_nanos() as f64 * self.launch.speed()) as i64
    }

    /// Whether the next scan is to be run now.
    fn is_due(&self) -> bool {
        let is_paced = self.going == Some(Going::On) && self.launch.speed() > 0.0;
        !is_paced || self.debuggee.now_ns() <= self.due_ns()
    }

    /// Does not catch up after a long pause.
    fn skip(&mut self) {
        let speed = self.launch.speed();
        if speed > 0.0 && self.due_ns() - self.debuggee.now_ns() > (TOO_LATE.as_nanos() as f64 * speed) as i64
        {
            self.since = (Instant::now(), self.debuggee.now_ns());
        }
    }
}

impl<W: Write> Adapter<W> {
    /// Runs what is due.
    pub(super) fn advance(&mut self) {
        let started = Instant::now();
        while self.debugged.as_ref().is_some_and(|debugged| debugged.going.is_some() && debugged.is_due()) {
            match self.debugged.as_ref().and_then(|debugged| debugged.going) {
                Some(Going::Back) => self.look_back(|| started.elapsed() < SLICE),
                _ => self.scan(),
            }
            if started.elapsed() >= SLICE {
                break;
            }
        }
        if let Some(debugged) = &mut self.debugged {
            debugged.skip();
        }
    }

    /// Goes on through the present scan.
    fn scan(&mut self) {
        let Some(debugged) = &mut self.debugged else { return };
        let Some(going) = debugged.going else { return };
        let fails = self.stops_at_errors && !debugged.launch.no_debug;
        let (program, breakpoints) = (&debugged.program, &mut self.breakpoints);
        let debuggee = &mut debugged.debuggee;
        let is_watched = !breakpoints.is_empty() && !debugged.launch.no_debug;
        let is_step = !matches!(going, Going::On | Going::Scan(_));
        if matches!(going, Going::Scan(scan) if debuggee.scan() >= scan) {
            return self.stop("step", None);
        }
        if !is_watched && !is_step && !fails {
            let errors = debuggee.finish();
            return self.tell(errors);
        }
        if std::mem::take(&mut debugged.is_fresh) {
            breakpoints.begin(debuggee.machine(), debuggee.here().is_some());
        }
        let mut before = debuggee.here().map(|here| here.place);
        let mut logged = Vec::new();
        let mut changed_at = None;
        let ended = debuggee.advance(fails, &mut |glimpse: &Glimpse<'_, u8>| {
            let place = glimpse.machine.place(glimpse.instruction);
            if is_watched {
                let found = breakpoints.at(glimpse);
                logged.extend(found.logged.into_iter().map(|words| (words, place)));
                if let Some(hit) = found.hit {
                    changed_at = before;
                    return Some(Some(hit));
                }
            }
            before = place.or(before);
            let is_there = match going {
                Going::Instruction => true,
                Going::Rung { rung, depth } => {
                    let is_other = place.is_some_and(|place| program.rung(place) != rung);
                    glimpse.depth() < depth || glimpse.depth() == depth && is_other
                }
                Going::Out { depth } => glimpse.depth() < depth,
                Going::On | Going::Scan(_) | Going::Back => false,
            };
            is_there.then_some(None)
        });
        for (words, place) in logged {
            self.say("console", &words, place);
        }
        match ended {
            Ended::Stopped(None) => self.stop("step", None),
            Ended::Stopped(Some(hit)) => self.stop_at(hit, changed_at),
            Ended::Failing(error) => {
                if let Some(debugged) = &mut self.debugged {
                    debugged.failing = Some(error);
                }
                self.stop("exception", None);
            }
            Ended::Through(errors) => {
                let found = match &self.debugged {
                    Some(debugged) if is_watched => self.breakpoints.at_end(debugged.debuggee.machine()),
                    _ => Found::default(),
                };
                self.tell(errors);
                for words in found.logged {
                    self.say("console", &words, before);
                }
                match found.hit {
                    Some(hit) => self.stop_at(hit, before),
                    None if is_step => self.stop("step", None),
                    None => {}
                }
            }
        }
    }

    /// Stops at a breakpoint; `changed_at` is the instruction that has changed a value.
    fn stop_at(&mut self, hit: Hit, changed_at: Option<Place>) {
        if let (Hit::Data { name, before, after, .. }, Some(debugged)) = (&hit, &self.debugged) {
            let key = if changed_at.is_some() { "debug.changed" } else { "debug.changed-between" };
            let at = changed_at.map(|place| {
                format!("{} ({})", debugged.program.words(place), debugged.program.shown(place))
            });
            let change = Message::new(key).with("name", name).with("before", before).with("after", after);
            let change = change.with("at", at.unwrap_or_default()).render(self.language);
            self.say("console", &change, changed_at);
        }
        self.stop("breakpoint", Some(hit));
    }

    /// Says what went wrong, once for each instruction.
    fn tell(&mut self, errors: Vec<Error>) {
        for error in errors {
            let Some(debugged) = &mut self.debugged else { return };
            if debugged.told.iter().any(|told| (told.place, told.kind) == (error.place, error.kind)) {
                continue;
            }
            debugged.told.push(error);
            let words = error.kind.message().render(self.language);
            self.say("stderr", &words, error.place);
        }
    }

    /// Stands still, and tells the client.
    pub(super) fn stop(&mut self, reason: &str, hit: Option<Hit>) {
        let Some(debugged) = &mut self.debugged else { return };
        debugged.going = None;
        debugged.debuggee.stand();
        let scan = debugged.debuggee.scan() - 1;
        let time = milliseconds(debugged.debuggee.now_ns());
        let at = Message::new("debug.scan").with("scan", scan).with("time", time);
        let mut body = json!({
            "reason": reason,
            "threadId": THREAD,
            "allThreadsStopped": true,
            "description": at.render(self.language),
        });
        match &hit {
            Some(Hit::Line(ids)) => body["hitBreakpointIds"] = json!(ids),
            Some(Hit::Use { id, name }) => {
                body["reason"] = json!("data breakpoint");
                body["hitBreakpointIds"] = json!([id]);
                body["text"] = json!(name);
            }
            Some(Hit::Data { id, name, before, after }) => {
                body["reason"] = json!("data breakpoint");
                body["hitBreakpointIds"] = json!([id]);
                body["text"] = json!(format!("{name}: {before} → {after}"));
            }
            None => {}
        }
        if let Some(error) = debugged.failing {
            body["text"] = json!(error.kind.message().render(self.language));
        }
        self.tell_outdated();
        self.event("stopped", body);
    }

    /// Says which files are no longer what runs.
    pub(super) fn tell_outdated(&mut self) {
        let Some(debugged) = &mut self.debugged else { return };
        for file in debugged.program.newly_outdated() {
            let words = Message::new("debug.outdated").with("file", file).render(self.language);
            self.say("important", &words, None);
        }
    }

    /// Says that there is no way back from here, where scans were forgotten.
    pub(super) fn tell_cut(&mut self) {
        let session = self.debugged.as_ref().map(|debugged| debugged.debuggee.session());
        if let Some(session) = session.filter(|session| session.is_cut()) {
            let words = Message::new("simulate.history-begins").with("limit", session.limit());
            let words = words.render(self.language);
            self.say("important", &words, None);
        }
    }

    /// Begins to go back to the last breakpoint before this instruction.
    pub(super) fn reverse(&mut self) -> Result<(), Message> {
        self.stopped()?;
        if let Some(debugged) = &mut self.debugged {
            debugged.search = Some(BackSearch::new(&debugged.debuggee, &mut self.breakpoints));
            debugged.resume(Going::Back);
        }
        Ok(())
    }

    /// Goes on looking back while there is time.
    fn look_back(&mut self, has_time: impl Fn() -> bool) {
        let Some(debugged) = &mut self.debugged else { return };
        let Some(search) = &mut debugged.search else { return };
        let Some(reached) = search.look(&debugged.debuggee, &mut self.breakpoints, has_time) else { return };
        debugged.search = None;
        match reached {
            Some(Reached { scan, number, hit }) => {
                debugged.debuggee.back_into(scan, number);
                self.stop("breakpoint", Some(hit));
            }
            None => {
                let first = debugged.debuggee.session().first_scan() + 1;
                debugged.debuggee.back_to(first);
                self.tell_cut();
                self.stop("entry", None);
            }
        }
    }
}
