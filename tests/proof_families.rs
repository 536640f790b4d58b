//! What is proved equal of a program of the FX family and one of IEC 61131-3, and what a translation between them is
//! sure of, does the same on the simulated PLC from the moment when it is switched on: random programs with edges,
//! timers, counters, jumps, values at first and what is kept without power, run side by side with random inputs.

use crate::proof_shown::Dice;
use rungwise::document::{Document, Notation};
use rungwise::simulate::{Code, Machine, Value, Variable, compile};
use rungwise::target::{Model, Target};
use rungwise::text::Span;
use rungwise::translate::{Certificate, Options, Proof, To, Translation, prove, translate, variable_called};
use std::sync::Arc;

fn fx(body: &str) -> Document {
    Document::new(&format!("{body}END\n"), Notation::FxIl, Target::of(Model::Fx2n))
}

fn iec(text: &str) -> Document {
    Document::new(text, Notation::IecIl, Target::of(Model::Iec))
}

/// A contact behind `word`: a bit, an edge, a comparison.
fn fx_contact(dice: &mut Dice, word: &str) -> String {
    let bit = dice.one(&["X0", "X1", "X2", "M0", "M1", "Y0", "T0", "C0", "M500", "M8000", "S0"]);
    let kind = match dice.roll(9) {
        0..4 => word,
        4 => return format!("{}I {bit}\n", if word == "LD" { "LD" } else { &word[..2] }),
        5 => return format!("{word}P {bit}\n"),
        6 => return format!("{word}F {bit}\n"),
        7 => {
            let sign = dice.one(&["=", ">", "<", ">=", "<=", "<>"]);
            let sides = dice.one(&["C0 K1", "C0 K2", "C0 K3", "K2 C0", "D0 K1", "D0 D1", "C0 K-1", "C0 D0"]);
            return format!("{word}{sign} {sides}\n");
        }
        _ => return format!("{word} {}\n", dice.one(&["M8002", "T1", "X0", "X1"])),
    };
    format!("{kind} {bit}\n")
}

fn fx_rung(dice: &mut Dice) -> String {
    let mut rung = fx_contact(dice, "LD");
    for _ in 0..dice.roll(3) {
        let word = dice.one(&["AND", "OR"]);
        rung += &fx_contact(dice, word);
    }
    if dice.roll(10) == 0 {
        rung += "INV\n";
    }
    for _ in 0..1 + dice.roll(4) / 3 {
        rung += dice.one(&[
            "OUT Y0\n",
            "OUT Y1\n",
            "OUT M0\n",
            "SET M1\n",
            "RST M1\n",
            "SET Y2\n",
            "PLS M0\n",
            "PLF M1\n",
            "PLF Y1\n",
            "OUT T0 K0\n",
            "OUT T0 K1\n",
            "OUT T0 K3\n",
            "OUT T1 K2\n",
            "OUT C0 K2\n",
            "OUT C0 K2\n",
            "OUT C0 K0\n",
            "OUT C0 D0\n",
            "RST C0\n",
            "MOV K2 D0\n",
            "MOVP K32767 D1\n",
            "ADDP D0 D1 D0\n",
            "INCP D0\n",
            "SUBP D1 D0 D1\n",
            "MULP D0 D1 D4\n",
            "DIVP D0 K-7 D2\n",
            "NEGP D1\n",
            "CMP D0 K1 M4\n",
            "SET M500\n",
            "RST M500\n",
            "OUT C100 K2\n",
            "SET S0\n",
            "ZRST C0 C1\n",
            "RST D0\n",
            "CJ P0\n",
            "CJ P63\n",
            "CJ P0\n",
        ]);
        if rung.contains("CJ") {
            break;
        }
    }
    rung
}

fn fx_body(dice: &mut Dice) -> Vec<String> {
    let mut rungs: Vec<String> = (0..1 + dice.roll(5)).map(|_| fx_rung(dice)).collect();
    if rungs.iter().any(|rung| rung.contains("CJ P0")) {
        let at = dice.roll(rungs.len() + 1);
        rungs.insert(at, "P0\n".into());
    }
    if dice.roll(12) == 0 {
        let at = dice.roll(rungs.len());
        rungs.insert(at, "END\n".into());
    }
    rungs
}

const DECLARED: [&str; 22] = [
    "X0 AT %IX0.0 : BOOL;",
    "X1 AT %IX0.1 : BOOL;",
    "X2 AT %IX0.2 : BOOL;",
    "Y0 AT %QX0.0 : BOOL;",
    "Y1 AT %QX0.1 : BOOL;",
    "Y2 AT %QX0.2 : BOOL;",
    "M0 AT %MX0.0 : BOOL;",
    "M1 AT %MX0.1 : BOOL;",
    "M4 AT %MX0.4 : BOOL;",
    "M5 AT %MX0.5 : BOOL;",
    "M6 AT %MX0.6 : BOOL;",
    "M500 AT %MX62.4 : BOOL;",
    "D0 AT %MW1000 : INT;",
    "D1 AT %MW1001 : INT;",
    "T0 : TON;",
    "T1 : TON;",
    "C0 : CTU;",
    "up : R_TRIG;",
    "down : F_TRIG;",
    "Pulse1 : R_TRIG;",
    "Was1, Fall1 : BOOL;",
    "PLF_M1, Was2, Held1 : BOOL;",
];

