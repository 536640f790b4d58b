//! What is around a simulated PLC: modules, the serial port, trimmers, pulses, keypads. Through the binary and the
//! language server.

use crate::binary::{folder, run};
use crate::dap_client::Debugger;
use serde_json::{Value, json};

/// What a scenario of these steps gives with a program.
fn steps(program: &str, steps: &str) -> (i32, String, String) {
    let suite = format!("[[scenario]]\nname = \"one\"\nsteps = [\n{steps}\n]\n");
    let files =
        [("cell.il", program), ("cell.test.toml", suite.as_str()), ("rungwise.toml", "target = \"fx3u\"\n")];
    run(&folder(&files), &["test"])
}

#[track_caller]
fn passes(program: &str, text: &str) {
    let (code, out, err) = steps(program, text);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
}

#[track_caller]
fn fails(program: &str, text: &str, said: &str) {
    let (code, out, err) = steps(program, text);
    assert_eq!((code, err.as_str()), (1, ""), "{out}");
    assert!(out.contains(said), "{out}");
}

/// What a program gives when these are set: the values of the last row.
#[track_caller]
fn values(program: &str, settings: &[&str], watch: &str) -> Value {
    let files = [("cell.il", program), ("rungwise.toml", "target = \"fx3u\"\n")];
    let mut arguments = vec!["run", "cell.il", "--scans", "40", "--format", "json", "--watch", watch];
    settings.iter().for_each(|setting| arguments.extend(["--set", setting]));
    let (code, out, err) = run(&folder(&files), &arguments);
    assert_eq!(code, 0, "{out}{err}");
    let told: Value = serde_json::from_str(&out).unwrap();
    told["scans"].as_array().unwrap().last().unwrap()["values"].clone()
}

