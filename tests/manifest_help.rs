//! `rungwise.toml` in the editor, through the binary: diagnostics while it is typed, completion, hover.

use crate::lsp_client::Client;
use proptest::prelude::*;
use rungwise::check::RULES;
use rungwise::ide::{Schema, manifest_completions, manifest_hover};
use rungwise::text::Language;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

/// Longer than every pause of the server.
const QUIET: Duration = Duration::from_millis(500);

/// The schema of the manifest.
pub static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
    serde_json::from_str(include_str!("../vscode-extension/schemas/rungwise.schema.json")).unwrap()
});

/// A folder with some files, and the address of its manifest, which is written if there is a text for it.
fn folder(manifest: Option<&str>) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().canonicalize().unwrap();
    std::fs::create_dir(root.join("sub")).unwrap();
    for name in ["main.lad", "sub/motors.il", "notes.txt", "devices.csv"] {
        std::fs::write(root.join(name), "").unwrap();
    }
    if let Some(text) = manifest {
        std::fs::write(root.join("rungwise.toml"), text).unwrap();
    }
    let uri = format!("file://{}", root.join("rungwise.toml").display());
    (folder, uri)
}

fn client(language: &str) -> Client {
    let knows = json!({"textDocument": {"completion": {"completionItem": {"snippetSupport": true}},
        "hover": {"contentFormat": ["markdown"]}}});
    Client::start_with(knows, json!({"language": language}))
}

/// Line and column of `$0`, and the text without it.
fn marked(text: &str) -> (Value, String) {
    let offset = text.find("$0").expect("a mark");
    let line = text[..offset].matches('\n').count();
    let column = text[..offset].rsplit('\n').next().unwrap().len();
    (json!({"line": line, "character": column}), text.replacen("$0", "", 1))
}

/// The proposals at `$0`: label, and the manifest with what is inserted.
fn proposals(text: &str) -> Vec<(String, String)> {
    let (position, text) = marked(text);
    let (_folder, uri) = folder(None);
    let mut client = client("en");
    client.open(&uri, "toml", &text);
    let params = json!({"textDocument": {"uri": uri}, "position": position});
    let answer = client.request("textDocument/completion", params)["result"].clone();
    let applied = |item: &Value| {
        let edit = &item["textEdit"];
        let offset = |place: &Value| {
            let lines: usize =
                text.split_inclusive('\n').take(place["line"].as_u64().unwrap() as usize).map(str::len).sum();
            lines + place["character"].as_u64().unwrap() as usize
        };
        let (start, end) = (offset(&edit["range"]["start"]), offset(&edit["range"]["end"]));
        format!("{}{}{}", &text[..start], edit["newText"].as_str().unwrap(), &text[end..])
    };
    let items = answer.as_array().unwrap().iter();
    items.map(|item| (item["label"].as_str().unwrap().to_string(), applied(item))).collect()
}

fn labels(text: &str) -> BTreeSet<String> {
    proposals(text).into_iter().map(|(label, _)| label).collect()
}

fn set<'w>(words: impl IntoIterator<Item = &'w str>) -> BTreeSet<String> {
    words.into_iter().map(str::to_string).collect()
}

/// The manifest with one proposal.
fn with(text: &str, label: &str) -> String {
    let found = proposals(text);
    let one = found.iter().find(|(own, _)| own == label);
    one.unwrap_or_else(|| panic!("{label} in {found:?}")).1.clone()
}

