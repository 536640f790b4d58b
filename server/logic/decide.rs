//! Decides whether formulas are equal, with decision diagrams. Work has a limit that no clock gives, so the same
//! question has the same answer on every machine.

use super::formula::{Atom, Node};
use super::{Formula, Formulas, Moment};
use biodivine_lib_bdd::{Bdd, BddVariable, BddVariableSet, op_function};
use rustc_hash::FxHashMap;
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
}

/// So many nodes a diagram may have: some tens of milliseconds.
const NODES_MAX: usize = 200_000;
/// The library numbers variables with 16 bits.
const ATOMS_MAX: usize = 4_000;

/// Whether two formulas are equal. Values that cannot occur together, as a bit that just came on and is off, are left
/// out of account.
pub fn equal(formulas: &mut Formulas, left: Formula, right: Formula) -> Verdict {
    if left == right {
        return Verdict::Equal;
    }
    let Some(mut diagrams) = Diagrams::of(formulas, &[left, right]) else { return Verdict::Undecided };
    let differ = diagrams.differing(left, right);
    match differ {
        None => Verdict::Undecided,
        Some(differ) => match differ.sat_witness() {
            None => Verdict::Equal,
            Some(_) => Verdict::Different(diagrams.values(&differ)),
        },
    }
}

/// Whether a formula holds for no values that can occur together; nothing if that is too large a question.
pub fn is_never(formulas: &mut Formulas, formula: Formula) -> Option<bool> {
    match equal(formulas, formula, Formulas::FALSE) {
        Verdict::Equal => Some(true),
        Verdict::Different(_) => Some(false),
        Verdict::Undecided => None,
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
}

impl Diagrams {
    pub fn of(formulas: &mut Formulas, wanted: &[Formula]) -> Option<Diagrams> {
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
                Node::And(inner) => joined(&of, inner, variables.mk_true(), op_function::and)?,
                Node::Or(inner) => joined(&of, inner, variables.mk_false(), op_function::or)?,
            };
            of.insert(part, diagram);
        }
        let possible = joined(&of, &axioms, variables.mk_true(), op_function::and)?;
        Some(Diagrams { variables, atoms, of, possible })
    }

    /// Where two formulas differ.
    fn differing(&mut self, left: Formula, right: Formula) -> Option<Bdd> {
        let (left, right) = (self.of.get(&left)?, self.of.get(&right)?);
        let differ = Bdd::binary_op_with_limit(NODES_MAX, left, right, op_function::xor)?;
        Bdd::binary_op_with_limit(NODES_MAX, &differ, &self.possible, op_function::and)
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
    operation: fn(Option<bool>, Option<bool>) -> Option<bool>,
) -> Option<Bdd> {
    let mut level: Vec<Bdd> = parts.iter().map(|part| of.get(part).cloned()).collect::<Option<_>>()?;
    while level.len() > 1 {
        let pairs = level.chunks(2);
        let next: Option<Vec<Bdd>> = pairs
            .map(|pair| match pair {
                [left, right] => Bdd::binary_op_with_limit(NODES_MAX, left, right, operation),
                _ => pair.first().cloned(),
            })
            .collect();
        level = next?;
    }
    Some(level.pop().unwrap_or(neutral))
}

/// The atoms in the order in which the formulas were written down, which is that of the drawing: contacts that belong
/// together get neighbouring variables.
fn in_order_of_use(formulas: &Formulas, wanted: &[Formula], parts: &[Formula]) -> Vec<u32> {
    let mut atoms = formulas.atoms_of(wanted.iter().copied());
    let known: rustc_hash::FxHashSet<u32> = atoms.iter().copied().collect();
    let more = formulas.atoms_of(parts.iter().copied());
    atoms.extend(more.into_iter().filter(|atom| !known.contains(atom)));
    atoms
}

/// What is true of the atoms of `wanted` among each other: a bit that just came on is on, a word that reaches 10
/// reaches 5, and of two words one is at least as large as the other.
pub(super) fn axioms(formulas: &mut Formulas, wanted: &[Formula]) -> Vec<Formula> {
    let atoms = formulas.atoms_of(wanted.iter().copied());
    let mut axioms = Vec::new();
    let mut numbers: BTreeMap<Moment, Vec<i64>> = BTreeMap::new();
    for atom in atoms {
        match formulas.atom_at(atom).clone() {
            Atom::Bit(_) | Atom::Behind(_) | Atom::Rail => {}
            Atom::Edge { of, value, rising } => {
                let edge = formulas.atom(Atom::Edge { of: of.clone(), value, rising });
                let bit = value.unwrap_or_else(|| formulas.atom(Atom::Bit(of)));
                let bit = if rising { bit } else { formulas.not(bit) };
                axioms.push(implies(formulas, edge, bit));
            }
            Atom::Reaches { word, number } => numbers.entry(word).or_default().push(number),
            Atom::AtLeast { word, other } => {
                let one = formulas.atom(Atom::AtLeast { word: word.clone(), other: other.clone() });
                let two = formulas.atom(Atom::AtLeast { word: other, other: word });
                axioms.push(formulas.or([one, two]));
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

fn implies(formulas: &mut Formulas, left: Formula, right: Formula) -> Formula {
    let left = formulas.not(left);
    formulas.or([left, right])
}
