//! Translations through the wire: the command, the code actions, the file that is made beside.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::lsp_client::Client;
use serde_json::{Value, json};
use std::time::Duration;

const LIST: &str = "file:///tmp/translate/main.il";
const DRAWING: &str = "file:///tmp/translate/motor.lad";

const THREE_RUNGS: &str = "\
; start
LD X0
OR Y0
ANI X1
OUT Y0
LD X2
MOV K5 D0
LD X3
OUT Y3
END
";

const MOTOR: &str = "\
|   X0        X1                             Y0  |
+---| |---+---|/|----------------------------( )-+
|   Y0    |                                      |
+---| |---+                                      |
";

fn translate(client: &mut Client, argument: Value) -> Value {
    let params = json!({"command": "rungwise.translate", "arguments": [argument]});
    client.request("workspace/executeCommand", params)
}

fn form(client: &mut Client, argument: Value) -> Value {
    let answer = translate(client, argument);
    let forms = answer["result"]["forms"].as_array().unwrap_or_else(|| panic!("{answer}"));
    assert_eq!(forms.len(), 1, "{answer}");
    forms[0].clone()
}

fn position(line: u32, character: u32) -> Value {
    json!({"line": line, "character": character})
}

fn range(from: (u32, u32), to: (u32, u32)) -> Value {
    json!({"start": position(from.0, from.1), "end": position(to.0, to.1)})
}

#[test]
fn the_rung_at_the_cursor_is_translated_to_each_form() {
    let mut client = Client::start();
    client.open(LIST, "plc-il", THREE_RUNGS);
    let ladder = form(&mut client, json!({"uri": LIST, "position": position(3, 2), "to": "ladder"}));
    assert_eq!(ladder["certificate"], "proved");
    assert_eq!(ladder["notes"], json!([]));
    let text = ladder["text"].as_str().unwrap();
    assert!(text.contains("Y0") && !text.contains("D0") && !text.contains("END"), "{text}");
    let boolean = form(&mut client, json!({"uri": LIST, "position": position(1, 0), "to": "boolean"}));
    assert_eq!(boolean["text"], "; start\nY0 = (X0 + Y0)*[X1]\n");
    assert_eq!(boolean["certificate"], "proved");
    let fx = form(&mut client, json!({"uri": LIST, "position": position(5, 3), "to": "fx"}));
    assert_eq!(fx["text"], "LD X2\nMOV K5 D0\n");
    assert_eq!(fx["certificate"], "construction");
}

#[test]
fn on_a_comment_it_is_the_rung_below() {
    let mut client = Client::start();
    client.open(LIST, "plc-il", THREE_RUNGS);
    let fx = form(&mut client, json!({"uri": LIST, "position": position(0, 3), "to": "fx"}));
    assert_eq!(fx["text"], "; start\nLD X0\nOR Y0\nANI X1\nOUT Y0\n");
}

#[test]
fn a_selection_of_lines_does_not_touch_the_next_one() {
    let mut client = Client::start();
    client.open(LIST, "plc-il", THREE_RUNGS);
    let fx = form(&mut client, json!({"uri": LIST, "range": range((4, 0), (7, 0)), "to": "boolean"}));
    let text = fx["text"].as_str().unwrap();
    assert!(text.contains("Y0") && text.contains("D0") && !text.contains("Y3"), "{text}");
}

#[test]
fn without_a_place_it_is_the_whole_document_and_the_weakest_certificate_counts() {
    let mut client = Client::start();
    client.open(DRAWING, "ladder", MOTOR);
    let fx = form(&mut client, json!({"uri": DRAWING, "to": "fx"}));
    assert_eq!(fx["text"], "LD X0\nOR Y0\nANI X1\nOUT Y0\nEND\n");
    assert_eq!(fx["certificate"], "proved");
    client.open(LIST, "plc-il", THREE_RUNGS);
    let list = form(&mut client, json!({"uri": LIST, "to": "ladder"}));
    assert_eq!(list["certificate"], "construction", "one rung has a MOV");
    let forms = translate(&mut client, json!({"uri": LIST, "to": "all"}))["result"]["forms"].clone();
    let names: Vec<&str> =
        forms.as_array().unwrap().iter().map(|form| form["to"].as_str().unwrap()).collect();
    assert!(["ladder", "fx", "boolean"].iter().all(|name| names.contains(name)), "{names:?}");
}