/// Declarations, some of which say what there is at first, or what is kept.
fn iec_head(dice: &mut Dice) -> String {
    let mut head = String::from("PROGRAM Main\n");
    for declared in DECLARED {
        let value = match dice.roll(24) {
            0 if declared.ends_with("BOOL;") => " := TRUE;",
            1 if declared.ends_with("INT;") => " := 3;",
            0..12 if declared.ends_with("CTU;") => " := (PV := 2);",
            12 if declared.ends_with("CTU;") => " := (CV := 1);",
            _ => ";",
        };
        let section = match dice.roll(24) {
            0 => "VAR RETAIN",
            1..20 if declared.starts_with("M500") => "VAR RETAIN",
            _ => "VAR",
        };
        head += &format!("{section} {}{value} END_VAR\n", declared.trim_end_matches(';'));
    }
    head
}

fn iec_condition(dice: &mut Dice) -> String {
    let bit = |dice: &mut Dice| {
        dice.one(&[
            "X0", "X1", "X2", "M0", "M1", "Y0", "T0.Q", "C0.Q", "M500", "TRUE", "X0", "up.Q", "down.Q",
        ])
    };
    let mut text = match dice.roll(6) {
        0 => {
            let compare = dice.one(&["GT", "EQ", "LT", "NE", "GE", "LE"]);
            let pair = dice.one(&["C0.CV;1", "C0.CV;2", "C0.CV;3", "2;C0.CV", "D0;1", "D0;D1"]);
            let (left, right) = pair.split_once(';').unwrap_or_default();
            format!("LD {left}\n{compare} {right}\n")
        }
        _ => format!("{} {}\n", dice.one(&["LD", "LD", "LDN"]), bit(dice)),
    };
    for _ in 0..dice.roll(3) {
        text += &format!("{} {}\n", dice.one(&["AND", "ANDN", "OR", "ORN"]), bit(dice));
    }
    text
}

fn iec_rung(dice: &mut Dice) -> String {
    let of = |dice: &mut Dice| dice.one(&["X0", "X1", "M0", "M1", "Y0"]);
    match dice.roll(18) {
        0 => format!("CAL T0(IN := {}, PT := T#{}ms)\n", of(dice), dice.one(&["0", "100", "300", "150"])),
        1 => format!("{}ST T1.IN\nCAL T1(PT := T#200ms)\n", iec_condition(dice)),
        2 | 3 => format!("CAL C0(CU := {}, PV := {})\n", of(dice), dice.one(&["2", "2", "2", "0", "D0"])),
        4 | 5 => format!("{}R C0\n", iec_condition(dice)),
        6 => format!("CAL up(CLK := {})\nLD up.Q\n{}", of(dice), dice.one(&["ST Y1\n", "S Y2\n", "R Y2\n"])),
        7 | 8 => format!("CAL down(CLK := {})\nLD down.Q\n{}", of(dice), dice.one(&["ST Y1\n", "S Y2\n"])),
        9 => {
            let bit = of(dice);
            format!("LD Was1\nANDN {bit}\nST Fall1\nLD {bit}\nST Was1\nLD Fall1\nAND X2\nST Y1\n")
        }
        10 => format!("{}ST PLF_M1\nLD Was2\nANDN PLF_M1\nST M1\nLD PLF_M1\nST Was2\n", iec_condition(dice)),
        11 => format!("{}JMPCN Over{}\nLD D0\nADD D1\nST D0\nOver{0}:\n", iec_condition(dice), dice.roll(99)),
        12 => format!("LD {}\nST {}\n", dice.one(&["3", "D0", "32767", "C0.CV"]), dice.one(&["D0", "D1"])),
        13 => {
            let call = "ST Pulse1.CLK\nCAL Pulse1\nLD Pulse1.Q\nJMPCN Past\nLD D0\nADD INT#1\nST D0\nPast:\n";
            iec_condition(dice) + call
        }
        14 => iec_condition(dice) + dice.one(&["JMPC Behind\n", "JMPC Behind\n", "RETC\n"]),
        _ => {
            iec_condition(dice)
                + dice.one(&["ST Y0\n", "ST Y1\n", "ST M0\n", "S M1\n", "R M1\n", "S M500\n", "STN M0\n"])
        }
    }
}

fn iec_body(dice: &mut Dice) -> Vec<String> {
    let mut rungs: Vec<String> = (0..1 + dice.roll(5)).map(|_| iec_rung(dice)).collect();
    if rungs.iter().any(|rung| rung.contains("Behind")) {
        let at = dice.roll(rungs.len() + 1);
        rungs.insert(at, "Behind:\n".into());
    }
    rungs
}

/// What is looked at behind each scan.
const SEEN: [&str; 16] =
    ["Y0", "Y1", "Y2", "M0", "M1", "M4", "M5", "M6", "M500", "S0", "D0", "D1", "D2", "D3", "TS0", "CS0"];

