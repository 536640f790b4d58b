//! Calls of function blocks and functions that a program declares itself: as boxes and back, proved, within a file and
//! across the files of a project.

use crate::binary::{folder, run};
use crate::translate_iec::{certain, drawing, list, to};
use rungwise::text::{Language, Span};
use rungwise::translate::{Certificate, Options, Proof, To, Translation, prove, translate};

/// A block with a bit as its first input, and one with none; functions with and without inputs.
const UNITS: &str = "\
FUNCTION_BLOCK Pump
VAR_INPUT
    Run   : BOOL;
    Level : INT;
END_VAR
VAR_IN_OUT
    Total : INT;
END_VAR
VAR_OUTPUT
    Speed : INT;
    Alarm : BOOL;
END_VAR

    LD      Run
    ST      Alarm

END_FUNCTION_BLOCK

FUNCTION_BLOCK Meter
VAR_INPUT
    Count : INT;
    Fast  : BOOL;
END_VAR
VAR_OUTPUT
    Sum : INT;
END_VAR

    LD      Count
    ADD     Sum
    ST      Sum

END_FUNCTION_BLOCK

FUNCTION Scale : INT
VAR_INPUT
    Value, Factor, Offset : INT;
END_VAR

    LD      Value
    ADD     Offset
    ST      Scale

END_FUNCTION

FUNCTION Safe : BOOL

    LD      TRUE
    ST      Safe

END_FUNCTION
";

const VARIABLES: &str =
    "a, b, c, d, y, z : BOOL; n, k, m, t : INT; P, R : Pump; Q : Meter; Held1 : BOOL;\nOdd : Unheard;";

/// A program with these variables behind the units.
fn with(variables: &str, body: &str) -> String {
    format!("{UNITS}\nPROGRAM Main\nVAR\n{variables}\nEND_VAR\n{body}\nEND_PROGRAM\n")
}

fn program(body: &str) -> String {
    with(VARIABLES, body)
}

/// The instructions of the last body of a list, with single blanks, joined by ` | `.
fn body(text: &str) -> String {
    let from = text.rfind("END_VAR").unwrap() + "END_VAR".len();
    let end = text.rfind("END_PROGRAM").unwrap();
    let lines = text[from..end].lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
    lines.filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" | ")
}

/// The notes of a translation, in English.
fn notes(translation: &Translation) -> Vec<String> {
    let notes = translation.rungs.iter().filter_map(|rung| rung.note.as_ref());
    notes.map(|note| note.render(Language::English)).collect()
}

#[test]
fn calls_are_boxes_and_come_back_as_they_were() {
    for (list_body, drawn_words) in [
        // The first input is a bit, so power drives it, and goes on from the first output that is one.
        ("CAL P(\nRun := a,\nLevel := n,\nTotal := t,\nAlarm => c\n)", "Run "),
        ("CAL P(\nRun := a,\nTotal := t,\nSpeed => m\n)\nLD P.Alarm\nAND b\nST y", "Speed|--m"),
        ("LD a\nAND b\nST P.Run\nCAL P(\nLevel := n,\nTotal := t\n)\nLD P.Alarm\nSTN y", "(/)"),
        // An output that has an operand is no wire.
        ("CAL P(\nRun := a,\nTotal := t,\nAlarm => c\n)\nLD P.Alarm\nST y", "Alarm|--c"),
        // Under a condition, without power, and where the first input is no bit.
        ("LD a\nCALC P(\nRun := b,\nTotal := t\n)", "EN       ENO"),
        ("LD a\nORN b\nCALCN P(\nRun := b,\nTotal := t\n)", "EN       ENO"),
        ("LD a\nCALC Q(\nCount := n,\nFast := b,\nSum => k\n)", "EN     ENO"),
        ("CAL Q(\nCount := n,\nFast := b\n)", "EN     ENO"),
        ("CAL Q", "EN     ENO"),
        // ENO is written whether the call is made or not, so that is no CALC.
        ("CAL P(\nEN := a,\nRun := b,\nTotal := t,\nENO => d\n)", "ENO|--d"),
        // Inputs that are stored before the call.
        ("LD n\nST Q.Count\nLD b\nST Q.Fast\nCAL Q", "Q.Count"),
        ("LD n\nST P.Level\nLD a\nOR b\nST P.Run\nCAL P(\nTotal := t\n)\nLD P.Alarm\nST z", "P.Level"),
        // Functions whose result is stored, under a condition, too.
        ("LD n\nScale k, 3\nST t", "Factor"),
        ("Safe()\nST y", "Safe"),
        ("LD a\nANDN b\nJMPCN Skip1\nLD n\nScale k, m\nST t\nSafe()\nST y\nSkip1:\nLD b\nST z", "OUT|--t"),
    ] {
        let drawn = certain(&list(&program(list_body)), To::Ladder);
        assert!(drawn.contains(drawn_words), "{drawn_words}\n{drawn}");
        let back = certain(&drawing(&drawn), To::Iec);
        let expected = list_body.split('\n').collect::<Vec<_>>().join(" | ");
        assert_eq!(body(&back), expected, "{drawn}");
        assert_eq!(certain(&drawing(&certain(&list(&back), To::Ladder)), To::Iec), back);
        for other in [&back, &drawn] {
            let document = if other == &drawn { drawing(other) } else { list(other) };
            let proof = prove(&list(&program(list_body)), &document);
            assert!(matches!(proof, Proof::Equal { .. }), "{proof:?}\n{other}");
        }
    }
}

