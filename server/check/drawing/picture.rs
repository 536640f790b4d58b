//! The displayed cells of a chunk, for looking around a finding and for drawing its fix.

use crate::text::{Span, TextEdit, cell_width};

/// The lines of a text as rows of cells, counted from 0 as in the ladder tree.
pub(super) struct Picture {
    rows: Vec<Row>,
}

struct Row {
    start: u32,
    /// One past the last byte before the line's end.
    end: u32,
    cells: Vec<Cell>,
}

/// A cell and the bytes of its character. The second cell of a wide character is `CONTINUED`.
#[derive(Clone, Copy)]
struct Cell {
    character: char,
    start: u32,
    end: u32,
}

const CONTINUED: char = '\u{1}';
const TAB_WIDTH: usize = 8;

/// A cell by row and column.
pub(super) type Place = (usize, usize);

/// A side of a cell.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Side {
    Left,
    Right,
    Up,
    Down,
}

impl Side {
    /// The neighbour of `place` on this side; nothing beyond the first row or column.
    pub(super) fn of(self, place: Place) -> Option<Place> {
        Some(match self {
            Side::Left => (place.0, place.1.checked_sub(1)?),
            Side::Right => (place.0, place.1 + 1),
            Side::Up => (place.0.checked_sub(1)?, place.1),
            Side::Down => (place.0 + 1, place.1),
        })
    }

    pub(super) fn is_horizontal(self) -> bool {
        matches!(self, Side::Left | Side::Right)
    }
}

impl Picture {
    pub(super) fn new(text: &str) -> Picture {
        let mut rows = Vec::new();
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let content = line.trim_end_matches(['\n', '\r']);
            let mut cells: Vec<Cell> = Vec::with_capacity(content.len());
            for (offset, character) in content.char_indices() {
                let first = (start + offset) as u32;
                let end = first + character.len_utf8() as u32;
                let width = match character {
                    '\t' => TAB_WIDTH - cells.len() % TAB_WIDTH,
                    _ => cell_width(character),
                };
                let shown = if character.is_whitespace() { ' ' } else { character };
                let rest = if shown == ' ' { ' ' } else { CONTINUED };
                for number in 0..width {
                    let character = if number == 0 { shown } else { rest };
                    cells.push(Cell { character, start: first, end });
                }
            }
            rows.push(Row { start: start as u32, end: (start + content.len()) as u32, cells });
            start += line.len();
        }
        Picture { rows }
    }

    /// The row of a byte.
    pub(super) fn row(&self, offset: u32) -> usize {
        self.rows.partition_point(|row| row.start <= offset).saturating_sub(1)
    }

    /// The cell of a byte.
    pub(super) fn place(&self, offset: u32) -> Place {
        let row = self.row(offset);
        let cells = self.rows.get(row).map_or(&[][..], |row| &row.cells);
        (row, cells.partition_point(|cell| cell.end <= offset))
    }

    /// The character in a cell, a blank outside of the text.
    pub(super) fn at(&self, place: Place) -> char {
        self.cell(place).map_or(' ', |cell| cell.character)
    }

    fn cell(&self, (row, column): Place) -> Option<&Cell> {
        self.rows.get(row)?.cells.get(column)
    }

    /// All cells that a span covers in its first row.
    pub(super) fn places(&self, span: Span) -> impl Iterator<Item = Place> + use<> {
        let (row, first) = self.place(span.start);
        let last = self.place(span.end.saturating_sub(1).max(span.start)).1;
        (first..=last).map(move |column| (row, column))
    }

    /// The first cell with something in it on the way from `place` to `side`, and the blank cells before it.
    /// Rows may be as long as they like; up and down it looks at most four cells far, which is a row of names and
    /// two descriptions.
    pub(super) fn look(&self, place: Place, side: Side) -> Option<(Place, Vec<Place>)> {
        const FARTHEST: usize = 4;
        let mut blanks = Vec::new();
        let mut next = side.of(place)?;
        loop {
            if self.at(next) != ' ' {
                return Some((next, blanks));
            }
            let outside = match side {
                Side::Right => next.1 >= self.rows.get(next.0)?.cells.len(),
                Side::Up | Side::Down => blanks.len() >= FARTHEST || next.0 >= self.rows.len(),
                Side::Left => false,
            };
            if outside {
                return None;
            }
            blanks.push(next);
            next = side.of(next)?;
        }
    }

    /// The edits that put `marks` into their cells; nothing if a cell is part of a tab or of a wide character.
    pub(super) fn draw(&self, marks: &[(Place, char)]) -> Option<Vec<TextEdit>> {
        let mut marks: Vec<(Place, char)> = marks.to_vec();
        marks.sort_unstable();
        marks.dedup_by_key(|(place, _)| *place);
        let mut edits: Vec<TextEdit> = Vec::new();
        for (place, character) in marks {
            let row = self.rows.get(place.0)?;
            let Some(cell) = row.cells.get(place.1) else {
                edits.push(append(row, &edits, place, character));
                continue;
            };
            let shared = |other: Option<&Cell>| other.is_some_and(|other| other.start == cell.start);
            if shared(row.cells.get(place.1 + 1)) || place.1 > 0 && shared(row.cells.get(place.1 - 1)) {
                return None;
            }
            let span = Span { start: cell.start, end: cell.end };
            match edits.last_mut().filter(|last| last.span.end == span.start) {
                Some(last) => {
                    last.span.end = span.end;
                    last.text.push(character);
                }
                None => edits.push(TextEdit::new(span, character)),
            }
        }
        Some(edits)
    }
}

/// Puts a character behind the end of a row, after what earlier edits put there.
fn append(row: &Row, edits: &[TextEdit], place: Place, character: char) -> TextEdit {
    let behind = edits.iter().filter(|edit| edit.span == Span { start: row.end, end: row.end });
    let added: usize = behind.map(|edit| edit.text.chars().count()).sum();
    let blanks = place.1.saturating_sub(row.cells.len() + added);
    TextEdit::new(Span { start: row.end, end: row.end }, format!("{}{character}", " ".repeat(blanks)))
}

/// Whether a character is a piece of a horizontal wire.
pub(super) fn is_wire(character: char) -> bool {
    matches!(character, '-' | '_' | '=' | '─' | '━' | '═')
}

/// Whether a character is a bar: it runs up and down only.
pub(super) fn is_bar(character: char) -> bool {
    matches!(character, '|' | '!' | '│' | '┃' | '║')
}

/// Whether a character is a junction or a corner.
pub(super) fn is_junction(character: char) -> bool {
    matches!(character, '+' | '*' | '┌'..='╋' | '╒'..='╬')
}

/// Whether a drawing with this character in it is made of box drawing characters.
pub(super) fn is_box_drawing(character: char) -> bool {
    matches!(character, '─'..='╿')
}
