//! The shortest sums of products.

use rungwise::logic::{Atom, Formula, Formulas, Moment, Sum, Verdict, equal, sum_of_products};
use std::collections::HashMap;

fn atoms(formulas: &mut Formulas, count: usize) -> Vec<Formula> {
    let name = |number: usize| Moment { name: format!("X{number}").into(), since: 0 };
    (0..count).map(|number| formulas.atom(Atom::Bit(name(number)))).collect()
}

fn contacts(sum: &Sum) -> usize {
    sum.iter().map(Vec::len).sum()
}

/// The formula of a sum.
fn again(formulas: &mut Formulas, sum: &Sum, of: &[Formula]) -> Formula {
    let products: Vec<Formula> = sum
        .iter()
        .map(|product| {
            let literals: Vec<Formula> = product
                .iter()
                .map(
                    |(atom, holds)| {
                        if *holds { of[*atom as usize] } else { formulas.not(of[*atom as usize]) }
                    },
                )
                .collect();
            formulas.and(literals)
        })
        .collect();
    formulas.or(products)
}

/// The rows of a table of four atoms in which a product holds, and how many contacts it has.
fn products() -> Vec<(u16, usize)> {
    let product = |number: u32| {
        let digits = [number % 3, number / 3 % 3, number / 9 % 3, number / 27];
        let asks = |row: u32| {
            let bits = digits.iter().enumerate();
            bits.into_iter().all(|(bit, digit)| *digit == 2 || row >> bit & 1 == *digit)
        };
        let rows = (0..16).filter(|row| asks(*row)).fold(0, |table, row| table | 1 << row);
        (rows, digits.iter().filter(|digit| **digit != 2).count())
    };
    (0..81).map(product).collect()
}

#[test]
fn functions_of_four_atoms_have_their_shortest_sums() {
    let mut formulas = Formulas::default();
    let of = atoms(&mut formulas, 4);
    let products = products();
    for table in (0..1usize << 16).step_by(1009) {
        let rows = (0..16).filter(|row| table >> row & 1 == 1);
        let sum: Sum = rows.map(|row| (0..4).map(|bit| (bit, row >> bit & 1 == 1)).collect()).collect();
        let formula = again(&mut formulas, &sum, &of);
        let minimal = sum_of_products(&mut formulas, formula).unwrap();
        let same = again(&mut formulas, &minimal, &of);
        assert_eq!(equal(&mut formulas, formula, same), Verdict::Equal);
        assert_eq!(
            contacts(&minimal),
            covering(table, table, &products, &mut HashMap::new()),
            "{table:016b}: {minimal:?}"
        );
    }
}

/// The fewest contacts of products that cover the rows `left` and hold in no row but those of `table`.
fn covering(
    left: usize,
    table: usize,
    products: &[(u16, usize)],
    known: &mut HashMap<usize, usize>,
) -> usize {
    if left == 0 {
        return 0;
    }
    if let Some(contacts) = known.get(&left) {
        return *contacts;
    }
    let first = left & left.wrapping_neg();
    let mut fewest = usize::MAX;
    for (rows, contacts) in products {
        let rows = usize::from(*rows);
        if rows & !table == 0 && rows & first != 0 {
            fewest = fewest.min(contacts + covering(left & !rows, table, products, known));
        }
    }
    known.insert(left, fewest);
    fewest
}

#[test]
fn with_many_atoms_it_is_still_equal_and_not_longer() {
    let mut formulas = Formulas::default();
    let of = atoms(&mut formulas, 12);
    let shared = of[0];
    let products: Vec<Formula> = of[1..].iter().map(|atom| formulas.and([shared, *atom])).collect();
    let mut twice = products.clone();
    twice.push(formulas.and([of[0], of[1], of[2]]));
    let formula = formulas.or(twice);
    let sum = sum_of_products(&mut formulas, formula).unwrap();
    let same = again(&mut formulas, &sum, &of);
    assert_eq!(equal(&mut formulas, formula, same), Verdict::Equal);
    assert_eq!(contacts(&sum), 22);
}

#[test]
fn a_sum_that_nobody_reads_is_not_made() {
    let mut formulas = Formulas::default();
    let of = atoms(&mut formulas, 14);
    let mut odd = Formulas::FALSE;
    for atom in of {
        let (not_odd, not_atom) = (formulas.not(odd), formulas.not(atom));
        let sides = [formulas.and([odd, not_atom]), formulas.and([not_odd, atom])];
        odd = formulas.or(sides);
    }
    assert_eq!(sum_of_products(&mut formulas, odd), None);
}
