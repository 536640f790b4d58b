//! Values of IEC 61131-3 programs as people write them and see them: on the command line, in scenario tests, in the
//! debugger and over the language server's protocol.

use super::binary::{folder, run};
use super::dap_client::Debugger;
use super::lsp_simulation::Simulated;
use serde_json::{Value, json};

const COLOURS: &str = "TYPE\nCol : (Re, Gr, Off, H1);\nOther : (Xa, Xb);\nEND_TYPE\n\
    PROGRAM Main\nVAR\nc : Col;\nd : Col := H1;\nn : INT;\nr : REAL;\nEND_VAR\n\
    LD c\nEQ Gr\nJMPCN no\nLD Col#Re\nST d\nno:\nLD n\nADD 1\nST n\nEND_PROGRAM\n";

/// The values of the last scan of a run with these settings.
fn ran(program: &str, settings: &[&str]) -> Result<Value, String> {
    let folder = folder(&[("main.il", program)]);
    let mut arguments = vec!["run", "main.il", "--scans", "1", "--format", "json"];
    settings.iter().for_each(|setting| arguments.extend(["--set", *setting]));
    let (code, out, err) = run(&folder, &arguments);
    if code != 0 && out.is_empty() {
        return Err(err);
    }
    let answer: Value = serde_json::from_str(&out).expect("JSON");
    Ok(answer["scans"].as_array().and_then(|scans| scans.last()).expect("a scan")["values"].clone())
}

#[test]
fn values_of_enumerations_are_written_with_their_type_and_without() {
    for (word, shown) in [
        ("Gr", "Gr"),
        ("col#gr", "Gr"),
        ("off", "Off"),
        ("H1", "H1"),
        ("Col#H1", "H1"),
        ("1", "Gr"),
        ("'Re'", "Re"),
    ] {
        let values = ran(COLOURS, &[&format!("c={word}")]).unwrap_or_else(|said| panic!("{word}: {said}"));
        let d = if shown == "Gr" { "Re" } else { "H1" };
        assert_eq!((&values["c"], &values["d"]), (&json!(shown), &json!(d)), "{word}");
    }
    for word in ["Xa", "Other#Gr", "Col#Xa", "7", "K2x"] {
        let said = ran(COLOURS, &[&format!("c={word}")]).expect_err(word);
        assert!(said.contains("`c` cannot be set to this value"), "{word}: {said}");
    }
    // What is a name for one variable is a number for another.
    assert_eq!(ran(COLOURS, &["n=H1F"]).unwrap()["n"], json!(32));
    assert!(ran(COLOURS, &["n=Gr"]).is_err());
}

#[test]
fn scenarios_expect_values_of_enumerations() {
    let tested = |step: &str| {
        let suite = format!("[[scenario]]\nname = \"one\"\nsteps = [\n{step}\n]\n");
        run(&folder(&[("main.il", COLOURS), ("main.test.toml", &suite)]), &["test"])
    };
    for expected in ["Re", "Col#Re", "'Re'"] {
        let step = format!("{{ at = \"20ms\", set = {{ c = \"Gr\" }}, expect = {{ d = \"{expected}\" }} }},");
        assert_eq!(tested(&step).0, 0, "{expected}: {}", tested(&step).1);
    }
    let (code, out, _) =
        tested("{ at = 0, force = { c = \"Col#Off\" }, expect = { c = \"off\", d = \"Gr\" } },");
    assert!(code == 1 && out.contains("d is H1 where Gr was expected, in scan 0"), "{out}");
    let (code, _, err) = tested("{ at = 0, expect = { c = \"Blue\" } },");
    assert!(code == 2 && err.contains("`c` never has this value"), "{code} {err}");
}

