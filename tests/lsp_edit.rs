//! Structural edits and typing through the wire.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::lsp_client::Client;
use serde_json::{Value, json};

const URI: &str = "file:///tmp/edit/motor.lad";

const MOTOR: &str = "\
|   X0        X1                             Y0  |
+---| |---+---|/|----------------------------( )-+
|   Y0    |                                      |
+---| |---+                                      |
";

fn started(capabilities: Value, locale: &str) -> Client {
    let mut client = Client::spawn();
    let params = json!({"processId": null, "rootUri": null, "capabilities": capabilities, "locale": locale});
    client.initialised = client.request("initialize", params)["result"].clone();
    client.notify("initialized", json!({}));
    client.open(URI, "ladder", MOTOR);
    client
}

fn range(from: (u32, u32), to: (u32, u32)) -> Value {
    json!({"start": {"line": from.0, "character": from.1}, "end": {"line": to.0, "character": to.1}})
}

fn edit(client: &mut Client, edit: &str, at: (u32, u32), more: Value) -> Value {
    let mut params = json!({"textDocument": {"uri": URI}, "range": range(at, at), "edit": edit});
    for (key, value) in more.as_object().unwrap() {
        params[key] = value.clone();
    }
    client.request("rungwise/edit", params)
}

#[test]
fn an_edit_answers_with_small_changes_and_a_selection() {
    let mut client = started(json!({}), "en");
    let answer = edit(&mut client, "insertContact", (1, 24), json!({}));
    let edits = answer["result"]["edits"].as_array().unwrap_or_else(|| panic!("{answer}"));
    assert_eq!(edits.len(), 2, "two lines change: {edits:?}");
    assert_eq!(answer["result"]["selection"], range((0, 22), (0, 25)));
    let named = edit(&mut client, "insertContact", (1, 24), json!({"operand": "M5"}));
    assert_eq!(named["result"]["selection"], range((1, 25), (1, 25)), "behind the contact");
    let rung = edit(&mut client, "insertRung", (1, 24), json!({}));
    assert_eq!(rung["result"]["selection"], range((6, 4), (6, 4)), "in the text after the edit");
}

#[test]
fn a_refusal_says_why_in_the_language_of_the_user() {
    let mut client = started(json!({}), "en");
    let answer = edit(&mut client, "insertCoil", (1, 12), json!({}));
    assert!(answer["error"]["message"].as_str().unwrap().contains("end of its line"), "{answer}");
    assert!(
        edit(&mut client, "fly", (1, 12), json!({}))["error"]["message"].as_str().unwrap().contains("`fly`")
    );
    let mut chinese = started(json!({}), "zh-CN");
    let answer = edit(&mut chinese, "insertCoil", (1, 12), json!({}));
    assert!(answer["error"]["message"].as_str().unwrap().contains("线圈"), "{answer}");
}

#[test]
fn an_edit_of_an_old_version_is_refused() {
    let mut client = started(json!({}), "en");
    client.change(URI, 2, (3, 11), (3, 11), "");
    let document = |version: i64| json!({"textDocument": {"uri": URI, "version": version}});
    let answer = edit(&mut client, "negate", (1, 5), document(1));
    assert_eq!(answer["error"]["code"], json!(-32801), "{answer}");
    assert!(edit(&mut client, "negate", (1, 5), document(2))["result"]["edits"].is_array());
}

fn actions(client: &mut Client, only: &str) -> Vec<Value> {
    let params = json!({"textDocument": {"uri": URI}, "range": range((3, 5), (3, 5)),
        "context": {"diagnostics": [], "only": [only]}});
    client.request("textDocument/codeAction", params)["result"].as_array().unwrap().clone()
}

#[test]
fn edits_are_code_actions_where_they_make_sense() {
    let mut client = started(json!({}), "en");
    let offered = actions(&mut client, "refactor");
    let kinds: Vec<&str> = offered.iter().map(|action| action["kind"].as_str().unwrap()).collect();
    let has = |edit: &str| kinds.contains(&format!("refactor.rewrite.ladder.{edit}").as_str());
    assert!(has("moveBranchUp") && has("deleteBranch") && has("insertContact"), "{kinds:?}");
    assert!(!has("moveBranchDown") && !has("insertCoil"), "{kinds:?}");
    assert!(offered.iter().all(|action| action["edit"]["changes"][URI].is_array()), "{offered:?}");
    assert!(actions(&mut client, "quickfix").iter().all(|action| action["kind"] == "quickfix"));
    assert_eq!(actions(&mut client, "refactor.rewrite.ladder.negate").len(), 1);
}

#[test]
fn quick_fixes_come_only_to_who_wants_them() {
    let mut client = started(json!({}), "en");
    let uri = "file:///tmp/edit/main.il";
    client.open(uri, "plc-il", "LD X0\nOUTT Y0\nEND\n");
    let mut fixes = |context: Value| {
        let params =
            json!({"textDocument": {"uri": uri}, "range": range((1, 0), (1, 0)), "context": context});
        let actions = client.request("textDocument/codeAction", params)["result"].clone();
        let actions = actions.as_array().unwrap().clone();
        actions.iter().filter(|action| action["kind"] == "quickfix").count()
    };
    let offered = fixes(json!({"diagnostics": []}));
    assert!(offered > 0);
    assert_eq!(fixes(json!({"diagnostics": [], "only": ["quickfix"]})), offered);
    assert_eq!(fixes(json!({"diagnostics": [], "only": ["refactor"]})), 0);
}

