//! What two programs may not be taken for equal over: names of one place in memory, parts of a program that are jumped
//! over or left out, other program units, and the order of what a call is handed over. Each pair does different things
//! in some scan.

use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::translate::{Proof, To, Value, prove, translate};

fn list(text: &str) -> Document {
    Document::new(text, Notation::IecIl, Target::of(Model::Iec))
}

fn fx(text: &str) -> Document {
    Document::new(text, Notation::FxIl, Target::of(Model::Fx3u))
}

/// A program with these variables and this body.
fn program(variables: &str, body: &str) -> Document {
    list(&format!("PROGRAM Test\nVAR\na, b, c, x, y, z : BOOL; {variables}\nEND_VAR\n{body}\nEND_PROGRAM\n"))
}

/// Lines are separated by semicolons.
fn lines(text: &str) -> String {
    text.replace("; ", "\n")
}

fn is_equal(left: &Document, right: &Document) -> bool {
    matches!(prove(left, right), Proof::Equal { .. })
}

/// Programs with these variables are not equal, while either is equal to itself.
fn tells_apart(variables: &str, left: &str, right: &str) {
    let [left, right] = [left, right].map(|body| program(variables, &lines(body)));
    assert!(!is_equal(&left, &right), "{}\n--\n{}", left.text(), right.text());
    assert!(is_equal(&left, &left) && is_equal(&right, &right), "{}", left.text());
}

#[test]
fn two_names_of_one_address_are_one_bit() {
    let swapped = ["LD a; ST v; LD w; ST y", "LD w; ST y; LD a; ST v"];
    for other in ["%QX0.0", "%Q0.0"] {
        let variables = format!("v AT %QX0.0 : BOOL; w AT {other} : BOOL;");
        tells_apart(&variables, swapped[0], swapped[1]);
    }
    tells_apart("v AT %QX0.0 : BOOL;", "LD a; ST v; LD %QX0.0; ST y", "LD %QX0.0; ST y; LD a; ST v");
    // In places of their own they are two, and one name may stand for the other.
    let apart = "v AT %QX0.0 : BOOL; w AT %QX0.1 : BOOL;";
    let [left, right] = swapped.map(|body| program(apart, &lines(body)));
    assert!(is_equal(&left, &right));
    let one = "v AT %QX0.0 : BOOL; w AT %QX0.0 : BOOL;";
    let [left, right] = ["LD a; ST v; LD v; ST y", "LD a; ST w; LD v; ST y"].map(|b| program(one, &lines(b)));
    assert!(is_equal(&left, &right));
}

#[test]
fn one_name_of_two_addresses_is_two_bits() {
    let [left, right] = ["%QX0.0", "%QX0.1"].map(|at| program(&format!("v AT {at} : BOOL;"), "LD a\nST v"));
    assert!(!is_equal(&left, &right));
}

#[test]
fn words_are_made_of_the_bits_in_their_area() {
    let variables = "n AT %MW0 : INT; m AT %MX0.0 : BOOL;";
    tells_apart(
        variables,
        "LD a; ST m; LD n; GT 3; ST y; LD b; ST z",
        "LD b; ST z; LD n; GT 3; ST y; LD a; ST m",
    );
    // Words and double words of one area may lie over each other.
    let variables = "n AT %MW1010 : INT; d AT %MD505 : DINT;";
    tells_apart(variables, "LD 5; ST d; LD n; GT 3; ST y", "LD n; GT 3; ST y; LD 5; ST d");
    tells_apart(variables, "LD 5; ST n; LD d; GT 3; ST y", "LD d; GT 3; ST y; LD 5; ST n");
    // So values of both that do not fit are no counterexample.
    let [left, right] =
        ["LD n; EQ 1; AND( d; EQ 0; ); ST y", "LD FALSE; ST y"].map(|body| program(variables, &lines(body)));
    assert!(matches!(prove(&left, &right), Proof::Undecided { .. }), "{:?}", prove(&left, &right));
    let variables = "f AT %QX0.0 : ARRAY[0..7] OF BOOL; q AT %QX0.1 : BOOL;";
    tells_apart(variables, "LD a; ST f[1]; LD q; ST y", "LD q; ST y; LD a; ST f[1]");
    // And on the FX family.
    let [left, right] = [
        "LD X0; OUT M0; LD= K4M0 K1; OUT Y0; LD X1; OUT M1; END",
        "LD X1; OUT M1; LD= K4M0 K1; OUT Y0; LD X0; OUT M0; END",
    ]
    .map(|text| fx(&lines(text)));
    assert!(!is_equal(&left, &right));
    // What is in another place is no part of the word.
    let variables = "n : INT;";
    let [left, right] = ["LD a; ST y; LD n; GT 3; ST z", "LD n; GT 3; ST z; LD a; ST y"]
        .map(|b| program(variables, &lines(b)));
    assert!(is_equal(&left, &right));
}

