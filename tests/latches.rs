//! Which devices keep their values without power: `[plc] latch`, from the manifest into the PLC and back out of it.

use crate::binary::{folder, run};
use crate::lsp_client::{Client, at, codes};
use crate::virtual_plc::VirtualPlc;
use serde_json::{Value, json};
use tempfile::TempDir;

const MANIFEST: &str = "target = \"fx2n\"\nfiles = [\"main.il\"]\n";
const LATCHED: &str = "[plc]\nlatch = [\"M0-M9\", \"S20-S29\", \"C5-C9\", \"C200-C205\", \"D0-D9\"]\n";

fn project(manifest: &str, main: &str) -> TempDir {
    folder(&[("rungwise.toml", manifest), ("main.il", main)])
}

fn check(folder: &TempDir, arguments: &[&str], code: i32) -> (String, String) {
    let (ended, out, err) = run(folder, arguments);
    assert_eq!(ended, code, "{arguments:?}\n{out}\n{err}");
    (out, err)
}

/// Values within the ranges of the project, on both sides of each, and where nothing can be set.
const WRITTEN: &[(&str, &str)] = &[
    ("M0", "1"),
    ("M9", "1"),
    ("M10", "1"),
    ("M600", "1"),
    ("M2000", "1"),
    ("S20", "1"),
    ("S30", "1"),
    ("S600", "1"),
    ("C5", "7"),
    ("C10", "7"),
    ("C150", "7"),
    ("C200", "7"),
    ("C206", "7"),
    ("D0", "7"),
    ("D9", "7"),
    ("D10", "7"),
    ("D300", "7"),
    ("D600", "7"),
    ("T250", "7"),
    ("T0", "7"),
];

fn written_into(folder: &TempDir, port: &str) {
    let settings: Vec<String> = WRITTEN.iter().map(|(device, value)| format!("{device}={value}")).collect();
    let settings = settings.iter().map(String::as_str);
    let arguments: Vec<&str> = ["write"].into_iter().chain(settings).chain(["--port", port]).collect();
    check(folder, &arguments, 0);
}

/// Those of [`WRITTEN`] that are still so.
fn kept_in(folder: &TempDir, port: &str) -> Vec<&'static str> {
    let devices = WRITTEN.iter().map(|(device, _)| *device);
    let end = ["--count", "1", "--format", "json", "--port", port];
    let arguments: Vec<&str> = ["monitor"].into_iter().chain(devices).chain(end).collect();
    let (out, _) = check(folder, &arguments, 0);
    let look: Value = serde_json::from_str(&out).unwrap();
    let is_kept = |device: &&str| [json!(true), json!(7)].contains(&look["values"][*device]);
    WRITTEN.iter().map(|(device, _)| *device).filter(is_kept).collect()
}

const MODEL_KEEPS: &[&str] = &["M600", "M2000", "S600", "C150", "D300", "D600", "T250"];
const PROJECT_KEEPS: &[&str] = &["M0", "M9", "M2000", "S20", "C5", "C200", "D0", "D9", "D600", "T250"];

#[test]
fn a_plc_keeps_what_the_parameters_of_its_download_say() {
    let folder = project(&(MANIFEST.to_string() + LATCHED), "LD X0\nOUT Y0\nEND\n");
    let start = || VirtualPlc::start(folder.path(), &["--state", "plc.json"]);
    let is_run = |port: &str| check(&folder, &["status", "--port", port], 0).0.contains("RUN");
    let mut plc = start();
    // A program that came without parameters leaves those of a new PLC.
    for (is_downloaded, kept) in [(false, MODEL_KEEPS), (true, PROJECT_KEEPS)] {
        if is_downloaded {
            check(&folder, &["download", "--yes", "--start", "--port", &plc.port], 0);
        } else {
            let (_, err) = check(&folder, &["download", "main.il", "--dry-run", "--port", &plc.port], 1);
            assert!(err.contains("are latched then"), "{err}");
        }
        // The power goes and comes back, and its memory is in a file meanwhile.
        written_into(&folder, &plc.port);
        assert_eq!(kept_in(&folder, &plc.port).len(), WRITTEN.len());
        assert_eq!(plc.quit(), Some(0));
        plc = start();
        assert_eq!(kept_in(&folder, &plc.port), kept);
        // It leaves RUN and comes back.
        check(&folder, &["start", "--yes", "--port", &plc.port], 0);
        written_into(&folder, &plc.port);
        check(&folder, &["stop", "--port", &plc.port], 0);
        assert_eq!(kept_in(&folder, &plc.port), kept);
        check(&folder, &["start", "--yes", "--port", &plc.port], 0);
        assert!(is_run(&plc.port));
        assert_eq!(kept_in(&folder, &plc.port), kept);
    }
    // The old parameters come back with the old program.
    check(&folder, &["download", "--rollback", "--yes", "--start", "--port", &plc.port], 0);
    written_into(&folder, &plc.port);
    check(&folder, &["stop", "--port", &plc.port], 0);
    assert_eq!(kept_in(&folder, &plc.port), MODEL_KEEPS);
}