#[test]
fn a_client_that_resolves_edits_gets_them_when_it_asks() {
    let support = json!({"textDocument": {"codeAction": {"dataSupport": true,
        "resolveSupport": {"properties": ["edit"]}}}});
    let mut client = started(support, "en");
    let offered = actions(&mut client, "refactor.rewrite.ladder.moveBranchUp");
    let [action] = offered.as_slice() else { panic!("{offered:?}") };
    assert!(action["edit"].is_null() && action["title"] == "Move branch up", "{action}");
    let resolved = client.request("codeAction/resolve", action.clone());
    assert_eq!(resolved["result"]["edit"]["changes"][URI].as_array().unwrap().len(), 2, "{resolved}");
}

#[test]
fn objects_ranges_and_typing_go_through_the_wire() {
    let mut client = started(json!({}), "en");
    let provider = &client.initialised["capabilities"]["documentOnTypeFormattingProvider"];
    assert_eq!(provider["firstTriggerCharacter"], "\n");
    let more = provider["moreTriggerCharacter"].as_array().unwrap();
    assert!(["|", "-", "]", "X", "0"].iter().all(|key| more.contains(&json!(key))), "{more:?}");
    let object = |object: &str, around: bool| {
        json!({"textDocument": {"uri": URI}, "position": {"line": 3, "character": 5}, "object": object,
            "around": around})
    };
    let branch = client.request("rungwise/object", object("branch", true));
    assert_eq!(branch["result"], json!({"range": range((2, 1), (3, 10)), "blockwise": true}), "{branch}");
    assert!(client.request("rungwise/object", object("program", false))["result"].is_null());
    let params = json!({"textDocument": {"uri": URI}, "positions": [{"line": 2, "character": 5}]});
    let ranges = client.request("textDocument/selectionRange", params);
    assert_eq!(ranges["result"][0]["range"], range((2, 4), (2, 6)), "{ranges}");
    assert!(ranges["result"][0]["parent"]["parent"]["parent"].is_object(), "{ranges}");
    client.change(URI, 2, (1, 24), (1, 24), "|");
    let params = json!({"textDocument": {"uri": URI}, "position": {"line": 1, "character": 25}, "ch": "|",
        "options": {"tabSize": 4, "insertSpaces": true}});
    let edits = client.request("textDocument/onTypeFormatting", params);
    assert_eq!(edits["result"].as_array().unwrap().len(), 1, "{edits}");
    assert_eq!(edits["result"][0]["newText"], "", "one cell of wire goes: {edits}");
    let linked = json!({"textDocument": {"uri": URI}, "position": {"line": 2, "character": 5}});
    assert!(client.request("textDocument/linkedEditingRange", linked)["result"].is_null());
}

#[test]
fn keystrokes_are_answered_in_a_text_that_the_server_does_not_have_yet() {
    let mut client = started(json!({}), "en");
    let mut typed = |text: &str, at: (u32, u32), character: &str, version: Value| {
        let params = json!({
            "textDocument": {"uri": URI, "version": version},
            "lines": {"first": 0, "end": 2, "text": text},
            "position": {"line": at.0, "character": at.1},
            "ch": character,
        });
        client.request("rungwise/typed", params)
    };
    let rows: Vec<&str> = MOTOR.lines().collect();
    let wider = format!("{}\n{}\n", rows[0].replace("X0 ", "X07 "), rows[1]);
    let answer = typed(&wider, (0, 7), "7", Value::Null);
    let edits = answer["result"].as_array().unwrap_or_else(|| panic!("{answer}"));
    assert_eq!(edits.len(), 1, "{edits:?}");
    assert_eq!((&edits[0]["newText"], &edits[0]["range"]["start"]["line"]), (&json!(""), &json!(0)));
    // Nothing of that is kept: the same place in the document has no such character before it.
    let plain = format!("{}\n{}\n", rows[0], rows[1]);
    assert_eq!(typed(&plain, (0, 6), "7", Value::Null)["result"], json!([]));
    let stale = typed(&wider, (0, 7), "7", json!(99));
    assert_eq!(stale["error"]["code"], json!(-32801), "{stale}");
    // Lines and places that are not there are no harm.
    let mut beyond = |first: u32, end: u32| {
        let lines = json!({"first": first, "end": end, "text": "| X |\n"});
        let position = json!({"line": 4_000_000_000_u32, "character": 7});
        let params = json!({"textDocument": {"uri": URI}, "lines": lines, "position": position, "ch": "\n"});
        client.request("rungwise/typed", params)
    };
    for (first, end) in [(0, 0), (3, 1), (900, 2_000_000_000), (4_000_000_000, 4_294_967_295)] {
        assert!(beyond(first, end)["result"].is_array());
    }
}
