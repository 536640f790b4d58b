//! The shortest sum of products that is equal to a formula.
//!
//! With few atoms the answer is exact: all prime implicants (Quine and McCluskey's), and of these a cover with the
//! fewest contacts. With more atoms it is what the library of decision diagrams finds.

use super::decide::{Diagrams, axioms};
use super::{Formula, Formulas};

/// Products of literals: each an atom, by its number, and whether it holds. An empty product is true, no product false.
pub type Sum = Vec<Vec<(u32, bool)>>;

/// With more atoms, tables of values grow long.
const EXACT_MAX: usize = 8;
/// With more atoms, an answer may be long in coming.
const ATOMS_MAX: usize = 32;
/// With more products nobody reads the sum.
const PRODUCTS_MAX: usize = 64;
/// So many choices among the prime implicants are tried.
const TRIES_MAX: u32 = 20_000;

/// The shortest sum of products for `formula`, counted in contacts; what cannot occur together makes no difference.
/// Nothing if it is too large a question.
pub fn sum_of_products(formulas: &mut Formulas, formula: Formula) -> Option<Sum> {
    let atoms = formulas.atoms_of([formula]);
    let sum = match atoms.len() <= EXACT_MAX {
        true => exact(formulas, formula, &atoms),
        false => found(formulas, formula, atoms.len())?,
    };
    (sum.len() <= PRODUCTS_MAX).then_some(sum)
}

fn found(formulas: &mut Formulas, formula: Formula, atoms: usize) -> Option<Sum> {
    if atoms > ATOMS_MAX {
        return None;
    }
    let diagrams = Diagrams::of(formulas, &[formula])?;
    let diagram = diagrams.of.get(&formula)?;
    // The library's search is quadratic in the ways through the diagram.
    if diagram.sat_clauses().take(PRODUCTS_MAX + 1).count() > PRODUCTS_MAX {
        return None;
    }
    let products = diagram.to_optimized_dnf().into_iter().map(|product| {
        let literals = product.to_values().into_iter();
        literals.map(|(variable, holds)| (diagrams.atoms[variable.to_index()], holds)).collect()
    });
    Some(products.collect())
}

/// A set of rows of a table of values.
type Rows = [u64; (1 << EXACT_MAX) / 64];

/// A product: the atoms that it asks for, and those that must hold of them, as bits.
#[derive(Clone, Copy)]
struct Cube {
    asked: u32,
    holds: u32,
    rows: Rows,
}

fn exact(formulas: &mut Formulas, formula: Formula, atoms: &[u32]) -> Sum {
    let mut all = axioms(formulas, &[formula]);
    all.push(formula);
    let (mut must, mut may) = (Rows::default(), Rows::default());
    for row in 0..1u32 << atoms.len() {
        let is_on =
            |atom: u32| atoms.iter().position(|known| *known == atom).is_some_and(|bit| row >> bit & 1 == 1);
        let mut values = formulas.evaluate(&all, is_on);
        let holds = values.pop().unwrap_or(false);
        let is_possible = values.into_iter().all(|value| value);
        let bit = 1u64 << (row % 64);
        must[row as usize / 64] |= if holds && is_possible { bit } else { 0 };
        may[row as usize / 64] |= if holds || !is_possible { bit } else { 0 };
    }
    let primes = primes(atoms.len() as u32, &may);
    let mut search = Search { primes: &primes, choices: choices(&primes), best: None, tries: 0 };
    search.cover(&must, &mut Vec::new(), 0);
    let chosen = search.best.map_or_else(Vec::new, |(_, chosen)| chosen);
    let product = |prime: usize| {
        let Cube { asked, holds, .. } = primes[prime];
        let bits = (0..atoms.len()).filter(move |bit| asked >> bit & 1 == 1);
        bits.map(|bit| (atoms[bit], holds >> bit & 1 == 1)).collect()
    };
    chosen.into_iter().map(product).collect()
}

/// The products that hold in no other rows than `may`, and of which nothing can be left out.
fn primes(atoms: u32, may: &Rows) -> Vec<Cube> {
    let mut primes: Vec<Cube> = Vec::new();
    let mut masks: Vec<u32> = (0..1u32 << atoms).collect();
    masks.sort_by_key(|mask| mask.count_ones());
    for asked in masks {
        // All subsets of the atoms that are asked for, from all to none.
        let mut holds = asked;
        loop {
            let is_new = !primes
                .iter()
                .any(|prime| prime.asked & asked == prime.asked && prime.holds == holds & prime.asked);
            if is_new {
                let rows = rows_of(atoms, asked, holds);
                if rows.iter().zip(may).all(|(own, may)| own & !may == 0) {
                    primes.push(Cube { asked, holds, rows });
                }
            }
            if holds == 0 {
                break;
            }
            holds = (holds - 1) & asked;
        }
    }
    primes
}

fn rows_of(atoms: u32, asked: u32, holds: u32) -> Rows {
    let mut rows = Rows::default();
    let matching = (0..1u32 << atoms).filter(|row| row & asked == holds);
    matching.for_each(|row| rows[row as usize / 64] |= 1 << (row % 64));
    rows
}

/// Each row that primes cover, with their numbers; the row that the fewest cover first.
fn choices(primes: &[Cube]) -> Vec<(usize, Vec<usize>)> {
    let covering = |row: usize| {
        let primes = primes.iter().enumerate();
        let covers = primes.filter(|(_, prime)| prime.rows[row / 64] >> (row % 64) & 1 == 1);
        (row, covers.map(|(number, _)| number).collect::<Vec<_>>())
    };
    let mut choices: Vec<_> = (0..1usize << EXACT_MAX).map(covering).collect();
    choices.sort_by_key(|(_, primes)| primes.len());
    choices
}

/// The search for the cheapest cover.
struct Search<'p> {
    primes: &'p [Cube],
    choices: Vec<(usize, Vec<usize>)>,
    /// Its cost, and the numbers of its primes.
    best: Option<(u32, Vec<usize>)>,
    tries: u32,
}

impl Search<'_> {
    /// Covers the rows that are `left`, after primes of this `cost` were `chosen`.
    fn cover(&mut self, left: &Rows, chosen: &mut Vec<usize>, cost: u32) {
        self.tries += 1;
        let is_beaten = self.best.as_ref().is_some_and(|(best, _)| cost >= *best);
        if is_beaten || (self.tries > TRIES_MAX && self.best.is_some()) {
            return;
        }
        // The row that the fewest primes cover leaves the least choice.
        let mut rows = self.choices.iter();
        let Some((_, choices)) = rows.find(|(row, _)| left[row / 64] >> (row % 64) & 1 == 1) else {
            self.best = Some((cost, chosen.clone()));
            return;
        };
        let mut choices = choices.clone();
        // Those that cover most come first, so that a good answer is found early.
        let covers = |prime: &usize| {
            let rows = self.primes[*prime].rows.iter().zip(left);
            rows.map(|(own, left)| (own & left).count_ones()).sum::<u32>()
        };
        choices.sort_by_key(|prime| std::cmp::Reverse(covers(prime)));
        for prime in choices {
            let Cube { asked, rows, .. } = self.primes[prime];
            let mut rest = *left;
            rest.iter_mut().zip(rows).for_each(|(left, own)| *left &= !own);
            chosen.push(prime);
            // A contact counts, and a branch a little, so that of equal ones the sum with fewer branches wins.
            self.cover(&rest, chosen, cost + 256 * asked.count_ones() + 1);
            chosen.pop();
        }
    }
}
