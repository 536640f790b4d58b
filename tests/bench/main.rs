//! `make bench`: what a user feels, measured through the wire of the real binary.
//!
//! Each figure is a median and a 95th percentile of many rounds, with a ratio to a calibration (a fixed piece of
//! arithmetic) run beside it, so that figures of different machines and hours can be compared. The clock starts when
//! the last byte of a message is written and stops when the last byte of the answer has come, before it is understood.
//!
//! `cargo bench --bench bench -- WORD …` measures only rows whose names contain one of the words; the environment
//! variable `RUNGWISE_BENCH_SERVER` names another build of the program.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a bench that cannot run stops"
)]

#[path = "../lsp_client.rs"]
#[allow(dead_code, reason = "the tests use all of it")]
mod lsp_client;

#[path = "../loopback.rs"]
#[allow(dead_code, reason = "the tests use all of it")]
mod loopback;

#[path = "../line_time.rs"]
mod line_time;

mod figures;

mod programs;

mod command_line;

mod interleaved;

mod translation;

mod machine_code;

mod cursor;

mod simulation;
mod simulation_wire;

mod link;
mod simulation_iec;

use figures::{Figures, Table, calibrate, milliseconds};
use lsp_client::{Client, at};
use programs::Program;
use serde_json::{Value, json};
use std::cell::{Cell, RefCell};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What is measured in this process has the program's allocator.
#[cfg(not(windows))]
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

const URI: &str = "file:///bench/program";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // `cargo test --benches` starts this too, with an argument; there is nothing to measure then.
    if arguments.iter().any(|argument| argument == "--test") {
        return;
    }
    let wanted = arguments.into_iter().filter(|argument| !argument.starts_with("--")).collect();
    let table =
        Table { calibration: calibrate(), wanted, shortest: RefCell::default(), missed: Cell::default() };
    table.head();
    for notation in ["il", "lad"] {
        for lines in [1_000, 5_000, 50_000] {
            Bench { table: &table, notation, lines, program: programs::program(notation, lines) }.run();
        }
    }
    start(&table);
    interleaved::measure(&table);
    translation::measure(&table);
    machine_code::measure(&table);
    cursor::measure(&table);
    simulation::measure(&table);
    simulation_iec::measure(&table);
    simulation_wire::measure(&table);
    link::measure(&table);
    command_line::measure(&table);
    println!("| (calibration again) | {} | | | | |", milliseconds(calibrate()));
    if table.missed.get() {
        std::process::exit(1);
    }
}

/// The program that is measured.
fn server() -> PathBuf {
    std::env::var_os("RUNGWISE_BENCH_SERVER").map_or(env!("CARGO_BIN_EXE_rungwise").into(), PathBuf::from)
}

/// A server after the handshake with a client that counts columns in UTF-16, as most do.
fn client() -> Client {
    let mut client = Client::spawn_program(&server(), &[]);
    // The largest model has room for the relays of long programs.
    client.initialise(json!({}), json!({"target": "fx3u"}));
    client
}

/// Everything that is measured on one open document.
struct Bench<'a> {
    table: &'a Table,
    notation: &'a str,
    lines: usize,
    program: Program,
}

