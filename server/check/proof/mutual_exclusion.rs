//! # mutual-exclusion
//!
//! Two outputs, relays or variables of which you said that they are never on together, and that can be. Forward and
//! reverse of one motor, star and delta, two valves of one cylinder: the program is the lock between them, and one
//! pressed button too many must not open it.
//!
//! Say it in a comment, `// rungwise: never Y0 & Y1`, in `(* … *)` where the language has it so, or for the whole
//! project in `rungwise.toml`: `[check]` with `never = ["Y0 & Y1"]`. Of three names or more no two are on together.
//! What counts is the end of a scan, when the outputs go to the terminals.
//!
//! An error is proved: the message says which inputs, from a start with everything off, bring both on; an interlock
//! that only one of the two rungs has is such a case. Silence is proved, too, over all states from which a scan can
//! begin: it is taken to hold at the ends of up to three scans and shown for the next. Between the two stands a
//! warning, *not proved*: a state would do it of which nobody knows whether the machine ever comes to it, such as a
//! relay or a timer that happens to be on; or the program writes one of the two where a jump, a master control, a step
//! or a routine may leave it out.
//!
//! Taken as inputs, which may be anything, are X devices and what no rung writes; each keeps its value for a scan, or
//! up to a REF in it. That somebody else, a panel or another PLC, writes what the program writes is not considered.
//!
//! ```fx
//! // rungwise: never Y0 & Y1
//!              ^^^^^^^^^^^^^
//! LD X0
//! OR Y0
//! ANI Y1
//! OUT Y0
//! LD X1
//! OR Y1
//! OUT Y1
//! END
//! ```
//!
//! ```fx
//! // rungwise: never Y0 & Y1
//! LD X0
//! OR Y0
//! ANI Y1
//! OUT Y0
//! LD X1
//! OR Y1
//! ANI Y0
//! OUT Y1
//! END
//! ```
//!
//! ```lad
//! // rungwise: never Y0 & Y1
//!              ^^^^^^^^^^^^^
//! |  X0          Y0  |
//! +--| |---------( )-+
//! |  X1    X2    Y1  |
//! +--| |---| |---( )-+
//! ```
//!
//! ```lad
//! // rungwise: never Y0 & Y1
//! |  X0    X2    Y0  |
//! +--| |---|/|---( )-+
//! |  X1    X2    Y1  |
//! +--| |---| |---( )-+
//! ```
//!
//! ```iec
//! PROGRAM Gate
//! VAR
//!     Up AT %IX0.0 : BOOL;
//!     Down AT %IX0.1 : BOOL;
//!     Lift AT %QX0.0 : BOOL;
//!     Lower AT %QX0.1 : BOOL;
//! END_VAR
//!     (* rungwise: never Lift & Lower *)
//!                  ^^^^^^^^^^^^^^^^^^
//!     LD Up
//!     ST Lift
//!     LD Down
//!     ST Lower
//! END_PROGRAM
//! ```
//!
//! ```iec
//! PROGRAM Gate
//! VAR
//!     Up AT %IX0.0 : BOOL;
//!     Down AT %IX0.1 : BOOL;
//!     Lift AT %QX0.0 : BOOL;
//!     Lower AT %QX0.1 : BOOL;
//! END_VAR
//!     (* rungwise: never Lift & Lower *)
//!     LD Up
//!     ANDN Down
//!     ST Lift
//!     LD Down
//!     ANDN Lift
//!     ST Lower
//! END_PROGRAM
//! ```

use super::interlock;
use super::slice::{Obstacle, Slice};
use crate::check::sense::{Key, Use};
use crate::check::{ProgramContext, Rule, Run};
use crate::document::{DeclaredType, Symbol};
use crate::logic::{Atom, Exclusion, Formulas, Moment, Scans, Source};
use crate::target::iec::ElementaryType;
use crate::target::{DeviceKind, Width};
use crate::text::{Diagnostic, Message, Severity, Span};
use rustc_hash::FxHashSet;
use std::collections::BTreeMap;

pub(super) const RULE: Rule = Rule {
    code: "mutual-exclusion",
    severity: Severity::Error,
    run: Run::Program(check),
    source: include_str!("mutual_exclusion.rs"),
};

