//! `rungwise translate` and `rungwise prove`, through the binary.

use crate::binary::{folder, run};
use crate::drawing_redrawn::BRIDGES;
use serde_json::{Value, json};

const MOTOR: &str = "; start\nLD X0\nOR Y0\nANI X1\nOUT Y0\nEND\n";
/// The same but for the stop contact.
const WRONG: &str = "LD X0\nOR Y0\nAND X1\nOUT Y0\nEND\n";
/// A contact in parallel with what already drives an output has no drawing.
const KEPT: &str = "LDI Y0\nOUT Y0\nOR X1\nOUT Y1\nEND\n";
#[test]
fn a_list_is_drawn_listed_and_written_as_equations_with_proof() {
    let folder = folder(&[("motor.il", MOTOR)]);
    let (code, drawn, err) = run(&folder, &["translate", "motor.il", "--to", "ladder", "--prove"]);
    assert_eq!((code, err.contains("2 rungs: 1 proved equal, 1 equal by construction")), (0, true), "{err}");
    assert!(drawn.contains("; start\n|   X0        X1 "), "{drawn}");
    let (code, out, _) = run(&folder, &["translate", "motor.il", "--to", "ladder", "-o", "motor.lad"]);
    assert_eq!((code, out.as_str()), (0, ""));
    assert_eq!(std::fs::read_to_string(folder.path().join("motor.lad")).unwrap(), drawn);
    assert_eq!(run(&folder, &["translate", "motor.lad", "--to", "fx"]), (0, MOTOR.into(), String::new()));
    let (code, equations, _) = run(&folder, &["translate", "motor.lad", "--to", "boolean"]);
    assert_eq!((code, equations.as_str()), (0, "; start\nY0 = (X0 + Y0)*[X1]\nEND\n"));
    let (_, symbols, _) = run(&folder, &["translate", "motor.lad", "--to", "boolean", "--symbols"]);
    assert!(symbols.contains("Y0 = (X0 ∨ Y0) ∧ ¬X1\n"), "{symbols}");
    std::fs::write(folder.path().join("motor.bool"), symbols).unwrap();
    assert_eq!(run(&folder, &["translate", "motor.bool", "--to", "fx"]).1, MOTOR);
}

#[test]
fn what_has_no_other_form_is_carried_along_and_told() {
    let folder = folder(&[("kept.il", KEPT), ("bridge.lad", BRIDGES[0])]);
    let (code, drawn, err) = run(&folder, &["translate", "kept.il", "--to", "ladder", "--prove"]);
    assert_eq!(code, 0, "{err}");
    assert!(err.starts_with("kept.il:1: this rung is kept as it is: a contact is put in parallel"), "{err}");
    assert!(drawn.contains("{il\nLDI Y0\nOUT Y0\nOR X1\nOUT Y1\n}\n"), "{drawn}");
    std::fs::write(folder.path().join("kept.lad"), drawn).unwrap();
    assert_eq!(run(&folder, &["translate", "kept.lad", "--to", "fx"]).1, KEPT);
    assert_eq!(run(&folder, &["prove", "kept.il", "kept.lad"]).0, 0);
    // A drawing in a list is but a comment, so that is no translation.
    let (code, out, err) = run(&folder, &["translate", "bridge.lad", "--to", "fx"]);
    assert_eq!((code, out.contains("; +---| |---+")), (1, true), "{out}");
    assert!(err.contains("neither series nor parallel"), "{err}");
    let (code, out, err) = run(&folder, &["translate", "bridge.lad", "--to", "fx", "--prove", "-o", "x.il"]);
    assert_eq!((code, out.as_str(), folder.path().join("x.il").exists()), (1, "", false));
    assert!(err.contains("nothing is written to x.il: not all of it is proved"), "{err}");
}