#[test]
fn keys_and_tables_that_are_not_there_yet_are_proposed() {
    let keys = ["name", "target", "dialect", "files", "comments", "port"];
    let tables = [
        "[check]",
        "[format]",
        "[monitor]",
        "[plc]",
        "[rules]",
        "[[alarm]]",
        "[simulate]",
        "[[task]]",
        "[translate]",
    ];
    assert_eq!(labels("$0"), set(keys.into_iter().chain(tables)));
    let left = labels("target = \"fx2n\"\n$0\nname = \"a\"\n[rules]\n");
    let tables =
        ["[check]", "[format]", "[monitor]", "[plc]", "[[alarm]]", "[simulate]", "[[task]]", "[translate]"];
    assert_eq!(left, set(["dialect", "files", "comments", "port"].into_iter().chain(tables)));
    let left = labels("[format]\nstyle = \"iec\"\n$0");
    assert_eq!(
        left,
        set([
            "width",
            "[check]",
            "[monitor]",
            "[plc]",
            "[rules]",
            "[[alarm]]",
            "[simulate]",
            "[[task]]",
            "[translate]"
        ])
    );
    // Each task has keys of its own, and a key in another table is no key of this one.
    let task = "name = \"x\"\n[[task]]\nname = \"a\"\n[[task]]\n$0";
    assert!(
        labels(task).is_superset(&set(["name", "interval", "priority", "programs"])),
        "{:?}",
        labels(task)
    );
    assert_eq!(labels("[fo$0"), set(["[format]"]));
    assert_eq!(with("[fo$0", "[format]"), "[format]");
    assert_eq!(with("[$0]\nx", "[rules]"), "[rules]\nx");
    assert_eq!(with("[[ta$0]]\n", "[[task]]"), "[[task]]\n");
    assert_eq!(with("fo$0", "[format]"), "[format]");
    assert_eq!(with("ta$0 = 1", "target"), "target = 1", "a key that has a value is replaced alone");
    assert_eq!(with("ta$0", "target"), "target = \"${1|fx1s,fx1n,fx2n,fx3u,iec|}\"");
    assert_eq!(with("[check]\nn$0", "never"), "[check]\nnever = [\"$1\"]");
    assert_eq!(with("[format]\nw$0", "width"), "[format]\nwidth = ${1:48}");
    assert_eq!(with("format = { $0 }", "style"), "format = { style = \"${1|iec,brackets,unicode|}\" }");
    assert_eq!(with("format = {$0}", "style"), "format = {style = \"${1|iec,brackets,unicode|}\"}");
    assert_eq!(with("\"tar$0\"", "target"), "\"target\"", "a key in quotes is completed inside them");
    assert_eq!(labels("# tar$0"), set([]));
    assert_eq!(labels("target $0"), set([]));
}

#[test]
fn values_are_the_words_and_files_that_fit() {
    let targets = ["fx1s", "fx1n", "fx2n", "fx3u", "iec"];
    assert_eq!(labels("target = $0"), set(targets));
    assert_eq!(labels("target = \"$0\""), set(targets));
    assert_eq!(labels("target = \"$0\n[format]\n"), set(targets), "a string that is not closed yet");
    assert_eq!(with("target = $0", "fx2n"), "target = \"fx2n\"");
    assert_eq!(with("target = \"fx$0\" # why", "fx2n"), "target = \"fx2n\" # why");
    assert_eq!(labels("[rules]\nopen-circuit = \"$0\""), set(["error", "warning", "hint", "off"]));
    assert_eq!(labels("rules = { open-circuit = \"$0\" }"), set(["error", "warning", "hint", "off"]));
    assert_eq!(labels("rules.open-circuit = \"$0\""), set(["error", "warning", "hint", "off"]));
    let codes = RULES.iter().map(|rule| rule.code).filter(|code| *code != "open-circuit");
    let rules = labels("[rules]\nopen-circuit = \"off\"\n$0\n[check]\n[format]\n[[task]]\n");
    assert_eq!(
        rules,
        set(codes.chain(["[monitor]", "[plc]", "[[alarm]]", "[simulate]", "[[task]]", "[translate]"]))
    );
    assert_eq!(labels("[translate]\ntarget = $0"), set(["fx1s", "fx1n", "fx2n", "fx3u"]));
    assert_eq!(labels("files = [$0"), set(["main.lad", "sub/motors.il"]));
    assert_eq!(labels("files = [$0]"), set(["main.lad", "sub/motors.il"]), "closed by the editor");
    assert_eq!(labels("files = [\"main.lad\", $0]"), set(["sub/motors.il"]));
    assert_eq!(labels("files = [\"main.lad\"$0]"), set([]));
    assert_eq!(labels("files = [\n  \"main.lad\",\n  \"$0\"\n]\n"), set(["sub/motors.il"]));
    assert_eq!(with("files = $0", "main.lad"), "files = [\"main.lad\"]");
    assert_eq!(labels("[[task]]\nprograms = [\"$0\"]"), set(["main.lad", "sub/motors.il"]));
    assert_eq!(labels("comments = \"$0\""), set(["devices.csv"]));
    assert_eq!(labels("[format]\nwidth = $0"), set(["48"]));
    assert_eq!(with("[check]\nnever = $0", "[\"Y0 & Y1\"]"), "[check]\nnever = [\"Y0 & Y1\"]");
    assert_eq!(labels("target = \"fx2n\" $0"), set([]));
    assert_eq!(labels("files = [\"main.lad\"\ntarget = \"$0\""), set(targets), "behind a list that is open");
}

/// The Markdown of the hover at `$0`.
fn hover(language: &str, text: &str) -> Option<String> {
    let (position, text) = marked(text);
    let (_folder, uri) = folder(None);
    let mut client = client(language);
    client.open(&uri, "toml", &text);
    let params = json!({"textDocument": {"uri": uri}, "position": position});
    client.request("textDocument/hover", params)["result"]["contents"]["value"].as_str().map(str::to_string)
}