/// The messages that are no errors, for nothing wrong is proved.
pub(in crate::check) const NOT_PROVED: [&str; 8] = [
    "mutual-exclusion.state",
    "mutual-exclusion.undecided",
    "mutual-exclusion.unknown",
    "mutual-exclusion.unwritten",
    "mutual-exclusion.row",
    "mutual-exclusion.no-bit",
    "mutual-exclusion.twice",
    "mutual-exclusion.few",
];

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    let mut judge = Judge { context, judged: FxHashSet::default(), found };
    for (number, file) in context.files().iter().enumerate() {
        for exclusion in file.document.exclusions() {
            let names = exclusion.names.iter();
            let names = names.map(|name| (file.document.slice(*name), Some(name.shifted(file.start))));
            let units = match exclusion.unit {
                None | Some(0) => 0..file.document.scopes().own_pous().len() + 1,
                Some(unit) => unit..unit + 1,
            };
            let wanted = Wanted {
                names: names.collect(),
                comment: Some(exclusion.span.shifted(file.start)),
                units: units.map(|unit| (number, unit)).collect(),
            };
            judge.comment(&wanted);
        }
    }
    for names in context.never() {
        let units = context.files().iter().enumerate().flat_map(|(number, file)| {
            (0..file.document.scopes().own_pous().len() + 1).map(move |unit| (number, unit))
        });
        let names = names.iter().map(|name| (name.clone(), None)).collect();
        judge.list(&Wanted { names, comment: None, units: units.collect() });
    }
}

/// Names of which no two may be on together.
struct Wanted {
    /// With their places, where they stand in a comment.
    names: Vec<(String, Option<Span>)>,
    /// From the word to the last name.
    comment: Option<Span>,
    /// The files and units in which the names may be declared.
    units: Vec<(usize, usize)>,
}

/// A name that was found.
#[derive(Clone)]
struct Named {
    words: String,
    /// Its number in each unit that knows it.
    numbers: BTreeMap<(usize, usize), u32>,
}

struct Judge<'c, 'a, 'f> {
    context: &'c ProgramContext<'a>,
    /// The pairs that have their answer.
    judged: FxHashSet<[u32; 2]>,
    found: &'f mut Vec<Diagnostic>,
}

