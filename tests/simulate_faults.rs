//! What went wrong in simulations once, through `rungwise run` and the protocol.

use super::binary;
use super::lsp_client::Client;
use serde_json::{Value, json};

/// The values after the last scan of a program for an FX3U; settings and other arguments of `rungwise run`.
#[track_caller]
fn last(text: &str, arguments: &[&str], watched: &str) -> Value {
    let rows = rows(text, arguments, watched);
    rows.last().expect("a scan")["values"].clone()
}

/// The rows of a run without errors.
#[track_caller]
fn rows(text: &str, arguments: &[&str], watched: &str) -> Vec<Value> {
    let (code, rows, err) = told(text, arguments, watched);
    assert_eq!((code, err.as_str()), (0, ""), "{text}");
    rows
}

/// Exit code, rows and complaints.
fn told(text: &str, arguments: &[&str], watched: &str) -> (i32, Vec<Value>, String) {
    told_in(&[("a.il", &program(text))], arguments, watched)
}

fn told_in(files: &[(&str, &str)], arguments: &[&str], watched: &str) -> (i32, Vec<Value>, String) {
    let folder = binary::folder(files);
    let mut all = vec!["run", "a.il", "--format", "json", "--watch", watched];
    for argument in arguments {
        if argument.contains('=') && !argument.starts_with("--") {
            all.push("--set");
        }
        all.push(argument);
    }
    let (code, out, err) = binary::run(&folder, &all);
    let rows = serde_json::from_str::<Value>(&out).ok().and_then(|out| out["scans"].as_array().cloned());
    (code, rows.unwrap_or_default(), err)
}

/// A list whose lines are parted by semicolons.
fn program(text: &str) -> String {
    format!("// dialect: fx\n{}\n", text.replace(';', "\n"))
}

/// When a variable first had a value.
#[track_caller]
fn first(rows: &[Value], name: &str, value: Value) -> i64 {
    let row = rows.iter().find(|row| row["values"][name] == value);
    row.unwrap_or_else(|| panic!("{name} is never {value}"))["time_ms"].as_i64().expect("whole milliseconds")
}

const URI: &str = "file:///faults/a.il";

struct Plc {
    client: Client,
    version: i32,
}

impl Plc {
    /// A program that is simulated and paused, after its first scan.
    fn start(text: &str) -> Plc {
        let mut plc = Plc { client: Client::start(), version: 1 };
        plc.client.open(URI, "plc-il", &program(text));
        plc.client.diagnostics(URI, 1);
        plc.tell("start", json!({ "paused": true }));
        plc
    }

    fn ask(&mut self, verb: &str, more: Value) -> i64 {
        let mut argument = json!({ "uri": URI });
        argument.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let params = json!({ "command": format!("rungwise.simulate.{verb}"), "arguments": [argument] });
        self.client.ask("workspace/executeCommand", params)
    }

    fn answer(&mut self, verb: &str, more: Value) -> Value {
        let id = self.ask(verb, more);
        self.client.answer(id)
    }

    #[track_caller]
    fn tell(&mut self, verb: &str, more: Value) -> Value {
        let answer = self.answer(verb, more);
        assert!(answer["error"].is_null(), "{verb}: {answer}");
        answer["result"].clone()
    }

    #[track_caller]
    fn refused(&mut self, verb: &str, more: Value, said: &str) {
        let answer = self.answer(verb, more);
        let message = answer["error"]["message"].as_str().unwrap_or_default();
        assert!(message.contains(said), "{verb}: {answer}");
    }

    fn set(&mut self, name: &str, value: Value) {
        self.tell("set", json!({ "name": name, "value": value }));
    }

    fn step(&mut self, count: u64) -> Value {
        self.tell("step", json!({ "count": count }))
    }

    /// The values of these names, bits as 0 and 1.
    fn values(&mut self, names: &[&str]) -> Vec<i64> {
        let state = self.tell("state", json!({ "names": names }));
        let values = state["values"].as_array().unwrap().iter();
        values
            .map(|value| value["value"].as_i64().unwrap_or(i64::from(value["value"] == json!(true))))
            .collect()
    }

