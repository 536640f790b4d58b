//! `rungwise run`, through the binary.

use crate::binary::{folder, run};
use serde_json::{Value, json};

const MOTOR: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nOUT T0 K3\nLD T0\nOUT Y1\nEND\n";

#[test]
fn a_run_has_a_row_for_each_change_the_first_and_the_last_scan() {
    let folder = folder(&[("motor.il", MOTOR)]);
    let arguments = [
        "run",
        "motor.il",
        "--set",
        "X0=1@100ms",
        "--set",
        "X0=0@150ms",
        "--watch",
        "X0,Y0,Y1,T0",
        "--format",
        "json",
    ];
    let (code, out, err) = run(&folder, &arguments);
    assert_eq!((code, err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(answer["scan_time_ms"], json!(10));
    let rows: Vec<(i64, i64, String)> = answer["scans"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| {
            (row["scan"].as_i64().unwrap(), row["time_ms"].as_i64().unwrap(), row["values"].to_string())
        })
        .collect();
    let expected = [
        (0, 0, json!({"X0": false, "Y0": false, "Y1": false, "T0": 0})),
        (10, 100, json!({"X0": true, "Y0": true, "Y1": false, "T0": 0})),
        (15, 150, json!({"X0": false, "Y0": true, "Y1": false, "T0": 0})),
        (20, 200, json!({"X0": false, "Y0": true, "Y1": false, "T0": 1})),
        (30, 300, json!({"X0": false, "Y0": true, "Y1": false, "T0": 2})),
        (40, 400, json!({"X0": false, "Y0": true, "Y1": true, "T0": 3})),
        (100, 1000, json!({"X0": false, "Y0": true, "Y1": true, "T0": 3})),
    ];
    assert_eq!(rows, expected.map(|(scan, time, values)| (scan, time, values.to_string())));
}

#[test]
fn scans_and_their_distance_are_what_was_asked_for() {
    let folder = folder(&[("motor.il", MOTOR)]);
    let arguments =
        ["run", "motor.il", "--scans", "5", "--scan-time", "2.5ms", "--watch", "Y0", "--format", "json"];
    let answer: Value = serde_json::from_str(&run(&folder, &arguments).1).unwrap();
    let last = answer["scans"].as_array().unwrap().last().unwrap().clone();
    assert_eq!(
        (&answer["scan_time_ms"], &last["scan"], &last["time_ms"]),
        (&json!(2.5), &json!(4), &json!(10))
    );
    let (_, out, _) =
        run(&folder, &["run", "motor.il", "--time", "T#30ms", "--set", "X0=on", "--watch", "X0,Y0"]);
    assert_eq!(
        out,
        "scan  0   3\nms    0  30\nX0   ▆▆▆▆▆▆▆\nY0   ▆▆▆▆▆▆▆\n".replace("   ▆▆▆▆▆▆▆", "  ▆▆▆▆▆▆▆"),
        "{out}"
    );
}

#[test]
fn traces_are_files_that_other_tools_open() {
    let folder = folder(&[("motor.il", MOTOR)]);
    for name in ["out.vcd", "out.csv"] {
        let (code, _, err) =
            run(&folder, &["run", "motor.il", "--set", "X0=1", "--watch", "X0,Y0,T0", "--trace", name]);
        assert_eq!((code, err.as_str()), (0, ""));
    }
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let csv = read("out.csv");
    assert!(csv.starts_with("scan,time_ms,X0,Y0,T0\n0,0,1,1,0\n10,100,1,1,1\n"), "{csv}");
    let dump = read("out.vcd");
    for piece in ["$timescale 1 ns $end", "$var wire 1 ", " Y0 $end", "#100000000\nb0000000000000001 "] {
        assert!(dump.contains(piece), "{piece}\n{dump}");
    }
}

#[test]
fn wrong_names_values_and_programs_are_told() {
    let folder = folder(&[("motor.il", MOTOR), ("wrong.il", "LD X0\nCJ P1\nEND\n")]);
    for (arguments, code, said) in [
        (["run", "motor.il", "--watch", "Q5"], 2, "nothing called `Q5`"),
        (["run", "motor.il", "--set", "X0=7"], 2, "`X0` cannot be set to this value"),
        (["run", "wrong.il", "--scans", "1"], 1, "wrong.il:2:1: there is no label P1"),
        (["run", "none.il", "--scans", "1"], 2, "no such file"),
        (["run", "motor.il", "--time", "soon"], 2, "soon"),
    ] {
        let (found, out, err) = run(&folder, &arguments);
        assert_eq!((found, out.as_str()), (code, ""), "{err}");
        assert!(err.contains(said), "{err}");
    }
}

#[test]
fn what_goes_wrong_in_a_scan_is_said_once_at_its_instruction() {
    let folder = folder(&[("loop.il", "P0\nLD M8000\nOUT Y0\nLD M8000\nCJ P0\nEND\n")]);
    let (code, _, err) = run(&folder, &["run", "loop.il", "--scans", "3"]);
    assert_eq!(code, 1);
    assert_eq!(err.matches("does not end").count(), 1, "{err}");
}

#[test]
fn a_program_of_iec_61131_runs_with_its_names_and_types() {
    let program = "PROGRAM Main\nVAR\n  Start AT %IX0.0 : BOOL;\n  Motor AT %QX0.0 : BOOL;\n  Delay : TON;\n  \
                   Level : REAL := 1.5;\n  Count : UINT := 65535;\nEND_VAR\nLD Start\nOR Motor\nST Motor\nLD Motor\nST Delay.IN\n\
                   LD T#20ms\nST Delay.PT\nCAL Delay\nLD Level\nMUL 2.0\nST Level\nEND_PROGRAM\n";
    let folder = folder(&[("main.il", program)]);
    let watched = "Motor,Main.Delay.ET,delay.q,Level,Count,%IX0.0";
    let arguments =
        ["run", "main.il", "--set", "start=1@10ms", "--set", "Start=FALSE@20ms", "--watch", watched];
    let (code, out, err) = run(&folder, &[&arguments[..], &["--scans", "4", "--format", "json"]].concat());
    assert_eq!((code, err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&out).unwrap();
    let last = answer["scans"].as_array().unwrap().last().unwrap();
    assert_eq!(
        last["values"],
        json!({ "Motor": true, "Main.Delay.ET": 20, "delay.q": true, "Level": 24.0, "Count": 65535, "%IX0.0": false })
    );
    // Two names of one variable are both shown, one name is shown once.
    let names = "%IX0.0,Start,start";
    let (_, out, _) = run(&folder, &["run", "main.il", "--scans", "1", "--watch", names, "--format", "json"]);
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(answer["scans"][0]["values"], json!({ "%IX0.0": false, "Start": false }));
    let (_, out, _) = run(&folder, &["run", "main.il", "--why", "Level@20ms", "--why", "Count"]);
    assert!(out.contains("LD Level, MUL 2.0, ST Level is executed") && !out.contains("by hand"), "{out}");
    let (code, _, err) = run(&folder, &["run", "main.il", "--set", "Count=-1"]);
    assert!(code == 2 && err.contains("`Count` cannot be set to -1"), "{err}");
    let (code, _, err) = run(&folder, &["run", "main.il", "--watch", "Speed"]);
    assert!(code == 2 && err.contains("Speed"), "{err}");
}

#[test]
fn a_file_of_a_project_runs_with_the_others() {
    let files = [
        ("rungwise.toml", "target = \"fx2n\"\nfiles = [\"main.il\", \"sub.il\"]\n"),
        ("main.il", "LD X0\nCALL P1\nFEND\n"),
        ("sub.il", "P1\nLD X1\nOUT Y1\nSRET\nEND\n"),
    ];
    let folder = folder(&files);
    let arguments = ["--set", "X0=1", "--set", "X1=1", "--scans", "2", "--watch", "M8000,Y1"];
    let picture = "scan  0   1\nms    0  10\nM8000 ▆▆▆▆▆▆▆\nY1    ▆▆▆▆▆▆▆\n";
    for asked in ["main.il", "sub.il", "."] {
        let (code, out, err) = run(&folder, &[&["run", asked], &arguments[..]].concat());
        assert_eq!((code, err.as_str()), (0, ""), "{asked}");
        assert_eq!(out.replace(' ', ""), picture.replace(' ', ""), "{asked}");
        assert!(out.contains("M8000 ▆") && out.contains("Y1    ▆"), "{out}");
    }
}

/// A program that goes on for longer than anybody waits, in a terminal that `script` gives it.
#[cfg(target_os = "linux")]
#[test]
fn a_long_run_shows_a_bar_on_a_terminal_and_ctrl_c_leaves_what_it_did() {
    use std::io::{Read, Write};
    use std::process::{Command, Stdio};
    let folder = folder(&[("clock.il", "LD M8000\nINC D0\nLD X0\nDIV K1 K0 D1\nEND\n")]);
    let program = env!("CARGO_BIN_EXE_rungwise");
    let line = format!(
        "trap : INT; {program} run clock.il --scans 1000000000 --watch D0 --trace out.csv; echo code $?"
    );
    let mut terminal = Command::new("script")
        .args(["--quiet", "--flush", "--command", &line, "/dev/null"])
        .env("LC_ALL", "C")
        .env("TERM", "xterm")
        .current_dir(&folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("script of util-linux");
    let (mut input, mut output) = (terminal.stdin.take().unwrap(), terminal.stdout.take().unwrap());
    let (mut shown, mut bytes) = (String::new(), [0; 4096]);
    let mut until = |wanted: &str, shown: &mut String| {
        while !shown.contains(wanted) {
            let count = output.read(&mut bytes).unwrap();
            assert!(count > 0, "{wanted} does not come: {shown}");
            shown.push_str(&String::from_utf8_lossy(&bytes[..count]));
        }
    };
    until("% · scan ", &mut shown);
    input.write_all(b"\x03").unwrap();
    until("code 1", &mut shown);
    assert!(shown.contains("ended by Ctrl-C after "), "{shown}");
    terminal.wait().unwrap();
    let trace = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let last = trace.lines().last().unwrap().split(',').collect::<Vec<_>>();
    assert!(
        trace.starts_with("scan,time_ms,D0\n0,0,1\n") && trace.ends_with('\n') && last.len() == 3,
        "{last:?}"
    );
    assert_eq!(last[0].parse::<i64>().unwrap() * 10, last[1].parse::<i64>().unwrap());
}

#[test]
fn a_long_run_shows_no_bar_in_a_pipe() {
    let folder = folder(&[("clock.il", "LD M8000\nINC D0\nEND\n")]);
    let (code, _, err) = run(&folder, &["run", "clock.il", "--scans", "300000", "--watch", "X0"]);
    assert_eq!((code, err.as_str()), (0, ""));
}

#[test]
fn a_small_history_forgets_the_oldest_scans_and_says_so() {
    let folder = folder(&[("motor.il", MOTOR), ("rungwise.toml", "[simulate]\nhistory = \"2 MiB\"\n")]);
    let asked = |more: &[&str]| {
        let arguments = ["run", "motor.il", "--scans", "200000", "--set", "X0=1", "--watch", "Y0"];
        run(&folder, &[&arguments[..], more].concat())
    };
    let (code, out, err) = asked(&["--history", "1MiB", "--why", "Y0@20ms"]);
    assert_eq!(code, 2, "{out}{err}");
    assert!(err.contains("the history begins at scan 1") && err.contains("now it has 1 MiB"), "{err}");
    let (_, _, err) = asked(&["--why", "Y0@20ms"]);
    assert!(err.contains("now it has 2 MiB"), "the project's: {err}");
    let (code, out, err) = asked(&["--history", "64 MiB", "--why", "Y0@20ms"]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(out.contains("Y0 is on"), "{out}");
    let (code, _, err) = asked(&["--history", "3 pages"]);
    assert!(code == 2 && err.contains("3 pages") && err.contains("--history"), "{err}");
    let settings = "target = \"fx2n\"\n[simulate]\nhistory = \"3 pages\"\n";
    std::fs::write(folder.path().join("rungwise.toml"), settings).unwrap();
    let (code, _, err) = run(&folder, &["run", "motor.il"]);
    assert!(code == 2 && err.contains("rungwise.toml:3:12: ") && err.contains("64 MiB"), "{err}");
    let (_, _, err) = run(&folder, &["--lang", "zh-CN", "run", "motor.il"]);
    assert!(err.contains("rungwise.toml:3:12: ") && err.contains("不是历史的大小"), "{err}");
}
