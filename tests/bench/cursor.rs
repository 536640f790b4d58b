//! What an editor asks whenever the cursor moves: code actions, the forms of the rung, a hover.

use super::figures::{Figures, Table};
use super::lsp_client::{Client, at};
use super::programs;
use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::translate::{Options, To, translate};
use serde_json::{Value, json};
use std::time::Instant;

pub fn measure(table: &Table) {
    let list = programs::rungs(10_000);
    let document = Document::new(&list, Notation::FxIl, Target::of(Model::Fx3u));
    let drawing = translate(&document, None, To::Ladder, &Options { proves: false, ..Options::default() });
    rows(table, "10000 rungs, ladder", ("lad", "ladder"), &drawing.text);
    rows(table, "10000 rungs, FX list", ("il", "plc-il"), &list);
    rows(table, "10000 rungs, IEC list", ("il", "plc-il"), &programs::iec_unit(10_000));
    rows(table, "5000 lines, IEC list", ("il", "plc-il"), &programs::iec(5_000));
}

fn rows(table: &Table, name: &str, (ending, language): (&str, &str), text: &str) {
    let of = |what: &str| format!("{name}, {what} at a cursor that moves");
    let (actions, forms, hover) = (of("code actions"), of("four forms"), of("hover"));
    if ![&actions, &forms, &hover].iter().any(|name| table.wants(name)) {
        return;
    }
    let uri = format!("file:///bench/cursor.{ending}");
    let mut client = client();
    client.open(&uri, language, text);
    client.diagnostics(&uri, 1);
    std::thread::sleep(std::time::Duration::from_millis(500));
    let lines: Vec<&str> = text.lines().collect();
    // Names stand somewhere in each part of the file.
    let places: Vec<(u32, u32)> = (0..200)
        .filter_map(|round| {
            let first = lines.len() * (round * 7 % 200) / 200;
            let names = |line: &&str| line.contains("M") || line.contains("X") || line.contains("Relay");
            let line = (first..lines.len()).find(|number| names(&lines[*number]))?;
            let column = lines[line].find(['M', 'X', 'R'])?;
            Some((line as u32, column as u32))
        })
        .collect();
    let mut row = |name: &str, target: &str, ask: &dyn Fn(&mut Client, u32, u32)| {
        if table.wants(name) {
            let figures = Figures::of(100, |round| {
                let (line, column) = places[round % places.len()];
                let started = Instant::now();
                ask(&mut client, line, column);
                client.arrived - started
            });
            table.row(name, target, &figures);
        }
    };
    row(&actions, "p95 ≤ 5 ms", &|client, line, column| {
        let place = json!({"line": line, "character": column});
        let params = json!({
            "textDocument": {"uri": uri},
            "range": {"start": place, "end": place},
            "context": {"diagnostics": []},
        });
        answered(client.request("textDocument/codeAction", params));
    });
    row(&forms, "p95 ≤ 5 ms", &|client, line, column| {
        let place = json!({"line": line, "character": column});
        let asked = json!({"uri": uri, "position": place, "to": "all"});
        let params = json!({"command": "rungwise.translate", "arguments": [asked]});
        answered(client.request("workspace/executeCommand", params));
    });
    row(&hover, "p95 ≤ 5 ms", &|client, line, column| {
        client.request("textDocument/hover", at(&uri, line, column));
    });
}

fn answered(answer: Value) {
    assert!(!answer["result"].is_null(), "{answer}");
}

/// A client that can do all that code actions may ask of it.
fn client() -> Client {
    let mut client = Client::spawn_program(&super::server(), &[]);
    let commands = ["rungwise.openTranslation", "rungwise.copyTranslation"];
    let kinds = json!({"codeActionKind": {"valueSet": ["quickfix", "refactor"]}});
    let capabilities = json!({
        "textDocument": {"codeAction": {
            "codeActionLiteralSupport": kinds,
            "dataSupport": true,
            "resolveSupport": {"properties": ["edit"]},
        }},
        "experimental": {"commands": {"commands": commands}},
    });
    client.initialise(capabilities, json!({"target": "fx3u"}));
    client
}
