//! Programs in IEC 61131-3 in the debug adapter.

use super::binary::folder;
use super::dap_client::Debugger;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const PLANT: &str = "\
FUNCTION Scale : INT
VAR_INPUT Raw : INT; END_VAR
LD Raw
MUL 10
ST Scale
END_FUNCTION

FUNCTION_BLOCK Motor
VAR_INPUT Run : BOOL; END_VAR
VAR_OUTPUT Speed : INT; END_VAR
VAR Delay : TON; END_VAR
CAL Delay(IN := Run, PT := T#20ms)
LD Delay.Q
JMPC fast
LD 1
ST Speed
RET
fast: LD 7
ST Speed
END_FUNCTION_BLOCK

PROGRAM Main
VAR Go : BOOL; Left, Right : Motor; Level : INT; Sum : ARRAY[1..3] OF INT; END_VAR
LD Go
ST Left.Run
CAL Left()
CAL Right(Run := FALSE)
LD Left.Speed
Scale
ST Level
LD Level
ADD 1
ST Sum[2]
END_PROGRAM
";

fn plant() -> (TempDir, PathBuf) {
    let folder = folder(&[("plant.il", PLANT)]);
    let path = folder.path().canonicalize().unwrap().join("plant.il");
    (folder, path)
}

/// The variables in what has a number, as `name = value`, and those that have parts with the number of these.
fn variables(plc: &mut Debugger, reference: &Value) -> (Vec<String>, Vec<Value>) {
    let body = plc.ask("variables", json!({ "variablesReference": reference }));
    let all = body["variables"].as_array().unwrap();
    let text = |variable: &Value, member: &str| variable[member].as_str().unwrap().to_string();
    let told = all.iter().map(|one| format!("{} = {}", text(one, "name"), text(one, "value"))).collect();
    (told, all.iter().map(|one| one["variablesReference"].clone()).collect())
}

/// The scopes of a frame, as names with numbers.
fn scopes(plc: &mut Debugger, frame: i64) -> Vec<(String, Value)> {
    let body = plc.ask("scopes", json!({ "frameId": frame }));
    let scopes = body["scopes"].as_array().unwrap().iter();
    scopes
        .map(|scope| (scope["name"].as_str().unwrap().to_string(), scope["variablesReference"].clone()))
        .collect()
}

fn entered(path: &Path) -> Debugger {
    let mut plc = Debugger::launch(path, json!({}));
    assert_eq!(plc.begin()["reason"], "entry");
    plc
}

#[test]
fn every_line_with_an_instruction_is_stopped_at() {
    let (_folder, path) = plant();
    let mut plc = entered(&path);
    let lines = PLANT.lines().zip(1..).filter(|(line, _)| {
        let first = line.trim_start_matches("fast: ").split([' ', '(']).next().unwrap_or_default();
        ["LD", "ST", "MUL", "ADD", "CAL", "JMPC", "RET", "Scale"].contains(&first)
    });
    let wanted: Vec<i64> = lines.map(|(_, line)| line).collect();
    assert_eq!(wanted.len(), 21);
    let asked: Vec<Value> = wanted.iter().map(|line| json!({ "line": line })).collect();
    let placed = plc.breakpoints(&path, json!(asked));
    let placed: Vec<i64> = placed.iter().map(|one| one["line"].as_i64().unwrap()).collect();
    assert_eq!(placed, wanted);
    // The same in an FX list, whatever stands there.
    let fx = "LD X0\nLD X1\nANB\nMPS\nAND X2\nOUT Y0\nMPP\nOUT Y1\nNOP\nLD M8000\nCALL P1\nFOR K2\nLD X3\nOUT Y2\nNEXT\n\
              LD X4\nMC N0 M5\nLD X5\nOUT Y3\nMCR N0\nSTL S0\nLD X6\nOUT Y4\nRET\nFEND\nP1\nLD X7\nOUT Y5\nSRET\nEND\n";
    let folder = folder(&[("all.il", fx)]);
    let path = folder.path().canonicalize().unwrap().join("all.il");
    let mut plc = entered(&path);
    let lines = (1..=30).filter(|line| *line != 26);
    let asked: Vec<Value> = lines.clone().map(|line| json!({ "line": line })).collect();
    let placed = plc.breakpoints(&path, json!(asked));
    assert!(placed.iter().zip(lines).all(|(one, line)| one["line"] == line), "{placed:?}");
    // Each is come to in a scan, but for what the step does not do and what a main program ends before.
    let mut passed = vec![1];
    while plc.go("continue")["reason"] == "breakpoint" {
        let stack = plc.stack();
        if stack.last().unwrap() != "scan 0, 0 ms" {
            break;
        }
        let line = stack[0].split('@').nth(1).unwrap().split(':').next().unwrap().parse::<i64>().unwrap();
        passed.push(line);
    }
    passed.sort_unstable();
    passed.dedup();
    let expected: Vec<i64> = (1..=29).filter(|line| ![22, 23, 26].contains(line)).collect();
    assert_eq!(passed, expected);
}

#[test]
fn a_line_of_a_parameter_belongs_to_its_call() {
    let text = "PROGRAM Main\nVAR a, y : BOOL; t : TON; END_VAR\nLD a\nCAL t(\n    IN := a,\n\n    PT := T#1s\n)\nLD t.Q\nST y\nEND_PROGRAM\n";
    let folder = folder(&[("call.il", text)]);
    let path = folder.path().canonicalize().unwrap().join("call.il");
    let mut plc = entered(&path);
    let asked: Vec<Value> = (4..=10).map(|line| json!({ "line": line })).collect();
    let placed = plc.breakpoints(&path, json!(asked));
    let placed: Vec<i64> = placed.iter().map(|one| one["line"].as_i64().unwrap()).collect();
    assert_eq!(placed, [4, 4, 4, 4, 4, 9, 10]);
    plc.go("continue");
    assert_eq!(plc.stack()[0], "Main · CAL t( @4:1");
}

#[test]
fn why_within_a_scan_looks_at_the_last_turn_of_what_comes_later() {
    let text =
        "PROGRAM Main\nVAR a, y : BOOL; n : INT; END_VAR\nLD a\nST y\nLD n\nMUL 2\nST n\nEND_PROGRAM\n";
    let folder = folder(&[("late.il", text)]);
    let path = folder.path().canonicalize().unwrap().join("late.il");
    let mut plc = entered(&path);
    let never = "nothing that drives it has done so yet";
    // In the first scan it has had none.
    assert_eq!(plc.console("why y"), format!("y is off: {never}\n  ST y is not executed  [late.il:4]"));
    plc.go("stepOut");
    plc.go("stepIn");
    let told = format!(
        "y is off: {never}\n  ST y has no power  [late.il:4]\n    a is off: nothing drives it  [late.il:3]"
    );
    assert_eq!(plc.console("why y"), told);
    assert!(plc.console("why n").contains("LD n, MUL 2, ST n is executed"), "{}", plc.console("why n"));
    plc.ask("evaluate", json!({ "expression": "set a=1", "context": "repl" }));
    plc.go("stepOut");
    plc.go("stepIn");
    // It stands at the coil, which has not acted.
    assert!(plc.console("why y").contains("ST y has no power"), "{}", plc.console("why y"));
    plc.go("stepIn");
    assert!(plc.console("why y").starts_with("y is on: ST y has power"), "{}", plc.console("why y"));
}

#[test]
fn instances_and_functions_are_frames_with_variables_of_their_own() {
    let (_folder, path) = plant();
    let mut plc = entered(&path);
    assert_eq!(plc.stack(), ["Main · LD Go @24:1", "scan 0, 0 ms"]);
    plc.breakpoints(&path, json!([{ "line": 13 }]));
    plc.go("continue");
    let call = "CAL Delay(IN := Run, PT := T#20ms)";
    assert_eq!(plc.stack(), ["Main.Left · LD Delay.Q @13:1", "Main · CAL Left() @26:1", "scan 0, 0 ms"]);
    // The same line in the other instance.
    plc.go("continue");
    assert_eq!(plc.stack()[..2], ["Main.Right · LD Delay.Q @13:1", "Main · CAL Right(Run := FALSE) @27:1"]);
    plc.go("stepBack");
    assert_eq!(plc.stack()[0], format!("Main.Right · {call} @12:1"));
    plc.go("reverseContinue");
    assert_eq!(plc.stack()[0], "Main.Left · LD Delay.Q @13:1");
    let names: Vec<String> = scopes(&mut plc, 1).into_iter().map(|(name, _)| name).collect();
    let own = ["Instruction", "Variables of Main.Left", "Variables of Main", "Variables of Scale"];
    assert_eq!(names, own);
    let left = scopes(&mut plc, 1)[1].1.clone();
    let (told, parts) = variables(&mut plc, &left);
    assert_eq!(told, ["Run = 0", "Speed = 0", "Delay = IN 0, PT T#20ms, Q 0, ET T#0s"]);
    assert_eq!(variables(&mut plc, &parts[2]).0, ["IN = 0", "PT = T#20ms", "Q = 0", "ET = T#0s"]);
    // The caller's frame has the caller's variables.
    let main = scopes(&mut plc, 2)[0].clone();
    assert_eq!(main.0, "Variables of Main");
    let (told, parts) = variables(&mut plc, &main.1);
    assert_eq!((told[0].as_str(), told[3].as_str()), ("Go = 0", "Level = 0"));
    assert_eq!(variables(&mut plc, &parts[4]).0, ["[1] = 0", "[2] = 0", "[3] = 0"]);
    // A name means the variable of the frame.
    assert_eq!((plc.value("Delay.PT"), plc.value("Delay.PT > T#10ms")), ("T#20ms".into(), "1".into()));
    let body = plc.ask("evaluate", json!({ "expression": "Left.Delay.PT", "frameId": 2 }));
    assert_eq!((&body["result"], &body["type"]), (&json!("T#20ms"), &json!("TIME")));
    plc.go("stepIn");
    let seen = scopes(&mut plc, 1)[0].1.clone();
    assert_eq!(variables(&mut plc, &seen).0, ["current result = 0"]);
    // The other arm of the jump.
    let set = json!({ "variablesReference": main.1, "name": "Go", "value": "TRUE" });
    assert_eq!(plc.ask("setVariable", set)["value"], "0 (1 from the next scan on)");
    plc.breakpoints(&path, json!([{ "line": 18 }]));
    plc.go("continue");
    assert_eq!(plc.here(), "Main.Left · LD 7 @18:7, scan 3, 30 ms");
    assert_eq!(
        (plc.value("Run"), plc.value("Delay.Q"), plc.value("Go")),
        ("1".into(), "1".into(), "1".into())
    );
    plc.go("stepOut");
    assert_eq!(plc.stack()[0], "Main · CAL Right(Run := FALSE) @27:1");
    plc.go("stepOut");
    assert_eq!(plc.here(), "Main · LD Go @24:1, scan 4, 40 ms");
    assert_eq!((plc.value("Level"), plc.value("Sum[2]")), ("70".into(), "71".into()));
    assert_eq!(plc.console("set Sum[3]=-4"), "-4");
    assert_eq!(plc.console("force Left.Speed=9"), "9 (forced)");
    plc.breakpoints(&path, json!([]));
    plc.go("stepOut");
    assert_eq!((plc.value("Level"), plc.value("Sum[3] - 1")), ("90".into(), "-5".into()));
}

#[test]
fn functions_data_and_uses_are_stopped_at() {
    let (_folder, path) = plant();
    let mut plc = entered(&path);
    let set = plc.ask(
        "setFunctionBreakpoints",
        json!({ "breakpoints": [{ "name": "scale" }, { "name": "Motor", "condition": "Speed = 1" }, { "name": "Pump" }] }),
    );
    assert_eq!((&set["breakpoints"][0]["line"], &set["breakpoints"][1]["line"]), (&json!(3), &json!(12)));
    assert_eq!(set["breakpoints"][2]["message"], "no label or program unit is called Pump");
    plc.go("continue");
    assert_eq!(plc.stack()[..2], ["Scale · LD Raw @3:1", "Main · Scale @29:1"]);
    assert_eq!(plc.value("Raw + 1"), "2");
    plc.go("continue");
    assert_eq!(plc.here().split(" · ").next(), Some("Main.Left"));
    plc.ask("setFunctionBreakpoints", json!({ "breakpoints": [] }));
    // A variable of an instance, as the client names it.
    let main = scopes(&mut plc, 2)[0].1.clone();
    let (_, parts) = variables(&mut plc, &main);
    let info = plc.ask("dataBreakpointInfo", json!({ "name": "Speed", "variablesReference": parts[1] }));
    assert_eq!(info["dataId"], "Main.Left.Speed", "{info}");
    plc.ask(
        "setDataBreakpoints",
        json!({ "breakpoints": [{ "dataId": "Main.Left.Speed", "accessType": "write" }] }),
    );
    plc.console("set Go=1");
    assert_eq!(plc.go("continue")["text"], "Main.Left.Speed: 1 → 7");
    assert_eq!(plc.said().last().unwrap(), "Main.Left.Speed: 1 → 7, by ST Speed (plant.il:19)");
    // Also where it stays the same, and where it is read.
    plc.ask(
        "setDataBreakpoints",
        json!({ "breakpoints": [{ "dataId": "Main.Left.Speed", "accessType": "readWrite" }] }),
    );
    let mut places = Vec::new();
    for _ in 0..3 {
        assert_eq!(plc.go("continue")["reason"], "data breakpoint");
        places.push(plc.here());
    }
    let scan = plc.stack().last().unwrap().clone();
    assert_eq!(places[0].split(',').next(), Some("Main · LD Left.Speed @28:1"));
    assert_eq!(places[1].split(',').next(), Some("Main.Left · ST Speed @19:1"));
    assert_eq!(places[2], format!("Main · LD Left.Speed @28:1, {scan}"));
}

#[test]
fn counts_hold_on_the_way_back_and_a_long_way_back_is_broken_off() {
    let (_folder, path) = plant();
    let mut plc = entered(&path);
    plc.breakpoints(&path, json!([{ "line": 30, "hitCondition": "% 4" }]));
    for scan in [3, 7, 11] {
        plc.go("continue");
        assert_eq!(plc.here(), format!("Main · ST Level @30:1, scan {scan}, {} ms", scan * 10));
    }
    for scan in [7, 3] {
        plc.go("reverseContinue");
        assert_eq!(plc.here(), format!("Main · ST Level @30:1, scan {scan}, {} ms", scan * 10));
    }
    plc.go("continue");
    assert_eq!(plc.here(), "Main · ST Level @30:1, scan 7, 70 ms");
    plc.go("reverseContinue");
    assert_eq!(plc.go("reverseContinue")["reason"], "entry");
    plc.go("continue");
    assert_eq!(plc.here(), "Main · ST Level @30:1, scan 3, 30 ms");
    plc.breakpoints(&path, json!([]));
    plc.ask("setExceptionBreakpoints", json!({ "filters": [] }));
    plc.console("scan 20000");
    plc.event("stopped");
    let here = plc.here();
    plc.breakpoints(&path, json!([{ "line": 30, "condition": "Level = 12345" }]));
    plc.send("reverseContinue", json!({ "threadId": 1 }));
    plc.send("pause", json!({ "threadId": 1 }));
    assert_eq!(plc.event("stopped")["reason"], "pause");
    assert_eq!(plc.here(), here);
    assert_eq!(plc.go("reverseContinue")["reason"], "entry");
}

const HANDED: &str = "\
FUNCTION_BLOCK Bump
VAR_IN_OUT x : INT; END_VAR
VAR_INPUT by : INT; END_VAR
LD x
ADD by
ST x
END_FUNCTION_BLOCK

PROGRAM Main
VAR total, other : INT; a : Bump; END_VAR
CAL a(x := total, by := 3)
CAL a(x := other, by := 2)
END_PROGRAM
";

#[test]
fn names_of_what_is_handed_over_mean_what_was_handed_over() {
    let folder = folder(&[("bump.il", HANDED)]);
    let path = folder.path().canonicalize().unwrap().join("bump.il");
    let mut plc = entered(&path);
    plc.breakpoints(&path, json!([{ "line": 6 }]));
    plc.go("continue");
    assert_eq!(plc.stack()[..2], ["Main.a · ST x @6:1", "Main · CAL a(x := total, by := 3) @11:1"]);
    plc.go("continue");
    assert_eq!(plc.stack()[..2], ["Main.a · ST x @6:1", "Main · CAL a(x := other, by := 2) @12:1"]);
    assert_eq!(
        (plc.value("x"), plc.value("x + 1"), plc.value("other")),
        ("0".into(), "1".into(), "0".into())
    );
    // In the next scan they have what was written to them.
    plc.go("continue");
    assert_eq!((plc.value("x"), plc.value("total"), plc.value("by")), ("3".into(), "3".into(), "3".into()));
    let all = scopes(&mut plc, 1);
    let names: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["Instruction", "Variables of Main.a", "Handed over to Main.a", "Variables of Main"]);
    assert_eq!(variables(&mut plc, &all[1].1).0, ["by = 3"]);
    assert_eq!(variables(&mut plc, &all[2].1).0, ["x = 3"]);
    // The caller has nothing of it.
    let names: Vec<String> = scopes(&mut plc, 2).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["Variables of Main"]);
    let info = plc.ask("dataBreakpointInfo", json!({ "name": "x", "variablesReference": all[2].1 }));
    assert_eq!(info["dataId"], "Main.total", "{info}");
    let set = json!({ "variablesReference": all[2].1, "name": "x", "value": "40" });
    assert_eq!(plc.ask("setVariable", set)["value"], "3 (40 from the next scan on)");
    plc.breakpoints(&path, json!([{ "line": 5, "condition": "x = 40" }]));
    plc.go("continue");
    assert_eq!(plc.stack()[1..], ["Main · CAL a(x := total, by := 3) @11:1", "scan 2, 20 ms"]);
    plc.breakpoints(&path, json!([{ "line": 5, "condition": "x = 4" }]));
    plc.go("continue");
    assert_eq!(plc.stack()[1..], ["Main · CAL a(x := other, by := 2) @12:1", "scan 2, 20 ms"]);
    // Who changes it is told where it is changed, under the name of who has it.
    plc.breakpoints(&path, json!([]));
    plc.ask(
        "setDataBreakpoints",
        json!({ "breakpoints": [{ "dataId": "Main.other", "accessType": "write" }] }),
    );
    assert_eq!(plc.go("continue")["text"], "Main.other: 4 → 6");
    assert_eq!(plc.said().last().unwrap(), "Main.other: 4 → 6, by ST x (bump.il:6)");
}

