//! Decides whether formulas are equal, with decision diagrams. Work has a limit that no clock gives, so the same
//! question has the same answer on every machine.

use super::formula::{Atom, Node, Step};
use super::{Bounds, Formula, Formulas, Moment};
use biodivine_lib_bdd::{Bdd, BddPartialValuation, BddVariable, BddVariableSet, op_function};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;

/// An answer.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// Equal for all values of the atoms that can occur together.
    Equal,
    /// Not equal for these values; atoms that are left out make no difference.
    Different(BTreeMap<u32, bool>),
    /// Too large a question.
    Undecided,
    /// Not equal, but only for values that words need not have: beyond a subrange, or no number.
    Doubtful,
}

/// So many nodes a diagram may have: some tens of milliseconds.
const NODES_MAX: usize = 200_000;
/// Two diagrams are joined without a look at how much work it will be if it cannot be more than so many steps.
const STEPS_MAX: usize = 1 << 16;
/// So many values that words cannot have are taken out of a question.
const TRIES_MAX: usize = 200;
/// The library numbers variables with 16 bits.
const ATOMS_MAX: usize = 4_000;

/// Whether two formulas are equal. Values that cannot occur together, as a bit that just came on and is off, are left
/// out of account.
pub fn equal(formulas: &mut Formulas, left: Formula, right: Formula) -> Verdict {
    if left == right {
        return Verdict::Equal;
    }
    let Some(mut diagrams) = Diagrams::of(formulas, &[left, right]) else { return Verdict::Undecided };
    let verdict = diagrams.differing(left, right).map(|differ| diagrams.verdict(differ, formulas));
    formulas.spend(diagrams.work.spent);
    verdict.unwrap_or(Verdict::Undecided)
}

/// Whether a formula holds for no values that can occur together; nothing if that is too large a question.
pub fn is_never(formulas: &mut Formulas, formula: Formula) -> Option<bool> {
    match equal(formulas, formula, Formulas::FALSE) {
        Verdict::Equal => Some(true),
        Verdict::Different(_) => Some(false),
        Verdict::Undecided | Verdict::Doubtful => None,
    }
}

/// The diagrams of formulas and of what can occur together.
pub(super) struct Diagrams {
    variables: BddVariableSet,
    /// The atom of each variable, in order.
    pub atoms: Vec<u32>,
    /// That of each formula that was wanted, and of its parts.
    pub of: FxHashMap<Formula, Bdd>,
    possible: Bdd,
    /// What was done since the formulas were told of it.
    work: Work,
}

/// The work that may be done.
#[derive(Default)]
struct Work {
    left: usize,
    spent: usize,
}

type Operation = fn(Option<bool>, Option<bool>) -> Option<bool>;

impl Work {
    /// Two diagrams joined; nothing if that is too much work.
    fn join(&mut self, left: &Bdd, right: &Bdd, operation: Operation) -> Option<Bdd> {
        let limit = self.left.min(NODES_MAX);
        if left.size().saturating_mul(right.size()) > STEPS_MAX {
            // The result may be small after all, but not the way to it.
            let steps = Bdd::check_binary_op(limit, left, right, operation).map(|(_, steps)| steps);
            self.spend(steps.unwrap_or(limit));
            steps?;
        }
        let joined = Bdd::binary_op_with_limit(limit, left, right, operation);
        self.spend(joined.as_ref().map_or(limit, Bdd::size));
        joined
    }

    fn spend(&mut self, effort: usize) {
        self.spent += effort;
        self.left = self.left.saturating_sub(effort);
    }
}

impl Diagrams {
    pub fn of(formulas: &mut Formulas, wanted: &[Formula]) -> Option<Diagrams> {
        let mut work = Work { left: formulas.effort(), spent: 0 };
        let diagrams = Diagrams::made(formulas, wanted, &mut work);
        formulas.spend(work.spent);
        diagrams.map(|diagrams| Diagrams { work: Work { left: formulas.effort(), spent: 0 }, ..diagrams })
    }