    /// Replaces the text, and waits until the simulation has taken it over.
    fn edit(&mut self, text: &str) {
        let edition = self.tell("state", json!({}))["edition"].clone();
        self.version += 1;
        let params = json!({ "textDocument": { "uri": URI, "version": self.version },
            "contentChanges": [{ "text": program(text) }] });
        self.client.notify("textDocument/didChange", params);
        self.client.diagnostics(URI, i64::from(self.version));
        while self.tell("state", json!({}))["edition"] == edition {
            std::thread::yield_now();
        }
    }
}

#[test]
fn an_edited_comment_lets_a_step_that_was_left_switch_its_coils_off() {
    let text = "LD M8002;SET S0;STL S20;OUT Y1;STL S0;OUT Y0;LD X0;SET S21;STL S21;OUT Y2;RET;END";
    let mut plc = Plc::start(text);
    plc.set("X0", json!(1));
    plc.step(1);
    plc.edit(&format!("{text};// a comment"));
    plc.step(2);
    assert_eq!(plc.values(&["S0", "Y0", "S21", "Y2"]), [0, 0, 1, 1]);
}

#[test]
fn a_step_that_was_left_switches_its_coils_off_also_if_its_own_lines_were_edited() {
    let mut plc = Plc::start("LD M8002;SET S0;STL S21;OUT Y2;STL S0;OUT Y0;LD X0;SET S21;RET;END");
    plc.set("X0", json!(1));
    plc.step(1);
    plc.edit("LD M8002;SET S0;STL S21;OUT Y2;STL S1;OUT Y0;LD X0;SET S21;RET;END");
    plc.step(2);
    assert_eq!(plc.values(&["Y0", "Y2"]), [0, 1]);
}

#[test]
fn an_edit_fires_no_pulse_and_one_that_changes_nothing_keeps_history() {
    let text = "LD X0;INCP D0;LDP X0;INC D1;LD X0;PLS M0;LD M0;INC D2;LD X0;ALTP M1;END";
    let mut plc = Plc::start(text);
    plc.set("X0", json!(1));
    plc.step(3);
    let names = ["D0", "D1", "D2", "M1"];
    assert_eq!(plc.values(&names), [1, 1, 1, 1]);
    plc.edit(&format!("// a comment above;{text}"));
    plc.step(1);
    assert_eq!(plc.values(&names), [1, 1, 1, 1]);
    assert_eq!(plc.tell("state", json!({}))["first_scan"], json!(0));
    plc.tell("stepBack", json!({ "changeOf": "D0" }));
    assert_eq!(plc.values(&["D0"]), [0]);
    plc.set("X0", json!(1));
    plc.step(2);
    // A rung before, one between, and pulses that are new while their power is on.
    plc.edit(&format!("LD X7;OUT Y7;{}", text.replace("LD X0;PLS", "LD X0;INCP D5;LDP X0;INC D6;LD X0;PLS")));
    plc.step(2);
    assert_eq!(plc.values(&["D0", "D1", "D2", "M1", "D5", "D6"]), [1, 1, 1, 1, 0, 0]);
    plc.set("X0", json!(0));
    plc.step(1);
    plc.set("X0", json!(1));
    plc.step(2);
    assert_eq!(plc.values(&["D0", "D1", "D2", "M1", "D5", "D6"]), [2, 2, 2, 0, 1, 1]);
}

#[test]
fn what_is_set_is_still_to_come_after_a_step_back_that_goes_nowhere() {
    let mut plc = Plc::start("LD X0;OUT Y0;INCP D0;END");
    plc.set("X0", json!(1));
    plc.tell("stepBack", json!({}));
    plc.step(3);
    assert_eq!(plc.values(&["X0", "D0"]), [1, 1]);
    plc.tell("stepBack", json!({}));
    assert_eq!(plc.values(&["X0", "D0"]), [1, 1]);
}

