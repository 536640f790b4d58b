//! `rungwise.test.…`, its lenses and the recorder over the protocol.

use crate::binary::folder;
use crate::lsp_client::Client;
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

const MOTOR: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nOUT T0 K3\nLD T0\nOUT Y1\nEND\n";
const SUITE: &str = "[[scenario]]\nname = \"starts\"\nsteps = [\n  { at = 50, set = { X0 = 1 }, expect = { Y0 = 1 } },\n]\n\
    [[scenario]]\nname = \"stops\"\nsteps = [\n  { at = 50, set = { X0 = 1, X1 = 1 } },\n  { expect = { Y0 = 1 } },\n]\n";

struct Tested {
    client: Client,
    folder: TempDir,
}

impl Tested {
    fn start(files: &[(&str, &str)]) -> Tested {
        let folder = folder(files);
        let mut client = Client::spawn();
        let root = address(folder.path(), "");
        let params = json!({"processId": null, "rootUri": root.trim_end_matches('/'), "capabilities": {}});
        client.initialised = client.request("initialize", params)["result"].clone();
        client.notify("initialized", json!({}));
        Tested { client, folder }
    }

    fn uri(&self, name: &str) -> String {
        address(self.folder.path(), name)
    }

    #[track_caller]
    fn tell(&mut self, command: &str, argument: Value) -> Value {
        let params = json!({ "command": command, "arguments": [argument] });
        let answer = self.client.request("workspace/executeCommand", params);
        assert!(answer["error"].is_null(), "{answer}");
        answer["result"].clone()
    }

    fn open(&mut self, name: &str) -> String {
        let uri = self.uri(name);
        let text = std::fs::read_to_string(self.folder.path().join(name)).unwrap();
        let language = if name.ends_with(".toml") { "toml" } else { "plc-il" };
        self.client.open(&uri, language, &text);
        uri
    }

    /// The editor has another text now.
    fn write(&mut self, uri: &str, version: i64, text: &str) {
        let document = json!({ "uri": uri, "version": version });
        let params = json!({ "textDocument": document, "contentChanges": [{ "text": text }] });
        self.client.notify("textDocument/didChange", params);
    }

    /// The titles of the lenses of a document, with their commands.
    fn lenses(&mut self, uri: &str) -> Vec<(u64, String, Value)> {
        let document = json!({ "textDocument": { "uri": uri } });
        let lenses = self.client.request("textDocument/codeLens", document)["result"].clone();
        let lenses = lenses.as_array().cloned().unwrap_or_default();
        let resolved = lenses.into_iter().map(|lens| match lens["command"].is_null() {
            true => self.client.request("codeLens/resolve", lens)["result"].clone(),
            false => lens,
        });
        let told = resolved.map(|lens| {
            let line = lens["range"]["start"]["line"].as_u64().unwrap();
            (line, lens["command"]["title"].as_str().unwrap().to_string(), lens["command"].clone())
        });
        told.collect()
    }
}

fn address(folder: &Path, name: &str) -> String {
    let root = folder.canonicalize().unwrap();
    format!("file://{}", root.join(name).display())
}

#[test]
fn scenarios_of_the_workspace_are_listed_and_run_without_opening_anything() {
    let mut tested = Tested::start(&[
        ("motor.il", MOTOR),
        ("motor.test.toml", SUITE),
        ("deep/other.test.toml", "steps = []\nsteppes = 1"),
    ]);
    let listed = tested.tell("rungwise.test.list", json!({}));
    let files = listed["files"].as_array().unwrap();
    assert_eq!(files.len(), 2, "{listed}");
    assert_eq!(files[0]["problems"][0]["range"]["start"], json!({"line": 1, "character": 0}), "{listed}");
    assert_eq!(files[1]["uri"], json!(tested.uri("motor.test.toml")));
    assert_eq!(files[1]["program"], json!([tested.uri("motor.il")]));
    let names: Vec<&Value> =
        files[1]["scenarios"].as_array().unwrap().iter().map(|one| &one["name"]).collect();
    assert_eq!(names, ["starts", "stops"]);
    assert_eq!(files[1]["scenarios"][1]["range"]["start"], json!({"line": 6, "character": 8}));
    let ran =
        tested.tell("rungwise.test.run", json!({ "uri": tested.uri("motor.test.toml"), "coverage": true }));
    assert_eq!((&ran["passed"], &ran["failed"]), (&json!(1), &json!(1)), "{ran}");
    let failure = &ran["files"][0]["scenarios"][1]["failures"][0];
    let range = |start: u64, end: u64, line: u64| json!({"start": {"line": line, "character": start}, "end": {"line": line, "character": end}});
    assert_eq!((&failure["range"], &failure["actual"]), (&range(15, 17, 9), &json!("0")), "{ran}");
    assert_eq!(failure["program"], json!({ "uri": tested.uri("motor.il"), "range": range(4, 6, 3) }));
    assert!(ran["files"][0]["scenarios"][1]["picture"].as_str().unwrap().contains('^'));
    let contact = &ran["files"][0]["coverage"][0]["rungs"][0]["contacts"][0];
    assert_eq!((&contact["name"], &contact["range"]), (&json!("X0"), &range(0, 5, 0)), "{contact}");
    let one = tested.tell("rungwise.test.run", json!({ "uri": tested.uri("motor.il"), "names": ["starts"] }));
    assert_eq!((&one["passed"], &one["failed"]), (&json!(1), &json!(0)), "{one}");
}

