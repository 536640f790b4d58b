//! Features about devices and one document through the server: comments file, signatures, marks, lenses, usage.

use crate::lsp_client::{Client, at};
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

const TABLE: &str = "X0,Start,green button\nY0,Motor,contactor\n";
const MAIN: &str = "LD Start\nOUT Y0\nLD Y0\nMOV K1 D0\nEND\n";

fn uri_of(path: &Path) -> String {
    format!("file://{}", path.canonicalize().unwrap().display())
}

/// A project with a table and one program, and a client that has the program open.
fn project(options: Value) -> (TempDir, Client, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        uri_of(&path)
    };
    write("rungwise.toml", "target = \"fx2n\"\ncomments = \"devices.csv\"\n");
    let table = write("devices.csv", TABLE);
    let main = write("main.il", MAIN);
    let capabilities = json!({"general": {"positionEncodings": ["utf-16"]},
        "workspace": {"didChangeWatchedFiles": {"dynamicRegistration": true},
            "workspaceEdit": {"documentChanges": true}}});
    let mut client = Client::start_with(capabilities, options);
    client.open(&main, "plc-il", MAIN);
    (folder, client, main, table)
}

/// Asks again until the answer is as wanted: projects are read in the background.
fn until(client: &mut Client, method: &str, params: &Value, wanted: impl Fn(&Value) -> bool) -> Value {
    let mut answer = Value::Null;
    for _ in 0..200 {
        answer = client.request(method, params.clone())["result"].clone();
        if wanted(&answer) {
            return answer;
        }
        std::thread::sleep(std::time::Duration::from_millis(25));
    }
    panic!("{method} stays at {answer}");
}

fn hover_text(answer: &Value) -> &str {
    answer["contents"]["value"].as_str().unwrap_or("")
}

fn published(client: &mut Client, uri: &str, wanted: impl Fn(&[Value]) -> bool) -> Vec<Value> {
    let message = client.wait_for("diagnostics", |message| {
        message["method"] == "textDocument/publishDiagnostics"
            && message["params"]["uri"] == uri
            && wanted(message["params"]["diagnostics"].as_array().unwrap())
    });
    message["params"]["diagnostics"].as_array().unwrap().clone()
}

#[test]
fn the_table_is_known_and_followed() {
    let (folder, mut client, main, table) = project(Value::Null);
    let here = at(&main, 0, 4);
    let answer = until(&mut client, "textDocument/hover", &here, |answer| hover_text(answer).contains("X0"));
    assert!(hover_text(&answer).contains("green button"), "{answer}");
    assert!(hover_text(&answer).contains("#L1)"), "a link to the line: {answer}");
    // The file changes on the disk.
    std::fs::write(folder.path().join("devices.csv"), "X5,Start,red button\nX5,Twice,\n").unwrap();
    let change = json!({"changes": [{"uri": table, "type": 2}]});
    client.notify("workspace/didChangeWatchedFiles", change);
    let found = published(&mut client, &table, |found| !found.is_empty());
    assert_eq!(found[0]["code"], "device-comments");
    assert_eq!(found[0]["range"]["start"], json!({"line": 1, "character": 0}));
    until(&mut client, "textDocument/hover", &here, |answer| hover_text(answer).contains("red button"));
    // The editor's text wins over the disk.
    client.open(&table, "csv", "X0,Start,from the editor\n");
    published(&mut client, &table, <[Value]>::is_empty);
    until(&mut client, "textDocument/hover", &here, |answer| hover_text(answer).contains("from the editor"));
    client.change(&table, 2, (0, 9), (0, 24), "typed now");
    until(&mut client, "textDocument/hover", &here, |answer| hover_text(answer).contains("typed now"));
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": table}}));
    until(&mut client, "textDocument/hover", &here, |answer| hover_text(answer).contains("red button"));
}

