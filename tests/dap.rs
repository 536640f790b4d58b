//! The debug adapter, as debuggers drive it.

use super::binary::folder;
use super::dap_client::Debugger;
use serde_json::{Value, json};
use std::path::PathBuf;
use tempfile::TempDir;

const MOTOR: &str =
    "LD X0\nOR Y0\nANI X1\nOUT Y0\n\nLD Y0\nOUT T0 K10\n\nLD T0\nOUT Y1\nLD M8013\nMOV K5 D0\nEND\n";
const DRAWN: &str = "|  X0        X1     Y0  |\n+--| |---+---|/|----( )-+\n|  Y0    |              |\n+--| |---+              |\n\n|  Y0               Y1  |\n+--| |--------------( )-+\n";

struct Program {
    folder: TempDir,
    path: PathBuf,
}

fn program(name: &str, text: &str) -> Program {
    let folder = folder(&[(name, text)]);
    let path = folder.path().canonicalize().unwrap().join(name);
    Program { folder, path }
}

/// A program that has stopped at its first instruction.
fn entered(program: &Program) -> Debugger {
    let mut debugger = Debugger::launch(&program.path, json!({}));
    assert_eq!(debugger.begin()["reason"], "entry");
    debugger
}

fn places(breakpoints: &[Value]) -> Vec<String> {
    let place = |breakpoint: &Value| match breakpoint["verified"] == true {
        true => format!("{}:{}", breakpoint["line"], breakpoint["column"]),
        false => breakpoint["message"].as_str().unwrap().to_string(),
    };
    breakpoints.iter().map(place).collect()
}

#[test]
fn instructions_rungs_and_scans_are_stepped_both_ways() {
    let motor = program("motor.il", MOTOR);
    let mut plc = entered(&motor);
    assert_eq!(plc.stack(), ["motor.il · LD X0 @1:1", "scan 0, 0 ms"]);
    plc.go("stepIn");
    assert_eq!(plc.stack()[0], "motor.il · OR Y0 @2:1");
    plc.go("next");
    assert_eq!(plc.here(), "motor.il · LD Y0 @6:1, scan 0, 0 ms");
    plc.ask("next", json!({ "threadId": 1, "granularity": "instruction" }));
    plc.event("stopped");
    assert_eq!(plc.stack()[0], "motor.il · OUT T0 K10 @7:1");
    plc.go("next");
    plc.go("next");
    assert_eq!(plc.here(), "motor.il · LD M8013 @11:1, scan 0, 0 ms");
    plc.go("next");
    assert_eq!(plc.here(), "motor.il · END @13:1, scan 0, 0 ms");
    plc.go("next");
    assert_eq!(plc.here(), "motor.il · LD X0 @1:1, scan 1, 10 ms");
    plc.go("stepOut");
    assert_eq!(plc.here(), "motor.il · LD X0 @1:1, scan 2, 20 ms");
    // Back over the border of a scan, and into one that was not stepped through.
    plc.go("stepBack");
    assert_eq!(plc.here(), "motor.il · END @13:1, scan 1, 10 ms");
    plc.go("stepBack");
    assert_eq!(plc.here(), "motor.il · MOV K5 D0 @12:1, scan 1, 10 ms");
    for _ in 0..19 {
        plc.go("stepBack");
    }
    assert_eq!(plc.here(), "motor.il · OR Y0 @2:1, scan 0, 0 ms");
    assert_eq!(plc.go("stepBack")["reason"], "step");
    assert_eq!(plc.go("stepBack")["reason"], "entry");
    assert_eq!(plc.here(), "motor.il · LD X0 @1:1, scan 0, 0 ms");
}

