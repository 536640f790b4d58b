//! `rungwise.prove` over the protocol.

use super::lsp_client::Client;
use serde_json::{Value, json};

const LIST: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nEND\n";
const DRAWING: &str = "|  X0        X1     Y0  |\n+--| |---+---|/|----( )-+\n|  Y0    |              |\n+--| |---+              |\n";

fn asked(left: &str, right: &str) -> Value {
    json!({"command": "rungwise.prove", "arguments": [{"uri": left, "with": right}]})
}

/// A server that has a list open, and the address of a file beside it with this text, which is not open.
fn beside(name: &str, text: &str) -> (tempfile::TempDir, Client, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().canonicalize().unwrap();
    std::fs::write(path.join("list.il"), LIST).unwrap();
    std::fs::write(path.join(name), text).unwrap();
    let uri = |name: &str| format!("file://{}", path.join(name).display());
    let mut client = Client::start();
    client.open(&uri("list.il"), "plc-il", LIST);
    client.diagnostics(&uri("list.il"), 1);
    let (left, right) = (uri("list.il"), uri(name));
    (folder, client, left, right)
}

#[test]
fn a_list_and_its_drawing_on_the_disk_are_proved_equal() {
    let (_folder, mut client, left, right) = beside("drawing.lad", DRAWING);
    let answer = client.request("workspace/executeCommand", asked(&left, &right));
    let result = &answer["result"];
    assert_eq!(result["equal"], json!(true), "{answer}");
    assert_eq!(result["places"], json!([]));
    let page = result["page"].as_str().unwrap();
    assert!(page.starts_with("# list.il · drawing.lad\n\nequal:"), "{page}");
}

#[test]
fn a_difference_comes_with_its_inputs_its_places_and_a_picture() {
    let (_folder, mut client, left, right) = beside("other.lad", &DRAWING.replace("|/|", "| |"));
    // The text in the editor counts, not that on the disk.
    client.change(&left, 2, (0, 0), (0, 0), "// first\n");
    let answer = client.request("workspace/executeCommand", asked(&left, &right));
    let result = &answer["result"];
    assert_eq!(result["equal"], json!(false), "{answer}");
    let inputs = &result["counterexample"]["inputs"];
    let powered = inputs["X0"] == json!(true) || inputs["Y0"] == json!(true);
    assert!(powered && inputs["X1"].is_boolean(), "{inputs}");
    let places = result["places"].as_array().unwrap();
    assert_eq!(places.len(), 2, "{answer}");
    assert_eq!((&places[0]["uri"], &places[1]["uri"]), (&json!(left), &json!(right)));
    assert_eq!(places[0]["range"]["start"]["line"], json!(1));
    let page = result["page"].as_str().unwrap();
    assert!(page.contains("```text\n") && page.contains("▆▆") && page.contains("Y0 in other.lad"), "{page}");
}

#[test]
fn what_is_no_program_is_refused_in_words() {
    let (_folder, mut client, left, right) = beside("other.lad", DRAWING);
    for wrong in [right.replace("other", "none"), "untitled:none".to_string()] {
        let answer = client.request("workspace/executeCommand", asked(&left, &wrong));
        let message = answer["error"]["message"].as_str().unwrap_or_default();
        assert!(message.contains("no program"), "{answer}");
    }
    let params = json!({"command": "rungwise.prove", "arguments": [{"uri": left}]});
    let answer = client.request("workspace/executeCommand", params);
    assert!(answer["error"]["message"].as_str().unwrap_or_default().contains("with"), "{answer}");
}
