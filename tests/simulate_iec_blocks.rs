//! The standard function blocks call by call, and the standard functions case by case.

use crate::simulate_iec::{Plc, result};
use rungwise::simulate::ErrorKind;
use rungwise::target::Fault;

const MS: i64 = 1_000_000;

/// A block whose pins are variables of the same names: what it shows after calls with these inputs.
///
/// A call is written `IN=1 PT=T#1s @20`: inputs that change, and the time in milliseconds.
fn calls(block: &str, outputs: &[&str], calls: &[(&str, &[&str])]) {
    let row = rungwise::target::iec::FunctionBlock::named(block).expect("a block");
    let mut declared = String::new();
    let mut given = Vec::new();
    for input in row.inputs {
        declared += &format!("i_{} : {};\n", input.name, input.kind.name());
        given.push(format!("{} := i_{}", input.name, input.name));
    }
    let text = format!(
        "PROGRAM Main\nVAR\n{declared}it : {block};\nEND_VAR\nCAL it(\n{}\n)\nEND_PROGRAM\n",
        given.join(",\n")
    );
    let mut plc = Plc::new(&text);
    for (number, (call, expected)) in calls.iter().enumerate() {
        let mut time = number as i64 * 10 * MS;
        for word in call.split_whitespace() {
            match (word.split_once('='), word.strip_prefix('@')) {
                (Some((pin, value)), _) => _ = plc.set(&format!("i_{pin}"), value),
                (None, Some(ms)) => time = ms.parse::<i64>().expect("a time") * MS,
                _ => panic!("{word}"),
            }
        }
        plc.scan_at(time);
        let shown: Vec<String> = outputs.iter().map(|pin| plc.get(&format!("it.{pin}"))).collect();
        assert_eq!(shown, *expected, "{block}, call {number}: {call}");
    }
}

#[test]
fn bistables_and_edges() {
    calls(
        "SR",
        &["Q1"],
        &[("", &["0"]), ("S1=1", &["1"]), ("S1=1 R=1", &["1"]), ("S1=0 R=0", &["1"]), ("R=1", &["0"])],
    );
    calls(
        "RS",
        &["Q1"],
        &[("S=1", &["1"]), ("S=1 R1=1", &["0"]), ("R1=0 S=0", &["0"]), ("S=1", &["1"]), ("S=0", &["1"])],
    );
    calls("R_TRIG", &["Q"], &[("CLK=1", &["1"]), ("", &["0"]), ("CLK=0", &["0"]), ("CLK=1", &["1"])]);
    // Its memory begins at 0, so a signal that is off at first is an edge.
    calls(
        "F_TRIG",
        &["Q"],
        &[("", &["1"]), ("", &["0"]), ("CLK=1", &["0"]), ("CLK=0", &["1"]), ("", &["0"])],
    );
    calls(
        "SEMA",
        &["BUSY"],
        &[
            ("CLAIM=1", &["0"]),
            ("", &["1"]),
            ("CLAIM=0", &["1"]),
            ("RELEASE=1", &["0"]),
            ("RELEASE=0 CLAIM=1", &["0"]),
        ],
    );
}

#[test]
fn counters() {
    calls(
        "CTU",
        &["Q", "CV"],
        &[
            ("PV=2", &["0", "0"]),
            ("CU=1", &["0", "1"]),
            ("", &["0", "1"]),
            ("CU=0", &["0", "1"]),
            ("CU=1", &["1", "2"]),
            ("CU=0", &["1", "2"]),
            // Counting goes on past the preset.
            ("CU=1", &["1", "3"]),
            ("R=1", &["0", "0"]),
            ("CU=0 R=0 PV=0", &["1", "0"]),
            // A reset hides the edge.
            ("CU=1 R=1 PV=1", &["0", "0"]),
            ("R=0", &["0", "0"]),
        ],
    );
    calls(
        "CTD",
        &["Q", "CV"],
        &[
            ("PV=2", &["1", "0"]),
            ("LD=1", &["0", "2"]),
            ("LD=0 CD=1", &["0", "1"]),
            ("CD=0", &["0", "1"]),
            ("CD=1", &["1", "0"]),
            ("CD=0", &["1", "0"]),
            ("CD=1", &["1", "-1"]),
        ],
    );
    calls(
        "CTUD",
        &["QU", "QD", "CV"],
        &[
            ("PV=1", &["0", "1", "0"]),
            ("CU=1", &["1", "0", "1"]),
            ("CU=0 CD=1", &["0", "1", "0"]),
            ("CD=0", &["0", "1", "0"]),
            // Both at once change nothing.
            ("CU=1 CD=1", &["0", "1", "0"]),
            ("CU=0 CD=0 LD=1 PV=5", &["1", "0", "5"]),
            ("R=1", &["0", "1", "0"]),
        ],
    );
    calls("CTU_UDINT", &["CV"], &[("CU=1", &["1"])]);
    calls("CTU", &["CV"], &[("CU=0", &["0"])]);
}

