//! Cutting a text into the pieces that chunks are made of.

use super::Notation;
use super::both::both;
use crate::il::{fx, iec};
use crate::ladder;

/// A text of so many bytes is cut by two threads.
const WORTH_A_THREAD: usize = 1 << 20;

/// So much of the second half is cut with the first one, to find where the two agree: many pieces.
const OVERLAP: usize = 1 << 14;

/// Ends of the pieces of `text`, which starts at a boundary.
pub(super) fn split(text: &str, notation: Notation) -> Vec<usize> {
    let halves = text.len() >= WORTH_A_THREAD;
    let halves = halves.then(|| in_halves(text, notation, text.len() / 2, OVERLAP)).flatten();
    halves.unwrap_or_else(|| at_once(text, notation))
}

fn at_once(text: &str, notation: Notation) -> Vec<usize> {
    match notation {
        Notation::Ladder => ladder::split(text),
        Notation::FxIl => fx::split(text),
        Notation::IecIl => iec::split(text),
    }
}

/// The same ends, found from the start and from a line behind `middle` at the same time; `None` if the two do not come
/// to agree within `overlap` bytes behind the middle, as where a comment begins before and ends behind them.
///
/// The line may lie inside of a piece, so the first boundaries behind it may be wrong. But no boundary depends on more
/// than the text from the boundary before it to the end of the piece after it: where a piece is the same for both, all
/// that follows is as if it had been cut from the start.
fn in_halves(text: &str, notation: Notation, middle: usize, overlap: usize) -> Option<Vec<usize>> {
    let line_behind = |offset: usize| {
        let newline = text.as_bytes().get(offset..)?.iter().position(|byte| *byte == b'\n')?;
        Some(offset + newline + 1)
    };
    let middle = line_behind(middle)?;
    let (head, tail) = (text.get(..line_behind(middle + overlap)?)?, text.get(middle..)?);
    let (mut ends, behind) =
        both(text.len() >= WORTH_A_THREAD, || at_once(head, notation), || at_once(tail, notation));
    // The last end is that of the portion, and the one before it was set without the text behind.
    ends.truncate(ends.len().saturating_sub(2));
    let first = ends.partition_point(|end| *end <= middle);
    let same = |number: &usize| {
        let start = behind.binary_search(&(ends[number - 1].checked_sub(middle)?)).ok()?;
        (behind.get(start + 1) == Some(&(ends[*number] - middle))).then_some(start + 1)
    };
    let (number, place) = (first + 1..ends.len()).find_map(|number| Some((number, same(&number)?)))?;
    ends.truncate(number + 1);
    ends.extend(behind[place + 1..].iter().map(|end| end + middle));
    Some(ends)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Lines that open, close, begin and go on with pieces of each language.
    const LINES: [(Notation, &[&str]); 3] = [
        (
            Notation::FxIl,
            &[
                "LD X0",
                "OR M1",
                "ANB",
                "OUT Y0 ; (*",
                "OUT Y1",
                "(* note",
                "END *)",
                "P1",
                "END",
                "",
                "LD \"(*",
            ],
        ),
        (
            Notation::IecIl,
            &["PROGRAM a", "VAR", "b : BOOL;", "END_VAR", "LD b", "(* c", "d *)", "ST b", "END_PROGRAM", ""],
        ),
        (
            Notation::Ladder,
            &[
                "NETWORK 1",
                "|  X0     Y0 |",
                "+--| |---( )-+",
                "|  |         |",
                "(* c",
                "d *)",
                "",
                "VAR",
                "END_VAR",
            ],
        ),
    ];

    proptest! {
        #[test]
        fn halves_are_cut_as_the_whole(language in 0..3usize, lines in prop::collection::vec(0..11usize, 1..80)) {
            let (notation, words) = LINES[language];
            let text: String = lines.iter().map(|line| format!("{}\n", words[line % words.len()])).collect();
            let whole = at_once(&text, notation);
            for middle in 0..text.len() {
                for overlap in [20, 60, 200] {
                    let halves = in_halves(&text, notation, middle, overlap);
                    prop_assert_eq!(halves.as_ref().unwrap_or(&whole), &whole, "{} {}\n{}", middle, overlap, text);
                }
            }
        }
    }

    #[test]
    fn rungs_are_cut_in_halves() {
        let text = "LD X0\nOR M1\nOUT Y0\n".repeat(40);
        assert_eq!(in_halves(&text, Notation::FxIl, 300, 100), Some(at_once(&text, Notation::FxIl)));
    }
}
