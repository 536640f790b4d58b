//! `rungwise usage`, and the device comments file in `rungwise check`, through the binary.

use crate::binary::{folder, run};
use serde_json::{Value, json};
use tempfile::TempDir;

const MANIFEST: &str = "target = \"fx2n\"\ncomments = \"devices.csv\"\nfiles = [\"main.il\", \"pump.il\"]\n";
const TABLE: &str = "X0;Start;\"button; green\"\nY0;Motor;contactor\n";
const MAIN: &str = "LD Start\nOUT Y0\nOUT T0 K50\n";
const PUMP: &str = "LD T0\nAND Motor\nOUT M500\nEND\n";

/// A project whose table of comments is of some encoding.
fn project(table: &[u8]) -> TempDir {
    let folder = folder(&[("rungwise.toml", MANIFEST), ("main.il", MAIN), ("pump.il", PUMP)]);
    std::fs::write(folder.path().join("devices.csv"), table).unwrap();
    folder
}

#[test]
fn usage_as_json_over_the_files_of_a_project() {
    let (code, out, err) = run(&project(TABLE.as_bytes()), &["usage", "--format", "json"]);
    assert_eq!((code, err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&out).unwrap();
    let [project] = answer["projects"].as_array().unwrap().as_slice() else { panic!("{out}") };
    assert_eq!(project["target"], "fx2n");
    let devices = project["devices"].as_array().unwrap();
    let names: Vec<&str> = devices.iter().map(|row| row["device"].as_str().unwrap()).collect();
    assert_eq!(names, ["X0", "Y0", "M500", "T0"]);
    let [x0, y0, m500, t0] = devices.as_slice() else { panic!("{out}") };
    assert_eq!((&x0["symbol"], &x0["comment"]), (&json!("Start"), &json!("button; green")));
    assert_eq!((&m500["latched"], &t0["preset"]), (&json!(true), &json!("K50 = 5 s")));
    let uses = y0["uses"].as_array().unwrap();
    assert_eq!(uses.len(), 2);
    assert!(uses[1]["path"].as_str().unwrap().ends_with("pump.il"));
    let told =
        json!([uses[1]["line"], uses[1]["column"], uses[1]["rung"], uses[1]["access"], uses[1]["text"]]);
    assert_eq!(told, json!([2, 5, 1, "read", "AND Motor"]));
    assert_eq!((&uses[0]["access"], &uses[0]["coil"]), (&json!("write"), &json!(true)));
}

#[test]
fn usage_as_text_and_as_table() {
    let folder = project(TABLE.as_bytes());
    let (code, out, _) = run(&folder, &["usage"]);
    assert_eq!(code, 0);
    assert!(out.starts_with("Used devices\n"), "{out}");
    assert!(out.contains("\nM500     -o   .   .   .   .   .   .   .   .   .\n"), "{out}");
    assert!(out.contains("pump.il, rung 1, line 1: read — LD T0\n"), "{out}");
    let (_, out, _) = run(&folder, &["--lang", "zh-CN", "usage"]);
    assert!(out.starts_with("软元件使用一览\n"), "{out}");
    let (code, out, _) = run(&folder, &["usage", "--format", "csv"]);
    assert_eq!(code, 0);
    let lines: Vec<&str> = out.lines().collect();
    assert_eq!(lines[0], "device,symbol,comment,latched,preset,reads,writes,uses,gaps");
    assert!(lines[1].starts_with("X0,Start,button; green,false,,1,0,"), "{out}");
    assert!(lines[4].starts_with("T0,,,false,K50 = 5 s,1,1,"), "{out}");
    // Only the files that are named.
    let (_, out, _) = run(&folder, &["usage", "pump.il", "--format", "csv"]);
    assert_eq!(out.lines().count(), 4, "{out}");
}

#[test]
fn usage_complains_as_other_verbs() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, err) = run(&folder, &["usage"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.starts_with("error[no-programs]"), "{err}");
    assert_eq!(run(&folder, &["usage", "--format", "xml"]).0, 2);
}

#[test]
fn check_reads_symbols_and_reports_the_table() {
    let (code, out, err) = run(&project(TABLE.as_bytes()), &["check"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("\ncheck passed: 2 rungs, "), "{out}");
    let table = format!("{TABLE}Y0;Other;\nX9;;\n");
    let (code, out, _) = run(&project(table.as_bytes()), &["check"]);
    assert_eq!(code, 1);
    assert!(out.contains("devices.csv:3:1: warning[device-comments]: Y0 has a line already"), "{out}");
    assert!(out.contains("devices.csv:4:1: warning[device-comments]: `X9` is no device"), "{out}");
    let (_, out, _) = run(&project(table.as_bytes()), &["check", "--format", "json"]);
    let answer: Value = serde_json::from_str(&out).unwrap();
    let last = answer["files"].as_array().unwrap().last().unwrap();
    assert!(last["path"].as_str().unwrap().ends_with("devices.csv"), "{last}");
    assert_eq!(last["diagnostics"][0]["range"]["start"], json!({"line": 3, "column": 1}));
}

#[test]
fn a_table_in_gbk_and_one_that_is_missing() {
    let text = "X0;启动;绿色按钮\nY0;电机;接触器\n";
    let folder = project(&encoding_rs::GBK.encode(text).0);
    std::fs::write(folder.path().join("main.il"), "LD 启动\nOUT Y0\nOUT T0 K50\n").unwrap();
    std::fs::write(folder.path().join("pump.il"), "LD T0\nAND 电机\nOUT M500\nEND\n").unwrap();
    let (code, out, _) = run(&folder, &["check"]);
    assert_eq!(code, 0, "{out}");
    std::fs::remove_file(folder.path().join("devices.csv")).unwrap();
    let (code, out, err) = run(&folder, &["check"]);
    assert_eq!(code, 1);
    assert!(out.contains("devices.csv") && out.contains("cannot be read"), "{out}{err}");
    assert!(out.contains("error[unknown-device]"), "{out}");
}

#[test]
fn a_drawing_with_symbols_needs_no_target() {
    let folder = project(TABLE.as_bytes());
    std::fs::write(folder.path().join("rungwise.toml"), "comments = \"devices.csv\"\n").unwrap();
    for name in ["main.il", "pump.il"] {
        std::fs::remove_file(folder.path().join(name)).unwrap();
    }
    let drawing = "|  Start                Motor  |\n+--| |-----------------( )----+\n\n+--[END]----------------------+\n";
    std::fs::write(folder.path().join("main.lad"), drawing).unwrap();
    let (_, out, _) = run(&folder, &["usage", "--format", "csv"]);
    let names: Vec<&str> = out.lines().map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(names, ["device", "X0", "Y0"], "{out}");
}

#[test]
fn fmt_keeps_symbols() {
    let folder = project(TABLE.as_bytes());
    std::fs::write(folder.path().join("main.il"), "ld Start\nout Y0\n").unwrap();
    assert_eq!(run(&folder, &["fmt", "main.il"]).0, 0);
    assert_eq!(std::fs::read_to_string(folder.path().join("main.il")).unwrap(), "LD Start\nOUT Y0\n");
}