#[test]
fn counters_end_where_their_type_does() {
    let text = "PROGRAM Main\nVAR\nx : BOOL;\nu : CTU;\nd : CTD;\nn : CTD_UDINT;\nEND_VAR\nCAL u(\nCU := x\n)\nCAL d(\nCD := x\n)\n\
                CAL n(\nCD := x\n)\nEND_PROGRAM\n";
    let mut plc = Plc::new(text);
    plc.set("u.CV", "32767").set("d.CV", "-32768").scan();
    plc.set("x", "1").scan();
    assert_eq!(
        (plc.get("u.CV"), plc.get("d.CV"), plc.get("n.CV")),
        ("32767".into(), "-32768".into(), "0".into())
    );
}

#[test]
fn timers() {
    calls(
        "TON",
        &["Q", "ET"],
        &[
            ("PT=T#100ms @0", &["0", "T#0s"]),
            ("IN=1 @10", &["0", "T#0s"]),
            ("@60", &["0", "T#50ms"]),
            ("@110", &["1", "T#100ms"]),
            ("@500", &["1", "T#100ms"]),
            ("IN=0 @510", &["0", "T#0s"]),
            ("IN=1 @520", &["0", "T#0s"]),
            // A preset that is lowered ends the delay.
            ("PT=T#20ms @550", &["1", "T#20ms"]),
            // What is over stays over.
            ("PT=T#1h @560", &["1", "T#20ms"]),
        ],
    );
    // An input that is on at the first call starts the time there; a preset of 0 takes one more call.
    calls("TON", &["Q", "ET"], &[("IN=1 @0", &["0", "T#0s"]), ("@1", &["1", "T#0s"])]);
    calls(
        "TOF",
        &["Q", "ET"],
        &[
            ("PT=T#100ms @0", &["0", "T#0s"]),
            ("IN=1 @10", &["1", "T#0s"]),
            ("IN=0 @20", &["1", "T#0s"]),
            ("@70", &["1", "T#50ms"]),
            ("IN=1 @80", &["1", "T#0s"]),
            ("IN=0 @90", &["1", "T#0s"]),
            ("@189", &["1", "T#99ms"]),
            ("@190", &["0", "T#100ms"]),
            ("@900", &["0", "T#100ms"]),
            ("IN=1 @910", &["1", "T#0s"]),
        ],
    );
    // Of each timer PT is read in each call while time passes, and no longer when it is over.
    calls(
        "TOF",
        &["Q", "ET"],
        &[
            ("PT=T#100ms IN=1 @0", &["1", "T#0s"]),
            ("IN=0 @20", &["1", "T#0s"]),
            ("PT=T#200ms @150", &["1", "T#130ms"]),
            ("@219", &["1", "T#199ms"]),
            ("PT=T#150ms @220", &["0", "T#150ms"]),
            ("PT=T#1h @230", &["0", "T#150ms"]),
            ("IN=1 @240", &["1", "T#0s"]),
        ],
    );
    calls(
        "TP",
        &["Q", "ET"],
        &[
            ("PT=T#100ms @0", &["0", "T#0s"]),
            ("IN=1 @10", &["1", "T#0s"]),
            ("PT=T#300ms @150", &["1", "T#140ms"]),
            ("PT=T#20ms @160", &["0", "T#20ms"]),
            ("PT=T#1h @170", &["0", "T#20ms"]),
            ("IN=0 @180", &["0", "T#0s"]),
        ],
    );
    calls("TOF", &["Q"], &[("IN=1 @0", &["1"]), ("IN=0 @10", &["1"]), ("@20", &["0"])]);
    calls(
        "TP",
        &["Q", "ET"],
        &[
            ("PT=T#100ms @0", &["0", "T#0s"]),
            ("IN=1 @10", &["1", "T#0s"]),
            ("IN=0 @20", &["1", "T#10ms"]),
            // Another edge does not prolong the pulse.
            ("IN=1 @30", &["1", "T#20ms"]),
            ("@110", &["0", "T#100ms"]),
            ("@120", &["0", "T#100ms"]),
            ("IN=0 @130", &["0", "T#0s"]),
            ("IN=1 @140", &["1", "T#0s"]),
        ],
    );
    calls("TP", &["Q"], &[("IN=1 @0", &["1"]), ("@10", &["0"])]);
    calls(
        "RTC",
        &["Q", "CDT"],
        &[
            ("PDT=DT#2024-02-28-23:59:59 @0", &["0", "DT#0001-01-01-00:00:00"]),
            ("IN=1 @10", &["1", "DT#2024-02-28-23:59:59"]),
            ("PDT=DT#2000-01-01-00:00:00 @1510", &["1", "DT#2024-02-29-00:00:00.5"]),
            ("IN=0 @2000", &["0", "DT#2024-02-29-00:00:00.5"]),
        ],
    );
}

