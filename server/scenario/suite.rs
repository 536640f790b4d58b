//! What a file with scenario tests says.

use crate::simulate::Value;
use crate::text::{Message, Span, folded};
use std::fmt;

/// The scenarios of a file. Reading never fails: what is wrong with the text is told beside it.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Suite {
    /// The program or the project that is tested, from the folder of the file; the program of the same name beside it
    /// where it is left out.
    pub program: Option<Named>,
    /// In the order of the text.
    pub scenarios: Vec<Scenario>,
}

/// A word of the file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Named {
    /// The word.
    pub name: String,
    /// Where it stands.
    pub span: Span,
}

/// Something that is wrong in a file with scenario tests.
#[derive(Clone, PartialEq, Debug)]
pub struct Flaw {
    /// What it is.
    pub message: Message,
    /// Where.
    pub span: Span,
}

/// A scenario. Moments are numbers of scans: scan 0 is at time 0, and a time between two scans is the later one.
#[derive(Clone, PartialEq, Debug)]
pub struct Scenario {
    /// Its name, of which there is one in the file.
    pub name: String,
    /// Where the name stands.
    pub span: Span,
    /// From one scan to the next, in nanoseconds.
    pub scan_ns: i64,
    /// The last scan; nothing where a golden trace says it.
    pub last: Option<u64>,
    /// What is done to the PLC, by time.
    pub inputs: Vec<Input>,
    /// What is expected, in the order of the text.
    pub checks: Vec<Check>,
    /// What is shown and traced besides what inputs and checks name.
    pub watch: Vec<Named>,
    /// The file with the trace that it must have.
    pub golden: Option<Named>,
    /// So many scans a change may come early or late.
    pub tolerance: u64,
    /// By so much numbers may differ.
    pub deviation: f64,
    /// Whether instructions may fail.
    pub allows_errors: bool,
}

/// Something that is done to the PLC before a scan.
#[derive(Clone, PartialEq, Debug)]
pub struct Input {
    /// The scan.
    pub scan: u64,
    /// The variable.
    pub name: Named,
    /// What is done.
    pub kind: InputKind,
}

/// What is done to a variable.
#[derive(Clone, PartialEq, Debug)]
pub enum InputKind {
    /// It is switched or written.
    Set(Value),
    /// It is held at a value.
    Force(Value),
    /// It is let go.
    Release,
}

/// Something that is expected.
#[derive(Clone, PartialEq, Debug)]
pub struct Check {
    /// In which scans it must hold.
    pub kind: CheckKind,
    /// The first scan that counts.
    pub first: u64,
    /// The last one; the last of the scenario where nothing is said.
    pub last: Option<u64>,
    /// It counts until these values are there, which must come.
    pub until: Vec<Want>,
    /// The values, all of them at once.
    pub wants: Vec<Want>,
    /// By so much numbers may differ.
    pub deviation: f64,
    /// For so many scans one after the other it may be otherwise.
    pub tolerance: u64,
    /// Where it stands.
    pub span: Span,
}

/// In which scans something is expected.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CheckKind {
    /// In one of them at least.
    Once,
    /// In all.
    Always,
    /// In none.
    Never,
}

/// A variable, and what it must be.
#[derive(Clone, PartialEq, Debug)]
pub struct Want {
    /// The variable.
    pub name: Named,
    /// What it must be.
    pub expected: Expected,
}

/// What a value must be.
#[derive(Clone, PartialEq, Debug)]
pub enum Expected {
    /// This.
    Is(Value),
    /// A number that compares so with this one.
    Compared(Comparison, f64),
    /// A number from the one to the other, both included.
    Between(f64, f64),
}

/// How numbers compare.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Comparison {
    /// `<=`
    AtMost,
    /// `>=`
    AtLeast,
    /// `<>` and `!=`
    Other,
    /// `<`
    Less,
    /// `>`
    Greater,
}

impl Comparison {
    /// All of them with their signs, longer signs first.
    const SIGNS: [(&'static str, Comparison); 6] = [
        ("<=", Comparison::AtMost),
        (">=", Comparison::AtLeast),
        ("<>", Comparison::Other),
        ("!=", Comparison::Other),
        ("<", Comparison::Less),
        (">", Comparison::Greater),
    ];
}

impl Expected {
    /// What is written as text: `"on"`, `">= 5"`, `"48..52"`.
    pub fn read(word: &str) -> Option<Expected> {
        let word = word.trim();
        let signed =
            Comparison::SIGNS.into_iter().find_map(|(sign, how)| Some((how, word.strip_prefix(sign)?)));
        if let Some((how, number)) = signed {
            return Some(Expected::Compared(how, Value::read(number)?.as_number()?));
        }
        if let Some((least, most)) = word.split_once("..") {
            let [least, most] = [least, most].map(|number| Value::read(number)?.as_number());
            let (least, most) = (least?, most?);
            return (least <= most).then_some(Expected::Between(least, most));
        }
        Value::read(word).map(Expected::Is)
    }

    /// Whether a value is so, where numbers may differ by `deviation`.
    pub fn holds(&self, actual: &Value, deviation: f64) -> bool {
        let number = actual.as_number();
        let is_one = |test: &dyn Fn(f64) -> bool| number.is_some_and(test);
        match self {
            Expected::Is(value) => {
                let is_near = |expected: f64| is_one(&|number| (expected - number).abs() <= deviation);
                match (value, actual) {
                    (Value::Word(word, _), Value::Name(name)) => folded(word) == folded(name),
                    _ => value == actual || value.as_number().is_some_and(is_near),
                }
            }
            Expected::Compared(how, other) => is_one(&|number| match how {
                Comparison::AtMost => number <= other + deviation,
                Comparison::AtLeast => number >= other - deviation,
                Comparison::Other => (number - other).abs() > deviation,
                Comparison::Less => number < other + deviation,
                Comparison::Greater => number > other - deviation,
            }),
            Expected::Between(least, most) => {
                is_one(&|number| least - deviation <= number && number <= most + deviation)
            }
        }
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Expected::Is(value) => value.fmt(f),
            Expected::Compared(how, number) => {
                let sign =
                    Comparison::SIGNS.iter().find(|(_, other)| other == how).map_or("", |(sign, _)| sign);
                write!(f, "{sign} {number}")
            }
            Expected::Between(least, most) if least == most => write!(f, "{least}"),
            Expected::Between(least, most) => write!(f, "{least}..{most}"),
        }
    }
}