fn found(code: &Code, name: &str) -> Option<Variable> {
    let other = variable_called(name);
    let names = [Some(name.to_string()), other].into_iter().flatten();
    names.into_iter().find_map(|name| code.variable(&name))
}

/// What differs in the scans of two programs from the moment when the PLC is switched on.
fn seen_apart(sides: [&Document; 2]) -> Option<String> {
    let codes = sides.map(|side| compile(&[side], false).ok().map(Arc::new));
    let [Some(left), Some(right)] = codes else { return None };
    let codes = [left, right];
    for seed in 0..8 {
        let mut dice = Dice(seed * 7877 + 3);
        let mut machines = codes.each_ref().map(|code| Machine::<u8>::new(Arc::clone(code)));
        let mut time = 0;
        let mut told = String::new();
        for scan in 0..16 {
            time += [10, 50, 100, 100, 300][dice.roll(5)] * 1_000_000;
            for input in ["X0", "X1", "X2"] {
                let value = Value::Bit(dice.roll(2) == 1);
                told += &format!("{input}={value} ");
                for (side, machine) in machines.iter_mut().enumerate() {
                    if let Some(touch) =
                        found(&codes[side], input).and_then(|input| input.set(&codes[side], &value))
                    {
                        touch.apply(machine);
                    }
                }
            }
            let failed = machines.each_mut().map(|machine| !machine.scan(time).errors.is_empty());
            if failed.contains(&true) {
                break;
            }
            for name in SEEN {
                let both = [0, 1].map(|side| found(&codes[side], name));
                let [Some(left), Some(right)] = both else { continue };
                let values = [machines[0].value(left, 0), machines[1].value(right, 0)];
                if values[0] != values[1] {
                    return Some(format!(
                        "{name} is {values:?} in scan {scan} at {} ms: {told}",
                        time / 1_000_000
                    ));
                }
            }
            told += "| ";
        }
    }
    None
}

#[derive(Default, Debug)]
struct Count {
    equal: usize,
    undecided: usize,
    different: usize,
    certain: usize,
    wrong: Vec<String>,
}

impl Count {
    /// `left` and what was made of it, or of something like it.
    fn note(&mut self, left: &Document, translation: &Translation, right: &Document, is_own: bool) {
        let is_certain = is_own && translation.is_certain();
        self.certain += usize::from(is_certain);
        let proof = prove(left, right);
        let is_equal = matches!(proof, Proof::Equal { .. });
        match proof {
            Proof::Equal { .. } => self.equal += 1,
            Proof::Undecided { .. } => self.undecided += 1,
            Proof::Different(_) => self.different += 1,
        }
        if !is_certain && !is_equal {
            return;
        }
        if let Some(seen) = seen_apart([left, right]) {
            let said = if is_equal { "equal" } else { "certain" };
            self.wrong.push(format!("{said}, and {seen}\n{}\n--\n{}", left.text(), right.text()));
        }
    }

    fn judge(&self) {
        let cases: Vec<&str> = self.wrong.iter().take(4).map(String::as_str).collect();
        assert!(self.wrong.is_empty(), "{} of\n{}", self.wrong.len(), cases.join("\n=====\n"));
        let Count { equal, undecided, different, certain, .. } = self;
        assert!(
            *equal > 5 && *undecided > 0 && *different > 0 && *certain > 5,
            "{equal} {undecided} {different} {certain}"
        );
    }
}

