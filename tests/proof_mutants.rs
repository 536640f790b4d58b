//! The proof finds each wrong translation: programs of the project, of other people and made up ones are translated, the
//! translation is spoiled at each of its instructions, and proved against the source. What is found to differ is run on
//! the simulated PLC, which must show it; what is found equal is run as well, and must not.

use crate::corpus::say_skipped;
use crate::proof_shown::{self, Dice};
use crate::translate::{all_small_rungs, found_different, list, truth_of_list};
use rungwise::document::{Document, Notation};
use rungwise::scenario::shown;
use rungwise::simulate::compile;
use rungwise::target::{Model, Target};
use rungwise::translate::{Options, Proof, Shown, To, Translation, prove, translate};
use std::collections::BTreeSet;
use std::path::Path;

/// A translation with one fault, and what that is.
struct Mutant {
    fault: String,
    text: String,
}

/// The words of an instruction, with blanks before it left out.
fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// What an instruction is confused with, in either language of lists.
const CONFUSED: &[(&str, &[&str])] = &[
    ("LD", &["LDI", "LDN"]),
    ("LDI", &["LD"]),
    ("LDP", &["LDF"]),
    ("LDF", &["LDP"]),
    ("AND", &["ANI", "ANDN", "OR"]),
    ("ANI", &["AND", "ORI"]),
    ("ANDP", &["ANDF"]),
    ("ANDF", &["ANDP"]),
    ("OR", &["ORI", "ORN", "AND"]),
    ("ORI", &["OR", "ANI"]),
    ("ORP", &["ORF"]),
    ("ORF", &["ORP"]),
    ("ANB", &["ORB"]),
    ("ORB", &["ANB"]),
    ("SET", &["RST"]),
    ("RST", &["SET"]),
    ("PLS", &["PLF"]),
    ("PLF", &["PLS"]),
    ("LDN", &["LD"]),
    ("ANDN", &["AND", "ORN"]),
    ("ORN", &["OR", "ANDN"]),
    ("AND(", &["OR("]),
    ("OR(", &["AND("]),
    ("ANDN(", &["AND("]),
    ("ORN(", &["OR("]),
    ("ST", &["STN"]),
    ("STN", &["ST"]),
    ("S", &["R"]),
    ("R", &["S"]),
    ("GT", &["GE", "LE"]),
    ("GE", &["GT", "LT"]),
    ("LT", &["LE", "GE"]),
    ("LE", &["LT", "GT"]),
    ("EQ", &["NE"]),
    ("NE", &["EQ"]),
];

/// What a sign of comparison is confused with.
const SIGNS: &[(&str, &[&str])] = &[
    ("<>", &["="]),
    (">=", &[">", "<"]),
    ("<=", &["<", ">"]),
    ("=", &["<>", ">="]),
    (">", &[">=", "<="]),
    ("<", &["<=", ">="]),
];

/// The row of a table that begins with `word`.
fn row<'t>(table: &'t [(&str, &'t [&'t str])], word: &str) -> &'t [&'t str] {
    table.iter().find(|(own, _)| *own == word).map_or(&[], |(_, others)| others)
}

/// `mnemonic` with another sign of comparison, if it has one.
fn otherwise_compared(mnemonic: &str) -> Vec<String> {
    let Some(at) = mnemonic.find(['<', '>', '=']) else { return Vec::new() };
    let (word, sign) = mnemonic.split_at(at);
    row(SIGNS, sign).iter().map(|other| format!("{word}{other}")).collect()
}

/// `line` with the last number that stands for itself counted on by one: a preset, a constant.
fn counted_on(line: &str) -> Option<String> {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let ends_there = |at: &usize| !line[at + digits(&line[*at..])..].starts_with(char::is_alphabetic);
    let starts = [" K", "T#", "PV := ", "LD      ", "EQ      ", "GT      "].iter().flat_map(|before| {
        line.match_indices(before).map(move |(at, _)| at + before.len()).collect::<Vec<_>>()
    });
    let starts = starts.filter(|at| digits(&line[*at..]) > 0);
    let at = starts.filter(|at| line[..*at].ends_with('#') || ends_there(at)).max()?;
    let end = at + digits(&line[at..]);
    let number: u32 = line[at..end].parse().ok()?;
    Some(format!("{}{}{}", &line[..at], number + 1, &line[end..]))
}

/// Where the block starts that the ANB or ORB in line `end` joins.
fn start_of_block(lines: &[&str], end: usize) -> Option<usize> {
    let mut open = 1;
    for at in (0..end).rev() {
        let mnemonic = words(lines[at]).first().copied().unwrap_or_default();
        match mnemonic {
            "ANB" | "ORB" => open += 1,
            _ if mnemonic.starts_with("LD") => open -= 1,
            _ => {}
        }
        if open == 0 {
            return Some(at);
        }
    }
    None
}

