//! A block of drawing lines as rows of displayed cells.

use super::glyph::{Arms, starts_ascii_word};
use super::lines::{Line, display_width, is_blank};
use crate::text::Span;
use std::ops::Range;

/// More rows than this in one block are not read.
pub(super) const MOST_ROWS: usize = 5_000;
/// More columns than this in one line are not read.
pub(super) const MOST_COLUMNS: usize = 10_000;

/// Rows of cells. Cells beyond the end of a row are blank.
#[derive(Debug, Default)]
pub(super) struct Grid {
    rows: Vec<Row>,
    /// Whether a row came with other characters than ASCII, or with comments or tabs.
    is_mixed: bool,
}

#[derive(Debug)]
struct Row {
    /// The line of the chunk, from 0.
    line: u32,
    /// One past the last byte of the line.
    end: u32,
    cells: Vec<Cell>,
    /// Groups of characters that it may have, such as [`WORDS`].
    groups: u8,
}

/// Letters, digits and signs with which words begin.
pub(super) const WORDS: u8 = 1;
/// Horizontal wire.
pub(super) const WIRES: u8 = 2;
/// Corners and branches.
pub(super) const JUNCTIONS: u8 = 4;
/// Signs with which boxes of LDmicro begin.
pub(super) const BOXES: u8 = 8;

/// The groups of the ASCII characters. Most searches are for what most rows do not have.
const GROUPS: [u8; 128] = {
    let mut groups = [0; 128];
    let mut character = 0;
    while character < 128 {
        let own = character as u8 as char;
        let arms = Arms::of(own);
        groups[character] = match own {
            _ if arms.is_horizontal() => WIRES,
            _ if arms.is_junction() => JUNCTIONS,
            _ if starts_ascii_word(own) => WORDS,
            '[' | '{' | '^' => BOXES,
            _ => 0,
        };
        character += 1;
    }
    groups
};

/// A displayed cell; the second cell of a wide character is a blank with the same bytes.
#[derive(Clone, Copy, Debug)]
struct Cell {
    character: char,
    start: u32,
    end: u32,
}

impl Grid {
    /// Adds a line as the next row, comments blanked out.
    pub(super) fn push(&mut self, line: &Line, number: u32, text: &str) {
        let cells = Vec::with_capacity(line.span.len());
        let mut row = Row { line: number, end: line.span.end, cells, groups: u8::MAX };
        let content = line.span.of(text);
        if line.comments.is_empty() && content.is_ascii() && !content.contains('\t') {
            row.groups = content.bytes().fold(0, |groups, byte| groups | GROUPS[usize::from(byte & 0x7F)]);
            row.cells.extend(content.bytes().enumerate().map(|(column, byte)| {
                let start = line.span.start + column as u32;
                let blank = matches!(byte, b'\t'..=b'\r');
                Cell { character: if blank { ' ' } else { char::from(byte) }, start, end: start + 1 }
            }));
            self.rows.push(row);
            return;
        }
        self.is_mixed = true;
        for (column, offset, character) in line.cells(text) {
            let length = text[offset..].chars().next().map_or(0, char::len_utf8);
            let (start, end) = (offset as u32, (offset + length) as u32);
            // What has no width, such as a combining accent, belongs to the cell before it.
            if let Some(before) = row.cells.last_mut()
                && before.end < start
            {
                before.end = start;
            }
            let shown = if is_blank(character) { ' ' } else { character };
            let width = match text[offset..].starts_with('\t') {
                true => 8 - column % 8,
                false => display_width(text[offset..].chars().next().unwrap_or(' ')),
            };
            row.cells.push(Cell { character: shown, start, end });
            // A wide letter goes on as a letter, so that a word is one run of cells.
            let rest = if shown == ' ' { ' ' } else { WIDE };
            row.cells.extend((1..width).map(|_| Cell { character: rest, start, end }));
        }
        if let Some(last) = row.cells.last_mut() {
            last.end = last.end.max(line.span.end.min(text.len() as u32));
        }
        self.rows.push(row);
    }

