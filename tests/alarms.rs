//! `[[alarm]]` in `rungwise.toml`: read with its place, told by the simulator and by whoever watches a PLC.

use crate::binary::{folder, run};
use crate::lsp_plc::Connected;
use crate::virtual_plc::{Pass, VirtualPlc, proxy};
use rungwise::project::Manifest;
use rungwise::text::Language;
use serde_json::{Value, json};
use std::sync::{Arc, Mutex};

const TANK: &str = "LD X0\nINCP D10\nLD X3\nOUT Y3\nEND\n";
const FULL: &str =
    "[[alarm]]\nwhen = \"D10 > 100 and not X3\"\nmessage = \"Too full\"\nseverity = \"error\"\n";

#[test]
fn a_bad_alarm_is_told_at_its_place_in_both_languages() {
    for (manifest, marked, english, chinese) in [
        (
            "[[alarm]]\nwhen = \"X0\"\nmessage = \"a\"\n\n[[alarm]]\nwhen = \"D10 > > 3\"\nmessage = \"b\"",
            "D10 > > 3",
            "is no expression",
            "不是表达式",
        ),
        (
            "target = \"fx1s\"\n[[alarm]]\nwhen = \"X0 and D300\"\nmessage = \"a\"",
            "X0 and D300",
            "nothing called `D300`",
            "`D300`",
        ),
        (
            "[[alarm]]\nwhen = \"X0\"\nmessage = \"a\"\nfor = \"soon\"",
            "soon",
            "\"soon\" is no time",
            "\"soon\"",
        ),
        ("[[alarm]]\nwhen = \"X0\"\nmessage = \"a\"\nseverity = \"off\"", "\"off\"", "`off`", "`off`"),
    ] {
        let error = Manifest::read(manifest).unwrap_err();
        assert_eq!(error.span.of(manifest), marked, "{manifest}");
        for (language, wanted) in [(Language::English, english), (Language::SimplifiedChinese, chinese)] {
            let said = error.message.render(language);
            assert!(said.contains(wanted), "{said}");
        }
    }
    // What a program declares is not known to the manifest, and a text may end in the middle.
    for manifest in [
        "target = \"iec\"\n[[alarm]]\nwhen = \"Motor.Level >= 3 or %IX0.0 and Mode = Fast\"\nmessage = \"\"",
        "[[alarm]]\nwhen = \"TS0 or D0:32 > H1F\"\nmessage = \"\"\nfor = \"1.5s\"\nseverity = \"hint\"",
    ] {
        assert!(Manifest::read(manifest).is_ok(), "{manifest}");
    }
    let cut = "[[alarm]]\nwhen = \"(X0\"\nmessage = \"a\"";
    assert!(Manifest::read(cut).is_err());
    // Whatever somebody has written there, opening the folder does no harm.
    for (part, behind) in [("D0 + ", "1"), ("not ", "X0"), ("(", "X0"), ("- ", "D0"), ("X0 or ", "X1")] {
        let manifest = format!("[[alarm]]\nwhen = \"{}{behind}\"\nmessage = \"a\"", part.repeat(100_000));
        assert!(Manifest::read(&manifest).is_err(), "{part}");
    }
    let usual = format!("[[alarm]]\nwhen = \"{}X0\"\nmessage = \"a\"", "X0 or ".repeat(500));
    assert!(Manifest::read(&usual).is_ok());
}

#[test]
fn a_run_tells_when_alarms_are_raised_and_gone() {
    let manifest =
        "target = \"fx2n\"\n[[alarm]]\nwhen = \"X0 and not X1\"\nmessage = \"Jammed\"\nfor = \"50ms\"\n";
    let folder = folder(&[("rungwise.toml", manifest), ("tank.il", TANK)]);
    let arguments = [
        "run",
        "tank.il",
        "--watch",
        "X0",
        "--set",
        "X0=1@100ms",
        "--set",
        "X1=1@120ms",
        "--set",
        "X1=0@200ms",
        "--set",
        "X0=0@300ms",
        "--format",
        "json",
    ];
    let (code, out, err) = run(&folder, &arguments);
    assert_eq!(code, 0, "{err}");
    let answer: Value = serde_json::from_str(&out).unwrap();
    let told: Vec<(i64, bool)> = answer["alarms"]
        .as_array()
        .unwrap()
        .iter()
        .map(|told| (told["time_ms"].as_i64().unwrap(), told["raised"].as_bool().unwrap()))
        .collect();
    // The first time it held for 20 ms only.
    assert_eq!(told, [(250, true), (300, false)]);
    assert_eq!(answer["alarms"][0]["message"], "Jammed");
    let (_, out, _) = run(&folder, &arguments[..arguments.len() - 2]);
    assert!(out.contains("alarm at 250 ms: Jammed (X0 and not X1)\nalarm gone at 300 ms: Jammed\n"), "{out}");
    std::fs::write(folder.path().join("rungwise.toml"), "[[alarm]]\nwhen = \"Level > 3\"\nmessage = \"a\"")
        .unwrap();
    let (code, _, err) = run(&folder, &["run", "tank.il"]);
    assert!(code == 2 && err.contains("the alarm `Level > 3` is not watched"), "{err}");
}

