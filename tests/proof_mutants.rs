//! The proof finds each wrong translation: programs of the project, of other people and made up ones are translated, the
//! translation is spoiled at each of its contacts, branches, constants and outputs, and proved against the source. What
//! is found to differ is run on the simulated PLC, which must show it, and by the evaluator as far as it can follow;
//! what is found equal is run as well, and must not.

use crate::corpus::say_skipped;
use crate::proof_shown::{self, Dice};
use crate::translate::{all_small_rungs, drawing, found_different, list, truth_of_list};
use crate::translation_faults::{Mutant, of_drawing, of_list, words};
use rungwise::document::{Document, Notation};
use rungwise::logic::{State, evaluate_jumping};
use rungwise::scenario::shown;
use rungwise::simulate::compile;
use rungwise::target::{Model, Target};
use rungwise::text::Span;
use rungwise::translate::{
    Counterexample, Options, Proof, Shown, Source, To, Translation, Value, prove, translate,
};
use smol_str::SmolStr;
use std::path::Path;

/// What became of the mutants of some programs.
#[derive(Default)]
struct Tally {
    different: usize,
    /// Of those the ones that the evaluator, which knows neither formulas nor the simulated PLC, tells apart as well.
    evaluated: usize,
    /// Not decided, with the reason.
    undecided: Vec<String>,
    /// Faults that leave no program: a block is left open, an operand is missing. They are not equal, either.
    broken: Vec<String>,
    wrong: Vec<String>,
}

impl Tally {
    fn judge(&mut self, source: &Document, made: &Document, mutant: &Mutant) {
        let spoiled = Document::new(&mutant.text, made.notation(), made.target());
        let told = |what: &str| format!("{what}: {}\n{}\n--\n{}", mutant.fault, source.text(), mutant.text);
        let line = |reason: &str| format!("{reason}: {}", words(&mutant.fault).join(" "));
        let names = ["one".to_string(), "two".to_string()];
        let runs = compile(&[&spoiled], false).is_ok();
        let proof = prove(source, &spoiled);
        if let Proof::Different(found) = &proof {
            self.evaluated += usize::from(evaluates_apart([source, &spoiled], found));
        }
        match shown(proof, [source, &spoiled], &names) {
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
            _ if !runs => self.broken.push(words(&mutant.fault).join(" ")),
            Proof::Undecided { reason, .. } if reason.key() == "prove.unread" => {
                self.broken.push(words(&mutant.fault).join(" "))
            }
            Proof::Different(found) => {
                let Shown::Not(reason) = &found.shown else { return self.wrong.push(told("untried")) };
                self.undecided.push(line(reason.key()));
            }
            Proof::Undecided { reason, .. } => self.undecided.push(line(reason.key())),
        }
    }
}

/// Whether one scan with plain values tells two programs apart as a proof says.
fn evaluates_apart(sides: [&Document; 2], found: &Counterexample) -> bool {
    let key = |name: &String| found.keys.get(name).map_or_else(|| name.as_str().into(), SmolStr::clone);
    let mut state = State::default();
    for (name, value) in &found.inputs {
        match value {
            Value::Bit(on) => _ = state.bits.insert(key(name), *on),
            Value::Word(number) => _ = state.words.insert(key(name), *number),
            _ => return false,
        }
    }
    for (name, value) in &found.before {
        let Value::Bit(on) = value else { return false };
        state.before.insert(key(name), *on);
    }
    let sources = [0, 1].map(|side| {
        let all = Source::within(sides[side], Span::new(0, sides[side].len()));
        let unit = found.at[side].map(|at| sides[side].unit_at(at.start as usize).number);
        all.into_iter().filter(|source| unit.is_none_or(|unit| source.pou == unit)).collect::<Vec<_>>()
    });
    let rungs = sources.each_ref().map(|all| all.iter().map(|source| &source.rung).collect::<Vec<_>>());
    let [Some(left), Some(right)] = rungs.each_ref().map(|rungs| evaluate_jumping(rungs, &state)) else {
        return false;
    };
    let what = key(&found.what);
    left.bit(&what) != right.bit(&what) || left.events != right.events
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

/// What becomes of each fault in the translations of a program.
fn tally(source: &Document) -> Tally {
    let source = &without_comments(source);
    let mut tally = Tally::default();
    let [(list, listed), (drawing, _)] = forms(source);
    assert!(compile(&[&list], false).is_ok(), "does not run:\n{}", list.text());
    assert!(compile(&[&drawing], false).is_ok(), "does not run:\n{}", drawing.text());
    let spoiled = of_list(&listed).into_iter().map(|mutant| (&list, mutant));
    let spoiled = spoiled.chain(of_drawing(&drawing).into_iter().map(|mutant| (&drawing, mutant)));
    for (made, mutant) in spoiled {
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

/// What is expected of the faults of some programs.
struct Expected<'e> {
    /// Those of which nothing is decided; of programs without effect their number.
    undecided: &'e [&'e str],
    /// So many at least are shown on the simulated PLC.
    different: usize,
    /// So many of them at least by the evaluator, too, which follows no steps and calls.
    evaluated: usize,
    /// So many at most leave no program.
    broken: usize,
    /// The programs with a rung that does nothing, so that no fault in it is one.
    without_effect: &'e [&'e str],
}

