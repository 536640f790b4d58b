//! `rungwise run`

use super::Outcome;
use super::across::{checked, whole_program};
use super::input::{Program, caution, complain, put, remark, say};
use super::progress::Progress;
use super::why;
use crate::document::Document;
use crate::scenario::picture;
use crate::simulate::{
    self, AlarmChange, Alarms, Code, HistoryLimit, NamesOfCode, Place, Reason, Session, Setting, Touch,
    Trace, TraceRow, Variable, WithSymbols, compile,
};
use crate::text::{Diagnostic, Encoding, Language, Message, Severity, Span};
use clap::ValueEnum;
use serde_json::{Map, Value as Json, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A program, or a project.
    file: PathBuf,
    /// So many scans; the first is scan 0.
    #[arg(
        long,
        value_name = "N",
        conflicts_with = "time",
        allow_negative_numbers = true,
        value_parser = clap::value_parser!(u64).range(1..)
    )]
    scans: Option<u64>,
    /// Every scan from time 0 up to this time: 500ms, 1.5s, T#2m.
    #[arg(long, value_name = "TIME", value_parser = duration, default_value = "1s")]
    time: i64,
    /// Time from one scan to the next.
    #[arg(long, value_name = "TIME", value_parser = distance, default_value = "10ms")]
    scan_time: i64,
    /// Sets a device or variable, from time 0 or from a time on: X0=1, D0=25@100ms.
    #[arg(long = "set", value_name = "NAME=VALUE[@TIME]")]
    settings: Vec<String>,
    /// What is shown, parted by commas; all that the program uses if left out.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    watch: Vec<String>,
    /// Says which contacts held a device on or off in the last scan, or at a time: Y0, Y0@500ms.
    #[arg(long = "why", value_name = "NAME[@TIME]", value_parser = why::question)]
    questions: Vec<why::Question>,
    /// The memory that the history may take which --why looks back into: 64MiB; that of the project if left out.
    #[arg(long, value_name = "SIZE", value_parser = history)]
    history: Option<HistoryLimit>,
    /// Writes the values over time to a file, as a value change dump (.vcd) or a table (.csv).
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// The shape of the result.
    #[arg(long, value_enum, default_value = "text")]
    format: RunFormat,
}

/// The shape of a run on standard output.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum RunFormat {
    /// For people.
    Text,
    /// One JSON document.
    Json,
}

/// The shape of a trace, by the end of its file's name.
enum TraceFormat {
    Vcd,
    Csv,
}

impl TraceFormat {
    fn of(path: &Path) -> Option<TraceFormat> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "vcd" => Some(TraceFormat::Vcd),
            "csv" => Some(TraceFormat::Csv),
            _ => None,
        }
    }
}

/// A time as people write it, in nanoseconds.
pub(super) fn duration(word: &str) -> Result<i64, String> {
    simulate::duration(word).ok_or_else(|| word.to_string())
}

/// A time from one scan to the next, in nanoseconds.
pub(super) fn distance(word: &str) -> Result<i64, String> {
    duration(word).and_then(|time_ns| if time_ns > 0 { Ok(time_ns) } else { Err(word.to_string()) })
}

/// A size of a history.
fn history(word: &str) -> Result<HistoryLimit, String> {
    HistoryLimit::read(word).ok_or_else(|| word.to_string())
}

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    if let Some(path) = arguments.trace.as_ref().filter(|path| TraceFormat::of(path).is_none()) {
        let reason = Message::new("cli.run-trace").with("path", path.display()).render(language);
        let help = Message::new("cli.run-traces").render(language);
        complain("unknown-format", &reason, &help, language);
        return Outcome::Unusable;
    }
    let Some(programs) = whole_program(&arguments.file, language) else {
        return Outcome::Unusable;
    };
    let documents: Vec<&Document> = programs.iter().map(|program| &program.document).collect();
    let code = match compile(&documents, false) {
        Ok(code) => Arc::new(code),
        Err(problems) => {
            for problem in problems {
                complain_at(&programs, Some(problem.place), problem.obstacle.message(), language);
            }
            return Outcome::Findings;
        }
    };
    let Some((touches, watched)) = named(arguments, &code, language) else { return Outcome::Unusable };
    let programs = cautioned(programs, language);
    let Some(alarms) = alarms_of(&programs, &code, language) else { return Outcome::Unusable };
    let of_project = || programs.first().map(|program| program.manifest.history());
    let limit = arguments.history.or_else(of_project).unwrap_or_default();
    let mut simulation = Simulation {
        session: Session::new(code).with_limit(limit),
        trace: Trace::new(watched),
        touches,
        alarms,
        told: Vec::new(),
    };
    let is_clean = simulation.run(arguments, &programs, language);
    let session = &simulation.session;
    let step = arguments.scan_time.max(1);
    let Some(reasons) = why::answers(&arguments.questions, session, step, &programs, language) else {
        return Outcome::Unusable;
    };
    if !simulation.tell(arguments, &reasons, &programs, language) {
        return Outcome::Unusable;
    }
    if is_clean { Outcome::Clean } else { Outcome::Findings }
}

