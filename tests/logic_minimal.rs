//! The shortest sums of products.

use rungwise::logic::{Atom, Formula, Formulas, Moment, Sum, Verdict, equal, sum_of_products};

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

#[test]
fn every_function_of_three_atoms_has_its_shortest_sum() {
    let mut formulas = Formulas::default();
    let of = atoms(&mut formulas, 3);
    let products: Vec<(usize, u8)> = (0..27u32)
        .map(|number| {
            let digits = [number % 3, number / 3 % 3, number / 9];
            let rows = (0..8u8).filter(|row| {
                digits
                    .iter()
                    .enumerate()
                    .all(|(bit, digit)| *digit == 2 || u32::from(row >> bit & 1) == *digit)
            });
            let asked = digits.iter().filter(|digit| **digit != 2).count();
            (asked, rows.fold(0, |table, row| table | 1 << row))
        })
        .collect();
    // The fewest contacts for each table of values, by joining products until nothing gets shorter.
    let mut fewest = [usize::MAX; 256];
    fewest[0] = 0;
    for _ in 0..8 {
        for table in 0..256 {
            let own = fewest[table];
            for (asked, rows) in products.iter().filter(|_| own < usize::MAX) {
                let joined = table | *rows as usize;
                fewest[joined] = fewest[joined].min(own + asked);
            }
        }
    }
    for table in 0..256usize {
        let rows = (0..8).filter(|row| table >> row & 1 == 1);
        let sum: Sum = rows.map(|row| (0..3).map(|bit| (bit, row >> bit & 1 == 1)).collect()).collect();
        let formula = again(&mut formulas, &sum, &of);
        let minimal = sum_of_products(&mut formulas, formula).unwrap();
        let same = again(&mut formulas, &minimal, &of);
        assert_eq!(equal(&mut formulas, formula, same), Verdict::Equal);
        assert_eq!(contacts(&minimal), fewest[table], "{table:08b}: {minimal:?}");
    }
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
