//! Literals are what they are however they are written, words are only what their types let them be, and a scan must come
//! to a difference.

use rungwise::document::{Document, Notation};
use rungwise::target::{Model, Target};
use rungwise::translate::{Proof, Value, prove};

fn iec(variables: &str, body: &str) -> Document {
    let body = body.replace(';', "\n");
    let text = format!("PROGRAM p\nVAR\n{variables} y : BOOL;\nEND_VAR\n{body}\nEND_PROGRAM\n");
    Document::new(&text, Notation::IecIl, Target::of(Model::Iec))
}

fn fx(body: &str) -> Document {
    let text = format!("{}\nEND\n", body.replace(';', "\n"));
    Document::new(&text, Notation::FxIl, Target::of(Model::Fx3u))
}

/// What is said of two programs, whichever is named first.
pub fn word(left: &Document, right: &Document) -> &'static str {
    let verdict = |left, right| match prove(left, right) {
        Proof::Equal { .. } => "equal",
        Proof::Different(_) => "different",
        Proof::Undecided { .. } => "undecided",
    };
    let found = verdict(left, right);
    assert_eq!(found, verdict(right, left), "{}\n{}", left.text(), right.text());
    found
}

#[test]
fn a_literal_is_one_however_it_is_written() {
    let variables = "x : TIME; r : REAL; l : LREAL; d : DATE; t : TON; a : BOOL;";
    for (left, right, expected) in [
        ("LD x;GT T#1s;ST y", "LD x;GT time#1000ms;ST y", "equal"),
        ("LD x;GT T#1m;ST y", "LD x;GT T#60s;ST y", "equal"),
        ("LD x;GT T#1s;ST y", "LD x;GT T#2s;ST y", "different"),
        ("LD x;GT T#1s;AND(x;GT T#500ms;);ST y", "LD x;GT T#1s;ST y", "equal"),
        ("LD x;GT T#1s;AND(x;LT T#500ms;);ST y", "LD FALSE;ST y", "equal"),
        // Not every PLC has times that are no whole milliseconds.
        ("LD x;GT T#1ms;ST y", "LD x;GE T#2ms;ST y", "undecided"),
        ("LD T#1s;GT T#2s;ST y", "LD FALSE;ST y", "equal"),
        ("LD T#1s;GT T#2s;ST y", "LD TRUE;ST y", "different"),
        ("LD T#1s;ST x", "LD T#1000ms;ST x", "equal"),
        ("LD T#1s;ST x", "LD T#2s;ST x", "undecided"),
        (
            "LD a;ST t.IN;CAL t(PT := T#1s);LD t.Q;ST y",
            "LD a;ST t.IN;CAL t(PT := T#1000ms);LD t.Q;ST y",
            "equal",
        ),
        ("LD r;GT 1.0;ST y", "LD r;GT 1.00;ST y", "equal"),
        ("LD r;GT 1.0;ST y", "LD r;GT 2.0;ST y", "different"),
        ("LD r;GT 1.5E1;ST y", "LD r;GT REAL#15.0;ST y", "equal"),
        ("LD r;GT 1.0;ANDN(r;GT 0.5;);ST y", "LD FALSE;ST y", "equal"),
        // A REAL has not so many digits.
        ("LD r;GT 1.0;ST y", "LD r;GT 1.00000000001;ST y", "equal"),
        ("LD l;GT 1.0;ST y", "LD l;GT 1.00000000001;ST y", "different"),
        // No number is neither larger nor smaller, where a PLC has that.
        ("LD r;GT 1.0;ST y", "LD r;LE 1.0;STN y", "undecided"),
        ("LD r;EQ 1.0;ST y", "LD r;NE 1.0;STN y", "equal"),
        ("LD d;GT D#2024-01-31;ST y", "LD d;GT DATE#2024-1-31;ST y", "equal"),
    ] {
        assert_eq!(word(&iec(variables, left), &iec(variables, right)), expected, "{left} | {right}");
    }
    let inputs = |left, right| match prove(&iec(variables, left), &iec(variables, right)) {
        Proof::Different(found) => found.inputs,
        other => panic!("{other:?}"),
    };
    assert_eq!(inputs("LD x;GT T#1s;ST y", "LD x;GT T#2s;ST y")["x"], Value::Time(1_001_000_000));
    let Value::Real(number) = inputs("LD r;GT 1.0;ST y", "LD r;GT 2.0;ST y")["r"] else { panic!() };
    assert!(number > 1.0 && number <= 2.0, "{number}");
}