    fn made(formulas: &mut Formulas, wanted: &[Formula], work: &mut Work) -> Option<Diagrams> {
        let axioms = axioms(formulas, wanted);
        let all: Vec<Formula> = wanted.iter().copied().chain(axioms.iter().copied()).collect();
        let parts = formulas.parts_of(all);
        let atoms = in_order_of_use(formulas, wanted, &parts);
        if atoms.len() > ATOMS_MAX {
            return None;
        }
        let variables = BddVariableSet::new_anonymous(atoms.len() as u16);
        let names = variables.variables();
        let places: FxHashMap<u32, BddVariable> = atoms.iter().copied().zip(names).collect();
        let mut of: FxHashMap<Formula, Bdd> = FxHashMap::default();
        for part in parts {
            let diagram = match formulas.node(part) {
                Node::Constant(true) => variables.mk_true(),
                Node::Constant(false) => variables.mk_false(),
                Node::Atom(number) => variables.mk_var(*places.get(number)?),
                Node::Not(inner) => of.get(inner)?.not(),
                Node::And(inner) => joined(&of, inner, variables.mk_true(), op_function::and, work)?,
            };
            of.insert(part, diagram);
        }
        let possible = joined(&of, &axioms, variables.mk_true(), op_function::and, work)?;
        Some(Diagrams { variables, atoms, of, possible, work: Work::default() })
    }

    /// Where two formulas differ.
    fn differing(&mut self, left: Formula, right: Formula) -> Option<Bdd> {
        let (left, right) = (self.of.get(&left)?, self.of.get(&right)?);
        let differ = self.work.join(left, right, op_function::xor)?;
        self.work.join(&differ, &self.possible, op_function::and)
    }

    /// Whether there are values for which `differ` holds and which words can have. Each try that words cannot follow
    /// takes out what is wrong with it. What only some PLCs can make of a word decides nothing.
    fn verdict(&mut self, mut differ: Bdd, formulas: &Formulas) -> Verdict {
        let mut is_open = false;
        for _ in 0..TRIES_MAX {
            if differ.is_false() {
                return if is_open { Verdict::Doubtful } else { Verdict::Equal };
            }
            let values = self.values(&differ);
            let conflict = match Bounds::of(formulas, &values, false).conflict() {
                Some(conflict) => Some(conflict),
                None => {
                    let conflict = Bounds::of(formulas, &values, true).conflict();
                    let no_number = values.iter().find(|(atom, value)| {
                        **value && matches!(formulas.atom_at(**atom), Atom::NoNumber(_))
                    });
                    let conflict = conflict.or_else(|| Some(vec![*no_number?.0]));
                    is_open |= conflict.is_some();
                    conflict
                }
            };
            let Some(conflict) = conflict else { return Verdict::Different(values) };
            let names = self.variables.variables();
            let others = names.into_iter().zip(&self.atoms).filter(|(_, atom)| conflict.contains(atom));
            let others: Vec<(BddVariable, bool)> =
                others.map(|(name, atom)| (name, !values.get(atom).copied().unwrap_or(false))).collect();
            let clause = self.variables.mk_disjunctive_clause(&BddPartialValuation::from_values(&others));
            match self.work.join(&differ, &clause, op_function::and) {
                Some(rest) => differ = rest,
                None => return Verdict::Undecided,
            }
        }
        Verdict::Undecided
    }

    /// Values for which `diagram` holds, with as few atoms on as there are on the shortest way.
    fn values(&self, diagram: &Bdd) -> BTreeMap<u32, bool> {
        let Some(valuation) = diagram.most_negative_valuation() else { return BTreeMap::new() };
        let names = self.variables.variables();
        names.into_iter().zip(&self.atoms).map(|(name, atom)| (*atom, valuation.value(name))).collect()
    }
}

/// The diagrams of `parts` joined, two and two so that none grows long before it must.
fn joined(
    of: &FxHashMap<Formula, Bdd>,
    parts: &[Formula],
    neutral: Bdd,
    operation: Operation,
    work: &mut Work,
) -> Option<Bdd> {
    let mut level: Vec<Bdd> = parts.iter().map(|part| of.get(part).cloned()).collect::<Option<_>>()?;
    while level.len() > 1 {
        let pairs = level.chunks(2);
        let next: Option<Vec<Bdd>> = pairs
            .map(|pair| match pair {
                [left, right] => work.join(left, right, operation),
                _ => pair.first().cloned(),
            })
            .collect();
        level = next?;
    }
    Some(level.pop().unwrap_or(neutral))
}

