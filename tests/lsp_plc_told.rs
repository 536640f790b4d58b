//! What an editor is told beside the answers about a PLC: the status of programs, and how far something is.

use super::lsp_plc::Connected;
use crate::virtual_plc::{Pass, proxy};
use serde_json::{Value, json};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const LIST: &str = "LD X0\nOUT Y0\nEND\n";

#[test]
fn the_status_of_a_program_has_the_connection_and_the_mode() {
    let mut editor = Connected::open(LIST);
    let port = json!(editor.port.clone());
    let told = |editor: &mut Connected, connection: &Value, mode: Value| {
        let status = editor.client.wait_for("a status", |message| {
            let status = &message["params"];
            message["method"] == "rungwise/status"
                && (&status["connection"], &status["mode"]) == (connection, &mode)
        });
        assert_eq!(
            (&status["params"]["target"], &status["params"]["steps"]),
            (&json!("fx2n"), &json!(3)),
            "{status}"
        );
    };
    told(&mut editor, &port, json!("RUN"));
    // A program that is opened later is told the same.
    let uri = format!("{}.il", editor.uri);
    editor.client.open(&uri, "plc-il", LIST);
    let other = editor.client.wait_for("the status of the other", |message| {
        message["method"] == "rungwise/status" && message["params"]["uri"] == json!(uri)
    });
    assert_eq!((&other["params"]["connection"], &other["params"]["mode"]), (&port, &json!("RUN")), "{other}");
    editor.tell("stop", json!({}));
    told(&mut editor, &port, json!("STOP"));
    editor.tell("disconnect", json!({}));
    told(&mut editor, &Value::Null, Value::Null);
}

#[test]
fn a_document_that_is_not_open_is_named() {
    let mut editor = Connected::open(LIST);
    for verb in ["plan", "verify", "download", "monitor"] {
        let answer = editor.answer(verb, json!({ "uri": "file:///elsewhere.il", "confirmed": true }));
        let message = answer["error"]["message"].as_str().unwrap();
        assert_eq!(message, "file:///elsewhere.il is not open in the editor", "{verb}");
    }
}

#[test]
fn how_far_a_download_is_is_told_in_percent_bytes_and_time() {
    let long: String = (0..200).map(|n| format!("LD M{n}\nOUT M{}\n", n + 1)).collect();
    let mut editor = Connected::open(&format!("{long}END\n"));
    for (verb, words) in [("plan", &["reading"][..]), ("download", &["reading", "writing", "comparing"])] {
        let argument = json!({ "uri": editor.uri, "confirmed": true });
        let params = json!({ "command": format!("rungwise.plc.{verb}"), "arguments": [argument], "workDoneToken": verb });
        let answer = editor.client.request("workspace/executeCommand", params);
        assert!(answer["error"].is_null(), "{answer}");
        editor.client.wait_for("the end of the bar", |message| {
            message["params"]["token"] == verb && message["params"]["value"]["kind"] == "end"
        });
        let told = editor.client.notified("$/progress");
        let told =
            told.iter().filter(|told| told["params"]["token"] == verb).map(|told| &told["params"]["value"]);
        let told: Vec<&Value> = told.filter(|value| value["kind"] == "report").collect();
        let percent: Vec<u64> = told.iter().map(|value| value["percentage"].as_u64().unwrap()).collect();
        assert!(percent.is_sorted() && percent.last() == Some(&100), "{verb}: {percent:?}");
        let said: Vec<&str> = told.iter().map(|value| value["message"].as_str().unwrap()).collect();
        for word in words {
            let own: Vec<_> = said.iter().filter(|said| said.starts_with(&format!("{word}: "))).collect();
            assert!(own.iter().all(|said| said.ends_with(" s left") && said.contains(" bytes, ")), "{own:?}");
            assert!(!own.is_empty(), "{word}: {said:?}");
            // What there is in all is known from the beginning.
            let totals = own.iter().map(|said| said.split(' ').nth(3));
            assert!(totals.clone().all(|total| Some(total) == totals.clone().next_back()), "{own:?}");
        }
        // LD M, OUT M: two bytes each, and END.
        let last = if verb == "plan" {
            "reading: 2 of 2 bytes, 0 s left"
        } else {
            "comparing: 802 of 802 bytes, 0 s left"
        };
        assert_eq!(said.last(), Some(&last), "{said:?}");
    }
}

#[test]
fn a_picture_says_of_how_many_moments_it_is() {
    let mut editor = Connected::open(LIST);
    let names = |count: usize| (0..count).map(|number| format!("D{number}")).collect::<Vec<_>>();
    for (count, exchanges) in [(32, 1), (33, 2), (100, 4)] {
        editor.tell("monitor", json!({ "ranges": [], "names": names(count) }));
        let picture = editor.picture(|picture| picture["values"].as_array().unwrap().len() == count);
        assert_eq!(picture["exchanges"], exchanges, "{count}: {picture}");
    }
}

