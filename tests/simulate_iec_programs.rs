//! Drawings, tasks, addresses and whole projects of IEC 61131-3 on the simulated PLC.

use crate::simulate_iec::document;
use proptest::prelude::*;
use rungwise::document::{Document, Notation};
use rungwise::logic::{Declared, State, evaluate, rungs_with};
use rungwise::simulate::{EnergisedKind, Session, Value, compile, power_flow};
use rungwise::translate::{Options, To, translate};
use std::sync::Arc;

const MS: i64 = 1_000_000;

fn session(documents: &[Document]) -> Session {
    let documents: Vec<&Document> = documents.iter().collect();
    let code = compile(&documents, false).unwrap_or_else(|problems| panic!("{problems:#?}"));
    Session::new(Arc::new(code))
}

fn set(session: &mut Session, name: &str, value: &str) {
    let code = Arc::clone(session.machine().code());
    let variable = code.variable(name).unwrap_or_else(|| panic!("{name} is a variable"));
    let value = Value::read(value).expect("a value");
    session.touch(variable.set(&code, &value).expect("a value of its type"));
}

fn get(session: &Session, name: &str) -> String {
    let machine = session.machine();
    let variable = machine.code().variable(name).unwrap_or_else(|| panic!("{name} is a variable"));
    machine.value(variable, 0).to_string()
}

const DRAWN: &str = "\
PROGRAM Main
VAR
    Start AT %IX0.0 : BOOL;
    Motor AT %QX0.0 : BOOL;
    Late, Done : BOOL;
    Delay : TON;
    Level AT %IW1 : INT;
    Copy : INT;
END_VAR

|  Start                                  Motor|
+---| |---+---------------------------------( )-+
|  Motor  |                                    |
+---| |---+                                    |

END_PROGRAM
";

#[test]
fn a_drawing_with_variables_runs() {
    let mut session = session(&[document(DRAWN, Notation::Ladder)]);
    set(&mut session, "Start", "1");
    session.scan(0);
    assert_eq!(get(&session, "Motor"), "1");
}

#[test]
fn the_pump_station_runs() {
    let read =
        |name: &str| std::fs::read_to_string(format!("examples/pump-station/{name}")).expect("an example");
    let documents = [
        document(&read("types.il"), Notation::IecIl),
        document(&read("pump.lad"), Notation::Ladder),
        document(&read("station.il"), Notation::IecIl),
        document(&read("configuration.il"), Notation::IecIl),
    ];
    let mut session = session(&documents);
    set(&mut session, "Level", "700");
    session.scan(0);
    assert_eq!((get(&session, "MotorOne"), get(&session, "MotorTwo")), ("1".into(), "0".into()));
    // Five seconds without flow are a fault, and the second pump helps out.
    for scan in 1..=510 {
        session.scan(scan * 10 * MS);
    }
    assert_eq!((get(&session, "Main.First.Failed"), get(&session, "MotorOne")), ("1".into(), "0".into()));
    session.scan(5_200 * MS);
    assert_eq!(get(&session, "MotorTwo"), "1");
    set(&mut session, "FlowTwo", "1");
    (521..600).for_each(|scan| _ = session.scan(scan * 10 * MS));
    assert_eq!(get(&session, "StationState"), "NoFault");
    // The task runs every 100 ms only.
    session.scan(6_000 * MS);
    set(&mut session, "Level", "0");
    set(&mut session, "Button", "1");
    session.scan(6_010 * MS);
    assert_eq!(get(&session, "MotorTwo"), "1");
    session.scan(6_100 * MS);
    assert_eq!(get(&session, "MotorTwo"), "0");
}