#[test]
fn values_are_those_of_the_instruction_and_what_is_done_is_met_again() {
    let motor = program("motor.il", MOTOR);
    let mut plc = entered(&motor);
    // Nothing of the scan was executed: it begins with the new value.
    assert_eq!(plc.console("set X0=1"), "1");
    plc.go("stepIn");
    plc.go("stepIn");
    plc.go("stepIn");
    assert_eq!((plc.stack()[0].as_str(), plc.value("Y0")), ("motor.il · OUT Y0 @4:1", "0".into()));
    assert_eq!(plc.console("set X0=0"), "1 (0 from the next scan on)");
    plc.go("stepIn");
    assert_eq!((plc.value("Y0"), plc.value("X0 and Y0")), ("1".into(), "1".into()));
    plc.go("stepOut");
    assert_eq!((plc.value("X0"), plc.value("Y0")), ("0".into(), "1".into()));
    plc.console("scan 100");
    plc.event("stopped");
    assert_eq!(
        (plc.here().as_str(), plc.value("T0"), plc.value("TS0")),
        ("motor.il · LD X0 @1:1, scan 101, 1010 ms", "10".into(), "1".into())
    );
    // Back to before the change, and on again: the same happens.
    plc.console("back Y1");
    plc.event("stopped");
    assert_eq!(plc.here(), "motor.il · LD X0 @1:1, scan 100, 1000 ms");
    plc.console("back Y0");
    plc.event("stopped");
    assert_eq!(plc.here(), "motor.il · LD X0 @1:1, scan 0, 0 ms");
    assert_eq!(plc.value("X0"), "1 (0 from the next scan on)");
    plc.console("run 1s");
    plc.event("stopped");
    assert_eq!(
        (plc.here().as_str(), plc.value("T0"), plc.value("Y0")),
        ("motor.il · LD X0 @1:1, scan 100, 1000 ms", "9".into(), "1".into())
    );
    // Another past has another future.
    plc.console("back Y0");
    plc.event("stopped");
    plc.console("set X0=0");
    plc.console("run 1s");
    plc.event("stopped");
    assert_eq!((plc.value("X0"), plc.value("Y0")), ("0".into(), "0".into()));
    assert_eq!(plc.refusal("evaluate", json!({ "expression": "back Y0", "context": "repl" })), {
        "Y0 has not changed before this scan"
    });
}

#[test]
fn breakpoints_move_to_instructions_and_stop_on_their_terms() {
    let motor = program("motor.il", MOTOR);
    let mut plc = entered(&motor);
    let set =
        plc.breakpoints(&motor.path, json!([{ "line": 5 }, { "line": 14 }, { "line": 3, "column": 5 }]));
    assert_eq!(places(&set), ["6:1", "no instruction stands here or below", "3:1"]);
    let other = plc.breakpoints(&PathBuf::from("/elsewhere.il"), json!([{ "line": 1 }]));
    assert_eq!(places(&other), ["this file is no part of the program that is debugged"]);
    let hit = plc.go("continue");
    assert_eq!((&hit["reason"], &hit["hitBreakpointIds"]), (&json!("breakpoint"), &json!([set[2]["id"]])));
    assert_eq!(plc.here(), "motor.il · ANI X1 @3:1, scan 0, 0 ms");
    plc.go("continue");
    assert_eq!(plc.here(), "motor.il · LD Y0 @6:1, scan 0, 0 ms");
    plc.go("continue");
    assert_eq!(plc.here(), "motor.il · ANI X1 @3:1, scan 1, 10 ms");
    plc.go("reverseContinue");
    assert_eq!(plc.here(), "motor.il · LD Y0 @6:1, scan 0, 0 ms");
    plc.go("reverseContinue");
    assert_eq!(plc.go("reverseContinue")["reason"], "entry");
    // A condition, a count, a message.
    let set = plc.breakpoints(
        &motor.path,
        json!([
            { "line": 4, "condition": "X0 and M8002 = 0" },
            { "line": 9, "hitCondition": "% 3", "logMessage": "scan of {T0}, {X0 or not X0}" },
            { "line": 1, "condition": "X0 and" },
            { "line": 1, "condition": "Q7" },
            { "line": 1, "hitCondition": "often" },
        ]),
    );
    let placed = places(&set);
    assert_eq!(placed[..2], ["4:1", "9:1"]);
    assert!(placed[2].starts_with("\"X0 and\" is no expression"), "{placed:?}");
    assert!(placed[3].contains("Q7") && placed[4].starts_with("\"often\" is no count"), "{placed:?}");
    plc.console("set X0=1");
    plc.said();
    plc.go("continue");
    assert_eq!(plc.here(), "motor.il · OUT Y0 @4:1, scan 1, 10 ms");
    plc.breakpoints(
        &motor.path,
        json!([{ "line": 9, "hitCondition": "%3", "logMessage": "T0 is {T0}, {X0 = 1}" }]),
    );
    plc.console("run 100ms");
    plc.event("stopped");
    assert_eq!(plc.said(), ["T0 is 0, 1", "T0 is 0, 1", "T0 is 0, 1"]);
}

