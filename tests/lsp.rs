//! The language server as an editor meets it: life cycle, order, cancellation, and every feature once.

use crate::lsp_client::{Client, at, codes};
use serde_json::{Value, json};
use std::time::Duration;

const URI: &str = "file:///somewhere/a.il";
const PROGRAM: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nLD Y0\nOUT T0 K50\nEND\n";

fn opened(text: &str) -> Client {
    let mut client = Client::start();
    client.open(URI, "plc-il", text);
    client
}

// Life cycle

#[test]
fn requests_before_initialize_are_refused() {
    let mut client = Client::spawn();
    let answer = client.request("textDocument/hover", at(URI, 0, 0));
    assert_eq!(answer["error"]["code"], json!(-32002), "{answer}");
}

#[test]
fn a_second_initialize_is_refused() {
    let mut client = Client::start();
    let answer = client.request("initialize", json!({"processId": null, "capabilities": {}}));
    assert_eq!(answer["error"]["code"], json!(-32600), "{answer}");
    client.open(URI, "plc-il", PROGRAM);
    assert_eq!(codes(&client.diagnostics(URI, 1)), ["written-never-read"], "the server lives on");
}

#[test]
fn exit_after_shutdown_is_success_even_with_the_input_open() {
    let mut client = Client::start();
    let answer = client.request("shutdown", Value::Null);
    assert_eq!(answer["result"], Value::Null);
    assert!(answer.get("error").is_none(), "{answer}");
    let late = client.request("textDocument/hover", at(URI, 0, 0));
    assert_eq!(late["error"]["code"], json!(-32600), "{late}");
    client.notify("exit", Value::Null);
    assert_eq!(client.exit_status().code(), Some(0));
}

#[test]
fn exit_without_shutdown_is_failure() {
    let mut client = Client::start();
    client.notify("exit", Value::Null);
    assert_eq!(client.exit_status().code(), Some(1));
}

#[test]
fn a_client_that_dies_ends_the_server() {
    let mut client = opened(PROGRAM);
    client.hang_up();
    assert_eq!(client.exit_status().code(), Some(1));
}

#[test]
fn unknown_requests_and_garbage_do_not_end_the_server() {
    let mut client = opened(PROGRAM);
    let answer = client.request("rungwise/unheardOf", json!({}));
    assert_eq!(answer["error"]["code"], json!(-32601), "{answer}");
    client.send_raw(b"{\"jsonrpc\":");
    client.send_raw(b"\xff\xfe\x00");
    client.notify("$/unheardOf", json!({}));
    client.notify("textDocument/didChange", json!({"wrong": true}));
    client.change("file:///never/opened.il", 2, (0, 0), (0, 0), "x");
    let answer = client.request("textDocument/hover", json!({"wrong": true}));
    assert_eq!(answer["error"]["code"], json!(-32602), "{answer}");
    assert!(client.request("textDocument/hover", at(URI, 0, 0))["result"].is_object());
}

#[test]
fn positions_are_counted_as_the_client_counts() {
    for (offered, chosen, column) in [
        (json!(["utf-8", "utf-16"]), "utf-8", 18),
        (json!(["utf-16"]), "utf-16", 14),
        (json!(["utf-32"]), "utf-32", 14),
        (Value::Null, "utf-16", 14),
    ] {
        let capabilities = match offered {
            Value::Null => json!({}),
            offered => json!({"general": {"positionEncodings": offered}}),
        };
        let mut client = Client::start_with(capabilities, Value::Null);
        assert_eq!(client.initialised["capabilities"]["positionEncoding"], json!(chosen));
        client.open(URI, "plc-il", "(* 电机 *) LD X8\nOUT Y0\nEND\n");
        let diagnostics = client.diagnostics(URI, 1);
        assert_eq!(codes(&diagnostics), ["octal-digit"]);
        assert_eq!(diagnostics[0]["range"]["start"]["character"], json!(column - 2), "{chosen}");
    }
}

