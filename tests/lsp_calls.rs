//! Who calls whom, through the server: pointers and labels of the FX family, labels, blocks and functions of IEC 61131-3.

use crate::lsp_client::{Client, at};
use serde_json::{Value, json};
use std::path::PathBuf;

/// A project that is open in a server, all of its files or the first one only.
struct Project {
    folder: tempfile::TempDir,
    client: Client,
}

impl Project {
    fn new(files: &[(&str, &str)], opened: usize) -> Project {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let mut project = Project { folder, client: Client::start() };
        for (name, text) in files.iter().filter(|(name, _)| *name != "rungwise.toml").take(opened) {
            let language = if name.ends_with(".lad") { "ladder" } else { "plc-il" };
            let uri = project.uri(name);
            project.client.open(&uri, language, text);
            project.client.diagnostics(&uri, 1);
        }
        project
    }

    fn uri(&self, name: &str) -> String {
        let path: PathBuf = self.folder.path().canonicalize().unwrap().join(name);
        format!("file://{}", path.display())
    }

    /// The node at the `nth` occurrence (from 0) of `words` in `text`, which is the file `name`.
    fn node(&mut self, (name, text): (&str, &str), words: &str, nth: usize) -> Value {
        let offset = text.match_indices(words).nth(nth).unwrap_or_else(|| panic!("{words} {nth}")).0;
        let line = text[..offset].matches('\n').count() as u32;
        let column = text[..offset].chars().rev().take_while(|c| *c != '\n').count() as u32;
        let params = at(&self.uri(name), line, column);
        let answer = self.client.request("textDocument/prepareCallHierarchy", params);
        let [node] = answer["result"].as_array().unwrap_or_else(|| panic!("{answer}")).as_slice() else {
            panic!("{answer}")
        };
        node.clone()
    }

    /// `name file lines`, the lines of the calls from 1.
    fn calls(&mut self, node: &Value, direction: &str, end: &str) -> Vec<String> {
        let answer = self.client.request(&format!("callHierarchy/{direction}Calls"), json!({"item": node}));
        let calls = answer["result"].as_array().unwrap_or_else(|| panic!("{answer}")).iter();
        let calls = calls.map(|call| {
            let lines = call["fromRanges"].as_array().unwrap().iter();
            let lines: Vec<String> =
                lines.map(|range| (range["start"]["line"].as_u64().unwrap() + 1).to_string()).collect();
            let uri = call[end]["uri"].as_str().unwrap();
            let file = uri.rsplit('/').next().unwrap();
            format!("{} {file} {}", call[end]["name"].as_str().unwrap(), lines.join(","))
        });
        calls.collect()
    }

    fn incoming(&mut self, node: &Value) -> Vec<String> {
        self.calls(node, "incoming", "from")
    }

    fn outgoing(&mut self, node: &Value) -> Vec<String> {
        self.calls(node, "outgoing", "to")
    }
}

const FX_MANIFEST: (&str, &str) =
    ("rungwise.toml", "target = \"fx3u\"\nfiles = [\"main.il\", \"subs.il\"]\n");
const FX_MAIN: (&str, &str) = (
    "main.il",
    "LD X0\nCJ P0\nLD X1\nCALL P1\nLD X2\nCALLP P2\nLD X3\nCJP P0\nP0\nLD X4\nCALL P1\nLD X5\nCJ P63\nFEND\n",
);
const FX_SUBS: (&str, &str) = (
    "subs.il",
    "P1\nLD X6\nCALL P2\nSRET\nP2\nLD X7\nCJ P3\nLD X10\nOUT Y0\nP3\nSRET\nI001\nLD X11\nCALL P2\nIRET\nEND\n",
);

#[test]
fn pointers_of_the_fx_family_are_called_and_jumped_to_across_files() {
    let mut project = Project::new(&[FX_MANIFEST, FX_MAIN, FX_SUBS], 1);
    let main = project.node(FX_MAIN, "LD X0", 0);
    assert_eq!(main["name"], "main.il");
    assert_eq!(project.outgoing(&main), ["P0 main.il 2,8", "P1 subs.il 4,11", "P2 subs.il 6"]);
    assert_eq!(project.incoming(&main), [""; 0]);
    // The routine is in another file, which is not open.
    let p1 = project.node(FX_MAIN, "P1", 0);
    assert!(p1["uri"].as_str().unwrap().ends_with("/subs.il"), "{p1}");
    assert_eq!(project.incoming(&p1), ["main.il main.il 4,11"]);
    assert_eq!(project.outgoing(&p1), ["P2 subs.il 3"]);
    let p2 = project.node(FX_MAIN, "P2", 0);
    assert_eq!(project.incoming(&p2), ["main.il main.il 6", "P1 subs.il 3", "I001 subs.il 14"]);
    assert_eq!(project.outgoing(&p2), ["P3 subs.il 7"]);
    // A label is where a jump goes; what follows it calls on.
    let p0 = project.node(FX_MAIN, "P0\nLD", 0);
    assert_eq!(p0["name"], "P0");
    assert_eq!(project.incoming(&p0), ["main.il main.il 2,8"]);
    assert_eq!(project.outgoing(&p0), ["P1 subs.il 11"]);
}

