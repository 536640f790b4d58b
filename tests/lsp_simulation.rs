//! `rungwise.simulate.…` and `rungwise/monitor` over the protocol.

use super::lsp_client::Client;
use serde_json::{Value, json};

const MOTOR: &str = "|  X0        X1     Y0  |\n+--| |---+---|/|----( )-+\n|  Y0    |              |\n+--| |---+              |\n|  Y0          T0  K100 |\n+--| |---------------( )-+\n";
const LIST: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nOUT T0 K100\nEND\n";
const URI: &str = "file:///simulated/motor.il";

/// A program that a client has open and simulates.
pub struct Simulated {
    pub client: Client,
    pub uri: String,
}

impl Simulated {
    pub fn open(uri: &str, language: &str, text: &str) -> Simulated {
        let mut client = Client::start();
        client.open(uri, language, text);
        client.diagnostics(uri, 1);
        Simulated { client, uri: uri.to_string() }
    }

    pub fn answer(&mut self, verb: &str, more: Value) -> Value {
        let mut argument = json!({ "uri": self.uri });
        argument.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let params = json!({ "command": format!("rungwise.simulate.{verb}"), "arguments": [argument] });
        self.client.request("workspace/executeCommand", params)
    }

    #[track_caller]
    pub fn tell(&mut self, verb: &str, more: Value) -> Value {
        let answer = self.answer(verb, more);
        assert!(answer["error"].is_null(), "{answer}");
        answer["result"].clone()
    }

    /// The values of these names.
    pub fn values(&mut self, names: &[&str]) -> Vec<Value> {
        let state = self.tell("state", json!({ "names": names }));
        state["values"].as_array().unwrap().iter().map(|value| value["value"].clone()).collect()
    }

    /// The next picture that is wanted.
    pub fn picture(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        let is_one = |message: &Value| message["method"] == "rungwise/monitor" && wanted(&message["params"]);
        self.client.wait_for("a picture", is_one)["params"].clone()
    }
}

#[test]
fn a_program_is_stepped_set_forced_and_looked_back_into() {
    let mut plc = Simulated::open(URI, "plc-il", LIST);
    let state = plc.tell("start", json!({ "paused": true }));
    assert_eq!((&state["mode"], &state["scan"]), (&json!("paused"), &json!(0)), "{state}");
    plc.tell("set", json!({ "name": "X0", "value": true }));
    assert_eq!(plc.values(&["Y0"]), [json!(false)]);
    plc.tell("step", json!({}));
    assert_eq!(plc.values(&["Y0", "X0"]), [json!(true), json!(true)]);
    plc.tell("set", json!({ "name": "X0", "value": "off" }));
    let state = plc.tell("step", json!({ "count": 30 }));
    assert_eq!((&state["scan"], &state["time_ms"]), (&json!(31), &json!(310.0)), "{state}");
    assert_eq!(plc.values(&["Y0", "T0", "TS0"]), [json!(true), json!(3), json!(false)]);
    // Back past the click that started it, in one go and scan by scan.
    let state = plc.tell("stepBack", json!({ "changeOf": "Y0" }));
    assert_eq!((&state["scan"], plc.values(&["Y0"])), (&json!(0), vec![json!(false)]), "{state}");
    plc.tell("step", json!({ "count": 5 }));
    assert_eq!(plc.values(&["Y0"]), [json!(false)]);
    plc.tell("force", json!({ "name": "Y0", "value": 1 }));
    let state = plc.tell("step", json!({ "count": 2 }));
    assert_eq!((&state["forced"], plc.values(&["Y0"])), (&json!(["Y0"]), vec![json!(true)]), "{state}");
    plc.tell("stepBack", json!({}));
    assert_eq!(plc.values(&["Y0"]), [json!(true)]);
    plc.tell("release", json!({}));
    plc.tell("set", json!({ "name": "X1", "value": true }));
    plc.tell("step", json!({}));
    assert_eq!(plc.values(&["Y0"]), [json!(false)]);
    assert_eq!(plc.tell("stop", json!({}))["mode"], json!("stopped"));
    assert_eq!(plc.tell("state", json!({}))["mode"], json!("stopped"));
    let answer = plc.answer("step", json!({}));
    assert!(
        answer["error"]["message"].as_str().unwrap_or_default().contains("not being simulated"),
        "{answer}"
    );
}

