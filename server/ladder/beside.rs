//! Figures beside a drawing that are no ladder: a plot, a table, a legend drawn with lines.

use super::glyph::Arms;
use super::grid::{Grid, WIDE};
use crate::text::{Diagnostic, Message, Span, TextEdit};

/// As many blank columns through all lines of a drawing keep what is behind them apart.
const GAP: usize = 3;

/// Blanks out what stands to the right of the drawing behind blank columns, is made of lines and words, and has no
/// element in it; says so once.
pub(super) fn take_beside(grid: &mut Grid, problems: &mut Vec<Diagnostic>) {
    if grid.is_ascii() {
        return;
    }
    let is_element = |c: char| matches!(c, '[' | ']' | '(' | ')' | '{' | '}');
    // Words beside a rail are remarks, which have a finding of their own.
    let is_strange = |c: char| !c.is_ascii() && c != WIDE && !c.is_alphanumeric() && !Arms::of(c).is_line();
    let rows: Vec<usize> = (0..grid.height()).collect();
    if !rows.iter().any(|row| grid.characters(*row).any(is_strange)) {
        return;
    }
    let drawn = |row: &&usize| (0..grid.width(**row)).any(|column| grid.arms(**row, column).is_upright());
    let drawn: Vec<usize> = rows.iter().filter(drawn).copied().collect();
    let width = drawn.iter().map(|row| grid.width(*row)).max().unwrap_or(0);
    let mut blank = vec![true; width];
    for row in &drawn {
        for (column, blank) in blank.iter_mut().enumerate() {
            *blank &= grid.at(*row, column) == ' ';
        }
    }
    let Some(left) = blank.iter().position(|blank| !blank) else { return };
    let mut gaps = blank[left..].windows(GAP).enumerate().filter(|(_, gap)| gap.iter().all(|blank| *blank));
    let behind = |at: usize| drawn.iter().flat_map(move |row| (at..width).map(move |column| (*row, column)));
    let found = gaps.find_map(|(at, _)| {
        let at = left + at + GAP;
        let cells = || behind(at).map(|(row, column)| grid.at(row, column));
        (cells().any(is_strange) && !cells().any(is_element)).then_some(at)
    });
    let Some(at) = found else { return };
    let lines = drawn.iter().filter_map(|row| {
        let content = |column: &usize| grid.at(*row, *column) != ' ';
        let start = (at..grid.width(*row)).find(content)?;
        let end = (start..grid.width(*row)).rev().find(content)? + 1;
        Some(grid.span(*row, start, end))
    });
    let lines: Vec<Span> = lines.collect();
    if let Some(first) = lines.first() {
        let problem = Diagnostic::new("stray-operand", *first, Message::new("stray-operand.beside"));
        let edits = lines.iter().map(|line| TextEdit::new(*line, "")).collect();
        problems.push(problem.fix(Message::new("stray-operand.remove-beside"), edits));
    }
    for row in drawn {
        grid.clear(row, at..usize::MAX);
    }
}
