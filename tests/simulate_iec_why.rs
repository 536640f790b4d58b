//! Why a variable of an IEC 61131-3 program is what it is, through the binary.

use crate::binary::{folder, run};

const PROGRAM: &str = "FUNCTION_BLOCK Latch\nVAR_INPUT\ns, r : BOOL;\nEND_VAR\nVAR_OUTPUT\nq : BOOL;\nEND_VAR\n\
    LD s\nOR q\nANDN r\nST q\nEND_FUNCTION_BLOCK\n\
    PROGRAM Main\nVAR\ngo, halt, Motor, late, big : BOOL;\nn, m : INT;\nt : TON;\nc : CTU;\nOne, Two : Latch;\nEND_VAR\n\
    CAL One(s := go, r := halt, q => Motor)\nLD Motor\nST t.IN\nCAL t(PT := T#100ms)\nLD t.Q\nST late\n\
    CAL c(CU := late, PV := 2)\nLD n\nADD 1\nST n\nLD n\nMUL 2\nST m\nLD m\nGT 10\nAND late\nST big\n\
    CAL Two(s := big, r := FALSE)\nEND_PROGRAM\n";

/// The answer to a question about a run of a program with these settings.
fn why(program: &str, settings: &[&str], question: &str) -> String {
    let folder = folder(&[("main.il", program)]);
    let mut arguments = vec![
        "run",
        "main.il",
        "--watch",
        question.split('@').next().unwrap_or(question),
        "--time",
        "200ms",
        "--why",
        question,
    ];
    settings.iter().for_each(|setting| arguments.extend(["--set", *setting]));
    let (code, out, err) = run(&folder, &arguments);
    assert_eq!((code, err.as_str()), (0, ""));
    out.split_once("\n\n").map(|(_, told)| told.to_string()).unwrap_or(out)
}

#[track_caller]
fn tells(settings: &[&str], question: &str, expected: &str) {
    assert_eq!(why(PROGRAM, settings, question), expected);
}

const PRESSED: [&str; 2] = ["go=1@10ms", "go=0@20ms"];

#[test]
fn outputs_of_blocks_are_followed_into_their_units_and_back_to_what_is_handed_over() {
    tells(
        &PRESSED,
        "Motor@10ms",
        "\
Motor is on: CAL One(s := go, r := halt, q => Motor) is executed  [main.il:21]
  One.q is on: ST q has power  [main.il:11]
    One.s is on: CAL One(s := go, r := halt, q => Motor) is executed  [main.il:8]
      go is on: it was set by hand  [main.il:21]
    One.r is off: CAL One(s := go, r := halt, q => Motor) is executed  [main.il:10]
      halt is off: nothing drives it
",
    );
    // The other instance of the unit has reasons of its own.
    tells(
        &["go=1"],
        "Two.q@20ms",
        "\
Two.q is off: ST q has no power  [main.il:11]
  Two.s is off: CAL Two(s := big, r := FALSE) is executed  [main.il:8]
    big is off: ST big has no power  [main.il:38]
      m GT 10 does not hold  [main.il:34]
        m is 6: LD n, MUL 2, ST m is executed  [main.il:31]
          n is 3: LD n, ADD 1, ST n is executed  [main.il:28]
  Two.q is off: so from the start on  [main.il:9]
",
    );
}

#[test]
fn timers_and_counters_say_how_far_they_are_and_what_drives_them() {
    let late = why(PROGRAM, &PRESSED, "late@50ms");
    let head = "late is off: ST late has no power  [main.il:26]\n  t.Q is off: 0.04 s of 0.1 s have passed  [main.il:25]\n    \
        Motor is on: CAL One(s := go, r := halt, q => Motor) is executed  [main.il:22]\n      One.q is on: ST q has power  [main.il:11]\n        \
        One.q is on since scan 1 (10 ms): ST q has power  [main.il:9]\n";
    assert!(late.starts_with(head), "{late}");
    let counter = why(PROGRAM, &PRESSED, "c.Q");
    assert!(
        counter.starts_with("c.Q is off: 1 of 2 are counted  [main.il:27]\n  late is on: ST late has power"),
        "{counter}"
    );
    let time = why(PROGRAM, &PRESSED, "t.ET@50ms");
    assert!(
        time.starts_with("t.ET is T#40ms: 0.04 s of 0.1 s have passed  [main.il:24]\n  Motor is on"),
        "{time}"
    );
}