#[test]
fn notifications_before_initialize_and_after_shutdown_change_nothing() {
    let mut client = Client::spawn();
    client.open(URI, "plc-il", "LD X8\nOUT Y0\nEND\n");
    let published = |message: &Value| message["method"] == json!("textDocument/publishDiagnostics");
    client.request("initialize", json!({"processId": null, "capabilities": {}}));
    client.notify("initialized", json!({}));
    assert_eq!(client.request("textDocument/hover", at(URI, 0, 0))["result"], Value::Null);
    client.request("shutdown", Value::Null);
    client.open(URI, "plc-il", "LD X8\nOUT Y0\nEND\n");
    assert!(client.stays_silent(Duration::from_millis(300), published));
    assert_eq!(client.request("shutdown", Value::Null)["error"]["code"], json!(-32600), "a second shutdown");
    client.notify("exit", Value::Null);
    assert_eq!(client.exit_status().code(), Some(0));
}

#[test]
fn a_client_that_hangs_up_still_gets_the_answers_it_asked_for() {
    let mut client = opened(&"LD X0\nOUT M5\n".repeat(5_000));
    let document = json!({"textDocument": {"uri": URI}});
    let asked: Vec<i64> =
        (0..5).map(|_| client.ask("textDocument/semanticTokens/full", document.clone())).collect();
    client.hang_up();
    asked.into_iter().for_each(|id| assert!(client.answer(id)["result"].is_object()));
    assert_eq!(client.exit_status().code(), Some(1));
}

// Order

#[test]
fn four_thousand_edits_and_hovers_without_a_stale_answer() {
    let mut client = opened("LD K0\nOUT Y0\nEND\n");
    let rounds = 4000;
    let mut asked = Vec::new();
    for round in 1..=rounds {
        // The constant's hover says its value, so an answer tells from which version it is.
        let digits = if round == 1 { 1 } else { (round - 1i64).to_string().len() } as u32;
        client.change(URI, round + 1, (0, 4), (0, 4 + digits), &round.to_string());
        asked.push((round, client.ask("textDocument/hover", at(URI, 0, 4))));
    }
    for (round, id) in asked {
        let answer = client.answer(id);
        let text = answer["result"]["contents"]["value"].as_str().unwrap_or_default();
        assert!(text.contains(&format!("K{round}")), "round {round}: {answer}");
    }
}

#[test]
fn diagnostics_come_in_the_order_of_versions_and_the_newest_comes() {
    let mut client = opened(PROGRAM);
    for version in 2..=300 {
        let text = if version % 2 == 0 { "8" } else { "0" };
        client.change(URI, version, (0, 4), (0, 5), text);
    }
    client.change(URI, 301, (0, 4), (0, 5), "9");
    let mut last = 0;
    loop {
        let message = client.wait_for_method("textDocument/publishDiagnostics");
        let version = message["params"]["version"].as_i64().expect("versioned");
        assert!(version >= last, "version {version} after {last}");
        last = version;
        if version == 301 {
            let found = message["params"]["diagnostics"].as_array().expect("an array").clone();
            // What the whole program is found to lack may have come along already.
            assert!(codes(&found).iter().any(|code| code == "octal-digit"), "{found:?}");
            break;
        }
    }
}

#[test]
fn a_client_that_answers_late_or_never_blocks_nothing() {
    let mut client = opened("ld x0\nout y0\nend\n");
    for _ in 0..150 {
        client.ask("workspace/executeCommand", json!({"command": "rungwise.format", "arguments": [URI]}));
    }
    for _ in 0..150 {
        client.wait_for_method("workspace/applyEdit");
    }
    let hover = client.request("textDocument/hover", at(URI, 0, 0));
    assert!(hover["result"].is_object(), "{hover}");
}

#[test]
fn a_cancelled_request_is_answered_and_others_go_on() {
    let mut client = opened(&"LD X0\nOUT M5\n".repeat(20_000));
    let id = client.ask("textDocument/semanticTokens/full", json!({"textDocument": {"uri": URI}}));
    client.notify("$/cancelRequest", json!({"id": id}));
    let answer = client.answer(id);
    let cancelled = answer["error"]["code"] == json!(-32800);
    assert!(cancelled || answer["result"].is_object(), "{answer}");
    client.notify("$/cancelRequest", json!({"id": 4711}));
    assert!(client.request("textDocument/hover", at(URI, 0, 0))["result"].is_object());
}