#[test]
fn who_calls_may_hand_over_one_variable_twice() {
    let block = |body: &str| {
        let head = "FUNCTION_BLOCK F\nVAR_IN_OUT v, w : BOOL; END_VAR\nVAR a, y : BOOL; END_VAR\n";
        list(&format!("{head}{}\nEND_FUNCTION_BLOCK\n", lines(body)))
    };
    let [left, right] = ["LD a; ST v; LD w; ST y", "LD w; ST y; LD a; ST v"].map(block);
    assert!(!is_equal(&left, &right));
    assert!(is_equal(&left, &left));
}

#[test]
fn variables_of_other_units_are_others() {
    let units = |last: &str| {
        list(&format!(
            "FUNCTION_BLOCK F\nVAR_INPUT x : BOOL; END_VAR\nVAR a : BOOL; END_VAR\nLD x\nST a\nEND_FUNCTION_BLOCK\n\
             PROGRAM P\nVAR x, a, y : BOOL; END_VAR\nLD {last}\nST y\nEND_PROGRAM\n"
        ))
    };
    assert!(!is_equal(&units("a"), &units("x")));
    assert!(is_equal(&units("a"), &units("a")));
}

#[test]
fn what_is_jumped_over_is_not_done() {
    tells_apart(
        "",
        "LD b; ST y; LD a; JMPC L; LD c; ST x; L:; LD a; ST z",
        "LD a; JMPC L; LD b; ST y; LD c; ST x; L:; LD a; ST z",
    );
    tells_apart("", "LD b; ST y; LD a; RETC; LD c; ST x", "LD a; RETC; LD b; ST y; LD c; ST x");
    let [left, right] = [
        "LD X0; CJ P0; LD X1; OUT M0; P0; LD M0; OUT Y0; END",
        "LD X0; CJ P0; LD X1; OUT M0; P0; LD X1; OUT Y0; END",
    ]
    .map(|text| fx(&lines(text)));
    assert!(!is_equal(&left, &right));
}

#[test]
fn without_power_at_the_rail_setting_is_not_driving() {
    let bodies = ["LD X0; SET Y0; LDI X0; RST Y0", "LD X0; OUT Y0"];
    let section = |body: &str| fx(&lines(&format!("LD X7; MC N0 M100; {body}; MCR N0; END")));
    let step = |body: &str| fx(&lines(&format!("STL S20; {body}; RET; END")));
    let plain = |body: &str| fx(&lines(&format!("{body}; END")));
    assert!(is_equal(&plain(bodies[0]), &plain(bodies[1])));
    assert!(!is_equal(&section(bodies[0]), &section(bodies[1])));
    assert!(!is_equal(&step(bodies[0]), &step(bodies[1])));
    // What does the same with and without power is still found.
    let order = ["LD X0; OUT Y0; LD X1; OUT Y1", "LD X1; OUT Y1; LD X0; OUT Y0"];
    assert!(is_equal(&section(order[0]), &section(order[1])));
}

#[test]
fn a_call_sees_what_was_stored_before_it() {
    let call = "CAL C1(; CU := b,; R := x,; PV := 3; )";
    tells_apart("C1 : CTU;", &format!("LD a; ST x; {call}"), &format!("{call}; LD a; ST x"));
    let other = "LD a; ST z";
    let [left, right] = [format!("{other}; {call}"), format!("{call}; {other}")]
        .map(|body| program("C1 : CTU;", &lines(&body)));
    assert!(is_equal(&left, &right));
}

#[test]
fn located_variables_keep_their_certificates_in_parts() {
    let text = "PROGRAM P\nVAR\nStart AT %IX0.0 : BOOL; Lamp AT %QX0.0 : BOOL;\nEND_VAR\nLD Start\nST Lamp\nEND_PROGRAM\n";
    let part = rungwise::text::Span::at(text.find("LD").unwrap());
    let devices = "LD X12\nOUT Y0\nEND\n";
    for (document, part) in [(list(text), part), (fx(devices), rungwise::text::Span::at(0))] {
        for to in [To::Ladder, To::Iec, To::Boolean, To::Fx] {
            let translation = translate(&document, Some(part), to, &Default::default());
            assert!(translation.is_certain() && !translation.rungs.is_empty(), "{to:?}\n{translation:#?}");
        }
    }
}

#[test]
fn a_counterexample_that_no_scan_confirms_is_none() {
    // The formulas know of a register only that MOV changed it, and of K4M0 only that M0 or M1 was driven.
    for (left, right) in [
        ("LD M8000; MOV K5 D0; LD= D0 K5; OUT Y0", "LD M8000; MOV K5 D0; LD M8000; OUT Y0"),
        (
            "LD X0; OUT M0; LD= K4M0 K1; OUT Y0; LD X1; OUT M1",
            "LD X1; OUT M1; LD= K4M0 K1; OUT Y0; LD X0; OUT M0",
        ),
    ] {
        let [left, right] = [left, right].map(|text| fx(&lines(text)));
        let Proof::Undecided { reason, .. } = prove(&left, &right) else {
            panic!("{:?}", prove(&left, &right))
        };
        assert_eq!(reason.key(), "prove.unconfirmed");
    }
}

