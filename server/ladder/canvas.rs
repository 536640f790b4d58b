//! A grid of cells in which wires are arms towards their neighbours, turned into characters at the end.

use crate::text::cell_width;

const LEFT: u8 = 1;
const RIGHT: u8 = 2;
const UP: u8 = 4;
const DOWN: u8 = 8;
const HORIZONTAL: u8 = LEFT | RIGHT;
const VERTICAL: u8 = UP | DOWN;

/// The grid of one drawing.
#[derive(Debug)]
pub(super) struct Canvas {
    cells: Vec<Vec<Cell>>,
    unicode: bool,
    whole: bool,
}

/// One displayed cell.
#[derive(Clone, Copy, Default, PartialEq, Debug)]
struct Cell {
    /// Arms of a wire.
    arms: u8,
    /// Arms that a vertical wire has claimed: no other line may add to them.
    claimed: bool,
    /// A character of a symbol or word.
    character: Option<char>,
    /// The right half of a wide character.
    half: bool,
}

impl Canvas {
    /// A blank canvas.
    pub fn new(lines: usize, width: usize, unicode: bool) -> Canvas {
        Canvas { cells: vec![vec![Cell::default(); width]; lines], unicode, whole: true }
    }

    /// Whether no two parts have claimed the same cell.
    pub fn is_whole(&self) -> bool {
        self.whole
    }

    /// The left rail in column 0 and the right rail in column `right`.
    pub fn rails(&mut self, right: usize) {
        for line in &mut self.cells {
            for column in [0, right] {
                line[column].arms |= VERTICAL;
                line[column].claimed = true;
            }
        }
    }

    /// A wire leaves the left rail.
    pub fn join_left_rail(&mut self, line: usize) {
        self.cells[line][0].arms |= RIGHT;
    }

    /// A wire ends at the right rail.
    pub fn join_right_rail(&mut self, line: usize, column: usize) {
        self.cells[line][column].arms |= LEFT;
    }

    /// A cell of a vertical wire with arms to the left, right, up and down.
    pub fn vertical(&mut self, line: usize, column: usize, arms: (bool, bool, bool, bool)) {
        let cell = &mut self.cells[line][column];
        for (arm, bit) in [(arms.0, LEFT), (arms.1, RIGHT), (arms.2, UP), (arms.3, DOWN)] {
            cell.arms |= if arm { bit } else { 0 };
        }
        cell.claimed = true;
    }

    /// A horizontal wire over the cells `from..to`.
    pub fn horizontal(&mut self, line: usize, from: usize, to: usize) {
        for column in from..to {
            let cell = &mut self.cells[line][column];
            // A vertical wire that this line meets has an arm to it; one that it meets not would be a crossing.
            self.whole &= cell.character.is_none() && (!cell.claimed || cell.arms & HORIZONTAL != 0);
            if !cell.claimed {
                cell.arms |= HORIZONTAL;
            }
        }
    }

    /// The border of a box between two corners.
    pub fn frame(&mut self, (top, left): (usize, usize), (bottom, right): (usize, usize)) {
        for line in top..=bottom {
            for column in left..=right {
                let (edge, side) = (line == top || line == bottom, column == left || column == right);
                let arms = match (edge, side) {
                    (true, true) => {
                        (if line == top { DOWN } else { UP }) | (if column == left { RIGHT } else { LEFT })
                    }
                    (true, false) => HORIZONTAL,
                    (false, true) => VERTICAL,
                    (false, false) => continue,
                };
                let cell = &mut self.cells[line][column];
                self.whole &= cell.arms == 0 && cell.character.is_none();
                *cell = Cell { arms, claimed: true, ..Cell::default() };
            }
        }
    }

    /// Words from a cell on; nothing if they do not fit.
    pub fn text(&mut self, line: usize, column: usize, words: &str) -> Option<()> {
        let mut column = column;
        for character in words.chars() {
            let cells = cell_width(character);
            // Marks that join the character before have no cell of their own and would be lost.
            if cells == 0 {
                return None;
            }
            for part in 0..cells {
                let cell = self.cells.get_mut(line)?.get_mut(column + part)?;
                self.whole &= *cell == Cell::default();
                *cell = Cell { character: Some(character), half: part > 0, ..Cell::default() };
            }
            column += cells;
        }
        Some(())
    }

    /// The lines; they end at the right rail, so never in a blank.
    pub fn into_lines(self) -> Vec<String> {
        let character =
            |cell: &Cell| cell.character.unwrap_or_else(|| wire_character(cell.arms, self.unicode));
        let line = |cells: &Vec<Cell>| cells.iter().filter(|cell| !cell.half).map(character).collect();
        self.cells.iter().map(line).collect()
    }
}

fn wire_character(arms: u8, unicode: bool) -> char {
    if !unicode {
        return match (arms & HORIZONTAL != 0, arms & VERTICAL != 0) {
            (true, true) => '+',
            (true, false) => '-',
            (false, true) => '|',
            (false, false) => ' ',
        };
    }
    const LEFT_RIGHT_DOWN: u8 = HORIZONTAL | DOWN;
    const LEFT_RIGHT_UP: u8 = HORIZONTAL | UP;
    const UP_DOWN_RIGHT: u8 = VERTICAL | RIGHT;
    const UP_DOWN_LEFT: u8 = VERTICAL | LEFT;
    const RIGHT_DOWN: u8 = RIGHT | DOWN;
    const LEFT_DOWN: u8 = LEFT | DOWN;
    const RIGHT_UP: u8 = RIGHT | UP;
    const LEFT_UP: u8 = LEFT | UP;
    match arms {
        0 => ' ',
        LEFT | RIGHT | HORIZONTAL => '─',
        UP | DOWN | VERTICAL => '│',
        RIGHT_DOWN => '┌',
        LEFT_DOWN => '┐',
        RIGHT_UP => '└',
        LEFT_UP => '┘',
        UP_DOWN_RIGHT => '├',
        UP_DOWN_LEFT => '┤',
        LEFT_RIGHT_DOWN => '┬',
        LEFT_RIGHT_UP => '┴',
        _ => '┼',
    }
}