#[test]
fn a_hover_does_not_wait_for_long_requests() {
    let mut client = opened(&"LD X0\nOUT M5\n".repeat(10_000));
    let long: Vec<i64> = (0..6)
        .map(|_| client.ask("textDocument/semanticTokens/full", json!({"textDocument": {"uri": URI}})))
        .collect();
    let hover = client.ask("textDocument/hover", at(URI, 0, 0));
    assert!(client.answer(hover)["result"].is_object());
    let waiting = long.iter().filter(|id| !client.has_answer(**id)).count();
    assert!(waiting > 0, "the hover came last");
    long.into_iter().for_each(|id| assert!(client.answer(id)["result"].is_object()));
}

// Diagnostics

#[test]
fn a_keystroke_clears_what_it_mends() {
    let mut client = opened("LD X8\nOUT Y0\nEND\n");
    let diagnostics = client.diagnostics(URI, 1);
    assert_eq!(codes(&diagnostics), ["octal-digit"]);
    assert_eq!(diagnostics[0]["range"]["start"], json!({"line": 0, "character": 3}));
    assert_eq!(diagnostics[0]["range"]["end"], json!({"line": 0, "character": 5}));
    assert_eq!(diagnostics[0]["severity"], json!(1));
    client.change(URI, 2, (0, 4), (0, 5), "7");
    assert!(client.diagnostics(URI, 2).is_empty());
}

#[test]
fn findings_about_the_whole_program_move_along_while_typing() {
    // Long enough that whole-program rules wait for a pause in typing.
    let text = format!("{}P5\nLD X0\nOUT Y0\nP5\nLD X1\nOUT Y1\nEND\n", "LD X0\nINC D5\n".repeat(20_000));
    let mut client = opened(&text);
    let line_of = |diagnostics: &[Value]| {
        let found = diagnostics.iter().find(|diagnostic| diagnostic["code"] == json!("duplicate-label"));
        found.map(|found| found["range"]["start"]["line"].as_i64().expect("a line"))
    };
    let message = client.wait_for("the finding", |message| {
        message["params"]["diagnostics"].as_array().is_some_and(|found| line_of(found).is_some())
    });
    let line = line_of(message["params"]["diagnostics"].as_array().expect("an array")).expect("a line");
    for version in 2..8 {
        client.change(URI, version, (4, 0), (4, 0), "// a new line\n");
        // Whichever publication of this version comes first has the finding at its new line.
        assert_eq!(line_of(&client.diagnostics(URI, version)), Some(line + version - 1), "version {version}");
    }
}

#[test]
fn closing_a_document_clears_its_diagnostics() {
    let mut client = opened("LD X8\nOUT Y0\nEND\n");
    assert_eq!(client.diagnostics(URI, 1).len(), 1);
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": URI}}));
    let message = client.wait_for("the clearing", |message| {
        message["method"] == json!("textDocument/publishDiagnostics")
            && message["params"]["diagnostics"] == json!([])
    });
    assert_eq!(message["params"]["uri"], json!(URI));
    assert_eq!(client.request("textDocument/hover", at(URI, 0, 0))["result"], Value::Null);
}

/// The last diagnostics of a document, once nothing more comes.
fn settled(client: &mut Client) -> (usize, Value) {
    let published = |message: &Value| {
        message["method"] == json!("textDocument/publishDiagnostics")
            && message["params"]["uri"] == json!(URI)
    };
    let mut count = 0;
    let mut last = client.wait_for("any diagnostics", published);
    while !client.stays_silent(Duration::from_millis(1500), published) {
        last = client.wait_for("the next diagnostics", published);
        count += 1;
    }
    (count, last["params"].clone())
}

#[test]
fn a_document_closed_and_opened_at_once_keeps_its_diagnostics() {
    // Long enough for the first check to be under way when the second opening comes.
    let text = "LD X8\nOUT M5\n".repeat(3_000);
    let mut client = opened(&text);
    for version in 2..6 {
        client.notify("textDocument/didClose", json!({"textDocument": {"uri": URI}}));
        client.notify(
            "textDocument/didOpen",
            json!({"textDocument": {"uri": URI, "languageId": "plc-il", "version": version, "text": text}}),
        );
    }
    let (_, last) = settled(&mut client);
    assert_eq!(last["version"], json!(5));
    assert_eq!(last["diagnostics"].as_array().expect("an array").len(), 1000);
}