#[test]
fn words_of_a_counterexample_are_numbers() {
    let cases = [
        ("LD>= D0 D1; AND> D1 K7; OUT Y0", "LD> D0 D1; AND> D1 K7; OUT Y0"),
        ("LD<= D0 K-3; OUT Y0", "LD< D0 K-3; OUT Y0"),
        ("LDD>= D0 K100000; OUT Y0", "LDD>= D0 K100001; OUT Y0"),
        ("LD X0; MOV K5 D0; LD> D0 K3; OUT Y0", "LD X0; MOV K5 D0; LD> D0 K7; OUT Y0"),
        ("LD X0; OUT T0 K5; LD T0; OUT Y0", "LD X0; OUT T0 K5; LDI T0; OUT Y0"),
        ("LDP X0; OUT M0; LDP M0; OUT Y0", "LDP X0; OUT M0; LDF M0; OUT Y0"),
    ];
    for (left, right) in cases {
        let [left, right] = [left, right].map(|text| fx(&lines(text)));
        let Proof::Different(found) = prove(&left, &right) else { panic!("{:?}", prove(&left, &right)) };
        assert!(found.what == "Y0" && found.sides[0] != found.sides[1], "{found:?}");
        if left.text().starts_with("LD>= D0 D1") {
            let word = |name: &str| match found.inputs.get(name) {
                Some(Value::Word(value)) => *value,
                other => panic!("{other:?}"),
            };
            assert!(word("D0") == word("D1") && word("D1") > 7, "{found:?}");
        }
    }
}

#[test]
fn a_counterexample_has_the_names_of_the_program() {
    let named = |left: &Document, right: &Document| {
        let Proof::Different(found) = prove(left, right) else { panic!("{}", left.text()) };
        found.inputs.into_keys().collect::<Vec<_>>()
    };
    let variables = "Start AT %IX0.0 : BOOL; Stop AT %IX0.1 : BOOL; Lamp AT %QX0.0 : BOOL;";
    let bodies = ["LD Start; AND Stop; ST Lamp", "LD Start; OR Stop; ST Lamp"];
    let [one, two] = bodies.map(|body| program(variables, &lines(body)));
    assert_eq!(named(&one, &two), ["Start", "Stop"]);
    let direct = program("", "LD %IX0.0\nAND %IX0.1\nST %QX0.0");
    assert_eq!(named(&direct, &two), ["%IX0.0", "%IX0.1"]);
    let devices = fx("LD X0\nAND X1\nOUT Y0\n");
    assert_eq!(named(&devices, &two), ["X0", "X1"]);
    // One name in two units for two places: the places tell them apart.
    let units = |join: &str| {
        let unit = |name: &str, at: &str, join: &str| {
            format!(
                "PROGRAM {name}\nVAR\nv AT %IX{at} : BOOL; w AT %IX2.0 : BOOL; y AT %QX{at} : BOOL;\nEND_VAR\n\
                 LD v\n{join} w\nST y\nEND_PROGRAM\n"
            )
        };
        list(&(unit("One", "0.0", "AND") + &unit("Two", "1.0", join)))
    };
    assert_eq!(named(&units("AND"), &units("OR")), ["v", "w"]);
}

#[test]
fn what_a_reference_leads_to_may_be_any_variable() {
    tells_apart("p : REF_TO BOOL;", "LD a; ST b; LD p^; ST x", "LD p^; ST x; LD a; ST b");
}

#[test]
fn what_blocks_and_calculations_make_of_their_inputs_is_no_difference() {
    for (variables, head, one, other) in [
        ("f : SR;", "CAL f(S1 := a, R := b); LD f.Q1", "", "OR a; "),
        ("f : RS;", "CAL f(S := b, R1 := a); LD f.Q1", "", "ANDN a; "),
        ("f : CTU;", "CAL f(CU := b, R := a, PV := 5); LD f.Q", "", "ANDN a; "),
        ("i, j : INT;", "LD i; ADD 1; ST j; LD j; GT i", "", "OR TRUE; "),
        ("i, j : INT;", "LD i; AND 16#F; ST j; LD j; GE 0", "", "OR TRUE; "),
        // Numbers beyond their types are none.
        ("i : INT;", "LD i; GT 32767", "", "AND FALSE; "),
        ("i : UINT;", "LD i; GE 0", "", "OR TRUE; "),
        // A word that is stored in itself keeps its bits.
        ("w : WORD;", "LD w; ST w; LD w.3", "", "OR w.3; "),
    ] {
        let [left, right] =
            [one, other].map(|more| program(variables, &lines(&format!("{head}; {more}ST x"))));
        for proof in [prove(&left, &right), prove(&right, &left)] {
            assert!(!matches!(proof, Proof::Different(_)), "{proof:?}\n{}", right.text());
        }
        // What they leave open makes one. Of numbers at the ends of their types the question is which is tried.
        if head.contains("32767") || head.contains("GE 0") {
            continue;
        }
        let other = program(variables, &lines(&format!("{head}; NOT; ST x")));
        assert!(matches!(prove(&left, &other), Proof::Different(_)), "{}", other.text());
    }
}
