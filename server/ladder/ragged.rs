//! Tolerance for vertical wires that miss their junction by a column or two, the norm in drawings by hand.

use super::glyph::Arms;
use super::grid::Grid;
use super::scan::{Token, Tokens, What};
use super::uprights::Uprights;
use crate::text::{Diagnostic, Message, Span};

/// How many columns a bar may be beside its junction.
const ASIDE: usize = 2;

/// The message about a wire that can be read in two ways.
pub(super) const TWO_READINGS: &str = "ragged-drawing.two";

const JUNCTION: &str = "ragged-drawing.junction";

/// An end of a vertical wire that is a bare bar.
#[derive(Clone, Copy)]
struct End {
    row: usize,
    token: Token,
    /// Its number in the row.
    number: usize,
    /// Whether it is the upper end.
    top: bool,
}

/// Joins each vertical wire that ends in a bar beside a junction with that junction, if it is the only one near, and
/// each that is interrupted by a name only; says so with `ragged-drawing`. With two junctions near it asks.
pub(super) fn mend(
    uprights: &mut Uprights,
    grid: &Grid,
    tokens: &Tokens,
    left: usize,
    problems: &mut Vec<Diagnostic>,
) {
    for end in bare_ends(uprights, tokens, left) {
        let Some(row) = (if end.top { end.row.checked_sub(1) } else { Some(end.row + 1) }) else { continue };
        let candidates = candidates(uprights, tokens, &end, row);
        let span = |row: usize, token: &Token| grid.span(row, token.start, token.end);
        let own = span(end.row, &end.token);
        match candidates[..] {
            [] => {
                let Some((upright, far, token)) = behind_name(uprights, tokens, &end, row) else { continue };
                let message = Message::new("ragged-drawing.name");
                problems.push(related(message, own, &[span(far, &token)]));
                join(uprights, &end, upright);
            }
            [(upright, token)] => {
                let junction = span(row, &token);
                // A wire in one row that misses its junctions at both ends is one finding.
                let message = Message::new("ragged-drawing.beside");
                match problems.iter_mut().find(|other| other.span == own && other.message == message) {
                    Some(other) => *other = other.clone().related(junction, Message::new(JUNCTION)),
                    None => problems.push(related(message, own, &[junction])),
                }
                join(uprights, &end, upright);
            }
            _ => {
                let spans: Vec<Span> = candidates.iter().map(|(_, token)| span(row, token)).collect();
                problems.push(related(Message::new(TWO_READINGS), own, &spans));
            }
        }
    }
}

fn related(message: Message, span: Span, junctions: &[Span]) -> Diagnostic {
    let problem = Diagnostic::new("ragged-drawing", span, message);
    junctions.iter().fold(problem, |problem, span| problem.related(*span, Message::new(JUNCTION)))
}

fn join(uprights: &mut Uprights, end: &End, other: usize) {
    // Earlier joints may have moved the end into another wire.
    match uprights.of(end.row, end.number).map(|(own, ..)| own) {
        Some(own) if own == other => {}
        Some(own) if end.top => uprights.append(other, own),
        Some(own) => uprights.append(own, other),
        None => {}
    }
}

/// The bars at which vertical wires end without touching anything; pieces of rails are left alone.
fn bare_ends(uprights: &Uprights, tokens: &Tokens, left: usize) -> Vec<End> {
    let mut ends = Vec::new();
    for found in &uprights.all {
        let (Some(first), Some(last)) = (found.cells.first(), found.cells.last()) else { continue };
        for (cell, top) in [(first, true), (last, false)] {
            let line = &tokens.rows[cell.row];
            let token = line[cell.token];
            let before = cell.token.checked_sub(1).and_then(|before| line.get(before));
            let after = line.get(cell.token + 1);
            let touches = before.is_some_and(|before| before.is_drawn() && before.end == token.start)
                || after.is_some_and(|after| after.is_drawn() && after.start == token.end);
            let bare = matches!(token.what, What::Upright(arms) if arms.is_vertical());
            if bare && !touches && token.start > left {
                ends.push(End { row: cell.row, token, number: cell.token, top });
            }
        }
    }
    ends
}

/// The junctions of `row` near the end that run towards it and meet nothing there.
fn candidates(uprights: &Uprights, tokens: &Tokens, end: &End, row: usize) -> Vec<(usize, Token)> {
    let line = tokens.rows.get(row).map_or(&[][..], |line| line);
    let from = line.partition_point(|token| token.end + ASIDE <= end.token.start);
    let near = line[from..].iter().enumerate().take_while(|(_, token)| token.start < end.token.end + ASIDE);
    // The last bar of a line below the last corner of the line above is a right rail that is not straight.
    let last =
        |row: usize, token: &Token| tokens.extent(row).drawn.is_some_and(|(_, last)| last == token.start);
    near.filter(|(_, token)| !(last(row, token) && last(end.row, &end.token)))
        .filter_map(|(number, token)| {
            let (upright, free) = free_towards(uprights, token, row, from + number, end)?;
            (free && matches!(token.what, What::Upright(arms) if arms.is_junction()))
                .then_some((upright, *token))
        })
        .collect()
}

/// The upright in the same column behind a word that covers the cells after the end.
fn behind_name(uprights: &Uprights, tokens: &Tokens, end: &End, row: usize) -> Option<(usize, usize, Token)> {
    let columns = end.token.start..end.token.end;
    let (_, over) = tokens.over(row, columns.clone())?;
    if over.what != What::Word {
        return None;
    }
    let far = if end.top { row.checked_sub(1)? } else { row + 1 };
    let (number, token) = tokens.over(far, columns)?;
    let (upright, free) = free_towards(uprights, token, far, number, end)?;
    free.then_some((upright, far, *token))
}

/// The upright of a token that runs towards `end`, and whether it ends there.
fn free_towards(
    uprights: &Uprights,
    token: &Token,
    row: usize,
    number: usize,
    end: &End,
) -> Option<(usize, bool)> {
    let What::Upright(arms) = token.what else { return None };
    let (upright, found, _) = uprights.of(row, number)?;
    let edge = if end.top { found.cells.last() } else { found.cells.first() };
    let towards = if end.top { Arms::down(arms) } else { Arms::up(arms) };
    Some((upright, towards && edge.is_some_and(|cell| cell.row == row)))
}