#[test]
fn a_proof_says_equal_or_which_scan_differs() {
    let folder = folder(&[("motor.il", MOTOR), ("wrong.il", WRONG)]);
    run(&folder, &["translate", "motor.il", "--to", "ladder", "-o", "motor.lad"]);
    let (code, out, err) = run(&folder, &["prove", "motor.il", "motor.lad", "--format", "json"]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(serde_json::from_str::<Value>(&out).unwrap(), json!({"equal": true, "reordered": false}));
    let arguments = ["prove", "motor.lad", "wrong.il", "--format", "json", "--scenario", "motor.test.toml"];
    let (code, out, _) = run(&folder, &arguments);
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, &answer["equal"]), (1, &json!(false)));
    let found = &answer["counterexample"];
    let inputs = &found["inputs"];
    let on = |name: &str| inputs[name].as_bool().unwrap_or(false);
    let seal = on("X0") || on("Y0");
    assert_eq!(found["left"]["Y0"], json!(seal && !on("X1")), "{out}");
    assert_eq!(found["right"]["Y0"], json!(seal && on("X1")), "{out}");
    assert_eq!(found["lines"], json!({"left": 2, "right": 1}));
    let scenario = std::fs::read_to_string(folder.path().join("motor.test.toml")).unwrap();
    let scenario: toml::Value = toml::from_str(&scenario).unwrap();
    assert_eq!(scenario["program"].as_str(), Some("motor.lad"));
    let expected = &scenario["scenario"][0]["steps"][0]["expect"]["Y0"];
    assert_eq!(expected.as_integer().map(|value| value == 1), found["left"]["Y0"].as_bool());
    assert_eq!(run(&folder, &["test"]).0, 0);
    let (code, out, _) = run(&folder, &["prove", "motor.il", "wrong.il", "--lang", "zh-CN"]);
    assert_eq!(code, 1);
    assert!(out.starts_with("不相等：Y0（motor.il:2, wrong.il:1）"), "{out}");
}

#[test]
fn what_the_simulated_plc_does_not_show_is_told_and_not_written() {
    let [one, two] = ["LD", "LDI"].map(|load| format!("{load} X0\nOUT Y0\nLD X1\nFOO D0\nEND\n"));
    let folder = folder(&[("one.il", &one), ("two.il", &two)]);
    let (code, out, err) = run(&folder, &["prove", "one.il", "two.il", "--scenario", "one.test.toml"]);
    assert_eq!((code, folder.path().join("one.test.toml").exists()), (1, false), "{out}");
    assert!(out.contains("Not shown on the simulated PLC: one.il does not run there"), "{out}");
    assert!(err.starts_with("one.test.toml: not written"), "{err}");
    let (_, out, _) = run(&folder, &["prove", "one.il", "two.il", "--format", "json"]);
    let answer: Value = serde_json::from_str(&out).unwrap();
    let found = &answer["counterexample"];
    assert!(found["run"].is_null() && found["reason"].as_str().unwrap().contains("one.il"), "{out}");
}

/// A timer takes its time, and an instruction is seen in what it writes.
#[test]
fn a_scenario_of_a_proof_passes_with_the_first_program_and_fails_with_the_second() {
    for (one, two) in [
        ("LD X0\nOUT T0 K20\nLD T0\nOUT Y0\n", "LD X0\nOUT T0 K20\nLD T0\nAND X1\nOUT Y0\n"),
        ("LDP X0\nMOV K5 D0\n", "LDF X0\nMOV K5 D0\n"),
        ("LD X0\nOUT C0 K2\nLD C0\nOUT Y0\n", "LD X0\nOUT C0 K2\nLD C0\nANI X0\nOUT Y0\n"),
    ] {
        let folder = folder(&[("one.il", one), ("two.il", two)]);
        let (_, out, _) = run(&folder, &["prove", "one.il", "two.il", "--scenario", "one.test.toml"]);
        let (code, tested, _) = run(&folder, &["test", "one.test.toml"]);
        assert_eq!(code, 0, "{out}\n{tested}");
        let path = folder.path().join("one.test.toml");
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace("program = \"one.il\"", "program = \"two.il\"")).unwrap();
        let (code, tested, _) = run(&folder, &["test", "one.test.toml"]);
        assert!(code == 1 && tested.contains("was expected"), "{out}\n{tested}");
    }
}