#[test]
fn other_ways_to_write_a_call_are_the_same_one() {
    for (written, expected) in [
        ("CAL P(a, n, t, m, c)", "CAL P(\nRun := a,\nLevel := n,\nTotal := t,\nSpeed => m,\nAlarm => c\n)"),
        ("CAL p(\ntotal := t,\nrun := a\n)", "CAL p(\nRun := a,\nTotal := t\n)"),
        ("CAL P(\nEN := a,\nTotal := t\n)", "LD a\nCALC P(\nTotal := t\n)"),
        ("LD a\nCALCN Q", "LDN a\nCALC Q"),
        ("Scale(\nOffset := 3,\nValue := n,\nFactor := k\n)\nST t", "LD n\nScale k, 3\nST t"),
        ("Scale(n, k, 3)\nST t", "LD n\nScale k, 3\nST t"),
        // Power for ENO that is more than a contact stands in a variable.
        (
            "LD a\nOR b\nST Held1\nCAL P(\nEN := Held1,\nTotal := t,\nENO => d\n)",
            "LD a\nOR b\nST Held1\nCAL P(\nEN := Held1,\nTotal := t,\nENO => d\n)",
        ),
    ] {
        let drawn = certain(&list(&program(written)), To::Ladder);
        assert_eq!(body(&certain(&drawing(&drawn), To::Iec)), expected.replace('\n', " | "), "{drawn}");
    }
    // Power that a call has as an operand of EN, and that is more than a contact, is stored for it.
    let drawn = "
|                        P              |
|                  +------------+       |
|    a       b     |    Pump    |       |
+---| |-----| |----|EN       ENO|--d    |
|               t--|Total       |       |
|                  +------------+       |

END_PROGRAM";
    let text = certain(&list(&program("")), To::Ladder).replace("END_PROGRAM", drawn);
    let written = certain(&drawing(&text), To::Iec);
    let expected = "LD a | AND b | ST Enable1 | CAL P( | EN := Enable1, | Total := t, | ENO => d | )";
    assert!(body(&written).ends_with(expected) && written.contains("Enable1 : BOOL;"), "{written}");
}

#[test]
fn a_block_of_the_program_hides_one_of_the_standard() {
    let own = "FUNCTION_BLOCK TON\nVAR_INPUT\nLevel : INT;\nEND_VAR\nVAR_OUTPUT\nQ : BOOL;\nEND_VAR\n\
               LD Level\nGT 5\nST Q\nEND_FUNCTION_BLOCK\n";
    let text = |body: &str| {
        format!("{own}PROGRAM p\nVAR\nT : TON; n : INT; a, y : BOOL;\nEND_VAR\n{body}\nEND_PROGRAM\n")
    };
    let drawn = certain(&list(&text("LD a\nCALC T(\nLevel := n\n)")), To::Ladder);
    assert_eq!(body(&certain(&drawing(&drawn), To::Iec)), "LD a | CALC T( | Level := n | )");
    let unknown = to(&list(&text("CAL T(\nIN := a,\nPT := T#5s\n)")), To::Ladder);
    assert_eq!(notes(&unknown), ["`T` is not called as it is declared"], "{}", unknown.text);
    let fx = to(&list(&text("LD TRUE\nCALC T")), To::Fx);
    assert!(notes(&fx).contains(&"`T : TON` has no counterpart in the other language".into()), "{fx:?}");
}