#[test]
fn a_rung_that_cannot_be_translated_is_noted_with_its_line() {
    let mut client = Client::start();
    client.open(LIST, "plc-il", "LD X0\nOUT Y0\nLD X1\nMPP\nOUT Y1\nEND\n");
    let ladder = form(&mut client, json!({"uri": LIST, "to": "ladder"}));
    let note = ladder["notes"][0].as_str().unwrap();
    assert!(note.starts_with("line 3: ") && note.contains("MPP"), "{note}");
    let mut chinese = Client::spawn();
    let params = json!({"processId": null, "rootUri": null, "capabilities": {}, "locale": "zh-CN"});
    chinese.request("initialize", params);
    chinese.notify("initialized", json!({}));
    chinese.open(LIST, "plc-il", "LD X0\nOUT Y0\nLD X1\nMPP\nOUT Y1\nEND\n");
    let ladder = form(&mut chinese, json!({"uri": LIST, "to": "ladder"}));
    assert!(ladder["notes"][0].as_str().unwrap().starts_with("第 3 行"), "{ladder}");
}

#[test]
fn where_there_is_no_rung_there_is_no_form() {
    let mut client = Client::start();
    client.open(LIST, "plc-il", "\n\n");
    let answer = translate(&mut client, json!({"uri": LIST, "position": position(1, 0), "to": "all"}));
    assert_eq!(answer["result"]["forms"], json!([]), "{answer}");
}

#[test]
fn wrong_arguments_are_said_to_be_wrong() {
    let mut client = Client::start();
    client.open(LIST, "plc-il", THREE_RUNGS);
    let mut refused = |argument: Value| {
        let answer = translate(&mut client, argument);
        answer["error"]["message"].as_str().unwrap_or_else(|| panic!("{answer}")).to_string()
    };
    assert!(refused(json!({"uri": LIST, "to": "pascal"})).contains("`pascal`"));
    assert!(refused(json!({"uri": LIST})).contains("`to`"));
    assert!(refused(json!({"to": "fx"})).contains("`uri`"));
    assert!(refused(json!({"uri": LIST, "to": "fx", "position": 3})).contains("rungwise.translate"));
    assert!(refused(json!(7)).contains("rungwise.translate"));
    let unknown = refused(json!({"uri": "file:///tmp/translate/none.il", "to": "fx"}));
    assert!(unknown.contains("does not know"), "{unknown}");
    let nothing = client.request("workspace/executeCommand", json!({"command": "rungwise.translate"}));
    assert!(nothing["error"]["message"].is_string(), "{nothing}");
}

#[test]
fn a_cancelled_translation_of_a_large_file_is_answered_and_the_server_lives_on() {
    let mut client = Client::start();
    let rung = "LD X0\nOR M1\nLD X2\nOR M3\nANB\nOUT Y0\n";
    client.open(LIST, "plc-il", &rung.repeat(20_000));
    let params = json!({"command": "rungwise.translate", "arguments": [{"uri": LIST, "to": "all"}]});
    let id = client.ask("workspace/executeCommand", params);
    client.notify("$/cancelRequest", json!({"id": id}));
    let answer = client.answer(id);
    assert_eq!(answer["error"]["code"], -32800, "{answer}");
    let fx = form(&mut client, json!({"uri": LIST, "position": position(0, 0), "to": "fx"}));
    assert_eq!(fx["certificate"], "proved");
}

#[test]
fn a_program_in_a_fence_is_translated_too() {
    let mut client = Client::start();
    let uri = "file:///tmp/translate/notes.md";
    client.open(uri, "markdown", "# Notes\n\n```il\nLD X7\nOUT Y7\n```\n\n```il\nLD X5\nOUT Y5\n```\n");
    let second = form(&mut client, json!({"uri": uri, "position": position(8, 0), "to": "boolean"}));
    assert_eq!(second["text"], "Y5 = X5\n");
}

fn actions(client: &mut Client, uri: &str, at: (u32, u32), only: Option<&str>) -> Vec<Value> {
    let mut context = json!({"diagnostics": []});
    if let Some(only) = only {
        context["only"] = json!([only]);
    }
    let params = json!({"textDocument": {"uri": uri}, "range": range(at, at), "context": context});
    let all = client.request("textDocument/codeAction", params)["result"].as_array().unwrap().clone();
    let is_translation = |action: &&Value| action["kind"].as_str().unwrap_or("").contains("translate");
    all.iter().filter(is_translation).cloned().collect()
}

