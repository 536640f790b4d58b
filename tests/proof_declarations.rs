//! Programs that are written alike and declare something in another way are not the same, and programs that only write
//! it in another way are.

use crate::binary::{folder, run};
use crate::proof_values::word;
use crate::proof_verdicts;
use rungwise::document::{Document, Notation};
use rungwise::scenario::shown;
use rungwise::target::{Model, Target};
use rungwise::translate::prove;

fn iec(text: &str) -> Document {
    Document::new(text, Notation::IecIl, Target::of(Model::Iec))
}

/// A program `p` with these variables; instructions are separated by semicolons.
fn program(types: &str, variables: &str, body: &str) -> Document {
    let body = body.replace(';', "\n");
    iec(&format!("{types}\nPROGRAM p\nVAR\n{variables} y : BOOL;\nEND_VAR\n{body}\nEND_PROGRAM\n"))
}

#[test]
fn numbers_of_the_fx_family_have_a_sign() {
    let fx = |body: &str| {
        let text = format!("{}\nEND\n", body.replace(';', "\n"));
        Document::new(&text, Notation::FxIl, Target::of(Model::Fx3u))
    };
    let y = "y AT %QX0.0 : BOOL;";
    for kind in ["INT", "UINT", "WORD", "SINT", "USINT", "DINT", "REAL"] {
        let expected = if kind == "INT" { "equal" } else { "undecided" };
        let words = format!("a AT %MW1000 : {kind}; b AT %MW1001 : {kind}; c AT %MW1002 : {kind};");
        let bits = format!("{words} x AT %IX0.0 : BOOL; {y}");
        let compared = iec(&format!("PROGRAM p\nVAR {bits} END_VAR\nLD a\nGT b\nST y\nEND_PROGRAM\n"));
        assert_eq!(word(&fx("LD> D0 D1;OUT Y0"), &compared), expected, "{kind}");
        let body = "LD x\nJMPCN over\nLD a\nADD b\nST c\nover:\nLD x\nST y\n";
        let added = iec(&format!("PROGRAM p\nVAR {bits} END_VAR\n{body}END_PROGRAM\n"));
        assert_eq!(word(&fx("LD X0;ADD D0 D1 D2;LD X0;OUT Y0"), &added), expected, "{kind}");
    }
    for kind in ["DINT", "UDINT", "DWORD"] {
        let expected = if kind == "DINT" { "equal" } else { "undecided" };
        let words = format!("a AT %MD500 : {kind}; b AT %MD501 : {kind};");
        let compared = iec(&format!("PROGRAM p\nVAR {words} {y} END_VAR\nLD a\nLT b\nST y\nEND_PROGRAM\n"));
        assert_eq!(word(&fx("LDD< D0 D2;OUT Y0"), &compared), expected, "{kind}");
    }
}

#[test]
fn words_at_one_address_are_of_one_type() {
    for (types, right, expected) in [
        (["INT", "INT"], "GT", "equal"),
        (["INT", "UINT"], "GT", "undecided"),
        (["INT", "UINT"], "DIV", "undecided"),
        (["INT(0..9)", "INT(0..10)"], "GT", "undecided"),
        (["INT(0..9)", "int (0 .. 9)"], "GT", "equal"),
    ] {
        let [left, right] = [("a", "b", types[0]), ("c", "d", types[1])].map(|(one, other, kind)| {
            let variables = format!("{one} AT %MW0 : {kind}; {other} AT %MW2 : {kind};");
            let end = if right == "DIV" { format!("ST {one}") } else { "ST y".to_string() };
            program("", &variables, &format!("LD {one};{right} {other};{end}"))
        });
        assert_eq!(word(&left, &right), expected, "{types:?}");
    }
}