/// Says that a program runs in which `rungwise check` finds errors.
fn cautioned(programs: Vec<Program>, language: Language) -> Vec<Program> {
    let checked = checked(programs, None);
    let is_told = |found: &&Diagnostic| found.severity == Severity::Error;
    let count = checked.iter().flat_map(|(_, found)| found).filter(is_told).count();
    let first = checked
        .iter()
        .find_map(|(program, found)| found.iter().find(is_told).map(|diagnostic| (program, diagnostic)));
    if let Some((program, found)) = first {
        let reason = Message::new("cli.run-findings")
            .with("count", count)
            .with("place", at(program, found.span))
            .with_messages("first", vec![found.message.clone()]);
        let help = Message::new("cli.run-check").render(language);
        caution("check", &reason.render(language), &help, language);
    }
    checked.into_iter().map(|(program, _)| program).collect()
}

/// What is set from which time on, and what is watched; nothing after complaints about names that there are not.
#[allow(clippy::type_complexity, reason = "two lists that are made together")]
fn named(
    arguments: &Arguments,
    code: &Code,
    language: Language,
) -> Option<(Vec<(i64, Touch)>, Vec<(String, Variable)>)> {
    let mut is_known = true;
    let mut complaint = |problem: &str, reason: Message| {
        let help = Message::new("cli.run-names").render(language);
        complain(problem, &reason.render(language), &help, language);
        is_known = false;
    };
    let unknown = |name: &str| Message::new("cli.run-unknown").with("name", name);
    let mut touches = Vec::new();
    for word in &arguments.settings {
        let setting = match Setting::read(word) {
            Ok(setting) => setting,
            Err(reason) => {
                complaint("bad-value", reason);
                continue;
            }
        };
        let Some(variable) = code.variable(&setting.name) else {
            complaint("unknown-name", unknown(&setting.name));
            continue;
        };
        match variable.set(code, &setting.value) {
            Some(touch) => touches.push((setting.from_ns, touch)),
            None => complaint("bad-value", variable.refusal(code, &setting.name, &setting.value)),
        }
    }
    // Of several settings for one time the last one counts.
    touches.sort_by_key(|(from_ns, _)| *from_ns);
    let names = if arguments.watch.is_empty() { code.named() } else { arguments.watch.clone() };
    let mut watched: Vec<(String, Variable)> = Vec::new();
    for name in names {
        match code.variable(&name) {
            // What is asked for twice is shown once; of two names for one variable each is shown.
            Some(_) if watched.iter().any(|(known, _)| known.eq_ignore_ascii_case(name.trim())) => {}
            Some(variable) => watched.push((name.trim().to_string(), variable)),
            None => complaint("unknown-name", unknown(&name)),
        }
    }
    is_known.then_some((touches, watched))
}

/// The alarms of the project; nothing after a complaint about one that names what there is not.
fn alarms_of(programs: &[Program], code: &Code, language: Language) -> Option<Alarms> {
    let wanted = programs.first().map(|program| program.manifest.alarms()).unwrap_or_default();
    let comments =
        programs.first().map(|program| Arc::clone(program.document.comments())).unwrap_or_default();
    let names = NamesOfCode { code, instruction: None };
    let names = WithSymbols { names: &names, symbols: comments.symbols() };
    let (alarms, refused) = Alarms::new(&wanted, &names);
    let Some((alarm, reason)) = refused.into_iter().next() else { return Some(alarms) };
    let reason =
        Message::new("simulate.alarm-refused").with("when", alarm.when).with_messages("reason", vec![reason]);
    let help = Message::new("cli.mend-manifest").render(language);
    complain("manifest", &reason.render(language), &help, language);
    None
}

struct Simulation {
    session: Session,
    trace: Trace,
    touches: Vec<(i64, Touch)>,
    alarms: Alarms,
    /// What was raised and what was gone, in its order.
    told: Vec<AlarmChange>,
}