    /// Whether all characters are sure to be ASCII.
    pub(super) fn is_ascii(&self) -> bool {
        !self.is_mixed
    }

    /// Whether a row may have characters of these groups.
    pub(super) fn may_have(&self, row: usize, groups: u8) -> bool {
        self.rows.get(row).is_some_and(|row| row.groups & groups != 0)
    }

    /// Number of rows.
    pub(super) fn height(&self) -> usize {
        self.rows.len()
    }

    /// Number of cells in a row.
    pub(super) fn width(&self, row: usize) -> usize {
        self.rows.get(row).map_or(0, |row| row.cells.len())
    }

    /// The line of the chunk, from 0, that is `row`.
    pub(super) fn line(&self, row: usize) -> u32 {
        self.rows.get(row).map_or(0, |row| row.line)
    }

    /// The character of a cell, a blank outside the drawing.
    pub(super) fn at(&self, row: usize, column: usize) -> char {
        self.rows.get(row).and_then(|row| row.cells.get(column)).map_or(' ', |cell| cell.character)
    }

    /// The characters of a row.
    pub(super) fn characters(&self, row: usize) -> impl Iterator<Item = char> {
        self.rows.get(row).into_iter().flat_map(|row| &row.cells).map(|cell| cell.character)
    }

    /// The first column of a row from `from` on with a character that is wanted.
    pub(super) fn find(&self, row: usize, from: usize, is_wanted: impl Fn(char) -> bool) -> Option<usize> {
        let cells = self.rows.get(row)?.cells.get(from..)?;
        cells.iter().position(|cell| is_wanted(cell.character)).map(|column| from + column)
    }

    /// The lines that a cell's character draws.
    pub(super) fn arms(&self, row: usize, column: usize) -> Arms {
        Arms::of(self.at(row, column))
    }

    /// The bytes of the cells `first..last` of a row.
    pub(super) fn span(&self, row: usize, first: usize, last: usize) -> Span {
        let Some(row) = self.rows.get(row) else { return Span::default() };
        let start = row.cells.get(first).map_or(row.end, |cell| cell.start);
        let end =
            last.checked_sub(1).map_or(start, |last| row.cells.get(last).map_or(row.end, |cell| cell.end));
        Span { start, end: end.max(start) }
    }

    /// From the first to the last cell of a row that is not blank.
    pub(super) fn content(&self, row: usize) -> Option<Span> {
        let cells = &self.rows.get(row)?.cells;
        let first = cells.iter().position(|cell| cell.character != ' ')?;
        let last = cells.iter().rposition(|cell| cell.character != ' ')?;
        Some(self.span(row, first, last + 1))
    }

    /// Marks cells as taken by a function block.
    pub(super) fn take(&mut self, row: usize, columns: Range<usize>) {
        self.fill(row, columns, TAKEN);
    }

    /// Turns cells that have been read into blanks.
    pub(super) fn clear(&mut self, row: usize, columns: Range<usize>) {
        self.fill(row, columns, ' ');
    }

    /// Draws wire over names that stand in it.
    pub(super) fn draw_wire(&mut self, row: usize, columns: Range<usize>) {
        self.fill(row, columns, '-');
    }

    /// Draws wire over the negation circle in cell `circle`.
    pub(super) fn bridge(&mut self, row: usize, circle: Option<usize>) {
        if let Some(circle) = circle {
            self.fill(row, circle..circle + 1, '-');
        }
    }

    fn fill(&mut self, row: usize, columns: Range<usize>, character: char) {
        if let Some(row) = self.rows.get_mut(row) {
            row.groups |= if character == '-' { WIRES } else { 0 };
            for cell in row.cells.iter_mut().take(columns.end).skip(columns.start) {
                cell.character = character;
            }
        }
    }
}

/// The second cell of a wide character.
pub(super) const WIDE: char = '\u{1}';
/// A cell that belongs to a function block.
pub(super) const TAKEN: char = '\u{2}';
