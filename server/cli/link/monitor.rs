//! `rungwise monitor`

use super::Connection;
use super::connection::{ATTENTION, AnyHost, failed};
use super::contents::words_at;
use super::devices::settings_of;
use super::drift::{ProgramWatch, Wanted};
use super::status::StatusFormat;
use crate::cli::Outcome;
use crate::cli::comments;
use crate::cli::input::{complain, is_writable, put, remark, say, usable_manifest};
use crate::cli::run::duration;
use crate::link::{Holds, NamesOfPlc, Point, Watch};
use crate::simulate::{AlarmChange, Alarms, Trace, TraceRow, Value, WithSymbols};
use crate::text::{Language, Message};
use serde_json::{Map, Value as Json, json};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// What is watched: X0, D10, D0:32, T0 (current value), TS0 (contact), TC0 (coil).
    #[arg(value_name = "DEVICE")]
    devices: Vec<String>,
    #[command(flatten)]
    connection: Connection,
    /// Time from one look to the next; as fast as the line is if left out.
    #[arg(long, value_name = "TIME", value_parser = duration, default_value = "0ms")]
    interval: i64,
    /// The program that should be in the PLC: tells whether it is there, and when it is not any more.
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// So many looks; until Ctrl-C if left out.
    #[arg(long, value_name = "N")]
    count: Option<u64>,
    /// So long; until Ctrl-C if left out.
    #[arg(long = "for", value_name = "TIME", value_parser = duration)]
    time: Option<i64>,
    /// Writes the values over time to a file, as a value change dump (.vcd) or a table (.csv).
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Looks with a change that are kept for the file at most, the latest.
    #[arg(long, value_name = "N", default_value = "100000", value_parser = clap::value_parser!(u32).range(1..))]
    keep: u32,
    /// Writes a value again with each look that finds another one: Y0=on, D0=5.
    #[arg(long = "hold", value_name = "DEVICE=VALUE")]
    holds: Vec<String>,
    /// The shape of the result: a line for each look in which something changed.
    #[arg(long, value_enum, default_value = "text")]
    format: StatusFormat,
}

pub(in crate::cli) fn run(arguments: &Arguments, language: Language) -> Outcome {
    carry_out(arguments, language).unwrap_or_else(|outcome| outcome)
}

