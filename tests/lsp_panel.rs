//! What a panel and a chart of a simulation are told over the protocol.

use super::lsp_simulation::Simulated;
use serde_json::{Value, json};

const URI: &str = "file:///simulated/panel.il";
/// A motor that holds itself, its hours in D0, and D5 says when the counter has counted enough.
const PROGRAM: &str =
    "LD X0\nOR Y0\nANI X1\nOUT Y0\nOUT T0 K10\nLD T0\nOUT C0 D5\nLD M8013\nMOV K2M10 D0\nEND\n";

fn row<'a>(panel: &'a Value, name: &str) -> &'a Value {
    let rows = panel["rows"].as_array().unwrap();
    rows.iter().find(|row| row["name"] == name).unwrap_or_else(|| panic!("no row {name} in {panel}"))
}

/// The points of a signal.
fn points(trace: &Value, name: &str) -> Vec<(u64, Value)> {
    let signals = trace["signals"].as_array().unwrap();
    let signal = signals.iter().find(|signal| signal["name"] == name);
    let points = signal.unwrap_or_else(|| panic!("no {name} in {trace}"))["points"].as_array().unwrap();
    points.iter().map(|point| (point[0].as_u64().unwrap(), point[1].clone())).collect()
}

#[test]
fn a_panel_has_what_the_program_uses_group_by_group() {
    let mut plc = Simulated::open(URI, "plc-il", PROGRAM);
    let refused = plc.answer("panel", json!({}));
    assert!(
        refused["error"]["message"].as_str().is_some_and(|m| m.contains("not being simulated")),
        "{refused}"
    );
    plc.tell("start", json!({ "paused": true }));
    let panel = plc.tell("panel", json!({}));
    let rows = panel["rows"].as_array().unwrap();
    let names: Vec<&str> = rows.iter().map(|row| row["name"].as_str().unwrap()).collect();
    // Relays within K2M10 are on it, the clock of the CPU is not.
    let wanted = "X0 X1 Y0 T0 C0 M10 M11 M12 M13 M14 M15 M16 M17 D0 D5";
    assert_eq!(names.join(" "), wanted, "{panel}");
    let groups: Vec<&str> = rows.iter().map(|row| row["group"].as_str().unwrap()).collect();
    assert_eq!(&groups[..6], ["inputs", "inputs", "outputs", "timers", "counters", "relays"]);
    let timer = row(&panel, "T0");
    assert_eq!(
        [&timer["contact"], &timer["preset"], &timer["unit_ms"], &timer["type"], &timer["greatest"]],
        [&json!("TS0"), &json!(10), &json!(100), &json!("word"), &json!(32767)],
        "{timer}"
    );
    let counter = row(&panel, "C0");
    assert_eq!([&counter["contact"], &counter["preset_of"]], [&json!("CS0"), &json!("D5")], "{counter}");
    assert!(counter["preset"].is_null() && counter["unit_ms"].is_null(), "{counter}");
    assert_eq!([&row(&panel, "X0")["type"], &row(&panel, "Y0")["reads"]], [&json!("bit"), &json!(1)]);
    assert_eq!((&panel["mode"], &panel["scan_ms"]), (&json!("paused"), &json!(10.0)), "{panel}");
}

#[test]
fn an_edit_gives_the_panel_another_edition() {
    let mut plc = Simulated::open(URI, "plc-il", PROGRAM);
    let edition = plc.tell("start", json!({ "paused": true }))["edition"].clone();
    plc.tell("watch", json!({ "names": ["X0"] }));
    let uri = plc.uri.clone();
    plc.client.change(&uri, 2, (9, 0), (9, 0), "LD X7\nOUT Y7\n");
    let picture = plc.picture(|picture| picture["edition"] != edition);
    assert_eq!(picture["elements"], json!([]), "nothing of the text is shown: {picture}");
    let panel = plc.tell("panel", json!({}));
    assert_eq!(
        (&row(&panel, "X7")["group"], &row(&panel, "Y7")["group"]),
        (&json!("inputs"), &json!("outputs"))
    );
}

