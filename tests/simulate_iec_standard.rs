//! Parts of IEC 61131-3 that are more than operators: EN and ENO, subranges, configurations, located arrays.

use crate::binary::{folder, run};
use crate::simulate_iec::{Plc, result};
use rungwise::simulate::ErrorKind;
use rungwise::target::Fault;
use rungwise::target::iec::{Datum, ElementaryType, Formula, Function, Inputs};

const UNITS: &str = "FUNCTION Half : INT\nVAR_INPUT\nn : INT;\nEND_VAR\nVAR_OUTPUT\nodd : BOOL;\nEND_VAR\n\
    LD n\nMOD 2\nEQ 1\nST odd\nLD n\nDIV 2\nST Half\nEND_FUNCTION\n\
    FUNCTION Safe : INT\nVAR_INPUT\nEN : BOOL := 1;\nn, by : INT;\nEND_VAR\nVAR_OUTPUT\nENO : BOOL;\nEND_VAR\n\
    LD by\nEQ 0\nJMPC no\nLD n\nDIV by\nST Safe\nRET\nno:\nLD FALSE\nST ENO\nLD -1\nST Safe\nEND_FUNCTION\n\
    FUNCTION_BLOCK Count\nVAR_INPUT\nEN : BOOL := 1;\nEND_VAR\nVAR_OUTPUT\nENO : BOOL;\nn : INT;\nEND_VAR\n\
    LD n\nADD 1\nST n\nEND_FUNCTION_BLOCK\n";

fn program(declared: &str, body: &str) -> String {
    format!("{UNITS}PROGRAM Main\nVAR\n{declared}\nEND_VAR\n{body}\nEND_PROGRAM\n")
}

#[test]
fn a_function_that_is_not_enabled_has_the_result_of_a_new_variable() {
    let declared = "go, ok, odd, big : BOOL; n, m : INT := 7; r : REAL; s : STRING := 'x';";
    let body = "Half(\nEN := go,\nn := n,\nodd => odd,\nENO => ok\n)\nST m\n\
        GT(\nEN := go,\nIN1 := n,\nIN2 := 3\n)\nST big\nSQRT(\nEN := go,\nIN := 4.0\n)\nST r\n\
        LEFT(\nEN := go,\nIN := 'abc',\nL := 2\n)\nST s";
    let mut plc = Plc::new(&program(declared, body));
    let all = |plc: &Plc| ["m", "odd", "ok", "big", "r", "s"].map(|name| plc.get(name));
    plc.set("go", "1").scan();
    assert_eq!(all(&plc), ["3", "1", "1", "1", "2.0", "'ab'"]);
    // Outputs keep what they have, results do not.
    plc.set("go", "0").set("n", "4").scan();
    assert_eq!(all(&plc), ["0", "1", "0", "0", "0.0", "''"]);
}

#[test]
fn eno_tells_errors_of_standard_functions_and_what_units_say_themselves() {
    let declared = "by : INT; a, b, c : BOOL; m : INT;";
    let body = "DIV(\nIN1 := 8,\nIN2 := by,\nENO => a\n)\nST m\nSafe(\nn := 8,\nby := by,\nENO => b\n)\nST m\n\
        Half(\nn := by,\nENO => c\n)";
    let mut plc = Plc::new(&program(declared, body));
    plc.scan();
    assert_eq!(["a", "b", "c", "m"].map(|name| plc.get(name)), ["0", "0", "1", "-1"]);
    plc.set("by", "4").scan();
    assert_eq!(["a", "b", "c", "m"].map(|name| plc.get(name)), ["1", "1", "1", "2"]);
    // A block that declares EN stands still without it, and keeps it from call to call.
    let mut plc = Plc::new(&program("t : Count; ok : BOOL;", "CAL t(ENO => ok)"));
    plc.scan();
    assert_eq!((plc.get("t.n"), plc.get("ok")), ("1".into(), "1".into()));
    plc.set("t.EN", "0").scan();
    assert_eq!((plc.get("t.n"), plc.get("ok"), plc.get("t.ENO")), ("1".into(), "0".into(), "0".into()));
}

