//! `rungwise.plc.…`, `rungwise/plc` and `rungwise/monitor` over the protocol, with a virtual PLC at the other end.

use super::lsp_client::Client;
use crate::virtual_plc::{Pass, VirtualPlc, proxy};
use serde_json::{Value, json};
use std::sync::LazyLock;

/// All lines of the list.
static WHOLE: LazyLock<Value> = LazyLock::new(
    || json!([{ "start": { "line": 0, "character": 0 }, "end": { "line": 9, "character": 0 } }]),
);

const LIST: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nLD Y0\nOUT T0 K100\nMOV D0 D1\nEND\n";

/// An editor that is connected to a virtual PLC.
pub struct Connected {
    pub client: Client,
    pub uri: String,
    pub plc: Option<VirtualPlc>,
    pub port: String,
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
    // What somebody has seen and agreed to is another program than that in the PLC.
    let answer = editor.answer("download", json!({ "confirmed": true, "sum": "1234" }));
    assert!(answer["error"]["message"].as_str().unwrap().contains("no longer what was read"), "{answer}");
    let sum = &plan["sum"];
    let done = editor.tell("download", json!({ "start": true, "confirmed": true, "sum": sum }));
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
    // Other lines and names are no other program.
    editor.tell("monitor", json!({ "ranges": all, "names": ["Y0", "D1"] }));
    let is_of_two = |picture: &Value| picture["values"].as_array().unwrap().len() == 2;
    let moved = editor.picture(|picture| is_of_two(picture) && picture["values"][1]["value"] == -7);
    assert_eq!(moved["edition"], off["edition"]);
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
    let edition = off["edition"].as_u64().unwrap();
    editor.picture(|picture| picture["edition"].as_u64().unwrap() > edition);
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

/// Two rungs, and the same in the other order, which has the same sum.
const RUNGS: [&str; 2] = ["LD X0\nOUT Y0\nLD X1\nOUT Y1\n", "LD X1\nOUT Y1\nLD X0\nOUT Y0\n"];

#[test]
fn no_power_is_shown_in_a_program_that_is_not_known_to_be_in_the_plc() {
    let mut editor = Connected::open(&format!("{}END\n", RUNGS[0]));
    editor.tell("download", json!({ "start": true, "confirmed": true }));
    editor.tell("force", json!({ "name": "X0", "value": true }));
    let has_power = |picture: &Value| {
        picture["elements"].as_array().unwrap().iter().any(|element| element["energised"] == true)
    };
    let change = |editor: &mut Connected, version, text| {
        let uri = editor.uri.clone();
        editor.client.change(&uri, version, (0, 0), (4, 0), text);
        editor.client.diagnostics(&uri, version);
    };
    editor.tell("monitor", json!({ "ranges": WHOLE.clone() }));
    editor.picture(has_power);
    change(&mut editor, 2, RUNGS[1]);
    assert_eq!(editor.tell("state", json!({}))["match"], "different");
    let dark = |editor: &mut Connected, version: i64| {
        let first = editor.picture(|picture| picture["version"] == version);
        let last = first["scan"].as_u64().unwrap() + 10;
        assert!(!has_power(&first), "{first}");
        let is_over = |picture: &Value| has_power(picture) || picture["scan"].as_u64().unwrap() >= last;
        let picture = editor.picture(is_over);
        assert!(!has_power(&picture), "{picture}");
    };
    dark(&mut editor, 2);
    // Whoever connects anew knows nothing of what is in the PLC.
    editor.tell("disconnect", json!({}));
    let port = editor.port.clone();
    editor.tell("connect", json!({ "port": port }));
    editor.tell("monitor", json!({ "ranges": WHOLE.clone() }));
    dark(&mut editor, 2);
    assert_eq!(editor.tell("state", json!({}))["match"], "unknown");
    // What is there is read beside the looks; that it is the same is told before its power is shown.
    let before = editor.client.notified("rungwise/plc").len();
    change(&mut editor, 3, RUNGS[0]);
    editor.picture(|picture| picture["version"] == 3 && has_power(picture));
    let told = editor.client.notified("rungwise/plc").split_off(before);
    assert!(told.iter().any(|told| told["params"]["match"] == "same"), "{told:?}");
    assert_eq!(editor.tell("state", json!({}))["match"], "same");
}

#[test]
fn of_a_download_that_was_cut_it_is_told_that_what_is_there_is_not_known() {
    let (reached, is_reached) = std::sync::mpsc::channel();
    let (go_on, goes_on) = std::sync::mpsc::channel::<()>();
    let mut writes = 0;
    let long: String = (0..200).map(|n| format!("LD M{n}\nOUT M{}\n", n + 1)).collect();
    let mut editor = Connected::open_with(&format!("{long}END\n"), "", |plc| {
        proxy(plc.address(), move |body| {
            writes += usize::from(body.starts_with("E11"));
            if writes == 5 {
                writes += 1;
                reached.send(()).unwrap();
                goes_on.recv().unwrap();
            }
            Pass::On
        })
    });
    editor.tell("stop", json!({}));
    assert_eq!(editor.tell("plan", json!({}))["same"], false);
    while editor.client.take(|message| message["method"] == "rungwise/plc").is_some() {}
    let params = json!({ "command": "rungwise.plc.download", "arguments": [{ "uri": editor.uri, "confirmed": true }] });
    let id = editor.client.ask("workspace/executeCommand", params);
    is_reached.recv().unwrap();
    editor.client.notify("$/cancelRequest", json!({ "id": id }));
    let answer = editor.client.answer(id);
    assert!(!answer["error"].is_null(), "{answer}");
    go_on.send(()).unwrap();
    let unknown = editor.client.wait_for("that nothing is known", |message| {
        message["method"] == "rungwise/plc" && message["params"]["match"] == "unknown"
    });
    assert_eq!(unknown["params"]["mode"], "STOP");
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
        ("hold", json!({ "name": "D0", "value": 1 }), "monitor a program first"),
        ("panel", json!({}), "monitor a program first"),
        ("export", json!({ "format": "csv" }), "nothing was recorded"),
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

#[test]
fn what_is_held_is_written_again_until_it_is_released() {
    let mut editor = Connected::open(LIST);
    editor.tell("download", json!({ "start": true, "confirmed": true }));
    editor.tell("monitor", json!({ "names": ["D0"], "ranges": WHOLE.clone() }));
    let state = editor.tell("hold", json!({ "name": "D0", "value": 7 }));
    assert_eq!(state["held"], json!([{ "device": "D0", "value": 7 }]));
    let is = |value: i64, forced: bool| {
        move |picture: &Value| {
            picture["values"][0] == json!({ "device": "D0", "value": value, "forced": forced })
        }
    };
    let held = editor.picture(is(7, true));
    // Where the text names it, it is marked as something that is forced in a simulation.
    let is_mark = |element: &&Value| element["kind"] == "forced";
    let marks: Vec<&Value> = held["elements"].as_array().unwrap().iter().filter(is_mark).collect();
    assert_eq!(marks.len(), 1, "{held}");
    assert_eq!((&marks[0]["value"], &marks[0]["range"]["start"]["line"]), (&json!(7), &json!(6)));
    // Somebody else writes it: that is seen, and mended.
    editor.tell("write", json!({ "name": "D0", "value": 3 }));
    editor.picture(is(3, true));
    editor.picture(is(7, true));
    assert_eq!(editor.tell("release", json!({ "name": "D0" }))["held"], json!([]));
    editor.tell("write", json!({ "name": "D0", "value": 3 }));
    let first = editor.picture(is(3, false))["scan"].as_u64().unwrap();
    let later = editor.picture(|picture| picture["scan"].as_u64().unwrap() > first + 3);
    assert_eq!(later["values"][0]["value"], 3);
    // Orders to the CPU are not held; what is held is let go with the program that stops, and that is told.
    let refused = editor.answer("hold", json!({ "name": "M8037", "value": 1 }));
    assert!(refused["error"]["message"].as_str().unwrap().contains("M8037"), "{refused}");
    for (verb, device) in [("stop", "M5"), ("unmonitor", "D5"), ("disconnect", "T0")] {
        editor.tell("monitor", json!({ "names": ["D0"] }));
        editor.tell("hold", json!({ "name": device, "value": 1 }));
        editor.tell(verb, json!({}));
        let told = editor.client.wait_for("what is no longer held", |message| {
            message["method"] == "window/showMessage"
                && message["params"]["message"].as_str().unwrap().contains("no longer held")
        });
        assert!(told["params"]["message"].as_str().unwrap().contains(&format!("{device}=1")), "{told}");
    }
}

#[test]
fn what_is_held_is_let_go_when_somebody_turns_the_switch_or_the_text_is_no_program_of_a_plc() {
    let mut editor = Connected::open(LIST);
    let held = |editor: &mut Connected, device: &str| {
        editor.tell("monitor", json!({ "names": ["D0"], "ranges": WHOLE.clone() }));
        editor.tell("hold", json!({ "name": device, "value": 1 }));
    };
    let told = |editor: &mut Connected, device: &str| {
        editor.client.wait_for("what is no longer held", |message| {
            message["method"] == "window/showMessage"
                && message["params"]["message"].as_str().unwrap().contains(&format!("{device}=1"))
        });
    };
    editor.tell("start", json!({ "confirmed": true }));
    held(&mut editor, "M5");
    editor.plc.as_mut().unwrap().tell("stop");
    told(&mut editor, "M5");
    assert_eq!(editor.tell("state", json!({}))["held"], json!([]));
    held(&mut editor, "D5");
    let uri = editor.uri.clone();
    editor.client.change(&uri, 2, (0, 0), (0, 0), "(* dialect: iec *)\n");
    told(&mut editor, "D5");
    assert!(editor.tell("state", json!({}))["monitoring"].is_null());
}

#[test]
fn what_is_held_is_let_go_when_the_line_is_gone_or_the_document_closed() {
    let mut editor = Connected::open(LIST);
    let told = |editor: &mut Connected| {
        editor.client.wait_for("what is no longer held", |message| {
            message["method"] == "window/showMessage"
                && message["params"]["message"].as_str().unwrap().contains("D0=1")
        });
    };
    editor.tell("monitor", json!({ "names": ["D0"] }));
    editor.tell("hold", json!({ "name": "D0", "value": 1 }));
    let uri = editor.uri.clone();
    editor.client.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
    told(&mut editor);
    editor.client.open(&uri, "plc-il", LIST);
    editor.tell("monitor", json!({ "names": ["D0"] }));
    editor.tell("hold", json!({ "name": "D0", "value": 1 }));
    drop(editor.plc.take());
    told(&mut editor);
}

#[test]
fn what_was_seen_is_a_chart_and_a_file_also_when_the_line_is_gone() {
    let mut editor = Connected::open(LIST);
    editor.tell("download", json!({ "start": true, "confirmed": true }));
    editor.tell("monitor", json!({ "names": ["X0"] }));
    editor.picture(|_| true);
    // What a chart asks for is read from then on, although no list of names has it.
    editor.tell("trace", json!({ "names": ["D1", "Y0"] }));
    editor.tell("force", json!({ "name": "X0", "value": true }));
    editor.tell("write", json!({ "name": "D0", "value": 5 }));
    let has = |signal: &Value, wanted: Value| {
        signal["points"].as_array().is_some_and(|points| points.iter().any(|point| point[1] == wanted))
    };
    let mut last = Value::Null;
    for _ in 0..1_000 {
        last = editor.tell("trace", json!({ "names": ["D1", "Y0"] }));
        if has(&last["signals"][0], json!(5)) && has(&last["signals"][1], json!(true)) {
            break;
        }
        editor.picture(|_| true);
    }
    let points = last["signals"][0]["points"].as_array().unwrap();
    let values: Vec<&Value> = points.iter().map(|point| &point[1]).collect();
    assert_eq!(values.last(), Some(&&json!(5)), "{last}");
    let times: Vec<u64> = points.iter().map(|point| point[0].as_u64().unwrap()).collect();
    assert!(times.is_sorted() && *times.last().unwrap() <= last["to"].as_u64().unwrap(), "{last}");
    // The panel has what the program uses, and what is named besides, as far as the port reaches it.
    let panel = editor.tell("panel", json!({ "names": ["D77", "Z0"] }));
    let rows: Vec<&str> =
        panel["rows"].as_array().unwrap().iter().map(|row| row["name"].as_str().unwrap()).collect();
    assert_eq!(rows, ["X0", "X1", "Y0", "T0", "D0", "D1", "D77"]);
    drop(editor.plc.take());
    editor.client.wait_for("the loss of the line", |message| {
        message["method"] == "rungwise/plc" && message["params"]["reason"].is_string()
    });
    let csv = editor.tell("export", json!({ "format": "csv", "names": ["X0", "D1"] }));
    let lines: Vec<&str> = csv["text"].as_str().unwrap().lines().collect();
    assert_eq!(lines[0], "scan,time_ms,X0,D1");
    assert!(lines[1].starts_with("0,0,0,"), "{csv}");
    assert!(lines.last().unwrap().ends_with(",1,5"), "{csv}");
    let vcd = editor.tell("export", json!({ "format": "vcd" }));
    let text = vcd["text"].as_str().unwrap();
    assert!(text.contains("$var wire 1") && text.contains(" D1 $end"), "{text}");
}