fn cases() -> u64 {
    std::env::var("RUNGWISE_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(150)
}

#[test]
fn what_is_equal_in_iec_runs_as_in_fx() {
    let mut count = Count::default();
    for seed in 0..cases() {
        let mut dice = Dice(seed * 7919 + 17);
        let rungs = fx_body(&mut dice);
        let mut others = rungs.clone();
        let at = dice.roll(others.len());
        others[at] = fx_rung(&mut dice);
        for (rungs, made_of, is_own) in [(&rungs, &rungs, true), (&rungs, &others, false)] {
            let left = fx(&rungs.concat());
            let translation = translate(&fx(&made_of.concat()), None, To::Iec, &Options::default());
            count.note(&left, &translation, &iec(&translation.text), is_own);
        }
    }
    count.judge();
}

#[test]
fn what_is_equal_in_fx_runs_as_in_iec() {
    let mut count = Count::default();
    for seed in 0..cases() {
        let mut dice = Dice(seed * 104_729 + 29);
        let head = iec_head(&mut dice);
        let rungs = iec_body(&mut dice);
        let mut others = rungs.clone();
        let at = dice.roll(others.len());
        others[at] = iec_rung(&mut dice);
        let program = |rungs: &[String]| iec(&format!("{head}{}END_PROGRAM\n", rungs.concat()));
        for (made_of, is_own) in [(&rungs, true), (&others, false)] {
            let translation = translate(&program(made_of), None, To::Fx, &Options::default());
            let right = Document::new(&translation.text, Notation::FxIl, Target::of(Model::Fx2n));
            count.note(&program(&rungs), &translation, &right, is_own);
        }
    }
    count.judge();
}

/// Instructions parted by semicolons, as a list has them.
fn lines(text: &str) -> String {
    text.replace("; ", "\n") + "\n"
}

/// A program of IEC 61131-3 with these declarations, of which each is a section or one in VAR.
fn program(declared: &str, body: &str) -> Document {
    let sections = declared.split(" | ").map(|own| match own.starts_with("VAR") {
        true => format!("{own} END_VAR\n"),
        false => format!("VAR {own} END_VAR\n"),
    });
    iec(&format!("PROGRAM Main\n{}{}END_PROGRAM\n", sections.collect::<String>(), lines(body)))
}

fn list(body: &str) -> Document {
    fx(&lines(body))
}

/// The key of the reason why nothing is proved of two programs.
fn reason(left: &Document, right: &Document) -> String {
    match prove(left, right) {
        Proof::Undecided { reason, .. } => reason.key().into(),
        other => format!("{other:?}\n{}\n--\n{}", left.text(), right.text()),
    }
}

/// What a translation says of the first rung that it says something of, and its text. What it says makes it uncertain.
fn said(document: &Document, to: To) -> (String, String) {
    let translation = translate(document, None, to, &Options::default());
    let noted = translation.rungs.iter().find(|rung| rung.note.is_some());
    let key = noted.and_then(|rung| rung.note.as_ref()).map(|note| note.key().to_string());
    let is_silent = key.is_none();
    assert_eq!(translation.is_certain(), is_silent, "{}", translation.text);
    assert!(noted.is_none_or(|rung| rung.certificate == Some(Certificate::Undecided)));
    (key.unwrap_or_default(), translation.text)
}

#[test]
fn a_value_at_first_is_given_in_the_first_scan_of_an_fx_list() {
    let run = "run AT %MX0.0 : BOOL";
    let rest = "y AT %QX0.0 : BOOL; D0 AT %MW1000 : INT";
    for (declared, body, other, first) in [
        (format!("{run} := TRUE; {rest};"), "LD run; ST y", "LD M0; OUT Y0", "SET M0"),
        (format!("{run} := BOOL#1; {rest};"), "LD run; ST y", "LD M0; OUT Y0", "SET M0"),
        // Nobody names it, and the output is on.
        (format!("{run}; {rest}; z AT %QX0.1 : BOOL := TRUE;"), "LD run; ST y", "LD M0; OUT Y0", "SET Y1"),
        (
            format!("{run} := 1; {rest} := 16#FF; d AT %MD510 : DINT := -70000;"),
            "LD D0; GT 3; ST y; LD d; EQ 0; ST run",
            "LD> D0 K3; OUT Y0; LDD= D20 K0; OUT M0",
            "SET M0\nMOV K255 D0\nDMOV K-70000 D20",
        ),
        (
            "VAR_GLOBAL M3 AT %MX0.3 : BOOL := TRUE; | y AT %QX0.0 : BOOL;".into(),
            "LD y; ST y",
            "LD Y0; OUT Y0",
            "SET M3",
        ),
    ] {
        // What all know stands before the program.
        let declared = declared.split_once(" | ").map_or(program(&declared, body), |(global, own)| {
            iec(&format!("{global} END_VAR\n{}", program(own, body).text()))
        });
        let (note, written) = said(&declared, To::Fx);
        assert_eq!(note, "", "{}", declared.text());
        assert_eq!(written, format!("LD M8002\n{first}\n{}END\n", lines(other)));
        let (without, with) = (list(other), fx(written.trim_end_matches("END\n")));
        for [left, right] in [[&declared, &with], [&with, &declared]] {
            let proof = prove(left, right);
            assert!(matches!(proof, Proof::Equal { .. }), "{proof:?} {written}");
        }
        for [left, right] in [[&declared, &without], [&without, &declared]] {
            assert!(!matches!(prove(left, right), Proof::Equal { .. }), "{written}");
        }
        assert_eq!(seen_apart([&declared, &with]), None);
    }
    let on = program(&format!("{run} := TRUE; {rest};"), "LD run; ST y");
    assert!(matches!(prove(&on, &list("LD M0; OUT Y0")), Proof::Different(_)));
    // A part of a program has no first scan.
    let part = on.text().find("LD run").map(|at| Span::new(at, at + 1));
    let rung = translate(&on, part, To::Fx, &Options { is_whole: false, ..Options::default() });
    assert!(!rung.text.contains("M8002") && rung.rungs[0].note.is_some(), "{}", rung.text);
    // What is no device, what is kept, what no literal says, and in a program beside another one.
    for text in [
        program(&format!("{run}; y AT %QX0.0 : BOOL; T0 : TON := (Q := TRUE);"), "LD T0.Q; ST y").text(),
        program(&format!("VAR RETAIN M500 AT %MX62.4 : BOOL := TRUE; | {rest};"), "LD M500; ST y").text(),
        program(&format!("VAR CONSTANT k : INT := 7; | {run}; {rest} := k;"), "LD run; ST y").text(),
    ] {
        assert_eq!(said(&iec(&text), To::Fx).0, "translate.initial", "{text}");
    }
    // By its type.
    let typed = "TYPE On : BOOL := TRUE; END_TYPE\nPROGRAM Main\nVAR run AT %MX0.0 : On; y AT %QX0.0 : BOOL; END_VAR\n\
                 LD run\nST y\nEND_PROGRAM\n";
    assert_ne!(said(&iec(typed), To::Fx).0, "");
    let plain = program(&format!("{run} := FALSE; {rest} := 0; M4 AT %MX0.4 : BOOL := 2#0;"), "LD run; ST y");
    assert!(matches!(prove(&plain, &list("LD M0; OUT Y0")), Proof::Equal { .. }));
    assert_eq!(said(&plain, To::Fx), (String::new(), "LD M0\nOUT Y0\nEND\n".into()));
    let temporary = program("VAR_TEMP M0 : BOOL; | Y0 AT %QX0.0 : BOOL;", "LD Y0; S M0; LD M0; ST Y0");
    assert_eq!(said(&temporary, To::Fx).0, "translate.temporary");
}

#[test]
fn the_first_scan_is_a_variable_that_the_first_rung_switches() {
    let switch = "LDN M8002_Done; ST M8002; S M8002_Done";
    for (text, body) in [
        ("LD M8002; SET M0", "LD M8002; S M0"),
        ("LD X0; ANI M8002; OUT Y0", "LD X0; ANDN M8002; ST Y0"),
        ("LD M8003; OUT Y0", "LDN M8002; ST Y0"),
        ("LD X0; ORI M8003; MOV K5 D0", "LD X0; OR M8002; JMPCN Skip1; LD 5; ST D0; Skip1:"),
    ] {
        let list = list(text);
        let (note, written) = said(&list, To::Iec);
        assert_eq!(note, "", "{text}");
        let again = iec(&written);
        let said_body: Vec<&str> = written.split_once("END_VAR\n").unwrap().1.split_whitespace().collect();
        let expected = lines(&format!("{switch}; {body}; END_PROGRAM"));
        assert_eq!(said_body, expected.split_whitespace().collect::<Vec<_>>(), "{written}");
        assert!(matches!(prove(&list, &again), Proof::Equal { .. }), "{written}");
        assert_eq!(seen_apart([&list, &again]), None, "{written}");
        // And back, but for the relay that is off: a closed contact of the other one is as good.
        let back = said(&again, To::Fx);
        let closed = text.replace("ORI M8003", "OR M8002").replace("LD M8003", "LDI M8002");
        assert_eq!(back, (String::new(), lines(&closed) + "END\n"));
    }
    // Whatever they are called.
    let declared = "First, Ran : BOOL; y AT %QX0.0 : BOOL;";
    let own = "LDN Ran; ST First; S Ran";
    let is_relay = |text: &str| said(&iec(text), To::Fx).1.contains("M8002");
    let named = program(declared, &format!("{own}; LD First; ST y"));
    assert_eq!(said(&named, To::Fx).1, "LD M8002\nOUT Y0\nEND\n");
    assert!(matches!(prove(&named, &list("LD M8002; OUT Y0")), Proof::Equal { .. }));
    assert!(matches!(prove(&named, &list("LDI M8002; OUT Y0")), Proof::Different(_)));
    for body in [
        format!("LD y; ST y; {own}; LD First; ST y"),
        format!("{own}; LD First; ST y; LD y; ST First"),
        format!("{own}; LD First; ST y; LD y; R Ran"),
        format!("{own}; LD First; AND Ran; ST y"),
        format!("again:; {own}; LD First; ST y; LD y; JMPC again"),
        format!("{own}; LD First; ST y; LD y; FROB"),
        "LD Ran; ST First; S Ran; LD First; ST y".into(),
        "LDN Ran; ST First; R Ran; LD First; ST y".into(),
        "LDN Ran; STN First; S Ran; LD First; ST y".into(),
    ] {
        assert!(!is_relay(&program(declared, &body).text()), "{body}");
    }
    for declared in [
        "First : BOOL; Ran : BOOL := TRUE; y AT %QX0.0 : BOOL;",
        "VAR RETAIN Ran : BOOL; | First : BOOL; y AT %QX0.0 : BOOL;",
        "First, Ran AT %MX0.1 : BOOL; y AT %QX0.0 : BOOL;",
    ] {
        assert!(!is_relay(&program(declared, &format!("{own}; LD First; ST y")).text()), "{declared}");
    }
}

#[test]
fn what_is_kept_without_power_is_declared_so() {
    let text = "LD X0; OUT M500; OUT Y0; LD X0; SET S500; LD X0; MOV K3 D200; LD X0; DMOV K3 D202; LD X0; OUT M499; \
                LD X0; MOV K3 D199; LD X0; SET S499";
    let (note, written) = said(&list(text), To::Iec);
    assert_eq!(note, "");
    let (kept, plain) = written.split_once("END_VAR").unwrap();
    assert!(kept.contains("VAR RETAIN"), "{written}");
    for (name, is_kept) in [
        ("M500 ", true),
        ("S500 ", true),
        ("D200 ", true),
        ("D202 ", true),
        ("M499 ", false),
        ("D199 ", false),
        ("S499 ", false),
        ("Y0 ", false),
        ("X0 ", false),
    ] {
        let declared = format!("{name}AT");
        assert_eq!((kept.contains(&declared), plain.contains(&declared)), (is_kept, !is_kept), "{written}");
    }
    let again = iec(&written);
    assert!(matches!(prove(&list(text), &again), Proof::Equal { .. }), "{written}");
    assert_eq!(said(&again, To::Fx).0, "", "{written}");
    let forgotten = iec(&written.replace("VAR RETAIN", "VAR"));
    assert_eq!(reason(&list(text), &forgotten), "translate.not-retained");
    assert_eq!(said(&forgotten, To::Fx).0, "translate.not-retained");
    let kept = iec(&written.replace("VAR\n", "VAR RETAIN\n"));
    assert_eq!(reason(&list(text), &kept), "translate.retained");
    assert_eq!(said(&kept, To::Fx).0, "translate.retained");
    let detector = program(
        "VAR RETAIN e : R_TRIG; | X0 AT %IX0.0 : BOOL; Y0 AT %QX0.0 : BOOL;",
        "CAL e(CLK := X0); LD e.Q; ST Y0",
    );
    let own = program(
        "VAR RETAIN Pulse1 : R_TRIG; | X0 AT %IX0.0 : BOOL; D0 AT %MW1000 : INT;",
        "LD X0; ST Pulse1.CLK; CAL Pulse1; LD Pulse1.Q; JMPCN Past; LD D0; ADD INT#1; ST D0; Past:",
    );
    assert_ne!(said(&detector, To::Fx).0, "");
    assert_eq!(said(&own, To::Fx).0, "translate.retained-alone");
    // Of a latched counter more is kept than its count.
    let counter = list("LD X0; OUT C100 K3; LD C100; OUT Y0");
    let (note, written) = said(&counter, To::Iec);
    assert!(
        note == "translate.latched-counter" && written.contains("VAR RETAIN\n    C100 : CTU"),
        "{note}\n{written}"
    );
    assert_eq!(reason(&counter, &iec(&written)), "translate.latched-counter");
    // What is kept depends on the model.
    let fx1n = Document::new("LD X0\nSET M400\nEND\n", Notation::FxIl, Target::of(Model::Fx1n));
    assert!(said(&fx1n, To::Iec).1.contains("VAR RETAIN\n    M400"));
    assert!(!said(&list("LD X0; SET M400"), To::Iec).1.contains("RETAIN"));
}

#[test]
fn a_falling_edge_is_none_in_the_first_scan() {
    let declared = "a AT %IX0.0 : BOOL; y AT %QX0.0 : BOOL; f : F_TRIG;";
    let trig = program(declared, "CAL f(CLK := a); LD f.Q; S y");
    let (note, written) = said(&trig, To::Fx);
    assert_eq!((note.as_str(), written.as_str()), ("", "LDF X0\nLD M8002\nANI X0\nORB\nSET Y0\nEND\n"));
    assert!(matches!(prove(&trig, &fx(written.trim_end_matches("END\n"))), Proof::Equal { .. }));
    assert!(matches!(prove(&trig, &list("LDF X0; SET Y0")), Proof::Different(_)));
    assert!(matches!(prove(&trig, &list("LDF X0; LD M8002; AND X0; ORB; SET Y0")), Proof::Different(_)));
    // One that is called later has its first call later.
    for body in [
        "LD a; JMPC over; CAL f(CLK := a); LD f.Q; S y; over:",
        "CAL f(CLK := a); LD f.Q; S y; CAL f(CLK := a); LD f.Q; R y",
        "LD a; AND y; ST f.CLK; CAL f; LD f.Q; S y",
    ] {
        let (note, written) = said(&program(declared, body), To::Fx);
        assert!(note == "translate.no-counterpart" && !written.contains("LDF"), "{body}\n{written}");
    }
    for text in [
        "LDF X0; OUT Y0",
        "LD X0; PLF M0; OUT Y0",
        "LD X0; ORF T0; OUT T0 K3; OUT Y0",
        "LD X0; ANDF M0; INV; OUT M0",
    ] {
        let (note, written) = said(&list(text), To::Iec);
        assert!(note.is_empty() && !written.contains("F_TRIG"), "{written}");
        assert!(matches!(prove(&list(text), &iec(&written)), Proof::Equal { .. }), "{written}");
        assert_eq!(seen_apart([&list(text), &iec(&written)]), None, "{written}");
        assert_eq!(said(&iec(&written), To::Fx), (String::new(), list(text).text()), "{written}");
    }
    // M2800 has one edge for all contacts.
    let shared = ["LDP M2800; OUT Y0; LDP M2800; OUT Y1", "LDP M2800; OUT Y1; LDP M2800; OUT Y0"].map(list);
    assert!(matches!(prove(&shared[0], &shared[1]), Proof::Undecided { .. }));
    assert_eq!(said(&shared[0], To::Iec).0, "translate.single-edge");
    assert!(matches!(prove(&shared[0], &shared[0]), Proof::Equal { .. }));
}

#[test]
fn a_counter_stops_at_its_preset() {
    let head = "LD X1; RST C0; LD X0; OUT C0 K3; ";
    for (test, expected) in [
        ("LD>= C0 K3", "LD C0.CV\nGE 3"),
        ("LD>= C0 K4", "LD FALSE"),
        ("LD> C0 K2", "LD C0.CV\nGT 2"),
        ("LD> C0 K3", "LD FALSE"),
        ("LD= C0 K2", "LD C0.CV\nEQ 2"),
        ("LD= C0 K3", "LD C0.CV\nGE 3"),
        ("LD= C0 K4", "LD FALSE"),
        ("LD<= C0 K2", "LD C0.CV\nLE 2"),
        ("LD<= C0 K3", "LD TRUE"),
        ("LD< C0 K3", "LD C0.CV\nLT 3"),
        ("LD< C0 K4", "LD TRUE"),
        ("LD<> C0 K3", "LD C0.CV\nLT 3"),
        ("LD<> C0 K4", "LD TRUE"),
        ("LD< K3 C0", "LD FALSE"),
        ("LD> K3 C0", "LD C0.CV\nLT 3"),
    ] {
        let text = list(&format!("{head}{test}; OUT Y0"));
        let (note, written) = said(&text, To::Iec);
        let own: String = written
            .lines()
            .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ") + "\n")
            .collect();
        assert!(note.is_empty() && own.contains(&format!("{expected}\nST Y0")), "{test}\n{written}");
        assert!(own.contains("C0 : CTU := (PV := 3);"), "{written}");
        assert!(matches!(prove(&text, &iec(&written)), Proof::Equal { .. }), "{written}");
        assert_eq!(seen_apart([&text, &iec(&written)]), None, "{written}");
    }
    let declared =
        "a AT %IX0.0 : BOOL; b AT %IX0.1 : BOOL; y AT %QX0.0 : BOOL; D0 AT %MW1000 : INT; C0 : CTU;";
    let preset = declared.replace("CTU;", "CTU := (PV := 3);");
    let call = "CAL C0(CU := a, PV := 3)";
    for (declared, body, expected) in [
        (declared, format!("LD b; R C0; {call}"), "translate.reset-first"),
        (&preset, format!("LD b; R C0; {call}"), ""),
        (declared, format!("{call}; LD b; R C0"), ""),
        (declared, format!("LD a; JMPC over; {call}; over:; LD b; R C0"), "translate.reset-first"),
        (declared, format!("{call}; LD C0.CV; GE 3; ST y"), ""),
        (declared, format!("{call}; LD C0.CV; GE 4; ST y"), "translate.beyond-preset"),
        (declared, format!("{call}; LD C0.CV; EQ 3; ST y"), "translate.beyond-preset"),
        (declared, format!("{call}; LD 3; GT C0.CV; ST y"), ""),
        (declared, format!("{call}; LD 2; LT C0.CV; ST y"), ""),
        (declared, format!("{call}; LD 3; LT C0.CV; ST y"), "translate.beyond-preset"),
        (declared, format!("{call}; LD C0.CV; GE D0; ST y"), "translate.beyond-preset"),
        (declared, format!("{call}; LD C0.CV; ST D0"), "translate.beyond-preset"),
        (declared, format!("{call}; {call}"), "translate.several-calls"),
        (declared, "CAL C0(CU := a, PV := 0)".into(), "translate.preset"),
        (declared, "CAL C0(CU := a, PV := D0)".into(), "translate.preset"),
    ] {
        assert_eq!(said(&program(declared, &body), To::Fx).0, expected, "{body}");
    }
    assert_eq!(
        reason(&program(declared, &format!("LD b; R C0; {call}")), &list("LD X1; RST C0; LD X0; OUT C0 K3")),
        "translate.reset-first"
    );
    for (text, expected) in [
        ("LD X0; OUT C0 K2; LD X1; OUT C0 K5", "translate.several-coils"),
        ("LD X0; OUT T0 K2; LD X1; OUT T0 K2", "translate.several-coils"),
        ("LD X0; OUT C0 D0", "translate.preset"),
        ("LD X0; RST C0", "translate.preset"),
        ("LD X0; OUT C0 K2; MOV C0 D0", "translate.counter-number"),
        ("LD X0; OUT C0 K2; LD= C0 D0; OUT Y0", "translate.counter-number"),
    ] {
        assert_eq!(said(&list(text), To::Iec).0, expected, "{text}");
    }
}

#[test]
fn a_timer_that_may_be_left_out_is_none_of_the_other_family() {
    let text = "LD X5; CJ P0; LD X0; OUT T0 K30; P0; LD T0; OUT Y0";
    let (note, written) = said(&list(text), To::Iec);
    assert!(note == "translate.jumped-timer" && written.contains("CAL     T0("), "{written}");
    assert_eq!(reason(&list(text), &iec(&written)), "translate.jumped-timer");
    assert_eq!(said(&iec(&written), To::Fx).0, "translate.jumped-timer");
    let leaving = text.replace("P0; ", "").replace("P0", "P63");
    assert_eq!(
        said(&list(&text.replace("CJ P0", "CJ P63").replace("P0; ", "")), To::Iec).0,
        "translate.jumped-timer",
        "{leaving}"
    );
    let part = list(text);
    let at = part.text().find("LD X0").unwrap() as u32;
    let span = Span { start: at, end: at + 5 };
    let of_part = translate(&part, Some(span), To::Iec, &Options { is_whole: false, ..Options::default() });
    assert_eq!(of_part.rungs[0].note.as_ref().map(|note| note.key()), Some("translate.jumped-timer"));
    // Before the jump and behind its label it runs.
    for text in [
        "LD X0; OUT T0 K30; LD X5; CJ P0; LD T0; OUT Y0; P0",
        "LD X5; CJ P0; LD T0; OUT Y0; P0; LD X0; OUT T0 K30",
    ] {
        let (note, written) = said(&list(text), To::Iec);
        assert_eq!(note, "", "{written}");
        assert!(matches!(prove(&list(text), &iec(&written)), Proof::Equal { .. }), "{written}");
    }
}

#[test]
fn the_least_preset_of_a_timer_is_one_step() {
    for (text, time) in
        [("LD X0; OUT T0 K0", "T#100ms"), ("LD X0; OUT T200 K0", "T#10ms"), ("LD X0; OUT T0 K1", "T#100ms")]
    {
        let text = list(&format!("{text}; LD T0; OUT Y0"));
        let (note, written) = said(&text, To::Iec);
        assert!(note.is_empty() && written.contains(&format!("PT := {time}")), "{written}");
        assert_eq!(seen_apart([&text, &iec(&written)]), None, "{written}");
    }
    let declared = "a AT %IX0.0 : BOOL; T0 : TON;";
    let at_once = program(declared, "CAL T0(IN := a, PT := T#0s)");
    assert_eq!(said(&at_once, To::Fx).0, "translate.zero-time");
    assert!(!matches!(prove(&at_once, &list("LD X0; OUT T0 K0")), Proof::Equal { .. }));
    let step = program(declared, "CAL T0(IN := a, PT := T#100ms)");
    assert!(matches!(prove(&step, &list("LD X0; OUT T0 K0")), Proof::Equal { .. }));
}

#[test]
fn what_a_configuration_decides_is_no_part_of_an_fx_list() {
    let text = "PROGRAM A\nVAR a AT %IX0.0 : BOOL; y AT %QX0.0 : BOOL; END_VAR\nLD a\nST y\nEND_PROGRAM\n";
    let configured = |inner: &str| {
        iec(&format!("{text}CONFIGURATION c\nRESOURCE r ON plc\n{inner}\nEND_RESOURCE\nEND_CONFIGURATION\n"))
    };
    let other = list("LD X0; OUT Y0");
    for (inner, is_plain) in [
        ("TASK t(INTERVAL := T#10ms, PRIORITY := 1);\nPROGRAM p WITH t : A;", true),
        ("TASK t(SINGLE := %IX0.5, PRIORITY := 1);\nPROGRAM p WITH t : A;", false),
        ("PROGRAM p : A;\nPROGRAM q : A;", false),
        ("PROGRAM RETAIN p : A;", false),
        ("PROGRAM p : A(y => %QX1.0);", false),
    ] {
        let document = configured(inner);
        let expected = if is_plain { "" } else { "translate.configuration" };
        assert_eq!(said(&document, To::Fx).0, expected, "{inner}");
        match is_plain {
            true => assert!(matches!(prove(&document, &other), Proof::Equal { .. }), "{inner}"),
            false => assert_eq!(reason(&document, &other), expected, "{inner}"),
        }
    }
    let two = iec(&format!("{text}{}", text.replace("PROGRAM A", "PROGRAM B")));
    assert_eq!(said(&two, To::Fx).0, "translate.configuration");
}

#[test]
fn nothing_is_done_behind_the_end() {
    let text = list("LD X0; OUT Y0; END; LD X1; OUT Y1");
    let (note, written) = said(&text, To::Iec);
    assert!(note.is_empty() && written.contains("RET\n"), "{written}");
    assert!(matches!(prove(&text, &iec(&written)), Proof::Equal { .. }), "{written}");
    assert_eq!(seen_apart([&text, &iec(&written)]), None, "{written}");
    let all = iec(&written.replace("    RET\n", ""));
    assert!(!matches!(prove(&text, &all), Proof::Equal { .. }), "{written}");
    let jump = list("LD X0; CJ P63; LD X1; OUT Y1");
    let (note, written) = said(&jump, To::Iec);
    assert!(note.is_empty() && written.contains("RETC\n"), "{written}");
    assert_eq!(seen_apart([&jump, &iec(&written)]), None, "{written}");
}