#[test]
fn a_symbol_is_no_mistake_and_proposed() {
    let (_folder, mut client, main, _) = project(Value::Null);
    let found =
        published(&mut client, &main, |found| found.iter().all(|one| one["code"] != "unknown-device"));
    assert!(found.iter().all(|one| one["severity"] != 1), "{found:?}");
    let params = at(&main, 2, 3);
    let answer = until(&mut client, "textDocument/completion", &params, |answer| {
        answer.as_array().unwrap().iter().any(|item| item["label"] == "Motor")
    });
    let items = answer.as_array().unwrap();
    let motor = items.iter().find(|item| item["label"] == "Y0").unwrap();
    assert!(motor["filterText"].as_str().unwrap().contains("contactor"), "{motor}");
}

#[test]
fn a_renamed_symbol_changes_program_and_table() {
    let (_folder, mut client, main, table) = project(Value::Null);
    until(&mut client, "textDocument/hover", &at(&main, 0, 4), |answer| hover_text(answer).contains("X0"));
    let mut params = at(&main, 0, 4);
    params["newName"] = json!("Begin");
    let edit = client.request("textDocument/rename", params.clone())["result"].clone();
    let changes = edit["documentChanges"].as_array().unwrap();
    assert_eq!(changes.len(), 2, "{edit}");
    assert_eq!(changes[0]["textDocument"], json!({"uri": main, "version": 1}));
    assert_eq!(changes[0]["edits"][0]["newText"], "Begin");
    assert_eq!(changes[1]["textDocument"], json!({"uri": table, "version": null}));
    let range = json!({"start": {"line": 0, "character": 3}, "end": {"line": 0, "character": 8}});
    assert_eq!(changes[1]["edits"][0], json!({"range": range, "newText": "Begin"}));
    params["newName"] = json!("OUT");
    let refused = client.request("textDocument/rename", params);
    assert!(refused["error"]["message"].as_str().unwrap().contains("instruction"), "{refused}");
    // A renamed device takes its line of the table along.
    let mut params = at(&main, 1, 4);
    params["newName"] = json!("Y7");
    let edit = client.request("textDocument/rename", params)["result"].clone();
    let changes = edit["documentChanges"].as_array().unwrap();
    assert_eq!(
        (&changes[1]["textDocument"]["uri"], &changes[1]["edits"][0]["newText"]),
        (&json!(table), &json!("Y7"))
    );
    // The action writes the symbol.
    let range = json!({"start": {"line": 1, "character": 4}, "end": {"line": 1, "character": 4}});
    let params = json!({"textDocument": {"uri": main}, "range": range, "context": {"diagnostics": []}});
    let actions = client.request("textDocument/codeAction", params)["result"].clone();
    let titles: Vec<&str> =
        actions.as_array().unwrap().iter().map(|one| one["title"].as_str().unwrap()).collect();
    assert!(titles.contains(&"Write Motor for Y0 in the whole file"), "{titles:?}");
}