#[test]
fn a_change_of_data_stops_behind_what_changed_it() {
    let motor = program("motor.il", MOTOR);
    let mut plc = Debugger::launch(&motor.path, json!({ "set": ["X0=1@50ms", "X0=0@70ms", "X1=1@200ms"] }));
    plc.begin();
    let info = plc.ask("dataBreakpointInfo", json!({ "name": "Y0", "variablesReference": 2 }));
    assert_eq!(
        (&info["dataId"], &info["accessTypes"]),
        (&json!("Y0"), &json!(["write", "readWrite"])),
        "{info}"
    );
    assert_eq!(plc.ask("dataBreakpointInfo", json!({ "name": "Q7" }))["dataId"], Value::Null);
    let set =
        plc.ask("setDataBreakpoints", json!({ "breakpoints": [{ "dataId": "Y0", "accessType": "write" }] }));
    assert_eq!(set["breakpoints"][0]["verified"], true, "{set}");
    let hit = plc.go("continue");
    assert_eq!((&hit["reason"], &hit["text"]), (&json!("data breakpoint"), &json!("Y0: 0 → 1")), "{hit}");
    assert_eq!((plc.here().as_str(), plc.value("Y0")), ("motor.il · LD Y0 @6:1, scan 5, 50 ms", "1".into()));
    assert_eq!(plc.said(), ["Y0: 0 → 1, by OUT Y0 (motor.il:4)"]);
    assert_eq!(plc.go("continue")["text"], "Y0: 1 → 0");
    assert_eq!(plc.here(), "motor.il · LD Y0 @6:1, scan 20, 200 ms");
    assert_eq!(plc.go("reverseContinue")["text"], "Y0: 0 → 1");
    assert_eq!(plc.here(), "motor.il · LD Y0 @6:1, scan 5, 50 ms");
    // An input changes where a scan begins, a register only when it is another value than before.
    plc.ask(
        "setDataBreakpoints",
        json!({ "breakpoints": [{ "dataId": "X0" }, { "dataId": "D0", "condition": "D0 = 5" }] }),
    );
    plc.go("continue");
    assert_eq!((plc.here().as_str(), plc.value("X0")), ("motor.il · LD X0 @1:1, scan 7, 70 ms", "0".into()));
    assert_eq!(plc.go("continue")["text"], "D0: 0 → 5");
    assert_eq!(plc.here(), "motor.il · END @13:1, scan 50, 500 ms");
    assert_eq!(
        plc.said(),
        [
            "Y0: 1 → 0, by OUT Y0 (motor.il:4)",
            "X0: 1 → 0, before the scan",
            "D0: 0 → 5, by MOV K5 D0 (motor.il:12)",
        ]
    );
}

#[test]
fn a_drawing_has_breakpoints_at_rungs_and_at_elements() {
    let drawn = program("motor.lad", DRAWN);
    let mut plc = entered(&drawn);
    assert_eq!(plc.stack()[0], "motor.lad · rung 1 @1:1");
    let locations = plc.ask("breakpointLocations", json!({ "source": { "path": drawn.path }, "line": 2 }));
    let columns = locations["breakpoints"].as_array().unwrap().iter().map(|place| place["column"].clone());
    let columns: Vec<Value> = columns.collect();
    assert!(columns.len() >= 3, "{locations}");
    let set =
        plc.breakpoints(&drawn.path, json!([{ "line": 2, "column": 15 }, { "line": 4 }, { "line": 7 }]));
    let found = places(&set);
    assert_eq!(found[0], "2:14", "{found:?}");
    plc.console("set X0=1");
    plc.go("continue");
    let stopped: Vec<String> = (0..4)
        .map(|_| {
            let here = plc.stack()[0].split(" @").last().unwrap().to_string();
            plc.go("continue");
            here
        })
        .collect();
    assert!(found.iter().all(|place| stopped.contains(place)), "{found:?} {stopped:?}");
    let scopes = plc.ask("scopes", json!({ "frameId": 1 }));
    assert_eq!(scopes["scopes"][0]["name"], "Instruction", "{scopes}");
}

