//! The simulation of a program in several files: it is one, whichever of them somebody looks at.

use super::lsp_client::Client;
use crate::cli_link::copied;
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

/// A project that a client has open, and its simulation.
struct Line {
    client: Client,
    folder: TempDir,
}

impl Line {
    /// A copy of an example, of which these files are open.
    fn open(example: &str, files: &[&str]) -> Line {
        let folder = tempfile::tempdir().unwrap();
        copied(&Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(example), folder.path());
        let mut line = Line { client: Client::start(), folder };
        files.iter().for_each(|file| line.show(file));
        line
    }

    fn uri(&self, file: &str) -> String {
        let path = self.folder.path().canonicalize().unwrap().join(file);
        format!("file://{}", path.display())
    }

    /// Opens a file.
    fn show(&mut self, file: &str) {
        let text = std::fs::read_to_string(self.folder.path().join(file)).unwrap();
        let language = if file.ends_with(".lad") { "ladder" } else { "plc-il" };
        let uri = self.uri(file);
        self.client.open(&uri, language, &text);
        self.client.diagnostics(&uri, 1);
    }

    fn close(&mut self, file: &str) {
        let uri = self.uri(file);
        self.client.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
    }

    fn answer(&mut self, file: &str, verb: &str, more: Value) -> Value {
        let mut argument = json!({ "uri": self.uri(file) });
        argument.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let params = json!({ "command": format!("rungwise.simulate.{verb}"), "arguments": [argument] });
        self.client.request("workspace/executeCommand", params)
    }

    /// Tells the simulation something of somebody who looks at a file.
    #[track_caller]
    fn tell(&mut self, file: &str, verb: &str, more: Value) -> Value {
        let answer = self.answer(file, verb, more);
        assert!(answer["error"].is_null(), "{answer}");
        answer["result"].clone()
    }

    /// Shows all lines of a file.
    fn watch(&mut self, file: &str) {
        let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
        self.tell(file, "watch", json!({ "ranges": [range] }));
    }

    fn values(&mut self, file: &str, names: &[&str]) -> Vec<Value> {
        let state = self.tell(file, "state", json!({ "names": names }));
        state["values"].as_array().unwrap().iter().map(|value| value["value"].clone()).collect()
    }

    /// The next picture of a file that is wanted.
    fn picture(&mut self, file: &str, wanted: impl Fn(&Value) -> bool) -> Value {
        let uri = self.uri(file);
        let is_one = |message: &Value| {
            message["method"] == "rungwise/monitor"
                && message["params"]["uri"] == uri
                && wanted(&message["params"])
        };
        self.client.wait_for("a picture", is_one)["params"].clone()
    }

    /// The names of the files that the simulation says it runs.
    fn files(&mut self, asked: &str) -> Vec<String> {
        let state = self.tell(asked, "state", json!({}));
        let name = |uri: &Value| uri.as_str().unwrap().rsplit('/').next().unwrap().to_string();
        state["files"].as_array().unwrap().iter().map(name).collect()
    }
}

/// How many outputs of a picture, or lines with one, have power.
fn energised(picture: &Value, kind: &str) -> usize {
    let elements = picture["elements"].as_array().unwrap().iter();
    elements.filter(|one| one["kind"] == kind && one["energised"] == json!(true)).count()
}