/// The lines of branches: blocks up to the instruction that joins them, in parentheses with these, and outputs behind a
/// kept power.
fn branches(lines: &[&str]) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut open = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        match words(line).first().copied().unwrap_or_default() {
            "ANB" | "ORB" => found.extend(start_of_block(lines, at).map(|start| start..at + 1)),
            word if word.ends_with('(') && line.trim().len() == word.len() => open.push(at),
            word if word.ends_with('(') && !line.contains(')') => open.push(at),
            ")" => found.extend(open.pop().map(|start| start..at + 1)),
            "MRD" => {
                let next =
                    lines[at + 1..].iter().position(|line| matches!(line.trim(), "MRD" | "MPP" | "MPS"));
                found.extend(
                    next.filter(|next| lines[at + 1 + next].trim() != "MPS").map(|next| at..at + 1 + next),
                );
            }
            _ => {}
        }
    }
    found
}

const OUTPUTS: [&str; 8] = ["OUT", "SET", "RST", "PLS", "PLF", "ST", "S", "R"];

/// What an instruction drives: its operands.
fn driven(line: &str) -> Option<&str> {
    let (mnemonic, operands) = line.trim_start().split_once(char::is_whitespace)?;
    OUTPUTS.contains(&mnemonic).then(|| operands.trim())
}

/// A list with one fault in each: at each instruction, of each branch, of each two outputs, of rungs that drive the same.
fn of_list(made: &Translation) -> Vec<Mutant> {
    let text = &made.text;
    let lines: Vec<&str> = text.lines().collect();
    let first = lines.iter().rposition(|line| line.trim() == "END_VAR").map_or(0, |at| at + 1);
    let last = lines.iter().rposition(|line| line.starts_with("END")).unwrap_or(lines.len());
    // Words of the other language.
    let is_fx = !text.contains("PROGRAM");
    let foreign = if is_fx { ["LDN", "ANDN", "ORN"] } else { ["LDI", "ANI", "ORI"] };
    let mut mutants = Vec::new();
    let mut add = |fault: String, changed: Vec<String>| {
        mutants.push(Mutant { fault, text: changed.join("\n") + "\n" });
    };
    let own = |range: std::ops::Range<usize>| lines[range].iter().map(|line| line.to_string());
    let with = |at: usize, line: String| own(0..at).chain([line]).chain(own(at + 1..lines.len())).collect();
    for (at, line) in lines.iter().enumerate().take(last).skip(first) {
        let all = words(line);
        let Some(mnemonic) = all.first().filter(|_| !line.trim_end().ends_with(':')) else { continue };
        // Only a bit is set.
        let is_word =
            all.get(1).is_some_and(|word| word.starts_with(['T', 'C', 'D']) && words(line).len() == 2);
        let others = row(CONFUSED, mnemonic).iter().map(|other| other.to_string());
        let others =
            others.filter(|other| (other != "SET" || !is_word) && !foreign.contains(&other.as_str()));
        for other in others.chain(otherwise_compared(mnemonic)) {
            add(format!("{line} as {other}"), with(at, line.replacen(mnemonic, &other, 1)));
        }
        if let Some(counted) = counted_on(line) {
            add(format!("{line} counted on"), with(at, counted));
        }
        add(format!("{line} left out"), own(0..at).chain(own(at + 1..lines.len())).collect());
        for (other, line_of_other) in lines.iter().enumerate().skip(at + 1) {
            let (Some(one), Some(two)) = (driven(line), driven(line_of_other)) else { continue };
            // What resets a counter cannot be what switches a lamp.
            let kinds = [line, line_of_other].map(|line| words(line)[0]);
            let is_alike =
                kinds[0] == kinds[1] || ![one, two].iter().any(|own| own.starts_with(['T', 'C', 'D']));
            if one == two || !is_alike {
                continue;
            }
            let mut swapped: Vec<String> = own(0..lines.len()).collect();
            swapped[at] = line.replacen(one, two, 1);
            swapped[other] = line_of_other.replacen(two, one, 1);
            add(format!("{one} and {two} swapped"), swapped);
        }
    }
    for range in branches(&lines) {
        let fault = format!("{} left out", lines[range.clone()].join("; "));
        add(fault, own(0..range.start).chain(own(range.end..lines.len())).collect());
    }
    for pair in made.rungs.windows(2) {
        let [one, two] = [0, 1].map(|side| &text[pair[side].result.clone()]);
        let drives =
            |text: &str| text.lines().filter_map(driven).map(str::to_string).collect::<BTreeSet<_>>();
        if pair.iter().any(|rung| rung.is_kept) || drives(one).is_disjoint(&drives(two)) {
            continue;
        }
        let between = &text[pair[0].result.end..pair[1].result.start];
        let swapped = format!("{two}{between}{one}");
        let mut text = text.clone();
        text.replace_range(pair[0].result.start..pair[1].result.end, &swapped);
        mutants.push(Mutant { fault: format!("swapped {one}{two}"), text });
    }
    mutants
}

