//! What is proved equal of a program of the FX family and one of IEC 61131-3, and what a translation between them is sure
//! of, does the same on the simulated PLC from the moment when it is switched on: random programs with edges, timers,
//! counters, jumps, values at first and what is kept without power, run side by side with random inputs.

use rungwise::document::{Document, Notation};
use rungwise::simulate::{Code, Machine, Value, Variable, compile};
use rungwise::target::{Model, Target};
use rungwise::translate::{Options, Proof, To, Translation, prove, translate, variable_called};
use std::sync::Arc;

/// Numbers that look random and are the same in each run.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % sides
    }

    fn one<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.roll(words.len())]
    }
}

fn fx(body: &str) -> Document {
    Document::new(&format!("{body}END\n"), Notation::FxIl, Target::of(Model::Fx2n))
}

fn iec(text: &str) -> Document {
    Document::new(text, Notation::IecIl, Target::of(Model::Iec))
}

/// A contact behind `word`: a bit, an edge, a comparison.
fn fx_contact(dice: &mut Dice, word: &str) -> String {
    let bit = dice.one(&["X0", "X1", "X2", "M0", "M1", "Y0", "T0", "C0", "M500", "M8000", "S0"]);
    let kind = match (word, dice.roll(9)) {
        ("LD", 0..3) | (_, 0..4) => word,
        (_, 4) => return format!("{}I {bit}\n", if word == "LD" { "LD" } else { &word[..2] }),
        (_, 5) => return format!("{word}P {bit}\n"),
        (_, 6) => return format!("{word}F {bit}\n"),
        (_, 7) => {
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
        12 => format!("LD {}\nST {}\n", dice.one(&["3", "D0", "32767"]), dice.one(&["D0", "D1"])),
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