#[test]
fn what_has_no_other_form_is_named() {
    for (form, rung, note) in [
        (To::Ladder, "CAL Nobody", "`Nobody` names no function block or function that is known here"),
        (To::Ladder, "CAL Odd(\nA := b\n)", "`Odd` names no function block or function that is known here"),
        (To::Ladder, "LD n\nFooo k\nST t", "`Fooo` names no function block or function that is known here"),
        (To::Ladder, "CAL P(\nWalk := b\n)", "`P` is not called as it is declared"),
        (To::Ladder, "LD a\nCALC P(\nRun := b,\nRun := c\n)", "`P` is not called as it is declared"),
        (To::Ladder, "LD a\nCALC P(\nENO => d\n)", "`P` is not called as it is declared"),
        (To::Ladder, "LD n\nScale k, 3\nADD 1\nST t", "it calculates with the current result"),
        (To::Fx, "LD TRUE\nCALC P(\nTotal := t\n)", "`P : Pump` has no counterpart in the other language"),
        (To::Fx, "LD TRUE\nJMPCN S\nSafe()\nST y\nS:", "`Safe` has no counterpart in the other language"),
        (To::Boolean, "LD a\nCALC P(\nTotal := t\n)", "`P : Pump` has no counterpart in the other language"),
        (
            To::Boolean,
            "CAL P(\nRun := a\n)\nLD P.Alarm\nST y",
            "`P : Pump` has no counterpart in the other language",
        ),
        (To::Boolean, "Safe()\nST y", "`Safe` has no counterpart in the other language"),
    ] {
        let text = program(rung);
        let translation = to(&list(&text), form);
        let at = text.rfind("END_VAR").unwrap();
        let own = translation.rungs.iter().find(|one| one.span.start as usize > at).unwrap();
        let said = own.note.as_ref().map(|note| note.render(Language::English));
        assert_eq!(said.as_deref(), Some(note), "{rung}\n{}", translation.text);
        if form == To::Ladder {
            assert!(translation.text.contains(&format!("{{il\n{rung}\n}}")), "{}", translation.text);
            assert_eq!(body(&to(&drawing(&translation.text), To::Iec).text), rung.replace('\n', " | "));
        }
    }
    let drawn = "\n|    a             P           |\n|           +-----------+      |\n+---| |-----|IN  Foo   Q|      |\n|           +-----------+      |\n";
    let translation = to(&drawing(drawn), To::Iec);
    assert_eq!(notes(&translation), ["`Foo` names no function block or function that is known here"]);
}

#[test]
fn a_part_of_a_program_is_proved_with_what_is_declared_around_it() {
    let text =
        program("LD b\nST y\n\nCAL P(\nRun := a,\nTotal := t\n)\nLD P.Alarm\nST z\n\nLD n\nScale k, 3\nST t");
    let part = |text: &str, from: &str, to: &str| {
        let start = text.rfind(from).unwrap();
        Span::new(start, start + text[start..].find(to).unwrap() + to.len())
    };
    let options = Options { is_whole: false, ..Options::default() };
    let drawn = certain(&list(&text), To::Ladder);
    for (document, form, parts) in [
        (list(&text), To::Ladder, [("CAL P", "ST z"), ("LD n", "ST t")]),
        (drawing(&drawn), To::Iec, [("|    | Pump", "( )"), ("| Scale", "Offset")]),
    ] {
        let own = document.text();
        for (from, to) in
            parts.map(|(from, to)| if own.contains(from) { (from, to) } else { ("Pump ", "Total") })
        {
            let translation = translate(&document, Some(part(&own, from, to)), form, &options);
            assert_eq!(translation.rungs.len(), 1, "{}", translation.text);
            let rung = &translation.rungs[0];
            assert_eq!(
                (rung.certificate, &rung.note),
                (Some(Certificate::Construction), &None),
                "{}",
                translation.text
            );
        }
    }
    // Contacts of edges need detectors, which nobody has declared yet.
    let drawn = drawn.replace("END_PROGRAM", "|   d      c |\n+--|P|----( )+\n\nEND_PROGRAM");
    let at = drawn.rfind("|P|").unwrap();
    let translation = translate(&drawing(&drawn), Some(Span::new(at, at + 1)), To::Iec, &options);
    assert_eq!(translation.rungs[0].certificate, Some(Certificate::Proved), "{}", translation.text);
}

