//! `rungwise test`, through the binary.

use crate::binary::{folder, run};
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

const MOTOR: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nOUT T0 K3\nLD T0\nOUT Y1\nEND\n";
const SUITE: &str = r#"
[[scenario]]
name = "seals in"
steps = [
  { at = "100ms", pulse = { X0 = "20ms" }, expect = { Y0 = 1 } },
  { at = "300ms", set = { X1 = 1 } },
  { after = "1 scan", expect = { Y0 = 0 } },
]
"#;

fn tested(program: &str, suite: &str) -> TempDir {
    folder(&[("motor.il", program), ("motor.test.toml", suite)])
}

/// What a file with one scenario of these steps gives with the motor: the exit code and both streams.
fn steps(steps: &str) -> (i32, String, String) {
    let suite = format!("[[scenario]]\nname = \"one\"\nsteps = [\n{steps}\n]\n");
    run(&tested(MOTOR, &suite), &["test"])
}

#[track_caller]
fn passes(text: &str) {
    let (code, out, err) = steps(text);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
}

#[track_caller]
fn fails(text: &str, said: &str) {
    let (code, out, err) = steps(text);
    assert_eq!((code, err.as_str()), (1, ""), "{out}");
    assert!(out.contains(said), "{out}");
}

#[test]
fn scenarios_pass_and_a_planted_fault_is_found_and_drawn() {
    let (code, out, err) = run(&tested(MOTOR, SUITE), &["test"]);
    assert_eq!(
        (code, out.as_str(), err.as_str()),
        (0, "motor.test.toml\n  ok     seals in\n\n1 passed, 0 failed\n", "")
    );
    let (code, out, _) = run(&tested(&MOTOR.replace("ANI X1", "AND X1"), SUITE), &["test", "motor.il"]);
    assert_eq!(code, 1);
    assert!(
        out.starts_with("motor.test.toml\n  FAILED seals in\n      motor.test.toml:5:55: Y0 is 0 where 1"),
        "{out}"
    );
    assert!(out.contains("\n      driven at motor.il:4:5\n"), "{out}");
    assert!(out.contains("\n        expected   ▆▆▆▆▆\n                   ^^^^^\n"), "{out}");
}

#[test]
fn times_are_those_of_scans() {
    passes("{ set = { X0 = 1 }, expect = { Y0 = 1 } }, { at = 35, expect = { T0 = 0 } }");
    // Set before the scan at 40 ms, which is the first at or after 35 ms.
    passes(
        "{ at = \"35ms\", set = { X0 = 1 } }, { at = \"30ms\", expect = { Y0 = 0 } }, { at = \"4 scans\", expect = { Y0 = 1 } }",
    );
    passes("{ at = \"T#50ms\", pulse = { X0 = 0 } }, { after = \"1 scan\", expect = { X0 = 0, Y0 = 1 } }");
    fails(
        "{ at = \"50ms\", set = { X0 = 1 } }, { at = \"40ms\", expect = { Y0 = 1 } }",
        "in scan 4 at 40 ms",
    );
}

#[test]
fn a_step_is_done_again_and_again() {
    let clocked = "LD X0\nOUT C0 K4\nLD C0\nOUT Y0\nEND\n";
    let tell = |steps: &str| {
        let suite = format!("[[scenario]]\nname = \"one\"\nsteps = [\n{steps}\n]\n");
        run(&tested(clocked, &suite), &["test"])
    };
    // The fourth pulse comes at 160 ms; `after` counts from it.
    let train = "{ at = 100, every = 20, times = 4, pulse = { X0 = 10 }, expect = { X0 = 1 } }";
    for (expected, code) in [
        ("{ at = 150, expect = { C0 = 3, Y0 = 0 } }, { at = 160, expect = { Y0 = 1 } }", 0),
        ("{ after = 0, expect = { C0 = 4 } }, { after = 10, expect = { X0 = 0 } }", 0),
        ("{ after = 0, expect = { C0 = 3 } }", 1),
    ] {
        let (found, out, err) = tell(&format!("{train},\n{expected}"));
        assert_eq!((found, err.as_str()), (code, ""), "{expected}\n{out}");
    }
    for (step, said) in [
        ("{ every = 20, set = { X0 = 1 } }", "`every` and `times` belong together"),
        ("{ times = 2, set = { X0 = 1 } }", "`every` and `times` belong together"),
        ("{ every = 5, times = 2, set = { X0 = 1 } }", "`every` is one scan at least"),
        ("{ every = 20, times = 0, set = { X0 = 1 } }", "a whole number from 1"),
        ("{ every = 20, times = 1.5, set = { X0 = 1 } }", "a whole number from 1"),
        ("{ every = 20, times = 2, pulse = { X0 = 20 } }", "the pulse lasts until the next one begins"),
        ("{ every = 20, times = 1000000, set = { X0 = 1 } }", "1000000 scans"),
    ] {
        let (code, out, err) = tell(step);
        assert!(code != 0 && format!("{out}{err}").contains(said), "{step}\n{code}\n{out}\n{err}");
    }
}