#[test]
fn the_cpu_obeys_the_special_relays_of_a_program() {
    // Outputs off, at the terminals alone.
    let text = "LD X0;OUT M8034;LD M8000;OUT Y0;LD Y0;OUT M0;END";
    assert_eq!(last(text, &["X0=1@20"], "Y0,M0"), json!({"Y0": false, "M0": true}));
    assert_eq!(last(text, &["X0=1@20", "X0=0@40"], "Y0,M0"), json!({"Y0": true, "M0": true}));
    // What is not latched is cleared, then what is.
    let text = "LD M8002;SET M0;SET M600;MOV K5 D0;MOV K6 D300;LD X0;OUT M8031;LD X1;OUT M8032;END";
    let watched = "M0,M600,D0,D300";
    assert_eq!(last(text, &["X0=1@20"], watched), json!({"M0": false, "M600": true, "D0": 0, "D300": 6}));
    assert_eq!(last(text, &["X1=1@20"], watched), json!({"M0": true, "M600": false, "D0": 5, "D300": 0}));
    // A stop is told once, at the end, and clears outputs, unless M8033 keeps them.
    for (hold, y0) in [("M8033", true), ("M1", false)] {
        let text = format!("LD M8000;OUT {hold};OUT Y0;INC D300;LD X0;OUT M8037;END");
        let (code, rows, err) = told(&text, &["X0=1@20"], "Y0,D300");
        assert_eq!((code, &rows.last().unwrap()["values"]), (1, &json!({"Y0": y0, "D300": 3})), "{err}");
        assert_eq!(err.matches("a.il:8:1: M8037 has stopped").count(), 1, "{err}");
    }
    // The scan is at least as long as D8039 says.
    let text = "LD M8002;MOV K50 D8039;LD X0;OUT M8039;LD M8000;INC D0;END";
    assert_eq!(last(text, &["X0=1@200", "--time", "400ms"], "D0"), json!({"D0": 25}));
    // Steps are watched.
    let text = "LD M8002;SET S20;SET S22;SET S900;LD X0;OUT M8047;LD X1;RST S20;RST S22;END";
    let watched = "M8046,D8040,D8041,D8042";
    let on = json!({"M8046": true, "D8040": 20, "D8041": 22, "D8042": 0});
    assert_eq!(last(text, &["X0=1"], watched), on);
    assert_eq!(last(text, &["X0=1", "X1=1@20"], watched)["M8046"], json!(false));
    // What it says of itself.
    let own = last("LD X0;OUT Y0;END", &[], "D8000,D8001,D8002");
    assert_eq!(own, json!({"D8000": 200, "D8001": 24310, "D8002": 8}));
}

#[test]
fn orders_to_the_cpu_that_are_not_simulated_are_told_at_their_instruction() {
    let (code, _, err) = told("LD X0;OUT M8099;END", &["X0=1@20"], "X0");
    assert_eq!((code, err.matches("a.il:3:1: the simulator does not do").count()), (1, 1), "{err}");
    assert_eq!(told("LD X0;OUT M8099;END", &[], "X0").0, 0);
}

#[test]
fn values_out_of_range_are_refused_and_nothing_that_is_held_ends_the_simulation() {
    let mut plc = Plc::start("LD M8012;OUT C0 K5;LD X0;OUT T0 D0;OUT C200 K5;END");
    for verb in ["set", "force"] {
        let more = |name: &str, value: i64| json!({ "name": name, "value": value });
        plc.refused(verb, more("C0", i64::MAX), "it takes numbers from -32768 to 32767");
        plc.refused(verb, more("D0", 40_000), "`D0` cannot be set to 40000");
        plc.refused(verb, more("C200", 3_000_000_000), "from -2147483648 to 2147483647");
    }
    plc.set("X0", json!(1));
    for (name, value) in [("C0", 32767), ("T0", 32767), ("D0", 32767), ("C200", 2_147_483_647)] {
        plc.tell("force", json!({ "name": name, "value": value }));
        plc.step(30);
        plc.tell("release", json!({ "name": name }));
        plc.step(30);
    }
    assert_eq!(plc.values(&["T0", "C0"]), [32767, 32767]);
    for setting in ["D0=100000", "D0=-40000", "D0=H12345", "C200=3000000000"] {
        let (code, _, err) = told("LD X0;OUT Y0;END", &[setting], "D0");
        assert!(
            code == 2 && err.starts_with("error[bad-value]") && err.contains("cannot be set to"),
            "{err}"
        );
    }
}

