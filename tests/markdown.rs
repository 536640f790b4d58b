//! Programs in the fences of Markdown documents, in an editor.

use crate::lsp_client::Client;
use proptest::prelude::*;
use rungwise::document::fences;
use serde_json::{Value, json};

const URI: &str = "file:///notes.md";
const NOTES: &str = "# Notes\n\n```ladder\n|  X0        Y0 |\n+--| |-------( )-+\n```\n\n| a | b |\n\n```il\nLD X8\nOUT Y1\nEND\n```\n";

fn open(client: &mut Client, text: &str) {
    let item = json!({"uri": URI, "languageId": "markdown", "version": 1, "text": text});
    client.notify("textDocument/didOpen", json!({"textDocument": item}));
}

fn at(line: u32, character: u32) -> Value {
    json!({"textDocument": {"uri": URI}, "position": {"line": line, "character": character}})
}

fn whole() -> Value {
    json!({"textDocument": {"uri": URI}, "options": {"tabSize": 4, "insertSpaces": true}})
}

/// The codes and lines of the last diagnostics that are published for the document, once they are `expected`.
fn await_diagnostics(client: &mut Client, version: Option<i64>, expected: &[(&str, u64)]) {
    client.wait_for("diagnostics", |message| {
        assert!(!message.to_string().contains(".fence-"), "{message}");
        let params = &message["params"];
        let other = params["version"].as_i64() != version || params["uri"] != URI;
        if message["method"] != "textDocument/publishDiagnostics" || other {
            return false;
        }
        let found: Vec<(String, u64)> = params["diagnostics"]
            .as_array()
            .unwrap()
            .iter()
            .map(|one| {
                (one["code"].as_str().unwrap().to_string(), one["range"]["start"]["line"].as_u64().unwrap())
            })
            .collect();
        found.iter().map(|(code, line)| (code.as_str(), *line)).eq(expected.iter().copied())
    });
}

#[test]
fn every_fence_is_a_document_at_its_place() {
    let mut client = Client::start();
    open(&mut client, NOTES);
    await_diagnostics(&mut client, Some(1), &[("octal-digit", 10)]);
    let hover = client.request("textDocument/hover", at(3, 3))["result"].clone();
    assert!(hover["contents"]["value"].as_str().unwrap().contains("X0"), "{hover}");
    assert_eq!(hover["range"]["start"], json!({"line": 3, "character": 3}));
    assert_eq!(client.request("textDocument/hover", at(7, 3))["result"], Value::Null);
    // A name in one fence is none in another.
    let references = client.request("textDocument/references", json!({
        "textDocument": {"uri": URI}, "position": {"line": 3, "character": 3}, "context": {"includeDeclaration": true}
    }))["result"].clone();
    assert_eq!(references.as_array().unwrap().len(), 1, "{references}");
    assert_eq!(references[0]["uri"], URI);
    let symbols = client.request("textDocument/documentSymbol", whole())["result"].clone();
    let lines: Vec<u64> = symbols
        .as_array()
        .unwrap()
        .iter()
        .map(|node| node["range"]["start"]["line"].as_u64().unwrap())
        .collect();
    assert_eq!(lines, [3, 10], "{symbols}");
}

#[test]
fn tokens_of_all_fences_are_one_list() {
    let mut client = Client::start();
    open(&mut client, NOTES);
    let data = client.request("textDocument/semanticTokens/full", whole())["result"]["data"].clone();
    let mut line = 0;
    let mut lines = Vec::new();
    for token in data.as_array().unwrap().chunks(5) {
        line += token[0].as_u64().unwrap();
        lines.push(line);
    }
    lines.dedup();
    assert_eq!(lines, [3, 4, 10, 11, 12], "{data}");
}

#[test]
fn formatting_leaves_the_text_around_alone() {
    let mut client = Client::start();
    open(&mut client, NOTES);
    let edits = client.request("textDocument/formatting", whole())["result"].clone();
    let edits = edits.as_array().unwrap();
    assert!(!edits.is_empty());
    for edit in edits {
        let line = edit["range"]["start"]["line"].as_u64().unwrap();
        assert!((3..=5).contains(&line) || (10..=13).contains(&line), "{edit}");
    }
}

