//! `rungwise/monitor`: how often it comes, and of which lines it tells.

use super::lsp_simulation::Simulated;
use serde_json::{Value, json};
use std::time::Instant;

const URI: &str = "file:///simulated/rows.il";

/// A hundred rungs of three lines each.
fn rows() -> String {
    (0..100).map(|number| format!("LD X{:o}\nOUT M{number}\nMOV D0 D1\n", number % 8)).collect::<String>()
        + "END\n"
}

fn lines(first: u64, last: u64) -> Value {
    json!([{ "start": { "line": first, "character": 0 }, "end": { "line": last, "character": 0 } }])
}

fn is_picture(message: &Value) -> bool {
    message["method"] == "rungwise/monitor"
}

/// The lines of which a picture tells.
fn lines_of(picture: &Value) -> Vec<u64> {
    let elements = picture["elements"].as_array().unwrap().iter();
    let mut lines: Vec<u64> =
        elements.map(|element| element["range"]["start"]["line"].as_u64().unwrap()).collect();
    lines.sort_unstable();
    lines.dedup();
    lines
}

#[test]
fn pictures_come_no_more_often_than_a_screen_shows_them_and_the_last_one_comes() {
    let mut plc = Simulated::open(URI, "plc-il", &rows());
    plc.tell("start", json!({ "paused": true }));
    plc.tell("watch", json!({ "ranges": lines(0, 30), "names": ["X0", "M0"] }));
    plc.picture(|_| true);
    let (began, changes) = (Instant::now(), 400);
    for change in 0..changes {
        plc.tell("set", json!({ "name": "X0", "value": change % 2 == 0 }));
        plc.tell("step", json!({}));
    }
    plc.tell("set", json!({ "name": "X0", "value": true }));
    let state = plc.tell("step", json!({}));
    let mut pictures = 1;
    while plc.client.take(is_picture).is_some() {
        pictures += 1;
    }
    // However fast or slow this machine is: at most one in 33 ms.
    let most = began.elapsed().as_millis() / 33 + 2;
    assert!(pictures <= most && pictures < changes, "{pictures} pictures, {most} at most");
    let last = plc.picture(|picture| picture["scan"] == state["scan"]);
    assert_eq!(last["values"][1]["value"], json!(true), "{last}");
}

#[test]
fn of_a_long_program_only_what_is_on_the_screen_is_told() {
    let mut plc = Simulated::open(URI, "plc-il", &rows());
    plc.tell("start", json!({ "paused": true, "scanTime": 10 }));
    plc.tell("watch", json!({ "ranges": lines(90, 119) }));
    let picture = plc.picture(|_| true);
    assert_eq!(lines_of(&picture), (90..=119).collect::<Vec<u64>>());
    // What is scrolled to is told, and what was left is not, also while the program runs.
    plc.tell("watch", json!({ "ranges": lines(30, 32) }));
    plc.picture(|picture| lines_of(picture) == [30, 31, 32]);
    plc.tell("set", json!({ "name": "X2", "value": true }));
    plc.tell("run", json!({ "speed": 0 }));
    let is_on = |picture: &Value| {
        picture["elements"].as_array().unwrap().iter().any(|element| element["energised"] == json!(true))
    };
    let running = plc.picture(is_on);
    assert_eq!(lines_of(&running), [30, 31, 32], "{running}");
    // Two editors of one document.
    let two = json!([lines(0, 2)[0], lines(297, 299)[0]]);
    plc.tell("watch", json!({ "ranges": two }));
    plc.picture(|picture| lines_of(picture) == [0, 1, 2, 297, 298, 299]);
    // Names alone have no elements, and nothing watched has no pictures.
    plc.tell("watch", json!({ "ranges": [], "names": ["X2"] }));
    plc.picture(|picture| lines_of(picture).is_empty() && picture["values"][0]["value"] == json!(true));
}