#[test]
fn the_text_of_the_editor_is_run_saved_or_not() {
    let mut tested = Tested::start(&[("motor.il", MOTOR), ("motor.test.toml", SUITE)]);
    let (program, suite) = (tested.open("motor.il"), tested.open("motor.test.toml"));
    let run = json!({ "uri": suite, "names": ["stops"] });
    assert_eq!(tested.tell("rungwise.test.run", run.clone())["failed"], json!(1));
    tested.write(&program, 2, &MOTOR.replace("ANI X1\n", ""));
    assert_eq!(tested.tell("rungwise.test.run", run.clone())["failed"], json!(0));
    tested.write(&suite, 2, &SUITE.replace("{ expect = { Y0 = 1 } }", "{ expect = { Y0 = 0 } }"));
    assert_eq!(tested.tell("rungwise.test.run", run.clone())["failed"], json!(1));
    tested.write(&program, 3, "LD X0\nCJ P1\nEND\n");
    let stuck = tested.tell("rungwise.test.run", run);
    assert_eq!(
        (&stuck["failed"], &stuck["files"][0]["problems"][0]["uri"]),
        (&json!(1), &json!(program)),
        "{stuck}"
    );
    assert_eq!(stuck["files"][0]["problems"][0]["range"]["start"], json!({"line": 1, "character": 0}));
}

#[test]
fn mistakes_are_shown_while_a_file_is_typed() {
    let mut tested = Tested::start(&[("motor.il", MOTOR), ("motor.test.toml", SUITE)]);
    let suite = tested.open("motor.test.toml");
    tested.write(&suite, 2, &SUITE.replace("at = 50", "att = 50"));
    let found = tested.client.diagnostics(&suite, 2);
    assert_eq!(found.len(), 2, "{found:?}");
    assert_eq!(found[0]["range"]["start"], json!({"line": 3, "character": 4}));
    assert!(found[0]["message"].as_str().unwrap().contains("did you mean `at`"), "{found:?}");
    tested.write(&suite, 3, SUITE);
    assert_eq!(tested.client.diagnostics(&suite, 3), Vec::<Value>::new());
    // It is no program: nothing else is said of it.
    for method in ["documentSymbol", "formatting", "semanticTokens/full"] {
        let params =
            json!({ "textDocument": { "uri": suite }, "options": { "tabSize": 2, "insertSpaces": true } });
        assert_eq!(tested.client.request(&format!("textDocument/{method}"), params)["result"], Value::Null);
    }
}

