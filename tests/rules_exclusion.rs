//! What is never on together: what is proved, what is found with its inputs, and what is said to be neither.

use proptest::prelude::*;
use rungwise::check::{self, Severities};
use rungwise::document::{Document, Member, Notation, ProjectView};
use rungwise::project::Manifest;
use rungwise::target::{Model, Target};
use rungwise::text::{Diagnostic, Language, Severity};

const CODE: &str = "mutual-exclusion";

fn document(text: &str) -> Document {
    let (notation, model) = match text {
        _ if text.contains("PROGRAM") => (Notation::IecIl, Model::Iec),
        _ if text.contains('|') => (Notation::Ladder, Model::Fx2n),
        _ => (Notation::FxIl, Model::Fx2n),
    };
    Document::new(text, notation, Target::of(model))
}

fn found_with(text: &str, severities: &Severities) -> Vec<Diagnostic> {
    let mut found = check::all(&document(text), severities);
    found.retain(|one| one.code == CODE);
    found
}

fn found(text: &str) -> Vec<Diagnostic> {
    found_with(text, &Severities::default())
}

/// What is said of a list under a comment that excludes `names`; its lines are parted by `; `.
fn said_of(names: &str, program: &str) -> Vec<String> {
    let text = format!("// rungwise: never {names}\n{}\nEND\n", program.replace("; ", "\n"));
    found(&text)
        .iter()
        .map(|one| format!("{} {}", one.severity.word(), one.message.render(Language::English)))
        .collect()
}

fn said(program: &str) -> String {
    said_of("Y0 & Y1", program).join(" / ")
}

fn is_error(said: &str, with: &str) -> bool {
    said.starts_with("error `Y0` and `Y1` can be on together: ") && said.ends_with(with)
}

#[test]
fn interlocks_are_proved() {
    for program in [
        // By an input, by the other rung, and by its own value of the scan before.
        "LD X0; ANI X1; OUT Y0; LD X1; ANI X0; OUT Y1",
        "LD X0; OUT Y0; LD X1; ANI Y0; OUT Y1",
        "LD X0; ANI Y1; OUT Y0; LD X1; ANI Y0; OUT Y1",
        "LD X0; OR Y0; ANI Y1; ANI X2; OUT Y0; LD X1; OR Y1; ANI Y0; ANI X2; OUT Y1",
        // Through relays above, and through relays that follow a scan later.
        "LD X0; ANI M1; OUT M0; LD X1; ANI M0; OUT M1; LD M0; OUT Y0; LD M1; OUT Y1",
        "LD M0; OUT Y0; LD M1; OUT Y1; LD X0; ANI M1; OUT M0; LD X1; ANI M0; OUT M1",
        // Latches that ask for each other.
        "LD X0; ANI Y1; SET Y0; LD X2; RST Y0; LD X1; ANI Y0; SET Y1; LD X3; RST Y1",
        "LD X0; SET Y0; RST Y1; LD X1; SET Y1; RST Y0",
        "LD X0; ANI M1; SET M0; LD X1; ANI M0; SET M1; LD M0; OUT Y0; LD M1; OUT Y1",
        // A timer between star and delta, other timers beside it.
        "LD X0; OUT M0; LD M0; OUT T0 K50; LD M0; ANI T0; OUT Y0; LD M0; AND T0; OUT Y1",
        "LD X0; ANI X1; OUT T0 K5; LD X1; OUT T1 K5; LD T0; OUT Y0; LD T1; OUT Y1",
        // The one relay turns over at each pulse, and chooses.
        "LDP X0; ANI M5; SET M5; LDP X1; RST M5; LD X2; AND M5; OUT Y0; LD X3; ANI M5; OUT Y1",
        // Numbers that exclude each other.
        "LD> D0 K10; OUT Y0; LD< D0 K5; OUT Y1",
        // What is written elsewhere does not matter.
        "LD X0; ANI Y1; OUT Y0; LD X1; ANI Y0; OUT Y1; LD X7; MOV K5 K1M40; CJ P1; LD X6; OUT Y7; P1; LD X5; OUT Y6",
    ] {
        assert_eq!(said(program), "", "{program}");
    }
}