#[test]
fn a_proof_of_other_structures_is_not_decided() {
    let jumping = "LD X0\nCJ P0\nLD X1\nOUT Y0\nP0\nLD X2\nOUT Y1\nEND\n";
    let same = "LD X0\nCJ P0\nP1\nLD X1\nOUT Y0\nP0\nLD X2\nOUT Y1\nEND\n";
    let folder = folder(&[("one.il", jumping), ("two.il", same), ("motor.il", MOTOR)]);
    // Running both shows no difference, or one.
    assert_eq!(
        run(&folder, &["prove", "one.il", "motor.il"]).1.lines().next(),
        Some("different: Y1 (one.il:1)")
    );
    let (code, out, _) = run(&folder, &["prove", "one.il", "two.il", "--format", "json"]);
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, &answer["equal"]), (1, &Value::Null), "{out}");
    assert!(answer["reason"].as_str().unwrap().starts_with("jumps, labels"), "{out}");
    // Wrong usage is another matter than an answer.
    assert_eq!(run(&folder, &["prove", "one.il", "nowhere.il"]).0, 2);
    assert_eq!(run(&folder, &["translate", "one.il"]).0, 2);
}

#[test]
fn a_rung_that_would_be_drawn_larger_than_can_be_read_is_carried_along() {
    for (contact, count) in [("AND", 100_000), ("OR", 5_000)] {
        let long = format!("LD X0\n{}OUT Y0\n", format!("{contact} X1\n").repeat(count));
        let files = folder(&[("long.il", &format!("{long}LD X2\nOUT Y1\nEND\n"))]);
        let (code, out, err) = run(&files, &["translate", "long.il", "--to", "ladder", "-o", "long.lad"]);
        assert_eq!((code, out.as_str()), (0, ""), "{err}");
        assert!(err.contains("long.il:1") && err.contains("has no drawing for it"), "{err}");
        let drawn = std::fs::read_to_string(files.path().join("long.lad")).unwrap();
        assert!(drawn.contains(&long) && drawn.contains("+---| |---"), "{} bytes", drawn.len());
        assert_eq!(drawn.lines().map(str::len).max(), Some(48), "the other rung is as wide as ever");
        let (code, out, err) = run(&files, &["prove", "long.il", "long.lad"]);
        assert_eq!(code, 0, "{out}{err}");
    }
}

