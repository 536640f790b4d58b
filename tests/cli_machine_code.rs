//! `rungwise encode` and `rungwise decode`, through the binary.

use crate::binary::{folder, run};
use rungwise::machine_code::{Image, encode};
use rungwise::target::{Model, Target};
use serde_json::{Value, json};

const MOTOR: &str = "LD X0 ; start\nOR Y0\nANI X1\nOUT Y0\nLD Y0\nOUT T0 K50\nEND\n";
const WORDS: &str = "2400\n6500\n5401\nC500\n2500\n0600 8032 8000\n000F\n";
const CANONICAL: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nLD Y0\nOUT T0 K50\nEND\n";

#[test]
fn a_list_becomes_words_and_comes_back() {
    let folder = folder(&[("motor.il", MOTOR)]);
    assert_eq!(run(&folder, &["encode", "motor.il"]), (0, WORDS.into(), String::new()));
    assert_eq!(run(&folder, &["encode", "motor.il", "-o", "motor.hex"]).0, 0);
    assert_eq!(run(&folder, &["decode", "motor.hex"]), (0, CANONICAL.into(), String::new()));
    let (code, out, _) = run(&folder, &["encode", "motor.il", "--format", "json", "--target", "fx1s"]);
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, &answer["model"], &answer["steps"]), (0, &json!("fx1s"), &json!(9)));
    let words = encode(MOTOR, Target::of(Model::Fx2n)).unwrap().words;
    assert_eq!(answer["words"], json!(words));
    let map = answer["map"].as_array().unwrap();
    assert_eq!(map.len(), 7);
    assert_eq!(map[0], json!({"line": 1, "step": 0, "words": ["2400"], "text": "LD X0"}));
    assert_eq!(
        map[5],
        json!({"line": 6, "step": 5, "words": ["0600", "8032", "8000"], "text": "OUT T0 K50"})
    );
    std::fs::write(folder.path().join("motor.json"), out).unwrap();
    assert_eq!(run(&folder, &["decode", "motor.json", "-o", "back.il"]).0, 0);
    assert_eq!(std::fs::read_to_string(folder.path().join("back.il")).unwrap(), CANONICAL);
    assert_eq!(run(&folder, &["encode", "back.il"]).1, WORDS);
}

#[test]
fn memory_is_read_in_bytes() {
    let folder = folder(&[]);
    let words = encode(MOTOR, Target::of(Model::Fx2n)).unwrap().words;
    let bytes = |words: &[u16]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let old = [words.as_slice(), &[0x2407, 0xFFFF, 0xFFFF]].concat();
    let image = Image::of(&old, Model::Fx2n).unwrap();
    for (name, content, expected) in [
        ("memory.bin", bytes(&old), format!("{CANONICAL}LD X7\n")),
        ("image.bin", image.to_bytes(), CANONICAL.to_string()),
        ("blank.bin", vec![0xFF; 16_000], String::new()),
    ] {
        std::fs::write(folder.path().join(name), content).unwrap();
        assert_eq!(run(&folder, &["decode", name]), (0, expected, String::new()), "{name}");
    }
}

#[test]
fn words_that_are_no_instructions_go_through() {
    let folder = folder(&[("odd.hex", "2400 01ff\n01CA 2400 C500 000F\n")]);
    let (code, list, err) = run(&folder, &["decode", "odd.hex"]);
    assert_eq!((code, list.as_str()), (0, "LD X0\nNOP? H01FF\nNOP? H01CA\nLD X0\nOUT Y0\nEND\n"));
    assert_eq!(err, "odd.hex: words that are no known instructions of FX2N, in the lines `NOP?`: 2\n");
    std::fs::write(folder.path().join("odd.il"), &list).unwrap();
    assert_eq!(run(&folder, &["encode", "odd.il"]).1, "2400\n01FF\n01CA\n2400\nC500\n000F\n");
    assert_eq!(run(&folder, &["fmt", "--check", "odd.il"]).0, 0);
    let (_, out, _) = run(&folder, &["check", "odd.il", "--format", "json"]);
    let file = serde_json::from_str::<Value>(&out).unwrap()["files"][0].clone();
    assert_eq!(file["steps"], json!(6));
    let codes: Vec<&str> =
        file["diagnostics"].as_array().unwrap().iter().map(|found| found["code"].as_str().unwrap()).collect();
    assert_eq!(codes.iter().filter(|code| **code == "unread-word").count(), 2, "{codes:?}");
    let (code, _, err) = run(&folder, &["run", "odd.il"]);
    assert_eq!((code, err.contains("does not know what NOP? does")), (1, true), "{err}");
    // It may be a contact, a coil or anything else, so the rung around it is neither translated nor proved.
    std::fs::write(folder.path().join("one.il"), "LD X0\nNOP? H01FF\nOUT Y0\nEND\n").unwrap();
    std::fs::write(folder.path().join("none.il"), "LD X0\nOUT Y0\nEND\n").unwrap();
    let (_, out, err) = run(&folder, &["translate", "one.il", "--to", "ladder"]);
    assert!(err.contains("one.il:1: this rung is kept as it is") && out.contains("NOP? H01FF"), "{out}{err}");
    assert_eq!(run(&folder, &["prove", "one.il", "none.il"]).0, 1);
    let drawing = "|  X0                    |\n+--| |---[NOP? H01FF]----+\n";
    std::fs::write(folder.path().join("box.lad"), drawing).unwrap();
    let (code, _, err) = run(&folder, &["run", "box.lad"]);
    assert_eq!((code, err.contains("does not know what NOP? does")), (1, true), "{err}");
    let (_, out, _) = run(&folder, &["check", "box.lad"]);
    assert!(out.contains("warning[unread-word]"), "{out}");
    assert!(run(&folder, &["explain", "NOP?"]).1.contains("is no instruction of the model"));
}

