//! Test results as one JSON document. Positions count from 1, columns in Unicode scalar values.
//!
//! ```text
//! { files: [{ path, program: path[], problems: { path, range, message }[],
//!     scenarios: [{ name, range, passed, scans, picture?,
//!       failures: { message, range, scan, time_ms, name?, expected?, actual?, program?: { path, range } }[] }] }],
//!   coverage?: { summary: { rungs, evaluated, contacts, covered, decided, decidable },
//!     files: [{ path, rungs: { range, evaluated,
//!       contacts: { name, range, on, off, decided_on, decided_off, decidable }[] }[] }] },
//!   mutants?: { total, tried, killed, equivalent, invalid, survived: fault[],
//!     not_running: fault[], not_written: fault[] }, where fault: { path, range, change },
//!   written: path[],
//!   summary: { passed, failed, unreadable } }
//! ```

use super::subject::Subject;
use super::{Fault, Ran, Session, SuiteFile, Verdict, text};
use crate::document::Document;
use crate::scenario::{Coverage, around, picture};
use crate::text::{Encoding, Language, Span};
use serde_json::{Value, json};

pub(super) fn of(session: &Session, language: Language) -> Value {
    let files = session.suites.iter().zip(&session.results).map(|(suite, results)| {
        let subject = suite.subject.and_then(|number| session.subjects.get(number));
        file(suite, subject, results, language)
    });
    let unreadable = session.suites.iter().filter(|suite| !suite.flaws.is_empty()).count();
    let mut all = json!({
        "files": files.collect::<Vec<_>>(),
        "written": session.written,
        "summary": {
            "passed": session.count(Ran::is_passed),
            "failed": session.count(|ran| !ran.is_passed()),
            "unreadable": unreadable,
        },
    });
    if session.shows_coverage {
        let counts = session.counts();
        let files =
            session.subjects.iter().filter_map(|subject| Some(covered(subject, subject.coverage.as_ref()?)));
        all["coverage"] = json!({
            "summary": {
                "rungs": counts.rungs,
                "evaluated": counts.evaluated,
                "contacts": counts.contacts,
                "covered": counts.covered,
                "decided": counts.decided,
                "decidable": counts.decidable,
            },
            "files": files.flatten().collect::<Vec<_>>(),
        });
    }
    if let Some(survivors) = &session.survivors {
        let fault = |fault: &Fault| {
            let program = session.subjects.get(fault.subject)?.programs.get(fault.document)?;
            Some(json!({
                "path": super::subject::shown(&program.path),
                "range": range(&program.document, fault.span),
                "change": fault.change.render(language),
            }))
        };
        let faults = |all: &[Fault]| all.iter().filter_map(fault).collect::<Vec<_>>();
        all["mutants"] = json!({
            "total": survivors.total,
            "tried": survivors.tried,
            "killed": survivors.killed,
            "equivalent": survivors.equivalent,
            "invalid": survivors.invalid.len() + survivors.unwritten.len(),
            "survived": faults(&survivors.survived),
            "not_running": faults(&survivors.invalid),
            "not_written": faults(&survivors.unwritten),
        });
    }
    all
}

fn file(suite: &SuiteFile, subject: Option<&Subject>, results: &[Ran], language: Language) -> Value {
    let own = suite.flaws.iter().map(|flaw| {
        json!({
            "path": suite.shown,
            "range": range_in(suite, flaw.span),
            "message": flaw.message.render(language),
        })
    });
    let mut problems: Vec<Value> = own.collect();
    let obstacles = subject.and_then(|subject| subject.bench.as_ref().err());
    for problem in obstacles.into_iter().flatten() {
        let program = subject.and_then(|subject| subject.programs.get(problem.place.document as usize));
        problems.extend(program.map(|program| {
            json!({
                "path": super::subject::shown(&program.path),
                "range": range(&program.document, problem.place.span),
                "message": problem.obstacle.message().render(language),
            })
        }));
    }
    let scenarios = results.iter().filter_map(|ran| {
        let scenario = suite.suite.scenarios.get(ran.number)?;
        let mut told = json!({
            "name": scenario.name,
            "range": range_in(suite, scenario.span),
            "passed": ran.is_passed(),
            "scans": 0,
            "failures": [],
        });
        if let Verdict::Done(report) = &ran.verdict {
            told["scans"] = report.scans.into();
            let failures = report.failures.iter().map(|failure| {
                let blamed = subject.and_then(|subject| {
                    let place = text::place_of(subject, failure)?;
                    let program = subject.programs.get(place.document as usize)?;
                    let path = super::subject::shown(&program.path);
                    Some(json!({ "path": path, "range": range(&program.document, place.span) }))
                });
                failure.json(range_in(suite, failure.span), blamed, language)
            });
            told["failures"] = failures.collect();
            let marks = report.marks();
            if !marks.is_empty() {
                told["picture"] = picture(&around(&report.trace, &marks), &marks, language).into();
            }
        }
        Some(told)
    });
    let programs: Vec<String> = subject.into_iter().flat_map(Subject::paths).collect();
    json!({
        "path": suite.shown,
        "program": programs,
        "problems": problems,
        "scenarios": scenarios.collect::<Vec<_>>(),
    })
}

fn covered(subject: &Subject, coverage: &Coverage) -> Vec<Value> {
    let files = (0..).zip(&subject.programs).map(|(number, program)| {
        let rungs = coverage.rungs().filter(|rung| rung.document == number).map(|rung| {
            let contacts = rung.contacts.iter().map(|contact| {
                json!({
                    "name": contact.name,
                    "range": range(&program.document, contact.span),
                    "on": contact.on,
                    "off": contact.off,
                    "decided_on": contact.decided_on,
                    "decided_off": contact.decided_off,
                    "decidable": contact.is_decidable,
                })
            });
            json!({
                "range": range(&program.document, rung.span),
                "evaluated": rung.evaluated,
                "contacts": contacts.collect::<Vec<_>>(),
            })
        });
        json!({ "path": super::subject::shown(&program.path), "rungs": rungs.collect::<Vec<_>>() })
    });
    files.collect()
}

fn range_in(suite: &SuiteFile, span: Span) -> Value {
    let position = |offset| {
        let (line, column) = suite.position(offset);
        json!({ "line": line, "column": column })
    };
    json!({ "start": position(span.start), "end": position(span.end) })
}

fn range(document: &Document, span: Span) -> Value {
    let position = |offset: u32| {
        let at = document.position(offset as usize, Encoding::Utf32);
        json!({ "line": at.line + 1, "column": at.column + 1 })
    };
    json!({ "start": position(span.start), "end": position(span.end) })
}