#[test]
fn expectations_hold_at_a_time_within_one_always_never_and_until() {
    let start = "{ at = \"100ms\", set = { X0 = 1 } },";
    passes(&format!("{start} {{ at = \"100ms\", expect = {{ Y1 = 1 }}, within = \"400ms\" }}"));
    fails(
        &format!("{start} {{ at = \"100ms\", expect = {{ Y1 = 1 }}, within = \"200ms\" }}"),
        "from scan 10 on, at the latest in scan 30",
    );
    passes(&format!("{start} {{ at = 0, always = {{ Y0 = 0 }}, for = \"100ms\" }}"));
    passes(&format!("{start} {{ at = 0, always = {{ Y0 = 0 }}, until = \"100ms\" }}"));
    fails(
        &format!("{start} {{ at = 0, always = {{ Y0 = 0 }}, for = \"110ms\" }}"),
        "Y0 is 1 where 0 was expected always, in scan 10",
    );
    fails(
        &format!(
            "{start} {{ at = 0, never = {{ Y0 = 1, X0 = 1 }} }}, {{ at = \"200ms\", expect = {{ Y0 = 1 }} }}"
        ),
        "never be is there in scan 10 at 100 ms: Y0 = 1, X0 = 1",
    );
    passes(&format!("{start} {{ at = 0, never = {{ Y0 = 1, X0 = 0 }} }}"));
    let suite = |values: &str| {
        format!(
            "[[scenario]]\nname = \"a\"\ntime = \"1s\"\nsteps = [{start} {{ at = 0, always = {{ Y1 = 0 }}, until = {{ {values} }} }}]\n"
        )
    };
    assert_eq!(run(&tested(MOTOR, &suite("TS0 = 1")), &["test"]).0, 0);
    let (code, out, _) = run(&tested(MOTOR, &suite("X7 = 1, TS0 = 1")), &["test"]);
    assert_eq!(code, 1);
    assert!(out.contains("Y1 is 1 where 0 was expected always"), "{out}");
    let waits = suite("X7 = 1").replace("Y1 = 0", "Y7 = 0");
    let (code, out, _) = run(&tested(MOTOR, &waits), &["test"]);
    assert!(code == 1 && out.contains("has not come by scan 100 at 1000 ms: X7 = 1"), "{out}");
}

#[test]
fn tolerances_are_in_scans_and_in_numbers() {
    let late = "{ at = \"110ms\", set = { X0 = 1 } }, { at = \"100ms\", expect = { Y0 = 1 }";
    fails(&format!("{late} }}"), "Y0 is 0");
    passes(&format!("{late}, tolerance = \"1 scan\" }}"));
    passes(
        "{ at = \"120ms\", set = { X0 = 1 } }, { at = 0, always = { Y0 = 0 }, until = \"150ms\", tolerance = \"3 scans\" }",
    );
    fails(
        "{ at = \"120ms\", set = { X0 = 1 } }, { at = 0, always = { Y0 = 0 }, until = \"150ms\", tolerance = \"2 scans\" }",
        "in scan 14",
    );
    for (expected, is_met) in [
        ("50", true),
        ("48", false),
        ("\"48..52\"", true),
        ("\"51..52\"", false),
        ("\">= 50\"", true),
        ("\"> 50\"", false),
        ("\"<> 51\"", true),
        ("\"!= 50\"", false),
        ("\"< 51\"", true),
        ("\"<= 49\"", false),
        ("\"H32\"", true),
        ("50.0", true),
    ] {
        let (code, out, err) =
            steps(&format!("{{ set = {{ D0 = 50 }} }}, {{ after = 10, expect = {{ D0 = {expected} }} }}"));
        assert_eq!(code, i32::from(!is_met), "{expected}: {out}{err}");
    }
    passes("{ set = { D0 = 50 }, expect = { D0 = 48 }, deviation = 2 }");
    fails("{ set = { D0 = 50 }, expect = { D0 = 48 }, deviation = 1.5 }", "D0 is 50 where 48");
    fails("{ set = { D0 = 50 }, expect = { D0 = 48.5 } }", "D0 is 50 where 48.5 was expected");
}

#[test]
fn what_is_forced_stays_until_it_is_let_go() {
    passes(
        "{ force = { Y0 = 1 } }, { after = 50, expect = { Y0 = 1 }, set = { X1 = 1 } }, { after = 50, expect = { Y0 = 1 } }, \
         { after = 10, release = [\"Y0\"], expect = { Y0 = 0 } }",
    );
}