/// What a symbol of a drawing is confused with.
const SYMBOLS: &[(&str, &[&str])] = &[
    ("-| |-", &["-|/|-"]),
    ("-|/|-", &["-| |-"]),
    ("-|P|-", &["-|N|-", "-| |-"]),
    ("-|N|-", &["-|P|-"]),
    ("-( )-", &["-(/)-", "-(S)-"]),
    ("-(S)-", &["-(R)-"]),
    ("-(R)-", &["-(S)-"]),
    ("-[> ", &["-[< "]),
    ("-[< ", &["-[> "]),
    ("-[>= ", &["-[<= "]),
    ("-[<= ", &["-[>= "]),
    ("-[= ", &["-[> "]),
];

/// A drawing with one fault in each: at each symbol, at each constant, without a branch below.
fn of_drawing(text: &str) -> Vec<Mutant> {
    let mut mutants = Vec::new();
    let lines: Vec<&str> = text.lines().collect();
    for (symbol, others) in SYMBOLS {
        for (at, _) in text.match_indices(symbol) {
            let start = text[..at].rfind('\n').map_or(0, |line| line + 1);
            let above = text[..start].lines().next_back().unwrap_or_default();
            // A coil stands at the right rail, and its name ends there.
            let name = match symbol.ends_with(")-") {
                true => above.trim_end_matches(['|', ' ']).rsplit("  ").next(),
                false => above.get(at - start..),
            };
            let name = name.unwrap_or_default().trim();
            let is_counted =
                name.starts_with(['T', 'C']) && name[1..].starts_with(|next: char| next.is_ascii_digit());
            // There are no such coils of timers and counters.
            if is_counted && symbol.ends_with(")-") {
                continue;
            }
            let name = words(name).first().copied().unwrap_or_default();
            for other in *others {
                let mut changed = text.to_string();
                changed.replace_range(at..at + symbol.len(), other);
                mutants.push(Mutant { fault: format!("{symbol} of {name} as {other}"), text: changed });
            }
        }
    }
    for (at, line) in lines.iter().enumerate() {
        let counted = counted_on(line).filter(|counted| line.starts_with('|') && counted.len() == line.len());
        let with = |changed: String| {
            let all = lines[..at].iter().map(|line| line.to_string()).chain([changed]);
            let all = all.chain(lines[at + 1..].iter().map(|line| line.to_string()));
            all.collect::<Vec<_>>().join("\n") + "\n"
        };
        if let Some(counted) = counted {
            mutants.push(Mutant { fault: format!("{line} counted on"), text: with(counted) });
        }
        if line.contains("[END]") {
            continue;
        }
        // The last row of a rung, from the left rail up to where it joins the row above it.
        let Some(end) = line.strip_prefix('+').and_then(|rest| rest.find('+')).map(|end| end + 1) else {
            continue;
        };

        let is_branch = line[end + 1..].trim_end_matches('|').trim().is_empty() && at >= 3;
        if !is_branch || lines.get(at + 1).is_some_and(|next| !next.is_empty()) {
            continue;
        }
        let mut kept: Vec<String> = lines.iter().map(|line| line.to_string()).collect();
        kept.drain(at - 1..=at);
        let above = &mut kept[at - 2];
        if above.get(end - 1..=end + 1) == Some("-+-") {
            above.replace_range(end..=end, "-");
        }
        mutants.push(Mutant { fault: format!("{line} left out"), text: kept.join("\n") + "\n" });
    }
    mutants
}

/// What became of the mutants of some programs.
#[derive(Default)]
struct Tally {
    different: usize,
    /// Not decided, with the reason.
    undecided: Vec<String>,
    wrong: Vec<String>,
}

