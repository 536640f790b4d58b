//! Every difference that is shown is one: the scenario that is written of it runs on the simulated PLC, the first program
//! passes it, and the second fails it. What is set in it matters, and what is not set does not.

use rungwise::document::{Document, Notation};
use rungwise::scenario::{Bench, Expected, InputKind, Report, Scenario, Suite, of_counterexample, shown};
use rungwise::simulate::{Machine, Value as Simulated, Variable, compile};
use rungwise::target::{Model, Target};
use rungwise::text::Language;
use rungwise::translate::{Counterexample, Options, Proof, Shown, To, prove, translate};
use std::sync::Arc;

/// Numbers that look random and are the same in each run.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % sides
    }

    pub(crate) fn one<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.roll(words.len())]
    }
}

pub(crate) fn fx(body: &str) -> Document {
    Document::new(&format!("{body}END\n"), Notation::FxIl, Target::of(Model::Fx3u))
}

const FX_BITS: [&str; 8] = ["X0", "X1", "X2", "M0", "M1", "Y0", "T0", "C0"];

fn fx_contact(dice: &mut Dice, word: &str) -> String {
    let plain = ["LD", "LDI", "LDP", "LDF", "LD=", "LD>", "LDD<="];
    let (form, tail) = match word {
        "LD" => (plain[dice.roll(plain.len())], ""),
        _ => (["", "I", "", "P", "=", "<", "D>"][dice.roll(7)], ""),
    };
    let form = form.strip_prefix("LD").unwrap_or(form).to_string() + tail;
    let mnemonic = match (word, form.as_str()) {
        ("LD", form) => format!("LD{form}"),
        ("AND", "I") => "ANI".into(),
        ("OR", "I") => "ORI".into(),
        (word, form) => format!("{word}{form}"),
    };
    match mnemonic.contains(['=', '<', '>']) {
        true => {
            let word = dice.one(&["D0", "D0", "D1", "C0", "K1X0", "K2M0"]);
            let word = if mnemonic.contains("DD") || mnemonic.contains("DR") { "D0" } else { word };
            let word = if word == "C0" || !mnemonic[2..].starts_with('D') { word } else { "D0" };
            format!("{mnemonic} {word} {}\n", dice.one(&["K0", "K1", "K3", "K-2", "D2", "H10"]))
        }
        false => format!("{mnemonic} {}\n", dice.one(&FX_BITS)),
    }
}

/// A rung of an FX list.
fn fx_rung(dice: &mut Dice) -> String {
    let mut rung = fx_contact(dice, "LD");
    for _ in 0..dice.roll(3) {
        let word = dice.one(&["AND", "OR"]);
        rung += &fx_contact(dice, word);
    }
    if dice.roll(8) == 0 {
        rung += "INV\n";
    }
    rung + dice.one(&[
        "OUT Y0\n",
        "OUT Y1\n",
        "OUT M0\n",
        "OUT M1\n",
        "SET M1\n",
        "RST M1\n",
        "PLS M0\n",
        "OUT T0 K3\n",
        "OUT T0 D1\n",
        "OUT C0 K2\n",
        "RST C0\n",
        "MOV K3 D0\n",
        "MOV D0 D1\n",
        "MOV K1X0 D0\n",
        "MOV K3 K1M0\n",
        "INCP D0\n",
        "ADD D0 K1 D1\n",
        "DIV K7 D0 D4\n",
        "CMP D0 K1 M4\n",
        "CJ P0\n",
    ])
}

pub(crate) fn fx_body(dice: &mut Dice) -> Vec<String> {
    let mut rungs: Vec<String> = (0..1 + dice.roll(4)).map(|_| fx_rung(dice)).collect();
    if rungs.iter().any(|rung| rung.contains("CJ")) {
        let first = rungs.iter().position(|rung| rung.contains("CJ")).unwrap_or(0);
        let behind = first + 1 + dice.roll(rungs.len() - first);
        rungs.insert(behind, "P0\n".into());
    }
    rungs
}