#[test]
fn words_are_numbers_of_their_types() {
    let never = "LD FALSE;ST y";
    for (variables, body, expected) in [
        // A PLC that writes a larger number into it is wrong, but who knows.
        ("v : INT(0..9);", "LD v;GT 9;ST y", "undecided"),
        ("v : INT(0..9);", "LD v;GT 8;ST y", "different"),
        ("v : INT(0..9); w : INT(20..30);", "LD v;GT w;ST y", "undecided"),
        ("v : INT(0..9); w : INT(9..30);", "LD v;GE w;ST y", "different"),
        ("v : INT(5..9); w : INT;", "LD v;LT w;ANDN(w;GT 5;);ST y", "undecided"),
        ("n : INT; m : INT;", "LD n;GT m;AND(m;GE 32767;);ST y", "equal"),
        ("n : INT; m : INT; k : INT;", "LD n;GT m;AND(m;GT k;);AND(k;GE n;);ST y", "equal"),
        ("w : WORD;", "LD w.0;AND(w;EQ 2;);ST y", "undecided"),
        ("w : WORD;", "LD w.1;AND(w;EQ 2;);ST y", "different"),
        ("w AT %MW0 : WORD; b AT %MX0.0 : BOOL;", "LD b;AND(w;EQ 0;);ST y", "undecided"),
        ("w AT %MW9 : WORD; b AT %MX0.0 : BOOL;", "LD b;AND(w;EQ 0;);ST y", "different"),
    ] {
        assert_eq!(word(&iec(variables, body), &iec(variables, never)), expected, "{variables} {body}");
    }
    for (body, expected) in [
        ("LD> D0 D1;AND>= D1 K32767;OUT Y0", "equal"),
        ("LD>= K1M0 K16;OUT Y0", "equal"),
        ("LD>= K1M0 K15;OUT Y0", "different"),
        ("LDD>= D0 K65536;AND= D1 K0;OUT Y0", "undecided"),
    ] {
        assert_eq!(word(&fx(body), &fx("LDI M8000;OUT Y0")), expected, "{body}");
    }
}

#[test]
fn a_subrange_counts_wherever_it_is_declared() {
    let text = |declared: &str, body: &str| {
        let text =
            format!("{declared}\nPROGRAM p\nVAR y : BOOL; END_VAR\nLD {body}\nGT 9\nST y\nEND_PROGRAM\n");
        Document::new(&text, Notation::IecIl, Target::of(Model::Iec))
    };
    let never = |declared: &str| text(declared, "0");
    for (declared, body) in [
        ("VAR_GLOBAL v : INT(0..9); END_VAR", "v"),
        ("TYPE s : INT(0..9); END_TYPE\nVAR_GLOBAL v : s; END_VAR", "v"),
        ("TYPE s : INT(0..9); r : STRUCT n : s; END_STRUCT; END_TYPE\nVAR_GLOBAL v : r; END_VAR", "v.n"),
    ] {
        assert_eq!(word(&text(declared, body), &never(declared)), "undecided", "{declared}");
        let wider = declared.replace("0..9", "0..10");
        assert_eq!(word(&text(&wider, body), &never(&wider)), "different", "{declared}");
    }
}