impl Tally {
    fn judge(&mut self, source: &Document, made: &Document, mutant: &Mutant) {
        let spoiled = Document::new(&mutant.text, made.notation(), made.target());
        let told = |what: &str| format!("{what}: {}\n{}\n--\n{}", mutant.fault, source.text(), mutant.text);
        let line = |reason: &str| format!("{reason}: {}", words(&mutant.fault).join(" "));
        let names = ["one".to_string(), "two".to_string()];
        let runs = compile(&[&spoiled], false).is_ok();
        match shown(prove(source, &spoiled), [source, &spoiled], &names) {
            Proof::Different(found) if matches!(found.shown, Shown::Runs(_)) => {
                self.different += 1;
                if !proof_shown::is_shown([source, &spoiled], &found) {
                    self.wrong.push(told("the scenario shows nothing"));
                }
            }
            Proof::Equal { .. } => {
                if let Some(seen) = proof_shown::seen_apart([source, &spoiled], 60) {
                    self.wrong.push(told(&format!("equal, and {seen}")));
                }
            }
            // A block is left open, an operand is missing: that is no program, and not equal.
            _ if !runs => {}
            Proof::Undecided { reason, .. } if reason.key() == "prove.unread" => {}
            Proof::Different(found) => {
                let Shown::Not(reason) = &found.shown else { return self.wrong.push(told("untried")) };
                self.undecided.push(line(reason.key()));
            }
            Proof::Undecided { reason, .. } => self.undecided.push(line(reason.key())),
        }
    }
}

/// A program and its translation in the form of the other kind of its family: a list for a drawing, a drawing for a list.
fn forms(source: &Document) -> [(Document, Translation); 2] {
    let made = |document: &Document, to: To| {
        let translation = translate(document, None, to, &Options::default());
        let notation = match to {
            To::Ladder => Notation::Ladder,
            To::Iec => Notation::IecIl,
            _ => Notation::FxIl,
        };
        (Document::new(&translation.text, notation, document.target()), translation)
    };
    let to_list = if source.target().is_fx() { To::Fx } else { To::Iec };
    let drawn = made(source, To::Ladder);
    [made(&drawn.0, to_list), drawn]
}

/// What becomes of each `step`th fault in the translations of a program.
fn tally(source: &Document, step: usize) -> Tally {
    let source = &without_comments(source);
    let mut tally = Tally::default();
    let [(list, listed), (drawing, drawn)] = forms(source);
    let spoiled = of_list(&listed).into_iter().map(|mutant| (&list, mutant));
    let spoiled = spoiled.chain(of_drawing(&drawn.text).into_iter().map(|mutant| (&drawing, mutant)));
    for (made, mutant) in spoiled.step_by(step) {
        tally.judge(source, made, &mutant);
    }
    tally
}

/// The program without its comments, so that every line says something.
fn without_comments(document: &Document) -> Document {
    let mut text = document.text();
    let line = if document.target().is_fx() { "; " } else { "//" };
    for (open, close) in [("(*", "*)"), ("//", "\n"), (line, "\n")] {
        while let Some(start) = text.find(open) {
            let end = text[start..].find(close).map_or(text.len(), |end| start + end);
            let end = if close == "\n" { end } else { end + close.len() };
            text.replace_range(start..end, "");
        }
    }
    Document::new(text.trim_start(), document.notation(), document.target())
}

/// Programs with the faults of which nothing is decided, `undecided` among them, and at least so many shown.
fn judge(programs: Vec<(String, Document, usize)>, undecided: &[&str], least: usize) {
    let (mut found, mut different, mut wrong) = (Vec::new(), 0, Vec::new());
    for (name, document, step) in programs {
        let tally = tally(&document, step);
        different += tally.different;
        found.extend(tally.undecided.iter().map(|said| format!("{name}: {said}")));
        wrong.extend(tally.wrong);
    }
    assert!(wrong.is_empty(), "{} of\n{}", wrong.len(), wrong.join("\n=====\n"));
    assert_eq!(found, undecided, "{found:#?}");
    assert!(different >= least, "{different}");
}

/// A file of the project, or one beside it.
fn file(name: &str) -> Option<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let places = ["", "../shared/", "../../shared/"];
    places.iter().find_map(|place| std::fs::read_to_string(root.join(place).join(name)).ok())
}

fn files(names: &[(&str, usize)]) -> Vec<(String, Document, usize)> {
    let read = |(name, step): &(&str, usize)| {
        let text = file(name)?;
        let notation = match () {
            () if name.ends_with(".lad") => Notation::Ladder,
            () if text.contains("PROGRAM") => Notation::IecIl,
            () => Notation::FxIl,
        };
        let model = if notation == Notation::IecIl { Model::Iec } else { Model::Fx3u };
        Some((name.to_string(), Document::new(&text, notation, Target::of(model)), *step))
    };
    names.iter().filter_map(read).collect()
}

