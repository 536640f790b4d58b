//! Runs scenarios on a simulated PLC and says what was otherwise than expected.

use super::golden::Golden;
use super::suite::{Check, CheckKind, Expected, Flaw, InputKind, Named, Scenario, Want};
use super::{Coverage, Mark};
use crate::document::Document;
use crate::simulate::{
    Code, ErrorKind, Machine, Place, Problem, Session, Touch, Trace, Value, Variable, compile, milliseconds,
};
use crate::target::Port;
use crate::target::iec::nearest;
use crate::text::{Language, Message, Span};
use serde_json::{Value as Json, json};
use std::sync::Arc;

/// A program that scenarios are run with.
#[derive(Clone, Debug)]
pub struct Bench {
    code: Arc<Code>,
}

/// What came of a scenario.
#[derive(Clone, PartialEq, Debug)]
pub struct Report {
    /// What was otherwise than expected, in the order of time; at most [`Report::MOST_FAILURES`].
    pub failures: Vec<Failure>,
    /// What the variables were that the scenario names.
    pub trace: Trace,
    /// The scans that were run.
    pub scans: u64,
    /// Whether an instruction failed, also where the scenario allows that.
    pub has_errors: bool,
}

impl Report {
    /// More failures of one scenario are not told.
    pub const MOST_FAILURES: usize = 20;

    /// Whether all was as expected.
    pub fn is_passed(&self) -> bool {
        self.failures.is_empty()
    }

    /// The marks of the first scan in which something was otherwise, for a timing picture.
    pub fn marks(&self) -> Vec<Mark> {
        let first = self.failures.iter().map(|failure| failure.scan).min();
        let own = self.failures.iter().filter(|failure| Some(failure.scan) == first);
        own.filter_map(|failure| {
            let (name, expected) = (failure.name.clone()?, failure.expected.clone()?);
            Some(Mark { scan: failure.scan, name, expected })
        })
        .collect()
    }
}

/// Something that was otherwise than expected.
#[derive(Clone, PartialEq, Debug)]
pub struct Failure {
    /// The sentence that says it.
    pub message: Message,
    /// Where it is expected, in the file of the scenario.
    pub span: Span,
    /// The scan.
    pub scan: u64,
    /// When that began, in nanoseconds.
    pub time_ns: i64,
    /// The instruction that failed, if one did.
    pub place: Option<Place>,
    /// The variable, if it is one.
    pub name: Option<String>,
    /// What it should have been, as people write it.
    pub expected: Option<String>,
    /// What it was.
    pub actual: Option<String>,
}

impl Failure {
    /// As programs that read results want it; `range` is where it is expected, `program` what of the program is to
    /// blame, as who asks counts places.
    pub fn json(&self, range: Json, program: Option<Json>, language: Language) -> Json {
        json!({
            "message": self.message.render(language),
            "range": range,
            "scan": self.scan,
            "time_ms": self.time_ns as f64 / 1e6,
            "name": self.name,
            "expected": self.expected,
            "actual": self.actual,
            "program": program,
        })
    }
}

/// A scenario whose names are known.
struct Plan<'s> {
    touches: Vec<(u64, Touch)>,
    checks: Vec<Running<'s>>,
    watched: Vec<(String, Variable)>,
    last: u64,
}

/// A check while its scenario runs.
struct Running<'s> {
    check: &'s Check,
    wants: Vec<(Want, Variable)>,
    until: Vec<(Want, Variable)>,
    last: u64,
    /// Whether nothing can come of it any more.
    is_done: bool,
    /// For how many scans it has been otherwise.
    wrong: u64,
}

impl Bench {
    /// Compiles the documents that are one program.
    ///
    /// # Errors
    /// With what keeps it from running.
    pub fn new(documents: &[&Document]) -> Result<Bench, Vec<Problem>> {
        Ok(Bench { code: Arc::new(compile(documents, false)?) })
    }

    /// The program.
    pub fn code(&self) -> &Arc<Code> {
        &self.code
    }