#[test]
fn timers_of_routines_go_on_without_their_coils() {
    let text = "LD X0;CALL P1;FEND;P1;LD X1;OUT T192 K2;OUT T246 K200;OUT T0 K2;SRET;END";
    let rows = rows(text, &["X1=1", "X0=1", "X0=0@100ms", "X0=1@500ms"], "TS192,T246,TS246,TS0");
    assert_eq!(first(&rows, "TS192", json!(true)), 200);
    assert_eq!(first(&rows, "T246", json!(200)), 200);
    assert_eq!(first(&rows, "TS246", json!(true)), 500, "at its coil");
    assert!(first(&rows, "TS0", json!(true)) > 500);
    let text = "LD X0;CJ P1;LD X1;OUT T192 K2;P1;END";
    let rows = self::rows(text, &["X1=1", "X0=1@100ms"], "TS192");
    assert_eq!(first(&rows, "TS192", json!(true)), 200);
}

#[test]
fn a_coil_without_power_holds_its_timer_at_nothing() {
    let text = "LD M8002;MOV K3 T0;LD X0;OUT T0 K5;END";
    let rows = rows(text, &["X0=1@100"], "T0,TS0");
    assert_eq!((&rows[0]["values"]["T0"], first(&rows, "TS0", json!(true))), (&json!(0), 600));
    assert_eq!(last("LD X0;OUT T0 K5;LD M8000;OUT T250 K5;END", &["TS0=1"], "TS0"), json!({"TS0": false}));
    let mut plc = Plc::start("LDI T0;OUT T0 K1;LD X0;OUT T1 K9;END");
    plc.tell("force", json!({ "name": "TS0", "value": 1 }));
    plc.step(5);
    plc.tell("force", json!({ "name": "T1", "value": 4 }));
    plc.step(2);
    assert_eq!(plc.values(&["T1"]), [4]);
    plc.tell("release", json!({}));
    plc.step(1);
    assert_eq!(plc.values(&["TS0", "T1"]), [0, 0]);
    // A retentive timer keeps what is written to it.
    assert_eq!(last("LD M8002;MOV K3 T250;LD X0;OUT T250 K5;END", &[], "T250"), json!({"T250": 3}));
}

#[test]
fn the_reset_input_of_a_high_speed_counter_opens_its_contact() {
    let text = "LD X10;OUT C241 K2;LD C241;OUT Y0;END";
    let pulses = ["X10=1", "X0=1@20", "X0=0@30", "X0=1@40", "X0=0@50"];
    assert_eq!(last(text, &pulses, "C241,Y0"), json!({"C241": 2, "Y0": true}));
    let with_reset = [&pulses[..], &["X1=1@100"]].concat();
    assert_eq!(last(text, &with_reset, "C241,Y0"), json!({"C241": 0, "Y0": false}));
}