#[test]
fn monitor_tells_alarms_of_a_plc_with_and_without_devices() {
    let folder = folder(&[("rungwise.toml", FULL), ("tank.il", TANK)]);
    let mut plc = VirtualPlc::start(folder.path(), &["--program", "tank.il", "--stepped"]);
    let port = plc.port.clone();
    plc.tell("D10=101");
    assert_eq!(plc.ask("D10"), "D10 = 101");
    let (code, out, err) = run(&folder, &["monitor", "--count", "2", "--port", &port]);
    assert_eq!(code, 0, "{err}");
    // Raised once, and no line about devices of which nobody asked.
    assert!(out.ends_with(" ms: Too full (D10 > 100 and not X3)\n"), "{out}");
    assert_eq!(out.lines().count(), 1, "{out}");
    let arguments = ["monitor", "Y3", "D10", "--count", "2", "--port", &port, "--format", "json"];
    let (_, out, _) = run(&folder, &arguments);
    let lines: Vec<Value> = out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines[0]["values"], json!({ "Y3": false, "D10": 101 }));
    let wanted =
        json!({ "when": "D10 > 100 and not X3", "message": "Too full", "severity": "error", "raised": true });
    assert_eq!(lines[1]["alarm"], wanted);
    // With the lock on, there is nothing to tell.
    plc.tell("X3=1");
    assert_eq!(plc.ask("X3"), "X3 = 1");
    let (code, out, err) = run(&folder, &["monitor", "--count", "2", "--port", &port]);
    assert_eq!((code, out.as_str()), (0, ""), "{err}");
    std::fs::write(folder.path().join("rungwise.toml"), "").unwrap();
    let (code, _, err) = run(&folder, &["monitor", "--count", "2", "--port", &port]);
    assert!(code == 2 && err.contains("[[alarm]]"), "{err}");
    std::fs::write(folder.path().join("rungwise.toml"), "[[alarm]]\nwhen = \"D10 >\"\nmessage = \"a\"")
        .unwrap();
    let (code, _, err) = run(&folder, &["monitor", "--count", "2", "--port", &port]);
    assert!(code == 2 && err.contains("rungwise.toml:2:9"), "{err}");
}

/// A project that calls some of its devices otherwise.
const CALLED: &str = "target = \"fx2n\"\ncomments = \"devices.csv\"\n[[alarm]]\n\
    when = \"Level > 100 and not Lock\"\nmessage = \"Too full\"\n";

#[test]
fn alarms_know_what_the_project_calls_its_devices() {
    let table = "device,symbol\nD10,Level\nX3,Lock\n";
    let folder = folder(&[("rungwise.toml", CALLED), ("devices.csv", table), ("tank.il", TANK)]);
    let arguments = ["run", "tank.il", "--watch", "D10", "--set", "D10=101", "--set", "X3=1@50ms"];
    let (code, out, err) = run(&folder, &arguments);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("alarm at 0 ms: Too full") && out.contains("alarm gone at 50 ms"), "{out}");
    let mut plc = VirtualPlc::start(folder.path(), &["--program", "tank.il"]);
    let port = plc.port.clone();
    plc.tell("D10=101");
    assert_eq!(plc.ask("D10"), "D10 = 101");
    let (code, out, err) = run(&folder, &["monitor", "--count", "1", "--port", &port]);
    assert!(code == 0 && out.contains("Too full (Level > 100 and not Lock)"), "{out}{err}");
    // What nothing is called is told when somebody watches.
    std::fs::write(folder.path().join("devices.csv"), "device,symbol\nD10,Level\n").unwrap();
    for arguments in [&["run", "tank.il"][..], &["monitor", "--count", "1", "--port", &port]] {
        let (code, _, err) = run(&folder, arguments);
        assert!(code == 2 && err.contains("is not watched") && err.contains("`Lock`"), "{err}");
    }
    // Devices that the model does not have are no such names.
    let wrong = CALLED.replace("Lock", "D9000");
    assert!(Manifest::read(&wrong).is_err() && Manifest::read(CALLED).is_ok());
    assert!(Manifest::read(&CALLED.replace("comments", "# ")).is_err());
}

#[test]
fn an_editor_is_told_of_alarms_by_the_names_of_the_project() {
    let mut editor = Connected::open_with(TANK, CALLED, |plc| plc.port.clone());
    let table = editor.folder.path().canonicalize().unwrap().join("devices.csv");
    let called = |editor: &mut Connected, text: &str, kind: u32| {
        std::fs::write(&table, text).unwrap();
        let changes = json!({ "changes": [{ "uri": format!("file://{}", table.display()), "type": kind }] });
        editor.client.notify("workspace/didChangeWatchedFiles", changes);
    };
    editor.tell("write", json!({ "name": "D10", "value": 101 }));
    editor.tell("monitor", json!({}));
    called(&mut editor, "device,symbol\nD10,Level\nX3,Lock\n", 1);
    assert_eq!(alarm(&mut editor, true)["when"], "Level > 100 and not Lock");
    // Another device is called so from now on.
    called(&mut editor, "device,symbol\nD11,Level\nX3,Lock\n", 2);
    assert_eq!(alarm(&mut editor, false)["ended"], false);
}

