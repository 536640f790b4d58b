//! Refactorings through the wire: code actions with edits, of the kinds that a client asks for.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::lsp_client::Client;
use serde_json::{Value, json};

const URI: &str = "file:///tmp/refactor/main.il";

fn actions(client: &mut Client, from: (u32, u32), to: (u32, u32), only: &str) -> Vec<Value> {
    let position = |(line, character): (u32, u32)| json!({"line": line, "character": character});
    let params = json!({"textDocument": {"uri": URI}, "range": {"start": position(from), "end": position(to)},
        "context": {"diagnostics": [], "only": [only]}});
    client.request("textDocument/codeAction", params)["result"].as_array().unwrap().clone()
}

#[test]
fn a_refactoring_is_an_action_with_its_edit() {
    let mut client = Client::start();
    client.open(URI, "plc-il", "LD X0\nLD X1\nOR X2\nANB\nOUT Y0\n");
    let found = actions(&mut client, (0, 3), (0, 3), "refactor.rewrite.rung");
    let wide = found.iter().find(|action| action["kind"] == "refactor.rewrite.rung.wideFirst").unwrap();
    assert_eq!(wide["title"], "Move wide branch first (saves 1 step)");
    let edits = wide["edit"]["changes"][URI].as_array().unwrap_or_else(|| panic!("{wide}"));
    assert!(!edits.is_empty());
    assert!(
        found.iter().all(|action| action["kind"].as_str().unwrap().starts_with("refactor.rewrite.rung."))
    );
    let one = actions(&mut client, (0, 3), (0, 3), "refactor.rewrite.rung.wideFirst");
    assert_eq!(one.len(), 1);
    assert!(actions(&mut client, (0, 3), (0, 3), "quickfix").is_empty());
}

#[test]
fn a_selection_is_extracted_and_an_extract_menu_has_nothing_else() {
    let mut client = Client::start();
    client.open(URI, "plc-il", "LD X0\nAND X1\nAND X2\nOUT Y0\nEND\n");
    let found = actions(&mut client, (1, 0), (3, 0), "refactor.extract");
    let titles: Vec<&str> = found.iter().map(|action| action["title"].as_str().unwrap()).collect();
    assert_eq!(titles, ["Extract to internal relay M0 (2 steps more)"]);
}

#[test]
fn a_variable_is_declared_in_the_edit_that_extracts_it() {
    let mut client = Client::start();
    let head = "PROGRAM P\nVAR\n    a, b, c, x : BOOL;\nEND_VAR\n";
    client.open(URI, "plc-il", &format!("{head}    LD a\n    OR b\n    AND c\n    ST x\nEND_PROGRAM\n"));
    let found = actions(&mut client, (5, 7), (5, 7), "refactor.extract");
    assert_eq!(found[0]["title"], "Extract to internal relay Relay1");
    let edits = found[0]["edit"]["changes"][URI].as_array().unwrap();
    assert_eq!(edits[0]["newText"], "    Relay1     : BOOL;\n");
    assert_eq!(edits[0]["range"]["start"], json!({"line": 3, "character": 0}));
    assert!(edits.len() > 1);
    let inlined = actions(&mut client, (5, 7), (5, 7), "refactor.rewrite.rung");
    assert!(inlined.iter().all(|action| !action["title"].as_str().unwrap().contains("step")));
}

#[test]
fn devices_of_other_files_of_the_project_are_not_free() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("rungwise.toml"), "name = \"two\"\ntarget = \"fx2n\"\n").unwrap();
    std::fs::write(folder.path().join("other.il"), "LD M0\nOUT Y7\nEND\n").unwrap();
    let root = format!("file://{}", folder.path().display());
    let uri = format!("{root}/main.il");
    let text = "LD X0\nOR X3\nAND X1\nOUT Y0\n";
    std::fs::write(folder.path().join("main.il"), text).unwrap();
    let mut client = Client::spawn();
    let params = json!({"processId": null, "rootUri": root, "capabilities": {}});
    client.request("initialize", params);
    client.notify("initialized", json!({}));
    client.open(&uri, "plc-il", text);
    let place = json!({"line": 1, "character": 3});
    let params = json!({"textDocument": {"uri": uri}, "range": {"start": place, "end": place},
        "context": {"diagnostics": [], "only": ["refactor.extract"]}});
    let start = std::time::Instant::now();
    // The other file is read in the background.
    loop {
        let found = client.request("textDocument/codeAction", params.clone())["result"].clone();
        let title = found[0]["title"].as_str().unwrap_or_else(|| panic!("{found}")).to_string();
        if title.contains("relay M1 ") {
            break;
        }
        assert!(start.elapsed() < crate::lsp_client::PATIENCE, "{title}");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
}
