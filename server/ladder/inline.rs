//! Names that stand in the wire, before or behind their element: `--- start --| |---`, `---| | start ---`.

use super::OperandPlace;
use super::content::Wants;
use super::glyph::{contact_mark, continues_word, starts_word};
use super::grid::{Grid, WIDE, WIRES, WORDS};
use super::scan::{Tokens, What};
use crate::target::Target;
use crate::text::{Span, Spanned};

/// A name in the wire.
#[derive(Clone, Copy, Debug)]
pub(super) struct InlineName {
    row: usize,
    span: Span,
}

/// Finds the names in the wires and draws wire over them. A row is taken only if each element in it has one such name
/// next to it, and none inside: then there is one reading.
pub(super) fn take_inline(grid: &mut Grid) -> Vec<InlineName> {
    let mut names = Vec::new();
    for row in 0..grid.height() {
        let Some(found) = inline_row(grid, row) else { continue };
        for (from, start, end, to) in found {
            names.push(InlineName { row, span: grid.span(row, start, end) });
            grid.draw_wire(row, from..to);
        }
    }
    names
}

/// The names of a row: from where the wire is to be drawn, first and one past the last column of the name, and to
/// where.
fn inline_row(grid: &Grid, row: usize) -> Option<Vec<(usize, usize, usize, usize)>> {
    let at = |column: usize| grid.at(row, column);
    let width = grid.width(row);
    // Most rows have no word or no wire.
    if !(grid.may_have(row, WORDS) && grid.may_have(row, WIRES)) {
        return None;
    }
    let mut found = Vec::new();
    let mut symbols: Vec<usize> = Vec::new();
    let mut column = 0;
    while column < width {
        if let Some(end) = bare_symbol(grid, row, column) {
            symbols.push(column);
            column = end;
            continue;
        }
        // A word inside brackets is an operand, and one behind a bar is no name in the wire.
        if matches!(at(column), '(' | '[' | '{' | '>' | '<') {
            return None;
        }
        if !starts_word(at(column)) {
            column += 1;
            continue;
        }
        let start = column;
        while column < width && (continues_word(at(column)) || at(column) == WIDE) {
            column += 1;
        }
        let gap = |at: char| at == ' ';
        let from = if start > 0 && gap(at(start - 1)) { start - 1 } else { start };
        let to = if gap(at(column)) { column + 1 } else { column };
        let wire = |column: usize| grid.arms(row, column).is_horizontal();
        let before = from > 0
            && (wire(from - 1)
                || symbols.last().is_some_and(|symbol| bare_symbol(grid, row, *symbol) == Some(from)));
        let after = wire(to) || bare_symbol(grid, row, to).is_some();
        let wired = (from > 0 && wire(from - 1)) || wire(to);
        if !before || !after || !wired {
            return None;
        }
        found.push((from, start, column, to));
    }
    // In a row of words and elements, the first two belong together, then the next two.
    let words = found.iter().map(|name| (name.0, true));
    let mut order: Vec<(usize, bool)> = words.chain(symbols.iter().map(|symbol| (*symbol, false))).collect();
    order.sort_unstable();
    let paired = order.chunks(2).all(|pair| matches!(pair, [(_, a), (_, b)] if a != b));
    (paired && !found.is_empty()).then_some(found)
}

/// One past the end of a contact or coil without a name inside that starts at a column: `| |`, `]/[`, `( )`, `(S)`.
fn bare_symbol(grid: &Grid, row: usize, column: usize) -> Option<usize> {
    let at = |column: usize| grid.at(row, column);
    let bar = |column: usize| {
        let arms = grid.arms(row, column);
        arms.is_vertical() || arms.is_left_tee() || arms.is_right_tee()
    };
    let closes = match at(column) {
        '(' => {
            let mark = matches!(at(column + 1), ' ' | '/' | 'S' | 'R' | 'L' | 'U' | 'P' | 'N');
            return (mark && at(column + 2) == ')').then_some(column + 3);
        }
        '[' => at(column + 2) == ']',
        ']' => at(column + 2) == '[',
        _ => bar(column) && bar(column + 2),
    };
    // The rail is no contact, however near the next bar is.
    let wired = column > 0 && at(column - 1) != ' ' || matches!(at(column + 3), '-' | '─');
    (closes && wired && contact_mark(at(column + 1)).is_some()).then_some(column + 3)
}

/// Gives the names in the wire to their elements.
pub(super) fn give_inline(names: &[InlineName], tokens: &mut Tokens, target: &Target, text: &str) {
    for row in names.chunk_by(|a, b| a.row == b.row) {
        let Some(line) = tokens.rows.get(row[0].row) else { continue };
        let numbers = line.iter().filter_map(|token| match token.what {
            What::Symbol(symbol) => Some(symbol),
            _ => None,
        });
        let symbols: Vec<usize> = numbers.collect();
        // The scanner may see other elements, such as contacts on a vertical wire; then nothing is certain.
        if symbols.len() != row.len() {
            continue;
        }
        for (name, symbol) in row.iter().zip(symbols) {
            let symbol = &mut tokens.symbols[symbol];
            if matches!(symbol.wants, Wants::Device | Wants::DeviceAndPreset) {
                let operand = target.read(name.span.of(text));
                symbol.element.operands = vec![Spanned::new(operand, name.span)];
                symbol.element.place = OperandPlace::Beside;
                symbol.wants = Wants::Nothing;
            }
        }
    }
}