#[test]
fn a_document_opened_twice_is_published_by_one_voice() {
    let mut client = opened(&"LD X8\nINC D5\n".repeat(1_500));
    client.diagnostics(URI, 1);
    client.change(URI, 2, (0, 0), (0, 0), "// x\n");
    client.diagnostics(URI, 2);
    client.open(URI, "plc-il", &"LD X0\nINC D5\n".repeat(1_500));
    let (count, last) = settled(&mut client);
    assert!(count < 8, "{count} messages about one document");
    assert_eq!(codes(last["diagnostics"].as_array().expect("an array")), ["missing-end"]);
}

#[test]
fn diagnostics_are_pulled_with_a_result_id() {
    let mut client = opened("LD X8\nOUT Y0\nEND\n");
    let pull = |client: &mut Client, previous: Value| {
        let params = json!({"textDocument": {"uri": URI}, "previousResultId": previous});
        client.request("textDocument/diagnostic", params)["result"].clone()
    };
    let first = pull(&mut client, Value::Null);
    assert_eq!(first["kind"], json!("full"));
    assert_eq!(codes(first["items"].as_array().expect("items")), ["octal-digit"]);
    let second = pull(&mut client, first["resultId"].clone());
    assert_eq!((&second["kind"], &second["resultId"]), (&json!("unchanged"), &first["resultId"]));
    client.change(URI, 2, (0, 4), (0, 5), "7");
    let third = pull(&mut client, first["resultId"].clone());
    assert_eq!((&third["kind"], &third["items"]), (&json!("full"), &json!([])));
}

#[test]
fn a_client_that_pulls_gets_nothing_pushed() {
    let capabilities = json!({"textDocument": {"diagnostic": {}}});
    let mut client = Client::start_with(capabilities.clone(), json!({"diagnostics": {"mode": "pull"}}));
    assert!(client.initialised["capabilities"]["diagnosticProvider"].is_object());
    client.open(URI, "plc-il", "LD X8\nOUT Y0\nEND\n");
    let pushed = |message: &Value| message["method"] == json!("textDocument/publishDiagnostics");
    assert!(client.stays_silent(Duration::from_millis(300), pushed));
    let pushing = Client::start_with(capabilities, Value::Null);
    assert_eq!(
        pushing.initialised["capabilities"]["diagnosticProvider"],
        Value::Null,
        "nothing is shown twice"
    );
}

#[test]
fn thousands_of_diagnostics_are_cut_with_a_word_about_the_rest() {
    let mut client = opened(&"LD X8\nOUT M0\n".repeat(3000));
    let diagnostics = client.diagnostics(URI, 1);
    assert_eq!(diagnostics.len(), 1000);
    let last = diagnostics[999]["message"].as_str().expect("a message");
    assert!(last.contains("more"), "{last}");
}

// Features, each through the wire once; the ide tests have the details

#[test]
fn hover_completion_and_navigation_answer() {
    let mut client = opened(PROGRAM);
    let hover = client.request("textDocument/hover", at(URI, 0, 0));
    assert!(hover["result"]["contents"]["value"].as_str().expect("Markdown").contains("LD"), "{hover}");
    let hover = client.request("textDocument/hover", at(URI, 5, 4));
    assert!(hover["result"]["contents"]["value"].as_str().expect("Markdown").contains("100 ms"), "{hover}");

    let items = client.request("textDocument/completion", at(URI, 3, 0))["result"].clone();
    let labels: Vec<&str> =
        items.as_array().expect("items").iter().filter_map(|item| item["label"].as_str()).collect();
    assert!(labels.contains(&"OUT") && labels.contains(&"MOV"), "{labels:?}");

    let found = client.request("textDocument/definition", at(URI, 1, 3))["result"].clone();
    assert_eq!(found[0]["range"]["start"], json!({"line": 3, "character": 4}), "{found}");
    let mut params = at(URI, 1, 3);
    params["context"] = json!({"includeDeclaration": true});
    let places = client.request("textDocument/references", params)["result"].clone();
    assert_eq!(places.as_array().expect("places").len(), 3, "{places}");
}