#[test]
fn comparisons_and_calculations_say_what_their_words_are() {
    let big = why(PROGRAM, &PRESSED, "big");
    let head = "big is on: ST big has power  [main.il:37]\n  m GT 10 holds  [main.il:34]\n    m is 42: LD n, MUL 2, ST m is executed  [main.il:31]\n      \
        n is 21: LD n, ADD 1, ST n is executed  [main.il:28]\n  late is on: ST late has power";
    assert!(big.starts_with(head), "{big}");
    // A word has the value that it had where it was read.
    let program = "PROGRAM Main\nVAR\nn : INT := 4; few : BOOL;\nEND_VAR\nLD n\nLT 6\nST few\nLD n\nADD 1\nST n\nEND_PROGRAM\n";
    let few = why(program, &[], "few@10ms");
    assert_eq!(
        few,
        "few is on: ST few has power  [main.il:7]\n  n LT 6 holds  [main.il:5]\n    n is 5 since scan 0 (0 ms): LD n, ADD 1, ST n is executed  [main.il:8]\n"
    );
}

#[test]
fn names_that_several_units_have_are_kept_apart() {
    let unit = |name: &str, from: &str| {
        format!("PROGRAM {name}\nVAR\nx, a, b : BOOL;\nEND_VAR\nLD {from}\nST x\nEND_PROGRAM\n")
    };
    let program = unit("One", "a") + &unit("Two", "b");
    assert_eq!(
        why(&program, &["One.a=1"], "One.x"),
        "One.x is on: ST x has power  [main.il:6]\n  One.a is on since scan 0 (0 ms): it was set by hand  [main.il:5]\n"
    );
}

const LEFT: &str = "PROGRAM Main\nVAR\nf : F; go, has, y, w : BOOL; n, m : INT;\nEND_VAR\nLD go\nCALC f\nLD go\nJMPCN Past\n\
    LD has\nST y\nLD n\nADD 1\nST m\nJMP Over\nPast:\nLD has\nST w\nOver:\nLD go\nRETCN\nLD has\nS w\nEND_PROGRAM\n\
    FUNCTION_BLOCK F\nVAR q : BOOL; g : G; END_VAR\nLD TRUE\nST q\nCAL g\nEND_FUNCTION_BLOCK\n\
    FUNCTION_BLOCK G\nVAR k : INT; END_VAR\nLD k\nADD 1\nST k\nEND_FUNCTION_BLOCK\n";

#[test]
fn what_was_jumped_over_or_not_called_names_the_jump_and_the_call() {
    let tells = |settings: &[&str], question: &str, expected: &str| {
        assert_eq!(why(LEFT, settings, question), expected);
    };
    tells(
        &["has=1"],
        "y",
        "\
y is off: nothing that drives it has done so yet
  ST y is not executed  [main.il:10]
    JMPCN Past led past it  [main.il:8]
      go is off: nothing drives it  [main.il:7]
",
    );
    tells(
        &["go=1"],
        "w",
        "\
w is off: nothing that drives it has done so yet
  ST w is not executed  [main.il:17]
    JMP Over led past it  [main.il:14]
  S w has no power  [main.il:22]
    has is off: nothing drives it  [main.il:21]
",
    );
    tells(
        &["has=0"],
        "f.g.k",
        "\
f.g.k is 0: nothing that drives it has done so yet
  LD k, ADD 1, ST k is not executed  [main.il:32]
    CAL g is not executed  [main.il:28]
      CALC f has no power  [main.il:6]
        go is off: nothing drives it  [main.il:5]
",
    );
    tells(
        &["go=1", "go=0@100ms"],
        "m",
        "\
m is 1 since scan 0 (0 ms): LD n, ADD 1, ST m is executed  [main.il:11]
  n is 0: nothing drives it
  LD n, ADD 1, ST m is not executed  [main.il:11]
    JMPCN Past led past it  [main.il:8]
      go is off since scan 10 (100 ms): it was set by hand  [main.il:7]
",
    );
}