const LADDER: (&str, &str) = (
    "main.lad",
    "\
|   X0                              |
+---| |--------------------[CJ P0]--+

|   X1                              |
+---| |------------------[CALL P1]--+

P0:
|   X2                          Y0  |
+---| |-------------------------( )-+

+---[FEND]--------------------------+

P1:
|   X3                          Y1  |
+---| |-------------------------( )-+

+---[SRET]--------------------------+

+---[END]---------------------------+
",
);

#[test]
fn jumps_and_calls_in_drawings() {
    let mut project = Project::new(&[LADDER], 1);
    let main = project.node(LADDER, "X0", 0);
    assert_eq!(main["name"], "main.lad");
    assert_eq!(project.outgoing(&main), ["P0 main.lad 2", "P1 main.lad 5"]);
    for (words, nth, line) in [("P0", 0, 2), ("P0", 1, 2), ("P1", 0, 5), ("P1", 1, 5)] {
        let label = project.node(LADDER, words, nth);
        assert_eq!(label["name"], words);
        assert_eq!(project.incoming(&label), [format!("main.lad main.lad {line}")], "{words}");
    }
}

const JUMPS: (&str, &str) = (
    "jumps.il",
    "\
PROGRAM One
VAR
    a : BOOL;
    b : BOOL;
END_VAR
    LD a
    JMPC Done
    LD b
    ST a
    JMP Done
Done:
    LD a
    ST b
END_PROGRAM
PROGRAM Two
VAR
    a : BOOL;
END_VAR
Again:
    LD a
    JMPCN done
    JMPC Again
Done:
    RET
END_PROGRAM
",
);

#[test]
fn labels_belong_to_their_program_organisation_unit() {
    let mut project = Project::new(&[JUMPS], 1);
    let first = project.node(JUMPS, "Done", 0);
    assert_eq!((&first["name"], &first["detail"]), (&json!("Done"), &json!("One")));
    assert_eq!(project.incoming(&first), ["One jumps.il 7,10"]);
    assert_eq!(project.outgoing(&first), [""; 0]);
    // Names are the same in any letter case.
    let second = project.node(JUMPS, "done", 0);
    assert_eq!((&second["name"], &second["detail"]), (&json!("Done"), &json!("Two")));
    assert_eq!(project.incoming(&second), ["Two jumps.il 21"]);
    let again = project.node(JUMPS, "Again", 0);
    assert_eq!(project.incoming(&again), ["Two jumps.il 22"]);
    assert_eq!(project.outgoing(&again), ["Done jumps.il 21", "Again jumps.il 22"]);
    let one = project.node(JUMPS, "One", 0);
    assert_eq!(project.outgoing(&one), ["Done jumps.il 7,10"]);
    assert_eq!(project.incoming(&one), [""; 0]);
}