#[test]
fn coils_of_timers_are_refused_and_each_part_is_forced_by_itself() {
    let (code, _, err) = told("LD X0;OUT T1 K5;END", &["TC1=1"], "TS1,TC1");
    assert!(code == 2 && err.contains("`TC1` is a coil"), "{err}");
    let mut plc = Plc::start("LD X0;OUT T0 K5;LD X1;OUT C0 K5;END");
    plc.refused("force", json!({ "name": "CC0", "value": 1 }), "`CC0` is a coil");
    plc.tell("force", json!({ "name": "TS0", "value": 1 }));
    let state = plc.tell("force", json!({ "name": "T0", "value": 3 }));
    assert_eq!(state["forced"], json!(["TS0", "T0"]));
    plc.step(2);
    assert_eq!(plc.values(&["TS0", "T0"]), [1, 3]);
    let state = plc.tell("release", json!({ "name": "TS0" }));
    assert_eq!(state["forced"], json!(["T0"]));
}

#[test]
fn pairs_of_registers_are_set_and_forced_and_what_is_none_is_no_name() {
    let text = "LD X0;DMOV D0 D2;END";
    assert_eq!(
        last(text, &["D0:32=100000", "X0=1"], "D0:32,D1,D2:32"),
        json!({"D0:32": 100_000, "D1": 1, "D2:32": 100_000})
    );
    for name in ["C200:32", "T0:32", "D7999:32"] {
        let (code, _, err) = told(text, &[], name);
        assert!(code == 2 && err.contains("nothing called"), "{name}: {err}");
    }
    let mut plc = Plc::start("LD X0;DMOV K5 D0;END");
    let state = plc.tell("force", json!({ "name": "D0:32", "value": -2 }));
    assert_eq!(state["forced"], json!(["D0", "D1"]));
    plc.set("X0", json!(1));
    plc.step(1);
    assert_eq!(plc.values(&["D0:32"]), [-2]);
    assert_eq!(plc.tell("release", json!({ "name": "D0:32" }))["forced"], json!([]));
    plc.step(1);
    assert_eq!(plc.values(&["D0:32"]), [5]);
}

#[test]
fn one_signal_takes_a_sequence_on_by_one_step() {
    let text = "LD X0;OUT M2800;LDP M2800;INC D0;LDP M2800;INC D1;LDP X0;INC D2;LDP X0;INC D3;END";
    let counts = last(text, &["X0=1@10", "X0=0@50", "X0=1@90"], "D0,D1,D2,D3");
    assert_eq!(counts, json!({"D0": 2, "D1": 0, "D2": 2, "D3": 2}));
    let text = "LD M8002;SET S0;LD X0;OUT M2800;STL S0;LDP M2800;SET S20;STL S20;LDP M2800;\
                SET S22;STL S22;OUT Y0;RET;END";
    assert_eq!(last(text, &["X0=1@20"], "S20,S22"), json!({"S20": true, "S22": false}));
    assert_eq!(last(text, &["X0=1@20", "X0=0@40", "X0=1@60"], "S20,S22"), json!({"S20": false, "S22": true}));
}

#[test]
fn timers_of_an_fx1s_count_finer_while_their_relay_is_on() {
    let text = program("LD X0;OUT M8028;LD X1;OUT T40 K3;OUT T31 K3;END");
    let files = [("rungwise.toml", "target = \"fx1s\"\n"), ("a.il", text.as_str())];
    let (code, rows, err) = told_in(&files, &["X0=1", "X1=1@20"], "TS40,TS31");
    assert_eq!(code, 0, "{err}");
    assert_eq!((first(&rows, "TS40", json!(true)), first(&rows, "TS31", json!(true))), (50, 320));
}

#[test]
fn clock_relays_never_stand_still() {
    let text = "LD M8011;INCP D0;LD M8012;INCP D1;LD M8013;INCP D2;END";
    let counts = last(text, &["--time", "10s"], "D0,D1,D2");
    assert_eq!(counts, json!({"D0": 500, "D1": 100, "D2": 10}));
    let counts = last(text, &["--time", "10s", "--scan-time", "100ms"], "D1,D2");
    assert_eq!(counts, json!({"D1": 50, "D2": 10}));
    assert_eq!(last(text, &["--time", "10s", "--scan-time", "2.5ms"], "D0"), json!({"D0": 1000}));
}

