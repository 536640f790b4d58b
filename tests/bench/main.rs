//! `make bench`: what a user feels, measured through the wire of the real binary.
//!
//! Each figure is a median and a 95th percentile of many rounds, with a ratio to a calibration (a fixed piece of
//! arithmetic) run beside it, so that figures of different machines and hours can be compared.

#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "a bench that cannot run stops")]

#[path = "../lsp_client.rs"]
#[allow(dead_code, reason = "the tests use all of it")]
mod lsp_client;

mod programs;

use lsp_client::{Client, at};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

const URI: &str = "file:///bench/program";

/// Durations of one kind of event.
struct Figures(Vec<Duration>);

impl Figures {
    fn of(rounds: usize, mut event: impl FnMut(usize) -> Duration) -> Figures {
        // The first rounds warm caches and are not counted.
        for round in 0..rounds / 10 + 1 {
            event(round);
        }
        let mut durations: Vec<Duration> = (0..rounds).map(|round| event(rounds / 10 + 1 + round)).collect();
        durations.sort();
        Figures(durations)
    }

    fn percentile(&self, percent: usize) -> Duration {
        self.0[(self.0.len() - 1) * percent / 100]
    }

    fn report(&self, what: &str, calibration: Duration) {
        let (median, p95) = (self.percentile(50), self.percentile(95));
        let ratio = median.as_secs_f64() / calibration.as_secs_f64();
        println!("| {what} | {} | {} | {ratio:.3} |", milliseconds(median), milliseconds(p95));
    }
}

fn milliseconds(duration: Duration) -> String {
    format!("{:.3} ms", duration.as_secs_f64() * 1e3)
}

fn main() {
    // `cargo test --benches` starts this too, with an argument; there is nothing to measure then.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let calibration = calibrate();
    println!("calibration: {} (2,000,000 steps of a pseudo-random generator)\n", milliseconds(calibration));
    println!("| what | median | 95th percentile | median / calibration |\n|---|---|---|---|");
    for notation in ["il", "lad"] {
        for lines in [1_000, 10_000, 50_000] {
            keystrokes(notation, lines, calibration);
        }
    }
    start(calibration);
    println!("| (calibration again) | {} | | |", milliseconds(calibrate()));
}

/// Everything that is measured on one open document.
fn keystrokes(notation: &str, lines: usize, calibration: Duration) {
    let program = programs::program(notation, lines);
    let uri = format!("{URI}.{notation}");
    let name = |what: &str| format!("{what}, {notation}, {lines} lines");

    let open = Figures::of(if lines > 10_000 { 10 } else { 20 }, |_| {
        let mut client = Client::start();
        let started = Instant::now();
        client.open(&uri, notation, &program.text);
        client.diagnostics(&uri, 1);
        started.elapsed()
    });
    open.report(&name("open to first diagnostics"), calibration);

    let mut client = Client::start();
    client.open(&uri, notation, &program.text);
    client.diagnostics(&uri, 1);
    std::thread::sleep(Duration::from_millis(500));
    let (line, column) = program.digit;
    let mut version = 1;
    let typing = Figures::of(200, |round| {
        version += 1;
        let digit = if round % 2 == 0 { "8" } else { "0" };
        let started = Instant::now();
        client.change(&uri, version, (line, column), (line, column + 1), digit);
        client.diagnostics(&uri, version);
        let elapsed = started.elapsed();
        // A typist at 600 strokes a minute leaves a pause, in which the batch tier may run.
        std::thread::sleep(Duration::from_millis(if lines > 10_000 { 40 } else { 10 }));
        elapsed
    });
    typing.report(&name("keystroke to diagnostics"), calibration);

    for (what, method) in [
        ("hover", "textDocument/hover"),
        ("definition", "textDocument/definition"),
        ("completion", "textDocument/completion"),
    ] {
        Figures::of(100, |_| timed(&mut client, method, at(&uri, line, column)))
            .report(&name(what), calibration);
    }
    let whole = json!({"textDocument": {"uri": uri}});
    let tokens = Figures::of(10, |_| timed(&mut client, "textDocument/semanticTokens/full", whole.clone()));
    tokens.report(&name("semantic tokens"), calibration);
    let memory = client.resident_kib().map_or("unknown".to_string(), |kib| format!("{} MiB", kib / 1024));
    println!("| {} | {memory} | | |", name("resident memory"));
}

fn timed(client: &mut Client, method: &str, params: Value) -> Duration {
    let started = Instant::now();
    let answer = client.request(method, params);
    assert!(answer.get("error").is_none(), "{answer}");
    started.elapsed()
}

/// From starting the process to the answer of `initialize`.
fn start(calibration: Duration) {
    let figures = Figures::of(20, |_| {
        let started = Instant::now();
        drop(Client::start());
        started.elapsed()
    });
    figures.report("start to initialize answered", calibration);
}

fn calibrate() -> Duration {
    let figures = Figures::of(20, |round| {
        let started = Instant::now();
        let mut state = round as u64 + 88_172_645_463_325_252;
        for _ in 0..2_000_000 {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
        }
        std::hint::black_box(state);
        started.elapsed()
    });
    figures.percentile(50)
}