    /// Runs a scenario. `golden` is the trace that it must have; what is covered is noted in `coverage`.
    ///
    /// # Errors
    /// With the names that the program and the PLC do not have, and values that they cannot have.
    pub fn run(
        &self,
        scenario: &Scenario,
        golden: Option<&Golden>,
        mut coverage: Option<&mut Coverage>,
    ) -> Result<Report, Vec<Flaw>> {
        let mut plan = self.plan(scenario, golden)?;
        let mut session = Session::new(Arc::clone(&self.code));
        let mut trace = Trace::new(std::mem::take(&mut plan.watched));
        let (mut failures, mut has_errors) = (Vec::new(), false);
        let mut touches = std::mem::take(&mut plan.touches).into_iter().peekable();
        for scan in 0..=plan.last {
            let now_ns = (scan as i64).saturating_mul(scenario.scan_ns);
            while let Some((_, touch)) = touches.next_if(|(from, _)| *from <= scan) {
                session.touch(touch);
            }
            let outcome = match coverage.as_deref_mut() {
                Some(coverage) => {
                    let outcome =
                        session.scan_seen(now_ns, &coverage.watched(), |sight| coverage.note(sight));
                    coverage.end_scan();
                    outcome
                }
                None => session.scan(now_ns),
            };
            trace.note(session.machine());
            has_errors |= !outcome.errors.is_empty();
            let is_stuck = outcome.errors.iter().any(|error| error.kind == ErrorKind::Watchdog);
            if let Some(error) = outcome.errors.first().filter(|_| is_stuck || !scenario.allows_errors) {
                let message =
                    Message::new("scenario.went-wrong").with_messages("reason", vec![error.kind.message()]);
                let failure = Failure::at(scan, now_ns, scenario.span, message);
                failures.push(Failure { place: error.place, ..failure });
                break;
            }
            plan.look(scan, session.machine(), &mut failures);
            if failures.len() >= Report::MOST_FAILURES {
                failures.truncate(Report::MOST_FAILURES);
                break;
            }
        }
        trace.end();
        let scans = session.machine().scans();
        if failures.is_empty() {
            plan.end(scans.saturating_sub(1), session.machine(), &mut failures);
        }
        if let (true, Some(golden)) = (failures.is_empty(), golden) {
            failures.extend(golden.compare(&trace, scenario));
        }
        Ok(Report { failures, trace, scans, has_errors })
    }

    fn plan<'s>(&self, scenario: &'s Scenario, golden: Option<&Golden>) -> Result<Plan<'s>, Vec<Flaw>> {
        let mut names = Names { code: &self.code, flaws: Vec::new(), watched: Vec::new() };
        let mut touches = Vec::new();
        for input in &scenario.inputs {
            let Some(variable) = names.find(&input.name) else { continue };
            let touch = match &input.kind {
                InputKind::Set(value) => variable.set(&self.code, value).ok_or(value),
                InputKind::Force(value) => variable.force(&self.code, value).ok_or(value),
                InputKind::Release => Ok(variable.release()),
            };
            match touch {
                Ok(touch) => touches.push((input.scan, touch)),
                Err(value) => {
                    names.flaw(&input.name, variable.refusal(&self.code, &input.name.name, value));
                }
            }
        }
        let last = scenario.last.or(golden.and_then(Golden::last)).unwrap_or(0);
        let mut checks = Vec::new();
        for check in &scenario.checks {
            let mut found = |wants: &[Want]| -> Vec<(Want, Variable)> {
                wants.iter().filter_map(|want| names.want(want)).collect()
            };
            let (wants, until) = (found(&check.wants), found(&check.until));
            let last = check.last.unwrap_or(last).min(last);
            checks.push(Running { check, wants, until, last, is_done: false, wrong: 0 });
        }
        scenario.watch.iter().for_each(|name| _ = names.find(name));
        let Names { flaws, watched, .. } = names;
        if !flaws.is_empty() {
            return Err(flaws);
        }
        let watched = self.watched(scenario, golden, watched)?;
        Ok(Plan { touches, checks, watched, last })
    }

    /// What is traced: the columns of the golden trace, else what is to be watched, else what is named; all that the
    /// program uses where a golden trace is to be made of nothing in particular.
    fn watched(
        &self,
        scenario: &Scenario,
        golden: Option<&Golden>,
        named: Vec<(String, Variable)>,
    ) -> Result<Vec<(String, Variable)>, Vec<Flaw>> {
        let Some(place) = &scenario.golden else { return Ok(named) };
        let columns = golden.map(Golden::names).filter(|names| !names.is_empty());
        let of = |names: &[String]| -> Result<Vec<(String, Variable)>, Vec<Flaw>> {
            let all = names.iter().map(|name| {
                let found = self.code.variable(name).map(|variable| (name.clone(), variable));
                found.ok_or_else(|| {
                    let message = Message::new("cli.run-unknown").with("name", name);
                    vec![Flaw { message, span: place.span }]
                })
            });
            all.collect()
        };
        match columns {
            Some(names) => of(names),
            None if !scenario.watch.is_empty() => {
                of(&scenario.watch.iter().map(|name| name.name.clone()).collect::<Vec<_>>())
            }
            None => of(&self.code.named()),
        }
    }
}