#[test]
fn a_chart_gets_the_past_the_present_and_forgets_what_is_taken_back() {
    let mut plc = Simulated::open(URI, "plc-il", PROGRAM);
    plc.tell("start", json!({ "paused": true }));
    plc.tell("step", json!({ "count": 4 }));
    let set = plc.tell("set", json!({ "name": "X0", "value": true }));
    assert_eq!(set["mode"], json!("paused"));
    // The program has not seen it yet.
    let input = plc.tell("state", json!({ "names": ["X0"] }))["values"][0].clone();
    assert_eq!((&input["value"], &input["wired"]), (&json!(false), &json!(true)), "{input}");
    plc.tell("step", json!({}));
    let input = plc.tell("state", json!({ "names": ["X0"] }))["values"][0].clone();
    assert_eq!((&input["value"], input.get("wired")), (&json!(true), None), "{input}");
    plc.tell("set", json!({ "name": "X0", "value": false }));
    plc.tell("step", json!({ "count": 44 }));
    // Nobody has recorded anything so far.
    let names = json!(["X0", "Y0", "T0"]);
    let trace = plc.tell("trace", json!({ "names": names }));
    assert_eq!((&trace["from"], &trace["to"]), (&json!(0), &json!(49)), "{trace}");
    assert_eq!(points(&trace, "X0"), [(0, json!(false)), (5, json!(true)), (6, json!(false))]);
    assert_eq!(points(&trace, "Y0"), [(0, json!(false)), (5, json!(true))]);
    // Ten scans of 10 ms for each 100 ms, from the scan after the one with power.
    let counted = [(0, json!(0)), (15, json!(1)), (25, json!(2)), (35, json!(3)), (45, json!(4))];
    assert_eq!(points(&trace, "T0"), counted, "{trace}");
    // From the last scan that is known on.
    plc.tell("set", json!({ "name": "X1", "value": true }));
    plc.tell("step", json!({}));
    let trace = plc.tell("trace", json!({ "names": names, "from": 49 }));
    assert_eq!(points(&trace, "Y0"), [(49, json!(true)), (50, json!(false))], "{trace}");
    assert_eq!(points(&trace, "X0"), [(49, json!(false))], "{trace}");
    let before = trace["branch"].clone();
    plc.tell("stepBack", json!({ "count": 30 }));
    let trace = plc.tell("trace", json!({ "names": names }));
    assert_ne!(trace["branch"], before);
    assert_eq!((&trace["scan"], points(&trace, "T0").last()), (&json!(20), Some(&(15, json!(1)))), "{trace}");
    plc.tell("step", json!({ "count": 10 }));
    let trace = plc.tell("trace", json!({ "names": names, "from": 18 }));
    assert_eq!(points(&trace, "T0"), [(18, json!(1)), (25, json!(2))], "{trace}");
    plc.tell("reset", json!({}));
    let trace = plc.tell("trace", json!({ "names": names }));
    assert_eq!((points(&trace, "Y0"), &trace["to"]), (vec![(0, json!(false))], &json!(0)), "{trace}");
}

#[test]
fn a_long_past_is_thinned_with_its_extremes_and_exact_where_one_looks_closely() {
    let mut plc = Simulated::open(URI, "plc-il", "LD M8000\nINC D0\nLD= D0 K20000\nMOV K-7 D0\nEND\n");
    plc.tell("start", json!({ "paused": true }));
    let names = json!(["D0"]);
    plc.tell("trace", json!({ "names": names }));
    plc.tell("step", json!({ "count": 100_000 }));
    let trace = plc.tell("trace", json!({ "names": names, "most": 400 }));
    let all = points(&trace, "D0");
    assert!((100..=420).contains(&all.len()), "{} points", all.len());
    let values: Vec<i64> = all.iter().map(|(_, value)| value.as_i64().unwrap()).collect();
    assert_eq!((values.iter().min(), values.iter().max()), (Some(&-7), Some(&19_999)));
    assert_eq!((all[0].0, all.last().unwrap().0), (0, 100_000));
    assert!(all.is_sorted_by_key(|(scan, _)| *scan));
    // Of long ago each change is found again.
    let close = plc.tell("trace", json!({ "names": names, "from": 1_000, "to": 1_050 }));
    let wanted: Vec<(u64, Value)> = (1_000..=1_050).map(|scan| (scan, json!(scan + 1))).collect();
    assert_eq!(points(&close, "D0"), wanted);
}

#[test]
fn what_was_is_written_for_waveform_viewers_and_spreadsheets() {
    let mut plc = Simulated::open(URI, "plc-il", PROGRAM);
    plc.tell("start", json!({ "paused": true }));
    plc.tell("set", json!({ "name": "X0", "value": true }));
    plc.tell("step", json!({ "count": 30 }));
    let vcd = plc.tell("export", json!({ "format": "vcd", "names": ["X0", "T0"] }));
    let text = vcd["text"].as_str().unwrap();
    assert!(text.contains("$timescale 1 ns $end") && text.contains(" T0 $end"), "{text}");
    assert!(text.contains("#10000000\n1!") && text.contains("#300000000"), "{text}");
    let csv = plc.tell("export", json!({ "format": "csv", "names": ["X0", "T0"], "from": 5, "to": 12 }));
    assert_eq!(csv["text"], json!("scan,time_ms,X0,T0\n5,50,1,0\n11,110,1,1\n12,120,1,1\n"), "{csv}");
    // All of the panel, if nothing is named.
    let all = plc.tell("export", json!({ "format": "csv" }));
    assert!(all["text"].as_str().unwrap().starts_with("scan,time_ms,X0,X1,Y0,T0,TS0,C0,CS0,M10,"), "{all}");
    let answer = plc.answer("export", json!({}));
    assert!(answer["error"]["message"].as_str().unwrap_or_default().contains("format"), "{answer}");
}