#[test]
fn types_of_one_name_say_the_same() {
    for (left, right, body, expected) in [
        ("e : (red, green);", "e : (green, red);", "LD v;GT green;ST y", "undecided"),
        (
            "e : STRUCT a : INT; END_STRUCT;",
            "e : STRUCT a : UINT; END_STRUCT;",
            "LD v.a;GT 5;ST y",
            "undecided",
        ),
        ("e : INT(0..9);", "e : INT(0..10);", "LD v;GT w;ST y", "undecided"),
        ("e : INT;", "e : UINT;", "LD v;GT w;ST y", "undecided"),
        ("e : INT := 5;", "e : INT := 6;", "LD v;GT w;ST y", "undecided"),
        ("e : f; f : INT;", "e : f; f : UINT;", "LD v;GT w;ST y", "undecided"),
        ("e : INT;", "E : int; (* a number *)", "LD v;GT w;ST y", "equal"),
        ("e : TIME := T#1s;", "e : TIME := T#1000ms;", "LD v;GT w;ST y", "equal"),
    ] {
        let [left, right] =
            [left, right].map(|types| program(&format!("TYPE {types} END_TYPE"), "v : e; w : e;", body));
        assert_eq!(word(&left, &right), expected, "{}", right.text());
    }
}

#[test]
fn variables_are_looked_for_in_the_units_that_correspond() {
    let unit = |name: &str, variables: &str, body: &str| {
        format!(
            "PROGRAM {name}\nVAR {variables} y : BOOL; END_VAR\n{}\nEND_PROGRAM\n",
            body.replace(';', "\n")
        )
    };
    let body = "LD a;GT b;ST y";
    let own = unit("p", "a : INT; b : INT;", body);
    for (other, expected) in [
        (unit("q", "a : INT; b : INT;", body), "equal"),
        (unit("q", "a : UINT; b : UINT;", body), "undecided"),
        (unit("q", "a : INT := 5; b : INT;", body), "undecided"),
        (own.replace("PROGRAM", "FUNCTION_BLOCK"), "undecided"),
        (format!("VAR_GLOBAL a : INT; END_VAR\n{}", unit("p", "b : INT;", body)), "undecided"),
        (unit("p", "b : INT;", body), "undecided"),
        (format!("VAR_GLOBAL a : INT; END_VAR\n{own}"), "equal"),
    ] {
        assert_eq!(word(&iec(&own), &iec(&other)), expected, "{other}");
    }
    let global = |kind: &str| {
        let external =
            "PROGRAM p\nVAR_EXTERNAL g : INT; END_VAR\nVAR y : BOOL; END_VAR\nLD g\nGT 5\nST y\nEND_PROGRAM";
        iec(&format!("VAR_GLOBAL g {kind}; END_VAR\n{external}\n"))
    };
    assert_eq!(word(&global(": INT"), &global(": INT")), "equal");
    assert_eq!(word(&global(": INT"), &global(": UINT")), "undecided");
    assert_eq!(word(&global("AT %MW0 : INT"), &global("AT %MW1 : INT")), "undecided");
}

/// What runs when, and what it is connected to, is as much of a program as its rungs.
#[test]
fn what_a_configuration_runs_counts() {
    let program = "PROGRAM P\nVAR_INPUT go : BOOL; END_VAR\nVAR_OUTPUT lit : BOOL; END_VAR\nLD go\nST lit\nEND_PROGRAM\n";
    let configured = |task: &str, connected: &str| {
        format!(
            "{program}CONFIGURATION C\nRESOURCE R ON X\nTASK t({task}, PRIORITY := 1);\n\
             PROGRAM p1 WITH t : P(go := %IX0.0, lit => {connected});\nEND_RESOURCE\nEND_CONFIGURATION\n"
        )
    };
    let own = configured("INTERVAL := T#10ms", "%QX0.0");
    for (other, expected) in [
        (configured("INTERVAL := T#10ms", "%QX0.0"), "equal"),
        (configured("INTERVAL := T#10ms", "%QX0.1"), "not decided"),
        // Running both shows that one does not look at its inputs so soon.
        (configured("INTERVAL := T#10s", "%QX0.0"), "different: go (a.il, b.il)"),
    ] {
        let folder = folder(&[("a.il", &own), ("b.il", &other)]);
        let (_, out, err) = run(&folder, &["prove", "a.il", "b.il"]);
        assert!(out.starts_with(expected), "{other}: {out}{err}");
    }
}

/// One that only one side has decides as well which programs run, and in which order.
#[test]
fn a_configuration_of_one_side_counts() {
    let program = "PROGRAM P\nVAR x AT %IX0.0 : BOOL; y AT %QX0.0 : BOOL; END_VAR\nLD x\nST y\nEND_PROGRAM\n";
    let configured = format!(
        "{program}CONFIGURATION C\nRESOURCE R ON X\nTASK t(INTERVAL := T#10s, PRIORITY := 1);\n\
         PROGRAM p1 WITH t : P;\nEND_RESOURCE\nEND_CONFIGURATION\n"
    );
    assert_eq!(word(&iec(program), &iec(&configured)), "undecided");
}