#[test]
fn the_port_of_the_project_is_among_the_ports() {
    let manifest = "port = \"tcp://127.0.0.1:5551\"\n";
    let mut editor = Connected::open_with(LIST, manifest, |plc| plc.port.clone());
    assert_eq!(editor.tell("ports", json!({}))["project"], "tcp://127.0.0.1:5551");
    let nameless = editor.answer("write", json!({ "name": "", "value": 1 }));
    assert!(nameless["error"]["message"].as_str().unwrap().contains("no device is named"), "{nameless}");
}

#[test]
fn what_was_shown_is_what_is_downloaded_and_is_not_read_again() {
    let reads = Arc::<AtomicUsize>::default();
    let counted = Arc::clone(&reads);
    let long: String = (0..200).map(|n| format!("LD M{n}\nOUT M{}\n", n + 1)).collect();
    let mut editor = Connected::open_with(&format!("{long}END\n"), "", |plc| {
        proxy(plc.address(), move |body| {
            counted.fetch_add(usize::from(body.starts_with("E01805C")), Ordering::Relaxed);
            Pass::On
        })
    });
    let confirmed = |plan: &Value| json!({ "confirmed": true, "sum": plan["sum"] });
    let plan = editor.tell("plan", json!({}));
    // The text moves on while somebody looks.
    editor.client.change(&editor.uri.clone(), 2, (0, 0), (0, 2), "LDI");
    editor.client.diagnostics(&editor.uri.clone(), 2);
    let answer = editor.answer("download", confirmed(&plan));
    assert!(answer["error"]["message"].as_str().unwrap().contains("what was shown"), "{answer}");
    let plan = editor.tell("plan", json!({}));
    let before = reads.swap(0, Ordering::Relaxed);
    assert_eq!(before, 2, "one for each plan");
    let done = editor.tell("download", confirmed(&plan));
    assert_eq!(reads.load(Ordering::Relaxed), 1, "read back, and not before");
    // All have ended.
    let backup = std::fs::read_to_string(done["backup"].as_str().unwrap()).unwrap();
    assert!(backup.contains("\"ended\": true"), "{backup}");
    // What was shown once is downloaded once.
    let plan = editor.tell("plan", json!({}));
    editor.tell("download", confirmed(&plan));
}

#[test]
fn a_command_that_there_is_not_is_refused() {
    let mut editor = Connected::open(LIST);
    let answer = editor.answer("explode", json!({}));
    assert!(answer["error"]["message"].as_str().unwrap().contains("rungwise.plc.explode"), "{answer}");
}

#[test]
fn a_drawing_is_compared_as_a_drawing() {
    let mut editor = Connected::open(LIST);
    editor.tell("download", json!({ "confirmed": true }));
    let drawn = "     X0          Y0\n|----|/|---------( )---|\n\n|--------------[END]---|\n";
    let uri = editor.uri.replace("motor.il", "motor.lad");
    editor.client.open(&uri, "ladder", drawn);
    editor.client.diagnostics(&uri, 1);
    let plan = editor.tell("plan", json!({ "uri": uri }));
    let [before, after] = ["before", "after"].map(|side| plan[side].as_str().unwrap().to_string());
    assert_eq!((&plan["form"], &plan["same"]), (&json!("ladder"), &json!(false)), "{plan}");
    assert!(before.contains("| |") && after.contains("|/|"), "{plan}");
    assert_eq!(editor.tell("plan", json!({}))["form"], "fx");
}

#[test]
fn a_file_that_was_just_opened_is_compared_with_all_files_of_its_program() {
    let mut plc = Connected::open("LD X0\nOUT Y0\nEND\n");
    let folder = plc.folder.path().canonicalize().unwrap().join("line");
    std::fs::create_dir(&folder).unwrap();
    let first = "LD X0\nCALL P1\nFEND\n";
    // So much to read that the answer would come before it, if it did not wait.
    let second = format!("P1\n{}SRET\nEND\n", "LD X1\nOUT Y1\n".repeat(500));
    std::fs::write(folder.join("first.il"), first).unwrap();
    std::fs::write(folder.join("second.il"), second).unwrap();
    let manifest = "target = \"fx2n\"\nfiles = [\"first.il\", \"second.il\"]\n";
    std::fs::write(folder.join("rungwise.toml"), manifest).unwrap();
    plc.uri = format!("file://{}", folder.join("first.il").display());
    plc.client.open(&plc.uri, "plc-il", first);
    let plan = plc.tell("plan", json!({}));
    assert!(plan.to_string().contains("SRET"), "{plan}");
}