#[test]
fn what_is_shown_is_painted_as_power_flowed() {
    let uri = "file:///simulated/motor.lad";
    let mut plc = Simulated::open(
        uri,
        "ladder",
        &MOTOR.replace("|  Y0          T0  K100 |\n+--| |---------------( )-+\n", ""),
    );
    plc.tell("start", json!({}));
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 3, "character": 0 } });
    plc.tell("watch", json!({ "ranges": [range], "names": ["Y0"] }));
    let off = plc.picture(|picture| picture["elements"].as_array().is_some_and(|all| !all.is_empty()));
    let energised = |picture: &Value, kind: &str| -> Vec<(u64, u64)> {
        let elements = picture["elements"].as_array().unwrap().iter();
        let on = elements.filter(|element| element["kind"] == kind && element["energised"] == json!(true));
        on.map(|element| {
            let start = &element["range"]["start"];
            (start["line"].as_u64().unwrap(), start["character"].as_u64().unwrap())
        })
        .collect()
    };
    assert_eq!((energised(&off, "contact"), energised(&off, "output")), (vec![], vec![]), "{off}");
    assert_eq!(
        (&off["source"], &off["mode"], &off["version"]),
        (&json!("simulator"), &json!("running"), &json!(1))
    );
    plc.tell("set", json!({ "name": "X0", "value": 1 }));
    let on = plc.picture(|picture| picture["values"][0]["value"] == json!(true));
    let mut contacts = energised(&on, "contact");
    contacts.sort_unstable();
    assert_eq!((contacts.first(), energised(&on, "output").len()), (Some(&(1, 3)), 1), "{on}");
    // Released, it holds itself: power comes through the branch, not through X0.
    plc.tell("set", json!({ "name": "X0", "value": 0 }));
    let later = |picture: &Value| picture["scan"].as_u64() > on["scan"].as_u64();
    let held = plc.picture(|picture| later(picture) && !energised(picture, "contact").contains(&(1, 3)));
    assert!(energised(&held, "contact").contains(&(3, 3)), "{held}");
    assert_eq!(energised(&held, "output").len(), 1, "{held}");
}

/// The names in a text that a picture marks as forced, as `line:name=value`.
fn forced(picture: &Value, text: &str) -> Vec<String> {
    let elements = picture["elements"].as_array().unwrap().iter().filter(|one| one["kind"] == "forced");
    let mut names: Vec<String> = elements
        .map(|one| {
            let place = |end: &str, part: &str| one["range"][end][part].as_u64().unwrap() as usize;
            let line = place("start", "line");
            let name =
                &text.lines().nth(line).unwrap()[place("start", "character")..place("end", "character")];
            format!("{}:{name}={}", line + 1, one["value"])
        })
        .collect();
    names.sort_unstable();
    names
}

#[test]
fn what_is_forced_is_marked_wherever_it_is_named() {
    let all = json!([{ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } }]);
    let text = MOTOR.replace("T0  K100 |", "M20      |")
        + "\n|  Y1                   |\n+--| |--[MOV D0 K2M20]--+\n";
    let mut plc = Simulated::open("file:///simulated/forced.lad", "ladder", &text);
    plc.tell("start", json!({}));
    plc.tell("watch", json!({ "ranges": all }));
    plc.picture(|picture| forced(picture, &text).is_empty());
    plc.tell("force", json!({ "name": "Y0", "value": 1 }));
    plc.picture(|picture| forced(picture, &text) == ["1:Y0=true", "3:Y0=true", "5:Y0=true"]);
    plc.tell("release", json!({}));
    plc.tell("force", json!({ "name": "M23", "value": 1 }));
    plc.tell("force", json!({ "name": "D0", "value": 7 }));
    plc.picture(|picture| forced(picture, &text) == ["9:D0=7", "9:M20=true"]);
    // A variable of one instance, and not the one of the same name beside it.
    let text = "FUNCTION_BLOCK Lamp\nVAR_INPUT Go : BOOL; END_VAR\nVAR Lit : BOOL; END_VAR\nLD Go\nST Lit\nEND_FUNCTION_BLOCK\n\
                PROGRAM Main\nVAR One : Lamp; Lit : BOOL; END_VAR\nCAL One(Go := TRUE)\nLD One.Lit\nST Lit\nEND_PROGRAM\n";
    let mut plc = Simulated::open("file:///simulated/forced.il", "plc-il", text);
    plc.tell("start", json!({}));
    plc.tell("watch", json!({ "ranges": all }));
    plc.tell("force", json!({ "name": "One.Lit", "value": false }));
    plc.picture(|picture| forced(picture, text) == ["10:One=false", "5:Lit=false"]);
    plc.tell("force", json!({ "name": "Main.Lit", "value": true }));
    plc.picture(|picture| forced(picture, text) == ["10:One=false", "11:Lit=true", "5:Lit=false"]);
}