const IEC_HEAD: &str = "PROGRAM Main\nVAR\na AT %IX0.0 : BOOL; b AT %IX0.1 : BOOL; c : BOOL; d : BOOL := TRUE;\n\
    y AT %QX0.0 : BOOL; z : BOOL; n : INT; k : INT := 3; u : UINT; w : WORD; t : TON; o : TOF; p : CTU; s : SR; r : RS;\n\
    e : R_TRIG; f : F_TRIG; m : (Idle, Busy, Done); g : ARRAY[0..2] OF BOOL; h : ARRAY[1..2] OF INT; q : INT(0..2); dur : TIME;\nEND_VAR\n";

pub(crate) fn iec(body: &str) -> Document {
    Document::new(&format!("{IEC_HEAD}{body}END_PROGRAM\n"), Notation::IecIl, Target::of(Model::Iec))
}

fn iec_condition(dice: &mut Dice) -> String {
    let bit = |dice: &mut Dice| {
        dice.one(&[
            "a", "b", "c", "d", "y", "z", "t.Q", "p.Q", "s.Q1", "e.Q", "w.1", "g[1]", "g[q]", "w.2", "o.Q",
            "r.Q1",
        ])
    };
    let mut text = match dice.roll(7) {
        0 => {
            let compare = dice.one(&["GT", "EQ", "LT", "NE"]);
            let pair =
                dice.one(&["n;3", "k;4", "n;k", "u;1", "p.CV;1", "h[1];2", "t.ET;T#20ms", "dur;T#5ms"]);
            let (left, right) = pair.split_once(';').unwrap_or_default();
            format!("LD {left}\n{compare} {right}\n")
        }
        1 => format!("LD m\n{} Busy\n", dice.one(&["EQ", "NE"])),
        _ => format!("{} {}\n", dice.one(&["LD", "LDN"]), bit(dice)),
    };
    for _ in 0..dice.roll(3) {
        text += &format!("{} {}\n", dice.one(&["AND", "ANDN", "OR", "ORN", "XOR"]), bit(dice));
    }
    text
}

fn iec_rung(dice: &mut Dice) -> String {
    match dice.roll(14) {
        0 => format!("LD {}\nST {}\n", dice.one(&["n", "k", "3", "-1"]), dice.one(&["n", "k", "h[1]"])),
        1 => format!(
            "LD {}\n{} {}\nST n\n",
            dice.one(&["n", "k"]),
            dice.one(&["ADD", "SUB", "MUL", "DIV", "MOD"]),
            dice.one(&["n", "k", "2"])
        ),
        2 => {
            format!("CAL t(IN := {}, PT := T#{}ms)\n", dice.one(&["a", "c"]), dice.one(&["20", "50", "3000"]))
        }
        3 => format!("CAL p(CU := {}, R := {}, PV := 2)\n", dice.one(&["a", "c"]), dice.one(&["b", "z"])),
        4 => format!("CAL s(S1 := {}, R := {})\n", dice.one(&["a", "c"]), dice.one(&["b", "z"])),
        5 => format!("CAL r(S := {}, R1 := {})\n", dice.one(&["a", "c"]), dice.one(&["b", "z"])),
        6 => format!("CAL e(CLK := {})\n", dice.one(&["a", "c"])),
        7 => format!("LD {}\nST m\n", dice.one(&["Idle", "Busy", "Done"])),
        8 => iec_condition(dice) + dice.one(&["RETC\n", "RETCN\n", "JMPC Over\n", "JMPCN Over\n"]),
        9 => format!("{}CALC t(IN := {}, PT := T#20ms)\n", iec_condition(dice), dice.one(&["a", "c"])),
        10 => format!("CAL o(IN := {}, PT := T#20ms)\n", dice.one(&["a", "c"])),
        _ => {
            iec_condition(dice)
                + dice.one(&[
                    "ST y\n",
                    "ST g[q]\n",
                    "S w.2\n",
                    "ST w.1\n",
                    "ST z\n",
                    "STN c\n",
                    "S y\n",
                    "R z\n",
                    "ST y\nST z\n",
                    "ST g[1]\n",
                    "ST g[0]\n",
                ])
        }
    }
}