#[test]
fn buffer_memories_are_read_and_written() {
    let program = "LD M8000\nFROM K2 K7 D0 K1\nTO K2 K8 D0 K1\nLD X1\nRD3A K2 K1 D5\nEND\n";
    passes(
        program,
        r#"{ at = "30ms", set = { "U2\\G7" = -3 }, expect = { D0 = -3, U2.G8 = -3 } },
        { at = "60ms", set = { U2.G7 = 12 }, expect = { "u2\\g8" = 12, U2 = 1 } }"#,
    );
    fails(program, r#"{ set = { U2.G7 = 5 }, expect = { U2.G8 = 6 } }"#, "U2.G8 is 5 where 6 was expected");
    assert_eq!(values(program, &["U2\\G7=5@100ms"], "D0,U2\\G8")["U2\\G8"], 5);
}

#[test]
fn a_module_that_is_taken_away_does_not_answer() {
    let program = "LD M8000\nFROM K2 K7 D0 K1\nEND\n";
    fails(program, r#"{ set = { U2 = 0 }, expect = { D0 = 0 } }"#, "something went wrong in scan 0");
    let suite = "[[scenario]]\nname = \"one\"\nallow-errors = true\nsteps = [\
        { set = { U2 = 0 }, expect = { D8067 = 6708 } }, { at = 50, set = { U2 = 1, 'U2\\G7' = 4 }, expect = { D0 = 4 } }]\n";
    let (code, out, err) = run(&folder(&[("cell.il", program), ("cell.test.toml", suite)]), &["test"]);
    assert_eq!(code, 0, "{out}{err}");
}

/// Sends the three bytes in D20 when X0 comes, and takes frames to D10.
const TALK: &str = "LD M8000\nRS D20 K3 D10 K8\nLDP X0\nMOV H4241 D20\nMOV H0003 D21\nSET M8122\n\
                    LD M8123\nMOV D8123 D0\nMOV D10 D1\nANI X2\nRST M8123\nEND\n";

#[test]
fn frames_are_received() {
    passes(
        TALK,
        r#"{ at = "20ms", receive = "ok", expect = { D0 = 2, D1 = "H6B6F" } },
        { at = "60ms", receive = [0x02, 0x41, 0x03], expect = { D0 = 3, D1 = "H4102" } },
        { at = "100ms", receive = ["a", [0x62, 0x63]], expect = { D0 = 1, "RS.received" = "'bc'" } },
        { after = "1 scan", expect = { D0 = 2, D1 = "H6362" } }"#,
    );
    fails(TALK, r#"{ receive = "ok", expect = { D0 = 3 } }"#, "D0 is 2 where 3 was expected");
    let last = values(TALK, &["RS.received=ok@50ms", "RS.received='$02A$03'@100ms"], "D0,D1");
    assert_eq!((last["D0"].as_i64(), last["D1"].as_i64()), (Some(3), Some(0x4102)));
}

#[test]
fn frames_that_are_sent_are_expected() {
    // SET M8122 stands behind RS, which sends in the scan after.
    passes(
        TALK,
        r#"{ at = "50ms", pulse = { X0 = "10ms" }, sent = [0x41, 0x42, 3], within = "3 scans" },
        { at = "100ms", pulse = { X0 = "10ms" } }, { after = "1 scan", sent = "AB\u0003" },
        { after = "1 scan", expect = { RS.sent = "''", RS.last = "'AB$03'" } }"#,
    );
    fails(
        TALK,
        r#"{ at = "50ms", pulse = { X0 = "10ms" }, sent = "AC", within = "3 scans" }"#,
        "the frame 'AC' was not sent by scan 8 at 80 ms; the last one that was sent is 'AB$03'",
    );
    // What was sent before is not sent again.
    fails(
        TALK,
        r#"{ pulse = { X0 = "10ms" } }, { at = "100ms", sent = "AB\u0003", within = "100ms" }"#,
        "was not sent",
    );
    assert_eq!(values(TALK, &["X0=1@50ms"], "RS.last")["RS.last"], "AB\u{3}");
}

#[test]
fn trimmers_turn() {
    let program = "LD M8000\nVRRD K3 D0\nVRSC K3 D1\nEND\n";
    passes(
        program,
        r#"{ expect = { D0 = 0 } }, { at = 50, set = { VR3 = 128 }, expect = { D0 = 128, D1 = 5 } }"#,
    );
    fails(program, r#"{ set = { VR2 = 128 }, expect = { D0 = 128 } }"#, "D0 is 0 where 128 was expected");
    assert_eq!(values(program, &["VR3=200@50ms"], "D0")["D0"], 200);
    // Small CPUs have two of their own, and their positions in registers.
    let (small, suite) = (
        "LD M8000\nMOV D8031 D0\nEND\n",
        "[[scenario]]\nname = \"one\"\nsteps = [{ set = { VR1 = 9 }, expect = { D0 = 9 } }]\n",
    );
    let files = [("cell.il", small), ("cell.test.toml", suite), ("rungwise.toml", "target = \"fx1n\"\n")];
    let (code, out, err) = run(&folder(&files), &["test"]);
    assert_eq!(code, 0, "{out}{err}");
}

#[test]
fn amplifiers_tell_their_position_and_drives_theirs() {
    let program = "LD X0\nDABS X4 Y4 D2\nLD X1\nDDRVI K500 K1000 Y0 Y5\nEND\n";
    passes(
        program,
        r#"{ set = { ABS = -70000, X0 = 1 } }, { at = "500ms", expect = { "D2:32" = -70000 } },
        { at = "600ms", set = { X1 = 1 } },
        { at = "5s", expect = { Y0.position = 500, Y0.pulses = 500, Y0.frequency = 0 } }"#,
    );
    fails(
        program,
        r#"{ set = { ABS = 5, X0 = 1 } }, { at = "500ms", expect = { "D2:32" = 6 } }"#,
        "D2:32 is 5 where 6 was expected",
    );
    assert_eq!(values(program, &["ABS=5", "X0=1"], "D2")["D2"], 5);
}

#[test]
fn pulses_come_faster_than_scans() {
    let program = "LD M8000\nOUT C235 K1000\nOUT C241 K1000\nSPD X2 K100 D0\nLD C235\nOUT Y0\nEND\n";
    passes(
        program,
        r#"{ at = "50ms", pulses = { X0 = 40, C241 = 3 }, expect = { C235 = 40, X0.pulses = 40, C241.pulses = 3 } },
        { after = "1 scan", expect = { C235 = 40, X0.pulses = 0 } },
        { at = "100ms", pulses = { X0 = "2kHz for 500ms", X2 = "1500 Hz for 1s" } },
        { at = "600ms", expect = { C235 = 1040, Y0 = 1, D0 = 150 } }"#,
    );
    fails(program, r#"{ pulses = { X0 = 41 }, expect = { C235 = 40 } }"#, "C235 is");
    let last = values(program, &["X0.pulses=7@50ms", "X0.pulses=8@50ms", "C235.pulses=5@100ms"], "C235");
    assert_eq!(last["C235"], 20);
    let (code, _, err) = steps(program, r#"{ pulses = { X0 = "fast" }, expect = { Y0 = 0 } }"#);
    assert!(code == 2 && err.contains("2kHz for 500ms"), "{err}");
}

#[test]
fn keys_of_a_keypad_are_pressed() {
    let program = "LD X20\nOUT Y2\nLD M8000\nOUT Y1\nEND\n";
    passes(
        program,
        r#"{ at = 50, set = { Y1.X20 = 1 } }, { at = 70, expect = { Y2 = 1, Y1.X20 = 1 } },
        { at = 100, set = { Y1.X20 = 0 } }, { at = 120, expect = { Y2 = 0 } }"#,
    );
    fails(program, r#"{ set = { Y0.X20 = 1 } }, { at = 50, expect = { Y2 = 1 } }"#, "Y2 is 0 where 1");
    assert_eq!(values(program, &["Y1.X20=1@50ms"], "Y2")["Y2"], true);
}

#[test]
fn what_is_no_value_of_the_surroundings_is_told() {
    let told = |setting: &str| {
        let (code, _, err) = run(&folder(&[("cell.il", TALK)]), &["run", "cell.il", "--set", setting]);
        assert_eq!(code, 2, "{setting}");
        err
    };
    assert!(told("VR0=256").contains("0 to 255"));
    assert!(told("RS.received=5").contains("takes a frame in quotes"));
    assert!(told("RS.sent=ok").contains("what the program gives"));
    assert!(told("U8=1").contains("nothing called `U8`"));
    let (code, out, err) = steps(TALK, r#"{ force = { VR0 = 5 }, expect = { D0 = 0 } }"#);
    assert!(code != 0 && format!("{out}{err}").contains("cannot be forced"), "{out}{err}");
    let (_, _, err) = steps(TALK, r#"{ receive = 5, expect = { D0 = 0 } }"#);
    assert!(err.contains("a list of its bytes"), "{err}");
}

#[test]
fn the_console_of_the_debugger_sets_and_shows_them() {
    let folder = folder(&[("cell.il", TALK)]);
    let mut plc = Debugger::launch(&folder.path().canonicalize().unwrap().join("cell.il"), json!({}));
    plc.begin();
    assert_eq!(plc.console("set RS.received='o k'"), "'o k'");
    plc.console("scan 2");
    plc.event("stopped");
    assert_eq!(plc.console("D0"), "3");
    plc.console("set U0\\G5=7");
    plc.console("scan 1");
    plc.event("stopped");
    assert_eq!(plc.console("U0\\G5 + VR0"), "7");
    let refused = plc.refusal("evaluate", json!({ "expression": "force VR0=5", "context": "repl" }));
    assert!(refused.contains("cannot be forced"), "{refused}");
    let refused = plc.refusal("evaluate", json!({ "expression": "set RS.sent='a'", "context": "repl" }));
    assert!(refused.contains("what the program gives"), "{refused}");
}