#[test]
fn what_is_shown_belongs_to_the_scan_and_the_lines_that_are_shown() {
    let two_rungs = LIST.replace("END\n", "LD X0\nOUT Y5\nEND\n");
    let mut plc = Simulated::open(URI, "plc-il", &two_rungs);
    plc.tell("start", json!({ "paused": true }));
    plc.tell("step", json!({ "count": 3 }));
    let lines = |first: u32, last: u32| json!([{ "start": { "line": first, "character": 0 }, "end": { "line": last, "character": 0 } }]);
    plc.tell("watch", json!({ "ranges": lines(0, 4) }));
    plc.tell("set", json!({ "name": "X0", "value": true }));
    // So long that the scan itself is shown, and not looked up.
    std::thread::sleep(std::time::Duration::from_millis(50));
    plc.tell("step", json!({}));
    let has = |picture: &Value, line: u64, energised: bool| {
        picture["elements"].as_array().unwrap().iter().any(|element| {
            element["range"]["start"]["line"] == json!(line) && element["energised"] == json!(energised)
        })
    };
    plc.picture(|picture| has(picture, 3, true));
    plc.tell("stepBack", json!({ "count": 2 }));
    plc.tell("state", json!({}));
    plc.picture(|picture| picture["scan"] == json!(2) && has(picture, 3, false));
    plc.tell("set", json!({ "name": "X0", "value": true }));
    plc.tell("step", json!({}));
    plc.tell("watch", json!({ "ranges": lines(6, 7) }));
    plc.picture(|picture| has(picture, 6, true));
}

#[test]
fn orders_are_obeyed_in_the_order_in_which_they_come() {
    let mut plc = Simulated::open(URI, "plc-il", "LD X0\nINCP D0\nEND\n");
    plc.tell("start", json!({ "paused": true }));
    let rounds = 200;
    let mut last = 0;
    for _ in 0..rounds {
        for (verb, value) in [("set", 1), ("step", 1), ("set", 0), ("step", 1)] {
            let argument = json!({ "uri": URI, "name": "X0", "value": value });
            let params = json!({ "command": format!("rungwise.simulate.{verb}"), "arguments": [argument] });
            last = plc.client.ask("workspace/executeCommand", params);
        }
    }
    let answer = plc.client.answer(last);
    assert_eq!(answer["result"]["scan"], json!(2 * rounds), "{answer}");
    assert_eq!(plc.values(&["D0"]), [json!(rounds)]);
}

#[test]
fn an_edit_is_taken_over_and_devices_keep_their_values() {
    let mut plc = Simulated::open(URI, "plc-il", LIST);
    plc.tell("start", json!({ "paused": true }));
    plc.tell("set", json!({ "name": "X0", "value": true }));
    plc.tell("step", json!({}));
    plc.tell("set", json!({ "name": "X0", "value": false }));
    let uri = plc.uri.clone();
    plc.client.change(&uri, 2, (5, 0), (5, 0), "LD Y0\nOUT Y7\n");
    plc.client.diagnostics(&uri, 2);
    let is_there = (0..50).any(|_| {
        plc.tell("step", json!({}));
        std::thread::sleep(std::time::Duration::from_millis(20));
        plc.values(&["Y7", "Y0"]) == [json!(true), json!(true)]
    });
    assert!(is_there, "the new rung runs");
}

#[test]
fn orders_that_nobody_understands_are_refused_and_say_what_it_was() {
    let mut plc = Simulated::open(URI, "plc-il", LIST);
    plc.tell("start", json!({ "paused": true }));
    for (verb, more, said) in [
        ("sttep", json!({}), "rungwise.simulate.sttep"),
        ("export", json!({ "format": "svg" }), "format"),
        ("export", json!({ "format": "csv", "names": ["Y0", "Q7"] }), "Q7"),
    ] {
        let answer = plc.answer(verb, more);
        assert!(answer["error"]["message"].as_str().is_some_and(|told| told.contains(said)), "{answer}");
    }
    assert_eq!(plc.tell("state", json!({}))["scan"], json!(0));
}

#[test]
fn what_cannot_be_run_is_refused_with_its_line() {
    let mut plc = Simulated::open(URI, "plc-il", "LD X0\nOUT Y0\nLD X1\nCJ P5\nEND\n");
    let answer = plc.answer("start", json!({}));
    let message = answer["error"]["message"].as_str().unwrap_or_default();
    assert!(message.contains("line 4") && message.contains("P5"), "{answer}");
    let answer = plc.answer("set", json!({ "name": "X0" }));
    assert!(answer["error"]["message"].as_str().unwrap_or_default().contains("value"), "{answer}");
}

