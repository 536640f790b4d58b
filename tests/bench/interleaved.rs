//! Edits and hovers without waiting: every answer must be about the text of the moment at which it was asked for.

use super::figures::{Figures, Table};
use super::lsp_client::at;
use super::programs;
use serde_json::json;
use std::time::Instant;

const PAIRS: usize = 2_000;

/// Sends 2,000 edits, a hover behind each, and counts the answers about another text than the one before them and the
/// diagnostics that come after those of a newer version.
pub fn measure(table: &Table) {
    let name = "4,000 interleaved edits and hovers, lad, 5000 lines";
    if !table.wants(name) {
        return;
    }
    let program = programs::program("lad", 5_000);
    let uri = "file:///bench/interleaved.lad";
    let mut client = super::client();
    client.open(uri, "ladder", &program.text);
    client.diagnostics(uri, 1);
    let (line, column) = program.digit;
    let mut stale = 0;
    // The place is that of `X10`, whose digits become 1, 2 … 7 in turn; it stays as long as it is.
    let digit = |pair: usize| pair % 7 + 1;
    let mut version = 1;
    let figures = Figures::of(PAIRS / 100 - 2, |_| {
        let started = Instant::now();
        let asked: Vec<(i64, usize)> = (0..100)
            .map(|_| {
                version += 1;
                let digit = digit(version as usize);
                client.change(uri, version, (line, column), (line, column + 1), &digit.to_string());
                (client.ask("textDocument/hover", at(uri, line, column)), digit)
            })
            .collect();
        for (id, digit) in asked {
            let answer = client.answer(id);
            let text = answer["result"]["contents"]["value"].as_str().unwrap_or("");
            stale += usize::from(!text.contains(&format!("X1{digit}")));
        }
        client.diagnostics(uri, version);
        started.elapsed()
    });
    let mut newest = 0;
    let unordered = client.notified("textDocument/publishDiagnostics").iter().filter(|message| {
        let version = message["params"]["version"].as_i64().unwrap_or(0);
        let is_older = version < newest;
        newest = newest.max(version);
        is_older
    });
    stale += unordered.count();
    table.row(&format!("{name}, 100 pairs at a time"), "", &figures);
    let pairs = (version - 1) as usize;
    table.value(name, "0 stale", &format!("{stale} stale of {}", json!(pairs * 2)));
}
