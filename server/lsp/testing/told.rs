//! Runs files with scenario tests, and tells what came of it as JSON.

use super::super::projects::file_path;
use super::super::to_proto::{Manner, Place};
use super::super::workspace::Snapshot;
use super::is_passed;
use super::subject::{Files, SuiteText};
use crate::document::Document;
use crate::project::read_text;
use crate::scenario::{Bench, Coverage, Flaw, Golden, Report, Scenario, around, driver, picture};
use crate::simulate::Problem;
use crate::text::{Message, Span};
use serde_json::{Value, json};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use tower_lsp::ls_types::Uri;

/// A file that was run.
pub(super) struct Run {
    pub suite: SuiteText,
    files: Files,
    flaws: Vec<Flaw>,
    /// What keeps the program from running.
    problems: Vec<Problem>,
    /// The scenarios by their numbers; nothing where the program does not run.
    results: Vec<(usize, Option<Report>)>,
    coverage: Option<Coverage>,
    /// Golden traces that are to be written.
    golden: Vec<(Uri, String)>,
}

/// A file that was not run: its scenarios and its mistakes.
pub(super) fn listed(snapshot: &Snapshot, suite: &SuiteText) -> Value {
    let place = Place::new(&suite.document, snapshot.manner);
    let (program, missing) = match suite.program(snapshot) {
        Ok(files) => (files, None),
        Err(flaw) => (Vec::new(), Some(flaw)),
    };
    let flaws = suite.flaws.iter().chain(&missing);
    let scenarios = suite.suite.scenarios.iter();
    json!({
        "uri": suite.uri,
        "program": program.iter().map(|(uri, _)| uri).collect::<Vec<_>>(),
        "scenarios": scenarios
            .map(|scenario| json!({ "name": scenario.name, "range": place.range(scenario.span) }))
            .collect::<Vec<_>>(),
        "problems": flaws.map(|flaw| flawed(&suite.uri, place, flaw)).collect::<Vec<_>>(),
    })
}

fn flawed(uri: &Uri, place: Place<'_>, flaw: &Flaw) -> Value {
    json!({ "uri": uri, "range": place.range(flaw.span), "message": flaw.message.render(place.language) })
}

impl Run {
    /// Runs the scenarios of these names, or all, until `cancelled` is set.
    pub fn of(
        snapshot: &Snapshot,
        suite: SuiteText,
        names: &Option<Vec<String>>,
        (has_coverage, is_update): (bool, bool),
        cancelled: &Arc<AtomicBool>,
    ) -> Run {
        let mut run = Run {
            flaws: suite.flaws.clone(),
            files: Vec::new(),
            problems: Vec::new(),
            results: Vec::new(),
            coverage: None,
            golden: Vec::new(),
            suite,
        };
        match run.suite.program(snapshot) {
            Ok(files) => run.files = files,
            Err(flaw) => run.flaws.push(flaw),
        }
        if !run.flaws.is_empty() {
            return run;
        }
        let documents: Vec<&Document> = run.files.iter().map(|(_, document)| document).collect();
        let bench = Bench::new(&documents);
        run.coverage = if has_coverage { Coverage::new(&documents).ok() } else { None };
        let bench = bench.map_err(|problems| run.problems = problems).ok();
        for (number, scenario) in run.suite.suite.scenarios.iter().enumerate() {
            let is_wanted = names.as_ref().is_none_or(|names| names.contains(&scenario.name));
            if !is_wanted || cancelled.load(Ordering::Relaxed) {
                continue;
            }
            let Some(bench) = &bench else {
                run.results.push((number, None));
                continue;
            };
            let golden = match run.suite.golden(snapshot, scenario).filter(|_| !is_update).transpose() {
                Ok(golden) => golden,
                Err(flaw) => {
                    run.flaws.push(flaw);
                    continue;
                }
            };
            match bench.run(scenario, golden.as_ref(), run.coverage.as_mut()) {
                Ok(report) => {
                    let path = scenario.golden.as_ref().and_then(|golden| run.suite.beside(&golden.name));
                    if let Some(uri) = path.filter(|_| is_update).and_then(Uri::from_file_path) {
                        run.golden.push((uri, report.trace.csv()));
                    }
                    run.results.push((number, Some(report)));
                }
                Err(flaws) => run.flaws.extend(flaws),
            }
        }
        run
    }

    /// How many scenarios passed, or did not.
    pub fn count(&self, passed: bool) -> usize {
        self.results.iter().filter(|(_, report)| is_passed(report) == passed).count()
    }

    /// What is wrong, at its places in the file.
    pub fn wrong(&self) -> Vec<(Span, Message)> {
        let flaws = self.flaws.iter().map(|flaw| (flaw.span, flaw.message.clone()));
        let failures = self.results.iter().filter_map(|(_, report)| report.as_ref());
        let failures = failures.flat_map(|report| &report.failures);
        let failures = failures.map(|failure| (failure.span, failure.message.clone()));
        flaws.chain(failures).collect()
    }