#[test]
fn a_project_in_several_files_is_proved_as_the_one_program_that_it_is() {
    let manifest = "target = \"fx2n\"\nfiles = [\"main.il\", \"called.lad\"]\n";
    let main = "LD X0\nCALL P1\nFEND\n";
    let called = "P1:\n|   X1       Y0 |\n+---| |-----( )-+\n\n+--[SRET]-------+\n\n+--[END]--------+\n";
    let files = folder(&[
        ("line/rungwise.toml", manifest),
        ("line/main.il", main),
        ("line/called.lad", called),
        ("same.il", &format!("{main}P1\nLD X1\nOUT Y0\nSRET\nEND\n")),
        ("other.il", &format!("{main}P1\nLDI X1\nOUT Y0\nSRET\nEND\n")),
    ]);
    let (code, out, err) = run(&files, &["prove", "line", "same.il"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    let (code, out, _) = run(&files, &["prove", "other.il", "line", "--scenario", "other.test.toml"]);
    assert!(code == 1 && out.starts_with("different: Y0"), "{out}");
    let (code, out, _) = run(&files, &["test", "other.test.toml"]);
    assert_eq!(code, 0, "{out}");
}

#[test]
fn a_folder_of_several_programs_is_taken_for_none() {
    let files = folder(&[("two/a.il", "LD X0\nOUT Y0\nEND\n"), ("two/b.il", "LD X1\nOUT Y1\nEND\n")]);
    let verbs = [
        vec!["encode", "two"],
        vec!["run", "two"],
        vec!["prove", "two/a.il", "two"],
        vec!["prove", "two", "two/b.il"],
        vec!["translate", "two", "--to", "ladder"],
        vec!["download", "two", "--yes", "--port", "tcp://127.0.0.1:1"],
    ];
    for verb in verbs {
        let (code, out, err) = run(&files, &verb);
        assert_eq!((code, out.as_str()), (2, ""), "{verb:?}\n{err}");
        assert!(err.starts_with("error[several-programs]: two: several programs"), "{verb:?}\n{err}");
    }
}

#[test]
fn symbols_of_a_project_stay_and_are_proved() {
    let manifest = "target = \"fx2n\"\ncomments = \"devices.csv\"\nfiles = [\"main.il\"]\n";
    let main = "LD Start\nAND> Level K10\nOUT Motor\nEND\n";
    let table = "X0;Start;\nY0;Motor;\nD5;Level;\n";
    let folder = folder(&[("rungwise.toml", manifest), ("devices.csv", table), ("main.il", main)]);
    let (code, drawn, err) = run(&folder, &["translate", "main.il", "--to", "ladder", "--prove"]);
    assert_eq!(code, 0, "{err}");
    assert!(drawn.contains("Start") && drawn.contains("[> Level K10]"), "{drawn}");
    assert_eq!(run(&folder, &["translate", "main.il", "--to", "boolean", "--prove"]).0, 0);
}

#[test]
fn a_list_for_another_model_says_what_that_lacks() {
    let head = "PROGRAM P\nVAR\nStart AT %IX0.0 : BOOL; Lamp AT %QX0.0 : BOOL;\nEND_VAR\nVAR RETAIN Far AT %MX500.0 : BOOL; END_VAR\n";
    let text = format!("{head}LD Start\nST Lamp\nLD Start\nST Far\nEND_PROGRAM\n");
    let folder = folder(&[("motor.il", MOTOR), ("other.il", &text)]);
    let (code, out, err) = run(&folder, &["translate", "other.il", "--to", "fx"]);
    assert_eq!((code, out.contains("; ST Far")), (1, true), "{out}");
    assert!(err.contains("FX2N has no M4000"), "{err}");
    let (code, out, err) =
        run(&folder, &["translate", "other.il", "--to", "fx", "--target", "fx3u", "--prove"]);
    assert_eq!((code, out.as_str()), (0, "LD X0\nOUT Y0\nLD X0\nOUT M4000\nEND\n"), "{err}");
    // The model of the project is the one to write for.
    std::fs::write(folder.path().join("rungwise.toml"), "target = \"fx3u\"\ndialect = \"iec\"\n").unwrap();
    assert_eq!(run(&folder, &["translate", "other.il", "--to", "fx"]).0, 0);
    let (code, _, err) = run(&folder, &["translate", "other.il", "--to", "fx", "--target", "fx1s"]);
    assert!(code == 1 && err.contains("FX1S has no M4000"), "{err}");
    // Which model lists are for can be said apart from that of the project, and on the command line.
    let manifest = "target = \"fx1n\"\ndialect = \"iec\"\n[translate]\ntarget = \"fx3u\"\n";
    std::fs::write(folder.path().join("rungwise.toml"), manifest).unwrap();
    assert_eq!(run(&folder, &["translate", "other.il", "--to", "fx"]).0, 0);
    let (code, _, err) = run(&folder, &["translate", "other.il", "--to", "fx", "--target", "fx1n"]);
    assert!(code == 1 && err.contains("FX1N has no M4000"), "{err}");
    let manifest = manifest.replace("fx1n", "iec");
    std::fs::write(folder.path().join("rungwise.toml"), manifest).unwrap();
    assert_eq!(run(&folder, &["translate", "other.il", "--to", "fx"]).0, 0);
    for arguments in [["ladder", "fx3u"], ["fx", "iec"]] {
        let (code, _, err) =
            run(&folder, &["translate", "other.il", "--to", arguments[0], "--target", arguments[1]]);
        assert_eq!((code, err.contains("no model for")), (2, true), "{err}");
    }
}

/// Behind an inverter at the left rail there is no power; beside it there is.
#[test]
fn an_inverter_at_the_left_rail_is_not_lost() {
    let drawings = [
        "|             X0         Y0 |\n+---[INV]-----| |-------( )-+\n",
        "|             X0         Y0 |\n+---[INV]-+---| |-------( )-+\n|         |   X1         Y1 |\n\
         |         +---| |-------( )-+\n",
        "|             X0         Y0 |\n+-+-[INV]-----| |-------( )-+\n| |           X1         Y1 |\n\
         | +-----------| |-------( )-+\n",
        "|             X0         Y0 |\n+---[INV]-----| |---+---( )-+\n|   X1              |       |\n\
         +---| |-------------+       |\n",
        "|                        Y0 |\n+---[INV]-----------+---( )-+\n|   X1              |    Y1 |\n\
         +---| |-------------+---( )-+\n",
        "|                        Y0 |\n+-+-[INV]---------------( )-+\n| |           X1         Y1 |\n\
         | +-----------| |-------( )-+\n",
        "|                   X0   Y0 |\n+---[INV]---[INV]---| |-( )-+\n",
    ];
    // What both outputs are for no input, X0, X1 and both.
    let expected = [
        "00 00 00 00",
        "00 00 00 00",
        "00 00 01 01",
        "00 00 10 10",
        "00 00 11 11",
        "00 00 01 01",
        "00 10 00 10",
    ];
    for (drawing, expected) in drawings.into_iter().zip(expected) {
        let folder = folder(&[("a.lad", drawing)]);
        for (to, file) in [("ladder", "b.lad"), ("fx", "b.il"), ("iec", "c.il"), ("boolean", "b.bool")] {
            let (code, _, err) = run(&folder, &["translate", "a.lad", "--to", to, "--prove", "-o", file]);
            assert_eq!(code, 0, "{drawing}{to}: {err}");
        }
        for file in ["a.lad", "b.lad", "b.il", "c.il"] {
            let shown = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|inputs| {
                let names = if drawing.contains("X1") { vec!["X0", "X1"] } else { vec!["X0"] };
                let set: Vec<String> = names
                    .iter()
                    .zip(inputs)
                    .filter(|(name, _)| drawing.contains(**name))
                    .flat_map(|(name, value)| ["--set".to_string(), format!("{name}={value}")])
                    .collect();
                let words = ["run", file, "--scans", "1", "--format", "json"];
                let words: Vec<&str> = words.into_iter().chain(set.iter().map(String::as_str)).collect();
                let (code, out, err) = run(&folder, &words);
                assert_eq!(code, 0, "{drawing}{file}: {err}");
                let values = serde_json::from_str::<Value>(&out).unwrap()["scans"][0]["values"].clone();
                ["Y0", "Y1"]
                    .map(|name| if values[name] == true { '1' } else { '0' })
                    .iter()
                    .collect::<String>()
            });
            assert_eq!(shown.join(" "), expected, "{drawing}{file}");
        }
    }
}

#[test]
fn a_list_in_a_box_is_the_list_that_it_was_and_edges_beside_it_are_the_same() {
    let head = "PROGRAM p\nVAR d, x : BOOL; j : INT; r : R_TRIG; END_VAR\n";
    let text = format!("{head}CAL r(CLK := d)\nLD r.Q\nR x\nLD j\nADD( j\nMUL 2\n)\nST j\nEND_PROGRAM\n");
    let folder = folder(&[("a.il", &text)]);
    let (code, _, err) = run(&folder, &["translate", "a.il", "--to", "ladder", "--prove", "-o", "a.lad"]);
    assert_eq!(code, 0, "{err}");
    let (code, out, _) = run(&folder, &["prove", "a.il", "a.lad"]);
    assert!(code == 0 && out.starts_with("equal: "), "{out}");
}

#[test]
fn jumps_of_iec_programs_are_proved_in_equations() {
    let head = "PROGRAM p\nVAR a, b, x, y : BOOL; END_VAR\n";
    let text =
        format!("{head}LDN a\nJMPC L1\nLD b\nST y\nL1:\nLDN b\nST x\nLD a\nRETC\nLD b\nST y\nEND_PROGRAM\n");
    let folder = folder(&[("a.il", &text)]);
    let (code, out, err) = run(&folder, &["translate", "a.il", "--to", "boolean", "--prove"]);
    assert_eq!((code, out.as_str()), (0, "JMP L1 = [a]\ny = b\nL1:\nx = [b]\nRET = a\ny = b\n"), "{err}");
}