#[test]
fn an_endless_loop_is_told_at_its_jump_and_the_server_lives() {
    let mut plc = Simulated::open(URI, "plc-il", "P0\nLD M8000\nOUT Y0\nLD M8000\nCJ P0\nEND\n");
    let state = plc.tell("start", json!({}));
    let errors = state["errors"].as_array().unwrap();
    assert!(errors[0]["message"].as_str().unwrap().contains("does not end"), "{state}");
    assert!((0..=4).contains(&errors[0]["range"]["start"]["line"].as_i64().unwrap()), "{state}");
    plc.tell("stop", json!({}));
}

/// A reason and those behind it, each set in by a blank.
fn reasons(reason: &Value) -> String {
    let behind = reason["because"].as_array().unwrap().iter().map(reasons);
    let behind: String = behind.collect::<String>().lines().map(|line| format!(" {line}\n")).collect();
    let line = reason["range"]["start"]["line"].as_i64().map(|line| format!(" @{line}"));
    format!("{}{}\n{behind}", reason["text"].as_str().unwrap(), line.unwrap_or_default())
}

#[test]
fn why_is_answered_for_names_and_places_and_scans_and_in_the_hover() {
    let uri = "file:///simulated/why.lad";
    let mut plc = Simulated::open(uri, "ladder", &MOTOR.replace("T0  K100", " T0 K100"));
    let refused = plc.answer("why", json!({ "name": "Y0" }));
    assert!(refused["error"]["message"].as_str().unwrap().contains("not being simulated"), "{refused}");
    let hover = |plc: &mut Simulated| {
        let position = json!({ "line": 1, "character": 22 });
        let params = json!({ "textDocument": { "uri": uri }, "position": position });
        plc.client.request("textDocument/hover", params)["result"]["contents"]["value"].to_string()
    };
    assert!(!hover(&mut plc).contains("is off"));
    plc.tell("start", json!({ "paused": true }));
    plc.tell("set", json!({ "name": "X0", "value": true }));
    plc.tell("step", json!({ "count": 5 }));
    let why = plc.tell("why", json!({ "position": { "line": 1, "character": 22 } }));
    assert_eq!(
        reasons(&why),
        concat!(
            "Y0 is on: ( ) Y0 has power @1\n",
            " X0 is on: an input, since scan 1 (10 ms) @1\n",
            " X1 is off: an input @1\n"
        )
    );
    assert_eq!((&why["scan"], &why["time_ms"], &why["uri"]), (&json!(5), &json!(50.0), &json!(uri)), "{why}");
    let before = plc.tell("why", json!({ "name": "y0", "scan": 0 }));
    assert!(reasons(&before).starts_with("Y0 is off: ( ) Y0 has no power"), "{before}");
    let timer = plc.tell("why", json!({ "name": "T0" }));
    assert!(reasons(&timer).starts_with("the contact of T0 is off: 0 s of 10 s have passed"), "{timer}");
    let shown = hover(&mut plc);
    assert!(shown.starts_with("\"Y0 is on: ( ) Y0 has power\\n- X0 is on"), "{shown}");
    for wrong in [
        json!({ "name": "Q7" }),
        json!({ "name": "Y0", "scan": 99 }),
        json!({ "position": { "line": 4, "character": 0 } }),
        json!({}),
    ] {
        let refused = plc.answer("why", wrong);
        assert!(refused["error"]["message"].is_string(), "{refused}");
    }
}

#[test]
fn a_history_that_is_full_begins_later_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().canonicalize().unwrap().join(name);
    std::fs::write(at("rungwise.toml"), "[simulate]\nhistory = \"1 MiB\"\n").unwrap();
    std::fs::write(at("motor.il"), LIST).unwrap();
    let mut plc = Simulated::open(&format!("file://{}", at("motor.il").display()), "plc-il", LIST);
    plc.tell("start", json!({ "paused": true }));
    let known = plc.tell("stepBack", json!({}))["scan"].clone();
    assert_eq!(known, json!(0), "nothing is forgotten yet, so nothing is said");
    let first = plc.tell("step", json!({ "count": 120_000 }))["first_scan"].as_u64().unwrap();
    assert!(first > 50_000, "{first}");
    let said = |answer: Value| answer["error"]["message"].as_str().unwrap_or_default().to_string();
    let why = said(plc.answer("why", json!({ "name": "Y0", "scan": 7 })));
    assert_eq!(
        why,
        format!("the history begins at scan {}; what was before is not known any more", first + 1)
    );
    assert_eq!(plc.tell("stepBack", json!({ "count": 120_000 }))["scan"], json!(first));
    let refused = said(plc.answer("stepBack", json!({})));
    assert!(refused.starts_with("the history begins here: 1 MiB hold no more"), "{refused}");
    // What is reset has the same room.
    plc.tell("reset", json!({}));
    let first = plc.tell("step", json!({ "count": 120_000 }))["first_scan"].as_u64().unwrap();
    assert!(first > 50_000, "{first}");
}