/// The next alarm.
fn alarm(editor: &mut Connected, is_raised: bool) -> Value {
    let is_one = |message: &Value| {
        message["method"] == "rungwise/alarm" && message["params"]["raised"].as_bool() == Some(is_raised)
    };
    editor.client.wait_for("an alarm", is_one)["params"].clone()
}

#[test]
fn an_editor_is_told_of_the_alarms_of_a_plc_that_it_watches() {
    let requests = Arc::<Mutex<Vec<String>>>::default();
    let seen = Arc::clone(&requests);
    let mut editor = Connected::open_with(TANK, FULL, |plc| {
        proxy(plc.address(), move |body| {
            seen.lock().unwrap().push(body.to_string());
            Pass::On
        })
    });
    editor.tell("download", json!({ "start": true, "confirmed": true }));
    let all = json!([{ "start": { "line": 2, "character": 0 }, "end": { "line": 3, "character": 0 } }]);
    editor.tell("monitor", json!({ "ranges": all }));
    editor.picture(|_| true);
    editor.tell("write", json!({ "name": "D10", "value": 101 }));
    let raised = alarm(&mut editor, true);
    assert_eq!(
        (&raised["source"], &raised["message"], &raised["severity"]),
        (&json!("plc"), &json!("Too full"), &json!("error")),
        "{raised}"
    );
    let shown = editor.client.wait_for_method("window/showMessage");
    assert_eq!(shown["params"], json!({ "type": 1, "message": "PLC: Too full (D10 > 100 and not X3)" }));
    // The devices of the alarm are not on the screen; they are read with those that are.
    requests.lock().unwrap().clear();
    let first = editor.picture(|_| true)["scan"].as_u64().unwrap();
    let last = editor.picture(|picture| picture["scan"].as_u64().unwrap() >= first + 5);
    let looks = requests.lock().unwrap().iter().filter(|body| body.starts_with("E001790")).count() as u64;
    let others: Vec<String> =
        requests.lock().unwrap().iter().filter(|body| body.contains("E004014")).cloned().collect();
    assert!(looks >= last["scan"].as_u64().unwrap() - first && others.is_empty(), "{looks} {others:?}");
    editor.tell("force", json!({ "name": "X3", "value": true }));
    assert_eq!(alarm(&mut editor, false)["ended"], false);
    // It comes again, and goes when nobody watches any more.
    editor.tell("force", json!({ "name": "X3", "value": false }));
    alarm(&mut editor, true);
    editor.tell("unmonitor", json!({}));
    assert_eq!(alarm(&mut editor, false)["ended"], true);
}

#[test]
fn an_editor_is_told_of_the_alarms_of_a_simulation() {
    let mut editor = Connected::open_with(TANK, FULL, |plc| plc.port.clone());
    let mut tell = |verb: &str, more: Value| {
        let mut argument = json!({ "uri": editor.uri });
        argument.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let params = json!({ "command": format!("rungwise.simulate.{verb}"), "arguments": [argument] });
        let answer = editor.client.request("workspace/executeCommand", params);
        assert!(answer["error"].is_null(), "{answer}");
    };
    tell("start", json!({ "paused": true }));
    tell("set", json!({ "name": "D10", "value": 101 }));
    tell("step", json!({ "count": 3 }));
    let raised = alarm(&mut editor, true);
    assert_eq!((&raised["source"], &raised["time_ms"]), (&json!("simulator"), &json!(10.0)), "{raised}");
    let shown = editor.client.wait_for_method("window/showMessage");
    assert_eq!(shown["params"]["message"], "in the simulation: Too full (D10 > 100 and not X3)");
    let mut tell = |verb: &str, more: Value| {
        let mut argument = json!({ "uri": editor.uri });
        argument.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let params = json!({ "command": format!("rungwise.simulate.{verb}"), "arguments": [argument] });
        editor.client.request("workspace/executeCommand", params)
    };
    // Before it was raised, it is not.
    tell("stepBack", json!({ "count": 3 }));
    tell("set", json!({ "name": "D10", "value": 0 }));
    tell("step", json!({}));
    assert_eq!(alarm(&mut editor, false)["ended"], false);
    // Another alarm in the manifest, which names what there is not, is told, too.
    let uri =
        format!("file://{}", editor.folder.path().canonicalize().unwrap().join("rungwise.toml").display());
    std::fs::write(
        editor.folder.path().join("rungwise.toml"),
        "[[alarm]]\nwhen = \"Level > 3\"\nmessage = \"a\"",
    )
    .unwrap();
    editor
        .client
        .notify("workspace/didChangeWatchedFiles", json!({ "changes": [{ "uri": uri, "type": 2 }] }));
    let refused = editor.client.wait_for("a message about the alarm", |message| {
        message["method"] == "window/showMessage"
            && message["params"]["message"].as_str().unwrap().contains("`Level > 3` is not watched")
    });
    assert_eq!(refused["params"]["type"], 1);
}
