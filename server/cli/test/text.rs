//! Test results for people.

use super::subject::Subject;
use super::{Fault, Ran, Session, SuiteFile, Verdict};
use crate::scenario::{ConditionKind, ContactCoverage, Failure, around, driver, picture};
use crate::simulate::Place;
use crate::text::{Encoding, Language, Message, Span};
use std::fmt::Write;

/// Differences of a scenario that are told one by one.
const MOST_TOLD: usize = 8;

pub(super) fn told(session: &Session, language: Language) -> String {
    let mut text = String::new();
    for (suite, results) in session.suites.iter().zip(&session.results) {
        if results.is_empty() {
            continue;
        }
        let _ = writeln!(text, "{}", suite.shown);
        let subject = suite.subject.and_then(|number| session.subjects.get(number));
        for ran in results {
            scenario(&mut text, suite, subject, ran, language);
        }
    }
    for path in &session.written {
        let _ = writeln!(text, "{}", Message::new("test.written").with("path", path).render(language));
    }
    let (passed, failed) = (session.count(Ran::is_passed), session.count(|ran| !ran.is_passed()));
    if passed + failed > 0 {
        let message = Message::new("test.summary").with("passed", passed).with("failed", failed);
        let _ = writeln!(text, "\n{}", message.render(language));
    }
    if session.shows_coverage {
        coverage(&mut text, session, language);
    }
    if let Some(survivors) = &session.survivors {
        let message = Message::new("test.mutants")
            .with("tried", survivors.tried)
            .with("total", survivors.total)
            .with("killed", survivors.killed)
            .with("survived", survivors.survived.len())
            .with("equivalent", survivors.equivalent)
            .with("invalid", survivors.invalid.len() + survivors.unwritten.len());
        let _ = writeln!(text, "\n{}", message.render(language));
        faults(&mut text, session, &survivors.survived, language);
        for (key, all) in [("test.invalid", &survivors.invalid), ("test.unwritten", &survivors.unwritten)] {
            if !all.is_empty() {
                let message = Message::new(key).with("count", all.len());
                let _ = writeln!(text, "{}", message.render(language));
                faults(&mut text, session, all, language);
            }
        }
    }
    text
}

fn faults(text: &mut String, session: &Session, all: &[Fault], language: Language) {
    for Fault { subject, document, span, change } in all {
        let place = session.subjects.get(*subject).and_then(|subject| place(subject, *document, *span));
        let _ = writeln!(text, "  {}: {}", place.unwrap_or_default(), change.render(language));
    }
}

fn scenario(text: &mut String, suite: &SuiteFile, subject: Option<&Subject>, ran: &Ran, language: Language) {
    let Some(scenario) = suite.suite.scenarios.get(ran.number) else { return };
    let key = if ran.is_passed() { "test.ok" } else { "test.failed" };
    let _ = writeln!(text, "  {} {}", Message::new(key).render(language), scenario.name);
    let Some(subject) = subject else { return };
    match &ran.verdict {
        Verdict::Stuck => {
            for line in stuck(subject, language) {
                let _ = writeln!(text, "      {line}");
            }
        }
        Verdict::Done(report) => {
            for failure in report.failures.iter().take(MOST_TOLD) {
                let _ = writeln!(
                    text,
                    "      {}: {}",
                    suite.place(failure.span),
                    failure.message.render(language)
                );
                if let Some(at) = blamed(subject, failure) {
                    let message = Message::new(match failure.place {
                        Some(_) => "test.at",
                        None => "test.driven",
                    });
                    let _ = writeln!(text, "      {}", message.with("place", at).render(language));
                }
            }
            let marks = report.marks();
            if !marks.is_empty() {
                let drawn = picture(&around(&report.trace, &marks), &marks, language);
                let _ = writeln!(text);
                drawn.lines().for_each(|line| _ = writeln!(text, "{}", format!("      {line}").trim_end()));
                let _ = writeln!(text);
            }
        }
    }
}

/// Why a program does not run.
pub(super) fn stuck(subject: &Subject, language: Language) -> Vec<String> {
    let problems = subject.bench.as_ref().err().map(Vec::as_slice).unwrap_or_default();
    let told = problems.iter().map(|problem| {
        let at = place(subject, problem.place.document as usize, problem.place.span);
        let reason = problem.obstacle.message().render(language);
        format!("{}: {reason}", at.unwrap_or_default())
    });
    told.collect()
}

/// The instruction that failed, or that drives the variable.
fn blamed(subject: &Subject, failure: &Failure) -> Option<String> {
    let Place { document, span } = place_of(subject, failure)?;
    place(subject, document as usize, span)
}

/// The same as a place.
pub(super) fn place_of(subject: &Subject, failure: &Failure) -> Option<Place> {
    let documents: Vec<_> = subject.programs.iter().map(|program| &program.document).collect();
    failure.place.or_else(|| driver(&documents, failure.name.as_deref()?))
}

/// `motor.lad:12:7`
fn place(subject: &Subject, document: usize, span: Span) -> Option<String> {
    let program = subject.programs.get(document)?;
    let at = program.document.position(span.start as usize, Encoding::Utf32);
    Some(format!("{}:{}:{}", super::subject::shown(&program.path), at.line + 1, at.column + 1))
}

/// What has not been seen of a contact.
fn lacking(contact: &ContactCoverage) -> Option<&'static str> {
    use ConditionKind::{Off, On, Other};
    Some(match (contact.on > 0, contact.off > 0, contact.kind) {
        (false, false, Other) => "test.never-evaluated",
        (false, false, On | Off) => "test.never-evaluated-contact",
        (true, false, On) => "test.open-conducted",
        (false, true, On) => "test.open-blocked",
        (true, false, Off) => "test.closed-conducted",
        (false, true, Off) => "test.closed-blocked",
        (true, false, Other) => "test.condition-held",
        (false, true, Other) => "test.condition-failed",
        (true, true, _) if !contact.is_decidable || contact.has_decided() => return None,
        (true, true, _) if contact.decided_on => "test.undecided-off",
        (true, true, _) if contact.decided_off => "test.undecided-on",
        (true, true, _) => "test.undecided",
    })
}

fn coverage(text: &mut String, session: &Session, language: Language) {
    let percent = |part: usize, whole: usize| (part * 100).checked_div(whole).unwrap_or(100);
    let _ = writeln!(text);
    for subject in &session.subjects {
        let Some(coverage) = &subject.coverage else { continue };
        for (number, path) in (0..).zip(subject.paths()) {
            let counts = coverage.counts(Some(number));
            let key = match (counts.contacts, counts.decidable) {
                (0, _) => "test.coverage-none",
                (_, 0) => "test.coverage-states",
                _ => "test.coverage",
            };
            let message = Message::new(key)
                .with("path", &path)
                .with("covered", counts.covered)
                .with("contacts", counts.contacts)
                .with("percent", percent(counts.covered, counts.contacts))
                .with("decided", counts.decided)
                .with("decidable", counts.decidable)
                .with("decided-percent", percent(counts.decided, counts.decidable))
                .with("evaluated", counts.evaluated)
                .with("rungs", counts.rungs);
            let _ = writeln!(text, "{}", message.render(language));
            for rung in coverage.rungs().filter(|rung| rung.document == number) {
                for contact in &rung.contacts {
                    let Some(key) = lacking(contact) else { continue };
                    let at = place(subject, number as usize, contact.span).unwrap_or_default();
                    let message = Message::new(key).with("name", &contact.name).render(language);
                    let _ = writeln!(text, "  {at}: {message}");
                }
            }
        }
    }
}
