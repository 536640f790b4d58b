//! Formulas in an arena: equal ones have equal numbers as far as commuting, associating and De Morgan's laws go, so
//! that most proofs are done when they are written down. For that, a sum is the inverse of a product of inverses.

use super::effort;
use crate::document::Limits;
use crate::target::iec::ElementaryType;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// The types of variables by their [keys](super::Term::key), as far as they are known beyond doubt; nothing inside
/// where several names of one place have different types.
pub type Types = FxHashMap<SmolStr, Option<Kind>>;

/// What numbers a variable has.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Kind {
    /// Its type.
    pub elementary: ElementaryType,
    /// Those that it is declared to be among.
    pub limits: Limits,
}

/// The number of a formula in its [`Formulas`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Formula(pub(super) u32);

/// A bit that nothing is known of but its name.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Atom {
    /// The value of a bit.
    Bit(Moment),
    /// Whether a bit came on (or went off) since it was last asked.
    Edge {
        /// The bit when it is asked.
        of: Moment,
        /// Its value then, if the run gave it one.
        value: Option<Formula>,
        /// On, or off.
        rising: bool,
    },
    /// What a contact for an edge finds whose relay has [one memory](crate::target::Device::has_single_edge) for all of
    /// them: the step that asking is.
    SingleEdge(u32),
    /// Whether a word is at least as large as a number.
    Reaches {
        /// The word.
        word: Moment,
        /// The least number for which it holds.
        number: i64,
    },
    /// Whether a word is at least as large as another.
    AtLeast {
        /// The word that is.
        word: Moment,
        /// The other.
        other: Moment,
    },
    /// Whether a word is no number, with which every comparison fails (IEC 60559).
    NoNumber(Moment),
    /// Whether power goes on behind the event of this number, from 1.
    Behind(u32),
    /// Whether there is power at the left rail, where a master control or a step may leave it without.
    Rail,
}

/// A device or variable at a moment of the scan.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Moment {
    /// Its name, as [`Term::key`](super::Term::key) has it; a 32-bit value has a `D` and a blank before it.
    pub name: SmolStr,
    /// 0 for its value before the run; else the number of the [`Step`] that may have changed it last.
    pub since: u32,
}

/// What may have changed a device in a run. Steps with equal numbers leave the same behind.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Step {
    /// An event.
    Event {
        /// Its number, from 1.
        number: u32,
        /// The step before, where more is left of that than the event itself leaves.
        before: u32,
    },
    /// A contact for an edge was executed that takes it from those behind it.
    Asked {
        /// The one of the same relay that was executed before.
        before: u32,
        /// The relay when it was asked.
        of: Moment,
        /// Its value then, if the run gave it one.
        value: Option<Formula>,
        /// On, or off.
        rising: bool,
    },
    /// A bit that was driven.
    Driven {
        /// The step before.
        before: u32,
        /// The bit.
        key: SmolStr,
        /// Its value then, where steps of different runs are not known to be the same.
        value: Option<Formula>,
    },
}

/// What a formula is.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) enum Node {
    Constant(bool),
    Atom(u32),
    Not(Formula),
    And(Box<[Formula]>),
}

/// An arena of formulas. Parts have smaller numbers than what they are part of.
#[derive(Clone, Debug)]
pub struct Formulas {
    nodes: Vec<Node>,
    numbers: FxHashMap<Node, Formula>,
    atoms: Vec<Atom>,
    atom_numbers: FxHashMap<Atom, u32>,
    steps: Vec<Step>,
    step_numbers: FxHashMap<Step, u32>,
    types: Arc<Types>,
    is_straight: bool,
    effort: usize,
}

impl Default for Formulas {
    fn default() -> Formulas {
        Formulas::limited(effort::QUESTION)
    }
}

impl Formulas {
    /// Never.
    pub const FALSE: Formula = Formula(0);
    /// Always.
    pub const TRUE: Formula = Formula(1);

    /// No formulas yet; proofs about them may need so many nodes of diagrams in all.
    pub fn limited(effort: usize) -> Formulas {
        Formulas {
            nodes: vec![Node::Constant(false), Node::Constant(true)],
            numbers: FxHashMap::default(),
            atoms: Vec::new(),
            atom_numbers: FxHashMap::default(),
            steps: Vec::new(),
            step_numbers: FxHashMap::default(),
            types: Arc::default(),
            is_straight: false,
            effort,
        }
    }

    /// The same, about variables of these types.
    pub fn with_types(self, types: Arc<Types>) -> Formulas {
        Formulas { types, ..self }
    }

    /// The same, about programs of which each contact is executed once in each scan.
    pub fn straight(self) -> Formulas {
        Formulas { is_straight: true, ..self }
    }

    /// Whether each contact is executed once in each scan.
    pub fn is_straight(&self) -> bool {
        self.is_straight
    }

    /// The type of the variable with this key, if it is known.
    pub fn type_of(&self, key: &str) -> Option<ElementaryType> {
        self.kind_of(key).map(|kind| kind.elementary)
    }

    /// What numbers the variable with this key has, if that is known.
    pub fn kind_of(&self, key: &str) -> Option<Kind> {
        self.types.get(key).copied().flatten()
    }

    /// Whether what has this key is several numbers, each as another type reads it.
    pub fn is_of_many_types(&self, key: &str) -> bool {
        matches!(self.types.get(key), Some(None))
    }

    /// How many nodes of diagrams proofs may still need.
    pub fn effort(&self) -> usize {
        self.effort
    }

    /// Takes off what a proof needed.
    pub(super) fn spend(&mut self, effort: usize) {
        self.effort = self.effort.saturating_sub(effort);
    }

    /// The constant.
    pub fn constant(value: bool) -> Formula {
        Formula(u32::from(value))
    }

