//! No list is shorter: for small rungs all lists that can be are tried. What a list does is computed here, with a bit for
//! each value of the inputs, and owes nothing to the translator.

use crate::proof_shown::Dice;
use crate::translate::{certain, drawing, list};
use rungwise::translate::{Options, To, translate};
use std::collections::{HashSet, VecDeque};

/// A contact of the drawn order.
#[derive(Clone, Copy)]
struct Contact {
    /// What it holds while so many outputs were driven: a bit for each value of the inputs.
    truths: [u64; 8],
    /// Whether an instruction asks for the opposite: not of edges.
    turns: bool,
}

/// Instructions of the shortest list that drives the outputs with these truths in this order, each contact once and in
/// this order, as drawn or as its opposite, if it is shorter than `known`; else `known`. Found by trying all lists that
/// can be.
fn shortest(contacts: &[Contact], outputs: &[u64], known: usize) -> usize {
    type State = (Vec<u64>, Vec<u64>, usize, usize);
    let mut waiting: VecDeque<(State, usize)> = VecDeque::from([((vec![], vec![], 0, 0), 0)]);
    let mut seen: HashSet<State> = HashSet::new();
    while let Some((state, length)) = waiting.pop_front() {
        let (blocks, kept, next, driven) = &state;
        if *driven == outputs.len() && *next == contacts.len() && kept.is_empty() && blocks.len() == 1 {
            return length;
        }
        // Contacts in parallel begin at the left rail, which is behind what was driven or kept already.
        let is_at_rail = *driven == 0 && kept.is_empty();
        let mut go = |blocks: Vec<u64>, kept: Vec<u64>, next: usize, driven: usize| {
            // Each contact and output still takes an instruction, and so do each block to join and each power to
            // forget.
            let left = contacts.len() - next + outputs.len() - driven + kept.len() + blocks.len().max(1) - 1;
            let state = (blocks, kept, next, driven);
            if length + 1 + left < known && seen.insert(state.clone()) {
                waiting.push_back((state, length + 1));
            }
        };
        let joined = |value: u64, and: bool| {
            let mut blocks = blocks.clone();
            if let Some(top) = blocks.last_mut() {
                *top = if and { *top & value } else { *top | value };
            }
            blocks
        };
        let ways = contacts.get(*next).map(|contact| {
            let value = contact.truths[*driven];
            [Some(value), contact.turns.then_some(!value)]
        });
        for value in ways.into_iter().flatten().flatten() {
            let mut loaded = blocks.clone();
            loaded.push(value);
            go(loaded, kept.clone(), next + 1, *driven);
            if !blocks.is_empty() {
                go(joined(value, true), kept.clone(), next + 1, *driven);
                if blocks.len() > 1 || is_at_rail {
                    go(joined(value, false), kept.clone(), next + 1, *driven);
                }
            }
        }
        let Some(top) = blocks.last() else { continue };
        if let [rest @ .., lower, upper] = &blocks[..] {
            go([rest, &[lower & upper]].concat(), kept.clone(), *next, *driven);
            if !rest.is_empty() || is_at_rail {
                go([rest, &[lower | upper]].concat(), kept.clone(), *next, *driven);
            }
        }
        let replaced = |value: u64| [&blocks[..blocks.len() - 1], &[value]].concat();
        go(replaced(!top), kept.clone(), *next, *driven);
        go(blocks.clone(), [&kept[..], &[*top]].concat(), *next, *driven);
        if let [rest @ .., last] = &kept[..] {
            go(replaced(*last), kept.clone(), *next, *driven);
            go(replaced(*last), rest.to_vec(), *next, *driven);
        }
        if outputs.get(*driven) == Some(top) && blocks.len() == 1 {
            go(blocks.clone(), kept.clone(), *next, driven + 1);
        }
    }
    known
}

/// The bit of input `number` in each value of six inputs.
fn input(number: usize) -> u64 {
    (0..64).filter(|inputs| inputs & 1 << number != 0).fold(0, |truth, inputs| truth | 1u64 << inputs)
}

/// What contacts ask, as the end of LD, AND and OR: `E` stands for a comparison of words.
const ASKED: [&str; 6] = ["", "I", "P", "F", "E", "N"];

/// A rung in the making: its text, and what it must do.
#[derive(Clone, Default)]
struct Rung {
    text: String,
    contacts: Vec<Contact>,
    outputs: Vec<u64>,
    /// Steps of its contacts and outputs, after the programming manuals.
    steps: usize,
}

impl Rung {
    /// Loads a contact of its own device.
    fn load(&mut self, asked: &str) -> u64 {
        let number = self.contacts.len();
        let (line, steps) = match asked {
            "E" => (format!("LD= D{number} K5"), 5),
            "N" => (format!("LDD> D{number} D10"), 9),
            "P" | "F" => (format!("LD{asked} X{number}"), 2),
            _ => (format!("LD{asked} X{number}"), 1),
        };
        self.text += &(line + "\n");
        self.steps += steps;
        let truth = if asked == "I" { !input(number) } else { input(number) };
        self.contacts.push(Contact { truths: [truth; 8], turns: !matches!(asked, "P" | "F") });
        truth
    }

