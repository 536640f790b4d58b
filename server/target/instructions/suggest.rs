//! The mnemonics that an unknown word may have meant.

use super::FORMS;
use crate::target::{Model, Opcode};
use std::cmp::Reverse;

/// What other makers and IEC 61131-3 call the basic instructions.
const ELSEWHERE: &[(&str, &str)] = &[
    ("LDN", "LDI"),
    ("LDNOT", "LDI"),
    ("ANDN", "ANI"),
    ("ANDI", "ANI"),
    ("ANDNOT", "ANI"),
    ("ORN", "ORI"),
    ("ORNOT", "ORI"),
    ("ANDLD", "ANB"),
    ("ANDB", "ANB"),
    ("ORLD", "ORB"),
    ("NOT", "INV"),
    ("ST", "OUT"),
    ("S", "SET"),
    ("R", "RST"),
    ("RESET", "RST"),
    ("JMP", "CJ"),
    ("CAL", "CALL"),
];

/// No mnemonic is longer.
const LONGEST: usize = 12;

/// At most three mnemonics that `model` has and that are near to `word`, best first; none if nothing is near.
///
/// ```
/// use rungwise::target::{Model, instructions::suggestions};
/// assert_eq!(suggestions("mvo", Model::Fx2n).first().map(String::as_str), Some("MOV"));
/// assert_eq!(suggestions("ANDN", Model::Fx2n).first().map(String::as_str), Some("ANI"));
/// ```
pub fn suggestions(word: &str, model: Model) -> Vec<String> {
    if word.is_empty() || word.len() > LONGEST || !word.is_ascii() {
        return Vec::new();
    }
    let word = word.to_ascii_uppercase();
    let allowed = if word.len() <= 3 { 1 } else { 2 };
    let mut near: Vec<(usize, Reverse<usize>, String)> = FORMS
        .iter()
        .filter(|(_, form)| form.is_on(model) && form.instruction.opcode != Opcode::Itself)
        .filter_map(|(key, form)| {
            let letters = key.to_be_bytes();
            let name = &letters[key.leading_zeros() as usize / 8..];
            let distance = distance_within(word.as_bytes(), name, allowed)?;
            let alike = word.bytes().zip(name.iter()).take_while(|(left, right)| left == *right).count();
            Some((distance, Reverse(alike), form.mnemonic()))
        })
        .collect();
    near.sort();
    let elsewhere = ELSEWHERE.iter().filter(|(other, _)| *other == word).map(|(_, ours)| ours.to_string());
    let mut found: Vec<String> = elsewhere.collect();
    for (_, _, mnemonic) in near {
        if !found.contains(&mnemonic) {
            found.push(mnemonic);
        }
    }
    found.truncate(3);
    found
}

/// No longer words are compared.
pub(in crate::target) const MOST_LETTERS: usize = 96;

/// How many letters must be inserted, left out, replaced or swapped with their neighbour to get from one word to the
/// other (optimal string alignment); `None` if these are more than `allowed`. A file full of unknown words asks this
/// millions of times, so what is hopeless ends early and nothing is allocated.
pub(in crate::target) fn distance_within(left: &[u8], right: &[u8], allowed: usize) -> Option<usize> {
    if left.len().abs_diff(right.len()) > allowed || right.len() > MOST_LETTERS {
        return None;
    }
    let mut before_last = [0; MOST_LETTERS + 1];
    let mut last: [usize; MOST_LETTERS + 1] = std::array::from_fn(|column| column);
    for (row, &letter) in left.iter().enumerate() {
        let mut line = [row + 1; MOST_LETTERS + 1];
        for (column, &other) in right.iter().enumerate() {
            let replaced = last[column] + usize::from(letter != other);
            let mut best = replaced.min(last[column + 1] + 1).min(line[column] + 1);
            let swapped = row > 0 && column > 0 && left[row - 1] == other && letter == right[column - 1];
            if swapped {
                best = best.min(before_last[column - 1] + 1);
            }
            line[column + 1] = best;
        }
        // A swap goes back two rows and adds one, so no way on is shorter than the shorter of both.
        let so_far = line[..=right.len()].iter().chain(&last[..=right.len()]).min();
        if so_far.is_some_and(|least| *least > allowed) {
            return None;
        }
        (before_last, last) = (last, line);
    }
    Some(last[right.len()]).filter(|distance| *distance <= allowed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        for (left, right, expected) in [
            ("", "", 0),
            ("", "MOV", 3),
            ("MOV", "MOV", 0),
            ("MVO", "MOV", 1),
            ("MOVE", "MOV", 1),
            ("LD", "OUT", 3),
            ("CA", "ABC", 3),
            ("BADC", "ABCD", 2),
        ] {
            for (one, other) in [(left, right), (right, left)] {
                let within = |allowed| distance_within(one.as_bytes(), other.as_bytes(), allowed);
                for allowed in 0..5 {
                    let known = (expected <= allowed).then_some(expected);
                    assert_eq!(within(allowed), known, "{one} {other} {allowed}");
                }
            }
        }
    }

    #[test]
    fn nearest_first_and_only_of_the_model() {
        assert_eq!(suggestions("MOVE", Model::Fx2n)[0], "MOV");
        assert_eq!(suggestions("otu", Model::Fx1s), ["OUT"]);
        assert!(suggestions("MEPP", Model::Fx3u).contains(&"MEP".to_string()));
        assert!(!suggestions("MEPP", Model::Fx2n).contains(&"MEP".to_string()));
        assert_eq!(suggestions("ANDN", Model::Fx2n)[0], "ANI");
        for nothing in ["", "qqqqqq", "ÄÖ", "AVERYLONGWORDINDEED"] {
            assert_eq!(suggestions(nothing, Model::Fx2n), Vec::<String>::new(), "{nothing}");
        }
        assert!(suggestions("D", Model::Fx3u).len() <= 3);
    }
}