#[test]
fn the_inputs_are_told_that_do_it() {
    for (program, with) in [
        ("LD X0; OUT Y0; LD X1; OUT Y1", "the first scan with `X0`, `X1` on, all other inputs off"),
        ("LDI X0; OUT Y0; LDI X1; OUT Y1", "the first scan with all inputs off"),
        ("LD X0; ANI Y1; OUT Y0; LD X1; OUT Y1", "with `X0`, `X1` on, all other inputs off"),
        // The contact that should be closed is open.
        ("LD X0; AND Y1; OUT Y0; LD X1; OUT Y1", "scan 1 with `X1` on, scan 2 with `X0`, `X1` on"),
        ("LD X0; SET Y0; LD X1; ANI X0; SET Y1", "scan 1 with `X1` on, scan 2 with `X0` on"),
        ("LD M0; OUT Y0; LD X1; OUT Y1; LD X0; ANI X1; OUT M0", "scan 1 with `X0` on, scan 2 with `X1` on"),
        ("LDP X0; SET Y0; LD X1; ANI X0; SET Y1", "scan 1 with `X1` on, scan 2 with `X0` on"),
        ("LD M8002; SET Y0; LD X1; ANI M8002; SET Y1", "scan 1 with all inputs off, scan 2 with `X1` on"),
        // What comes later in the scan wins.
        ("LD X0; OUT Y0; LD X0; OUT Y1; LD X2; OUT Y1", "with `X0`, `X2` on, all other inputs off"),
    ] {
        assert!(is_error(&said(program), with), "{program}\n{}", said(program));
    }
}

#[test]
fn what_is_not_decided_is_no_error() {
    let not_proved = "warning not proved that `Y0` and `Y1` are never on together: ";
    for (program, why) in [
        // Whether the counter counts and the number is reached, nobody follows.
        (
            "LD X0; OUT Y0; LD C0; OUT Y1; LD X1; OUT C0 K5",
            "both are at the end of a scan with input `X0`, `C0` left on by the scan before, if that can come about",
        ),
        (
            "LD M0; OUT T0 K50; LD M0; ANI T0; OUT Y0; LD X3; OUT M0; LD M0; AND T0; OUT Y1; LD T0; OUT Y0",
            "a scan with input `X3`, `M0` left on by the scan before, `T0` switched on in it, if that",
        ),
        (
            "LD X0; MOV D0 K1Y0; LD Y1; OUT Y4",
            "both are at the end of a scan with `Y0`, `Y1` switched on in it",
        ),
        // Behind a refresh an input may be another than before it.
        ("LD X0; OUT Y0; LD M8000; REF X0 K8; LDI X0; OUT Y1", "with `Y0` switched on in it"),
        ("LD X0; OUT Y0; LD M8000; REFF K2; LDI X0; OUT Y1", "with `Y0` switched on in it"),
        ("LD X7; CJ P1; LD X0; OUT Y0; P1; LD X1; ANI Y0; OUT Y1", "leave out line 5"),
        ("LD X7; MC N0 M100; LD X0; OUT Y0; MCR N0; LD X1; ANI Y0; OUT Y1", "leave out line 5"),
        ("FOR K3; LD X0; OUT Y0; NEXT; LD X1; ANI Y0; OUT Y1", "line 4 may be executed several times"),
        ("P1; LD X0; OUT Y0; LD X1; ANI Y0; OUT Y1; LD X7; CJ P1", "line 7 may be executed several times"),
        ("LD X0; CALL P1; LD X1; ANI Y0; OUT Y1; FEND; P1; LD X2; OUT Y0; SRET", "leave out line 10"),
        ("LD X0; ORB; OUT Y0; LD X1; OUT Y1", "line 4:"),
    ] {
        let said = said(program);
        assert!(said.starts_with(not_proved) && said.contains(why), "{program}\n{said}");
    }
}

#[test]
fn of_three_names_no_two_are_on() {
    let three =
        said_of("Y0 & Y1 & Y2 the jaws", "LD X0; OUT Y0; LD X1; ANI Y0; OUT Y1; LD X2; ANI Y0; OUT Y2");
    assert_eq!(three.len(), 1);
    assert!(three[0].contains("`Y1` and `Y2` can be on together"), "{}", three[0]);
}