/// The atoms in the order in which the formulas were written down, which is that of the drawing: contacts that belong
/// together get neighbouring variables. So do the numbers that one word is compared with, for each tells of the next.
fn in_order_of_use(formulas: &Formulas, wanted: &[Formula], parts: &[Formula]) -> Vec<u32> {
    let mut atoms = formulas.atoms_of(wanted.iter().copied());
    let known: FxHashSet<u32> = atoms.iter().copied().collect();
    let more = formulas.atoms_of(parts.iter().copied());
    atoms.extend(more.into_iter().filter(|atom| !known.contains(atom)));
    let mut first: FxHashMap<&Moment, usize> = FxHashMap::default();
    let place = |(place, atom): (usize, &u32)| match formulas.atom_at(*atom) {
        Atom::Reaches { word, number } => (*first.entry(word).or_insert(place), *number),
        _ => (place, 0),
    };
    let places: Vec<(usize, i64)> = atoms.iter().enumerate().map(place).collect();
    let mut order: Vec<usize> = (0..atoms.len()).collect();
    order.sort_by_key(|number| places[*number]);
    order.into_iter().map(|number| atoms[number]).collect()
}

/// What is true of the atoms of `wanted` among each other: a bit that just came on is on, a word that reaches 10
/// reaches 5, and of two words one is at least as large as the other.
pub(super) fn axioms(formulas: &mut Formulas, wanted: &[Formula]) -> Vec<Formula> {
    let atoms = formulas.atoms_of(wanted.iter().copied());
    let asked: FxHashSet<u32> = atoms.iter().copied().collect();
    let mut axioms = Vec::new();
    let mut numbers: BTreeMap<Moment, Vec<i64>> = BTreeMap::new();
    for atom in atoms {
        match formulas.atom_at(atom).clone() {
            Atom::Bit(_) | Atom::NoNumber(_) | Atom::Behind(_) | Atom::Rail => {}
            Atom::SingleEdge(step) => {
                if let Some(Step::Asked { of, value, rising, .. }) = formulas.step_at(step).cloned() {
                    let edge = formulas.atom(Atom::SingleEdge(step));
                    axioms.push(edge_tells(formulas, edge, (of, value, rising)));
                }
            }
            Atom::Edge { of, value, rising } => {
                let edge = formulas.atom(Atom::Edge { of: of.clone(), value, rising });
                axioms.push(edge_tells(formulas, edge, (of, value, rising)));
            }
            Atom::Reaches { word, number } => numbers.entry(word).or_default().push(number),
            Atom::AtLeast { word, other } => {
                let one = formulas.atom(Atom::AtLeast { word: word.clone(), other: other.clone() });
                let two = formulas.atom(Atom::AtLeast { word: other, other: word });
                // Where nobody asks for the other way round, it may always be so.
                if one < two && formulas.atoms_of([two]).iter().all(|two| asked.contains(two)) {
                    axioms.push(formulas.or([one, two]));
                }
            }
        }
    }
    for (word, mut numbers) in numbers {
        numbers.sort_unstable();
        for pair in numbers.windows(2) {
            let [low, high] =
                [pair[0], pair[1]].map(|number| formulas.atom(Atom::Reaches { word: word.clone(), number }));
            axioms.push(implies(formulas, high, low));
        }
    }
    axioms
}

/// An edge is one of a bit that is on behind it, or off.
fn edge_tells(
    formulas: &mut Formulas,
    edge: Formula,
    (of, value, rising): (Moment, Option<Formula>, bool),
) -> Formula {
    let bit = value.unwrap_or_else(|| formulas.atom(Atom::Bit(of)));
    let bit = if rising { bit } else { formulas.not(bit) };
    implies(formulas, edge, bit)
}

fn implies(formulas: &mut Formulas, left: Formula, right: Formula) -> Formula {
    let left = formulas.not(left);
    formulas.or([left, right])
}