#[test]
fn signatures_marks_lenses_and_ranges() {
    let (_folder, mut client, main, _) = project(Value::Null);
    let offered = &client.initialised["capabilities"];
    for name in [
        "signatureHelpProvider",
        "documentHighlightProvider",
        "codeLensProvider",
        "documentRangeFormattingProvider",
    ] {
        assert!(!offered[name].is_null(), "{name}");
    }
    let help = client.request("textDocument/signatureHelp", at(&main, 3, 7))["result"].clone();
    let signature = &help["signatures"][0];
    assert_eq!((&signature["label"], &help["activeParameter"]), (&json!("MOV S D"), &json!(1)));
    assert_eq!(signature["parameters"][1]["label"], json!([6, 7]));
    let marks = client.request("textDocument/documentHighlight", at(&main, 1, 5))["result"].clone();
    let kinds: Vec<i64> = marks.as_array().unwrap().iter().map(|one| one["kind"].as_i64().unwrap()).collect();
    assert_eq!(kinds, [3, 2], "written, then read");
    let lenses =
        client.request("textDocument/codeLens", json!({"textDocument": {"uri": main}}))["result"].clone();
    let lenses = lenses.as_array().unwrap();
    assert!(lenses.iter().all(|lens| lens["command"].is_null()), "they are resolved one by one");
    let titles: Vec<String> = lenses
        .iter()
        .map(|lens| {
            let resolved = client.request("codeLens/resolve", lens.clone())["result"].clone();
            let does =
                if resolved["command"]["title"] == "Simulate" { "rungwise.simulate.start" } else { "" };
            assert_eq!(resolved["command"]["command"], does, "plain text");
            resolved["command"]["title"].as_str().unwrap().to_string()
        })
        .collect();
    assert!(titles.contains(&"2 steps".to_string()), "{titles:?}");
    assert!(
        titles.iter().any(|title| title.starts_with("Y0") && title.ends_with("1 reference")),
        "{titles:?}"
    );
    client.change(&main, 2, (2, 0), (2, 2), "ld");
    client.change(&main, 3, (0, 0), (0, 2), "ld");
    let options = json!({"tabSize": 4, "insertSpaces": true});
    let range = json!({"start": {"line": 2, "character": 0}, "end": {"line": 2, "character": 1}});
    let params = json!({"textDocument": {"uri": main}, "range": range, "options": options});
    let edits = client.request("textDocument/rangeFormatting", params)["result"].clone();
    assert_eq!(edits.as_array().unwrap().len(), 1, "{edits}");
    assert_eq!(edits[0]["range"]["start"]["line"], 2);
    let all = json!({"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 1}});
    let params = json!({"textDocument": {"uri": main}, "ranges": [range, all], "options": options});
    let edits = client.request("textDocument/rangesFormatting", params)["result"].clone();
    assert_eq!(edits.as_array().unwrap().len(), 2, "{edits}");
}

#[test]
fn lenses_and_comment_hints_are_switched_off() {
    let options = json!({"codeLens": {"steps": false, "references": false, "nextFree": false, "run": false},
        "inlayHints": {"comments": false}});
    let (_folder, mut client, main, _) = project(options);
    until(&mut client, "textDocument/hover", &at(&main, 0, 4), |answer| hover_text(answer).contains("X0"));
    let document = json!({"textDocument": {"uri": main}});
    assert_eq!(client.request("textDocument/codeLens", document)["result"], json!([]));
    let range = json!({"start": {"line": 0, "character": 0}, "end": {"line": 9, "character": 0}});
    let params = json!({"textDocument": {"uri": main}, "range": range});
    assert_eq!(client.request("textDocument/inlayHint", params.clone())["result"], json!([]));
    client.notify("workspace/didChangeConfiguration", json!({"settings": {"rungwise": {}}}));
    until(&mut client, "textDocument/inlayHint", &params, |hints| {
        hints.as_array().unwrap().iter().any(|hint| hint["label"] == "X0 green button")
    });
}

#[test]
fn the_list_of_used_devices_as_command_and_as_document() {
    let (_folder, mut client, main, _) = project(Value::Null);
    until(&mut client, "textDocument/hover", &at(&main, 0, 4), |answer| hover_text(answer).contains("X0"));
    let params = json!({"command": "rungwise.usage", "arguments": [main]});
    let answer = client.request("workspace/executeCommand", params)["result"].clone();
    let names: Vec<&str> =
        answer["devices"].as_array().unwrap().iter().map(|one| one["device"].as_str().unwrap()).collect();
    assert_eq!(names, ["X0", "Y0", "D0"]);
    assert_eq!(answer["devices"][0]["uses"][0]["uri"], json!(main));
    let page = answer["text"].as_str().unwrap();
    assert!(page.contains("Start: green button"), "{page}");
    let virtual_uri = main.replacen("file:", "rungwise-usage:", 1);
    let content =
        client.request("workspace/textDocumentContent", json!({"uri": virtual_uri}))["result"].clone();
    assert_eq!(content["text"], json!(page));
}

#[test]
fn newer_clients_are_offered_what_they_take() {
    let capabilities = json!({
        "textDocument": {"rangeFormatting": {"dynamicRegistration": true, "rangesSupport": true}},
        "workspace": {"textDocumentContent": {"dynamicRegistration": true}},
    });
    let mut client = Client::start_with(capabilities, Value::Null);
    assert!(client.initialised["capabilities"]["documentRangeFormattingProvider"].is_null());
    let message = client.wait_for_method("client/registerCapability");
    let methods: Vec<&str> = message["params"]["registrations"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["method"].as_str().unwrap())
        .collect();
    assert_eq!(methods, ["workspace/textDocumentContent", "textDocument/rangeFormatting"]);
}