#[test]
fn rename_and_its_refusal() {
    let mut client = opened(PROGRAM);
    let range = client.request("textDocument/prepareRename", at(URI, 1, 3))["result"].clone();
    assert_eq!(range["start"], json!({"line": 1, "character": 3}), "{range}");
    let mut params = at(URI, 1, 3);
    params["newName"] = json!("Y7");
    let edit = client.request("textDocument/rename", params.clone())["result"].clone();
    assert_eq!(edit["documentChanges"][0]["edits"].as_array().expect("edits").len(), 3, "{edit}");
    params["newName"] = json!("not a device");
    let refusal = client.request("textDocument/rename", params);
    assert!(refusal["error"]["message"].as_str().is_some_and(|message| !message.is_empty()), "{refusal}");
}

#[test]
fn outline_folding_tokens_and_hints_answer() {
    let mut client = opened(PROGRAM);
    let document = json!({"textDocument": {"uri": URI}});
    for method in ["textDocument/documentSymbol", "textDocument/foldingRange"] {
        let answer = client.request(method, document.clone())["result"].clone();
        assert!(!answer.as_array().expect("an array").is_empty(), "{method}");
    }
    let tokens =
        client.request("textDocument/semanticTokens/full", document.clone())["result"]["data"].clone();
    assert_eq!(tokens.as_array().expect("numbers").len() % 5, 0);
    assert!(tokens.as_array().expect("numbers").len() >= 5 * 13, "{tokens}");
    // Themes leave operators grey, and in an instruction list half of all words are mnemonics.
    let legend = &client.initialised["capabilities"]["semanticTokensProvider"]["legend"]["tokenTypes"];
    assert_eq!(legend[tokens[3].as_u64().expect("a type") as usize], "keyword", "{tokens}");
    let mut params = document;
    params["range"] = json!({"start": {"line": 0, "character": 0}, "end": {"line": 9, "character": 0}});
    let hints = client.request("textDocument/inlayHint", params)["result"].clone();
    assert!(hints[0]["label"].as_str().expect("a label").contains("5 s"), "{hints}");
}

#[test]
fn formatting_by_request_and_by_command() {
    let mut client = opened("ld x0\nout   y0\nend\n");
    let params = json!({"textDocument": {"uri": URI}, "options": {"tabSize": 4, "insertSpaces": true}});
    let edits = client.request("textDocument/formatting", params)["result"].clone();
    assert!(!edits.as_array().expect("edits").is_empty());
    let id =
        client.ask("workspace/executeCommand", json!({"command": "rungwise.format", "arguments": [URI]}));
    let apply = client.wait_for_method("workspace/applyEdit");
    assert_eq!(apply["params"]["edit"]["documentChanges"][0]["edits"], edits);
    client.send(json!({"jsonrpc": "2.0", "id": apply["id"], "result": {"applied": true}}));
    assert_eq!(client.answer(id)["result"]["edits"], json!(edits.as_array().map(Vec::len)));
}

#[test]
fn quick_fixes_and_the_check_command() {
    let mut client = opened("LD X8\nOUT Y0\nEND\n");
    let range = json!({"start": {"line": 0, "character": 3}, "end": {"line": 0, "character": 3}});
    let params = json!({"textDocument": {"uri": URI}, "range": range, "context": {"diagnostics": []}});
    let actions = client.request("textDocument/codeAction", params)["result"].clone();
    let edit = &actions[0]["edit"]["changes"][URI][0];
    assert_eq!((&edit["newText"], &actions[0]["kind"]), (&json!("X10"), &json!("quickfix")), "{actions}");
    let command = json!({"command": "rungwise.check", "arguments": [URI]});
    let summary = client.request("workspace/executeCommand", command)["result"].clone();
    assert_eq!((&summary["errors"], &summary["capacity"]), (&json!(1), &json!(8000)), "{summary}");
    let said = summary["message"].as_str().unwrap();
    assert!(said.starts_with("check failed: 1 error"), "{summary}");
    // A program without mistakes is told so.
    let mend = json!({"textDocument": {"uri": URI, "version": 2}, "contentChanges": [{"text": PROGRAM}]});
    client.notify("textDocument/didChange", mend);
    let command = json!({"command": "rungwise.check", "arguments": [URI]});
    let summary = client.request("workspace/executeCommand", command)["result"].clone();
    assert_eq!(summary["message"], json!("check passed: 2 rungs, 9 of 8000 steps; 1 hint"), "{summary}");
    for wrong in [json!({"command": "rungwise.check"}), json!({"command": "rm", "arguments": [URI]})] {
        let answer = client.request("workspace/executeCommand", wrong);
        assert_eq!(answer["error"]["code"], json!(-32602), "{answer}");
    }
}

