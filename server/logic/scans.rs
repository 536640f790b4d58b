//! What bits are from scan to scan: whether two of them are ever on together at the end of one.
//!
//! One run gives the value of each bit at the end of a scan in terms of those at its start. Put into itself it gives
//! two scans, and so on. That two bits are never on together is proved by induction: if it held at the ends of some
//! scans, it holds at the end of the next. That they can be is shown by scans from the start of the PLC.

use super::decide::{Verdict, equal};
use super::formula::{Atom, Moment};
use super::{Formula, Formulas, Run, Term};
use crate::target::Device;
use rustc_hash::FxHashMap;
use smol_str::{SmolStr, ToSmolStr};
use std::collections::BTreeMap;

/// What is known of a bit that a scan reads.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Source {
    /// It comes from outside, may be anything, and stays the same for the whole scan.
    Input,
    /// The program drives it, and it is off when the PLC starts.
    Driven,
    /// The program drives it, and it keeps its value without power.
    Kept,
    /// Nobody can tell.
    Unknown,
}

/// Whether two bits can be on together at the end of a scan.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Exclusion {
    /// Never, which is proved.
    Never,
    /// They are at the end of the last of these scans from the start of the PLC. For each the inputs that are on; all
    /// others are off.
    Reached(Vec<Vec<SmolStr>>),
    /// They are behind a scan in which atoms have these values, by their numbers, if that can come about.
    Possible(BTreeMap<u32, bool>),
    /// Too large a question.
    Undecided,
}

/// The values of bits over several scans of a program.
pub struct Scans<'r, 'p> {
    /// The run through the program, once.
    pub run: &'r Run<'p>,
    /// The bits that it reads or drives, by their keys.
    pub terms: &'r FxHashMap<SmolStr, Term>,
    /// What is known of each, by its key.
    pub source: &'r dyn Fn(&SmolStr) -> Source,
    /// What holds in each scan, over the atoms of the run.
    pub facts: Formula,
}

/// So many scans are looked at. Relays that follow each other over a scan or two are common, longer rows are not.
const SCANS: u32 = 3;
/// So many atoms of which nothing is known may stand in what is claimed for all of their values.
const UNKNOWN_MAX: usize = 8;
/// Formulas with more parts are not put to the diagrams.
const PARTS_MAX: usize = 20_000;
/// Atoms of later scans have numbers from here on.
const LATER: u32 = 1 << 30;

impl Scans<'_, '_> {
    /// Whether the bits `one` and `other` can be on together at the end of a scan.
    pub fn exclusion(&self, one: &Term, other: &Term, formulas: &mut Formulas) -> Exclusion {
        let pair = [one, other];
        let behind = pair.map(|term| self.run.bit(term, formulas));
        let behind = formulas.and(behind);
        let before = pair.map(|term| formulas.atom(Atom::Bit(Moment { name: term.key(), since: 0 })));
        let before = formulas.and(before);
        let mut anywhere = Unrolled::new(self, Begin::Anywhere);
        let mut start = Unrolled::new(self, Begin::Start);
        // What the induction takes to hold at the ends of the scans before.
        let (mut held, mut possible) = (vec![formulas.not(before)], None);
        let holds_at_start = match is_never(start.at(1, before, formulas), formulas) {
            Some(holds) => holds || pair.iter().all(|term| (self.source)(&term.key()) == Source::Kept),
            None => return Exclusion::Undecided,
        };
        for scan in 1..=SCANS {
            let fact = anywhere.at(scan, self.facts, formulas);
            let on = anywhere.at(scan, behind, formulas);
            held.push(fact);
            let bad = formulas.and(held.iter().copied().chain([on]));
            let bad = if holds_at_start { bad } else { formulas.and([fact, on]) };
            match equal_to_never(bad, formulas) {
                Verdict::Equal => return Exclusion::Never,
                Verdict::Undecided | Verdict::Doubtful => return possible.unwrap_or(Exclusion::Undecided),
                Verdict::Different(values) => {
                    possible.get_or_insert(Exclusion::Possible(values));
                }
            }
            if !holds_at_start {
                break;
            }
            held.push(formulas.not(on));
            // The next step needs one more scan from the start.
            let (first, fact) = (start.at(scan, behind, formulas), start.at(scan, self.facts, formulas));
            let ends = formulas.not(before);
            let first = formulas.and([first, fact, ends]);
            if is_never(first, formulas) != Some(true) {
                break;
            }
        }
        self.reached(behind, formulas).or(possible).unwrap_or(Exclusion::Undecided)
    }

    /// The inputs that lead to `behind` from a start with all bits off, whatever is unknown.
    fn reached(&self, behind: Formula, formulas: &mut Formulas) -> Option<Exclusion> {
        let mut first = Unrolled::new(self, Begin::FirstStart);
        for scan in 1..=SCANS {
            let mut on = first.at(scan, behind, formulas);
            let atoms = formulas.atoms_of([on]);
            let unknown: Vec<u32> =
                atoms.into_iter().filter(|atom| self.input_at(*atom, formulas).is_none()).collect();
            if unknown.len() > UNKNOWN_MAX {
                return None;
            }
            for atom in unknown {
                let sides = [Formulas::FALSE, Formulas::TRUE].map(|value| {
                    let put = |formulas: &mut Formulas, own: u32| match own == atom {
                        true => value,
                        false => {
                            let same = formulas.atom_at(own).clone();
                            formulas.atom(same)
                        }
                    };
                    formulas.replaced(&[on], put)[0]
                });
                on = formulas.and(sides);
            }
            if let Verdict::Different(values) = equal_to_never(on, formulas) {
                let mut steps = vec![Vec::new(); scan as usize];
                for (atom, _) in values.into_iter().filter(|(_, value)| *value) {
                    if let Some((scan, name)) = self.input_at(atom, formulas)
                        && let Some(step) = steps.get_mut(scan as usize - 1)
                    {
                        step.push(name);
                    }
                }
                return Some(Exclusion::Reached(steps));
            }
        }
        None
    }

