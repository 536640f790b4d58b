//! Simulation as a client feels it: from the command that starts it to the first picture, and what pictures take.

use super::client;
use super::figures::{Figures, Table};
use super::lsp_client::Client;
use super::simulation::{Shapes, program};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

const URI: &str = "file:///bench/simulated.il";
const START: &str = "simulation over the protocol, from the start command to its answer";
const PICTURE: &str = "simulation over the protocol, from the start command to the first picture of 200 rows";
const SCREEN: &str = "simulation over the protocol, pictures of 200 rows that change, 30 in a second";

pub fn measure(table: &Table) {
    if ![START, PICTURE, SCREEN].iter().any(|name| table.wants(name)) {
        return;
    }
    let mut client = client();
    client.open(URI, "plc-il", &program(10_000, Shapes::Words));
    client.diagnostics(URI, 1);
    // Until the batch tier is done.
    std::thread::sleep(Duration::from_secs(2));
    if table.wants(START) {
        table.row(START, "< 20 ms", &Figures::of(20, |_| start(&mut client, false)));
    }
    if table.wants(PICTURE) {
        table.row(PICTURE, "", &Figures::of(20, |_| start(&mut client, true)));
    }
    if table.wants(SCREEN) {
        let quiet = core(&mut client, None);
        let painted = core(&mut client, Some(rows()));
        let share = (painted - quiet) * 100.0;
        table.value(SCREEN, "< 10 % of a core", &format!("{share:.2} % of a core"));
    }
}

/// The lines of a tall screen in the middle.
fn rows() -> Value {
    json!([{ "start": { "line": 30_000, "character": 0 }, "end": { "line": 30_199, "character": 0 } }])
}

fn send(client: &mut Client, verb: &str, more: &Value) -> i64 {
    let mut argument = json!({ "uri": URI });
    if let (Some(argument), Some(more)) = (argument.as_object_mut(), more.as_object()) {
        argument.extend(more.clone());
    }
    let params = json!({ "command": format!("rungwise.simulate.{verb}"), "arguments": [argument] });
    client.ask("workspace/executeCommand", params)
}

fn tell(client: &mut Client, verb: &str, more: &Value) -> Value {
    let id = send(client, verb, more);
    let answer = client.answer(id);
    assert!(answer["error"].is_null(), "{answer}");
    answer["result"].clone()
}

/// From the command to its answer, with which the first scan is done, or to the first picture, for which a client asks
/// behind the command.
fn start(client: &mut Client, is_picture: bool) -> Duration {
    let started = Instant::now();
    let id = send(client, "start", &json!({ "paused": true }));
    let shown = is_picture.then(|| send(client, "watch", &json!({ "ranges": rows() })));
    let state = client.answer(id);
    assert_eq!(state["result"]["scan"], 0, "{state}");
    if let Some(shown) = shown {
        let picture = client.wait_for_method("rungwise/monitor");
        assert!(picture["params"]["elements"].as_array().is_some_and(|all| all.len() >= 200), "{picture}");
        let took = client.arrived - started;
        client.answer(shown);
        tell(client, "stop", &json!({}));
        client.wait_for("the last picture", |message| message["params"]["mode"] == "stopped");
        return took;
    }
    let took = client.arrived - started;
    tell(client, "stop", &json!({}));
    took
}

/// The share of a core that the server takes while inputs change, with what is watched.
fn core(client: &mut Client, ranges: Option<Value>) -> f64 {
    tell(client, "start", &json!({}));
    if let Some(ranges) = &ranges {
        tell(client, "watch", &json!({ "ranges": ranges }));
    }
    let (before, started) = (client.processor_time(), Instant::now());
    let mut pictures = 0;
    for round in 0..150 {
        let (name, on) = (format!("X{:o}", round % 60), round / 60 % 2 == 0);
        tell(client, "set", &json!({ "name": name, "value": on }));
        std::thread::sleep(Duration::from_millis(33));
        while client.take(|message| message["method"] == "rungwise/monitor").is_some() {
            pictures += 1;
        }
    }
    let (after, elapsed) = (client.processor_time(), started.elapsed());
    tell(client, "stop", &json!({}));
    assert!(ranges.is_none() || pictures > 100, "{pictures} pictures");
    let used = after.zip(before).map_or(Duration::ZERO, |(after, before)| after.saturating_sub(before));
    used.as_secs_f64() / elapsed.as_secs_f64()
}