    /// Loads a contact of Y0, which may be driven before: a bit of its own then, whatever it was driven with.
    fn load_driven(&mut self) -> u64 {
        let before = input(self.contacts.len());
        self.text += "LD Y0\n";
        self.steps += 1;
        let mut truths = [input(5); 8];
        truths[0] = before;
        self.contacts.push(Contact { truths, turns: true });
        truths[self.outputs.len()]
    }

    fn bare(&mut self, mnemonic: &str) {
        self.text += mnemonic;
        self.text.push('\n');
    }

    /// Drives an output with `power`.
    fn drive(&mut self, kind: usize, power: u64) {
        let number = self.outputs.len();
        let (line, steps) = match kind % 6 {
            0 => (format!("OUT Y{number}"), 1),
            1 => (format!("SET Y{number}"), 1),
            2 => (format!("RST S{number}"), 2),
            3 => (format!("OUT T{number} K10"), 3),
            4 => (format!("OUT C{number} K7"), 3),
            _ => (format!("PLS M{number}"), 2),
        };
        self.text += &(line + "\n");
        self.steps += steps;
        self.outputs.push(power);
    }

    /// The rung as list and drawn takes the fewest steps.
    fn check(&self) {
        let short = certain(&list(&self.text), To::Fx);
        let lines: Vec<&str> = short.lines().filter(|line| *line != "END").collect();
        let fewest = shortest(&self.contacts, &self.outputs, lines.len());
        assert_eq!(lines.len(), fewest, "{}\nis written\n{short}", self.text);
        // A row of a drawing has one inverted edge at most, and that comes first.
        let drawn = translate(&list(&self.text), None, To::Ladder, &Options::default());
        let again = if drawn.is_certain() { certain(&drawing(&drawn.text), To::Fx) } else { String::new() };
        if devices(&again) == devices(&self.text) {
            assert_eq!(again, short, "{}", drawn.text);
        }
        let joins = fewest - self.contacts.len() - self.outputs.len();
        assert_eq!(lines.iter().map(|line| steps(line)).sum::<usize>(), self.steps + joins, "{short}");
    }
}

fn devices(list: &str) -> Vec<&str> {
    list.lines().filter_map(|line| line.split_once(' ')).map(|(_, device)| device).collect()
}

/// The steps of an instruction after the programming manuals.
fn steps(line: &str) -> usize {
    let (word, operand) = line.split_once(' ').unwrap_or((line, ""));
    let compares = ["LD", "AND", "OR"].into_iter().find_map(|role| word.strip_prefix(role));
    match (word, operand.as_bytes().first()) {
        _ if word.ends_with(['=', '<', '>']) => {
            if compares.is_some_and(|rest| rest.starts_with('D')) {
                9
            } else {
                5
            }
        }
        ("OUT", Some(b'T' | b'C')) => 3,
        ("PLS", _) | ("RST", Some(b'S')) => 2,
        ("LDP" | "LDF" | "ANDP" | "ANDF" | "ORP" | "ORF", _) => 2,
        _ => 1,
    }
}

/// Contacts in series and in parallel, each part inverted or not.
#[derive(Clone)]
enum Part {
    Contact,
    Joined { series: bool, parts: Vec<Part> },
    Not(Box<Part>),
}

/// All parts of so many contacts, with an inverter behind each of them or not.
fn parts(contacts: usize) -> Vec<Part> {
    let mut all = Vec::new();
    if contacts == 1 {
        all.push(Part::Contact);
    }
    for parts in rows(contacts, 2) {
        all.extend([true, false].map(|series| Part::Joined { series, parts: parts.clone() }));
    }
    let inverted: Vec<Part> = all.iter().map(|part| Part::Not(Box::new(part.clone()))).collect();
    [all, inverted].concat()
}

/// Rows of at least so many parts with so many contacts in all.
fn rows(contacts: usize, least: usize) -> Vec<Vec<Part>> {
    let mut all = Vec::new();
    for first in (1..=contacts).take_while(|first| first + least <= contacts + 1) {
        for head in parts(first) {
            match contacts - first {
                0 => all.push(vec![head]),
                rest => all.extend(rows(rest, 1).into_iter().map(|tail| [vec![head.clone()], tail].concat())),
            }
        }
    }
    all
}

impl Part {
    /// Writes the part as a block, which joins as nobody would write it. Returns what it holds.
    fn write(&self, asked: &mut impl Iterator<Item = &'static str>, rung: &mut Rung) -> u64 {
        match self {
            Part::Contact => rung.load(asked.next().expect("a contact")),
            Part::Joined { series, parts } => {
                let mut holds = parts[0].write(asked, rung);
                for part in &parts[1..] {
                    let next = part.write(asked, rung);
                    rung.bare(if *series { "ANB" } else { "ORB" });
                    holds = if *series { holds & next } else { holds | next };
                }
                holds
            }
            Part::Not(part) => {
                let holds = part.write(asked, rung);
                rung.bare("INV");
                !holds
            }
        }
    }
}