fn carry_out(arguments: &Arguments, language: Language) -> Result<Outcome, Outcome> {
    let here = arguments.program.as_deref().unwrap_or(Path::new("."));
    let manifest = usable_manifest(here, language).ok_or(Outcome::Unusable)?;
    let wanted = manifest.alarms();
    if arguments.devices.is_empty() && wanted.is_empty() && arguments.program.is_none() {
        let reason = Message::new("link.nothing-to-watch").render(language);
        complain(
            "nothing-to-watch",
            &reason,
            &Message::new("link.help-no-device").render(language),
            language,
        );
        return Err(Outcome::Unusable);
    }
    let program = match &arguments.program {
        Some(path) => {
            Some(words_at(path, language).map(|(words, target)| -> Wanted { (path, words, target) })?)
        }
        None => None,
    };
    let mut host = arguments.connection.open(here, language)?;
    let target = host.identity().target;
    let point = |name: &String| {
        Point::named(name, target).ok_or_else(|| {
            let reason = Message::new("link.no-device").with("device", name).render(language);
            complain("no-device", &reason, &Message::new("link.help-no-device").render(language), language);
            Outcome::Unusable
        })
    };
    let settings = settings_of(&arguments.holds, false, target, language)?;
    let named = arguments.devices.iter().map(point).collect::<Result<Vec<_>, _>>()?;
    let comments = comments::of(here, &manifest);
    let names = WithSymbols { names: &NamesOfPlc(target), symbols: comments.symbols() };
    let (mut alarms, refused) = Alarms::new(&wanted, &names);
    if let Some((alarm, reason)) = refused.into_iter().next() {
        let reason = Message::new("simulate.alarm-refused")
            .with("when", alarm.when)
            .with_messages("reason", vec![reason]);
        let help = Message::new("cli.mend-manifest").render(language);
        complain("manifest", &reason.render(language), &help, language);
        return Err(Outcome::Unusable);
    }
    // Said before hours of looking are lost.
    if arguments.trace.as_ref().is_some_and(|path| !is_writable(path, language)) {
        return Err(Outcome::Unusable);
    }
    // All in one list, so that alarms are about the values that are shown.
    let mut points: Vec<Point> = named.iter().copied().chain(alarms.variables()).collect();
    let mut holds = Holds::default();
    for (point, number) in settings {
        holds.hold(&mut host, point, number).map_err(|error| failed(&error, language))?;
        points.push(point);
    }
    let mut watch = Watch::new(points.clone());
    let program = ProgramWatch::new(&mut host, program.as_ref());
    let mut program = program.map_err(|error| failed(&error, language))?;
    let mut trace = Trace::bounded(arguments.devices.clone(), arguments.keep as usize);
    let start = host.line().now();
    let mut look = 0;
    let end = loop {
        let values = match host.poll(&mut watch) {
            Ok(values) => values,
            Err(error) => break Err(error),
        };
        if look == 0 && watch.exchanges() > 1 {
            let told = Message::new("link.several-scans").with("count", watch.exchanges());
            remark(&told.render(language));
        }
        let values: Vec<Value> = points.iter().zip(values).map(|(point, value)| point.value(value)).collect();
        let time_ns = host.line().now().saturating_sub(start).as_nanos() as i64;
        let of = |wanted: Point| {
            let at = points.iter().position(|point| *point == wanted);
            at.map_or(wanted.value(0), |at| values[at].clone())
        };
        let changes = alarms.look(time_ns, &of);
        let is_news = trace.push(TraceRow { scan: look, time_ns, values: values[..named.len()].to_vec() });
        if is_news && !named.is_empty() {
            tell(&trace, arguments.format);
        }
        if let Err(error) = holds.rewrite(&mut host, &|point| point.number(&of(point))) {
            break Err(error);
        }
        changes.iter().for_each(|change| tell_alarm(change, arguments.format, language));
        if let Err(error) = program.look(&mut host, time_ns, (arguments.format, language)) {
            break Err(error);
        }
        look += 1;
        let is_over = arguments.time.is_some_and(|time| time_ns >= time);
        if is_over || arguments.count.is_some_and(|count| look >= count) {
            break Ok(());
        }
        let interval = Duration::from_nanos(arguments.interval.max(0) as u64);
        rest(&mut host, if points.is_empty() { interval.max(program.pause()) } else { interval });
    };
    let held = holds.release_all();
    if !held.is_empty() {
        let names: Vec<String> = held.iter().map(|(point, number)| format!("{point}={number}")).collect();
        let released = Message::new("link.released");
        let released = released.with_words("devices", names.iter().map(String::as_str), ", ");
        remark(&released.render(language));
    }
    trace.end();
    if let Some(path) = &arguments.trace {
        let is_dump = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("vcd"));
        let text = match is_dump {
            true => trace.vcd().map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).unwrap_or_default(),
            false => trace.csv(),
        };
        if !put(&text, Some(path), language) {
            return Err(Outcome::Unusable);
        }
    }
    program.end(language);
    match end {
        // Whoever watches ends it this way.
        Ok(()) | Err(crate::link::LinkError::Cancelled) => {
            Ok(if program.is_other() { Outcome::Findings } else { Outcome::Clean })
        }
        Err(error) => Err(failed(&error, language)),
    }
}

/// Waits, until the user ends it.
fn rest(host: &mut AnyHost, time: Duration) {
    let end = Instant::now() + time;
    loop {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() || host.line().is_cancelled() {
            return;
        }
        std::thread::sleep(left.min(ATTENTION));
    }
}

/// A line about an alarm that is raised or gone.
fn tell_alarm(change: &AlarmChange, format: StatusFormat, language: Language) {
    let text = match format {
        StatusFormat::Json => {
            json!({ "time_ms": change.time_ns / 1_000_000, "alarm": change.json() }).to_string()
        }
        StatusFormat::Text => change.told().render(language),
    };
    say(&format!("{text}\n"));
}

/// A line with the values of the last look.
fn tell(trace: &Trace, format: StatusFormat) {
    let Some(row) = trace.rows.last() else { return };
    let values = trace.names.iter().zip(&row.values);
    let text = match format {
        StatusFormat::Json => {
            let values: Map<String, Json> =
                values.map(|(name, value)| (name.clone(), value.json())).collect();
            json!({ "time_ms": row.time_ns / 1_000_000, "values": values }).to_string()
        }
        StatusFormat::Text => {
            let words: Vec<String> = values.map(|(name, value)| format!("{name}={value}")).collect();
            format!("{:.1} ms  {}", row.time_ns as f64 / 1e6, words.join("  "))
        }
    };
    say(&format!("{text}\n"));
}