/// The variables that a scenario names.
struct Names<'c> {
    code: &'c Code,
    flaws: Vec<Flaw>,
    watched: Vec<(String, Variable)>,
}

impl Names<'_> {
    fn find(&mut self, name: &Named) -> Option<Variable> {
        let Some(variable) = self.code.variable(&name.name) else {
            let known = self.code.named();
            let near = nearest(&name.name, known.iter().map(String::as_str));
            let message = match near.is_empty() {
                true => Message::new("cli.run-unknown"),
                false => Message::new("scenario.near-name").with_words(
                    "near",
                    near.iter().map(String::as_str),
                    ", ",
                ),
            };
            self.flaw(name, message);
            return None;
        };
        if !self.watched.iter().any(|(_, known)| *known == variable) {
            self.watched.push((name.name.clone(), variable));
        }
        Some(variable)
    }

    /// What is expected, as the variable has it.
    fn want(&mut self, want: &Want) -> Option<(Want, Variable)> {
        let variable = self.find(&want.name)?;
        let expected = match &want.expected {
            Expected::Is(value) => match variable.meant(self.code, value) {
                Some(meant) => Expected::Is(meant),
                None => {
                    self.flaw(&want.name, Message::new("scenario.never-value"));
                    return None;
                }
            },
            other => other.clone(),
        };
        Some((Want { name: want.name.clone(), expected }, variable))
    }

    fn flaw(&mut self, name: &Named, message: Message) {
        self.flaws.push(Flaw { message: message.with("name", &name.name), span: name.span });
    }
}

impl Failure {
    /// What `message` says of a scan.
    pub(super) fn at(scan: u64, time_ns: i64, span: Span, message: Message) -> Failure {
        let message = message.with("scan", scan).with("time", milliseconds(time_ns));
        Failure { message, span, scan, time_ns, place: None, name: None, expected: None, actual: None }
    }
}

impl Plan<'_> {
    /// Looks at the PLC after a scan.
    fn look(&mut self, scan: u64, machine: &Machine<u8>, failures: &mut Vec<Failure>) {
        for running in &mut self.checks {
            running.look(scan, machine, failures);
        }
    }

    /// Looks once more when all is over.
    fn end(&mut self, scan: u64, machine: &Machine<u8>, failures: &mut Vec<Failure>) {
        let waiting = self.checks.iter().filter(|running| !running.is_done && !running.until.is_empty());
        for running in waiting {
            let message = Message::new("scenario.until").with("values", told(&running.until));
            let failure = Failure::at(scan, machine.now_ns(), running.check.span, message);
            failures.push(match first_wrong(&running.until, machine, running.check.deviation) {
                Some((want, actual)) => failure.about(want, &actual),
                None => failure,
            });
        }
        let missed =
            self.checks.iter().filter(|running| running.check.first > self.last && running.until.is_empty());
        for running in missed {
            let message = Message::new("scenario.ends-before").with("last", running.check.first);
            failures.push(Failure::at(scan, machine.now_ns(), running.check.span, message));
        }
    }
}