#[test]
fn steps_of_the_file_begin_every_scenario() {
    let suite = "program = \"motor.il\"\nsteps = [{ set = { X0 = 1 } }, { never = { Y1 = 1 } }]\n\
        [[scenario]]\nname = \"a\"\nsteps = [{ at = 20, expect = { Y0 = 1 } }]\n\
        [[scenario]]\nname = \"b\"\nsteps = [{ at = 500, set = { X7 = 1 } }]\n";
    let (code, out, _) = run(&tested(MOTOR, suite), &["test"]);
    assert!(code == 1 && out.contains("ok     a\n") && out.contains("FAILED b\n"), "{out}");
    assert_eq!(run(&tested(MOTOR, suite), &["test", "--only", "A"]).0, 0);
    let (code, _, err) = run(&tested(MOTOR, suite), &["test", "--only", "c"]);
    assert!(code == 2 && err.contains("no scenario has `c` in its name"), "{err}");
}

#[test]
fn a_golden_trace_is_written_and_compared() {
    let suite = "[[scenario]]\nname = \"cycle\"\ntime = \"500ms\"\ngolden = \"cycle.csv\"\nwatch = [\"X0\", \"Y0\", \"Y1\"]\n\
        steps = [{ at = \"100ms\", set = { X0 = 1 } }]\n";
    let files = tested(MOTOR, suite);
    let (code, _, err) = run(&files, &["test"]);
    assert!(code == 2 && err.contains("motor.test.toml:4:11: there is no golden trace cycle.csv"), "{err}");
    let (code, out, _) = run(&files, &["test", "--update"]);
    assert!(code == 0 && out.contains("written: ") && out.contains("cycle.csv"), "{out}");
    let path = files.path().join("cycle.csv");
    let written = std::fs::read_to_string(&path).unwrap();
    assert_eq!(written, "scan,time_ms,X0,Y0,Y1\n0,0,0,0,0\n10,100,1,1,0\n40,400,1,1,1\n50,500,1,1,1\n");
    assert_eq!(run(&files, &["test"]).0, 0);
    // Nothing is written where nothing changed.
    assert!(!run(&files, &["test", "--update"]).1.contains("written"));
    std::fs::write(&path, written.replace("40,400", "38,380")).unwrap();
    let (code, out, _) = run(&files, &["test"]);
    assert!(code == 1 && out.contains("Y1 is 0 where the golden trace has 1, in scan 38 at 380 ms"), "{out}");
    let tolerant = suite.replace("time =", "tolerance = \"2 scans\"\ntime =");
    std::fs::write(files.path().join("motor.test.toml"), tolerant).unwrap();
    assert_eq!(run(&files, &["test"]).0, 0);
    std::fs::write(&path, written.replace("10,100,1,1,0", "10,100,1,1 0,0")).unwrap();
    let (code, _, err) = run(&files, &["test"]);
    assert!(code == 2 && err.contains("no table of scan, time_ms and variables; line 3"), "{err}");
}

#[test]
fn json_and_junit_tell_the_same() {
    let files = tested(&MOTOR.replace("ANI X1", "AND X1"), SUITE);
    let (code, out, _) = run(&files, &["test", "--format", "json"]);
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, &answer["summary"]), (1, &json!({"passed": 0, "failed": 1, "unreadable": 0})));
    let file = &answer["files"][0];
    assert_eq!((&file["path"], &file["program"]), (&json!("motor.test.toml"), &json!(["motor.il"])));
    let scenario = &file["scenarios"][0];
    assert_eq!((&scenario["name"], &scenario["passed"]), (&json!("seals in"), &json!(false)));
    let failure = &scenario["failures"][0];
    assert_eq!(
        failure["range"],
        json!({"start": {"line": 5, "column": 55}, "end": {"line": 5, "column": 57}})
    );
    assert_eq!(
        (&failure["name"], &failure["expected"], &failure["actual"], &failure["scan"], &failure["time_ms"]),
        (&json!("Y0"), &json!("1"), &json!("0"), &json!(10), &json!(100.0))
    );
    assert_eq!(failure["program"]["range"]["start"], json!({"line": 4, "column": 5}));
    assert!(scenario["picture"].as_str().unwrap().contains("^^^^^"));
    let (code, out, _) = run(&files, &["test", "--format", "junit"]);
    assert_eq!(code, 1);
    assert!(out.contains("<testsuites name=\"rungwise\" tests=\"1\" failures=\"1\" errors=\"0\">"), "{out}");
    assert!(
        out.contains("<testcase classname=\"motor.test.toml\" name=\"seals in\" time=\"0.320\">"),
        "{out}"
    );
    assert!(
        out.contains("<failure message=\"Y0 is 0 where 1 was expected, in scan 10 at 100 ms\">"),
        "{out}"
    );
}