#[test]
fn the_status_bar_is_told() {
    let mut client = opened(PROGRAM);
    let status = client.wait_for_method("rungwise/status")["params"].clone();
    assert_eq!((&status["target"], &status["dialect"]), (&json!("fx2n"), &json!("fx")), "{status}");
    assert_eq!((&status["steps"], &status["capacity"]), (&json!(9), &json!(8000)), "{status}");
    assert_eq!((&status["rungs"], &status["uri"]), (&json!(2), &json!(URI)), "{status}");
}

#[test]
fn a_change_of_settings_reads_open_documents_anew() {
    let mut client = opened("LD S500\nOUT Y0\nEND\n");
    assert!(client.diagnostics(URI, 1).is_empty());
    client.notify("workspace/didChangeConfiguration", json!({"settings": {"rungwise": {"target": "fx1s"}}}));
    let message = client.wait_for("diagnostics for the FX1S", |message| {
        message["method"] == json!("textDocument/publishDiagnostics")
            && message["params"]["diagnostics"].as_array().is_some_and(|found| !found.is_empty())
    });
    let found = message["params"]["diagnostics"].as_array().expect("an array").clone();
    assert_eq!(codes(&found), ["device-out-of-range"]);
}

#[test]
fn settings_of_a_wrong_kind_do_not_spoil_the_others() {
    let options = json!({"target": "fx1s", "format": null, "inlayHints": {"enabled": null},
        "diagnostics": 7, "dialect": null});
    let mut client = Client::start_with(json!({}), options);
    client.open(URI, "plc-il", "LD S500\nOUT Y0\nEND\n");
    assert_eq!(codes(&client.diagnostics(URI, 1)), ["device-out-of-range"]);
    // A client without any settings says null; what `initialize` said stays in force.
    client.notify("workspace/didChangeConfiguration", json!({"settings": null}));
    client.notify("workspace/didChangeConfiguration", json!({"settings": {"rungwise": null}}));
    client.change(URI, 2, (0, 4), (0, 7), "501");
    assert_eq!(codes(&client.diagnostics(URI, 2)), ["device-out-of-range"]);
}

#[test]
fn a_program_typed_into_an_empty_document_is_read_as_what_it_becomes() {
    let mut client = opened("");
    let dialect =
        |client: &mut Client| client.wait_for_method("rungwise/status")["params"]["dialect"].clone();
    assert_eq!(dialect(&mut client), json!("fx"));
    client.change(URI, 2, (0, 0), (0, 0), "PROGRAM p\nVAR a : BOOL; END_VAR\nLD a\nST a\nEND_PROGRAM\n");
    assert!(client.diagnostics(URI, 2).is_empty());
    assert_eq!(dialect(&mut client), json!("iec"));
}

#[test]
fn a_long_program_is_read_as_what_it_became_when_it_is_saved() {
    let mut client = opened(&"// still to be written\n".repeat(300));
    let program = format!("PROGRAM p\nVAR a : BOOL; END_VAR\n{}END_PROGRAM\n", "LD a\nST a\n".repeat(9_000));
    client.change(URI, 2, (0, 0), (0, 0), &program);
    client.notify("textDocument/didSave", json!({"textDocument": {"uri": URI}}));
    client.wait_for("the status", |message| {
        message["method"] == json!("rungwise/status") && message["params"]["dialect"] == json!("iec")
    });
}

// Projects

