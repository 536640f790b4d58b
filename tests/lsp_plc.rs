//! `rungwise.plc.…`, `rungwise/plc` and `rungwise/monitor` over the protocol, with a virtual PLC at the other end.

use super::lsp_client::Client;
use crate::virtual_plc::VirtualPlc;
use serde_json::{Value, json};

const LIST: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nLD Y0\nOUT T0 K100\nMOV D0 D1\nEND\n";

/// An editor that is connected to a virtual PLC.
pub struct Connected {
    pub client: Client,
    pub uri: String,
    pub plc: Option<VirtualPlc>,
    port: String,
    pub folder: tempfile::TempDir,
}

impl Connected {
    pub fn open(list: &str) -> Connected {
        Connected::open_with(list, "", |plc| plc.port.clone())
    }

    /// In a project with a manifest, at the port that `port` says.
    pub fn open_with(list: &str, manifest: &str, port: impl FnOnce(&VirtualPlc) -> String) -> Connected {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("motor.il");
        std::fs::write(&path, list).unwrap();
        if !manifest.is_empty() {
            std::fs::write(folder.path().join("rungwise.toml"), manifest).unwrap();
        }
        let uri = format!("file://{}", path.canonicalize().unwrap().display());
        let plc = VirtualPlc::start(folder.path(), &[]);
        let port = port(&plc);
        let mut client = Client::start();
        client.open(&uri, "plc-il", list);
        client.diagnostics(&uri, 1);
        let mut connected = Connected { client, uri, plc: Some(plc), port, folder };
        let port = connected.port.clone();
        let state = connected.tell("connect", json!({ "port": port }));
        assert_eq!((&state["connected"], &state["model"]), (&json!(true), &json!("fx2n")), "{state}");
        connected
    }

    pub fn answer(&mut self, verb: &str, more: Value) -> Value {
        let mut argument = json!({ "uri": self.uri });
        argument.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let params = json!({ "command": format!("rungwise.plc.{verb}"), "arguments": [argument] });
        self.client.request("workspace/executeCommand", params)
    }

    #[track_caller]
    pub fn tell(&mut self, verb: &str, more: Value) -> Value {
        let answer = self.answer(verb, more);
        assert!(answer["error"].is_null(), "{answer}");
        answer["result"].clone()
    }

    /// The next picture that is wanted.
    pub fn picture(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        let is_one = |message: &Value| message["method"] == "rungwise/monitor" && wanted(&message["params"]);
        self.client.wait_for("a picture", is_one)["params"].clone()
    }
}

/// How the element of a kind on a line is painted.
fn energised(picture: &Value, line: u64, kind: &str) -> Option<bool> {
    let elements = picture["elements"].as_array()?;
    let on = elements
        .iter()
        .find(|element| element["kind"] == kind && element["range"]["start"]["line"].as_u64() == Some(line));
    on?["energised"].as_bool()
}