    /// What keeps the file from being run, in a sentence.
    pub fn problem(&self) -> Option<Message> {
        let flaw = self.flaws.first().map(|flaw| {
            let line = self.suite.document.line_of(flaw.span.start as usize) + 1;
            Message::new("test.flaw").with("line", line).with_messages("reason", vec![flaw.message.clone()])
        });
        flaw.or_else(|| {
            let problem = self.problems.first()?;
            let (_, document) = self.files.get(problem.place.document as usize)?;
            let line = document.line_of(problem.place.span.start as usize) + 1;
            let reason = vec![problem.obstacle.message()];
            Some(Message::new("simulate.refused").with("line", line).with_messages("reason", reason))
        })
    }

    /// What the first scenario that failed failed by.
    pub fn first_failure(&self) -> Option<Message> {
        let reports = self.results.iter().filter_map(|(_, report)| report.as_ref());
        reports.flat_map(|report| &report.failures).map(|failure| failure.message.clone()).next()
    }

    pub fn json(&self, manner: Manner) -> Value {
        let place = Place::new(&self.suite.document, manner);
        let problems = self.problems.iter().filter_map(|problem| {
            let (uri, document) = self.files.get(problem.place.document as usize)?;
            let range = Place::new(document, manner).range(problem.place.span);
            let message = problem.obstacle.message().render(manner.language);
            Some(json!({ "uri": uri, "range": range, "message": message }))
        });
        let flaws = self.flaws.iter().map(|flaw| flawed(&self.suite.uri, place, flaw));
        let scenarios = self.results.iter().filter_map(|(number, report)| {
            let scenario = self.suite.suite.scenarios.get(*number)?;
            Some(self.told(scenario, report.as_ref(), place))
        });
        let golden = self.golden.iter().map(|(uri, text)| json!({ "uri": uri, "text": text }));
        let mut told = json!({
            "uri": self.suite.uri,
            "program": self.files.iter().map(|(uri, _)| uri).collect::<Vec<_>>(),
            "problems": flaws.chain(problems).collect::<Vec<_>>(),
            "golden": golden.collect::<Vec<_>>(),
            "scenarios": scenarios.collect::<Vec<_>>(),
        });
        if let Some(coverage) = &self.coverage {
            told["coverage"] = covered(coverage, &self.files, manner);
        }
        told
    }

    fn told(&self, scenario: &Scenario, report: Option<&Report>, place: Place<'_>) -> Value {
        let mut told = json!({
            "name": scenario.name,
            "range": place.range(scenario.span),
            "passed": report.is_some_and(Report::is_passed),
            "scans": report.map_or(0, |report| report.scans),
            "failures": [],
        });
        let Some(report) = report else { return told };
        let documents: Vec<&Document> = self.files.iter().map(|(_, document)| document).collect();
        let failures = report.failures.iter().map(|failure| {
            let at = failure.place.or_else(|| driver(&documents, failure.name.as_deref()?));
            let program = at.and_then(|at| {
                let (uri, document) = self.files.get(at.document as usize)?;
                Some(json!({ "uri": uri, "range": Place::new(document, place.manner()).range(at.span) }))
            });
            failure.json(json!(place.range(failure.span)), program, place.language)
        });
        told["failures"] = failures.collect();
        let marks = report.marks();
        if !marks.is_empty() {
            told["picture"] = picture(&around(&report.trace, &marks), &marks, place.language).into();
        }
        told
    }
}

impl SuiteText {
    /// The golden trace of a scenario, if it has one.
    fn golden(&self, snapshot: &Snapshot, scenario: &Scenario) -> Option<Result<Golden, Flaw>> {
        let named = scenario.golden.as_ref()?;
        let path = self.beside(&named.name)?;
        let open = snapshot.opens().find(|open| file_path(&open.uri).as_ref() == Some(&path));
        let text = open.map(|open| open.document.text()).or_else(|| read_text(&path));
        let read = match text {
            Some(text) => Golden::read(&text),
            None => Err(Message::new("scenario.golden-missing").with("path", &named.name)),
        };
        Some(read.map_err(|message| Flaw { message, span: named.span }))
    }
}

fn covered(coverage: &Coverage, files: &Files, manner: Manner) -> Value {
    let files = (0..).zip(files).map(|(number, (uri, document))| {
        let place = Place::new(document, manner);
        let rungs = coverage.rungs().filter(|rung| rung.document == number).map(|rung| {
            let contacts = rung.contacts.iter().map(|contact| {
                json!({
                    "name": contact.name,
                    "range": place.range(contact.span),
                    "on": contact.on,
                    "off": contact.off,
                    "decided_on": contact.decided_on,
                    "decided_off": contact.decided_off,
                    "decidable": contact.is_decidable,
                })
            });
            json!({
                "range": place.range(rung.span),
                "evaluated": rung.evaluated,
                "contacts": contacts.collect::<Vec<_>>(),
            })
        });
        json!({ "uri": uri, "rungs": rungs.collect::<Vec<_>>() })
    });
    files.collect()
}