impl Failure {
    fn about(self, want: &Want, actual: &Value) -> Failure {
        Failure {
            name: Some(want.name.name.clone()),
            expected: Some(want.expected.to_string()),
            actual: Some(actual.to_string()),
            ..self
        }
    }
}

impl Running<'_> {
    fn look(&mut self, scan: u64, machine: &Machine<u8>, failures: &mut Vec<Failure>) {
        if self.is_done || scan < self.check.first {
            return;
        }
        let deviation = self.check.deviation;
        if !self.until.is_empty() && first_wrong(&self.until, machine, deviation).is_none() {
            self.is_done = true;
            return;
        }
        let is_met = first_wrong(&self.wants, machine, deviation).is_none();
        match self.check.kind {
            CheckKind::Once if is_met => self.is_done = true,
            CheckKind::Once => {
                if scan >= self.last {
                    self.is_done = true;
                    let key = match self.check.first == self.last {
                        true => "scenario.differs",
                        false => "scenario.within",
                    };
                    self.differs(key, scan, machine, failures);
                }
            }
            CheckKind::Always | CheckKind::Never => {
                let is_wrong = is_met == (self.check.kind == CheckKind::Never);
                self.wrong = if is_wrong { self.wrong + 1 } else { 0 };
                if self.wrong > self.check.tolerance {
                    self.is_done = true;
                    match self.check.kind {
                        CheckKind::Never => failures.push(self.is_there(scan, machine)),
                        _ => self.differs("scenario.always", scan, machine, failures),
                    }
                }
                self.is_done |= self.until.is_empty() && scan >= self.last;
            }
        }
    }

    /// A failure for each value that is not as expected.
    fn differs(&self, key: &'static str, scan: u64, machine: &Machine<u8>, failures: &mut Vec<Failure>) {
        for (want, variable) in &self.wants {
            let actual = machine.value(*variable, 0);
            if want.expected.holds(&actual, self.check.deviation) {
                continue;
            }
            // Of a frame that was not sent it is told what was.
            let (key, actual) = match *variable {
                Variable::Around(Port::Sent) if self.check.kind == CheckKind::Once => {
                    ("scenario.not-sent", machine.value(Variable::Around(Port::LastSent), 0))
                }
                _ => (key, actual),
            };
            let message = Message::new(key)
                .with("name", &want.name.name)
                .with("actual", &actual)
                .with("expected", &want.expected)
                .with("first", self.check.first);
            let failure = Failure::at(scan, machine.now_ns(), want.name.span, message);
            failures.push(failure.about(want, &actual));
        }
    }

    /// All the values are there that must never be there together.
    fn is_there(&self, scan: u64, machine: &Machine<u8>) -> Failure {
        let message = Message::new("scenario.never").with("values", told(&self.wants));
        let failure = Failure::at(scan, machine.now_ns(), self.check.span, message);
        let Some((want, variable)) = self.wants.last() else { return failure };
        let actual = machine.value(*variable, 0);
        // Of a bit it is known what it should have been.
        let expected = match actual {
            Value::Bit(on) => Value::Bit(!on).to_string(),
            _ => format!("≠ {}", want.expected),
        };
        Failure { expected: Some(expected), ..failure.about(want, &actual) }
    }
}

fn first_wrong<'w>(
    wants: &'w [(Want, Variable)],
    machine: &Machine<u8>,
    deviation: f64,
) -> Option<(&'w Want, Value)> {
    wants.iter().find_map(|(want, variable)| {
        let actual = machine.value(*variable, 0);
        (!want.expected.holds(&actual, deviation)).then_some((want, actual))
    })
}

fn told(wants: &[(Want, Variable)]) -> String {
    let pairs = wants.iter().map(|(want, _)| format!("{} = {}", want.name.name, want.expected));
    pairs.collect::<Vec<_>>().join(", ")
}