#[test]
fn subranges_hold_and_say_where_they_are_left() {
    let text = "TYPE\nDigit : INT(0..9);\nEND_TYPE\nPROGRAM Main\nVAR\nn : INT;\nd : Digit;\n\
        all : ARRAY[1..2] OF SINT(-5..5);\nlow : UINT(3..8);\nEND_VAR\n\
        LD n\nST d\nLD n\nINT_TO_SINT\nST all[2]\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    plc.scan();
    assert_eq!(["d", "all[1]", "low"].map(|name| plc.get(name)), ["0", "-5", "3"]);
    plc.set("n", "12").scan();
    assert_eq!(["d", "all[2]"].map(|name| plc.get(name)), ["9", "5"]);
    assert_eq!(plc.errors, [ErrorKind::Calculation(Fault::Subrange); 2]);
    plc.set("n", "-3").scan();
    assert_eq!((["d", "all[2]"].map(|name| plc.get(name)), plc.errors.len()), (["0".into(), "-3".into()], 1));
    let files = folder(&[("main.il", text)]);
    let (code, _, err) = run(&files, &["run", "main.il", "--set", "n=12@50ms"]);
    assert!(code == 1 && err.contains("main.il:12:1: the value is outside of the subrange"), "{err}");
    let (_, _, err) = run(&files, &["run", "main.il", "--set", "d=10"]);
    assert!(err.contains("`d` takes 0 to 9") || err.contains("from 0 to 9"), "{err}");
    assert_eq!(result("v : INT(1..5) := 4;", "LD v\nADD 10\nSUB 10\nST v", "v"), "4");
}

#[test]
fn programs_are_connected_by_their_configuration() {
    let text = "CONFIGURATION Plant\nVAR_GLOBAL\nwanted : INT := 5; made : INT; done : BOOL; ramp : ARRAY[0..1] OF INT;\nEND_VAR\n\
        RESOURCE PLC ON Cpu\nTASK Slow(INTERVAL := T#20ms, PRIORITY := 1);\n\
        PROGRAM A WITH Slow : Maker(goal := wanted, each := 2, sum => made, busy => done, table := ramp);\n\
        PROGRAM B : Maker(goal := %IW3, sum => %QW7);\nEND_RESOURCE\nEND_CONFIGURATION\n\
        PROGRAM Maker\nVAR_INPUT\ngoal : INT; each : INT := 1; table : ARRAY[0..1] OF INT;\nEND_VAR\n\
        VAR_OUTPUT\nsum : INT; busy : BOOL;\nEND_VAR\nLD sum\nLT goal\nST busy\nJMPCN full\nLD sum\nADD each\nADD table[1]\nST sum\n\
        full:\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    plc.set("%IW3", "3").set("ramp[1]", "1").scan();
    assert_eq!(["made", "done", "B.sum", "%QW7"].map(|name| plc.get(name)), ["3", "1", "1", "1"]);
    // A task that does not run takes nothing over.
    plc.set("made", "0").scan();
    assert_eq!(["made", "A.sum", "%QW7"].map(|name| plc.get(name)), ["0", "3", "2"]);
    plc.scan().scan().scan();
    assert_eq!(["made", "A.sum", "done", "%QW7"].map(|name| plc.get(name)), ["6", "6", "0", "3"]);
}

#[test]
fn arrays_lie_at_addresses() {
    let text = "PROGRAM Main\nVAR\nrow AT %MW10 : ARRAY[0..9] OF INT := [1, 2, 3];\nbits AT %QX0.6 : ARRAY[0..3] OF BOOL;\n\
        grid AT %IB8 : ARRAY[0..1, 0..2] OF BYTE;\ncopy : ARRAY[0..9] OF INT;\nk : INT; one : BYTE; got : WORD;\nEND_VAR\n\
        LD k\nADD 10\nST row[k]\nLD TRUE\nST bits[k]\nLD grid[1, k]\nST one\nLD row\nST copy\nLD %MW12\nST got\n\
        LD 7\nST %MW19\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    plc.set("k", "2").set("grid[1,2]", "33").scan();
    assert_eq!(
        ["row[2]", "copy[2]", "got", "one", "%IB13"].map(|name| plc.get(name)),
        ["12", "12", "12", "33", "33"]
    );
    assert_eq!(["row[0]", "row[9]", "%MW10", "%MB20"].map(|name| plc.get(name)), ["1", "7", "1", "1"]);
    assert_eq!(["bits[1]", "bits[2]", "%QX0.7", "%QX1.0"].map(|name| plc.get(name)), ["0", "1", "0", "1"]);
    plc.set("k", "3").scan();
    assert_eq!(plc.errors, [ErrorKind::Calculation(Fault::Index)]);
}

