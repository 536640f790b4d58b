//! What is found in one rung is shown before what takes long, old work ends when the text moves on, and requests are
//! answered meanwhile.

use super::lsp_client::{Client, at, codes};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// A rung whose decision diagram grows beyond any limit, as its contacts are asked for in an order in which the second
/// half says nothing about the first: `(M0 + M1 + …) · (M0 · M100 + M1 · M101 + …)`.
pub fn hard_rung(number: usize) -> String {
    const PAIRS: usize = 30;
    let mut rung = "LD M0\n".to_string();
    (1..PAIRS).for_each(|pair| rung += &format!("OR M{pair}\n"));
    for pair in 0..PAIRS {
        rung += &format!("LD M{pair}\nAND M{}\n", 100 + pair);
        rung += if pair > 0 { "ORB\n" } else { "" };
    }
    rung + &format!("ANB\nOUT M{}\n", 1000 + number)
}

/// So many of them, behind a rung with an octal mistake and a coil that is driven twice, and a contact that is never
/// on at the end.
fn hard_program(rungs: usize) -> String {
    let mut text = "LD X8\nOUT Y0\nLD X1\nOUT Y0\n".to_string();
    (0..rungs).for_each(|number| text += &hard_rung(number));
    text + "LD X2\nANI X2\nOUT Y1\nEND\n"
}

const URI: &str = "file:///streaming/program.il";

fn published(client: &mut Client, version: i64) -> (Vec<String>, Duration) {
    let started = Instant::now();
    let found = client.diagnostics(URI, version);
    (codes(&found), started.elapsed())
}

fn client() -> Client {
    let mut client = Client::spawn();
    client.initialise(json!({}), json!({"target": "fx3u"}));
    client
}

fn version_of(message: &Value) -> Option<i64> {
    let is_told = message["method"] == "textDocument/publishDiagnostics";
    message["params"]["version"].as_i64().filter(|_| is_told)
}

#[test]
fn what_is_found_at_once_does_not_wait_for_proofs() {
    let mut client = client();
    client.open(URI, "plc-il", &hard_program(8));
    let (first, _) = published(&mut client, 1);
    assert!(first.contains(&"octal-digit".to_string()), "{first:?}");
    assert!(!first.contains(&"never-energised".to_string()), "the proofs go on: {first:?}");
    let hover = Instant::now();
    let answer = client.request("textDocument/hover", at(URI, 2, 4));
    assert!(answer["result"]["contents"].is_object(), "{answer}");
    assert!(hover.elapsed() < Duration::from_secs(2), "a hover waits for no proof");
    // What the rules about the program find comes before the proofs are done, and all of it stays.
    let (mut last, mut before) = (first, Vec::new());
    while !last.contains(&"never-energised".to_string()) {
        before = std::mem::replace(&mut last, published(&mut client, 1).0);
    }
    assert!(before.contains(&"double-coil".to_string()), "{before:?}");
    for code in ["octal-digit", "double-coil", "contradiction-on-path"] {
        assert!(last.contains(&code.to_string()), "{code} in {last:?}");
    }
}

#[test]
fn an_edit_ends_the_proofs_of_the_old_text() {
    let mut client = client();
    client.open(URI, "plc-il", &hard_program(8));
    published(&mut client, 1);
    // The mistake is mended while the proofs go on.
    let started = Instant::now();
    client.change(URI, 2, (0, 4), (0, 5), "7");
    let (mended, _) = published(&mut client, 2);
    assert!(!mended.contains(&"octal-digit".to_string()), "{mended:?}");
    let waited = started.elapsed();
    let mut last = mended;
    while !last.contains(&"never-energised".to_string()) {
        (last, _) = published(&mut client, 2);
    }
    let whole = started.elapsed();
    assert!(waited < whole / 4, "{waited:?} of {whole:?}");
    let old = |message: &Value| version_of(message) == Some(1);
    assert!(client.stays_silent(Duration::from_millis(300), old), "nothing about the old text comes later");
}
