//! A session with a client that behaves badly: at the end the server knows the same as one that was just started.

use crate::lsp_client::{Client, at, codes};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Edits of the flood.
const EDITS: usize = 10_000;

/// Numbers that look random and are the same in each run (xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }
}

/// A text as the protocol's own words define edits of it, in UTF-16.
struct Model(String);

impl Model {
    /// The byte of a position: past the end of a line it is that end, past the last line the end of the text. Inside
    /// of a character it is the start of it.
    fn offset(&self, line: usize, column: usize) -> usize {
        // A line ends with a line feed, a carriage return, or both.
        let bytes = self.0.as_bytes();
        let ends =
            |at: &usize| bytes[*at] == b'\n' || bytes[*at] == b'\r' && bytes.get(at + 1) != Some(&b'\n');
        let starts = std::iter::once(0).chain((0..bytes.len()).filter(ends).map(|at| at + 1));
        let Some(start) = starts.into_iter().nth(line) else { return self.0.len() };
        let text = self.0[start..].split(['\n', '\r']).next().unwrap_or("");
        let mut units = 0;
        for (at, character) in text.char_indices() {
            units += character.len_utf16();
            if units > column {
                return start + at;
            }
        }
        start + text.len()
    }

    fn replace(&mut self, from: (usize, usize), to: (usize, usize), text: &str) {
        let start = self.offset(from.0, from.1);
        let end = self.offset(to.0, to.1).max(start);
        self.0.replace_range(start..end, text);
    }
}

/// Everything that a server says about a document.
fn knowledge(client: &mut Client, uri: &str) -> Vec<Value> {
    let document = json!({"textDocument": {"uri": uri}});
    let mut answers = Vec::new();
    for method in [
        "textDocument/documentSymbol",
        "textDocument/semanticTokens/full",
        "textDocument/foldingRange",
        "textDocument/diagnostic",
    ] {
        answers.push(client.request(method, document.clone())["result"].clone());
    }
    for line in (0..400).step_by(7) {
        for column in [0, 3, 9] {
            answers.push(client.request("textDocument/hover", at(uri, line, column))["result"].clone());
        }
        let mut params = at(uri, line, 4);
        params["context"] = json!({"includeDeclaration": true});
        answers.push(client.request("textDocument/references", params)["result"].clone());
    }
    // Names of results depend on more than the text.
    answers.iter_mut().for_each(|answer| _ = answer.as_object_mut().map(|answer| answer.remove("resultId")));
    answers
}

const IL: &str = "LD X0\nOR M0\nANI X1\nOUT M0\n(* 泵 🚰 *)\nLD M0\nOUT T0 K50\nLD T0\nOUT Y0\nCALL P1\nFEND\nP1\nLD X2\nOUT Y1\nSRET\nEND\n";

const LADDER: &str = "\
(* 🚰 *)
|   X0      X1     M0  |
+---| |--+--|/|----( )--+
|   M0   |              |
+---| |--+              |

|   M0         Y0       |
+---| |--------( )------+
";

const SNIPPETS: &[&str] = &[
    "",
    " ",
    "\n",
    "LD X3\n",
    "OUT Y2",
    "🚰",
    "(*",
    "*)",
    "P2\n",
    "---",
    "| |",
    "END\n",
    "K4M0",
    "\r\n",
    "\t",
    "泵",
    "|   X5     Y5  |\n+---| |----( )--+\n",
];

/// A position, sometimes one that the text does not have.
fn any_position(random: &mut Random, lines: usize) -> (usize, usize) {
    match random.below(20) {
        0 => (lines + random.below(1000), random.below(50)),
        1 => (random.below(lines), 100_000),
        2 => (u32::MAX as usize, u32::MAX as usize),
        _ => (random.below(lines), random.below(30)),
    }
}