#[test]
fn golden_traces_keep_values_of_enumerations_and_reals() {
    let program = COLOURS.replace("ADD 1\n", "ADD 1\nST n\nLD 0.1\nST r\nLD n\n");
    let suite = "[[scenario]]\nname = \"one\"\ntime = \"20ms\"\ngolden = \"one.csv\"\nwatch = [\"c\", \"d\", \"r\"]\n\
        steps = [{ at = \"10ms\", set = { c = \"Gr\" } }]\n";
    let folder = folder(&[("main.il", &program), ("main.test.toml", suite)]);
    assert_eq!(run(&folder, &["test", "--update"]).0, 0);
    let golden = std::fs::read_to_string(folder.path().join("one.csv")).expect("the trace");
    assert_eq!(
        golden.lines().collect::<Vec<_>>()[1..],
        ["0,0,Re,H1,0.1", "1,10,Gr,Re,0.1", "2,20,Gr,Re,0.1"]
    );
    let (code, out, err) = run(&folder, &["test"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
}

#[test]
fn the_debugger_knows_values_by_their_names() {
    let program = folder(&[("main.il", COLOURS)]);
    let path = program.path().canonicalize().unwrap().join("main.il");
    let mut plc = Debugger::launch(&path, json!({ "set": { "r": 0.5 } }));
    plc.begin();
    assert_eq!(plc.console("set c=Gr"), "Gr");
    plc.breakpoints(&path, json!([{ "line": 16, "condition": "c = Gr and d <> Col#H1 and r > 0.25" }]));
    plc.go("continue");
    assert_eq!(plc.here(), "Main · ST d @16:1, scan 1, 10 ms");
    assert_eq!(
        (plc.value("c"), plc.value("c = col#re"), plc.value("r * 2")),
        ("Gr".into(), "0".into(), "1.0".into())
    );
    assert!(plc.refusal("evaluate", json!({ "expression": "c = Blue" })).contains("Blue"));
    assert!(plc.refusal("evaluate", json!({ "expression": "Gr" })).contains("Gr"));
    assert_eq!(plc.console("force d=Col#Off"), "Re (Off from the next scan on)");
}

#[test]
fn editors_set_and_force_values_of_enumerations() {
    let mut plc = Simulated::open("file:///values/main.il", "iec-il", COLOURS);
    plc.tell("start", json!({ "paused": true }));
    plc.tell("set", json!({ "name": "c", "value": "Gr" }));
    plc.tell("force", json!({ "name": "d", "value": "Col#Off" }));
    plc.tell("step", json!({}));
    assert_eq!(plc.values(&["c", "d"]), [json!("Gr"), json!("Off")]);
}

#[test]
fn what_is_infinite_is_told_as_text_and_reals_have_the_digits_of_their_type() {
    let program = "PROGRAM Main\nVAR\na, b, c : REAL;\nl : LREAL;\ns, t : STRING;\nf : REAL;\nEND_VAR\n\
        LD 1.0E30\nMUL 1.0E30\nST a\nLD 0.0\nSUB a\nST b\nLD a\nADD b\nST c\nLD 0.1\nST f\nREAL_TO_STRING\nST s\n\
        LD f\nREAL_TO_LREAL\nST l\nLD 1.0E20\nREAL_TO_STRING\nST t\nEND_PROGRAM\n";
    let values = ran(program, &[]).unwrap();
    assert_eq!(
        (&values["a"], &values["b"], &values["c"]),
        (&json!("Infinity"), &json!("-Infinity"), &json!("NaN"))
    );
    assert_eq!((&values["f"], &values["s"], &values["t"]), (&json!(0.1), &json!("0.1"), &json!("1.0e20")));
    assert_eq!(values["l"], json!(f64::from(0.1_f32)));
    // They can be set, and what stays no number is no change.
    let folder = folder(&[("main.il", &program.replace("ST a\nLD 0.0", "LD 0.0"))]);
    let (_, out, _) = run(
        &folder,
        &["run", "main.il", "--set", "a=-Infinity", "--set", "f=NaN", "--watch", "a,c", "--format", "json"],
    );
    let answer: Value = serde_json::from_str(&out).unwrap();
    let rows: Vec<Value> =
        answer["scans"].as_array().unwrap().iter().map(|row| row["values"].clone()).collect();
    assert_eq!(rows, vec![json!({ "a": "-Infinity", "c": "NaN" }); 2]);
}

/// What a picture shows beside operands: lines from 1, words, values.
fn shown(picture: &Value, text: &str) -> Vec<String> {
    let elements =
        picture["elements"].as_array().unwrap().iter().filter(|element| element["kind"] == "value");
    let mut all: Vec<(u64, u64, String)> = elements
        .map(|element| {
            let (start, end) = (&element["range"]["start"], &element["range"]["end"]);
            let (line, from) = (start["line"].as_u64().unwrap(), start["character"].as_u64().unwrap());
            let to = end["character"].as_u64().unwrap();
            let words = &text.lines().nth(line as usize).unwrap()[from as usize..to as usize];
            (line + 1, from, format!("{}: {words} = {}", line + 1, element["value"]))
        })
        .collect();
    all.sort();
    all.into_iter().map(|(_, _, shown)| shown).collect()
}

#[test]
fn values_stand_beside_the_words_of_the_unit_and_instance_that_they_are_of() {
    let text = "FUNCTION_BLOCK Once\nVAR_INPUT\nn : INT;\nEND_VAR\nVAR\nm : INT;\nt : TON;\nEND_VAR\n\
        LD n\nADD 1\nST m\nCAL t(IN := TRUE, PT := T#1s)\nLD t.ET\nEND_FUNCTION_BLOCK\n\
        FUNCTION_BLOCK Twice\nVAR_INPUT\nn : INT;\nEND_VAR\nVAR_IN_OUT\nall : INT;\nEND_VAR\nLD n\nADD all\nST all\n\
        LD limit\nST n\nEND_FUNCTION_BLOCK\n\
        PROGRAM Main\nVAR_EXTERNAL\nlimit : INT;\nEND_VAR\nVAR\nn : INT := 3;\ngo : BOOL;\nc : (Re, Gr) := Gr;\none : Once;\n\
        a, b : Twice;\ns : STRING := 'x';\nrow : ARRAY[0..2] OF INT := [4, 5, 6];\nEND_VAR\n\
        LD n\nST one.n\nLD go\nST go\nCAL one()\nCAL a(n := 1, all := n)\nCAL b(n := 10, all := n)\nLD c\nLD s\nLD row[1]\n\
        LD row[n]\nLD %IW4\nEND_PROGRAM\nCONFIGURATION C\nVAR_GLOBAL\nlimit : INT := 8;\nEND_VAR\nRESOURCE R ON Cpu\n\
        PROGRAM P : Main;\nEND_RESOURCE\nEND_CONFIGURATION\n";
    let text =
        text.replace("FUNCTION_BLOCK Twice\n", "FUNCTION_BLOCK Twice\nVAR_EXTERNAL\nlimit : INT;\nEND_VAR\n");
    let mut plc = Simulated::open("file:///values/words.il", "iec-il", &text);
    plc.tell("start", json!({ "paused": true }));
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 90, "character": 0 } });
    plc.tell("watch", json!({ "ranges": [range] }));
    plc.tell("step", json!({ "count": 2 }));
    let picture = plc.picture(|picture| picture["scan"] == json!(2));
    // What is another value in each instance is not shown, nor what a subscript names that only the PLC knows.
    let expected = [
        "9: n = 25",
        "11: m = 26",
        "12: t = \"T#20ms\"",
        "13: t.ET = \"T#20ms\"",
        "26: all = 36",
        "27: all = 36",
        "28: limit = 8",
        "44: n = 36",
        "45: one.n = 25",
        "49: n = 36",
        "50: n = 36",
        "51: c = \"Gr\"",
        "52: s = \"'x'\"",
        "53: row[1] = 5",
        "55: %IW4 = 0",
    ];
    let shown = shown(&picture, &text);
    assert_eq!(shown, expected);
}