#[test]
fn names_that_mean_nothing_are_told_where_they_stand() {
    let text = |names: &str| {
        format!(
            "LD X0\n// rungwise: never {names}\nOUT Y0\nLD X1\nOUT Y1\nLD M5\nOUT Y2\nMOV K1 K1Y10\nEND\n"
        )
    };
    for (names, at, key) in [
        ("Y0 & Y7", "Y7", "mutual-exclusion.unknown"),
        ("Y0 & Motor", "Motor", "mutual-exclusion.unknown"),
        ("Y0 & M5", "M5", "mutual-exclusion.unwritten"),
        ("Y0 & y000", "y000", "mutual-exclusion.twice"),
        ("Y0 & Y11", "Y11", "mutual-exclusion.row"),
        ("Y0", "never Y0", "mutual-exclusion.few"),
        ("", "never", "mutual-exclusion.few"),
    ] {
        let text = text(names);
        let found = found(&text);
        let [one] = &found[..] else { panic!("{names}: {found:?}") };
        assert_eq!(
            (one.span.of(&text), one.message.key(), one.severity),
            (at, key, Severity::Warning),
            "{names}"
        );
    }
    // Words that only begin like it are none of it.
    assert!(found(&text("").replace("never", "nevermore")).is_empty());
}

#[test]
fn the_places_of_both_coils_are_shown() {
    let text = "|  X0          Y0  |  // rungwise: never Y0 & Y1\n+--| |---------( )-+\n|  X1          Y1  |\n+--| |---------( )-+\n";
    let found = found(text);
    assert_eq!(found[0].span.of(text), "never Y0 & Y1");
    let places: Vec<&str> = found[0].related.iter().map(|one| one.span.of(text)).collect();
    assert_eq!(places, ["Y0", "Y1"]);
    assert!(found[0].related[0].span.start < found[0].related[1].span.start);
}

#[test]
fn the_manifest_names_pairs() {
    let manifest = Manifest::read("[check]\nnever = [\"Y0 & Y1\", \"M0 & M1 & M2\"]\n").expect("a manifest");
    let severities = manifest.severities();
    let text = "LD X0\nOUT Y0\nLD X1\nOUT Y1\nEND\n";
    let found = found_with(text, &severities);
    // Nothing names the relays, and the outputs are told at the later of their coils.
    let told: Vec<(&str, &str)> = found.iter().map(|one| (one.message.key(), one.span.of(text))).collect();
    assert_eq!(
        told,
        [
            ("mutual-exclusion.unknown", ""),
            ("mutual-exclusion.unknown", ""),
            ("mutual-exclusion.unknown", ""),
            ("mutual-exclusion.found", "Y1"),
        ]
    );
    // One that names nothing is told where the other is written.
    let severities = Manifest::read("[check]\nnever = [\"Y0 & Y7\"]\n").expect("a manifest").severities();
    let found = found_with(text, &severities);
    assert_eq!((found[0].span.of(text), found.len()), ("Y0", 1));
    for (line, at) in
        [("Y0", "Y0"), ("Y0 Y1", "Y0 Y1"), ("Y0 & Y1 & y0", "y0"), ("Y0 & Y1 jaws", "Y0 & Y1 jaws")]
    {
        let text = format!("[check]\nnever = [\n  \"M0 & M1\",\n  \"{line}\",\n]\n");
        let error = Manifest::read(&text).expect_err(line);
        assert_eq!(error.span.of(&text), at);
    }
}

#[test]
fn files_of_a_project_are_one_program() {
    let [first, second] =
        ["// rungwise: never Y0 & Y1\nLD X0\nANI Y1\nOUT Y0\n", "LD X1\nOUT Y1\nEND\n"].map(document);
    let member = |name, document| Member { name, document };
    let members = vec![member("a.il", &first), member("b.il", &second)];
    let view = ProjectView::new(members, 0, true).expect("a project");
    let found = check::project(&view, &Severities::default());
    let one = found[0].iter().find(|one| one.code == CODE).expect("a finding in the file with the comment");
    assert_eq!(one.related.iter().map(|one| one.file).collect::<Vec<_>>(), [None, Some(1)]);
}