pub(crate) fn iec_body(dice: &mut Dice) -> Vec<String> {
    let mut rungs: Vec<String> = (0..1 + dice.roll(4)).map(|_| iec_rung(dice)).collect();
    if let Some(first) = rungs.iter().position(|rung| rung.contains("JMP")) {
        let behind = first + 1 + dice.roll(rungs.len() - first);
        rungs.insert(behind, "Over:\n".into());
    }
    rungs
}

/// The rungs with one of them made anew, two of them swapped, or changed a little.
fn changed(dice: &mut Dice, rungs: &[String], rung: impl Fn(&mut Dice) -> String) -> Vec<String> {
    let tries = std::iter::repeat_with(|| changed_once(dice, rungs, &rung)).take(20);
    let all: Vec<_> = tries.collect();
    all.into_iter().find(|changed| changed != rungs).unwrap_or_default()
}

fn changed_once(dice: &mut Dice, rungs: &[String], rung: &impl Fn(&mut Dice) -> String) -> Vec<String> {
    let mut changed = rungs.to_vec();
    let at = dice.roll(changed.len());
    let swaps = [
        ("LD ", "LDI "),
        ("LDI ", "LD "),
        ("LDN ", "LD "),
        ("AND ", "OR "),
        ("OR ", "AND "),
        ("ANDN ", "ORN "),
        ("K3", "K1"),
        ("X0", "X1"),
        (" a", " b"),
        (":= a", ":= c"),
        ("LD T0", "LD X2"),
        (" 3", " 4"),
        ("Busy", "Done"),
        ("RETC\n", "RETCN\n"),
        ("JMPC ", "JMPCN "),
        ("ST y", "STN y"),
        ("OUT Y0", "SET Y0"),
        ("GT", "LT"),
        (">", "<"),
    ];
    let (old, new) = swaps[dice.roll(swaps.len())];
    match dice.roll(8) {
        0 if !changed[at].ends_with(":\n") && !changed[at].starts_with('P') => changed[at] = rung(dice),
        1 if at + 1 < changed.len() => changed.swap(at, at + 1),
        _ => changed.iter_mut().for_each(|rung| *rung = rung.replacen(old, new, 1)),
    }
    changed
}

fn scenario(text: &str) -> Scenario {
    let (suite, flaws) = Suite::read(text);
    assert!(flaws.is_empty(), "{flaws:?}\n{text}");
    suite.scenarios.into_iter().next().unwrap()
}

fn report(document: &Document, scenario: &Scenario, text: &str) -> Report {
    let bench = Bench::new(&[document]).unwrap();
    bench.run(scenario, None, None).unwrap_or_else(|flaws| panic!("{flaws:?}\n{text}"))
}

/// Whether the first program passes a scenario, and the second fails it in what it expects.
fn tells_apart(sides: [&Document; 2], scenarios: [&Scenario; 2], text: &str) -> bool {
    let [left, right] = [0, 1].map(|side| {
        let mut scenario = scenarios[side].clone();
        // A program of the other family need not have all that the first one looks at.
        if side == 1 && sides[0].target().is_fx() && !sides[1].target().is_fx() {
            let bench = Bench::new(&[sides[1]]).unwrap();
            scenario.inputs.retain(|input| bench.code().variable(&input.name.name).is_some());
        }
        report(sides[side], &scenario, text)
    });
    let differs = |failure: &rungwise::scenario::Failure| failure.name.is_some();
    left.is_passed() && !right.is_passed() && right.failures.iter().all(differs)
}