#[test]
fn no_list_with_edges_and_inverters_is_shorter() {
    for contacts in 1..=3 {
        for part in parts(contacts) {
            for edges in 0..1 << contacts {
                let mut asked = (0..contacts).map(|number| if edges & 1 << number == 0 { "" } else { "P" });
                let mut rung = Rung::default();
                let power = part.write(&mut asked, &mut rung);
                rung.drive(0, power);
                rung.check();
            }
        }
    }
}

#[test]
fn no_list_with_comparisons_and_edges_is_shorter() {
    let parts = parts(4);
    let mut dice = Dice(17);
    for number in 0..600 {
        let mut rung = Rung::default();
        let mut asked = std::iter::repeat_with(|| ASKED[dice.roll(ASKED.len())]);
        let power = parts[number * parts.len() / 600].write(&mut asked, &mut rung);
        rung.drive(number, power);
        rung.check();
    }
}

/// A letter for each thing that power may come to behind what leads to it.
const DRIVES: &str = "onbikjefcvwd";

/// Writes what `letter` stands for behind `power`.
fn drive(rung: &mut Rung, letter: char, kind: usize, power: u64) {
    let contact = |rung: &mut Rung, asked: &str, power: u64| {
        let own = rung.load(asked);
        rung.bare("ANB");
        power & own
    };
    let invert = |rung: &mut Rung, power: u64| {
        rung.bare("INV");
        !power
    };
    match letter {
        'o' => rung.drive(kind, power),
        'n' => {
            let power = invert(rung, power);
            rung.drive(kind, power);
        }
        'b' | 'e' => {
            let power = contact(rung, if letter == 'b' { "" } else { "P" }, power);
            rung.drive(kind, power);
        }
        'i' => {
            let power = invert(rung, power);
            let power = contact(rung, "", power);
            rung.drive(kind, power);
        }
        'k' => {
            let power = contact(rung, "", power);
            let power = invert(rung, power);
            rung.drive(kind, power);
        }
        'j' | 'f' => {
            let power = invert(rung, power);
            let power = contact(rung, if letter == 'j' { "" } else { "F" }, power);
            let power = invert(rung, power);
            rung.drive(kind, power);
        }
        'c' => {
            let [one, two] = [rung.load(""), rung.load("E")];
            rung.bare("ORB\nANB");
            rung.drive(kind, power & (one | two));
        }
        'v' => {
            let power = contact(rung, "", power);
            rung.drive(kind, power);
            let power = contact(rung, "", power);
            rung.drive(kind + 1, power);
        }
        'w' => {
            let power = contact(rung, "", power);
            rung.bare("MPS");
            let first = contact(rung, "", power);
            rung.drive(kind, first);
            rung.bare("MPP");
            let second = contact(rung, "I", power);
            rung.drive(kind + 1, second);
        }
        _ => {
            let own = rung.load_driven();
            rung.bare("ANB");
            rung.drive(kind, power & own);
        }
    }
}

#[test]
fn no_list_that_branches_is_shorter() {
    // What leads to the outputs: a contact, an edge, an inverted edge, two in parallel, two blocks in series.
    let fronts = ["o", "e", "e!", "oo+", "oe+", "oo*!", "oo+oo+*"];
    for (number, drives) in words(DRIVES, 3).into_iter().enumerate() {
        if drives.matches('d').count() > 1 {
            continue;
        }
        // All of them behind a contact, and each two; of three behind other things each a few.
        let all = if drives.len() < 3 { &fronts[..] } else { &fronts[number % 7..][..1] };
        for front in all {
            let mut rung = Rung::default();
            let mut blocks: Vec<u64> = Vec::new();
            for letter in front.chars() {
                match letter {
                    'o' => blocks.push(rung.load("")),
                    'e' => blocks.push(rung.load("P")),
                    '!' => {
                        rung.bare("INV");
                        let top = blocks.last_mut().expect("a block");
                        *top = !*top;
                    }
                    _ => {
                        rung.bare(if letter == '+' { "ORB" } else { "ANB" });
                        let upper = blocks.pop().expect("a block");
                        let top = blocks.last_mut().expect("a block");
                        *top = if letter == '+' { *top | upper } else { *top & upper };
                    }
                }
            }
            for (row, letter) in drives.chars().enumerate() {
                match row {
                    _ if drives.len() == 1 => {}
                    0 => rung.bare("MPS"),
                    _ if row + 1 == drives.len() => rung.bare("MPP"),
                    _ => rung.bare("MRD"),
                }
                drive(&mut rung, letter, 0, blocks[0]);
            }
            // With more contacts there are too many lists to try.
            if rung.contacts.len() <= if drives.len() < 3 { 5 } else { 4 } {
                rung.check();
            }
        }
    }
}

/// All words of up to `length` letters.
fn words(letters: &str, length: usize) -> Vec<String> {
    let mut all = vec![String::new()];
    let mut start = 0;
    for _ in 0..length {
        let end = all.len();
        for word in start..end {
            all.extend(letters.chars().map(|letter| format!("{}{letter}", all[word])).collect::<Vec<_>>());
        }
        start = end;
    }
    all.split_off(1)
}
