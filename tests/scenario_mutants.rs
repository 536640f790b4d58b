//! Mutants: what is otherwise in them, and that it is nothing else.

use rungwise::document::Document;
use rungwise::project::{Manifest, open_document};
use rungwise::scenario::{Bench, Mutants};
use rungwise::text::Language;
use rungwise::translate::{Proof, prove};

/// What each mutant of a program is called, and the lines that are otherwise in it.
fn mutants(name: &str, text: &str) -> Vec<(String, String)> {
    let document = open_document(name, text, &Manifest::default(), None, None);
    let documents: [&Document; 1] = [&document];
    let mutants = Mutants::of(&documents);
    let told = mutants.sample(usize::MAX, 0).into_iter().map(|mutant| {
        let made = mutants.documents(mutant).map(|made| made[0].text()).unwrap_or_default();
        let new: Vec<&str> = made.lines().filter(|line| !text.lines().any(|old| old == *line)).collect();
        (mutant.change.message().render(Language::English), new.join(" / "))
    });
    told.collect()
}

#[test]
fn a_list_has_faults_of_all_kinds() {
    let found = mutants(
        "a.il",
        "LD X0\nOR Y0\nANDP X1\nOUT Y0\nLD X2\nSET M0\nLDI X3\nRST M0\nLD M0\nOUT T0 K5\nOUT C0 K5\nEND\n",
    );
    let told: Vec<String> = found.iter().map(|(what, new)| format!("{what} | {new}")).collect();
    let expected = [
        "X0: the branch left out | LD Y0",
        "X0: normally closed in place of normally open, or the other way round | LDI X0",
        "Y0: the branch left out | ",
        "Y0: normally closed in place of normally open, or the other way round | ORI Y0",
        "X1: normally closed in place of normally open, or the other way round | ANDF X1",
        "X1: the contact left out, power always passes | ",
        "X2: normally closed in place of normally open, or the other way round | LDI X2",
        "X2: the contact left out, power always passes | LD M8000",
        "M0: reset in place of set | ",
        "X3: normally closed in place of normally open, or the other way round | LD X3",
        "X3: the contact left out, power always passes | LD M8000",
        "M0: set in place of reset | ",
        "M0: normally closed in place of normally open, or the other way round | LDI M0",
        "M0: the contact left out, power always passes | LD M8000",
        "T0: the preset K10 | OUT T0 K10",
        "C0: the preset K6 | OUT C0 K6",
    ];
    assert_eq!(told, expected);
}

#[test]
fn a_drawing_is_drawn_anew_where_the_fault_is() {
    let text = "|  X0        X1     Y0  |\n+--| |---+---|/|----( )-+\n|  Y0    |              |\n+--| |---+              |\n\n|  X2               M0  |\n+--| |--------------(S)-+\n";
    let document = open_document("a.lad", text, &Manifest::default(), None, None);
    let documents: [&Document; 1] = [&document];
    let mutants = Mutants::of(&documents);
    assert_eq!(mutants.len(), 9);
    for mutant in mutants.sample(usize::MAX, 0) {
        let made = &mutants.documents(mutant).unwrap()[0];
        assert!(matches!(prove(&document, made), Proof::Different(_)), "{mutant:?}\n{}", made.text());
        // The other rung is as it was.
        let other = if mutant.span.start < 100 {
            "|  X2               M0  |\n+--| |--------------(S)-+\n"
        } else {
            &text[..100]
        };
        assert!(made.text().contains(other), "{mutant:?}\n{}", made.text());
    }
}

#[test]
fn lists_of_iec_have_faults_too() {
    let found = mutants(
        "a.il",
        "PROGRAM a\nVAR\nx : BOOL;\ny : BOOL;\nz : BOOL;\nEND_VAR\nLD x\nOR y\nST z\nLD y\nS x\nEND_PROGRAM\n",
    );
    let told: Vec<String> = found.iter().map(|(what, new)| format!("{what} | {}", new.trim())).collect();
    assert!(told.iter().any(|line| line.contains("x: normally closed") && line.contains("LDN")), "{told:#?}");
    assert!(told.iter().any(|line| line.starts_with("x: reset in place of set")), "{told:#?}");
}