#[test]
fn addresses_share_bits_and_images_change_between_scans() {
    let text = "PROGRAM Main\nVAR\nrow AT %QW0 : WORD;\nn AT %ID1 : REAL;\nm AT %MX0.1 : BOOL;\nEND_VAR\n\
                LD %QX0.3\nST m\nLD %IW0\nST row\nLD n\nST %MD4\nLD %MD4\nMUL 2.0\nST %MD5\nEND_PROGRAM\n";
    let mut session = session(&[document(text, Notation::IecIl)]);
    set(&mut session, "%IW0", "9");
    set(&mut session, "n", "2.5");
    session.scan(0);
    assert_eq!(
        (get(&session, "row"), get(&session, "m"), get(&session, "%MB0")),
        ("9".into(), "0".into(), "0".into())
    );
    session.scan(MS);
    assert_eq!((get(&session, "m"), get(&session, "%MX0.1")), ("1".into(), "1".into()));
    assert_eq!((get(&session, "%QX0.0"), get(&session, "%MD5")), ("1".into(), 5.0_f32.to_bits().to_string()));
}

#[test]
fn tasks_run_by_priority_time_and_edge() {
    let text = "CONFIGURATION Plant\nVAR_GLOBAL\nlog : DINT;\ngo : BOOL;\nEND_VAR\nRESOURCE PLC ON CPU\n\
                TASK Slow(SINGLE := FALSE, INTERVAL := T#50ms, PRIORITY := 2);\nTASK Fast(INTERVAL := T#20ms, PRIORITY := 1);\n\
                TASK Edge(SINGLE := go, PRIORITY := 0);\nPROGRAM A WITH Slow : Two;\nPROGRAM B WITH Fast : One;\n\
                PROGRAM C WITH Edge : Three;\nPROGRAM D : Four;\nEND_RESOURCE\nEND_CONFIGURATION\n\
                PROGRAM One\nVAR_EXTERNAL\nlog : DINT;\nEND_VAR\nLD log\nMUL 10\nADD 1\nST log\nEND_PROGRAM\n\
                PROGRAM Two\nVAR_EXTERNAL\nlog : DINT;\nEND_VAR\nLD log\nMUL 10\nADD 2\nST log\nEND_PROGRAM\n\
                PROGRAM Three\nVAR_EXTERNAL\nlog : DINT;\nEND_VAR\nVAR\nruns : INT;\nEND_VAR\nLD log\nMUL 10\nADD 3\nST log\n\
                LD runs\nADD 1\nST runs\nEND_PROGRAM\n\
                PROGRAM Four\nVAR\nruns : INT;\nEND_VAR\nLD runs\nADD 1\nST runs\nEND_PROGRAM\n";
    let mut session = session(&[document(text, Notation::IecIl)]);
    let log = |session: &mut Session, ms: i64| {
        set(session, "log", "0");
        session.scan(ms * MS);
        get(session, "log")
    };
    assert_eq!(log(&mut session, 0), "12");
    assert_eq!(log(&mut session, 10), "0");
    assert_eq!(log(&mut session, 20), "1");
    set(&mut session, "go", "1");
    assert_eq!(log(&mut session, 50), "312");
    assert_eq!(log(&mut session, 60), "1");
    assert_eq!((get(&session, "PLC.C.runs"), get(&session, "d.runs")), ("1".into(), "5".into()));
}

#[test]
fn what_is_not_simulated_is_refused_at_its_place() {
    let refused = |text: &str| {
        let problems = compile(&[&document(text, Notation::IecIl)], false).expect_err("a refusal");
        let place = problems[0].place.span;
        let message = problems[0].obstacle.message();
        (text[place.start as usize..place.end as usize].to_string(), message.key().to_string())
    };
    let unit =
        |declared: &str, body: &str| format!("PROGRAM Main\nVAR\n{declared}\nEND_VAR\n{body}\nEND_PROGRAM\n");
    let said = |declared: &str, body: &str| refused(&unit(declared, body));
    assert_eq!(said("a : BOOL;", "LD b\nST a"), ("LD b".into(), "simulate.undeclared".into()));
    assert_eq!(said("a : BOOL;", "ST a").1, "logic.no-current-result");
    assert_eq!(said("a : BOOL; n : INT;", "LD n\nST a").1, "simulate.mismatch");
    assert_eq!(said("a : ARRAY[1..3] OF INT; n : INT;", "LD a[4]\nST n").1, "simulate.index-known");
    assert_eq!(said("a : BOOL;", "LD a\nJMPC Nowhere").1, "simulate.no-label-named");
    assert_eq!(said("p : Unknown;", "LD TRUE").1, "simulate.no-type");
    assert_eq!(said("CONSTANT_1 : INT;", "LD 1.5\nST CONSTANT_1").1, "simulate.mismatch");
    let text = "FUNCTION F : INT\nVAR_INPUT\nx : INT;\nEND_VAR\nLD x\nF\nST F\nEND_FUNCTION\n".to_string()
        + &unit("n : INT;", "LD n\nF\nST n");
    assert_eq!(refused(&text).1, "simulate.recursion");
}