#[test]
fn each_contact_of_each_small_rung_counts() {
    let small = |rung: &&String| rung.lines().filter(|line| line.starts_with("LD")).count() <= 3;
    let mut mutants = 0;
    for rung in all_small_rungs().iter().filter(small) {
        let made = translate(&list(rung), None, To::Fx, &Options::default());
        let made = made.text.strip_suffix("END\n").unwrap().to_string();
        let mutants_of_rung = of_list(&Translation { text: made.clone(), ..Translation::default() });
        let is_list = |mutant: &&Mutant| {
            ["LD", "ANB left", "ORB left", "OUT"]
                .iter()
                .all(|word| !mutant.fault.starts_with(word) || !mutant.fault.ends_with("left out"))
        };
        for mutant in mutants_of_rung.iter().filter(is_list) {
            // Each input is in it once, so that each contact and each connection counts.
            assert_ne!(truth_of_list(&made), truth_of_list(&mutant.text), "{}\n{made}", mutant.fault);
            found_different(&made, &mutant.text);
            mutants += 1;
        }
    }
    assert!(mutants > 300, "{mutants}");
}

#[test]
fn faults_in_translations_of_the_examples_are_found() {
    let programs = files(&[
        ("examples/batch-counter/batch.il", 2),
        ("examples/conveyor/conveyor.il", 5),
        ("examples/motor/motor.lad", 1),
        ("examples/traffic-lights/lights.lad", 4),
        ("examples/tank-level/tank.lad", 2),
        ("examples/getting-started/first-steps.lad", 1),
        ("examples/mixer/mixer.il", 3),
    ]);
    // Only where Blink.Enable is on for half a second does a scan come to what these change in the block of a lamp.
    let undecided = [
        "examples/mixer/mixer.il: prove.open: -( )- of OffTime.IN as -(S)-",
        "examples/mixer/mixer.il: prove.open: +----| |-----------------------------------( )-+ left out",
    ];
    judge(programs, &undecided, 250);
}

#[test]
fn faults_in_translations_of_programs_of_others_are_found() {
    let programs = files(&[
        ("corpus/fx/leandro-Analog_Voltage_Input.il", 1),
        ("corpus/fx/leandro-Bomba_de_poco.il", 1),
        ("corpus/fx/leandro-CALL_Instruction.il", 1),
        ("corpus/fx/leandro-Conter_Up.il", 1),
        ("corpus/fx/leandro-Math_Instructions.il", 4),
        ("corpus/fx/leandro-PWM_2.il", 1),
        ("corpus/fx/leandro-Step_Motor.il", 2),
        ("corpus/fx/leandro-Timer_Delay_to_ON.il", 1),
    ]);
    if programs.is_empty() {
        return say_skipped("no folder of lists");
    }
    let undecided = [
        // The simulated PLC has no analogue block.
        "corpus/fx/leandro-Analog_Voltage_Input.il: prove.unlike: RD3A K0 K0 D0 counted on",
        // Without FEND the subroutine is a part of the main program, which has no counterpart in the other one.
        "corpus/fx/leandro-CALL_Instruction.il: prove.structure: FEND left out",
        concat!(
            "corpus/fx/leandro-CALL_Instruction.il: prove.structure: ",
            "+--[FEND]--------------------------------------+ left out"
        ),
        // A counter counts rising edges itself.
        "corpus/fx/leandro-Conter_Up.il: prove.unconfirmed: -|P|- of X000 as -| |-",
        "corpus/fx/leandro-Step_Motor.il: prove.unconfirmed: LDP T200 left out",
        "corpus/fx/leandro-Step_Motor.il: prove.unconfirmed: -|P|- of T200 as -| |-",
    ];
    judge(programs, &undecided, 150);
}

#[test]
fn faults_in_translations_of_made_up_programs_are_found() {
    let fx = (0..9).filter(|seed| *seed != 1).map(|seed| {
        let rungs = proof_shown::fx_body(&mut Dice(seed * 7919 + 1));
        (format!("fx {seed}"), proof_shown::fx(&rungs.concat()), 1)
    });
    let iec = (0..9).map(|seed| {
        let rungs = proof_shown::iec_body(&mut Dice(seed * 104_729 + 5));
        (format!("iec {seed}"), proof_shown::iec(&rungs.concat()), 1)
    });
    // Nobody calls the block whose output would let power come there.
    let undecided = ["iec 0: prove.unlike: S w.2 as R", "iec 0: prove.unlike: -(S)- of w.2 as -(R)-"];
    judge(fx.chain(iec).collect(), &undecided, 250);
}