#[test]
fn presets_and_constants_are_others() {
    let fx = "LD= D0 K5\nAND> D1 H10\nMOV K7 D2\nLD X0\nDCMP D4 K100000 M0\nEND\n";
    let told: Vec<String> = mutants("a.il", fx)
        .into_iter()
        .filter(|(what, _)| what.contains("constant"))
        .map(|(what, new)| format!("{what} | {new}"))
        .collect();
    let expected = [
        "D0: the constant K6 in place of K5 | LD= D0 K6",
        "D2: the constant K8 in place of K7 | MOV K8 D2",
        "D4: the constant K100001 in place of K100000 | DCMP D4 K100001 M0",
    ];
    assert_eq!(told, expected);
    let head = "PROGRAM a\nVAR x, y : BOOL; t : TON; c : CTU; n : INT; END_VAR\n";
    let iec = format!(
        "{head}LD x\nST t.IN\nCAL t(PT := T#1s500ms)\nCAL c(CU := x, PV := INT#3)\nLD n\nGT 4\nST y\nLD 9\nST n\nEND_PROGRAM\n"
    );
    let told: Vec<String> = mutants("a.il", &iec)
        .into_iter()
        .filter(|(what, _)| what.contains("constant"))
        .map(|(what, new)| format!("{what} | {new}"))
        .collect();
    let expected = [
        "t: the constant T#3s in place of T#1s500ms |     CAL     t( /         IN := x, /         PT := T#3s /     )",
        "c: the constant INT#4 in place of INT#3 |     CAL     c( /         CU := x, /         PV := INT#4 /     )",
        "n: the constant 5 in place of 4 |     LD      n /     GT      5 /     ST      y",
        "n: the constant 10 in place of 9 |     LD      10 /     ST      n",
    ];
    assert_eq!(told, expected);
}

#[test]
fn faults_behind_detectors_of_edges_declare_what_they_need_and_run() {
    for (head, end) in [("PROGRAM a\nVAR", "END_VAR"), ("PROGRAM a VAR", "END_VAR (* all *)")] {
        let text = format!(
            "{head} go, halt, Motor : BOOL; e : R_TRIG; f : F_TRIG; {end}\n\
            CAL e(CLK := go)\nLD e.Q\nOR Motor\nANDN halt\nST Motor\nCAL f(CLK := go)\nLD f.Q\nR Motor\nEND_PROGRAM\n"
        );
        let document = open_document("a.il", &text, &Manifest::default(), None, None);
        let documents: [&Document; 1] = [&document];
        let mutants = Mutants::of(&documents);
        assert_eq!(mutants.len(), 9);
        for mutant in mutants.sample(usize::MAX, 0) {
            let made = &mutants.documents(mutant).unwrap_or_else(|| panic!("{mutant:?}"))[0];
            let all: [&Document; 1] = [made];
            assert!(rungwise::simulate::compile(&all, false).is_ok(), "{mutant:?}\n{}", made.text());
        }
    }
}

/// Drawings of two rungs whose rails stand where none are drawn by the writer of mutants.
const ODD_RAILS: [&str; 8] = [
    // A rail that begins above the first rung, and none on the right.
    "|\n+------+\n|      |  one    red\n| two  +--[ ]-+--( )-\n+-[ ]---------+\n|             |  dim\n|             +--( )-\n",
    // It goes on below the last one.
    "|   X0      X1        Y0  |\n+---| |-----|/|------( )--+\n|   X2                Y1  |\n+---| |--------------( )--+\n|                         |\n|                         |\n",
    "    a      b        y\n ---] [----]/[-----( )\n\n    c               z\n ---] [------------( )\n",
    "    a      b        y    |\n ---] [----]/[-----( )---|\n    c               z    |\n ---] [------------( )---|\n",
    "|   a      b        y\n|---] [----]/[-----( )\n|   c               z\n|---] [------------( )\n",
    "||   a      b        y   ||\n||--] [----]/[-----( )---||\n||   c               z   ||\n||--] [------------( )---||\n",
    "        |   X0      X1        Y0  |\n        +---| |-----|/|------( )--+\n        |                         |\n        |   X2                Y1  |\n        +---| |--------------( )--+\n",
    "|   a      b    |    y   |\n|---] [---]/[---|---( )--|\n|   c           |    z   |\n|---] [---------|---( )--|\n",
];

#[test]
fn mutants_of_drawings_with_odd_rails_run_and_are_others() {
    for text in ODD_RAILS {
        let document = open_document("a.lad", text, &Manifest::default(), None, None);
        assert!(Bench::new(&[&document]).is_ok(), "{text}");
        let documents: [&Document; 1] = [&document];
        let mutants = Mutants::of(&documents);
        assert!(mutants.len() >= 4, "{text}");
        for mutant in mutants.sample(usize::MAX, 0) {
            let told = mutant.change.message().render(Language::English);
            let made = mutants.documents(mutant).unwrap_or_else(|| panic!("{told} is not written\n{text}"));
            assert!(Bench::new(&[&made[0]]).is_ok(), "{told} does not run\n{text}\n{}", made[0].text());
            let is_other = matches!(prove(&document, &made[0]), Proof::Different(_));
            assert!(is_other, "{told} is the same\n{text}\n{}", made[0].text());
        }
    }
}
