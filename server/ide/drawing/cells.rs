//! Rows of a rung as displayed cells: making room in all rows at once, and taking it back where there is slack.

use crate::ladder::Strokes;
use crate::text::cell_width;

/// The second cell of a wide character.
const WIDE: char = '\u{1}';

/// One row, a character for each displayed cell.
pub(super) type Row = Vec<char>;

/// The cells of a line without its line end; nothing if columns cannot be told from it alone (tabs, combining marks).
pub(super) fn row(line: &str) -> Option<Row> {
    let mut cells = Row::with_capacity(line.len());
    for character in line.chars() {
        match cell_width(character) {
            _ if character == '\t' || character == WIDE => return None,
            0 => return None,
            width => {
                cells.push(character);
                cells.extend((1..width).map(|_| WIDE));
            }
        }
    }
    Some(cells)
}

/// The text of some cells.
pub(super) fn text(cells: &[char]) -> String {
    cells.iter().filter(|character| **character != WIDE).collect()
}

/// A horizontal wire and nothing else.
pub(super) fn is_wire(character: char) -> bool {
    let Strokes { left, right, up, down } = Strokes::of(character);
    left && right && !up && !down
}

/// A bar, corner or junction.
pub(super) fn is_upright(character: char) -> bool {
    let Strokes { up, down, .. } = Strokes::of(character);
    up || down
}

/// Part of a name, a number or a mnemonic.
pub(super) fn is_word(character: char) -> bool {
    let signs = ['.', '%', '#', '$', '@', '?', '\'', '"', WIDE];
    character.is_alphanumeric() || signs.contains(&character)
}

fn at(row: &[char], column: usize) -> char {
    row.get(column).copied().unwrap_or(' ')
}

/// Where cells can be put into a row at or near a column without tearing a word or an element.
fn seam(row: &[char], column: usize) -> usize {
    let (start, end) = piece_around(row, column);
    // What belongs to the left of the column stays there.
    if start == column || start + end < 2 * column { end.max(column) } else { start }
}

/// Whether a column lies within a word or an element.
pub(super) fn is_within(row: &[char], column: usize) -> bool {
    let (start, end) = piece_around(row, column);
    start < end
}

/// The word or element that covers the cells on both sides of a column; empty if none does.
fn piece_around(row: &[char], column: usize) -> (usize, usize) {
    let none = (column, column);
    if column == 0 || column >= row.len() {
        return none;
    }
    if is_word(row[column - 1]) && is_word(row[column]) {
        let start = (0..column).rev().take_while(|at| is_word(row[*at])).last().unwrap_or(column);
        let end = (column..row.len()).find(|at| !is_word(row[*at])).unwrap_or(row.len());
        return (start, end);
    }
    let open = (0..column).rev().find(|at| matches!(row[*at], '[' | ']' | '(' | ')' | '{' | '}'));
    if let Some(open) = open.filter(|open| matches!(row[*open], '[' | '(' | '{')) {
        let close = (column..row.len()).find(|at| matches!(row[*at], ']' | ')' | '}'));
        return close.map_or(none, |close| (open, close + 1));
    }
    // A contact of three cells with a wire or a corner outside.
    let contact = |start: usize| {
        let bars = is_upright(at(row, start)) && is_upright(at(row, start + 2));
        let inside = at(row, start + 1);
        bars && (matches!(inside, ' ' | '/' | '\\' | '↑' | '↓') || inside.is_alphabetic())
            && start > 0
            && is_wire(at(row, start - 1))
    };
    let start =
        [column.checked_sub(1), column.checked_sub(2)].into_iter().flatten().find(|start| contact(*start));
    start.map_or(none, |start| (start, start + 3))
}

/// Puts `count` cells into a row at a column: wire where one runs through, else blanks.
pub(super) fn insert(row: &mut Row, column: usize, count: usize) {
    if column >= row.len() {
        return;
    }
    let column = seam(row, column);
    let (before, behind) = (if column == 0 { ' ' } else { row[column - 1] }, at(row, column));
    let leads = |character: char| {
        let Strokes { left, right, .. } = Strokes::of(character);
        left || right
    };
    let fill = match (before, behind) {
        _ if is_wire(before) && behind != ' ' => before,
        _ if is_wire(behind) && before != ' ' => behind,
        _ if leads(before) && leads(behind) => {
            if before.is_ascii() {
                '-'
            } else {
                '─'
            }
        }
        _ => ' ',
    };
    row.splice(column..column, std::iter::repeat_n(fill, count));
}

/// Whether `count` cells at a column can be taken out of a row: all wire or all blank, with one of it left beside.
fn is_slack(row: &[char], column: usize, count: usize) -> bool {
    if column >= row.len() {
        return true;
    }
    let cells = &row[column..row.len().min(column + count)];
    let beside = [column.checked_sub(1).map(|before| row[before]), row.get(column + count).copied()];
    let like = |wanted: fn(char) -> bool| {
        cells.iter().all(|cell| wanted(*cell)) && beside.iter().flatten().any(|cell| wanted(*cell))
    };
    // At the end of a line nothing is drawn behind a blank.
    like(is_wire)
        || like(|character| character == ' ')
        || cells.iter().all(|cell| *cell == ' ') && beside[1].is_none()
}

/// The first column from `from` on at which `count` cells can be taken out of all rows.
pub(super) fn slack(rows: &[Row], from: usize, count: usize) -> Option<usize> {
    let widest = rows.iter().map(Vec::len).max().unwrap_or(0);
    (from..widest).find(|column| rows.iter().all(|row| is_slack(row, *column, count)))
}

/// Takes cells out of a row.
pub(super) fn remove(row: &mut Row, column: usize, count: usize) {
    if column < row.len() {
        let end = row.len().min(column + count);
        row.drain(column..end);
    }
}