/// What is wrong with the scenario of a difference; nothing if it is as it should be. `again` puts it into the words of
/// the second program.
fn wrong(sides: [&Document; 2], found: &Counterexample, again: impl Fn(&str) -> String) -> Option<String> {
    let names = ["one.il".to_string(), "two.il".to_string()];
    let text = of_counterexample(found, &names, Language::English).unwrap();
    let own = scenario(&text);
    let other = scenario(&again(&text));
    if !tells_apart(sides, [&own, &other], &text) {
        return Some(format!("does not tell them apart\n{text}"));
    }
    let Some(Expected::Is(_)) = own.checks.first().map(|check| check.wants[0].expected.clone()) else {
        return Some(format!("expects nothing\n{text}"));
    };
    let last = own.inputs.iter().map(|input| input.scan).max().unwrap_or_default();
    // Each bit that is set matters where it is set: otherwise or not set at all, it is no such scenario.
    for number in 0..own.inputs.len() {
        let kinds = [&own, &other].map(|scenario| scenario.inputs[number].kind.clone());
        let InputKind::Set(value) = &kinds[0] else { continue };
        let name = &own.inputs[number].name.name;
        let code = Bench::new(&[sides[0]]).unwrap();
        let is_bit = matches!(code.code().variable(name), Some(Variable::Relay(_)));
        let (Some(on), true) = (value.as_bit().filter(|_| is_bit), own.inputs[number].scan == last) else {
            continue;
        };
        let changed = [&own, &other].map(|scenario| {
            let mut scenario = scenario.clone();
            scenario.inputs[number].kind = InputKind::Set(Simulated::Bit(!on));
            scenario
        });
        let left_out = [&own, &other].map(|scenario| {
            let mut scenario = scenario.clone();
            scenario.inputs.remove(number);
            scenario
        });
        if tells_apart(sides, [&changed[0], &changed[1]], &text)
            && tells_apart(sides, [&left_out[0], &left_out[1]], &text)
        {
            return Some(format!("{} does not matter\n{text}", name));
        }
    }
    None
}

/// Whether the scenario of a difference is passed by the first program and failed by the second.
pub(crate) fn is_shown(sides: [&Document; 2], found: &Counterexample) -> bool {
    let names = ["one.il".to_string(), "two.il".to_string()];
    let text = of_counterexample(found, &names, Language::English).unwrap();
    let scenario = scenario(&text);
    tells_apart(sides, [&scenario, &scenario], &text)
}

/// What differs in some scans of two programs with random values, as far as both have it, in so many `runs`.
pub(crate) fn seen_apart(sides: [&Document; 2], runs: u64) -> Option<String> {
    let codes = sides.map(|side| compile(&[side], false).ok().map(Arc::new));
    let [Some(left), Some(right)] = codes else { return None };
    let codes = [left, right];
    let names: Vec<String> =
        codes[0].named().into_iter().filter(|name| codes[1].variable(name).is_some()).collect();
    for seed in 0..runs {
        let mut dice = Dice(seed * 31 + 11);
        let mut machines = codes.each_ref().map(|code| Machine::<u8>::new(Arc::clone(code)));
        for scan in 0..5 {
            for name in &names {
                let (kind, value) = (dice.roll(3), dice.roll(5));
                let both = codes.each_ref().map(|code| code.variable(name).unwrap());
                let value = match both[0] {
                    Variable::Relay(_) => Simulated::Bit(value % 2 == 1),
                    _ => Simulated::Number(value as i64),
                };
                let touches = [0, 1].map(|side| both[side].set(&codes[side], &value));
                if let ([Some(left), Some(right)], 0) = (touches, kind) {
                    left.apply(&mut machines[0]);
                    right.apply(&mut machines[1]);
                }
            }
            let ends = machines.each_mut().map(|machine| machine.scan(scan * 10_000_000).errors.len());
            if ends != [0, 0] {
                break;
            }
            for name in &names {
                let values = [0, 1].map(|side| machines[side].value(codes[side].variable(name).unwrap(), 0));
                if values[0] != values[1] {
                    return Some(format!("{name} is {values:?} in scan {scan}"));
                }
            }
        }
    }
    None
}

#[derive(Default, Debug)]
struct Count {
    equal: usize,
    undecided: usize,
    shown: usize,
    not: Vec<String>,
    wrong: Vec<String>,
}