#[test]
fn a_scan_comes_to_the_difference() {
    for (left, right, expected) in [
        // What was driven before a label is known behind it.
        ("LD X0;OUT M0;P1;LD M0;OUT Y0", "LD X0;OUT M0;P1;LD X0;OUT Y0", "undecided"),
        ("LD X0;OUT M0;P1;LD M0;OUT Y0", "LD X0;OUT M0;P1;LDI X0;OUT Y0", "different"),
        // The jump is taken where the two would differ.
        ("LD X0;CJ P1;LD X0;OUT Y0;P1", "LD X0;CJ P1;LDI M8000;OUT Y0;P1", "undecided"),
        ("LD X0;CJ P1;LD X1;OUT Y0;P1", "LD X0;CJ P1;LDI M8000;OUT Y0;P1", "different"),
        // Nobody knows what a rung does that cannot be read, but it does the same on both sides.
        ("LD X0;OUT M0;LD X1;FOO D0;LD M0;OUT Y0", "LD X0;OUT M0;LD X1;FOO D0;LD X0;OUT Y0", "undecided"),
        ("LD X0;OUT Y1;LD X1;FOO D0;LD M0;OUT Y0", "LD X0;OUT Y1;LD X1;FOO  D0;LD M0;OUT Y0", "equal"),
        ("LD X1;FOO D0;LD M0;OUT Y0", "LD X1;FOO D1;LD M0;OUT Y0", "undecided"),
        // It may be that it drives what differs before it.
        ("LD X0;OUT M0;LD X1;FOO M0", "LD X1;OUT M0;LD X1;FOO M0", "undecided"),
    ] {
        assert_eq!(word(&fx(left), &fx(right)), expected, "{left} | {right}");
    }
    let variables = "a : INT; b : INT; c : BOOL;";
    let unread = iec(variables, "LD a;FOO b;ST a;LD c;ST y");
    assert_eq!(word(&unread, &iec(variables, "ld A;foo B (* who knows *);ST a;LD c;ST y")), "equal");
    assert_eq!(word(&unread, &iec(variables, "LD a;FOO c;ST a;LD c;ST y")), "undecided");
}

#[test]
fn a_helper_that_keeps_power_is_nothing_to_compare() {
    let variables = "a : BOOL; b : BOOL; c : BOOL; z : BOOL;";
    let with = format!("{variables} Held1 : BOOL;");
    let held = "LD a;AND b;ST Held1;ST y;LD Held1;AND c;ST z";
    let plain = "LD a;AND b;ST y;LD a;AND b;AND c;ST z";
    let apart = held.replace("ST y;", "ST y;;");
    for (left, right) in [(held, apart.as_str()), (plain, held), (plain, &apart)] {
        let own = |body: &str| iec(if body == plain { variables } else { &with }, body);
        assert_eq!(word(&own(left), &own(right)), "equal", "{left} | {right}");
    }
    // What it was one scan before is something to compare.
    let [left, right] = ["LD Held1;ST y;LD a;ST Held1", "LD Held1;ST y;LD b;ST Held1"];
    assert_eq!(word(&iec(&with, left), &iec(&with, right)), "different");
    // So it is where an edge remembers it.
    let edge = format!("{with} e : R_TRIG;");
    let [left, right] = ["a", "b"].map(|bit| format!("LD {bit};ST Held1;CAL e(CLK := Held1);LD e.Q;ST y"));
    assert_eq!(word(&iec(&edge, &left), &iec(&edge, &right)), "different");
}

#[test]
fn an_input_operator_is_a_call_with_that_input() {
    let variables = "t : TON; c : CTU; a : BOOL;";
    for (left, right, expected) in [
        ("LD a;IN t;LD t.Q;ST y", "CAL t(IN := a);LD t.Q;ST y", "equal"),
        ("LD a;CU c;LD c.Q;ST y", "CAL c(CU := a);LD c.Q;ST y", "equal"),
        ("LD T#1s;PT t;LD a;IN t;LD t.Q;ST y", "CAL t(PT := T#1000ms);CAL t(IN := a);LD t.Q;ST y", "equal"),
        ("LD 5;PV c;LD a;CU c", "CAL c(PV := 5);CAL c(CU := a)", "equal"),
        ("LD 5;PV c;LD a;CU c", "CAL c(PV := 6);CAL c(CU := a)", "undecided"),
        // Both inputs in one call are another thing.
        ("LD T#1s;PT t;LD a;IN t;LD t.Q;ST y", "CAL t(IN := a, PT := T#1s);LD t.Q;ST y", "undecided"),
        ("LD a;IN t;LD t.Q;ST y", "LD a;CALC t(IN := a);LD t.Q;ST y", "undecided"),
    ] {
        assert_eq!(word(&iec(variables, left), &iec(variables, right)), expected, "{left} | {right}");
    }
}