impl Simulation {
    /// Runs all scans; whether nothing went wrong.
    fn run(&mut self, arguments: &Arguments, programs: &[Program], language: Language) -> bool {
        let mut touches = std::mem::take(&mut self.touches).into_iter().peekable();
        let mut told: Vec<(Option<Place>, Message)> = Vec::new();
        let mut now_ns = 0i64;
        let by_time = arguments.time / arguments.scan_time.max(1) + 1;
        let mut progress = Progress::new(arguments.scans.unwrap_or(by_time.unsigned_abs()));
        let mut is_ended = false;
        for scan in 0.. {
            let is_over = match arguments.scans {
                Some(scans) => scan >= scans,
                None => now_ns > arguments.time,
            };
            if is_over {
                break;
            }
            if !progress.goes_on(scan, language) {
                let words = Message::new("cli.run-ended").with("scans", scan).render(language);
                progress.aside(|| remark(&words));
                is_ended = true;
                break;
            }
            while let Some((_, touch)) = touches.next_if(|(from_ns, _)| *from_ns <= now_ns) {
                self.session.touch(touch);
            }
            for error in self.session.scan(now_ns).errors {
                let message = error.kind.message();
                // What goes wrong in every scan is said once.
                if !told.contains(&(error.place, message.clone())) {
                    progress.aside(|| complain_at(programs, error.place, message.clone(), language));
                    told.push((error.place, message));
                }
            }
            let machine = self.session.machine();
            self.trace.note(machine);
            self.told.extend(self.alarms.look(now_ns, &|variable| machine.value(variable, 0)));
            // The program may ask for a scan that is longer.
            let least = self.session.machine().least_scan_ns();
            now_ns = now_ns.saturating_add(arguments.scan_time.max(least));
        }
        progress.end();
        self.trace.end();
        told.is_empty() && !is_ended
    }

    /// Writes what came out; whether that could be done.
    fn tell(
        &self,
        arguments: &Arguments,
        reasons: &[Reason],
        programs: &[Program],
        language: Language,
    ) -> bool {
        if let Some(path) = &arguments.trace {
            let text = match TraceFormat::of(path) {
                Some(TraceFormat::Vcd) => {
                    self.trace.vcd().map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
                }
                _ => Ok(self.trace.csv()),
            };
            if !text.is_ok_and(|text| put(&text, Some(path), language)) {
                return false;
            }
        }
        match arguments.format {
            RunFormat::Json => {
                let mut told = json_of(&self.trace, arguments.scan_time);
                if !self.alarms.is_empty() {
                    let alarms = self.told.iter().map(|change| {
                        let mut json = change.json();
                        json["time_ms"] = as_ms(change.time_ns);
                        json
                    });
                    told["alarms"] = alarms.collect();
                }
                if !reasons.is_empty() {
                    let reasons = reasons.iter().map(|reason| why::json(reason, programs, language));
                    told["why"] = reasons.collect();
                }
                say(&format!("{told:#}\n"));
            }
            RunFormat::Text => {
                say(&picture(&self.trace, &[], language));
                self.told.iter().for_each(|change| say(&format!("{}\n", change.told().render(language))));
                say(&why::text(reasons, programs, language));
            }
        }
        true
    }
}

fn json_of(trace: &Trace, scan_time_ns: i64) -> Json {
    let scan = |row: &TraceRow| {
        let values = trace.names.iter().zip(&row.values);
        let values: Map<String, Json> = values.map(|(name, value)| (name.clone(), value.json())).collect();
        json!({ "scan": row.scan, "time_ms": as_ms(row.time_ns), "values": values })
    };
    let scans: Vec<Json> = trace.rows.iter().map(scan).collect();
    json!({ "scan_time_ms": as_ms(scan_time_ns), "scans": scans })
}

/// Milliseconds as a whole number where they are one.
fn as_ms(time_ns: i64) -> Json {
    match time_ns % 1_000_000 {
        0 => json!(time_ns / 1_000_000),
        _ => json!(time_ns as f64 / 1e6),
    }
}

/// Where something stands in a program.
fn at(program: &Program, span: Span) -> String {
    let position = program.document.position(span.start as usize, Encoding::Utf32);
    format!("{}:{}:{}", program.path.display(), position.line + 1, position.column + 1)
}

/// A complaint about a place in one of the programs.
fn complain_at(programs: &[Program], place: Option<Place>, message: Message, language: Language) {
    let at =
        place.and_then(|place| Some(format!("{}: ", at(programs.get(place.document as usize)?, place.span))));
    let reason = format!("{}{}", at.unwrap_or_default(), message.render(language));
    complain("simulation", &reason, &Message::new("cli.run-check").render(language), language);
}