fn titles(actions: &[Value]) -> Vec<&str> {
    actions.iter().map(|action| action["title"].as_str().unwrap()).collect()
}

#[test]
fn a_client_with_commands_of_its_own_gets_them_with_titles_that_say_the_outcome() {
    let commands = json!(["rungwise.openTranslation", "rungwise.copyTranslation"]);
    let capabilities = json!({"experimental": {"commands": {"commands": commands}}});
    let mut client = Client::start_with(capabilities, json!({}));
    client.open(DRAWING, "ladder", MOTOR);
    let offered = actions(&mut client, DRAWING, (1, 5), None);
    let found = titles(&offered);
    assert!(found.contains(&"Translate rung to FX list (4 steps, proved equal)"), "{found:?}");
    assert!(found.contains(&"Copy rung as FX list (4 steps)"), "{found:?}");
    assert!(found.contains(&"Translate rung to boolean form (proved equal)"), "{found:?}");
    assert!(!found.iter().any(|title| title.contains("ladder") || title.contains("file")), "{found:?}");
    let open = offered.iter().find(|action| action["kind"] == "refactor.rewrite.translate.fx").unwrap();
    assert_eq!(open["command"]["command"], "rungwise.openTranslation");
    let argument = open["command"]["arguments"][0].clone();
    assert_eq!(form(&mut client, argument)["text"], "LD X0\nOR Y0\nANI X1\nOUT Y0\n");
    let copy = actions(&mut client, DRAWING, (1, 5), Some("refactor.rewrite.translate.fx.copy"));
    assert_eq!(titles(&copy), ["Copy rung as FX list (4 steps)"]);
    let of_file = actions(&mut client, DRAWING, (1, 5), Some("source"));
    assert!(titles(&of_file).contains(&"Translate file to FX list"), "{of_file:?}");
    assert!(of_file.iter().all(|action| action["kind"].as_str().unwrap().starts_with("source.translate.")));
    assert!(actions(&mut client, DRAWING, (1, 5), Some("quickfix")).is_empty());
}

#[test]
fn a_client_that_makes_files_gets_one_beside() {
    let folder = tempfile::tempdir().unwrap();
    let uri = format!("file://{}/motor.lad", folder.path().display());
    std::fs::write(folder.path().join("motor-fx.il"), "").unwrap();
    let capabilities = json!({"window": {"showDocument": {"support": true}}, "workspace": {"workspaceEdit":
        {"documentChanges": true, "resourceOperations": ["create", "rename", "delete"]}}});
    let mut client = Client::start_with(capabilities, json!({}));
    client.open(&uri, "ladder", MOTOR);
    let offered = actions(&mut client, &uri, (1, 5), Some("refactor.rewrite.translate.fx"));
    let [action] = offered.as_slice() else { panic!("{offered:?}") };
    assert_eq!(action["command"]["command"], "rungwise.translateBeside");
    let id = client.ask("workspace/executeCommand", action["command"].clone());
    let asked = client.wait_for_method("workspace/applyEdit");
    let changes = asked["params"]["edit"]["documentChanges"].as_array().unwrap().clone();
    let made = format!("file://{}/motor-fx-2.il", folder.path().display());
    assert_eq!((&changes[0]["kind"], &changes[0]["uri"]), (&json!("create"), &json!(made)));
    assert_eq!(changes[1]["textDocument"]["uri"], json!(made));
    assert_eq!(changes[1]["edits"][0]["newText"], "LD X0\nOR Y0\nANI X1\nOUT Y0\n");
    assert_eq!(client.answer(id)["result"]["uri"], json!(made));
    client.send(json!({"jsonrpc": "2.0", "id": asked["id"], "result": {"applied": true}}));
    let shown = client.wait_for_method("window/showDocument");
    assert_eq!(shown["params"]["uri"], json!(made));
}

#[test]
fn a_client_that_can_do_neither_is_not_offered_what_it_cannot_do() {
    let mut client = Client::start_with(json!({"workspace": {}}), json!({}));
    client.open(DRAWING, "ladder", MOTOR);
    assert!(actions(&mut client, DRAWING, (1, 5), None).is_empty());
    assert!(client.stays_silent(Duration::from_millis(50), |message| message.get("error").is_some()));
}

