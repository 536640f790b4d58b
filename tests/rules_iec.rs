//! Rules on IEC programs, where a page is too small: every example of the tables, applied fixes, programs of other
//! people, one diagnostic for one mistake.

use crate::rules_sense::without_sense;
use proptest::prelude::*;
use rungwise::check;
use rungwise::document::{Document, Notation};
use rungwise::target::iec::{Function, FunctionBlock, Operator};
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Language, Severity, TextEdit};

fn judged(text: &str) -> Vec<Diagnostic> {
    let document = Document::new(text, Notation::IecIl, Target::of(Model::Iec));
    check::all(&document, &without_sense())
}

/// `line:column code message` of everything found that is graver than a hint.
fn found(text: &str) -> Vec<String> {
    let document = Document::new(text, Notation::IecIl, Target::of(Model::Iec));
    let all = check::all(&document, &without_sense());
    all.iter()
        .filter(|one| one.severity != Severity::Hint)
        .map(|one| {
            let at = document.position(one.span.start as usize, rungwise::text::Encoding::Utf32);
            let message = one.message.render(Language::English);
            format!("{}:{} {}: {message}", at.line + 1, at.column + 1, one.code)
        })
        .collect()
}

/// Code and marked words of everything found that is graver than a hint.
fn told(text: &str) -> Vec<String> {
    let all = judged(text);
    let grave = all.iter().filter(|one| one.severity != Severity::Hint);
    grave.map(|one| format!("{}: {}", one.code, one.span.of(text))).collect()
}