#[test]
fn var_config_lays_variables_of_instances_at_addresses() {
    let text = "CONFIGURATION Plant\nRESOURCE PLC ON Cpu\nPROGRAM A : Main;\nPROGRAM B : Main;\nEND_RESOURCE\n\
        VAR_CONFIG\nPLC.A.start AT %IX0.3 : BOOL;\nPLC.A.left.lamp AT %QX1.0 : BOOL;\nPLC.B.start AT %IX0.4 : BOOL;\n\
        PLC.B.left.limit : INT := 9;\nPLC.B.row[2].lamp AT %QX1.5 : BOOL;\nPLC.B.row[1].limit : INT := 8;\n\
        END_VAR\nEND_CONFIGURATION\n\
        FUNCTION_BLOCK Light\nVAR_INPUT\non_ : BOOL;\nEND_VAR\nVAR\nlamp AT %Q* : BOOL; limit : INT := 4;\nEND_VAR\n\
        LD on_\nST lamp\nEND_FUNCTION_BLOCK\n\
        PROGRAM Main\nVAR\nstart AT %I* : BOOL;\nleft : Light;\nrow : ARRAY[1..2] OF Light;\nEND_VAR\n\
        LD start\nST left.on_\nST row[2].on_\nCAL left\nCAL row[2]\nEND_PROGRAM\n";
    let text = text.replace("on_", "lit");
    let mut plc = Plc::new(&text);
    plc.set("%IX0.3", "1").scan();
    assert_eq!(["%QX1.0", "A.left.lamp", "B.left.lamp"].map(|name| plc.get(name)), ["1", "1", "0"]);
    assert_eq!(["A.left.limit", "B.left.limit"].map(|name| plc.get(name)), ["4", "9"]);
    assert_eq!(["B.row[1].limit", "B.row[2].limit", "%QX1.5"].map(|name| plc.get(name)), ["8", "4", "0"]);
    plc.set("A.start", "0").set("B.start", "1").scan();
    assert_eq!(["%IX0.3", "%IX0.4", "%QX1.0", "B.left.lamp"].map(|name| plc.get(name)), ["0", "1", "0", "1"]);
    assert_eq!(["%QX1.5", "A.row[2].lamp"].map(|name| plc.get(name)), ["1", "0"]);
    let files = folder(&[("main.il", &text.replace("PLC.B.start", "PLC.C.start"))]);
    let (code, _, err) = run(&files, &["run", "main.il"]);
    assert!(code == 1 && err.contains("main.il:9:1: PLC.C.start is not declared"), "{err}");
}

#[test]
fn instances_are_called_by_subscripts() {
    let text = format!(
        "{UNITS}PROGRAM Main\nVAR\nall : ARRAY[1..3, 0..1] OF Count;\ni, j : INT := 1;\nlast : INT;\nEND_VAR\n\
         CAL all[i, j](n => last)\nEND_PROGRAM\n"
    );
    let mut plc = Plc::new(&text);
    plc.scan().set("i", "3").scan().scan().set("j", "0").scan();
    let names = ["all[1,1].n", "all[3,1].n", "all[3,0].n", "all[2,0].n", "last"];
    assert_eq!(names.map(|name| plc.get(name)), ["1", "2", "1", "0", "1"]);
    plc.set("i", "4").scan();
    assert_eq!((plc.get("all[3,0].n"), plc.errors.is_empty()), ("1".into(), false));
}

#[test]
fn what_is_not_simulated_is_refused_where_it_stands() {
    let refused = |text: &str| {
        let files = folder(&[("main.il", text)]);
        let (code, _, err) = run(&files, &["run", "main.il", "--scans", "1"]);
        assert_eq!(code, 1, "{err}");
        err
    };
    let err = refused(
        "FUNCTION_BLOCK F\nVAR_INPUT i : BOOL; END_VAR\nLD i\nEND_FUNCTION_BLOCK\nPROGRAM Main\nVAR f : F; END_VAR\n\
        CAL f()\nEND_PROGRAM\nCONFIGURATION C\nRESOURCE R ON PLC\nTASK slow(INTERVAL := T#1s, PRIORITY := 2);\n\
        PROGRAM P WITH slow : Main(f WITH slow);\nEND_RESOURCE\nEND_CONFIGURATION\n",
    );
    assert!(err.contains("main.il:12:28: f has a task of its own (WITH), which is not simulated"), "{err}");
    let err = refused("PROGRAM Main\nVAR a : INT; p : REF_TO INT; END_VAR\nLD REF(a)\nST p\nEND_PROGRAM\n");
    assert!(err.contains("main.il:2:18: references (`REF_TO`, `REF(…)`, `^`) are not simulated"), "{err}");
    assert!(err.contains("main.il:3:1: references (`REF_TO`"), "{err}");
    let err = refused(
        "TYPE P : STRUCT x : INT; END_STRUCT; END_TYPE\nPROGRAM Main\nVAR s AT %MW0 : P; b : INT; END_VAR\n\
        LD 1\nST b\nEND_PROGRAM\n",
    );
    assert!(
        err.contains("main.il:3:5: a structure or an instance lies at %MW0, which is not simulated"),
        "{err}"
    );
}