    /// The scan and the name, if an atom is an input in a scan.
    fn input_at(&self, atom: u32, formulas: &Formulas) -> Option<(u32, SmolStr)> {
        let Atom::Bit(Moment { name, since }) = formulas.atom_at(atom) else { return None };
        let scan = match since {
            0 => 1,
            _ => since.checked_sub(LATER)?,
        };
        ((self.source)(name) == Source::Input).then(|| (scan, name.clone()))
    }
}

fn equal_to_never(formula: Formula, formulas: &mut Formulas) -> Verdict {
    match formulas.size_of([formula]) > PARTS_MAX {
        true => Verdict::Undecided,
        false => equal(formulas, formula, Formulas::FALSE),
    }
}

fn is_never(formula: Formula, formulas: &mut Formulas) -> Option<bool> {
    match equal_to_never(formula, formulas) {
        Verdict::Equal => Some(true),
        Verdict::Different(_) => Some(false),
        Verdict::Undecided | Verdict::Doubtful => None,
    }
}

/// Where the first scan begins.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Begin {
    /// In any state.
    Anywhere,
    /// When the PLC starts; what it keeps without power may be anything.
    Start,
    /// When it starts for the first time.
    FirstStart,
}

/// Formulas over the atoms of a row of scans.
struct Unrolled<'s, 'r, 'p> {
    scans: &'s Scans<'r, 'p>,
    begin: Begin,
    known: FxHashMap<(u32, Formula), Formula>,
    /// The atoms of later scans of which nothing is known, one for each.
    fresh: FxHashMap<(u32, u32), u32>,
}

impl<'s, 'r, 'p> Unrolled<'s, 'r, 'p> {
    fn new(scans: &'s Scans<'r, 'p>, begin: Begin) -> Self {
        Unrolled { scans, begin, known: FxHashMap::default(), fresh: FxHashMap::default() }
    }

    /// What `formula`, over the atoms of one run, is in a scan, from 1.
    fn at(&mut self, scan: u32, formula: Formula, formulas: &mut Formulas) -> Formula {
        if let Some(known) = self.known.get(&(scan, formula)) {
            return *known;
        }
        let mut atoms: FxHashMap<u32, Formula> = FxHashMap::default();
        for atom in formulas.atoms_of([formula]) {
            let value = self.atom(scan, atom, formulas);
            atoms.insert(atom, value);
        }
        let made = formulas.replaced(&[formula], |_, atom| atoms[&atom])[0];
        self.known.insert((scan, formula), made);
        made
    }

    fn atom(&mut self, scan: u32, number: u32, formulas: &mut Formulas) -> Formula {
        let atom = formulas.atom_at(number).clone();
        match &atom {
            Atom::Bit(of) if self.begin != Begin::Anywhere && is_first_scan(&of.name).is_some() => {
                Formulas::constant((scan == 1) == (is_first_scan(&of.name) == Some(true)))
            }
            Atom::Bit(Moment { name, since: 0 }) => self.bit(scan, name, atom.clone(), formulas),
            Atom::Edge { of, value, rising } if scan > 1 => {
                let bit = value.unwrap_or_else(|| formulas.atom(Atom::Bit(of.clone())));
                let [now, last] = [scan, scan - 1].map(|scan| self.at(scan, bit, formulas));
                let sides = match rising {
                    true => [now, formulas.not(last)],
                    false => [last, formulas.not(now)],
                };
                formulas.and(sides)
            }
            _ if scan == 1 => formulas.atom(atom),
            _ => {
                let next = LATER + self.fresh.len() as u32;
                let number = *self.fresh.entry((scan, number)).or_insert(next);
                formulas.atom(Atom::Behind(number))
            }
        }
    }

    /// A bit at the start of a scan.
    fn bit(&mut self, scan: u32, name: &SmolStr, atom: Atom, formulas: &mut Formulas) -> Formula {
        let source = (self.scans.source)(name);
        let is_off = match self.begin {
            Begin::Anywhere => false,
            Begin::Start => source == Source::Driven,
            Begin::FirstStart => matches!(source, Source::Driven | Source::Kept),
        };
        match scan {
            1 if is_off => Formulas::FALSE,
            1 => formulas.atom(atom),
            _ => match self.scans.terms.get(name).filter(|_| source != Source::Input) {
                Some(term) => {
                    let last = self.scans.run.bit(term, formulas);
                    let unchanged = formulas.atom(atom);
                    let is_own = matches!(source, Source::Driven | Source::Kept);
                    match last == unchanged && !is_own {
                        // Nothing here drives it, and somebody may in between.
                        true => formulas.atom(Atom::Bit(Moment { name: name.clone(), since: LATER + scan })),
                        false => self.at(scan - 1, last, formulas),
                    }
                }
                None => formulas.atom(Atom::Bit(Moment { name: name.clone(), since: LATER + scan })),
            },
        }
    }
}

/// Whether it is the special relay that is on in the first scan, or the one that is off in it.
fn is_first_scan(name: &SmolStr) -> Option<bool> {
    let is = |device: Device| device.to_smolstr() == *name;
    is(Device::FIRST_SCAN).then_some(true).or_else(|| is(Device::OFF_AT_FIRST).then_some(false))
}