#[test]
fn units_have_variables_of_their_own() {
    let unit = |name: &str, lock: &str| {
        format!(
            "PROGRAM {name}\nVAR\n  A AT %IX0.0 : BOOL;\n  B AT %IX0.1 : BOOL;\n  Up : BOOL;\n  Down : BOOL;\nEND_VAR\n\
             LD A\nANDN Down\nST Up\nLD B\n{lock}ST Down\nEND_PROGRAM\n"
        )
    };
    let text = format!("// rungwise: never Up & Down\n\n{}\n{}", unit("One", "ANDN Up\n"), unit("Two", ""));
    let found = found(&text);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].related[0].span.start as usize > text.find("PROGRAM Two").expect("a unit"));
    // A comment in a unit, or above all of one, is about that one.
    for (comment, count) in [("One", 0), ("Two", 1)] {
        let text = format!("{}\n{}", unit("One", "ANDN Up\n"), unit("Two", ""));
        let inside = text.replace(
            &format!("PROGRAM {comment}\n"),
            &format!("PROGRAM {comment}\n// rungwise: never Up & Down\n"),
        );
        assert_eq!(self::found(&inside).len(), count, "{comment}");
    }
    // An initial value counts: both may begin on.
    let held = "PROGRAM P\nVAR\n A AT %IX0.0 : BOOL;\n Up : BOOL := TRUE;\n Down : BOOL := TRUE;\nEND_VAR\n\
         // rungwise: never Up & Down\nLD A\nANDN A\nS Up\nS Down\nEND_PROGRAM\n";
    assert_eq!(self::found(held)[0].message.key(), "mutual-exclusion.state");
    assert!(self::found(&held.replace(":= TRUE", "")).is_empty());
}

/// A rung of two contacts: devices by their numbers in [`NAMES`], each with its polarity.
#[derive(Clone, Copy, Debug)]
struct Small {
    contacts: [(usize, bool); 2],
    is_or: bool,
    /// OUT, SET or RST.
    word: &'static str,
    target: usize,
}

const NAMES: [&str; 6] = ["X0", "X1", "Y0", "Y1", "M0", "M1"];
const INPUTS: usize = 2;
const OUTPUTS: [usize; 2] = [2, 3];

impl Small {
    fn text(&self) -> String {
        let [(first, is_on), (second, is_also)] = self.contacts;
        let load = if is_on { "LD" } else { "LDI" };
        let join = match (self.is_or, is_also) {
            (false, true) => "AND",
            (false, false) => "ANI",
            (true, true) => "OR",
            (true, false) => "ORI",
        };
        format!("{load} {}\n{join} {}\n{} {}\n", NAMES[first], NAMES[second], self.word, NAMES[self.target])
    }

    fn run(&self, bits: &mut [bool; 6]) {
        let [first, second] = self.contacts.map(|(device, is_on)| bits[device] == is_on);
        let power = if self.is_or { first || second } else { first && second };
        let target = &mut bits[self.target];
        match self.word {
            "SET" => *target |= power,
            "RST" => *target &= !power,
            _ => *target = power,
        }
    }
}

fn scan(program: &[Small], state: [bool; 6], inputs: [bool; INPUTS]) -> [bool; 6] {
    let mut bits = state;
    bits[..INPUTS].copy_from_slice(&inputs);
    program.iter().for_each(|rung| rung.run(&mut bits));
    bits
}

fn are_both_on(state: &[bool; 6]) -> bool {
    OUTPUTS.iter().all(|output| state[*output])
}

const ALL_INPUTS: [[bool; INPUTS]; 4] = [[false, false], [true, false], [false, true], [true, true]];

/// After how many scans from the start both outputs can be on; nothing if never.
fn scans_until_both(program: &[Small]) -> Option<usize> {
    let mut seen = std::collections::HashSet::from([[false; 6]]);
    let mut states = vec![[false; 6]];
    for scans in 1.. {
        let next = states.iter().flat_map(|state| ALL_INPUTS.map(|inputs| scan(program, *state, inputs)));
        let next: Vec<[bool; 6]> = next.collect();
        if next.iter().any(are_both_on) {
            return Some(scans);
        }
        states = next.into_iter().filter(|state| seen.insert(*state)).collect();
        if states.is_empty() {
            return None;
        }
    }
    None
}

