//! Semantic tokens over the wire: the difference to what was sent before, and those of a range.

use crate::lsp_client::Client;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use rungwise::ide;
use rungwise::project::{Manifest, open_document};
use serde_json::{Value, json};
use std::cell::{Cell, RefCell};

/// `[line, column, length, type, modifiers]`, absolute.
type Token = [u64; 5];

fn numbers(value: &Value) -> Vec<u64> {
    value.as_array().expect("an array").iter().map(|number| number.as_u64().expect("a number")).collect()
}

/// The tokens that relative `data` stands for.
fn absolute(data: &[u64]) -> Vec<Token> {
    let (mut line, mut column) = (0, 0);
    let place = |token: &[u64]| {
        column = if token[0] == 0 { column + token[1] } else { token[1] };
        line += token[0];
        [line, column, token[2], token[3], token[4]]
    };
    data.chunks_exact(5).map(place).collect()
}

fn full(client: &mut Client, uri: &str) -> (String, Vec<u64>) {
    let answer = client.request("textDocument/semanticTokens/full", json!({"textDocument": {"uri": uri}}));
    let id = answer["result"]["resultId"].as_str().expect("a name of the result").to_string();
    (id, numbers(&answer["result"]["data"]))
}

fn delta(client: &mut Client, uri: &str, previous: &str) -> Value {
    let params = json!({"textDocument": {"uri": uri}, "previousResultId": previous});
    client.request("textDocument/semanticTokens/full/delta", params)["result"].clone()
}

/// `data` after `edits`, which all count in the data as it was.
fn applied(mut data: Vec<u64>, edits: &Value) -> Vec<u64> {
    let mut edits = edits.as_array().expect("edits").clone();
    edits.sort_by_key(|edit| std::cmp::Reverse(edit["start"].as_u64()));
    for edit in edits {
        let start = edit["start"].as_u64().expect("a start") as usize;
        let count = edit["deleteCount"].as_u64().expect("a count") as usize;
        let new = edit.get("data").filter(|data| !data.is_null()).map_or(Vec::new(), numbers);
        data.splice(start..start + count, new);
    }
    data
}

/// What `ide` says of the same text, for lines of plain ASCII.
fn expected(name: &str, text: &str) -> Vec<Token> {
    let document = open_document(name, text, &Manifest::default(), None, None);
    let tokens = ide::semantic_tokens(&document).into_iter().map(|token| {
        let head = &text[..token.span.start as usize];
        let line = head.matches('\n').count() as u64;
        let column = head.len() - head.rfind('\n').map_or(0, |newline| newline + 1);
        let modifiers = u64::from(token.modification);
        [line, column as u64, token.span.len() as u64, token.kind as u64, modifiers]
    });
    tokens.collect()
}

fn list(rungs: usize) -> String {
    (0..rungs).map(|n| format!("// {n}\nLD X{:o}\nOR M{n}\nOUT M{n}\n", n % 64)).collect::<String>() + "END\n"
}

fn ladder(rungs: usize) -> String {
    (0..rungs).map(|n| format!("|  X{:<3o}     Y0  |\n+--| |------( )-+\n\n", n % 64)).collect()
}

#[test]
fn the_tokens_of_several_pages_are_those_of_the_whole_text() {
    let mut client = Client::start();
    for (name, language, text) in [("a.il", "plc-il", list(300)), ("b.lad", "ladder", ladder(300))] {
        let uri = format!("file:///{name}");
        client.open(&uri, language, &text);
        let (_, data) = full(&mut client, &uri);
        assert_eq!(absolute(&data), expected(name, &text));
    }
}

#[test]
fn a_keystroke_changes_a_few_numbers_of_a_long_result() {
    let mut client = Client::start();
    let uri = "file:///long.il";
    client.open(uri, "plc-il", &list(1000));
    let (id, data) = full(&mut client, uri);
    client.change(uri, 2, (2001, 4), (2001, 5), "77");
    let result = delta(&mut client, uri, &id);
    let edits = result["edits"].as_array().expect("a difference");
    assert_eq!(edits.len(), 1);
    assert!(numbers(&edits[0]["data"]).len() <= 10, "{edits:?}");
    let (_, whole) = full(&mut client, uri);
    assert_ne!(whole, data);
    assert_eq!(applied(data, &result["edits"]), whole);
}