/// What a body stores in `x`, or what went wrong in it.
fn outcome(kind: &str, body: &str) -> String {
    let text = format!("PROGRAM Main\nVAR\nx : {kind};\nEND_VAR\n{body}\nST x\nEND_PROGRAM\n");
    let mut plc = Plc::new(&text);
    plc.scan();
    match plc.errors[..] {
        [] => plc.get("x"),
        [ErrorKind::Calculation(fault)] => format!("{fault:?} {}", plc.get("x")),
        ref other => format!("{other:?}"),
    }
}

#[test]
fn numeric_functions() {
    for (kind, body, expected) in [
        ("INT", "LD -5\nABS", "5"),
        ("INT", "LD INT#-32768\nABS", "Overflow -32768"),
        ("REAL", "LD 6.25\nSQRT", "2.5"),
        ("REAL", "LD -1.0\nSQRT", "Value(0) 0.0"),
        ("LREAL", "LD 1.0\nLN", "0.0"),
        ("LREAL", "LD 0.0\nLN", "Value(0) 0.0"),
        ("LREAL", "LD 1000.0\nLOG", "3.0"),
        ("REAL", "LD REAL#100.0\nEXP", "Overflow Infinity"),
        ("LREAL", "LD 0.0\nCOS", "1.0"),
        ("LREAL", "LD 2.0\nASIN", "Value(0) 0.0"),
        ("LREAL", "LD 0.0\nATAN2 1.0", "0.0"),
        ("LREAL", "LD 2.0\nEXPT 10", "1024.0"),
        ("LREAL", "LD -8.0\nEXPT 0.5", "Value(0) 0.0"),
        ("INT", "LD 1\nADD 2, 3", "6"),
        ("USINT", "LD USINT#200\nADD USINT#100", "Overflow 44"),
        ("UINT", "LD UINT#0\nSUB 1", "Overflow 65535"),
        ("ULINT", "LD ULINT#18446744073709551615\nSUB 1", "18446744073709551614"),
        ("LINT", "LD LINT#-9223372036854775808\nDIV -1", "Overflow -9223372036854775808"),
        ("INT", "LD 5\nDIV 0", "DivisionByZero 0"),
        ("REAL", "LD 5.0\nDIV 0.0", "DivisionByZero 0.0"),
        ("REAL", "LD 1.0\nDIV 3.0", "0.33333334"),
        ("DINT", "LD DINT#100000\nMUL 3", "300000"),
        ("TIME", "LD T#1s\nMUL 2.5", "T#2s500ms"),
        ("TIME", "LD T#1s\nDIV 4", "T#250ms"),
        ("TIME", "LD T#1s\nDIV_TIME 0", "DivisionByZero T#0s"),
        ("TIME", "LD D#2024-03-01\nSUB D#2024-02-28", "T#2d"),
        ("TOD", "LD TOD#23:00:00\nADD T#2h", "Overflow TOD#01:00:00"),
        ("DT", "LD DT#2024-12-31-23:00:00\nADD_DT_TIME T#2h", "DT#2025-01-01-01:00:00"),
        ("DT", "LD D#2024-01-31\nCONCAT_DATE_TOD TOD#12:30:00", "DT#2024-01-31-12:30:00"),
    ] {
        assert_eq!(outcome(kind, body), expected, "{body}");
    }
}

#[test]
fn bit_and_selection_functions() {
    for (kind, body, expected) in [
        ("BYTE", "LD BYTE#16#81\nSHL 1", "2"),
        ("BYTE", "LD BYTE#16#81\nSHL 8", "0"),
        ("BYTE", "LD BYTE#16#81\nSHR 1", "64"),
        ("BYTE", "LD BYTE#16#81\nROL 1", "3"),
        ("BYTE", "LD BYTE#16#81\nROR 9", "192"),
        ("BYTE", "LD BYTE#16#81\nSHL -1", "Value(1) 0"),
        ("LWORD", "LD LWORD#16#8000000000000001\nROL 1", "3"),
        ("WORD", "LD WORD#16#F0\nXOR 16#FF, 16#1", "14"),
        ("INT", "LD TRUE\nSEL 1, 2", "2"),
        ("INT", "LD FALSE\nSEL 1, 2", "1"),
        ("INT", "LD 2\nMUX 10, 20, 30", "30"),
        ("INT", "LD 3\nMUX 10, 20, 30", "Value(0) 0"),
        ("INT", "LD -1\nMUX 10, 20, 30", "Value(0) 0"),
        ("INT", "LD 3\nMAX 5, 4", "5"),
        ("INT", "LD 3\nMIN 5, 4", "3"),
        ("INT", "LIMIT(\nMN := 0,\nIN := 12,\nMX := 10\n)", "10"),
        ("INT", "LIMIT(\nMN := 5,\nIN := 7,\nMX := 3\n)", "3"),
        ("BOOL", "LD 3\nGT 2, 1", "1"),
        ("BOOL", "LD 3\nGT 2, 2", "0"),
        ("BOOL", "LD 'abc'\nLT 'abd'", "1"),
        ("BOOL", "LD 3\nNE 3", "0"),
    ] {
        assert_eq!(outcome(kind, body), expected, "{body}");
    }
}