/// The inputs that are told, scan by scan.
fn inputs_told(said: &str) -> Vec<[bool; INPUTS]> {
    let steps = said.split_once("can be on together: ").expect("an error").1;
    let steps: Vec<&str> = match steps.contains("the first scan") {
        true => vec![steps],
        false => steps.split("scan ").filter(|step| !step.is_empty()).collect(),
    };
    steps.iter().map(|step| [step.contains("`X0`"), step.contains("`X1`")]).collect()
}

/// Whether the verdict on a program is right; whether it is "not proved".
fn judged_rightly(program: &[Small]) -> Result<bool, String> {
    let text: String = program.iter().map(Small::text).collect();
    let text = format!("// rungwise: never Y0 & Y1\n{text}END\n");
    let found = found(&text);
    let said = found.first().map(|one| one.message.render(Language::English));
    let wrong = |why: &str| Err(format!("{text}{why}: {said:?}"));
    match (found.first().map(|one| one.severity), scans_until_both(program)) {
        (None, Some(_)) => wrong("called proved, but both come on"),
        (Some(Severity::Error), None) => wrong("both never come on"),
        (Some(Severity::Error), Some(scans)) => {
            let told = inputs_told(said.as_deref().unwrap_or(""));
            let mut state = [false; 6];
            told.iter().for_each(|inputs| state = scan(program, state, *inputs));
            match told.len() == scans && are_both_on(&state) {
                true => Ok(false),
                false => wrong("what is told does not do it, or not soonest"),
            }
        }
        (Some(_), Some(scans)) if scans <= 3 => wrong("not told, though it takes few scans"),
        (verdict, _) => Ok(verdict.is_some()),
    }
}

#[test]
fn all_pairs_of_small_rungs_are_judged_rightly() {
    let literals: Vec<(usize, bool)> = (0..4).flat_map(|device| [(device, true), (device, false)]).collect();
    let mut rungs = Vec::new();
    for (place, first) in literals.iter().enumerate() {
        for second in &literals[place + 1..] {
            rungs.extend([false, true].map(|is_or| ([*first, *second], is_or)));
        }
    }
    let (mut count, mut open) = (0, 0);
    for (contacts, is_or) in &rungs {
        for (others, is_other_or) in &rungs {
            let program = [
                Small { contacts: *contacts, is_or: *is_or, word: "OUT", target: 2 },
                Small { contacts: *others, is_or: *is_other_or, word: "OUT", target: 3 },
            ];
            open += usize::from(judged_rightly(&program).unwrap_or_else(|wrong| panic!("{wrong}")));
            count += 1;
        }
    }
    assert_eq!(count, 56 * 56);
    assert!(open * 20 < count, "{open} of {count} were left open");
}

#[test]
fn a_latch_that_never_changes_hides_no_sequence() {
    for latch in ["LD M0\nSET M0\n", "LD M0\nANI M0\nSET M0\n", "LDI M0\nRST M0\n"] {
        let text = format!(
            "// rungwise: never Y0 & Y1\nLD Y1\nANI Y0\nOUT Y0\nLDI X1\nANI M0\nOUT Y1\n{latch}END\n"
        );
        let severities: Vec<Severity> = found(&text).iter().map(|one| one.severity).collect();
        assert_eq!(severities, [Severity::Error], "{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]
    #[test]
    fn programs_with_latches_and_relays_are_judged_rightly(
        rungs in prop::collection::vec(
            ((0usize..6, any::<bool>()), (0usize..6, any::<bool>()), any::<bool>(), 0usize..3, 2usize..6),
            2..7,
        )
    ) {
        let word = |number: usize| ["OUT", "SET", "RST"][number];
        let targets: Vec<usize> =
            rungs.iter().enumerate().map(|(place, rung)| if place < 2 { place + 2 } else { rung.4 }).collect();
        // A relay that nothing drives is an input to the rule, and off to this evaluator: an input stands for it.
        let known = |(device, is_on): (usize, bool)| match device < INPUTS || targets.contains(&device) {
            true => (device, is_on),
            false => (device % INPUTS, is_on),
        };
        let program: Vec<Small> = rungs
            .iter()
            .zip(&targets)
            .map(|((first, second, is_or, number, _), target)| {
                Small { contacts: [known(*first), known(*second)], is_or: *is_or, word: word(*number), target: *target }
            })
            .collect();
        if let Err(wrong) = judged_rightly(&program) {
            prop_assert!(false, "{wrong}");
        }
    }
}