#[test]
fn lenses_run_scenarios_in_clients_that_know_nothing_of_tests() {
    let mut tested = Tested::start(&[("motor.il", MOTOR), ("alone.il", MOTOR), ("motor.test.toml", SUITE)]);
    let suite = tested.open("motor.test.toml");
    let lenses = tested.lenses(&suite);
    let told: Vec<(u64, &str)> = lenses.iter().map(|(line, title, _)| (*line, title.as_str())).collect();
    assert_eq!(told, [(0, "Run scenarios"), (1, "Run scenario"), (6, "Run scenario")]);
    let command = lenses[2].2.clone();
    let answer = tested.client.request(
        "workspace/executeCommand",
        json!({ "command": command["command"], "arguments": command["arguments"] }),
    );
    assert_eq!(answer["result"]["failed"], json!(1), "{answer}");
    let found = tested.client.wait_for("what failed", |message| {
        message["method"] == "textDocument/publishDiagnostics"
            && message["params"]["diagnostics"].as_array().is_some_and(|found| !found.is_empty())
    });
    assert_eq!(found["params"]["diagnostics"][0]["range"]["start"], json!({"line": 9, "character": 15}));
    let message = tested.client.wait_for_method("window/showMessage");
    assert_eq!(message["params"]["type"], json!(1));
    let text = message["params"]["message"].as_str().unwrap();
    assert!(text.starts_with("0 passed, 1 failed: Y0 is 0 where 1 was expected"), "{text}");
    let program = tested.open("motor.il");
    let lenses = tested.lenses(&program);
    let told: Vec<(u64, &str)> =
        lenses.iter().take(2).map(|(line, title, _)| (*line, title.as_str())).collect();
    assert_eq!(told, [(0, "Simulate"), (0, "Run scenarios")]);
    assert_eq!(lenses[1].2["arguments"], json!([{ "uri": program, "show": true }]));
    assert_eq!(lenses[0].2["command"], json!("rungwise.simulate.start"));
    let alone = tested.open("alone.il");
    let titles: Vec<String> = tested.lenses(&alone).into_iter().map(|(_, title, _)| title).collect();
    assert!(
        titles.contains(&"Simulate".to_string()) && !titles.contains(&"Run scenarios".to_string()),
        "{titles:?}"
    );
}

#[test]
fn what_was_done_to_a_simulation_becomes_a_scenario_that_passes() {
    let mut tested = Tested::start(&[("motor.il", MOTOR)]);
    let uri = tested.open("motor.il");
    let mut tell = |verb: &str, more: Value| {
        let mut argument = json!({ "uri": uri });
        argument.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        tested.tell(&format!("rungwise.simulate.{verb}"), argument)
    };
    tell("start", json!({ "paused": true }));
    tell("step", json!({ "count": 4 }));
    tell("set", json!({ "name": "X0", "value": true }));
    tell("step", json!({ "count": 40 }));
    tell("set", json!({ "name": "X7", "value": true }));
    tell("step", json!({ "count": 5 }));
    // What is taken back was never done.
    tell("stepBack", json!({ "count": 7 }));
    tell("set", json!({ "name": "X0", "value": false }));
    tell("force", json!({ "name": "Y0", "value": 0 }));
    tell("step", json!({ "count": 2 }));
    tell("release", json!({}));
    tell("set", json!({ "name": "X1", "value": 1 }));
    tell("step", json!({ "count": 3 }));
    let recorded = tell("record", json!({}));
    assert_eq!(recorded["name"], json!("motor.test.toml"));
    let text = recorded["text"].as_str().unwrap();
    let expected = r#"program = "motor.il"
scan-time = "10ms"

[[scenario]]
name = "motor"
time = "470ms"
steps = [
  { at = "0ms", expect = { Y0 = 0, Y1 = 0 } },
  { at = "50ms", set = { X0 = 1 }, expect = { Y0 = 1 } },
  { at = "350ms", expect = { Y1 = 1 } },
  { at = "430ms", set = { X0 = 0 }, force = { Y0 = 0 }, expect = { Y0 = 0, Y1 = 0 } },
  { at = "450ms", set = { X1 = 1 }, release = ["Y0"] },
]
"#;
    assert_eq!(text, expected);
    std::fs::write(tested.folder.path().join("motor.test.toml"), text).unwrap();
    let ran = tested.tell("rungwise.test.run", json!({ "uri": tested.uri("motor.test.toml") }));
    assert_eq!((&ran["passed"], &ran["failed"]), (&json!(1), &json!(0)), "{ran:#}");
}