fn judge(programs: Vec<(String, Document)>, expected: &Expected<'_>) {
    let mut all = Tally::default();
    for (name, document) in programs {
        let tally = tally(&document);
        let named =
            |said: Vec<String>| said.into_iter().map(|said| format!("{name}: {said}")).collect::<Vec<_>>();
        all.different += tally.different;
        all.evaluated += tally.evaluated;
        match expected.without_effect.contains(&name.as_str()) {
            true => all.undecided.push(format!("{name}: {}", tally.undecided.len())),
            false => all.undecided.extend(named(tally.undecided)),
        }
        all.broken.extend(named(tally.broken));
        all.wrong.extend(tally.wrong);
    }
    assert!(all.wrong.is_empty(), "{} of\n{}", all.wrong.len(), all.wrong.join("\n=====\n"));
    assert_eq!(all.undecided, expected.undecided, "{:#?}", all.undecided);
    assert!(all.broken.len() <= expected.broken, "{} {:#?}", all.broken.len(), all.broken);
    let counts = [all.different, all.evaluated];
    assert!(counts[0] >= expected.different && counts[1] >= expected.evaluated, "{counts:?}");
}

/// A file of the project, or one beside it.
fn file(name: &str) -> Option<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let places = ["", "../shared/", "../../shared/"];
    places.iter().find_map(|place| std::fs::read_to_string(root.join(place).join(name)).ok())
}

fn files(names: &[&str]) -> Vec<(String, Document)> {
    let read = |name: &&str| {
        let text = file(name)?;
        let notation = match () {
            () if name.ends_with(".lad") => Notation::Ladder,
            () if text.contains("PROGRAM") => Notation::IecIl,
            () => Notation::FxIl,
        };
        let model = if notation == Notation::IecIl { Model::Iec } else { Model::Fx3u };
        Some((name.to_string(), Document::new(&text, notation, Target::of(model))))
    };
    names.iter().filter_map(read).collect()
}

/// All small rungs; of those with four and five contacts only with all of them open and with every other one closed: a
/// contact that is turned over is another input in the same place.
fn small_rungs() -> Vec<String> {
    let is_taken = |rung: &String| {
        let contacts: Vec<&str> = rung.lines().filter(|line| line.starts_with("LD")).collect();
        let is_closed = |number: usize| contacts[number].starts_with("LDI");
        let numbers = || 0..contacts.len();
        contacts.len() <= 3
            || !numbers().any(is_closed)
            || numbers().all(|number| is_closed(number) == (number % 2 == 1))
    };
    all_small_rungs().into_iter().filter(is_taken).collect()
}

