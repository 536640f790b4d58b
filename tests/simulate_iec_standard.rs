//! Parts of IEC 61131-3 that are more than operators: EN and ENO, subranges, configurations, located arrays.

use crate::binary::{folder, run};
use crate::simulate_iec::{Plc, result};
use rungwise::simulate::ErrorKind;
use rungwise::target::Fault;

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