#[test]
fn coverage_tells_states_and_who_decided() {
    let files = tested(
        MOTOR,
        "[[scenario]]\nname = \"a\"\nsteps = [{ at = 50, set = { X0 = 1 }, expect = { Y0 = 1 } }]\n",
    );
    let (code, out, _) =
        run(&files, &["test", "--coverage", "--coverage-file", "out.info", "--format", "json"]);
    assert_eq!(code, 0);
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        answer["coverage"]["summary"],
        json!({"rungs": 2, "evaluated": 2, "contacts": 4, "covered": 1, "decided": 1, "decidable": 4})
    );
    let contacts = answer["coverage"]["files"][0]["rungs"][0]["contacts"].as_array().unwrap();
    let told: Vec<String> = contacts
        .iter()
        .map(|contact| {
            format!(
                "{} {} {} {} {}",
                contact["name"], contact["on"], contact["off"], contact["decided_on"], contact["decided_off"]
            )
        })
        .collect();
    // Y0 has not come on yet where it is read, but had it been on, the motor would have run: it decides while it is off.
    // So does X1, which conducts, only in the last scan, when X0 lets power come as far.
    assert_eq!(told, ["\"X0\" 1 5 true true", "\"Y0\" 0 6 false true", "\"X1\" 6 0 true false"]);
    let trace = std::fs::read_to_string(files.path().join("out.info")).unwrap();
    assert!(
        trace.starts_with("TN:\nSF:motor.il\nBRDA:1,0,0,5\nBRDA:1,0,1,1\nBRDA:2,0,0,6\nBRDA:2,0,1,0\n"),
        "{trace}"
    );
    assert!(
        trace.contains("BRF:8\nBRH:5\nDA:1,6\n") && trace.ends_with("LF:4\nLH:4\nend_of_record\n"),
        "{trace}"
    );
    let (_, out, _) = run(&files, &["test", "--coverage"]);
    assert!(
        out.contains("1 of 4 contacts and conditions seen on and off (25 %), 1 of 4 deciding both ways (25 %), 2 of 2 rungs"),
        "{out}"
    );
    assert!(
        out.contains("motor.il:2:1: the normally open contact of Y0 never conducted: Y0 was off whenever it was evaluated\n")
            && out.contains("motor.il:3:1: the normally closed contact of X1 never blocked: X1 was off whenever it was evaluated\n"),
        "{out}"
    );
}

#[test]
fn a_contact_that_is_on_and_off_need_not_decide() {
    // X1 goes on and off while X0 is off: whatever it does, Y0 stays off. X2 beside it lets power past it for a while.
    let program = "LD X1\nOR X2\nAND X0\nOUT Y0\nEND\n";
    let suite = "[[scenario]]\nname = \"a\"\nsteps = [{ at = 20, pulse = { X1 = 20 } }, { at = 60, expect = { Y0 = 0 } }";
    let told = |more: &str| {
        let files = tested(program, &format!("{suite}{more}]\n"));
        run(&files, &["test", "--coverage"]).1
    };
    let out = told("");
    assert!(out.contains("1 of 3 contacts") && out.contains("0 of 3 deciding both ways"), "{out}");
    assert!(
        out.contains("motor.il:1:1: the contact of X1 conducted and blocked, and decided nothing\n"),
        "{out}"
    );
    // With X0 on it decides while it is off, not while it is on, for X2 is on then.
    let more = ", { at = 80, set = { X0 = 1 } }, { at = 100, set = { X1 = 1, X2 = 1 }, expect = { Y0 = 1 } }";
    let out = told(more);
    assert!(out.contains("motor.il:1:1: the contact of X1 decided nothing while it conducted\n"), "{out}");
}

#[test]
fn code_that_no_scan_comes_to_is_not_covered() {
    let program = "LD M8000\nCJ P1\nLD X0\nOUT Y0\nP1\nLD X1\nOUT Y1\nEND\n";
    let files = tested(
        program,
        "[[scenario]]\nname = \"a\"\nsteps = [{ at = 50, set = { X1 = 1 }, expect = { Y1 = 1 } }]\n",
    );
    let (code, out, _) = run(&files, &["test", "--coverage"]);
    assert!(code == 0 && out.contains("motor.il:3:1: the contact of X0 was never evaluated\n"), "{out}");
    assert!(out.contains("1 of 2 contacts") && out.contains("2 of 3 rungs"), "{out}");
}