#[test]
fn each_contact_of_each_small_rung_counts() {
    let mut mutants = 0;
    for rung in small_rungs() {
        let made = translate(&list(&rung), None, To::Fx, &Options::default());
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
    assert!(mutants > 2800, "{mutants}");
}

#[test]
fn each_branch_of_each_small_drawing_counts() {
    let rungs = small_rungs();
    let mut mutants = 0;
    for rung in &rungs {
        let source = list(rung);
        let drawn = translate(&source, None, To::Ladder, &Options { is_whole: false, ..Options::default() });
        let drawn = drawing(&drawn.text);
        for mutant in of_drawing(&drawn) {
            let spoiled = drawing(&mutant.text);
            match prove(&source, &spoiled) {
                Proof::Different(found) => {
                    assert!(evaluates_apart([&source, &spoiled], &found), "{rung}\n{}", mutant.text);
                }
                // Without its rung it is no program at all.
                proof => panic!("{proof:?}: {}\n{rung}\n{}", mutant.fault, mutant.text),
            }
            mutants += 1;
        }
    }
    assert!(mutants > 1000, "{mutants}");
}

#[test]
fn faults_in_translations_of_the_examples_are_found() {
    let programs = files(&[
        "examples/batch-counter/batch.il",
        "examples/conveyor/conveyor.il",
        "examples/motor/motor.lad",
        "examples/traffic-lights/lights.lad",
        "examples/tank-level/tank.lad",
        "examples/getting-started/first-steps.lad",
        "examples/mixer/mixer.il",
    ]);
    let undecided = [
        // Behind a step OUT of a state goes there as SET does.
        "examples/conveyor/conveyor.il: prove.unlike: -( )- of S0 as -(S)-",
        // The first call finds a preset of 0, in which no time ends.
        "examples/mixer/mixer.il: prove.unlike: OnTime.PT and OffTime.PT swapped",
        // What is tried from the start does not come to a second batch.
        "examples/mixer/mixer.il: prove.open: -( )- of Batches.CU as -(S)-",
    ];
    judge(
        programs,
        &Expected { undecided: &undecided, different: 900, evaluated: 300, broken: 45, without_effect: &[] },
    );
}

#[test]
fn faults_in_translations_of_programs_of_others_are_found() {
    let programs = files(&[
        "corpus/fx/leandro-Analog_Voltage_Input.il",
        "corpus/fx/leandro-Bomba_de_poco.il",
        "corpus/fx/leandro-CALL_Instruction.il",
        "corpus/fx/leandro-Conter_Up.il",
        "corpus/fx/leandro-Math_Instructions.il",
        "corpus/fx/leandro-PWM_2.il",
        "corpus/fx/leandro-Step_Motor.il",
        "corpus/fx/leandro-Timer_Delay_to_ON.il",
    ]);
    if programs.is_empty() {
        return say_skipped("no folder of lists");
    }
    const END: &str = "rung left out: +--[FEND]--------------------------------------+";
    let [call_end, step_end] = ["CALL_Instruction", "Step_Motor"]
        .map(|name| format!("corpus/fx/leandro-{name}.il: prove.structure: {END}"));
    let undecided = [
        // The simulated PLC has no analogue block.
        "corpus/fx/leandro-Analog_Voltage_Input.il: prove.unlike: RD3A K0 K0 D0 counted on",
        // Without FEND the subroutine is a part of the main program, which has no counterpart in the other one.
        "corpus/fx/leandro-CALL_Instruction.il: prove.structure: FEND left out",
        &call_end,
        // A counter counts rising edges itself.
        "corpus/fx/leandro-Conter_Up.il: prove.unconfirmed: -|P|- of X000 as -| |-",
        "corpus/fx/leandro-Step_Motor.il: prove.structure: FEND left out",
        "corpus/fx/leandro-Step_Motor.il: prove.unconfirmed: LDP T200 left out",
        "corpus/fx/leandro-Step_Motor.il: prove.unconfirmed: -|P|- of T200 as -| |-",
        &step_end,
    ];
    judge(
        programs,
        &Expected { undecided: &undecided, different: 350, evaluated: 100, broken: 18, without_effect: &[] },
    );
}

#[test]
fn faults_in_translations_of_made_up_programs_are_found() {
    let fx = (0..9).map(|seed| {
        let rungs = proof_shown::fx_body(&mut Dice(seed * 7919 + 1));
        (format!("fx {seed}"), proof_shown::fx(&rungs.concat()))
    });
    let iec = (0..9).map(|seed| {
        let rungs = proof_shown::iec_body(&mut Dice(seed * 104_729 + 5));
        (format!("iec {seed}"), proof_shown::iec(&rungs.concat()))
    });
    let undecided = [
        // A jump over nothing does nothing, whatever its condition is.
        "fx 1: 8",
        // Nobody calls the block whose output would let power come there.
        "iec 0: prove.unlike: S w.2 as R",
        "iec 0: prove.unlike: -(S)- of w.2 as -(R)-",
        concat!(
            "iec 0: prove.structure: rung left out: | r.Q1 z s.Q1 w.2 | ",
            "+---|/|-----|/|---+---| |------------------(S)-+ | r.Q1 z | | +---| |-----| |---+ |",
        ),
        // Behind RETC of z nothing can reset z.
        "iec 8: 27",
    ];
    judge(
        fx.chain(iec).collect(),
        &Expected {
            undecided: &undecided,
            different: 320,
            evaluated: 50,
            broken: 87,
            without_effect: &["fx 1", "iec 8"],
        },
    );
}
