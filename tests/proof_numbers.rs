//! What is proved of comparisons with constants: numbers have the range of their types.

use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::translate::{Proof, prove};

fn program(variables: &str, body: &str) -> Document {
    let text = format!("PROGRAM p\nVAR\n{variables}\nEND_VAR\n{}\nEND_PROGRAM\n", body.replace(';', "\n"));
    Document::new(&text, Notation::IecIl, Target::of(Model::Iec))
}

fn word(left: &Document, right: &Document) -> &'static str {
    match prove(left, right) {
        Proof::Equal { .. } => "equal",
        Proof::Different(_) => "different",
        Proof::Undecided { .. } => "undecided",
    }
}

/// The verdicts on two bodies of one program, either way round.
fn verdicts(variables: &str, left: &str, right: &str) -> [&'static str; 2] {
    let [left, right] = [left, right].map(|body| program(variables, body));
    [word(&left, &right), word(&right, &left)]
}

/// The verdict, which is the same either way.
fn verdict(variables: &str, left: &str, right: &str) -> &'static str {
    let [found, back] = verdicts(variables, left, right);
    assert_eq!(found, back, "{variables} {left} | {right}");
    found
}

/// An operator with what it says of two numbers.
type Operator = (&'static str, fn(i128, i128) -> bool);

const OPERATORS: [Operator; 6] = [
    ("GT", |left, right| left > right),
    ("GE", |left, right| left >= right),
    ("EQ", |left, right| left == right),
    ("NE", |left, right| left != right),
    ("LE", |left, right| left <= right),
    ("LT", |left, right| left < right),
];

#[test]
fn comparisons_that_never_hold_are_false() {
    const NEVER: &str = "LD FALSE;ST y";
    const ALWAYS: &str = "LD TRUE;ST y";
    for (kind, least, greatest) in [
        ("SINT", i128::from(i8::MIN), i128::from(i8::MAX)),
        ("INT", i128::from(i16::MIN), i128::from(i16::MAX)),
        ("DINT", i128::from(i32::MIN), i128::from(i32::MAX)),
        ("LINT", i128::from(i64::MIN), i128::from(i64::MAX)),
        ("USINT", 0, i128::from(u8::MAX)),
        ("UINT", 0, i128::from(u16::MAX)),
        ("UDINT", 0, i128::from(u32::MAX)),
        ("ULINT", 0, i128::from(u64::MAX)),
        ("BYTE", 0, i128::from(u8::MAX)),
        ("WORD", 0, i128::from(u16::MAX)),
    ] {
        let variables = format!("n : {kind}; y : BOOL;");
        for (body, expected) in [
            (format!("LD n;GT {greatest};ST y"), NEVER),
            (format!("LD n;LT {least};ST y"), NEVER),
            (format!("LD n;LE {greatest};ST y"), ALWAYS),
            (format!("LD n;GE {least};ST y"), ALWAYS),
            (format!("LD n;GT {kind}#{greatest};ST y"), NEVER),
            (format!("LD n;LT {kind}#{least};ST y"), NEVER),
            (format!("LD {greatest};LT n;ST y"), NEVER),
            (format!("LD {least};LE n;ST y"), ALWAYS),
        ] {
            assert_eq!(verdict(&variables, &body, expected), "equal", "{kind}: {body}");
        }
        // One step within the range the comparison can go either way.
        if !kind.contains("LINT") {
            for body in [format!("LD n;GE {greatest};ST y"), format!("LD n;LE {least};ST y")] {
                assert_eq!(verdict(&variables, &body, NEVER), "different", "{kind}: {body}");
                assert_eq!(verdict(&variables, &body, ALWAYS), "different", "{kind}: {body}");
            }
        }
    }
}

#[test]
fn a_number_is_one_however_it_is_written() {
    let variables = "n : INT; u : UINT; y : BOOL;";
    for (left, right, expected) in [
        ("LD n;GT 16", "LD n;GT 16#10", "equal"),
        ("LD n;GT 16", "LD n;GT 2#1_0000", "equal"),
        ("LD n;GT 16", "LD n;GT 8#20", "equal"),
        ("LD n;GT 16", "LD n;GT INT#16", "equal"),
        ("LD n;GT 16", "LD n;GT INT#16#10", "equal"),
        ("LD n;GT 16", "LD n;GE 17", "equal"),
        ("LD n;GT 16", "LD 17;LE n", "equal"),
        ("LD n;EQ 16", "LD n;GT 15;AND(n;LT 17;)", "equal"),
        ("LD n;GT 16", "LD n;GT 16#11", "different"),
        ("LD n;GT 16", "LD u;GT 16", "different"),
        ("LD u;GT 16#FFFE", "LD u;EQ UINT#65535", "equal"),
        ("LD 5;GT 3", "LD TRUE", "equal"),
        ("LD 3;GT 5", "LD TRUE", "different"),
    ] {
        let [left, right] = [left, right].map(|condition| format!("{condition};ST y"));
        assert_eq!(verdict(variables, &left, &right), expected, "{left} | {right}");
    }
}

/// All comparisons of a small number with all constants at the ends of its range, against each other: what is proved is
/// what comparing every number of the type says.
#[test]
fn proofs_about_small_numbers_are_what_counting_says() {
    for (kind, range) in [("SINT", -128..=127_i128), ("USINT", 0..=255), ("BYTE", 0..=255)] {
        let variables = format!("n : {kind}; y : BOOL;");
        let (least, greatest) = (*range.start(), *range.end());
        let mut all = Vec::new();
        for constant in [least - 1, least, least + 1, 7, greatest - 1, greatest, greatest + 1] {
            for (name, holds) in OPERATORS {
                let body = format!("LD n;{name} {constant};ST y");
                let values: Vec<bool> = range.clone().map(|number| holds(number, constant)).collect();
                all.push((body, values, range.contains(&constant)));
            }
        }
        for (number, (left, left_values, left_fits)) in all.iter().enumerate() {
            // Every third is enough, and which ones changes from row to row.
            for (right, right_values, right_fits) in all.iter().skip(number % 3).step_by(3) {
                let expected = if left_values == right_values { "equal" } else { "different" };
                for found in verdicts(&variables, left, right) {
                    let may_be_open = found == "undecided" && !(*left_fits && *right_fits);
                    assert!(found == expected || may_be_open, "{kind} {found}: {left} | {right}");
                }
            }
        }
    }
}

#[test]
fn where_the_type_is_in_doubt_nothing_is_taken_for_granted() {
    for (variables, left, right) in [
        // Between two whole numbers there are others, of a REAL and of who knows what.
        ("n : REAL;", "LD n;GT 16", "LD n;GE 17"),
        ("n : LREAL;", "LD n;GT 32767", "LD FALSE"),
        ("n : TIME;", "LD n;GT 32767", "LD FALSE"),
        ("n : Odd;", "LD n;GT 16", "LD n;GE 17"),
        ("m : INT;", "LD n;GT 32767", "LD FALSE"),
        ("n : STRING;", "LD n;GT 16", "LD n;GE 17"),
        // Larger than the type.
        ("n : INT;", "LD n;GT 40000", "LD FALSE"),
        ("n : INT;", "LD n;LT 16#FFFF", "LD TRUE"),
        ("n : UINT;", "LD n;LT -1", "LD FALSE"),
        // Types that do not convert to each other.
        ("n : INT;", "LD n;LT UINT#0", "LD FALSE"),
        ("n : UINT;", "LD n;LT INT#0", "LD FALSE"),
        ("n : INT;", "LD n;GT WORD#16#7FFF", "LD FALSE"),
        ("n : WORD;", "LD n;LT INT#0", "LD FALSE"),
        // Two names of one place, with and without a sign.
        ("n AT %MW0 : INT; m AT %MW0 : UINT;", "LD n;GT 32767", "LD m;GT 32767"),
        ("n AT %MW0 : INT; m AT %MW0 : UINT; k : INT;", "LD n;GT k", "LD m;GT k"),
        ("n AT %MW0 : INT;", "LD n;GT 5;AND(%MW0;GT 32767;)", "LD FALSE"),
        // Of one type alone, the other may be larger.
        ("n : INT; d : DINT;", "LD d;GT 32767", "LD FALSE"),
        ("n : INT; d : DINT;", "LD d;GT n;AND(n;GE 32767;)", "LD FALSE"),
    ] {
        let variables = format!("{variables} y : BOOL;");
        let [left, right] = [left, right].map(|condition| format!("{condition};ST y"));
        let found = verdicts(&variables, &left, &right);
        assert!(!found.contains(&"equal"), "{variables} {left} | {right}");
    }
    // A wider type holds both sides.
    for (variables, left, right) in [
        ("n : INT;", "LD n;GT DINT#40000", "LD FALSE"),
        ("n : DINT;", "LD n;GT INT#5", "LD n;GE 6"),
        ("n : BYTE;", "LD n;GT WORD#16#FF", "LD FALSE"),
    ] {
        let variables = format!("{variables} y : BOOL;");
        let [left, right] = [left, right].map(|condition| format!("{condition};ST y"));
        assert_eq!(verdict(&variables, &left, &right), "equal", "{variables} {left} | {right}");
    }
}

#[test]
fn a_name_of_two_types_in_two_units_is_neither() {
    let text = |kind: &str, first: &str, second: &str| {
        let text = format!(
            "FUNCTION_BLOCK f\nVAR n : {kind}; y : BOOL; END_VAR\n{first}\nST y\nEND_FUNCTION_BLOCK\n\
             PROGRAM p\nVAR n : INT; y : BOOL; END_VAR\n{second}\nST y\nEND_PROGRAM\n"
        );
        Document::new(&text, Notation::IecIl, Target::of(Model::Iec))
    };
    for kind in ["DINT", "REAL", "UINT"] {
        let left = text(kind, "LD n\nGT 32767", "LD n\nGT 3");
        let right = text(kind, "LD FALSE", "LD n\nGT 3");
        assert_ne!(word(&left, &right), "equal", "{kind}");
        let [left, right] = ["LD n\nGT 32767", "LD FALSE"].map(|body| text(kind, "LD n\nGT 3", body));
        assert_ne!(word(&left, &right), "different", "{kind}");
    }
    let [left, right] = ["LD n\nGT 32767", "LD FALSE"].map(|body| text("INT", body, "LD n\nGT 3"));
    assert_eq!(word(&left, &right), "equal");
}

#[test]
fn a_drawn_comparison_is_one_as_well() {
    let drawing = |condition: &str| {
        let text = format!(
            "PROGRAM p\nVAR\n n : INT;\n y : BOOL;\nEND_VAR\n\n|                    y   |\n+--{condition}--( )-+\n\nEND_PROGRAM\n"
        );
        Document::new(&text, Notation::Ladder, Target::of(Model::Iec))
    };
    let list = |condition: &str| program("n : INT; y : BOOL;", &format!("{condition};ST y"));
    let drawn = drawing("[ n > 32767 ]---");
    assert_eq!(word(&drawn, &list("LD FALSE")), "equal", "{}", drawn.text());
    assert_eq!(word(&drawn, &list("LD n;GE 32767")), "different");
}

/// The verdict on two lists of the FX family, whichever of them comes first.
fn fx(left: &str, right: &str) -> [&'static str; 2] {
    let [left, right] = [left, right].map(|body| {
        let text = format!("{}\nEND\n", body.replace(';', "\n"));
        Document::new(&text, Notation::FxIl, Target::of(Model::Fx3u))
    });
    [word(&left, &right), word(&right, &left)]
}

#[test]
fn what_an_instruction_makes_of_words_and_groups_is_worked_out_or_not_decided() {
    for (left, right, expected) in [
        // Copies to relays are worked out.
        ("LD X0;MOV K5 K1M0;LD M0;OUT Y0", "LD X0;MOV K5 K1M0;LD M0;AND X1;OUT Y0", "different"),
        ("LD M8000;MOV K5 K1M0;LD M1;OUT Y0", "LD M8000;MOV K5 K1M0;LDI M8000;OUT Y0", "undecided"),
        ("LD M8000;MOV K5 K1M0;LD M0;OUT Y0", "LD M8000;MOV K5 K1M0;LDI M8000;OUT Y0", "different"),
        ("LD M8000;MOV K5 K1M0;LD M0;AND X0;OUT Y0", "LD M8000;MOV K5 K1M0;LDI X0;OUT Y0", "different"),
        ("LD M8000;MOV K0 K1M0;LD M0;OUT Y0", "LD M8000;MOV K0 K1M0;LDI M8000;OUT Y0", "undecided"),
        ("LD M8000;MOV D0 K1M0;LD M9;OUT Y0", "LD M8000;MOV D0 K1M0;LDI M9;OUT Y0", "different"),
        ("LD M8000;MOV K2X0 K1M0;LD M0;OUT Y0", "LD M8000;MOV K2X0 K1M0;LD X0;OUT Y0", "undecided"),
        ("LD M8000;MOV K2X0 K1M0;LD M0;OUT Y0", "LD M8000;MOV K2X0 K1M0;LD X1;OUT Y0", "different"),
        ("LD X1;MOV K1X0 K1M0;LD X1;AND M0;OUT Y0", "LD X1;MOV K1X0 K1M0;LD X1;AND X0;OUT Y0", "undecided"),
        ("LD X1;MOV K1X0 D0;LD= D0 K5;OUT Y0", "LD X1;MOV K1X0 D0;LD= D0 K5;AND X0;OUT Y0", "different"),
        // What other instructions leave in registers that they write may be what it never is.
        ("LD M8000;WAND K0 D1 D0;LD= D0 K5;OUT Y0", "LD M8000;WAND K0 D1 D0;LDI M8000;OUT Y0", "undecided"),
        ("LD M8000;ADD D0 D0 D1;LD= D1 K5;OUT Y0", "LD M8000;ADD D0 D0 D1;LDI M8000;OUT Y0", "undecided"),
        ("LD M8000;DMOV K0 D0;LD= D1 K5;OUT Y0", "LD M8000;DMOV K0 D0;LDI M8000;OUT Y0", "undecided"),
        ("LD M8000;CML K0 D0;LD= D0 K5;OUT Y0", "LD M8000;CML K0 D0;LDI M8000;OUT Y0", "undecided"),
        ("LD M8000;INC D0;LD= D0 K5;OUT Y0", "LD= D0 K4;OUT Y0;LD M8000;INC D0", "undecided"),
        // Registers below are not written.
        ("LD M8000;ADD D5 D6 D7;LD= D1 K5;OUT Y0", "LD M8000;ADD D5 D6 D7;LD= D1 K6;OUT Y0", "different"),
        ("LD M8000;ADD D5 D6 K1M0;LD= D9 K5;OUT Y0", "LD M8000;ADD D5 D6 K1M0;LD= D9 K6;OUT Y0", "different"),
    ] {
        assert_eq!(fx(left, right), [expected; 2], "{left} | {right}");
    }
}