const IEC_MANIFEST: (&str, &str) = ("rungwise.toml", "target = \"iec\"\n");
const BLOCKS: (&str, &str) = (
    "blocks.il",
    "\
FUNCTION_BLOCK Pump
VAR_INPUT
    Go : BOOL;
END_VAR
VAR_OUTPUT
    Run : BOOL;
END_VAR
VAR
    Delay : TON;
END_VAR
    CAL Delay(IN := Go, PT := T#1s)
    LD Delay.Q
    ST Run
END_FUNCTION_BLOCK
FUNCTION Twice : INT
VAR_INPUT
    Value : INT;
END_VAR
    LD Value
    ADD Value
    ST Twice
END_FUNCTION
FUNCTION Fourfold : INT
VAR_INPUT
    Value : INT;
END_VAR
    LD Value
    Twice
    Twice
    ST Fourfold
END_FUNCTION
",
);
const PLANT: (&str, &str) = (
    "plant.il",
    "\
PROGRAM Plant
VAR
    Left : Pump;
    Right : Pump;
    Sum : INT;
    Start : BOOL;
END_VAR
    CAL Left(Go := Start)
    LD Start
    CALC Right
    LD Sum
    Fourfold
    ST Sum
    Twice(Value := Sum)
    ST Sum
END_PROGRAM
",
);

#[test]
fn function_blocks_and_functions_are_called_across_files() {
    let mut project = Project::new(&[IEC_MANIFEST, PLANT, BLOCKS], 1);
    let plant = project.node(PLANT, "Plant", 0);
    assert_eq!((&plant["name"], &plant["detail"]), (&json!("Plant"), &json!("PROGRAM")));
    assert_eq!(
        project.outgoing(&plant),
        ["Pump blocks.il 8,10", "Fourfold blocks.il 12", "Twice blocks.il 14"]
    );
    // At a type, an instance that is declared, and one that is called.
    for (words, nth) in [("Pump", 0), ("Left", 0), ("Right", 1)] {
        let pump = project.node(PLANT, words, nth);
        assert_eq!((&pump["name"], &pump["detail"]), (&json!("Pump"), &json!("FUNCTION_BLOCK")), "{words}");
        assert_eq!(project.incoming(&pump), ["Plant plant.il 8,10"], "{words}");
        // The blocks of the standard have no body to go to.
        assert_eq!(project.outgoing(&pump), [""; 0]);
    }
    let twice = project.node(PLANT, "Twice", 0);
    assert!(twice["uri"].as_str().unwrap().ends_with("/blocks.il"), "{twice}");
    let mut callers = project.incoming(&twice);
    callers.sort();
    assert_eq!(callers, ["Fourfold blocks.il 28,29", "Plant plant.il 14"]);
    let fourfold = project.node(PLANT, "Fourfold", 0);
    assert_eq!(project.outgoing(&fourfold), ["Twice blocks.il 28,29"]);
}

#[test]
fn a_routine_that_calls_itself_is_its_own_caller() {
    let text = "LD X0\nCALL P1\nFEND\nP1\nLD X1\nCALL P1\nSRET\nEND\n";
    let file = ("self.il", text);
    let mut project = Project::new(&[file], 1);
    let routine = project.node(file, "P1", 1);
    assert_eq!(project.incoming(&routine), ["self.il self.il 2", "P1 self.il 6"]);
    assert_eq!(project.outgoing(&routine), ["P1 self.il 6"]);
}

const DRAWN: (&str, &str) = (
    "plant.lad",
    "\
PROGRAM Plant
VAR
    Left : Pump;
    Start : BOOL;
    Sum : INT;
END_VAR

|  Start                              |
+---| |------------------------>>Done |

|            Left                     |
|          +------+                   |
|  Start   | Pump |           Lamp    |
+---| |----|Go Run|------------( )----+
|          +------+                   |

Done:
|  Start                      Lamp    |
+---|/|------------------------(R)----+
END_PROGRAM
",
);

#[test]
fn drawn_blocks_and_labels_are_called() {
    let mut project = Project::new(&[IEC_MANIFEST, DRAWN, BLOCKS], 1);
    let plant = project.node(DRAWN, "Plant", 0);
    let mut called = project.outgoing(&plant);
    called.sort();
    assert_eq!(called.len(), 2, "{called:?}");
    assert!(called[0].starts_with("Done plant.lad 9"), "{called:?}");
    assert!(called[1].starts_with("Pump blocks.il 1"), "{called:?}");
    let done = project.node(DRAWN, "Done", 1);
    assert_eq!(project.incoming(&done), ["Plant plant.lad 9"]);
    let pump = project.node(DRAWN, "Pump", 1);
    assert!(pump["uri"].as_str().unwrap().ends_with("/blocks.il"), "{pump}");
    assert_eq!(project.incoming(&pump).len(), 1);
}

#[test]
fn instances_that_all_files_share_are_called() {
    let globals = ("globals.il", "VAR_GLOBAL\n    Shared : Pump;\nEND_VAR\n");
    let main =
        ("main.il", "PROGRAM Main\nVAR_EXTERNAL\n    Shared : Pump;\nEND_VAR\n    CAL Shared\nEND_PROGRAM\n");
    let mut project = Project::new(&[IEC_MANIFEST, main, globals, BLOCKS], 1);
    let node = project.node(main, "Main", 0);
    assert_eq!(project.outgoing(&node), ["Pump blocks.il 5"]);
    let pump = project.node(main, "Shared", 1);
    assert_eq!(project.incoming(&pump), ["Main main.il 5"]);
}