#[test]
fn faults_that_no_scenario_finds_are_listed() {
    let (code, out, _) = run(&tested(MOTOR, SUITE), &["test", "--mutate"]);
    assert_eq!(code, 1);
    // Nothing is said of Y1, so whatever becomes of it passes.
    for line in [
        "motor.il:5:1: T0: the preset K6",
        "motor.il:6:1: T0: normally closed in place",
        "motor.il:6:1: T0: the contact left out",
    ] {
        assert!(out.contains(line), "{line}\n{out}");
    }
    assert!(out.contains("9 of 9 faults tried: 3 found, 6 not found, 0 proved to change nothing"), "{out}");
    let lamp = "\n[[scenario]]\nname = \"lamp\"\nsteps = [\n\
        { always = { Y0 = 0, Y1 = 0 }, until = 50 },\n\
        { at = 50, pulse = { X0 = 20 } },\n\
        { at = 50, always = { Y0 = 1 }, for = \"1s\" },\n\
        { at = 50, always = { Y1 = 0 }, for = 300 },\n\
        { at = 350, expect = { Y1 = 1 } },\n]\n";
    let more = format!("{SUITE}{lamp}");
    let (code, out, _) = run(&tested(MOTOR, &more), &["test", "--mutate", "--format", "json"]);
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, &answer["mutants"]["survived"]), (0, &json!([])), "{out}");
    let sample =
        |seed: &str| run(&tested(MOTOR, SUITE), &["test", "--mutate", "--mutants", "4", "--seed", seed]).1;
    assert_eq!(sample("1"), sample("1"));
    assert!(sample("1").contains("4 of 9 faults tried"));
}

#[test]
fn faults_that_change_nothing_are_proved_so() {
    // Behind X0 the second X0 may be left out, or its branch.
    let program = "LD X0\nAND X0\nOUT Y0\nEND\n";
    let suite = "[[scenario]]\nname = \"a\"\nsteps = [{ expect = { Y0 = 0 } }, { at = 50, set = { X0 = 1 }, expect = { Y0 = 1 } }]\n";
    let (code, out, _) = run(&tested(program, suite), &["test", "--mutate"]);
    assert!(
        code == 0 && out.contains("4 of 4 faults tried: 2 found, 0 not found, 2 proved to change nothing"),
        "{out}"
    );
}

#[test]
fn mistakes_are_told_with_line_and_column_in_both_languages() {
    let suite = |text: &str| format!("[[scenario]]\nname = \"a\"\n{text}\n");
    for (text, place, english, chinese) in [
        (suite("stepz = []"), "3:1", "did you mean `steps`", "是否指 `steps`"),
        (suite("steps = [{ at = \"soon\" }]"), "3:17", "a time belongs here", "此处应为时间"),
        (
            suite("steps = [{ at = \"10h\", set = { X0 = 1 } }]"),
            "3:17",
            "at most 1000000 scans",
            "最多 1000000 次扫描",
        ),
        (
            suite("steps = [{ set = { X99 = 1 }, expect = { Y0 = 0 } }]"),
            "3:20",
            "nothing called `X99`",
            "没有 `X99`",
        ),
        (
            suite("steps = [{ set = { X0 = 7 }, expect = { Y0 = 0 } }]"),
            "3:20",
            "cannot be set to this value",
            "X0",
        ),
        (
            suite("steps = [{ set = { X0 = \"up\" }, expect = { Y0 = 0 } }]"),
            "3:20",
            "cannot be set to this value",
            "X0",
        ),
        (suite("steps = [{ expect = { X0 = \"up\" } }]"), "3:23", "never has this value", "不会有这个值"),
        (suite("steps = [{ set = { X0 = \"u p\" } }]"), "3:25", "a value belongs here", "此处应为值"),
        (suite("steps = [{ expect = { X0 = \"5..1\" } }]"), "3:28", "a value belongs here", "此处应为值"),
        (suite("steps = [{ at = 5 }]"), "3:10", "does nothing", "既不做任何事"),
        (suite("steps = [{ at = 5, after = 5, set = { X0 = 1 } }]"), "3:20", "`at` names", "`at` 已经"),
        (suite("steps = [{ set = { X0 = 1 }, within = 5 }]"), "3:30", "`expect` counts", "`expect` 持续"),
        (
            suite("time = 10\nsteps = [{ at = 50, expect = { X0 = 1 } }]"),
            "3:8",
            "before scan 5",
            "在扫描 5 之前",
        ),
        (
            suite("steps = [{ always = { X0 = 1 }, until = { X1 = 1 } }]"),
            "3:10",
            "needs a `time`",
            "需要 `time`",
        ),
        (
            suite("steps = [{ always = { X0 = 1 }, for = 5, until = 5 }]"),
            "3:33",
            "`until` says how long already",
            "`until` 已经",
        ),
        (suite("time = 50\nsteps = [{ set = { X0 = 1 } }]"), "2:9", "`a` expects nothing", "没有任何期望"),
        ("[[scenario]]\ntime = 5\n".into(), "1:1", "expects nothing", "没有任何期望"),
        (suite("scan-time = \"1h\""), "3:13", "from 1us to 60s", "1us 到 60s"),
        (suite("steps = 5"), "3:9", "a list in brackets", "方括号"),
        ("program = \"gone.il\"\n[[scenario]]\nname = \"a\"".into(), "1:12", "no such file", "gone.il"),
        ("".into(), "1:1", "`[[scenario]]`", "`[[scenario]]`"),
        ("[[scenario]\n".into(), "1:", "not valid TOML", "TOML"),
        (format!("{}{}", suite(""), suite("")), "5:9", "another scenario", "另有场景"),
    ] {
        let files = tested(MOTOR, &text);
        let (code, _, err) = run(&files, &["test"]);
        assert!(
            code == 2 && err.contains(&format!("motor.test.toml:{place}")) && err.contains(english),
            "{text}\n{err}"
        );
        let (code, _, err) = run(&files, &["--lang", "zh-CN", "test"]);
        assert!(code == 2 && err.contains(chinese), "{text}\n{err}");
    }
    let (code, _, err) = run(&folder(&[("a.il", "LD X0\n")]), &["test"]);
    assert!(code == 2 && err.contains("there are no scenario tests here"), "{err}");
    let (code, _, err) = run(&folder(&[("a.test.toml", SUITE)]), &["test"]);
    assert!(code == 2 && err.contains("which program is tested?"), "{err}");
}

