//! Whether words can be as large as comparisons of them say, each among the numbers of its type.
//!
//! All that comparisons say is that one word is at least so much larger than another, or than zero. Such a set of
//! differences has a solution unless some of them form a circle that adds up to more than nothing (Bellman and Ford).

use super::formula::Atom;
use super::number::Numbers;
use super::{Formulas, Moment};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Words that are at least so much larger than others, by numbers of their types.
pub struct Bounds {
    /// The number of each word; that of zero is 0.
    numbers: FxHashMap<Moment, usize>,
    words: Vec<Moment>,
    /// In how large steps each word goes, zero first.
    steps: Vec<i128>,
    least: Vec<Least>,
}

/// `left` is at least `more` more than `right`.
struct Least {
    left: usize,
    right: usize,
    more: i128,
    /// The atom that says so; nothing where the type does.
    atom: Option<u32>,
}

impl Bounds {
    /// What atoms say that have these values. With `is_narrow` words are only what every PLC can make of them: within
    /// subranges, times in whole milliseconds, no infinite numbers.
    pub fn of(formulas: &Formulas, values: &BTreeMap<u32, bool>, is_narrow: bool) -> Bounds {
        let mut bounds =
            Bounds { numbers: FxHashMap::default(), words: Vec::new(), steps: vec![1], least: Vec::new() };
        for (atom, value) in values {
            let (left, right, more) = match (formulas.atom_at(*atom), value) {
                (Atom::Reaches { word, number }, true) => (Some(word), None, i128::from(*number)),
                (Atom::Reaches { word, number }, false) => (None, Some(word), 1 - i128::from(*number)),
                (Atom::AtLeast { word, other }, true) => (Some(word), Some(other), 0),
                (Atom::AtLeast { word, other }, false) => (Some(other), Some(word), 1),
                _ => continue,
            };
            let sides = [left, right].map(|word| match word {
                None => 0,
                Some(word) => bounds.number(word, formulas, is_narrow),
            });
            bounds.at_least(sides, more, Some(*atom));
        }
        bounds
    }

    fn at_least(&mut self, [left, right]: [usize; 2], more: i128, atom: Option<u32>) {
        let step = self.steps[left].max(self.steps[right]);
        // So many whole steps are enough, and fewer are not.
        let more = more.div_euclid(step) + i128::from(more.rem_euclid(step) > 0);
        self.least.push(Least { left, right, more, atom });
    }

    fn number(&mut self, word: &Moment, formulas: &Formulas, is_narrow: bool) -> usize {
        if let Some(known) = self.numbers.get(word) {
            return *known;
        }
        self.words.push(word.clone());
        let number = self.words.len();
        self.numbers.insert(word.clone(), number);
        let Numbers { least, greatest, step } = Numbers::of(word, formulas, is_narrow);
        self.steps.push(step);
        if let Some(least) = least {
            self.at_least([number, 0], least, None);
        }
        if let Some(greatest) = greatest {
            self.at_least([0, number], -greatest, None);
        }
        number
    }

    /// The least numbers that fit, none below zero that need not be; nothing if there are none.
    pub fn solved(&self) -> Option<Vec<(Moment, i64)>> {
        let (values, _) = self.relaxed().ok()?;
        let zero = values[0];
        let words = self.words.iter().zip(&values[1..]).zip(&self.steps[1..]);
        words
            .map(|((word, value), step)| Some((word.clone(), i64::try_from((value - zero) * step).ok()?)))
            .collect()
    }

    /// Atoms that cannot all have the values that they have; nothing if they can.
    pub fn conflict(&self) -> Option<Vec<u32>> {
        let (mut at, before) = match self.relaxed() {
            Ok(_) => return None,
            Err(found) => found,
        };
        // So many steps back one is on the circle.
        for _ in 0..=self.words.len() {
            at = self.least[before[at]?].right;
        }
        let (start, mut atoms) = (at, Vec::new());
        loop {
            let least = &self.least[before[at]?];
            atoms.extend(least.atom);
            at = least.right;
            if at == start {
                return Some(atoms);
            }
        }
    }

    /// The least values, or a word that still grows when all must have come to rest, with the comparison that each word
    /// grew by last.
    #[allow(clippy::type_complexity, reason = "two vectors with one number for each word")]
    fn relaxed(&self) -> Result<(Vec<i128>, Vec<Option<usize>>), (usize, Vec<Option<usize>>)> {
        let mut values = vec![0_i128; self.words.len() + 1];
        let mut before = vec![None; values.len()];
        let mut grown = 0;
        for _ in 0..=values.len() {
            let mut is_done = true;
            for (number, Least { left, right, more, .. }) in self.least.iter().enumerate() {
                let least = values[*right] + more;
                if values[*left] < least {
                    values[*left] = least;
                    before[*left] = Some(number);
                    grown = *left;
                    is_done = false;
                }
            }
            if is_done {
                return Ok((values, before));
            }
            // Who goes back on the way by which values grew and comes round finds what can never come to rest.
            if let Some(on_circle) = self.on_circle(&before) {
                return Err((on_circle, before));
            }
        }
        Err((grown, before))
    }

    /// A word by whose growth it grew itself.
    fn on_circle(&self, before: &[Option<usize>]) -> Option<usize> {
        let mut seen_from = vec![usize::MAX; before.len()];
        for start in 0..before.len() {
            let mut at = start;
            loop {
                match seen_from[at] {
                    usize::MAX => seen_from[at] = start,
                    known if known == start => return Some(at),
                    _ => break,
                }
                match before[at] {
                    Some(least) => at = self.least[least].right,
                    None => break,
                }
            }
        }
        None
    }
}