impl Judge<'_, '_, '_> {
    /// A list in a comment, which may be wrong in itself.
    fn comment(&mut self, wanted: &Wanted) {
        let Some(span) = wanted.comment else { return };
        if wanted.names.len() < 2 {
            self.found.push(Diagnostic::new(RULE.code, span, Message::new("mutual-exclusion.few")));
            return;
        }
        self.list(wanted);
    }

    fn list(&mut self, wanted: &Wanted) {
        let mut named: Vec<Named> = Vec::new();
        for (words, place) in &wanted.names {
            let numbers = self.numbers_of(words, wanted);
            let is_same = |other: &&Named| {
                other.words.eq_ignore_ascii_case(words) || (!numbers.is_empty() && other.numbers == numbers)
            };
            if named.iter().find(is_same).is_some() {
                self.mistake("mutual-exclusion.twice", words, *place, wanted);
                continue;
            }
            let in_row = numbers.is_empty() && self.is_in_row(words);
            let mistake =
                self.mistake_in(&numbers).map(|key| if in_row { "mutual-exclusion.row" } else { key });
            match mistake {
                Some(key) => self.mistake(key, words, *place, wanted),
                None => named.push(Named { words: words.clone(), numbers }),
            }
        }
        for (place, first) in named.iter().enumerate() {
            for second in &named[place + 1..] {
                for (unit, number) in &first.numbers {
                    let Some(other) = second.numbers.get(unit) else { continue };
                    let mut pair = [*number, *other];
                    pair.sort_unstable();
                    if self.judged.insert(pair) {
                        self.pair([*number, *other], [&first.words, &second.words], wanted);
                    }
                }
            }
        }
    }

    /// What a name means in each unit; the units of an FX program know the same devices.
    fn numbers_of(&self, words: &str, wanted: &Wanted) -> BTreeMap<(usize, usize), u32> {
        let uses = self.context.uses();
        let mut numbers = BTreeMap::new();
        for (file, unit) in &wanted.units {
            let Some(at) = self.context.files().get(*file) else { continue };
            let operand = at.document.reader().read(words);
            let number = match (uses.is_fx, operand) {
                (true, operand) => operand.device().and_then(|device| uses.device(device)),
                (false, crate::target::Operand::Direct(address)) => {
                    uses.named(at.document.scopes(), *file, *unit, &Symbol::Direct(address))
                }
                (false, _) => uses.named(at.document.scopes(), *file, *unit, &Symbol::variable(words)),
            };
            let Some(number) = number else { continue };
            match uses.is_fx {
                true => return BTreeMap::from([((0, 0), number)]),
                false => _ = numbers.insert((*file, *unit), number),
            }
        }
        numbers
    }

    /// Whether it is a device that is written as one of several.
    fn is_in_row(&self, words: &str) -> bool {
        let uses = self.context.uses();
        let device =
            self.context.files().first().and_then(|file| file.document.reader().read(words).device());
        device.is_some_and(|device| uses.is_fx && uses.is_written_in_row(device))
    }

    /// Why nothing can be said of a name.
    fn mistake_in(&self, numbers: &BTreeMap<(usize, usize), u32>) -> Option<&'static str> {
        let uses = self.context.uses();
        if numbers.is_empty() {
            return Some("mutual-exclusion.unknown");
        }
        let is_bit = |number: &u32| {
            uses.name(*number).is_some_and(|name| match name.key {
                Key::Device(device) => {
                    use DeviceKind::{C, M, S, T, X, Y};
                    matches!(device.kind, X | Y | M | S | T | C)
                }
                Key::Direct(address) => address.width == Width::Bit,
                Key::Global(_) | Key::Local(..) => name.variable.is_none_or(|variable| {
                    variable.declared == DeclaredType::Elementary(ElementaryType::Bool)
                }),
            })
        };
        let is_written = |number: &u32| {
            let in_row = uses.name(*number).is_some_and(
                |name| matches!(name.key, Key::Device(device) if uses.is_written_in_row(device)),
            );
            in_row || uses.acts(*number).writes_but(&[])
        };
        if !numbers.values().any(is_bit) {
            return Some("mutual-exclusion.no-bit");
        }
        (!numbers.values().any(is_written)).then_some("mutual-exclusion.unwritten")
    }

    /// Tells of a name that is wrong: where it stands, or else where another name of the list is written.
    fn mistake(&mut self, key: &'static str, words: &str, place: Option<Span>, wanted: &Wanted) {
        let elsewhere = || {
            let others = wanted.names.iter().map(|(other, _)| self.numbers_of(other, wanted));
            let mut written =
                others.flat_map(BTreeMap::into_values).filter_map(|number| self.written(number));
            written.next().map(|one| one.span)
        };
        // Of several programs of a project it may be about another one.
        let start = || self.context.is_all().then(|| Span::at(0));
        let Some(span) = place.or_else(elsewhere).or_else(start) else { return };
        let all: Vec<&str> = wanted.names.iter().map(|(name, _)| name.as_str()).collect();
        let message = Message::new(key).with("name", words).with("list", all.join(" & "));
        self.found.push(Diagnostic::new(RULE.code, span, message));
    }

    /// The first place that writes a name.
    fn written(&self, number: u32) -> Option<Use> {
        self.context.uses().of_name(number).find(|one| one.access.act.writes())
    }

    fn pair(&mut self, numbers: [u32; 2], words: [&str; 2], wanted: &Wanted) {
        let Some(message) = self.verdict(numbers) else { return };
        let message = message.with("first", words[0]).with("second", words[1]);
        let places: Vec<(Span, &str)> = numbers
            .iter()
            .zip(words)
            .filter_map(|(number, words)| Some((self.written(*number)?.span, words)))
            .collect();
        let last = places.iter().map(|(span, _)| *span).max().unwrap_or(Span::at(0));
        let diagnostic = Diagnostic::new(RULE.code, wanted.comment.unwrap_or(last), message);
        let related = places.into_iter().fold(diagnostic, |diagnostic, (span, words)| {
            diagnostic.related(span, Message::new("mutual-exclusion.coil").with("name", words))
        });
        // What is not decided may be right as it is.
        let is_open = related.message.key() == "mutual-exclusion.undecided";
        let interlock = if is_open { None } else { interlock::of(self.context, numbers) };
        self.found.push(match interlock {
            Some((title, edits)) => related.fix(title, edits),
            None => related,
        });
    }

    /// What is to be said of a pair; nothing if the two are proved never to be on together.
    fn verdict(&self, numbers: [u32; 2]) -> Option<Message> {
        let undecided =
            |why: Message| Some(Message::new("mutual-exclusion.undecided").with_messages("why", vec![why]));
        let slice = match Slice::of(self.context, &numbers) {
            Ok(slice) => slice,
            Err(obstacle) => return undecided(self.why(obstacle)),
        };
        let [one, other] = numbers.map(|number| slice.term(number));
        let (Some(one), Some(other)) = (one, other) else {
            return undecided(Message::new("mutual-exclusion.large"));
        };
        let mut formulas = Formulas::default();
        let (run, facts) = slice.run(&mut formulas);
        let source = |key: &smol_str::SmolStr| slice.source(key);
        let scans = Scans { run: &run, terms: &slice.terms, source: &source, facts };
        match scans.exclusion(one, other, &mut formulas) {
            Exclusion::Never => None,
            Exclusion::Undecided => undecided(Message::new("mutual-exclusion.large")),
            Exclusion::Reached(steps) => {
                let steps: Vec<Vec<String>> =
                    steps.iter().map(|step| step.iter().map(|key| slice.shown(key)).collect()).collect();
                Some(reached(&steps))
            }
            Exclusion::Possible(values) => Some(possible(&slice, &formulas, &values)),
        }
    }

    fn why(&self, obstacle: Obstacle) -> Message {
        let line = |key: &'static str, span: Span| {
            let line = self.context.line_at(span);
            Message::new(key).with("line", line)
        };
        match obstacle {
            Obstacle::Part(span) => line("mutual-exclusion.part", span),
            Obstacle::Loop(span) => line("mutual-exclusion.loop", span),
            Obstacle::Unread(span, refusal) => {
                line("mutual-exclusion.unread", span).with_messages("reason", vec![refusal.message()])
            }
            Obstacle::Elsewhere(span) => line("mutual-exclusion.elsewhere", span),
            Obstacle::Alias(span) => line("mutual-exclusion.alias", span),
            Obstacle::Passing(span) => line("mutual-exclusion.passing", span),
            Obstacle::Large => Message::new("mutual-exclusion.large"),
        }
    }
}