/// Sets what is written at first, and clears what is not latched when X0 comes on.
const CLEARING: &str = "\
LD M8002\nSET M5\nSET M600\nMOV K7 D5\nMOV K7 D300\nLD X0\nOUT M8031\nLD X1\nOUT M8032\nEND\n";

#[test]
fn the_simulated_plc_clears_by_the_latches_of_the_project() {
    let values = |manifest: &str, input: &str| {
        let folder = project(manifest, CLEARING);
        let set = format!("{input}=1@50ms");
        let watched = ["--watch", "M5,M600,D5,D300", "--format", "json"];
        let (out, _) = check(&folder, &[&["run", "main.il", "--set", &set], &watched[..]].concat(), 0);
        let answer: Value = serde_json::from_str(&out).unwrap();
        answer["scans"].as_array().unwrap().last().unwrap()["values"].clone()
    };
    let own = MANIFEST.to_string() + LATCHED;
    let latched = json!({"M5": true, "M600": false, "D5": 7, "D300": 0});
    let general = json!({"M5": false, "M600": true, "D5": 0, "D300": 7});
    assert_eq!(values(&own, "X0"), latched);
    assert_eq!(values(MANIFEST, "X0"), general);
    assert_eq!(values(&own, "X1"), json!({"M5": false, "M600": true, "D5": 0, "D300": 7}));
    assert_eq!(values(MANIFEST, "X1"), json!({"M5": true, "M600": false, "D5": 7, "D300": 0}));
}

/// Passing results in relays of both ranges.
const PASSING: &str = "LD X0\nAND X1\nOUT M5\nLD M5\nOUT Y0\nLD X2\nAND X3\nOUT M600\nLD M600\nOUT Y1\nEND\n";

#[test]
fn rules_and_lists_of_devices_know_the_latches_of_the_project() {
    let named = |manifest: &str| {
        let folder = project(manifest, PASSING);
        let (out, err) = check(&folder, &["check", "--format", "json"], 0);
        let (usage, _) = check(&folder, &["usage", ".", "--format", "csv"], 0);
        let latched = usage.lines().filter(|line| line.split(',').nth(3) == Some("true"));
        let latched: Vec<String> = latched.map(|line| line.split(',').next().unwrap().to_string()).collect();
        let found = |name: &str| out.contains("latched-range") && out.contains(name);
        ((found("M5"), found("M600")), latched, out + &err)
    };
    let (found, latched, told) = named(MANIFEST);
    assert_eq!((found, latched), ((false, true), vec!["M600".to_string()]), "{told}");
    let (found, latched, told) = named(&(MANIFEST.to_string() + LATCHED));
    assert_eq!((found, latched), ((true, false), vec!["M5".to_string()]), "{told}");
}

#[test]
fn an_editor_is_told_when_the_latches_of_its_project_change() {
    let folder = project(MANIFEST, PASSING);
    let path = |name: &str| format!("file://{}", folder.path().canonicalize().unwrap().join(name).display());
    let mut client = Client::start();
    let uri = path("main.il");
    client.open(&uri, "plc-il", PASSING);
    let told = |client: &mut Client, line: u32| {
        client.wait_for("the rule", |message| {
            let found = message["params"]["diagnostics"].as_array();
            message["params"]["uri"] == json!(uri)
                && found.is_some_and(|found| {
                    codes(found) == ["latched-range"] && found[0]["range"]["start"]["line"] == json!(line)
                })
        });
        let mut hover = |line| client.request("textDocument/hover", at(&uri, line, 5))["result"].to_string();
        (hover(2), hover(7))
    };
    let (general, latched) = told(&mut client, 7);
    assert!(
        !general.contains("Keeps its value") && latched.contains("Keeps its value"),
        "{general}{latched}"
    );
    std::fs::write(folder.path().join("rungwise.toml"), MANIFEST.to_string() + LATCHED).unwrap();
    let changes = json!([{"uri": path("rungwise.toml"), "type": 2}]);
    client.notify("workspace/didChangeWatchedFiles", json!({ "changes": changes }));
    let (own, outside) = told(&mut client, 2);
    assert!(own.contains("`[plc] latch` of the project says so"), "{own}");
    assert!(outside.contains("outside of what `[plc] latch`"), "{outside}");
}