impl Count {
    fn note(&mut self, left: &Document, right: &Document, again: impl Fn(&str) -> String) {
        let names = ["one.il".to_string(), "two.il".to_string()];
        let told = || format!("{}\n--\n{}", body(left), body(right));
        match shown(prove(left, right), [left, right], &names) {
            Proof::Equal { .. } => {
                self.equal += 1;
                // What a detector of edges says in the first scan, IEC 61131-3 and the FX family see otherwise.
                let is_mixed = left.target().is_fx() != right.target().is_fx();
                if let Some(seen) = seen_apart([left, right], 12).filter(|_| !is_mixed) {
                    self.wrong.push(format!("equal, and {seen}\n{}", told()));
                }
            }
            Proof::Undecided { .. } => self.undecided += 1,
            Proof::Different(found) => match &found.shown {
                Shown::Runs(_) => {
                    self.shown += 1;
                    self.wrong
                        .extend(wrong([left, right], &found, again).map(|what| format!("{what}{}", told())));
                }
                // A program of the other family need not have what only one of the two drives.
                Shown::Not(reason) if reason.key() == "prove.not-there" => {}
                other => self.not.push(format!("{other:?}\n{:?}\n{}", found.inputs, told())),
            },
        }
    }

    fn judge(&self) {
        let cases = |all: &[String]| all.iter().take(8).cloned().collect::<Vec<_>>().join("\n=====\n");
        assert!(self.wrong.is_empty(), "{}", cases(&self.wrong));
        // That of which nothing can be shown is rare, and mostly no difference.
        assert!(self.not.len() * 50 <= self.shown, "{}", cases(&self.not));
        let Count { equal, undecided, shown, .. } = self;
        assert!(*equal > 0 && *undecided > 0 && *shown > 5, "{equal} {undecided} {shown}");
    }
}

fn body(document: &Document) -> String {
    document.text().replace(IEC_HEAD, "")
}