#[test]
fn what_happens_around_the_plc_is_recorded() {
    let program = "LD M8000\nRS D20 K2 D10 K8\nVRRD K0 D5\nFROM K0 K5 D6 K1\nOUT C235 K9\nLD C235\nOUT Y0\n\
                   LDP X0\nMOV H6B6F D20\nSET M8122\nLD M8123\nRST M8123\nLD> D10 K0\nOUT Y1\nEND\n";
    let mut tested = Tested::start(&[("cell.il", program)]);
    let uri = tested.open("cell.il");
    let mut tell = |verb: &str, more: Value| {
        let mut argument = json!({ "uri": uri });
        argument.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        tested.tell(&format!("rungwise.simulate.{verb}"), argument)
    };
    let value = |name: &str, value: Value| json!({ "name": name, "value": value });
    tell("start", json!({ "paused": true }));
    tell("step", json!({ "count": 2 }));
    tell("set", value("VR0", json!(12)));
    tell("set", value("U0\\G5", json!(-7)));
    tell("set", value("X0.pulses", json!(4)));
    tell("set", value("X0.pulses", json!(5)));
    tell("set", value("RS.received", json!("ok")));
    tell("set", value("RS.received", json!("'$02$03'")));
    tell("step", json!({ "count": 3 }));
    tell("set", value("X0", json!(1)));
    tell("step", json!({ "count": 3 }));
    let state = tell("state", json!({ "names": ["VR0", "U0\\G5", "RS.last", "D5", "D6"] }));
    let values: Vec<&Value> = state["values"].as_array().unwrap().iter().map(|one| &one["value"]).collect();
    assert_eq!(values, [&json!(12), &json!(-7), &json!("ok"), &json!(12), &json!(-7)]);
    let text = tell("record", json!({}))["text"].as_str().unwrap().to_string();
    let steps = r#"steps = [
  { at = "0ms", expect = { Y0 = 0, Y1 = 0 } },
  { at = "30ms", set = { VR0 = 12, "U0\\G5" = -7, "X0.pulses" = 4 } },
  { at = "30ms", set = { "X0.pulses" = 5 }, expect = { Y0 = 1, Y1 = 1 }, receive = ["ok", [0x02, 0x03]] },
  { at = "60ms", set = { X0 = 1 } },
  { at = "70ms", sent = "ok" },
]
"#;
    assert!(text.ends_with(steps), "{text}");
    std::fs::write(tested.folder.path().join("cell.test.toml"), &text).unwrap();
    let ran = tested.tell("rungwise.test.run", json!({ "uri": tested.uri("cell.test.toml") }));
    assert_eq!((&ran["passed"], &ran["failed"]), (&json!(1), &json!(0)), "{ran:#}");
}

#[test]
fn what_is_done_to_one_name_between_two_scans_is_recorded_in_its_order() {
    let program = "LD X0\nOUT Y0\nLD X1\nDIV D0 D1 D2\nLD M0\nOUT Y1\nEND\n";
    let mut tested = Tested::start(&[("order.il", program)]);
    let uri = tested.open("order.il");
    let mut tell = |verb: &str, more: Value| {
        let mut argument = json!({ "uri": uri });
        argument.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        tested.tell(&format!("rungwise.simulate.{verb}"), argument)
    };
    let value = |name: &str, value: i64| json!({ "name": name, "value": value });
    tell("start", json!({ "paused": true }));
    tell("set", value("X0", 1));
    tell("force", value("X0", 0));
    tell("step", json!({ "count": 2 }));
    tell("release", json!({ "name": "x0" }));
    tell("force", value("X0", 0));
    tell("step", json!({ "count": 2 }));
    tell("force", value("M0", 1));
    tell("release", json!({ "name": "M0" }));
    tell("set", value("M0", 0));
    tell("set", value("X1", 0));
    tell("set", value("x1", 1));
    tell("step", json!({ "count": 2 }));
    let text = tell("record", json!({}))["text"].as_str().unwrap().to_string();
    let expected = r#"program = "order.il"
scan-time = "10ms"

[[scenario]]
name = "order"
allow-errors = true
time = "60ms"
steps = [
  { at = "0ms", expect = { Y0 = 0, Y1 = 0 } },
  { at = "10ms", set = { X0 = 1 }, force = { X0 = 0 } },
  { at = "30ms", release = ["x0"] },
  { at = "30ms", force = { X0 = 0 } },
  { at = "50ms", force = { M0 = 1 }, release = ["M0"] },
  { at = "50ms", set = { M0 = 0, x1 = 1 } },
]
"#;
    assert_eq!(text, expected);
    std::fs::write(tested.folder.path().join("order.test.toml"), &text).unwrap();
    let ran = tested.tell("rungwise.test.run", json!({ "uri": tested.uri("order.test.toml") }));
    assert_eq!((&ran["passed"], &ran["failed"]), (&json!(1), &json!(0)), "{ran:#}");
}