#[test]
fn a_document_that_is_opened_anew_is_taken_over_whatever_its_version() {
    let mut plc = Plc::start("LD M8000;OUT Y3;END");
    assert_eq!(plc.values(&["Y3"]), [1]);
    plc.client.notify("textDocument/didClose", json!({ "textDocument": { "uri": URI } }));
    plc.client.open(URI, "plc-il", &program("LD M8000;OUT Y4;END"));
    // Either it went on with the new text, or it saw that the document was closed.
    loop {
        let state = plc.tell("state", json!({ "names": ["Y4"] }));
        if state["mode"] == json!("stopped") {
            plc.tell("start", json!({ "paused": true }));
            break;
        }
        if state["edition"] == json!(1) {
            plc.step(1);
            break;
        }
        std::thread::yield_now();
    }
    assert_eq!(plc.values(&["Y4"]), [1]);
}

#[test]
fn closing_a_document_stops_its_simulation() {
    let mut plc = Plc::start("LD M8000;OUT Y3;END");
    plc.tell("watch", json!({ "names": ["Y3"] }));
    plc.tell("run", json!({ "speed": 0 }));
    plc.client.notify("textDocument/didClose", json!({ "textDocument": { "uri": URI } }));
    plc.client.wait_for("the last picture", |message| {
        message["method"] == "rungwise/monitor" && message["params"]["mode"] == json!("stopped")
    });
    assert_eq!(plc.tell("state", json!({}))["mode"], json!("stopped"));
}

#[test]
fn stop_says_so_and_shows_it() {
    let mut plc = Plc::start("LD M8000;OUT Y3;END");
    plc.tell("watch", json!({ "names": ["Y3"] }));
    assert_eq!(plc.tell("stop", json!({}))["mode"], json!("stopped"));
    plc.client.wait_for("the last picture", |message| {
        message["method"] == "rungwise/monitor" && message["params"]["mode"] == json!("stopped")
    });
}

#[test]
fn questions_are_answered_while_a_long_order_runs_and_another_order_ends_it() {
    let mut plc = Plc::start("LD M8000;INC D0;LD M8002;SET Y0;END");
    let long = plc.ask("step", json!({ "count": 1_000_000_000_000u64 }));
    let scan = plc.tell("state", json!({}))["scan"].as_u64().unwrap();
    assert!(!plc.client.has_answer(long), "it still runs");
    plc.tell("pause", json!({}));
    let answer = plc.client.answer(long);
    assert!(answer["result"]["scan"].as_u64().unwrap() >= scan, "{answer}");
    assert_eq!(answer["result"]["mode"], json!("paused"));
    let after = plc.tell("state", json!({}))["scan"].clone();
    assert_eq!(plc.tell("state", json!({}))["scan"], after, "it stands");
    let answer = plc.tell("stepBack", json!({ "changeOf": "Y0" }));
    assert_eq!(answer["scan"], json!(0));
}

#[test]
fn a_jump_out_of_an_inner_loop_leaves_the_outer_one_to_go_on() {
    let text = "FOR K3;LD M8000;INC D0;FOR K5;LD M8000;INC D1;LD M8000;CJ P1;NEXT;P1;NEXT;END";
    assert_eq!(last(text, &["--scans", "1"], "D0,D1"), json!({"D0": 3, "D1": 3}));
    // Out of a loop, and into it again from its start.
    let text = "LD M8000;MOV K0 D9;P2;FOR K2;LD M8000;INC D0;LD= D9 K0;CJ P3;NEXT;\
                LD M8000;CJ P4;P3;LD M8000;INC D9;CJ P2;P4;END";
    assert_eq!(last(text, &["--scans", "1"], "D0"), json!({"D0": 3}));
}

#[test]
fn a_master_control_that_nothing_closes_ends_with_the_main_program() {
    let text = "LD M8000;CALL P1;LD X1;MC N0 M100;LD M8000;OUT Y0;FEND;P1;LD M8000;OUT Y1;SRET;END";
    let found = told(text, &[], "Y0,Y1").1;
    assert_eq!(found.last().unwrap()["values"], json!({"Y0": false, "Y1": true}));
}