#[test]
fn each_file_of_a_program_shows_the_one_simulation_of_it() {
    let mut line = Line::open("packing-line", &["main.il", "filling.lad"]);
    line.tell("main.il", "start", json!({ "paused": true }));
    assert_eq!(line.files("filling.lad"), ["main.il", "filling.lad", "alarms.il"]);
    line.watch("main.il");
    line.watch("filling.lad");
    // What is done in the one is seen in the other; each has pictures of its own.
    line.tell("filling.lad", "set", json!({ "name": "X0", "value": true }));
    line.tell("main.il", "set", json!({ "name": "X2", "value": true }));
    line.tell("filling.lad", "step", json!({ "count": 2 }));
    assert_eq!(line.values("main.il", &["M0", "M1", "Y1"]), [json!(true), json!(true), json!(true)]);
    let main = line.picture("main.il", |picture| picture["scan"] == json!(2));
    let filling = line.picture("filling.lad", |picture| picture["scan"] == json!(2));
    assert!(energised(&main, "line") >= 6, "{main}");
    assert_eq!((energised(&filling, "output"), energised(&filling, "line")), (2, 0), "{filling}");
    // One that is opened later belongs to it as well, and to start again there starts the same anew.
    line.show("alarms.il");
    line.watch("alarms.il");
    line.tell("alarms.il", "step", json!({}));
    let alarms = line.picture("alarms.il", |picture| picture["scan"] == json!(3));
    assert!(energised(&alarms, "line") >= 2, "{alarms}");
    let state = line.tell("alarms.il", "start", json!({ "paused": true }));
    assert_eq!((&state["scan"], &state["branch"]), (&json!(0), &json!(1)), "{state}");
    assert_eq!(line.values("main.il", &["X0", "M1"]), [json!(true), json!(true)]);
    let uri = line.uri("filling.lad");
    let why = line.tell("main.il", "why", json!({ "name": "Y1" }));
    assert!(why["text"].as_str().unwrap().contains("Y1 is on") && why["uri"] == uri, "{why}");
    let position = json!({ "textDocument": { "uri": uri }, "position": { "line": 2, "character": 4 } });
    let hover = line.client.request("textDocument/hover", position);
    assert!(hover["result"]["contents"]["value"].as_str().unwrap().contains("X2 is on"), "{hover}");
    // It ends with the last of them.
    line.close("main.il");
    line.close("alarms.il");
    assert_eq!(line.tell("filling.lad", "step", json!({}))["mode"], "paused");
    line.close("filling.lad");
    line.picture("filling.lad", |picture| picture["mode"] == "stopped");
}

#[test]
fn an_edit_of_any_file_is_taken_over_and_a_mistake_in_any_is_told_with_its_file() {
    let mut line = Line::open("packing-line", &["main.il", "filling.lad"]);
    line.tell("main.il", "start", json!({ "paused": true }));
    line.watch("main.il");
    let (main, filling) = (line.uri("main.il"), line.uri("filling.lad"));
    // X3 in the place of X2: the box comes at another contact.
    line.client.change(&filling, 2, (2, 5), (2, 6), "3");
    line.picture("main.il", |picture| picture["edition"] == json!(1));
    line.client.change(&main, 2, (4, 3), (4, 5), "X");
    line.picture("main.il", |picture| picture["elements"].as_array().is_some_and(Vec::is_empty));
    let answer = line.answer("filling.lad", "start", json!({}));
    let message = answer["error"]["message"].as_str().unwrap_or_default();
    assert!(message.contains("line 5 (main.il)"), "{answer}");
    // The simulation that runs is the one before.
    assert_eq!(line.tell("filling.lad", "state", json!({}))["mode"], "paused");
    line.client.change(&main, 3, (4, 3), (4, 4), "X0");
    line.tell("main.il", "set", json!({ "name": "X0", "value": true }));
    line.picture("main.il", |picture| energised(picture, "line") > 0);
    assert_eq!(line.tell("filling.lad", "stop", json!({}))["mode"], "stopped");
    assert_eq!(line.tell("main.il", "state", json!({}))["mode"], "stopped");
}

#[test]
fn units_of_iec_in_files_of_their_own_are_shown_where_they_stand() {
    let mut line = Line::open("pump-station", &["configuration.il", "pump.lad", "station.il"]);
    line.tell("configuration.il", "start", json!({ "paused": true }));
    assert_eq!(line.files("station.il"), ["types.il", "pump.lad", "station.il", "configuration.il"]);
    for file in ["pump.lad", "station.il"] {
        line.watch(file);
    }
    line.tell("station.il", "step", json!({ "count": 300 }));
    let drawn = line.picture("pump.lad", |picture| picture["scan"] == json!(300));
    let listed = line.picture("station.il", |picture| picture["scan"] == json!(300));
    assert!(drawn["elements"].as_array().unwrap().len() > 10, "{drawn}");
    assert!(listed["elements"].as_array().unwrap().len() > 5, "{listed}");
}