/// Elements with constant subscripts are variables of their own, unless a subscript that varies may be the same.
#[test]
fn elements_of_arrays_are_compared() {
    let variables = "a : BOOL; b : BOOL; i : INT; g : ARRAY[0..2] OF BOOL; k : ARRAY[0..2] OF BOOL; w : WORD; o : TON; \
                     t : ARRAY[0..1, 0..1] OF BOOL;";
    for (left, right, expected) in [
        ("LD a;ST g[1];LD g[1];ST y", "LD a;ST g[1];LD a;ST y", "equal"),
        ("LD a;ST g[1];LD b;ST g[2]", "LD b;ST g[2];LD a;ST g[1]", "equal"),
        ("LD a;ST g[1];LD g[2];ST y", "LD a;ST g[1];LD g[0];ST y", "different"),
        ("LD a;ST g[1]", "LDN a;ST g[1]", "different"),
        ("LD a;ST t[0,1];LD t[0,1];ST y", "LD a;ST t[0,1];LD a;ST y", "equal"),
        ("LD g[1];ST y;CAL o(IN := a, PT := T#1s)", "CAL o(IN := a, PT := T#1s);LD g[1];ST y", "equal"),
        ("LD w.1;ST y;CAL o(IN := a, PT := T#1s)", "CAL o(IN := a, PT := T#1s);LD w.1;ST y", "equal"),
        ("LD a;ST g[1];LD b;ST g[i];LD g[1];ST y", "LD a;ST g[1];LD b;ST g[i];LD a;ST y", "undecided"),
        ("LD a;ST g[1];LD g[i];ST y", "LD g[i];ST y;LD a;ST g[1]", "undecided"),
        ("LD w.1;ST y", "LD w.%X1;ST y", "undecided"),
    ] {
        assert_eq!(word(&iec(variables, left), &iec(variables, right)), expected, "{left} | {right}");
    }
    // What is a part of something changes with it, and the other way round.
    for (left, right) in [
        ("LD k[1];ST y;LD g;ST k", "LD g;ST k;LD k[1];ST y"),
        ("LD a;ST g[1];LD g;ST k;LD b;ST g[1]", "LD b;ST g[1];LD g;ST k;LD b;ST g[1]"),
    ] {
        assert_ne!(word(&iec(variables, left), &iec(variables, right)), "equal", "{left} | {right}");
    }
}

/// Behind a jump the outcome of the whole scan tells.
#[test]
fn a_jump_makes_no_difference_where_the_scan_ends_alike() {
    for (left, right, expected) in [
        ("LD X0;CJ P1;LDI X0;OUT Y0;P1", "LDI X0;CJ P1;LDI X0;OUT Y0;P1", "different"),
        ("LD Y0;CJ P1;LD X1;SET Y0;P1", "LDI X1;CJ P1;LD X1;SET Y0;P1", "undecided"),
        ("LD X1;CJ P1;LD X0;OUT Y0;P1;LD X0;OUT Y1", "LD X1;CJ P1;LD X0;OUT Y0;P1;LD Y0;OUT Y1", "different"),
        ("LD X0;OUT Y0;P1;LD X1;OUT Y0", "LDI X0;OUT Y0;P1;LD X1;OUT Y0", "undecided"),
    ] {
        assert_eq!(word(&fx(left), &fx(right)), expected, "{left} | {right}");
    }
}

#[test]
fn a_difference_is_shown_only_where_running_with_plain_values_is_what_a_plc_does() {
    let variables = "a : BOOL; m : BOOL; i : INT; bar : ARRAY[0..3] OF BOOL; x1 AT %QX0.0 : BOOL; w1 AT %QW0 : WORD; \
                     s : STRING[3]; c : (re, gr, bl);";
    for (left, right) in [
        ("LD TRUE;ST m;LD a;ST bar[i];LD m;ST y", "LD TRUE;ST m;LD a;ST bar[i];LD TRUE;ST y"),
        (
            "LD TRUE;ST bar[0];LD FALSE;ST bar[1];LD bar[0];ST y",
            "LD TRUE;ST bar[0];LD FALSE;ST bar[1];LD TRUE;ST y",
        ),
        ("LD 16#1;ST w1;LD x1;ST y", "LD 16#1;ST w1;LD TRUE;ST y"),
        ("LD TRUE;ST m;LD a;ST bar[01];LD bar[1];ST y", "LD TRUE;ST m;LD a;ST bar[01];LD a;ST y"),
        ("LD bar[1];ST y", "LD bar[01];ST y"),
        ("LD i;EQ 1;AND bar[i];ST y", "LD i;EQ 1;AND bar[1];ST y"),
        ("LD c;GT re;ST y", "LD c;GE gr;ST y"),
        ("LD s;EQ 'abcd';ST y", "LD FALSE;ST y"),
    ] {
        assert_ne!(word(&iec(variables, left), &iec(variables, right)), "different", "{left} / {right}");
    }
}