#[test]
fn inputs_and_forces_stay_when_a_plc_is_switched_on_again() {
    for verb in ["reset", "start"] {
        let mut plc = Plc::start("LD X0;OUT Y0;LD M8000;INC D0;OUT Y5;OUT T0 K99;END");
        plc.set("X0", json!(1));
        plc.tell("force", json!({ "name": "Y5", "value": 0 }));
        plc.tell("force", json!({ "name": "T0", "value": 7 }));
        plc.step(5);
        let state = plc.tell(verb, json!({ "paused": true }));
        assert_eq!((&state["scan"], &state["forced"]), (&json!(0), &json!(["Y5", "T0"])), "{verb}");
        assert_eq!(plc.values(&["X0", "Y0", "Y5", "D0", "T0"]), [1, 1, 0, 1, 7], "{verb}");
        // What was forced is so in history as well.
        plc.tell("release", json!({}));
        plc.step(2);
        plc.tell("stepBack", json!({ "count": 2 }));
        assert_eq!(plc.values(&["Y5"]), [0], "{verb}");
    }
}

#[test]
fn scan_times_and_speeds_that_make_no_sense_are_refused() {
    let mut plc = Plc::start("LD X0;OUT Y0;END");
    for scan_time in [json!(-5), json!(0), json!(1e308)] {
        plc.refused("start", json!({ "scanTime": scan_time }), "a scan time is 0.001 to 60000 ms");
    }
    plc.refused("start", json!({ "speed": -3 }), "a speed is 0");
    plc.refused("run", json!({ "speed": -3 }), "a speed is 0");
    assert_eq!(plc.tell("state", json!({}))["mode"], json!("paused"), "the simulation before goes on");
}

#[test]
fn settings_that_cannot_be_read_are_told_with_their_reason() {
    for (setting, said) in [
        ("D0=?", "`?` is no value for `D0`"),
        ("D0=1.5", "`D0` cannot be set to this value"),
        ("X0=1@-5", "`-5` is no time"),
        ("X0=2", "`X0` cannot be set to this value"),
    ] {
        let (code, _, err) = told("LD X0;OUT Y0;END", &[setting], "Y0");
        assert!(code == 2 && err.starts_with("error[bad-value]") && err.contains(said), "{setting}: {err}");
    }
    let (code, _, err) = told("LD X0;OUT Y0;END", &["--set", "X0"], "Y0");
    assert!(code == 2 && err.contains("NAME=VALUE@TIME"), "{err}");
}

#[test]
fn arguments_that_make_no_run_are_refused() {
    for arguments in
        [["--scan-time", "0"], ["--scans", "0"], ["--scans", "-1"], ["--trace", "a.xyz"], ["--trace", "a"]]
    {
        let (code, rows, err) = told("LD X0;OUT Y0;END", &arguments, "Y0");
        assert_eq!((code, rows.len()), (2, 0), "{arguments:?}: {err}");
        assert!(err.contains(arguments[1]) && !err.contains("-- -1"), "{arguments:?}: {err}");
    }
}

#[test]
fn a_program_in_which_the_check_finds_errors_runs_with_a_word_about_them() {
    let (code, rows, err) = told("LD X0;SET X5;OUT Y0", &["X0=1"], "Y0");
    assert_eq!((code, rows.len()), (0, 2), "{err}");
    assert!(err.starts_with("warning[check]") && err.contains("finds errors in it (2)"), "{err}");
    assert!(err.contains("a.il:3:5"), "{err}");
}

#[test]
fn what_is_watched_twice_is_shown_once_and_two_names_are_both_shown() {
    let rows = rows("LD X0;OUT Y0;END", &["X0=1"], "X0,X000,Y0,x0");
    assert_eq!(rows[0]["values"], json!({"X0": true, "X000": true, "Y0": true}));
}