#[test]
fn text_functions() {
    for (kind, body, expected) in [
        ("INT", "LD 'A-4711'\nLEN", "6"),
        ("STRING", "LD 'A-4711'\nRIGHT 4", "'4711'"),
        ("STRING", "LD 'A-4711'\nRIGHT 40", "'A-4711'"),
        ("STRING", "LD 'A-4711'\nLEFT -1", "Value(1) ''"),
        ("STRING", "LD 'A-4711'\nMID 2, 3", "'47'"),
        ("STRING", "LD '20240131'\nINSERT '-', 4", "'2024-0131'"),
        ("STRING", "LD 'A-4711'\nDELETE 1, 2", "'A4711'"),
        ("STRING", "LD 'Pump off'\nREPLACE 'on', 3, 6", "'Pump on'"),
        ("INT", "LD 'OK 42'\nFIND '42'", "4"),
        ("INT", "LD 'OK 42'\nFIND 'x'", "0"),
        ("STRING", "LD 'a$'b$41'", "'a$'bA'"),
    ] {
        assert_eq!(outcome(kind, body), expected, "{body}");
    }
}

#[test]
fn conversions() {
    for (kind, body, expected) in [
        ("INT", "LD 2.5\nREAL_TO_INT", "2"),
        ("INT", "LD 3.5\nREAL_TO_INT", "4"),
        ("INT", "LD -3.5\nREAL_TO_INT", "-4"),
        ("INT", "LD -1.9\nTRUNC", "-1"),
        ("INT", "LD 1.9\nREAL_TRUNC_INT", "1"),
        ("INT", "LD 40000.0\nREAL_TO_INT", "Overflow -25536"),
        ("SINT", "LD INT#200\nINT_TO_SINT", "Overflow -56"),
        ("INT", "LD WORD#16#FFFF\nWORD_TO_INT", "-1"),
        ("DWORD", "LD INT#-1\nINT_TO_DWORD", "4294967295"),
        ("BYTE", "LD WORD#16#1234\nWORD_TO_BYTE", "52"),
        ("BOOL", "LD 2\nINT_TO_BOOL", "1"),
        ("INT", "LD TRUE\nBOOL_TO_INT", "1"),
        ("REAL", "LD 5\nINT_TO_REAL", "5.0"),
        ("DINT", "LD T#1500ms\nTIME_TO_DINT", "1500"),
        ("TIME", "LD DINT#1500\nDINT_TO_TIME", "T#1s500ms"),
        ("UINT", "LD WORD#16#1234\nWORD_BCD_TO_UINT", "1234"),
        ("UINT", "LD WORD#16#123A\nWORD_BCD_TO_UINT", "Value(0) 0"),
        ("WORD", "LD UINT#1234\nUINT_TO_BCD_WORD", "4660"),
        ("BYTE", "LD UINT#100\nUINT_TO_BCD_BYTE", "Value(0) 0"),
        ("STRING", "LD T#90s\nTIME_TO_STRING", "'T#1m30s'"),
        ("STRING", "LD WORD#16#AF\nWORD_TO_STRING", "'16#AF'"),
        ("STRING", "LD D#2024-02-29\nDATE_TO_STRING", "'D#2024-02-29'"),
        ("INT", "LD ' 42 '\nSTRING_TO_INT", "42"),
        ("INT", "LD 'x'\nSTRING_TO_INT", "Value(0) 0"),
        ("DATE", "LD DT#2024-02-29-12:00:00\nDT_TO_DATE", "D#2024-02-29"),
        ("TOD", "LD DT#2024-02-29-12:00:00\nDT_TO_TOD", "TOD#12:00:00"),
        ("REAL", "LD INT#7\nTO_REAL", "7.0"),
    ] {
        assert_eq!(outcome(kind, body), expected, "{body}");
    }
    assert_eq!(Fault::Index.code(), 6706);
    assert_eq!(result("x : DATE;", "LD x\nST x", "x"), "D#0001-01-01");
}