/// A condition of four relays.
#[derive(Clone, Debug)]
enum Condition {
    Relay(usize, bool),
    Joined(&'static str, Box<[Condition; 2]>),
}

/// All conditions whose relays are those of a range, in order.
fn conditions(relays: std::ops::Range<usize>) -> Vec<Condition> {
    if relays.len() == 1 {
        return [false, true].map(|negated| Condition::Relay(relays.start, negated)).to_vec();
    }
    let mut all = Vec::new();
    for middle in relays.start + 1..relays.end {
        for left in conditions(relays.start..middle) {
            for right in conditions(middle..relays.end) {
                for operator in ["AND", "OR", "XOR"] {
                    all.push(Condition::Joined(operator, Box::new([left.clone(), right.clone()])));
                }
            }
        }
    }
    all
}

impl Condition {
    fn holds(&self, inputs: usize) -> bool {
        match self {
            Condition::Relay(number, negated) => (inputs >> number & 1 == 1) != *negated,
            Condition::Joined(operator, sides) => {
                let [left, right] = [0, 1].map(|side| sides[side].holds(inputs));
                match *operator {
                    "AND" => left && right,
                    "OR" => left || right,
                    _ => left != right,
                }
            }
        }
    }

    fn has_exclusive(&self) -> bool {
        match self {
            Condition::Relay(..) => false,
            Condition::Joined(operator, sides) => {
                *operator == "XOR" || sides.iter().any(Condition::has_exclusive)
            }
        }
    }