#[test]
fn every_key_says_what_it_is_for_in_both_languages() {
    let description =
        |place: &str| SCHEMA.pointer(place).unwrap()["description"].as_str().unwrap().to_string();
    let said = hover("en", "tar$0get = \"fx2n\"").unwrap();
    assert!(said.contains(&description("/properties/target")) && said.contains("`fx3u`"), "{said}");
    let said = hover("en", "target = \"fx$02n\"").unwrap();
    assert!(said.contains(&description("/properties/target")), "of a value that of its key: {said}");
    let said = hover("en", "[form$0at]").unwrap();
    assert!(said.contains(&description("/properties/format")), "{said}");
    let said = hover("en", "[format]\nwid$0th = 60").unwrap();
    assert!(
        said.contains(&description("/properties/format/properties/width")) && said.contains("`48`"),
        "{said}"
    );
    let rule = RULES.iter().find(|rule| rule.code == "upper-parallel").unwrap();
    let said = hover("en", "[rules]\nupper-$0parallel = \"off\"").unwrap();
    assert!(said.contains(&rule.summary(Language::English)), "{said}");
    assert!(said.contains(&format!("Left out: `{}`", rule.severity.word())), "{said}");
    assert_eq!(hover("en", "col$0our = 1"), None);
    assert_eq!(hover("en", "# tar$0get"), None);
    // All keys in Chinese: each description is a phrase that is translated.
    let mut manifests: Vec<(String, String)> = Vec::new();
    for (key, node) in SCHEMA["properties"].as_object().unwrap() {
        let element = if node["items"].is_object() { &node["items"] } else { node };
        manifests.push((key.clone(), format!("$0{key} = 1")));
        for inner in element["properties"].as_object().into_iter().flatten().map(|(inner, _)| inner) {
            manifests.push((format!("{key}.{inner}"), format!("[{key}]\n$0{inner} = 1")));
        }
    }
    assert!(manifests.len() > 60, "{}", manifests.len());
    let (_folder, uri) = folder(None);
    let mut client = client("zh-CN");
    client.open(&uri, "toml", "");
    for (number, (key, text)) in manifests.iter().enumerate() {
        let (position, text) = marked(text);
        let document = json!({"uri": uri, "version": number + 2});
        client.notify(
            "textDocument/didChange",
            json!({"textDocument": document, "contentChanges": [{"text": text}]}),
        );
        let params = json!({"textDocument": {"uri": uri}, "position": position});
        let answer = client.request("textDocument/hover", params);
        let said =
            answer["result"]["contents"]["value"].as_str().unwrap_or_else(|| panic!("{key}: {answer}"));
        let sentence = said.lines().nth(2).unwrap();
        assert!(sentence.chars().any(|c| ('\u{4e00}'..='\u{9fff}').contains(&c)), "{key}: {said}");
    }
}

/// What `check` says about the manifest in a folder.
fn said_by_check(folder: &Path) -> String {
    let run =
        Command::new(env!("CARGO_BIN_EXE_rungwise")).args(["check", "--lang", "en"]).arg(folder).output();
    String::from_utf8(run.unwrap().stderr).unwrap()
}

#[test]
fn a_mistake_is_shown_while_it_is_typed_in_the_words_of_check() {
    let (folder, uri) = folder(Some("target = \"fx9\"\n"));
    let mut client = client("en");
    client.open(&uri, "toml", "target = \"fx2n\"\n");
    assert!(
        client.stays_silent(QUIET, |message| message["params"]["uri"] == json!(uri)
            || message["method"] == json!("window/showMessage")),
        "the buffer wins over the disk"
    );
    client.change(&uri, 2, (0, 10), (0, 14), "fx9");
    let found = client.diagnostics(&uri, 2);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0]["range"]["start"], json!({"line": 0, "character": 10}));
    assert_eq!(found[0]["range"]["end"], json!({"line": 0, "character": 13}));
    let words = found[0]["message"].as_str().unwrap();
    let said = said_by_check(folder.path());
    assert!(said.contains(words), "{words} in {said}");
    client.change(&uri, 3, (0, 0), (0, 6), "tarjet");
    assert_eq!(client.diagnostics(&uri, 3)[0]["range"]["start"], json!({"line": 0, "character": 0}));
    client.change(&uri, 4, (0, 0), (1, 0), "name = \"\u{1F40E}\"\n");
    assert_eq!(client.diagnostics(&uri, 4), Vec::<Value>::new());
    assert!(client.notified("window/showMessage").is_empty(), "who types sees it where it is");
}