/// A constant has one value, and what is made anew in each call is nothing that lasts.
#[test]
fn what_never_changes_or_never_lasts_is_no_difference() {
    let shown_word = |left: &Document, right: &Document| {
        let names = ["left", "right"].map(String::from);
        proof_verdicts::word(&shown(prove(left, right), [left, right], &names))
    };
    let text = |sections: &str, body: &str| {
        let body = body.replace(';', "\n");
        iec(&format!(
            "PROGRAM p\nVAR x : INT; b : BOOL; q : BOOL; END_VAR\n{sections}\n{body}\nEND_PROGRAM\n"
        ))
    };
    let constant = "VAR CONSTANT k : INT := 5; END_VAR";
    let temporary = "VAR_TEMP t : BOOL; END_VAR";
    for (section, left, right, expected) in [
        (constant, "LD x;GE k;ST q", "LD x;GE 5;ST q", "undecided"),
        (constant, "LD x;GE k;ST q", "LD x;GE 6;ST q", "different"),
        (temporary, "LD b;ST t;LD t;ST q", "LD b;STN t;LDN t;ST q", "equal"),
        (temporary, "LD b;ST t;LD t;ST q", "LD b;STN t;LD t;ST q", "different"),
    ] {
        assert_eq!(shown_word(&text(section, left), &text(section, right)), expected, "{left} | {right}");
    }
}

#[test]
fn what_a_configuration_sets_counts() {
    let text = |set: &str| {
        iec(&format!(
            "PROGRAM p\nVAR a : BOOL; y : BOOL; END_VAR\nLD a\nST y\nEND_PROGRAM\nCONFIGURATION c\nRESOURCE r ON x\n\
             TASK t(INTERVAL := T#10ms, PRIORITY := 1);\nPROGRAM i WITH t : p;\nEND_RESOURCE\n{set}\nEND_CONFIGURATION\n"
        ))
    };
    let set = |value: &str| text(&format!("VAR_CONFIG r.i.a : BOOL := {value}; END_VAR"));
    assert_eq!(word(&set("TRUE"), &set("true")), "equal");
    assert_eq!(word(&set("TRUE"), &set("FALSE")), "undecided");
    assert_eq!(word(&set("TRUE"), &text("")), "undecided");
}

/// Two projects of a program and a file of declarations.
#[test]
fn declarations_in_other_files_count() {
    let body = "PROGRAM p\nVAR_EXTERNAL\n g : INT;\n v : Level;\nEND_VAR\nVAR\n y : BOOL;\nEND_VAR\n\
                LD v\nGT g\nST y\nEND_PROGRAM\n";
    let declared = |words: &str| {
        format!(
            "{words}\nCONFIGURATION c\nRESOURCE r ON x\nTASK t(INTERVAL := T#10ms, PRIORITY := 1);\nPROGRAM i WITH t : p;\nEND_RESOURCE\nEND_CONFIGURATION\n"
        )
    };
    let plain = "TYPE\n Level : INT(0..9);\nEND_TYPE\nVAR_GLOBAL\n g : INT;\n v : Level;\nEND_VAR";
    for (other, expected) in [
        (plain.to_string(), "equal"),
        (plain.replace("0..9", "0..10"), "not decided"),
        (plain.replace("g : INT", "g : INT := 5"), "not decided"),
        (format!("{plain}\nVAR_GLOBAL\n h : INT;\nEND_VAR"), "equal"),
    ] {
        let folder = folder(&[
            ("a/rungwise.toml", "target = \"iec\"\n"),
            ("a/main.il", body),
            ("a/declared.il", &declared(plain)),
            ("b/rungwise.toml", "target = \"iec\"\n"),
            ("b/main.il", body),
            ("b/declared.il", &declared(&other)),
        ]);
        let (_, found, _) = run(&folder, &["prove", "a/main.il", "b/main.il", "--lang", "en"]);
        assert!(found.starts_with(expected), "{found}");
    }
}