#[test]
fn scopes_group_what_the_program_uses_and_values_are_set_and_forced() {
    let motor = program("motor.il", MOTOR);
    let mut plc = entered(&motor);
    let scopes = plc.ask("scopes", json!({ "frameId": 1 }));
    let scopes = scopes["scopes"].as_array().unwrap().clone();
    let names: Vec<&str> = scopes.iter().map(|scope| scope["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["Instruction", "Inputs", "Outputs", "Timers", "Registers", "Special devices"]);
    let list = |plc: &mut Debugger, scope: usize| {
        let body = plc.ask("variables", json!({ "variablesReference": scopes[scope]["variablesReference"] }));
        let variables = body["variables"].as_array().unwrap().clone();
        let shown = |v: &Value| format!("{}={}", v["name"].as_str().unwrap(), v["value"].as_str().unwrap());
        (variables.iter().map(shown).collect::<Vec<_>>().join(", "), variables)
    };
    assert_eq!(list(&mut plc, 0).0, "conducts=0, power behind it=0, X0=0");
    assert_eq!(list(&mut plc, 1).0, "X0=0, X1=0");
    assert_eq!(list(&mut plc, 5).0, "M8013=0");
    let (timers, parts) = list(&mut plc, 3);
    assert_eq!(timers, "T0=0");
    let parts = plc.ask("variables", json!({ "variablesReference": parts[0]["variablesReference"] }));
    let parts: Vec<&Value> =
        parts["variables"].as_array().unwrap().iter().map(|part| &part["name"]).collect();
    assert_eq!(parts, ["TS0", "TC0", "TN0"]);
    let registers = scopes[4]["variablesReference"].clone();
    let set = json!({ "variablesReference": registers, "name": "D0", "value": "H1F" });
    assert_eq!(plc.ask("setVariable", set)["value"], "31");
    assert_eq!(plc.ask("setExpression", json!({ "expression": "X1", "value": "on" }))["value"], "1");
    let refused = json!({ "variablesReference": 1, "name": "X0", "value": "5" });
    assert!(plc.refusal("setVariable", refused).contains("X0"));
    // A force holds against the program, and is shown as such.
    assert_eq!(plc.console("force Y0=on"), "1 (forced)");
    plc.console("scan 3");
    plc.event("stopped");
    assert_eq!((plc.value("Y0"), list(&mut plc, 2).0), ("1 (forced)".into(), "Y0=1 (forced), Y1=0".into()));
    assert_eq!(plc.console("release Y0"), "1");
    plc.go("next");
    assert_eq!(plc.value("Y0"), "0");
    plc.console("force D0=7");
    assert_eq!(plc.console("release"), "nothing is forced any more");
    // Expressions, help and what may be written.
    for (expression, value) in [
        ("D0 + 2 * 3 = 37", "1"),
        ("not X1 or D0 > 30", "1"),
        ("-(D0 - 1) / 4", "-7"),
        ("X1 xor Y0", "1"),
        ("H1F mod 10", "1"),
    ] {
        assert_eq!(plc.value(expression), value, "{expression}");
    }
    assert!(plc.console("help").contains("run 500ms"));
    assert!(plc.refusal("evaluate", json!({ "expression": "D0 / 0" })).contains("no value"));
    let offered = plc.ask("completions", json!({ "text": "fo", "column": 3 }));
    assert_eq!(offered["targets"][0]["label"], "force", "{offered}");
    let offered = plc.ask("completions", json!({ "text": "force y", "column": 8 }));
    let labels: Vec<&Value> =
        offered["targets"].as_array().unwrap().iter().map(|target| &target["label"]).collect();
    assert_eq!(labels, ["Y0", "Y1"]);
}

#[test]
fn routines_are_frames() {
    let text = "LD M8000\nCALL P1\nLD X0\nOUT Y0\nFEND\nP1\nLD X1\nOUT Y1\nLD X2\nOUT Y2\nSRET\nEND\n";
    let called = program("called.il", text);
    let mut plc = entered(&called);
    plc.breakpoints(&called.path, json!([{ "line": 8 }]));
    plc.go("continue");
    assert_eq!(plc.stack(), ["P1 · OUT Y1 @8:1", "called.il · CALL P1 @2:1", "scan 0, 0 ms"]);
    plc.go("next");
    assert_eq!(plc.stack()[0], "P1 · LD X2 @9:1");
    plc.go("stepOut");
    assert_eq!(plc.stack()[0], "called.il · LD X0 @3:1");
    plc.go("stepBack");
    assert_eq!(plc.stack()[0], "P1 · SRET @11:1");
    // A step over a rung passes what it calls.
    plc.breakpoints(&called.path, json!([]));
    plc.go("stepOut");
    plc.go("next");
    assert_eq!(plc.stack()[0], "called.il · FEND @5:1");
    plc.go("next");
    assert_eq!(plc.here(), "called.il · LD M8000 @1:1, scan 1, 10 ms");
    plc.go("next");
    assert_eq!(plc.stack()[0], "called.il · LD X0 @3:1");
}

#[test]
fn instructions_that_fail_are_stopped_at() {
    let text = "FOR K3\nLD M8000\nADD D1 K1 D1\nLD= D1 K2\nDIV K9 D0 D2\nNEXT\nLD X0\nOUT Y0\nEND\n";
    let failing = program("failing.il", text);
    let mut plc = entered(&failing);
    let hit = plc.go("continue");
    assert_eq!(
        (&hit["reason"], &hit["text"]),
        (&json!("exception"), &json!("division by zero; the instruction was not executed"))
    );
    // In the second of three rounds.
    assert_eq!(
        (plc.here().as_str(), plc.value("D1")),
        ("failing.il · DIV K9 D0 D2 @5:1, scan 0, 0 ms", "2".into())
    );
    let info = plc.ask("exceptionInfo", json!({ "threadId": 1 }));
    assert_eq!(info["exceptionId"], "failing.il:5", "{info}");
    plc.ask("setExceptionBreakpoints", json!({ "filters": [] }));
    plc.console("scan");
    plc.event("stopped");
    assert_eq!(plc.said(), ["division by zero; the instruction was not executed"]);
    assert_eq!(plc.refusal("exceptionInfo", json!({ "threadId": 1 })), "nothing has gone wrong here");
}

#[test]
fn a_scan_without_an_end_is_stopped_and_looked_into() {
    let endless = program("endless.il", "P0\nLD M8000\nINC D0\nLD M8000\nCJ P0\nEND\n");
    let mut plc = entered(&endless);
    let hit = plc.go("continue");
    assert_eq!(
        (&hit["reason"], &hit["text"]),
        (&json!("exception"), &json!("the scan does not end: it was stopped here"))
    );
    assert_eq!(plc.stack()[1], "scan 0, 0 ms");
    let deep = plc.value("D0");
    plc.go("stepBack");
    plc.go("stepIn");
    assert_eq!(plc.value("D0"), deep);
    plc.go("stepOut");
    assert_eq!(plc.stack().last().unwrap(), "scan 1, 10 ms");
}

#[test]
fn a_running_program_is_paused_and_restarted_with_its_new_text() {
    let motor = program("motor.il", MOTOR);
    let mut plc =
        Debugger::launch(&motor.path, json!({ "stopOnEntry": false, "speed": 1, "scanTime": "5ms" }));
    plc.ask("configurationDone", json!({}));
    assert_eq!(plc.refusal("next", json!({ "threadId": 1 })), "the program is running; pause it first");
    assert_eq!(plc.ask("evaluate", json!({ "expression": "Y1" }))["result"], "0");
    assert_eq!(plc.go("pause")["reason"], "pause");
    assert!(plc.stack()[0].starts_with("motor.il · LD X0"));
    std::fs::write(&motor.path, MOTOR.replace("OUT Y1", "OUT Y7")).unwrap();
    plc.go("stepIn");
    let said = plc.said().join("\n");
    assert!(said.starts_with("motor.il has changed on the disk"), "{said}");
    plc.go("stepIn");
    assert!(plc.said().is_empty());
    plc.breakpoints(&motor.path, json!([{ "line": 10 }]));
    plc.ask("restart", json!({}));
    assert_eq!(plc.event("breakpoint")["breakpoint"]["verified"], true);
    plc.event("stopped");
    assert!(plc.here().starts_with("motor.il · OUT Y7 @10:1, scan 0"), "{}", plc.here());
    // What cannot be run is said, and the old program stays.
    std::fs::write(&motor.path, "LD X0\nOUT\n").unwrap();
    let refused = plc.refusal("restart", json!({}));
    assert!(refused.starts_with("the program cannot be run; motor.il, line 2"), "{refused}");
    assert_eq!(plc.value("Y7"), "0");
    plc.ask("terminate", json!({}));
    plc.event("terminated");
    plc.ask("disconnect", json!({}));
    assert_eq!(plc.exit_code(), Some(0));
    drop(motor.folder);
}

#[test]
fn a_project_is_one_program_and_its_comments_are_shown() {
    let files = [
        (
            "rungwise.toml",
            "target = \"fx2n\"\nfiles = [\"first.il\", \"second.il\"]\ncomments = \"devices.csv\"\n",
        ),
        ("first.il", "LD X0\nOUT M0\n"),
        ("second.il", "LD M0\nOUT Y0\nEND\n"),
        ("devices.csv", "Device,Symbol,Comment\nX0,START,Start button\n"),
    ];
    let folder = folder(&files);
    let root = folder.path().canonicalize().unwrap();
    for path in [root.clone(), root.join("second.il"), root.join("rungwise.toml")] {
        let mut plc = Debugger::launch(&path, json!({ "set": { "X0": true } }));
        plc.begin();
        let sources = plc.ask("loadedSources", json!({}));
        assert_eq!(sources["sources"].as_array().unwrap().len(), 2, "{sources}");
        plc.breakpoints(&root.join("second.il"), json!([{ "line": 2 }]));
        plc.go("continue");
        assert_eq!(plc.stack()[0], "second.il · OUT Y0 @2:1");
        let shown = plc.ask("evaluate", json!({ "expression": "x0", "context": "hover" }));
        assert_eq!(shown["result"], "1", "{shown}");
        let inputs = plc.ask("variables", json!({ "variablesReference": 1 }));
        assert_eq!(inputs["variables"][0]["type"], "bit · START: Start button", "{inputs}");
    }
}

#[test]
fn nothing_that_a_client_sends_ends_the_adapter() {
    let motor = program("motor.il", MOTOR);
    let mut plc = Debugger::spawn();
    plc.write(b"garbage\r\n\r\nContent-Length: 5\r\n\r\n{nope");
    plc.write(b"Content-Length: many\r\n\r\nContent-Length: 2\r\n\r\n{}Content-Length: 4\r\n\r\nnull");
    for (command, arguments) in [
        ("stackTrace", json!({ "threadId": 1 })),
        ("continue", Value::Null),
        ("evaluate", json!({ "expression": "X0" })),
        ("launch", json!({})),
        ("launch", json!({ "program": "/nowhere/at/all.il" })),
        ("launch", json!({ "program": motor.path, "scanTime": -5 })),
        ("launch", json!({ "program": motor.path, "set": ["X0"] })),
        ("launch", json!({ "program": motor.path, "set": { "Q9": 1 } })),
        ("launch", json!({ "program": 7 })),
        ("teleport", json!({})),
        ("restart", json!({})),
    ] {
        plc.refusal(command, arguments);
    }
    plc.ask("initialize", json!({ "linesStartAt1": false, "columnsStartAt1": false, "locale": "zh-cn" }));
    plc.ask("launch", json!({ "program": motor.path, "stopOnEntry": true }));
    plc.begin();
    let stack = plc.ask("stackTrace", json!({}));
    assert_eq!(
        (&stack["stackFrames"][0]["line"], &stack["stackFrames"][0]["column"]),
        (&json!(0), &json!(0))
    );
    assert_eq!(
        places(&plc.breakpoints(&motor.path, json!([{ "line": 0 }, { "line": 4_000_000_000_u32 }])))[0],
        "0:0"
    );
    assert!(plc.refusal("stackTrace", json!({ "threadId": 9 })).contains("PLC"));
    for (command, arguments) in [
        ("variables", json!({ "variablesReference": -1 })),
        ("variables", json!({ "variablesReference": 987_654_321 })),
        ("scopes", json!({ "frameId": 77 })),
        ("completions", json!({ "text": "阀", "column": 9 })),
        ("completions", json!({ "text": "", "column": 0 })),
        ("breakpointLocations", json!({ "source": { "path": "x" }, "line": 0 })),
    ] {
        plc.ask(command, arguments);
    }
    for expression in
        ["", "(", &"(".repeat(5000), "not not", "阀门", "%", "9999999999999999999999 + 1", "- - D0 +"]
    {
        plc.refusal("evaluate", json!({ "expression": expression, "context": "repl" }));
    }
    for line in ["run x", "run", "scan -", "back Q7", "set X0", "set =", "force", "release Q7"] {
        plc.refusal("evaluate", json!({ "expression": line, "context": "repl" }));
    }
    // A client that goes while the program runs.
    plc.ask("continue", json!({ "threadId": 1 }));
    plc.hang_up();
    assert_eq!(plc.exit_code(), Some(0));
}

#[test]
fn the_console_says_why() {
    let motor = program("motor.il", MOTOR);
    let mut plc = entered(&motor);
    plc.console("set X0=1");
    plc.console("scan 5");
    plc.event("stopped");
    let on = "Y0 is on: OUT Y0 has power  [motor.il:4]\n  X0 is on: an input, since scan 0 (0 ms)  [motor.il:1]\n  \
              X1 is off: an input  [motor.il:3]";
    // Where a scan begins, the one before it is the answer.
    assert_eq!(plc.console("why Y0"), on);
    // Within the scan, behind the coil, it is this scan.
    plc.go("next");
    assert_eq!(plc.console("why Y0"), on);
    assert_eq!(
        plc.console("why D0"),
        "D0 is 0: nothing that drives it has done so yet\n  \
        MOV K5 D0 has no power  [motor.il:12]\n    \
        M8013 is off: the PLC itself drives it  [motor.il:11]"
    );
    // A coil at which it stands has not acted.
    plc.console("set X1=1");
    plc.go("stepOut");
    (0..3).for_each(|_| drop(plc.go("stepIn")));
    assert_eq!(plc.here(), "motor.il · OUT Y0 @4:1, scan 6, 60 ms");
    assert_eq!(plc.console("why Y0"), on.replacen("is on:", "is on since scan 0 (0 ms):", 1));
    plc.go("stepIn");
    assert!(plc.console("why Y0").starts_with("Y0 is off: OUT Y0 has no power"), "{}", plc.console("why Y0"));
    assert!(plc.refusal("evaluate", json!({ "expression": "why Q7", "context": "repl" })).contains("Q7"));
}

#[test]
fn the_way_back_ends_where_a_small_history_begins_and_it_is_said() {
    let motor = program("motor.il", MOTOR);
    std::fs::write(motor.folder.path().join("rungwise.toml"), "[simulate]\nhistory = \"1 MiB\"\n").unwrap();
    let mut plc = entered(&motor);
    plc.console("scan 120000");
    plc.event("stopped");
    plc.said();
    assert_eq!(plc.go("reverseContinue")["reason"], "entry");
    let begin = plc.here();
    let scan = begin.split("scan ").nth(1).and_then(|rest| rest.split(',').next()?.parse::<u64>().ok());
    assert!(scan.is_some_and(|scan| scan > 50_000), "{begin}");
    let said = plc.said().join("\n");
    assert!(said.starts_with("the history begins here: 1 MiB hold no more"), "{said}");
    // In the first scan that is known there is no instruction before the first.
    while plc.go("stepBack")["reason"] == "step" {
        plc.said();
    }
    assert!(plc.said().join("\n").starts_with("the history begins here"));
}
