//! The names that a misspelt word may have meant.

use super::{Function, FunctionBlock, Operator};
use crate::target::instructions::{MOST_LETTERS, distance_within};
use std::cmp::Reverse;

/// What other dialects call the operators.
const ELSEWHERE: &[(&str, &str)] = &[
    ("LDI", "LDN"),
    ("LDNOT", "LDN"),
    ("ANI", "ANDN"),
    ("ANDI", "ANDN"),
    ("ANDNOT", "ANDN"),
    ("ORI", "ORN"),
    ("ORNOT", "ORN"),
    ("OUT", "ST"),
    ("STO", "ST"),
    ("OUTI", "STN"),
    ("SET", "S"),
    ("RST", "R"),
    ("RESET", "R"),
    ("INV", "NOT"),
    ("CALL", "CAL"),
    ("CJ", "JMPC"),
    ("JMPNC", "JMPCN"),
    ("JPC", "JMPC"),
    ("JP", "JMP"),
    ("GOTO", "JMP"),
    ("RETURN", "RET"),
    ("MOV", "MOVE"),
];

/// At most three of `names` that are near to `word`, letter case aside, best first; none if nothing is near.
///
/// ```
/// use rungwise::target::iec::nearest;
/// assert_eq!(nearest("TONN", ["TON", "TOF", "CTU"].into_iter()), ["TON"]);
/// let long = "Conveyor_of_the_second_hall_motor_is_running";
/// assert_eq!(nearest(&long.replace("second", "secnod"), [long].into_iter()), [long]);
/// ```
pub fn nearest<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Vec<String> {
    if word.is_empty() || word.len() > MOST_LETTERS {
        return Vec::new();
    }
    let word = word.to_ascii_uppercase();
    let allowed = if word.len() <= 5 { 1 } else { 2 };
    let mut near: Vec<(usize, Reverse<usize>, &str)> = names
        .filter(|name| name.len().abs_diff(word.len()) <= allowed && name.len() > 1)
        .filter_map(|name| {
            let upper = name.to_ascii_uppercase();
            let distance = distance_within(word.as_bytes(), upper.as_bytes(), allowed)?;
            let alike = word.bytes().zip(upper.bytes()).take_while(|(left, right)| left == right).count();
            (distance < word.len()).then_some((distance, Reverse(alike), name))
        })
        .collect();
    near.sort();
    near.dedup_by(|left, right| left.2 == right.2);
    near.into_iter().take(3).map(|(_, _, name)| name.to_string()).collect()
}

/// At most three operators, standard functions or functions of the program, called `declared`, that are near to
/// `word`.
///
/// ```
/// use rungwise::target::iec::suggestions;
/// assert_eq!(suggestions("OUT", [].into_iter()), ["ST"]);
/// assert_eq!(suggestions("LIMTI", [].into_iter()).first().map(String::as_str), Some("LIMIT"));
/// ```
pub fn suggestions<'a>(word: &str, declared: impl Iterator<Item = &'a str>) -> Vec<String> {
    let elsewhere = ELSEWHERE.iter().find(|(other, _)| other.eq_ignore_ascii_case(word));
    if let Some((_, ours)) = elsewhere {
        return vec![ours.to_string()];
    }
    let names = Operator::all_words();
    // Conversions are near to each other by the dozen; they are looked for where the word looks like one.
    let conversions =
        word.to_ascii_uppercase().contains("TO_") || word.to_ascii_uppercase().contains("TRUNC");
    let functions = Function::families().map(|function| function.name);
    let conversions = Function::all().filter(|_| conversions).map(|function| function.name);
    let inputs = FunctionBlock::all_input_operators().iter().copied();
    let own = names.chain(functions).chain(conversions).chain(inputs);
    nearest(word, own.map(|name| -> &'a str { name }).chain(declared))
}