impl Bench<'_> {
    fn run(&self) {
        self.open();
        let rows = [
            "keystroke to diagnostics",
            "hover",
            "definition",
            "completion",
            "semantic tokens",
            "cancel",
            "resident memory",
        ];
        if !rows.iter().any(|what| self.table.wants(&self.name(what))) {
            return;
        }
        let mut client = self.opened();
        let quiet = client.resident_kib();
        self.keystrokes(&mut client);
        self.requests(&mut client);
        self.tokens(&mut client);
        self.cancel(&mut client);
        std::thread::sleep(Duration::from_millis(1500));
        let mebibytes =
            |kib: Option<u64>| kib.map_or("unknown".to_string(), |kib| format!("{} MiB", kib / 1024));
        let target = if self.lines == 50_000 { "< 40 MB" } else { "" };
        self.table.value(&self.name("resident memory after opening"), target, &mebibytes(quiet));
        self.table.value(
            &self.name("resident memory after all this"),
            target,
            &mebibytes(client.resident_kib()),
        );
    }

    fn name(&self, what: &str) -> String {
        format!("{what}, {}, {} lines", self.notation, self.lines)
    }

    fn uri(&self) -> String {
        format!("{URI}.{}", self.notation)
    }

    /// A server that has the document open and is done with it.
    fn opened(&self) -> Client {
        let mut client = client();
        client.open(&self.uri(), self.notation, &self.program.text);
        client.diagnostics(&self.uri(), 1);
        std::thread::sleep(Duration::from_millis(500));
        client
    }

    /// Measures `rounds` events of `client` and prints the row.
    fn events(
        &self,
        client: &mut Client,
        what: &str,
        target: &str,
        rounds: usize,
        mut event: impl FnMut(&mut Client, usize) -> Duration,
    ) {
        let name = self.name(what);
        if !self.table.wants(&name) {
            return;
        }
        let before = client.processor_time();
        let mut events = 0;
        let mut figures = Figures::of(rounds, |round| {
            events += 1;
            event(client, round)
        });
        let used = client.processor_time().zip(before).map(|(after, before)| after.saturating_sub(before));
        figures.processor = used.map(|used| used / events);
        self.table.row(&name, target, &figures);
    }

    fn open(&self) {
        let name = self.name("open to first diagnostics");
        if !self.table.wants(&name) {
            return;
        }
        let item =
            json!({"uri": self.uri(), "languageId": self.notation, "version": 1, "text": self.program.text});
        let message =
            json!({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": item}});
        let message = message.to_string();
        let mut used = Duration::ZERO;
        let mut events = 0;
        let mut figures = Figures::of(if self.lines > 10_000 { 15 } else { 20 }, |_| {
            let mut client = client();
            let before = client.processor_time();
            let started = Instant::now();
            client.send_raw(message.as_bytes());
            client.diagnostics(&self.uri(), 1);
            let elapsed = client.arrived - started;
            if let (Some(after), Some(before)) = (client.processor_time(), before) {
                used += after.saturating_sub(before);
            }
            events += 1;
            elapsed
        });
        figures.processor = Some(used / events);
        self.table.row(&name, if self.lines == 50_000 { "≤ 50 ms" } else { "" }, &figures);
    }

    fn keystrokes(&self, client: &mut Client) {
        let (line, column) = self.program.digit;
        let uri = self.uri();
        let target = if self.lines > 10_000 { "p95 ≤ 3 ms" } else { "p95 ≤ 1 ms" };
        self.events(client, "keystroke to diagnostics", target, 200, |client, round| {
            let version = round as i64 + 2;
            let digit = if round % 2 == 0 { "8" } else { "0" };
            let started = Instant::now();
            client.change(&uri, version, (line, column), (line, column + 1), digit);
            client.diagnostics(&uri, version);
            // A typist at 600 strokes a minute leaves a pause, in which the batch tier may run.
            std::thread::sleep(Duration::from_millis(if self.lines > 10_000 { 40 } else { 10 }));
            client.arrived - started
        });
    }

    fn requests(&self, client: &mut Client) {
        let (line, column) = self.program.digit;
        for (what, method) in [
            ("hover", "textDocument/hover"),
            ("definition", "textDocument/definition"),
            ("completion", "textDocument/completion"),
        ] {
            let place = at(&self.uri(), line, column);
            self.events(client, what, "p95 ≤ 1 ms", 200, |client, _| timed(client, method, place.clone()));
        }
    }

    fn tokens(&self, client: &mut Client) {
        let uri = self.uri();
        let document = json!({"uri": uri});
        let is_middle = self.lines == 5_000;
        let target = if is_middle { "≤ 2 ms" } else { "" };
        let full = "textDocument/semanticTokens/full";
        self.events(client, "semantic tokens, all", target, 40, |client, _| {
            timed(client, full, json!({"textDocument": document}))
        });
        let answer = client.request(full, json!({"textDocument": document}));
        let mut result = answer["result"]["resultId"].clone();
        let (line, column) = self.program.digit;
        self.events(client, "semantic tokens, difference", "≤ 1 ms", 100, |client, round| {
            let version = round as i64 + 1_000;
            let digit = if round % 2 == 0 { "12" } else { "1" };
            client.change(&uri, version, (line, column - 1), (line, column), digit);
            client.diagnostics(&uri, version);
            let started = Instant::now();
            let params = json!({"textDocument": document, "previousResultId": result});
            let answer = client.request("textDocument/semanticTokens/full/delta", params);
            assert!(answer["result"]["edits"].is_array(), "{answer}");
            result = answer["result"]["resultId"].clone();
            client.arrived - started
        });
        let range =
            json!({"start": {"line": line, "character": 0}, "end": {"line": line + 60, "character": 0}});
        self.events(client, "semantic tokens, 60 lines", "", 100, |client, _| {
            let params = json!({"textDocument": document, "range": range});
            timed(client, "textDocument/semanticTokens/range", params)
        });
    }

    /// From the cancellation of a long request to its answer.
    fn cancel(&self, client: &mut Client) {
        let document = json!({"textDocument": {"uri": self.uri()}});
        self.events(client, "cancel", "≤ 1 ms", 20, |client, _| {
            let id = client.ask("textDocument/documentSymbol", document.clone());
            let started = Instant::now();
            client.notify("$/cancelRequest", json!({"id": id}));
            client.answer(id);
            // What was cancelled may still run for a while; it is not part of the next round.
            let elapsed = client.arrived.saturating_duration_since(started);
            std::thread::sleep(Duration::from_millis(self.lines as u64 / 500));
            elapsed
        });
    }
}

fn timed(client: &mut Client, method: &str, params: Value) -> Duration {
    let started = Instant::now();
    let answer = client.request(method, params);
    assert!(answer.get("error").is_none(), "{answer}");
    client.arrived - started
}

/// From starting the process to the answer of `initialize`.
fn start(table: &Table) {
    let name = "start to initialize answered";
    if table.wants(name) {
        let figures = Figures::of(40, |_| {
            let started = Instant::now();
            let client = client();
            client.arrived - started
        });
        table.row(name, "≤ 30 ms", &figures);
    }
}