#[test]
fn what_follows_from_a_refusal_is_not_told() {
    let refused = |text: &str| {
        let (code, _, err) = run(&folder(&[("main.il", text)]), &["run", "main.il", "--scans", "1"]);
        assert_eq!(code, 1, "{err}");
        let places = err.lines().filter_map(|line| line.strip_prefix("error[simulation]: main.il:"));
        places.map(|line| line.split(": ").next().unwrap_or_default().to_string()).collect::<Vec<_>>()
    };
    let text = "TYPE P : STRUCT x : INT; END_STRUCT; END_TYPE\nVAR_GLOBAL g : REF_TO INT; h AT %MD4 : P; END_VAR\n\
        PROGRAM Main\nVAR go : BOOL; r : REF_TO INT; s AT %MW0 : P; u : Unknown; i : INT; END_VAR\n\
        LD r\nST i\nLD go\nAND u\nST go\nLD s.x\nADD g\nST i\nLD h.x\nJMPC Over\nLD go\nST r\nOver:\nEND_PROGRAM\n";
    assert_eq!(refused(text), ["2:16", "2:28", "4:20", "4:32", "4:51"]);
    // A register has no contact and no coil, and yet the PLC has it.
    let text = "LD D0\nOUT Y0\nLD X0\nOUT D1\nLD M3071\nEND\n";
    let (_, _, err) = run(&folder(&[("main.il", text)]), &["run", "main.il"]);
    let count = |words: &str| err.matches(words).count();
    assert_eq!((count("cannot be read"), count("this PLC has no ")), (2, 0), "{err}");
    // What is wrong besides is told.
    let text =
        "PROGRAM Main\nVAR r : REF_TO INT; i : INT; END_VAR\nST i\nLD r\nST i\nLD other\nST i\nEND_PROGRAM\n";
    assert_eq!(refused(text), ["2:9", "3:1", "6:1"]);
    assert_eq!(
        refused("OUT Y0\nLD X0\nAND Y777\nOUT Y1\nAND X1\nOUT Y2\nLD M9999\nOUT Y3\nEND\n"),
        ["1:1", "3:1", "7:1"]
    );
}

#[test]
fn blocks_that_are_nested_beyond_measure_are_refused() {
    let chain = |count: usize, leaf_first: bool| {
        let block = |number: usize| {
            let inside = if number + 1 < count {
                format!("VAR next : B{}; END_VAR\n", number + 1)
            } else {
                String::new()
            };
            let call = if number + 1 < count { "CAL next(run := run)\nLD next.q\n" } else { "LD run\n" };
            format!(
                "FUNCTION_BLOCK B{number}\nVAR_INPUT run : BOOL; END_VAR\nVAR_OUTPUT q : BOOL; END_VAR\n\
                 {inside}{call}ST q\nEND_FUNCTION_BLOCK\n"
            )
        };
        let mut blocks: Vec<String> = (0..count).map(block).collect();
        if leaf_first {
            blocks.reverse();
        }
        let main =
            "PROGRAM Main\nVAR a, y : BOOL; b : B0; END_VAR\nCAL b(run := a)\nLD b.q\nST y\nEND_PROGRAM\n";
        blocks.concat() + main
    };
    for leaf_first in [false, true] {
        let mut plc = Plc::new(&chain(60, leaf_first));
        plc.set("a", "1").scan();
        assert_eq!(plc.get("y"), "1");
        let files = folder(&[("main.il", &chain(3000, leaf_first))]);
        let (code, _, err) = run(&files, &["run", "main.il"]);
        assert!(code == 1 && err.contains("is nested deeper than 64 times"), "{code} {err}");
    }
}

/// What functions make of whole numbers without looking at types is what their rows say.
#[test]
fn the_short_way_of_a_function_leads_where_the_long_one_does() {
    const ENDS: [i64; 12] =
        [i64::MIN, i64::MIN + 1, i64::MIN / 2, -32_769, -7, -1, 0, 1, 2, 65_536, i64::MAX / 2, i64::MAX];
    let formulas = Function::all().map(|function| (function.name, function.formula, function.inputs.len()));
    let mut told = 0;
    for (name, formula, inputs) in formulas.chain([("copy", Formula::COPY, 1)]) {
        let Some(kernel) = formula.kernel else { continue };
        for (left, right) in ENDS.into_iter().flat_map(|left| ENDS.map(|right| (left, right))) {
            let values = [left, right].map(|value| Datum::Whole(value.into()));
            let asked = Inputs {
                values: &values[..inputs],
                kinds: &[ElementaryType::Lint; 2][..inputs],
                result: ElementaryType::Lint,
            };
            let long = formula.apply(&asked);
            if let Some(short) = kernel(left, right) {
                assert_eq!(long, Ok(Datum::Whole(short.into())), "{name} {left} {right}");
                told += 1;
            } else {
                let is_less = |datum: &Datum| i64::try_from(datum.whole()).is_ok();
                let is_zero = name == "MOD" && long == Ok(Datum::Whole(0));
                assert!(is_zero || !long.as_ref().is_ok_and(is_less), "{name} {left} {right}: {long:?}");
            }
        }
    }
    assert!(told > 2_000, "{told}");
}
