//! Features that reach across the files of a project, through the binary.

use crate::lsp_client::{Client, at, codes};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Duration;

/// Longer than every pause of the server.
const QUIET: Duration = Duration::from_millis(700);

/// A project in a temporary folder.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new(files: &[(&str, &str)]) -> Folder {
        let folder = Folder(tempfile::tempdir().unwrap());
        files.iter().for_each(|(name, text)| folder.write(name, text));
        folder
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().canonicalize().unwrap().join(name)
    }

    fn uri(&self, name: &str) -> String {
        format!("file://{}", self.path(name).display())
    }

    fn changed(&self, client: &mut Client, name: &str, kind: u8) {
        let changes = json!([{"uri": self.uri(name), "type": kind}]);
        client.notify("workspace/didChangeWatchedFiles", json!({"changes": changes}));
    }
}

const GLOBALS: &str = "\
VAR_GLOBAL
    Level : INT;
    Limit : INT := 80;
END_VAR
TYPE
    Mode : (Hand, Auto);
END_TYPE
";

const FILL: &str = "\
FUNCTION_BLOCK Fill
VAR_INPUT
    Go : BOOL;
END_VAR
VAR_OUTPUT
    Valve : BOOL;
END_VAR
VAR
    Full : BOOL;
END_VAR

|   Go      Full     Valve |
+---| |-----|/|------( )---+

END_FUNCTION_BLOCK
";

const MAIN: &str = "\
PROGRAM Main
VAR
    Filling : Fill;
    Start AT %IX0.0 : BOOL;
    Out AT %QX0.0 : BOOL;
    Way : Mode;
END_VAR
    LD Start
    ST Filling.Go
    CAL Filling
    LD Filling.Valve
    ST Out
    LD Hand
    ST Way
    LD Level
    GT Limit
    ST Out
END_PROGRAM
";

fn iec() -> Folder {
    // What the units do is no matter here.
    let manifest = "target = \"iec\"\n[rules]\nread-never-written = \"off\"\ndouble-coil = \"off\"\n";
    Folder::new(&[
        ("rungwise.toml", manifest),
        ("globals.il", GLOBALS),
        ("fill.lad", FILL),
        ("main.il", MAIN),
    ])
}

const FX_MAIN: &str = "LD X0\nCALL P1\nLD M0\nOUT Y0\nFEND\n";

const FX_SUBS: &str = "\
(* see main.il and nothing.il *)
P1:
|   X1    M0         |
+---| |---( )--------+

|                    |
+------------[SRET]--+

|                    |
+-------------[END]--+
";

fn fx() -> Folder {
    let manifest = "target = \"fx2n\"\nfiles = [\"main.il\", \"subs.lad\"]\n";
    Folder::new(&[("rungwise.toml", manifest), ("main.il", FX_MAIN), ("subs.lad", FX_SUBS)])
}

fn published(client: &mut Client, uri: &str) -> Vec<Value> {
    let message = client.wait_for(&format!("diagnostics of {uri}"), |message| {
        message["method"] == json!("textDocument/publishDiagnostics")
            && message["params"]["uri"] == json!(uri)
    });
    message["params"]["diagnostics"].as_array().unwrap().clone()
}

/// Waits for diagnostics of `uri` with these codes.
fn awaits(client: &mut Client, uri: &str, wanted: &[&str]) -> Vec<Value> {
    let message = client.wait_for(&format!("{wanted:?} in {uri}"), |message| {
        message["method"] == json!("textDocument/publishDiagnostics")
            && message["params"]["uri"] == json!(uri)
            && codes(message["params"]["diagnostics"].as_array().unwrap()) == wanted
    });
    message["params"]["diagnostics"].as_array().unwrap().clone()
}

fn is_about(uri: &str) -> impl Fn(&Value) -> bool + '_ {
    move |message| {
        message["method"] == json!("textDocument/publishDiagnostics")
            && message["params"]["uri"] == json!(uri)
    }
}

fn places(locations: &Value) -> Vec<(String, u64, u64)> {
    let place = |location: &Value| {
        let name = location["uri"].as_str().unwrap().rsplit('/').next().unwrap().to_string();
        let start = &location["range"]["start"];
        (name, start["line"].as_u64().unwrap(), start["character"].as_u64().unwrap())
    };
    locations.as_array().unwrap_or_else(|| panic!("no places: {locations}")).iter().map(place).collect()
}

fn place(name: &str, line: u64, character: u64) -> (String, u64, u64) {
    (name.to_string(), line, character)
}

#[test]
fn a_file_that_is_not_open_is_read_in_its_encoding() {
    let folder = iec();
    let [globals, main] = [GLOBALS, MAIN].map(|text| text.replace("Level", "电机"));
    let bytes = encoding_rs::GBK.encode(&globals).0.into_owned();
    std::fs::write(folder.path("globals.il"), bytes).unwrap();
    let mut client = Client::start();
    client.open(&folder.uri("main.il"), "plc-il", &main);
    awaits(&mut client, &folder.uri("main.il"), &[]);
    let found = client.request("textDocument/definition", at(&folder.uri("main.il"), 14, 7));
    assert_eq!(places(&found["result"]), [place("globals.il", 1, 4)]);
}