#[test]
fn a_rung_without_a_form_has_no_action_for_it() {
    let commands = json!(["rungwise.openTranslation", "rungwise.copyTranslation"]);
    let capabilities = json!({"experimental": {"commands": {"commands": commands}}});
    let mut client = Client::start_with(capabilities, json!({}));
    client.open(LIST, "plc-il", "LD X1\nANB\nOUT Y1\nEND\n");
    assert!(actions(&mut client, LIST, (0, 0), None).is_empty());
}

#[test]
fn a_file_beside_a_program_in_a_fence_is_named_after_the_document() {
    let folder = tempfile::tempdir().unwrap();
    let uri = format!("file://{}/notes.md", folder.path().display());
    let mut client = Client::start();
    client.open(&uri, "markdown", "```il\nLD X7\nOUT Y7\n```\n");
    let argument = json!({"uri": uri, "position": position(1, 0), "to": "boolean"});
    let params = json!({"command": "rungwise.translateBeside", "arguments": [argument]});
    let answer = client.request("workspace/executeCommand", params);
    let made = format!("file://{}/notes-boolean.txt", folder.path().display());
    assert_eq!(answer["result"]["uri"], json!(made), "{answer}");
}

#[test]
fn the_header_of_a_network_is_all_of_it_and_a_comment_the_rung_below() {
    let rung = |contact: &str, output: &str| {
        format!(
            "|   {contact}                                       {output}  |\n+---| |--------------------------------------( )-+\n"
        )
    };
    let text = format!(
        "NETWORK 1 'Start'\n{}; second\n{}\nNETWORK 2\n{}",
        rung("X0", "Y0"),
        rung("X1", "Y1"),
        rung("X2", "Y2")
    );
    let commands = json!(["rungwise.openTranslation"]);
    let mut client =
        Client::start_with(json!({"experimental": {"commands": {"commands": commands}}}), json!({}));
    client.open(DRAWING, "ladder", &text);
    let network = form(&mut client, json!({"uri": DRAWING, "position": position(0, 3), "to": "boolean"}));
    let words = network["text"].as_str().unwrap();
    assert!(words.contains("Y0 = X0\n") && words.contains("Y1 = X1\n") && !words.contains("Y2"), "{words}");
    let offered = actions(&mut client, DRAWING, (0, 3), Some("refactor.rewrite.translate.boolean"));
    assert_eq!(titles(&offered), ["Translate network to boolean form (proved equal)"]);
    let below = form(&mut client, json!({"uri": DRAWING, "position": position(3, 3), "to": "boolean"}));
    let words = below["text"].as_str().unwrap();
    assert!(words.contains("Y1 = X1\n") && !words.contains("Y0"), "{words}");
}

#[test]
fn an_fx_list_is_for_the_model_that_the_project_or_the_client_names() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().canonicalize().unwrap();
    let text = "PROGRAM P\nVAR\nStart AT %IX0.0 : BOOL; END_VAR VAR RETAIN Far AT %MX500.0 : BOOL;\nEND_VAR\nLD Start\nST Far\nEND_PROGRAM\n";
    std::fs::write(place.join("rungwise.toml"), "[translate]\ntarget = \"fx3u\"\n").unwrap();
    std::fs::write(place.join("main.il"), text).unwrap();
    let uri = format!("file://{}", place.join("main.il").display());
    let mut client = Client::start();
    client.open(&uri, "plc-il", text);
    let asked = json!({"uri": uri, "position": position(4, 0), "to": "fx"});
    assert_eq!(form(&mut client, asked.clone())["text"], "LD X0\nOUT M4000\n");
    let with = |target: &str| {
        let mut asked = asked.clone();
        asked["target"] = json!(target);
        asked
    };
    let kept = form(&mut client, with("fx2n"));
    assert_eq!(kept["notes"], json!(["line 5: FX2N has no M4000"]), "{kept}");
    assert_eq!(form(&mut client, with("fx3u"))["notes"], json!([]));
    let answer = translate(&mut client, with("iec"));
    let said = answer["error"]["message"].as_str().unwrap();
    assert_eq!(said, "`iec` is no model of the FX family; fx1s, fx1n, fx2n and fx3u are");
}