#[test]
fn a_program_is_compared_downloaded_watched_and_driven() {
    let mut editor = Connected::open(LIST);
    let plan = editor.tell("plan", json!({}));
    assert_eq!(
        (&plan["same"], &plan["before"], &plan["after"]),
        (&json!(false), &json!("END\n"), &json!(LIST))
    );
    let state = editor.tell("state", json!({}));
    assert_eq!(state["match"], "different");
    // Everything but END is new.
    assert_eq!(state["drift"].as_array().unwrap().len(), 7, "{state}");
    let done = editor.tell("download", json!({ "start": true, "confirmed": true }));
    assert_eq!((&done["mode"], &done["steps"]), (&json!("RUN"), &json!(14)), "{done}");
    let backup = std::fs::read_to_string(done["backup"].as_str().unwrap()).unwrap();
    assert!(backup.contains("fx2n"), "{backup}");
    let state = editor.tell("state", json!({}));
    assert_eq!(
        (&state["match"], &state["drift"], &state["mode"]),
        (&json!("same"), &json!([]), &json!("RUN"))
    );
    // Power in the text is that of the PLC.
    let all = json!([{ "start": { "line": 0, "character": 0 }, "end": { "line": 9, "character": 0 } }]);
    editor.tell("monitor", json!({ "ranges": all, "names": ["Y0", "D1", "T0"] }));
    let off = editor.picture(|_| true);
    assert_eq!(off["source"], "plc");
    assert_eq!(energised(&off, 3, "line"), Some(false), "{off}");
    editor.tell("force", json!({ "name": "X0", "value": true }));
    editor.tell("write", json!({ "name": "D0", "value": -7 }));
    let on = editor.picture(|picture| energised(picture, 3, "line") == Some(true));
    assert_eq!(energised(&on, 0, "line"), Some(true), "{on}");
    // Nothing is held in the PLC, whatever the values of the picture come from.
    assert!(on["elements"].as_array().unwrap().iter().all(|element| element["kind"] != "forced"), "{on}");
    let moved = editor.picture(|picture| picture["values"][1]["value"] == -7);
    assert_eq!(moved["values"][0]["value"], true);
    let shown = moved["elements"].as_array().unwrap();
    assert!(shown.iter().any(|element| element["kind"] == "value" && element["value"] == -7), "{moved}");
    // An edit that has not gone to the PLC shows.
    editor.client.change(&editor.uri.clone(), 2, (2, 0), (2, 3), "AND");
    editor.client.diagnostics(&editor.uri.clone(), 2);
    let state = editor.tell("state", json!({}));
    assert_eq!(
        (&state["match"], state["drift"][0]["start"]["line"].as_u64()),
        (&json!("different"), Some(2))
    );
    let uploaded = editor.tell("upload", json!({}));
    assert_eq!((&uploaded["text"], &uploaded["unread"]), (&json!(LIST), &json!(0)));
    let state = editor.tell("stop", json!({}));
    assert_eq!(state["mode"], "STOP");
    // X0 is still on, and no power flows.
    let still = editor.picture(|picture| picture["mode"] == "stopped");
    assert!(
        still["elements"].as_array().unwrap().iter().all(|element| element["energised"] == false),
        "{still}"
    );
    assert_eq!(editor.tell("start", json!({ "confirmed": true }))["mode"], "RUN");
    assert_eq!(editor.tell("disconnect", json!({}))["connected"], false);
    assert!(editor.answer("stop", json!({}))["error"]["message"].as_str().unwrap().contains("no PLC"));
}

#[test]
fn whoever_has_not_confirmed_is_asked_before_anything_moves() {
    let mut editor = Connected::open(LIST);
    for (choice, is_done) in [("No", false), ("Yes", true)] {
        let params = json!({ "command": "rungwise.plc.download", "arguments": [{ "uri": editor.uri, "start": true }] });
        let id = editor.client.ask("workspace/executeCommand", params);
        let question = editor.client.wait_for_method("window/showMessageRequest");
        let text = question["params"]["message"].as_str().unwrap();
        assert!(text.contains("The machine may move"), "{text}");
        editor.client.send(json!({ "jsonrpc": "2.0", "id": question["id"], "result": { "title": choice } }));
        let answer = editor.client.answer(id);
        assert_eq!(answer["error"].is_null(), is_done, "{answer}");
        assert_eq!(editor.tell("verify", json!({}))["same"], is_done);
    }
}

#[test]
fn what_is_wrong_is_said_and_the_server_goes_on() {
    let mut editor = Connected::open(LIST);
    for (verb, more, wanted) in [
        ("write", json!({ "name": "D0", "value": 70000 }), "D0 does not take 70000"),
        ("force", json!({ "name": "D0", "value": 1 }), "D0 is no relay"),
        ("write", json!({ "name": "Q7", "value": 1 }), "does not reach Q7"),
        ("write", json!({ "name": "D0" }), "value"),
        ("connect", json!({ "port": "tcp://127.0.0.1:1" }), "cannot be opened"),
    ] {
        let answer = editor.answer(verb, more.clone());
        let message = answer["error"]["message"].as_str().unwrap_or_default();
        assert!(message.contains(wanted), "{verb} {more}: {answer}");
    }
    let port = editor.port.clone();
    editor.tell("connect", json!({ "port": port }));
    drop(editor.plc.take());
    let lost =
        |message: &Value| message["method"] == "rungwise/plc" && message["params"]["reason"].is_string();
    let lost = editor.client.wait_for("the loss of the line", lost);
    assert!(lost["params"]["reason"].as_str().unwrap().contains("the line is gone"), "{lost}");
    assert_eq!(editor.tell("state", json!({})), json!({ "connected": false }));
    assert!(editor.tell("ports", json!({}))["ports"].is_array());
}