    /// Behind `LD`, `AND(` and the like.
    fn list(&self, text: &mut String) {
        match self {
            Condition::Relay(number, negated) => {
                *text += &format!("LD{} r{number}\n", if *negated { "N" } else { "" })
            }
            Condition::Joined(operator, sides) => {
                sides[0].list(text);
                match &sides[1] {
                    Condition::Relay(number, negated) => {
                        *text += &format!("{operator}{} r{number}\n", if *negated { "N" } else { "" });
                    }
                    inner => {
                        *text += &format!("{operator}(\n");
                        inner.list(text);
                        *text += ")\n";
                    }
                }
            }
        }
    }
}

fn program_of(conditions: &[Condition]) -> String {
    let mut text = "PROGRAM Main\nVAR\nr0, r1, r2, r3 : BOOL;\n".to_string();
    (0..conditions.len()).for_each(|number| text += &format!("y{number} : BOOL;\n"));
    text += "END_VAR\n";
    for (number, condition) in conditions.iter().enumerate() {
        condition.list(&mut text);
        text += &format!("ST y{number}\n");
    }
    text + "END_PROGRAM\n"
}

fn assert_all_hold(document: &Document, conditions: &[Condition]) {
    let mut session = session(std::slice::from_ref(document));
    let code = Arc::clone(session.machine().code());
    let outputs: Vec<_> = (0..conditions.len())
        .map(|number| code.variable(&format!("y{number}")).expect("a variable"))
        .collect();
    for inputs in 0..16 {
        for number in 0..4 {
            set(&mut session, &format!("r{number}"), if inputs >> number & 1 == 1 { "1" } else { "0" });
        }
        session.scan(inputs as i64 * MS);
        for (condition, output) in conditions.iter().zip(&outputs) {
            let is_on = session.machine().value(*output, 0) == Value::Bit(true);
            assert_eq!(is_on, condition.holds(inputs), "{condition:?} {inputs:04b}");
        }
    }
}

#[test]
fn every_small_condition_holds_when_it_should() {
    let all: Vec<Condition> = (1..=4).flat_map(|relays| conditions(0..relays)).collect();
    assert_all_hold(&document(&program_of(&all), Notation::IecIl), &all);
}

#[test]
fn small_conditions_are_the_same_in_drawings_and_as_their_paths_say() {
    let all: Vec<Condition> = (1..=4).flat_map(|relays| conditions(0..relays)).collect();
    let plain: Vec<Condition> = all.into_iter().filter(|it| !it.has_exclusive()).step_by(3).collect();
    let list = document(&program_of(&plain), Notation::IecIl);
    let drawn = translate(&list, None, To::Ladder, &Options::default()).text;
    assert!(drawn.contains("| |"), "{drawn}");
    assert_all_hold(&document(&drawn, Notation::Ladder), &plain);
    // The reader of rungs and its plain evaluation are of the same opinion.
    for (at, pous) in list.iec_chunks() {
        let declared = Declared { scopes: list.scopes(), pous };
        for rung in rungs_with(at.chunk, list.target(), declared) {
            let Ok(Some(path)) = rung.path else { continue };
            let output = path.actions()[0].terms[0].key();
            let condition = &plain[output[1..].parse::<usize>().expect("a number")];
            for inputs in 0..16_usize {
                let bits =
                    (0..4).map(|number| (format!("r{number}").into(), inputs >> number & 1 == 1)).collect();
                let state = State { bits, ..State::default() };
                let scan = evaluate(&[&path], &state);
                assert_eq!(scan.bit(&output), condition.holds(inputs), "{condition:?} {inputs:04b}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arithmetic_is_that_of_sixteen_bits(
        first in any::<i16>(),
        steps in proptest::collection::vec((0..7usize, any::<i16>(), any::<bool>()), 1..12),
    ) {
        const NAMES: [&str; 7] = ["ADD", "SUB", "MUL", "DIV", "MOD", "MAX", "MIN"];
        let mut declared = format!("first : INT := {first};\nx : INT;\n");
        let mut body = "LD first\n".to_string();
        let mut expected = i64::from(first);
        for (number, (operator, value, is_variable)) in steps.iter().enumerate() {
            declared += &format!("v{number} : INT := {value};\n");
            let operand = if *is_variable { format!("v{number}") } else { value.to_string() };
            let name = NAMES[*operator];
            body += &if *is_variable && *operator < 5 && number % 3 == 0 {
                format!("{name}( {operand}\nADD 0\n)\n")
            } else {
                format!("{name} {operand}\n")
            };
            let value = i64::from(*value);
            let exact = match *operator {
                0 => expected + value,
                1 => expected - value,
                2 => expected * value,
                3 => expected.checked_div(value).unwrap_or(0),
                4 => expected.checked_rem(value).unwrap_or(0),
                5 => expected.max(value),
                _ => expected.min(value),
            };
            expected = i64::from(exact as i16);
        }
        let text = format!("PROGRAM Main\nVAR\n{declared}END_VAR\n{body}ST x\nEND_PROGRAM\n");
        let mut session = session(&[document(&text, Notation::IecIl)]);
        session.scan(0);
        prop_assert_eq!(get(&session, "x"), expected.to_string(), "{}", text);
    }
}

#[test]
fn power_flows_in_lists_and_drawings() {
    let document = document(DRAWN, Notation::Ladder);
    let [plain, watched] =
        [false, true].map(|is_watched| Arc::new(compile(&[&document], is_watched).expect("code")));
    let mut session = Session::new(plain);
    set(&mut session, "Start", "1");
    let mut sights = Vec::new();
    session.scan_seen(0, &watched, |sight| sights.push(sight));
    let shown = power_flow(&document, 0, &watched, &sights, 0..DRAWN.len());
    let outputs: Vec<bool> =
        shown.iter().filter(|it| it.kind == EnergisedKind::Output).map(|it| it.energised).collect();
    assert_eq!(outputs, [true]);
    let contacts = shown.iter().filter(|it| it.kind == EnergisedKind::Contact(true)).count();
    assert_eq!(contacts, 1, "{shown:?}");
}