#[test]
fn programs_that_do_not_run_or_end_fail_where_they_are_wrong() {
    let (code, out, _) = run(&tested("LD X0\nCJ P9\nOUT Y0\nEND\n", SUITE), &["test"]);
    assert!(code == 1 && out.contains("motor.il:2:1: there is no label P9"), "{out}");
    let (code, out, _) = run(&tested("P0\nLD M8000\nCJ P0\nEND\n", SUITE), &["test"]);
    assert!(
        code == 1 && out.contains("something went wrong in scan 0 at 0 ms: the scan does not end"),
        "{out}"
    );
    assert!(out.contains("at motor.il:"), "{out}");
    let divides = "LD X0\nDIV K1 D5 D6\nEND\n";
    let suite = "[[scenario]]\nname = \"a\"\nsteps = [{ at = 50, set = { X0 = 1 } }, { at = 100, expect = { X0 = 1 } }]\n";
    let (code, out, _) = run(&tested(divides, suite), &["test"]);
    assert!(code == 1 && out.contains("division by zero") && out.contains("at motor.il:2:1"), "{out}");
    let allows = suite.replace("steps", "allow-errors = true\nsteps");
    assert_eq!(run(&tested(divides, &allows), &["test"]).0, 0);
}

#[test]
fn garbled_and_huge_files_are_refused_and_nothing_else_happens() {
    let deep = format!("a = {}", "[".repeat(100_000));
    let long = format!("[[scenario]]\nname = \"a\"\nsteps = [{}]", "{ set = { X0 = 1 } },".repeat(150_000));
    let dots =
        format!("[[scenario]]\nname = \"a\"\nsteps = [{{ set = {{ {}X0 = 1 }} }}]", "a.".repeat(5_000));
    for text in [
        deep,
        long,
        dots,
        "\u{0}\u{feff}[[\"".repeat(1000),
        "[[scenario]]\nname = \"😀\"\nsteps = [{ set = { 😀 = 1 } }]".into(),
    ] {
        let (code, _, err) = run(&tested(MOTOR, &text), &["test"]);
        assert!(code == 2 && err.contains("motor.test.toml:") && !err.contains("panicked"), "{err}");
        assert!(err.len() < 200_000, "{}", err.len());
    }
}

#[test]
fn a_program_of_several_files_is_tested_as_one() {
    let files = folder(&[
        ("rungwise.toml", "target = \"fx2n\"\nfiles = [\"main.il\", \"sub.il\"]\n"),
        ("main.il", "LD X0\nCALL P1\nFEND\n"),
        ("sub.il", "P1\nLD X1\nOUT Y1\nSRET\nEND\n"),
        (
            "line.test.toml",
            "[[scenario]]\nname = \"a\"\nsteps = [{ set = { X0 = 1, X1 = 1 }, expect = { Y1 = 1 } }]\n",
        ),
        (
            "main.test.toml",
            "[[scenario]]\nname = \"b\"\nsteps = [{ set = { X0 = 1, X1 = 1 }, expect = { Y1 = 1 } }]\n",
        ),
    ]);
    let (code, out, err) = run(&files, &["test", "--coverage"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("main.il: 0 of 1 contacts") && out.contains("sub.il: 0 of 1 contacts"), "{out}");
    assert_eq!(run(&files, &["test", "sub.il"]).0, 0);
}

#[test]
fn the_scenarios_of_the_examples_pass_and_find_all_faults_but_one() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output =
        crate::binary::command(root, &["test", "examples", "--mutate", "--format", "json"]).output().unwrap();
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        (&answer["summary"]["failed"], &answer["summary"]["unreadable"]),
        (&json!(0), &json!(0)),
        "{answer:#}"
    );
    assert!(answer["summary"]["passed"].as_u64() >= Some(10));
    // The one that the head of its test file tells of.
    let survived = answer["mutants"]["survived"].as_array().unwrap();
    let places: Vec<String> = survived
        .iter()
        .map(|one| {
            format!("{}:{}", one["path"].as_str().unwrap().replace('\\', "/"), one["range"]["start"]["line"])
        })
        .collect();
    assert_eq!(places, ["examples/batch-counter/batch.il:5"], "{:#}", answer["mutants"]);
}