#[test]
fn a_flood_of_bad_manners_leaves_the_state_of_the_text() {
    let mut client = Client::start();
    let uris = ["untitled:flood.il", "file:///nowhere/flood.lad"];
    let mut models = [Model(IL.repeat(8)), Model(LADDER.repeat(8))];
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let languages = ["plc-il", "ladder"];
    for number in 0..2 {
        client.open(uris[number], languages[number], &models[number].0);
    }
    let mut versions = [1i64, 1];
    let mut asked = Vec::new();
    for count in 0..EDITS {
        let number = random.below(2);
        let (uri, model) = (uris[number], &mut models[number]);
        let lines = model.0.matches('\n').count() + 1;
        let from = any_position(&mut random, lines);
        // A quarter of the ranges are given end first.
        let to = match random.below(4) {
            0 => any_position(&mut random, lines),
            _ => (from.0, from.1.saturating_add(random.below(6))),
        };
        // Keeps the text from dying out or growing without end.
        let to = if to.0 > from.0 + 2 { from } else { to };
        let text = SNIPPETS[random.below(SNIPPETS.len())];
        let text = if model.0.len() > 8_000 { "" } else { text };
        versions[number] += 1;
        let range = json!({
            "start": {"line": from.0, "character": from.1},
            "end": {"line": to.0, "character": to.1.min(u32::MAX as usize)},
        });
        let change = json!({"range": range, "text": text});
        let document = json!({"uri": uri, "version": versions[number]});
        client
            .notify("textDocument/didChange", json!({"textDocument": document, "contentChanges": [change]}));
        model.replace(from, to, text);
        match count % 10 {
            0 => asked
                .push(client.ask("textDocument/semanticTokens/full", json!({"textDocument": {"uri": uri}}))),
            3 => asked.push(client.ask("textDocument/hover", at(uri, from.0 as u32, from.1 as u32))),
            5 => asked.push(client.ask("workspace/symbol", json!({"query": "p"}))),
            7 => {
                let unknown = json!({"textDocument": {"uri": "file:///not/open.il"}});
                asked.push(client.ask("textDocument/foldingRange", unknown));
            }
            _ => {}
        }
        if count % 10 < 8 {
            asked.drain(..).for_each(|id| client.notify("$/cancelRequest", json!({"id": id})));
        }
        if count % 997 == 0 {
            client.notify("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
            client.notify(
                "textDocument/didChange",
                json!({"textDocument": {"uri": uri, "version": 9}, "contentChanges": [{"text": "lost"}]}),
            );
            versions[number] = 1;
            client.open(uri, languages[number], &model.0);
        }
    }
    let mut fresh = Client::start();
    for number in 0..2 {
        fresh.open(uris[number], languages[number], &models[number].0);
        let (old, new) = (knowledge(&mut client, uris[number]), knowledge(&mut fresh, uris[number]));
        let told = old.iter().filter(|answer| !answer.is_null()).count();
        assert!(told > 40, "{told} of {}", old.len());
        for (old, new) in old.iter().zip(&new) {
            assert_eq!(old, new, "in the text\n{}", models[number].0);
        }
        // What is pushed at last is what a new server pushes, too.
        let last = last_word(&mut client, uris[number], versions[number]);
        let new = last_word(&mut fresh, uris[number], 1);
        assert_eq!(codes(&last), codes(&new));
    }
}

/// The diagnostics of a version after which no more of them come: those of the whole program may follow the others.
fn last_word(client: &mut Client, uri: &str, version: i64) -> Vec<Value> {
    let mut last = client.diagnostics(uri, version);
    let of_version = |message: &Value| {
        let params = &message["params"];
        params["uri"] == json!(uri) && params["version"] == json!(version) && params["diagnostics"].is_array()
    };
    while !client.stays_silent(Duration::from_millis(600), of_version) {
        last = client.diagnostics(uri, version);
    }
    last
}

#[test]
fn a_file_under_two_spellings_is_one_file_for_the_project() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().canonicalize().unwrap();
    std::fs::write(root.join("rungwise.toml"), "target = \"iec\"\n").unwrap();
    let block = "FUNCTION_BLOCK Fill\nVAR_INPUT\n    Go : BOOL;\nEND_VAR\nVAR_OUTPUT\n    Valve : BOOL;\nEND_VAR\n    LD Go\n    ST Valve\nEND_FUNCTION_BLOCK\n";
    std::fs::write(root.join("fill.il"), block).unwrap();
    let main = "PROGRAM Main\nVAR\n    F : Fill;\n    Out AT %QX0.0 : BOOL;\nEND_VAR\n    CAL F\n    LD F.Valve\n    ST Out\nEND_PROGRAM\n";
    std::fs::write(root.join("main.il"), main).unwrap();
    let plain = format!("file://{}/fill.il", root.display());
    let odd = format!("file://{}/./%66ill.il", root.display());
    let user = format!("file://{}/main.il", root.display());
    let mut client = Client::start();
    client.open(&user, "plc-il", main);
    client.open(&plain, "plc-il", block);
    client.open(&odd, "plc-il", block);
    assert_eq!(client.diagnostics(&user, 1), [] as [Value; 0], "no block is declared twice");
    client.change(&plain, 2, (5, 4), (5, 9), "Open");
    client.change(&odd, 2, (5, 4), (5, 9), "Open");
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": plain}}));
    client.wait_for("the mistake", |message| {
        message["params"]["uri"] == json!(user)
            && message["params"]["diagnostics"].as_array().is_some_and(|found| !found.is_empty())
    });
    // The other spelling is still open and counts, not the disk.
    let definition = client.request("textDocument/definition", at(&user, 2, 8));
    assert_eq!(definition["result"][0]["uri"], json!(odd));
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": odd}}));
    client.wait_for("the mistake to go", |message| {
        message["params"]["uri"] == json!(user) && message["params"]["diagnostics"] == json!([])
    });
    let definition = client.request("textDocument/definition", at(&user, 2, 8));
    assert_eq!(definition["result"][0]["uri"], json!(plain), "and now that of the disk");
}

#[test]
fn a_document_that_is_reopened_at_once_does_not_flicker() {
    let uri = "untitled:one";
    let mut client = Client::start();
    client.open(uri, "plc-il", "LD X0\nOUT X1\nEND\n");
    assert_eq!(codes(&client.diagnostics(uri, 1)), ["write-to-input"]);
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
    client.open(uri, "plc-il", "LD X0\nOUT X1\nEND\n");
    assert_eq!(codes(&client.diagnostics(uri, 1)), ["write-to-input"]);
    let cleared = |message: &Value| message["params"]["diagnostics"] == json!([]);
    assert!(client.stays_silent(Duration::from_millis(300), cleared));
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
    client.wait_for("the end of the diagnostics", cleared);
}

#[test]
fn cancelled_work_is_answered_at_once() {
    let mut client = Client::start();
    let uri = "untitled:long.il";
    client.open(uri, "plc-il", &"LD X0\nAND X1\nOUT Y0\n".repeat(30_000));
    client.diagnostics(uri, 1);
    let params = json!({"textDocument": {"uri": uri}, "options": {"tabSize": 4, "insertSpaces": true}});
    let started = Instant::now();
    client.request("textDocument/formatting", params.clone());
    let whole = started.elapsed();
    let mut times = Vec::new();
    for _ in 0..20 {
        let id = client.ask("textDocument/formatting", params.clone());
        let started = Instant::now();
        client.notify("$/cancelRequest", json!({"id": id}));
        let answer = client.answer(id);
        assert_eq!(answer["error"]["code"], json!(-32800), "{answer}");
        times.push(started.elapsed());
    }
    times.sort_unstable();
    assert!(times[10] * 4 < whole, "{times:?} of {whole:?}");
}