#[test]
fn drawings_and_other_lists_are_translated_first() {
    let iec = "PROGRAM Main\nVAR\n    Start AT %IX0.0 : BOOL;\n    Motor AT %QX0.0 : BOOL;\nEND_VAR\n\n    LD Start\n    ST Motor\nEND_PROGRAM\n";
    let folder = folder(&[("motor.il", MOTOR), ("start.il", iec), ("motor.bool", "Y0 = X0*[X1]\nEND\n")]);
    run(&folder, &["translate", "motor.il", "--to", "ladder", "-o", "motor.lad"]);
    let (code, out, err) = run(&folder, &["encode", "motor.lad", "--format", "json"]);
    assert_eq!((code, err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(answer["words"], json!(encode(MOTOR, Target::of(Model::Fx2n)).unwrap().words));
    let drawing = std::fs::read_to_string(folder.path().join("motor.lad")).unwrap();
    let line = |map: usize| answer["map"][map]["line"].as_u64().unwrap() as usize;
    let text_at = |line: usize| drawing.lines().nth(line - 1).unwrap();
    assert!(text_at(line(0)).contains("X0"), "{drawing}{out}");
    assert!(text_at(line(5)).contains("T0"), "{drawing}{out}");
    assert_eq!(run(&folder, &["encode", "start.il"]), (0, "2400\nC500\n000F\n".into(), String::new()));
    assert_eq!(run(&folder, &["encode", "motor.bool"]).1, "2400\n5401\nC500\n000F\n");
}

#[test]
fn what_cannot_be_encoded_is_shown_at_its_place() {
    let bridge = crate::drawing_redrawn::BRIDGES[0];
    let folder = folder(&[("v.il", "LD X0\nMOV D0V1 D5\nFOO\nEND\n"), ("bridge.lad", bridge)]);
    let (code, out, err) = run(&folder, &["encode", "v.il"]);
    assert_eq!((code, out.as_str()), (1, ""));
    let shown =
        "v.il:2:5: error[no-machine-code]: it is not known how an index register V is coded: D0V1; use Z\n";
    assert!(err.starts_with(shown) && err.contains("v.il:3:1: error[no-machine-code]: `FOO`"), "{err}");
    let (_, _, err) = run(&folder, &["encode", "v.il", "--lang", "zh-CN"]);
    assert!(err.contains("不清楚变址寄存器 V 如何编码"), "{err}");
    let (code, _, err) = run(&folder, &["encode", "bridge.lad"]);
    assert_eq!((code, err.contains("this rung has no instruction list: ")), (1, true), "{err}");
    let (code, _, err) = run(&folder, &["encode", "v.il", "--target", "iec"]);
    assert_eq!((code, err.contains("error[target-refused]: iec")), (2, true), "{err}");
    assert_eq!(run(&folder, &["encode", "none.il"]).0, 2);
}

#[test]
fn the_files_of_a_program_are_one() {
    let manifest = "target = \"fx1s\"\nfiles = [\"a.il\", \"b.lad\", \"c.il\"]\n";
    let drawing = "|  X1        Y1 |\n+--| |-------( )--+\n".replace("Y1 |", "Y1   |");
    let folder = folder(&[
        ("rungwise.toml", manifest),
        ("a.il", "LD X0\nOUT Y0\n"),
        ("b.lad", &drawing),
        ("c.il", "LD X2\nOUT Y2\nEND\n"),
    ]);
    let (code, out, err) = run(&folder, &["encode", "b.lad"]);
    assert_eq!((code, out.as_str()), (0, "2400\nC500\n2401\nC501\n2402\nC502\n000F\n"), "{err}");
    let (_, out, _) = run(&folder, &["encode", "a.il", "--format", "json"]);
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&answer["model"], &answer["steps"]), (&json!("fx1s"), &json!(7)));
    let place = |map: usize| (answer["map"][map]["step"].clone(), answer["map"][map]["path"].clone());
    assert_eq!(place(0), (json!(0), json!("a.il")));
    assert_eq!(place(3), (json!(3), json!("b.lad")));
    assert_eq!(place(6), (json!(6), json!("c.il")));
    assert_eq!(answer["map"][5]["line"], json!(2));
    let long = "LD X0\nOUT T0 K5\n".repeat(300);
    std::fs::write(folder.path().join("a.il"), &long).unwrap();
    std::fs::write(folder.path().join("c.il"), format!("{long}END\n")).unwrap();
    let (code, _, err) = run(&folder, &["encode", "a.il"]);
    assert_eq!(
        (code, err.contains("2403 steps do not fit into FX1S, which has room for 2000")),
        (1, true),
        "{err}"
    );
}

#[test]
fn what_are_no_words_is_refused() {
    let folder = folder(&[
        ("digits.hex", "2400 C5\n"),
        ("word.json", "{\"words\": [70000]}"),
        ("list.il", "LD X0\n"),
        ("odd.bin", "\u{1}\u{2}\u{3}"),
        ("some.hex", "2400"),
    ]);
    for (name, reason) in [
        ("digits.hex", "four hexadecimal digits"),
        ("word.json", "no JSON document with a list `words`"),
        ("list.il", "four hexadecimal digits"),
        ("odd.bin", "an odd number of bytes"),
        ("none.hex", "none.hex"),
    ] {
        let (code, out, err) = run(&folder, &["decode", name]);
        assert_eq!((code, out.as_str()), (2, ""), "{name}");
        assert!(err.starts_with("error[unreadable-input]: ") && err.contains(reason), "{name}: {err}");
    }
    let (code, _, err) = run(&folder, &["decode", "some.hex", "--target", "iec"]);
    assert_eq!((code, err.contains("error[target-refused]")), (2, true), "{err}");
}