fn project(manifest: &str) -> (tempfile::TempDir, String, String) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("rungwise.toml"), manifest).expect("written");
    let uri = |name: &str| format!("file://{}", folder.path().join(name).display());
    let (program, manifest) = (uri("a.il"), uri("rungwise.toml"));
    (folder, program, manifest)
}

#[test]
fn a_manifest_that_changes_on_disk_changes_what_is_found() {
    let (folder, program, _) = project("target = \"fx1s\"\n");
    let mut client = Client::start();
    client.open(&program, "plc-il", "LD S500\nOUT Y0\nEND\n");
    assert_eq!(codes(&client.diagnostics(&program, 1)), ["device-out-of-range"]);
    std::fs::write(folder.path().join("rungwise.toml"), "target = \"fx3u\"\n").expect("written");
    client.notify("workspace/didChangeWatchedFiles", json!({"changes": []}));
    client.wait_for("cleared diagnostics", |message| {
        message["method"] == json!("textDocument/publishDiagnostics")
            && message["params"]["uri"] == json!(program)
            && message["params"]["diagnostics"] == json!([])
    });
}

#[test]
fn a_mistake_in_the_manifest_is_shown_where_it_is_until_it_is_mended() {
    let (folder, program, manifest) = project("# Line\ntarget = \"fx9\"\n");
    let mut client = Client::start();
    client.open(&program, "plc-il", "LD X0\nOUT Y0\nEND\n");
    let message = client.wait_for_method("window/showMessage");
    assert!(message["params"]["message"].as_str().is_some_and(|text| text.contains("fx9")), "{message}");
    let about = |wanted: Value| {
        move |message: &Value| {
            message["method"] == json!("textDocument/publishDiagnostics")
                && message["params"]["uri"] == wanted
        }
    };
    let shown = client.wait_for("the mistake", about(json!(manifest)));
    let found = &shown["params"]["diagnostics"][0];
    assert_eq!(found["range"]["start"], json!({"line": 1, "character": 10}), "{shown}");
    client.open(&program.replace("a.il", "b.il"), "plc-il", "LD X0\nOUT Y0\nEND\n");
    client.diagnostics(&program.replace("a.il", "b.il"), 1);
    let told = |message: &Value| message["method"] == json!("window/showMessage");
    assert!(client.stays_silent(Duration::from_millis(200), told), "each mistake is told once");
    std::fs::write(folder.path().join("rungwise.toml"), "target = \"fx3u\"\n").expect("written");
    client.notify("workspace/didChangeWatchedFiles", json!({"changes": []}));
    let shown = client.wait_for("the clearing", about(json!(manifest)));
    assert_eq!(shown["params"]["diagnostics"], json!([]));
}

#[test]
fn a_client_that_can_is_asked_to_watch_manifests() {
    let capabilities = json!({"workspace": {"didChangeWatchedFiles": {"dynamicRegistration": true}}});
    let mut client = Client::start_with(capabilities, Value::Null);
    let asked = client.wait_for_method("client/registerCapability")["params"].clone();
    let registration = &asked["registrations"][0];
    assert_eq!(registration["method"], json!("workspace/didChangeWatchedFiles"));
    assert_eq!(registration["registerOptions"]["watchers"][0]["globPattern"], json!("**/rungwise.toml"));
    let asks = |message: &Value| message["method"] == json!("client/registerCapability");
    assert!(Client::start().stays_silent(Duration::from_millis(200), asks));
}

#[test]
fn thousands_of_edits_do_not_grow_the_memory() {
    let mut client = opened(&"LD X0\nAND X1\nOUT M5\n".repeat(300));
    let mut version = 1;
    let mut edit = |client: &mut Client, rounds: usize| {
        for round in 0..rounds {
            version += 1;
            let line = (round * 37 % 900) as u32;
            client.change(URI, version, (line, 0), (line, 0), "// x\n");
            version += 1;
            client.change(URI, version, (line, 0), (line + 1, 0), "");
        }
        client.request("textDocument/hover", at(URI, 0, 0));
        client.diagnostics(URI, version);
    };
    edit(&mut client, 1_000);
    let Some(before) = client.resident_kib() else { return };
    edit(&mut client, 4_000);
    let after = client.resident_kib().expect("as before");
    assert!(after < before + 16 * 1024, "{before} KiB became {after} KiB");
}
