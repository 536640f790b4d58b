//! Test results as build servers read them: the XML that JUnit's runners write.

use super::{Ran, Session, Verdict, text};
use crate::scenario::{around, picture};
use crate::text::{Language, Message};
use std::fmt::Write;

/// A suite for each file, a test case for each scenario. What cannot be run at all is an error, not a failure. Times
/// are those of the PLC, so that a report is the same wherever it is made.
pub(super) fn of(session: &Session, language: Language) -> String {
    let total = session.results.iter().map(Vec::len).sum::<usize>();
    let errors = |suite: &super::SuiteFile| suite.flaws.len();
    let all_errors: usize = session.suites.iter().map(errors).sum();
    let failed = session.count(|ran| !ran.is_passed());
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        xml,
        "<testsuites name=\"rungwise\" tests=\"{}\" failures=\"{failed}\" errors=\"{all_errors}\">",
        total + all_errors
    );
    for (suite, results) in session.suites.iter().zip(&session.results) {
        let own = results.iter().filter(|ran| !ran.is_passed()).count();
        let _ = writeln!(
            xml,
            "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{own}\" errors=\"{}\">",
            escaped(&suite.shown),
            results.len() + errors(suite),
            errors(suite)
        );
        for flaw in &suite.flaws {
            let message = flaw.message.render(language);
            let told = format!("{}: {message}", suite.place(flaw.span));
            case(
                &mut xml,
                &suite.shown,
                &Message::new("test.reading").render(language),
                0.0,
                Some(("error", &message, &told)),
            );
        }
        for ran in results {
            let Some(scenario) = suite.suite.scenarios.get(ran.number) else { continue };
            let seconds = match &ran.verdict {
                Verdict::Done(report) => report.scans as f64 * scenario.scan_ns as f64 / 1e9,
                Verdict::Stuck => 0.0,
            };
            let failure = failure(session, suite, ran, language);
            let shown = failure.as_ref().map(|(message, told)| ("failure", message.as_str(), told.as_str()));
            case(&mut xml, &suite.shown, &scenario.name, seconds, shown);
        }
        xml.push_str("  </testsuite>\n");
    }
    xml.push_str("</testsuites>\n");
    xml
}

/// What a scenario failed by, in a sentence and at length.
fn failure(
    session: &Session,
    suite: &super::SuiteFile,
    ran: &Ran,
    language: Language,
) -> Option<(String, String)> {
    match &ran.verdict {
        Verdict::Stuck => {
            let subject = suite.subject.and_then(|number| session.subjects.get(number))?;
            let told = text::stuck(subject, language).join("\n");
            Some((told.lines().next().unwrap_or_default().to_string(), told))
        }
        Verdict::Done(report) => {
            let first = report.failures.first()?.message.render(language);
            let mut told = String::new();
            for failure in &report.failures {
                let _ = writeln!(told, "{}: {}", suite.place(failure.span), failure.message.render(language));
            }
            let marks = report.marks();
            if !marks.is_empty() {
                let _ = write!(told, "\n{}", picture(&around(&report.trace, &marks), &marks, language));
            }
            Some((first, told))
        }
    }
}

fn case(xml: &mut String, class: &str, name: &str, seconds: f64, problem: Option<(&str, &str, &str)>) {
    let _ = write!(
        xml,
        "    <testcase classname=\"{}\" name=\"{}\" time=\"{seconds:.3}\"",
        escaped(class),
        escaped(name)
    );
    match problem {
        None => xml.push_str("/>\n"),
        Some((kind, message, told)) => {
            let _ = writeln!(
                xml,
                ">\n      <{kind} message=\"{}\">{}</{kind}>\n    </testcase>",
                escaped(message),
                escaped(told)
            );
        }
    }
}

/// Text as XML has it; what XML 1.0 has no character for is replaced.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(letter),
            letter if letter.is_control() => escaped.push('\u{fffd}'),
            letter => escaped.push(letter),
        }
    }
    escaped
}