#[test]
fn what_the_disk_says_of_a_closed_manifest_is_shown_again() {
    let (folder, uri) = folder(Some("target = \"fx9\"\n"));
    let program = format!("file://{}", folder.path().canonicalize().unwrap().join("main.lad").display());
    let mut client = client("en");
    client.open(&program, "ladder", "");
    let about = |message: &Value| {
        message["method"] == json!("textDocument/publishDiagnostics")
            && message["params"]["uri"] == json!(uri)
    };
    let shown = client.wait_for("the mistake on the disk", about);
    assert_eq!(shown["params"]["diagnostics"].as_array().unwrap().len(), 1);
    client.open(&uri, "toml", "target = \"fx2n\"\n");
    let shown = client.wait_for("the clearing", about);
    assert_eq!(shown["params"]["diagnostics"], json!([]));
    // The project is read again for whatever reason: the buffer still wins.
    client.notify("workspace/didChangeWatchedFiles", json!({"changes": [{"uri": uri, "type": 2}]}));
    assert!(client.stays_silent(QUIET, about));
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
    let shown = client.wait_for("the mistake again", about);
    assert_eq!(shown["params"]["diagnostics"][0]["range"]["start"], json!({"line": 0, "character": 10}));
}

#[test]
fn a_manifest_is_no_program() {
    let (_folder, uri) = folder(None);
    let mut client = client("en");
    client.open(&uri, "toml", "target = \"fx2n\"\n");
    let document = json!({"textDocument": {"uri": uri}, "options": {"tabSize": 4, "insertSpaces": true}});
    for method in ["codeLens", "documentSymbol", "formatting", "semanticTokens/full", "foldingRange"] {
        let answer = client.request(&format!("textDocument/{method}"), document.clone());
        assert_eq!(answer["result"], Value::Null, "{method}: {answer}");
    }
    let at = json!({"textDocument": {"uri": uri}, "positions": [{"line": 0, "character": 0}]});
    let answer = client.request("textDocument/selectionRange", at);
    assert_eq!(answer["result"], Value::Null, "{answer}");
    let report = client.request("textDocument/diagnostic", document);
    assert_eq!(report["result"]["items"], json!([]), "they are pushed: {report}");
}

#[test]
fn the_sign_of_words_opens_no_list_in_programs() {
    let mut client = client("en");
    let uri = "file:///tmp/manifest-signs/a.il";
    client.open(uri, "plc-il", "LD ");
    let mut ask = |sign: Value| {
        let position = json!({"line": 0, "character": 3});
        let params = json!({"textDocument": {"uri": uri}, "position": position, "context": sign});
        client.request("textDocument/completion", params)["result"].clone()
    };
    assert_eq!(ask(json!({"triggerKind": 2, "triggerCharacter": "\""})), Value::Null);
    let asked = ask(json!({"triggerKind": 1}));
    assert!(!asked.as_array().unwrap().is_empty(), "{asked}");
}

#[test]
fn a_manifest_of_any_depth_is_read_in_bounded_time() {
    let deep = [("x = ", "["), ("x = ", "{a="), ("", "a."), ("[", "a."), ("", "[")];
    for (start, repeated) in deep {
        let text = format!("{start}{}", repeated.repeat(200_000));
        let begun = Instant::now();
        let found =
            manifest_completions(Schema::Manifest, &text, text.len(), &|_| Vec::new(), Language::English);
        assert!(
            found.len() < 200 && begun.elapsed() < Duration::from_secs(5),
            "{repeated}: {:?}",
            begun.elapsed()
        );
    }
}

proptest! {
    /// Whatever is typed, and wherever one asks: no panic, and what is replaced has the cursor in its line.
    #[test]
    fn help_in_any_text(text in "([\\[\\]{}=\"',.#\\\\é𠀀 \n\r]|rules|task|format|files|a|1){0,40}") {
        for offset in (0..=text.len()).filter(|offset| text.is_char_boundary(*offset)) {
            if let Some(hover) = manifest_hover(Schema::Manifest, &text, offset, Language::English) {
                prop_assert!(text.get(hover.span.range()).is_some());
            }
            for found in manifest_completions(Schema::Manifest, &text, offset, &|_| Vec::new(), Language::English) {
                let replaced = text.get(found.edit.span.range());
                prop_assert!(replaced.is_some_and(|text| !text.contains('\n')), "{text:?} {offset} {found:?}");
                prop_assert!(found.edit.span.touches(offset), "{text:?} {offset} {found:?}");
            }
        }
    }
}