/// The verdict on two bodies of the same program.
fn verdict(variables: &str, [left, right]: [&str; 2]) -> &'static str {
    let [left, right] = [left, right].map(|body| list(&with(variables, &body.replace(';', "\n"))));
    match prove(&left, &right) {
        Proof::Equal { .. } => "equal",
        Proof::Different(_) => "different",
        Proof::Undecided { .. } => "undecided",
    }
}

/// `g` is known outside, `s` is handed over, `i` lies at an address; the others are plain variables of the program.
const KNOWN: &str = "a, b, c, y, z, l : BOOL; n, k, t : INT; P, R : Pump; Q : Meter; T1 : TON; END_VAR\n\
    VAR i AT %IX0.0 : BOOL; o AT %QX0.0 : BOOL; END_VAR VAR_EXTERNAL g, h : BOOL; END_VAR VAR ";

#[test]
fn verdicts_on_calls_of_units() {
    const CALL: &str = "CAL P(Run := a, Level := n, Total := t)";
    let call = |body: &str| body.replace("CALL", CALL);
    let wrong: Vec<_> = [
        // By construction, in whatever words.
        ("CALL;LD P.Alarm;ST y", "CALL;LD P.Alarm;ST y", "equal"),
        ("CALL", "CAL P(a, n, t)", "equal"),
        ("LD a;ST P.Run;CAL P(Level := n, Total := t)", "CALL", "equal"),
        ("LD n;Scale k, 3;ST t", "Scale(Value := n, Factor := k, Offset := 3);ST t", "equal"),
        ("LD a;CALC Q;LD b;ST y", "LD a;CALC Q;LD b;ST y", "equal"),
        // Conditions that are equal, however written, and the order of what the call cannot see.
        ("LD a;AND b;CALC Q", "LD b;AND a;CALC Q", "equal"),
        ("LD a;ST l;CALL;LD l;ST y", "LD a;ST l;CALL;LD a;ST y", "equal"),
        ("LD a;ST y;LD b;ST z;CALL", "LD b;ST z;LD a;ST y;CALL", "equal"),
        // Other arguments, conditions, instances, outputs.
        ("CALL", "CAL P(Run := b, Level := n, Total := t)", "different"),
        ("LD a;CALC Q", "LDN a;CALC Q", "different"),
        ("LD a;CALC Q", "LD a;CALCN Q", "different"),
        (
            "CAL P(Run := a, Total := t, Alarm => c);LD c;ST y",
            "CAL P(Run := a, Total := t, Alarm => c);LDN c;ST y",
            "different",
        ),
        ("CAL Q;LD Q.Fast;ST y", "CAL Q;LDN Q.Fast;ST y", "different"),
        ("CALL;LD P.Alarm;OR b;ST y", "CALL;LDN P.Alarm;OR b;ST y", "different"),
        // What the call may have changed, and may not: what is known outside, what lies at an address, what it was
        // handed. What the unit really does is not looked at.
        ("LD g;ST l;CALL;LD g;ST y", "LD g;ST l;CALL;LD l;ST y", "undecided"),
        ("LD i;ST l;CALL;LD i;ST y", "LD i;ST l;CALL;LD l;ST y", "undecided"),
        ("LD t;GT 5;ST l;CALL;LD t;GT 5;ST y", "LD t;GT 5;ST l;CALL;LD l;ST y", "undecided"),
        ("LD T1.Q;ST l;CALL;LD T1.Q;ST y", "LD T1.Q;ST l;CALL;LD l;ST y", "undecided"),
        ("LD g;ST l;LD n;Scale k, 3;ST t;LD g;ST y", "LD g;ST l;LD n;Scale k, 3;ST t;LD l;ST y", "undecided"),
        ("CALL;LD P.Alarm;AND b;ST y", "CALL;LD P.Alarm;AND c;ST y", "undecided"),
        ("LD P.Alarm;ST l;CALL;LD P.Alarm;ST y", "LD P.Alarm;ST l;CALL;LD l;ST y", "undecided"),
        ("CALL;LD P.Alarm;ST y", "CALL;LD a;ST y", "undecided"),
        // An output that is moved over a call which may have changed it, or what drives it.
        ("LD g;ST y;CALL", "CALL;LD g;ST y", "undecided"),
        ("LD i;ST o;CALL", "CALL;LD i;ST o", "undecided"),
        ("LD b;ST y;CALL", "CALL;LD b;ST y", "undecided"),
        // It leaves alone what only the caller knows.
        ("LD b;ST l;CALL;LD b;ST y", "LD b;ST l;CALL;LD l;ST y", "equal"),
        ("LD n;GT 5;ST l;CALL;LD n;GT 5;ST y", "LD n;GT 5;ST l;CALL;LD l;ST y", "equal"),
    ]
    .into_iter()
    .flat_map(|(left, right, expected)| [(left, right, expected), (right, left, expected)])
    .map(|(left, right, expected)| (verdict(KNOWN, [&call(left), &call(right)]), expected, left, right))
    .filter(|(found, expected, ..)| found != expected)
    .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_a_unit_may_see_is_never_reordered() {
    const CALL: &str = "CAL P(Run := a, Level := n, Total := t)";
    let call = |body: &str| body.replace("CALL", CALL);
    let wrong: Vec<_> = [
        // Two calls in another order, and outputs moved over one that may see or change them.
        ("CALL;CAL Q", "CAL Q;CALL"),
        (
            "CAL P(Run := a, Total := t);CAL R(Run := a, Total := t)",
            "CAL R(Run := a, Total := t);CAL P(Run := a, Total := t)",
        ),
        ("LD b;ST g;CALL", "CALL;LD b;ST g"),
        ("LD b;ST o;CALL;LD c;ST o", "CALL;LD c;ST o"),
        ("LD b;ST g;LD n;Scale k, 3;ST t;LD c;ST g", "LD n;Scale k, 3;ST t;LD c;ST g"),
        // An input that keeps what was stored to it, of a block of the standard as well.
        ("LD b;ST Q.Fast;CAL Q;LD c;ST Q.Fast", "CAL Q;LD c;ST Q.Fast"),
        ("LD a;ST T1.IN;LD b;ST y;CAL T1;LD c;ST T1.IN", "LD b;ST y;CAL T1;LD c;ST T1.IN"),
        // What an earlier call handed over, this one may still change.
        ("LD n;GT 5;ST l;CAL P;LD n;GT 5;ST y", "LD n;GT 5;ST l;CAL P;LD l;ST y"),
        ("CALL", "CAL P(Run := a, Level := k, Total := t)"),
        ("CALL", "CAL P(Run := a, Level := n, Total := k)"),
        ("CALL", "CAL R(Run := a, Level := n, Total := t)"),
        ("LD n;Scale k, 3;ST t", "LD n;Scale k, 4;ST t"),
        ("CALL;LD P.Alarm;ST y", "CAL P(Run := a, Level := n, Total := t, Alarm => y)"),
    ]
    .into_iter()
    .flat_map(|(left, right)| [(left, right), (right, left)])
    .map(|(left, right)| (verdict(KNOWN, [&call(left), &call(right)]), left, right))
    .filter(|(found, ..)| *found == "equal")
    .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

const MANIFEST: &str = "dialect = \"iec\"\nfiles = [\"main.il\", \"units.il\"]\n";
const MAIN: &str = "\
PROGRAM Main
VAR
    a, b, y : BOOL;
    t : INT;
    P : Pump;
END_VAR

    LD      a
    AND     b
    ST      P.Run
    CAL     P(
        Level := 5,
        Total := t
    )
    LD      P.Alarm
    ST      y
    LD      t
    Scale   t, 3
    ST      t

END_PROGRAM
";

#[test]
fn the_files_of_a_project_know_each_others_units() {
    let files = [("rungwise.toml", MANIFEST), ("main.il", MAIN), ("units.il", UNITS)];
    let folder = folder(&files);
    let (code, drawn, err) = run(&folder, &["translate", "main.il", "--to", "ladder", "--prove"]);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("2 rungs: 0 proved equal, 2 equal by construction, 0 not decided"), "{err}");
    assert!(drawn.contains("Pump") && !drawn.contains("{il"), "{drawn}");
    // A file beside those of the project stands for the one that it is compared with.
    std::fs::write(folder.path().join("other.lad"), &drawn).unwrap();
    let (code, out, err) = run(&folder, &["prove", "main.il", "other.lad"]);
    assert_eq!(code, 0, "{out}{err}");
    assert_eq!(run(&folder, &["prove", "other.lad", "main.il"]).0, 0);
    let changed = drawn.replace("| |------|Run", "|/|------|Run");
    assert_ne!(changed, drawn);
    std::fs::write(folder.path().join("changed.lad"), changed).unwrap();
    let (code, out, _) = run(&folder, &["prove", "main.il", "changed.lad"]);
    assert_eq!((code, out.starts_with("different: P")), (1, true), "{out}");
    // And back, as a file of the project.
    let manifest = MANIFEST.replace("main.il", "main.lad");
    std::fs::write(folder.path().join("rungwise.toml"), manifest).unwrap();
    std::fs::rename(folder.path().join("other.lad"), folder.path().join("main.lad")).unwrap();
    let (code, back, err) = run(&folder, &["translate", "main.lad", "--to", "iec", "--prove"]);
    assert_eq!(code, 0, "{err}");
    assert_eq!(body(&back), body(MAIN), "{drawn}");
}

#[test]
fn units_of_different_projects_may_be_different_ones() {
    let other = UNITS.replace("LD      Run", "LDN     Run");
    let folder = folder(&[
        ("one/rungwise.toml", MANIFEST),
        ("one/main.il", MAIN),
        ("one/units.il", UNITS),
        ("two/rungwise.toml", MANIFEST),
        ("two/main.il", MAIN),
        ("two/units.il", &other),
        ("all.il", &format!("{UNITS}{MAIN}")),
        ("rest.il", &format!("{other}{MAIN}")),
    ]);
    for (left, right, expected) in [
        ("one/main.il", "one/main.il", "equal"),
        ("one/main.il", "two/main.il", "not decided: what `Pump` does is not compared"),
        ("one/main.il", "all.il", "not decided"),
        ("all.il", "all.il", "equal"),
        // The unit has an `Alarm`, too.
        ("all.il", "rest.il", "different: P.Alarm"),
    ] {
        let (_, out, err) = run(&folder, &["prove", left, right]);
        assert!(out.starts_with(expected), "{left} {right}: {out}{err}");
    }
    let (_, out, _) = run(&folder, &["prove", "one/main.il", "two/main.il", "--lang", "zh-CN"]);
    assert!(out.contains("`Pump` 的作用没有比较"), "{out}");
}

#[test]
fn a_drawing_without_declarations_knows_the_blocks_of_its_project() {
    let drawn = "
|                  P                     |
|            +------------+              |
|    a       |    Pump    |         y    |
+---| |------|Run    Alarm|--------( )---+
|         t--|Total       |              |
|            +------------+              |
";
    let folder = folder(&[
        ("rungwise.toml", "dialect = \"iec\"\nfiles = [\"main.lad\", \"units.il\"]\n"),
        ("main.lad", drawn),
        ("units.il", &format!("VAR_GLOBAL\n    y : BOOL;\nEND_VAR\n\n{UNITS}")),
    ]);
    let (code, written, err) = run(&folder, &["translate", "main.lad", "--to", "iec", "--prove"]);
    assert_eq!(code, 0, "{err}{written}");
    for declared in ["P : Pump;", "t : INT;", "a : BOOL;", "VAR_EXTERNAL\n    y : BOOL;\nEND_VAR"] {
        assert!(written.contains(declared), "{declared}\n{written}");
    }
    assert_eq!(body(&written), "CAL P( | Run := a, | Total := t | ) | LD P.Alarm | ST y");
}

#[test]
fn the_check_looks_at_pins_as_the_translation_does() {
    let folder = folder(&[
        ("rungwise.toml", "dialect = \"iec\"\nfiles = [\"main.lad\", \"units.il\"]\n"),
        ("main.il", MAIN),
        ("units.il", UNITS),
    ]);
    std::fs::write(folder.path().join("rungwise.toml"), MANIFEST).unwrap();
    let drawn = run(&folder, &["translate", "main.il", "--to", "ladder"]).1;
    std::fs::write(folder.path().join("rungwise.toml"), MANIFEST.replace("main.il", "main.lad")).unwrap();
    let found = |drawn: &str| {
        std::fs::write(folder.path().join("main.lad"), drawn).unwrap();
        let out = run(&folder, &["check", "main.lad"]).1;
        let lines = out.lines().filter(|line| line.contains("error[")).map(str::to_string);
        (lines.collect::<Vec<_>>(), run(&folder, &["translate", "main.lad", "--to", "iec"]).0)
    };
    assert_eq!(found(&drawn), (Vec::new(), 0));
    for (old, new, said) in [
        ("Level ", "Lvl   ", "Pump has no input Lvl; it has Run, Level, Total"),
        ("Alarm|", "Alert|", "Pump has no output Alert; it has Speed, Alarm"),
        ("Factor ", "Faktor ", "Scale has no input Faktor; it has Value, Factor, Offset"),
    ] {
        let wrong = drawn.replacen(old, new, 1);
        assert_ne!(wrong, drawn);
        let (errors, code) = found(&wrong);
        assert!(errors.len() == 1 && errors[0].ends_with(said), "{errors:?}\n{wrong}");
        assert_eq!(code, 1, "{wrong}");
    }
}

/// Why what a unit does is not compared: who declares it where.
#[test]
fn a_unit_that_may_be_another_one_is_told_with_the_reason() {
    let unit =
        "FUNCTION Twice : INT\nVAR_INPUT\n    In : INT;\nEND_VAR\nLD In\nADD In\nST Twice\nEND_FUNCTION\n";
    let caller = "PROGRAM Main\nVAR\n    n, k : INT;\nEND_VAR\nLD n\nTwice\nST k\nEND_PROGRAM\n";
    let both = format!("{unit}{caller}");
    let manifest = "target = \"iec\"\n";
    let files = [
        ("one/rungwise.toml", manifest),
        ("one/unit.il", unit),
        ("one/main.il", caller),
        ("one/whole.il", &both),
        ("two/rungwise.toml", manifest),
        ("two/unit.il", unit),
        ("two/main.il", caller),
        ("two/whole.il", &both),
    ];
    let folder = folder(&files);
    let told =
        |left: &str, right: &str, language: &str| run(&folder, &["prove", left, right, "--lang", language]).1;
    let says = |left, right, words: &str| {
        let said = told(left, right, "en");
        assert!(said.contains(words), "{said}");
    };
    says("one/main.il", "two/main.il", "declared in other files, which belong to different projects");
    says("one/main.il", "two/whole.il", "one side declares it itself, for the other another file does");
    let said = told("one/main.il", "two/whole.il", "zh-CN");
    assert!(said.contains("一方自己声明了它"), "{said}");
}

#[test]
fn a_long_chain_of_blocks_that_call_each_other_is_translated_and_proved() {
    const BLOCKS: usize = 1000;
    let chain = |last: &str| {
        let block = |number: usize| {
            let (own, body) = match number + 1 < BLOCKS {
                true => {
                    (format!("Next : B{};", number + 1), "CAL Next(\nRun := Run\n)\nLD Next.Q".to_string())
                }
                false => ("Own : BOOL;".to_string(), format!("{last} Run")),
            };
            format!(
                "FUNCTION_BLOCK B{number}\nVAR_INPUT\nRun : BOOL;\nEND_VAR\nVAR_OUTPUT\nQ : BOOL;\nEND_VAR\n\
                 VAR\n{own}\nEND_VAR\n{body}\nST Q\nEND_FUNCTION_BLOCK\n\n"
            )
        };
        let blocks: String = (0..BLOCKS).map(block).collect();
        list(&format!(
            "{blocks}PROGRAM Main\nVAR\na, y : BOOL;\nB : B0;\nEND_VAR\nCAL B(\nRun := a\n)\nLD B.Q\nST y\nEND_PROGRAM\n"
        ))
    };
    let (own, other) = (chain("LD"), chain("LDN"));
    assert!(matches!(prove(&own, &own), Proof::Equal { .. }));
    // Who calls a block may never do it so that a difference inside is seen, and so many are not run.
    assert!(matches!(prove(&own, &other), Proof::Undecided { .. }));
    let translation = to(&own, To::Ladder);
    assert!(translation.rungs.iter().all(|rung| rung.certificate.is_some_and(Certificate::is_certain)));
}