    /// The formula that is this atom.
    pub fn atom(&mut self, atom: Atom) -> Formula {
        let number = match self.atom_numbers.entry(atom) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => {
                self.atoms.push(new.key().clone());
                *new.insert(self.atoms.len() as u32 - 1)
            }
        };
        self.number(Node::Atom(number))
    }

    /// The number of a step, from 1.
    pub fn step(&mut self, step: Step) -> u32 {
        match self.step_numbers.entry(step) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => {
                self.steps.push(new.key().clone());
                *new.insert(self.steps.len() as u32)
            }
        }
    }

    /// The step with this number; nothing for 0, the start of the run.
    pub fn step_at(&self, number: u32) -> Option<&Step> {
        self.steps.get((number as usize).checked_sub(1)?)
    }

    /// Where `part` does not hold.
    pub fn not(&mut self, part: Formula) -> Formula {
        match self.node(part) {
            Node::Constant(value) => Formulas::constant(!value),
            Node::Not(inner) => *inner,
            _ => self.number(Node::Not(part)),
        }
    }

    /// Where one of the parts holds.
    pub fn or(&mut self, parts: impl IntoIterator<Item = Formula>) -> Formula {
        let inverses: Vec<Formula> = parts.into_iter().map(|part| self.not(part)).collect();
        let none = self.and(inverses);
        self.not(none)
    }

    /// The atom with this number.
    pub fn atom_at(&self, number: u32) -> &Atom {
        &self.atoms[number as usize]
    }

    /// The atoms of a formula by number, in order.
    pub fn atoms_of(&self, formulas: impl IntoIterator<Item = Formula>) -> Vec<u32> {
        let mut atoms: Vec<u32> = self
            .parts_of(formulas)
            .into_iter()
            .filter_map(|part| match self.node(part) {
                Node::Atom(number) => Some(*number),
                _ => None,
            })
            .collect();
        atoms.sort_unstable();
        atoms
    }

    /// The value of each formula, parts before wholes, where `value` gives those of the atoms; those that are no part
    /// of `formulas` are false.
    pub fn evaluate(&self, formulas: &[Formula], value: impl Fn(u32) -> bool) -> Vec<bool> {
        let mut values: FxHashMap<Formula, bool> = FxHashMap::default();
        for part in self.parts_of(formulas.iter().copied()) {
            let of = |part: &Formula| values.get(part).copied().unwrap_or(false);
            let own = match self.node(part) {
                Node::Constant(value) => *value,
                Node::Atom(number) => value(*number),
                Node::Not(inner) => !of(inner),
                Node::And(parts) => parts.iter().all(of),
            };
            values.insert(part, own);
        }
        formulas.iter().map(|formula| values.get(formula).copied().unwrap_or(false)).collect()
    }

    /// The formulas with others in place of their atoms.
    pub fn replaced(
        &mut self,
        formulas: &[Formula],
        mut other: impl FnMut(&mut Formulas, u32) -> Formula,
    ) -> Vec<Formula> {
        let mut made: FxHashMap<Formula, Formula> = FxHashMap::default();
        for part in self.parts_of(formulas.iter().copied()) {
            let node = self.node(part).clone();
            let of = |part: &Formula| made.get(part).copied().unwrap_or(*part);
            let new = match node {
                Node::Constant(_) => part,
                Node::Atom(number) => other(self, number),
                Node::Not(inner) => self.not(of(&inner)),
                Node::And(parts) => self.and(parts.iter().map(of)),
            };
            made.insert(part, new);
        }
        formulas.iter().map(|formula| made.get(formula).copied().unwrap_or(*formula)).collect()
    }

    /// How many parts the formulas have.
    pub fn size_of(&self, formulas: impl IntoIterator<Item = Formula>) -> usize {
        self.parts_of(formulas).len()
    }

    /// The formulas and all their parts, each once, parts first.
    pub(super) fn parts_of(&self, formulas: impl IntoIterator<Item = Formula>) -> Vec<Formula> {
        let mut waiting: Vec<Formula> = formulas.into_iter().collect();
        let mut seen = rustc_hash::FxHashSet::default();
        while let Some(formula) = waiting.pop() {
            if !seen.insert(formula) {
                continue;
            }
            match self.node(formula) {
                Node::Constant(_) | Node::Atom(_) => {}
                Node::Not(part) => waiting.push(*part),
                Node::And(parts) => waiting.extend(parts.iter()),
            }
        }
        let mut parts: Vec<Formula> = seen.into_iter().collect();
        parts.sort_unstable();
        parts
    }

    pub(super) fn node(&self, formula: Formula) -> &Node {
        &self.nodes[formula.0 as usize]
    }

    /// Where all parts hold.
    pub fn and(&mut self, parts: impl IntoIterator<Item = Formula>) -> Formula {
        let mut flat = Vec::new();
        for part in parts {
            match self.node(part) {
                Node::And(inner) => flat.extend(inner.iter().copied()),
                _ => flat.push(part),
            }
        }
        flat.sort_unstable();
        flat.dedup();
        flat.retain(|part| *part != Formulas::TRUE);
        let is_contrary = |part: &Formula| match self.node(*part) {
            Node::Not(inner) => flat.binary_search(inner).is_ok(),
            _ => false,
        };
        if flat.first() == Some(&Formulas::FALSE) || flat.iter().any(is_contrary) {
            return Formulas::FALSE;
        }
        match flat[..] {
            [] => Formulas::TRUE,
            [only] => only,
            _ => self.number(Node::And(flat.into())),
        }
    }

    fn number(&mut self, node: Node) -> Formula {
        match self.numbers.entry(node) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => {
                self.nodes.push(new.key().clone());
                *new.insert(Formula(self.nodes.len() as u32 - 1))
            }
        }
    }
}