const DRAWN: &str = "\
FUNCTION_BLOCK Pump
VAR_INPUT Run : BOOL; END_VAR
VAR_OUTPUT Alarm : BOOL; END_VAR

|  Run                  Alarm |
+---| |------------------( )--+

END_FUNCTION_BLOCK

PROGRAM Main
VAR a, late, y : BOOL; t : TON; p : Pump; n : INT; END_VAR

|                 t                     |
|            +---------+                |
|    a       |   TON   |         late   |
+---| |------|IN      Q|----------( )---+
|   T#20ms---|PT       |                |
|            +---------+                |

|                 p                     |
|            +----------+               |
|  late      |   Pump   |          y    |
+---| |------|Run  Alarm|---------( )---+
|            +----------+               |

END_PROGRAM
";

#[test]
fn drawn_blocks_are_stopped_at_and_entered() {
    let folder = folder(&[("plant.lad", DRAWN)]);
    let path = folder.path().canonicalize().unwrap().join("plant.lad");
    let mut plc = entered(&path);
    // In the order of power: a timer has no instructions to step into, a declared block has.
    let mut passed = vec![plc.stack()[0].clone()];
    for _ in 0..10 {
        plc.go("stepIn");
        passed.push(plc.stack()[0].clone());
    }
    let expected = [
        "Main · rung 5 @13:1",
        "Main · | | a @16:5",
        "Main · TON t @14:14",
        "Main · ( ) late @16:35",
        "Main · rung 6 @20:1",
        "Main · | | late @23:5",
        "Main · Pump p @21:14",
        "Main.p · rung 2 @5:1",
        "Main.p · | | Run @6:5",
        "Main.p · ( ) Alarm @6:26",
        "Main · ( ) y @23:35",
    ];
    assert_eq!(passed, expected);
    // Over it, out of it, and back.
    let placed = plc.breakpoints(&path, json!([{ "line": 21 }, { "line": 6 }]));
    assert_eq!((&placed[0]["line"], &placed[1]["line"]), (&json!(21), &json!(6)), "{placed:?}");
    plc.go("continue");
    assert_eq!(plc.stack()[0], "Main · Pump p @21:14");
    plc.go("stepBack");
    assert_eq!(plc.stack()[0], "Main · | | late @23:5");
    plc.go("continue");
    assert_eq!(plc.stack()[0], "Main · Pump p @21:14");
    plc.go("continue");
    assert_eq!(plc.stack()[..2], ["Main.p · | | Run @6:5", "Main · Pump p @21:14"]);
    assert_eq!((plc.value("Run"), plc.value("Alarm")), ("0".into(), "0".into()));
    plc.go("stepOut");
    assert_eq!(plc.stack()[0], "Main · ( ) y @23:35");
    plc.breakpoints(&path, json!([{ "line": 21 }]));
    plc.go("continue");
    // The next rung is that of the next scan; the body between has a breakpoint no longer.
    plc.go("next");
    assert_eq!(plc.stack()[0], "Main · rung 5 @13:1");
}