#[test]
fn a_file_belongs_to_the_innermost_of_projects_in_each_other() {
    let manifest = "target = \"fx2n\"\n";
    let names: Vec<String> = (0..8).map(|depth| "in/".repeat(depth)).collect();
    let folder = fx();
    for name in &names[1..] {
        folder.write(&format!("{name}rungwise.toml"), manifest);
    }
    let inner = names.last().unwrap();
    let main = folder.uri(&format!("{inner}main.il"));
    folder.write(&format!("{inner}main.il"), FX_MAIN);
    folder.write(&format!("{inner}subs.lad"), FX_SUBS);
    let mut client = Client::spawn();
    let folders = json!([{"uri": folder.uri(""), "name": "plant"}]);
    client.request("initialize", json!({"processId": null, "capabilities": {}, "workspaceFolders": folders}));
    client.notify("initialized", json!({}));
    client.open(&main, "plc-il", FX_MAIN);
    published(&mut client, &main);
    for _ in 0..100 {
        let prepared = client.request("textDocument/prepareCallHierarchy", at(&main, 1, 6));
        let item = prepared["result"][0].clone();
        let incoming = client.request("callHierarchy/incomingCalls", json!({"item": item}));
        if incoming["result"][0]["from"]["name"] == json!("main.il") {
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("the file of the call is in no project");
}

/// A client that has the program and the block of `folder` open, both published.
fn with_both_open(folder: &Folder) -> (Client, String, String) {
    let (main, fill) = (folder.uri("main.il"), folder.uri("fill.lad"));
    let mut client = Client::start();
    client.open(&main, "plc-il", MAIN);
    client.open(&fill, "ladder", FILL);
    published(&mut client, &main);
    published(&mut client, &fill);
    (client, main, fill)
}

#[test]
fn iec_files_know_what_the_others_declare() {
    let folder = iec();
    let (main, fill, globals) = (folder.uri("main.il"), folder.uri("fill.lad"), folder.uri("globals.il"));
    let mut client = Client::start();
    client.open(&main, "plc-il", MAIN);
    assert_eq!(codes(&published(&mut client, &main)), [""; 0], "also at the first moment");
    client.open(&fill, "ladder", FILL);
    assert_eq!(codes(&published(&mut client, &fill)), [""; 0]);
    // Full is a name that nothing but its own unit knows.
    client.change(&fill, 2, (8, 4), (8, 8), "Level");
    awaits(&mut client, &fill, &["unused-variable", "undeclared-variable"]);
    client.change(&fill, 3, (8, 4), (8, 9), "Full");
    awaits(&mut client, &fill, &[]);
    client.change(&fill, 4, (5, 4), (5, 9), "Open");
    let found = awaits(&mut client, &main, &["unknown-parameter"]);
    assert_eq!(found[0]["range"]["start"]["line"], json!(10), "{found:?}");
    client.change(&fill, 5, (5, 4), (5, 8), "Valve");
    awaits(&mut client, &main, &[]);
    // What the editor has counts, then what the disk has.
    client.open(&globals, "plc-il", &GLOBALS.replace("Limit", "Most"));
    awaits(&mut client, &main, &["undeclared-variable"]);
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": globals}}));
    awaits(&mut client, &main, &[]);
}

/// What other files saw of an edit that was taken back before it was judged does not stay in them.
#[test]
fn an_edit_that_is_taken_back_at_once_leaves_nothing_in_other_files() {
    let folder = iec();
    let (mut client, main, fill) = with_both_open(&folder);
    let globals = folder.uri("globals.il");
    client.open(&globals, "plc-il", GLOBALS);
    client.stays_silent(QUIET, |_| false);
    let mut version = 1;
    // The other files are linked some sixty milliseconds after a declaration.
    for (round, wait) in (40..80).step_by(4).enumerate() {
        let declared = if round % 2 == 0 { "    More : INT;\n" } else { "" };
        let lines = if round % 2 == 0 { 1 } else { 2 };
        client.change(&globals, round as i64 + 2, (1, 0), (lines, 0), declared);
        std::thread::sleep(Duration::from_millis(wait));
        client.change(&fill, version + 1, (5, 4), (5, 9), "Latch");
        std::thread::sleep(Duration::from_millis(25));
        client.change(&fill, version + 2, (5, 4), (5, 9), "Valve");
        version += 2;
        client.stays_silent(QUIET, |_| false);
        let mut last = None;
        while let Some(message) = client.take(is_about(&main)) {
            last = Some(message);
        }
        if let Some(last) = last {
            let found = last["params"]["diagnostics"].as_array().unwrap();
            assert_eq!(codes(found), [""; 0], "after {wait} ms");
        }
    }
}

#[test]
fn a_keystroke_costs_nothing_in_other_files() {
    let folder = iec();
    let (mut client, main, fill) = with_both_open(&folder);
    client.stays_silent(QUIET, |_| false);
    while client.take(is_about(&main)).is_some() {}
    client.change(&fill, 2, (11, 13), (11, 15), "-|");
    client.change(&fill, 3, (11, 13), (11, 15), "|/");
    client.change(&fill, 4, (8, 15), (8, 15), " := FALSE");
    client.diagnostics(&fill, 4);
    assert!(client.stays_silent(QUIET, is_about(&main)), "nothing changed for the other file");
}

#[test]
fn duplicates_and_circles_are_found_across_files() {
    let folder = iec();
    let main = folder.uri("main.il");
    folder.write(
        "again.il",
        "FUNCTION_BLOCK Fill\nVAR\n    Inner : Outer;\nEND_VAR\n    CAL Inner\nEND_FUNCTION_BLOCK\n",
    );
    folder.write(
        "round.il",
        "FUNCTION_BLOCK Outer\nVAR\n    Own : Outer2;\nEND_VAR\n    CAL Own\nEND_FUNCTION_BLOCK\n",
    );
    folder.write(
        "square.il",
        "FUNCTION_BLOCK Outer2\nVAR\n    Own : Outer;\nEND_VAR\n    CAL Own\nEND_FUNCTION_BLOCK\n",
    );
    let mut client = Client::start();
    client.open(&main, "plc-il", MAIN);
    // The files come by name: again.il is the first with Fill.
    let found = awaits(&mut client, &folder.uri("fill.lad"), &["duplicate-declaration"]);
    let related = &found[0]["relatedInformation"];
    assert_eq!(places(&json!([related[0]["location"]])), [place("again.il", 0, 15)]);
    let found = awaits(&mut client, &folder.uri("square.il"), &["recursive-pou"]);
    let related = &found[0]["relatedInformation"];
    assert_eq!(places(&json!([related[0]["location"]])), [place("round.il", 2, 10)], "{found:?}");
}

#[test]
fn the_files_of_an_fx_program_are_executed_one_behind_the_other() {
    let folder = fx();
    let (main, subs) = (folder.uri("main.il"), folder.uri("subs.lad"));
    let mut client = Client::start();
    client.open(&main, "plc-il", FX_MAIN);
    client.open(&subs, "ladder", FX_SUBS);
    awaits(&mut client, &main, &[]);
    awaits(&mut client, &subs, &[]);
    client.change(&main, 2, (5, 0), (5, 0), "P1\nLD X5\nOUT Y5\nSRET\n");
    let found = awaits(&mut client, &subs, &["duplicate-label"]);
    let related = &found[0]["relatedInformation"][0];
    assert_eq!(places(&json!([related["location"]])), [place("main.il", 5, 0)], "{found:?}");
    client.change(&main, 3, (5, 0), (9, 0), "END\n");
    let found = awaits(&mut client, &subs, &["code-after-end"]);
    let related = &found[0]["relatedInformation"][0];
    assert_eq!(places(&json!([related["location"]])), [place("main.il", 5, 0)], "{found:?}");
    client.change(&main, 4, (5, 0), (6, 0), "");
    awaits(&mut client, &subs, &[]);
    client.change(&subs, 2, (1, 0), (2, 0), "P2:\n");
    awaits(&mut client, &main, &["undefined-label"]);
    awaits(&mut client, &subs, &["unused-label"]);
}

#[test]
fn files_that_are_not_listed_and_end_are_programs_of_their_own() {
    let folder = Folder::new(&[
        ("rungwise.toml", "target = \"fx2n\"\n"),
        ("a.il", "LD X0\nCJ P1\nLD X1\nOUT Y0\nP1\nLD X2\nOUT Y1\nEND\n"),
        ("b.il", "LD X0\nCJ P1\nLD X1\nOUT Y0\nP1\nLD X2\nOUT Y1\nEND\n"),
    ]);
    let text = std::fs::read_to_string(folder.path("b.il")).unwrap();
    let mut client = Client::start();
    client.open(&folder.uri("b.il"), "plc-il", &text);
    assert_eq!(codes(&published(&mut client, &folder.uri("b.il"))), [""; 0]);
    let found = client.request("textDocument/references", {
        let mut params = at(&folder.uri("b.il"), 1, 3);
        params["context"] = json!({"includeDeclaration": true});
        params
    });
    assert_eq!(places(&found["result"]), [place("b.il", 1, 3), place("b.il", 4, 0)]);
}

#[test]
fn files_that_are_not_open_are_reported_unless_only_open_ones_are_wanted() {
    let files =
        [("rungwise.toml", "target = \"fx2n\"\n"), ("a.il", "LD X0\nOUT X1\nEND\n"), ("b.il", "END\n")];
    let folder = Folder::new(&files);
    let (closed, open) = (folder.uri("a.il"), folder.uri("b.il"));
    let mut client = Client::start();
    client.open(&open, "plc-il", "END\n");
    awaits(&mut client, &closed, &["write-to-input"]);
    // Opened, mended, closed without being saved: the disk counts again.
    client.open(&closed, "plc-il", "LD X0\nOUT X1\nEND\n");
    awaits(&mut client, &closed, &["write-to-input"]);
    client.change(&closed, 2, (1, 4), (1, 6), "Y1");
    awaits(&mut client, &closed, &[]);
    client.notify("textDocument/didClose", json!({"textDocument": {"uri": closed}}));
    awaits(&mut client, &closed, &["write-to-input"]);
    // Mended on the disk, then removed.
    folder.write("a.il", "LD X0\nOUT Y10\nEND\n");
    folder.changed(&mut client, "a.il", 2);
    awaits(&mut client, &closed, &[]);
    folder.write("a.il", "LD X0\nOUT X1\nEND\n");
    folder.changed(&mut client, "a.il", 2);
    awaits(&mut client, &closed, &["write-to-input"]);
    std::fs::remove_file(folder.path("a.il")).unwrap();
    folder.changed(&mut client, "a.il", 3);
    awaits(&mut client, &closed, &[]);
    let mut client = Client::start_with(json!({}), json!({"diagnostics": {"scope": "open"}}));
    folder.write("a.il", "LD X0\nOUT X1\nEND\n");
    client.open(&open, "plc-il", "END\n");
    awaits(&mut client, &open, &[]);
    assert!(client.stays_silent(QUIET, is_about(&closed)));
}

#[test]
fn definitions_and_references_reach_other_files() {
    let folder = iec();
    let main = folder.uri("main.il");
    let mut client = Client::start();
    client.open(&main, "plc-il", MAIN);
    published(&mut client, &main);
    let mut definition = |line, character| {
        let answer = client.request("textDocument/definition", at(&main, line, character));
        places(&answer["result"])
    };
    assert_eq!(definition(2, 15), [place("fill.lad", 0, 15)], "the function block");
    assert_eq!(definition(8, 15), [place("fill.lad", 2, 4)], "its parameter");
    assert_eq!(definition(14, 8), [place("globals.il", 1, 4)], "a global variable");
    assert_eq!(definition(5, 11), [place("globals.il", 5, 4)], "a type");
    let mut params = at(&main, 8, 15);
    params["context"] = json!({"includeDeclaration": true});
    let found = client.request("textDocument/references", params);
    let expected = [place("fill.lad", 2, 4), place("fill.lad", 11, 4), place("main.il", 8, 15)];
    assert_eq!(places(&found["result"]), expected);
}

#[test]
fn devices_and_labels_are_one_in_all_files_of_a_program() {
    let folder = fx();
    let main = folder.uri("main.il");
    let mut client = Client::start();
    client.open(&main, "plc-il", FX_MAIN);
    published(&mut client, &main);
    let definition = client.request("textDocument/definition", at(&main, 1, 6));
    assert_eq!(places(&definition["result"]), [place("subs.lad", 1, 0)]);
    let definition = client.request("textDocument/definition", at(&main, 2, 4));
    assert_eq!(places(&definition["result"]), [place("subs.lad", 2, 10)], "where the relay is driven");
}

/// Applies the edits of a rename to the texts of files.
fn renamed(edit: &Value, texts: &[(&str, &str)]) -> Vec<String> {
    let changes = |name: &str| -> Vec<Value> {
        let ends = |uri: &str| uri.ends_with(&format!("/{name}"));
        if let Some(changes) = edit["changes"].as_object() {
            let edits = changes.iter().filter(|(uri, _)| ends(uri));
            return edits.flat_map(|(_, edits)| edits.as_array().unwrap().clone()).collect();
        }
        let changes = edit["documentChanges"].as_array().unwrap_or_else(|| panic!("no edits: {edit}")).iter();
        let changes = changes.filter(|change| ends(change["textDocument"]["uri"].as_str().unwrap()));
        changes.flat_map(|change| change["edits"].as_array().unwrap().clone()).collect()
    };
    let apply = |(name, text): &(&str, &str)| {
        let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
        let mut edits = changes(name);
        let start = |edit: &Value| {
            let start = &edit["range"]["start"];
            (start["line"].as_u64().unwrap() as usize, start["character"].as_u64().unwrap() as usize)
        };
        edits.sort_by_key(|edit| std::cmp::Reverse(start(edit)));
        for edit in edits {
            let (line, from) = start(&edit);
            let to = edit["range"]["end"]["character"].as_u64().unwrap() as usize;
            lines[line].replace_range(from..to, edit["newText"].as_str().unwrap());
        }
        lines.join("\n") + "\n"
    };
    texts.iter().map(apply).collect()
}

#[test]
fn rename_changes_all_files() {
    let folder = iec();
    let (mut client, main, _) = with_both_open(&folder);
    let mut rename = |uri: &str, line, character, new: &str| {
        let mut params = at(uri, line, character);
        params["newName"] = json!(new);
        client.request("textDocument/rename", params)
    };
    let answer = rename(&main, 8, 15, "Run");
    let changes = answer["result"]["documentChanges"].as_array().unwrap();
    assert_eq!(changes.len(), 2);
    assert!(changes.iter().all(|change| change["textDocument"]["version"] == json!(1)), "{changes:?}");
    let texts = renamed(&answer["result"], &[("fill.lad", FILL), ("main.il", MAIN)]);
    assert!(texts[0].contains("    Run : BOOL;") && texts[1].contains("ST Filling.Run"));
    assert!(texts[0].contains("|   Run     Full     Valve |"), "columns are kept: {}", texts[0]);
    let answer = rename(&main, 14, 8, "Height");
    let texts = renamed(&answer["result"], &[("globals.il", GLOBALS), ("main.il", MAIN)]);
    assert_eq!(texts[0], GLOBALS.replace("Level", "Height"));
    assert_eq!(texts[1], MAIN.replace("Level", "Height"));
    let globals = answer["result"]["documentChanges"].as_array().unwrap().iter();
    let versions: Vec<&Value> = globals.map(|change| &change["textDocument"]["version"]).collect();
    assert_eq!(versions, [&Value::Null, &json!(1)], "a file that is not open has no version");
    let answer = rename(&main, 14, 8, "Full");
    let reason = answer["error"]["message"].as_str().unwrap();
    assert!(reason.contains("fill.lad") && reason.contains("line 9"), "{reason}");
}

#[test]
fn a_client_without_versioned_edits_gets_plain_ones() {
    let folder = fx();
    let main = folder.uri("main.il");
    let mut client = Client::start_with(json!({"workspace": {}}), Value::Null);
    client.open(&main, "plc-il", FX_MAIN);
    published(&mut client, &main);
    let mut params = at(&main, 2, 4);
    params["newName"] = json!("M10");
    let answer = client.request("textDocument/rename", params);
    let texts = renamed(&answer["result"], &[("main.il", FX_MAIN), ("subs.lad", FX_SUBS)]);
    assert!(answer["result"]["changes"].is_object());
    assert_eq!(texts[0], FX_MAIN.replace("M0", "M10"));
    assert!(texts[1].contains("|   X1    M10        |\n+---| |---( )--------+"), "{}", texts[1]);
    let mut params = at(&main, 1, 6);
    params["newName"] = json!("P7");
    let answer = client.request("textDocument/rename", params);
    let texts = renamed(&answer["result"], &[("main.il", FX_MAIN), ("subs.lad", FX_SUBS)]);
    assert!(texts[0].contains("CALL P7") && texts[1].contains("\nP7:\n"));
}

#[test]
fn names_are_found_in_the_whole_workspace() {
    let folder = iec();
    let mut client = Client::spawn();
    let folders = json!([{"uri": folder.uri(""), "name": "plant"}]);
    client.request("initialize", json!({"processId": null, "capabilities": {}, "workspaceFolders": folders}));
    client.notify("initialized", json!({}));
    let mut names = |query: &str| {
        // Nothing is open, so nothing but the answers tells when the project was read.
        for _ in 0..100 {
            let answer = client.request("workspace/symbol", json!({"query": query}));
            if let Some(found) = answer["result"].as_array() {
                let name = |symbol: &Value| {
                    let words = [&symbol["name"], &symbol["containerName"]].map(|w| w.as_str().unwrap_or(""));
                    words.join(" in ").trim_end_matches(" in ").to_string()
                };
                return found.iter().map(name).collect::<Vec<_>>();
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        panic!("the project is not read");
    };
    assert_eq!(names("fill"), ["Fill", "Filling in Main"]);
    assert_eq!(names("lmt"), ["Limit"]);
    assert_eq!(names("mode"), ["Mode"]);
    assert_eq!(names("xyzzy"), [""; 0]);
    let event = json!({"event": {"removed": [{"uri": folder.uri(""), "name": "plant"}], "added": []}});
    client.notify("workspace/didChangeWorkspaceFolders", event);
    for _ in 0..100 {
        let answer = client.request("workspace/symbol", json!({"query": "fill"}));
        if answer["result"].is_null() {
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("a removed folder is still searched");
}

#[test]
fn calls_are_followed_across_files() {
    let folder = fx();
    let (main, subs) = (folder.uri("main.il"), folder.uri("subs.lad"));
    let mut client = Client::start();
    client.open(&main, "plc-il", FX_MAIN);
    published(&mut client, &main);
    let prepared = client.request("textDocument/prepareCallHierarchy", at(&main, 1, 6));
    let item = prepared["result"][0].clone();
    assert_eq!((item["name"].as_str(), item["uri"].as_str()), (Some("P1"), Some(subs.as_str())));
    let incoming = client.request("callHierarchy/incomingCalls", json!({"item": item}));
    let caller = &incoming["result"][0];
    assert_eq!(caller["from"]["name"], json!("main.il"), "{incoming}");
    assert_eq!(caller["fromRanges"][0]["start"], json!({"line": 1, "character": 5}));
    let outgoing = client.request("callHierarchy/outgoingCalls", json!({"item": caller["from"]}));
    assert_eq!(outgoing["result"][0]["to"]["name"], json!("P1"), "{outgoing}");
    assert_eq!(outgoing["result"][0]["to"]["range"]["end"]["line"], json!(6), "to the return");

    let folder = iec();
    let main = folder.uri("main.il");
    client.open(&main, "plc-il", MAIN);
    published(&mut client, &main);
    let prepared = client.request("textDocument/prepareCallHierarchy", at(&main, 9, 10));
    let item = prepared["result"][0].clone();
    assert_eq!((&item["name"], &item["detail"]), (&json!("Fill"), &json!("FUNCTION_BLOCK")));
    let incoming = client.request("callHierarchy/incomingCalls", json!({"item": item}));
    assert_eq!(incoming["result"][0]["from"]["name"], json!("Main"), "{incoming}");
    let outgoing =
        client.request("callHierarchy/outgoingCalls", json!({"item": incoming["result"][0]["from"]}));
    assert_eq!(outgoing["result"][0]["to"], item);
}

#[test]
fn names_of_files_are_links_if_there_are_such_files() {
    let folder = fx();
    let (subs, manifest) = (folder.uri("subs.lad"), folder.uri("rungwise.toml"));
    let mut client = Client::start();
    client.open(&subs, "ladder", FX_SUBS);
    let links = client.request("textDocument/documentLink", json!({"textDocument": {"uri": subs}}));
    assert_eq!(links["result"].as_array().unwrap().len(), 1, "{links}");
    assert_eq!(links["result"][0]["target"], json!(folder.uri("main.il")));
    assert_eq!(links["result"][0]["range"]["start"], json!({"line": 0, "character": 7}));
    client.open(&manifest, "toml", &std::fs::read_to_string(folder.path("rungwise.toml")).unwrap());
    let links = client.request("textDocument/documentLink", json!({"textDocument": {"uri": manifest}}));
    let targets: Vec<&Value> =
        links["result"].as_array().unwrap().iter().map(|link| &link["target"]).collect();
    assert_eq!(targets, [&json!(folder.uri("main.il")), &json!(subs)]);
    assert!(client.stays_silent(QUIET, is_about(&manifest)), "a manifest is no program");
}

#[test]
fn files_that_appear_change_and_go_are_noticed() {
    let folder = iec();
    let main = folder.uri("main.il");
    std::fs::remove_file(folder.path("globals.il")).unwrap();
    let watching = json!({"workspace": {"didChangeWatchedFiles": {"dynamicRegistration": true}}});
    let mut client = Client::start_with(watching, Value::Null);
    let request = client.wait_for_method("client/registerCapability");
    let globs = request["params"]["registrations"][0]["registerOptions"].to_string();
    assert!(globs.contains("lad") && globs.contains("csv") && globs.contains("rungwise.toml"), "{globs}");
    client.open(&main, "plc-il", MAIN);
    let missing = ["unknown-type", "undeclared-variable", "undeclared-variable", "undeclared-variable"];
    awaits(&mut client, &main, &missing);
    folder.write("globals.il", GLOBALS);
    folder.changed(&mut client, "globals.il", 1);
    awaits(&mut client, &main, &[]);
    std::fs::remove_file(folder.path("globals.il")).unwrap();
    folder.changed(&mut client, "globals.il", 3);
    awaits(&mut client, &main, &missing);
    // A client that watches nothing is looked after when it saves.
    let mut client = Client::start();
    client.open(&main, "plc-il", MAIN);
    awaits(&mut client, &main, &missing);
    folder.write("globals.il", GLOBALS);
    client.notify("textDocument/didSave", json!({"textDocument": {"uri": main}}));
    awaits(&mut client, &main, &[]);
}

#[test]
fn settings_are_asked_for() {
    let capabilities = json!({"workspace": {"configuration": true}});
    let mut client = Client::start_with(capabilities, Value::Null);
    let request = client.wait_for_method("workspace/configuration");
    assert_eq!(request["params"]["items"][0]["section"], json!("rungwise"));
    let uri = "untitled:one";
    client.open(uri, "plc-il", "LD X0\nOUT Y400\nEND\n");
    awaits(&mut client, uri, &["device-out-of-range"]);
    client.send(json!({"jsonrpc": "2.0", "id": request["id"], "result": [{"target": "fx3u"}]}));
    let status = client.wait_for("the status", |message| {
        message["method"] == json!("rungwise/status") && message["params"]["target"] == json!("fx3u")
    });
    assert_eq!(status["params"]["uri"], json!(uri));
    client.notify("workspace/didChangeConfiguration", json!({"settings": null}));
    let request = client.wait_for_method("workspace/configuration");
    client.send(json!({"jsonrpc": "2.0", "id": request["id"], "result": [{"target": "fx1s"}]}));
    client.wait_for("the status", |message| {
        message["method"] == json!("rungwise/status") && message["params"]["target"] == json!("fx1s")
    });
}

#[test]
fn another_language_has_everything_asked_for_again() {
    const TEXT: &str = "PROGRAM p\nLD a\nEND_PROGRAM\n";
    let folder = Folder::new(&[("rungwise.toml", "target = \"iec\"\n"), ("main.il", TEXT)]);
    let capabilities = json!({"workspace": {"diagnostics": {"refreshSupport": true},
        "inlayHint": {"refreshSupport": true}}, "textDocument": {"diagnostic": {}}});
    let mut client = Client::start_with(capabilities, json!({"diagnostics": {"mode": "pull"}}));
    client.open(&folder.uri("main.il"), "plc-il", TEXT);
    let ask = |client: &mut Client| {
        let answer = client.request("workspace/diagnostic", json!({"previousResultIds": []}));
        answer["result"]["items"].to_string()
    };
    // The project is read in the background, which is a reason to ask again as well.
    let is_read = (0..200).any(|_| {
        std::thread::sleep(Duration::from_millis(25));
        ask(&mut client).contains("is not declared")
    });
    assert!(is_read);
    client.stays_silent(Duration::from_millis(300), |_| false);
    while client.take(|message| message["method"] == json!("workspace/diagnostic/refresh")).is_some() {}
    while client.take(|message| message["method"] == json!("workspace/inlayHint/refresh")).is_some() {}
    let settings = json!({"settings": {"rungwise": {"language": "zh-CN", "diagnostics": {"mode": "pull"}}}});
    client.notify("workspace/didChangeConfiguration", settings);
    let request = client.wait_for_method("workspace/diagnostic/refresh");
    client.send(json!({"jsonrpc": "2.0", "id": request["id"], "result": null}));
    client.wait_for_method("workspace/inlayHint/refresh");
    let found = ask(&mut client);
    assert!(found.contains("没有在 p 中声明") && !found.contains("is not declared"), "{found}");
}

#[test]
fn symbols_are_known_in_files_that_are_not_open() {
    let folder = iec();
    folder.write("rungwise.toml", "target = \"fx2n\"\ncomments = \"devices.csv\"\n");
    folder.write("devices.csv", "X0,Start,\nM0,Lamps,\n");
    for name in ["main.il", "globals.il"] {
        std::fs::remove_file(folder.path(name)).ok();
    }
    folder.write("one.il", "LD Start\nMOV K4Lamps D0\nOUT Nobody\nEND\n");
    folder.write("two.lad", "|  Start    Lamps  |\n+--| |-------( )---+\n\n[END]\n");
    let mut client = Client::start_with(json!({}), json!({"diagnostics": {"mode": "pull"}}));
    client.open(&folder.uri("two.lad"), "ladder", "|  Start    Lamps  |\n+--| |-------( )---+\n\n[END]\n");
    let mut found = String::new();
    for _ in 0..200 {
        let answer = client.request("workspace/diagnostic", json!({"previousResultIds": []}));
        found = answer["result"]["items"].to_string();
        // What the open file knows of the project comes a moment after the project is read.
        if found.contains("Nobody") && !found.contains("`Start`") {
            break;
        }
        std::thread::sleep(Duration::from_millis(25));
    }
    assert!(found.contains("`Nobody` is no device"), "{found}");
    assert!(!found.contains("`Start`") && !found.contains("K4Lamps"), "{found}");
}

#[test]
fn the_workspace_is_reported_on_demand() {
    let folder = iec();
    let main = folder.uri("main.il");
    let mut client = Client::start_with(json!({}), json!({"diagnostics": {"mode": "pull"}}));
    client.open(&main, "plc-il", &MAIN.replace("ST Out", "ST Nothing"));
    client.wait_for_method("rungwise/status");
    // A part of the answer goes to each of the tokens.
    let tokens = json!({"previousResultIds": [], "partialResultToken": "part", "workDoneToken": "work"});
    let answer = client.request("workspace/diagnostic", tokens);
    assert_eq!(answer["result"], json!({"items": []}), "all went to the token");
    let is_progress = |token: &'static str| {
        move |message: &Value| {
            message["method"] == json!("$/progress") && message["params"]["token"] == json!(token)
        }
    };
    let part = client.wait_for("a partial result", is_progress("part"));
    let items = part["params"]["value"]["items"].as_array().unwrap().clone();
    let of_main = items.iter().find(|item| item["uri"] == json!(main)).unwrap();
    assert_eq!(codes(of_main["items"].as_array().unwrap()), ["undeclared-variable"]);
    assert_eq!((items.len(), &of_main["version"]), (3, &json!(1)));
    for kind in ["begin", "end"] {
        client.wait_for(kind, |message| {
            is_progress("work")(message) && message["params"]["value"]["kind"] == json!(kind)
        });
    }
    let known = items.iter().map(|item| json!({"uri": item["uri"], "value": item["resultId"]}));
    let mut known: Vec<Value> = known.collect();
    known.push(json!({"uri": folder.uri("gone.il"), "value": "x"}));
    let answer = client.request("workspace/diagnostic", json!({"previousResultIds": known}));
    let mut kinds: Vec<&str> = answer["result"]["items"]
        .as_array()
        .unwrap()
        .iter()
        .map(|item| item["kind"].as_str().unwrap())
        .collect();
    kinds.sort_unstable();
    assert_eq!(kinds, ["full", "unchanged", "unchanged", "unchanged"], "and what is gone is cleared");
}

#[test]
fn long_reading_is_shown_where_the_client_shows_it() {
    // Work that is done in less than 0.3 s shows nothing.
    let size = if cfg!(debug_assertions) { 600 } else { 6000 };
    let text = "LD X0\nAND X1\nOUT Y0\n".repeat(size);
    let names: Vec<String> = (0..400).map(|number| format!("part{number}.il")).collect();
    let mut files: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), text.as_str())).collect();
    files.push(("rungwise.toml", "target = \"fx2n\"\n"));
    let folder = Folder::new(&files);
    let mut client = Client::start_with(json!({"window": {"workDoneProgress": true}}), Value::Null);
    client.open(&folder.uri("part0.il"), "plc-il", &text);
    let request = client.wait_for_method("window/workDoneProgress/create");
    client.send(json!({"jsonrpc": "2.0", "id": request["id"], "result": null}));
    for kind in ["begin", "end"] {
        let message = client.wait_for(kind, |message| {
            message["method"] == json!("$/progress") && message["params"]["value"]["kind"] == json!(kind)
        });
        assert_eq!(message["params"]["token"], request["params"]["token"]);
    }
}

#[test]
fn a_client_that_knows_less_gets_less() {
    let poor = json!({"textDocument": {"hover": {}, "codeAction": {}, "documentSymbol": {}, "completion": {"completionItem": {}},
        "publishDiagnostics": {}}});
    let mut client = Client::start_with(poor, Value::Null);
    let uri = "untitled:one";
    client.open(uri, "plc-il", "LD X0\nOUT Y0\nP1\nEND\n");
    let hover = client.request("textDocument/hover", at(uri, 0, 0));
    assert_eq!(hover["result"]["contents"]["kind"], json!("plaintext"));
    assert!(!hover["result"]["contents"]["value"].as_str().unwrap().contains("**"));
    let symbols = client.request("textDocument/documentSymbol", json!({"textDocument": {"uri": uri}}));
    assert!(symbols["result"][0]["location"].is_object(), "a list: {symbols}");
    let proposals = client.request("textDocument/completion", at(uri, 3, 0));
    let items = proposals["result"].as_array().or(proposals["result"]["items"].as_array()).unwrap();
    let mov = items.iter().find(|item| item["label"] == json!("MOV")).unwrap();
    assert_eq!(mov["documentation"]["kind"], json!("plaintext"), "{mov}");
    assert!(mov["labelDetails"].is_null() && mov["detail"] == json!("move"), "{mov}");
    assert!(items.iter().all(|item| item["insertTextFormat"] != json!(2)), "no places to fill in");
    let range = json!({"start": {"line": 0, "character": 0}, "end": {"line": 3, "character": 0}});
    let context = json!({"diagnostics": []});
    let params = json!({"textDocument": {"uri": uri}, "range": range, "context": context});
    let actions = client.request("textDocument/codeAction", params);
    let command = &actions["result"][0];
    assert_eq!(command["command"], json!("rungwise.applyEdit"), "{actions}");
    let params = json!({"command": command["command"], "arguments": command["arguments"]});
    client.request("workspace/executeCommand", params);
    let applied = client.wait_for_method("workspace/applyEdit");
    assert_eq!(applied["params"]["edit"], command["arguments"][0]);
    assert_eq!(client.initialised["capabilities"]["renameProvider"], json!(true), "no options");
    let twice = "untitled:two";
    client.open(twice, "plc-il", TWICE);
    let found = awaits(&mut client, twice, &["duplicate-label"]);
    assert!(found[0]["relatedInformation"].is_null(), "{found:?}");
    let definition = client.request("textDocument/definition", at(twice, 1, 3));
    assert!(definition["result"][0]["range"].is_object(), "a place: {definition}");
}

/// A program with a label that stands twice.
const TWICE: &str = "LD X0\nCJ P1\nLD X1\nOUT Y0\nP1\nLD X2\nOUT Y1\nP1\nLD X3\nOUT Y2\nEND\n";

#[test]
fn a_client_that_knows_more_gets_more() {
    let rich = json!({"textDocument": {"hover": {"contentFormat": ["markdown"]}, "definition": {"linkSupport": true},
        "documentSymbol": {"hierarchicalDocumentSymbolSupport": true}, "publishDiagnostics": {"relatedInformation": true},
        "rename": {"prepareSupport": true}, "completion": {"completionItem": {"documentationFormat": ["markdown"],
        "snippetSupport": true, "labelDetailsSupport": true}}}});
    let mut client = Client::start_with(rich, Value::Null);
    let uri = "untitled:two";
    client.open(uri, "plc-il", TWICE);
    let found = awaits(&mut client, uri, &["duplicate-label"]);
    assert_eq!(
        found[0]["relatedInformation"][0]["location"]["range"]["start"]["line"],
        json!(4),
        "{found:?}"
    );
    let hover = client.request("textDocument/hover", at(uri, 0, 0));
    assert_eq!(hover["result"]["contents"]["kind"], json!("markdown"));
    let symbols = client.request("textDocument/documentSymbol", json!({"textDocument": {"uri": uri}}));
    assert!(symbols["result"][0]["selectionRange"].is_object(), "a tree: {symbols}");
    let proposals = client.request("textDocument/completion", at(uri, 3, 0));
    let mov =
        proposals["result"].as_array().unwrap().iter().find(|item| item["label"] == json!("MOV")).unwrap();
    let told = [&mov["documentation"]["kind"], &mov["labelDetails"]["description"], &mov["insertTextFormat"]];
    assert_eq!(told, [&json!("markdown"), &json!("move"), &json!(2)], "{mov}");
    let definition = client.request("textDocument/definition", at(uri, 1, 3));
    let link = &definition["result"][0];
    let asked = json!({"start": {"line": 1, "character": 3}, "end": {"line": 1, "character": 5}});
    assert_eq!((&link["originSelectionRange"], &link["targetUri"]), (&asked, &json!(uri)), "{definition}");
    let options = &client.initialised["capabilities"]["renameProvider"];
    assert_eq!(options["prepareProvider"], json!(true), "{options}");
}

#[test]
fn edits_of_a_text_that_changed_meanwhile_are_not_given() {
    let mut client = Client::start();
    let uri = "untitled:long.il";
    client.open(uri, "plc-il", &"LD X0\nAND X1\nOUT Y0\n".repeat(30_000));
    let options = json!({"tabSize": 4, "insertSpaces": true});
    let id = client.ask("textDocument/formatting", json!({"textDocument": {"uri": uri}, "options": options}));
    client.change(uri, 2, (0, 0), (0, 0), "LD X7\n");
    assert_eq!(client.answer(id)["error"]["code"], json!(-32801));
}