#[test]
fn nothing_changed_is_no_edit_and_an_unknown_result_is_answered_with_all_tokens() {
    let mut client = Client::start();
    let uri = "file:///same.il";
    client.open(uri, "plc-il", &list(10));
    let (id, data) = full(&mut client, uri);
    let same = delta(&mut client, uri, &id);
    assert_eq!(same["edits"], json!([]));
    let next = same["resultId"].as_str().expect("a name").to_string();
    assert_eq!(delta(&mut client, uri, &next)["edits"], json!([]), "the answer's own name is known");
    assert_eq!(numbers(&delta(&mut client, uri, "never sent")["data"]), data);
    // Only the last result is kept.
    assert_eq!(numbers(&delta(&mut client, uri, &id)["data"]), data);
}

#[test]
fn a_closed_document_is_forgotten() {
    let mut client = Client::start();
    let uri = "file:///closed.il";
    client.open(uri, "plc-il", &list(10));
    let (id, data) = full(&mut client, uri);
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
    client.open(uri, "plc-il", &list(10));
    assert_eq!(numbers(&delta(&mut client, uri, &id)["data"]), data);
}

#[test]
fn the_tokens_of_a_range_are_those_that_touch_it() {
    let mut client = Client::start();
    let uri = "file:///range.il";
    client.open(uri, "plc-il", &list(500));
    let (_, data) = full(&mut client, uri);
    // From behind the mnemonic of a line to behind that of a later one.
    let range = json!({"start": {"line": 801, "character": 2}, "end": {"line": 1210, "character": 2}});
    let params = json!({"textDocument": {"uri": uri}, "range": range});
    let answer = client.request("textDocument/semanticTokens/range", params);
    let wanted = |token: &Token| {
        let (start, end) = ((token[0], token[1]), (token[0], token[1] + token[2]));
        start < (1210, 2) && (801, 2) < end
    };
    let expected: Vec<Token> = absolute(&data).into_iter().filter(wanted).collect();
    assert!(expected.len() > 700, "{}", expected.len());
    assert_eq!(absolute(&numbers(&answer["result"]["data"])), expected);
}

/// Pieces that move what follows: lines more and less, comments that open and close, wide characters.
const PIECES: &[&str] =
    &["", "\n", "\r\n", "\r", "X1", "(*", "*)", "// 电机\n", "LD X0\nOUT Y7\n", "END", " ", "\n\n\n", "😀"];

#[test]
fn differences_one_after_another_lead_to_the_tokens_of_the_whole() {
    let edit = || (0..1000u32, 0..12u32, 0..3u32, 0..PIECES.len());
    let samples = [("list.il", "plc-il", list(260)), ("drawing.lad", "ladder", ladder(260))];
    let client = RefCell::new(Client::start());
    let (number, differences) = (Cell::new(0), Cell::new(0));
    let config = Config { cases: 24, failure_persistence: None, ..Config::default() };
    let edits = (0..samples.len(), prop::collection::vec(edit(), 1..8));
    let run = TestRunner::new(config).run(&edits, |(sample, edits)| {
        let (name, language, text) = &samples[sample];
        let client = &mut *client.borrow_mut();
        number.set(number.get() + 1);
        let uri = format!("file:///{}/{name}", number.get());
        client.open(&uri, language, text);
        let (mut id, mut data) = full(client, &uri);
        let lines = text.matches('\n').count() as u32;
        for (version, (line, column, removed, piece)) in edits.into_iter().enumerate() {
            let line = lines * line / 1000;
            let to = if removed == 2 { (line + 2, 0) } else { (line, column + removed) };
            client.change(&uri, version as i64 + 2, (line, column), to, PIECES[piece]);
            let result = delta(client, &uri, &id);
            data = match result.get("edits") {
                Some(edits) => {
                    differences.set(differences.get() + 1);
                    applied(data, edits)
                }
                None => numbers(&result["data"]),
            };
            // All tokens by way of a range, which leaves what was sent for differences alone.
            let params = json!({"textDocument": {"uri": uri}, "range": {
                "start": {"line": 0, "character": 0}, "end": {"line": 100_000, "character": 0}}});
            let whole = client.request("textDocument/semanticTokens/range", params);
            prop_assert_eq!(&data, &numbers(&whole["result"]["data"]));
            id = result["resultId"].as_str().expect("a name").to_string();
        }
        client.notify("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
        Ok(())
    });
    run.expect("differences that lead to the whole");
    assert!(differences.get() > 20, "{}", differences.get());
}