/// The program of a page, or nothing.
fn example(page: &str) -> &str {
    page.split("```il\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap_or("")
}

#[test]
fn every_example_of_the_tables_is_clean() {
    let pages = Operator::all()
        .map(|row| (row.name, row.page()))
        .chain(Function::all().map(|row| (row.name, row.page())))
        .chain(FunctionBlock::all().map(|row| (row.name, row.page())));
    let mut wrong = Vec::new();
    let mut checked = 0;
    for (name, page) in pages {
        checked += 1;
        assert!(example(&page).contains("END_PROGRAM"), "{name} has no example");
        for one in found(example(&page)) {
            wrong.push(format!("{name} {one}\n{}", example(&page)));
        }
    }
    assert!(checked > 400, "only {checked} examples");
    assert!(wrong.is_empty(), "{} findings:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn mistakes_are_told_once() {
    let cases: &[(&str, &str, &[&str])] = &[
        // Current result.
        ("a : BOOL", "ST a", &["no-current-result: ST"]),
        ("a : BOOL", "NOT\nST a", &["no-current-result: NOT"]),
        ("a : BOOL", "LD a\nJMP x\nAND a\nST a\nx: LD a\nST a", &["no-current-result: AND"]),
        ("a : BOOL", "LD a\nJMP x\nx: ST a", &[]),
        ("a : BOOL", "JMP x\nx: ST a", &["no-current-result: ST"]),
        ("a : BOOL", "LD a\nRETC\nST a", &[]),
        ("a : BOOL", "LD a\nAND(\n)\nST a", &["no-current-result: )"]),
        ("a : BOOL", "LD a\nAND( a\nOR( a\nAND a\n)\n)\nST a", &[]),
        ("a : BOOL", "CALC t", &["no-current-result: CALC", "undeclared-variable: t"]),
        ("t : TON", "IN t", &["no-current-result: IN"]),
        ("i : INT", "ABS\nST i", &["no-current-result: ABS"]),
        // Types.
        ("a : BOOL; i : INT", "LD i\nST a", &["result-type-mismatch: a"]),
        ("i : INT; d : DINT", "LD i\nST d\nLD i\nADD d\nST d", &[]),
        ("i : INT; d : DINT", "LD i\nADD d\nST i", &["result-type-mismatch: i"]),
        ("r : REAL; i : INT", "LD r\nADD 2\nMUL i\nST r", &[]),
        ("r : REAL; d : DINT", "LD r\nADD d\nST r", &["result-type-mismatch: d"]),
        ("a : BOOL; i : INT", "LD a\nGT i\nST a", &["result-type-mismatch: i"]),
        ("a : BOOL; i : INT", "LD i\nGT 3\nAND i\nST a", &["operand-kind: i"]),
        ("a : BOOL; i : INT", "LD i\nAND a\nST a", &["result-type-mismatch: AND"]),
        ("a : BOOL; i : INT", "LD a\nAND(\nLD i\nGT 5\n)\nST a", &[]),
        ("a : BOOL; i : INT", "LD a\nAND(\nLD i\nADD 5\n)\nST a", &["operand-kind: AND"]),
        ("t : TIME; i : INT", "LD t\nMUL i\nADD T#5s\nST t", &[]),
        ("t : TIME; i : INT", "LD t\nADD i\nST t", &["result-type-mismatch: i"]),
        ("d : TOD; t : TIME", "LD d\nADD t\nST d\nLD d\nSUB d\nST t", &[]),
        ("a : BOOL", "LD 1\nST a\nLD 0\nAND TRUE\nST a", &[]),
        ("a : BOOL", "LD 2\nST a", &["result-type-mismatch: a"]),
        ("w : WORD", "LD 16#FF\nAND w\nST w\nLD w\nAND 16#1FFFF\nST w", &["constant-out-of-range: 16#1FFFF"]),
        ("b : BYTE; w : WORD", "LD w\nST b", &["result-type-mismatch: b"]),
        (
            "s : STRING; i : INT",
            "LD s\nLEN\nST i\nLD s\nLEFT 3\nST s\nLD s\nLEFT s\nST s",
            &["result-type-mismatch: s"],
        ),
        ("a : BOOL; i : INT", "LD a\nSEL 1, i\nST i\nLD i\nSEL 1, 2\nST i", &["result-type-mismatch: LD i"]),
        ("i : INT; r : REAL", "LD i\nMAX r\nST r", &[]),
        ("i : INT; u : UINT", "LD i\nMAX u\nST i", &["result-type-mismatch: u"]),
        ("i : INT", "LD i\nJMPC x\nx: LD i\nST i", &["result-type-mismatch: JMPC"]),
        ("i : INT", "LD i\nS i", &["operand-kind: i", "result-type-mismatch: S"]),
        ("f : SR; a : BOOL", "LD a\nS1 f\nLD a\nR f\nLD f.Q1\nST a", &[]),
        ("f : TON; a : BOOL", "LD a\nS f", &["operand-kind: f"]),
        ("f : TON; a : BOOL", "LD T#5s\nPT f\nLD a\nPT f", &["result-type-mismatch: PT"]),
        ("f : CTU; a : BOOL; d : DINT", "CAL f(\nCU := a,\nPV := d\n)", &["result-type-mismatch: d"]),
        (
            "f : CTU; a : BOOL; d : DINT; i : SINT",
            "CAL f(\nQ => a,\nCV => d\n)\nCAL f(\nCV => i\n)",
            &["result-type-mismatch: i"],
        ),
        ("f : CTU; a : BOOL", "CAL f(a, FALSE, 10, a)\nCAL f(a, FALSE, a)", &["result-type-mismatch: a"]),
        ("f : TON; i : INT", "CAL f(\nPT := (\nLD i\nADD 1\n)\n)", &["result-type-mismatch: )"]),
        ("f : TON; a : BOOL", "CAL f(\nIN := (\nLD a\nANDN a\n),\nPT := T#1s\n)", &[]),
        // Words.
        ("a : BOOL", "LD a\nOUT a", &["unknown-instruction: OUT"]),
        ("a : BOOL", "LD a\na\nST a", &["unknown-instruction: a"]),
        ("a : BOOL", "TON(IN := a)", &["unknown-instruction: TON"]),
        ("a : BOOL", "LD STEP\nST a", &["operand-kind: STEP"]),
        ("a : BOOL", "LD a_\nST a", &["operand-kind: a_"]),
        ("t : TIME", "LD T#1h90m\nST t", &["malformed-literal: T#1h90m"]),
        ("t : TIME := 5", "LD t\nST t", &["operand-kind: 5"]),
        ("x : ARRAY[0..2] OF SINT := [1, 2(300), 3]", "LD x[0]\nST x[1]", &["constant-out-of-range: 300"]),
        ("x : INT(0..9) := 12", "LD x\nST x", &["constant-out-of-range: 12"]),
        ("b : BYTE := FALSE; r : REAL := 1; l : LREAL := 1.0", "LD b\nST b\nLD r\nST l", &[]),
        ("i : INT", "LD UINT#70000\nST i", &["constant-out-of-range: UINT#70000"]),
        ("i AT %IW0 : INT", "LD 5\nST i", &["write-to-input: i"]),
        // Calls and members.
        ("f : TON", "LD f.X\nST f.IN", &["unknown-parameter: X"]),
        ("f : TON; a : BOOL", "CAL f(\nIN => a\n)", &["unknown-parameter: IN"]),
        ("f : TON; a : BOOL", "CAL f(a, T#1s, a, f.ET, a)", &["unknown-parameter: a"]),
        ("a : BOOL", "CAL a", &["unknown-function-block: a"]),
        ("a : BOOL", "CAL TON", &["unknown-function-block: TON"]),
        ("a : BOOL", "LD a\nIN a", &["unknown-function-block: a"]),
        ("i : INT", "CAL LIMIT(MN := 1, IN := i, MX := 128)\nST i", &[]),
        ("i : INT", "LIMIT(MIN := 1, IN := i, MX := 128)\nST i", &["unknown-parameter: MIN"]),
        ("i : INT", "LD i\nADD_(5)", &["unknown-instruction: ADD_"]),
        ("s : Missing", "LD s\nADD 1\nST s.x", &["unknown-type: Missing"]),
    ];
    let mut wrong = Vec::new();
    for (variables, body, expected) in cases {
        let text = format!("PROGRAM Main\nVAR\n{variables};\nEND_VAR\n{body}\nEND_PROGRAM\n");
        let mut expected: Vec<String> = expected.iter().map(|word| word.to_string()).collect();
        let mut told = told(&text);
        expected.sort();
        told.sort();
        if told != expected {
            wrong.push(format!(
                "{variables} | {body:?}\n  expected {expected:?}\n  found {:#?}",
                found(&text)
            ));
        }
    }
    assert!(wrong.is_empty(), "{} of {} wrong:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

#[test]
fn programs_of_other_people() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/corpus/iec");
    let Ok(entries) = std::fs::read_dir(folder) else {
        crate::corpus::say_skipped("no sample programs beside the source tree");
        return;
    };
    let mut all = Vec::new();
    for entry in entries {
        let path = entry.unwrap().path();
        let text = String::from_utf8_lossy(&std::fs::read(&path).unwrap()).into_owned();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        all.extend(found(&text).into_iter().map(|one| format!("{name} {one}")));
    }
    all.sort();
    println!("{}", all.join("\n"));
    // Three words belong to the author's machine alone, and one function gets its only input behind its name.
    let expected = |one: &String| {
        ["`dbg` is no", "`_exit` is no", "`piface_write` is no", "BOOL_TO_BYTE takes the current"]
            .iter()
            .any(|part| one.contains(part))
    };
    let unexpected: Vec<&String> = all.iter().filter(|one| !expected(one)).collect();
    assert!(unexpected.is_empty(), "{unexpected:#?}");
    assert!(all.len() >= 10, "{all:#?}");
}

#[test]
fn an_external_variable_has_the_type_of_the_global_one() {
    let text = |global: &str, external: &str| {
        format!(
            "TYPE\n Level : INT;\n Part : INT(0..9);\nEND_TYPE\nVAR_GLOBAL\n g {global};\nEND_VAR\nPROGRAM p\n\
             VAR_EXTERNAL\n g : {external};\nEND_VAR\nVAR\n y : BOOL;\nEND_VAR\nLD g\nGT g\nST y\nEND_PROGRAM\n"
        )
    };
    for (global, external, is_found) in [
        (": INT", "INT", false),
        ("AT %MW1 : INT := 5", "int", false),
        (": INT", "Level", false),
        (": Level", "INT", false),
        (": Part", "INT(0..9)", false),
        (": INT", "UINT", true),
        (": INT", "Part", true),
        (": Part", "INT(0..10)", true),
    ] {
        let text = text(global, external);
        let all: Vec<String> =
            told(&text).into_iter().filter(|one| one.starts_with("external-type")).collect();
        assert_eq!(!all.is_empty(), is_found, "{global} {external}: {all:?}");
        if is_found {
            let judged = judged(&text);
            let one = judged.iter().find(|one| one.code == "external-type").expect("the finding");
            let mended = TextEdit::apply_all(&one.fixes[0].edits, &text);
            assert!(!told(&mended).iter().any(|one| one.starts_with("external-type")), "{mended}");
        }
    }
}

#[test]
fn what_a_configuration_says_of_programs_is_judged() {
    let alone = "CONFIGURATION Line\n    PROGRAM First : Cutter;\nEND_CONFIGURATION\n";
    assert_eq!(told(alone), ["unknown-type: Cutter"]);
    let program = "PROGRAM Cutter\nVAR_INPUT\n    Go : BOOL;\nEND_VAR\nVAR_OUTPUT\n    Blade : BOOL;\nEND_VAR\n    \
                   LD Go\n    ST Blade\nEND_PROGRAM\n\n";
    let connected = |with: &str| {
        told(&format!(
            "{program}CONFIGURATION Line\n    PROGRAM First : Cutter({with});\nEND_CONFIGURATION\n"
        ))
    };
    assert_eq!(connected("Go := %IX0.0, Blade => %QX0.0"), Vec::<String>::new());
    assert_eq!(connected("Goo := %IX0.0"), ["unknown-parameter: Goo"]);
    assert_eq!(connected("Knife => %QX0.0"), ["unknown-parameter: Knife"]);
    assert_eq!(connected("Blade := %IX0.0"), ["unknown-parameter: Blade"]);
}

#[test]
fn constants_alone_have_a_type_in_common() {
    let of = |lines: &str| {
        let variables = "Go : BOOL;\n    Lamp : BOOL;\n    Count : INT;\n    Level : REAL;\n    Wait : TIME;";
        told(&format!(
            "PROGRAM Mixer\nVAR\n    {variables}\nEND_VAR\n    {}\nEND_PROGRAM\n",
            lines.replace("; ", "\n    ")
        ))
    };
    for fine in [
        "LD Go; SEL TRUE, 1; ST Lamp",
        "LD Go; SEL 1, 2.5; ST Level",
        "LD 0; LIMIT 5, 100000; ST Count",
        "LD Go; SEL T#1s, T#2s; ST Wait",
        "LD Go; SEL 1, 2; ST Level",
    ] {
        assert_eq!(
            of(fine).iter().filter(|one| one.contains("mismatch")).count(),
            0,
            "{fine}: {:?}",
            of(fine)
        );
    }
    assert_eq!(of("LD Go; SEL TRUE, 5; ST Lamp"), ["result-type-mismatch: 5"]);
    assert_eq!(of("LD Go; SEL 5, TRUE; ST Count"), ["result-type-mismatch: TRUE"]);
    assert_eq!(of("LD Go; SEL TRUE, FALSE; ST Count"), ["result-type-mismatch: Count"]);
    assert_eq!(of("LD 5; MAX T#1s; ST Count"), ["result-type-mismatch: T#1s"]);
}

#[test]
fn the_mixer_is_clean() {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/mixer/mixer.il")).unwrap();
    assert_eq!(found(&text), Vec::<String>::new());
}

/// Applies the first fix of the first finding that has one, until none is left.
fn mended(mut text: String) -> String {
    for _ in 0..20 {
        let all = judged(&text);
        let Some(fix) =
            all.iter().filter(|one| one.severity != Severity::Hint).find_map(|one| one.fixes.first())
        else {
            break;
        };
        text = TextEdit::apply_all(&fix.edits, &text);
    }
    text
}

#[test]
fn fixes_mend() {
    let cases: &[(&str, &str, &str)] = &[
        ("a : BOOL", "AND a\nST a", "LD a\nST a"),
        ("a : BOOL", "ANDN a\nST a", "LDN a\nST a"),
        ("i : INT", "  ADD i, 1\n  ST i", "  LD i\n  ADD 1\n  ST i"),
        ("a : BOOL; b : BYTE", "LD a\nbool_to_byte a\nST b", "LD a\nLD a\nbool_to_byte\nST b"),
        ("i : INT; d : DINT", "  LD d\n  ST i", "  LD d\n  DINT_TO_INT\n  ST i"),
        ("i : INT", "LD i\nRETC\nLD i\nST i", "LD i\nNE 0\nRETC\nLD i\nST i"),
        ("t : TON; a : BOOL", "LD t\nST a", "LD t.Q\nST a"),
        ("t : TON; a : BOOL", "CAL t(\nQ := a\n)", "CAL t(\nQ => a\n)"),
        ("a : BOOL", "LD a\nOUT a", "LD a\nST a"),
        ("a : BOOL", "LD a\nout a", "LD a\nst a"),
        ("r : REAL", "LD .5\nST r", "LD 0.5\nST r"),
        ("Motor : BOOL", "LD Moter\nST Motor\nLD Moter\nST Motor", "LD Motor\nST Motor\nLD Motor\nST Motor"),
    ];
    for (variables, body, expected) in cases {
        let around = |body: &str| format!("PROGRAM Main\nVAR\n{variables};\nEND_VAR\n{body}\nEND_PROGRAM\n");
        let text = mended(around(body));
        assert_eq!(text, around(expected));
        assert_eq!(found(&text), Vec::<String>::new(), "{text}");
    }
}

#[test]
fn declarations_are_made_with_the_type_of_the_use() {
    for (body, kind) in [
        ("LD New\nST a", "BOOL"),
        ("LD i\nST New", "INT"),
        ("LD New\nADD 5\nST i", "INT"),
        ("LD T#5s\nST New", "TIME"),
        ("LD New\nJMPC x\nx: LD a\nST a", "BOOL"),
        ("LD i\nGT New\nST a", "INT"),
        ("CAL New(\nIN := a,\nPT := T#1s\n)", "TON"),
        ("LD a\nCU New", "CTU"),
        ("CAL New(\nCLK := a\n)\nLD New.Q\nST a", "R_TRIG"),
        ("CAL t(\nPT := New\n)", "TIME"),
        ("LD i\nLIMIT New, 9\nST i", "INT"),
    ] {
        for (head, declared) in [
            (
                "VAR\n  a : BOOL; i : INT;\n  t : TON;\nEND_VAR\n",
                format!("VAR\n  a : BOOL; i : INT;\n  t : TON;\n  New : {kind};\nEND_VAR\n"),
            ),
            (
                "var a : BOOL; i : INT; t : TON; end_var\n",
                format!("var a : BOOL; i : INT; t : TON; New : {kind}; end_var\n"),
            ),
        ] {
            let around = |head: &str| format!("PROGRAM Main\n{head}{body}\nEND_PROGRAM\n");
            let text = around(head);
            let all = judged(&text);
            let undeclared = all.iter().find(|one| one.code == "undeclared-variable").unwrap();
            let fix = undeclared.fixes.last().unwrap_or_else(|| panic!("no fix in {text}"));
            assert_eq!(TextEdit::apply_all(&fix.edits, &text), around(&declared), "{body}");
        }
    }
    let text = "PROGRAM Main\nLD New\nST New\nEND_PROGRAM\n";
    let fix = &judged(text)[0].fixes[0];
    let mended = TextEdit::apply_all(&fix.edits, text);
    assert_eq!(mended, "PROGRAM Main\nVAR\n    New : BOOL;\nEND_VAR\nLD New\nST New\nEND_PROGRAM\n");
    assert_eq!(found(&mended), Vec::<String>::new());
}

#[test]
fn declarations_against_each_other() {
    for (text, expected) in [
        ("PROGRAM a\nEND_PROGRAM\nPROGRAM A\nEND_PROGRAM\n", &["duplicate-declaration: A"][..]),
        ("TYPE\n T : STRUCT x : INT; X : BOOL; END_STRUCT;\nEND_TYPE\n", &["duplicate-declaration: X"]),
        ("TYPE\n T : (Red, Green, red);\nEND_TYPE\n", &["duplicate-declaration: red"]),
        (
            "FUNCTION F : INT\nVAR_INPUT x : INT; END_VAR\nLD x\nST F\nEND_FUNCTION\nPROGRAM p\nVAR i : INT; END_VAR\nLD i\nF\nST i\nEND_PROGRAM\n",
            &[],
        ),
        (
            "FUNCTION F : INT\nVAR_INPUT x, y : INT; END_VAR\nLD x\nADD y\nST F\nEND_FUNCTION\nPROGRAM p\nVAR i : INT; a : BOOL; END_VAR\nLD i\nF a\nST i\nLD i\nF\nST i\nEND_PROGRAM\n",
            &["result-type-mismatch: a", "operand-count: F"],
        ),
        (
            "TYPE\n Colour : (Red, Green);\nEND_TYPE\nPROGRAM p\nVAR c : Colour := Red; a : BOOL; END_VAR\nLD c\nEQ Green\nST a\nLD Colour#Red\nST c\nEND_PROGRAM\n",
            &[],
        ),
        (
            "PROGRAM p\nVAR w AT %QW1 : WORD; x AT %QX2.0 : BOOL; y AT %QX1.0 : BOOL; END_VAR\nLD w\nST w\nLD x\nST y\nEND_PROGRAM\n",
            &["address-overlap: %QX2.0"],
        ),
        (
            "PROGRAM p\nVAR x AT %QX2.0 : BOOL; END_VAR\nLD x\nST x\nEND_PROGRAM\nPROGRAM q\nVAR x AT %QX2.0 : BOOL; END_VAR\nLD x\nST x\nEND_PROGRAM\n",
            &[],
        ),
        (
            "VAR_GLOBAL\n g : BOOL;\nEND_VAR\nPROGRAM p\nVAR_EXTERNAL g : BOOL; END_VAR\nLD g\nST g\nEND_PROGRAM\n",
            &[],
        ),
        ("FUNCTION_BLOCK A\nVAR b : ARRAY[0..1] OF A; END_VAR\nEND_FUNCTION_BLOCK\n", &["recursive-pou: A"]),
        ("FUNCTION_BLOCK A\nVAR_IN_OUT b : A; END_VAR\nEND_FUNCTION_BLOCK\n", &[]),
        ("LD a\nST b\n", &[]),
        ("CONFIGURATION c\nPROGRAM p : Elsewhere;\nEND_CONFIGURATION\n", &["unknown-type: Elsewhere"]),
        (
            "PROGRAM Main\nEND_PROGRAM\nCONFIGURATION c\nPROGRAM p : Mian;\nEND_CONFIGURATION\n",
            &["unknown-type: Mian"],
        ),
    ] {
        let mut told = told(text);
        let mut expected: Vec<String> = expected.iter().map(|word| word.to_string()).collect();
        told.sort();
        expected.sort();
        assert_eq!(told, expected, "{text}\n{:#?}", found(text));
    }
}

proptest! {
    #[test]
    fn rules_bear_any_arrangement_of_words(words in proptest::collection::vec(any_word(), 0..60)) {
        let text = words.concat();
        for one in judged(&text) {
            prop_assert!(text.get(one.span.range()).is_some(), "{} at {:?}", one.code, one.span);
            for fix in &one.fixes {
                TextEdit::apply_all(&fix.edits, &text);
            }
        }
    }
}

fn any_word() -> impl Strategy<Value = &'static str> {
    proptest::sample::select(vec![
        "PROGRAM p\n",
        "END_PROGRAM\n",
        "FUNCTION f : INT\n",
        "END_FUNCTION\n",
        "FUNCTION_BLOCK b\n",
        "VAR\n",
        "END_VAR\n",
        "VAR_INPUT ",
        "x : INT;\n",
        "b1 : b;\n",
        "y AT %QW0 : WORD := 5;\n",
        "t : TON;\n",
        "LD ",
        "ST ",
        "AND(",
        "ADD ",
        "x",
        "x[",
        "]",
        ".Q",
        "t",
        "b1",
        "(",
        ")",
        "\n",
        ",",
        ":=",
        "=>",
        "CAL ",
        "f ",
        "L: ",
        "JMP L\n",
        "RET\n",
        "S ",
        "R ",
        "IN ",
        "16#",
        "T#5s",
        "'ä'",
        "5",
        "%IX0.0",
        "%Q",
        "TYPE e : (r, g);\nEND_TYPE\n",
        "CONFIGURATION c\n",
        "TASK k(PRIORITY := 1);\n",
        "PROGRAM i WITH k : p;\n",
        "END_CONFIGURATION\n",
        "阀",
        "(*",
        "*)",
    ])
}