fn cases() -> u64 {
    std::env::var("RUNGWISE_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(60)
}

#[test]
fn what_is_shown_of_fx_lists_runs() {
    let mut count = Count::default();
    for seed in 0..cases() {
        let mut dice = Dice(seed * 7919 + 1);
        let rungs = fx_body(&mut dice);
        let others = changed(&mut dice, &rungs, fx_rung);
        count.note(&fx(&rungs.concat()), &fx(&others.concat()), str::to_string);
    }
    count.judge();
}

#[test]
fn what_is_shown_of_iec_lists_runs() {
    let mut count = Count::default();
    for seed in 0..cases() {
        let mut dice = Dice(seed * 104_729 + 5);
        let rungs = iec_body(&mut dice);
        let others = changed(&mut dice, &rungs, iec_rung);
        count.note(&iec(&rungs.concat()), &iec(&others.concat()), str::to_string);
    }
    count.judge();
}

#[test]
fn what_is_shown_of_both_families_runs() {
    let mut count = Count::default();
    // Most of them are not written in the words of the other family.
    for seed in 0..cases() * 8 {
        let mut dice = Dice(seed * 15_485_863 + 3);
        let rungs = fx_body(&mut dice);
        let others = changed(&mut dice, &rungs, fx_rung);
        let [left, right] = [&rungs, &others].map(|rungs| fx(&rungs.concat()));
        let written = translate(&right, None, To::Iec, &Options::default()).text;
        let right = Document::new(&written, Notation::IecIl, Target::of(Model::Iec));
        let Ok(bench) = Bench::new(&[&right]) else { continue };
        if written.contains("(*") {
            continue;
        }
        count.note(&left, &right, |text| {
            let (head, steps) = text.split_once("steps").unwrap();
            let mut steps = steps.replace("TS0 =", "\"T0.Q\" =").replace("CS0 =", "\"C0.Q\" =");
            steps = steps.replace(" C0 =", " \"C0.CV\" =");
            for number in 0..6 {
                let name = format!("D{number}");
                let range = bench.code().variable(&name).and_then(|own| own.range(bench.code()));
                let own = match range.is_some_and(|range| *range.end() > i64::from(u16::MAX)) {
                    true => name,
                    false if number % 2 == 0 => format!("\"%MD{}\"", 500 + number / 2),
                    false => format!("\"%MD{}\"", 10_000 + number),
                };
                steps = steps.replace(&format!("\"D{number}:32\" ="), &format!("{own} ="));
            }
            // What is only a part of what it declares has no name there.
            for (letter, area, first) in [("D", "MW", 1000), ("X", "IX", 0), ("Y", "QX", 0), ("M", "MX", 0)] {
                for number in 0..8 {
                    let name = format!("{letter}{number}");
                    let part = if letter == "D" { String::new() } else { "0.".to_string() };
                    if bench.code().variable(&name).is_none() {
                        let address = format!(" \"%{area}{part}{}\" =", first + number);
                        steps = steps.replace(&format!(" {name} ="), &address);
                    }
                }
            }
            format!("{head}steps{steps}")
        });
    }
    count.judge();
}

/// The scenario of two programs that differ.
fn scenario_of(left: &Document, right: &Document) -> String {
    let names = ["one.il".to_string(), "two.il".to_string()];
    let Proof::Different(found) = shown(prove(left, right), [left, right], &names) else {
        panic!("{}", body(left))
    };
    let text = of_counterexample(&found, &names, Language::English);
    let text = text.unwrap_or_else(|| panic!("{:?}\n{}", found.shown, body(left)));
    assert_eq!(wrong([left, right], &found, str::to_string), None);
    text
}

fn lines(text: &str) -> String {
    text.replace("; ", "\n") + "\n"
}

#[test]
fn a_scenario_has_what_decides() {
    for (left, right, expected) in [
        // The condition of a return or a jump is an input.
        ("LD a; RETC; LD b; ST y", "LD a; RETC; LDN b; ST y", "a = 0"),
        ("LD a; RETCN; LD b; ST y", "LD a; RETCN; LDN b; ST y", "a = 1"),
        ("LD a; JMPC Over; LD b; ST y; Over:", "LD a; JMPC Over; LDN b; ST y; Over:", "a = 0"),
        ("LD a; JMPCN Over; LD b; ST y; Over:", "LD a; JMPCN Over; LDN b; ST y; Over:", "a = 1"),
        ("LD g[1]; ST y", "LD g[2]; ST y", "\"g[1]\" = "),
        // A variable begins as it is declared.
        ("LD d; AND a; ST y", "LD d; ANDN a; ST y", "d = 1"),
        // An instance is no BOOL; its outputs are.
        ("LD a; CALC t(IN := c, PT := T#20ms)", "LDN a; CALC t(IN := c, PT := T#20ms)", "expect = { \"t."),
    ] {
        let [left, right] = [left, right].map(|text| iec(&lines(text)));
        let text = scenario_of(&left, &right);
        assert!(text.contains(expected), "{text}");
    }
    for (left, right, expected) in [
        // The contact of a timer or a counter is not its value.
        ("LD X0; OUT T250 K5; LD T250; OUT Y0", "LD X0; OUT T250 K5; LDI T250; OUT Y0", "TS250 = "),
        ("LD C0; OUT Y0", "LDI C0; OUT Y0", "CS0 = "),
        ("LD> C0 K5; OUT Y0", "LD< C0 K5; OUT Y0", " C0 = "),
        // Nothing is divided by zero, and what an instruction does is seen in what it writes.
        ("LD M8000; DIV K7 D0 D2; LD X0; OUT Y0", "LD M8000; DIV K7 D0 D2; LDI X0; OUT Y0", "D0 = "),
        ("LD X0; MOV K5 D0", "LDI X0; MOV K5 D0", "expect = { D0 = "),
        // A pair of registers is one value.
        ("LDD> D0 K100000; OUT Y0", "LDD> D0 K100001; OUT Y0", "\"D0:32\" = 100001"),
        ("LD D0.3; OUT Y0", "LDI D0.3; OUT Y0", "D0 = "),
        // The relay of the first scan is on in it, and is not set.
        ("LD M8002; OUT Y0", "LDI M8002; OUT Y0", "{ at = \"0 scans\", expect"),
        ("LDI M8002; AND X0; OUT Y0", "LDI M8002; ANI X0; OUT Y0", "{ at = \"1 scan\", "),
    ] {
        let [left, right] = [left, right].map(|text| fx(&lines(text)));
        let text = scenario_of(&left, &right);
        assert!(text.contains(expected), "{text}");
    }
}
