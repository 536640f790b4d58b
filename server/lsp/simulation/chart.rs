//! What variables were over time: for a chart that is drawn while the program runs, and for files.

use super::super::answering::wrong_argument;
use super::panel;
use crate::document::ProjectView;
use crate::simulate::{Change, Recorder, Session, Trace, is_affordable};
use crate::text::Message;
use serde_json::{Value as Json, json};
use std::time::{Duration, Instant};

/// What of the past is wanted. Scans are counted from 0, as clients do.
#[derive(Clone, Debug, Default)]
pub(super) struct Wanted {
    pub(super) names: Vec<String>,
    pub(super) from: Option<u64>,
    pub(super) to: Option<u64>,
    pub(super) most: Option<usize>,
}

/// Points of a variable, if nothing is said; and at most.
const POINTS: (usize, usize) = (2_000, 20_000);
/// So long one question may look back into what was not recorded.
const LOOKING_BACK: Duration = Duration::from_millis(20);

/// The changes of the variables that are wanted, which are recorded from now on.
pub(super) fn changes(recorder: &mut Recorder, session: &Session, wanted: &Wanted) -> Json {
    let last = session.machine().scans();
    let to = wanted.to.map_or(last, |to| to.saturating_add(1)).clamp(1, last.max(1));
    let from = wanted.from.unwrap_or(0).saturating_add(1).min(to);
    recorder.record(&wanted.names, session.machine());
    let began = Instant::now();
    recorder.look_back(session, from, || began.elapsed() < LOOKING_BACK);
    let is_thinned = |name: &String| recorder.signal(name).is_some_and(|signal| from < signal.exact_from());
    let again = match wanted.names.iter().any(is_thinned) {
        true => recorder.again(&wanted.names, session, from, to),
        false => None,
    };
    let most = wanted.most.unwrap_or(POINTS.0).clamp(8, POINTS.1);
    let signals = wanted.names.iter().filter_map(|name| {
        let signal = again.as_ref().unwrap_or(recorder).signal(name)?;
        let point = |(scan, value): &Change| json!([scan.saturating_sub(1), value.json()]);
        let points: Vec<Json> = signal.changes(from, to, most).iter().map(point).collect();
        Some(json!({ "name": name, "known_from": signal.since().saturating_sub(1), "points": points }))
    });
    json!({ "from": from - 1, "to": to - 1, "signals": signals.collect::<Vec<_>>() })
}

/// The variables that are wanted, all on the panel if none is named, as the text of a file: every change of the scans
/// that are wanted, as far back as they can be run again in a moment.
///
/// # Errors
/// For a name that the program does not know, and a format other than `vcd` and `csv`.
pub(super) fn file(
    session: &Session,
    view: &ProjectView<'_>,
    wanted: &Wanted,
    format: &str,
) -> Result<Json, Message> {
    let names = match wanted.names.is_empty() {
        true => panel::rows(view, session.machine(), &[]).iter().flat_map(names_of).collect(),
        false => wanted.names.clone(),
    };
    let code = session.machine().code();
    let watched = names.into_iter().map(|name| match code.variable(&name) {
        Some(variable) => Ok((name, variable)),
        None => Err(Message::new("cli.run-unknown").with("name", name)),
    });
    let mut trace = Trace::new(watched.collect::<Result<_, _>>()?);
    let last = session.machine().scans();
    let to = wanted.to.map_or(last, |to| to.saturating_add(1)).min(last);
    let earliest = session.first_scan().max(1);
    let mut from = wanted.from.unwrap_or(0).saturating_add(1).clamp(earliest, to.max(earliest));
    while !is_affordable(session, session.moment_of(from), to) && from < to {
        from += (to - from).div_ceil(2);
    }
    session.walk(from, to, |machine| {
        trace.note(machine);
        true
    });
    trace.end();
    let text = match format {
        "csv" => trace.csv(),
        "vcd" => {
            let written = trace.vcd().map_err(|reason| {
                Message::new("translating.argument")
                    .with("command", "export")
                    .with("reason", reason.to_string())
            })?;
            String::from_utf8_lossy(&written).into_owned()
        }
        _ => return Err(wrong_argument("export", "format")),
    };
    Ok(json!({ "from": from.saturating_sub(1), "to": to.saturating_sub(1), "text": text }))
}

/// What a row of the panel shows: the current value and the contact of a timer.
fn names_of(row: &Json) -> Vec<String> {
    ["name", "contact"].iter().filter_map(|member| row[*member].as_str().map(str::to_string)).collect()
}