#[test]
fn fences_come_and_go_as_one_types() {
    let mut client = Client::start();
    open(&mut client, NOTES);
    await_diagnostics(&mut client, Some(1), &[("octal-digit", 10)]);
    let mut version = 1;
    let mut change = |client: &mut Client, start: (u32, u32), end: (u32, u32), text: &str| {
        version += 1;
        let place = |(line, character): (u32, u32)| json!({"line": line, "character": character});
        client.notify(
            "textDocument/didChange",
            json!({
                "textDocument": {"uri": URI, "version": version},
                "contentChanges": [{"range": {"start": place(start), "end": place(end)}, "text": text}]
            }),
        );
    };
    change(&mut client, (1, 0), (1, 0), "Some words.\n\n");
    await_diagnostics(&mut client, Some(2), &[("octal-digit", 12)]);
    change(&mut client, (12, 4), (12, 5), "1");
    await_diagnostics(&mut client, Some(3), &[]);
    // The first fence is opened no more, so that the second one becomes prose and the rest a fence.
    change(&mut client, (4, 0), (4, 9), "```c");
    change(&mut client, (12, 4), (12, 5), "9");
    await_diagnostics(&mut client, Some(5), &[("octal-digit", 12)]);
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": URI}}));
    await_diagnostics(&mut client, None, &[]);
    assert_eq!(client.request("textDocument/hover", at(12, 1))["result"], Value::Null);
}

#[test]
fn fixes_and_renames_name_the_document() {
    let mut client = Client::start();
    open(&mut client, NOTES);
    await_diagnostics(&mut client, Some(1), &[("octal-digit", 10)]);
    let range = json!({"start": {"line": 10, "character": 3}, "end": {"line": 10, "character": 3}});
    let params = json!({"textDocument": {"uri": URI}, "range": range, "context": {"diagnostics": []}});
    let actions = client.request("textDocument/codeAction", params)["result"].clone();
    assert!(!actions.to_string().contains(".fence-"), "{actions}");
    assert!(actions.to_string().contains(URI), "{actions}");
    let answer = client.request(
        "textDocument/rename",
        json!({
            "textDocument": {"uri": URI}, "position": {"line": 3, "character": 3}, "newName": "X1"
        }),
    );
    assert!(
        answer["result"].to_string().contains(URI) && !answer.to_string().contains(".fence-"),
        "{answer}"
    );
}

#[test]
fn what_opens_and_closes_a_fence() {
    let programs = |text: &str| -> Vec<(bool, usize, String)> {
        let of = |fence: rungwise::document::Fence| {
            (fence.is_ladder, fence.lines_before, text[fence.content.clone()].to_string())
        };
        fences(text).into_iter().map(of).collect()
    };
    for (text, expected) in [
        ("```ladder\na\n```\n", vec![(true, 1, "a\n")]),
        ("```lad\na\n```\n", vec![(true, 1, "a\n")]),
        ("```il\na\n```\n", vec![(false, 1, "a\n")]),
        ("```plc-il title=x\na\n```\n", vec![(false, 1, "a\n")]),
        ("``` IL\na\n```\n", vec![(false, 1, "a\n")]),
        ("~~~~ladder\n~~~\n```\n~~~~~\n", vec![(true, 1, "~~~\n```\n")]),
        ("```c\n```ladder\n```\n", vec![]),
        ("````ladder\na\n```\n````\n", vec![(true, 1, "a\n```\n")]),
        ("```ladder\nopen", vec![(true, 1, "open")]),
        ("x\n\n  ```il\n  a\n  ```\n", vec![(false, 3, "  a\n")]),
        ("`ladder`\n``ladder\n", vec![]),
        ("```ladder\n```\n```il\n```", vec![(true, 1, ""), (false, 3, "")]),
        ("```ladder `x\na\n", vec![]),
    ] {
        let expected: Vec<_> =
            expected.into_iter().map(|(ladder, line, text)| (ladder, line, text.to_string())).collect();
        assert_eq!(programs(text), expected, "{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn fences_keep_lines_and_columns(text in "(```|~~~|(```|~~~|  ```)(ladder|il)(\n|\r\n)|\n|\r\n| |x|é){4,40}") {
        let found = fences(&text);
        // Were none of them found, too many cases would be refused.
        prop_assume!(!found.is_empty());
        for fence in found {
            let isolated = fence.isolated(&text);
            let lines = |text: &str| text.split('\n').map(str::to_string).collect::<Vec<_>>();
            let (all, own) = (lines(&text), lines(&isolated));
            let last = fence.lines_before + fence.lines;
            prop_assert!(own.len() > fence.lines_before && own.len() >= last, "{:?}", isolated);
            for line in fence.lines_before..last {
                prop_assert_eq!(&all[line], &own[line]);
            }
        }
    }
}