#[test]
fn the_example_of_the_page_does_as_it_says() {
    let page = include_str!("../docs/testing.md");
    let fence = |word: &str| page.split(&format!("```{word}\n")).nth(1).unwrap().split("```").next().unwrap();
    let files = folder(&[("motor.il", fence("il")), ("motor.test.toml", fence("toml"))]);
    let (code, out, err) = run(&files, &["test", "motor.test.toml"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(page.contains(&format!("$ rungwise test motor.test.toml\n{out}```")), "{out}");
}

#[test]
fn a_counterexample_is_a_scenario_test() {
    let files =
        folder(&[("left.il", "LD X0\nAND M0\nOUT Y0\nEND\n"), ("right.il", "LD X0\nOR M0\nOUT Y0\nEND\n")]);
    let (code, _, _) = run(&files, &["prove", "left.il", "right.il", "--scenario", "left.test.toml"]);
    assert_eq!(code, 1);
    let text = std::fs::read_to_string(files.path().join("left.test.toml")).unwrap();
    assert_eq!(run(&files, &["test"]).0, 0, "{text}");
    std::fs::write(files.path().join("left.test.toml"), text.replace("left.il\"", "right.il\"")).unwrap();
    assert_eq!(run(&files, &["test"]).0, 1, "{text}");
}

#[test]
fn conditions_of_lists_of_iec_are_covered_and_contacts_are_called_what_they_are() {
    let program = "FUNCTION_BLOCK Gate\nVAR_INPUT\nx : BOOL;\nEND_VAR\nVAR_OUTPUT\ny : BOOL;\nEND_VAR\nLDN x\nST y\n\
        END_FUNCTION_BLOCK\nPROGRAM Main\nVAR\na, b, Motor : BOOL; n : INT; w : WORD; one, two : Gate;\nEND_VAR\n\
        CAL one(x := a)\nCAL two(x := b)\nLD n\nADD 1\nST n\nLD a\nANDN b\nST Motor\nLD n\nGT 3\nR Motor\n\
        LD w\nAND 16#1\nWORD_TO_BOOL\nJMPC off\nGT(n, 1)\nRETC\noff:\nEND_PROGRAM\n";
    let scenarios = "[[scenario]]\nname = \"a\"\ntime = \"100ms\"\nsteps = [ { at = \"20ms\", set = { a = 1 } }, \
        { at = \"100ms\", expect = { Motor = 0 } } ]\n";
    let folder = folder(&[("main.il", program), ("main.test.toml", scenarios)]);
    let (code, out, _) = run(&folder, &["test", "--coverage"]);
    assert_eq!(code, 0, "{out}");
    let told: Vec<&str> = out.lines().skip_while(|line| !line.starts_with("main.il:")).collect();
    let expected = [
        "main.il: 5 of 7 contacts and conditions seen on and off (71 %), 3 of 4 deciding both ways (75 %), 8 of 8 rungs evaluated",
        "  main.il:21:6: the normally closed contact of b never blocked: b was off whenever it was evaluated",
        "  main.il:29:1: `JMPC off` never held when it was evaluated",
    ];
    assert_eq!(told, expected);
    let (_, json, _) = run(&folder, &["test", "--coverage", "--format", "json"]);
    let json: Value = serde_json::from_str(&json).unwrap();
    let summary = &json["coverage"]["summary"];
    assert_eq!((&summary["contacts"], &summary["decidable"]), (&json!(7), &json!(4)));
    // Nothing to count is not all of it.
    let folder = self::folder(&[
        ("main.il", "PROGRAM Main\nVAR\nn : INT;\nEND_VAR\nLD n\nADD 1\nST n\nEND_PROGRAM\n"),
        ("main.test.toml", "[[scenario]]\nname = \"a\"\nsteps = [ { expect = { n = 1 } } ]\n"),
    ]);
    let (_, out, _) = run(&folder, &["test", "--coverage"]);
    assert!(
        out.contains(
            "main.il: it has no contact and no condition that could be covered; 1 of 1 rungs evaluated\n"
        ) && !out.contains("100 %"),
        "{out}"
    );
}

#[test]
fn faults_behind_detectors_of_edges_are_tried() {
    let program = "PROGRAM Main\nVAR\ngo, halt, Motor : BOOL; e : R_TRIG;\nEND_VAR\n\
        CAL e(CLK := go)\nLD e.Q\nOR Motor\nANDN halt\nST Motor\nEND_PROGRAM\n";
    let scenarios = "[[scenario]]\nname = \"a\"\nsteps = [ { expect = { Motor = 0 } }, { at = 20, set = { go = 1 }, \
        expect = { Motor = 1 } }, { at = 40, set = { go = 0 }, expect = { Motor = 1 } }, { at = 60, set = { halt = 1 }, \
        expect = { Motor = 0 } }, { at = 80, set = { halt = 0 }, expect = { Motor = 0 } } ]\n";
    let folder = folder(&[("main.il", program), ("main.test.toml", scenarios)]);
    let (code, out, _) = run(&folder, &["test", "--mutate"]);
    let line =
        "6 of 6 faults tried: 6 found, 0 not found, 0 proved to change nothing, 0 that cannot be run\n";
    assert!(code == 0 && out.contains(line), "{out}");
}

#[test]
fn faults_with_which_nothing_runs_are_named() {
    let program =
        "PROGRAM Main\nVAR\nn : INT; a : SINT;\nEND_VAR\nLD SINT#127\nST a\nLD n\nADD 1\nST n\nEND_PROGRAM\n";
    let scenarios = "[[scenario]]\nname = \"a\"\nsteps = [ { at = 20, expect = { n = 3 } } ]\n";
    let folder = folder(&[("main.il", program), ("main.test.toml", scenarios)]);
    let (code, out, _) = run(&folder, &["test", "--mutate"]);
    let told = "2 of 2 faults tried: 1 found, 0 not found, 0 proved to change nothing, 1 that cannot be run\n\
        1 of them make programs that do not run:\n  main.il:5:1: a: the constant SINT#128 in place of SINT#127\n";
    assert!(code == 0 && out.contains(told), "{out}");
    let (_, json, _) = run(&folder, &["test", "--mutate", "--format", "json"]);
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(
        (&json["mutants"]["invalid"], json["mutants"]["not_running"][0]["path"].as_str()),
        (&json!(1), Some("main.il"))
    );
}

#[test]
fn faults_that_cannot_be_written_are_named_and_are_no_success() {
    // What finds a falling edge needs variables, and nothing heads the unit behind which they could be declared.
    let program = "VAR\ngo, Motor : BOOL; e : R_TRIG;\nEND_VAR\nCAL e(CLK := go)\nLD e.Q\nST Motor\n";
    let scenarios = "[[scenario]]\nname = \"a\"\nsteps = [ { expect = { Motor = 0 } }, { at = 20, set = { go = 1 }, \
        expect = { Motor = 1 } } ]\n";
    let folder = folder(&[("main.il", program), ("main.test.toml", scenarios)]);
    let (code, out, _) = run(&folder, &["test", "--mutate"]);
    let told = "2 of 2 faults tried: 1 found, 0 not found, 0 proved to change nothing, 1 that cannot be run\n\
        1 of them cannot be written, so nothing is known of them:\n  \
        main.il:5:4: go: normally closed in place of normally open, or the other way round\n";
    assert!(code == 1 && out.contains(told), "{out}");
    let (code, json, _) = run(&folder, &["test", "--mutate", "--format", "json"]);
    let json: Value = serde_json::from_str(&json).unwrap();
    let mutants = &json["mutants"];
    let line = &mutants["not_written"][0]["range"]["start"]["line"];
    assert_eq!((code, &mutants["invalid"], &mutants["killed"], line), (1, &json!(1), &json!(1), &json!(5)));
    assert_eq!((&mutants["survived"], &mutants["not_running"]), (&json!([]), &json!([])));
    // Faults are counted only where they are tried.
    assert_eq!(run(&folder, &["test", "--mutants", "3"]).0, 2);
}

#[test]
fn a_golden_trace_is_read_in_any_encoding_and_one_that_is_no_table_is_not_called_missing() {
    let suite = "[[scenario]]\nname = \"a\"\ntime = \"20ms\"\ngolden = \"a.csv\"\n";
    let folder = tested(MOTOR, suite);
    let mut units: Vec<u16> = vec![0xfeff];
    units.extend("scan,time_ms,Y0\r\n0,0,0\r\n2,20,0\r\n".encode_utf16());
    let bytes: Vec<u8> = units.into_iter().flat_map(u16::to_le_bytes).collect();
    std::fs::write(folder.path().join("a.csv"), bytes).unwrap();
    assert_eq!(run(&folder, &["test"]).0, 0);
    std::fs::write(folder.path().join("a.csv"), [0xc3, 0x28, 0x00, 0xff]).unwrap();
    let (code, _, err) = run(&folder, &["test"]);
    assert!(code == 2 && err.contains("the golden trace is no table"), "{err}");
}