/// Both are on behind these scans from the start.
fn reached(steps: &[Vec<String>]) -> Message {
    let step = |(number, on): (usize, &Vec<String>)| {
        let key = match (steps.len(), on.is_empty()) {
            (1, false) => "mutual-exclusion.only-on",
            (1, true) => "mutual-exclusion.only-off",
            (_, false) => "mutual-exclusion.step-on",
            (_, true) => "mutual-exclusion.step-off",
        };
        Message::new(key).with("number", number + 1).with_words("on", on.iter().cloned(), ", ")
    };
    let steps = steps.iter().enumerate().map(step).collect();
    Message::new("mutual-exclusion.found").with_messages("steps", steps)
}

/// Both are on behind a scan that begins and goes on so.
fn possible(slice: &Slice, formulas: &Formulas, values: &BTreeMap<u32, bool>) -> Message {
    let (mut inputs, mut before, mut later) = (Vec::new(), Vec::new(), Vec::new());
    for (atom, value) in values {
        match formulas.atom_at(*atom) {
            Atom::Bit(Moment { name, since }) if *value => {
                let list = match (since, slice.source(name)) {
                    (0, Source::Input) => &mut inputs,
                    (0, _) => &mut before,
                    _ => &mut later,
                };
                list.push(slice.shown(name));
            }
            Atom::Edge { of, rising, .. } if *value => {
                inputs.push(format!("`{}{}`", slice.name(&of.name), if *rising { '↑' } else { '↓' }));
            }
            Atom::Bit(_) | Atom::NoNumber(_) | Atom::Edge { .. } => {}
            Atom::SingleEdge(_) | Atom::Behind(_) | Atom::Rail => {}
            Atom::Reaches { word, number } => {
                let sign = if *value { ">=" } else { "<" };
                inputs.push(format!("`{} {sign} {number}`", slice.name(&word.name)));
            }
            Atom::AtLeast { word, other } => {
                let sign = if *value { ">=" } else { "<" };
                inputs.push(format!("`{} {sign} {}`", slice.name(&word.name), slice.name(&other.name)));
            }
        }
    }
    let part = |key: &'static str, names: Vec<String>| {
        (!names.is_empty()).then(|| Message::new(key).with_words("names", names, ", "))
    };
    let parts = [
        part("mutual-exclusion.on", inputs),
        part("mutual-exclusion.before", before),
        part("mutual-exclusion.later", later),
    ];
    let mut parts: Vec<Message> = parts.into_iter().flatten().collect();
    if parts.is_empty() {
        parts.push(Message::new("mutual-exclusion.nothing"));
    }
    Message::new("mutual-exclusion.state").with_messages("values", parts)
}
