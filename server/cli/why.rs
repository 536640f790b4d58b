//! `rungwise run --why`: which contacts held a device on or off.

use super::input::{Program, complain};
use super::run::duration;
use crate::document::Document;
use crate::simulate::{Drivers, Inquiry, Place, Reason, Session, compile};
use crate::text::{Encoding, Language, Message};
use serde_json::{Value as Json, json};
use std::sync::Arc;

/// A device, and the time at which it is asked about.
#[derive(Clone, Debug)]
pub(super) struct Question {
    name: String,
    at_ns: Option<i64>,
}

/// Reads `NAME` or `NAME@TIME`.
///
/// # Errors
/// What is no time.
pub(super) fn question(word: &str) -> Result<Question, String> {
    Ok(match word.rsplit_once('@') {
        Some((name, time)) => Question { name: name.trim().to_string(), at_ns: Some(duration(time)?) },
        None => Question { name: word.trim().to_string(), at_ns: None },
    })
}

/// The answers after a run with scans that are `scan_ns` apart; nothing after complaints about unknown names.
pub(super) fn answers(
    questions: &[Question],
    session: &Session,
    scan_ns: i64,
    programs: &[Program],
    language: Language,
) -> Option<Vec<Reason>> {
    if questions.is_empty() {
        return Some(Vec::new());
    }
    let documents: Vec<&Document> = programs.iter().map(|program| &program.document).collect();
    // What could be run can be run watched.
    let watched = Arc::new(compile(&documents, true).ok()?);
    let drivers = Drivers::of(&documents);
    let inquiry = Inquiry::new(session, &watched, &documents, &drivers);
    let last = session.machine().scans().saturating_sub(1);
    let answer = |question: &Question| {
        let scan = question.at_ns.map_or(last, |at_ns| ((at_ns / scan_ns.max(1)) as u64).min(last));
        if scan < session.first_scan() {
            let message = Message::new("why.forgotten").with("scan", session.first_scan());
            let help = Message::new("cli.run-history").with("limit", session.limit()).render(language);
            complain("history", &message.render(language), &help, language);
            return None;
        }
        let reason = inquiry.why(&question.name, Some(scan));
        if reason.is_none() {
            let message = Message::new("cli.run-unknown").with("name", &question.name);
            let help = Message::new("cli.run-names").render(language);
            complain("unknown-name", &message.render(language), &help, language);
        }
        reason
    };
    let answers: Vec<Option<Reason>> = questions.iter().map(answer).collect();
    answers.into_iter().collect()
}

/// For people: a line for each reason, with its place.
pub(super) fn text(answers: &[Reason], programs: &[Program], language: Language) -> String {
    let place = |place: Place| {
        let (path, line, _) = located(place, programs);
        format!("{path}:{line}")
    };
    answers.iter().map(|reason| format!("\n{}", reason.told(language, place))).collect()
}

/// For programs.
pub(super) fn json(reason: &Reason, programs: &[Program], language: Language) -> Json {
    let because: Vec<Json> = reason.because.iter().map(|reason| json(reason, programs, language)).collect();
    let mut told = json!({
        "text": reason.message.render(language),
        "scan": reason.scan,
        "time_ms": reason.time_ns as f64 / 1e6,
        "because": because,
    });
    if let Some(place) = reason.place {
        let (path, line, column) = located(place, programs);
        told["path"] = json!(path);
        (told["line"], told["column"]) = (json!(line), json!(column));
    }
    told
}

/// The path, the line and the column of a place, from 1 on.
fn located(place: Place, programs: &[Program]) -> (String, u32, u32) {
    let Some(program) = programs.get(place.document as usize) else { return (String::new(), 1, 1) };
    let position = program.document.position(place.span.start as usize, Encoding::Utf32);
    (program.path.display().to_string(), position.line + 1, position.column + 1)
}
